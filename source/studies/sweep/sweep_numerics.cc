// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/studies/sweep/sweep_numerics.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    /// Fewest points that are worth a search.
    constexpr unsigned long fewest = 6;
    /// Numbers of examples of a block, and of one that has fewer points than many.
    constexpr std::size_t n_examples = 5, n_examples_of_few = 3;
    constexpr unsigned long many = 48;

    /// Square of the distance of two places.
    double
    distance(const std::vector<double> &a, const std::vector<double> &b, const std::vector<double> &spread)
    {
      double sum = 0.;
      for (std::size_t i = 0; i < a.size(); ++i)
        if (spread[i] > 0.)
          sum += std::pow((a[i] - b[i]) / spread[i], 2);
      return sum;
    }

    /// Indices of @p n places: the first, and then always the one farthest from all before.
    std::vector<std::size_t>
    far_apart(const std::vector<std::vector<double>> &places, const std::vector<double> &spread, const std::size_t n)
    {
      std::vector<std::size_t> chosen = {0};
      std::vector<double> nearest(places.size(), std::numeric_limits<double>::infinity());
      while (chosen.size() < n)
      {
        for (std::size_t i = 0; i < places.size(); ++i)
          nearest[i] = std::min(nearest[i], distance(places[i], places[chosen.back()], spread));
        const auto farthest = std::max_element(nearest.begin(), nearest.end());
        if (!(*farthest > 0.))
          break;
        chosen.push_back(static_cast<std::size_t>(farthest - nearest.begin()));
      }
      return chosen;
    }
  } // namespace

  /// Coordinates of a point on axes of numbers; other axes have none.
  std::vector<double>
  SweepNumerics::place(const unsigned long point) const
  {
    const SweepDesign &design = points_.design();
    std::vector<double> place;
    for (std::size_t axis = 0; axis < design.axes().size(); ++axis)
    {
      const double x = to_number(design.value(axis, point)).value_or(0.);
      place.push_back(design.axes()[axis].is_logarithmic && x > 0. ? std::log(x) : x);
    }
    return place;
  }

  SweepNumerics::Known
  SweepNumerics::measure(const SweepBlock &part, const std::function<bool()> &keep_going) const
  {
    Known known;
    if (part.size < fewest || !are_shared(points_))
      return known;
    std::vector<std::vector<double>> places;
    for (unsigned long i = 0; i < part.size; ++i)
      places.push_back(place(part.first + i));
    for (std::size_t axis = 0; axis < places.front().size(); ++axis)
    {
      const auto [least, most] = std::minmax_element(
        places.begin(), places.end(), [axis](const auto &a, const auto &b) { return a[axis] < b[axis]; });
      known.spread.push_back((*most)[axis] - (*least)[axis]);
    }
    std::vector<Task> examples;
    for (const std::size_t i : far_apart(places, known.spread, part.size < many ? n_examples_of_few : n_examples))
    {
      examples.push_back(task(part.first + i));
      known.places.push_back(std::move(places[i]));
    }
    known.choice = shared_numerics(examples, keep_going);
    return known;
  }

  SweepNumerics::Shared
  SweepNumerics::at(const SweepBlock &block, const unsigned long point, const std::function<bool()> &keep_going)
  {
    if (block_ != block.first)
      known_.clear();
    block_ = block.first;
    for (SweepBlock part = block;;)
    {
      const auto key = std::pair(part.first, part.size);
      auto found     = known_.find(key);
      if (found == known_.end())
        found = known_.emplace(key, measure(part, keep_going)).first;
      if (found->second.choice || part.size < 2 * fewest)
        return {part, found->second.choice ? &*found->second.choice : nullptr};
      const unsigned long half = part.size / 2;
      part = point < part.first + half ? SweepBlock{part.first, half} : SweepBlock{part.first + half, part.size - half};
    }
  }

  double
  SweepNumerics::size_at(const Shared &shared, const unsigned long point)
  {
    const Known &known             = known_.at({shared.points.first, shared.points.size});
    const std::vector<double> here = place(point);
    double sum = 0., weights = 0.;
    for (std::size_t i = 0; i < known.places.size(); ++i)
    {
      constexpr double near = 1e-6;
      const double weight   = 1. / (near + distance(here, known.places[i], known.spread));
      sum += weight * std::log(known.choice->sizes[i]);
      weights += weight;
    }
    return std::exp(sum / weights);
  }
} // namespace crawler
