// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What the page calls: the text of a parameter file goes in, JSON and fields come out, as `crawler run` would write
// them.
#include <crawler/base/plain_numbers.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/output/statistics_writer.h>
#include <crawler/run/summary.h>
#include <crawler/studies/core/input.h>
#include <crawler/studies/run/run_in_memory.h>

#include <emscripten/emscripten.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>

namespace crawler
{
  namespace
  {
    using Json = nlohmann::ordered_json;

    /// Of the latest run; null if it has none.
    std::shared_ptr<Kymograph> kymograph;

    Json
    run_text(const std::string &text)
    {
      kymograph.reset();
      Input input             = read_input(ParameterFile::from_text(text, "this page"));
      const ModelChoice model = choose_model(input);
      const double length = input.scene.body.length, end_time = input.scene.end_time;
      Json notes      = input.notes;
      RunInMemory run = run_in_memory(input, model, {}, []() { return false; });
      kymograph       = std::move(run.kymograph);
      Json shown      = Json::object();
      for (const FieldName &field : field_names)
        if (kymograph && field.in_kymograph)
          shown[field.name] = kymograph->shown(field);
      return {{"summary", summary_of(run.result)},
              {"length", length},
              {"end_time", end_time},
              {"model", model.explanation},
              {"notes", std::move(notes)},
              {"times", kymograph ? Json(kymograph->times()) : Json::array()},
              {"shown", std::move(shown)}};
    }

    /// Lives until the next call.
    const char *
    keep(const Json &json)
    {
      static std::string text;
      text = json.dump(-1, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
      return text.c_str();
    }
  } // namespace
} // namespace crawler

using namespace crawler;

extern "C"
{
  /// Names, units and meanings of the numbers of a run, and the number of points of a field along the body.
  EMSCRIPTEN_KEEPALIVE const char *
  crawler_entries()
  {
    return keep({{"entries", result_entries()}, {"n_points", Kymograph::n_points}});
  }

  /// The run of the parameter file @p text; {"problem": a sentence} if it is refused.
  EMSCRIPTEN_KEEPALIVE const char *
  crawler_run(const char *text)
  {
    try
    {
      return keep(run_text(text));
    }
    catch (const std::exception &problem)
    {
      return keep({{"problem", with_plain_numbers(problem.what())}});
    }
  }

  /// The field of this name ("stretch") of the latest run at [time][point], as field_names has them; null if there is
  /// none.
  EMSCRIPTEN_KEEPALIVE const double *
  crawler_field(const char *name)
  {
    const auto *field = std::ranges::find(field_names, std::string(name), [](const FieldName &f) { return f.name; });
    return kymograph && field != std::end(field_names) && field->in_kymograph
             ? (kymograph->rows().*field->values).data()
             : nullptr;
  }
}
