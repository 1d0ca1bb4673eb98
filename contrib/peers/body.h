// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What the peers in C share: the crawler equation in position form by elements of degree q on n equal cells of a body
// of length 1 with gamma = 1. Unknown is the displacement u = zeta - s at the Gauss-Lobatto nodes, w = 1 + u_s:
//
//     F_i = int w^a u_t phi_i + (k (w-1) + m) phi_i,s ds,    m the optimal wave with a_1 = c = 1 (doc/theory.md).
//
// serve() is the main loop: each line of the standard input, "METHOD a chi k T degree cells tolerance repeat", is
// answered by a line "displacement seconds", processor time of a run; or "failed" and why. The tolerance is absolute.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum
{
  MOST          = 12,
  MOST_UNKNOWNS = 1000
};

struct Body
{
  char method[32];
  double a, chi, k, T, tolerance;
  int q, cells, n;                                                              // n unknowns
  double phi[MOST][MOST], slope[MOST][MOST], weight[MOST], mean[MOST];          // [Gauss point][node]; on a cell
  double constant[MOST_UNKNOWNS], by_cos[MOST_UNKNOWNS], by_sin[MOST_UNKNOWNS]; // stress at the Gauss points
};

// P_n and its derivative.
static double
legendre(int n, double x, double *slope)
{
  double last = 1., p = x;
  for (int i = 2; i <= n; ++i)
  {
    const double next = ((2 * i - 1) * x * p - (i - 1) * last) / i;
    last = p, p = next;
  }
  *slope = n * (last - x * p) / (1. - x * x);
  return p;
}

// Zeros of P_n (n points), or of P'_(n-1) with the ends, on [-1, 1] by Newton's method.
static void
points(int n, int with_ends, double *x, double *weight)
{
  for (int i = 0; i < n; ++i)
  {
    double p = 0., slope = 0.;
    const int degree = with_ends ? n - 1 : n, is_end = with_ends && (i == 0 || i == n - 1);
    x[i] = is_end ? (i == 0 ? -1. : 1.) : -cos(M_PI * (with_ends ? i / (n - 1.) : (i + 0.75) / (n + 0.5)));
    for (int iteration = 0; iteration < 20 && !is_end; ++iteration)
    {
      p                   = legendre(degree, x[i], &slope);
      const double second = (2. * x[i] * slope - degree * (degree + 1.) * p) / (1. - x[i] * x[i]);
      x[i] -= with_ends ? slope / second : p / slope;
    }
    if (!with_ends)
      weight[i] = 2. / ((1. - x[i] * x[i]) * slope * slope);
  }
}

static void
prepare(struct Body *b)
{
  const int q = b->q, gauss = q + 1;
  const double h = 1. / b->cells, two_pi = 2. * M_PI;
  double node[MOST], point[MOST];
  points(q + 1, 1, node, NULL);
  points(gauss, 0, point, b->weight);
  b->n = q * b->cells + 1;
  memset(b->mean, 0, sizeof b->mean);
  for (int g = 0; g < gauss; ++g)
    for (int i = 0; i <= q; ++i)
    {
      double value = 1., slope = 0.; // of the Lagrange polynomial
      for (int j = 0; j <= q; ++j)
        if (j != i)
        {
          slope = (slope * (point[g] - node[j]) + value) / (node[i] - node[j]);
          value *= (point[g] - node[j]) / (node[i] - node[j]);
        }
      b->phi[g][i] = value, b->slope[g][i] = slope * 2. / h;
      b->mean[i] += 0.5 * h * b->weight[g] * value;
    }
  for (int g = 0; g < gauss; ++g)
    b->weight[g] *= 0.5 * h;
  for (int cell = 0; cell < b->cells; ++cell)
    for (int g = 0; g < gauss; ++g)
    {
      const double s = (cell + 0.5 * (1. + point[g])) * h, sine = sin(two_pi * s), cosine = cos(two_pi * s);
      const int i    = cell * gauss + g;
      b->constant[i] = b->chi * b->k * sine;
      b->by_cos[i]   = b->chi * ((1. - cosine) / two_pi - b->k * sine);
      b->by_sin[i]   = b->chi * (sine / two_pi - b->k * cosine);
    }
}

static inline double
power(double w, double a)
{
  return a == -1. ? 1. / w : a == -2. ? 1. / (w * w) : a == -3. ? 1. / (w * w * w) : pow(w, a);
}

static inline __attribute__((always_inline)) int
loops(const int q,
      const struct Body *b,
      double t,
      const double *u,
      const double *rate,
      double *F,
      double sigma,
      double *jacobian)
{
  const int gauss     = q + 1;
  const double cosine = cos(2. * M_PI * t), sine = sin(2. * M_PI * t);
  if (F)
    memset(F, 0, b->n * sizeof *F);
  if (jacobian)
    memset(jacobian, 0, b->cells * gauss * gauss * sizeof *jacobian);
  for (int cell = 0; cell < b->cells; ++cell)
    for (int g = 0; g < gauss; ++g)
    {
      const int first = cell * q, point = cell * gauss + g;
      double w = 1., v = 0.;
      for (int i = 0; i <= q; ++i)
        w += b->slope[g][i] * u[first + i], v += b->phi[g][i] * rate[first + i];
      if (!(w > 0.))
        return 1;
      const double friction = power(w, b->a) * b->weight[g];
      if (F)
      {
        const double m     = b->constant[point] + b->by_cos[point] * cosine + b->by_sin[point] * sine;
        const double force = (b->k * (w - 1.) + m) * b->weight[g], drag = friction * v;
        for (int i = 0; i <= q; ++i)
          F[first + i] += drag * b->phi[g][i] + force * b->slope[g][i];
      }
      if (jacobian)
      {
        const double stiffness = b->k * b->weight[g], by_w = b->a * friction / w * v;
        for (int i = 0; i <= q; ++i)
        {
          double *row           = jacobian + (cell * gauss + i) * gauss;
          const double by_phi   = sigma * friction * b->phi[g][i],
                       by_slope = by_w * b->phi[g][i] + stiffness * b->slope[g][i];
          for (int j = 0; j <= q; ++j)
            row[j] += by_phi * b->phi[g][j] + by_slope * b->slope[g][j];
        }
      }
    }
  return 0;
}

// F, and if `jacobian` is given blocks[cell][i][j] of sigma dF/du_t + dF/du. Not zero where a stretch is not positive.
// The compiler knows the length of the loops.
static int
evaluate(const struct Body *b, double t, const double *u, const double *rate, double *F, double sigma, double *jacobian)
{
  switch (b->q)
  {
    case 3:
      return loops(3, b, t, u, rate, F, sigma, jacobian);
    case 4:
      return loops(4, b, t, u, rate, F, sigma, jacobian);
    case 5:
      return loops(5, b, t, u, rate, F, sigma, jacobian);
    case 6:
      return loops(6, b, t, u, rate, F, sigma, jacobian);
    case 7:
      return loops(7, b, t, u, rate, F, sigma, jacobian);
    default:
      return loops(b->q, b, t, u, rate, F, sigma, jacobian);
  }
}

static double
displacement(const struct Body *b, const double *u)
{
  double sum = 0.;
  for (int cell = 0; cell < b->cells; ++cell)
    for (int i = 0; i <= b->q; ++i)
      sum += b->mean[i] * u[cell * b->q + i];
  return sum;
}

static double
now(void)
{
  struct timespec time;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return time.tv_sec + 1e-9 * time.tv_nsec;
}

// `run` leaves the final u in its second argument, and returns 0 or an error code.
static int
serve(int (*run)(const struct Body *, double *))
{
  static struct Body b;
  static double u[MOST_UNKNOWNS];
  char line[256];
  while (fgets(line, sizeof line, stdin))
  {
    int repeat = 1, code = 0;
    if (sscanf(line,
               "%31s %lf %lf %lf %lf %d %d %lf %d",
               b.method,
               &b.a,
               &b.chi,
               &b.k,
               &b.T,
               &b.q,
               &b.cells,
               &b.tolerance,
               &repeat) != 9 ||
        b.q < 1 || b.q >= MOST || (b.q + 1) * b.cells > MOST_UNKNOWNS)
      return fprintf(stderr, "bad line: %s", line), 2;
    const double start = now();
    for (int i = 0; i < repeat && code == 0; ++i)
    {
      prepare(&b);
      code = run(&b, u);
    }
    if (code != 0)
      printf("failed code %d\n", code);
    else
      printf("%.16g %.6g\n", displacement(&b, u), (now() - start) / repeat);
    fflush(stdout);
  }
  return 0;
}
