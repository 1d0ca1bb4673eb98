// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/tradeoff/tradeoff_settings.h>

#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /// A displacement that one method gave with ever finer meshes and steps.
  struct RefinedDisplacement
  {
    std::string method;                          ///< with the last mesh and tolerance, in words; empty: there is none
    double displacement = TradeoffSetting::none; ///< [length]
    double change       = TradeoffSetting::none; ///< by the last refinement [length]
  };

  /// What the errors of a tradeoff are measured against, and which meshes it tries.
  struct TradeoffReference
  {
    RefinedDisplacement first, second;   ///< first is the reference
    double bar  = TradeoffSetting::none; ///< errors below this cannot be told from 0 [length]
    double size = TradeoffSetting::none; ///< errors are relative to this [length]
    MeshErrors meshes;                   ///< for each degree of the lists
    // Without a reference: status (failed, inverted, stopped) and why, of the last method that was tried.
    std::string status = "finished", message;

    double
    displacement() const
    {
      return first.displacement;
    }
    bool
    is_checked() const
    {
      return !second.method.empty();
    }
    double
    relative_bar() const
    {
      return bar / size;
    }
  };

  /**
   * Refines the displacement by one method after another until two have settled: position form of degree 8 by radau 9;
   * position of degree 7 by radau 5 on PETSc; then others, for
   * scenes that these cannot do (bodies that collapse). Cells are doubled and tolerances divided by 100 until the
   * displacement changes by less than 1e-12, or as long as it helps and a run takes no longer than the limit. The bar
   * is the distance of the two, plus the last change of the reference, plus 1e-14 for round-off. Errors are relative to
   * |displacement|, or to 1e-4 of the largest root mean square of the body's own displacements if that is more (as
   * Accuracy is). Then the error of uniform meshes is measured (position form if it works, radau 9).
   */
  TradeoffReference
  make_reference(const Parameters &parameters,
                 const Scene &scene,
                 const TradeoffLists &lists,
                 const std::function<bool()> &interrupted,
                 const std::function<void(const std::string &)> &report);

  /// Up to five of the meshes (cells, error), evenly spaced from the first whose error is at most 3 % to the first
  /// whose error is at most @p wanted; the last one if none is that good.
  std::vector<std::pair<unsigned int, double>>
  useful_meshes(const std::vector<std::pair<unsigned int, double>> &meshes, double wanted);

  /// As a text (JSON), and back.
  std::string
  pack(const TradeoffReference &reference);
  TradeoffReference
  unpack_reference(const std::string &text);
} // namespace crawler
