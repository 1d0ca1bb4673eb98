// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/deal_ii_library.h>
#include <crawler/mesh/triangulation.h>

namespace crawler
{
  std::unique_ptr<Triangulation>
  create_triangulation(MPI_Comm communicator, const std::vector<double> &ends)
  {
    return std::unique_ptr<Triangulation>(
      deal_ii_function<CreateTriangulation>("crawler_create_triangulation")(communicator, ends));
  }
} // namespace crawler
