// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/input.h>

#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// A column of the table that says what a setting is, and the entry of the parameter file that it stands for.
  struct SettingColumn
  {
    RowFile::Column column;
    std::string entry;
  };

  /// From model to tolerance, in the order of the table.
  const std::vector<SettingColumn> &
  setting_columns();

  /// Columns of the table and their values as texts, without those that are not known.
  using TradeoffTexts = std::map<std::string, std::string>;

  /// A way to compute a scene.
  struct TradeoffSetting
  {
    TradeoffTexts values;    ///< of setting_columns(), without those that have no meaning for it
    std::string not_offered; ///< why the program cannot do this; then it has neither mesh nor tolerance

    /// Empty if it has no such value.
    std::string
    operator[](const std::string &column) const;
  };

  /// Whether two settings differ by the tolerance alone.
  bool
  same_mesh(TradeoffSetting a, TradeoffSetting b);

  /**
   * All combinations of the lists in section "Tradeoff"; those of one mesh follow each other, from the loosest
   * tolerance on. What the program cannot do is one setting, whatever the meshes. The level perturbation is one
   * setting; for kinematic the tolerances are values of Accuracy, 0.1 at first. Throws InputError, with the
   * place in the file.
   */
  std::vector<TradeoffSetting>
  settings_to_try(const Input &input);

  /// The setting as overrides "Section/Entry=value" of the command line: with them `crawler run` computes a scene in
  /// this way. @p size is that to which the tolerance is relative [length]. Tolerance and first step are given, the
  /// former rounded to six digits.
  std::vector<std::string>
  overrides(const TradeoffSetting &setting, const Parameters &parameters, double size);
} // namespace crawler
