// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>

#include <mpi.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace crawler
{
  /**
   * A table in an HDF5 file into which all ranks write rows as they come (parallel HDF5). Its layout is fixed at
   * creation: a group with a dataset for each column, contiguous and allocated. Later only numbers are written, no
   * structure, so a file whose writers were killed is valid and has all rows written before. Unwritten rows have NaN as
   * numbers and empty texts. Each written row has a checksum.
   */
  class RowFile
  {
  public:
    struct Column
    {
      std::string name, unit, description;
      unsigned int width = 0; ///< 0: numbers; otherwise texts of at most this number of bytes (UTF-8)
    };
    using Value = std::variant<double, std::string>; ///< texts that are too long are cut
    using Row   = std::vector<Value>;                ///< one for each column

    /// Values of the first columns in some rows, known at creation.
    struct Known
    {
      std::size_t n_columns;
      std::function<Value(std::size_t column, unsigned long row)> value;
    };

    /// Creates the file: @p n_rows rows, empty except for the @p known values. @p attributes belong to the group @p
    /// group. Throws FileError.
    static void
    create(const std::filesystem::path &path,
           const std::string &group,
           const std::vector<Column> &columns,
           unsigned long n_rows,
           const std::map<std::string, std::string> &attributes,
           const Known &known = {});

    /// About the size of the file that create() makes.
    static double
    bytes_of(const std::vector<Column> &columns,
             unsigned long n_rows,
             const std::map<std::string, std::string> &attributes);

    /// Opens a file made by create() for writing into the given columns (collective, as is the destructor). Throws
    /// FileError.
    RowFile(MPI_Comm communicator,
            const std::filesystem::path &path,
            const std::string &group,
            std::vector<Column> columns);
    ~RowFile();
    RowFile(const RowFile &) = delete;

    /// Writes rows @p first, first + 1, ... (this rank alone). The last column is written last: a row that has it is
    /// complete. Throws FileError.
    void
    write(unsigned long first, std::span<const Row> rows);

  private:
    struct Handles;
    const std::filesystem::path path_;
    const std::vector<Column> columns_;
    std::unique_ptr<Handles> handles_;
  };

  /// Reads parts of a table that RowFile has written; a large one need not fit into memory.
  class RowReader
  {
  public:
    /// Opens the file (collective, as is the destructor). Throws FileError if there is none, InputError if RowFile did
    /// not make it or it is damaged.
    RowReader(MPI_Comm communicator, const std::filesystem::path &path, const std::string &group);
    ~RowReader();
    RowReader(const RowReader &) = delete;

    unsigned long
    n_rows() const
    {
      return n_rows_;
    }

    /// Number of the column of this name. Throws FileError if there is none.
    std::size_t
    index_of(const std::string &name) const;

    /// Reads @p n rows from row @p first on, of one column (by its number) or of all in the order of their creation
    /// (this rank alone). Throws FileError.
    crawler::Column
    read(std::size_t number, unsigned long first, unsigned long n) const;
    Table
    read(unsigned long first, unsigned long n) const;

    /// Tells for each row whether its columns @p written are unchanged since they were written (this rank alone);
    /// nothing if the file has no checksums. Throws FileError.
    std::optional<std::vector<bool>>
    intact(const std::vector<RowFile::Column> &written, unsigned long first, unsigned long n) const;

  private:
    struct Handles;

    RowReader(const std::filesystem::path &path, const std::string &group, std::int64_t access);

    const std::filesystem::path path_;
    std::unique_ptr<Handles> handles_;
    Table columns_; ///< without values
    unsigned long n_rows_ = 0;
  };

  /// Reads an attribute of the group. Throws FileError if there is no such file, InputError if the attribute is missing
  /// or damaged.
  std::string
  read_attribute(const std::filesystem::path &path, const std::string &group, const std::string &name);
} // namespace crawler
