// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/equation/assembler.h>
#include <crawler/equation/energy_balance.h>
#include <crawler/output/picture_times.h>
#include <crawler/time/stepper.h>

#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace crawler
{
  /// Numbers of a state: a row of the statistics.
  struct StateNumbers
  {
    Step step{};              ///< with the time of this state, which may be within the step
    double displacement = 0.; ///< of the centre of mass
    StretchRange stretch{};
    double velocity              = 0.; ///< of the centre of mass
    EnergyBalance energy_balance = {};
    double net_friction          = std::numeric_limits<double>::quiet_NaN();

    /// Returns them in the user's units, from natural ones.
    StateNumbers
    in_units(const Units &units) const
    {
      StateNumbers result = *this;
      result.step.time *= units.time;
      result.step.size *= units.time;
      result.displacement *= units.length;
      for (StretchAt *extreme : {&result.stretch.min, &result.stretch.max})
        extreme->s *= units.length;
      result.velocity *= units.velocity();
      result.energy_balance = energy_balance.scaled(units.energy());
      result.net_friction *= units.force;
      return result;
    }
  };

  /// A state of a run, read-only, in the user's units except for assembler, y, v and computed_time, which are in
  /// `units`. It is the end of an accepted step, or interpolated within one; the first is the initial state.
  struct Snapshot : StateNumbers
  {
    bool is_step_end;           ///< an accepted state
    bool is_in_lost_step;       ///< before an inversion, but later than the answer's last state
    PictureKinds pictures;      ///< pictures for which it was requested
    const Assembler &assembler; ///< mesh and formulation; may change from one snapshot to the next ...
    unsigned int mesh_number;   ///< ... together with this number
    const Units &units;
    double computed_time;
    std::span<const double> y; ///< the unknowns (assembler.h), owned values of this rank
    std::span<const double> v; ///< velocity at the nodes; only for pictures if there is no energy balance
  };

  /// Output fields at a list of points, in the user's units.
  struct Fields
  {
    std::vector<double> position, displacement, stretch, velocity, active_stress, elastic_stress, friction_force;
  };

  /// Name of a field in files, and its unit.
  struct FieldName
  {
    const char *name, *unit;
    std::vector<double> Fields::*values;
    bool in_kymograph;
    bool has_peaks; ///< a jump of the active stress makes it large for an instant
  };
  constexpr FieldName field_names[] = {
    {"stretch", "1", &Fields::stretch, true, false},
    {"position", "length", &Fields::position, false, false},
    {"displacement", "length", &Fields::displacement, true, false},
    {"velocity", "length/time", &Fields::velocity, true, true},
    {"active_stress", "force", &Fields::active_stress, true, false},
    {"elastic_stress", "force", &Fields::elastic_stress, false, false},
    {"friction_force", "force/length", &Fields::friction_force, true, true},
  };

  /// The whole body at one time, in the user's units.
  struct Frame
  {
    double time;
    unsigned int step;
    unsigned int points_per_cell;
    std::vector<double> s; ///< of the points of all cells, ends included: two at each cell boundary [length]
    Fields fields;
  };

  /// A state of a level without a mesh, in the user's units: its body is one cell.
  struct StateWithoutMesh : StateNumbers
  {
    PictureKinds pictures; ///< pictures for which it was requested
    Frame frame;
  };

  /// Sees the accepted states of a run and the requested ones. Called on all ranks together.
  class Observer
  {
  public:
    virtual ~Observer() = default;

    virtual void
    observe(const Snapshot &snapshot) = 0;

    /// Counterpart for levels without a mesh, whose states are all requested (this rank alone).
    virtual void
    show(const StateWithoutMesh &)
    {
    }

    /// Exchanges the data collected so far, to continue the same files. Throws FileError if these are missing.
    virtual void
    exchange(Archive &)
    {
    }

    /// Called after the last state, however the run ended.
    virtual void
    end()
    {
    }
  };

  using Observers = std::vector<std::shared_ptr<Observer>>;

  /// Observers, one in number, that show each snapshot of a run to @p see.
  inline Observers
  watched_by(std::function<void(const Snapshot &)> see)
  {
    struct Watcher : public Observer
    {
      explicit Watcher(std::function<void(const Snapshot &)> see)
        : see(std::move(see))
      {
      }
      void
      observe(const Snapshot &snapshot) override
      {
        see(snapshot);
      }
      const std::function<void(const Snapshot &)> see;
    };
    return {std::make_shared<Watcher>(std::move(see))};
  }
} // namespace crawler
