// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/library.h>
#include <crawler/scene/active_stress/strain_feedback.h>
#include <crawler/scene/known_stress.h>
#include <crawler/scene/stress_plugin.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <dlfcn.h>
#include <filesystem>
#include <ostream>
#include <sstream>

namespace crawler
{
  namespace
  {
    const std::string file_entry       = "Active stress/Library/File";
    const std::string parameters_entry = "Active stress/Library/Parameters";

    /// Runs code of the user; returns what it threw, in one line, or nothing.
    template <typename Function>
    std::optional<std::string>
    thrown_by(const Function &function)
    {
      try
      {
        function();
        return std::nullopt;
      }
      catch (const std::exception &error)
      {
        std::string words = error.what();
        std::ranges::replace(words, '\n', ' ');
        return words;
      }
      catch (...)
      {
        return "something that is not a std::exception";
      }
    }

    /// Failures, and the name of the plug-in that caused them.
    struct LibraryFailures : StressFailures
    {
      std::string plugin;
    };

    void
    fail(LibraryFailures &failures, const std::string &what)
    {
      ++failures.count;
      failures.latest = fmt::format("the plug-in \"{}\" {}", failures.plugin, what);
    }

    /// Makes an evaluator of a stress of the plug-in, or of its strain, whose errors become failures: then all values
    /// are NaN. @p whose follows names in messages.
    std::unique_ptr<ActiveStressAtPoints>
    guarded(const std::shared_ptr<LibraryFailures> &failures,
            const ActiveStress &stress,
            const std::string &whose,
            const std::vector<double> &points,
            const bool rate)
    {
      const auto make = [&stress, rate](const std::vector<double> &places) {
        return rate ? stress.rate_at(places) : stress.at(places);
      };
      const std::string maker = (rate ? "rate_at()" : "at()") + whose,
                        name  = (rate ? "values() of the rate" : "values()") + whose;
      std::shared_ptr<ActiveStressAtPoints> at_points;
      if (const auto thrown = thrown_by([&]() { at_points = make(points); }))
        fail(*failures, fmt::format("threw an exception in {}: {}", maker, *thrown));
      else if (!at_points)
        fail(*failures, fmt::format("returned no evaluator in {}", maker));
      return stress_at_points([=](const double t, const std::span<double> m) {
        const unsigned long n_before = failures->count;
        const auto is_finite         = [](const double value) { return std::isfinite(value); };
        if (!at_points) // has been reported already
          ++failures->count;
        else if (const auto thrown = thrown_by([&]() { at_points->values(t, m); }))
        {
          // Place of the failure: the first point that throws on its own.
          const auto place = std::ranges::find_if(points, [&](const double s) {
            double value = 0.;
            return thrown_by([&]() { make({s})->values(t, {&value, 1}); }).has_value();
          });
          fail(*failures,
               fmt::format("threw an exception in {} at {}t = {:.9g}: {}",
                           name,
                           place != points.end() ? fmt::format("s = {:.9g}, ", *place) : "",
                           t,
                           *thrown));
        }
        else if (const auto bad = std::ranges::find_if_not(m, is_finite); bad != m.end())
          fail(*failures,
               fmt::format("returned {} in {} at s = {:.9g}, t = {:.9g}; a finite number is expected",
                           *bad,
                           name,
                           points[static_cast<std::size_t>(bad - m.begin())],
                           t));
        if (failures->count > n_before)
          std::fill(m.begin(), m.end(), NAN);
      });
    }

    /// Notes a failure at the first of the numbers @p m that is not finite.
    void
    require_finite(LibraryFailures &failures,
                   const FeedbackStress &m,
                   const std::vector<double> &points,
                   const StretchSeen &seen,
                   const double t)
    {
      const std::pair<const char *, std::span<double>> all[] = {
        {"m", m.m}, {"m_w", m.m_w}, {"m_rate", m.m_rate}, {"m_near", m.m_near}};
      for (const auto &[name, values] : all)
        for (std::size_t i = 0; i < values.size(); ++i)
          if (!std::isfinite(values[i]))
            return fail(failures,
                        fmt::format("returned {} = {} in values() of its feedback at s = {:.9g}, t = {:.9g}, stretch "
                                    "{:.9g}; a finite number is expected",
                                    name,
                                    values[i],
                                    points[i],
                                    t,
                                    seen.stretch.empty() ? 1. : seen.stretch[i]));
    }

    std::unique_ptr<FeedbackAtPoints>
    guarded_feedback_at(const std::shared_ptr<LibraryFailures> &failures,
                        const StretchFeedback &feedback,
                        const std::vector<double> &points)
    {
      std::shared_ptr<FeedbackAtPoints> at_points;
      if (const auto thrown = thrown_by([&]() { at_points = feedback.at(points); }))
        fail(*failures, fmt::format("threw an exception in at() of its feedback: {}", *thrown));
      else if (!at_points)
        fail(*failures, "returned no evaluator in at() of its feedback");
      return feedback_at_points([failures, points, at_points](
                                  const double t, const StretchSeen &seen, const FeedbackStress &m) {
        const unsigned long n_before = failures->count;
        if (!at_points)
          ++failures->count;
        else if (const auto thrown = thrown_by([&]() { at_points->values(t, seen, m); }))
          fail(*failures, fmt::format("threw an exception in values() of its feedback at t = {:.9g}: {}", t, *thrown));
        else
          require_finite(*failures, m, points, seen, t);
        if (failures->count > n_before)
          for (const std::span<double> values : {m.m, m.m_w, m.m_rate, m.m_near})
            std::fill(values.begin(), values.end(), NAN);
      });
    }

    /// Loads the plug-in for the lifetime of the program: objects it has made may be anywhere.
    const Plugin &
    load(const std::string &name)
    {
      if (name.empty())
        throw InputError("the name of the shared object is missing", file_entry);
      const std::filesystem::path file = std::filesystem::absolute(name).lexically_normal();
      std::error_code ignored;
      if (!std::filesystem::exists(file, ignored))
        refuse(file_entry, "there is no file \"{}\"; a shared object is expected", file.string());
      if (!std::filesystem::is_regular_file(file, ignored)) // opening a pipe may wait for ever
        refuse(file_entry, "\"{}\" is not a file; a shared object is expected", name);
      void *handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
      if (handle == nullptr)
      {
        const char *words = dlerror();
        refuse(file_entry,
               "\"{}\" cannot be loaded: {}; a file compiled with -shared on this machine is expected",
               name,
               words != nullptr ? words : "unknown");
      }
      const auto function = reinterpret_cast<const Plugin *(*)()>(dlsym(handle, plugin_function));
      if (function == nullptr)
        refuse(file_entry,
               "\"{}\" is not a plug-in of crawler: it has no function {}; the macro "
               "CRAWLER_ACTIVE_STRESS_PLUGIN is expected in it",
               name,
               plugin_function);
      const Plugin &plugin = *function();
      if (plugin.interface != plugin_interface || std::strcmp(plugin.crawler_version, plugin_version) != 0)
        refuse(file_entry,
               "\"{}\" was built against crawler {} (interface {}), but this program is crawler {} "
               "(interface {}); build it again, against this one",
               name,
               plugin.crawler_version,
               plugin.interface,
               plugin_version,
               plugin_interface);
      return plugin;
    }

    std::map<std::string, std::string>
    parse_parameters(const std::string &text)
    {
      std::map<std::string, std::string> values;
      std::istringstream in(text);
      std::string item;
      while (std::getline(in, item, ','))
      {
        const auto equals      = item.find('=');
        const std::string name = trimmed(item.substr(0, equals));
        if (equals == std::string::npos || name.empty())
          refuse(parameters_entry,
                 "found \"{}\" among the parameters of the plug-in, but \"name=value, name=value, "
                 "...\" is expected",
                 trimmed(item));
        if (!values.emplace(name, trimmed(item.substr(equals + 1))).second)
          refuse(parameters_entry, "the parameter \"{}\" of the plug-in is set a second time", name);
      }
      return values;
    }

    void
    require_known(const PluginParameters &parameters, const std::string &plugin)
    {
      const std::vector<std::string> known(parameters.known().begin(), parameters.known().end());
      for (const auto &[name, value] : parameters.values())
        if (std::find(known.begin(), known.end(), name) == known.end())
          refuse(parameters_entry,
                 "the plug-in \"{}\" does not know the parameter \"{}\"; it knows {}",
                 plugin,
                 name,
                 known.empty() ? "none" : quoted_list(known));
    }

    class Library : public KnownStress
    {
    public:
      Library(const LibraryParameters &parameters, const Body &body, const double end_time)
        : file_(parameters.file)
        , failures_(std::make_shared<LibraryFailures>())
      {
        const Plugin &plugin = load(file_);
        failures_->plugin    = plugin.name;
        const PluginInput input{body.length,
                                body.elastic_modulus,
                                body.friction_coefficient,
                                body.anchoring_exponent,
                                end_time,
                                PluginParameters(parse_parameters(parameters.parameters))};
        if (const auto thrown = thrown_by([&]() { stress_ = plugin.create(input); }))
          refuse(parameters_entry, "the plug-in \"{}\" refuses the scene: {}", plugin.name, *thrown);
        if (!stress_)
          refuse(file_entry, "the plug-in \"{}\" returned nothing; an active stress is expected", plugin.name);
        require_known(input.parameters, plugin.name);
        ask(body.length, end_time);
      }

      const StressFailures *
      failures() const override
      {
        return failures_.get();
      }
      void
      report(std::ostream &out) const override
      {
        out << fmt::format("Plug-in \"{}\" from {}\n", failures_->plugin, file_) << report_;
        if (!report_.empty() && report_.back() != '\n')
          out << '\n';
      }

    private:
      std::unique_ptr<ActiveStressAtPoints>
      evaluator(const std::vector<double> &points, const bool rate) const override
      {
        return guarded(failures_, *stress_, "", points, rate);
      }

      /// Asks the plug-in once for its properties.
      void
      ask(const double length, const double end_time)
      {
        const char *asked = "";
        const auto thrown = thrown_by([&]() {
          asked                  = "repetition()";
          facts_.repetition      = stress_->repetition();
          asked                  = "breaks_in_space()";
          facts_.breaks_in_space = stress_->breaks_in_space();
          asked                  = "breaks_in_time()";
          facts_.breaks_in_time  = stress_->breaks_in_time();
          asked                  = "rate_at()";
          facts_.has_rate        = stress_->rate_at({0.}) != nullptr;
          asked                  = "feedback()";
          if (const StretchFeedback *feedback = stress_->feedback())
            facts_.feedback =
              StretchFeedback{feedback->facts, [failures = failures_, feedback](const std::vector<double> &points) {
                                return guarded_feedback_at(failures, *feedback, points);
                              }};
          asked = "prescribed_strain()";
          if (const ActiveStress *strain = stress_->prescribed_strain())
            facts_.prescribed_strain = std::make_shared<StressByFunctions>(
              [failures = failures_, strain](const std::vector<double> &points, const bool rate) {
                return guarded(failures, *strain, " of its strain", points, rate);
              });
          asked = "report()";
          std::ostringstream out;
          stress_->report(out);
          report_ = out.str();
        });
        const auto refuse = [&](const std::string &what) {
          crawler::refuse(file_entry, "the plug-in \"{}\" {}", failures_->plugin, what);
        };
        if (thrown)
          refuse(fmt::format("threw an exception in {}: {}", asked, *thrown));
        if (const auto gait = facts_.repetition)
        {
          if (!(gait->period > 0. && std::isfinite(gait->period)))
            refuse(fmt::format("says that its period is {}; a positive number is expected", gait->period));
          if (!(gait->from >= 0. && std::isfinite(gait->from)))
            refuse(fmt::format("says that it repeats from {} on; a number of at least 0 is expected", gait->from));
        }
        for (const double s : facts_.breaks_in_space)
          if (!(s > 0. && s < length))
            refuse(
              fmt::format("returned {} in breaks_in_space(); a number above 0 and below {:g} is expected", s, length));
        for (const double t : facts_.breaks_in_time)
          if (!(t >= 0. && t <= end_time))
            refuse(fmt::format("returned {} in breaks_in_time(); a number from 0 to {:g} is expected", t, end_time));
        if (facts_.feedback)
          if (const auto bad = bad_fact(facts_.feedback->facts, length, end_time))
            refuse(fmt::format("has a feedback with the {} {}; {} is expected", bad->name, bad->value, bad->expected));
      }

      std::string file_;
      std::shared_ptr<LibraryFailures> failures_; ///< evaluators write here
      std::unique_ptr<const ActiveStress> stress_;
      std::string report_;
    };
  } // namespace

  std::unique_ptr<ActiveStress>
  load_library(const LibraryParameters &parameters, const Body &body, const double end_time)
  {
    return std::make_unique<Library>(parameters, body, end_time);
  }
} // namespace crawler
