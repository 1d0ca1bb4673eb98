// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/output/field_sampler.h>
#include <crawler/output/vtk_xml.h>

#include <fmt/format.h>

#include <cstring>

namespace crawler
{
  namespace
  {
    /// Number of bytes followed by the values, in base 64.
    template <typename Number>
    std::string
    encoded(const std::vector<Number> &values)
    {
      constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      const std::uint64_t size = values.size() * sizeof(Number);
      std::vector<unsigned char> bytes(sizeof(size) + size + 2, 0); // up to two more to fill the last three
      std::memcpy(bytes.data(), &size, sizeof(size));
      if (size > 0)
        std::memcpy(bytes.data() + sizeof(size), values.data(), size);
      const std::size_t n = sizeof(size) + size;
      std::string text((n + 2) / 3 * 4, '=');
      char *out = text.data();
      for (std::size_t i = 0; i < n; i += 3)
      {
        const unsigned int three = bytes[i] << 16 | bytes[i + 1] << 8 | bytes[i + 2];
        *out++                   = letters[three >> 18];
        *out++                   = letters[three >> 12 & 63];
        if (i + 1 < n)
          *out++ = letters[three >> 6 & 63];
        if (i + 2 < n)
          *out++ = letters[three & 63];
      }
      return text;
    }

    template <typename Number>
    std::string
    array(const char *type,
          const std::string &name,
          const std::vector<Number> &values,
          const unsigned int n_components,
          const std::string &unit)
    {
      std::string text = fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" NumberOfTuples=\"{}\" format=\"binary\">\n",
        type,
        name,
        n_components,
        values.size() / n_components);
      text += encoded(values);
      if (!unit.empty())
        text += "\n<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">" + unit + "</InformationKey>";
      return text + "\n</DataArray>\n";
    }
  } // namespace

  std::string
  vtk_array(const std::string &name,
            const std::vector<double> &values,
            const unsigned int n_components,
            const std::string &unit)
  {
    return array("Float64", name, values, n_components, unit);
  }

  std::string
  vtk_array(const std::string &name, const std::vector<std::int32_t> &values)
  {
    return array("Int32", name, values, 1, "");
  }

  std::string
  vtk_array(const std::string &name, const std::vector<std::uint8_t> &values)
  {
    return array("UInt8", name, values, 1, "");
  }

  std::string
  vtk_text(const std::string &name, const std::string &text)
  {
    std::string codes;
    for (const char letter : text)
      codes += fmt::format("{} ", static_cast<unsigned char>(letter));
    return fmt::format(
      "<Array type=\"String\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">\n{}0\n</Array>\n", name, codes);
  }

  std::string
  vtk_file(const std::string &type, const std::string &content)
  {
    return fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
                       "header_type=\"UInt64\">\n<{0}{1}</{0}>\n</VTKFile>\n",
                       type,
                       content);
  }

  std::string
  units_of_fields()
  {
    std::string text;
    for (const FieldName &field : field_names)
      text += fmt::format("{}{} [{}]", text.empty() ? "" : ", ", field.name, field.unit);
    return text;
  }
} // namespace crawler
