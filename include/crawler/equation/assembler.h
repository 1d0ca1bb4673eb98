// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/cell_kernels.h>
#include <crawler/equation/general_laws.h>
#include <crawler/equation/stretch_sampler.h>
#include <crawler/mesh/discretization.h>
#include <crawler/scene/scene.h>

#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace crawler
{

  /// A stretch and where it was seen.
  struct StretchAt
  {
    double value; ///< [1]
    double s;     ///< [length]
  };

  /// The smallest and the largest stretch of a state: looked for at the quadrature points and the ends of all cells,
  /// and sharpened by a parabola inside a cell.
  struct StretchRange
  {
    StretchAt min, max;
  };

  /// In which unknowns the equation is solved.
  enum class Formulation
  {
    position, ///< the displacement u = zeta - s
    stretch   ///< the stretch w in each cell: for layers, and for bodies that collapse
  };

  /**
   * The semi-discrete crawler in one of its formulations, as far as it looks at states: what the unknowns y of a rank
   * mean. Vectors are the owned values of each rank; all functions are collective.
   */
  class Assembler
  {
  public:
    using Vector      = std::span<double>;
    using ConstVector = std::span<const double>;

    virtual ~Assembler();
    Assembler(const Assembler &) = delete;

    /// Number of unknowns of this rank, and of all ranks.
    virtual std::size_t
    n_owned() const = 0;
    virtual std::size_t
    n_unknowns() const = 0;

    /// The active stress is another one from now on, at the same times, too.
    virtual void
    forget_stresses()
    {
    }

    /// v = u' at the nodes [length/time], from the balance of forces. Returns false if it cannot be computed.
    virtual bool
    velocity(double t, ConstVector y, Vector v) = 0;

    /// The integrals over the whole body, the same on all ranks. @p v is the velocity at the nodes.
    virtual CellIntegrals
    integrals(double t, ConstVector y, ConstVector v) = 0;

    /// The displacements at the owned nodes. What is returned is good until the next call.
    virtual ConstVector
    displacement(ConstVector y) const = 0;

    /// The stretches of the cells; empty in the position form, where they follow from the displacement. What is
    /// returned is good until the next call.
    virtual ConstVector
    stretch(ConstVector) const
    {
      return {};
    }

    /// How the stretch may be drawn within the cells: its slopes there, times the size of the cell; and the friction at
    /// the nodes [force/length], which balances the forces where cells are empty and their own laws have no value. Both
    /// empty in the position form.
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

    /// The extreme stretches of the whole body, the same on all ranks. A stretch that is not a number counts as the
    /// smallest.
    virtual StretchRange
    stretch_range(ConstVector y) = 0;

    /// The displacement at the ends of @p n_pieces equal pieces of the body, the same on all ranks [length].
    std::vector<double>
    displacement_at(unsigned int n_pieces, ConstVector y);

    /// The square root of the mean of u^2 over the body, the same on all ranks [length].
    double
    root_mean_square(ConstVector y) const;

    /// The stretches that the end conditions prescribe, 1 - m/k at s = 0 and s = L. A body with feedback makes its own:
    /// then they are not known, and has_known_ends() is false.
    std::pair<double, double>
    end_stretches(double t);
    bool
    has_known_ends() const
    {
      return scene_.active_stress->feedback() == nullptr;
    }

    /// The unknowns of the body at t = 0: with its initial stretch, its centre of mass where it is without.
    virtual void
    set_initial_state(Vector y) = 0;

    /// The strain at the stretch points of this rank's cells [cell][q].
    std::vector<double>
    stretch_coefficients(ConstVector y) const;

    /// Where a feedback with delay finds the past; none: the body was at its initial stretch before. Must outlive this.
    void
    set_history(const StretchHistory *history)
    {
      history_ = history;
    }
    const StretchHistory *
    history() const
    {
      return history_;
    }

    /// The first law that was not positive, of the last state that was refused because of one (on each rank its own).
    /// @p units are those of the user.
    std::optional<BadLaw>
    bad_law(const Units &units) const
    {
      return describe_bad_law_ ? std::optional(describe_bad_law_(units)) : std::nullopt;
    }

    /// Looks whether the friction @p g at the stretches @p w is positive and finite; the number of the first point
    /// where it is not, or -1. Then bad_law() tells.
    long
    look_at_friction(std::span<const double> w, std::span<const double> g);

    const Discretization &
    discretization() const
    {
      return discretization_;
    }
    const Scene &
    scene() const
    {
      return scene_;
    }

  protected:
    Assembler(const Scene &scene, const Discretization &discretization);

    /// Adds up over all ranks.
    void
    sum_over_ranks(CellIntegrals &sum) const;

    const Scene &scene_;
    const Discretization &discretization_;
    std::function<BadLaw(const Units &)> describe_bad_law_;
    const StretchHistory *history_ = nullptr;

  private:
    const std::pair<double, double> end_moduli_;
    const std::unique_ptr<ActiveStressAtPoints> end_stress_;
    std::vector<double> u_local_;
    /// Ends of equal pieces of the body in own cells, and the shape functions there.
    struct PieceEnds
    {
      unsigned int n_pieces = 0, first = 0;
      std::vector<unsigned int> cells;
      std::vector<double> shape; ///< [end][n nodes]
    };
    PieceEnds piece_ends_;
    void
    find_piece_ends(unsigned int n_pieces);
  };
} // namespace crawler
