// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/step_limits.h>

#include <cstddef>

/**
 * Kernels and time integration of a form in one piece, for meshes that do not change: the position form with the
 * p-model of friction, and the stretch form. Radau IIA with the simplified Newton method, as in time/radau.h, without
 * an object of PETSc. Several bodies are computed side by side in the lanes of vector registers, each with its own
 * parameters and its own steps; a lane that is done takes the next body. No operation mixes lanes, so an answer does
 * not depend on which bodies share a batch.
 *
 * Only plain data here: this header is included by code for instruction sets that the processor may not have.
 * Everything is in natural units (scene/scene.h).
 */
namespace crawler
{
  /// What bodies and grounds have besides the numbers of a plain scene: bits.
  struct LaneLaws
  {
    enum Bits : unsigned int
    {
      plain                 = 0,
      general               = 1,  ///< anything of what follows, k(s) or gamma(s)
      direction             = 2,  ///< friction depends on the direction
      host_friction         = 4,  ///< another friction law than the power law: the host evaluates it
      host_ground           = 8,  ///< c(x): the host evaluates it
      feedback              = 16, ///< m depends on the stretch: the host evaluates it
      rate                  = 32, ///< and on its rate
      nonlinear_in_velocity = direction | rate
    };
  };

  /// What all lanes share: the mesh, the element (mesh/reference_element.h) and the method
  /// (time/radau_tableau.h). All arrays belong to the caller.
  struct LaneSetup
  {
    unsigned int degree, n_cells, n_stages;
    const double *sizes;                                      ///< [n_cells] of the cells
    const double *values, *derivatives, *weights, *stiffness; ///< of the element
    unsigned int n_samples;                                   ///< per cell, where the stretch is looked at
    const double *sample_derivatives;                         ///< [n_samples][degree+1]
    const double *c, *b, *inverse, *error_weights;            ///< of the method
    double newton_fraction; ///< of the method: error of Newton's method that is left, relative to the tolerance
    double real_eigenvalue;
    const double *eigenvalues; ///< [pairs][real, imaginary]
    const double *vectors;     ///< [stages][1 + pairs][real, imaginary]
    const double *rows;        ///< [1 + pairs][stages][real, imaginary]

    unsigned int laws = LaneLaws::plain; ///< what the bodies and grounds of a run have

    // The stretch form (lane_stretch.h), whose points are the middles of its cells.
    bool is_stretch = false, is_power = false;           ///< see StretchSystem
    unsigned char node_rule = 0;                         ///< NodeRule of equation/stretch_loops.h
    double backward_ratio = 1., switching_velocity = 1.; ///< of the ground (scene/ground.h)
  };

  /// What a body knows of its steps from one to the next, besides its state.
  struct LaneProgress
  {
    bool has_old = false, just_rejected = false;
    bool is_retry = false; ///< of a step whose failed try is the guess
    double t = 0., h = 1., next = 1., old_h = 1.;
    double rate = 0., known_rate = 1., last_correction = 0.;
    unsigned int steps = 0, rejected = 0, failures = 0, all_failures = 0, output_time = 0, limit = 0;
    unsigned int first_step = 0; ///< steps before the last start
    unsigned long newton    = 0;

    void
    exchange(auto &archive)
    {
      archive(has_old, just_rejected, is_retry, t, h, next, old_h, rate, known_rate, last_correction);
      archive(steps, rejected, failures, all_failures, output_time, limit, first_step, newton);
    }
  };

  /// One body to compute.
  struct LaneJob
  {
    double k, a;          ///< elastic modulus, friction exponent
    double tolerance;     ///< root mean square of the error of a step; in the stretch form the largest one of a stretch
    double newton_factor; ///< on LaneSetup::newton_fraction
    double initial_step;
    const StepLimit *limits; ///< of its steps
    unsigned int n_limits;
    unsigned int most_steps;
    double least_stretch; ///< a state with a smaller one is given up; the full path must tell what it means
    bool is_last_resort;  ///< is there no other engine to go on where Newton's method often fails?
    double start_time;
    const double *start;        ///< [unknowns] displacement at start_time; null: rest
    const double *output_times; ///< ascending times after start_time where steps must end; the run ends with the last
    unsigned int n_output_times;
    /// [n_output_times] is the output time a time when the active stress jumps, so the body starts anew there? Null:
    /// none is.
    const unsigned char *restarts;

    // Of a body that goes on between two steps, where `start` is its state; null: it starts.
    const LaneProgress *progress = nullptr;
    const double *old_z          = nullptr; ///< [stages][unknowns] of the step before, as in LaneStep

    // Of a general body in the position form.
    const double *k_profile = nullptr, *friction_profile = nullptr; ///< [points] k(s)/k and b(s)
    double backward_ratio = 1., switching_velocity = 1.;            ///< of the ground (scene/ground.h)
  };

  /// The state of a lane at all quadrature points, and where the host writes what the laws say there. What LaneLaws
  /// does not ask for is null, and derivatives that are not wanted.
  struct LanePoints
  {
    double t;
    const double *u, *v, *w, *rate; ///< displacement, velocity, stretch and its rate
    double *g, *w_dg;               ///< friction law and its derivative by log w
    double *c, *c_x;                ///< profile of the ground at s + u, and its slope
    double *m, *m_w, *m_rate;       ///< active stress with feedback, and its derivatives by the stretch and its rate
  };

  /// Of a stage of an accepted step (the last one is its end).
  struct LaneStage
  {
    double min_stretch, max_stretch;     ///< among the samples
    unsigned int min_sample, max_sample; ///< cell*n_samples + sample
    // If rates are asked for (CellIntegrals).
    double stress_power, positive_power, absolute_power, dissipation, net_friction, abs_friction;
    double left_velocity, right_velocity; ///< of the ends of the body
    // If the active stress depends on it, too: the stretch at both ends and its rate.
    double end_stretch[2], end_rate[2];
  };

  /// An accepted step of a lane. The pointers are good until the next advance(); element i is at [i*stride].
  struct LaneStep
  {
    double time, size;
    double next_size;
    unsigned int number, rejected;
    unsigned long newton_iterations;
    bool is_output_time;
    std::size_t stride;
    const double *y;         ///< [unknowns] displacement
    const double *z;         ///< [stages][unknowns] displacements in the stages relative to the start of the step
    const LaneStage *stages; ///< [n_stages]; the last one alone is filled unless `look_inside` is set
    double elastic_energy;   ///< at the end, if rates are asked for
    bool is_settled;         ///< was the velocity at the end found? If rates are asked for
    const LaneProgress *progress;
  };

  struct LaneOutcome
  {
    enum Status
    {
      finished,
      stopped, ///< by the host, or at most_steps
      gave_up  ///< something that only the full path can tell apart
    } status;
    double time, step_size; ///< of the last accepted state; step that would come next
    unsigned int steps, rejected;
    unsigned long newton_iterations;
    double displacement; ///< int u ds at that time
  };

  /// The laws of a general body in the stretch form, at all cells: the mobility 1/(g b), the force N, and their
  /// derivatives by w and w_t. The arrays belong to the host and are good until it is asked again.
  struct LaneCellLaws
  {
    const double *mobility, *mobility_by_w, *force, *force_by_w, *force_by_rate;
    double least; ///< not positive if one of them has no meaning
  };

  /// Who gives the bodies and takes the answers. Lanes are numbered 0 to lanes - 1.
  struct LaneHost
  {
    void *context;
    /// The next body for a lane; false if there is none.
    bool (*next)(void *context, unsigned int lane, LaneJob &job);
    /// m at all quadrature points [cell][point]. Asked for at the start, in all stages of each step that is tried, and
    /// after a step to a time when it jumps there once more, for what comes then.
    void (*stress)(void *context, unsigned int lane, double t, double *m);
    /// Sees each accepted step; false stops the lane. May be null.
    bool (*accepted)(void *context, unsigned int lane, const LaneStep &step);
    void (*done)(void *context, unsigned int lane, const LaneOutcome &outcome);
    bool look_inside; ///< stretch and rates in all stages, of the position form
    /// The laws that the engine leaves to the host; false if one of them has no meaning for this state.
    bool (*laws)(void *context, unsigned int lane, const LanePoints &points) = nullptr;
    /// In the stretch form, for the stretch @p w and its rate at each cell, for an engine with one lane. Null: the laws
    /// of a plain body.
    LaneCellLaws (*cell_laws)(void *context, double t, const double *m, const double *w, const double *rate) = nullptr;
  };

  /// A run to go through backwards. All arrays belong to the caller.
  struct LanePast
  {
    unsigned int n_steps = 0;
    const double *times = nullptr, *sizes = nullptr; ///< [n_steps] ends and lengths of the steps
    const double *z             = nullptr;           ///< [n_steps][stages][unknowns] as in LaneStep
    const double *end           = nullptr;           ///< [unknowns] the last state
    const unsigned char *starts = nullptr;           ///< [n_steps] does a body start anew with this step? Null: never
    const double *gradient      = nullptr; ///< [unknowns] what one wants to know, differentiated by the last state
    bool has_sources            = false;   ///< depends what one wants to know on the steps, too?
  };

  /// What one wants to know, differentiated by the states of a step themselves. The arrays are 0 before.
  struct LaneSources
  {
    double *by_end;             ///< [unknowns] the state at the end of the step
    double *by_u, *by_velocity; ///< [stages][unknowns] displacements and velocities in the stages
  };

  /// A step gone through backwards; element i is at [i*stride].
  struct LaneAdjointStep
  {
    unsigned int number; ///< from 0
    std::size_t stride;
    const double
      *mu; ///< [stages][unknowns] what one wants to know, differentiated by the residuals, with the sign of dF
    /// [unknowns] M^-1 of what one wants to know, differentiated by the state at the end of the step: minus the effect
    /// of an impulse there. Null unless the body starts anew with the next step, or there is none.
    const double *zeta;
  };

  /// Who gives the runs and takes their adjoints.
  struct LaneAdjointHost
  {
    void *context;
    /// The next run for a lane; of @p job the laws of the body alone count. False if there is none.
    bool (*next)(void *context, unsigned int lane, LaneJob &job, LanePast &past);
    void (*step)(void *context, unsigned int lane, const LaneAdjointStep &step);
    /// @p by_start: [unknowns] what one wants to know, differentiated by the first state; not good unless @p finished.
    void (*done)(void *context, unsigned int lane, bool finished, std::size_t stride, const double *by_start);
    bool (*laws)(void *context, unsigned int lane, const LanePoints &points) = nullptr; ///< as in LaneHost
    /// Called before each step of a run that has sources.
    void (*sources)(void *context, unsigned int lane, unsigned int step, const LaneSources &sources) = nullptr;
  };

  /// The engine as compiled for one instruction set and one number of lanes.
  struct LaneEngine
  {
    const char *instruction_set;
    unsigned int lanes;
    /// Doubles of memory that start() and advance() need, aligned to 64 bytes.
    std::size_t (*memory)(const LaneSetup &setup);
    /// Begins with the bodies of a host. All that is given must outlive the last advance().
    void (*start)(const LaneSetup &setup, const LaneHost &host, double *memory);
    /// Tries one step of all bodies in the lanes, after lanes without a body took the next one; false if there is none
    /// left. What the host got to see of a step is good until then.
    bool (*advance)(const LaneSetup &setup, double *memory);
    /// The same for the adjoint of runs in the position form.
    std::size_t (*adjoint_memory)(const LaneSetup &setup);
    void (*adjoint)(const LaneSetup &setup, const LaneAdjointHost &host, double *memory);
  };

  /// The best engine for this processor: for many bodies, or with one lane for one body.
  const LaneEngine &
  batch_engine();
  const LaneEngine &
  single_engine();

  /// The engines for an instruction set ("baseline", "avx2", "avx512") if the processor has it, else null: for
  /// comparisons.
  const LaneEngine *
  batch_engine(const char *instruction_set);
} // namespace crawler
