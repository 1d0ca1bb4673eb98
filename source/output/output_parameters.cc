// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/output/output_parameters.h>
#include <crawler/parameters/declarations.h>

namespace crawler
{
  void
  OutputParameters::add_parameters(Declarations &declarations)
  {
    declarations.whole_number("Number of snapshots", n_snapshots, 0, 1000000)
      .means("Number of snapshots for ParaView at equal time intervals until the end time, in addition to the initial "
             "state. 0: none, and no kymograph. Automatic: 64 for each stride, at least 64 and at most 640; 256 if the "
             "stride is not known.");
    declarations.choice("Snapshot format", snapshot_format)
      .means(
        "File format of the snapshots. vtu: solution.pvd and files for each snapshot in solution/. xdmf: solution.xdmf "
        "and solution.h5 with all snapshots, for long runs and for reading by Python, MATLAB or Octave.");
    declarations.flag("Kymograph", kymograph)
      .means(
        "Whether to write the fields over s and t to one file, in addition to snapshots. It has its own times: 64 for "
        "each stride and at least 128, of the last 20 strides if there are more, and each jump of the active stress.");
    declarations.flag("Statistics", statistics)
      .means(
        "Whether to write statistics.csv, with a row for each time step and each snapshot until the end of the run.");
    declarations.flag("Ledger", energy_balance)
      .means("Whether to compute works, energies and the net friction in every step, and to check that they balance.");
    declarations.number("Ledger tolerance", energy_balance_tolerance, positive(), "1")
      .means("Largest admissible residual of the energy balance, relative to the work that the active stress exchanges "
             "with the body; beyond it the run fails its self-check. Automatic: ten times Accuracy (300 times in the "
             "stretch form), at least 1e-8 (0.1 if Tolerance or integrator is set).");
    declarations.numbers("Active stress table", active_stress_table, "")
      .means("Numbers of samples over s and over t, like 65, 129, of the active stress that are written to "
             "active_stress.csv, which the generator table reads. Empty: no such file.");
    declarations.whole_number("Segment table", segment_table, 0, 1000000)
      .means("Number of equal parts of the duration in tables for the controller of a robot (Generator = segments): "
             "segments.csv has the active stress of each segment at the ends of these parts and wherever it jumps, "
             "segment_switching.csv the times when each segment is switched on and off. 0: no such files.");
    declarations.text("Sensitivities", sensitivities, "a list Section/Entry, Section/Entry, or the word \"all\"")
      .means("Entries with respect to which displacement and works are differentiated: numbers of the body, the "
             "ground, the active stress or the end time. How much each of them matters is written to summary.json, the "
             "screen and, along the body and over time, sensitivity_body.csv and sensitivity_stress.csv. all: all that "
             "have an effect. Empty: none.");
    declarations.text("Uncertainty", uncertainty, "a list like Section/Entry : 0.1; Section/Entry : 5 %")
      .means("Entries that are not known exactly, numbers as for Sensitivities, and their standard deviations, in "
             "their units or in per cent of their values. They give the standard deviation of the displacement and of "
             "the works, to first order and as if the entries were independent.");
  }
} // namespace crawler
