// A step of the extrapolation, and what lies within a step. Internal.
#pragma once

#include <algorithm>
#include <boost/numeric/odeint/stepper/bulirsch_stoer.hpp>
#include <cmath>

#include "simulation/equations.h"

namespace bentaxis::analytic::simulation {

// Rounding of a step, of a state's size: no tolerance below it can be met.
inline constexpr double kRounding = 1e-15;

// One extrapolated step of scaled states; `h` becomes what the method would take next.
class Stepper {
 public:
  Stepper(Equations& equations, const State& scale, double tolerance)
      : equations_(equations), scale_(scale), method_(tolerance, kRounding, 1.0, 0.0) {}

  bool attempt(double time, const State& y, const State& dy, double& h, State& out) {
    State from, slope;
    for (std::size_t i = 0; i < kMotionStates; ++i) {
      from[i] = y[i] / scale_[i];
      slope[i] = dy[i] / scale_[i];
    }
    const auto system = [this](const State& x, State& dx, double t) {
      State at, rate;
      for (std::size_t i = 0; i < kMotionStates; ++i) at[i] = x[i] * scale_[i];
      equations_.rates(t, at, rate);
      for (std::size_t i = 0; i < kMotionStates; ++i) dx[i] = rate[i] / scale_[i];
    };
    const double asked = h;
    const auto result = method_.try_step(system, from, slope, time, out, h);
    for (std::size_t i = 0; i < kMotionStates; ++i) out[i] *= scale_[i];
    const bool finite =
        std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); });
    if (!finite || !std::isfinite(h)) {
      h = asked / 8;
      method_.reset();
      return false;
    }
    return result == boost::numeric::odeint::success;
  }

 private:
  Equations& equations_;
  State scale_;
  boost::numeric::odeint::bulirsch_stoer<State> method_;
};

// Lag theta - psi within a step.
class LagWithin {
 public:
  struct End {
    double lag, rate, acceleration;
  };
  // The polynomial of degree 5 through both ends.
  LagWithin(const End& from, const End& to, double h) : from_(from), h_(h) {
    const double rise = to.lag - from.lag - h * from.rate - h * h / 2 * from.acceleration;
    const double rate = (to.rate - from.rate - h * from.acceleration) * h;
    const double bend = (to.acceleration - from.acceleration) * h * h;
    cubic_ = 10 * rise - 4 * rate + bend / 2;
    quartic_ = -15 * rise + 7 * rate - bend;
    quintic_ = 6 * rise - 3 * rate + bend / 2;
  }

  // With this acceleration in the middle: what is added is a multiple of s^3 (1 - s)^3, whose
  // second derivative there is -3/8.
  LagWithin with_middle(double acceleration) const {
    LagWithin better = *this;
    const double found =
        from_.acceleration + (3 * cubic_ + 3 * quartic_ + 2.5 * quintic_) / (h_ * h_);
    better.added_ = (found - acceleration) * h_ * h_ / 0.375;
    return better;
  }
  // The largest that was added, to the lag and to its rate.
  double change() const { return std::abs(added_) / 64; }
  double change_of_rate() const { return std::abs(added_) * kSteepest / h_; }

  // At a share `s` of the step.
  void at(double s, double& lag, double& rate) const {
    const double t = s * h_, within = s * (1 - s);
    lag = from_.lag + t * (from_.rate + t / 2 * from_.acceleration) +
          s * s * s * (cubic_ + s * (quartic_ + s * quintic_)) + added_ * within * within * within;
    rate = from_.rate + t * from_.acceleration +
           s * s * (3 * cubic_ + s * (4 * quartic_ + s * 5 * quintic_)) / h_ +
           added_ * 3 * within * within * (1 - 2 * s) / h_;
  }

 private:
  static constexpr double kSteepest = 0.0536656;  // largest slope of s^3 (1 - s)^3
  End from_;
  double h_, cubic_, quartic_, quintic_;
  double added_ = 0;
};

}  // namespace bentaxis::analytic::simulation
