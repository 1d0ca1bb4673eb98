// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/input.h>

#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// Column of the table that describes a setting, and the entry of the parameter file for which it stands.
  struct SettingColumn
  {
    RowFile::Column column;
    std::string entry;
  };

  /// Columns from model to tolerance, in the order of the table.
  const std::vector<SettingColumn> &
  setting_columns();

  /// Columns of the table and their values as texts, without those that are unknown.
  using TradeoffTexts = std::map<std::string, std::string>;

  /// Setting: a way to compute a scene.
  struct TradeoffSetting
  {
    TradeoffTexts values;    ///< values of setting_columns(), without those that have no meaning for it
    std::string not_offered; ///< reason why the program cannot do this; then it has neither mesh nor tolerance

    /// Value in the column; empty if there is none.
    std::string
    operator[](const std::string &column) const
    {
      const auto found = values.find(column);
      return found == values.end() ? "" : found->second;
    }
  };

  /// Returns true if two settings differ by the tolerance alone.
  bool
  same_mesh(TradeoffSetting a, TradeoffSetting b);

  /**
   * Combinations of the lists in section "Tradeoff"; those of one mesh follow each other, from the loosest tolerance
   * on. Settings that the program cannot compute are listed once, whatever the meshes. The level perturbation is one
   * setting; for kinematic the tolerances are values of Accuracy, 0.1 at first. Throws InputError.
   */
  std::vector<TradeoffSetting>
  settings_to_try(const Input &input);

  /// Setting as overrides "Section/Entry=value" of the command line: with them `crawler run` computes a scene in this
  /// way. @p size is that to which the tolerance is relative [length]. Tolerance and first step are given, the former
  /// rounded to six digits.
  std::vector<std::string>
  overrides(const TradeoffSetting &setting, const Parameters &parameters, double size);
} // namespace crawler
