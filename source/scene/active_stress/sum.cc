// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/sum.h>
#include <crawler/scene/period.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ostream>
#include <sstream>

namespace crawler
{
  namespace
  {
    /// The points where the window of a term is open.
    struct OpenPoints
    {
      OpenPoints(const SumTerm &term, const std::vector<double> &points)
      {
        for (std::size_t i = 0; i < points.size(); ++i)
          if (const double W = term.in_s.value(points[i]); W != 0.)
          {
            index.push_back(i);
            place.push_back(points[i]);
            factor.push_back(term.factor * W);
          }
      }

      std::vector<std::size_t> index; ///< among all points
      std::vector<double> place;      ///< [length]
      std::vector<double> factor;     ///< the term's factor times W(s)
    };

    /// Sum and product of terms, and their derivatives in some directions, point by point.
    class Combination
    {
    public:
      Combination(const std::size_t n_points, const std::size_t n_derivatives)
        : sum_(n_points)
        , product_(n_points)
        , f(n_points)
        , sum_d_(n_derivatives, sum_)
        , product_d_(n_derivatives, sum_)
        , f_d(n_derivatives, sum_)
      {
      }

      void
      start()
      {
        std::fill(sum_.begin(), sum_.end(), 0.);
        std::fill(product_.begin(), product_.end(), 1.);
        for (auto *all : {&sum_d_, &product_d_})
          for (auto &d : *all)
            std::fill(d.begin(), d.end(), 0.);
      }

      /// Clears f and f_d for the next term.
      void
      clear_term()
      {
        std::fill(f.begin(), f.end(), 0.);
        for (auto &d : f_d)
          std::fill(d.begin(), d.end(), 0.);
      }

      void
      combine(const bool multiplies)
      {
        for (std::size_t d = 0; d < f_d.size(); ++d)
          for (std::size_t i = 0; i < f.size(); ++i)
            if (multiplies)
              product_d_[d][i] = product_d_[d][i] * f[i] + product_[i] * f_d[d][i];
            else
              sum_d_[d][i] += f_d[d][i];
        for (std::size_t i = 0; i < f.size(); ++i)
          if (multiplies)
            product_[i] *= f[i];
          else
            sum_[i] += f[i];
      }

      void
      values(const std::span<double> m) const
      {
        for (std::size_t i = 0; i < m.size(); ++i)
          m[i] = sum_[i] * product_[i];
      }

      void
      derivatives(const std::size_t d, const std::span<double> m_d) const
      {
        for (std::size_t i = 0; i < m_d.size(); ++i)
          m_d[i] = sum_d_[d][i] * product_[i] + sum_[i] * product_d_[d][i];
      }

    private:
      std::vector<double> sum_, product_;

    public:
      std::vector<double> f; ///< of one term

    private:
      std::vector<std::vector<double>> sum_d_, product_d_;

    public:
      std::vector<std::vector<double>> f_d; ///< [direction][point]
    };

    /// Evaluates values, or rates.
    class SumAtPoints : public ActiveStressAtPoints
    {
    public:
      SumAtPoints(const std::vector<SumTerm> &terms, const std::vector<double> &points, const bool wants_rate)
        : wants_rate_(wants_rate)
        , all_(points.size(), wants_rate ? 1 : 0)
      {
        for (const SumTerm &term : terms)
        {
          Part part{&term, OpenPoints(term, points), {}, {}, {}, {}};
          if (!part.open.index.empty())
          {
            part.stress = term.stress->at(part.open.place);
            part.g.resize(part.open.index.size());
            if (wants_rate)
              part.rate = term.stress->rate_at(part.open.place);
            part.g_t.resize(part.g.size());
          }
          parts_.push_back(std::move(part));
        }
      }

      void
      values(const double t, const std::span<double> m) override
      {
        all_.start();
        for (Part &part : parts_)
        {
          all_.clear_term();
          const double V = part.term->in_t.value(t), V_t = wants_rate_ ? part.term->in_t.rate(t) : 0.;
          if (part.stress && (V != 0. || V_t != 0.))
            write(part, t, V, V_t);
          all_.combine(part.term->multiplies);
        }
        if (wants_rate_)
          all_.derivatives(0, m);
        else
          all_.values(m);
      }

    private:
      struct Part
      {
        const SumTerm *term;
        OpenPoints open;
        std::unique_ptr<ActiveStressAtPoints> stress, rate;
        std::vector<double> g, g_t;
      };

      /// Writes f = F W V g, or f_t = F W ( V_t g + V g_t ).
      void
      write(Part &part, const double t, const double V, const double V_t)
      {
        const OpenPoints &open = part.open;
        part.stress->values(t, part.g);
        for (std::size_t i = 0; i < open.index.size(); ++i)
          all_.f[open.index[i]] = open.factor[i] * V * part.g[i];
        if (!wants_rate_)
          return;
        part.rate->values(t, part.g_t);
        for (std::size_t i = 0; i < open.index.size(); ++i)
          all_.f_d[0][open.index[i]] = open.factor[i] * (V_t * part.g[i] + V * part.g_t[i]);
      }

      const bool wants_rate_;
      Combination all_;
      std::vector<Part> parts_;
    };

    class SumFeedbackAtPoints : public FeedbackAtPoints
    {
    public:
      SumFeedbackAtPoints(const std::vector<SumTerm> &terms, const std::vector<double> &points)
        : all_(points.size(), n_directions)
      {
        for (const SumTerm &term : terms)
        {
          Part part{&term, OpenPoints(term, points), {}, {}, {}, {}, {}};
          const std::size_t n = part.open.index.size();
          if (n > 0)
          {
            if (const StretchFeedback *feedback = term.stress->feedback())
              part.feedback = feedback->at(part.open.place);
            else
              part.stress = term.stress->at(part.open.place);
            part.g.resize(n);
            for (auto &d : part.g_d)
              d.resize(n);
          }
          parts_.push_back(std::move(part));
        }
      }

      void
      values(const double t, const StretchSeen &seen, const FeedbackStress &m) override
      {
        const std::array<std::span<double>, n_directions> wanted = {{m.m_w, m.m_rate, m.m_near}};
        all_.start();
        for (Part &part : parts_)
        {
          all_.clear_term();
          const double V = part.term->in_t.value(t);
          if (!part.open.index.empty() && V != 0.)
            write(part, t, V, seen, wanted);
          all_.combine(part.term->multiplies);
        }
        all_.values(m.m);
        for (std::size_t d = 0; d < n_directions; ++d)
          all_.derivatives(d, wanted[d]);
      }

    private:
      static constexpr std::size_t n_directions = 3, n_seen = 4; ///< w, w_t, w near; also w delayed

      struct Part
      {
        const SumTerm *term;
        OpenPoints open;
        std::unique_ptr<ActiveStressAtPoints> stress; ///< or
        std::unique_ptr<FeedbackAtPoints> feedback;
        std::array<std::vector<double>, n_seen> seen;
        std::vector<double> g;
        std::array<std::vector<double>, n_directions> g_d;
      };

      void
      write(Part &part,
            const double t,
            const double V,
            const StretchSeen &seen,
            const std::array<std::span<double>, n_directions> &wanted)
      {
        const OpenPoints &open = part.open;
        const std::size_t n    = open.index.size();
        if (part.stress)
          part.stress->values(t, part.g);
        else
        {
          const std::array<std::span<const double>, n_seen> all = {{seen.stretch, seen.rate, seen.near, seen.delayed}};
          for (std::size_t k = 0; k < n_seen; ++k)
          {
            part.seen[k].resize(all[k].empty() ? 0 : n);
            for (std::size_t i = 0; i < part.seen[k].size(); ++i)
              part.seen[k][i] = all[k][open.index[i]];
          }
          FeedbackStress answer{part.g, {}, {}, {}};
          std::span<double> *const derivatives[] = {&answer.m_w, &answer.m_rate, &answer.m_near};
          for (std::size_t d = 0; d < n_directions; ++d)
            if (!wanted[d].empty())
              *derivatives[d] = part.g_d[d];
          part.feedback->values(t, {part.seen[0], part.seen[1], part.seen[2], part.seen[3]}, answer);
        }
        for (std::size_t i = 0; i < n; ++i)
          all_.f[open.index[i]] = open.factor[i] * V * part.g[i];
        if (part.feedback)
          for (std::size_t d = 0; d < n_directions; ++d)
            if (!wanted[d].empty())
              for (std::size_t i = 0; i < n; ++i)
                all_.f_d[d][open.index[i]] = open.factor[i] * V * part.g_d[d][i];
      }

      Combination all_;
      std::vector<Part> parts_;
    };

    const std::string sum_section = "Active stress/Sum/";

    /// Facts of the feedbacks of all terms, which have one distance, delay and sensor.
    KnownFeedback::Facts
    common_facts(const std::vector<SumTerm> &terms)
    {
      KnownFeedback::Facts common;
      bool sees_near = false;
      for (std::size_t i = 0; i < terms.size(); ++i)
      {
        const StretchFeedback *const feedback = terms[i].stress->feedback();
        if (feedback == nullptr)
          continue;
        const auto take = [i](const double value, double &known, const bool is_known, const char *name) {
          if (is_known && value != known)
            throw InputError(
              fmt::format("term {} uses the stretch with the {} {:g}, but another term with {:g}; one {} for all "
                          "terms is expected",
                          i + 1,
                          name,
                          value,
                          known,
                          name),
              fmt::format("{}Term {}/Generator", sum_section, i + 1));
          known = value;
        };
        common.uses_rate = common.uses_rate || feedback->uses_rate();
        if (feedback->sees_near())
        {
          take(feedback->distance(), common.distance, sees_near, "distance");
          take(feedback->sensor_length(), common.sensor_length, sees_near, "sensor length");
          sees_near = true;
        }
        if (feedback->delay() != 0.)
          take(feedback->delay(), common.delay, common.delay != 0., "delay");
      }
      return common;
    }
  } // namespace

  void
  SumTermParameters::add_parameters(Declarations &declarations)
  {
    const Range not_negative{.lower = 0., .lower_included = true};
    declarations.choice("Combine", combine, {"add", "multiply"})
      .means("m is the sum of all terms that add, times the product of all terms that multiply.");
    declarations.number("Factor", factor, any_number(), "1").means("Factor that multiplies the term's generator.");
    const auto window = [&](WindowEntries &entries, const std::string &x, const std::string &whole, const char *unit) {
      declarations.numbers("Window in " + x, entries.interval, unit)
        .means("Range of " + x + " in which the term acts, as two numbers; outside the term is 0. Empty: " + whole +
               ".");
      declarations.number("Edge width in " + x, entries.edge_width, not_negative, unit)
        .means("Width of the window's edges, which are smooth steps inside its ends; with 0 the term jumps there.");
    };
    window(in_s, "s", "the whole body", "length");
    window(in_t, "t", "the whole duration", "time");
  }

  Sum::Sum(std::vector<SumTerm> terms, const double length, const double end_time)
    : terms_(std::move(terms))
    , length_(length)
    , end_time_(end_time)
  {
    if (terms_.empty())
      throw InputError("the sum has no terms; a subsection \"Term 1\" in the subsection Sum is expected",
                       "Active stress/Generator");
    if (std::all_of(terms_.begin(), terms_.end(), [](const SumTerm &term) { return term.multiplies; }))
      throw InputError("all terms of the sum multiply; at least one that adds is expected",
                       sum_section + "Term 1/Combine");
    if (std::any_of(
          terms_.begin(), terms_.end(), [](const SumTerm &term) { return term.stress->feedback() != nullptr; }))
      feedback_ = std::make_unique<KnownFeedback>(common_facts(terms_), [this](const std::vector<double> &points) {
        return std::make_unique<SumFeedbackAtPoints>(terms_, points);
      });
    const auto add = [](std::vector<double> &all, const std::vector<double> &list) {
      all.insert(all.end(), list.begin(), list.end());
    };
    for (const SumTerm &term : terms_)
    {
      add(facts_.breaks_in_space, term.stress->breaks_in_space());
      add(facts_.breaks_in_space, term.in_s.breaks());
      add(facts_.breaks_in_time, term.stress->breaks_in_time());
      add(facts_.breaks_in_time, term.in_t.ends());
    }
  }

  std::unique_ptr<ActiveStressAtPoints>
  Sum::evaluator(const std::vector<double> &points, const bool rate) const
  {
    return std::make_unique<SumAtPoints>(terms_, points, /*wants_rate=*/rate);
  }

  std::unique_ptr<ActiveStressAtPoints>
  Sum::rate_at(const std::vector<double> &points) const
  {
    for (const SumTerm &term : terms_)
      if (!term.stress->rate_at({0.}))
        return nullptr;
    return evaluator(points, /*rate=*/true);
  }

  std::optional<ActiveStress::Repetition>
  Sum::search_repetition() const
  {
    std::vector<double> periods;
    double from = 0.;
    for (const SumTerm &term : terms_)
    {
      from = std::max(from, term.in_t.constant_from());
      if (const auto bounds = term.stress->bounds({0., length_, 0., end_time_}); bounds && bounds->rate == 0.)
        continue; // steady
      const auto repeats = term.stress->repetition();
      if (!repeats)
        return find_repetition(*this, length_, end_time_);
      from = std::max(from, repeats->from);
      periods.push_back(repeats->period);
    }
    const auto common = periods.empty() ? std::nullopt : common_period(periods);
    if (!common)
      return std::nullopt;
    return Repetition{shortest_period(*this, length_, *common, from), from};
  }

  namespace
  {
    ActiveStress::Bounds
    sampled_bounds(const ActiveStress &stress, const ActiveStress::Box &box)
    {
      constexpr unsigned int n = 2;
      constexpr double margin  = 2.;
      std::vector<double> places, now(n + 1), before;
      for (unsigned int i = 0; i <= n; ++i)
        places.push_back(box.s_from + (box.s_to - box.s_from) * i / n);
      const auto at = stress.at(places), rate_at = stress.rate_at(places);
      ActiveStress::Bounds largest{0., 0.};
      const double step = (box.t_to - box.t_from) / n;
      for (unsigned int j = 0; j <= n; ++j)
      {
        const double t = box.t_from + step * j;
        before         = now;
        at->values(t, now);
        for (unsigned int i = 0; i <= n; ++i)
        {
          largest.value = std::max(largest.value, margin * std::abs(now[i]));
          if (j > 0 && step > 0.)
            largest.rate = std::max(largest.rate, margin * std::abs(now[i] - before[i]) / step);
        }
        if (!rate_at)
          continue;
        rate_at->values(t, now);
        for (const double rate : now)
          largest.rate = std::max(largest.rate, margin * std::abs(rate));
        at->values(t, now);
      }
      return largest;
    }
  } // namespace

  std::optional<ActiveStress::Bounds>
  Sum::bounds(const Box &box) const
  {
    bool any = false;
    Bounds sum{0., 0.}, product{1., 0.};
    for (const SumTerm &term : terms_)
    {
      auto own = term.stress->bounds(box);
      any      = any || own;
      if (!own)
        own = sampled_bounds(*term.stress, box);
      const auto [window, change] = term.in_t.largest(box.t_from, box.t_to);
      const double factor         = std::abs(term.factor) * term.in_s.largest(box.s_from, box.s_to).first;
      const auto times            = [](const double a, const double b) { return a == 0. || b == 0. ? 0. : a * b; };
      const Bounds f = {factor * window * own->value, times(factor * window, own->rate) + factor * change * own->value};
      if (term.multiplies)
        product = {product.value * f.value, times(product.rate, f.value) + times(product.value, f.rate)};
      else
        sum = {sum.value + f.value, sum.rate + f.rate};
    }
    if (!any)
      return std::nullopt;
    const double rate = (sum.rate > 0. && product.value > 0. ? sum.rate * product.value : 0.) +
                        (sum.value > 0. && product.rate > 0. ? sum.value * product.rate : 0.);
    return Bounds{sum.value * product.value, rate};
  }

  std::unique_ptr<const ActiveStress>
  Sum::with_fronts(const double part) const
  {
    std::vector<SumTerm> terms = terms_;
    bool any                   = false;
    for (SumTerm &term : terms)
      if (const auto *const jumping = dynamic_cast<const MovingJumps *>(term.stress.get()))
        if (std::shared_ptr<const ActiveStress> smooth = jumping->with_fronts(part))
        {
          term.stress = std::move(smooth);
          any         = true;
        }
    return any ? std::make_unique<Sum>(std::move(terms), length_, end_time_) : nullptr;
  }

  const StressFailures *
  Sum::failures() const
  {
    bool may_fail = false;
    StressFailures all;
    for (const SumTerm &term : terms_)
      if (const StressFailures *own = term.stress->failures())
      {
        may_fail = true;
        all.count += own->count;
        if (!own->latest.empty())
          all.latest = own->latest;
      }
    failures_ = all;
    return may_fail ? &failures_ : nullptr;
  }

  void
  Sum::report(std::ostream &out) const
  {
    for (std::size_t i = 0; i < terms_.size(); ++i)
    {
      const SumTerm &term = terms_[i];
      out << fmt::format("Term {} {}: {}", i + 1, term.multiplies ? "multiplies" : "adds", term.name);
      if (term.factor != 1.)
        out << fmt::format(", factor {:g}", term.factor);
      for (const std::string &words : {term.in_s.in_words(), term.in_t.in_words()})
        if (!words.empty())
          out << ", " << words;
      out << '\n';
      std::ostringstream own;
      term.stress->report(own);
      std::istringstream lines(own.str());
      for (std::string line; std::getline(lines, line);)
        out << "  " << line << '\n';
    }
  }
} // namespace crawler
