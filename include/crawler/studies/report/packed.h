// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>
#include <crawler/output/kymograph_reader.h>

#include <nlohmann/json.hpp>

namespace crawler
{
  /// Tables and fields as a page has them: numbers as base 64 of their bytes, little-endian.
  using Json = nlohmann::ordered_json;

  /**
   * {name, unit, meaning} and its values: {values, codes, bytes}, where the codes of this many bytes are indices into
   * the different values (null: not known); {count} for the numbers 0, 1, 2, ...; {floats} in single precision, where
   * that is shorter; {doubles} instead if it must be exact, as the others are.
   */
  Json
  packed(const Column &column, bool is_exact = false);

  /// {places, times, fields: {NAME: {shown, low, high, codes}}}: what pictures show (two numbers), and codes from 0 to
  /// 65534 for low to high, 65535 where a value is not known; {shown, floats} where far more than that occurs. Rows and
  /// places that lines between the others give to a 256th of the range are left out; there are no more than @p
  /// most_rows times.
  Json
  packed(const KymographTable &kymograph, std::size_t most_rows);
} // namespace crawler
