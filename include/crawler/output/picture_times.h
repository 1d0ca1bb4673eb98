// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace crawler
{
  struct OutputParameters;
  struct Scene;

  /// Pictures for which a state is needed.
  struct PictureKinds
  {
    bool is_snapshot = false; ///< a frame for ParaView
    bool is_row      = false; ///< a row of the kymograph
  };

  /// Times of the pictures of a run, traversed once. Steps need not end at these times.
  class PictureTimes
  {
  public:
    struct Time
    {
      double value; ///< [time]
      PictureKinds kinds;
    };

    /// Makes an empty list.
    PictureTimes() = default;

    /// Lists the initial state, and @p snapshots and @p rows of the kymograph in [0, @p end_time] [time]. Times that
    /// differ by round-off are merged.
    PictureTimes(const std::vector<double> &snapshots, const std::vector<double> &rows, double end_time);

    bool
    is_empty() const
    {
      return times_.empty();
    }
    const std::vector<Time> &
    all() const
    {
      return times_;
    }
    /// Number of snapshots besides the initial state.
    std::size_t
    n_snapshots() const;

    /// Time number @p i in units of the duration; 1 is the end, exactly.
    double
    natural(const std::size_t i) const
    {
      return times_[i].value == end_time_ ? 1. : times_[i].value / end_time_;
    }

  private:
    std::vector<Time> times_;
    double end_time_ = 1.;
  };

  /**
   * Times of the pictures of @p scene that @p output requests. Automatic snapshots are at equal intervals: 64 per
   * stride, at least 64 and at most 640 in all; 256 if the stride is not declared. Automatic rows of the kymograph: 64
   * per stride and at least 128 of the whole run, or of its last 20 strides if there are more; and before and after
   * each jump of the active stress, if these are not too many.
   */
  PictureTimes
  picture_times(const OutputParameters &output, const Scene &scene);
} // namespace crawler
