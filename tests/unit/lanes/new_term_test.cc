// SPDX-License-Identifier: LGPL-2.1-or-later
//
// A made-up term of the equation, a body that stiffens, N = m + k e + beta e^3, on ground with f = g(w) v + c v^3: laws
// of its own are all that it needs. The loops over cells then have it in the residual, in the Jacobian (against
// differences), in the energies, and in the lanes.
#include "../../support/derivative.h"
#include "../../support/test.h"

#define CRAWLER_PACK pack2 // of what is compiled here

#include <crawler/equation/cell_kernels.h>
#include <crawler/equation/cell_loops.h>
#include <crawler/lanes/pack.h>

namespace
{
  using namespace crawler;
  using namespace crawler::CRAWLER_INSTRUCTION_SET;

  constexpr int n    = 5;
  constexpr double h = 0.3, k = 0.7, beta = 4., c = 0.6, gamma = 1.3;
  using State   = std::array<double, n>;
  const State u = {{0., 0.02, -0.05, 0.03, 0.06}}, v = {{0.3, -0.2, 0.5, 0.1, -0.4}};
  const State m_at                = {{0.1, -0.2, 0.15, 0.05, -0.1}};
  const ReferenceElement &element = reference_element(n - 1);
  const ElementTables tables      = {
         element.values.data(), element.derivatives.data(), element.weights.data(), element.stiffness.data()};

  template <typename Number>
  struct Laws
  {
    static constexpr bool has_one_modulus = false;
    const Number *m;
    double with_term;

    static constexpr bool
    has_place()
    {
      return false;
    }
    static constexpr bool
    has_rate()
    {
      return false;
    }

    void
    forces(const Number *e, const Number *w, const Number *v, Number *N, Number *f) const
    {
      for (int p = 0; p < n; ++p)
      {
        N[p] = m[p] + k * e[p] + with_term * beta * e[p] * e[p] * e[p];
        if (v != nullptr)
          f[p] = gamma * w[p] * w[p] * v[p] + with_term * c * v[p] * v[p] * v[p];
      }
    }
    template <bool>
    void
    derivatives(const Number *e, const Number *w, const Number *v, PointDerivatives<n, Number> &D) const
    {
      for (int p = 0; p < n; ++p)
      {
        D.f_v[p] = gamma * w[p] * w[p] + with_term * 3. * c * v[p] * v[p];
        D.f_w[p] = 2. * gamma * w[p] * v[p];
        D.N_w[p] = k + with_term * 3. * beta * e[p] * e[p];
      }
    }
    void
    densities(const Number *e, const Number *w, const Number *v, const Number *v_s, PointDensities<Number> *at) const
    {
      for (int p = 0; p < n; ++p)
        at[p] = {0.5 * k * e[p] * e[p] + with_term * 0.25 * beta * e[p] * e[p] * e[p] * e[p],
                 -m[p] * v_s[p],
                 gamma * w[p] * w[p] * v[p] + with_term * c * v[p] * v[p] * v[p]};
    }
  };

  State
  residual(const State &u, const double *v, const State &m, const double with_term = 1.)
  {
    State F{};
    cell_residual<n>(tables, h, Laws<double>{m.data(), with_term}, u.data(), v, F.data());
    return F;
  }

  CellIntegrals
  integrals(const State &u, const State &v)
  {
    CellIntegrals sum;
    cell_integrals<n>(tables, h, Laws<double>{m_at.data(), 1.}, u.data(), v.data(), sum);
    return sum;
  }

  double
  product(const State &a, const State &b)
  {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.);
  }

  std::array<State, 2 * n>
  blocks()
  {
    std::array<double, n * n> K, M;
    cell_blocks<n, true>(tables, h, Laws<double>{m_at.data(), 1.}, u.data(), v.data(), K.data(), M.data());
    std::array<State, 2 * n> columns;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
      {
        columns[j][i]     = K[i * n + j];
        columns[n + j][i] = M[i * n + j];
      }
    return columns;
  }

  TEST(NewTerm, IsInTheResidual)
  {
    EXPECT_GT(std::abs(residual(u, v.data(), m_at)[2] - residual(u, v.data(), m_at, 0.)[2]), 1e-3);
  }

  TEST(NewTerm, JacobianIsTheDerivativeOfTheResidual)
  {
    const auto columns = blocks();
    for (int j = 0; j < 2 * n; ++j)
    {
      const auto by_differences = test::derivative([&](const double step) {
        State u_j = u, v_j = v;
        (j < n ? u_j[j] : v_j[j - n]) += step;
        const State F = residual(u_j, v_j.data(), m_at);
        return std::vector<double>(F.begin(), F.end());
      });
      for (int i = 0; i < n; ++i)
        EXPECT_NEAR(columns[j][i], by_differences[i], 1e-9) << i << " " << j;
    }
  }

  /// The force in the body is the derivative of the elastic energy; what friction takes is lost; and the powers of all
  /// forces are those of the residual.
  TEST(NewTerm, EnergiesBalance)
  {
    const CellIntegrals sum = integrals(u, v);
    const double rate       = test::derivative([&](const double step) {
      State moved = u;
      for (int i = 0; i < n; ++i)
        moved[i] += step * v[i];
      return std::vector<double>{integrals(moved, v).elastic_energy};
    })[0];
    EXPECT_NEAR(rate, product(residual(u, nullptr, State{}), v), 1e-9);
    EXPECT_NEAR(
      sum.dissipation, product(residual(u, v.data(), m_at), v) - product(residual(u, nullptr, m_at), v), 1e-12);
    EXPECT_NEAR(rate - sum.stress_power + sum.dissipation, product(residual(u, v.data(), m_at), v), 1e-9);
  }

  TEST(NewTerm, IsInTheLanes)
  {
    pack2 u_pack[n], v_pack[n], m_pack[n], F[n] = {}, K[n * n], M[n * n];
    for (int i = 0; i < n; ++i)
    {
      u_pack[i] = pack2{0., u[i]};
      v_pack[i] = pack2{0., v[i]};
      m_pack[i] = pack2{m_at[i], m_at[i]};
    }
    const Laws<pack2> laws{m_pack, 1.};
    cell_residual<n>(tables, h, laws, u_pack, v_pack, F);
    cell_blocks<n, true>(tables, h, laws, u_pack, v_pack, K, M);
    const State expected = residual(u, v.data(), m_at), at_rest = residual(State{}, State{}.data(), m_at);
    const auto columns = blocks();
    for (int i = 0; i < n; ++i)
    {
      EXPECT_NEAR(F[i][0], at_rest[i], 1e-15);
      EXPECT_NEAR(F[i][1], expected[i], 1e-15);
      for (int j = 0; j < n; ++j)
      {
        EXPECT_NEAR(K[i * n + j][1], columns[j][i], 1e-14);
        EXPECT_NEAR(M[i * n + j][1], columns[n + j][i], 1e-14);
      }
    }
  }
} // namespace
