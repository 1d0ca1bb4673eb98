// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/fused/lane_engine.h>
#include <crawler/fused/lane_kernels.h>

#include <cstddef>

/**
 * The Radau IIA methods on packs of bodies; formulas and their sources are in doc/numerics.md, "Fused engine". Included
 * by lanes.cc alone, once for each instruction set. Nothing here may come from the C++ library: its inline functions
 * would be compiled for this instruction set and might be used by all.
 */
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Error of Newton's method that is left, relative to the admissible error of a step.
  constexpr double newton_fraction = 0.01;
  constexpr int most_newton        = 8;
  /// But the equations are solved at least as if the tolerance were this.
  constexpr double largest_tolerance = 1e-3;
  /// Newton's method must converge faster than this per iteration, or the step is made shorter by failure_factor.
  constexpr double slowest_rate = 0.5, failure_factor = 0.25;
  constexpr unsigned int most_failures = 12;
  /// A body for which it has failed so often, and in so large a part of the steps, is left to who can do more.
  constexpr unsigned int many_failures = 1000;
  constexpr double large_part          = 0.5;
  /// The polynomial of the last step is a good guess up to this multiple of the step.
  constexpr double longest_extrapolation = 3.;
  /// Step control: the next step is safety * (1/error)^(1/(stages+1)) of this one, within these factors.
  constexpr double safety = 0.9, after_rejection = 0.5, least_change = 0.1, most_change = 10.;
  constexpr double least_step = 1e-12;
  /// A start disturbs stiff components; traces are left after so many steps.
  constexpr unsigned int settling_steps = 3;

  template <typename Pack, int s>
  class RadauLanes
  {
  public:
    static constexpr int lanes = PackTraits<Pack>::size, pairs = (s - 1) / 2, middle = s / 2;
    using Number = Complex<Pack>;

    RadauLanes(const LaneSetup &setup, const LaneHost &host, double *memory)
      : setup_(setup)
      , host_(host)
      , kernels_(lane_kernels<Pack>(setup.degree))
      , n_(static_cast<int>(setup.n_cells * setup.degree + 1))
      , n_points_(static_cast<int>(setup.n_cells * (setup.degree + 1)))
    {
      mesh_.n_cells = static_cast<int>(setup.n_cells);
      mesh_.tables  = {setup.values, setup.derivatives, setup.weights, setup.stiffness};
      lay_out(memory);
    }

    static std::size_t
    memory(const LaneSetup &setup)
    {
      const LaneHost nobody{};
      return RadauLanes(setup, nobody, nullptr).size_;
    }

    void
    run()
    {
      for (int l = 0; l < lanes; ++l)
        take_next(l);
      while (any_busy())
      {
        if (friction_changed_)
          sort_friction();
        begin_step();
        guess();
        factorize();
        newton();
        estimate_error();
        decide();
      }
    }

  private:
    struct Lane
    {
      LaneJob job;
      bool busy = false, rests = false, has_old = false, just_rejected = false;
      bool iterating = false, failed = false, accepted = false;
      double t = 0., h = 1., next = 1., old_h = 1., error = 0.;
      double rate = 0., known_rate = 1., last_correction = 0.;
      unsigned int steps = 0, rejected = 0, failures = 0, all_failures = 0, frame = 0;
      unsigned long newton = 0;
    };

    /// A piece of memory, all pieces one after the other; without memory only their sizes are added.
    template <typename Type>
    void
    piece(Type *&pointer, double *memory, const std::size_t n)
    {
      pointer = memory != nullptr ? reinterpret_cast<Type *>(memory + size_) : nullptr;
      size_ += (n * sizeof(Type) / sizeof(double) + 7) / 8 * 8;
    }

    void
    lay_out(double *memory)
    {
      const std::size_t n = n_, block = std::size_t(setup_.degree + 1) * (setup_.degree + 1) * setup_.n_cells,
                        corners = setup_.n_cells + 1;
      piece(y_, memory, n);
      piece(z_, memory, s * n);
      piece(old_z_, memory, s * n);
      piece(F_, memory, s * n);
      piece(u_, memory, n);
      piece(v_, memory, n);
      piece(m_, memory, std::size_t(s) * n_points_);
      piece(m_start_, memory, n_points_);
      piece(real_, memory, n);
      piece(complex_, memory, pairs * n);
      piece(blocks_, memory, block);
      piece(schur_, memory, 4 * setup_.n_cells);
      piece(lower_, memory, corners);
      piece(pivot_, memory, corners);
      piece(upper_, memory, corners);
      piece(complex_blocks_, memory, pairs * block);
      piece(complex_schur_, memory, pairs * 4 * setup_.n_cells);
      piece(complex_lower_, memory, pairs * corners);
      piece(complex_pivot_, memory, pairs * corners);
      piece(complex_upper_, memory, pairs * corners);
      piece(scratch_, memory, n_points_);
    }

    bool
    any_busy() const
    {
      for (int l = 0; l < lanes; ++l)
        if (lanes_[l].busy)
          return true;
      return false;
    }

    /// The next body for a lane, or one at rest that asks nothing.
    void
    take_next(const int l)
    {
      Lane &lane = lanes_[l];
      lane       = Lane();
      lane.busy  = host_.next(host_.context, static_cast<unsigned int>(l), lane.job);
      if (!lane.busy)
      {
        lane.job   = {1., 0., 1., 1., 1., 0, 0., 0., nullptr, nullptr, 0};
        lane.rests = true;
      }
      lane.t    = lane.job.start_time;
      lane.next = lane.job.initial_step;
      set_lane(mesh_.k, l, lane.job.k);
      set_lane(mesh_.friction.a, l, lane.job.a);
      set_lane(tolerance_, l, lane.job.tolerance);
      friction_changed_ = true;
      for (int i = 0; i < n_; ++i)
        set_lane(y_[i], l, lane.job.start != nullptr ? lane.job.start[i] : 0.);
      for (int i = 0; i < s * n_; ++i)
        set_lane(old_z_[i], l, 0.);
      for (int i = 0; i < s * n_points_; ++i)
        set_lane(m_[i], l, 0.);
      stress(l, lane.t, m_start_);
    }

    void
    stress(const int l, const double t, Pack *m)
    {
      if (lanes_[l].busy)
        host_.stress(host_.context, static_cast<unsigned int>(l), t, scratch_);
      for (int i = 0; i < n_points_; ++i)
        set_lane(m[i], l, lanes_[l].busy ? scratch_[i] : 0.);
    }

    void
    sort_friction()
    {
      auto &friction      = mesh_.friction;
      friction.any_whole  = false;
      friction.any_other  = false;
      friction.n_bits     = 0;
      friction_changed_   = false;
      constexpr int bound = (1 << LaneFriction<Pack>::most_bits) - 1;
      Pack whole{}, negative{}, bits[LaneFriction<Pack>::most_bits] = {};
      for (int l = 0; l < lanes; ++l)
      {
        const double a = get_lane(friction.a, l), size = a < 0. ? -a : a;
        const bool is_whole = size <= bound && size == static_cast<int>(size);
        set_lane(whole, l, is_whole);
        set_lane(negative, l, a < 0.);
        friction.any_whole = friction.any_whole || is_whole;
        friction.any_other = friction.any_other || !is_whole;
        for (int b = 0; b < LaneFriction<Pack>::most_bits; ++b)
          if (is_whole && (static_cast<int>(size) >> b & 1) != 0)
          {
            set_lane(bits[b], l, 1.);
            friction.n_bits = b + 1 > friction.n_bits ? b + 1 : friction.n_bits;
          }
      }
      friction.whole    = whole > 0.;
      friction.negative = negative > 0.;
      for (int b = 0; b < LaneFriction<Pack>::most_bits; ++b)
        friction.bits[b] = bits[b] > 0.;
    }

    /// Lengths of the steps, and the active stress in their stages.
    void
    begin_step()
    {
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = lanes_[l];
        if (lane.busy)
        {
          const double left = lane.job.frames[lane.frame] - lane.t;
          double h          = lane.next < lane.job.largest_step ? lane.next : lane.job.largest_step;
          if (h >= left * (1. - 1e-9))
            h = left;
          else if (h > 0.5 * left)
            h = 0.5 * left;
          lane.h = h;
          for (int i = 0; i < s; ++i)
            stress(l, i + 1 < s ? lane.t + setup_.c[i] * h : end_of_step(lane), m_ + i * n_points_);
        }
        set_lane(inverse_h_, l, 1. / lane.h);
      }
    }

    static double
    end_of_step(const Lane &lane)
    {
      const double frame = lane.job.frames[lane.frame];
      return lane.h == frame - lane.t ? frame : lane.t + lane.h;
    }

    /// The polynomial of the last step continued, or rest.
    void
    guess()
    {
      Pack ratio{}, use{};
      for (int l = 0; l < lanes; ++l)
      {
        set_lane(ratio, l, lanes_[l].h / lanes_[l].old_h);
        set_lane(use, l, lanes_[l].has_old);
      }
      const double *c    = setup_.c;
      const auto is_near = ratio <= broadcast<Pack>(longest_extrapolation);
      for (int i = 0; i < s; ++i)
      {
        Pack weights[s];
        const Pack x = 1. + c[i] * ratio;
        for (int j = 0; j < s; ++j)
        {
          Pack weight = x * (1. / c[j]); // of the polynomial through (0, 0) and (c_k, z_k), less its value at 1
          for (int k = 0; k < s; ++k)
            if (k != j)
              weight *= (x - c[k]) * (1. / (c[j] - c[k]));
          if (j == s - 1)
            weight -= 1.;
          const Pack tangent = c[i] * ratio * setup_.inverse[(s - 1) * s + j];
          weights[j]         = use * (is_near ? weight : tangent);
        }
        Pack *z = z_ + i * n_;
        for (int d = 0; d < n_; ++d)
        {
          Pack sum = weights[0] * old_z_[d];
          for (int j = 1; j < s; ++j)
            sum += weights[j] * old_z_[j * n_ + d];
          z[d] = sum;
        }
      }
    }

    /// u and v of stage i.
    void
    state_of_stage(const int i)
    {
      Pack weights[s];
      for (int j = 0; j < s; ++j)
        weights[j] = inverse_h_ * setup_.inverse[i * s + j];
      for (int d = 0; d < n_; ++d)
      {
        u_[d]    = y_[d] + z_[i * n_ + d];
        Pack sum = weights[0] * z_[d];
        for (int j = 1; j < s; ++j)
          sum += weights[j] * z_[j * n_ + d];
        v_[d] = sum;
      }
    }

    void
    factorize()
    {
      state_of_stage(middle);
      Number shifts[pairs];
      for (int j = 0; j < pairs; ++j)
        shifts[j] = {setup_.eigenvalues[2 * j] * inverse_h_, setup_.eigenvalues[2 * j + 1] * inverse_h_};
      kernels_.factorize(mesh_,
                         u_,
                         v_,
                         setup_.real_eigenvalue * inverse_h_,
                         pairs,
                         shifts,
                         blocks_,
                         schur_,
                         complex_blocks_,
                         complex_schur_);
      const int N = mesh_.n_cells;
      factorize_corners(schur_, lower_, pivot_, upper_);
      for (int j = 0; j < pairs; ++j)
        factorize_corners(complex_schur_ + 4 * j * N,
                          complex_lower_ + j * (N + 1),
                          complex_pivot_ + j * (N + 1),
                          complex_upper_ + j * (N + 1));
    }

    /// The tridiagonal system of the corners: factors below the diagonal, 1/pivots, upper diagonal.
    template <typename Type>
    void
    factorize_corners(const Type *schur, Type *lower, Type *pivot, Type *upper) const
    {
      const int N   = mesh_.n_cells;
      Type diagonal = schur[0];
      for (int c = 0; c < N; ++c)
      {
        const Type *S = schur + 4 * c;
        pivot[c]      = 1. / diagonal;
        upper[c]      = S[1];
        lower[c]      = S[2] * pivot[c];
        diagonal      = S[3];
        diagonal -= lower[c] * upper[c];
        if (c + 1 < N)
          diagonal += S[4];
      }
      pivot[N] = 1. / diagonal;
    }

    template <typename Type>
    void
    solve_corners(const Type *lower, const Type *pivot, const Type *upper, Type *x) const
    {
      const int N = mesh_.n_cells, q = static_cast<int>(setup_.degree);
      for (int c = 0; c < N; ++c)
        x[(c + 1) * q] -= lower[c] * x[c * q];
      x[N * q] *= pivot[N];
      for (int c = N - 1; c >= 0; --c)
      {
        x[c * q] -= upper[c] * x[(c + 1) * q];
        x[c * q] *= pivot[c];
      }
    }

    void
    solve(Pack *x) const
    {
      kernels_.forward(mesh_.n_cells, blocks_, x);
      solve_corners(lower_, pivot_, upper_, x);
      kernels_.backward(mesh_.n_cells, blocks_, x);
    }

    void
    solve_complex(const int j, Number *x) const
    {
      const int N         = mesh_.n_cells;
      const Number *block = complex_blocks_ + std::size_t(j) * N * (setup_.degree + 1) * (setup_.degree + 1);
      kernels_.complex_forward(N, block, x);
      solve_corners(complex_lower_ + j * (N + 1), complex_pivot_ + j * (N + 1), complex_upper_ + j * (N + 1), x);
      kernels_.complex_backward(N, block, x);
    }

    void
    newton()
    {
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane     = lanes_[l];
        lane.iterating = lane.busy;
        lane.failed    = false;
        lane.rate      = 0.;
      }
      for (int it = 1; it <= most_newton && any_iterating(); ++it)
      {
        Pack least = broadcast<Pack>(HUGE_VAL);
        for (int i = 0; i < s; ++i)
        {
          state_of_stage(i);
          least = smaller(least, kernels_.residual(mesh_, u_, v_, m_ + i * n_points_, F_ + i * n_));
        }
        const Pack correction = correct();
        for (int l = 0; l < lanes; ++l)
          if (lanes_[l].iterating)
            look_at_correction(lanes_[l], it, get_lane(least, l), ::sqrt(get_lane(correction, l)));
      }
      for (int l = 0; l < lanes; ++l)
        if (lanes_[l].iterating)
          lanes_[l].failed = true;
    }

    bool
    any_iterating() const
    {
      for (int l = 0; l < lanes; ++l)
        if (lanes_[l].iterating)
          return true;
      return false;
    }

    /// One correction from the residuals F, in the basis of the eigenvectors of A^-1; returns its mean square in units
    /// of the tolerance. Lanes that are done keep their state.
    Pack
    correct()
    {
      constexpr int columns = 1 + pairs;
      Pack mask{};
      for (int l = 0; l < lanes; ++l)
        set_lane(mask, l, lanes_[l].iterating);
      const auto moves = mask > 0.;
      // The corrections of all stages take the place of the residuals, so all right-hand sides come first.
      for (int d = 0; d < n_; ++d)
      {
        Pack f[s], sum = Pack{};
        for (int j = 0; j < s; ++j)
        {
          f[j] = F_[j * n_ + d];
          sum += setup_.rows[2 * j] * f[j];
        }
        real_[d] = sum;
        for (int p = 0; p < pairs; ++p)
        {
          const double *row = setup_.rows + 2 * (p + 1) * s;
          Number r{Pack{}, Pack{}};
          for (int j = 0; j < s; ++j)
          {
            r.re += row[2 * j] * f[j];
            r.im += row[2 * j + 1] * f[j];
          }
          F_[2 * p * n_ + d]       = r.re;
          F_[(2 * p + 1) * n_ + d] = r.im;
        }
      }
      solve(real_);
      Pack square{};
      Number *x[pairs];
      for (int p = 0; p < pairs; ++p)
      {
        x[p] = complex_ + std::size_t(p) * n_;
        for (int d = 0; d < n_; ++d)
          x[p][d] = {F_[2 * p * n_ + d], F_[(2 * p + 1) * n_ + d]};
        solve_complex(p, x[p]);
      }
      for (int d = 0; d < n_; ++d)
        for (int i = 0; i < s; ++i)
        {
          Pack change = setup_.vectors[2 * i * columns] * real_[d];
          for (int p = 0; p < pairs; ++p)
          {
            const double *vector = setup_.vectors + 2 * (i * columns + p + 1);
            change += 2. * vector[0] * x[p][d].re - 2. * vector[1] * x[p][d].im;
          }
          square += change * change;
          Pack &z = z_[i * n_ + d];
          z       = moves ? z - change : z;
        }
      return square / (tolerance_ * tolerance_) * (1. / (s * n_));
    }

    /// The iteration converges linearly; with the rate so far the error that remains is rate/(1-rate) corrections.
    void
    look_at_correction(Lane &lane, const int it, const double least_stretch_of_stages, const double correction)
    {
      ++lane.newton;
      if (!(least_stretch_of_stages > 0.) || !(correction < HUGE_VAL))
      {
        lane.failed    = true;
        lane.iterating = false;
        return;
      }
      if (it == 1)
        lane.known_rate = ::pow(lane.known_rate, 0.8);
      else
      {
        lane.rate       = lane.last_correction > 0. ? correction / lane.last_correction : 0.;
        lane.known_rate = lane.rate < 1e-6 ? 1e-6 : lane.rate > 0.9 ? 0.9 : lane.rate;
      }
      lane.last_correction = correction;
      const double excess  = lane.job.tolerance > largest_tolerance ? lane.job.tolerance / largest_tolerance : 1.;
      const double rate    = lane.known_rate < 0.9 ? lane.known_rate : 0.9;
      const double left    = rate / (1. - rate) * correction * excess;
      const double floor   = 1e-15 / lane.job.tolerance; // of displacements up to 1: they are sums of such numbers
      if (left <= newton_fraction || correction <= floor)
        lane.iterating = false;
      else if (it >= 2 && lane.rate > slowest_rate && correction > 10. * floor)
      {
        lane.failed    = true;
        lane.iterating = false;
      }
    }

    /// The error of the embedded formula (time/radau.cc, estimate_error).
    void
    estimate_error()
    {
      Pack sigma = -setup_.real_eigenvalue * inverse_h_;
      for (int d = 0; d < n_; ++d)
      {
        Pack sum = setup_.error_weights[0] * z_[d];
        for (int j = 1; j < s; ++j)
          sum += setup_.error_weights[j] * z_[j * n_ + d];
        v_[d] = sigma * sum;
        u_[d] = y_[d];
      }
      for (int round = 0; round < 2; ++round)
      {
        kernels_.residual(mesh_, u_, v_, m_start_, real_);
        solve(real_);
        Pack square{};
        for (int d = 0; d < n_; ++d)
        {
          square += real_[d] * real_[d];
          u_[d] = y_[d] - real_[d];
        }
        square     = square / (tolerance_ * tolerance_) * (1. / n_);
        bool again = false;
        for (int l = 0; l < lanes; ++l)
        {
          Lane &lane          = lanes_[l];
          const bool settling = lane.steps < settling_steps;
          if (round == 0)
            lane.error = ::sqrt(get_lane(square, l));
          else if (lane.error >= 1. && settling)
            lane.error = settled(::sqrt(get_lane(square, l)));
          again = again || (lane.busy && !lane.failed && lane.error >= 1. && settling);
        }
        if (!again)
          break;
      }
    }

    /// An error that had to be filtered twice: the step must not grow.
    static double
    settled(const double error)
    {
      double least = safety;
      for (int i = 0; i < s; ++i)
        least *= safety;
      return error < least ? least : error;
    }

    /// Accepts or rejects, and finds the next steps.
    void
    decide()
    {
      Pack accepted{};
      bool any = false;
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = lanes_[l];
        if (!lane.busy)
          continue;
        lane.accepted = !lane.failed && lane.error <= 1.;
        control_step(lane);
        set_lane(accepted, l, lane.accepted);
        any = any || lane.accepted;
      }
      if (any)
        advance(accepted > 0.);
      for (int l = 0; l < lanes; ++l)
        if (lanes_[l].busy && !lanes_[l].accepted && is_hopeless(lanes_[l]))
          end(l, LaneOutcome::gave_up);
    }

    static bool
    is_hopeless(const Lane &lane)
    {
      return lane.failures > most_failures || lane.next < least_step ||
             (lane.all_failures > many_failures && lane.all_failures > large_part * lane.steps);
    }

    void
    control_step(Lane &lane)
    {
      if (lane.failed)
      {
        lane.next    = failure_factor * lane.h;
        lane.has_old = false; // it was no good guess
        ++lane.failures;
        ++lane.all_failures;
        ++lane.rejected;
        return;
      }
      double factor = lane.accepted || !lane.just_rejected ? safety : safety * after_rejection;
      factor *= lane.error > 0. ? ::pow(lane.error, -1. / (s + 1)) : HUGE_VAL;
      factor             = factor < least_change ? least_change : factor > most_change ? most_change : factor;
      lane.next          = factor * lane.h;
      lane.just_rejected = !lane.accepted;
      if (lane.accepted)
        lane.failures = 0;
      else
        ++lane.rejected;
    }

    /// The accepted lanes go to the ends of their steps.
    void
    advance(const typename PackTraits<Pack>::Mask &accepted)
    {
      if (host_.look_inside)
        for (int i = 0; i + 1 < s; ++i)
        {
          state_of_stage(i);
          look_at_stage(i, u_);
        }
      for (int d = 0; d < n_; ++d)
        y_[d] = accepted ? y_[d] + z_[(s - 1) * n_ + d] : y_[d];
      for (int i = 0; i < s * n_; ++i)
        old_z_[i] = accepted ? z_[i] : old_z_[i];
      for (int i = 0; i < n_points_; ++i)
        m_start_[i] = accepted ? m_[(s - 1) * n_points_ + i] : m_start_[i];
      if (host_.look_inside)
      {
        // The velocity in which all forces balance; that of the stage has the error of Newton's method.
        kernels_.balance(mesh_, y_, m_ + (s - 1) * n_points_, v_, blocks_, schur_);
        factorize_corners(schur_, lower_, pivot_, upper_);
        solve(v_);
      }
      look_at_stage(s - 1, y_);
      for (int l = 0; l < lanes; ++l)
        if (lanes_[l].busy && lanes_[l].accepted)
          arrive(l);
    }

    /// Keeps the stretch, and the rates if they are asked for, of a stage with the state (@p u, v_).
    void
    look_at_stage(const int i, const Pack *u)
    {
      Pack least, least_at, most, most_at;
      kernels_.extremes(
        mesh_, static_cast<int>(setup_.n_samples), setup_.sample_derivatives, u, &least, &least_at, &most, &most_at);
      LaneIntegrals<Pack> sums;
      if (host_.look_inside)
        kernels_.integrals(mesh_, u, v_, m_ + i * n_points_, sums);
      for (int l = 0; l < lanes; ++l)
        stages_[l][i] = {get_lane(least, l),
                         get_lane(most, l),
                         static_cast<unsigned int>(get_lane(least_at, l)),
                         static_cast<unsigned int>(get_lane(most_at, l)),
                         get_lane(sums.stress_power, l),
                         get_lane(sums.positive_power, l),
                         get_lane(sums.absolute_power, l),
                         get_lane(sums.dissipation, l),
                         get_lane(sums.net_friction, l),
                         get_lane(sums.abs_friction, l),
                         get_lane(v_[0], l),
                         get_lane(v_[n_ - 1], l)};
      elastic_energy_ = sums.elastic_energy;
    }

    /// A lane at the end of its step.
    void
    arrive(const int l)
    {
      Lane &lane          = lanes_[l];
      lane.t              = end_of_step(lane);
      lane.old_h          = lane.h;
      lane.has_old        = true;
      const bool is_frame = lane.t == lane.job.frames[lane.frame];
      ++lane.steps;
      if (is_frame)
        ++lane.frame;
      if (!(stages_[l][s - 1].min_stretch > lane.job.least_stretch))
      {
        end(l, LaneOutcome::gave_up);
        return;
      }
      bool go_on = true;
      if (host_.accepted != nullptr)
        go_on = host_.accepted(host_.context,
                               static_cast<unsigned int>(l),
                               {lane.t,
                                lane.h,
                                lane.next,
                                lane.steps,
                                lane.rejected,
                                lane.newton,
                                is_frame,
                                lanes,
                                reinterpret_cast<const double *>(y_) + l,
                                reinterpret_cast<const double *>(old_z_) + l,
                                stages_[l],
                                get_lane(elastic_energy_, l)});
      if (lane.frame == lane.job.n_frames)
        end(l, LaneOutcome::finished);
      else if (!go_on || lane.steps >= lane.job.most_steps)
        end(l, LaneOutcome::stopped);
    }

    void
    end(const int l, const LaneOutcome::Status status)
    {
      const Lane &lane = lanes_[l];
      host_.done(
        host_.context,
        static_cast<unsigned int>(l),
        {status, lane.t, lane.next, lane.steps, lane.rejected, lane.newton, get_lane(kernels_.integral(mesh_, y_), l)});
      take_next(l);
    }

    const LaneSetup &setup_;
    const LaneHost &host_;
    const LaneKernelTable<Pack> &kernels_;
    const int n_, n_points_; ///< unknowns and quadrature points
    std::size_t size_ = 0;   ///< of the memory
    LaneMesh<Pack> mesh_;
    Lane lanes_[lanes];
    Pack tolerance_, inverse_h_;
    bool friction_changed_ = true;
    LaneStage stages_[lanes][s];
    Pack elastic_energy_{};

    Pack *y_;               ///< at the start of the step
    Pack *z_, *old_z_, *F_; ///< [stage][unknown]
    Pack *u_, *v_, *real_;  ///< [unknown]
    Number *complex_;       ///< [pair][unknown]
    Pack *m_, *m_start_;    ///< active stress of the stages, and at the start
    Pack *blocks_, *schur_, *lower_, *pivot_, *upper_;
    Number *complex_blocks_, *complex_schur_, *complex_lower_, *complex_pivot_, *complex_upper_;
    double *scratch_; ///< active stress of one lane
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
