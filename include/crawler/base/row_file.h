// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>

#include <hdf5.h>
#include <mpi.h>

#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace crawler
{
  /**
   * A table in an HDF5 file into which all ranks write rows as they come (parallel HDF5). Its layout is fixed when it
   * is created: a group with a dataset for each column, contiguous and allocated, so later only numbers are written, no
   * structure, and a file whose writers were killed is a valid file with all rows that were written. A row that has not
   * been written has NaN in its numbers and empty texts.
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

    /// Creates the file: @p n_rows empty rows. @p attributes are those of the group @p group. Throws FileError.
    static void
    create(const std::filesystem::path &path,
           const std::string &group,
           const std::vector<Column> &columns,
           unsigned long n_rows,
           const std::map<std::string, std::string> &attributes);

    /// Opens a file that create() has made, for writing (collective, and so is the destructor). Throws FileError.
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

  /// All columns of the group of a file that RowFile or write_hdf5() has made, in the order in which they were made
  /// (one process). Throws FileError.
  Table
  read_table(const std::filesystem::path &path, const std::string &group);

  /// One column of texts. Throws FileError if there is none of this name.
  std::vector<std::string>
  read_texts(const std::filesystem::path &path, const std::string &group, const std::string &column);

  /// An attribute of the group; FileError if there is none.
  std::string
  read_attribute(const std::filesystem::path &path, const std::string &group, const std::string &name);
} // namespace crawler
