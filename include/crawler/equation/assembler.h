// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/words.h>
#include <crawler/equation/cell_kernels.h>
#include <crawler/equation/general_laws.h>
#include <crawler/mesh/discretization.h>
#include <crawler/scene/scene.h>

#include <functional>
#include <optional>

namespace crawler
{

  /// Stretch and its place.
  struct StretchAt
  {
    double value; ///< [1]
    double s;     ///< [length]
  };

  /// Smallest and largest stretch of a state: searched at the quadrature points and the ends of all cells, and refined
  /// by a parabola inside a cell.
  struct StretchRange
  {
    StretchAt min, max;
  };

  /// Unknowns in which the equation is solved.
  enum class Formulation
  {
    position, ///< the displacement u = zeta - s
    stretch   ///< the stretch w in each cell: for layers, and for bodies that collapse
  };
  template <>
  inline constexpr const char *words_of<Formulation>[] = {"position", "stretch"};

  /**
   * Semi-discrete crawler in one of its formulations: the part that evaluates states, i.e. the meaning of the unknowns
   * y of a rank, as many as nodes of the mesh. Vectors are the owned values of each rank; all functions are collective.
   */
  class Assembler
  {
  public:
    using Vector      = std::span<double>;
    using ConstVector = std::span<const double>;

    virtual ~Assembler()         = default;
    Assembler(const Assembler &) = delete;

    /// Forgets kept values: the active stress is another one from now on, at the same times, too.
    virtual void
    forget_stresses()
    {
    }

    /// Velocity v = u' at the nodes [length/time], from the balance of forces. Returns false if it cannot be computed.
    virtual bool
    velocity(double t, ConstVector y, Vector v) = 0;

    /// Integrals over the whole body, the same on all ranks. @p v is the velocity at the nodes.
    virtual CellIntegrals
    integrals(double t, ConstVector y, ConstVector v) = 0;

    /// Displacements at the owned nodes; valid until the next call.
    virtual ConstVector
    displacement(ConstVector y) const = 0;

    /// Stretches of the cells, valid until the next call; empty in the position form, which computes
    /// them from the displacement.
    virtual ConstVector
    stretch(ConstVector) const
    {
      return {};
    }

    /// Slopes of the stretch within the cells, for drawing, times the cell size; and the friction at the nodes
    /// [force/length], which balances the forces where cells are empty and their own laws have no value. Both are empty
    /// in the position form.
    virtual std::vector<double>
    stretch_slopes(ConstVector) const
    {
      return {};
    }
    virtual std::vector<double>
    node_friction(double, ConstVector, ConstVector) const
    {
      return {};
    }

    /// Extreme stretches of the whole body, the same on all ranks. A stretch that is not a number counts as the
    /// smallest.
    virtual StretchRange
    stretch_range(ConstVector y) = 0;

    /// Displacement at the ends of @p n_pieces equal pieces of the body, the same on all ranks [length].
    std::vector<double>
    displacement_at(unsigned int n_pieces, ConstVector y);

    /// Root mean square of u over the body, the same on all ranks [length].
    double
    root_mean_square(ConstVector y) const;

    /// Sets the unknowns of the body at t = 0: its initial stretch, with the centre of mass where it is without one.
    virtual void
    set_initial_state(Vector y) = 0;

    const Scene &scene;
    const Discretization &discretization;
    EndStretches ends;
    /// History for a feedback with delay; none: the body was at its initial stretch before.
    const StretchHistory *history = nullptr;

    /// First law that was not positive, of the last state that was refused for that reason (on each rank its own). @p
    /// units are those of the user.
    std::optional<BadLaw>
    bad_law(const Units &units) const
    {
      return describe_bad_law_ ? std::optional(describe_bad_law_(units)) : std::nullopt;
    }

    /// Checks that the friction @p g at the stretches @p w is positive and finite; returns the number of the first
    /// point where it is not, or -1. bad_law() then describes it.
    long
    look_at_friction(std::span<const double> w, std::span<const double> g);

  protected:
    Assembler(const Scene &scene, const Discretization &discretization);

    std::function<BadLaw(const Units &)> describe_bad_law_;

  private:
    std::vector<double> u_local_;
    /// Ends of equal pieces of the body in own cells, and the shape functions there.
    struct PieceEnds
    {
      unsigned int n_pieces = 0, first = 0;
      std::vector<CellPlace> places;
      std::vector<double> shape; ///< [end][n nodes]
    };
    PieceEnds piece_ends_;
    void
    find_piece_ends(unsigned int n_pieces);
  };
} // namespace crawler
