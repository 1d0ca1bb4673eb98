// SPDX-License-Identifier: LGPL-2.1-or-later
#include "setting_search.h"

#include "../support/processor_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace crawler::test
{
  namespace
  {
    /// A setting that takes so much longer than the best is not worth a second look.
    constexpr double hopeless = 2.;
    /// Repetitions of the timing.
    constexpr unsigned int repetitions = 8;

    Setting
    make_setting(const SearchSpace &space,
                 const std::string &integrator,
                 const unsigned int degree,
                 const unsigned int n_cells,
                 const double tolerance)
    {
      Setting setting;
      setting.time.integrator       = integrator;
      setting.time.engine           = from_word<Engine>(space.engine).value();
      setting.time.end_time         = space.end_time;
      setting.numerics.degree       = degree;
      setting.numerics.n_cells      = n_cells;
      setting.numerics.tolerance    = tolerance;
      setting.numerics.initial_step = (integrator == "bdf" ? 1e-5 : 1e-2) * space.end_time;
      return setting;
    }

    /// The fastest of some runs [s].
    double
    seconds_of(const std::function<double()> &run, const unsigned int n)
    {
      double seconds = std::numeric_limits<double>::infinity();
      for (unsigned int i = 0; i < n; ++i)
      {
        const double start = processor_seconds();
        run();
        seconds = std::min(seconds, processor_seconds() - start);
      }
      return seconds;
    }

    /// Keeps the cheapest setting so far.
    class Search
    {
    public:
      Search(const double wanted, const Prepare &prepare, const std::function<bool(const Setting &)> &confirm)
        : wanted_(wanted)
        , prepare_(prepare)
        , confirm_(confirm)
      {
      }

      /// Of a mesh the loosest tolerance counts that reaches the error. True if the setting needs no tighter one.
      bool
      ends_with(const Setting &setting)
      {
        const auto run     = prepare_(setting);
        const double error = run(); // this one also builds what it needs
        double seconds     = seconds_of(run, 3);
        if (seconds > hopeless * seconds_)
          return true;
        if (!(error <= wanted_))
          return is_stuck(error);
        seconds = std::min(seconds, seconds_of(run, repetitions));
        if (seconds >= seconds_)
          return true;
        if (!confirm_(setting))
          return false;
        seconds_ = seconds;
        best     = setting;
        return true;
      }

      Setting best;

      bool
      has_found() const
      {
        return seconds_ < std::numeric_limits<double>::infinity();
      }

      /// Forgets the errors of the last mesh.
      void
      start_mesh()
      {
        last_error_ = HUGE_VAL;
        times_      = 0;
      }

    private:
      /// Is the error that of the mesh, which no tolerance makes smaller?
      bool
      is_stuck(const double error)
      {
        times_      = std::abs(error - last_error_) < 0.03 * error ? times_ + 1 : 0;
        last_error_ = error;
        return times_ == 3;
      }

      double last_error_  = HUGE_VAL;
      unsigned int times_ = 0;
      const double wanted_;
      const Prepare &prepare_;
      const std::function<bool(const Setting &)> &confirm_;
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
  cheapest_setting(const SearchSpace &space,
                   const double wanted,
                   const Prepare &prepare,
                   const std::function<bool(const Setting &)> &confirm)
  {
    Search search(wanted, prepare, confirm);
    for (const std::string &integrator : space.integrators)
      for (const unsigned int degree : space.degrees)
        for (const unsigned int n_cells : space.cells)
        {
          search.start_mesh();
          for (double tolerance = space.loosest; tolerance >= space.tightest; tolerance *= space.tolerance_factor)
            if (search.ends_with(make_setting(space, integrator, degree, n_cells, tolerance)))
              break;
        }
    if (!search.has_found())
      throw std::runtime_error(fmt::format("no setting reaches an error of {:g}", wanted));
    return search.best;
  }
} // namespace crawler::test
