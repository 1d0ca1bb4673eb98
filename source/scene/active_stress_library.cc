// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/none.h>
#include <crawler/scene/active_stress/shaped_wave.h>
#include <crawler/scene/active_stress_library.h>

#include <fmt/format.h>

#include <functional>

namespace crawler
{
  namespace
  {
    const std::string section = "Active stress/", name_of_sum = "sum";

    std::string
    section_of_term(const std::size_t number)
    {
      return fmt::format("{}Sum/Term {}/", section, number);
    }

    SumTerm
    create_term(const TermParameters &parameters, const std::size_t number, const Body &body, const double end_time)
    {
      const SumTermParameters &own = parameters.combination;
      const std::string entries    = section_of_term(number);
      try
      {
        return {parameters.stress.generator,
                create_active_stress(parameters.stress, body, end_time),
                own.combine == "multiply",
                own.factor,
                Window(own.in_s, 's', entries, body.length),
                Window(own.in_t, 't', entries, end_time)};
      }
      catch (const InputError &error) // the generator believes that it stands alone
      {
        const bool is_alone = error.entry.starts_with(section) && !error.entry.starts_with(entries);
        throw InputError(fmt::format("term {}: {}", number, error.what()),
                         is_alone ? entries + error.entry.substr(section.size()) : error.entry);
      }
    }

    std::unique_ptr<ActiveStress>
    create_sum(const SumParameters &parameters, const Body &body, const double end_time)
    {
      std::vector<SumTerm> terms;
      for (std::size_t i = 0; i < parameters.terms.size(); ++i)
        terms.push_back(create_term(parameters.terms[i], i + 1, body, end_time));
      return std::make_unique<Sum>(std::move(terms), body.length, end_time);
    }

    std::unique_ptr<ActiveStress>
    create_prescribed_strain(const ActiveStressParameters &parameters, const Body &body, const double end_time)
    {
      const PrescribedStrainParameters &own = parameters.prescribed_strain;
      std::unique_ptr<ActiveStress> generator;
      if (own.is_generated())
      {
        ActiveStressParameters of_strain = parameters;
        of_strain.generator              = own.given_by;
        generator                        = create_active_stress(of_strain, body, end_time);
      }
      return std::make_unique<PrescribedStrain>(own, body, end_time, std::move(generator));
    }

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
         [](const auto &, const Body &, double) { return std::make_unique<NoActiveStress>(); }},
        {"optimal wave",
         OptimalWave::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return create_optimal_wave(parameters.optimal_wave, body, end_time);
         }},
        {"travelling wave",
         TravellingWave::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return std::make_unique<TravellingWave>(parameters.travelling_wave, body.length, end_time);
         }},
        {"standing wave",
         StandingWave::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return std::make_unique<StandingWave>(parameters.standing_wave, body.length, end_time);
         }},
        {"pulse",
         Pulse::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return std::make_unique<Pulse>(parameters.pulse, body.length, end_time);
         }},
        {"expression",
         Expression::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return std::make_unique<Expression>(parameters.expression, body.length, end_time);
         }},
        {"prescribed strain",
         PrescribedStrain::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return create_prescribed_strain(parameters, body, end_time);
         }},
        {"library",
         Library::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return std::make_unique<Library>(parameters.library, body, end_time);
         }},
        {"segments",
         Segments::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return std::make_unique<Segments>(parameters.segments, body.length, end_time);
         }},
        {"strain feedback",
         StrainFeedback::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return std::make_unique<StrainFeedback>(parameters.strain_feedback, body.length, end_time);
         }},
        {"table",
         ActiveStressTable::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return std::make_unique<ActiveStressTable>(parameters.table, body.length, end_time);
         }},
        {name_of_sum,
         Sum::description,
         [](const auto &parameters, const Body &body, const double end_time) {
           return create_sum(parameters.sum, body, end_time);
         }},
      };
      return list;
    }
  } // namespace

  void
  ActiveStressParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Active stress");
    add_generators(declarations, /*is_term=*/false);
    declarations.enter("Sum");
    for (std::size_t i = 0; i < sum.terms.size(); ++i)
    {
      declarations.enter(fmt::format("Term {}", i + 1));
      sum.terms[i].combination.add_parameters(declarations);
      sum.terms[i].stress.add_parameters_of_term(declarations);
      declarations.leave();
    }
    declarations.leave();
    declarations.leave();
  }

  void
  ActiveStressParameters::add_parameters_of_term(Declarations &declarations)
  {
    add_generators(declarations, /*is_term=*/true);
  }

  void
  ActiveStressParameters::add_generators(Declarations &declarations, const bool is_term)
  {
    std::vector<std::string> names, of_strain;
    std::string documentation = "What makes the active stress: ";
    for (const Generator &entry : generators())
    {
      if (is_term && entry.name == name_of_sum)
        continue;
      documentation += (names.empty() ? "" : "; ") + entry.name + " (" + entry.description + ")";
      names.push_back(entry.name);
      if (entry.name != "none" && entry.name != "prescribed strain")
        of_strain.push_back(entry.name);
    }
    declarations.choice(
      "Generator", generator, names, is_term ? "What makes the term, as in Active stress." : documentation + ".");
    optimal_wave.add_parameters(declarations);
    travelling_wave.add_parameters(declarations);
    standing_wave.add_parameters(declarations);
    pulse.add_parameters(declarations);
    segments.add_parameters(declarations);
    expression.add_parameters(declarations);
    prescribed_strain.add_parameters(declarations, of_strain);
    library.add_parameters(declarations);
    strain_feedback.add_parameters(declarations);
    table.add_parameters(declarations);
  }

  std::unique_ptr<ActiveStress>
  create_active_stress(const ActiveStressParameters &parameters, const Body &body, const double end_time)
  {
    for (const Generator &entry : generators())
      if (entry.name == parameters.generator)
        return entry.create(parameters, body, end_time);
    throw std::logic_error("the parameters name a generator that is not in the list");
  }

  std::vector<std::string>
  generator_names()
  {
    std::vector<std::string> names;
    for (const Generator &entry : generators())
      names.push_back(entry.name);
    return names;
  }
} // namespace crawler
