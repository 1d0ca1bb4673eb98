// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/observer.h>
#include <crawler/studies/core/input.h>

#include <functional>

namespace crawler
{
  class ReducedModel;

  /// Times of the states of a level that needs no mesh. Without snapshots, the table of statistics has as many rows as
  /// there would be snapshots by default.
  PictureTimes
  times_without_mesh(const Input &input);

  /// Shows the states at @p times, with fields at @p points (parts of the length), to the @p observers, and ends them.
  /// Call after compute(). Returns false if @p keep_going returned false.
  bool
  show_pictures(const ReducedModel &level,
                const PictureTimes &times,
                const std::vector<double> &points,
                const Observers &observers,
                const std::function<bool()> &keep_going);
} // namespace crawler
