// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/picture_times.h>
#include <crawler/output/snapshot_files.h>
#include <crawler/studies/core/input.h>

#include <filesystem>
#include <functional>

namespace crawler
{
  class Kymograph;
  class ReducedModel;
  class Statistics;

  /// Viewers of the states of a level that needs no mesh; null where there is none.
  struct PictureViewers
  {
    std::function<void(const Frame &)> snapshots;
    Kymograph *kymograph;
    Statistics *statistics;
  };

  /// Times of these states. Without snapshots, the table of statistics has as many rows as there would be snapshots by
  /// default.
  PictureTimes
  times_without_mesh(const Input &input);

  /// Shows the states at @p times at equidistant points: one cell, the whole body. Call after compute(). Returns false
  /// if @p keep_going returned false.
  bool
  show_pictures(const ReducedModel &level,
                const PictureTimes &times,
                const PictureViewers &viewers,
                const std::function<bool()> &keep_going);

  /// Writes these states in the files of a run on a mesh. Call after compute(). Returns false if @p keep_going returned
  /// false.
  bool
  write_pictures(const ReducedModel &level,
                 const Input &input,
                 const std::filesystem::path &folder,
                 const std::function<bool()> &keep_going);
} // namespace crawler
