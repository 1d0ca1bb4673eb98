// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/active_stress/wave_entries.h>
#include <crawler/scene/known_stress.h>

#include <string>

namespace crawler
{
  /// Section "Active stress/Segments".
  struct SegmentsParameters
  {
    unsigned int number              = 8;     ///< N
    std::vector<double> amplitude    = {0.3}; ///< [force], one for all segments or one per segment
    double frequency                 = 1.;    ///< f [1/time]
    double phase_lag                 = 0.125; ///< [1], a fraction of the period
    std::string direction            = "from head to tail";
    double duty_cycle                = 0.5; ///< D [1]
    std::string switching            = "square";
    double front_width               = 0.1; ///< [1], a fraction of the period
    double phase                     = 0.;  ///< [1], a fraction of the period
    double gap                       = 0.;  ///< [1], a fraction of the length of a segment
    std::optional<double> saturation = {};  ///< [force]; unset: no limit
    std::optional<double> rate_limit = {};  ///< r [force/time]; unset: no limit
    double ramp_duration             = 0.;  ///< [time]

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * A robot of N actuated segments, each of which switches a uniform active stress on and off:
   *
   *   m(s,t) = ramp(t) y_i( f t + phase - n_i lag )  in segment i,  0 in the gaps between segments,
   *
   * where n_i counts the segments before it in the running direction, and y_i has the period 1, mean A_i D, and is
   *  - square: A_i for the fraction D of the period, then 0, where A_i is cut to the saturation. With a rate limit it
   *    is the periodic response of an actuator that follows the square signal at the rate r: a trapezoid;
   *  - smooth: A_i times a Switching with smooth fronts (wave_entries.h), cut to the saturation.
   */
  class Segments : public KnownStress
  {
  public:
    /// Throws InputError if there are neither one nor N amplitudes, if smooth fronts do not fit into the period or are
    /// faster than the rate limit, or if there are more switchings until the end time than a run can have.
    Segments(const SegmentsParameters &parameters, double length, double end_time);

    std::optional<Bounds>
    bounds(const Box &box) const override;

    /// Centres of the segments from s = 0 to s = L [length].
    std::vector<double>
    middles() const;

    /// Switching of a segment (0 is that at s = 0), on or off.
    struct SwitchingTime
    {
      double time;
      unsigned int segment;
      bool on;
    };
    /// Switching times for a controller until the end time, in order: at t = 0 segments begin that are on. With smooth
    /// fronts these are the middles of the fronts.
    std::vector<SwitchingTime>
    switching_times(double end_time) const;

    /// Reports lengths, and the amplitudes that a rate limit lets the segments reach.
    void
    report(std::ostream &out) const override;

  private:
    /// A segment from `first` to `last` [length]. Its phase at t = 0 is `phase`. If not smooth, y goes from `low` to
    /// `high` [force] and back by fronts of the width `front` [period], which begin at 0 and at D.
    struct Segment
    {
      double first, last, phase, amplitude;
      double low, high, front;
    };

    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    /// The segments from s = 0 to s = L.
    std::vector<Segment>
    create_segments() const;

    std::vector<double>
    times_of_switching(double end_time) const;

    /// Value of y_i(x), or its derivative [force/period].
    double
    signal(const Segment &segment, double x, bool rate) const;

    /// Places of a period at which y_i or its derivative jumps.
    std::vector<double>
    breaks(const Segment &segment) const;

    const SegmentsParameters parameters_;
    const double length_;
    const Ramp ramp_;
    std::optional<Switching> smooth_;
    std::vector<Segment> segments_; ///< from s = 0 to s = L
  };
} // namespace crawler
