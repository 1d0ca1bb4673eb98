// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/assembler.h>

#include <fmt/format.h>

#include <cmath>

namespace crawler
{
  Assembler::Assembler(const Scene &scene, const Discretization &discretization)
    : scene(scene)
    , discretization(discretization)
    , ends(scene)
  {
  }

  double
  Assembler::root_mean_square(const ConstVector y) const
  {
    std::vector<double> buffer;
    const auto local                = discretization.to_local(displacement(y), buffer);
    const ReferenceElement &element = discretization.element;
    double sum                      = 0.;
    for (unsigned int c = 0; c < discretization.n_local_cells(); ++c)
      for (unsigned int i = 0; i < element.n; ++i)
        sum += discretization.cell_size[c] * element.node_weights[i] * std::pow(local[c * element.degree + i], 2);
    discretization.sum_over_ranks({&sum, 1});
    return std::sqrt(sum / discretization.length);
  }

  long
  Assembler::look_at_friction(const std::span<const double> w, const std::span<const double> g)
  {
    for (std::size_t i = 0; i < g.size(); ++i)
      if (!(g[i] > 0. && std::isfinite(g[i])))
      {
        describe_bad_law_ = [stretch = w[i], friction = g[i]](const Units &) {
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
    std::vector<double> ends;
    for (unsigned int i = 0; i <= n_pieces; ++i)
      ends.push_back(discretization.length * i / n_pieces);
    piece_ends_       = {n_pieces, 0, discretization.own_places(ends), {}};
    piece_ends_.shape = interpolation_matrix(discretization.element.nodes, in_cells(piece_ends_.places));
    const auto &left  = discretization.cell_left;
    while (piece_ends_.first <= n_pieces && !left.empty() && ends[piece_ends_.first] < left.front())
      ++piece_ends_.first;
  }

  std::vector<double>
  Assembler::displacement_at(const unsigned int n_pieces, const ConstVector y)
  {
    if (piece_ends_.n_pieces != n_pieces)
      find_piece_ends(n_pieces);
    const auto u         = discretization.to_local(displacement(y), u_local_);
    const unsigned int n = discretization.element.n, q = discretization.element.degree;
    std::vector<double> values(n_pieces + 1, 0.);
    for (std::size_t e = 0; e < piece_ends_.places.size(); ++e)
      for (unsigned int i = 0; i < n; ++i)
        values[piece_ends_.first + e] +=
          piece_ends_.shape[e * n + i] * u[static_cast<std::size_t>(piece_ends_.places[e].cell) * q + i];
    discretization.sum_over_ranks(values);
    return values;
  }
} // namespace crawler
