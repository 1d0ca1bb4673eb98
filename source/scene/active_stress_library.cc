// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/none.h>
#include <crawler/scene/active_stress_library.h>

#include <functional>

namespace crawler
{
  namespace
  {
    struct Generator
    {
      std::string name, description;
      std::function<std::unique_ptr<ActiveStress>(const ActiveStressParameters &, const Body &, double)> create;
    };

    /// The one list of all generators.
    const std::vector<Generator> &
    generators()
    {
      static const std::vector<Generator> list = {
        {"none",
         NoActiveStress::description,
         [](const auto &, const Body &, double)
         {
           return std::make_unique<NoActiveStress>();
         }},
        {"optimal wave",
         OptimalWave::description,
         [](const auto &parameters, const Body &body, const double end_time)
         {
           return std::make_unique<OptimalWave>(parameters.optimal_wave, body, end_time);
         }},
        {"travelling wave",
         TravellingWave::description,
         [](const auto &parameters, const Body &body, const double end_time)
         {
           return std::make_unique<TravellingWave>(parameters.travelling_wave, body.length, end_time);
         }},
        {"standing wave",
         StandingWave::description,
         [](const auto &parameters, const Body &body, const double end_time)
         {
           return std::make_unique<StandingWave>(parameters.standing_wave, body.length, end_time);
         }},
        {"pulse",
         Pulse::description,
         [](const auto &parameters, const Body &body, const double end_time)
         {
           return std::make_unique<Pulse>(parameters.pulse, body.length, end_time);
         }},
        {"expression",
         Expression::description,
         [](const auto &parameters, const Body &body, const double end_time)
         {
           return std::make_unique<Expression>(parameters.expression, body.length, end_time);
         }},
        {"prescribed strain",
         PrescribedStrain::description,
         [](const auto &parameters, const Body &body, const double end_time)
         {
           return std::make_unique<PrescribedStrain>(parameters.prescribed_strain, body, end_time);
         }},
        {"strain feedback",
         StrainFeedback::description,
         [](const auto &parameters, const Body &body, const double end_time)
         {
           return std::make_unique<StrainFeedback>(parameters.strain_feedback, body.length, end_time);
         }},
        {"table",
         ActiveStressTable::description,
         [](const auto &parameters, const Body &body, const double end_time)
         {
           return std::make_unique<ActiveStressTable>(parameters.table, body.length, end_time);
         }},
      };
      return list;
    }
  } // namespace

  void
  ActiveStressParameters::add_parameters(Declarations &declarations)
  {
    std::vector<std::string> names;
    std::string documentation = "What makes the active stress: ";
    for (const Generator &entry : generators())
    {
      documentation += (names.empty() ? "" : "; ") + entry.name + " (" + entry.description + ")";
      names.push_back(entry.name);
    }
    declarations.enter("Active stress");
    declarations.choice("Generator", generator, names, documentation + ".");
    optimal_wave.add_parameters(declarations);
    travelling_wave.add_parameters(declarations);
    standing_wave.add_parameters(declarations);
    pulse.add_parameters(declarations);
    expression.add_parameters(declarations);
    prescribed_strain.add_parameters(declarations);
    strain_feedback.add_parameters(declarations);
    table.add_parameters(declarations);
    declarations.leave();
  }

  std::unique_ptr<ActiveStress>
  create_active_stress(const ActiveStressParameters &parameters, const Body &body, const double end_time)
  {
    for (const Generator &entry : generators())
      if (entry.name == parameters.generator)
        return entry.create(parameters, body, end_time);
    throw std::logic_error("the parameters name a generator that is not in the list");
  }
} // namespace crawler
