// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/field_sampler.h>
#include <crawler/output/observer.h>
#include <crawler/output/usual_size.h>
#include <crawler/scene/profile.h>

#include <filesystem>
#include <memory>
#include <vector>

namespace crawler
{
  /// Collects the fields over s and t, at points of the body.
  class Kymograph : public Observer
  {
  public:
    static constexpr unsigned int n_points = 201; ///< of the default points, both ends included

    /// The default points, as fractions of the length from 0 to 1.
    static std::vector<double>
    equidistant();

    /// Takes @p points as increasing fractions of the length.
    explicit Kymograph(std::vector<double> points = equidistant());

    const std::vector<double> points; ///< as fractions of the length

    void
    observe(const Snapshot &snapshot) override;
    void
    show(const StateWithoutMesh &state) override
    {
      if (state.pictures.is_row)
        add(state.step.time, state.frame.fields);
    }
    void
    exchange(Archive &archive) override;

    const std::vector<double> &
    times() const
    {
      return times_;
    }
    /// Values [time][point] of those fields of field_names that are in_kymograph, on rank 0.
    const Fields &
    rows() const
    {
      return rows_;
    }
    /// Range shown in pictures of a field that is in_kymograph: all, or its usual size if it has peaks. On rank 0.
    FieldRange
    shown(const FieldName &field) const;

  private:
    /// Adds a time with @p fields at all points.
    void
    add(double time, const Fields &fields);

    FieldSampler sampler_;
    std::vector<double> times_;
    Fields rows_;
  };

  /// Writes the kymograph as one structured grid (kymograph.vts: x is s/L, y is t/T) when the run ends, with the range
  /// shown of each field ("shown_stretch": two numbers) and the ground below the body's path.
  class KymographWriter : public Kymograph
  {
  public:
    /// Takes the length L [length]; @p ground may be null.
    KymographWriter(double length,
                    double end_time,
                    std::shared_ptr<const Profile> ground,
                    const std::filesystem::path &folder);

    void
    end() override;

  private:
    /// Arrays of places on the ground and of its factor there; empty for a uniform ground.
    std::string
    ground_arrays() const;

    const double length_, end_time_;
    const std::shared_ptr<const Profile> ground_;
    const std::filesystem::path folder_;
  };
} // namespace crawler
