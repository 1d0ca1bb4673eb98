// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_interpolation.h>
#include <crawler/base/grid_samples.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/active_stress/prescribed_strain.h>
#include <crawler/scene/breaks.h>
#include <crawler/scene/fast_changes.h>
#include <crawler/scene/given_motion.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string prescribed_strain_section = "Active stress/Prescribed strain/";

    /// e = mean + amplitude sin( q (s + c t) + phase )
    std::unique_ptr<const ActiveStress>
    wave_strain(const PrescribedStrainParameters &wave, const double length)
    {
      const double q = 2. * std::numbers::pi * wave.wave_number / length, rate_factor = q * wave.wave_speed;
      return std::make_unique<StressByFunctions>(
        [=](const std::vector<double> &points, const bool rate) {
          return stress_at_points([=](const double t, const std::span<double> e) {
            for (std::size_t i = 0; i < e.size(); ++i)
            {
              const double angle = q * (points[i] + wave.wave_speed * t) + wave.phase;
              e[i]               = rate ? rate_factor * wave.amplitude * std::cos(angle)
                                        : wave.mean_strain + wave.amplitude * std::sin(angle);
            }
          });
        },
        [=](const ActiveStress::Box &) {
          return ActiveStress::Bounds{std::abs(wave.mean_strain) + std::abs(wave.amplitude),
                                      std::abs(rate_factor * wave.amplitude)};
        });
    }

    /// Active stress from the balance of forces, see the class.
    std::unique_ptr<ActiveStressAtPoints>
    balancing_stress(const ActiveStress &strain,
                     const Scene &scene,
                     const std::vector<double> &panel_ends,
                     const std::vector<double> &points)
    {
      const auto panels   = std::make_shared<const GaussPanels>(panel_ends);
      const std::size_t n = panels->points().size();
      const BodyAtPoints body(scene, panels->points());
      const std::vector<double> k = BodyAtPoints(scene, points).elastic_modulus;
      const GaussPanels::Places places(*panels, points);
      GivenMotion motion;
      std::vector<double> e(n), e_t(n), elastic(points.size());
      return stress_at_points([          =,
                               inside    = strain.at(panels->points()),
                               rate      = strain.rate_at(panels->points()),
                               at_points = strain.at(points)](const double t, const std::span<double> m) mutable {
        inside->values(t, e);
        rate->values(t, e_t);
        motion.find(*panels, e, e_t, body);
        places.running_integral(motion.gv, m);
        at_points->values(t, elastic);
        for (std::size_t i = 0; i < m.size(); ++i)
          m[i] -= k[i] * elastic[i];
      });
    }

    /// Reads a strain on a grid over s and t (base/grid_table.h), with cubic splines in both directions (tensor
    /// product).
    std::unique_ptr<const ActiveStress>
    read_table(const std::string &name, const double length, const double end_time)
    {
      const std::string entry = prescribed_strain_section + "File";
      GridTable grid          = read_grid_table(name, "strain", 4, entry);
      reach_ends(grid.s, length, "s", "body", name, entry);
      reach_ends(grid.t, end_time, "t", "duration", name, entry);
      const auto table = std::make_shared<const GridInterpolation>(
        std::move(grid), GridInterpolation::Method::cubic, GridInterpolation::Outside::go_on);
      return std::make_unique<StressByFunctions>([table](const std::vector<double> &points, const bool rate) {
        return stress_at_points([at = table->at(points), rate](const double t, const std::span<double> e) {
          rate ? at->rates(t, e) : at->values(t, e);
        });
      });
    }

    std::unique_ptr<const ActiveStress>
    create_strain(const PrescribedStrainParameters &parameters,
                  const double length,
                  const double end_time,
                  std::unique_ptr<const ActiveStress> generator)
    {
      if (parameters.given_by == "wave")
        return wave_strain(parameters, length);
      if (parameters.given_by == "table")
        return read_table(parameters.file, length, end_time);
      if (!parameters.is_generated())
        return std::make_unique<Expression>(FormulaInput{"strain",
                                                         parameters.strain,
                                                         parameters.constants,
                                                         prescribed_strain_section + "Strain",
                                                         prescribed_strain_section + "Constants"},
                                            length,
                                            end_time);
      if (generator == nullptr)
        throw std::logic_error("the generator of the strain is missing");
      if (generator->feedback() != nullptr)
        refuse(prescribed_strain_section + "Given by",
               "Given by is {}, but there the active stress depends on the stretch; a generator "
               "that is a function of s and t is expected",
               parameters.given_by);
      if (!generator->rate_at({0.}))
        refuse(prescribed_strain_section + "Given by",
               "Given by is {}, whose rate of change is not known here; a strain that can be "
               "differentiated in time is expected",
               parameters.given_by);
      return generator;
    }
  } // namespace

  void
  PrescribedStrainParameters::add_parameters(Declarations &declarations, const std::vector<std::string> &generators)
  {
    std::vector<std::string> choices = {"expression", "wave", "table"};
    for (const std::string &name : generators)
      if (std::find(choices.begin(), choices.end(), name) == choices.end())
        choices.push_back(name);
    declarations.choice("Given by", given_by, choices)
      .means("How the strain e(s,t), the stretch minus 1, is given: by a formula, a sine wave, a table in a file, or "
             "another generator with the entries of its own section, whose values are read as strain. The nonlinear "
             "model starts from rest, so there e(s,0) must be 0.");
    declarations.text("Strain", strain, "a formula of s and t", "1")
      .means("The strain e(s,t) as a formula like that of Active stress/Expression. Used if given by expression.");
    declarations.constants("Constants", constants, {"Strain"})
      .means("Constants that the formula may use. Used if given by expression.");
    declarations.number("Mean strain", mean_strain, any_number(), "1")
      .means("Mean of the wave: e = mean + amplitude sin(2 pi n (s + c t)/L + phase). Used, as the following entries, "
             "if given by wave.");
    declarations.number("Amplitude", amplitude, any_number(), "1").means("Amplitude of the wave.");
    declarations.number("Wave number", wave_number, positive(), "1").means("Number n of waves per body length.");
    declarations.number("Wave speed", wave_speed, any_number(), "length/time")
      .means("Wave speed c; a positive one runs from s = L to s = 0.");
    declarations.number("Phase", phase, any_number(), "1").means("Phase of the wave at s = 0, t = 0, in radians.");
    declarations.file("File", file, "the name of a CSV or HDF5 file")
      .means("Table: CSV with the header s,t,strain and a row for each point of a full grid over the whole body and "
             "duration, in any order, or HDF5 with s[ns], t[nt] and strain[nt,ns]; cubic splines in s and t go through "
             "them. Used if given by table.");
  }

  PrescribedStrain::PrescribedStrain(const PrescribedStrainParameters &parameters,
                                     const Scene &scene,
                                     std::unique_ptr<const ActiveStress> generator)
    : scene_(scene)
    , parameters_(parameters)
    , strain_(create_strain(parameters, scene.body.length, scene.end_time, std::move(generator)))
  {
    const double phase_rate = parameters.wave_number * parameters.wave_speed / scene.body.length;
    if (parameters_.given_by == "wave" && parameters.amplitude != 0. && phase_rate != 0.)
      facts_.repetition = {1. / std::abs(phase_rate), 0.};
    facts_.has_rate          = false;
    facts_.breaks_in_space   = strain_->breaks_in_space();
    facts_.breaks_in_time    = strain_->breaks_in_time();
    facts_.prescribed_strain = strain_;
    if (parameters_.is_generated())
    {
      facts_.search = [this]() { return strain_->repetition(); };
      require_usable_generator();
    }
    require_admissible_strain();
    choose_panels();
  }

  /// Throws InputError if the strain jumps at a break of the generator.
  void
  PrescribedStrain::require_usable_generator() const
  {
    constexpr unsigned int n = 33;
    constexpr double beside = 1e-9, jump = 1e-6;
    const double L = scene_.body.length, size = sampled_bounds(*strain_, {0., L, 0., scene_.end_time}, n, n).value;
    const auto refuse = [&](const char *variable, const double place) {
      crawler::refuse(prescribed_strain_section + "Given by",
                      "Given by is {}, whose values jump at {} = {:g}; a strain without jumps is expected (give "
                      "fronts and edges a width)",
                      parameters_.given_by,
                      variable,
                      place);
    };
    const auto at_points = strain_->at(equal_parts(0., L, n - 1));
    std::vector<double> e(n), after(n);
    for (const double t : facts_.breaks_in_time)
    {
      if (t == 0. || t == scene_.end_time) // the strain has no other side
        continue;
      at_points->values(t - beside * scene_.end_time, e);
      at_points->values(t + beside * scene_.end_time, after);
      for (unsigned int i = 0; i < n; ++i)
        if (std::abs(after[i] - e[i]) > jump * size)
          refuse("t", t);
    }
    for (const double s : facts_.breaks_in_space)
    {
      const auto sides = strain_->at({s - beside * L, s + beside * L});
      std::array<double, 2> values{};
      for (const double t : equal_parts(0., scene_.end_time, n - 1))
      {
        sides->values(t, values);
        if (std::abs(values[1] - values[0]) > jump * size)
          refuse("s", s);
      }
    }
  }

  void
  PrescribedStrain::require_admissible_strain()
  {
    constexpr unsigned int n = 161;
    extremes_                = find_extremes(*strain_, scene_.body.length, scene_.end_time, n, n);
    const auto &[e, s, t]    = extremes_.smallest;
    const std::string entry  = prescribed_strain_section + (parameters_.given_by == "wave"    ? "Amplitude"
                                                            : parameters_.given_by == "table" ? "File"
                                                            : parameters_.is_generated()      ? "Given by"
                                                                                              : "Strain");
    if (!std::isfinite(e))
      refuse(entry, "the strain is {} at s = {:.6g}, t = {:.6g}; a finite number is expected", e, s, t);
    if (!(1. + e > 0.))
      refuse(entry,
             "the strain is {:.6g} at s = {:.6g}, t = {:.6g}, but more than -1 is expected: there the body would "
             "be inverted",
             e,
             s,
             t);
    const auto &largest = extremes_.largest;
    if (!(largest.strain <= 1e6))
      refuse(entry,
             "the strain is {:.6g} at s = {:.6g}, t = {:.6g}, but at most 1e6 is expected",
             largest.strain,
             largest.s,
             largest.t);
    if (const auto stretch = stretch_without_friction(*scene_.friction, 1. + e, 1. + largest.strain))
      refuse(entry,
             "the friction law has no positive value at the stretch {:.6g}, which this strain "
             "reaches; smaller strains, or another law, are expected",
             *stretch);
    if (const auto jump = find_jump(*strain_, scene_.body.length, scene_.end_time))
      refuse(entry,
             "the strain at s = {:.6g} changes by {:.6g} from t = {:.6g} to {:.6g}, but the integral "
             "of its rate is {:.6g}; a strain without jumps in time is expected",
             jump->s,
             jump->change,
             jump->from,
             jump->to,
             jump->integral);
  }

  /// Doubles the panels, which end at breaks of strain and profiles, until the stress changes by no more than round-off
  /// at some times.
  void
  PrescribedStrain::choose_panels()
  {
    constexpr unsigned int most      = 512;
    constexpr double tolerance       = 1e-13;
    const std::vector<double> points = equal_parts(0., scene_.body.length, 16);
    std::vector<double> coarse(points.size()), fine(points.size()), breaks = scene_.breaks_in_space();
    breaks.insert(breaks.end(), facts_.breaks_in_space.begin(), facts_.breaks_in_space.end());
    breaks = distinct_breaks_in_space(std::move(breaks), scene_.body.length);
    for (unsigned int n = 2; n < most; n *= 2)
    {
      panels_        = GaussPanels::ends_at(breaks, scene_.body.length, n);
      const auto now = balancing_stress(*strain_, scene_, panels_, points),
                 next =
                   balancing_stress(*strain_, scene_, GaussPanels::ends_at(breaks, scene_.body.length, 2 * n), points);
      double change = 0., largest = 0.;
      for (const double part : {0.03, 0.21, 0.47, 0.71, 0.95})
      {
        now->values(part * scene_.end_time, coarse);
        next->values(part * scene_.end_time, fine);
        for (std::size_t i = 0; i < fine.size(); ++i)
        {
          change  = std::max(change, std::abs(fine[i] - coarse[i]));
          largest = std::max(largest, std::abs(fine[i]));
        }
      }
      if (!(change > tolerance * largest))
        return;
    }
  }

  std::unique_ptr<ActiveStressAtPoints>
  PrescribedStrain::evaluator(const std::vector<double> &points, bool) const
  {
    return balancing_stress(*strain_, scene_, panels_, points);
  }

  void
  PrescribedStrain::report(std::ostream &out) const
  {
    out << fmt::format("Strain given by {}: {:.6g} (s = {:.4g}, t = {:.4g}) to {:.6g} (s = {:.4g}, t = {:.4g})\n",
                       parameters_.given_by,
                       extremes_.smallest.strain,
                       extremes_.smallest.s,
                       extremes_.smallest.t,
                       extremes_.largest.strain,
                       extremes_.largest.s,
                       extremes_.largest.t);
    strain_->report(out);
  }
} // namespace crawler
