// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/studies/optimize/gradient_check.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr std::array<const char *, n_gait_numbers> words_of_numbers = {{"displacement",
                                                                            "work",
                                                                            "positive work",
                                                                            "mean-square strain",
                                                                            "speed",
                                                                            "T/(gamma L)",
                                                                            "dissipation",
                                                                            "efficiency"}};

    /// A number that is checked: its value, and its derivative by a variable.
    struct Checked
    {
      std::string name;
      std::function<double(const GaitValues &)> value;
      std::function<double(const GaitValues &, std::size_t)> derivative;
    };

    void
    add_extremes(const std::string &name,
                 const GaitValues &here,
                 LimitedValues GaitValues::*block,
                 const std::size_t n,
                 std::vector<Checked> &list)
    {
      const std::vector<double> &values = (here.*block).values;
      const auto [least, most]          = std::ranges::minmax_element(values);
      for (const auto place : {least, most})
      {
        const auto p = static_cast<std::size_t>(place - values.begin());
        list.push_back(
          {fmt::format("{} {}", place == least ? "smallest" : "largest", name),
           [=, is_least = place == least](const GaitValues &there) {
             const auto [smallest, largest] = std::ranges::minmax((there.*block).values);
             return is_least ? smallest : largest;
           },
           [=](const GaitValues &there, const std::size_t i) { return (*(there.*block).jacobian)[p * n + i]; }});
      }
    }
  } // namespace

  std::optional<bool>
  check_gradient(
    GaitModel &model, const SceneFamily &family, const GaitWishes &wishes, const std::vector<double> &x, Log &log)
  {
    const double noise = model.noise();
    const double step = noise > 0. ? 0.5 * std::cbrt(noise) : 1e-6, tolerance = noise > 0. ? 20. * noise / step : 1e-5;
    const GaitValues here = model.evaluate(x, /*with_gradients=*/true);
    here.require_start();
    std::vector<Checked> list;
    for (std::size_t k = 0; k < n_gait_numbers; ++k)
      if (wishes.numbers[k])
        list.push_back({words_of_numbers[k],
                        [k](const GaitValues &there) { return there.numbers[k]; },
                        [k](const GaitValues &there, const std::size_t i) { return there.gradients[k][i]; }});
    if (wishes.strain && std::ranges::find(here.strain_by_differences, true) == here.strain_by_differences.end())
      add_extremes("strain", here, &GaitValues::strain, x.size(), list);
    if (wishes.stress)
      add_extremes("stress", here, &GaitValues::stress, x.size(), list);
    if (wishes.stress_rate)
      add_extremes("stress rate", here, &GaitValues::stress_rate, x.size(), list);

    std::vector<std::size_t> checked;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (here.by_differences.empty() || !here.by_differences[i])
        checked.push_back(i);
      else
        log.line(fmt::format("{}: its derivatives are differences of simulations, since the adjoint does not cover it; "
                             "there is nothing to compare",
                             family.variables()[i].path));
    if (checked.empty())
      return std::nullopt;

    std::vector<std::vector<double>> differences(list.size(), std::vector<double>(x.size()));
    for (const std::size_t i : checked)
    {
      const auto around = family.stencil(x, i, step);
      for (std::size_t k = 0; k < around.places.size(); ++k)
      {
        std::vector<double> other = x;
        other[i] += around.places[k];
        const GaitValues there = model.evaluate(other, /*with_gradients=*/false);
        if (!there.problem.empty())
          throw InputError("beside the start: " + there.problem, "Optimize/Variables");
        for (std::size_t c = 0; c < list.size(); ++c)
          differences[c][i] += around.weights[k] * list[c].value(there);
      }
    }
    bool agrees = true;
    for (std::size_t c = 0; c < list.size(); ++c)
    {
      const auto scaled = [&](const double derivative, const std::size_t i) { return derivative * family.scale(x, i); };
      double size = noise * std::abs(list[c].value(here)), largest = 0.;
      for (const std::size_t i : checked)
      {
        size    = std::max({size, std::abs(scaled(differences[c][i], i)), std::abs(list[c].value(here))});
        largest = std::max(largest, std::abs(scaled(list[c].derivative(here, i) - differences[c][i], i)));
      }
      const bool is_good = largest <= tolerance * size;
      agrees             = agrees && is_good;
      log.line(fmt::format("{}: gradient and differences differ by {:.1e} of its size; {:.1e} is {}",
                           list[c].name,
                           size > 0. ? largest / size : 0.,
                           tolerance,
                           is_good ? "allowed" : "allowed: they do NOT agree"));
      for (const std::size_t i : checked)
        log.line(fmt::format("  {:<60} {:>17.10g} {:>17.10g}",
                             family.variables()[i].path,
                             list[c].derivative(here, i),
                             differences[c][i]));
    }
    return agrees;
  }
} // namespace crawler
