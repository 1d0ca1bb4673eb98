// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/scene/active_stress.h>
#include <crawler/scene/breaks.h>

namespace crawler
{
  namespace
  {
    /// Breaks in (0, @p size), in units of @p size, ascending and at least @p gap apart.
    std::vector<double>
    distinct(std::vector<double> breaks, const double size, const double gap)
    {
      std::sort(breaks.begin(), breaks.end());
      std::vector<double> result;
      for (const double place : breaks)
      {
        const double x = place / size;
        if (x > gap && x < 1. - gap && (result.empty() || x > result.back() + gap))
          result.push_back(x);
      }
      return result;
    }
  } // namespace

  std::vector<double>
  within(std::vector<double> places, const double end)
  {
    constexpr double round_off = 1e-12;
    std::erase_if(places, [end](const double x) { return !(x > round_off * end && x < (1. - round_off) * end); });
    return places;
  }

  std::vector<double>
  distinct_breaks_in_space(std::vector<double> places, const double length)
  {
    std::vector<double> breaks = distinct(std::move(places), length, min_space_between_breaks);
    for (double &s : breaks)
      s *= length;
    return breaks;
  }

  std::vector<double>
  with_echoes(std::vector<double> places, const StretchFeedback::Facts &facts, const double length)
  {
    // Distances, as parts of the body, below which places would not be worth their cells, and numbers of echoes. A
    // sensor below the second distance is a point; the echoes by others are smoother, and have none.
    constexpr double shortest = 1e-3, shortest_from_ends = 0.05;
    constexpr unsigned int of_point = 20, most = 300;
    const double d     = facts.distance,
                 half  = facts.sensor_length >= shortest_from_ends * length ? 0.5 * facts.sensor_length : 0.,
                 reach = std::max(std::abs(d), 2. * half) / length;
    if (reach >= shortest_from_ends) // where the feedback, or an end of its sensor, comes to an end of the body
      places.insert(places.end(), {(d > 0. || half > 0. ? length : 0.) - d - half, half - d});
    std::vector<double> latest = within(places, length);
    for (unsigned int i = 0; i < (half > 0. ? 1 : of_point) && reach >= shortest; ++i)
    {
      std::vector<double> next;
      for (const double s : latest)
        for (const double centre : {s - half, s + half}) // of a sensor that is not moved inside
          if (centre >= half && centre <= length - half)
            next.push_back(centre - d);
      latest = distinct_breaks_in_space(std::move(next), length);
      if (places.size() + latest.size() > most)
        break;
      places.insert(places.end(), latest.begin(), latest.end());
    }
    return places;
  }

  std::vector<double>
  off_breaks_at_ends(std::vector<double> points, const std::vector<double> &breaks, const double length)
  {
    const double off = 1e-12 * length;
    double first = 0., last = length;
    for (const double s : breaks)
    {
      if (s < off)
        first = off;
      if (s > length - off)
        last = length - off;
    }
    for (double &s : points)
      s = std::clamp(s, first, last);
    return points;
  }

  TimeSegments::TimeSegments(const ActiveStress &stress, const double end_time)
  {
    std::vector<double> breaks = stress.breaks_in_time();
    if (const auto *feedback = stress.feedback(); feedback != nullptr && feedback->facts.delay > 0.)
    {
      constexpr unsigned int most_echoes = 6, most = 1000; // each is smoother than the one before
      std::vector<double> heard = breaks;
      heard.push_back(0.); // the past begins there
      for (unsigned int i = 1; i <= most_echoes && breaks.size() + heard.size() <= most; ++i)
        for (const double t : heard)
          if (const double echo = t + i * feedback->facts.delay; echo < end_time)
            breaks.push_back(echo);
    }
    clamps_ = !breaks.empty();
    breaks_ = distinct(std::move(breaks), end_time, min_time_between_breaks);
    set_limits();
  }

  /// Sets the limits of the present piece; merged breaks are at most d later than the one kept.
  void
  TimeSegments::set_limits()
  {
    if (piece_ > breaks_.size())
      throw FileError("a saved state does not match the program: its piece of time is missing");
    if (!clamps_)
      return;
    from_ = (piece_ == 0 ? 0. : breaks_[piece_ - 1]) + 2. * min_time_between_breaks;
    to_   = std::max(from_, end() - min_time_between_breaks);
  }
} // namespace crawler
