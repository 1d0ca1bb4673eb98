// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/result_table.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    using Result = SimulationResult;
    using Scale  = ResultEntry::Scale;

    const std::string length = "length", time = "time", energy = "force length", force = "force", one = "1";

    ResultValue
    known(const std::optional<double> &value)
    {
      return value && std::isfinite(*value) ? ResultValue(*value) : ResultValue();
    }

    ResultEntry
    number(const std::string &key,
           const std::string &unit,
           const std::string &meaning,
           ResultValue (*value)(const Result &),
           const Scale scale     = Scale::none,
           const bool is_sampled = false)
    {
      return {.key = key, .unit = unit, .meaning = meaning, .value = value, .scale = scale, .is_sampled = is_sampled};
    }

    /// Energy per distance of the last stride.
    ResultEntry
    cost_of_transport(const std::string &key,
                      const std::string &meaning,
                      ResultValue (*value)(const Result &),
                      const bool is_sampled = false)
    {
      return number("gait.cost_of_transport." + key, force, meaning, value, Scale::cost, is_sampled);
    }

    ResultEntry
    word(const std::string &key, const std::string &meaning, ResultValue (*value)(const Result &))
    {
      return {.key = key, .unit = "", .meaning = meaning, .value = value, .is_word = true};
    }

    ResultEntry
    of_process(ResultEntry entry)
    {
      entry.of_process = true;
      return entry;
    }

    /// Values of optional parts of a result: an expression of the part, and nothing without it.
#define PART(member, expression)                   \
  [](const Result &r) -> ResultValue {             \
    if (!r.member)                                 \
      return {};                                   \
    [[maybe_unused]] const auto &part = *r.member; \
    return ResultValue(expression);                \
  }
#define VALUE(expression) [](const Result &r) -> ResultValue { return ResultValue(expression); }
#define COUNT(expression) VALUE((unsigned long)(expression))
#define WORK(expression) PART(energy_balance, part.expression)
#define COST(expression)                                 \
  [](const Result &r) -> ResultValue {                   \
    if (!r.gait || !r.gait->energy_balance)              \
      return {};                                         \
    const EnergyBalance &part = *r.gait->energy_balance; \
    return known(r.gait->cost_of_transport(expression)); \
  }

    std::vector<ResultEntry>
    entries_of_run()
    {
      using enum ResultEntry::Scale;
      return {
        of_process(word("status", "how the run ended", VALUE(std::string(word_of(r.time.status))))),
        of_process(word("reason",
                        "name of what went wrong",
                        VALUE(r.time.status == Status::finished ? std::string() : r.time.reason))),
        of_process(word("message",
                        "what went wrong, in a sentence",
                        VALUE(r.time.status == Status::finished ? std::string() : r.time.message))),
        number("displacement", length, "displacement of the centre of mass", VALUE(r.displacement)),
        number("displacement_error.total", length, "bound of the error of the displacement", PART(error, part.total)),
        number("displacement_error.space", length, "part of this bound from space", PART(error, part.space)),
        number("displacement_error.time", length, "part of this bound from time", PART(error, part.time)),
        number("displacement_error.model", length, "part of this bound from the model", PART(error, part.model)),
        number("end_time", time, "time that was reached", VALUE(r.time.time)),
        number("cycles.period", time, "period of the cycles that repeat", PART(cycles, part.period)),
        number("cycles.computed", one, "cycles that were computed", PART(cycles, 1ul * part.computed)),
        number("cycles.extrapolated", one, "cycles that were extrapolated", PART(cycles, 1ul * part.extrapolated)),
        number(
          "cycles.error", length, "bound of the error of the displacement by extrapolation", PART(cycles, part.bound)),
        word("model", "level of the model hierarchy", VALUE(std::string(word_of(r.process.model)))),
        number("stress_power", energy, "work of the active stress", WORK(stress_work), exchanged_work),
        number("dissipation", energy, "work against the friction", WORK(dissipation), exchanged_work),
        number("elastic_energy", energy, "elastic energy of the last state", WORK(elastic_energy), exchanged_work),
        number("ledger_residual",
               one,
               "residual of the energy balance, relative to the exchanged work",
               [](const Result &r) -> ResultValue {
                 return known(r.energy_balance ? r.energy_balance->residual() : r.residuals.unknown_works);
               }),
        number("paper_energy", energy, "energy of the paper", WORK(paper_energy()), exchanged_work),
        number("positive_power",
               energy,
               "work of the active stress where it is positive",
               WORK(positive_work),
               exchanged_work,
               true),
        number("net_friction",
               one,
               "mean net friction, relative to the mean absolute friction",
               PART(energy_balance, r.residuals.net_friction)),
        number(
          "min_stretch.value", one, "smallest stretch over body and time", VALUE(r.stretch.min.value), strain, true),
        number("min_stretch.s", length, "where the stretch is smallest", VALUE(r.stretch.min.s)),
        number("min_stretch.t", time, "when the stretch is smallest", VALUE(r.stretch.min.t)),
        number(
          "max_stretch.value", one, "largest stretch over body and time", VALUE(r.stretch.max.value), strain, true),
        number("max_stretch.s", length, "where the stretch is largest", VALUE(r.stretch.max.s)),
        number("max_stretch.t", time, "when the stretch is largest", VALUE(r.stretch.max.t)),
      };
    }

    std::vector<ResultEntry>
    entries_of_gait()
    {
      using enum ResultEntry::Scale;
      return {
        number("gait.period", time, "period of the last stride", PART(gait, part.period)),
        number("gait.frequency", "1/time", "frequency of the last stride", PART(gait, 1. / part.period)),
        word("gait.period_from",
             "what the period is known from",
             PART(gait, std::string(part.is_declared ? "active stress" : "stretch"))),
        number("gait.strides", one, "number of strides that fit into the run", PART(gait, part.n_strides)),
        number("gait.displacement", length, "displacement in the last stride", PART(gait, part.displacement), itself),
        number("gait.body_lengths", one, "body lengths covered in the last stride", PART(gait, part.body_lengths())),
        number("gait.speed", "length/time", "speed in the last stride", PART(gait, part.speed()), itself),
        cost_of_transport("stress_power", "work of the active stress per distance", COST(part.stress_work)),
        cost_of_transport("positive_power",
                          "positive work of the active stress per distance, for actuators that cannot recover work",
                          COST(part.positive_work),
                          /*is_sampled=*/true),
        cost_of_transport("paper_energy", "energy of the paper per distance", COST(part.paper_energy())),
        cost_of_transport("dissipation", "work against the friction per distance", COST(part.dissipation)),
        number("gait.slip", one, "1 - speed of the body/speed of the wave", PART(gait, known(part.slip())), itself),
        word("gait.wave.direction", "direction of the wave of stretch", PART(gait, std::string(part.direction()))),
        number("gait.wave.speed",
               "length/time",
               "speed of the wave of stretch",
               PART(gait, known(part.wave_speed())),
               itself),
        number("gait.wave.coherence",
               one,
               "coherence of the wave of stretch: 1 for a pure wave",
               [](const Result &r) -> ResultValue {
                 return r.gait && r.gait->wave ? ResultValue(r.gait->wave->coherence) : ResultValue();
               }),
        number("gait.efficiency",
               one,
               "displacement over the largest that any gait can reach",
               VALUE(known(r.gait_efficiency)),
               itself,
               true),
        number("gait.stride_efficiency",
               one,
               "the same for the displacement of the last stride",
               PART(gait, known(part.efficiency)),
               itself,
               true)};
    }

    std::vector<ResultEntry>
    entries_of_process()
    {
      return {
        word("formulation", "position or stretch", VALUE(std::string(word_of(r.process.formulation)))),
        number("mesh_changes", one, "number of changes of an adaptive mesh", COUNT(r.process.mesh.changes)),
        number("most_cells",
               one,
               "largest number of cells of all meshes",
               COUNT(std::max(r.process.mesh.most_cells, r.process.mesh.n_cells))),
        number("inversion.value", one, "stretch where the body inverted", PART(inversion, part.value)),
        number("inversion.s", length, "where the body inverted", PART(inversion, part.s)),
        number("inversion.t", time, "when the body inverted", PART(inversion, part.t)),
        number(
          "inversion.error", time, "bound of the error of the time of inversion", PART(inversion, known(part.error))),
        number("inversion.s_first",
               length,
               "first place where the stretch was lost",
               PART(inversion, part.places ? part.places->first : part.s)),
        number("inversion.s_last",
               length,
               "last place where the stretch was lost",
               PART(inversion, part.places ? part.places->second : part.s)),
        number("cells", one, "number of cells of the last mesh", COUNT(r.process.mesh.n_cells)),
        number("degree",
               one,
               "polynomial degree of the elements",
               VALUE(r.process.mesh.n_cells > 0 ? ResultValue(1ul * r.process.mesh.degree) : ResultValue())),
        number("degrees_of_freedom", one, "number of unknowns of the last mesh", COUNT(r.process.mesh.n_unknowns)),
        number("steps", one, "number of accepted time steps", COUNT(r.time.steps)),
        number("rejected_steps", one, "number of rejected time steps", COUNT(r.time.rejected_steps)),
        number("newton_iterations", one, "Newton iterations of all steps", COUNT(r.time.newton_iterations)),
        of_process(
          number("cells_shared", "", "whether several ranks shared the cells", VALUE(r.process.mesh.is_shared))),
        number("refinements", one, "number of attempts before this run", COUNT(r.process.refinements)),
        word("integrator", "time integrator", VALUE(r.process.integrator)),
        word("engine", "engine that ran the integrator", VALUE(r.process.engine)),
        of_process(number("seconds.setup", "s", "wall time for the setup", VALUE(r.process.seconds.setup))),
        of_process(number("seconds.solve", "s", "wall time for the solution", VALUE(r.process.seconds.solve))),
        of_process(number("seconds.output", "s", "wall time for the output", VALUE(r.process.seconds.output))),
        of_process(number("seconds.error", "s", "wall time for the error bounds", VALUE(r.process.seconds.error)))};
    }
#undef PART
#undef VALUE
#undef COST
#undef COUNT
#undef WORK
  } // namespace

  ResultValue
  ResultEntry::value_in(const SimulationResult &result) const
  {
    if (error < 0)
      return value(result);
    return !result.errors.empty() ? known(result.errors[static_cast<std::size_t>(error)]) : ResultValue();
  }

  double
  ResultEntry::number_in(const SimulationResult &result) const
  {
    const ResultValue found = value_in(result);
    const double *number    = std::get_if<double>(&found);
    return number != nullptr ? *number : std::numeric_limits<double>::quiet_NaN();
  }

  double
  ResultEntry::scale_in(const SimulationResult &result) const
  {
    switch (scale)
    {
      case Scale::exchanged_work:
        return result.energy_balance ? result.energy_balance->exchanged_work : 0.;
      case Scale::strain:
        return std::max(1. - result.stretch.min.value, result.stretch.max.value - 1.);
      case Scale::itself:
        return std::abs(number_in(result));
      case Scale::cost:
        return result.gait && result.gait->energy_balance
                 ? result.gait->energy_balance->exchanged_work / std::abs(result.gait->displacement)
                 : 0.;
      case Scale::none:
        break;
    }
    return 0.;
  }

  const std::vector<ResultEntry> &
  result_table()
  {
    static const std::vector<ResultEntry> table = []() {
      std::vector<ResultEntry> list = entries_of_run();
      std::ranges::move(entries_of_gait(), std::back_inserter(list));
      const std::string value = ".value";
      int n_errors            = 0;
      for (std::size_t i = 0, n = list.size(); i < n; ++i)
        if (list[i].scale != Scale::none)
        {
          std::string key = list[i].key;
          if (key.ends_with(value))
            key.resize(key.size() - value.size());
          list.push_back(number("errors." + key, list[i].unit, "bound of the error of " + key, nullptr));
          list.back().error = n_errors++;
        }
      std::ranges::move(entries_of_process(), std::back_inserter(list));
      return list;
    }();
    return table;
  }

  const ResultEntry &
  entry_of(const std::string &key)
  {
    return *std::ranges::find(result_table(), key, &ResultEntry::key);
  }

  const std::vector<const ResultEntry *> &
  entries_with_errors()
  {
    static const std::vector<const ResultEntry *> list = []() {
      std::vector<const ResultEntry *> entries;
      for (const ResultEntry &entry : result_table())
        if (entry.scale != Scale::none)
          entries.push_back(&entry);
      return entries;
    }();
    return list;
  }

  std::optional<double>
  error_bound(const SimulationResult &result, const std::string &key)
  {
    const auto &entries = entries_with_errors();
    for (std::size_t i = 0; i < result.errors.size(); ++i)
      if (entries[i]->key == key && std::isfinite(result.errors[i]))
        return result.errors[i];
    return std::nullopt;
  }

  void
  set_error_bound(SimulationResult &result, const std::string &key, const double bound)
  {
    const auto &entries = entries_with_errors();
    result.errors.resize(entries.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (entries[i]->key == key)
        result.errors[i] = bound;
  }

  std::string
  error_bound_in_words(const SimulationResult &result, const std::string &key)
  {
    const auto bound = error_bound(result, key);
    return bound ? fmt::format(" +- {:.2g}", *bound) : "";
  }
} // namespace crawler
