// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/stretch_history.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crawler
{
  const std::array<double, 6> &
  StretchHistory::places()
  {
    static const std::array<double, 6> list = []() {
      std::array<double, 6> result{};
      for (unsigned int i = 0; i < 6; ++i)
        result[i] = 0.5 - 0.5 * std::cos(std::numbers::pi * i / 5.);
      result[5] = 1.;
      return result;
    }();
    return list;
  }

  void
  StretchHistory::clear()
  {
    steps_.clear();
  }

  /// Steps on one mesh share its cells.
  void
  StretchHistory::exchange(Archive &archive)
  {
    if (archive.reads())
      steps_.clear();
    std::size_t n = steps_.size();
    archive(n);
    std::shared_ptr<const std::vector<Cell>> latest;
    for (std::size_t i = 0; i < n; ++i)
    {
      if (archive.reads())
        steps_.emplace_back();
      Step &step   = steps_[i];
      bool is_same = latest && step.cells == latest;
      archive(step.from, step.to, step.u, is_same);
      if (!is_same)
      {
        std::vector<Cell> cells = step.cells ? *step.cells : std::vector<Cell>();
        archive(cells);
        latest = archive.reads() ? std::make_shared<const std::vector<Cell>>(std::move(cells)) : step.cells;
      }
      if (archive.reads())
      {
        const std::size_t n_cells = latest ? latest->size() : 0,
                          degree  = n_cells > 0 ? (step.u[0].size() - 1) / n_cells : 0;
        archive.require(
          degree >= 1 && degree <= ReferenceElement::highest_degree &&
            std::ranges::all_of(step.u, [&](const auto &list) { return list.size() == n_cells * degree + 1; }),
          "the displacement of a step");
        step.cells   = latest;
        step.element = &reference_element(static_cast<unsigned int>(degree));
      }
    }
  }

  void
  StretchHistory::add(Step step, const double forget)
  {
    steps_.push_back(std::move(step));
    while (steps_.size() > 1 && steps_.front().to < forget)
      steps_.pop_front();
  }

  const StretchHistory::Step *
  StretchHistory::find(const double t) const
  {
    if (steps_.empty() || t < steps_.front().from)
      return nullptr;
    const auto found = std::lower_bound(
      steps_.begin(), steps_.end(), t, [](const Step &step, const double time) { return step.to < time; });
    return found == steps_.end() ? &steps_.back() : &*found;
  }

  void
  StretchHistory::displacement(const Step &step, const double t, std::vector<double> &u)
  {
    const double x = (t - step.from) / (step.to - step.from);
    u.assign(step.u[0].size(), 0.);
    for (unsigned int j = 0; j < 6; ++j)
    {
      double weight = 1.;
      for (unsigned int i = 0; i < 6; ++i)
        if (i != j)
          weight *= (x - places()[i]) / (places()[j] - places()[i]);
      for (std::size_t k = 0; k < u.size(); ++k)
        u[k] += weight * step.u[j][k];
    }
  }
} // namespace crawler
