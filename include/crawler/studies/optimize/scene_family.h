// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/variables.h>
#include <crawler/studies/optimize/gait_model.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// An entry that limits gaits, and its value if it is set.
  struct LimitEntry
  {
    std::string name;
    std::optional<double> value;
  };

  /// All of them, in the order in which results name them.
  std::vector<LimitEntry>
  limits_of(const OptimizeParameters &parameters);

  /// The scenes that the variables of an optimisation make (Optimize/Variables).
  class SceneFamily
  {
  public:
    /// @p form must outlive it. Throws InputError as read_variables() does, and for an objective without maximum: one
    /// that no limit holds.
    explicit SceneFamily(Form &form);
    SceneFamily(const SceneFamily &) = delete;
    /// Leaves the form as it was.
    ~SceneFamily();

    const std::vector<Variable> &
    variables() const
    {
      return variables_;
    }
    Form &
    form()
    {
      return form_;
    }

    /// Throws InputError.
    Parameters
    parameters(const std::vector<double> &x);

    /// The values where start @p number begins: those of the file for the first, others at random about them.
    std::vector<double>
    start(unsigned long number) const;

    /// By how much variable @p i changes a gait: about its value, here or at the start; between 0.01 and 1 of its
    /// range.
    double
    scale(const std::vector<double> &x, std::size_t i) const;

    /// Where variable @p i differs a little: x + @p places, all in its range; the weights of the values there make the
    /// derivative, of fourth order inside of the range. @p relative_step: in scales of the variable.
    struct Stencil
    {
      std::vector<double> places, weights;
    };
    Stencil
    stencil(const std::vector<double> &x, std::size_t i, double relative_step) const;

    /// Derivatives by differences of what @p values gives of the parameters: [place][variable]. Throws InputError.
    std::vector<double>
    differences(const std::vector<double> &x,
                const std::function<std::vector<double>(const Parameters &)> &values,
                double relative_step);

    /// The active stress (@p rate: its rate) on a grid over body and duration, where it is limited.
    LimitedValues
    stress(const std::vector<double> &x, bool rate, bool with_gradients);

    /// The largest size of it, between the points of that grid, too.
    double
    largest_stress(const std::vector<double> &x, bool rate);

  private:
    Form &form_;
    const std::vector<Variable> variables_;
  };
} // namespace crawler
