// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/words.h>

#include <optional>
#include <string>

namespace crawler
{
  class Declarations;

  /// Engine that carries out an integrator.
  enum class Engine
  {
    automatic,
    petsc ///< never the fused engine
  };
  template <>
  inline constexpr const char *words_of<Engine>[] = {"automatic", "petsc"};

  enum class StepControl
  {
    adaptive,
    fixed
  };
  template <>
  inline constexpr const char *words_of<StepControl>[] = {"adaptive", "fixed"};

  /// Option to end a run when its cycles repeat.
  enum class CycleStopMode
  {
    automatic,
    on,
    off
  };
  template <>
  inline constexpr const char *words_of<CycleStopMode>[] = {"automatic", "on", "off"};

  /// Section "Time"; empty entries are chosen from the wanted accuracy.
  struct TimeParameters
  {
    double end_time          = 1.;
    std::string integrator   = "automatic";
    Engine engine            = Engine::automatic;
    unsigned int order       = 5;
    StepControl step_control = StepControl::adaptive;
    std::optional<double> tolerance;    ///< absolute, in the displacement [length]
    std::optional<double> initial_step; ///< [time]
    unsigned int max_steps = 100000000;
    std::optional<double> wall_time_limit; ///< of a run [s]
    double checkpoint_interval = 60.;      ///< [s]
    CycleStopMode cycle_stop   = CycleStopMode::automatic;

    std::string petsc_prefix; ///< prefix of PETSc's options; not an entry of the file

    void
    add_parameters(Declarations &declarations);

    /// Throws InputError if the entries do not fit together.
    void
    validate() const;
  };
} // namespace crawler
