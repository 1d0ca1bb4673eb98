// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/files.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <string_view>
#include <utility>

namespace crawler
{
  namespace
  {
    constexpr int letter = 7; // tag of messages of send_to_first_rank()
  }

  unsigned int
  rank_of(MPI_Comm communicator)
  {
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    return static_cast<unsigned int>(rank);
  }

  unsigned int
  size_of(MPI_Comm communicator)
  {
    int size = 1;
    MPI_Comm_size(communicator, &size);
    return static_cast<unsigned int>(size);
  }

  bool
  is_true_anywhere(const bool is_true, MPI_Comm communicator)
  {
    int any = is_true;
    if (size_of(communicator) > 1)
      MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, communicator);
    return any != 0;
  }

  std::string
  broadcast(const std::string &text, MPI_Comm communicator)
  {
    unsigned long length = text.size();
    MPI_Bcast(&length, 1, MPI_UNSIGNED_LONG, 0, communicator);
    std::string result = text;
    result.resize(length);
    MPI_Bcast(result.data(), static_cast<int>(length), MPI_CHAR, 0, communicator);
    return result;
  }

  namespace
  {
    /// Gathers @p own of all ranks on rank 0, one behind the other, and writes there how long each is.
    template <typename List>
    List
    gathered(const List &own, std::vector<int> &lengths, const MPI_Datatype type, MPI_Comm communicator)
    {
      const int length = static_cast<int>(own.size());
      lengths.resize(rank_of(communicator) == 0 ? size_of(communicator) : 0);
      MPI_Gather(&length, 1, MPI_INT, lengths.data(), 1, MPI_INT, 0, communicator);
      std::vector<int> starts(lengths.size());
      std::exclusive_scan(lengths.begin(), lengths.end(), starts.begin(), 0);
      List all;
      all.resize(std::accumulate(lengths.begin(), lengths.end(), 0));
      MPI_Gatherv(own.data(), length, type, all.data(), lengths.data(), starts.data(), type, 0, communicator);
      return all;
    }
  } // namespace

  std::vector<std::string>
  gather(const std::string &text, MPI_Comm communicator)
  {
    std::vector<int> lengths;
    const std::string all = gathered(text, lengths, MPI_CHAR, communicator);
    std::vector<std::string> texts;
    std::size_t start = 0;
    for (const int length : lengths)
    {
      texts.push_back(all.substr(start, length));
      start += length;
    }
    return texts;
  }

  std::string
  first_text(const std::string &text, MPI_Comm communicator)
  {
    if (size_of(communicator) == 1 || !is_true_anywhere(!text.empty(), communicator))
      return text;
    const auto all = gather(text, communicator);
    const auto one = std::ranges::find_if(all, [](const std::string &its) { return !its.empty(); });
    return broadcast(one == all.end() ? "" : *one, communicator);
  }

  std::vector<double>
  gather(const std::vector<double> &numbers, MPI_Comm communicator)
  {
    std::vector<int> lengths;
    return size_of(communicator) == 1 ? numbers : gathered(numbers, lengths, MPI_DOUBLE, communicator);
  }

  std::string
  on_first_rank(MPI_Comm communicator, const std::function<std::string()> &action)
  {
    std::string kind = "done", text, entry;
    if (rank_of(communicator) == 0)
      try
      {
        text = action();
      }
      catch (const InputError &error)
      {
        kind  = "input";
        text  = error.what();
        entry = error.entry;
      }
      catch (const FileError &error)
      {
        kind = "file";
        text = error.what();
      }
      catch (const std::filesystem::filesystem_error &error)
      {
        kind = "file";
        text = in_words(error);
      }
    kind  = broadcast(kind, communicator);
    text  = broadcast(text, communicator);
    entry = broadcast(entry, communicator);
    if (kind == "input")
      throw InputError(text, entry);
    if (kind == "file")
      throw FileError(text, /*on_all_ranks=*/true);
    return text;
  }

  ExitCode
  exit_code_of_first_rank(MPI_Comm communicator, const std::function<ExitCode()> &action)
  {
    return static_cast<ExitCode>(
      std::stoi(on_first_rank(communicator, [&]() { return std::to_string(static_cast<int>(action())); })));
  }

  void
  send_to_first_rank(const std::string &text, MPI_Comm communicator)
  {
    MPI_Ssend(text.data(), static_cast<int>(text.size()), MPI_BYTE, 0, letter, communicator);
  }

  void
  take_from_others(MPI_Comm communicator, const std::function<void(const std::string &)> &keep)
  {
    int is_there = 0, size = 0;
    MPI_Status status;
    while (MPI_Iprobe(MPI_ANY_SOURCE, letter, communicator, &is_there, &status), is_there != 0)
    {
      MPI_Get_count(&status, MPI_BYTE, &size);
      std::string text(static_cast<std::size_t>(size), '\0');
      MPI_Recv(text.data(), size, MPI_BYTE, status.MPI_SOURCE, letter, communicator, MPI_STATUS_IGNORE);
      keep(text);
    }
  }

  QuickStart::QuickStart()
  {
    // Open MPI's "rdma" (4.1.4) takes seconds for each access to the counters of a WorkQueue between nodes connected
    // by TCP; "pt2pt" takes 0.1 ms.
    setenv("OMPI_MCA_osc", "^rdma", /*overwrite=*/0);
    constexpr std::string_view launchers[] = {
      "OMPI_COMM_WORLD_", "PMIX_", "PMI_", "SLURM_PROCID=", "SLURM_STEP_ID=", "FLUX_", "JSM_", "PALS_", "ALPS_"};
    for (char **variable = environ; *variable != nullptr; ++variable)
      for (const std::string_view launcher : launchers)
        if (std::string_view(*variable).starts_with(launcher))
          return;
    // Processes without a daemon would all use one session folder, which the first to end removes while another begins.
    constexpr std::pair<const char *, const char *> settings[] = {{"OMPI_MCA_ess_singleton_isolated", "1"},
                                                                  {"OMPI_MCA_orte_create_session_dirs", "0"},
                                                                  {"OMPI_MCA_btl", "self"},
                                                                  {"OMPI_MCA_pml", "ob1"}};
    // Shared memory for file pointers would need the daemon's folder. The variable is read when the first file is
    // opened, so it stays.
    setenv("OMPI_MCA_sharedfp", "^sm", /*overwrite=*/0);
    for (const auto &[name, value] : settings)
      if (std::getenv(name) == nullptr && setenv(name, value, /*overwrite=*/0) == 0)
        set_.push_back(name);
  }

  QuickStart::~QuickStart()
  {
    for (const char *const name : set_)
      unsetenv(name);
  }
} // namespace crawler
