// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/lane_extremes.h>

#include <cmath>

namespace crawler
{
  namespace
  {
    /// A record that is beaten by less than this part of a strain may be beaten after sharpening.
    constexpr double sharpening = 0.05;
  } // namespace

  LaneExtremes::Range
  LaneExtremes::look(const LaneStep &step, const unsigned int i, const double least, const double most) const
  {
    const LaneSetup &setup = tables_.setup;
    const LaneStage &stage = step.stages[i];
    const double t         = i + 1 < setup.n_stages ? step.time - (1. - setup.c[i]) * step.size : step.time;
    const auto sharpened =
      [&](const double value, const unsigned int sample, const bool is_beyond, const double record) {
        Extreme now{value, tables_.place_of_sample(sample), t};
        if (is_beyond || std::abs(value - record) < sharpening * std::abs(record - 1.))
          sharpen(step, i, sample, now);
        return now;
      };
    return {sharpened(stage.min_stretch, stage.min_sample, stage.min_stretch < least, least),
            sharpened(stage.max_stretch, stage.max_sample, stage.max_stretch > most, most)};
  }

  void
  LaneExtremes::sharpen(const LaneStep &step, const unsigned int i, const unsigned int sample, Extreme &now) const
  {
    const LaneSetup &setup   = tables_.setup;
    const unsigned int place = sample % setup.n_samples, cell = sample / setup.n_samples;
    if (place == 0 || place + 1 == setup.n_samples)
      return;
    const auto stretch_at = [&](const unsigned int p) {
      const std::size_t n = setup.degree + 1, unknowns = setup.n_cells * setup.degree + 1;
      double sum = 0.;
      for (unsigned int j = 0; j < n; ++j)
      {
        const std::size_t d = cell * setup.degree + j;
        const double u      = step.y[d * step.stride] - step.z[((setup.n_stages - 1) * unknowns + d) * step.stride] +
                         step.z[(i * unknowns + d) * step.stride];
        sum += setup.sample_derivatives[p * n + j] * u;
      }
      return 1. + sum / setup.sizes[cell];
    };
    const auto [s, value] = parabola_vertex(tables_.place_of_sample(sample - 1),
                                            stretch_at(place - 1),
                                            now.s,
                                            now.value,
                                            tables_.place_of_sample(sample + 1),
                                            stretch_at(place + 1));
    if (value > 0. && s > tables_.place_of_sample(sample - 1) && s < tables_.place_of_sample(sample + 1))
    {
      now.s     = s;
      now.value = value;
    }
  }
} // namespace crawler
