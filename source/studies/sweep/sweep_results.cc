// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/row_file.h>
#include <crawler/base/versions.h>
#include <crawler/studies/sweep/sweep_folder.h>
#include <crawler/studies/sweep/sweep_results.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace crawler
{
  namespace
  {
    namespace fs = std::filesystem;

    /// A file into which all ranks write at places of their own (MPI-IO). Nothing is thrown: good() tells, on all ranks
    /// the same.
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

      /// The texts of all ranks in their order, after what was written before (collective).
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

    void
    count(const Table &table, SweepCounts &counts)
    {
      for (const Column &column : table)
      {
        const auto *texts = std::get_if<std::vector<std::string>>(&column.values);
        if (texts == nullptr || (column.name != "status" && column.name != "reason"))
          continue;
        for (const std::string &text : *texts)
          if (column.name == "status")
            ++counts.statuses[text.empty() ? "missing" : text];
          else if (!text.empty())
            ++counts.reasons[text];
      }
    }

    /// The sum over all ranks, on rank 0.
    SweepCounts
    sum(MPI_Comm communicator, const SweepCounts &counts)
    {
      SweepCounts all;
      all.n_points              = counts.n_points;
      const nlohmann::json mine = {counts.statuses, counts.reasons};
      for (const std::string &text :
           gather(mine.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), communicator))
      {
        const auto json = nlohmann::json::parse(text);
        for (const auto &[name, n] : json[0].items())
          all.statuses[name] += n.get<unsigned long>();
        for (const auto &[name, n] : json[1].items())
          all.reasons[name] += n.get<unsigned long>();
      }
      return all;
    }
  } // namespace

  SweepCounts
  write_results_csv(MPI_Comm communicator, const fs::path &folder)
  {
    constexpr unsigned long together = 1024; // rows, about a megabyte
    const fs::path path = folder / "results.csv", temporary = folder / "results.csv.part";
    const RowReader table(communicator, folder / "results.h5", sweep_group);
    const unsigned long n_ranks = size_of(communicator), rank = rank_of(communicator);
    SweepCounts counts;
    counts.n_points = table.n_rows();
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
        count(part, counts);
        is_good = file.good();
      }
      size = file.size();
    }
    on_first_rank(communicator, [&]() {
      // What the file system says late is seen in the size.
      std::error_code error;
      if (!is_good || fs::file_size(temporary, error) != size)
      {
        fs::remove(temporary, error);
        throw FileError("cannot write \"" + path.string() + "\" (is the disk full?)");
      }
      fs::rename(temporary, path);
      return "";
    });
    return sum(communicator, counts);
  }

  unsigned long
  n_computed(const SweepCounts &counts, const SweepEnd &end)
  {
    const auto missing = counts.statuses.find("missing");
    return counts.n_points - end.n_before - (missing == counts.statuses.end() ? 0 : missing->second);
  }

  std::string
  sweep_json(const SweepCounts &counts, const SweepEnd &end)
  {
    const nlohmann::ordered_json json = {
      {"status", end.status},
      {"reason", end.reason.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(end.reason)},
      {"points", counts.n_points},
      {"computed", n_computed(counts, end)},
      {"statuses", counts.statuses},
      {"reasons", counts.reasons},
      {"seconds", end.seconds},
      {"ranks", end.n_ranks},
      {"versions", versions()},
      {"command_line", end.command_line}};
    return json.dump(2, ' ', /*ensure_ascii=*/false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  }
} // namespace crawler
