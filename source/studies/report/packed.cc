// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/base64.h>
#include <crawler/studies/report/packed.h>

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
      return encode_base64(bytes);
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
    /// Least and largest finite value; the other way round if there is none.
    std::pair<double, double>
    range_of(const std::vector<double> &values)
    {
      double low = HUGE_VAL, high = -HUGE_VAL;
      for (const double value : values)
        if (std::isfinite(value))
        {
          low  = std::min(low, value);
          high = std::max(high, value);
        }
      return {low, high};
    }

    /// Of the numbers below @p n every so many, and the last one.
    std::vector<std::size_t>
    every(const std::size_t stride, const std::size_t n)
    {
      std::vector<std::size_t> list;
      for (std::size_t i = 0; i < n; i += stride)
        list.push_back(i);
      if (list.back() + 1 != n)
        list.push_back(n - 1);
      return list;
    }

    /// What pictures show of a field.
    FieldRange
    shown_range(const KymographTable &kymograph, const std::string &name, const std::vector<double> &values)
    {
      const auto known = kymograph.shown.find(name);
      return known != kymograph.shown.end() ? known->second : range_of(values);
    }

    KymographTable
    part_of(const KymographTable &whole, const std::vector<std::size_t> &rows, const std::vector<std::size_t> &places)
    {
      KymographTable part;
      part.shown = whole.shown;
      for (const std::size_t i : places)
        part.places.push_back(whole.places[i]);
      for (const std::size_t j : rows)
        part.times.push_back(whole.times[j]);
      for (const auto &[name, values] : whole.fields)
      {
        part.fields.emplace_back(name, std::vector<double>());
        for (const std::size_t j : rows)
          for (const std::size_t i : places)
            part.fields.back().second.push_back(values[j * whole.places.size() + i]);
      }
      return part;
    }

    /// Is every other row (or place) what a line between its neighbours gives, to a colour of the 256 that a picture
    /// has?
    bool
    can_be_halved(const KymographTable &kymograph, const bool in_time)
    {
      constexpr double tolerance = 1. / 256;
      const std::size_t n_rows = kymograph.times.size(), n_places = kymograph.places.size();
      const auto &axis = in_time ? kymograph.times : kymograph.places;
      if (axis.size() % 2 == 0 || axis.size() < 64)
        return false;
      const std::size_t other = in_time ? n_places : n_rows, step = in_time ? n_places : 1,
                        other_step = in_time ? 1 : n_places;
      for (const auto &[name, values] : kymograph.fields)
      {
        const auto [low, high] = shown_range(kymograph, name, values);
        const auto seen = [low = low, high = high](const double x) { return x < low ? low : x > high ? high : x; };
        for (std::size_t k = 1; k + 1 < axis.size(); k += 2)
        {
          const double part = (axis[k] - axis[k - 1]) / (axis[k + 1] - axis[k - 1]);
          for (std::size_t l = 0; l < other; ++l)
          {
            const double *here = &values[k * step + l * other_step];
            const double line  = here[-static_cast<std::ptrdiff_t>(step)] * (1. - part) + here[step] * part;
            if (!(std::abs(seen(*here) - seen(line)) <= tolerance * (high - low)))
              return false;
          }
        }
      }
      return true;
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
  packed(const KymographTable &kymograph, const std::size_t most_rows)
  {
    constexpr std::uint16_t unknown = std::numeric_limits<std::uint16_t>::max();
    KymographTable small            = kymograph;
    for (const bool in_time : {true, false})
      while (can_be_halved(small, in_time))
        small = part_of(small, every(in_time ? 2 : 1, small.times.size()), every(in_time ? 1 : 2, small.places.size()));
    const std::size_t n_rows = small.times.size();
    small     = part_of(small, every((n_rows + most_rows - 1) / most_rows, n_rows), every(1, small.places.size()));
    Json json = {{"places", small.places}, {"times", small.times}, {"fields", Json::object()}};
    for (const auto &[name, values] : small.fields)
    {
      const auto [low, high] = range_of(values);
      if (low > high)
        continue;
      const auto [from, to] = shown_range(small, name, values);
      json["fields"][name]  = {{"shown", {from, to}}};
      if (high - low > 2. * (to - from)) // codes would be too coarse for what is shown
      {
        json["fields"][name]["floats"] = base64(std::vector<float>(values.begin(), values.end()));
        continue;
      }
      const double scale = high > low ? (unknown - 1) / (high - low) : 0.;
      std::vector<std::uint16_t> codes;
      for (const double value : values)
        codes.push_back(std::isfinite(value) ? static_cast<std::uint16_t>(std::lround((value - low) * scale))
                                             : unknown);
      json["fields"][name].update({{"low", low}, {"high", high}, {"codes", base64(codes)}});
    }
    return json;
  }
} // namespace crawler
