// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/files.h>
#include <crawler/parameters/declarations.h>
#include <crawler/studies/core/sensitivities.h>
#include <crawler/studies/run/sensitivity_files.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace crawler
{
  void
  write_sensitivities(const LocalSensitivity &local, const std::filesystem::path &folder, const UnitNames &units)
  {
    if (local.s.empty())
      return;
    std::string text = units.in_brackets("s [length],elastic modulus [1],friction [1]\n");
    for (std::size_t i = 0; i < local.s.size(); ++i)
      fmt::format_to(std::back_inserter(text), "{},{},{}\n", local.s[i], local.elastic_modulus[i], local.friction[i]);
    write_file(folder / "sensitivity_body.csv", text);
    if (local.times.empty())
      return;
    text = units.in_brackets("s [length],t [time],active stress [1/(force time)]\n");
    for (std::size_t j = 0; j < local.times.size(); ++j)
      for (std::size_t i = 0; i < local.s.size(); ++i)
        fmt::format_to(
          std::back_inserter(text), "{},{},{}\n", local.s[i], local.times[j], local.stress[j * local.s.size() + i]);
    write_file(folder / "sensitivity_stress.csv", text);
  }

  LocalSensitivity
  add_sensitivities(const Input &input,
                    const NumericsChoice &choice,
                    SimulationResult &result,
                    const std::function<bool()> &keep_going)
  {
    Form form(input.file);
    LocalSensitivity local = find_sensitivities(form, input.scene, input.sensitivities, choice, result, keep_going);
    if (trimmed(input.parameters.output.sensitivities) == "all")
      std::erase_if(result.sensitivities, [&](const EntrySensitivity &one) {
        return one.standard_deviation == 0. &&
               (one.may_vary ? one.value == 0. : input.file.assignment_of(one.entry) == nullptr);
      });
    std::ranges::stable_sort(result.sensitivities, [](const EntrySensitivity &a, const EntrySensitivity &b) {
      const auto size = [](const EntrySensitivity &one) { return one.value ? std::abs(*one.value * one.at) : -1.; };
      return size(a) > size(b);
    });
    return local;
  }
} // namespace crawler
