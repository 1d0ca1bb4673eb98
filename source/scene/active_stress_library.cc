// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/shaped_wave.h>
#include <crawler/scene/active_stress_library.h>
#include <crawler/scene/scene.h>

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

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
    create_term(const TermParameters &parameters, const std::size_t number, const Scene &scene)
    {
      const SumTermParameters &own = parameters.combination;
      const std::string entries    = section_of_term(number);
      try
      {
        return {parameters.stress.generator,
                create_active_stress(parameters.stress, scene),
                own.combine == "multiply",
                own.factor,
                Window(own.in_s, 's', entries, scene.body.length),
                Window(own.in_t, 't', entries, scene.end_time)};
      }
      catch (const InputError &error) // names entries of a generator outside of a sum
      {
        const bool is_alone = error.entry.starts_with(section) && !error.entry.starts_with(entries);
        refuse(
          is_alone ? entries + error.entry.substr(section.size()) : error.entry, "term {}: {}", number, error.what());
      }
    }

    std::unique_ptr<ActiveStress>
    create_sum(const ActiveStressParameters &parameters, const Scene &scene)
    {
      std::vector<SumTerm> terms;
      for (const TermParameters &term : parameters.sum.terms)
        terms.push_back(create_term(term, terms.size() + 1, scene));
      return std::make_unique<Sum>(std::move(terms), scene.body.length, scene.end_time);
    }

    std::unique_ptr<ActiveStress>
    create_nothing(const ActiveStressParameters &, const Scene &)
    {
      const auto no_stress = [](double, const std::span<double> m) { std::ranges::fill(m, 0.); };
      return std::make_unique<StressByFunctions>(
        [=](const std::vector<double> &, bool) { return stress_at_points(no_stress); },
        [](const ActiveStress::Box &) {
          return ActiveStress::Bounds{0., 0.};
        });
    }

    /// Makes a wave by Fourier coefficients or of any shape.
    std::unique_ptr<ActiveStress>
    create_any_optimal_wave(const ActiveStressParameters &parameters, const Scene &scene)
    {
      if (parameters.optimal_wave.shape == "Fourier")
        return std::make_unique<OptimalWave>(parameters.optimal_wave, scene.body, scene.end_time);
      return std::make_unique<ShapedWave>(parameters.optimal_wave, scene.body, scene.end_time);
    }

    std::unique_ptr<ActiveStress>
    create_prescribed_strain(const ActiveStressParameters &parameters, const Scene &scene)
    {
      const PrescribedStrainParameters &own = parameters.prescribed_strain;
      std::unique_ptr<ActiveStress> generator;
      if (own.is_generated())
      {
        ActiveStressParameters of_strain = parameters;
        of_strain.generator              = own.given_by;
        generator                        = create_active_stress(of_strain, scene);
      }
      return std::make_unique<PrescribedStrain>(own, scene, std::move(generator));
    }

    /// Makes a generator with the parameters of its own section.
    template <typename Stress, auto section>
    std::unique_ptr<ActiveStress>
    create(const ActiveStressParameters &parameters, const Scene &scene)
    {
      const auto &own = parameters.*section;
      if constexpr (std::is_constructible_v<Stress, decltype(own), const Scene &>)
        return std::make_unique<Stress>(own, scene);
      else if constexpr (std::is_constructible_v<Stress, decltype(own), const Body &, double>)
        return std::make_unique<Stress>(own, scene.body, scene.end_time);
      else
        return std::make_unique<Stress>(own, scene.body.length, scene.end_time);
    }

    struct Generator
    {
      std::string name, description;
      std::unique_ptr<ActiveStress> (*create)(const ActiveStressParameters &, const Scene &);
    };

    /// The list of all generators, kept only here.
    const std::vector<Generator> &
    generators()
    {
      using P                                  = ActiveStressParameters;
      static const std::vector<Generator> list = {
        {"none", "no actuation, m = 0", create_nothing},
        {"optimal wave",
         "the wave of largest displacement for a given energy, to leading order in chi",
         create_any_optimal_wave},
        {"travelling wave",
         "a sine or square wave that runs along the body",
         create<TravellingWave, &P::travelling_wave>},
        {"standing wave", "a wave whose nodes stay in place", create<StandingWave, &P::standing_wave>},
        {"pulse", "a bump that runs along the body, once or repeatedly", create<Pulse, &P::pulse>},
        {"expression", "a formula of s and t", create<Expression, &P::expression>},
        {"prescribed strain", "the stress that produces a given strain", create_prescribed_strain},
        {"two-level wave",
         "the two-level strain that goes farthest of all for its work, and the stress that produces it",
         create<TwoLevelWave, &P::two_level_wave>},
        {"library",
         "a shared object that the user has compiled",
         [](const P &own, const Scene &scene) { return load_library(own.library, scene.body, scene.end_time); }},
        {"segments", "actuated segments of a robot that switch one after the other", create<Segments, &P::segments>},
        {"strain feedback",
         "a formula of s, t, the stretch, its rate, and stretches nearby and before",
         create<StrainFeedback, &P::strain_feedback>},
        {"table", "samples over s and t in a CSV or HDF5 file", create<ActiveStressTable, &P::table>},
        {"modes", "a sum of Fourier modes, or of Fourier modes and splines in time", create<Modes, &P::modes>},
        {name_of_sum, "a sum and product of generators, each with a window in s and t", create_sum},
      };
      return list;
    }
  } // namespace

  void
  ActiveStressParameters::add_parameters(Declarations &declarations)
  {
    add_generators(declarations, /*is_term=*/false);
    declarations.section("Sum", sum);
  }

  void
  SumParameters::add_parameters(Declarations &declarations)
  {
    for (std::size_t i = 0; i < terms.size(); ++i)
      declarations.section(fmt::format("Term {}", i + 1), terms[i]);
  }

  void
  LibraryParameters::add_parameters(Declarations &declarations)
  {
    declarations.file("File", file, "the name of a shared object")
      .means("Shared object with the active stress as a plug-in (doc/generators/library.md).");
    declarations.text("Parameters", parameters, "a list name=value, name=value")
      .means("Parameters that are passed to the plug-in, which defines their names.");
  }

  void
  TermParameters::add_parameters(Declarations &declarations)
  {
    combination.add_parameters(declarations);
    stress.add_generators(declarations, /*is_term=*/true);
  }

  void
  ActiveStressParameters::add_generators(Declarations &declarations, const bool is_term)
  {
    std::vector<std::string> names, of_strain;
    std::string documentation = "Generator of the active stress: ";
    for (const Generator &entry : generators())
    {
      if (is_term && entry.name == name_of_sum)
        continue;
      documentation += (names.empty() ? "" : "; ") + entry.name + " (" + entry.description + ")";
      names.push_back(entry.name);
      if (entry.name != "none" && entry.name != "prescribed strain" && entry.name != "two-level wave")
        of_strain.push_back(entry.name);
    }
    declarations.choice("Generator", generator, names)
      .means(is_term ? "Generator of the term, as in Active stress." : documentation + ".");
    declarations.section("Optimal wave", optimal_wave);
    declarations.section("Travelling wave", travelling_wave);
    declarations.section("Standing wave", standing_wave);
    declarations.section("Pulse", pulse);
    declarations.section("Segments", segments);
    declarations.section("Expression", expression);
    declarations.section("Prescribed strain", prescribed_strain, of_strain);
    declarations.section("Two-level wave", two_level_wave);
    declarations.section("Library", library);
    declarations.section("Strain feedback", strain_feedback);
    declarations.section("Table", table);
    declarations.section("Modes", modes);
  }

  std::unique_ptr<ActiveStress>
  create_active_stress(const ActiveStressParameters &parameters, const Scene &scene)
  {
    for (const Generator &entry : generators())
      if (entry.name == parameters.generator)
        return entry.create(parameters, scene);
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
