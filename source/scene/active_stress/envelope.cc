// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/active_stress/wave_entries.h>
#include <crawler/scene/breaks.h>

#include <fmt/format.h>

namespace crawler
{
  void
  EnvelopeParameters::add_parameters(Declarations &declarations)
  {
    declarations.number("Window start", window_start, not_negative(), "length")
      .means("Start of the window outside which the active stress is 0. Automatic: no edge at s = 0.");
    declarations.number("Window end", window_end, not_negative(), "length")
      .means("End of the window. Automatic: no edge at s = L.");
    declarations.number("Window edge", window_edge, not_negative(), "length")
      .means("Width of the window's edges, which are smooth steps inside the window; with 0 the stress jumps there.");
    declarations.number("Ramp duration", ramp_duration, not_negative(), "time")
      .means("Time in which the stress grows by a smooth step from 0 at t = 0 to its full size.");
  }

  double
  Ramp::value(const double t) const
  {
    return end > 0. ? smooth_step(t / end) : 1.;
  }

  double
  Ramp::rate(const double t) const
  {
    return end > 0. ? smooth_step_rate(t / end) / end : 0.;
  }

  ActiveStress::Bounds
  Ramp::ramped(const ActiveStress::Bounds bounds, const double from, const double to) const
  {
    if (!(end > 0.))
      return bounds;
    const double largest = value(to), steepest = largest_smooth_step_rate(from / end, to / end) / end;
    return {bounds.value * largest, bounds.rate * largest + bounds.value * steepest};
  }

  Window::Window(const EnvelopeParameters &parameters, const std::string &section, const double length)
    : variable_('s')
    , end_(length)
    , edge_(parameters.window_edge)
    , from_(parameters.window_start.value_or(-HUGE_VAL))
    , to_(parameters.window_end.value_or(HUGE_VAL))
  {
    const double start = parameters.window_start.value_or(0.), end = parameters.window_end.value_or(length);
    if (end > length)
      refuse(section + "Window end",
             "the window ends at s = {:g}, but a place on the body, at most {:g}, is expected",
             end,
             length);
    if (!(start < end))
      refuse(section + "Window start",
             "the window starts at s = {:g}, but a place before its end, {:g}, is expected",
             start,
             end);
    const int n_edges = (parameters.window_start ? 1 : 0) + (parameters.window_end ? 1 : 0);
    if (n_edges * edge_ > (end - start) * (1. + 1e-12))
      refuse(section + "Window edge",
             "the edges of the window are {:g} wide, but at most {:g} is expected for a window "
             "from {:g} to {:g}",
             edge_,
             (end - start) / n_edges,
             start,
             end);
  }

  Window::Window(const WindowEntries &entries, const char variable, const std::string &section, const double end)
    : variable_(variable)
    , end_(end)
    , edge_(entries.edge_width)
  {
    if (entries.interval.empty())
      return;
    const std::string entry = fmt::format("{}Window in {}", section, variable),
                      name  = fmt::format("Window in {}", variable);
    if (entries.interval.size() != 2)
      refuse(entry, "{} has {} numbers, but two, from and to, or none are expected", name, entries.interval.size());
    from_ = entries.interval[0];
    to_   = entries.interval[1];
    if (!(from_ < to_ && to_ > 0. && from_ < end))
      refuse(entry,
             "{} is from {:g} to {:g}, but two increasing numbers are expected, with a part of the "
             "range from 0 to {:g} between them",
             name,
             from_,
             to_,
             end);
    if (2. * edge_ > (to_ - from_) * (1. + 1e-12))
      refuse(fmt::format("{}Edge width in {}", section, variable),
             "the edges are {:g} wide, but at most {:g} is expected for a window from {:g} to {:g}",
             edge_,
             0.5 * (to_ - from_),
             from_,
             to_);
  }

  double
  Window::value(const double x) const
  {
    if (edge_ == 0.) // of two adjacent windows only one includes the common end
      return x >= from_ && (x < to_ || to_ >= end_) ? 1. : 0.;
    return smooth_step((x - from_) / edge_) * smooth_step((to_ - x) / edge_);
  }

  double
  Window::rate(const double x) const
  {
    if (edge_ == 0.)
      return 0.;
    const double up = (x - from_) / edge_, down = (to_ - x) / edge_;
    return (smooth_step_rate(up) * smooth_step(down) - smooth_step(up) * smooth_step_rate(down)) / edge_;
  }

  std::pair<double, double>
  Window::largest(const double from, const double to) const
  {
    if (to < from_ || from > to_)
      return {0., 0.};
    if (edge_ == 0.)
      return {1., 0.};
    const double up   = largest_smooth_step_rate((from - from_) / edge_, (to - from_) / edge_),
                 down = largest_smooth_step_rate((to_ - to) / edge_, (to_ - from) / edge_);
    return {1., (up + down) / edge_};
  }

  std::vector<double>
  Window::ends() const
  {
    return within({from_, to_}, end_);
  }

  double
  Window::constant_from() const
  {
    if (is_whole())
      return 0.;
    const bool lasts = to_ - edge_ >= end_ || (edge_ == 0. && to_ >= end_);
    return std::clamp(lasts ? from_ + edge_ : to_, 0., end_);
  }

  std::string
  Window::in_words() const
  {
    if (is_whole())
      return "";
    return fmt::format(
      "{} from {:g} to {:g}{}", variable_, from_, to_, edge_ > 0. ? fmt::format(" (edges {:g} wide)", edge_) : "");
  }
} // namespace crawler
