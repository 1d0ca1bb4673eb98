// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/cell_loops.h>
#include <crawler/equation/crawler_equation.h>
#include <crawler/reduced_models/kinematic.h>
#include <crawler/scene/fast_changes.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  using namespace CRAWLER_INSTRUCTION_SET;

  namespace
  {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    /// Result of the quadrature with some numbers of panels.
    struct Sums
    {
      double displacement = 0., friction_impulse = 0., net_impulse = 0.;
      EnergyBalance energies;
      StrainExtreme smallest{HUGE_VAL, 0., 0.}, largest{-HUGE_VAL, 0., 0.};
      bool stopped = false;
    };

    void
    add(Sums &sums, const KinematicBody::Integrals &now, const double duration)
    {
      sums.friction_impulse += duration * now.sums.abs_friction;
      sums.net_impulse += duration * std::abs(now.sums.net_friction);
      if (now.smallest.strain < sums.smallest.strain)
        sums.smallest = now.smallest;
      if (now.largest.strain > sums.largest.strain)
        sums.largest = now.largest;
    }

    /// Bounds of the strain from some points of the box, where it has no bounds of its own or an enclosure is too wide
    /// to be of use.
    ActiveStress::Bounds
    bounds_of(const ActiveStress &strain, const ActiveStress::Box &box)
    {
      if (const auto bounds = strain.bounds(box); bounds && std::isfinite(bounds->value) && std::isfinite(bounds->rate))
        return *bounds;
      return sampled_bounds(strain, box, 9, 3);
    }

    /// Ends of panels in time such that the strain changes by at most a few times its size in each (two waves of a
    /// sine), so that their points resolve it, however short its events are. Nothing if there are more than @p most.
    std::optional<std::vector<double>>
    time_panels(const ActiveStress &strain, std::vector<double> breaks, const std::size_t most)
    {
      constexpr unsigned int fewest = 4;
      constexpr double max_changes  = 12.;
      constexpr double negligible = 1e-6, shortest = 1e-9; // of the largest strain; of the duration
      for (unsigned int i = 1; i < fewest; ++i)
        breaks.push_back(1. * i / fewest);
      breaks.push_back(1.);
      std::erase_if(breaks, [](const double t) { return !(t > shortest && t <= 1.); });
      std::ranges::sort(breaks, std::greater());
      const double largest     = bounds_of(strain, {0., 1., 0., 1.}).value,
                   floor       = std::isfinite(largest) ? negligible * largest : 0.;
      std::vector<double> ends = {0.};
      for (std::vector<double> &open = breaks; !open.empty();)
      {
        const double from = ends.back(), to = open.back();
        const auto [value, rate] = bounds_of(strain, {0., 1., from, to});
        if (to - from <= shortest || rate * (to - from) <= max_changes * std::max(value, floor))
        {
          ends.push_back(to);
          open.pop_back();
        }
        else
          open.push_back(0.5 * (from + to));
        if (ends.size() + open.size() > most)
          return std::nullopt;
      }
      return ends;
    }

    /// True if one panel is much shorter than another. The change at the few points in an event may be small by chance.
    bool
    has_events(const std::vector<double> &ends)
    {
      constexpr double much = 8.;
      double shortest = HUGE_VAL, longest = 0.;
      for (std::size_t i = 1; i < ends.size(); ++i)
      {
        shortest = std::min(shortest, ends[i] - ends[i - 1]);
        longest  = std::max(longest, ends[i] - ends[i - 1]);
      }
      return longest > much * shortest;
    }

    std::vector<double>
    halved(const std::vector<double> &ends)
    {
      std::vector<double> finer = {ends.front()};
      for (std::size_t i = 1; i < ends.size(); ++i)
        finer.insert(finer.end(), {0.5 * (ends[i - 1] + ends[i]), ends[i]});
      return finer;
    }

    /// @p space_ends and @p ends are those of the panels in space and time.
    Sums
    integrate(const Scene &scene,
              const ActiveStress &strain,
              const std::vector<double> &space_ends,
              const std::vector<double> &ends,
              const std::function<bool()> &keep_going)
    {
      KinematicBody body(scene, strain, space_ends);
      Sums sums;
      add(sums, body.evaluate(0.), 0.);
      sums.energies.initial_energy = body.evaluate(0.).sums.elastic_energy;
      for (std::size_t p = 1; p < ends.size(); ++p)
      {
        sums.displacement +=
          advance(body, ends[p - 1], ends[p], sums.energies, [&](const auto &now, const double duration) {
            add(sums, now, duration);
          });
        if (keep_going && !keep_going())
        {
          sums.stopped = true;
          return sums;
        }
      }
      const auto &end              = body.evaluate(1.);
      sums.energies.elastic_energy = end.sums.elastic_energy;
      add(sums, end, 0.);
      return sums;
    }

    /// Sets the numbers of the finest quadrature @p sums, or the place where the stretch is lost: @p lost, or where the
    /// extremes are.
    void
    set_result(KinematicResult &result, const Sums &sums, const std::optional<StrainExtreme> &lost)
    {
      const bool is_lost_between = !(1. + result.extremes.smallest.strain > 0.);
      if (lost || is_lost_between || !(1. + sums.smallest.strain > 0.))
      {
        result.inversion = lost ? *lost : is_lost_between ? result.extremes.smallest : sums.smallest;
        return;
      }
      result.stopped = sums.stopped;
      if (sums.stopped)
        return;
      if (sums.smallest.strain < result.extremes.smallest.strain)
        result.extremes.smallest = sums.smallest;
      if (sums.largest.strain > result.extremes.largest.strain)
        result.extremes.largest = sums.largest;
      result.displacement = sums.displacement;
      result.energies     = sums.energies;
      result.net_friction = sums.friction_impulse > 0. ? sums.net_impulse / sums.friction_impulse : 0.;
    }
  } // namespace

  KinematicBody::KinematicBody(const Scene &scene,
                               const ActiveStress &strain,
                               const std::vector<double> &panels,
                               const std::vector<double> &points)
    : panels_(panels)
    , points_(points)
    , inside_(panels_.points_and_ends())
    , strain_(strain.at(inside_))
    , rate_(strain.rate_at(inside_))
    , strain_at_points_(strain.at(points))
    , body_(scene, inside_)
    , body_at_points_(scene, points)
    , places_(panels_, points)
    , e_(inside_.size())
    , e_t_(inside_.size())
    , m_(panels_.points().size())
  {
  }

  const KinematicBody::Integrals &
  KinematicBody::evaluate(const double t)
  {
    const std::size_t n = m_.size();
    const auto &weights = panels_.weights();
    time_               = t;
    strain_->values(t, e_);
    rate_->values(t, e_t_);
    integrals_               = {};
    const auto [least, most] = std::minmax_element(e_.begin(), e_.end());
    integrals_.smallest      = {*least, inside_[static_cast<std::size_t>(least - e_.begin())], t};
    integrals_.largest       = {*most, inside_[static_cast<std::size_t>(most - e_.begin())], t};
    if (!(1. + *least > 0.) || !std::isfinite(*most))
    {
      integrals_.sums.velocity = integrals_.sums.dissipation = integrals_.sums.stress_power = unknown;
      return integrals_;
    }
    motion_.find(panels_, {e_.data(), n}, {e_t_.data(), n}, body_);
    panels_.running_integral(motion_.gv, m_);
    double end_B_t = 0.;
    for (std::size_t i = 0; i < n; ++i)
      end_B_t += weights[i] * e_t_[i];
    const std::vector<double> &k = body_.elastic_modulus;
    for (std::size_t i = 0; i < n; ++i)
    {
      const double m = equation::active_stress(m_[i], e_[i], k[i]);
      add_densities<double>(weights[i],
                            {equation::elastic_energy(e_[i], k[i]), equation::stress_power(m, e_t_[i]), motion_.gv[i]},
                            motion_.v[i],
                            integrals_.sums);
    }
    integrals_.sums.velocity = motion_.velocity; // without the round-off of the sum
    // Force m = -k e at the ends, where none acts.
    integrals_.end_power = -(k[n + 1] * e_[n + 1] * (end_B_t + motion_.drift) - k[n] * e_[n] * motion_.drift);
    return integrals_;
  }

  ReducedFields
  KinematicBody::fields(const double displacement)
  {
    const std::size_t n = m_.size(), n_points = points_.size();
    ReducedFields fields;
    fields.strain.resize(n_points);
    fields.displacement.resize(n_points);
    fields.velocity.resize(n_points);
    fields.active_stress.resize(n_points);
    strain_at_points_->values(time_, fields.strain);
    places_.running_integral({e_.data(), n}, fields.displacement);
    places_.running_integral({e_t_.data(), n}, fields.velocity);
    places_.running_integral(motion_.gv, fields.active_stress);
    std::vector<double> B(n);
    panels_.running_integral({e_.data(), n}, B);
    const double B_mean = panels_.integral(B);
    for (std::size_t i = 0; i < n_points; ++i)
    {
      fields.displacement[i] += displacement - B_mean;
      fields.velocity[i] += motion_.drift;
      fields.active_stress[i] =
        equation::active_stress(fields.active_stress[i], fields.strain[i], body_at_points_.elastic_modulus[i]);
    }
    return fields;
  }

  double
  advance(KinematicBody &body,
          const double start,
          const double end,
          EnergyBalance &energies,
          const std::function<void(const KinematicBody::Integrals &, double)> &see)
  {
    static const GaussPanels panel(0., 1., 1);
    double displacement = 0.;
    for (unsigned int i = 0; i < GaussPanels::n_points; ++i)
    {
      const auto &now     = body.evaluate(start + (end - start) * panel.points()[i]);
      const double weight = (end - start) * panel.weights()[i];
      if (see)
        see(now, weight);
      displacement += weight * now.sums.velocity;
      Rates works = now.rates();
      for (double &work : works)
        work *= weight;
      energies.add_works(works);
    }
    return displacement;
  }

  KinematicResult
  kinematic(const Scene &scene,
            const ActiveStress &strain,
            const double tolerance,
            const std::function<bool()> &keep_going)
  {
    constexpr double floor = 1e-12, share = 0.25, min_part = 0.1;
    constexpr unsigned int max_space = 1024, max_time = 1u << 17, max_in_all = 1u << 20;
    KinematicResult result;
    std::vector<double> &space_ends = result.space_panels;
    space_ends                      = GaussPanels::ends_at(scene.breaks_in_space(), 1., 2);
    const auto panels               = time_panels(strain, scene.active_stress->breaks_in_time(), max_time / 4);
    const bool sees_all             = panels.has_value();
    const double part               = sees_all && has_events(*panels) ? min_part : 0.;
    std::vector<double> &ends       = result.time_panels;
    ends                            = sees_all ? *panels : std::vector<double>{0., 0.25, 0.5, 0.75, 1.};
    for (;;)
    {
      const std::size_t n_space = space_ends.size() - 1, n_time = ends.size() - 1;
      const Sums coarse  = integrate(scene, strain, space_ends, ends, keep_going);
      const bool inverts = !(1. + coarse.smallest.strain > 0.);
      Sums in_space, in_time, both;
      if (!inverts && !coarse.stopped)
      {
        in_space = integrate(scene, strain, halved(space_ends), ends, keep_going);
        in_time  = integrate(scene, strain, space_ends, halved(ends), keep_going);
      }
      if (coarse.stopped || in_space.stopped || in_time.stopped)
      {
        result.stopped = true;
        return result;
      }
      result.space_error   = std::abs(in_space.displacement - coarse.displacement);
      result.time_error    = sees_all ? std::abs(in_time.displacement - coarse.displacement) : HUGE_VAL;
      const double allowed = share * std::max(tolerance * std::abs(in_time.displacement), floor);
      result.time_error    = std::max(result.time_error, part * allowed);
      // At a = 0 the displacement is 0: the works decide there, and otherwise hardly ever.
      const auto settled = [&](const Sums &finer) {
        const double works = share * std::max(tolerance, floor) * coarse.energies.exchanged_work;
        return std::abs(finer.displacement - coarse.displacement) <= allowed &&
               std::abs(finer.energies.stress_work - coarse.energies.stress_work) <= works &&
               std::abs(finer.energies.dissipation - coarse.energies.dissipation) <= works;
      };
      const bool space_fits = settled(in_space), time_fits = settled(in_time);
      const bool at_limit = (!space_fits && 4 * n_space > max_space) || (!time_fits && 4 * n_time > max_time) ||
                            16 * n_space * n_time > max_in_all;
      if (!inverts && !(space_fits && time_fits) && !at_limit)
      {
        if (!space_fits)
          space_ends = halved(space_ends);
        if (!time_fits)
          ends = halved(ends);
        continue;
      }
      space_ends = halved(space_ends);
      ends       = halved(ends);
      if (!inverts)
        both = integrate(scene, strain, space_ends, ends, keep_going);
      // Extremes are searched where the finest quadrature has seen them.
      const auto n_s  = static_cast<unsigned int>(std::clamp<std::size_t>(8 * n_space, 33, 257)),
                 n_t  = static_cast<unsigned int>(std::clamp<std::size_t>(8 * n_time, 33, 2049));
      result.extremes = find_extremes(strain, 1., 1., n_s, n_t);
      set_result(result, both, inverts ? std::optional(coarse.smallest) : std::nullopt);
      return result;
    }
  }
} // namespace crawler
