// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace crawler
{
  /// A DataArray of VTK's XML files in base 64 (header_type UInt64), with the unit as VTK keeps it (UNITS_LABEL).
  std::string
  vtk_array(const std::string &name,
            const std::vector<double> &values,
            unsigned int n_components = 1,
            const std::string &unit   = "");
  std::string
  vtk_array(const std::string &name, const std::vector<std::int32_t> &values);
  std::string
  vtk_array(const std::string &name, const std::vector<std::uint8_t> &values);

  /// A text as field data.
  std::string
  vtk_text(const std::string &name, const std::string &text);

  /// A whole file of the type UnstructuredGrid, StructuredGrid, ...
  std::string
  vtk_file(const std::string &type, const std::string &content);

  /// Names and units of all fields in a sentence, as field data of pictures.
  std::string
  units_of_fields();
} // namespace crawler
