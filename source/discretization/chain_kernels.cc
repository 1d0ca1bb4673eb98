// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/chain_kernels.h>

#include <stdexcept>

namespace crawler
{
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

      // Nodes 1 ... q-1 of each cell are the inner ones. After condense() a block holds
      //   [1..q-1][1..q-1]  L (unit diagonal not stored) and U of A_ii, with 1/U_ii on the diagonal
      //   [1..q-1][0 and q] X = A_ii^-1 A_ib
      //   [0 and q][1..q-1] A_bi
      static bool
      condense(const unsigned int n_cells, Number *blocks, Number *schur)
      {
        bool ok = true;
        for (unsigned int c = 0; c < n_cells; ++c)
        {
          Number *A = blocks + c * n * n;
          for (int k = 1; k < q; ++k)
          {
            const Number pivot   = A[k * n + k];
            ok                   = ok && pivot != 0. && is_finite(pivot);
            const Number inverse = 1. / pivot;
            A[k * n + k]         = inverse;
            for (int i = k + 1; i < q; ++i)
            {
              const Number factor = A[i * n + k] * inverse;
              A[i * n + k]        = factor;
              for (int j = k + 1; j < q; ++j)
                A[i * n + j] -= factor * A[k * n + j];
              A[i * n] -= factor * A[k * n];
              A[i * n + q] -= factor * A[k * n + q];
            }
          }
          for (int k = q - 1; k >= 1; --k)
          {
            Number left = A[k * n], right = A[k * n + q];
            for (int j = k + 1; j < q; ++j)
            {
              left -= A[k * n + j] * A[j * n];
              right -= A[k * n + j] * A[j * n + q];
            }
            A[k * n]     = left * A[k * n + k];
            A[k * n + q] = right * A[k * n + k];
          }
          Number s00 = A[0], s01 = A[q], s10 = A[q * n], s11 = A[q * n + q];
          for (int k = 1; k < q; ++k)
          {
            s00 -= A[k] * A[k * n];
            s01 -= A[k] * A[k * n + q];
            s10 -= A[q * n + k] * A[k * n];
            s11 -= A[q * n + k] * A[k * n + q];
          }
          schur[4 * c]     = s00;
          schur[4 * c + 1] = s01;
          schur[4 * c + 2] = s10;
          schur[4 * c + 3] = s11;
        }
        return ok;
      }

      static void
      forward(const unsigned int n_cells, const Number *blocks, Number *x)
      {
        for (unsigned int c = 0; c < n_cells; ++c)
        {
          const Number *A = blocks + c * n * n;
          Number *y       = x + c * q;
          for (int i = 2; i < q; ++i)
            for (int j = 1; j < i; ++j)
              y[i] -= A[i * n + j] * y[j];
          for (int i = q - 1; i >= 1; --i)
          {
            for (int j = i + 1; j < q; ++j)
              y[i] -= A[i * n + j] * y[j];
            y[i] *= A[i * n + i];
          }
          for (int i = 1; i < q; ++i)
          {
            y[0] -= A[i] * y[i];
            y[q] -= A[q * n + i] * y[i];
          }
        }
      }

      static void
      backward(const unsigned int n_cells, const Number *blocks, Number *x)
      {
        for (unsigned int c = 0; c < n_cells; ++c)
        {
          const Number *A = blocks + c * n * n;
          Number *y       = x + c * q;
          for (int i = 1; i < q; ++i)
            y[i] -= A[i * n] * y[0] + A[i * n + q] * y[q];
        }
      }

      static constexpr ChainKernels<Number> table = {multiply, condense, forward, backward};
    };
  } // namespace

  template <typename Number>
  const ChainKernels<Number> &
  chain_kernels(const unsigned int degree)
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

  template const ChainKernels<double> &
  chain_kernels(unsigned int);
  template const ChainKernels<std::complex<double>> &
  chain_kernels(unsigned int);
} // namespace crawler
