// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/hdf5_calls.h>
#include <crawler/base/plain_numbers.h>
#include <crawler/base/row_file.h>
#include <crawler/base/stop_place.h>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace crawler
{
  namespace
  {
    /// Throws InputError if something that must be in the file is missing.
    template <typename Result>
    Result
    found(const Result result, const std::filesystem::path &path, const std::string &what)
    {
      if (result < 0)
        throw InputError(fmt::format(
          "\"{}\" {}: it is not a file of results that crawler wrote, or it is damaged; an intact one is expected",
          path.string(),
          what));
      return result;
    }

    /// Opens an HDF5 file for reading.
    hid_t
    opened(const std::filesystem::path &path, const hid_t access)
    {
      const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
      if (file >= 0)
        return file;
      errno = 0;
      std::ifstream in(path, std::ios::binary);
      if (!in)
        throw FileError(
          fmt::format("cannot open \"{}\": {}", path.string(), errno != 0 ? std::strerror(errno) : "unknown reason"));
      std::string start(8, '\0');
      in.read(start.data(), static_cast<std::streamsize>(start.size()));
      return found(file, path, start == "\x89HDF\r\n\x1a\n" ? "cannot be read as an HDF5 file" : "is not an HDF5 file");
    }

    /// Name of a dataset without "/", which HDF5 reserves for groups.
    std::string
    dataset_name(std::string name)
    {
      std::replace(name.begin(), name.end(), '/', '.');
      return name;
    }

    /// Reads an attribute that is one text, as write_attribute() makes it: others would not fit into the buffer.
    std::string
    read_attribute_of(const hid_t object, const std::string &name, const std::filesystem::path &path)
    {
      const Hdf5Handle attribute(
        found(H5Aopen(object, name.c_str(), H5P_DEFAULT), path, "has no attribute \"" + name + "\""), H5Aclose);
      const Hdf5Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
      const bool is_text =
        H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0 && H5Sget_simple_extent_npoints(space) == 1;
      found(is_text ? 0 : -1, path, "has an attribute \"" + name + "\" that is not text");
      constexpr std::size_t most = 1 << 28;
      found(H5Tget_size(type) <= most ? 0 : -1, path, "has an attribute \"" + name + "\" that is too long");
      std::string text(H5Tget_size(type), '\0');
      found(H5Aread(attribute, type, text.data()), path, "has an attribute \"" + name + "\" that cannot be read");
      return text.substr(0, text.find('\0'));
    }

    /// Throws InputError if @p read would crash HDF5, or never end, on the file.
    void
    require_harmless(const std::filesystem::path &path, const std::string &purpose, const std::function<void()> &read)
    {
      H5Eset_auto(H5E_DEFAULT, nullptr, nullptr); // our own message instead of HDF5's stack
      found(hdf5::is_harmless(path, purpose, read) ? 0 : -1, path, "makes HDF5 crash or hang");
    }

    /// Access of all ranks to a file.
    Hdf5Handle
    shared_access(MPI_Comm communicator, const std::filesystem::path &path)
    {
      H5Eset_auto(H5E_DEFAULT, nullptr, nullptr); // our own message instead of HDF5's stack
      Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
      hdf5::checked(H5Pset_fapl_mpio(access, communicator, MPI_INFO_NULL), path, "open");
      return access;
    }

    /// Writes rows @p first to @p first + @p n - 1 of a column; @p value gives the value of row @p first + i.
    template <typename Function>
    void
    write_values(const hid_t dataset,
                 const unsigned int width,
                 const unsigned long first,
                 const unsigned long n,
                 const Function &value,
                 const hid_t transfer,
                 const std::filesystem::path &path)
    {
      const Hdf5Handle type(width == 0 ? H5Tcopy(H5T_NATIVE_DOUBLE) : hdf5::text_type(width), H5Tclose);
      std::vector<char> data(n * (width == 0 ? sizeof(double) : width), '\0');
      for (unsigned long i = 0; i < n; ++i)
      {
        const RowFile::Value &one = value(i);
        if (width == 0)
          std::memcpy(&data[i * sizeof(double)], &std::get<double>(one), sizeof(double));
        else
        {
          const auto &text = std::get<std::string>(one);
          std::copy_n(
            text.begin(), whole_characters(text, width), data.begin() + static_cast<std::ptrdiff_t>(i * width));
        }
      }
      hdf5::Part(dataset, {first}, {n}).write(type, data.data(), path, transfer);
    }

    /// Length of a column, which must be complete: numbers or texts of fixed width, one-dimensional, with storage for
    /// each.
    std::size_t
    length_of(const hid_t dataset, const hid_t type, const std::string &name, const std::filesystem::path &path)
    {
      const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
      const bool is_column = (H5Tget_class(type) == H5T_FLOAT && H5Tget_size(type) == sizeof(double)) ||
                             (H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0);
      const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose);
      if (!is_column || H5Sget_simple_extent_ndims(space) != 1 || H5Pget_layout(creation) != H5D_CONTIGUOUS)
        found(-1, path, fmt::format("has a dataset \"{}\" that is not a column of a table", name));
      hsize_t n = 0;
      H5Sget_simple_extent_dims(space, &n, nullptr);
      std::error_code error;
      const hsize_t bytes = std::min<hsize_t>(H5Dget_storage_size(dataset), std::filesystem::file_size(path, error));
      if (error || bytes / H5Tget_size(type) < n)
        found(-1, path, fmt::format("has a dataset \"{}\" without room for all its values", name));
      return n;
    }

    const char *const checksums = "/checksums"; ///< of the rows, beside the group

    /// CRC-32 of the values of a row as stored, in the order of the columns written.
    class RowChecksum
    {
    public:
      void
      add(const RowFile::Value &value, const unsigned int width)
      {
        if (const auto *number = std::get_if<double>(&value))
          crc_.process_bytes(number, sizeof(double));
        else
        {
          const auto &text = std::get<std::string>(value);
          crc_.process_bytes(text.data(), whole_characters(text, width));
        }
      }

      double
      value() const
      {
        return crc_.checksum();
      }

    private:
      boost::crc_32_type crc_;
    };

    /// Creates the dataset of a column, with its values if they are known.
    void
    create_column(const std::filesystem::path &path,
                  const hid_t group,
                  const hid_t space,
                  const RowFile::Column &column,
                  const std::size_t number,
                  const unsigned long n_rows,
                  const RowFile::Known &known)
    {
      const bool is_known = number < known.n_columns;
      const Hdf5Handle type(column.width == 0 ? H5Tcopy(H5T_IEEE_F64LE) : hdf5::text_type(column.width), H5Tclose);
      const Hdf5Handle dataset(
        hdf5::create_dataset(group, dataset_name(column.name), type, space, /*is_filled=*/!is_known, path), H5Dclose);
      hdf5::write_attribute(dataset, "name", column.name, path);
      hdf5::write_attribute(dataset, "unit", column.unit, path);
      hdf5::write_attribute(dataset, "description", column.description, path);
      constexpr unsigned long together = 1 << 16;
      for (unsigned long first = 0; is_known && first < n_rows; first += together)
        write_values(
          dataset,
          column.width,
          first,
          std::min(together, n_rows - first),
          [&](const unsigned long i) { return known.value(number, first + i); },
          H5P_DEFAULT,
          path);
    }
  } // namespace

  double
  RowFile::bytes_of(const std::vector<Column> &columns,
                    const unsigned long n_rows,
                    const std::map<std::string, std::string> &attributes)
  {
    constexpr double bytes_of_column = 540.; // measured: structure, name, unit and description
    double bytes                     = static_cast<double>(n_rows * sizeof(double)); // checksums
    for (const Column &column : columns)
      bytes += bytes_of_column + static_cast<double>(n_rows * (column.width == 0 ? sizeof(double) : column.width));
    for (const auto &[name, text] : attributes)
      bytes += static_cast<double>(text.size());
    return bytes;
  }

  void
  RowFile::create(const std::filesystem::path &path,
                  const std::string &group_name,
                  const std::vector<Column> &columns,
                  const unsigned long n_rows,
                  const std::map<std::string, std::string> &attributes,
                  const Known &known)
  {
    H5Eset_auto(H5E_DEFAULT, nullptr, nullptr); // our own message instead of HDF5's stack
    hdf5::require_space(path, bytes_of(columns, n_rows, attributes));
    const std::filesystem::path temporary = temporary_file(path);
    try
    {
      const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
      H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18); // attributes may be larger than 64 KB
      const Hdf5Handle file(
        hdf5::checked(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), path, "create"), H5Fclose);
      const Hdf5Handle order(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
      H5Pset_link_creation_order(order, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
      const Hdf5Handle group(H5Gcreate(file, group_name.c_str(), H5P_DEFAULT, order, H5P_DEFAULT), H5Gclose);
      hdf5::checked(static_cast<hid_t>(group), path, "write");
      for (const auto &[name, text] : attributes)
        hdf5::write_attribute(group, name, text, path);
      const hsize_t size = n_rows;
      const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
      for (std::size_t number = 0; number < columns.size(); ++number)
        create_column(path, group, space, columns[number], number, n_rows, known);
      if (known.n_columns < columns.size())
      {
        const Hdf5Handle dataset(
          hdf5::create_dataset(file, checksums, H5T_IEEE_F64LE, space, /*is_filled=*/false, path), H5Dclose);
        hdf5::write_attribute(
          dataset, "description", "CRC-32 of what was written into each row, to detect damage", path);
      }
      hdf5::checked(H5Fflush(file, H5F_SCOPE_GLOBAL), path, "write");
    }
    catch (...)
    {
      std::error_code ignored;
      std::filesystem::remove(temporary, ignored);
      throw;
    }
    rename_whole(temporary, path);
  }

  struct RowFile::Handles
  {
    Hdf5Handle file, transfer;
    std::vector<Hdf5Handle> datasets;
    std::optional<Hdf5Handle> checksums;
  };

  RowFile::RowFile(MPI_Comm communicator,
                   const std::filesystem::path &path,
                   const std::string &group,
                   std::vector<Column> columns)
    : path_(path)
    , columns_(std::move(columns))
  {
    const Hdf5Handle access = shared_access(communicator, path);
    handles_.reset(new Handles{{hdf5::checked(H5Fopen(path.c_str(), H5F_ACC_RDWR, access), path, "open"), H5Fclose},
                               {H5Pcreate(H5P_DATASET_XFER), H5Pclose},
                               {},
                               std::nullopt});
    H5Pset_dxpl_mpio(handles_->transfer, H5FD_MPIO_INDEPENDENT);
    for (const Column &column : columns_)
    {
      const std::string name = "/" + group + "/" + dataset_name(column.name);
      handles_->datasets.emplace_back(hdf5::checked(H5Dopen(handles_->file, name.c_str(), H5P_DEFAULT), path, "open"),
                                      H5Dclose);
    }
    handles_->checksums.emplace(hdf5::checked(H5Dopen(handles_->file, checksums, H5P_DEFAULT), path, "open"), H5Dclose);
  }

  RowFile::~RowFile() = default;

  void
  RowFile::write(const unsigned long first, const std::span<const Row> rows)
  {
    if (rows.empty())
      return;
    const auto write = [&](const hid_t dataset, const unsigned int width, const auto &value) {
      write_values(dataset, width, first, rows.size(), value, handles_->transfer, path_);
    };
    for (std::size_t i = 0; i < columns_.size(); ++i)
    {
      if (i + 1 == columns_.size())
        write(*handles_->checksums, 0, [&](const unsigned long row) -> Value {
          RowChecksum checksum;
          for (std::size_t k = 0; k < columns_.size(); ++k)
            checksum.add(rows[row][k], columns_[k].width);
          return checksum.value();
        });
      write(handles_->datasets[i], columns_[i].width, [&](const unsigned long row) -> const Value & {
        return rows[row][i];
      });
    }
    reach(StopPlace::row, rows.size());
  }

  struct RowReader::Handles
  {
    Hdf5Handle file;
    std::vector<Hdf5Handle> datasets = {}, types = {};
    std::optional<Hdf5Handle> checksums = std::nullopt;
  };

  RowReader::RowReader(MPI_Comm communicator, const std::filesystem::path &path, const std::string &group_name)
    : RowReader(path, group_name, [&]() {
      on_first_rank(communicator,
                    [&]() { require_harmless(path, "table", [&]() { RowReader(path, group_name, H5P_DEFAULT); }); });
      return shared_access(communicator, path);
    }())
  {
  }

  RowReader::RowReader(const std::filesystem::path &path, const std::string &group_name, const hid_t access)
    : path_(path)
    , handles_(new Handles{{opened(path, access), H5Fclose}})
  {
    const Hdf5Handle group(
      found(H5Gopen(handles_->file, group_name.c_str(), H5P_DEFAULT), path, "has no group \"" + group_name + "\""),
      H5Gclose);
    H5G_info_t info;
    H5Gget_info(group, &info);
    for (hsize_t i = 0; i < info.nlinks; ++i)
    {
      char name[1024];
      found(H5Lget_name_by_idx(group, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, i, name, sizeof(name), H5P_DEFAULT),
            path,
            fmt::format("has no column {} in the order of creation", i + 1));
      const hid_t dataset = found(H5Dopen(group, name, H5P_DEFAULT), path, fmt::format("has no dataset \"{}\"", name));
      handles_->datasets.emplace_back(dataset, H5Dclose);
      handles_->types.emplace_back(H5Dget_type(dataset), H5Tclose);
      columns_.push_back({read_attribute_of(dataset, "name", path),
                          read_attribute_of(dataset, "unit", path),
                          read_attribute_of(dataset, "description", path),
                          {}});
      const std::size_t n = length_of(dataset, handles_->types.back(), name, path);
      if (i > 0 && n != n_rows_)
        found(-1, path, "has columns of different lengths");
      n_rows_ = n;
    }
    if (H5Lexists(handles_->file, checksums, H5P_DEFAULT) > 0)
    {
      handles_->checksums.emplace(
        found(H5Dopen(handles_->file, checksums, H5P_DEFAULT), path, "has no dataset of checksums"), H5Dclose);
      const Hdf5Handle type(H5Dget_type(*handles_->checksums), H5Tclose);
      if (length_of(*handles_->checksums, type, checksums, path) != n_rows_)
        found(-1, path, "has different numbers of checksums and rows");
    }
  }

  RowReader::~RowReader() = default;

  std::size_t
  RowReader::index_of(const std::string &name) const
  {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (columns_[i].name == name)
        return i;
    throw FileError(fmt::format("\"{}\" has no column \"{}\"", path_.string(), name));
  }

  crawler::Column
  RowReader::read(const std::size_t number, const unsigned long first, const unsigned long n) const
  {
    crawler::Column column = columns_[number];
    const hid_t dataset = handles_->datasets[number], type = handles_->types[number];
    const hdf5::Part part(dataset, {first}, {n});
    if (H5Tget_class(type) == H5T_STRING)
    {
      const std::size_t width = H5Tget_size(type);
      std::vector<char> data(n * width);
      part.read(type, data.data(), path_);
      std::vector<std::string> texts;
      texts.reserve(n);
      for (std::size_t i = 0; i < n; ++i)
        texts.emplace_back(&data[i * width], strnlen(&data[i * width], width));
      column.values = std::move(texts);
    }
    else
    {
      std::vector<double> numbers(n);
      part.read(H5T_NATIVE_DOUBLE, numbers.data(), path_);
      column.values = std::move(numbers);
    }
    return column;
  }

  std::optional<std::vector<bool>>
  RowReader::intact(const std::vector<RowFile::Column> &written, const unsigned long first, const unsigned long n) const
  {
    if (!handles_->checksums)
      return std::nullopt;
    std::vector<RowChecksum> found_checksums(n);
    for (const RowFile::Column &column : written)
    {
      const crawler::Column part = read(index_of(column.name), first, n);
      for (unsigned long row = 0; row < n; ++row)
        std::visit([&](const auto &values) { found_checksums[row].add(values[row], column.width); }, part.values);
    }
    std::vector<double> kept(n);
    hdf5::Part(*handles_->checksums, {first}, {n}).read(H5T_NATIVE_DOUBLE, kept.data(), path_);
    std::vector<bool> result;
    for (unsigned long row = 0; row < n; ++row)
      result.push_back(kept[row] == found_checksums[row].value());
    return result;
  }

  Table
  RowReader::read(const unsigned long first, const unsigned long n) const
  {
    Table table;
    for (std::size_t i = 0; i < columns_.size(); ++i)
      table.push_back(read(i, first, n));
    return table;
  }

  std::string
  read_attribute(const std::filesystem::path &path, const std::string &group_name, const std::string &name)
  {
    const auto read = [&]() {
      const Hdf5Handle file(opened(path, H5P_DEFAULT), H5Fclose);
      const Hdf5Handle group(
        found(H5Gopen(file, group_name.c_str(), H5P_DEFAULT), path, "has no group \"" + group_name + "\""), H5Gclose);
      return read_attribute_of(group, name, path);
    };
    require_harmless(path, name, read);
    return read();
  }
} // namespace crawler
