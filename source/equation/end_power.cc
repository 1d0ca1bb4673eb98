// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/end_power.h>

namespace crawler
{
  EndPower::EndPower(const Assembler &assembler)
    : assembler_(assembler)
    , stress_(assembler.scene.active_stress->at({0., assembler.scene.body.length}))
  {
    if (assembler.scene.active_stress->feedback() == nullptr)
      return;
    // At the left end of the first and the right end of the last of this rank's cells.
    std::vector<CellPlace> places;
    if (const unsigned int n_cells = assembler.discretization.n_local_cells(); n_cells > 0)
      places = {{0, 0.}, {n_cells - 1, 1.}};
    sampler_  = std::make_unique<GeneralSampler>(assembler, places);
    feedback_ = assembler.scene.active_stress->feedback()->at({0., assembler.scene.body.length});
  }

  double
  EndPower::of_ends(const Ends &ends)
  {
    std::array<double, 2> m{};
    if (feedback_)
      feedback_->values(ends.t, {ends.stretch, ends.rate, {}, {}}, {m, {}, {}, {}});
    else
      stress_->values(ends.t, m);
    return m[1] * ends.velocity[1] - m[0] * ends.velocity[0];
  }

  double
  EndPower::operator()(const double t, const std::span<const double> y, const std::span<const double> v)
  {
    std::array<double, 2> m{};
    if (!sampler_)
      stress_->values(t, m);
    else
    {
      sampler_->sample(t, y, v);
      const auto &own = sampler_->force.m;
      if (!own.empty()) // the first rank uses the left one only, the last rank the right one
        m = {{own.front(), own.back()}};
    }
    const Discretization &d = assembler_.discretization;
    double power            = 0.;
    if (d.rank == 0)
      power -= m[0] * v.front();
    if (d.n_local() > 0 && !d.has_right_neighbour())
      power += m[1] * v.back();
    d.sum_over_ranks({&power, 1});
    return power;
  }
} // namespace crawler
