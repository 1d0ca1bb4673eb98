// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What the stretch form says of a state: identities of the velocity and its energies, and the rules for the mobility of
// a node (stretch_loops.h).
#include "../../support/features.h"
#include "../../support/test.h"

#include <crawler/equation/stretch_form.h>
#include <crawler/equation/stretch_loops.h>

using namespace crawler;
using generic::directed_velocity;
using generic::node_mobility;
using generic::NodeMobility;
using test::Feature;

namespace
{
  constexpr double t = 0.3;

  /// Factor d(v) of the friction.
  double
  factor(const Direction &direction, const double v)
  {
    const double r = direction.ratio;
    return 0.5 * (1. + r) + 0.5 * (1. - r) * std::tanh(v / direction.switching_velocity);
  }

  Feature
  plain(const double a, const double k = 1.)
  {
    return {"a = " + test::text(a) + ", k = " + test::text(k), test::wave(a, 0.3, 1., 1., k)};
  }

  /// Plain scenes with all rules for the nodes, and general ones: each law alone, and all together.
  std::vector<Feature>
  features()
  {
    std::vector<Feature> list = {
      plain(-5., 5e-4), plain(-3.), plain(-1.), plain(-0.5), plain(0.), plain(0.5), plain(2.)};
    const std::vector<Feature> general = test::laws();
    list.insert(list.end(), general.begin(), general.end());
    list.push_back({"feedback", test::feedback("0.3*sin(w)*(1+s)+0.1*sin(t)")});
    list.push_back({"rate", test::feedback("0.2*w_t+0.1*tanh(w_t)*w")});
    list.push_back({"Newtonian", {{"Ground/Friction law", "Newtonian"}}});
    list.push_back(test::all_of(general, test::feedback("0.3*sin(w)*(1+s)+0.2*w_t*w+0.1*sin(t)")));
    return list;
  }

  const std::vector<double> ends = {0., 0.05, 0.13, 0.3, 0.45, 0.7, 0.86, 0.95, 1.};

  /// The form on cells of several sizes, with stretches between 0.6 and 1.4.
  struct Case
  {
    explicit Case(const Feature &feature, const bool other = false)
      : scene(test::parameters_with(feature.settings).create_scene())
      , d(MPI_COMM_SELF, ends, 1)
      , form(scene, d, other)
      , is_power(stretch_method(scene, other).is_power)
      , w(d.n_cells())
      , v(d.n_unknowns())
    {
      for (std::size_t j = 0; j < w.size(); ++j)
        w[j] = 1. + 0.35 * std::cos(5. * (d.cell_left[j] + 0.5 * d.cell_size[j]) + 0.4);
      y = state(w, 0.1);
    }

    /// The unknowns for the stretches @p w and the displacement @p left of the left end.
    std::vector<double>
    state(const std::vector<double> &stretches, const double left) const
    {
      std::vector<double> result = stretches;
      const double power         = 1. + scene.friction_exponent();
      if (is_power)
        for (double &q : result)
          q = std::pow(q, power) / power;
      result.push_back(left);
      return result;
    }

    /// The rates of the unknowns where the body moves with the velocity v.
    std::vector<double>
    motion() const
    {
      std::vector<double> result(y.size());
      for (std::size_t j = 0; j < w.size(); ++j)
        result[j] = (v[j + 1] - v[j]) / d.cell_size[j] * (is_power ? std::pow(w[j], scene.friction_exponent()) : 1.);
      result.back() = v[0];
      return result;
    }

    Scene scene;
    Discretization d;
    StretchForm form;
    const bool is_power;
    std::vector<double> w, y, v;
  };

  void
  for_all(const std::function<void(Case &, const std::string &)> &check)
  {
    for (const Feature &feature : features())
      for (const bool other : {false, true})
      {
        Case test(feature, other);
        ASSERT_TRUE(test.form.velocity(t, test.y, test.v)) << feature.name;
        check(test, feature.name + (other ? ", other rule" : ""));
      }
  }

  const std::vector<NodeRule> rules = {NodeRule::friction, NodeRule::fronts, NodeRule::upwind};
} // namespace

TEST(StretchForm, AllRulesForTheNodesAreTested)
{
  std::array<unsigned int, 3> n{};
  for_all(
    [&](Case &test, const std::string &) { ++n[static_cast<std::size_t>(stretch_method(test.scene).node_rule)]; });
  for (const unsigned int found : n)
    EXPECT_GT(found, 2u);
}

/// The velocity balances the friction, and the stress power is dissipated or stored, both to round-off.
TEST(StretchForm, IdentitiesOfAState)
{
  for_all([](Case &test, const std::string &name) {
    const CellIntegrals sum = test.form.integrals(t, test.y, test.v);
    EXPECT_LE(std::abs(sum.net_friction), 1e-14 * sum.abs_friction) << name;
    const std::vector<double> rates = test.motion();
    const auto energy               = [&](const double step) {
      std::vector<double> y = test.y;
      for (std::size_t i = 0; i < y.size(); ++i)
        y[i] += step * rates[i];
      return test.form.integrals(t, y, test.v).elastic_energy;
    };
    const double e = 1e-3 / std::abs(*std::max_element(rates.begin(), rates.end(), [](const double a, const double b) {
                       return std::abs(a) < std::abs(b);
                     }));
    const double rate = (8. * (energy(e) - energy(-e)) - (energy(2. * e) - energy(-2. * e))) / (12. * e);
    EXPECT_NEAR(sum.stress_power, sum.dissipation + rate, 1e-10 * (sum.absolute_power + sum.dissipation)) << name;
    EXPECT_GT(sum.dissipation, 0.) << name;
    EXPECT_GE(sum.positive_power, sum.stress_power) << name;
  });
}

/// What telescopes is the friction of the equation: where nodes have the mean friction of their cells it is that of the
/// trapezoidal rule in each cell.
TEST(StretchForm, FrictionIsThatOfTheLaws)
{
  for (const Feature &feature :
       {plain(0.),
        plain(0.5),
        plain(2.),
        Feature{"general",
                test::set("Body/Friction profile = 2-s^2; Ground/Friction law = expression; Ground/Expression = "
                          "0.5+0.5*w^2; Ground/Backward ratio = 3; Ground/Switching velocity = 0.2")}})
  {
    Case test(feature);
    ASSERT_EQ(stretch_method(test.scene).node_rule, NodeRule::friction) << feature.name;
    ASSERT_TRUE(test.form.velocity(t, test.y, test.v));
    const std::size_t n = test.w.size();
    std::vector<double> g(n), w_dg(n), b(n, 1.);
    test.scene.friction->values(test.w, g, w_dg);
    if (test.scene.profiles.friction)
      test.scene.profiles.friction->values(test.d.points({0.5}), b);
    double net = 0., power = 0., size = 0.;
    for (std::size_t j = 0; j < n; ++j)
      for (const double v : {test.v[j], test.v[j + 1]})
      {
        const double f = 0.5 * test.d.cell_size[j] * g[j] * b[j] * factor(test.scene.ground.direction, v) * v;
        net += f;
        size += std::abs(f);
        power += f * v;
      }
    EXPECT_LT(std::abs(net), 1e-13 * size) << feature.name;
    EXPECT_NEAR(test.form.integrals(t, test.y, test.v).dissipation, power, 1e-13 * power) << feature.name;
  }
}

/// Length, stretches and centre of mass of a state are what they were made of.
TEST(StretchForm, StatesAreShapes)
{
  for_all([](Case &test, const std::string &name) {
    const std::vector<double> u(test.form.displacement(test.y).begin(), test.form.displacement(test.y).end());
    EXPECT_EQ(u[0], 0.1);
    const auto w = test.form.stretch(test.y);
    for (std::size_t j = 0; j < test.w.size(); ++j)
    {
      EXPECT_NEAR(w[j], test.w[j], 1e-14) << name;
      EXPECT_NEAR((u[j + 1] - u[j]) / test.d.cell_size[j], test.w[j] - 1., 1e-13) << name;
    }
  });
}

/// The stretch of each cell is the mean of the initial one over it, and the centre of mass does not move.
TEST(StretchForm, InitialStretch)
{
  for (const double a : {-1., -0.5, 1.})
  {
    Feature feature = plain(a);
    feature.settings.emplace_back("Body/Initial stretch", "1+0.4*sin(3*s)*s");
    Case test(feature);
    test.form.set_initial_state(test.y);
    const auto w        = test.form.stretch(test.y);
    const auto integral = [](const double s) { return s + 0.4 * (std::sin(3. * s) / 9. - s * std::cos(3. * s) / 3.); };
    for (std::size_t j = 0; j < w.size(); ++j)
      EXPECT_NEAR(w[j], (integral(ends[j + 1]) - integral(ends[j])) / (ends[j + 1] - ends[j]), 1e-13);
    EXPECT_NEAR(test.form.integrals(0., test.y, test.v).displacement, 0., 1e-15);
  }
}

/// Where the position form has only round-off left of the stretch, this form still has all its digits.
TEST(StretchForm, KeepsTheDigitsOfASmallStretch)
{
  for (const double a : {-2., -1., -0.5})
  {
    Case test(plain(a));
    test.w[3]             = 1e-12;
    test.y                = test.state(test.w, 0.);
    const StretchAt least = test.form.stretch_range(test.y).min;
    EXPECT_NEAR(least.value, 1e-12, 1e-25);
    EXPECT_GE(least.s, ends[3]);
    EXPECT_LE(least.s, ends[4]);
    EXPECT_TRUE(test.form.velocity(t, test.y, test.v));
  }
}

/// Friction that grows without bound holds what is emptied: nothing flows out of an empty cell, and it can be refilled.
TEST(StretchForm, EmptyCellsGiveNothing)
{
  for (const bool other : {false, true})
    for (std::size_t empty = 0; empty + 1 < ends.size(); ++empty)
      for (const double time : {0.1, 0.3, 0.6, 0.9})
      {
        Case test(plain(-1.), other);
        test.w[empty] = 0.;
        test.y        = test.state(test.w, 0.);
        ASSERT_TRUE(test.form.velocity(time, test.y, test.v));
        EXPECT_GE(test.v[empty + 1] - test.v[empty], 0.);
      }
}

TEST(NodeMobility, OfEqualCellsIsTheirs)
{
  const std::vector<double> h = {0.1, 0.3, 0.05, 0.2}, mobility(4, 0.7);
  for (const NodeRule rule : rules)
    for (const double difference : {-1., 1.})
      for (int i = 1; i < 4; ++i)
        EXPECT_NEAR(node_mobility(rule, 4, h.data(), mobility.data(), i, difference).value, 0.7, 1e-15);
}

/// Between a full cell and an empty one.
TEST(NodeMobility, FillsEmptyCellsAndKeepsThemEmpty)
{
  const std::vector<double> h(4, 0.25), mobility = {0., 0., 1., 1.};
  const auto of = [&](const NodeRule rule, const double difference) {
    return node_mobility(rule, 4, h.data(), mobility.data(), 2, difference).value;
  };
  // Length goes to the left if the velocity is positive.
  EXPECT_EQ(of(NodeRule::friction, 1.), 0.);
  EXPECT_EQ(of(NodeRule::friction, -1.), 0.);
  EXPECT_EQ(of(NodeRule::fronts, 1.), 0.5);
  EXPECT_EQ(of(NodeRule::fronts, -1.), 0.);
  EXPECT_EQ(of(NodeRule::upwind, 1.), 1.);
  EXPECT_EQ(of(NodeRule::upwind, -1.), 0.);
}

TEST(NodeMobility, DerivativesMatchDifferences)
{
  constexpr double e          = 1e-6;
  constexpr int n             = 6;
  const std::vector<double> h = {0.1, 0.3, 0.05, 0.2, 0.25, 0.1};
  unsigned int limited        = 0;
  for (unsigned int sample = 0; sample < 20; ++sample)
  {
    std::vector<double> mobility(n);
    for (int j = 0; j < n; ++j)
      mobility[j] = 1. + 0.8 * std::sin(12.9898 * (n * sample + j + 1.));
    for (const NodeRule rule : rules)
      for (const double difference : {-0.3, 0.3})
        for (int i = 1; i < n; ++i)
        {
          const auto value = [&](const int cell, const double step) {
            std::vector<double> changed = mobility;
            changed[cell] += step;
            return node_mobility(rule, n, h.data(), changed.data(), i, difference).value;
          };
          const auto slope = [&](const int cell) { return (value(cell, e) - value(cell, -e)) / (2. * e); };
          const NodeMobility<double> result = node_mobility(rule, n, h.data(), mobility.data(), i, difference);
          EXPECT_NEAR(result.by_left, slope(i - 1), 1e-8) << "rule " << static_cast<int>(rule) << ", node " << i;
          EXPECT_NEAR(result.by_right, slope(i), 1e-8) << "rule " << static_cast<int>(rule) << ", node " << i;
          limited += rule == NodeRule::upwind && result.by_left * result.by_right != 0.;
        }
  }
  EXPECT_GT(limited, 20u); // else van Leer's correction was not tested
}

TEST(DirectedVelocity, SolvesForTheVelocity)
{
  for (const double ratio : {0.1, 0.5, 1., 3., 10.})
    for (const double switching_velocity : {0.01, 0.2, 5.})
    {
      const Direction direction{ratio, switching_velocity};
      for (double size = 1e-6; size < 1e3; size *= 3.)
        for (const double q : {-size, 0., size})
        {
          double slope = 0., unused = 0.;
          const double v = directed_velocity(direction, q, slope);
          EXPECT_NEAR(factor(direction, v) * v, q, 1e-14 * size) << ratio << " " << switching_velocity;
          const double e = 1e-4 * std::min(size, switching_velocity),
                       by_differences =
                         (directed_velocity(direction, q + e, unused) - directed_velocity(direction, q - e, unused)) /
                         (2. * e);
          EXPECT_NEAR(slope, by_differences, 1e-6 * slope) << ratio << " " << switching_velocity << " " << q;
        }
    }
}
