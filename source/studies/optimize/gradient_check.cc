// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/studies/optimize/gradient_check.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Number to check: its value, and its derivative by a variable.
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
                 std::vector<Checked> &list)
    {
      const std::vector<double> &values = (here.*block).values;
      const auto [least, most]          = std::ranges::minmax_element(values);
      for (const auto place : {least, most})
      {
        const auto p = static_cast<std::size_t>(place - values.begin());
        list.push_back({fmt::format("{} {}", place == least ? "smallest" : "largest", name),
                        [=](const GaitValues &there) { return (there.*block).values[p]; },
                        [=](const GaitValues &there, const std::size_t i) { return (there.*block).gradients[i][p]; }});
      }
    }

    /// Numbers that the study wants or limits.
    std::vector<Checked>
    numbers_to_check(const GaitValues &here, const GaitWishes &wishes)
    {
      std::vector<Checked> list;
      for (std::size_t k = 0; k < gait_numbers.size(); ++k)
        if (wishes.numbers[k])
          list.push_back({gait_numbers[k].words,
                          [k](const GaitValues &there) { return there.numbers[k]; },
                          [k](const GaitValues &there, const std::size_t i) { return there.gradients[k][i]; }});
      if (wishes.strain && std::ranges::find(here.strain_by_differences, true) == here.strain_by_differences.end())
        add_extremes("strain", here, &GaitValues::strain, list);
      if (wishes.stress)
        add_extremes("stress", here, &GaitValues::stress, list);
      if (wishes.stress_rate)
        add_extremes("stress rate", here, &GaitValues::stress_rate, list);
      return list;
    }

    /// Largest deviation of a gradient from differences, relative to the number or to its largest derivative.
    double
    deviation_of(const Checked &number,
                 const GaitValues &here,
                 const std::vector<double> &differences,
                 const std::vector<std::size_t> &variables,
                 const std::function<double(std::size_t)> &scale)
    {
      double size = std::abs(number.value(here)), largest = 0.;
      for (const std::size_t i : variables)
      {
        size    = std::max(size, std::abs(differences[i] * scale(i)));
        largest = std::max(largest, std::abs((number.derivative(here, i) - differences[i]) * scale(i)));
      }
      return size > 0. ? largest / size : 0.;
    }
  } // namespace

  std::optional<bool>
  check_gradient(GaitModel &model, const std::vector<double> &x, Log &log)
  {
    const double noise = model.noise();
    const double step = noise > 0. ? 0.5 * std::cbrt(noise) : 1e-6, tolerance = noise > 0. ? 20. * noise / step : 1e-5;
    const GaitValues here = model.evaluate(x, /*with_gradients=*/true);
    here.require_start();
    const std::vector<Checked> list = numbers_to_check(here, model.wishes);
    std::vector<std::size_t> checked;
    for (std::size_t i = 0; i < x.size(); ++i)
      if (here.by_differences.empty() || !here.by_differences[i])
        checked.push_back(i);
      else
        log.line(fmt::format("{}: its derivatives are differences of simulations, since the adjoint does not cover it; "
                             "there is nothing to compare",
                             model.family.variables[i].path));
    if (checked.empty() || list.empty())
      return std::nullopt;

    // Values jump by their error where the integrator takes another step or the mesh another cell. Narrower differences
    // avoid most of these places; a wrong derivative agrees with none.
    std::vector<std::vector<double>> differences(list.size(), std::vector<double>(x.size()));
    std::vector<double> deviations(list.size(), std::numeric_limits<double>::max());
    for (double width = step; width >= step / 64. && std::ranges::max(deviations) > tolerance; width /= 8.)
    {
      std::vector<std::vector<double>> narrower(list.size(), std::vector<double>(x.size()));
      for (const std::size_t i : checked)
        for (const auto &point : model.family.stencil(x, i, width))
        {
          const GaitValues there = model.evaluate(point.x, /*with_gradients=*/false);
          if (!there.problem.empty())
            throw InputError("near the start: " + there.problem, "Optimize/Variables");
          for (std::size_t c = 0; c < list.size(); ++c)
            narrower[c][i] += point.weight * list[c].value(there);
        }
      for (std::size_t c = 0; c < list.size(); ++c)
        if (const double deviation = deviation_of(
              list[c], here, narrower[c], checked, [&](const std::size_t i) { return model.family.scale(x, i); });
            deviation < deviations[c])
        {
          deviations[c]  = deviation;
          differences[c] = narrower[c];
        }
    }
    for (std::size_t c = 0; c < list.size(); ++c)
    {
      log.line(fmt::format("{}: gradient and differences differ by {:.1e} of its size; {:.1e} is {}",
                           list[c].name,
                           deviations[c],
                           tolerance,
                           deviations[c] <= tolerance ? "allowed" : "allowed: they do NOT agree"));
      for (const std::size_t i : checked)
        log.line(fmt::format("  {:<60} {:>17.10g} {:>17.10g}",
                             model.family.variables[i].path,
                             list[c].derivative(here, i),
                             differences[c][i]));
    }
    return std::ranges::max(deviations) <= tolerance;
  }
} // namespace crawler
