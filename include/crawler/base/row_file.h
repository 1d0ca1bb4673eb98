// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>

#include <hdf5.h>
#include <mpi.h>

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
  /// So many bytes of a UTF-8 @p text, at most @p width, are whole characters.
  std::size_t
  whole_characters(const std::string &text, std::size_t width);

  /// A text that is too long for this width ends with dots.
  std::string
  shortened(const std::string &text, std::size_t width);

  /**
   * A table in an HDF5 file into which all ranks write rows as they come (parallel HDF5). Its layout is fixed when it
   * is created: a group with a dataset for each column, contiguous and allocated, so later only numbers are written, no
   * structure, and a file whose writers were killed is a valid file with all rows that were written. A row that has not
   * been written has NaN in its numbers and empty texts. Each row that is written has a checksum.
   */
  class RowFile
  {
  public:
    struct Column
    {
      std::string name, unit, description;
      unsigned int width = 0; ///< 0: numbers; otherwise texts of at most so many bytes (UTF-8)
    };
    using Value = std::variant<double, std::string>; ///< texts that are too long are cut
    using Row   = std::vector<Value>;                ///< one for each column

    /// What the first columns have in their rows from the beginning.
    struct Known
    {
      std::size_t n_columns;
      std::function<Value(std::size_t column, unsigned long row)> value;
    };

    /// Creates the file: @p n_rows rows, empty but for what is @p known. @p attributes are those of the group @p group.
    /// Throws FileError.
    static void
    create(const std::filesystem::path &path,
           const std::string &group,
           const std::vector<Column> &columns,
           unsigned long n_rows,
           const std::map<std::string, std::string> &attributes,
           const Known &known = {});

    /// Opens a file that create() has made, for writing into these of its columns (collective, and so is the
    /// destructor). Throws FileError.
    RowFile(MPI_Comm communicator,
            const std::filesystem::path &path,
            const std::string &group,
            std::vector<Column> columns);
    ~RowFile();
    RowFile(const RowFile &) = delete;

    /// Writes rows @p first, first + 1, ... (this rank alone). The last column is written last, so whoever finds it
    /// there finds the others, too. Throws FileError.
    void
    write(unsigned long first, std::span<const Row> rows);

  private:
    struct Handles;
    const std::filesystem::path path_;
    const std::vector<Column> columns_;
    std::unique_ptr<Handles> handles_;
  };

  /// A whole table in such a file. Throws FileError.
  void
  write_hdf5(const std::filesystem::path &path,
             const std::string &group,
             const Table &table,
             const std::map<std::string, std::string> &attributes);

  /// Reads parts of a table that RowFile has made, so that a large one need not fit into the memory.
  class RowReader
  {
  public:
    /// Collective, and so is the destructor. Throws FileError if there is no such file, InputError if RowFile did not
    /// make it or it is damaged.
    RowReader(MPI_Comm communicator, const std::filesystem::path &path, const std::string &group);
    ~RowReader();
    RowReader(const RowReader &) = delete;

    unsigned long
    n_rows() const
    {
      return n_rows_;
    }
    std::size_t
    n_columns() const;

    /// The number of the column of this name. Throws FileError if there is none.
    std::size_t
    index_of(const std::string &name) const;

    /// @p n rows from row @p first on, of one column (by its number) or of all in the order in which they were made
    /// (this rank alone). Throws FileError.
    crawler::Column
    read(std::size_t number, unsigned long first, unsigned long n) const;
    Table
    read(unsigned long first, unsigned long n) const;

    /// Whether these rows have still what was written into them, the columns @p written (this rank alone). Nothing if
    /// the file has no checksums. Throws FileError.
    std::optional<std::vector<bool>>
    intact(const std::vector<RowFile::Column> &written, unsigned long first, unsigned long n) const;

  private:
    struct Handles;

    explicit RowReader(std::filesystem::path path);
    void
    open(hid_t access, const std::string &group);

    const std::filesystem::path path_;
    std::unique_ptr<Handles> handles_;
    Table columns_; ///< without values
    unsigned long n_rows_ = 0;
  };

  /// An attribute of the group. Throws FileError if there is no such file, InputError if there is no such attribute in
  /// it or it is damaged.
  std::string
  read_attribute(const std::filesystem::path &path, const std::string &group, const std::string &name);
} // namespace crawler
