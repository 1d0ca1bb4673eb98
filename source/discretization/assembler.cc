// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/parabola.h>
#include <crawler/discretization/assembler.h>
#include <crawler/discretization/general_log_form.h>
#include <crawler/discretization/general_position_form.h>
#include <crawler/discretization/general_sampler.h>
#include <crawler/discretization/log_stretch_form.h>
#include <crawler/discretization/position_form.h>
#include <crawler/model/crawler_equation.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace crawler
{
  namespace
  {
    /// Errors of a stretch are relative to it, but not to less than this: what is emptied sticks and pushes no more.
    constexpr double smallest_scale = 0.05;

    /// The entry of the rank with the smallest key, on all ranks.
    StretchAt
    reduce_minimum(const StretchAt own, const double sign, const Discretization &discretization)
    {
      const unsigned int size = discretization.n_ranks();
      if (size == 1)
        return own;
      const double sent[2] = {own.value, own.s};
      std::vector<double> all(2 * size);
      MPI_Allgather(sent, 2, MPI_DOUBLE, all.data(), 2, MPI_DOUBLE, discretization.communicator());
      StretchAt best{all[0], all[1]};
      for (unsigned int r = 1; r < size; ++r)
        if (sign * all[2 * r] < sign * best.value || (std::isnan(all[2 * r]) && !std::isnan(best.value)))
          best = {all[2 * r], all[2 * r + 1]};
      return best;
    }

    /// Where the stretch is looked at in a cell: its ends and the quadrature points, from left to right.
    std::vector<double>
    sampled_places(const ReferenceElement &element)
    {
      std::vector<double> places = {0.};
      places.insert(places.end(), element.points.begin(), element.points.end());
      places.push_back(1.);
      return places;
    }

    /// The sampler at these places, made once for each degree.
    const StretchSampler &
    stretch_sampler(const ReferenceElement &element)
    {
      static std::map<unsigned int, const StretchSampler> samplers;
      const auto known = samplers.find(element.degree);
      return known != samplers.end()
               ? known->second
               : samplers.try_emplace(element.degree, element, sampled_places(element)).first->second;
    }
  } // namespace

  Assembler::Assembler(const Scene &scene,
                       const Discretization &discretization,
                       const std::vector<double> &stress_points)
    : scene_(scene)
    , discretization_(discretization)
    , end_moduli_(scene.end_moduli())
    , stress_(scene.active_stress->at(stress_points))
    , end_stress_(scene.active_stress->at({0., scene.body.length}))
    , n_stress_points_(stress_points.size())
    , stresses_(1)
    , sampler_(stretch_sampler(discretization.element()))
  {
    // The stretch is a polynomial of degree q - 1 in a cell.
    const auto &element = discretization.element();
    for (unsigned int p = 0; p < element.n; ++p)
      highest_mode_.push_back((2. * element.degree - 1.) * element.weights[p] *
                              std::legendre(element.degree - 1, 2. * element.points[p] - 1.));
  }

  Assembler::~Assembler() = default;

  CellInput
  Assembler::input(const double t, const ConstVector u, const ConstVector v)
  {
    CellInput in = geometry();
    in.u         = discretization_.to_local<double>(u, u_local_).data();
    in.v         = v.data() == nullptr ? nullptr : discretization_.to_local<double>(v, v_local_).data();
    in.m         = stress_at(t).data();
    return in;
  }

  const std::vector<double> &
  Assembler::stress_at(const double t)
  {
    auto found = std::find_if(stresses_.begin(),
                              stresses_.end(),
                              [t](const StressAtTime &stress)
                              {
                                return stress.time == t;
                              });
    if (found == stresses_.end())
    {
      found          = stresses_.begin() + oldest_stress_;
      oldest_stress_ = (oldest_stress_ + 1) % stresses_.size();
      found->m.resize(n_stress_points_);
      stress_->values(t, found->m);
      found->time = t;
    }
    return found->m;
  }

  void
  Assembler::keep_stresses(const unsigned int n_times)
  {
    stresses_.resize(n_times);
    oldest_stress_ = 0;
  }

  void
  Assembler::forget_stresses()
  {
    for (StressAtTime &stress : stresses_)
      stress.time = std::numeric_limits<double>::quiet_NaN();
  }

  CellInput
  Assembler::geometry() const
  {
    return {discretization_.n_local_cells(),
            discretization_.cell_size().data(),
            &discretization_.element(),
            scene_.friction.get(),
            scene_.body.elastic_modulus,
            nullptr,
            nullptr,
            nullptr};
  }

  void
  Assembler::sum_over_ranks(CellIntegrals &sum) const
  {
    static_assert(sizeof(CellIntegrals) % sizeof(double) == 0);
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE,
                    &sum,
                    sizeof(CellIntegrals) / sizeof(double),
                    MPI_DOUBLE,
                    MPI_SUM,
                    discretization_.communicator());
  }

  StretchAt
  Assembler::smallest_of_ranks(const StretchAt own) const
  {
    return reduce_minimum(own, 1., discretization_);
  }

  StretchRange
  Assembler::stretch_range(const ConstVector y)
  {
    const auto local          = discretization_.to_local<double>(displacement(y), u_local_);
    const unsigned n          = discretization_.element().n;
    constexpr double infinity = std::numeric_limits<double>::infinity();

    const auto log_w = log_stretch(y);
    const auto place = [&](const unsigned int i)
    {
      return sampler_.places()[i];
    };
    const auto stretch_at = [&](const unsigned int c, const unsigned int i)
    {
      return sampler_.stretch(local, log_w, c, discretization_.cell_size()[c], i);
    };

    struct Found
    {
      double w;
      unsigned int cell, i;
    };
    Found smallest{infinity, 0, 0}, largest{-infinity, 0, 0};
    for (unsigned int c = 0; c < discretization_.n_local_cells(); ++c)
      for (unsigned int i = 0; i < n + 2; ++i)
      {
        const double w = stretch_at(c, i);
        if (w < smallest.w || (std::isnan(w) && !std::isnan(smallest.w)))
          smallest = {w, c, i};
        if (w > largest.w)
          largest = {w, c, i};
      }

    // Inside a cell the parabola through the neighbours comes closer to the extreme than the sample.
    const auto sharpened = [&](const Found &found)
    {
      double x = place(found.i), w = found.w;
      if (discretization_.n_local_cells() == 0)
        return StretchAt{w, 0.};
      if (found.i > 0 && found.i <= n && std::isfinite(w))
      {
        const auto [vertex_x, vertex_w] = parabola_vertex(place(found.i - 1),
                                                          stretch_at(found.cell, found.i - 1),
                                                          x,
                                                          w,
                                                          place(found.i + 1),
                                                          stretch_at(found.cell, found.i + 1));
        if (w <= 0. || vertex_w > 0.)
        {
          x = vertex_x;
          w = vertex_w;
        }
      }
      return StretchAt{w, discretization_.cell_left()[found.cell] + discretization_.cell_size()[found.cell] * x};
    };
    return {reduce_minimum(sharpened(smallest), 1., discretization_),
            reduce_minimum(sharpened(largest), -1., discretization_)};
  }

  Resolution
  Assembler::resolution(const ConstVector y)
  {
    const auto local    = discretization_.to_local<double>(displacement(y), u_local_);
    const auto log_w    = log_stretch(y);
    const auto &element = discretization_.element();
    double sums[2]      = {0., 0.};
    for (unsigned int c = 0; c < discretization_.n_local_cells(); ++c)
    {
      const double h = discretization_.cell_size()[c];
      double mode = 0., strain = 0., smallest = std::numeric_limits<double>::infinity();
      for (unsigned int p = 0; p < element.n; ++p)
      {
        const double e = sampler_.strain(local, log_w, c, h, p + 1);
        mode += highest_mode_[p] * e;
        strain += element.weights[p] * e * e;
        smallest = std::min(smallest, 1. + e);
      }
      sums[0] += h / (2. * element.degree - 1.) * (mode / smallest) * (mode / smallest);
      sums[1] += h * strain;
    }
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return {sums[0], sums[1]};
  }

  std::vector<double>
  Assembler::error_indicators(const double t, const ConstVector y, const ConstVector v)
  {
    const auto &element   = discretization_.element();
    const auto &to_points = friction_integration(); // [quadrature point][friction point]
    const unsigned int n = element.n, n_cells = discretization_.n_local_cells();
    const std::size_t n_points = static_cast<std::size_t>(n_cells) * n;
    const bool is_plain        = scene_.is_plain();
    if (!is_plain)
    {
      if (!quadrature_sampler_)
        quadrature_sampler_ = std::make_unique<GeneralSampler>(*this, element.points);
      quadrature_sampler_->sample(t, y, v);
    }
    // The position form has the active stress at these points already.
    else if (n_stress_points_ != n_points && !quadrature_stress_)
      quadrature_stress_ = scene_.active_stress->at(discretization_.points(element.points));
    if (!is_plain)
      m_at_quadrature_ = quadrature_sampler_->force().m;
    else if (quadrature_stress_)
    {
      m_at_quadrature_.resize(n_points);
      quadrature_stress_->values(t, m_at_quadrature_);
    }
    else
      m_at_quadrature_ = stress_at(t);
    friction(t, y, v, friction_at_);
    const std::vector<double> &weights = friction_weights();

    // N* at the left end of the own cells.
    double own = 0., balance = 0.;
    for (unsigned int c = 0; c < n_cells; ++c)
      for (unsigned int i = 0; i < n; ++i)
        own += discretization_.cell_size()[c] * weights[i] * friction_at_[c * n + i];
    if (discretization_.n_ranks() > 1)
    {
      MPI_Exscan(&own, &balance, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
      if (discretization_.rank() == 0)
        balance = 0.;
    }

    const auto local = discretization_.to_local<double>(displacement(y), u_local_);
    const auto log_w = log_stretch(y);
    std::vector<double> indicators(n_cells, 0.);
    for (unsigned int c = 0; c < n_cells; ++c)
    {
      const double h    = discretization_.cell_size()[c];
      const double *g_v = &friction_at_[c * n];
      for (unsigned int p = 0; p < n; ++p)
      {
        double N = balance;
        for (unsigned int i = 0; i < n; ++i)
          N += h * to_points[p * n + i] * g_v[i];
        const double e = sampler_.strain(local, log_w, c, h, p + 1);
        const double k = is_plain ? scene_.body.elastic_modulus : quadrature_sampler_->force().k[c * n + p];
        const double d = (N - equation::body_force(e, m_at_quadrature_[c * n + p], k)) / k;
        const double w = std::max(1. + e, smallest_scale);
        // An error of the stretch changes the friction by w g'/g times as much.
        double g = 0., w_dg = 0.;
        scene_.friction->values_and_log_derivatives({&w, 1}, {&g, 1}, {&w_dg, 1});
        const double relative = d / w * std::max(1., std::abs(w_dg / g));
        indicators[c] += h * element.weights[p] * relative * relative;
      }
      for (unsigned int i = 0; i < n; ++i)
        balance += h * weights[i] * g_v[i];
    }
    return indicators;
  }

  double
  Assembler::root_mean_square(const ConstVector y) const
  {
    double sum = 0.;
    for (const double value : displacement(y))
      sum += value * value;
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return std::sqrt(sum / static_cast<double>(discretization_.n_unknowns()));
  }

  std::pair<double, double>
  Assembler::end_stretches(const double t)
  {
    std::array<double, 2> m{};
    end_stress_->values(t, m);
    return {1. - m[0] / end_moduli_.first, 1. - m[1] / end_moduli_.second};
  }

  void
  Assembler::set_initial_state(const Vector y)
  {
    std::fill(y.begin(), y.end(), 0.);
    const auto &initial = scene_.profiles.initial_stretch;
    if (!initial)
      return;
    // u is the integral of w - 1, from node to node by a Gauss formula, minus its mean.
    const auto &element     = discretization_.element();
    const auto &formula     = reference_element(ReferenceElement::highest_degree);
    const unsigned int n    = element.n;
    const std::size_t first = static_cast<std::size_t>(discretization_.first_cell()) * element.degree +
                              (discretization_.has_left_neighbour() ? 1 : 0);
    std::vector<double> u(discretization_.n_unknowns(), 0.), places(formula.n), w(formula.n);
    double mean = 0.;
    for (std::size_t c = 0; c < discretization_.n_cells(); ++c)
    {
      const Cell &cell = discretization_.cells()[c];
      for (unsigned int i = 0; i < n; ++i)
      {
        double &here = u[c * element.degree + i];
        if (i > 0)
        {
          const double from = cell.left + cell.size * element.nodes[i - 1],
                       size = cell.size * (element.nodes[i] - element.nodes[i - 1]);
          for (unsigned int p = 0; p < formula.n; ++p)
            places[p] = from + size * formula.points[p];
          initial->values(places, w);
          here = u[c * element.degree + i - 1];
          for (unsigned int p = 0; p < formula.n; ++p)
            here += size * formula.weights[p] * (w[p] - 1.);
        }
        mean += cell.size * element.node_weights[i] * here;
      }
    }
    for (std::size_t i = 0; i < discretization_.n_owned(); ++i)
      y[i] = u[first + i] - mean / discretization_.length();
    if (formulation() == Formulation::position)
      return;
    const auto points = discretization_.points(element.stretch_points);
    const auto log_w  = y.subspan(discretization_.n_owned(), points.size());
    initial->values(points, log_w);
    for (double &value : log_w)
      value = std::log(value);
  }

  std::vector<double>
  Assembler::stretch_coefficients(const ConstVector y) const
  {
    const auto log_w = log_stretch(y);
    if (formulation() == Formulation::log_stretch)
      return {log_w.begin(), log_w.end()};
    const auto &element  = discretization_.element();
    const unsigned int q = element.degree;
    std::vector<double> buffer;
    const auto local = discretization_.to_local<double>(displacement(y), buffer);
    std::vector<double> strain(static_cast<std::size_t>(discretization_.n_local_cells()) * q, 0.);
    for (std::size_t c = 0; c < discretization_.n_local_cells(); ++c)
      for (unsigned int p = 0; p < q; ++p)
      {
        double &sum = strain[c * q + p];
        for (unsigned int i = 0; i < element.n; ++i)
          sum += element.stretch_derivatives[p * element.n + i] * local[c * q + i];
        sum /= discretization_.cell_size()[c];
      }
    return strain;
  }

  long
  Assembler::look_at_friction(const std::span<const double> w, const std::span<const double> g)
  {
    for (std::size_t i = 0; i < g.size(); ++i)
      if (!(g[i] > 0. && std::isfinite(g[i])))
      {
        describe_bad_law_ = [stretch = w[i], friction = g[i]](const Units &)
        {
          return BadLaw{fmt::format("the friction law is {} at the stretch w = {:.6g}, which the body has reached; a "
                                    "positive number is expected",
                                    friction > 0. || friction <= 0. ? "not positive" : "not a finite number",
                                    stretch),
                        "Ground/Friction law"};
        };
        return static_cast<long>(i);
      }
    return -1;
  }

  void
  Assembler::find_piece_ends(const unsigned int n_pieces)
  {
    const auto &left = discretization_.cell_left();
    const auto &size = discretization_.cell_size();
    const auto s     = [&](const unsigned int end)
    {
      return discretization_.length() * end / n_pieces;
    };
    piece_ends_       = {n_pieces, 0, {}, {}};
    unsigned int next = 0;
    while (next <= n_pieces && !left.empty() && s(next) < left.front())
      ++next;
    piece_ends_.first = next;
    for (unsigned int c = 0; c < left.size(); ++c)
    {
      const bool is_last = !discretization_.has_right_neighbour() && c + 1 == left.size();
      std::vector<double> places;
      for (; next <= n_pieces && (is_last || s(next) < left[c] + size[c]); ++next)
      {
        places.push_back(std::clamp((s(next) - left[c]) / size[c], 0., 1.));
        piece_ends_.cells.push_back(c);
      }
      const auto shape = interpolation_matrix(discretization_.element().nodes, places);
      piece_ends_.shape.insert(piece_ends_.shape.end(), shape.begin(), shape.end());
    }
  }

  std::vector<double>
  Assembler::displacement_at(const unsigned int n_pieces, const ConstVector y)
  {
    if (piece_ends_.n_pieces != n_pieces)
      find_piece_ends(n_pieces);
    const auto u         = discretization_.to_local<double>(displacement(y), u_local_);
    const unsigned int n = discretization_.element().n, q = discretization_.element().degree;
    std::vector<double> values(n_pieces + 1, 0.);
    for (std::size_t e = 0; e < piece_ends_.cells.size(); ++e)
      for (unsigned int i = 0; i < n; ++i)
        values[piece_ends_.first + e] +=
          piece_ends_.shape[e * n + i] * u[static_cast<std::size_t>(piece_ends_.cells[e]) * q + i];
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE,
                    values.data(),
                    static_cast<int>(values.size()),
                    MPI_DOUBLE,
                    MPI_SUM,
                    discretization_.communicator());
    return values;
  }

  double
  Assembler::end_power(const double t, const ConstVector y, const ConstVector v)
  {
    std::array<double, 2> m{};
    if (has_known_ends())
      end_stress_->values(t, m);
    else
    {
      if (!end_sampler_)
        end_sampler_ = GeneralSampler::at_ends(*this);
      end_sampler_->sample(t, y, v);
      const auto &own = end_sampler_->force().m;
      if (!own.empty()) // the left one is used by the first rank only, the right one by the last
        m = {{own.front(), own.back()}};
    }
    const double m_left = m[0], m_right = m[1];
    double power = 0.;
    if (discretization_.rank() == 0)
      power -= m_left * v.front();
    if (discretization_.n_local() > 0 && !discretization_.has_right_neighbour())
      power += m_right * v.back();
    if (discretization_.n_ranks() > 1)
      MPI_Allreduce(MPI_IN_PLACE, &power, 1, MPI_DOUBLE, MPI_SUM, discretization_.communicator());
    return power;
  }

  std::unique_ptr<Assembler>
  create_assembler(const Formulation formulation, const Scene &scene, const Discretization &discretization)
  {
    const bool in_position = formulation == Formulation::position;
    if (scene.is_plain())
    {
      if (in_position)
        return std::make_unique<PositionForm>(scene, discretization);
      return std::make_unique<LogStretchForm>(scene, discretization);
    }
    if (in_position)
      return std::make_unique<GeneralPositionForm>(scene, discretization);
    return std::make_unique<GeneralLogForm>(scene, discretization);
  }
} // namespace crawler
