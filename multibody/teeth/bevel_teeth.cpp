#include "teeth/bevel_teeth.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::Rotation;
using SimTK::Vec3;

namespace {

constexpr int kMaxIterations = 60;
constexpr double kLongestStep = 0.3;  // rad of roll, of Newton's method
constexpr double kRollRoundOff = 4e-16;
// What a search may leave over where rounding ends it.
constexpr double kFound = 1e-10;
// Nm: presses teeth of metal by less than the rounding of a length.
constexpr double kNoTorque = 1e-9;
// Of an angle in tooth pitches: below it a tooth counts as at its next place.
constexpr double kSamePlace = 1e-9;

// A frame by two of its axes, where z2 = y: (x, y, z) with x = y cross z.
Rotation frame_of(const Vec3& y, const Vec3& z) {
  return Rotation(SimTK::UnitVec3(z), SimTK::ZAxis, y, SimTK::YAxis);
}

Vec3 mirrored(const Vec3& v) { return {-v[0], v[1], v[2]}; }

std::array<double, 3> array_of(const Vec3& v) { return {v[0], v[1], v[2]}; }

const ToothData& teeth_of(const Gear& gear) {
  if (!gear.teeth) throw InputError("[gear] contact = \"teeth\" needs tooth_number, face_width_mm");
  return *gear.teeth;
}

std::string mm(double metres) { return number_text(metres * 1e3); }

}  // namespace

// Two flanks that face each other, and what of it does not change over the face width.
struct BevelTeeth::Pair {
  PairContact contact;  // numbers, approach; point is a direction here
  bool found = false;
  Vec3 direction;        // from O2
  Vec3 normal;           // of the force on the block
  double give = 0;       // m/(N/m), of a slice
  double curvature = 0;  // m, lead crowning at both ends
};

// What all slices of a pair do together.
struct BevelTeeth::Slices {
  double force = 0;   // N
  double moment = 0;  // Nm, of the forces about O2, across direction and normal
};

// A point of a flank and its directions in S1.
struct BevelTeeth::Placed {
  Vec3 point, tangent, tangent_rate;
};

BevelTeeth::BevelTeeth(const PumpParameters& pump, FlankShape shape)
    : gear_(pump.gear),
      teeth_(teeth_of(pump.gear)),
      tilt_(pump.geometry.tilt),
      pitch_cone_(kPi / 2 - pump.geometry.tilt / 2),
      distance_(pump.gear.pitch_diameter / 2 / std::sin(pitch_cone_)),
      tip_cone_(pitch_cone_ + std::atan(teeth_.addendum / distance_)),
      pitch_angle_(2 * kPi / teeth_.count),
      block_axis_(0, std::sin(tilt_), std::cos(tilt_)),
      // Flanks that push towards +psi: the shaft's looks towards -x1, the block's towards +x1.
      shaft_frame_(frame_of(Vec3(1, 0, 0), Vec3(0, 0, -1))),
      block_frame_(frame_of(Vec3(-1, 0, 0), block_axis_)),
      curve_(flank_curve(shape, pitch_cone_, pump.gear.pressure_angle)) {
  if (!(tip_cone_ < kPi - curve_->at(curve_->first_roll()).polar_angle()))
    throw InputError("[gear] addendum_mm = " + mm(teeth_.addendum) +
                     ": the tips are outside the range of flanks of this shape");
  tip_roll_ = curve_->roll_at(tip_cone_);
  refuse_what_does_not_mesh();
  flexibility_.emplace(pump.gear, pitch_cone_);
}

double BevelTeeth::contact_ratio() const { return 2 * tip_roll_ / pitch_angle_; }

void BevelTeeth::refuse_what_does_not_mesh() const {
  const auto refuse = [](const std::string& what) { throw InputError("[gear] " + what); };
  if (!(distance_ - teeth_.face_width / 2 > 0))
    refuse("face_width_mm = " + mm(teeth_.face_width) + ": reaches O2, must be below twice " +
           mm(distance_));
  if (teeth_.dedendum <= teeth_.addendum)
    refuse("dedendum_mm = " + mm(teeth_.dedendum) +
           ": no clearance, must be above addendum_mm = " + mm(teeth_.addendum));
  const std::string tip = "addendum_mm = " + mm(teeth_.addendum) + ": ";
  const std::string number = "tooth_number = " + std::to_string(teeth_.count) + ": ";
  if (tip_roll_ > -curve_->first_roll())
    refuse(tip + "tip interference, tips reach past the start of the mate's flanks");
  const Vec3 edge = curve_->at(tip_roll_).point;
  if (std::atan2(edge[1], edge[0]) >= pitch_angle_ / 4) refuse(tip + "pointed tips");
  if (contact_ratio() < 1)
    refuse(number + "contact ratio " + number_text(contact_ratio()) + ", must be at least 1");
  if (contact_ratio() > kLargestContactRatio)
    refuse(number + "contact ratio " + number_text(contact_ratio()) + ", must be at most " +
           number_text(kLargestContactRatio));
}

BevelTeeth::Placed BevelTeeth::place(const Rotation& frame, double azimuth, double roll) const {
  const FlankPoint local = curve_->at(roll);
  const double s = std::sin(azimuth), c = std::cos(azimuth);
  const auto turned = [&](const Vec3& v) {
    return Vec3(frame * Vec3(c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]));
  };
  return {turned(local.point), turned(local.tangent), turned(local.tangent_rate)};
}

BevelTeeth::Placed BevelTeeth::on_shaft(double shaft_ahead, double roll) const {
  return place(shaft_frame_, -shaft_ahead, roll);  // ahead is towards -x1, -y of the frame
}

BevelTeeth::Placed BevelTeeth::on_block(double block_ahead, double roll) const {
  return place(block_frame_, block_ahead, roll);  // towards -x1, +y of the frame
}

// The great circle that is normal to a flank has the flank's tangent as pole. Two flanks have one
// in common where the tangents are opposite: two equations for both rolls, whose matrix is regular
// unless the flanks are bent alike, however near to each other they are.
bool BevelTeeth::regular(double shaft_ahead, double block_ahead, Touch& touch) const {
  double last = std::numeric_limits<double>::infinity();
  while (touch.iterations < kMaxIterations) {
    ++touch.iterations;
    const Placed a = on_shaft(shaft_ahead, touch.shaft_roll);
    const Placed b = on_block(block_ahead, touch.block_roll);
    const Vec3 across = a.tangent % a.point;
    const Vec3 off = a.tangent + b.tangent;
    const double e1 = dot(off, a.point), e2 = dot(off, across);
    const double m11 = dot(a.tangent_rate, a.point), m12 = dot(b.tangent_rate, a.point);
    const double m21 = dot(a.tangent_rate, across), m22 = dot(b.tangent_rate, across);
    const double determinant = m11 * m22 - m12 * m21;
    if (determinant == 0) return false;
    double da = (m12 * e2 - m22 * e1) / determinant;
    double db = (m21 * e1 - m11 * e2) / determinant;
    const double step = std::max(std::abs(da), std::abs(db));
    if (!std::isfinite(step)) return false;
    const double share = std::min(1.0, kLongestStep / step);
    touch.shaft_roll += share * da;
    touch.block_roll += share * db;
    // Tangents that are alike, not opposite, are no root: there `off` is twice the tangent.
    if (step <= kRollRoundOff || (step < kFound && step >= last / 2))
      return dot(a.tangent, b.tangent) < 0;
    last = step;
  }
  return false;
}

// Roll of the flank's point whose normal passes through a tip of the mate. There are two: the tip
// is in front of one and behind the other, nearer to the root. Beyond the path the search may slip
// to that one; from the flank's own tip it comes down to the one in front.
template <class Flank>
bool BevelTeeth::foot(const Vec3& tip, const Flank& flank, double& roll) const {
  return foot_from(roll, tip, flank, roll) || foot_from(tip_roll_, tip, flank, roll);
}

template <class Flank>
bool BevelTeeth::foot_from(double start, const Vec3& tip, const Flank& flank, double& roll) const {
  double last = std::numeric_limits<double>::infinity();
  double at_roll = start;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Placed at = flank(at_roll);
    const double slope = dot(at.tangent_rate, tip);
    const double step = -dot(at.tangent, tip) / slope;
    if (!std::isfinite(step)) return false;
    at_roll += std::clamp(step, -kLongestStep, kLongestStep);
    if (std::abs(step) <= kRollRoundOff ||
        (std::abs(step) < kFound && std::abs(step) >= last / 2)) {
      if (!(slope < 0)) return false;
      roll = at_roll;
      return true;
    }
    last = std::abs(step);
  }
  return false;
}

Touch BevelTeeth::touch(double shaft_ahead, double block_ahead,
                        std::optional<TouchGuess> guess) const {
  Touch touch;
  touch.shaft_roll = guess ? guess->shaft_roll : shaft_ahead;
  touch.block_roll = guess ? guess->block_roll : -block_ahead;
  if (!regular(shaft_ahead, block_ahead, touch)) return touch;
  const bool shaft_over = touch.shaft_roll > tip_roll_;
  const bool block_over = touch.block_roll > tip_roll_;
  if (shaft_over && block_over) return touch;
  touch.at_tip = shaft_over || block_over;
  if (shaft_over) {
    touch.shaft_roll = tip_roll_;
    touch.found = foot(
        on_shaft(shaft_ahead, tip_roll_).point,
        [&](double roll) { return on_block(block_ahead, roll); }, touch.block_roll);
  } else if (block_over) {
    touch.block_roll = tip_roll_;
    touch.found = foot(
        on_block(block_ahead, tip_roll_).point,
        [&](double roll) { return on_shaft(shaft_ahead, roll); }, touch.shaft_roll);
  } else {
    touch.found = true;
  }
  if (!touch.found) return touch;
  const Placed a = on_shaft(shaft_ahead, touch.shaft_roll);
  const Placed b = on_block(block_ahead, touch.block_roll);
  touch.point = (a.point + b.point).normalize();
  // The flank that is not held at its tip says where the normal lies.
  const Vec3 pole = shaft_over ? Vec3(-b.tangent) : a.tangent;
  touch.normal = (pole % touch.point).normalize();
  touch.pressed_in = 2 * std::asin(std::clamp(dot(a.point - b.point, touch.normal) / 2, -1.0, 1.0));
  touch.shaft_angle = curve_->at(touch.shaft_roll).polar_angle();
  touch.block_angle = curve_->at(touch.block_roll).polar_angle();
  return touch;
}

BevelTeeth::Pair BevelTeeth::pair(double theta, double lag, int flank, int which) const {
  constexpr int kAside[] = {0, -1, 1};
  const double reduced = std::remainder(theta, 2 * kPi);
  const int z = teeth_.count;
  const int index =
      static_cast<int>(std::floor(reduced * z / (2 * kPi) + 0.5 + kSamePlace)) + kAside[which];
  const auto cyclic = [z](int i) { return (i % z + z) % z; };
  Pair pair;
  const int shaft = cyclic(index);
  const int block = cyclic(flank > 0 ? index - 1 : index);
  pair.contact.flank = flank;
  pair.contact.shaft_tooth = shaft + 1;
  pair.contact.block_tooth = block + 1;
  // The flank that pushes towards -psi is the other's image in a mirror, which reverses turns.
  const double shaft_ahead = flank * (reduced - index * pitch_angle_) + pitch_angle_ / 4;
  const double block_ahead = shaft_ahead - flank * lag;
  const Touch touch = this->touch(shaft_ahead, block_ahead);
  pair.found = touch.found;
  if (!touch.found) {
    pair.contact.approach = -distance_;
    return pair;
  }
  pair.direction = flank > 0 ? touch.point : mirrored(touch.point);
  pair.normal = flank > 0 ? touch.normal : mirrored(touch.normal);
  const auto pitch_error = [](const ToothErrors& errors, int tooth) {
    return errors.pitch.empty() ? 0.0 : errors.pitch[static_cast<std::size_t>(tooth)];
  };
  const auto runout = [&](const ToothErrors& errors, int tooth) {
    return errors.runout * std::cos(tooth * pitch_angle_ - errors.runout_angle);
  };
  const auto relief = [&](double polar_angle) {
    const double down = distance_ * (tip_cone_ - polar_angle);
    if (teeth_.tip_relief == 0 || !(down < teeth_.relief_height)) return 0.0;
    const double share = 1 - down / teeth_.relief_height;
    return teeth_.tip_relief * share * share;
  };
  pair.contact.approach =
      distance_ * touch.pressed_in - teeth_.backlash / 2 +
      flank * (pitch_error(teeth_.shaft, shaft) - pitch_error(teeth_.block, block)) -
      runout(teeth_.shaft, shaft) - runout(teeth_.block, block) - relief(touch.shaft_angle) -
      relief(touch.block_angle);
  const auto height = [&](double polar_angle) { return distance_ * (polar_angle - pitch_cone_); };
  pair.give = flexibility_->tooth(height(touch.shaft_angle)) +
              flexibility_->tooth(height(touch.block_angle)) + flexibility_->contact();
  return pair;
}

// Of a slice, over its distance from O2.
double BevelTeeth::closing_per_length(const Pair& pair, double shaft_speed, double lag_rate) const {
  const Vec3 turning = (shaft_speed * (shaft_axis() - block_axis_)) + lag_rate * block_axis_;
  return dot(pair.normal, turning % pair.direction);
}

// Between its kinks (where slices begin to touch, where they leave too fast to push) force per
// width is a cubic in the distance from O2 and its moment one degree more: three points are exact.
BevelTeeth::Slices BevelTeeth::press(const Pair& pair, double closing_per_length,
                                     double dissipation) const {
  static constexpr double kNode = 0.77459666924148337704;
  static constexpr double kNodes[] = {-kNode, 0, kNode}, kWeights[] = {5 / 9., 8 / 9., 5 / 9.};
  Slices sum;
  if (!pair.found) return sum;
  const double half = teeth_.face_width / 2;
  const double inner = distance_ - half, outer = distance_ + half;
  const double per_length = pair.contact.approach / distance_;
  const double crown = teeth_.lead_crowning / (half * half);
  std::array<double, 5> ends = {inner, outer};
  int count = 2;
  const auto kink = [&](double r) {
    if (r > inner && r < outer) ends[count++] = r;
  };
  if (crown > 0) {
    // per_length r = crown (r - R)^2
    const double b = distance_ + per_length / (2 * crown);
    const double inside = b * b - distance_ * distance_;
    if (inside > 0) {
      const double far = b + std::copysign(std::sqrt(inside), b);
      kink(far);
      kink(distance_ * distance_ / far);
    }
  } else if (!(per_length > 0)) {
    return sum;
  }
  const double damping = dissipation * closing_per_length;
  if (damping < 0) kink(-1 / damping);
  std::sort(ends.begin(), ends.begin() + count);
  for (int i = 0; i + 1 < count; ++i) {
    const double middle = (ends[i] + ends[i + 1]) / 2, reach = (ends[i + 1] - ends[i]) / 2;
    for (int node = 0; node < 3; ++node) {
      const double r = middle + reach * kNodes[node];
      const double in = per_length * r - crown * (r - distance_) * (r - distance_);
      const double push = std::max(0.0, in) / pair.give * std::max(0.0, 1 + damping * r);
      sum.force += kWeights[node] * reach * push;
      sum.moment += kWeights[node] * reach * push * r;
    }
  }
  return sum;
}

TeethAction BevelTeeth::act(double theta, double shaft_speed, const ToothLag& lag,
                            bool dissipation) const {
  TeethAction action;
  action.lag = lag.angle;
  Vec3 force(0), moment(0);
  std::size_t next = 0;
  for (const int flank : {1, -1})
    for (int which = 0; which < kPairsPerFlank; ++which) {
      const Pair pair = this->pair(theta, lag.angle, flank, which);
      PairContact& contact = action.pairs[next++];
      contact = pair.contact;
      if (!pair.found) continue;
      const Slices sum = press(pair, closing_per_length(pair, shaft_speed, lag.rate),
                               dissipation ? teeth_.dissipation : 0);
      contact.force = sum.force;
      contact.normal = array_of(pair.normal);
      if (!(sum.force > 0)) continue;
      contact.point = array_of(sum.moment / sum.force * pair.direction);
      force += sum.force * pair.normal;
      moment += sum.moment * (pair.direction % pair.normal);
    }
  action.force = array_of(force);
  action.moment = array_of(moment);
  return action;
}

double BevelTeeth::torque_on_block(const TeethAction& action) const {
  return dot(vector_of(action.moment), block_axis_);
}

double BevelTeeth::torque_on_shaft(const TeethAction& action) const {
  return -dot(vector_of(action.moment), shaft_axis());
}

double BevelTeeth::largest_approach(double theta, double lag, int flank) const {
  double largest = -distance_;
  for (int which = 0; which < kPairsPerFlank; ++which)
    largest = std::max(largest, pair(theta, lag, flank, which).contact.approach);
  return largest;
}

BevelTeeth::Closing BevelTeeth::closing(double theta, double shaft_speed, const ToothLag& lag,
                                        int flank) const {
  const double half = teeth_.face_width / 2;
  Closing closing{-std::numeric_limits<double>::infinity(), 0};
  for (int which = 0; which < kPairsPerFlank; ++which) {
    const Pair pair = this->pair(theta, lag.angle, flank, which);
    const double per_length = pair.contact.approach / distance_;
    double r = per_length < 0 ? distance_ - half : distance_ + half;
    if (teeth_.lead_crowning > 0) {
      const double crown = teeth_.lead_crowning / (half * half);
      r = std::clamp(distance_ + per_length / (2 * crown), distance_ - half, distance_ + half);
    }
    const double aside = (r - distance_) / half;
    const double approach = per_length * r - teeth_.lead_crowning * aside * aside;
    if (!(approach > closing.approach)) continue;
    closing.approach = approach;
    closing.rate = pair.found ? r * closing_per_length(pair, shaft_speed, lag.rate) : 0;
  }
  return closing;
}

ToothLag BevelTeeth::rest(double theta, double torque_on_block) const {
  if (std::abs(torque_on_block) <= kNoTorque) {
    // Flank +1 just touches, unless the other presses there: teeth of unequal pitch.
    const double lag = root(theta, 1, 0, [&](double at) { return largest_approach(theta, at, 1); });
    if (this->torque_on_block(act(theta, 0, {lag, 0}, false)) >= -kNoTorque) return {lag, 0};
    torque_on_block = 0;
  }
  return {root(theta, torque_on_block < 0 ? -1 : 1, torque_on_block,
               [&](double lag) {
                 return this->torque_on_block(act(theta, 0, {lag, 0}, false)) - torque_on_block;
               }),
          0};
}

// Where a function of the lag that grows with it is 0.
template <class Excess>
double BevelTeeth::root(double theta, int flank, double torque_on_block,
                        const Excess& excess) const {
  constexpr double kFirstStep = 1e-6;
  const double arm = gear_.pitch_diameter / 2 * std::cos(gear_.pressure_angle);
  double low = flank * teeth_.backlash / 2 / arm;
  double high = low;
  double at_low = excess(low), at_high = at_low;
  for (double step = kFirstStep; at_high < 0 || at_low > 0; step *= 2) {
    if (step > pitch_angle_)
      throw ComputationError("multibody model: no lag of the teeth transmits " +
                             number_text(torque_on_block) +
                             " Nm at theta = " + number_text(theta / kRadPerDegree) + " deg");
    if (at_high < 0) {
      low = high;
      at_low = at_high;
      at_high = excess(high += step);
    } else {
      high = low;
      at_high = at_low;
      at_low = excess(low -= step);
    }
  }
  if (at_low == 0) return low;
  if (at_high == 0) return high;
  std::uintmax_t most = 200;
  const auto bracket = boost::math::tools::toms748_solve(
      excess, low, high, at_low, at_high, boost::math::tools::eps_tolerance<double>(52), most);
  return (bracket.first + bracket.second) / 2;
}

}  // namespace bentaxis::multibody
