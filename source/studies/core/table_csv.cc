// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/row_file.h>
#include <crawler/studies/core/table_csv.h>

#include <algorithm>

namespace crawler
{
  namespace fs = std::filesystem;

  namespace
  {
    /// File to which all ranks write, each at its own places (MPI-IO). Nothing is thrown: good() is the same on all
    /// ranks.
    class SharedFile
    {
    public:
      SharedFile(MPI_Comm communicator, const fs::path &path)
        : communicator_(communicator)
      {
        is_good_ =
          MPI_File_open(communicator, path.c_str(), MPI_MODE_CREATE | MPI_MODE_WRONLY, MPI_INFO_NULL, &file_) ==
            MPI_SUCCESS &&
          MPI_File_set_size(file_, 0) == MPI_SUCCESS;
      }
      ~SharedFile()
      {
        if (file_ != MPI_FILE_NULL)
          MPI_File_close(&file_);
      }
      SharedFile(const SharedFile &) = delete;

      /// Appends the texts of all ranks in their order (collective).
      void
      append(const std::string &text)
      {
        const unsigned long size = text.size();
        unsigned long before = 0, total = 0;
        MPI_Exscan(&size, &before, 1, MPI_UNSIGNED_LONG, MPI_SUM, communicator_);
        MPI_Allreduce(&size, &total, 1, MPI_UNSIGNED_LONG, MPI_SUM, communicator_);
        if (is_good_)
        {
          MPI_Status status;
          int n    = 0;
          is_good_ = MPI_File_write_at(file_,
                                       static_cast<MPI_Offset>(end_ + (rank_of(communicator_) > 0 ? before : 0)),
                                       text.data(),
                                       static_cast<int>(size),
                                       MPI_CHAR,
                                       &status) == MPI_SUCCESS &&
                     MPI_Get_count(&status, MPI_CHAR, &n) == MPI_SUCCESS && n == static_cast<int>(size);
        }
        end_ += total;
      }

      bool
      good() const
      {
        int all = is_good_;
        MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, communicator_);
        return all != 0;
      }

      unsigned long
      size() const
      {
        return end_;
      }

    private:
      const MPI_Comm communicator_;
      MPI_File file_     = MPI_FILE_NULL;
      unsigned long end_ = 0;
      bool is_good_;
    };
  } // namespace

  void
  write_table_csv(MPI_Comm communicator,
                  const fs::path &table_path,
                  const std::string &group,
                  const fs::path &csv,
                  const std::function<void(const Table &part)> &see)
  {
    constexpr unsigned long together = 1024; // rows, about a megabyte
    fs::path temporary               = csv.string() + ".part";
    on_first_rank(communicator, [&]() {
      temporary = temporary_file(csv);
      return "";
    });
    const RowReader table(communicator, table_path, group);
    const unsigned long n_ranks = size_of(communicator), rank = rank_of(communicator);
    bool is_good;
    unsigned long size;
    {
      SharedFile file(communicator, temporary);
      is_good = file.good();
      if (is_good)
        file.append(rank == 0 ? csv_names(table.read(0, 0)) : "");
      for (unsigned long round = 0; is_good && round < table.n_rows(); round += n_ranks * together)
      {
        const unsigned long first = std::min(round + rank * together, table.n_rows());
        const Table part          = table.read(first, std::min(together, table.n_rows() - first));
        file.append(csv_rows(part));
        see(part);
        is_good = file.good();
      }
      size = file.size();
    }
    on_first_rank(communicator, [&]() {
      // Late errors of the file system show in the size.
      std::error_code error;
      if (!is_good || fs::file_size(temporary, error) != size)
      {
        fs::remove(temporary, error);
        throw FileError("cannot write \"" + csv.string() + "\" (is the disk full?)");
      }
      rename_whole(temporary, csv);
      return "";
    });
  }
} // namespace crawler
