#include "bentaxis/analytic/teeth.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/tooth_flexibility.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/pump/validate.h"
#include "closed_form/bevel.h"

namespace bentaxis::analytic {
namespace {

using Vector = closed_form::Vec3<double>;

// The tooth's number less 1, of any number of turns.
int wrapped(long long tooth, int count) {
  const auto left = static_cast<int>(tooth % count);
  return left < 0 ? left + count : left;
}

// How much a flank lacks, m, less what it is ahead along `side`.
double lack(const ToothErrors& errors, int tooth, int count, int side) {
  const double runout = errors.runout * std::cos(2 * kPi * tooth / count - errors.runout_angle);
  return runout - (errors.pitch.empty() ? 0 : side * errors.pitch[tooth]);
}

const PumpParameters& checked(const PumpParameters& pump) {
  validate(pump);
  if (pump.gear.contact != ToothContact::teeth || !pump.gear.teeth)
    throw InputError("[gear] contact: must be \"teeth\" for resolved tooth contact");
  closed_form::require_mesh(pump.gear, closed_form::bevel(pump));
  return pump;
}

std::array<double, 3> array(const Vector& v) { return {v.x, v.y, v.z}; }

}  // namespace

namespace {

// A smooth function from one argument to another as a row of polynomials, to rounding; constant
// before the first.
class Pieces {
 public:
  template <class Function>
  Pieces(double from, double to, const Function& f)
      : from_(from), per_piece_(kPieces / (to - from)), pieces_(kPieces) {
    for (int piece = 0; piece < kPieces; ++piece) {
      // Of Chebyshev's polynomials through their nodes, then of powers.
      Piece series = {};
      for (int node = 0; node < kTerms; ++node) {
        const double angle = kPi * (node + 0.5) / kTerms;
        const double value = f(from + (piece + 0.5 * (1 + std::cos(angle))) / per_piece_);
        for (int i = 0; i < kTerms; ++i)
          series[i] += (i == 0 ? 1.0 : 2.0) / kTerms * value * std::cos(i * angle);
      }
      Piece before = {1}, last = {0, 1}, sum = {};
      for (int i = 0; i < kTerms; ++i) {
        for (int k = 0; k < kTerms; ++k) sum[k] += series[i] * before[k];
        Piece next = {};
        for (int k = 0; k + 1 < kTerms; ++k) next[k + 1] = 2 * last[k];
        for (int k = 0; k < kTerms; ++k) next[k] -= before[k];
        before = last;
        last = next;
      }
      pieces_[piece] = sum;
    }
  }

  double operator()(double at) const {
    const double place = std::max(0.0, (at - from_) * per_piece_);
    const int piece = static_cast<int>(std::min(place, kPieces - 1.0));
    const double x = 2 * (place - piece) - 1;
    const Piece& c = pieces_[piece];
    const double x2 = x * x;
    return (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2 +
           x2 * x2 * ((c[4] + c[5] * x) + (c[6] + c[7] * x) * x2);
  }

 private:
  static constexpr int kPieces = 64;
  static constexpr int kTerms = 8;
  using Piece = std::array<double, kTerms>;
  double from_, per_piece_;
  std::vector<Piece> pieces_;
};

Pieces flexibility_by_arc(const ToothFlexibility& law, const closed_form::Bevel& bevel) {
  const ToothFlexibility::Profile& tooth = law.profile();
  const double start =
      tooth.base_radius * std::hypot(1, tooth.start_roll) - tooth.pitch_radius;  // height
  const double start_cone = bevel.at.pitch_cone + start / bevel.at.distance;
  const double from = std::acos(std::min(1.0, std::cos(start_cone) / bevel.cos_base));
  return {from, bevel.tip_roll, [&](double arc) {
            return law.tooth(bevel.at.distance * (bevel.cone(arc) - bevel.at.pitch_cone));
          }};
}

}  // namespace

struct BevelTeeth::Numbers {
  explicit Numbers(const PumpParameters& pump);

  closed_form::Bevel bevel;
  ToothFlexibility law;
  Pieces flexibility;  // of a tooth's slice by the arc of where it touches
  // What a tip's edge lacks at least, m, so many steps of its angle past the path's end.
  static constexpr int kSteps = 64;
  std::array<double, kSteps> least_gap;
  double steps_per_arc;
  int count;
  double pitches_per_radian;
  double half_width;  // over R
  double crowning, dissipation, relief, relief_height;
  // By flank (+1, -1) and the shaft's tooth, numbered from 0: approach, m, without lag: errors and
  // backlash.
  std::vector<double> offset[2];
  double block_axis_y, block_axis_z;
  double stiffness;

  double relief_at(double cone) const {
    const double depth = bevel.at.distance * (bevel.at.tip_cone - cone);
    if (!(depth < relief_height)) return 0;
    const double share = (relief_height - depth) / relief_height;
    return relief * share * share;
  }
  // Whether what presses a pair, m, cannot close the gap of its tips.
  bool beyond_reach(double along, double shut, double pressed) const {
    const double past =
        std::max(along - bevel.at.path_end, bevel.at.path_begin - along + shut) * steps_per_arc;
    if (!(past > 1)) return false;
    return least_gap[static_cast<std::size_t>(std::min(past, kSteps - 1.0))] > pressed;
  }

  template <class Use>
  void each_pair(double theta, int flank, const Use& use) const;
  Contact contact(double along, double shaft_speed, const ToothLag& lag, int flank,
                  double offset) const;
  void press(Contact& c, bool dissipation) const;
};

// A pair of flanks +1, or the mirror image of one of flanks -1; vectors in (u, n, m) of Bevel.
struct BevelTeeth::Contact {
  enum class Place { inside, shaft_tip, block_tip } place = Place::inside;
  closed_form::Corner corner;
  double shaft_arc = 0, block_arc = 0;  // rad, of the points of both flanks from base circles
  double middle = 0;                    // rad, arc from O4 on the great circle, before its turn
  double approach = 0;                  // A, m
  double rate = 0;                      // per distance from O2, rad/s
  double force = 0, moment = 0;         // int f dr, int r f dr

  // What the plane of action's vectors are at the contact.
  Vector placed(const closed_form::Bevel& bevel, Vector v) const {
    if (place == Place::inside) return v;
    v = bevel.turned(v, corner);
    // Half a turn about u0 changes shaft and block; force and moment are then on the other.
    if (place == Place::block_tip) v = {v.x, -v.y, -v.z};
    return v;
  }
  Vector point(const closed_form::Bevel& bevel) const {
    return placed(bevel, {std::cos(middle), std::sin(middle), 0});
  }
  Vector direction(const closed_form::Bevel& bevel) const {
    const double side = place == Place::block_tip ? -1 : 1;
    return placed(bevel, {-side * std::sin(middle), side * std::cos(middle), 0});
  }
  Vector moment_direction(const closed_form::Bevel& bevel) const {
    return placed(bevel, {0, 0, place == Place::block_tip ? -1.0 : 1.0});
  }
};

BevelTeeth::Numbers::Numbers(const PumpParameters& pump)
    : bevel(closed_form::bevel(pump)),
      law(pump.gear, bevel.at.pitch_cone),
      flexibility(flexibility_by_arc(law, bevel)) {
  const double step = bevel.pitch / 32;
  for (int i = 0; i < kSteps; ++i) least_gap[i] = bevel.at.distance * bevel.corner(step * i).gap;
  steps_per_arc = 1 / (step * bevel.sin_base);
  const ToothData& teeth = *pump.gear.teeth;
  count = teeth.count;
  pitches_per_radian = count / (2 * kPi);
  half_width = teeth.face_width / 2 / bevel.at.distance;
  crowning = teeth.lead_crowning;
  dissipation = teeth.dissipation;
  relief = teeth.tip_relief;
  relief_height = teeth.relief_height;
  for (int flank = 0; flank < 2; ++flank)
    for (int i = 0; i < count; ++i)
      offset[flank].push_back(
          -teeth.backlash / 2 - lack(teeth.shaft, i, count, flank == 0 ? 1 : -1) -
          lack(teeth.block, flank == 0 ? wrapped(i - 1, count) : i, count, flank == 0 ? -1 : 1));
  block_axis_y = std::sin(pump.geometry.tilt);
  block_axis_z = std::cos(pump.geometry.tilt);
  stiffness = teeth.face_width / (2 * law.tooth(0) + law.contact());
}

// Where a pair touches, whose shaft's flank is at this arc from O4, were there no tips.
BevelTeeth::Contact BevelTeeth::Numbers::contact(double along, double shaft_speed,
                                                 const ToothLag& lag, int flank,
                                                 double pair_offset) const {
  const double sb = bevel.sin_base;
  const double shut = flank * sb * lag.angle;
  const double mate = along - shut;  // the block's flank
  const double block_speed = shaft_speed - lag.rate;
  Contact c;
  double pressed = shut;
  double arc = 0;
  double mate_arc = 0;
  if (along > bevel.at.path_end || mate < bevel.at.path_begin) {
    const bool shaft = along > bevel.at.path_end;
    c.place = shaft ? Contact::Place::shaft_tip : Contact::Place::block_tip;
    c.corner = bevel.corner((shaft ? along - bevel.at.path_end : bevel.at.path_begin - mate) / sb);
    pressed -= c.corner.gap;
    arc = bevel.tip_roll;
    mate_arc = c.corner.arc + pressed;
    if (!shaft) std::swap(arc, mate_arc);
    c.middle = bevel.roll - c.corner.arc - pressed / 2;
    c.rate = flank * (shaft ? shaft_speed * c.corner.lever - block_speed * sb
                            : shaft_speed * sb - block_speed * c.corner.lever);
  } else {
    arc = bevel.roll + along;
    mate_arc = bevel.roll - mate;
    c.middle = (along + mate) / 2;
    c.rate = flank * sb * lag.rate;
  }
  c.approach = bevel.at.distance * pressed + pair_offset;
  c.shaft_arc = arc;
  c.block_arc = mate_arc;
  if (relief > 0) {
    c.approach -= relief_at(bevel.cone(arc)) + relief_at(bevel.cone(mate_arc));
  }
  return c;
}

// Along the face width x from -1 to 1 approach is a parabola and damping's factor linear: between
// their zeros the force is a polynomial that three points of Gauss integrate exactly.
void BevelTeeth::Numbers::press(Contact& c, bool dissipation_acts) const {
  const double a = c.approach;
  if (!(a > 0)) return;
  const double r0 = bevel.at.distance;
  double low = -1;
  double high = 1;
  if (crowning > 0) {
    const double root =
        a * half_width + std::sqrt(a * (a * half_width * half_width + 4 * crowning));
    low = std::max(low, -2 * a / root);
    high = std::min(high, root / (2 * crowning));
  }
  const double damping = dissipation_acts ? dissipation * c.rate * r0 : 0;
  if (damping < 0) high = std::min(high, (-1 / damping - 1) / half_width);
  if (!(high > low)) return;
  const double flexible = flexibility(c.shaft_arc) + flexibility(c.block_arc) + law.contact();
  constexpr double kPlaces[] = {-0.77459666924148337704, 0, 0.77459666924148337704};
  constexpr double kWeights[] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  const double middle = (low + high) / 2;
  const double half = (high - low) / 2;
  for (int i = 0; i < 3; ++i) {
    const double x = middle + half * kPlaces[i];
    const double r = 1 + half_width * x;
    const double f = kWeights[i] * (a * r - crowning * x * x) * (1 + damping * r);
    c.force += f;
    c.moment += r * f;
  }
  const double width = half * half_width * r0 / flexible;
  c.force *= width;
  c.moment *= width * r0;
}

template <class Use>
void BevelTeeth::Numbers::each_pair(double theta, int flank, const Use& use) const {
  constexpr double kHair = 1e-9;  // of a pitch: samples on the border belong to one side
  const double nearest = std::floor(theta * pitches_per_radian + 0.5 + kHair);
  const double past = std::fma(-nearest, bevel.pitch, theta) - nearest * bevel.pitch_rest;
  const auto tooth = static_cast<long long>(nearest);
  constexpr int kBefore[kPairsPerFlank] = {0, 1, -1};
  for (int which = 0; which < kPairsPerFlank; ++which) {
    const int i = wrapped(tooth - kBefore[which], count);
    const double turned = past + kBefore[which] * bevel.pitch;
    const double along = bevel.sin_base * (flank * turned + bevel.pitch / 4);
    use(which, i, along, offset[flank > 0 ? 0 : 1][i]);
  }
}

BevelTeeth::BevelTeeth(const PumpParameters& pump, Unchecked)
    : numbers_(std::make_shared<const Numbers>(pump)) {}

BevelTeeth::BevelTeeth(const PumpParameters& pump) : BevelTeeth(checked(pump), Unchecked{}) {}

const BevelGeometry& BevelTeeth::geometry() const { return numbers_->bevel.at; }

double BevelTeeth::stiffness() const { return numbers_->stiffness; }

double BevelTeeth::about_block_axis(const std::array<double, 3>& moment) const {
  return numbers_->block_axis_y * moment[1] + numbers_->block_axis_z * moment[2];
}

namespace {

// Flanks -1 are the mirror image in x; a moment's is turned round.
Vector mirrored(const Vector& v, int flank) { return {flank * v.x, v.y, v.z}; }

}  // namespace

TeethAction BevelTeeth::act(double theta, double shaft_speed, const ToothLag& lag,
                            bool dissipation) const {
  const Numbers& p = *numbers_;
  TeethAction action;
  action.lag = lag.angle;
  Vector force = {0, 0, 0};
  Vector moment = {0, 0, 0};
  for (const int flank : {1, -1}) {
    p.each_pair(theta, flank, [&](int which, int tooth, double along, double offset) {
      Contact c = p.contact(along, shaft_speed, lag, flank, offset);
      p.press(c, dissipation);
      PairContact& pair = action.pairs[(flank > 0 ? 0 : kPairsPerFlank) + which];
      pair.flank = flank;
      pair.shaft_tooth = tooth + 1;
      pair.block_tooth = (flank > 0 ? wrapped(tooth - 1, p.count) : tooth) + 1;
      pair.approach = c.approach;
      pair.force = c.force;
      if (!(c.force > 0)) return;
      const Vector point = mirrored(p.bevel.to_s1(c.point(p.bevel)), flank);
      const Vector normal = mirrored(p.bevel.to_s1(c.direction(p.bevel)), flank);
      const Vector turns = mirrored(p.bevel.to_s1(c.moment_direction(p.bevel)), flank);
      pair.point = array(c.moment / c.force * point);
      pair.normal = array(normal);
      force = force + c.force * normal;
      moment = moment + flank * c.moment * turns;
    });
  }
  action.force = array(force);
  action.moment = array(moment);
  return action;
}

BevelTeeth::Wrench BevelTeeth::wrench(double theta, double shaft_speed, const ToothLag& lag,
                                      bool dissipation) const {
  const Numbers& p = *numbers_;
  Vector force = {0, 0, 0};
  Vector moment = {0, 0, 0};
  const double shut = p.bevel.sin_base * lag.angle;
  for (const int flank : {1, -1}) {
    Vector flank_force = {0, 0, 0};
    Vector flank_moment = {0, 0, 0};
    p.each_pair(theta, flank, [&](int, int, double along, double offset) {
      const double pressed = flank * shut * p.bevel.at.distance + offset;
      if (!(pressed > 0) || p.beyond_reach(along, flank * shut, pressed)) return;
      Contact c = p.contact(along, shaft_speed, lag, flank, offset);
      p.press(c, dissipation);
      if (!(c.force > 0)) return;
      flank_force = flank_force + c.force * c.direction(p.bevel);
      flank_moment = flank_moment + c.moment * c.moment_direction(p.bevel);
    });
    force = force + mirrored(p.bevel.to_s1(flank_force), flank);
    moment = moment + flank * mirrored(p.bevel.to_s1(flank_moment), flank);
  }
  return {array(force), array(moment)};
}

BevelTeeth::Approach BevelTeeth::approach(double theta, double shaft_speed, const ToothLag& lag,
                                          int flank) const {
  const Numbers& p = *numbers_;
  Approach largest = {-std::numeric_limits<double>::infinity(), 0};
  p.each_pair(theta, flank, [&](int, int, double along, double offset) {
    const Contact c = p.contact(along, shaft_speed, lag, flank, offset);
    // Of the slices that whose parabola is highest.
    const double slope = c.approach * p.half_width;
    const double x =
        std::abs(slope) < 2 * p.crowning ? slope / (2 * p.crowning) : std::copysign(1.0, slope);
    const double r = 1 + p.half_width * x;
    const double distance = c.approach * r - p.crowning * x * x;
    if (distance > largest.distance) largest = {distance, c.rate * p.bevel.at.distance * r};
  });
  return largest;
}

ToothLag BevelTeeth::rest(double theta, double torque) const {
  const Numbers& p = *numbers_;
  const double arm = p.bevel.at.distance * p.bevel.sin_base;
  const auto excess = [&](double lag) {
    return about_block_axis(wrench(theta, 0, {lag, 0}, false).moment) - torque;
  };
  // The lag at which the first pair of a flank touches. Without tips its approach is arm times the
  // lag; the tips' part changes slowly.
  const auto touch = [&](int flank) {
    double lag = 0;
    for (int i = 0; i < 100; ++i) {
      double largest = -std::numeric_limits<double>::infinity();
      p.each_pair(theta, flank, [&](int, int, double along, double offset) {
        largest = std::max(largest, p.contact(along, 0, {lag, 0}, flank, offset).approach);
      });
      const double next = lag - flank * largest / arm;
      const bool settled =
          std::abs(next - lag) <= std::numeric_limits<double>::epsilon() * std::abs(lag);
      lag = next;
      if (settled) break;
    }
    return lag;
  };
  constexpr double kNoTorque = 1e-9;  // Nm: what rounding leaves of nothing
  if (std::abs(torque) <= kNoTorque) torque = 0;
  const double stiffness = p.stiffness * arm * arm;
  const int side = torque < 0 ? -1 : 1;
  double near = touch(side);
  double near_excess = excess(near);
  if (side * near_excess >= 0) return {near, 0};
  constexpr double kMax = 0.1;  // rad
  double step = std::clamp(std::abs(near_excess) / stiffness, 1e-9, kMax);
  double far = near + side * step;
  double far_excess = excess(far);
  while (side * far_excess < 0) {
    near = far;
    near_excess = far_excess;
    step *= 2;
    if (step > kMax)
      throw ComputationError("analytic model: no lag of the teeth transmits a torque of " +
                             rounded_text(torque) +
                             " Nm at theta = " + rounded_text(theta / kRadPerDegree) + " deg");
    far = near + side * step;
    far_excess = excess(far);
  }
  if (far_excess == 0) return {far, 0};
  std::uintmax_t evaluations = 200;
  double low = near, high = far, low_value = near_excess, high_value = far_excess;
  if (low > high) {
    std::swap(low, high);
    std::swap(low_value, high_value);
  }
  const auto [from, to] = boost::math::tools::toms748_solve(
      excess, low, high, low_value, high_value,
      [](double a, double b) {
        return std::abs(a - b) <=
               std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
      },
      evaluations);
  return {std::abs(excess(from)) < std::abs(excess(to)) ? from : to, 0};
}

}  // namespace bentaxis::analytic
