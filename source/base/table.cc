// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/hdf5_handle.h>
#include <crawler/base/table.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace crawler
{
  namespace
  {
    using Numbers = std::vector<double>;
    using Texts   = std::vector<std::string>;

    void
    append(const std::string &text, fmt::memory_buffer &out)
    {
      if (text.find_first_of(",\"\r\n") == std::string::npos)
      {
        out.append(text);
        return;
      }
      out.push_back('"');
      for (const char c : text)
      {
        if (c == '"')
          out.push_back('"');
        out.push_back(c);
      }
      out.push_back('"');
    }

    void
    append(const Column &column, const std::size_t row, fmt::memory_buffer &out)
    {
      if (const auto *texts = std::get_if<Texts>(&column.values))
        append((*texts)[row], out);
      else if (const double value = std::get<Numbers>(column.values)[row]; !std::isnan(value))
        fmt::format_to(std::back_inserter(out), "{}", value);
    }

    std::size_t
    size_of(const Column &column)
    {
      return std::visit([](const auto &values) { return values.size(); }, column.values);
    }

    /// Throws FileError if HDF5 says that a call went wrong.
    template <typename Result>
    Result
    hdf5(const Result result)
    {
      if (result < 0)
        throw FileError("HDF5 cannot write the table (is the disk full?)");
      return result;
    }

    /// An object that must have been opened.
    class Handle : public Hdf5Handle
    {
    public:
      Handle(const hid_t id, herr_t (*close)(hid_t))
        : Hdf5Handle(hdf5(id), close)
      {
      }
    };

    /// Texts of any length in UTF-8: what h5py calls str.
    Handle
    text_type()
    {
      const hid_t type = hdf5(H5Tcopy(H5T_C_S1));
      H5Tset_size(type, H5T_VARIABLE);
      H5Tset_cset(type, H5T_CSET_UTF8);
      return {type, H5Tclose};
    }

    void
    write_attribute(const hid_t object, const std::string &name, const std::string &text)
    {
      const Handle type = text_type(), space(H5Screate(H5S_SCALAR), H5Sclose);
      const Handle attribute(H5Acreate(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      const char *const value = text.c_str();
      hdf5(H5Awrite(attribute, type, &value));
    }

    void
    write_column(const hid_t group, const Column &column)
    {
      std::string name = column.name;
      std::replace(name.begin(), name.end(), '/', '.');
      const hsize_t size = size_of(column);
      const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
      const auto write = [&](const hid_t type, const void *values) {
        const Handle dataset(H5Dcreate(group, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Dclose);
        if (size > 0)
          hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
        write_attribute(dataset, "name", column.name);
        write_attribute(dataset, "unit", column.unit);
        write_attribute(dataset, "description", column.description);
      };
      if (const auto *numbers = std::get_if<Numbers>(&column.values))
        write(H5T_NATIVE_DOUBLE, numbers->data());
      else
      {
        std::vector<const char *> pointers;
        for (const std::string &text : std::get<Texts>(column.values))
          pointers.push_back(text.c_str());
        write(text_type(), pointers.data());
      }
    }
  } // namespace

  std::string
  csv_names(const Table &table)
  {
    fmt::memory_buffer text;
    for (std::size_t i = 0; i < table.size(); ++i)
    {
      if (i > 0)
        text.push_back(',');
      append(table[i].name, text);
    }
    text.push_back('\n');
    return fmt::to_string(text);
  }

  std::string
  csv_rows(const Table &table)
  {
    fmt::memory_buffer text;
    for (std::size_t row = 0; row < (table.empty() ? 0 : size_of(table[0])); ++row)
    {
      for (std::size_t i = 0; i < table.size(); ++i)
      {
        if (i > 0)
          text.push_back(',');
        append(table[i], row, text);
      }
      text.push_back('\n');
    }
    return fmt::to_string(text);
  }

  std::string
  csv(const Table &table)
  {
    return csv_names(table) + csv_rows(table);
  }

  void
  write_hdf5(const std::filesystem::path &path,
             const std::string &group_name,
             const Table &table,
             const std::map<std::string, std::string> &attributes)
  {
    H5Eset_auto(H5E_DEFAULT, nullptr, nullptr); // our own sentence instead of HDF5's stack
    const std::filesystem::path temporary = path.string() + ".part";
    {
      const hid_t id = H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
      if (id < 0)
        throw FileError("cannot write \"" + path.string() + "\"");
      const Handle file(id, H5Fclose);
      const Handle group(H5Gcreate(file, group_name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
      write_attribute(group, "not known", "NaN in numbers, an empty text in texts");
      for (const auto &[name, text] : attributes)
        write_attribute(group, name, text);
      for (const Column &column : table)
        write_column(group, column);
      hdf5(H5Fflush(file, H5F_SCOPE_LOCAL));
    }
    std::error_code error;
    std::filesystem::rename(temporary, path, error);
    if (error)
      throw FileError("cannot write \"" + path.string() + "\": " + error.message());
  }
} // namespace crawler
