// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/scene/active_stress/profile.h>
#include <crawler/scene/active_stress/window.h>
#include <crawler/scene/breaks.h>

#include <fmt/format.h>

namespace crawler
{
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
      throw InputError(
        fmt::format("{} has {} numbers, but two, from and to, or none are expected", name, entries.interval.size()),
        entry);
    from_ = entries.interval[0];
    to_   = entries.interval[1];
    if (!(from_ < to_ && to_ > 0. && from_ < end))
      throw InputError(
        fmt::format("{} is from {:g} to {:g}, but two increasing numbers are expected, with a part of the "
                    "range from 0 to {:g} between them",
                    name,
                    from_,
                    to_,
                    end),
        entry);
    if (2. * edge_ > (to_ - from_) * (1. + 1e-12))
      throw InputError(
        fmt::format("the edges are {:g} wide, but at most {:g} is expected for a window from {:g} to {:g}",
                    edge_,
                    0.5 * (to_ - from_),
                    from_,
                    to_),
        fmt::format("{}Edge width in {}", section, variable));
  }

  double
  Window::value(const double x) const
  {
    if (is_everywhere_)
      return 1.;
    if (edge_ == 0.) // of two windows that meet only one has the place where they do
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
    if (is_everywhere_)
      return {1., 0.};
    if (to < from_ || from > to_)
      return {0., 0.};
    if (edge_ == 0.)
      return {1., 0.};
    const double up   = largest_smooth_step_rate((from - from_) / edge_, (to - from_) / edge_),
                 down = largest_smooth_step_rate((to_ - to) / edge_, (to_ - from) / edge_);
    return {1., (up + down) / edge_};
  }

  std::vector<double>
  Window::breaks() const
  {
    return edge_ == 0. ? ends() : std::vector<double>();
  }

  std::vector<double>
  Window::ends() const
  {
    return is_everywhere_ ? std::vector<double>() : within({from_, to_}, end_);
  }

  bool
  Window::is_whole() const
  {
    return is_everywhere_ || (from_ + edge_ <= 0. && to_ - edge_ >= end_);
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
