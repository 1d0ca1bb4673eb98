// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/csv_numbers.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/smoothing_spline.h>
#include <crawler/studies/table/marker_strain.h>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace crawler
{
  namespace
  {
    constexpr unsigned int usual_n_s = 33;

    /// The material coordinates: a list, or from the places in the first frame or on average.
    std::vector<double>
    material_coordinates(const Samples &tracks, const PreparationSettings &settings)
    {
      const std::size_t n = tracks.s.size();
      std::vector<double> s;
      if (settings.material == "first")
        s = tracks.over_body(0);
      else if (settings.material == "mean")
      {
        s.assign(n, 0.);
        for (std::size_t j = 0; j < tracks.t.size(); ++j)
          for (std::size_t i = 0; i < n; ++i)
            s[i] += tracks.at(j, i) / static_cast<double>(tracks.t.size());
      }
      else
      {
        std::istringstream in(settings.material);
        for (std::string part; std::getline(in, part, ',');)
          if (const auto number = number_in(part))
            s.push_back(*number);
          else
            throw InputError(
              fmt::format("\"--markers-at\" has \"{}\", but \"first\", \"mean\" or a list of {} numbers is "
                          "expected",
                          part,
                          n));
        if (s.size() != n)
          throw InputError(fmt::format(
            "\"--markers-at\" has {} numbers, but there are {} markers, and one for each is expected", s.size(), n));
        return s;
      }
      const double first = s.front();
      for (double &place : s)
        place += settings.first_marker - first;
      return s;
    }

    /// The tracks with the tail first.
    Samples
    from_tail_to_head(Samples tracks, const PreparationSettings &settings)
    {
      if (settings.material != "first" && settings.material != "mean")
        return tracks;
      const std::size_t n = tracks.s.size();
      if (tracks.at(0, 0) > tracks.at(0, n - 1))
        for (std::size_t j = 0; j < tracks.t.size(); ++j)
          std::reverse(tracks.values.begin() + static_cast<std::ptrdiff_t>(j * n),
                       tracks.values.begin() + static_cast<std::ptrdiff_t>((j + 1) * n));
      return tracks;
    }
  } // namespace

  Samples
  strain_of_tracks(const Samples &measured, const PreparationSettings &settings, std::vector<std::string> &words)
  {
    const Samples tracks = from_tail_to_head(measured, settings);
    if (tracks.at(0, 0) != measured.at(0, 0))
      words.push_back(
        "the last marker lies at the smallest x, so it is the first from the tail: the order is turned round");
    const std::vector<double> s = material_coordinates(tracks, settings);
    const std::size_t n         = s.size();
    for (std::size_t i = 1; i < n; ++i)
      if (!(s[i] > s[i - 1]))
        throw InputError(
          fmt::format("the marker {} lies at s = {:g} and the next one at s = {:g}, but markers that follow "
                      "each other along the body are expected",
                      i,
                      s[i - 1],
                      s[i]));
    const double length = settings.length.value_or(s.back());
    if (s.front() < 0. || s.front() >= length || s.back() > length * (1. + 1e-9))
      throw InputError(fmt::format("the markers lie from s = {:g} to {:g}, but the body from 0 to {:g}; see "
                                   "\"--first-marker\" and \"--length\"",
                                   s.front(),
                                   s.back(),
                                   length));
    Samples strain;
    strain.quantity          = MeasuredQuantity::strain;
    strain.t                 = tracks.t;
    const unsigned int n_out = settings.n_s == 0 ? usual_n_s : settings.n_s;
    for (unsigned int i = 0; i < n_out; ++i)
      strain.s.push_back(i + 1 == n_out ? length : length * i / (n_out - 1));
    const SmoothingSpline spline(s, settings.width_s);
    for (std::size_t j = 0; j < tracks.t.size(); ++j)
    {
      std::vector<double> u = tracks.over_body(j);
      for (std::size_t i = 0; i < n; ++i)
        u[i] -= s[i];
      const SplineCurve curve = spline.curve(u);
      for (const double place : strain.s)
      {
        const double inside = std::clamp(place, s.front(), s.back());
        const double slope  = place == inside || settings.ends == "hold" ? 0.
                              : place < inside                           ? curve.curvatures().front()
                                                                         : curve.curvatures().back();
        strain.values.push_back(curve.derivative(inside) + slope * (place - inside));
        if (!(strain.values.back() > -1.))
          throw InputError(
            fmt::format("the tracks give the strain {:g} at s = {:g}, t = {:g}, where the body would have no "
                        "length; more smoothing (\"--smooth-s\") is needed, or markers are mixed up",
                        strain.values.back(),
                        place,
                        tracks.t[j]));
      }
    }
    words.push_back(fmt::format("strain of {} markers at s = {:g} to {:g} ({}), at {} places of a body of length {:g}",
                                n,
                                s.front(),
                                s.back(),
                                settings.material == "first"  ? "from the first frame"
                                : settings.material == "mean" ? "from the mean of all frames"
                                                              : "as given",
                                n_out,
                                length));
    if (s.front() > 0. || s.back() < length * (1. - 1e-9))
      words.push_back(
        fmt::format("beyond the outermost markers, over {:g} at the tail and {:g} at the head, the strain {}",
                    s.front(),
                    std::max(0., length - s.back()),
                    settings.ends == "hold" ? "is held" : "goes on linearly"));
    return strain;
  }
} // namespace crawler
