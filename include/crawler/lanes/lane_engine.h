// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/step_limits.h>
#include <crawler/equation/stretch_method.h>
#include <crawler/scene/direction.h>

#include <cstddef>

/**
 * Kernels and time integration of a form in one piece, for meshes that do not change: the position form with the
 * p-model of friction, and the stretch form. Radau IIA with the simplified Newton method, as in time/radau.h, without
 * PETSc objects. Several bodies are computed side by side in the lanes of vector registers, each with its own
 * parameters and its own steps; a lane that is done takes the next body. No operation mixes lanes, so an answer does
 * not depend on which bodies share a batch.
 *
 * Plain data only: this header is included by code for instruction sets that the processor may not have. All numbers
 * are in natural units (scene/scene.h).
 */
namespace crawler
{
  /// Properties of bodies and grounds besides the numbers of a plain scene: bits.
  struct LaneLaws
  {
    enum Bits : unsigned int
    {
      plain                 = 0,
      general               = 1,  ///< any of the following, k(s) or gamma(s)
      direction             = 2,  ///< friction depends on the direction
      host_friction         = 4,  ///< another friction law than the power law: the host evaluates it
      host_ground           = 8,  ///< c(x): the host evaluates it
      feedback              = 16, ///< m depends on the stretch: the host evaluates it
      rate                  = 32, ///< m also depends on the stretch rate
      nonlinear_in_velocity = direction | rate
    };
  };

  /// Setup shared by all lanes: the mesh, the element (mesh/reference_element.h) and the method (time/radau_tableau.h).
  /// All arrays belong to the caller.
  struct LaneSetup
  {
    unsigned int degree, n_cells, n_stages;
    const double *sizes;                                      ///< [n_cells] sizes of the cells
    const double *values, *derivatives, *weights, *stiffness; ///< tables of the element
    unsigned int n_samples;                                   ///< samples of the stretch per cell
    const double *sample_derivatives;                         ///< [n_samples][degree+1]
    const double *c, *b, *inverse, *error_weights;            ///< coefficients of the method
    double newton_fraction; ///< remaining error of Newton's method, relative to the tolerance
    double real_eigenvalue;
    const double *eigenvalues; ///< [pairs][real, imaginary]
    const double *vectors;     ///< [stages][1 + pairs][real, imaginary]
    const double *rows;        ///< [1 + pairs][stages][real, imaginary]

    unsigned int laws = LaneLaws::plain; ///< LaneLaws of the bodies and grounds of a run

    // The stretch form (lane_stretch.h), whose points are the middles of its cells.
    bool is_stretch = false;
    StretchMethod stretch{};
    Direction direction{}; ///< of the ground, for an engine with one lane
  };

  /// Progress of a body from step to step, besides its state.
  struct LaneProgress
  {
    bool has_old = false, just_rejected = false;
    bool is_retry = false; ///< the guess is a step's failed try
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

  /// Body to compute.
  struct LaneJob
  {
    double k, a;          ///< elastic modulus, friction exponent
    double tolerance;     ///< root mean square error of a step; in the stretch form the largest error
    double newton_factor; ///< factor on LaneSetup::newton_fraction
    double initial_step;
    const StepLimit *limits; ///< limits of its steps
    unsigned int n_limits;
    unsigned int max_steps;
    double least_stretch; ///< smaller stretches are given up; the full path must tell what they mean
    bool is_last_resort;  ///< no other engine can take over where Newton's method often fails
    double start_time;
    const double *start;        ///< [unknowns] displacement at start_time; null: rest
    const double *output_times; ///< ascending times after start_time where steps must end; the run ends at the last
    unsigned int n_output_times;
    /// Flags [n_output_times] of times when the active stress jumps, so the body starts anew there; null: none are.
    const unsigned char *restarts;

    // State between two steps, for a body that continues from `start`; null: it starts.
    const LaneProgress *progress = nullptr;
    const double *old_z          = nullptr; ///< [stages][unknowns] of the step before, as in LaneStep

    // Profiles and ground of a general body in the position form.
    const double *k_profile = nullptr, *friction_profile = nullptr; ///< [points] k(s)/k and b(s)
    Direction direction{};                                          ///< of the ground
  };

  /// State of a lane at all quadrature points, and the arrays into which the host writes the values of the laws there.
  /// Arrays that LaneLaws does not need are null, as are unwanted derivatives.
  struct LanePoints
  {
    double t;
    const double *u, *v, *w, *rate; ///< displacement, velocity, stretch and its rate
    double *g, *w_dg;               ///< friction law and its derivative by log w
    double *c, *c_x;                ///< profile of the ground at s + u, and its slope
    double *m, *m_w, *m_rate;       ///< active stress with feedback, and its derivatives by the stretch and its rate
  };

  /// Stage of an accepted step (the last one is its end).
  struct LaneStage
  {
    double min_stretch, max_stretch;     ///< extremes among the samples
    unsigned int min_sample, max_sample; ///< cell*n_samples + sample
    // Rates, if they are requested (CellIntegrals).
    double stress_power, positive_power, absolute_power, dissipation, net_friction, abs_friction;
    double left_velocity, right_velocity; ///< velocities of the ends of the body
    // Stretch at both ends and its rate, if the active stress depends on them, too.
    double end_stretch[2], end_rate[2];
  };

  /// Accepted step of a lane. The pointers are valid until the next advance(); element i is at [i*stride].
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
    double elastic_energy;   ///< elastic energy at the end, if rates are requested
    bool is_settled;         ///< the velocity at the end was found, if rates are requested
    const LaneProgress *progress;
  };

  struct LaneOutcome
  {
    enum Status
    {
      finished,
      stopped, ///< stopped by the host, or at max_steps
      gave_up  ///< given up for a reason that only the full path can tell
    } status;
    double time, step_size; ///< time of the last accepted state; step that would follow
    unsigned int steps, rejected;
    unsigned long newton_iterations;
    double displacement; ///< int u ds at that time
  };

  /// Host that supplies the bodies and takes the answers. Lanes are numbered 0 to lanes - 1.
  struct LaneHost
  {
    void *context;
    /// Supplies the next body for a lane; false if there is none.
    bool (*next)(void *context, unsigned int lane, LaneJob &job);
    /// Writes m at all quadrature points [cell][point]. Called at the start, in all stages of each tried step, and once
    /// more after a step to a time when m jumps, for its values from then on.
    void (*stress)(void *context, unsigned int lane, double t, double *m);
    /// Observes each accepted step; false stops the lane. May be null.
    bool (*accepted)(void *context, unsigned int lane, const LaneStep &step);
    void (*done)(void *context, unsigned int lane, const LaneOutcome &outcome);
    bool look_inside; ///< stretch and rates in all stages, of the position form
    /// Evaluates the laws that the engine leaves to the host; false if one of them has no meaning for this state.
    bool (*laws)(void *context, unsigned int lane, const LanePoints &points) = nullptr;
    /// Evaluates the laws in the stretch form, for the stretch @p w and its rate at each cell, for an engine with one
    /// lane; the arrays belong to the host and are valid until its next call. Returns a number that is not positive if
    /// a law has no meaning there. Null: the laws of a plain body.
    double (*cell_laws)(
      void *context, double t, const double *m, const double *w, const double *rate, CellLaws<double> &laws) = nullptr;
  };

  /// Run to traverse backwards. All arrays belong to the caller.
  struct LanePast
  {
    unsigned int n_steps = 0;
    const double *times = nullptr, *sizes = nullptr; ///< [n_steps] ends and lengths of the steps
    const double *z             = nullptr;           ///< [n_steps][stages][unknowns] as in LaneStep
    const double *end           = nullptr;           ///< [unknowns] last state
    const unsigned char *starts = nullptr;           ///< [n_steps] true if a body starts anew; null: never
    const double *gradient      = nullptr; ///< [unknowns] derivative of the quantity of interest by the last state
    bool has_sources            = false;   ///< true if the quantity of interest depends on the steps, too
  };

  /// Derivatives of the quantity of interest by the states of a step themselves. The arrays are 0 before.
  struct LaneSources
  {
    double *by_end;             ///< [unknowns] the state at the end of the step
    double *by_u, *by_velocity; ///< [stages][unknowns] displacements and velocities in the stages
  };

  /// Step traversed backwards; element i is at [i*stride].
  struct LaneAdjointStep
  {
    unsigned int number; ///< counted from 0
    std::size_t stride;
    const double
      *mu; ///< [stages][unknowns] derivative of the quantity of interest by the residuals, with the sign of dF
    /// [unknowns] M^-1 times the derivative of the quantity of interest by the state at the end of the step: minus the
    /// effect of an impulse there. Null unless the body starts anew with the next step, or there is none.
    const double *zeta;
  };

  /// Host that supplies the runs and takes their adjoints.
  struct LaneAdjointHost
  {
    void *context;
    /// Supplies the next run for a lane; of @p job the laws of the body alone count. False if there is none.
    bool (*next)(void *context, unsigned int lane, LaneJob &job, LanePast &past);
    void (*step)(void *context, unsigned int lane, const LaneAdjointStep &step);
    /// @p by_start: [unknowns] derivative of the quantity of interest by the first state; invalid unless @p finished.
    void (*done)(void *context, unsigned int lane, bool finished, std::size_t stride, const double *by_start);
    bool (*laws)(void *context, unsigned int lane, const LanePoints &points) = nullptr; ///< as in LaneHost
    /// Called before each step of a run that has sources.
    void (*sources)(void *context, unsigned int lane, unsigned int step, const LaneSources &sources) = nullptr;
  };

  /// Engine compiled for one instruction set and one number of lanes.
  struct LaneEngine
  {
    const char *instruction_set;
    unsigned int lanes;
    /// Number of doubles that start() and advance() need, aligned to 64 bytes.
    std::size_t (*memory)(const LaneSetup &setup);
    /// Begins with the bodies of a host. All arguments must outlive the last advance().
    void (*start)(const LaneSetup &setup, const LaneHost &host, double *memory);
    /// Tries one step of all bodies in the lanes, after lanes without a body took the next one; false if there is none
    /// left. The data that the host sees of a step are valid until then.
    bool (*advance)(const LaneSetup &setup, double *memory);
    /// Memory and run of the adjoint of runs in the position form.
    std::size_t (*adjoint_memory)(const LaneSetup &setup);
    void (*adjoint)(const LaneSetup &setup, const LaneAdjointHost &host, double *memory);
  };

  /// Best engine for this processor: for many bodies, or with one lane for one body.
  const LaneEngine &
  batch_engine();
  const LaneEngine &
  single_engine();

  /// Engines for an instruction set ("baseline", "avx2", "avx512") if the processor has it, else null: for comparisons.
  const LaneEngine *
  batch_engine(const char *instruction_set);
} // namespace crawler
