// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/told_apart.h>
#include <crawler/equation/stretch_form.h>
#include <crawler/output/active_stress_table.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/run/run_parameters.h>
#include <crawler/time/integrators.h>

#include <fmt/format.h>

#include <optional>

namespace crawler
{
  namespace
  {
    /// Requires numbers whose squares in natural units stay in the range of doubles.
    void
    require_computable(const std::optional<double> &value, const double unit, const char *name, const char *unit_name)
    {
      constexpr double smallest = 1e-100, largest = 1e100;
      if (value && !(*value / unit >= smallest && *value / unit <= largest))
        refuse(std::string("Time/") + name,
               "{0} is {1:g}, but a number from {2:g} to {3:g} times the {4} is expected",
               name,
               *value,
               smallest,
               largest,
               unit_name);
    }

    /// Requires settings of the stretch form, which has meshes and integrators of its own.
    void
    require_stretch_form(const RunParameters &p, const Scene &scene)
    {
      const auto require =
        [](const bool ok, const std::string &entry, const std::string &found, const std::string &expected) {
          if (!ok)
            refuse(entry,
                   "Formulation is stretch and {} is {}, but {} is expected",
                   entry.substr(entry.find('/') + 1),
                   found,
                   expected);
        };
      const DiscretizationParameters &d = p.discretization;
      require(d.mesh != MeshKind::adaptive, "Discretization/Mesh", word_of(d.mesh), "automatic or uniform");
      require(!d.degree || *d.degree == 1, "Discretization/Degree", fmt::format("{}", d.degree.value_or(1)), "1");
      require(
        d.share_cells != ShareCells::yes, "Discretization/Share cells", word_of(d.share_cells), "automatic or no");
      require(p.time.integrator == "automatic" || integrator(p.time.integrator).petsc_type == "radau",
              "Time/Integrator",
              p.time.integrator,
              "automatic, radau 5 or radau 9");
      require(p.time.engine == Engine::automatic, "Time/Engine", word_of(p.time.engine), "automatic");
      require(
        p.time.step_control == StepControl::adaptive, "Time/Step control", word_of(p.time.step_control), "adaptive");
      require(!p.time.tolerance || *p.time.tolerance <= 1e-3 * p.body.length,
              "Time/Tolerance",
              fmt::format("{:g}", p.time.tolerance.value_or(0.)),
              fmt::format("at most a thousandth of the Length, {:g},", 1e-3 * p.body.length));
      if (const std::string reason = reason_against_stretch_form(scene); !reason.empty())
        refuse("Discretization/Formulation",
               "Formulation is stretch, but position or automatic is expected, since {}",
               reason);
    }

    /// Requires settings that fit a general scene.
    void
    require_general(const RunParameters &p, const Scene &scene)
    {
      const std::string features = scene.general_features();
      const bool is_prescribed   = scene.active_stress->prescribed_strain() != nullptr;
      if (p.model != Model::automatic && p.model != Model::nonlinear && !(p.model == Model::kinematic && is_prescribed))
        refuse("Model",
               "Model is {}, which is for plain bodies and grounds{}, but the scene has {}; nonlinear or "
               "auto is expected",
               word_of(p.model),
               p.model == Model::kinematic ? " unless the strain is prescribed" : "",
               features);
      if (const std::string beyond = scene.features_beyond_strain(); is_prescribed && !beyond.empty())
        refuse("Active stress/Generator",
               "Generator is {}, which is for bodies whose motion follows from their strain alone, "
               "but the scene has {}; another one is expected",
               p.active_stress.generator,
               beyond);
      if (p.time.cycle_stop == CycleStopMode::on && !scene.is_alike_everywhere())
        refuse("Time/Cycle stop",
               "Cycle stop is on, but the motion of the body depends on its place or its past, "
               "since the scene has {}; automatic or off is expected",
               features);
      const StretchFeedback *feedback = scene.active_stress->feedback();
      const double delay              = feedback != nullptr ? feedback->facts.delay : 0.;
      if (delay > 0. && p.time.step_control == StepControl::fixed && p.time.initial_step &&
          *p.time.initial_step > delay)
        refuse("Time/Initial step",
               "Initial step is {} and Step control is fixed, but no more than the delay of the "
               "feedback, {}, is expected",
               told_apart(*p.time.initial_step, {delay}),
               told_apart(delay, {*p.time.initial_step}));
    }
  } // namespace

  void
  RunParameters::count_terms(const ParameterFile &file)
  {
    const std::string sum = "Active stress/Sum", term = "Term ";
    const auto names = file.subsections(sum);
    std::size_t n    = 0;
    while (names.contains(term + std::to_string(n + 1)))
      ++n;
    for (const std::string &name : names)
    {
      const bool is_number = name.size() > term.size() && name.starts_with(term) &&
                             name.find_first_not_of("0123456789", term.size()) == std::string::npos;
      if (is_number && name[term.size()] != '0' &&
          (name.size() > term.size() + 6 || std::stoul(name.substr(term.size())) > n))
        throw InputError(fmt::format("{}: the section \"{}/{}\" is found, but \"{}{}\" is not; terms are expected to "
                                     "be numbered from Term 1 without gaps",
                                     file.name(),
                                     sum,
                                     name,
                                     term,
                                     n + 1));
    }
    // Names of the first term are known even if there is none, in case the file has a slip in them.
    active_stress.sum.terms.assign(names.empty() ? 0 : std::max<std::size_t>(n, 1), {});
    for (TermParameters &parameters : active_stress.sum.terms)
      parameters.stress.generator = "expression";
  }

  void
  RunParameters::add_parameters(Declarations &declarations)
  {
    declarations.choice("Model", model)
      .means("Level of the model hierarchy (doc/theory.md): the series for the optimal wave in closed form, a body "
             "whose strain is known, the equation for a = 0, or the full nonlinear equation; auto is the first of "
             "these whose estimated error is at most Accuracy.");
    declarations.number("Accuracy", accuracy, between(1e-12, 0.1), "1")
      .means(
        "Accepted error of the displacement, relative to the displacement (or to 1e-4 of the largest deformation, if "
        "that is larger). It determines degree, cells and time tolerance where they are automatic (doc/numerics.md).");
    declarations.flag("Error estimate", error_estimate)
      .means("Whether a second, finer run measures the error of the displacement; it costs about as much as a run "
             "without output.");
    declarations.section("Body", body);
    declarations.section("Ground", ground);
    declarations.section("Active stress", active_stress);
    declarations.section("Discretization", discretization);
    declarations.section("Time", time);
    declarations.section("Output", output);
  }

  Scene
  RunParameters::create_scene() const
  {
    time.validate();
    require_computable(time.tolerance, body.length, "Tolerance", "Length");
    require_computable(time.initial_step, time.end_time, "Initial step", "End time");
    if (discretization.smallest_cell && !(*discretization.smallest_cell < body.length))
      refuse("Discretization/Smallest cell",
             "Smallest cell is {}, but less than the Length, {}, is expected",
             told_apart(*discretization.smallest_cell, {body.length}),
             told_apart(body.length, {*discretization.smallest_cell}));
    if (time.cycle_stop == CycleStopMode::on && output.has_snapshots())
      throw InputError("Cycle stop is on, but snapshots until the end time are wanted; 0 is expected for Output/Number "
                       "of snapshots, or automatic or off here",
                       "Time/Cycle stop");
    Scene scene{body, nullptr, nullptr, time.end_time};
    natural_units(scene); // first, since nothing else is prepared for numbers that it rejects
    scene.profiles = read_profiles(body, time.end_time);
    scene.ground   = create_ground(ground, body, time.end_time);
    scene.friction = create_friction_law(ground, body, time.end_time);
    if (ground.friction_law != "power") // the power law tangent to it at stretch 1
      scene.body.anchoring_exponent = 1. - scene.friction->exponent(1.);
    scene.active_stress = create_active_stress(active_stress, scene);
    require_computable_stress(scene);
    require_well_posed_feedback(scene);
    require_table_fits(output.active_stress_table, *scene.active_stress);
    require_segment_table_fits(output.segment_table, *scene.active_stress);
    if (!scene.is_plain())
      require_general(*this, scene);
    if (time.cycle_stop == CycleStopMode::on && scene.keeps_its_centre())
      throw InputError("Cycle stop is on, but the displacement, by which cycles are judged, is 0 where a = 1 - p is 0; "
                       "automatic or off is expected",
                       "Time/Cycle stop");
    if (discretization.formulation == FormulationEntry::stretch)
      require_stretch_form(*this, scene);
    return scene;
  }
} // namespace crawler
