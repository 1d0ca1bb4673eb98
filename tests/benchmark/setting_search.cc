// SPDX-License-Identifier: LGPL-2.1-or-later
#include "setting_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <limits>
#include <stdexcept>

namespace crawler::test
{
  namespace
  {
    /// A setting that takes so much longer than the best is not worth a second look.
    constexpr double hopeless = 1.5;
    /// Repetitions of the timing.
    constexpr unsigned int repetitions = 8;

    /// [s]
    double
    processor_time()
    {
      timespec now{};
      clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
      return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }

    Setting
    make_setting(const SearchSpace &space,
                 const std::string &integrator,
                 const unsigned int degree,
                 const unsigned int n_cells,
                 const double tolerance)
    {
      Setting setting;
      setting.time.integrator       = integrator;
      setting.time.engine           = space.engine;
      setting.time.end_time         = space.end_time;
      setting.numerics.degree       = degree;
      setting.numerics.n_cells      = n_cells;
      setting.numerics.tolerance    = tolerance;
      setting.numerics.initial_step = (integrator == "bdf" ? 1e-5 : 1e-2) * space.end_time;
      return setting;
    }

    /// What one run gives and costs.
    struct Trial
    {
      double error, seconds;
    };

    Trial
    time_run(const std::function<double()> &run)
    {
      const double start = processor_time(), error = run();
      return {error, processor_time() - start};
    }

    /// Keeps the cheapest setting so far.
    class Search
    {
    public:
      Search(const double wanted, const Prepare &prepare)
        : wanted_(wanted)
        , prepare_(prepare)
      {
      }

      /// Of a mesh the loosest tolerance counts that reaches the error. True if the setting needs no tighter one.
      bool
      ends_with(const Setting &setting)
      {
        const auto run    = prepare_(setting);
        const Trial first = time_run(run);
        if (first.seconds > hopeless * seconds_)
          return true;
        if (!(first.error <= wanted_))
          return false;
        double seconds = first.seconds;
        for (unsigned int i = 0; i < repetitions; ++i)
          seconds = std::min(seconds, time_run(run).seconds);
        if (seconds < seconds_)
        {
          seconds_ = seconds;
          best     = setting;
        }
        return true;
      }

      Setting best;

      bool
      has_found() const
      {
        return seconds_ < std::numeric_limits<double>::infinity();
      }

    private:
      const double wanted_;
      const Prepare &prepare_;
      double seconds_ = std::numeric_limits<double>::infinity();
    };
  } // namespace

  std::string
  in_words(const Setting &setting)
  {
    return fmt::format("{}, degree {}, {} cell{}, tolerance {:.2g}",
                       setting.time.integrator,
                       setting.numerics.degree,
                       setting.numerics.n_cells,
                       setting.numerics.n_cells == 1 ? "" : "s",
                       setting.numerics.tolerance);
  }

  Setting
  cheapest_setting(const SearchSpace &space, const double wanted, const Prepare &prepare)
  {
    Search search(wanted, prepare);
    for (const std::string &integrator : space.integrators)
      for (const unsigned int degree : space.degrees)
        for (const unsigned int n_cells : space.cells)
          for (double tolerance = space.loosest; tolerance >= space.tightest; tolerance *= space.tolerance_factor)
            if (search.ends_with(make_setting(space, integrator, degree, n_cells, tolerance)))
              break;
    if (!search.has_found())
      throw std::runtime_error(fmt::format("no setting reaches an error of {:g}", wanted));
    return search.best;
  }
} // namespace crawler::test
