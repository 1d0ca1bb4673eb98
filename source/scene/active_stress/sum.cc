// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/sum.h>
#include <crawler/scene/fast_changes.h>
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
    /// Evaluates a sum with its derivatives: values, rates, or values and derivatives with respect to what is seen.
    class SumAtPoints : public ActiveStressAtPoints, public FeedbackAtPoints
    {
    public:
      enum class Wanted
      {
        values,
        rates,
        feedback
      };

      SumAtPoints(const std::vector<SumTerm> &terms, const std::vector<double> &points, const Wanted wanted)
        : wants_rates_(wanted == Wanted::rates)
        , f_(wanted == Wanted::values  ? 1
             : wanted == Wanted::rates ? 2
                                       : n_all,
             std::vector<double>(points.size()))
        , sum_(f_)
        , product_(f_)
      {
        for (const SumTerm &term : terms)
        {
          Part part{.term = &term};
          std::vector<double> places;
          for (std::size_t i = 0; i < points.size(); ++i)
            if (const double W = term.in_s.value(points[i]); W != 0.)
            {
              part.index.push_back(i);
              part.factor.push_back(term.factor * W);
              places.push_back(points[i]);
            }
          if (!places.empty())
          {
            const StretchFeedback *feedback = wanted == Wanted::feedback ? term.stress->feedback() : nullptr;
            if (feedback != nullptr)
              part.feedback = feedback->at(places);
            else
              part.stress = term.stress->at(places);
            if (wants_rates_)
              part.rate = term.stress->rate_at(places);
            part.g.assign(feedback != nullptr ? n_all : wants_rates_ ? 2 : 1, places);
          }
          parts_.push_back(std::move(part));
        }
      }

      void
      values(const double t, const std::span<double> m) override
      {
        if (wants_rates_)
          evaluate(t, {}, {{{}, m}});
        else
          evaluate(t, {}, {{m}});
      }

      void
      values(const double t, const StretchSeen &seen, const FeedbackStress &m) override
      {
        evaluate(t, seen, {{m.m, m.m_w, m.m_rate, m.m_near}});
      }

    private:
      static constexpr std::size_t n_all = 4; ///< m and its derivatives; also what is seen: w, w_t, w near, w delayed
      using Written                      = std::array<std::span<double>, n_all>;

      /// A term at the points where its window is open.
      struct Part
      {
        const SumTerm *term;
        std::vector<std::size_t> index               = {};            ///< among all points
        std::vector<double> factor                   = {};            ///< the term's factor times W(s)
        std::unique_ptr<ActiveStressAtPoints> stress = {}, rate = {}; ///< or
        std::unique_ptr<FeedbackAtPoints> feedback  = {};
        std::array<std::vector<double>, n_all> seen = {};
        std::vector<std::vector<double>> g          = {}; ///< and its derivatives
      };

      /// Writes value and derivatives; those that are not wanted are empty.
      void
      evaluate(const double t, const StretchSeen &seen, const Written &m)
      {
        for (std::size_t k = 0; k < f_.size(); ++k)
        {
          std::fill(sum_[k].begin(), sum_[k].end(), 0.);
          std::fill(product_[k].begin(), product_[k].end(), k == 0 ? 1. : 0.);
        }
        for (Part &part : parts_)
        {
          for (auto &f : f_)
            std::fill(f.begin(), f.end(), 0.);
          const double V = part.term->in_t.value(t), V_t = wants_rates_ ? part.term->in_t.rate(t) : 0.;
          if (!part.index.empty() && (V != 0. || V_t != 0.))
            write(part, t, V, V_t, seen, m);
          combine(part.term->multiplies);
        }
        for (std::size_t k = 0; k < f_.size(); ++k)
          for (std::size_t i = 0; i < m[k].size(); ++i)
            m[k][i] = k == 0 ? sum_[0][i] * product_[0][i] : sum_[k][i] * product_[0][i] + sum_[0][i] * product_[k][i];
      }

      /// Writes f = F W V g and its derivatives; in time F W (V_t g + V g_t).
      void
      write(
        Part &part, const double t, const double V, const double V_t, const StretchSeen &seen, const Written &wanted)
      {
        if (part.feedback)
          see(part, t, seen, wanted);
        else
          part.stress->values(t, part.g[0]);
        if (part.rate)
          part.rate->values(t, part.g[1]);
        for (std::size_t k = 0; k < part.g.size(); ++k)
          if (k == 0 || !wanted[k].empty())
            for (std::size_t i = 0; i < part.index.size(); ++i)
              f_[k][part.index[i]] = k > 0 && part.rate ? part.factor[i] * (V_t * part.g[0][i] + V * part.g[1][i])
                                                        : part.factor[i] * V * part.g[k][i];
      }

      static void
      see(Part &part, const double t, const StretchSeen &seen, const Written &wanted)
      {
        const std::array<std::span<const double>, n_all> all = {{seen.stretch, seen.rate, seen.near, seen.delayed}};
        Written g;
        for (std::size_t k = 0; k < n_all; ++k)
        {
          part.seen[k].resize(all[k].empty() ? 0 : part.index.size());
          for (std::size_t i = 0; i < part.seen[k].size(); ++i)
            part.seen[k][i] = all[k][part.index[i]];
          if (k == 0 || !wanted[k].empty())
            g[k] = part.g[k];
        }
        part.feedback->values(t, {part.seen[0], part.seen[1], part.seen[2], part.seen[3]}, {g[0], g[1], g[2], g[3]});
      }

      /// Adds f and its derivatives to the sum, or multiplies the product by them.
      void
      combine(const bool multiplies)
      {
        for (std::size_t k = f_.size(); k-- > 0;)
          for (std::size_t i = 0; i < f_[k].size(); ++i)
            if (!multiplies)
              sum_[k][i] += f_[k][i];
            else if (k == 0)
              product_[0][i] *= f_[0][i];
            else
              product_[k][i] = product_[k][i] * f_[0][i] + product_[0][i] * f_[k][i];
      }

      const bool wants_rates_;
      std::vector<std::vector<double>> f_, sum_, product_; ///< [value, then derivatives][point]; f of one term
      std::vector<Part> parts_;
    };

    const std::string sum_section = "Active stress/Sum/";

    /// Facts of the feedbacks of all terms, which have one distance, delay and sensor; nothing without feedback.
    std::optional<StretchFeedback::Facts>
    common_facts(const std::vector<SumTerm> &terms)
    {
      StretchFeedback::Facts common;
      bool has_feedback = false, sees_near = false;
      for (std::size_t i = 0; i < terms.size(); ++i)
      {
        const StretchFeedback *const feedback = terms[i].stress->feedback();
        if (feedback == nullptr)
          continue;
        has_feedback    = true;
        const auto take = [i](const double value, double &known, const bool is_known, const char *name) {
          if (is_known && value != known)
            refuse(fmt::format("{}Term {}/Generator", sum_section, i + 1),
                   "term {} uses the stretch with the {} {:g}, but another term with {:g}; one {} for all "
                   "terms is expected",
                   i + 1,
                   name,
                   value,
                   known,
                   name);
          known = value;
        };
        const StretchFeedback::Facts &own = feedback->facts;
        common.uses_rate                  = common.uses_rate || own.uses_rate;
        if (own.sees_near())
        {
          take(own.distance, common.distance, sees_near, "distance");
          take(own.sensor_length, common.sensor_length, sees_near, "sensor length");
          sees_near = true;
        }
        if (own.delay != 0.)
          take(own.delay, common.delay, common.delay != 0., "delay");
      }
      return has_feedback ? std::optional(common) : std::nullopt;
    }
  } // namespace

  void
  SumTermParameters::add_parameters(Declarations &declarations)
  {
    declarations.choice("Combine", combine, {"add", "multiply"})
      .means("m is the sum of all terms that add, times the product of all terms that multiply.");
    declarations.number("Factor", factor, any_number(), "1").means("Factor that multiplies the term's generator.");
    const auto window = [&](WindowEntries &entries, const std::string &x, const std::string &whole, const char *unit) {
      declarations.numbers("Window in " + x, entries.interval, unit)
        .means("Range of " + x + " in which the term acts, as two numbers; outside the term is 0. Empty: " + whole +
               ".");
      declarations.number("Edge width in " + x, entries.edge_width, not_negative(), unit)
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
    if (const auto facts = common_facts(terms_))
      facts_.feedback =
        StretchFeedback{*facts, [this](const std::vector<double> &points) {
                          return std::make_unique<SumAtPoints>(terms_, points, SumAtPoints::Wanted::feedback);
                        }};
    facts_.search  = [this]() { return search_repetition(); };
    const auto add = [](std::vector<double> &all, const std::vector<double> &list) {
      all.insert(all.end(), list.begin(), list.end());
    };
    for (const SumTerm &term : terms_)
    {
      add(facts_.breaks_in_space, term.stress->breaks_in_space());
      add(facts_.breaks_in_space, term.in_s.breaks());
      add(facts_.breaks_in_time, term.stress->breaks_in_time());
      add(facts_.breaks_in_time, term.in_t.ends());
      facts_.has_rate = facts_.has_rate && term.stress->rate_at({0.}) != nullptr;
    }
  }

  std::unique_ptr<ActiveStressAtPoints>
  Sum::evaluator(const std::vector<double> &points, const bool rate) const
  {
    return std::make_unique<SumAtPoints>(
      terms_, points, rate ? SumAtPoints::Wanted::rates : SumAtPoints::Wanted::values);
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
      {
        constexpr double margin = 2.;
        const Bounds sampled    = sampled_bounds(*term.stress, box, 3, 3);
        own                     = {margin * sampled.value, margin * sampled.rate};
      }
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
      if (const auto *const known = dynamic_cast<const KnownStress *>(term.stress.get()))
        if (std::shared_ptr<const ActiveStress> smooth = known->with_fronts(part))
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
