// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "run_text.h"

#include <cmath>
#include <optional>
#include <random>

namespace crawler::test
{
  /// Random scenes with the optimal wave, always the same ones: a from -4 to 3, leading-order strain from 0.01 to 0.9,
  /// |c| from 0.5 to 2, k from 0.1 to 10, T from 0.3 to 3, two harmonics.
  class RandomWaves
  {
  public:
    struct Wave
    {
      double a, chi, c, k, T;
      Settings settings;
    };

    Wave
    next()
    {
      const auto between = [this](const double low, const double high) {
        return std::uniform_real_distribution<double>(low, high)(generator_);
      };
      const auto log_between = [&](const double low, const double high) {
        return std::exp(between(std::log(low), std::log(high)));
      };
      Wave wave{};
      wave.a          = between(-4., 3.);
      wave.c          = log_between(0.5, 2.) * (between(-1., 1.) < 0. ? -1. : 1.);
      wave.k          = log_between(0.1, 10.);
      wave.T          = log_between(0.3, 3.);
      const double a2 = between(-0.5, 0.5), b1 = between(-0.5, 0.5), b2 = between(-0.5, 0.5);
      // Strain is at most 2 chi/|c| times the sum of the amplitudes.
      const double amplitudes = std::sqrt(1. + b1 * b1) + std::sqrt(a2 * a2 + b2 * b2);
      wave.chi                = log_between(0.01, 0.9) * std::abs(wave.c) / (2. * amplitudes);
      wave.settings           = with(test::wave(wave.a, wave.chi, wave.c, wave.T, wave.k),
                           "optimal wave; Sine coefficients = 1, {}; Cosine coefficients = {}, {}",
                           a2,
                           b1,
                           b2);
      return wave;
    }

  private:
    std::mt19937_64 generator_{20261121};
  };

  /// Displacement of the nonlinear model, to a relative 1e-6; nothing if the run does not finish.
  inline std::optional<double>
  true_displacement(const Settings &settings)
  {
    const SimulationResult result = run_with(with(settings, "Accuracy = 1e-6"), {}).result;
    return result.time.status == Status::finished ? std::optional(result.displacement) : std::nullopt;
  }
} // namespace crawler::test
