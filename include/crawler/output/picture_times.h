// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <vector>

namespace crawler
{
  struct OutputParameters;
  struct Scene;

  /// What a state is wanted for.
  struct PictureKinds
  {
    bool is_snapshot = false; ///< a frame for ParaView
    bool is_row      = false; ///< a row of the kymograph
  };

  /// When pictures of a run are wanted, as a list to be gone through once. Steps need not end at these times.
  class PictureTimes
  {
  public:
    struct Time
    {
      double value; ///< [time]
      PictureKinds kinds;
    };

    /// None.
    PictureTimes() = default;

    /// The initial state, and @p snapshots and @p rows of the kymograph in [0, @p end_time] [time]. Times that differ
    /// by round-off are one.
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
    /// Besides the initial state.
    std::size_t
    n_snapshots() const;

    /// The time of number @p i in units of the duration; 1 is the end, exactly.
    double
    natural(std::size_t i) const;

  private:
    std::vector<Time> times_;
    double end_time_ = 1.;
  };

  /**
   * The pictures that @p output wants of @p scene. Automatic snapshots are at equal intervals: 64 a stride, at least 64
   * and at most 640 in all; 256 if the stride is not declared. Automatic rows of the kymograph: 64 a stride and at
   * least 128 of the whole run, or of its last 20 strides if there are more; and before and after each jump of the
   * active stress, if these are not too many.
   */
  PictureTimes
  picture_times(const OutputParameters &output, const Scene &scene);
} // namespace crawler
