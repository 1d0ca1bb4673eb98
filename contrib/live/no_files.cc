// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Tables in files, which a page in a browser does not have: refused in a sentence.
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_table.h>

namespace crawler
{
  namespace
  {
    [[noreturn]] void
    refuse(const std::string &entry)
    {
      throw InputError("\"" + entry + "\" names a file, " CRAWLER_LEFT_OUT, entry);
    }
  } // namespace

  GridTable
  read_grid_table(const std::string &, const std::string &, const std::string &entry)
  {
    refuse(entry);
  }
  void
  require_number_of_values(
    const std::vector<double> &, std::size_t, const std::string &, const std::string &, const std::string &entry)
  {
    refuse(entry);
  }
  void
  reach_ends(std::vector<double> &,
             double,
             const std::string &,
             const std::string &,
             const std::string &,
             const std::string &entry)
  {
    refuse(entry);
  }
} // namespace crawler
