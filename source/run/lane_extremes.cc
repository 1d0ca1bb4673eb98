// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/lane_extremes.h>
#include <crawler/scene/breaks.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Margin, as a part of the strain, within which a record may be beaten after sharpening.
    constexpr double sharpening = 0.05;
    /// Margin within which a record may be beaten between times, and its jump counts.
    constexpr double near = 0.2;

    /// Stretch at a sample of a cell.
    double
    stretch_at(const LaneTables &tables,
               const LaneStep &step,
               const unsigned int i,
               const unsigned int cell,
               const unsigned int place)
    {
      const LaneSetup &setup = tables.setup;
      const std::size_t n = setup.degree + 1, unknowns = setup.n_cells * setup.degree + 1;
      double sum = 0.;
      for (unsigned int j = 0; j < n; ++j)
      {
        const std::size_t d = cell * setup.degree + j;
        const double u      = step.y[d * step.stride] - step.z[((setup.n_stages - 1) * unknowns + d) * step.stride] +
                         step.z[(i * unknowns + d) * step.stride];
        sum += setup.sample_derivatives[place * n + j] * u;
      }
      return 1. + sum / setup.sizes[cell];
    }

    /// Largest of the jumps at the ends of a cell that are no breaks.
    double
    jump_at(const LaneTables &tables,
            const LaneStep &step,
            const unsigned int i,
            const unsigned int cell,
            const std::vector<double> &breaks)
    {
      const unsigned int last = tables.setup.n_samples - 1;
      const auto jump         = [&](const unsigned int right) { // jump at its left end
        const double s = tables.place_of_sample(right * tables.setup.n_samples);
        if (std::ranges::any_of(breaks, [s](const double b) { return std::abs(b - s) < min_space_between_breaks; }))
          return 0.;
        return std::abs(stretch_at(tables, step, i, right, 0) - stretch_at(tables, step, i, right - 1, last));
      };
      return std::max(cell > 0 ? jump(cell) : 0., cell + 1 < tables.setup.n_cells ? jump(cell + 1) : 0.);
    }

    void
    sharpen(
      const LaneTables &tables, const LaneStep &step, const unsigned int i, const unsigned int sample, Extreme &now)
    {
      const LaneSetup &setup   = tables.setup;
      const unsigned int place = sample % setup.n_samples, cell = sample / setup.n_samples;
      if (place == 0 || place + 1 == setup.n_samples)
        return;
      const auto [s, value] = parabola_vertex(tables.place_of_sample(sample - 1),
                                              stretch_at(tables, step, i, cell, place - 1),
                                              now.s,
                                              now.value,
                                              tables.place_of_sample(sample + 1),
                                              stretch_at(tables, step, i, cell, place + 1));
      if (value > 0. && s > tables.place_of_sample(sample - 1) && s < tables.place_of_sample(sample + 1))
      {
        now.s     = s;
        now.value = value;
      }
    }
  } // namespace

  std::pair<Extreme, Extreme>
  lane_extremes(const LaneTables &tables,
                const LaneStep &step,
                const unsigned int i,
                const SimulationResult &so_far,
                const std::vector<double> &breaks)
  {
    const LaneSetup &setup = tables.setup;
    const LaneStage &stage = step.stages[i];
    const double t         = i + 1 < setup.n_stages ? step.time - (1. - setup.method.c[i]) * step.size : step.time;
    const auto sharpened =
      [&](const double value, const unsigned int sample, const bool is_beyond, const double record) {
        Extreme now{value, tables.place_of_sample(sample), t};
        const double part = std::abs(value - record) / std::abs(record - 1.);
        if (is_beyond || part < near)
          now.jump = jump_at(tables, step, i, sample / setup.n_samples, breaks);
        if (is_beyond || part < sharpening)
          sharpen(tables, step, i, sample, now);
        return now;
      };
    const double least = so_far.stretch.min.value, most = so_far.stretch.max.value;
    return {sharpened(stage.min_stretch, stage.min_sample, stage.min_stretch < least, least),
            sharpened(stage.max_stretch, stage.max_sample, stage.max_stretch > most, most)};
  }
} // namespace crawler
