// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/block_tridiagonal_kernels.h>
#include <crawler/mesh/block_tridiagonal_loops.h>
#include <crawler/mesh/reference_element.h>

namespace crawler
{
  using namespace CRAWLER_INSTRUCTION_SET;

  namespace
  {
    template <typename Number, int q>
    struct Kernels
    {
      static constexpr int n = q + 1;

      static void
      multiply(const unsigned int n_cells, const Number *blocks, const Number *x, Number *y)
      {
        for (unsigned int c = 0; c < n_cells; ++c)
          for (int i = 0; i < n; ++i)
          {
            Number sum = 0.;
            for (int j = 0; j < n; ++j)
              sum += blocks[(c * n + i) * n + j] * x[c * q + j];
            y[c * q + i] += sum;
          }
      }

      static bool
      condense(const unsigned int n_cells, Number *blocks, Number *schur)
      {
        bool ok           = true;
        const auto usable = [&ok](const Number &pivot) { ok = ok && pivot != 0. && is_finite(pivot); };
        for (unsigned int c = 0; c < n_cells; ++c)
          condense_cell<q>(blocks + c * n * n, schur + 4 * c, usable);
        return ok;
      }

      static void
      forward(const unsigned int n_cells, const Number *blocks, Number *x)
      {
        for (unsigned int c = 0; c < n_cells; ++c)
        {
          const Number *A = blocks + c * n * n;
          solve_inner<q>(A, x + c * q);
          eliminate_inner<q>(A, 0, x + c * q);
          eliminate_inner<q>(A, q, x + c * q);
        }
      }

      static void
      backward(const unsigned int n_cells, const Number *blocks, Number *x)
      {
        for (unsigned int c = 0; c < n_cells; ++c)
          backward_cell<q>(blocks + c * n * n, x + c * q);
      }

      static constexpr BlockTridiagonalKernels<Number> table = {multiply, condense, forward, backward};
    };
  } // namespace

  template <typename Number>
  const BlockTridiagonalKernels<Number> &
  block_tridiagonal_kernels(const unsigned int degree)
  {
    return for_degree(
      degree, [](const auto q) -> const auto & { return Kernels<Number, q>::table; });
  }

  template const BlockTridiagonalKernels<double> &
  block_tridiagonal_kernels(unsigned int);
  template const BlockTridiagonalKernels<std::complex<double>> &
  block_tridiagonal_kernels(unsigned int);
} // namespace crawler
