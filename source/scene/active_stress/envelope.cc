// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/active_stress/profile.h>
#include <crawler/scene/breaks.h>

#include <fmt/format.h>

namespace crawler
{
  namespace
  {
    const Range not_negative{.lower = 0., .lower_included = true};
  }

  void
  EnvelopeParameters::add_parameters(Declarations &declarations)
  {
    declarations.number("Window start", window_start, not_negative, "length")
      .means("Where the window begins outside of which the active stress is 0; automatic: it has no edge at s = 0.");
    declarations.number("Window end", window_end, not_negative, "length")
      .means("Where the window ends; automatic: it has no edge at s = L.");
    declarations.number("Window edge", window_edge, not_negative, "length")
      .means("Width of the window's edges, smooth steps inside of the window; with 0 the stress jumps there.");
    declarations.number("Ramp duration", ramp_duration, not_negative, "time")
      .means("How long the stress takes to grow, by a smooth step, from 0 at t = 0 to its full size.");
  }

  Envelope::Envelope(const EnvelopeParameters &parameters, const std::string &section, const double length)
    : start_(parameters.window_start)
    , end_(parameters.window_end)
    , edge_(parameters.window_edge)
    , ramp_(parameters.ramp_duration)
    , length_(length)
  {
    const double start = start_.value_or(0.), end = end_.value_or(length);
    if (end > length)
      throw InputError(
        fmt::format("the window ends at s = {:g}, but a place on the body, at most {:g}, is expected", end, length),
        section + "Window end");
    if (!(start < end))
      throw InputError(
        fmt::format("the window starts at s = {:g}, but a place before its end, {:g}, is expected", start, end),
        section + "Window start");
    const int n_edges = (start_ ? 1 : 0) + (end_ ? 1 : 0);
    if (n_edges * edge_ > (end - start) * (1. + 1e-12))
      throw InputError(fmt::format("the edges of the window are {:g} wide, but at most {:g} is expected for a window "
                                   "from {:g} to {:g}",
                                   edge_,
                                   (end - start) / n_edges,
                                   start,
                                   end),
                       section + "Window edge");
  }

  double
  Envelope::window(const double s) const
  {
    if (edge_ == 0.)
      return (start_ && s < *start_) || (end_ && s > *end_) ? 0. : 1.;
    return (start_ ? smooth_step((s - *start_) / edge_) : 1.) * (end_ ? smooth_step((*end_ - s) / edge_) : 1.);
  }

  double
  Envelope::ramp(const double t) const
  {
    return ramp_ > 0. ? smooth_step(t / ramp_) : 1.;
  }

  double
  Envelope::ramp_rate(const double t) const
  {
    return ramp_ > 0. ? smooth_step_rate(t / ramp_) / ramp_ : 0.;
  }

  double
  Envelope::largest_ramp_rate(const double from, const double to) const
  {
    return ramp_ > 0. ? largest_smooth_step_rate(from / ramp_, to / ramp_) / ramp_ : 0.;
  }

  std::vector<double>
  Envelope::breaks_in_space() const
  {
    return edge_ == 0. ? within({start_.value_or(0.), end_.value_or(length_)}, length_) : std::vector<double>();
  }
} // namespace crawler
