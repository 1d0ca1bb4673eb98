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

  Envelope::Envelope(const EnvelopeParameters &parameters, const std::string &section, const double length)
    : start_(parameters.window_start)
    , end_(parameters.window_end)
    , edge_(parameters.window_edge)
    , ramp_(parameters.ramp_duration)
    , length_(length)
  {
    const double start = start_.value_or(0.), end = end_.value_or(length);
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
    const int n_edges = (start_ ? 1 : 0) + (end_ ? 1 : 0);
    if (n_edges * edge_ > (end - start) * (1. + 1e-12))
      refuse(section + "Window edge",
             "the edges of the window are {:g} wide, but at most {:g} is expected for a window "
             "from {:g} to {:g}",
             edge_,
             (end - start) / n_edges,
             start,
             end);
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

  ActiveStress::Bounds
  Envelope::ramped(const ActiveStress::Bounds bounds, const double from, const double to) const
  {
    if (!(ramp_ > 0.))
      return bounds;
    const double largest = ramp(to), rate = largest_smooth_step_rate(from / ramp_, to / ramp_) / ramp_;
    return {bounds.value * largest, bounds.rate * largest + bounds.value * rate};
  }

  std::vector<double>
  Envelope::breaks_in_space() const
  {
    return edge_ == 0. ? within({start_.value_or(0.), end_.value_or(length_)}, length_) : std::vector<double>();
  }

  Window::Window(const WindowEntries &entries, const char variable, const std::string &section, const double end)
    : variable_(variable)
    , end_(end)
    , is_everywhere_(entries.interval.empty())
    , edge_(entries.edge_width)
  {
    if (is_everywhere_)
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
    if (is_everywhere_)
      return 1.;
    if (edge_ == 0.) // of two adjacent windows only one includes the common end
      return x >= from_ && (x < to_ || to_ >= end_) ? 1. : 0.;
    return smooth_step((x - from_) / edge_) * smooth_step((to_ - x) / edge_);
  }

  double
  Window::rate(const double x) const
  {
    if (is_everywhere_ || edge_ == 0.)
      return 0.;
    const double up = (x - from_) / edge_, down = (to_ - x) / edge_;
    return (smooth_step_rate(up) * smooth_step(down) - smooth_step(up) * smooth_step_rate(down)) / edge_;
  }

  std::pair<double, double>
  Window::largest(const double from, const double to) const
  {
    if (!is_everywhere_ && (to < from_ || from > to_))
      return {0., 0.};
    if (is_everywhere_ || edge_ == 0.)
      return {1., 0.};
    const double up   = largest_smooth_step_rate((from - from_) / edge_, (to - from_) / edge_),
                 down = largest_smooth_step_rate((to_ - to) / edge_, (to_ - from) / edge_);
    return {1., (up + down) / edge_};
  }

  std::vector<double>
  Window::ends() const
  {
    return is_everywhere_ ? std::vector<double>() : within({from_, to_}, end_);
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
