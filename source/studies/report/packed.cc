// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/report/packed.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <unordered_map>

namespace crawler
{
  namespace
  {
    static_assert(std::endian::native == std::endian::little, "the page reads numbers as they are here");

    template <typename Number>
    std::string
    base64(const std::vector<Number> &values)
    {
      std::vector<unsigned char> bytes(values.size() * sizeof(Number));
      std::memcpy(bytes.data(), values.data(), bytes.size());
      return dealii::Utilities::encode_base64(bytes);
    }

    /// Indices into the different values; nothing if these are too many to be worth it.
    template <typename Value>
    bool
    add_codes(const std::vector<Value> &values, const std::size_t most, Json &json)
    {
      constexpr std::size_t few = 256;
      const auto is_unknown     = [](const Value &value) {
        if constexpr (std::is_same_v<Value, double>)
          return !std::isfinite(value);
        else
          return value.empty();
      };
      std::unordered_map<Value, std::size_t> code_of;
      Json different = Json::array();
      std::vector<std::uint32_t> codes;
      std::optional<std::uint32_t> unknown;
      for (const Value &value : values)
      {
        if (is_unknown(value))
        {
          if (!unknown)
          {
            unknown = static_cast<std::uint32_t>(different.size());
            different.push_back(nullptr);
          }
          codes.push_back(*unknown);
          continue;
        }
        const auto [found, is_new] = code_of.emplace(value, different.size());
        if (is_new)
          different.push_back(value);
        if (different.size() > most)
          return false;
        codes.push_back(static_cast<std::uint32_t>(found->second));
      }
      const auto as = [&]<typename Code>(const Code) {
        json["codes"] = base64(std::vector<Code>(codes.begin(), codes.end()));
        json["bytes"] = sizeof(Code);
      };
      json["values"] = std::move(different);
      if (json["values"].size() <= few)
        as(std::uint8_t());
      else if (json["values"].size() <= few * few)
        as(std::uint16_t());
      else
        as(std::uint32_t());
      return true;
    }
    /// 0, 1, 2, ...
    bool
    is_count(const std::vector<double> &numbers)
    {
      for (std::size_t i = 0; i < numbers.size(); ++i)
        if (numbers[i] != static_cast<double>(i))
          return false;
      return numbers.size() > 1;
    }
  } // namespace

  Json
  packed(const Column &column, const bool is_exact)
  {
    constexpr std::size_t small = 2000; ///< tables of so many rows are exact
    Json json                   = {{"name", column.name}, {"unit", column.unit}, {"meaning", column.description}};
    if (const auto *texts = std::get_if<std::vector<std::string>>(&column.values))
      add_codes(*texts, texts->size() + 1, json);
    else
    {
      const auto &numbers = std::get<std::vector<double>>(column.values);
      if (is_count(numbers))
        json["count"] = numbers.size();
      else if (!add_codes(numbers, numbers.size() <= small ? numbers.size() + 1 : numbers.size() / 16, json))
      {
        if (is_exact)
          json["doubles"] = base64(numbers);
        else
          json["floats"] = base64(std::vector<float>(numbers.begin(), numbers.end()));
      }
    }
    return json;
  }

  Json
  packed(const Kymograph &kymograph, const std::size_t most_rows)
  {
    constexpr std::uint16_t unknown = std::numeric_limits<std::uint16_t>::max();
    const std::size_t n_rows = kymograph.times.size(), n_places = kymograph.places.size();
    const std::size_t stride = (n_rows + most_rows - 1) / most_rows;
    std::vector<std::size_t> rows;
    for (std::size_t j = 0; j < n_rows; j += stride)
      rows.push_back(j);
    if (rows.back() + 1 != n_rows)
      rows.push_back(n_rows - 1);
    std::vector<double> times;
    for (const std::size_t j : rows)
      times.push_back(kymograph.times[j]);
    Json json = {{"places", kymograph.places}, {"times", times}, {"fields", Json::object()}};
    for (const auto &[name, all] : kymograph.fields)
    {
      std::vector<double> values;
      for (const std::size_t j : rows)
        for (std::size_t i = 0; i < n_places; ++i)
          values.push_back(all[j * n_places + i]);
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (const double value : values)
        if (std::isfinite(value))
        {
          low  = std::min(low, value);
          high = std::max(high, value);
        }
      if (low > high)
        continue;
      const double scale = high > low ? (unknown - 1) / (high - low) : 0.;
      std::vector<std::uint16_t> codes;
      for (const double value : values)
        codes.push_back(std::isfinite(value) ? static_cast<std::uint16_t>(std::lround((value - low) * scale))
                                             : unknown);
      json["fields"][name] = {{"low", low}, {"high", high}, {"codes", base64(codes)}};
    }
    return json;
  }
} // namespace crawler
