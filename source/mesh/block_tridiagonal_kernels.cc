// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/block_tridiagonal_kernels.h>
#include <crawler/mesh/block_tridiagonal_loops.h>

#include <stdexcept>

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
          forward_cell<q>(blocks + c * n * n, x + c * q);
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
    switch (degree)
    {
      case 1:
        return Kernels<Number, 1>::table;
      case 2:
        return Kernels<Number, 2>::table;
      case 3:
        return Kernels<Number, 3>::table;
      case 4:
        return Kernels<Number, 4>::table;
      case 5:
        return Kernels<Number, 5>::table;
      case 6:
        return Kernels<Number, 6>::table;
      case 7:
        return Kernels<Number, 7>::table;
      case 8:
        return Kernels<Number, 8>::table;
    }
    throw std::logic_error("degrees 1 to 8 are compiled");
  }

  template const BlockTridiagonalKernels<double> &
  block_tridiagonal_kernels(unsigned int);
  template const BlockTridiagonalKernels<std::complex<double>> &
  block_tridiagonal_kernels(unsigned int);
} // namespace crawler
