// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/result_json.h>
#include <crawler/run/result_table.h>

#include <nlohmann/json.hpp>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// Place in the JSON of a key with dots for nesting.
    Json &
    place_of(const std::string &key, Json &json)
    {
      Json *place      = &json;
      std::size_t from = 0;
      for (std::size_t dot = 0; (dot = key.find('.', from)) != std::string::npos; from = dot + 1)
        place = &(*place)[key.substr(from, dot - from)];
      return (*place)[key.substr(from)];
    }

    Json
    as_json(const ResultValue &value)
    {
      if (const auto *text = std::get_if<std::string>(&value); text != nullptr && text->empty())
        return nullptr;
      return std::visit(
        [](const auto &one) -> Json {
          if constexpr (std::is_same_v<std::decay_t<decltype(one)>, std::monostate>)
            return nullptr;
          else if constexpr (std::is_same_v<std::decay_t<decltype(one)>, double>)
            return one + 0.; // no -0
          else
            return one;
        },
        value);
    }
  } // namespace

  nlohmann::ordered_json
  summary_of(const SimulationResult &result)
  {
    Json json;
    for (const ResultEntry &entry : result_table())
      place_of(entry.key, json) = as_json(entry.value_in(result));
    // Parts missing from the run.
    if (!result.cycles)
      json["cycles"] = nullptr;
    if (!result.inversion)
      json["inversion"] = nullptr;
    return json;
  }

  nlohmann::ordered_json
  result_entries()
  {
    Json entries = Json::array();
    for (const ResultEntry &entry : result_table())
      entries.push_back({{"key", entry.key}, {"unit", entry.unit}, {"meaning", entry.meaning}});
    return entries;
  }
} // namespace crawler
