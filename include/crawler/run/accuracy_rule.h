// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>

/**
 * All constants of the rules by which the program chooses its numerics and bounds their errors, each with its meaning
 * and, for each group, where it was measured. Lengths, times and errors are relative or in natural units where nothing
 * else is said. Whoever changes one runs the study of its group again.
 */
namespace crawler::accuracy_rule
{
  /// Floor of the displacement for relative errors, as a part of the body's largest deformation [1].
  inline constexpr double displacement_floor = 1e-4;

  // Choice of degree, cells and tolerance (mesh_choices.h; doc/numerics.md, sections on the choice). Measured by
  // tests/verification/calibration.cc and tests/benchmark/setting_search.cc.
  namespace choice
  {
    inline constexpr unsigned int automatic_degree = 6;
    inline constexpr unsigned int min_cells = 4, max_cells = 4096;
    /// Stretch below which a pilot that breaks off has lost it.
    inline constexpr double emptied = 0.1;
    /// Limit on the cells of uniform meshes of pilots; degree of adaptive meshes.
    inline constexpr unsigned int max_uniform_cells = 1024, adaptive_degree = 4;
    /// Factor on the sum of the error indicators over the strain: a bound of the relative error of the displacement.
    inline constexpr double indicator_factor = 8.;
    /// Stretch form: cells of the coarsest mesh, cells for each length in which the active stress changes, and the time
    /// tolerance relative to the strain, as a multiple of Accuracy and at most.
    inline constexpr unsigned int first_family_cells = 25;
    inline constexpr double cells_of_length = 4., family_tolerance = 10., largest_family_tolerance = 1e-3;
    /// Layers of the stretch form: layer_lengths times k/max|m_s| thick, at most this part of the body.
    inline constexpr double layer_lengths = 1., largest_layer = 0.02;
    inline constexpr unsigned int max_pilot_steps = 100000, max_adaptive_pilot_steps = 20000,
                                  max_adaptive_pilot_cells = 1200;
    /// Relative accuracy of the displacement for pilots that end when their cycles repeat.
    inline constexpr double pilot_accuracy = 1e-2;
    /// Limit of `unresolved` below which a pilot's mesh is good enough to predict others.
    inline constexpr double resolved = 1e-3;
    /// Thickness, in distances between the unknowns, below which layers may look resolved when they are not.
    inline constexpr double widest_hidden_layer = 1.;
    /// Factor on `unresolved` of the mesh: a bound of the relative error of the displacement in space.
    inline constexpr double space_factor = 6.;
    /// Factor on the number of steps times the tolerance: a bound of the error of the displacement in time.
    inline constexpr double time_factor = 0.25;
    /// Factors on that tolerance for radau 5 and 9 on uniform meshes of the position form, whose steps end better.
    inline constexpr double radau_5_superconvergence = 50., radau_9_superconvergence = 2000.;
    /// Smallest tolerances relative to the motion; below the second, kinks in the friction of stiff bodies stop a run.
    inline constexpr double min_tolerance = 1e-15, min_tolerance_if_kinks = 1e-10;
    /// Accuracy below which runs on uniform meshes are by radau 9, others by radau 5.
    inline constexpr double radau_9_accuracy = 1.1e-4;
    /// Counterpart on graded meshes, where starts take many steps that are short for any method.
    inline constexpr double radau_9_accuracy_if_graded = 3e-5;
    /// Size of a start or jump of the stress, relative to the largest stress, over the root of Accuracy, above which
    /// layers count. Graded meshes have degree graded_degree, below Accuracy accurate_graded the higher one.
    inline constexpr double sudden_part         = 0.1;
    inline constexpr unsigned int graded_degree = 6, accurate_graded_degree = 8;
    inline constexpr double accurate_graded = 3e-7;
    /// Numbers of breaks beyond which graded meshes become too large, or too many starts have nothing sudden.
    inline constexpr std::size_t max_graded_places = 200, max_gentle_breaks = 200;
    /// Smallest error that may be wanted, as a part of the length: round-off.
    inline constexpr double min_error = 3e-15;
    /// Largest tolerance with pictures, relative to the wanted error, since the displacement within a step of radau 5
    /// or 9 has an error of up to half the tolerance; and its floor, as a part of the length.
    inline constexpr double tolerance_of_pictures = 2., min_tolerance_of_pictures = 1e-13;
    /// First tolerances on graded meshes, relative to the wanted error.
    inline constexpr double graded_radau_5 = 4., graded_radau_9 = 10., graded_others = 0.1;
    /// Meshes for moving jumps: doubled from the coarsest until the displacement settles, which it does in proportion
    /// to the cell size, with tolerances that fall in the same proportion; limits on cells, and on cells times steps.
    inline constexpr unsigned int moving_degree = 2, first_moving_cells = 64, last_moving_cells = 2048;
    inline constexpr double moving_tolerance = 0.1, max_moving_work = 1e7;
    /// Smallest number of steps of a period for each cell.
    inline constexpr double moving_steps = 4.;
    /// Factors on the last change, which is the remaining error of a first-order method: the first one counts more.
    inline constexpr double moving_factor = 1.5, moving_factor_of_first = 4.;
    /// First steps, relative to the duration: methods that start with order 1 need small ones.
    inline constexpr double multistep_start = 1e-5, one_step_start = 1e-2;
    /// Runs long_run times as long as their first strides that do not end when cycles repeat have their numerics
    /// chosen by those strides. Strides are slow to repeat below this stiffness, in natural units of a stride.
    inline constexpr double first_strides = 3., long_run = 4., min_settling_stiffness = 0.02;
    /// Bodies softer than very_soft, in natural units, may have a relative error of soft_error on adaptive meshes
    /// whatever Accuracy is: the indicators do not see their layers, and uniform meshes do not see them at all.
    inline constexpr double very_soft = 2e-5, soft_error = 3e-3;
  } // namespace choice

  // Search for graded meshes (graded_choice.cc; doc/numerics.md, "Jumps"). Measured by
  // tests/verification/jump_study.cc.
  namespace graded
  {
    inline constexpr double coarse_ratio = 0.25, fine_ratio = 0.4;
    /// Gain of a level: it reduces the error at a discontinuity at least by this factor over the square of the ratio.
    inline constexpr double part_of_gain = 0.5;
    /// Accuracy from which on the coarse ratio has never mattered.
    inline constexpr double coarse_ratio_is_enough = 1e-5;
    /// Change of the displacement, as a part of the wanted error, below which a refinement was not needed.
    inline constexpr double part = 0.25;
    /// Relative change of the displacement assumed for the tolerance beyond which that is set anew.
    inline constexpr double same_size = 0.1;
    /// Limits at which the search is given up.
    inline constexpr unsigned int max_runs = 40, max_cells = 96, max_cells_of_piece = 12;
    /// Factor on max_cells while cells times steps stay below max_work; the last change by more cells may then be
    /// last_part of the wanted error.
    inline constexpr unsigned int cheap_mesh_factor = 4;
    inline constexpr double max_work = 3e5, last_part = 0.5;
    inline constexpr double smallest_cell = 1e-7, emptied = 1e-3;
    /// Thickness of layers, relative to the length, below which they do not count.
    inline constexpr double smallest_layer = 1e-6;
    /// Number of times the search begins anew, with twice the cells, if its first mesh loses a stretch.
    inline constexpr unsigned int max_beginnings = 3;
    inline constexpr double more_cells = 1.5, finer_tolerance = 0.1;
    inline constexpr double longest_first_step = 1e-2, shortest_first_step = 1e-16;
  } // namespace graded

  // Numerics shared by similar scenes (shared_choice.cc; doc/numerics.md, "Sweeps"). Measured by
  // tests/verification/shared_numerics_test.cc.
  namespace shared
  {
    /// Smallest number of cells, and factor on the first step, that are tried.
    inline constexpr unsigned int min_cells   = 2;
    inline constexpr double longer_first_step = 5.;
    /// Parts of the wanted error by which space and time may each change the displacement of an example, and by which
    /// the extrapolation of cycles may.
    inline constexpr double part = 0.12, part_of_cycles = 0.1;
    /// Factor on Accuracy where no finer run finds the scenes that need more than the examples.
    inline constexpr double unchecked = 0.3;
    /// Tolerances tried, relative to the displacement: from the loosest, smaller by next_tolerance each time.
    inline constexpr double loosest_tolerance = 3e-2, next_tolerance = 0.316;
  } // namespace shared

  // Choice of the cheaper form (form_choice.cc; doc/numerics.md, "Stretch form"). Measured by
  // tests/benchmark/stretch_table.cc.
  namespace form
  {
    /// Limits at low accuracy, the Accuracy below which they fall, and the powers by which they do.
    inline constexpr double softest = 1e-3, emptied = 0.06, emptied_if_it_inverts = 3e-3, moderate = 1e-5;
    inline constexpr double softness_power = 0.5, stretch_power = 0.35;
    /// Limits beyond which many cells of the position form are cheaper.
    inline constexpr double max_lengths = 30., min_accuracy = 1e-7;
  } // namespace form

  // Families of meshes of the stretch form (mesh_family.cc; doc/numerics.md, "Stretch form"). Measured by
  // tests/verification/random_extremes.cc and tests/benchmark/stretch_table.cc.
  namespace family
  {
    /// Cells of the finest mesh: in general, for an Accuracy below accurate, and of bodies that invert.
    inline constexpr unsigned int max_cells = 51200, max_cells_if_accurate = 6400, max_cells_if_inverted = 1600;
    inline constexpr double accurate = 2e-6;
    /// Limits on cells times steps of the next mesh, about a second for each 2e6, and the factor by which it takes more
    /// of them than the last one.
    inline constexpr double max_work = 2.5e7, max_work_if_accurate = 5e7, more_work = 5.;
    /// Part of the wanted error that the error in time may be; number of reductions of the time tolerance for that.
    inline constexpr double time_part            = 0.3;
    inline constexpr unsigned int max_tolerances = 5;
    inline constexpr double finer_tolerance      = 0.1;
    /// Stretch below which cells are empty; largest tolerance that checks the error in time then, over the length.
    inline constexpr double empty = 1e-9, check_if_empty = 3e-8;
    inline constexpr unsigned int few_steps = 30;  ///< steps below which errors grow fast with the cells
    inline constexpr double min_part        = 0.5; ///< part of the wanted error that all runs have in common
    inline constexpr double min_order = 1.5, largest_order = 2.7; ///< observed orders accepted as the second
    /// Factors by which a time tolerance, relative to the strain, may be too large or small before it is chosen anew.
    inline constexpr double too_large = 2., too_small = 0.05;
    /// Limits relative to the time of an inversion: error beyond which it may be none; change beyond which meshes are
    /// too coarse.
    inline constexpr double believed = 0.3, largest_change_of_inversion = 0.2;
    /// Round-off of the displacement, in lengths of the body.
    inline constexpr double round_off = 4e-15;
    /// Rates at which extrapolations settle: the fastest that is believed, and at a turning point. Regions thinner than
    /// cells count unseen_part of their length, for a displacement of at least part_of_largest displacement of a point.
    inline constexpr double fastest = 8., turned = 4., unseen_part = 0.15, part_of_largest = 0.25;
    /// Factor on the last change of the time of an inversion for its error, for a between min_slow_exponent and 0, and
    /// the rate at which such changes are believed to fall.
    inline constexpr double min_slow_exponent = -0.5, sticking_factor = 3., sticking_rate = 3.;
    /// Deviation of the order from 2 up to which that is accepted; else a first change counts unclean_factor times.
    /// Two orders in a row that deviate by at most regular are no chance.
    inline constexpr double clean = 0.25, unclean_factor = 2., regular = 0.1;
  } // namespace family

  // Moving jumps as the limit of fronts (moving_fronts.cc; doc/numerics.md, "Jumps that move"). Measured by
  // tests/verification/square_actuation_test.cc.
  namespace fronts
  {
    /// Widths of fronts, relative to the widest that fit: the first, halved each time, and the last.
    inline constexpr double first_part = 0.32, last_part = 0.0025;
    /// Largest number of widths of an answer.
    inline constexpr unsigned int max_levels = 5;
    /// Limits of the error bound, as multiples of the change by one width less, and of that since the answer before.
    inline constexpr double factor = 2., factor_of_change = 0.5;
    /// Accuracy of the runs, relative to the wanted one, and its limits.
    inline constexpr double part_of_runs = 0.1, min_accuracy = 1e-9, largest_accuracy = 1e-3;
    /// Steps of all runs after which no steeper fronts are tried.
    inline constexpr unsigned long max_steps = 100000;
    /// Relative change of the time of an inversion from fronts to fronts below which it is known.
    inline constexpr double settled_inversion = 1e-2;
  } // namespace fronts

  // Finer run that measures errors (error_estimate.cc; doc/numerics.md, "Error bounds"). Calibrated by
  // tests/verification/calibration.cc.
  namespace finer_run
  {
    inline constexpr double measured_factor = 1.5, factor_without_rule = 2.;
    /// Parts of the wanted error in the bound: adaptive meshes have more of their errors in common than others, and so
    /// have graded ones if kinks move through their cells; otherwise each part was measured beforehand.
    inline constexpr double predicted_part = 0.2, predicted_part_if_irregular = 0.5, predicted_part_if_graded = 0.15;
    /// Cells and tolerances of the finer run, relative to the run's.
    inline constexpr double more_cells = 1.1, finer_tolerance = 0.2, finer_mesh_tolerance = 0.1;
    /// Tolerance for runs not by radau 9, which is more accurate for the same tolerance than all others.
    inline constexpr double finer_tolerance_than_others = 4.;
    /// Cells and tolerance where the user chose the numerics: mesh and steps may both be the problem. As many cells
    /// where the active stress is not smooth, so that errors fall with the cells by a small power.
    inline constexpr double more_cells_without_rule = 2., finer_tolerance_without_rule = 0.1;
    inline constexpr const char *best_integrator = "radau 9";
    /// Exponent of the tolerance to which its steps are proportional; its smallest first step over the duration.
    inline constexpr double steps_over_tolerances = 1. / 6., first_step = 1e-3;
    /// Layers at the ends of bodies softer than soft, in natural units, about as thick as the softness; the finer run
    /// has cells as small as the softness times layer_cells there, graded by layer_ratio.
    inline constexpr double soft = 1e-3, layer_cells = 3., layer_ratio = 0.25, max_layer_levels = 8.;
    /// Tolerance where one cycle stands for many: its error does not average out, so the finer run is more accurate.
    inline constexpr double finer_tolerance_of_cycles = 0.25;
    /// Number of next tries, also while the error falls and is within near_factor; factors on cells and tolerance.
    inline constexpr unsigned int max_refinements = 3, max_refinements_if_near = 6;
    inline constexpr double near_factor = 4., refined_cells = 1.2, max_refined_cells = 4., refined_tolerance = 0.1;
    /// Round-off of the displacement, as a part of the body length.
    inline constexpr double round_off = 1e-15;
  } // namespace finer_run

  // Errors by the adjoint (error_sweep.cc; doc/numerics.md, "Errors by the adjoint"). Measured by
  // tests/verification/error_sweep_test.cc.
  namespace sweep
  {
    /// Quadrature points of a cell beyond its degree + 1; number of improvements of the functions of higher degree.
    inline constexpr unsigned int more_points = 2, rounds = 2;
    /// Bound of the corrected displacement: this part of the sums of the sizes of all errors, plus the change of the
    /// last round. Nothing is estimated below least_stretch, nor of runs of more steps times cells, about a second.
    inline constexpr double part_of_sums = 0.4, least_stretch = 0.1, max_work = 5e4;
  } // namespace sweep

  // Derivatives by entries (studies/core/sensitivities.cc). Measured by
  // tests/verification/sensitivity_bounds.py.
  namespace sensitivities
  {
    /// Bound of a derivative: factor on its difference to the finer numerics; since both may agree by chance, multiples
    /// of Accuracy of the derivative and of D/p, for works of the relative error of the work and with factors of their
    /// own; and relative round-off of the differences that give dF/dp.
    inline constexpr double measured_factor = 2., wanted_factor = 16., wanted_factor_of_works = 40.,
                            wanted_factor_of_positive_work = 160., round_off = 1e-10;
    /// Relative steps of entries whose answers are compared where there is no adjoint; a slope is suspicious if it
    /// changes by more than this part, as a kink's does, and values closer by closer_answers decide.
    inline constexpr double min_step_of_answers = 1e-3, largest_step_of_answers = 0.01, suspicious = 0.1,
                            closer_answers = 0.25;
  } // namespace sensitivities

  // Bounds of other numbers than the displacement (finer_run_errors.cc). Calibrated by
  // tests/verification/number_errors.py.
  namespace number_bounds
  {
    inline constexpr double more_if_sampled = 1.5, sampling_error = 2., if_not_extrapolated = 2.;
  } // namespace number_bounds

  // Choice of the level of the model hierarchy (model_choice.cc; doc/numerics.md, "Levels without a mesh"). Measured by
  // build/tests/ladder_study.
  namespace level
  {
    /// Errors below this part of the length count as zero.
    inline constexpr double floor = 1e-12;
    /// Share of the model in the error of the kinematic level; the rest is for its quadrature.
    inline constexpr double model_share = 0.75;
  } // namespace level

  // Repetition of cycles (cycle_stop.cc). Measured by tests/verification/cycle_stop_test.cc.
  namespace cycles
  {
    /// Part of the wanted accuracy that the bound may take.
    inline constexpr double part = 0.2;
    /// Relative difference of the strains of two successive cycles below which they repeat.
    inline constexpr double same = 1e-3;
    /// Safety factor on the observed dependence of a cycle's displacement on its start.
    inline constexpr double safety = 10.;
    /// Changes of the strain below this multiple of the tolerance of the time integration are its noise.
    inline constexpr double noise = 10.;
    /// Limit of the remaining drift, as a part of the smallest stretch.
    inline constexpr double min_part = 0.1;
    /// Distance of a start from the first phase, as a part of a cycle, below which it is left out.
    inline constexpr double short_start = 1e-3;
    /// Largest number of cycles watched.
    inline constexpr unsigned int max_watched = 200;
  } // namespace cycles

  // Tolerances of the identities of a finished run (self_check.cc; doc/numerics.md, "Energy balance and self-checks").
  // Measured by tests/verification/identities_test.cc.
  namespace identities
  {
    /// Energy residual, relative: in units of Accuracy for each form, and at least.
    inline constexpr double of_accuracy = 10., of_accuracy_in_stretch_form = 300., min_residual = 1e-8;
    /// Energy residuals with the user's numerics; for moving jumps; above which stretch-form works are unknown.
    inline constexpr double residual_of_users = 0.1, residual_of_moving_jumps = 0.2, residual_of_known_works = 0.1;
    /// Net friction, relative to the absolute one: at least; in units of Accuracy; with the user's own steps.
    inline constexpr double min_net_friction = 1e-6, net_friction_of_accuracy = 0.1, net_friction_of_users = 1e-3;
  } // namespace identities
} // namespace crawler::accuracy_rule
