#include "../support/run_text.h"
#include <chrono>
#include <crawler/fused/batch.h>
#include <cstdio>
#include <deal.II/base/mpi.h>
#include <random>
using namespace crawler;
int
main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize guard(argc, argv, 1);
  std::mt19937 gen(7);
  auto U = [&](double a, double b)
  {
    return a + (b - a) * std::generate_canonical<double, 53>(gen);
  };
  for (int i = 0; i < 40; ++i)
  {
    double a = U(-3, 2), chi = U(0.02, 0.4), k = std::pow(10, U(-1.5, 2)),
           T = i % 5 == 0 ? 20 : std::pow(10, U(-0.3, 0.7));
    auto st  = test::wave(a, chi);
    st.emplace_back("Body/Elastic modulus", test::text(k));
    st.emplace_back("Time/End time", test::text(T));
    std::string what = "wave";
    if (i % 4 == 1)
    {
      st   = {{"Body/Anchoring exponent", test::text(1 - a)},
              {"Body/Elastic modulus", test::text(k)},
              {"Time/End time", test::text(T)},
              {"Active stress/Generator", "expression"},
              {"Active stress/Expression/Active stress",
               "0.3*" + test::text(chi * std::min(k, 1.)) + "*sin(2*pi*(s+t))^3*exp(-3*s)"}};
      what = "expr";
    }
    if (i % 4 == 3)
    {
      st   = {{"Body/Anchoring exponent", test::text(1 - a)},
              {"Body/Elastic modulus", test::text(k)},
              {"Time/End time", test::text(T)},
              {"Active stress/Generator", "expression"},
              {"Active stress/Expression/Active stress",
               "0.5*" + test::text(chi * std::min(k, 1.)) + "*(tanh(8*sin(2*pi*(s+t)))+0.4)"}};
      what = "tanh";
    }
    try
    {
      const auto parameters = test::parameters_with(st);
      const Scene scene     = parameters.create_scene();
      auto go               = [&](unsigned s, double tol, double h0)
      {
        FusedRun r{&scene, tol, h0 * T, 1e9, 1000000};
        return run_batch({6, 24, s}, {&r, 1})[0];
      };
      auto ref = go(5, 1e-12, 1e-2);
      if (!ref.finished)
      {
        printf("%d %s a %.2f chi %.2f k %.3g T %.2g: not finished min %.3f\n",
               i,
               what.c_str(),
               a,
               chi,
               k,
               T,
               ref.min_stretch);
        continue;
      }
      printf("%d %s a %.2f chi %.2f k %.3g T %.2g D %.4g steps %u:\n",
             i,
             what.c_str(),
             a,
             chi,
             k,
             T,
             ref.displacement,
             ref.steps);
      double size = std::max(std::abs(ref.displacement), 1e-5);
      for (unsigned s : {3u, 5u})
      {
        printf("   s=%u:", s);
        for (double tol : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7})
        {
          auto r   = go(s, tol * size, 1e-2);
          double e = std::abs(r.displacement - ref.displacement) / (tol * size);
          printf(" %6.0e: %3u+%-2u %.0e/%.0e", tol, r.steps, r.rejected_steps, e, e / r.steps);
        }
        printf("\n");
      }
    }
    catch (const std::exception &e)
    {
      printf("%d: %s\n", i, e.what());
    }
  }
}
