// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>
#include <crawler/parameters/axis.h>
#include <crawler/studies/atlas/atlas_point.h>

#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// Points as a text that another rank can read, and back.
  std::string
  pack(const std::vector<AtlasPoint> &points);
  std::vector<AtlasPoint>
  unpack(const std::string &text);

  /// Two axes, and the entries' units.
  struct AtlasAxes
  {
    Axis first, second;
    std::string first_unit, second_unit;

    unsigned long
    n_points() const
    {
      return first.values.size() * second.values.size();
    }
  };

  /// A row for each point; the columns are a contract (doc/user_guide.md, "Atlas").
  Table
  atlas_table(const std::vector<AtlasPoint> &points, const AtlasAxes &axes);

  /// The whole atlas in numbers.
  struct AtlasSummary
  {
    unsigned long points = 0; ///< asked for
    /// By what `crawler run` answers; they add up to the computed points.
    unsigned long finished = 0, inverted = 0, failed = 0, stopped = 0, refused = 0;
    unsigned long checked              = 0; ///< points with two answers at least
    unsigned long silent_wrong_answers = 0;
    std::map<std::string, unsigned long> reasons; ///< of the answers that are not finished
    /// Measured error over the sum of the promised ones, largest over points and runs; not a number if none is known.
    double largest_error_ratio = AtlasRun::unknown;

    unsigned long
    computed() const
    {
      return finished + inverted + failed + stopped + refused;
    }
  };

  AtlasSummary
  summarize(const std::vector<AtlasPoint> &points, const AtlasAxes &axes);

  /// The summary as a paragraph.
  std::string
  in_words(const AtlasSummary &summary, const AtlasAxes &axes, double seconds, unsigned int n_ranks);

  /// The text of summary.json.
  std::string
  atlas_json(const AtlasSummary &summary,
             const AtlasAxes &axes,
             const std::string &status,
             double seconds,
             unsigned int n_ranks,
             const std::string &command_line);
} // namespace crawler
