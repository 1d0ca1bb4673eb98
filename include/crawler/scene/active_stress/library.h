// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/body.h>
#include <crawler/scene/known_stress.h>

#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Library".
  struct LibraryParameters
  {
    std::string file       = "libmy_stress.so";
    std::string parameters = "";

    void
    add_parameters(Declarations &declarations);
  };

  /// Failures, and the name of the plug-in that caused them.
  struct LibraryFailures : StressFailures
  {
    std::string plugin;
  };

  /**
   * An active stress from a shared object compiled by the user (stress_plugin.h). Exceptions and values that are not
   * finite are caught and kept as failures; the values are NaN there, which ends a run in order on all ranks.
   */
  class Library : public KnownStress
  {
  public:
    /**
     * Throws InputError if there is no such file, if it is not a shared object for this machine or not a plug-in of
     * this version, if it does not know one of the parameters, or, with its message, if it throws.
     */
    Library(const LibraryParameters &parameters, const Body &body, double end_time);

    const StretchFeedback *
    feedback() const override
    {
      return feedback_.get();
    }
    const ActiveStress *
    prescribed_strain() const override
    {
      return strain_.get();
    }
    void
    report(std::ostream &out) const override;
    const StressFailures *
    failures() const override
    {
      return failures_.get();
    }

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    void
    ask(double length, double end_time);

    std::string file_;
    std::shared_ptr<LibraryFailures> failures_; ///< evaluators write here
    std::unique_ptr<const ActiveStress> stress_;
    // Answers of the plug-in to calls that are made once.
    std::unique_ptr<const StretchFeedback> feedback_;
    std::unique_ptr<const ActiveStress> strain_;
    std::string report_;
  };
} // namespace crawler
