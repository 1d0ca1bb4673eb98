// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/base64.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/output/kymograph_reader.h>

#include <boost/algorithm/string/trim.hpp>
#include <boost/property_tree/xml_parser.hpp>

#include <cstdint>
#include <cstring>
#include <sstream>

namespace crawler
{
  namespace
  {
    /// The values of an array in base 64, which the number of their bytes precedes.
    std::vector<double>
    decoded(const boost::property_tree::ptree &array)
    {
      const std::vector<unsigned char> bytes = decode_base64(boost::trim_copy(array.data()));
      if (array.get<std::string>("<xmlattr>.type") != "Float64" || bytes.size() < sizeof(std::uint64_t))
        throw InputError("an array without numbers");
      std::vector<double> values((bytes.size() - sizeof(std::uint64_t)) / sizeof(double));
      std::memcpy(values.data(), bytes.data() + sizeof(std::uint64_t), values.size() * sizeof(double));
      return values;
    }

    /// Of the extent "0 200 0 64 0 0": the number of places and of times.
    std::pair<std::size_t, std::size_t>
    size_of_grid(const std::string &extent)
    {
      std::istringstream in(extent);
      long first = 0, last = -1, begin = 0, end = -1;
      in >> first >> last >> begin >> end;
      if (!in || last <= first || end <= begin)
        throw InputError("a grid without size");
      return {last - first + 1, end - begin + 1};
    }
  } // namespace

  KymographTable
  read_kymograph(const std::filesystem::path &path)
  {
    std::istringstream text(read_whole_file(path));
    try
    {
      boost::property_tree::ptree file;
      boost::property_tree::read_xml(text, file);
      const auto &piece             = file.get_child("VTKFile.StructuredGrid.Piece");
      const auto [n_places, n_rows] = size_of_grid(piece.get<std::string>("<xmlattr>.Extent"));
      const auto points             = decoded(piece.get_child("Points.DataArray"));
      if (points.size() != 3 * n_places * n_rows)
        throw InputError("another number of points than its grid");
      KymographTable kymograph;
      for (std::size_t i = 0; i < n_places; ++i)
        kymograph.places.push_back(points[3 * i]);
      for (std::size_t j = 0; j < n_rows; ++j)
        kymograph.times.push_back(points[3 * j * n_places + 1]);
      for (const auto &[word, array] : piece.get_child("PointData"))
        if (word == "DataArray")
        {
          kymograph.fields.emplace_back(array.get<std::string>("<xmlattr>.Name"), decoded(array));
          if (kymograph.fields.back().second.size() != n_places * n_rows)
            throw InputError("a field of another size than its grid");
        }
      for (const auto &[word, array] : file.get_child("VTKFile.StructuredGrid.FieldData"))
        if (const auto name = array.get<std::string>("<xmlattr>.Name", ""); name.starts_with(shown_prefix))
        {
          const auto range                                  = decoded(array);
          kymograph.shown[name.substr(shown_prefix.size())] = {range.at(0), range.at(1)};
        }
      return kymograph;
    }
    catch (const std::exception &)
    {
      throw InputError("\"" + path.string() + "\" is damaged: a whole kymograph that crawler wrote is expected");
    }
  }
} // namespace crawler
