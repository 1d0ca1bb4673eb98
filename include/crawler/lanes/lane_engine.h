// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/step_limits.h>
#include <crawler/equation/stretch_method.h>
#include <crawler/mesh/element_tables.h>
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

  /// Coefficients of a RadauTableau (time/radau_tableau.h), with real and imaginary parts in alternation.
  struct LaneTableau
  {
    const double *c, *b, *inverse, *error_weights;
    double newton_fraction; ///< remaining error of Newton's method, relative to the tolerance
    double real_eigenvalue;
    const double *eigenvalues; ///< [pairs]
    const double *vectors;     ///< [stages][1 + pairs]
    const double *rows;        ///< [1 + pairs][stages]
  };

  /// Setup shared by all lanes: the mesh, the element and the method. All arrays belong to the caller.
  struct LaneSetup
  {
    unsigned int degree, n_cells, n_stages;
    const double *sizes; ///< [n_cells] sizes of the cells
    ElementTables element;
    unsigned int n_samples;           ///< samples of the stretch per cell
    const double *sample_derivatives; ///< [n_samples][degree+1]
    LaneTableau method;

    unsigned int laws = LaneLaws::plain; ///< LaneLaws of the bodies and grounds of a run

    // The stretch form (lane_stretch.h), whose points are the middles of its cells.
    bool is_stretch = false;
    StretchMethod stretch{};
    Direction direction{}; ///< of the ground, for an engine with one lane
  };

  /// Progress of a body at an accepted state, besides the state.
  struct LaneProgress
  {
    double t    = 0.;             ///< time of the state
    double next = 1., old_h = 1.; ///< sizes of the next step, and of the last one
    double known_rate  = 1.;      ///< convergence rate of Newton's method
    unsigned int steps = 0, rejected = 0, failures = 0;
    unsigned int output_time = 0, limit = 0; ///< numbers of the next output time, and of the present limit
    unsigned int first_step = 0;             ///< steps before the last start
    unsigned long newton    = 0;             ///< iterations

    void
    exchange(auto &archive)
    {
      archive(t, next, old_h, known_rate, steps, rejected, failures, output_time, limit, first_step, newton);
    }
  };

  /// State of a body at all quadrature points, and the arrays into which the host writes the values of the laws there.
  /// Arrays that LaneLaws does not need are null, as are unwanted derivatives.
  struct LanePoints
  {
    double t;
    const double *u, *v, *w, *rate; ///< displacement, velocity, stretch and its rate
    double *g, *w_dg;               ///< friction law and its derivative by log w
    double *c, *c_x;                ///< profile of the ground at s + u, and its slope
    double *m, *m_w, *m_rate;       ///< active stress with feedback, and its derivatives by the stretch and its rate
  };

  /// Host that evaluates the laws of a body that the engine leaves to it.
  class LawHost
  {
  public:
    virtual ~LawHost() = default;

    /// Evaluates the laws in the position form; false if one of them has no meaning for this state.
    virtual bool
    evaluate(const LanePoints &points);

    /// Evaluates the laws of a general body in the stretch form, with the active stress @p m, for the stretch @p w and
    /// its rate at each cell, for an engine with one lane; the arrays belong to the host and are valid until its next
    /// call. Returns a number that is not positive if a law has no meaning there.
    virtual double
    evaluate_cells(double t, const double *m, const double *w, const double *rate, CellLaws<double> &laws);
  };

  /// Laws of a body, and of its ground.
  struct LaneBody
  {
    double k = 1., a = 0.; ///< elastic modulus, friction exponent
    // Profiles and ground of a general body in the position form.
    const double *k_profile = nullptr, *friction_profile = nullptr; ///< [points] k(s)/k and b(s)
    Direction direction{};                                          ///< of the ground
    LawHost *host = nullptr; ///< evaluates the laws of a general body; null: the lane is at rest
  };

  /// Run of a body; by default it stays at rest.
  struct LaneJob
  {
    LaneBody body;
    double tolerance        = 1.; ///< root mean square error of a step; in the stretch form the largest error
    double initial_step     = 1.;
    const StepLimit *limits = nullptr; ///< limits of its steps
    unsigned int n_limits   = 0;
    unsigned int max_steps  = 0;
    double least_stretch    = 0.;      ///< smaller stretches are given up; the full path must tell what they mean
    LaneProgress progress   = {};      ///< where it starts, or continues
    const double *start     = nullptr; ///< [unknowns] displacement there; null: rest
    const double *old_z     = nullptr; ///< [stages][unknowns] of the step before, as in LaneStep; null: there is none
    /// Ascending times after the start where steps must end; the run ends at the last.
    const double *output_times  = nullptr;
    unsigned int n_output_times = 0;
    /// Flags [n_output_times] of times when the active stress jumps, so the body starts anew there; null: none are.
    const unsigned char *restarts = nullptr;
  };

  /// Stage of an accepted step (the last one is its end).
  struct LaneStage
  {
    double min_stretch, max_stretch;     ///< extremes among the samples
    unsigned int min_sample, max_sample; ///< cell*n_samples + sample
    // Energy and rates, if they are requested (CellIntegrals).
    double elastic_energy, stress_power, positive_power, absolute_power, dissipation, net_friction, abs_friction;
    double left_velocity, right_velocity; ///< velocities of the ends of the body
    // Stretch at both ends and its rate, if the active stress depends on them, too.
    double end_stretch[2], end_rate[2];
  };

  /// Accepted step of a lane. The pointers are valid until the next advance(); element i is at [i*stride].
  struct LaneStep
  {
    double time, size;
    bool is_output_time;
    std::size_t stride;
    const double *y;         ///< [unknowns] displacement
    const double *z;         ///< [stages][unknowns] displacements in the stages relative to the start of the step
    const LaneStage *stages; ///< [n_stages]; the last one alone is filled unless `look_inside` is set
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
    const LaneProgress *progress;
  };

  /// Host that supplies the bodies and takes the answers.
  class LaneHost
  {
  public:
    virtual ~LaneHost() = default;

    bool look_inside = false; ///< request for stretch and rates in all stages, of the position form

    /// Supplies the next body for a lane; false if there is none.
    virtual bool
    take(unsigned int lane, LaneJob &job) = 0;
    /// Writes m at all quadrature points [cell][point]. Called at the start, in all stages of each tried step, and once
    /// more after a step to a time when m jumps, for its values from then on.
    virtual void
    stress(unsigned int lane, double t, double *m) = 0;
    /// Observes each accepted step; false stops the lane.
    virtual bool
    accepted(unsigned int lane, const LaneStep &step) = 0;
    virtual void
    done(unsigned int lane, const LaneOutcome &outcome) = 0;
  };

  class LaneAdjointHost;
  struct LanePast;

  /// Engine compiled for one instruction set and one number of lanes.
  struct LaneEngine
  {
    const char *instruction_set;
    unsigned int lanes;
    /// Number of doubles that start() and advance() need, aligned to 64 bytes.
    std::size_t (*memory)(const LaneSetup &setup);
    /// Begins with the bodies of a host. All arguments must outlive the last advance().
    void (*start)(const LaneSetup &setup, LaneHost &host, double *memory);
    /// Tries one step of all bodies in the lanes, after lanes without a body took the next one; false if there is none
    /// left. The data that the host sees of a step are valid until then.
    bool (*advance)(const LaneSetup &setup, double *memory);
    /// Memory for the adjoint of a run in the position form, and its computation, with one lane in any case. False if
    /// the iteration for the stages of a step does not converge.
    std::size_t (*adjoint_memory)(const LaneSetup &setup);
    bool (*adjoint)(
      const LaneSetup &setup, LaneAdjointHost &host, const LaneBody &body, const LanePast &past, double *memory);
  };

  /// Best engine for this processor: for many bodies, or with one lane for one body.
  const LaneEngine &
  batch_engine();
  const LaneEngine &
  single_engine();

  /// Engines for an instruction set ("baseline", "avx2", "avx512") if the processor has it, else null: for comparisons.
  const LaneEngine *
  batch_engine(const char *instruction_set);

  /// Instruction set that the environment variable CRAWLER_INSTRUCTION_SET requests for all lanes ("baseline", "avx2",
  /// "avx512"), else null. Throws InputError if there is no such set, or if this processor does not have it.
  const char *
  forced_instruction_set();
} // namespace crawler
