// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/app/table_command.h>
#include <crawler/base/communication.h>

#include <CLI/CLI.hpp>

#include <type_traits>

namespace crawler
{
  TableCommand::TableCommand(CLI::App &app)
    : command_(
        app.add_subcommand("table", "Turns measured samples or tracks of markers into a table that a scene reads"))
  {
    SampleSettings &samples  = options_.samples;
    PreparationSettings &how = options_.preparation;
    const auto number        = [&](const char *name, auto &value, const char *description) {
      command_->add_option(name, value, description)
        ->type_name(std::is_integral_v<std::remove_cvref_t<decltype(value)>> ? "WHOLE NUMBER" : "NUMBER");
    };
    const auto text = [&](const char *name, std::string &value, const char *description) {
      command_->add_option(name, value, description)->type_name("TEXT");
    };
    command_->add_option("IN", options_.input, "Measured samples: s, t, m; or t, marker, x; or t and a column for each")
      ->required();
    command_->add_option("OUT", options_.output, "The table to be written, NAME.csv")->required();
    text("--quantity", samples.quantity, "m, strain, stretch or markers (default: by the names of columns)");
    text("--columns", samples.columns, "Other names of columns: \"t=Frame time, x=X\"");
    text("--unit-of-s", samples.unit_of_s, "Factor of s and x, or the unit they are turned into: mm");
    text("--unit-of-t", samples.unit_of_t, "The same for t");
    text("--unit-of-m", samples.unit_of_value, "The same for m (may be negative) or strain");
    text("--shift-s", samples.shift_s, "Is added to s; \"first\": the first s becomes 0");
    text("--shift-t", samples.shift_t, "The same for t");
    number("--gap", how.largest_gap, "Largest number of samples in a row that are filled in (default: 3)");
    number("--smooth-t", how.width_t, "Width of the smoothing in t: waves of this length are halved (default: 0)");
    number("--smooth-s", how.width_s, "The same in s");
    text("--period", how.period, "find, whole or a number: makes one cycle of all, that closes");
    number("--cycles", how.n_cycles, "How often the cycle is written (default: 1)");
    number("--points-s", how.n_s, "Equally spaced places of the table (default: those of the samples; markers: 33)");
    number("--points-t", how.n_t, "Equally spaced times of the table (default: those of the samples)");
    text("--markers-at", how.material, "Material coordinates: first (frame; default), mean, or a list of numbers");
    number("--first-marker", how.first_marker, "s of the first marker (default: 0)");
    number("--length", how.length, "Length of the body (default: up to the last marker)");
    text("--ends", how.ends, "Strain beyond the outermost markers: hold (default) or linear");
    number("--noise", how.noise, "Standard deviation of a sample, in units of the table (default: estimated)");
    text(
      "--scene", options_.scene, "Parameter file that uses the table: how uncertain the noise makes its displacement");
    command_->add_option("--set", options_.overrides, "Sets an entry of it: \"Section/Entry=value\" (repeatable)")
      ->allow_extra_args(false)
      ->take_all();
    number("--copies", options_.n_copies, "Noisy copies from which that is found (default: 64)");
    number("--seed", options_.seed, "Of their random numbers (default: 1)");
    command_->add_flag("--overwrite", options_.overwrite, "Replaces OUT");
    command_->add_flag("--quiet", options_.quiet, "Prints nothing but errors");
  }

  ExitCode
  TableCommand::operator()(MPI_Comm communicator) const
  {
    if (rank_of(communicator) == 0)
      make_table(options_);
    return ExitCode::finished;
  }
} // namespace crawler
