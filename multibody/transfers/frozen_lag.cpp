#include "transfers/frozen_lag.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "bentaxis/numerics/bisection.h"
#include "bentaxis/numerics/root.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "scene/block.h"

namespace bentaxis::multibody {

using SimTK::Rotation;
using SimTK::Vec3;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Halvings that find an angle within half a turn to round-off of an angle of 1 rad.
constexpr int kHalvings = 56;
// Moments below this share of the load scale are none.
constexpr double kNoLoad = 1e-12;
// Steps outwards from the end of the free play, rad: the first, the factor between two, and the
// largest, which is far below the width of a pressure's transition.
constexpr double kFirstStep = 1e-9;
constexpr double kStepGrowth = 2;
constexpr double kLargestStep = 5e-4;
// Steps from the middle of the free play to one of its ends.
constexpr int kStepsInside = 64;

// The root between two lags at whose ends the moment has different signs.
double root_between(double a, double fa, double b, double fb, const BlockMoment& moment,
                    bool walls) {
  const auto at = [&](double lag) { return moment(lag, walls); };
  return a < b ? numerics::root_between(at, a, b, fa, fb)
               : numerics::root_between(at, b, a, fb, fa);
}

// Goes outwards from an end of the free play, way = +1 or -1, to the first root.
double root_outwards(double end, double f_end, double way, const BlockMoment& moment) {
  double from = end, f_from = f_end;
  for (double step = kFirstStep; std::abs(from - end) < kPi;
       step = std::min(kStepGrowth * step, kLargestStep)) {
    const double to = from + way * step;
    const double f = moment(to, true);
    if (f == 0 || (f < 0) != (f_from < 0)) return root_between(from, f_from, to, f, moment, true);
    from = to;
    f_from = f;
  }
  throw ComputationError("no lag is found at which the walls of the bores hold the block");
}

// The root without walls that is nearest to the middle of the free play.
double root_inside(const FreePlay& play, const BlockMoment& moment) {
  const double step = (play.high - play.low) / 2 / kStepsInside;
  const double f_middle = moment(play.middle(), false);
  double f[2] = {f_middle, f_middle};
  double best = kInfinity;
  for (int i = 1; i <= kStepsInside && !std::isfinite(best); ++i)
    for (const int side : {0, 1}) {
      const double way = side == 0 ? -1 : 1;
      const double end = side == 0 ? play.low : play.high;
      const double from = play.middle() + way * step * (i - 1);
      const double to = i == kStepsInside ? end : play.middle() + way * step * i;
      const double f_to = moment(to, false);
      if (f_to == 0 || (f_to < 0) != (f[side] < 0)) {
        const double root = root_between(from, f[side], to, f_to, moment, false);
        if (std::abs(root - play.middle()) < std::abs(best - play.middle())) best = root;
      }
      f[side] = f_to;
    }
  if (!std::isfinite(best))
    throw ComputationError("no lag is found at which the block is in balance in its free play");
  return best;
}

}  // namespace

FreePlay free_play(const PumpParameters& pump, double theta) {
  const Geometry& g = pump.geometry;
  const WallContact& wall = *pump.transfer.wall;
  const double share = 1 - wall.from_joint / g.piston_length;
  const SimTK::Transform frame = block_frame(g);
  FreePlay play{-kInfinity, kInfinity};
  const auto refuse = [&](const std::string& why) {
    throw InputError(
        "multibody model: [transfer] clearance_mm = " + number_text(wall.clearance * 1e3) +
        (wall.deviation.empty() ? ": "
                                : " with " + wall.deviation_file.filename().string() + ": ") +
        why + " at theta = " + number_text(theta / kRadPerDegree) + " deg");
  };
  for (int k = 0; k < g.pistons; ++k) {
    const double theta_k = theta - 2 * kPi * k / g.pistons;
    const Vec3 joint = Rotation(theta_k, SimTK::ZAxis) * Vec3(0, g.joint_circle_radius, 0);
    const Vec3 seen = ~frame * joint;  // along z2: its x and y count
    const auto gap_at = [&](double psi_k) {
      const Vec3 bore = Rotation(psi_k, SimTK::ZAxis) * Vec3(0, g.bore_circle_radius, 0);
      return wall.clearance_of(static_cast<std::size_t>(k)) -
             share * (seen - bore).getSubVec<2>(0).norm();
    };
    // The bore's axis is nearest where it lies on the same radius, and farthest opposite.
    const double nearest = std::atan2(-seen[0], seen[1]);
    if (!(gap_at(nearest) > 0)) refuse("a piston touches its bore at any lag");
    if (!(gap_at(nearest + kPi) < 0)) continue;
    const double lag = std::remainder(theta_k - nearest, 2 * kPi);
    const auto reach = [&](double way) {
      const auto is_beyond = [&](double turned) { return gap_at(nearest - way * turned) < 0; };
      return numerics::bisect({0, kPi}, kHalvings, is_beyond).middle();
    };
    play.high = std::min(play.high, lag + reach(1));
    play.low = std::max(play.low, lag - reach(-1));
  }
  if (!std::isfinite(play.high)) refuse("no piston ever touches its bore");
  if (!(play.low < play.high)) refuse("the pistons leave no free play");
  return play;
}

FrozenLag find_frozen_lag(const FreePlay& play, const BlockMoment& moment, double load_scale,
                          double omega) {
  const double low = moment(play.low, false);
  const double high = moment(play.high, false);
  const double none = kNoLoad * load_scale;
  if (std::abs(low) <= none && std::abs(high) <= none &&
      std::abs(moment(play.middle(), false)) <= none)
    return {play.middle(), LagRule::unloaded};
  const bool above = high < 0;  // pushed back, until the walls push forward
  const bool below = low > 0;
  if (above || below) {
    const bool forward = !(omega < 0);
    const bool goes_above = above && (forward || !below);
    const double lag = goes_above ? root_outwards(play.high, high, 1, moment)
                                  : root_outwards(play.low, low, -1, moment);
    return {lag, goes_above == forward ? LagRule::driving_side : LagRule::trailing_side};
  }
  return {root_inside(play, moment), LagRule::within_play};
}

}  // namespace bentaxis::multibody
