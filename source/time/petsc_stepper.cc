// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/petsc_object.h>
#include <crawler/base/petsc_releases.h>
#include <crawler/time/integrators.h>
#include <crawler/time/petsc_stepper.h>
#include <crawler/time/radau.h>
#include <crawler/time/radau_loops.h>
#include <crawler/time/vec_access.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <petsc/private/tsimpl.h>
#include <set>

namespace crawler
{
  namespace
  {
    /// Remaining error of Newton's method, relative to the admissible error of a step.
    constexpr double newton_fraction = 0.01;
    /// Version for an error that is only predicted, with the constant of an earlier step.
    constexpr double predicted_fraction = 0.1 * newton_fraction;

    /// Keeps PETSc's duplicate of a communicator until PETSc frees it at its end; otherwise it would be made and freed
    /// with the objects of every time stepper.
    void
    keep_duplicate(MPI_Comm communicator)
    {
      static std::set<MPI_Comm> kept;
      if ((communicator != MPI_COMM_WORLD && communicator != MPI_COMM_SELF) || !kept.insert(communicator).second)
        return;
      MPI_Comm duplicate = MPI_COMM_NULL;
      petsc(PetscCommDuplicate(communicator, &duplicate, nullptr));
    }

    class PetscStepper : public Stepper
    {
    public:
      PetscStepper(MPI_Comm communicator, ImplicitSystem &system, const TimeParameters &parameters)
        : system_(system)
        , parameters_(parameters)
      {
        keep_duplicate(communicator);
        Vec vec = nullptr;
        petsc(VecCreate(communicator, &vec));
        solution_.reset(vec);
        petsc(VecSetSizes(vec, static_cast<PetscInt>(system_.n_owned()), PETSC_DECIDE));
        petsc(VecSetType(vec, VECSTANDARD));
        petsc(VecDuplicate(solution_.get(), &vec));
        residual_.reset(vec);
        Mat mat          = nullptr;
        const auto local = static_cast<PetscInt>(system_.n_owned());
        petsc(MatCreateShell(communicator, local, local, PETSC_DECIDE, PETSC_DECIDE, this, &mat));
        const PetscOwner<Mat> jacobian(mat);
        petsc(MatShellSetOperation(mat, MATOP_MULT, reinterpret_cast<ShellOperation>(multiply)));

        petsc(register_radau());
        TS stepper = nullptr;
        petsc(TSCreate(communicator, &stepper));
        ts_.reset(stepper);
        petsc(TSSetApplicationContext(stepper, this));
        petsc(TSSetIFunction(stepper, residual_.get(), function, this));
        petsc(TSSetIJacobian(stepper, mat, mat, jacobian_function, this));
        petsc(TSSetSolution(stepper, solution_.get()));
        set_options();
      }


      void
      begin(const ConstVector start, const Course &course) override
      {
        TS stepper           = ts_.get();
        progress_            = {};
        course_              = course;
        course_.tolerance    = user_tolerance_.value_or(course.tolerance);
        course_.initial_step = user_step_.value_or(course.initial_step);
        if (goes_on_)
        {
          (*goes_on_)(course_.start, progress_);
          goes_on_->require(progress_.next_end < course_.ends.size() && progress_.limit <= course_.limits.size(),
                            "the next step");
        }
        y_.assign(start.begin(), start.end());
        {
          const WriteAccess access(solution_.get());
          std::copy(start.begin(), start.end(), access.span.begin());
        }
        petsc(TSSetTolerances(stepper, course_.tolerance, nullptr, ts_->rtol, nullptr));
        petsc(TSSetTime(stepper, course_.start));
        petsc(TSSetStepNumber(stepper, 0));
        ts_->reject = ts_->snes_its = ts_->ksp_its = 0;
        petsc(TSSetMaxTime(stepper, course_.ends.back()));
        petsc(TSSetTimeStep(stepper, course_.initial_step));
        petsc(TSRestartStep(stepper));
        if (goes_on_)
          radau_exchange(stepper, *goes_on_);
        goes_on_.reset();
        show();
      }

      const Step *
      next() override
      {
        std::optional<TimeOutcome> &end = progress_.end;
        if (end)
          return nullptr;
        choose_step();
        const PetscErrorCode code = make_step();
        guarded_.rethrow();
        TSConvergedReason reason;
        petsc(TSGetConvergedReason(ts_.get(), &reason));
        const Step *const made = code == 0 && reason >= 0 ? arrive() : nullptr;
        if (made == nullptr)
          end = failure(code);
        else if (progress_.next_end == course_.ends.size())
        {
          end         = counts();
          end->status = Status::finished;
        }
        else if (reason == TS_CONVERGED_ITS)
        {
          end          = counts();
          end->status  = Status::stopped;
          end->reason  = "step_limit";
          end->message = "the maximum number of steps was reached";
        }
        if (made != nullptr)
          show();
        if (end)
          petsc(PetscObjectViewFromOptions(reinterpret_cast<PetscObject>(ts_.get()), nullptr, "-ts_view"));
        return made;
      }

      ConstVector
      state() const override
      {
        return y_;
      }

      TimeOutcome
      outcome() override
      {
        return progress_.end ? *progress_.end : counts();
      }

      /// Exchanges the state; only the radau methods can.
      bool
      exchange(Archive &archive) override
      {
        if (stage_places_.empty())
          return false;
        if (archive.reads())
        {
          std::string bytes;
          archive(bytes);
          goes_on_.emplace(std::move(bytes));
          return true;
        }
        Archive own;
        own(ts_->ptime, progress_);
        radau_exchange(ts_.get(), own);
        std::string bytes = own.bytes();
        archive(bytes);
        return true;
      }

      void
      interpolate(const double time, const Vector result) override
      {
        // Times outside of the step are refused by PETSc, even by a last bit: it takes the start of a step as its end
        // less its size.
        const double from = ts_->ptime_prev, to = ts_->ptime;
        const double inside = std::clamp(time, from, to);
        const bool is_there = std::abs(inside - time) <= 1e-12 * std::abs(to);
        petsc(TSInterpolate(ts_.get(), is_there ? inside : time, residual_.get()));
        const ReadAccess access(residual_.get());
        std::copy(access.span.begin(), access.span.end(), result.begin());
      }

    private:
      /// Progress since begin().
      struct Progress
      {
        std::size_t next_end           = 0;
        unsigned int limit             = 0;     ///< number of the present limit
        double refused_at              = -1.;   ///< time of the last refused state
        double nonfinite_at            = -1.;   ///< time of the last residual that was not finite
        bool underflow                 = false; ///< a step is below the resolution of the time
        double convergence_constant    = std::numeric_limits<double>::infinity();
        double last_correction         = 0.;
        Step step                      = {};
        std::optional<TimeOutcome> end = {}; ///< outcome, once the course has ended

        void
        exchange(Archive &archive)
        {
          archive(next_end, limit, refused_at, nonfinite_at);
        }
      };

      /// Sets the choices of the program, then the user's options after "--".
      void
      set_options()
      {
        const Integrator &method = integrator(parameters_.integrator);
        TS stepper               = ts_.get();
        petsc(TSSetOptionsPrefix(stepper, parameters_.petsc_prefix.c_str()));
        petsc(TSSetProblemType(stepper, TS_NONLINEAR));
        petsc(TSSetType(stepper, method.petsc_type.c_str()));
        if (method.petsc_type == "bdf")
          petsc(TSBDFSetOrder(stepper, static_cast<PetscInt>(parameters_.order)));
        if (method.petsc_type == radau_type)
          radau_set_stages(stepper, method.n_stages);
        TSAdapt adapt = nullptr;
        petsc(TSGetAdapt(stepper, &adapt));
        petsc(TSAdaptSetType(adapt, parameters_.step_control == StepControl::fixed ? TSADAPTNONE : TSADAPTBASIC));
        if (method.petsc_type == radau_type)
          petsc(TSAdaptSetClip(adapt, radau::min_change, radau::max_change));
        petsc(TSSetExactFinalTime(stepper, TS_EXACTFINALTIME_STEPOVER)); // choose_step() sets the ends of steps
        petsc(TSSetMaxSNESFailures(stepper, -1));
        petsc(TSSetMaxStepRejections(stepper, 30));
        petsc(TSSetErrorIfStepFails(stepper, PETSC_FALSE));
        petsc(TSSetMaxSteps(stepper, static_cast<PetscInt>(parameters_.max_steps)));
        stepper->rtol = 0.; // unless the user has another

        set_newton();
        apply_user_options();
      }

      /// Newton's method with exact elimination, or with that as preconditioner of a Krylov method.
      void
      set_newton()
      {
        constexpr double krylov_tolerance = 1e-6; // Newton's method is quadratic
        TS stepper                        = ts_.get();
        SNES snes                         = nullptr;
        SNESLineSearch line_search        = nullptr;
        KSP ksp                           = nullptr;
        PC pc                             = nullptr;
        petsc(TSGetSNES(stepper, &snes));
        petsc(SNESSetType(snes, SNESNEWTONLS));
        petsc(SNESGetLineSearch(snes, &line_search));
        petsc(SNESLineSearchSetType(line_search, SNESLINESEARCHBASIC));
        // No tolerance of the correction: a line search that fails after a small one would count as converged.
        petsc(
          SNESSetTolerances(snes, PETSC_DEFAULT, PETSC_DEFAULT, /*correction=*/0., /*iterations=*/10, PETSC_DEFAULT));
        petsc(SNESSetConvergenceTest(snes, newton_converged, this, nullptr));
        petsc(SNESGetKSP(snes, &ksp));
        petsc(KSPSetType(ksp, system_.solves_exactly() ? KSPPREONLY : KSPGMRES));
        petsc(KSPSetPCSide(ksp, PC_RIGHT)); // residuals are the true ones
        petsc(KSPSetTolerances(ksp, krylov_tolerance, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
        petsc(KSPGetPC(ksp, &pc));
        petsc(PCSetType(pc, PCSHELL));
        petsc(PCShellSetContext(pc, this));
        petsc(PCShellSetName(pc, "block-tridiagonal elimination"));
        petsc(PCShellSetSetUp(pc, set_up_preconditioner));
        petsc(PCShellSetApply(pc, precondition));
      }

      /// Applies the user's options after "--"; the integrator must be among those offered.
      void
      apply_user_options()
      {
        TS stepper          = ts_.get();
        PetscErrorCode code = 0;
        std::string words;
        {
          PetscErrorWords error;
          code  = TSSetFromOptions(stepper);
          words = error.text;
        }
        if (code != 0)
          throw InputError("PETSc refuses an option after \"--\": " + words);

        // Options that begin() resets each time.
        const auto option = [&](const char *option_name) {
          PetscReal value = 0.;
          PetscBool found = PETSC_FALSE;
          petsc(PetscOptionsGetReal(nullptr, parameters_.petsc_prefix.c_str(), option_name, &value, &found));
          return found ? std::optional<double>(value) : std::nullopt;
        };
        user_tolerance_ = option("-ts_atol");
        user_step_      = option("-ts_dt");
        if (option("-ts_max_time"))
          throw InputError(
            "the PETSc option -ts_max_time is refused: Time/End time is expected to say when the run ends");

        TSType type = nullptr;
        petsc(TSGetType(stepper, &type));
        std::string name = type;
        if (name == radau_type)
        {
          stage_places_ = radau_set_system(stepper, &system_, &guarded_).c;
          name += " " + std::to_string(2 * stage_places_.size() - 1);
        }
        if (is_offered(name))
          return;
        const std::string reason = reason_against(name);
        throw InputError("the PETSc integrator \"" + name + "\" (option -ts_type) is refused: " +
                         (reason.empty() ? "it is not tested for a mass matrix that depends on the state" : reason) +
                         "; \"bdf\" or \"radau\" is expected");
      }

      static PetscErrorCode
      function(TS ts, const PetscReal t, Vec y, Vec y_dot, Vec F, void *context)
      {
        auto &self                = *static_cast<PetscStepper *>(context);
        bool accepted             = true;
        const PetscErrorCode code = self.guarded_([&]() {
          const ReadAccess y_access(y), y_dot_access(y_dot);
          const WriteAccess F_access(F);
          if (self.stage_rates)
            self.stage_rates(t, y_dot_access.span);
          accepted   = self.system_.residual(t, y_access.span, y_dot_access.span, F_access.span);
          double sum = 0.;
          for (const double value : F_access.span)
            sum += value;
          if (accepted && !std::isfinite(sum))
            self.progress_.nonfinite_at = t;
        });
        if (code == 0 && !accepted)
        {
          self.progress_.refused_at = t;
          return SNESSetFunctionDomainError(ts->snes);
        }
        return code;
      }

      static PetscErrorCode
      jacobian_function(TS, const PetscReal t, Vec y, Vec y_dot, const PetscReal shift, Mat A, Mat, void *context)
      {
        auto &self                = *static_cast<PetscStepper *>(context);
        const PetscErrorCode code = self.guarded_([&]() {
          const ReadAccess y_access(y), y_dot_access(y_dot);
          self.jacobian_ok_ = self.system_.setup_jacobian(t, y_access.span, y_dot_access.span, shift);
        });
        if (code != 0)
          return code;
        MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY); // tells PETSc that the matrix has changed
        return MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY);
      }

      static PetscErrorCode
      multiply(Mat A, Vec x, Vec y)
      {
        auto &self = context_of<PetscStepper>(A);
        return self.guarded_([&]() {
          const ReadAccess x_access(x);
          const WriteAccess y_access(y);
          self.system_.jacobian_vmult(x_access.span, y_access.span);
        });
      }

      static PetscErrorCode
      set_up_preconditioner(PC pc)
      {
        return PCSetFailedReason(pc,
                                 context_of<PetscStepper>(pc).jacobian_ok_ ? PC_NOERROR : PC_FACTOR_NUMERIC_ZEROPIVOT);
      }

      static PetscErrorCode
      precondition(PC pc, Vec x, Vec y)
      {
        auto &self = context_of<PetscStepper>(pc);
        return self.guarded_([&]() {
          const ReadAccess x_access(x);
          const WriteAccess y_access(y);
          self.system_.solve_with_jacobian(x_access.span, y_access.span);
        });
      }

      /**
       * Convergence test of Newton's method, which converges quadratically with an exact Jacobian: after a correction d
       * the remaining error is about C d^2. C is taken from the last solve that needed two corrections; before the
       * first, two are made.
       */
      static PetscErrorCode
      newton_converged(SNES,
                       const PetscInt it,
                       const PetscReal x_norm,
                       const PetscReal dx_norm,
                       const PetscReal F_norm,
                       SNESConvergedReason *reason,
                       void *context)
      {
        if (ends_without_correction(it, dx_norm, F_norm, *reason))
          return 0;
        auto &self     = *static_cast<PetscStepper *>(context);
        Progress &past = self.progress_;
        PetscInt n     = 0;
        VecGetSize(self.solution_.get(), &n);
        // Norms in units of the admissible error.
        const double unit = self.course_.tolerance, rms = 1. / std::sqrt(static_cast<double>(n));
        const double d = dx_norm / unit * rms, rounding = 1e-15 * (x_norm / unit) * rms;
        if (it >= 2 && past.last_correction > 0.)
          past.convergence_constant = d / (past.last_correction * past.last_correction);
        past.last_correction = d;
        const bool small     = d <= newton_fraction || past.convergence_constant * d * d <= predicted_fraction;
        if (small || d <= rounding)
          *reason = SNES_CONVERGED_SNORM_RELATIVE;
        return 0;
      }

      /// Shortens the step so that it, or the next one, ends at a required time.
      void
      choose_step()
      {
        const bool is_fixed = parameters_.step_control == StepControl::fixed;
        double size         = course_.initial_step;
        if (!is_fixed)
          size = admitted_step(course_.limits.data(),
                               static_cast<unsigned int>(course_.limits.size()),
                               progress_.limit,
                               ts_->ptime,
                               ts_->time_step);
        const double remaining = course_.ends[progress_.next_end] - ts_->ptime;
        if (size >= remaining * (1. - 1e-9))
          size = remaining;
        else if (!is_fixed && size > 0.5 * remaining)
          size = 0.5 * remaining;
        petsc(TSSetTimeStep(ts_.get(), size));
      }

      /// Makes a step; errors are returned as codes, not printed.
      PetscErrorCode
      make_step()
      {
        petsc(PetscPushErrorHandler(PetscReturnErrorHandler, nullptr));
        const PetscErrorCode code = TSStep(ts_.get());
        petsc(PetscPopErrorHandler());
        return code;
      }

      /// Completes an accepted step; null if there was none.
      const Step *
      arrive()
      {
        double time           = ts_->ptime;
        const double previous = ts_->ptime_prev;
        const double end      = course_.ends[progress_.next_end];
        const bool is_end     = std::abs(time - end) <= 1e-13 * std::max(end - previous, end);
        if (is_end)
        {
          time = end;
          ++progress_.next_end;
          petsc(TSSetTime(ts_.get(), time));
        }
        const double size = time - previous;
        if (!(size > 4. * std::numeric_limits<double>::epsilon() * time))
        {
          progress_.underflow = true; // shorter steps do not help, and `size` cannot be a divisor
          return nullptr;
        }
        const TimeOutcome so_far = counts();
        progress_.step           = {time, size, so_far.steps, is_end, so_far.rejected_steps, so_far.newton_iterations};
        const ReadAccess access(solution_.get());
        std::copy(access.span.begin(), access.span.end(), y_.begin());
        return &progress_.step;
      }

      /// Shows the state to the monitors of PETSc's options.
      void
      show()
      {
        petsc(TSMonitor(ts_.get(), ts_->steps, ts_->ptime, solution_.get()));
      }

      TimeOutcome
      counts() const
      {
        TimeOutcome result;
        result.time              = ts_->ptime;
        result.step_size         = ts_->time_step;
        result.steps             = static_cast<unsigned int>(ts_->steps);
        result.rejected_steps    = static_cast<unsigned int>(ts_->reject);
        result.newton_iterations = static_cast<unsigned long>(ts_->snes_its);
        return result;
      }

      /// Names the failure that PETSc reports.
      TimeOutcome
      failure(const PetscErrorCode code)
      {
        TimeOutcome result = counts();
        SNESConvergedReason newton_reason;
        SNESGetConvergedReason(ts_->snes, &newton_reason);
        // Refused states and residuals count if their times were close: they made the steps small. Each rank knows its
        // own.
        double latest[2] = {progress_.refused_at, progress_.nonfinite_at};
        MPI_Allreduce(
          MPI_IN_PLACE, latest, 2, MPI_DOUBLE, MPI_MAX, PetscObjectComm(reinterpret_cast<PetscObject>(ts_.get())));
        const double close  = result.time - 1e-6 * parameters_.end_time;
        result.status       = Status::failed;
        result.domain_error = latest[0] >= close;
        const auto named    = [&](const char *reason, const std::string &message) {
          result.reason  = reason;
          result.message = message;
          return result;
        };
        if (code != 0)
        {
          const char *text = nullptr;
          PetscErrorMessage(code, &text, nullptr);
          return named("petsc_error",
                       std::string("PETSc stopped with the error: ") + (text != nullptr ? text : "unknown"));
        }
        if (latest[1] >= close)
          return named("nonfinite", "the residual is not a finite number");
        if (newton_reason == SNES_DIVERGED_LINEAR_SOLVE)
          return named("linear_failed", "the linear system of Newton's method is singular or could not be solved");
        if (progress_.underflow || result.step_size < 1e-13 * parameters_.end_time)
          return named("step_underflow", "the step size fell below the resolution of the time");
        if (newton_reason < 0)
          return named("newton_diverged",
                       std::string("Newton's method did not converge (") + SNESConvergedReasons[newton_reason] + ")");
        return named("rejection_limit", "a step was rejected too many times: its error stays above the tolerance");
      }

      ImplicitSystem &system_;
      const TimeParameters parameters_;

      PetscOwner<Vec> solution_;
      PetscOwner<Vec> residual_; ///< between steps for interpolated states
      PetscOwner<TS> ts_;
      std::optional<double> user_tolerance_, user_step_; ///< options -ts_atol and -ts_dt
      PetscGuard guarded_;
      bool jacobian_ok_ = true;

      Course course_ = {}; ///< with the user's options
      Progress progress_;
      std::vector<double> y_;          ///< state after `progress_.step`
      std::optional<Archive> goes_on_; ///< where begin() is to continue from
    };
  } // namespace


  std::unique_ptr<Stepper>
  petsc_stepper(MPI_Comm communicator, ImplicitSystem &system, const TimeParameters &parameters)
  {
    return std::make_unique<PetscStepper>(communicator, system, parameters);
  }

  std::string
  integrator_of_petsc(const std::string &otherwise)
  {
    char type[64]   = "";
    PetscBool found = PETSC_FALSE;
    petsc(PetscOptionsGetString(nullptr, nullptr, "-ts_type", type, sizeof(type), &found));
    return found ? type : otherwise;
  }
} // namespace crawler
