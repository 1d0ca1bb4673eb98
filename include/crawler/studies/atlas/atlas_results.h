// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>
#include <crawler/parameters/axis.h>
#include <crawler/studies/atlas/atlas_point.h>
#include <crawler/studies/sweep/point_table.h>

#include <mpi.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// Two axes.
  struct AtlasAxes
  {
    Axis first, second;

    unsigned long
    n_points() const
    {
      return first.values.size() * second.values.size();
    }
  };

  /// atlas.h5: a row for each point; the columns are a contract (doc/user_guide.md, "Atlas").
  PointTable
  atlas_table(const SweepPoints &points);

  /// The row of a point, in @p columns.
  RowFile::Row
  atlas_row(const std::vector<RowFile::Column> &columns, const AtlasPoint &point);

  /// The whole atlas in numbers.
  struct AtlasSummary
  {
    unsigned long points = 0; ///< asked for
    /// By what `crawler run` answers: finished, inverted, failed, stopped, refused.
    std::map<std::string, unsigned long> statuses;
    unsigned long checked              = 0; ///< points with two answers at least
    unsigned long silent_wrong_answers = 0;
    std::map<std::string, unsigned long> reasons; ///< of the answers that are not finished
    /// Measured error over the sum of the promised ones, largest over points and runs; not a number if none is known.
    double largest_error_ratio = AtlasRun::unknown;
    std::vector<std::string> wrong_answers; ///< in words, the first few

    unsigned long
    number(const std::string &status) const
    {
      const auto found = statuses.find(status);
      return found == statuses.end() ? 0 : found->second;
    }
    unsigned long
    computed() const
    {
      unsigned long n = 0;
      for (const auto &[status, count] : statuses)
        n += count;
      return n;
    }
  };

  /// Reads the table of the folder (one process).
  AtlasSummary
  summarize(const std::filesystem::path &folder, const AtlasAxes &axes);

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
