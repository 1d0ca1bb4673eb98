// SPDX-License-Identifier: LGPL-2.1-or-later
//
// restart.dat of a run that is resumed. The first byte chooses what is given: the file itself, its content behind a
// checksum that is right, or the state of one of several runs, which then goes on for some steps.
#include <crawler/base/files.h>
#include <crawler/run/run_journal.h>
#include <crawler/studies/run/run_checkpoint.h>
#include <crawler/time/failure.h>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include <fstream>
#include <memory>

#include "../support/run_text.h"
#include "fuzz.h"

namespace
{
  using namespace crawler;

  /// A run that can be stopped, and what it leaves then.
  struct StoppedRun
  {
    explicit StoppedRun(const std::string &settings)
    {
      parameters = test::parameters_with(
        test::set("T = 20; cells = 4; tolerance = 1e-3; expression; Active stress = 0.1*sin(2*pi*(s+t)); " + settings));
      scene.emplace(parameters.create_scene());
      numerics = choose_numerics({parameters, *scene})->numerics;
      RunJournal journal(0., [&](const std::string &bytes) {
        left = bytes;
        return true;
      });
      go(journal, 5);
      journal.write();
      fuzz::require(!left.empty(), "the run was stopped before its end");
    }

    void
    go(RunJournal &journal, const unsigned int n_steps) const
    {
      unsigned int n = 0;
      Simulation simulation(MPI_COMM_SELF, *scene, parameters.time, numerics);
      const auto goes_on = [&]() { return ++n < n_steps; };
      simulation.run({}, {.energy_balance = true}, {}, KeepGoing(goes_on, &journal));
    }

    Parameters parameters;
    std::optional<Scene> scene;
    Numerics numerics;
    std::string left;
  };

  const std::vector<std::unique_ptr<const StoppedRun>> &
  runs()
  {
    static const auto all = []() {
      std::vector<std::unique_ptr<const StoppedRun>> list;
      for (const char *settings : {"",
                                   "Time/Engine = petsc",
                                   "integrator = bdf",
                                   "Discretization/Formulation = stretch",
                                   "Discretization/Mesh = adaptive; cells = automatic",
                                   "strain feedback; Active stress = 0.05*tanh(w_delayed-1+0.1*s); Delay = 0.3"})
        list.push_back(std::make_unique<StoppedRun>(settings));
      return list;
    }();
    return all;
  }

  std::string
  with_heading(const std::string &content)
  {
    boost::crc_32_type crc;
    crc.process_bytes(content.data(), content.size());
    return fmt::format("crawler state, {} bytes, CRC-32 {:08x}\n", content.size(), crc.checksum()) + content;
  }

  /// What `crawler run --resume` reads before it computes.
  void
  resume(fuzz::Bytes &bytes, const bool is_signed)
  {
    static const Input input       = read_input(ParameterFile::from_text("set Model = nonlinear", "scene.prm"));
    static RunCheckpoint own       = checkpoint_of(input, {});
    static const std::string whole = []() {
      own.journal         = runs()[0]->left;
      std::string content = archived(own);
      own.journal.clear();
      write_file(fuzz::scratch() / "parameters.prm", input.effective);
      write_file(fuzz::scratch() / "log.txt", "");
      return content;
    }();
    const std::string content =
      is_signed ? with_heading(fuzz::damaged(whole, bytes)) : fuzz::damaged(with_heading(whole), bytes);
    std::ofstream(fuzz::scratch() / "restart.dat", std::ios::binary) << content;
    const Resumption resumption = resumption_of(fuzz::scratch(), own);
    RunJournal journal(1e9, {});
    if (resumption.kind == Resumption::goes_on)
      journal.load(resumption.journal);
  }
} // namespace

int
LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  fuzz::start_mpi();
  fuzz::Bytes bytes(data, size);
  const std::size_t kind = bytes.number<std::uint8_t>() % (runs().size() + 2);
  fuzz::is_accepted([&]() {
    if (kind < 2)
      return resume(bytes, kind == 1);
    const StoppedRun &run = *runs()[kind - 2];
    RunJournal journal(1e9, {});
    journal.load(fuzz::damaged(run.left, bytes));
    try
    {
      run.go(journal, 20);
    }
    catch (...)
    {
      failure_of(std::current_exception()); // as the command does
    }
  });
  return 0;
}
