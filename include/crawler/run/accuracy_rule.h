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
  /// The displacement counts as no smaller than this part of the body's largest deformation [1].
  inline constexpr double displacement_floor = 1e-4;

  // How degree, cells and tolerance are chosen (numerics_choice.cc; doc/numerics.md, sections on the choice). Measured
  // by tests/verification/calibration.cc and tests/benchmark/setting_search.cc.
  namespace choice
  {
    inline constexpr unsigned int automatic_degree = 6;
    inline constexpr unsigned int fewest_cells = 4, most_cells = 4096;
    /// A pilot that breaks off with a smaller stretch than this has lost it.
    inline constexpr double emptied = 0.1;
    /// Uniform meshes of pilots have at most so many cells; adaptive meshes have this degree.
    inline constexpr unsigned int most_uniform_cells = 1024, adaptive_degree = 4;
    /// The error of the displacement, relative, is below this times the sum of the error indicators over the strain.
    inline constexpr double indicator_factor = 8.;
    /// The coarsest mesh of the stretch form, cells for each length in which the active stress changes, and the part of
    /// Accuracy that the time tolerance is, relative to the strain, and at most.
    inline constexpr unsigned int first_family_cells = 25;
    inline constexpr double cells_of_length = 4., family_tolerance = 10., largest_family_tolerance = 1e-3;
    /// Its layers: of this many lengths k/max|m_s|, at most this part of the body.
    inline constexpr double layer_lengths = 1., largest_layer = 0.02;
    inline constexpr unsigned int most_pilot_steps = 100000, most_adaptive_pilot_steps = 20000,
                                  most_adaptive_pilot_cells = 1200;
    /// How well a pilot that ends when its cycles repeat must know the displacement.
    inline constexpr double pilot_accuracy = 1e-2;
    /// A pilot's mesh is good enough to predict others if its `unresolved` is below this.
    inline constexpr double resolved = 1e-3;
    /// Layers thinner than this, in distances between the unknowns, may look resolved when they are not.
    inline constexpr double widest_hidden_layer = 1.;
    /// Error of the displacement in space, relative, is below this times `unresolved` of the mesh.
    inline constexpr double space_factor = 6.;
    /// Error of the displacement in time is below this times the number of steps times the tolerance.
    inline constexpr double time_factor = 0.25;
    /// The steps of radau 5 and 9 on uniform meshes in the position form end much more accurately than their tolerance
    /// says: the tolerance is so many times the one of that rule.
    inline constexpr double radau_5_superconvergence = 50., radau_9_superconvergence = 2000.;
    /// The least tolerance relative to the motion; below the second, kinks in the friction of stiff bodies stop a run.
    inline constexpr double least_tolerance = 1e-15, least_tolerance_if_kinks = 1e-10;
    /// On uniform meshes runs for a smaller Accuracy than this are by radau 9, others by radau 5.
    inline constexpr double radau_9_accuracy = 1.1e-4;
    /// The same on graded meshes, where starts take many steps that are short for any method.
    inline constexpr double radau_9_accuracy_if_graded = 3e-5;
    /// A stress that starts or jumps by more than this times the root of Accuracy, relative to the largest, makes
    /// layers that count. Graded meshes have this degree, the higher one for a smaller Accuracy than that.
    inline constexpr double sudden_part         = 0.1;
    inline constexpr unsigned int graded_degree = 6, accurate_graded_degree = 8;
    inline constexpr double accurate_graded = 3e-7;
    /// More breaks would make graded meshes too large, or too many starts where nothing happens suddenly.
    inline constexpr std::size_t most_graded_places = 200, most_gentle_breaks = 200;
    /// No error is wanted to be smaller than this part of the length: round-off.
    inline constexpr double least_error = 3e-15;
    /// The displacement within a step of radau 5 or 9 has an error of up to half the tolerance: with pictures this is
    /// at most so many times the wanted error, and never smaller than this part of the length.
    inline constexpr double tolerance_of_pictures = 2., least_tolerance_of_pictures = 1e-13;
    /// First tolerances on graded meshes, relative to the wanted error.
    inline constexpr double graded_radau_5 = 4., graded_radau_9 = 10., graded_others = 0.1;
    /// Meshes for jumps that move: from the coarsest, doubled until the displacement settles, which it does like the
    /// size of a cell, with tolerances that fall like it too; at most so many cells, and cells times steps.
    inline constexpr unsigned int moving_degree = 2, first_moving_cells = 64, last_moving_cells = 2048;
    inline constexpr double moving_tolerance = 0.1, most_moving_work = 1e7;
    /// Steps of a period for each cell, at least.
    inline constexpr double moving_steps = 4.;
    /// The remaining error of a method of first order is the last change; a larger part is promised.
    inline constexpr double moving_factor = 1.5, moving_factor_of_first = 4.;
    /// First steps, relative to the duration: methods that start with order 1 need small ones.
    inline constexpr double multistep_start = 1e-5, one_step_start = 1e-2;
    /// A run that is so many times as long as its first strides, and does not end when cycles repeat, has its numerics
    /// chosen by these. Strides do not repeat soon where the stiffness in natural units of a stride is below that.
    inline constexpr double first_strides = 3., long_run = 4., least_settling_stiffness = 0.02;
    /// On adaptive meshes the error of bodies softer than this, in natural units, may be as large as soft_error,
    /// relative, whatever Accuracy is: their layers are not seen by the indicators, and not at all on uniform meshes.
    inline constexpr double very_soft = 2e-5, soft_error = 3e-3;
  } // namespace choice

  // The search for graded meshes (graded_choice.cc; doc/numerics.md, "Jumps"). Measured by
  // tests/verification/jump_study.cc.
  namespace graded
  {
    inline constexpr double coarse_ratio = 0.25, fine_ratio = 0.4;
    /// A level makes the error at a discontinuity smaller by this over the square of the ratio, at least.
    inline constexpr double part_of_gain = 0.5;
    /// From this Accuracy on the coarse ratio has never mattered.
    inline constexpr double coarse_ratio_is_enough = 1e-5;
    /// A refinement that changes the displacement by less than this part of the wanted error was not needed.
    inline constexpr double part = 0.25;
    /// The tolerance is set anew if the displacement differs by more than this part from what it was set for.
    inline constexpr double same_size = 0.1;
    /// The search is given up beyond these.
    inline constexpr unsigned int most_runs = 40, most_cells = 96, most_cells_of_piece = 12;
    /// So many times as many if that takes no longer than this, in cells times steps; the last change by more cells may
    /// be this part of the wanted error then.
    inline constexpr unsigned int more_cells_than_most = 4;
    inline constexpr double most_work = 3e5, last_part = 0.5;
    inline constexpr double smallest_cell = 1e-7, emptied = 1e-3;
    /// Layers thinner than this, relative to the length, do not count.
    inline constexpr double smallest_layer = 1e-6;
    /// So often the search begins anew, with twice the cells, if its first mesh loses a stretch.
    inline constexpr unsigned int most_beginnings = 3;
    inline constexpr double more_cells = 1.5, finer_tolerance = 0.1;
    inline constexpr double longest_first_step = 1e-2, shortest_first_step = 1e-16;
  } // namespace graded

  // Numerics that similar scenes share (shared_choice.cc; doc/numerics.md, "Sweeps"). Measured by
  // tests/verification/shared_numerics_test.cc.
  namespace shared
  {
    /// Space and time may each change the displacement of an example by this part of the wanted error, and the
    /// extrapolation of cycles by that one.
    inline constexpr double part = 0.12, part_of_cycles = 0.1;
    /// Tolerances that are tried, relative to the displacement: from the loosest, smaller by this factor each time.
    inline constexpr double loosest_tolerance = 3e-2, next_tolerance = 0.316;
  } // namespace shared

  // Which form is the cheaper one (form_choice.cc; doc/numerics.md, "Stretch form"). Measured by
  // tests/benchmark/stretch_table.cc.
  namespace form
  {
    /// Limits at low accuracy, the Accuracy from which on they fall, and how.
    inline constexpr double softest = 1e-3, emptied = 0.06, emptied_if_it_inverts = 3e-3, moderate = 1e-5;
    inline constexpr double softness_power = 0.5, stretch_power = 0.35;
    /// Beyond these many cells of the position form are cheaper.
    inline constexpr double most_lengths = 30., least_accuracy = 1e-7;
  } // namespace form

  // Families of meshes of the stretch form (mesh_family.cc; doc/numerics.md, "Stretch form"). Measured by
  // tests/verification/random_extremes.cc and tests/benchmark/stretch_table.cc.
  namespace family
  {
    /// Cells of the finest mesh, for a smaller Accuracy than accurate, and of bodies that invert.
    inline constexpr unsigned int most_cells = 3200, most_cells_if_accurate = 6400, most_cells_if_inverted = 1600;
    inline constexpr double accurate = 2e-6;
    /// Cells times steps that the next mesh may take, about a second for each 2e6, and how many times as many as the
    /// last one it does.
    inline constexpr double most_work = 2.5e7, most_work_if_accurate = 5e7, more_work = 5.;
    /// The error in time may be this part of the wanted one, and the time tolerance is made smaller so often for that.
    inline constexpr double time_part             = 0.3;
    inline constexpr unsigned int most_tolerances = 5;
    inline constexpr double finer_tolerance       = 0.1;
    /// Cells with a smaller stretch are empty; the time tolerance then is no larger than this.
    inline constexpr double empty = 1e-9, tolerance_if_empty = 3e-7;
    inline constexpr unsigned int few_steps = 30;  ///< whose errors grow fast with the cells
    inline constexpr double least_part      = 0.5; ///< of the wanted error, which all runs have in common
    /// Observed orders between which second order is believed.
    inline constexpr double least_order = 1.5, largest_order = 2.7;
    /// A time tolerance, relative to the strain, that is so many times too large or small is chosen anew.
    inline constexpr double too_large = 2., too_small = 0.05;
    /// Relative to its time: an inversion that is known worse may be none; meshes that move it more are too coarse.
    inline constexpr double believed = 0.3, largest_change_of_inversion = 0.2;
    /// No displacement is known better than this, in lengths of the body.
    inline constexpr double round_off = 4e-15;
    /// Extrapolations that settle at least so fast are believed to go on so; what settles faster than fourth order does
    /// it by chance, as does what turns round. What is thinner than cells is such a part of its length.
    inline constexpr double fast = 5., credited = 3., fastest = 16., turned = 8., unseen_part = 0.15;
    /// For a between this and 0 the time of an inversion has an error of so many times its last change.
    inline constexpr double least_slow_exponent = -0.5, sticking_factor = 3.;
    /// That is believed where the order is as near to 2 as this; else a first change counts so many times as much.
    inline constexpr double clean = 0.25, unclean_factor = 2.;
  } // namespace family

  // Jumps that move, as the limit of fronts (moving_fronts.cc; doc/numerics.md, "Jumps that move"). Measured by
  // tests/verification/square_actuation_test.cc.
  namespace fronts
  {
    /// Widths of fronts, relative to the widest that fit: the first, each next one half of it, and the last.
    inline constexpr double first_part = 0.32, last_part = 0.0025;
    /// So many widths, at most, make an answer.
    inline constexpr unsigned int most_levels = 5;
    /// Its error is at most so many times the change by one width less, and that since the answer before.
    inline constexpr double factor = 2., factor_of_change = 0.5;
    /// Accuracy of the runs, relative to the wanted one, and its limits.
    inline constexpr double part_of_runs = 0.1, least_accuracy = 1e-9, largest_accuracy = 1e-3;
    /// No steeper fronts after so many steps in all.
    inline constexpr unsigned long most_steps = 100000;
    /// The time of an inversion is known if it changes by less than this, relative, from fronts to fronts.
    inline constexpr double settled_inversion = 1e-2;
  } // namespace fronts

  // The finer run that measures errors (error_estimate.cc; doc/numerics.md, "Error bounds"). Calibrated by
  // tests/verification/calibration.cc.
  namespace finer_run
  {
    inline constexpr double measured_factor = 1.5, promised_part = 0.2, factor_without_promise = 2.;
    /// The errors of two adaptive meshes have more in common.
    inline constexpr double promised_part_if_adaptive = 0.5;
    /// On graded meshes each part of the error was measured beforehand.
    inline constexpr double promised_part_if_graded = 0.15;
    /// The finer run: cells and tolerances relative to the run's.
    inline constexpr double more_cells = 1.1, finer_tolerance = 0.2, finer_mesh_tolerance = 0.1;
    /// Its cells if the active stress is not smooth, so that errors fall with the cells by a small power.
    inline constexpr double more_cells_if_rough = 1.5;
    /// The same if the run is not by radau 9, which is more accurate for the same tolerance than all others.
    inline constexpr double finer_tolerance_than_others = 4.;
    /// The same if the user chose the numerics: it is not known whether mesh or steps are the problem.
    inline constexpr double more_cells_without_promise = 2., finer_tolerance_without_promise = 0.1;
    inline constexpr const char *best_integrator = "radau 9";
    /// The power of the tolerance by which its steps go.
    inline constexpr double steps_over_tolerances = 1. / 6.;
    /// Its first step, relative to the duration, at least: others start with smaller ones.
    inline constexpr double first_step = 1e-3;
    /// Bodies softer than this in natural units have layers at their ends, of a thickness of about that; the finer run
    /// has cells as small as this times that there, smaller and smaller by this ratio.
    inline constexpr double soft = 1e-3, layer_cells = 3., layer_ratio = 0.25, most_layer_levels = 8.;
    /// A cycle that stands for many others has an error that does not average out: the finer run is more accurate.
    inline constexpr double finer_tolerance_of_cycles = 0.25;
    /// For the next try.
    inline constexpr double refined_cells = 1.2, most_refined_cells = 4., refined_tolerance = 0.1;
    /// No displacement is more accurate than this part of the body length.
    inline constexpr double round_off = 1e-15;
  } // namespace finer_run

  // Errors by the adjoint (error_sweep.cc; doc/numerics.md, "Errors by the adjoint"). Measured by
  // tests/verification/error_sweep_test.cc.
  namespace sweep
  {
    /// Points of a cell more than its degree + 1, and how often the functions of higher degree are improved.
    inline constexpr unsigned int more_points = 2, rounds = 2;
    /// The bound of the corrected displacement is this part of the sums of the sizes of all errors, and the change of
    /// the last round.
    inline constexpr double part_of_sums = 0.4;
    /// Below this stretch nothing is estimated.
    inline constexpr double least_stretch = 0.1;
    /// Steps times cells of a run for which it is made, about a second.
    inline constexpr double most_work = 5e4;
  } // namespace sweep

  // Derivatives by entries (studies/core/sensitivities.cc). Measured by
  // tests/verification/sensitivity_bounds.py.
  namespace sensitivities
  {
    /// The bound: so many times the difference to the finer numerics; since both may agree by chance so many times
    /// Accuracy of the derivative and of D/p, for works the relative error of the work and other factors; and relative
    /// round-off of the differences by which dF/dp is found.
    inline constexpr double measured_factor = 2., promised_factor = 16., promised_factor_of_works = 40.,
                            promised_factor_of_positive_work = 160., round_off = 1e-10;
    /// Where there is no adjoint answers are compared whose entries differ by such a step, relative; a slope that
    /// changes by more than this part of it as a kink's does is suspicious, and values closer by this factor decide.
    inline constexpr double least_step_of_answers = 1e-3, largest_step_of_answers = 0.01, suspicious = 0.1,
                            closer_answers = 0.25;
  } // namespace sensitivities

  // Bounds of other numbers than the displacement (finer_run_errors.cc). Calibrated by
  // tests/verification/number_errors.py.
  namespace number_bounds
  {
    inline constexpr double more_if_sampled = 1.5, sampling_error = 2., if_not_extrapolated = 2.;
  } // namespace number_bounds

  // Which level of the model hierarchy (model_choice.cc; doc/numerics.md, "Levels without a mesh"). Measured by
  // build/tests/ladder_study.
  namespace level
  {
    /// Errors below this part of the length are no errors.
    inline constexpr double floor = 1e-12;
    /// The model's share of the error of the kinematic level; the rest is for its quadrature.
    inline constexpr double model_share = 0.75;
  } // namespace level

  // When cycles repeat (cycle_stop.cc). Measured by tests/verification/cycle_stop_test.cc.
  namespace cycles
  {
    /// The part of the wanted accuracy that the bound may take.
    inline constexpr double part = 0.2;
    /// A cycle repeats if its strain differs from that of the one before by less than this part.
    inline constexpr double same = 1e-3;
    /// The displacement of a cycle may depend on its start by so much more than has been seen.
    inline constexpr double safety = 10.;
    /// A change of the strain that is smaller than this times the tolerance of the time integration is its noise.
    inline constexpr double noise = 10.;
    /// The drift that is still to come must be smaller than this part of the smallest stretch.
    inline constexpr double least_part = 0.1;
    /// A start closer to the first phase than this part of a cycle is left out.
    inline constexpr double short_start = 1e-3;
    /// So many cycles are watched.
    inline constexpr unsigned int most_watched = 200;
  } // namespace cycles

  // What the identities of a finished run may lack (self_check.cc; doc/numerics.md, "Energy balance and self-checks").
  // Measured by tests/verification/identities_test.cc.
  namespace identities
  {
    /// Residual of the energy balance, relative: in units of Accuracy for each form, and at least.
    inline constexpr double of_accuracy = 10., of_accuracy_in_stretch_form = 300., least_residual = 1e-8;
    /// Where the user chose the numerics; where jumps of the stress move; above which stretch-form works are unknown.
    inline constexpr double residual_of_users = 0.1, residual_of_moving_jumps = 0.2, residual_of_known_works = 0.1;
    /// Net friction, relative to the absolute one.
    inline constexpr double net_friction = 1e-6;
  } // namespace identities
} // namespace crawler::accuracy_rule
