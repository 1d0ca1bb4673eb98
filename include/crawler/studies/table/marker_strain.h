// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/table/preparation_settings.h>
#include <crawler/studies/table/samples.h>

namespace crawler
{
  /**
   * The strain dx/ds - 1 of tracks x_i(t) without gaps, at equally spaced places s over the whole body, by a spline
   * over the material coordinates of the markers for each time (smoothed with the width in s). Beyond the outermost
   * markers it is held or goes on linearly. What was done is added to @p words. Throws InputError.
   */
  Samples
  strain_of_tracks(const Samples &tracks, const PreparationSettings &settings, std::vector<std::string> &words);
} // namespace crawler
