// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/host_laws.h>
#include <crawler/lanes/lane_tables.h>
#include <crawler/time/stepper.h>

namespace crawler
{
  /// Outcome, without a status, of a body that has come so far.
  TimeOutcome
  outcome_at(const LaneProgress &progress);

  /**
   * One body by the fused engine (lane_engine.h): the method of the PETSc type "radau", without its objects. A problem
   * that it cannot solve it gives up, with the reason `gave_up` and the last accepted state: then the time stepper of
   * PETSc goes on from there, or finds out what is wrong.
   */
  class LaneStepper : public Stepper, private LaneHost
  {
  public:
    static constexpr const char *gave_up = "gave_up";

    /// @p scene is in natural units; it must fit (fits_lanes, reason_against_stretch_form) and outlive the stepper.
    LaneStepper(const Scene &scene, const LaneMethod &method);

    void
    begin(ConstVector y, const Course &course) override;
    const Step *
    next() override;
    ConstVector
    state() const override
    {
      return y_;
    }
    TimeOutcome
    outcome() override;
    void
    interpolate(double time, Vector y) override;
    bool
    exchange(Archive &archive) override;

    using LaneHost::look_inside; // to be set before begin()
    /// Last step, until the next one.
    const LaneStep &
    lane_step() const
    {
      return lane_step_;
    }
    const LaneTables &
    tables() const
    {
      return *tables_;
    }

    /// Stretch and friction where a friction law was not positive, since begin(); nothing if all were.
    std::optional<std::pair<double, double>>
    bad_friction() const
    {
      return cell_laws_ ? cell_laws_->bad_friction : std::nullopt;
    }

  private:
    bool
    take(unsigned int lane, LaneJob &job) override;
    void
    stress(unsigned int lane, double t, double *m) override;
    bool
    accepted(unsigned int lane, const LaneStep &step) override;
    void
    done(unsigned int lane, const LaneOutcome &outcome) override;
    void
    show_rates();

    const Scene &scene_;
    const std::shared_ptr<const LaneTables> tables_;
    LaneSetup setup_;
    std::optional<HostLaws> laws_;          ///< laws of a general body in the position form
    std::optional<HostCellLaws> cell_laws_; ///< laws in the stretch form
    const std::unique_ptr<ActiveStressAtPoints> stress_;
    LaneStorage memory_;

    // State since begin().
    Course course_;
    LaneProgress progress_;     ///< progress at the last accepted state
    std::vector<double> old_z_; ///< stages of the step before, until the first one of a run that continues
    std::vector<double> y_;
    LaneStep lane_step_;
    std::optional<Step> step_;       ///< step that next() makes
    std::optional<TimeOutcome> end_; ///< outcome, if the run has ended
  };
} // namespace crawler
