// One point of the rattle map: the motion of the teeth at a speed and a pressure.
#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/multibody/mechanics.h"
#include "bentaxis/pump/units.h"
#include "rattle_pieces.h"

namespace bentaxis::study {
namespace {

constexpr double kErrorOfStep = 1e-3;
constexpr double kLoosestStep = 1e-5, kTightestStep = 1e-12;

// A turn with where it began.
struct Turn {
  double lag, lag_rate;
  coupled::ContactInterval teeth;
};

class Settling {
 public:
  Settling(const MotionVector& scales, int most) : scales_(scales), most_(most) {}

  void add(const Turn& turn) { turns_.push_back(turn); }

  // How many of the last turns say all; 0: more are needed.
  int enough(const RattleOptions& options, double lag, double lag_rate) {
    ends_.push_back({lag, lag_rate, {}});
    for (period_ = 1; period_ <= kLongestPeriod; ++period_)
      if (repeats(period_)) return period_;
    period_ = 0;
    const auto in_touch = [](const Turn& t) {
      return t.teeth.separations == 0 && t.teeth.apart == 0;
    };
    if (count() >= kTurnsInTouch &&
        std::all_of(turns_.end() - kTurnsInTouch, turns_.end(), in_touch))
      return 1;
    return count() >= most_ ? options.turns : 0;
  }

  RattlePoint point(int observed) const {
    RattlePoint p;
    coupled::ContactInterval all;
    p.least_turn = INFINITY;
    for (auto turn = turns_.end() - observed; turn != turns_.end(); ++turn) {
      all = all + turn->teeth;
      p.least_turn = std::min(p.least_turn, turn->teeth.largest);
    }
    const Turn& first = turns_[turns_.size() - static_cast<std::size_t>(observed)];
    p.kind = class_of(all);
    p.apart = all.apart / all.duration;
    p.plus = all.plus / all.duration;
    p.minus = all.minus / all.duration;
    p.largest = all.largest;
    p.mean = all.impulse / all.duration;
    p.impacts = static_cast<double>(all.impacts) / observed;
    p.largest_impulse = all.largest_hit;
    p.observed = observed;
    p.passed = count() - observed;
    p.period = period_;
    p.lag = first.lag;
    p.lag_rate = first.lag_rate;
    return p;
  }

 private:
  int count() const { return static_cast<int>(turns_.size()); }

  // The end of the last turn is that of the turn `period` before it, and so was the one before.
  bool repeats(int period) const {
    if (count() < period + 2) return false;
    const auto near = [&](int back) {
      const Turn& now = ends_[ends_.size() - 1 - static_cast<std::size_t>(back)];
      const Turn& then = ends_[ends_.size() - 1 - static_cast<std::size_t>(back + period)];
      return std::abs(now.lag - then.lag) <= kRepeats * scales_[kLag] &&
             std::abs(now.lag_rate - then.lag_rate) <= kRepeats * scales_[kLagRate];
    };
    const auto touches = [&](int back) {
      return turns_[turns_.size() - 1 - static_cast<std::size_t>(back)].teeth.separations;
    };
    return near(0) && near(1) && touches(0) == touches(period);
  }

  MotionVector scales_;
  int most_;
  int period_ = 0;
  std::vector<Turn> turns_, ends_;
};

// Teeth that do not give way: their force is what the block's balance needs.
RattlePoint rigid_point(const PreparedCase& ready) {
  const Samples samples = ready.samples(Way::driven);
  RunOptions options;
  const ResultTable table = run(ready, samples, options).table;
  const std::size_t column = table.find("Rcs_z4_N");
  RattlePoint p;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double force = table.at(row, column);
    p.largest = std::max(p.largest, std::abs(force));
    p.mean += std::abs(force) / static_cast<double>(table.rows());
    (force >= 0 ? p.plus : p.minus) += 1 / static_cast<double>(table.rows());
  }
  p.least_turn = p.largest;
  const auto [least, greatest] = rigid_extremes(ready);
  p.kind = carries_rigidly(least, greatest) ? RattleClass::carries : RattleClass::reverses;
  p.period = 1;
  return p;
}

}  // namespace

RattleClass class_of(const coupled::ContactInterval& s) {
  const bool both = s.plus > 0 && s.minus > 0;
  // Teeth of unequal pitch may press on the other flank while one touches throughout.
  const bool throughout = std::max(s.plus, s.minus) >= (1 - kNoGap) * s.duration;
  if (s.apart <= kNoGap * s.duration)
    return both && !throughout ? RattleClass::reverses : RattleClass::carries;
  return both ? RattleClass::hits_both : RattleClass::loses_contact;
}

double step_tolerance(double error) {
  return std::clamp(kErrorOfStep * error, kTightestStep, kLoosestStep);
}

WatchedModel::WatchedModel(const PreparedCase& ready, Model model, double tolerance, double lag,
                           double lag_rate, double disturbance)
    : oil(coupled::prescribed_oil(ready.the_case.pump.geometry.pistons, ready.pressure,
                                  ready.the_case.pressure.ports)),
      mechanics(model == Model::analytic
                    ? analytic::mechanics(ready.the_case, ready.assumptions(model))
                    : multibody::mechanics(ready.the_case, ready.assumptions(model))),
      watch(to_string(model), *mechanics, *oil, tolerance, kImpactSpeed) {
  MotionVector motion = mechanics->start();
  motion[kLag] = lag + disturbance * mechanics->scales()[kLag];
  motion[kLagRate] = lag_rate;
  watch.start(motion);
}

RattlePoint settle(const PreparedCase& ready, const RattleOptions& options, double& lag,
                   double& lag_rate, const std::function<void()>& turn) {
  const Case& c = ready.the_case;
  if (!c.pump.block_moves_freely()) {
    turn();
    return rigid_point(ready);
  }
  WatchedModel model(ready, Model::analytic, step_tolerance(options.error), lag, lag_rate);
  coupled::ToothWatch& watch = model.watch;
  Settling settling(model.mechanics->scales(), options.discard + options.turns);
  const double period = 60 / c.operation.speed_rpm;
  for (int n = 1;; ++n) {
    const Turn began{watch.motion()[kLag], watch.motion()[kLagRate], {}};
    settling.add({began.lag, began.lag_rate, watch.run_to(n * period)});
    turn();
    lag = watch.motion()[kLag];
    lag_rate = watch.motion()[kLagRate];
    if (const int observed = settling.enough(options, lag, lag_rate); observed > 0)
      return settling.point(observed);
  }
}

}  // namespace bentaxis::study
