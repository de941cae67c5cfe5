// Bevel teeth in closed form: against curves and searches of their own, and what must hold.
#include "bentaxis/analytic/teeth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>

#include "allocations.h"
#include "bentaxis/analytic/batch.h"
#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/rounding.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/analytic/validity.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/tooth_flexibility.h"
#include "bentaxis/pump/units.h"
#include "closed_form/bevel.h"
#include "free_bodies.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using analytic::BevelGeometry;
using analytic::BevelTeeth;

using V = std::array<double, 3>;
V operator+(const V& a, const V& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
V operator-(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V operator*(double s, const V& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double size(const V& a) { return std::sqrt(dot(a, a)); }
V unit(const V& a) { return 1 / size(a) * a; }
V turned(const V& v, const V& axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
         (1 - std::cos(angle)) * dot(axis, v) * axis;
}
double angle_between(const V& a, const V& b) { return std::atan2(size(cross(a, b)), dot(a, b)); }

PumpParameters toothed() {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_teeth.toml").pump;
}

// Where the axes are, from the definition of the frames alone.
struct Gears {
  explicit Gears(const PumpParameters& pump) {
    const double a = pump.geometry.tilt;
    z2 = {0, std::sin(a), std::cos(a)};
    o4 = {0, pump.gear.pitch_diameter / 2, -pump.gear.pitch_diameter / 2 * std::tan(a / 2)};
    u0 = unit(o4);
    count = pump.gear.teeth->count;
    const double delta = angle_between(u0, z2);
    const double p = pump.gear.pressure_angle;
    base = std::asin(std::sin(delta) * std::cos(p));
    tip = delta + std::atan(pump.gear.teeth->addendum / size(o4));
    n0 = {-std::cos(p), std::sin(p) * std::cos(delta), std::sin(p) * std::sin(delta)};
  }
  V z1 = {0, 0, 1}, z2, o4, u0, n0;
  int count = 0;
  double base = 0, tip = 0;

  // A taut arc that is unwound from the base circle of an axis by `roll`: the point it leaves at
  // the azimuth 0 of `from`, wound in the sense `sense` about the axis.
  V involute(const V& axis, const V& from, int sense, double roll) const {
    const V pole = axis;
    const V across = unit(from - dot(from, pole) * pole);
    const V start = std::cos(base) * pole + std::sin(base) * across;
    const V touching = turned(start, pole, sense * roll);
    const V tangent = sense * cross(pole, unit(touching - dot(touching, pole) * pole));
    const double arc = roll * std::sin(base);
    return std::cos(arc) * touching - std::sin(arc) * tangent;
  }
};

// The flank +1 of a tooth, on the unit sphere: the involute that has the tooth's middle a quarter
// of a pitch away from where it crosses the pitch cone.
struct Curve {
  const Gears* gears = nullptr;
  V axis, from;
  int sense = 1;
  double last = 0;  // roll at the tip

  V at(double roll) const { return gears->involute(axis, from, sense, roll); }
};

// axis: points into the cone; spin: about it, of the flank's azimuth at the pitch cone from O4.
Curve flank(const Gears& gears, const V& axis, double spin, int sense) {
  Curve curve{&gears, axis, gears.u0, sense, 0};
  const auto roll_of = [&](double cone) {
    double low = 0, high = kPi / std::sin(gears.base) / 2;
    for (int i = 0; i < 200; ++i) {
      const double middle = (low + high) / 2;
      (angle_between(curve.at(middle), axis) < cone ? low : high) = middle;
    }
    return low;
  };
  const V crossing = curve.at(roll_of(angle_between(gears.u0, axis)));
  const V x = unit(gears.u0 - dot(gears.u0, axis) * axis);
  const double azimuth = std::atan2(dot(crossing, cross(axis, x)), dot(crossing, x));
  curve.last = roll_of(gears.tip);
  curve.from = turned(gears.u0, axis, spin - azimuth);
  return curve;
}

// Where a function of one minimum has it.
template <class Function>
double lowest(double low, double high, const Function& f) {
  const double golden = (std::sqrt(5.0) - 1) / 2;
  double x = high - golden * (high - low), y = low + golden * (high - low);
  double fx = f(x), fy = f(y);
  for (int i = 0; i < 70; ++i) {
    if (fx < fy) {
      high = y, y = x, fy = fx;
      x = high - golden * (high - low), fx = f(x);
    } else {
      low = x, x = y, fx = fy;
      y = low + golden * (high - low), fy = f(y);
    }
  }
  return (low + high) / 2;
}

// Smallest distance of two curves, ends and all.
double nearest(const Curve& a, const Curve& b, double* roll = nullptr) {
  const auto to_b = [&](double x) {
    const V p = a.at(x);
    const auto distance = [&](double y) { return angle_between(p, b.at(y)); };
    return std::min(distance(lowest(0, b.last, distance)), distance(b.last));
  };
  const double x = lowest(0, a.last, to_b);
  if (roll) *roll = x;
  return std::min(to_b(x), to_b(a.last));
}

// Flanks +1 at these angles: of the shaft's tooth 1 and of the block's last, towards +psi and -psi.
// The shaft turns about -z1 by -theta; its flank pushes towards -x, where the block's awaits it.
Curve shaft_flank(const Gears& gears, double theta) {
  return flank(gears, -1 * gears.z1, -(theta + kPi / 2 / gears.count), 1);
}
Curve block_flank(const Gears& gears, double psi) {
  return flank(gears, gears.z2, psi + kPi / 2 / gears.count, 1);
}

TEST(BevelGeometry, FlanksAreCurvesThatTouchOnThePathOfContact) {
  // At theta = psi the curves of a pair touch, at a point of the great circle through O4.
  const PumpParameters pump = toothed();
  const Gears gears(pump);
  const BevelGeometry geometry = BevelTeeth(pump).geometry();
  for (const double share : {-0.9, -0.3, 0.0, 0.4, 0.9}) {
    const double phi = share * geometry.path_end;
    const double theta = phi / std::sin(gears.base) - kPi / 2 / gears.count;
    double roll = 0;
    const Curve shaft = shaft_flank(gears, theta);
    EXPECT_LT(nearest(shaft, block_flank(gears, theta), &roll), 1e-9) << share;
    const V point = shaft.at(roll);
    EXPECT_NEAR(dot(point, cross(gears.u0, gears.n0)), 0, 1e-5) << share;
    EXPECT_NEAR(angle_between(point, gears.u0), std::abs(phi), 1e-5) << share;
  }
}

TEST(BevelGeometry, GapsOfPairsAreTheDistancesOfTheirCurves) {
  // With a gap of some micrometres, within the path of contact and well beyond its ends, where a
  // tip's edge is nearest to the mate's flank.
  PumpParameters pump = toothed();
  pump.gear.teeth->backlash = 0;
  const Gears gears(pump);
  const BevelTeeth teeth(pump);
  const BevelGeometry& g = teeth.geometry();
  const double lag = -2e-4;
  int corners = 0;
  for (const double share : {-1.35, -1.2, -1.05, -0.9, -0.4, 0.0, 0.5, 0.95, 1.05, 1.2, 1.5}) {
    const double theta = share * g.path_end / std::sin(gears.base) - kPi / 2 / gears.count;
    const double gap = nearest(shaft_flank(gears, theta), block_flank(gears, theta - lag));
    const TeethAction action = teeth.act(theta, 0, {lag, 0});
    const PairContact* pair = nullptr;
    for (const PairContact& p : action.pairs)
      if (p.flank == 1 && p.shaft_tooth == 1) pair = &p;
    ASSERT_NE(pair, nullptr) << share;
    EXPECT_EQ(pair->block_tooth, gears.count);
    EXPECT_NEAR(pair->approach / g.distance, -gap, 1e-9) << share;
    if (std::abs(share) > 1) {
      ++corners;
      EXPECT_LT(pair->approach, g.distance * std::sin(gears.base) * lag * (1 + 1e-3));
    }
  }
  EXPECT_GE(corners, 6);
}

TEST(BevelGeometry, ContactRatioIsThatOfASearchForTheTips) {
  for (const double tilt : {15.0, 40.0, 60.0}) {
    PumpParameters pump = toothed();
    pump.geometry.tilt = radians(tilt);
    const Gears gears(pump);
    // How far the path can be followed until the distance from the shaft's axis is the tip's.
    double low = 0, high = 1;
    for (int i = 0; i < 200; ++i) {
      const double phi = (low + high) / 2;
      const V point = std::cos(phi) * gears.u0 + std::sin(phi) * gears.n0;
      (angle_between(point, -1 * gears.z1) < gears.tip ? low : high) = phi;
    }
    analytic::closed_form::Bevel shape = analytic::closed_form::bevel(pump);
    EXPECT_NEAR(shape.at.path_end, low, 1e-14) << tilt;
    EXPECT_NEAR(shape.at.contact_ratio, 2 * low / (2 * kPi / gears.count * std::sin(gears.base)),
                1e-12)
        << tilt;
    EXPECT_EQ(shape.at.path_begin, -shape.at.path_end);
  }
}

TEST(BevelGeometry, GapsOfAnyShapeAreTheDistancesOfItsCurves) {
  std::mt19937 random(20261122);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int accepted = 0, refused = 0;
  while (accepted < 100 && refused < 4000) {
    PumpParameters pump = toothed();
    ToothData& t = *pump.gear.teeth;
    pump.geometry.tilt = radians(draw(8, 80));
    pump.gear.pressure_angle = radians(draw(12, 32));
    t.count = static_cast<int>(draw(9, 70));
    t.backlash = 0;
    t.addendum = draw(0.6, 1.2) * pump.gear.pitch_diameter / t.count;
    t.dedendum = 1.2 * t.addendum;
    const Gears gears(pump);
    analytic::closed_form::Bevel shape = analytic::closed_form::bevel(pump);
    try {
      analytic::closed_form::require_mesh(pump.gear, shape);
    } catch (const InputError&) {
      ++refused;
      continue;
    }
    ++accepted;
    std::optional<BevelTeeth> teeth;
    try {
      teeth.emplace(pump);
    } catch (const InputError&) {
      continue;  // a rack cuts no such tooth: the law of its flexibility says so
    }
    const double lag = -1e-4;
    for (const double share : {-1.15, -1.02, 0.3, 1.05, 1.2}) {
      const double quarter = kPi / 2 / gears.count;
      const double theta = share * shape.at.path_end / std::sin(gears.base) - quarter;
      if (theta + quarter <= -4.9 * quarter) continue;  // no longer looked at
      const double gap = nearest(shaft_flank(gears, theta), block_flank(gears, theta - lag));
      for (const PairContact& pair : teeth->act(theta, 0, {lag, 0}).pairs)
        if (pair.flank == 1 && pair.shaft_tooth == 1) {
          EXPECT_NEAR(pair.approach / shape.at.distance, -gap, 1e-10)
              << share << ": Z " << gears.count << ", tilt " << pump.geometry.tilt << ", ap "
              << pump.gear.pressure_angle << ", addendum " << t.addendum;
        }
    }
  }
  EXPECT_EQ(accepted, 100);
  EXPECT_GT(refused, 3);
}

TEST(BevelGeometry, RefusesByName) {
  const auto refusal = [](const std::function<void(PumpParameters&)>& change) {
    PumpParameters pump = toothed();
    change(pump);
    try {
      const BevelTeeth teeth(pump);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  using testing::HasSubstr;
  using testing::StartsWith;
  EXPECT_EQ(refusal([](PumpParameters&) {}), "accepted");
  EXPECT_THAT(refusal([](PumpParameters& p) { p.gear.teeth.reset(); }), HasSubstr("contact"));
  EXPECT_THAT(refusal([](PumpParameters& p) { p.gear.contact = ToothContact::rigid; }),
              StartsWith("[gear] contact"));
  EXPECT_THAT(refusal([](PumpParameters& p) { p.gear.teeth->addendum = 1e-3; }),
              testing::AllOf(StartsWith("[gear] addendum_mm = 1: contact ratio"),
                             HasSubstr("must be >= 1")));
  EXPECT_THAT(refusal([](PumpParameters& p) {
                p.gear.teeth->count = 60;
                p.gear.teeth->addendum = 2e-3;
                p.gear.pressure_angle = radians(12.0);
              }),
              testing::AllOf(StartsWith("[gear] addendum_mm"), HasSubstr("must be <= 2.5")));
  EXPECT_THAT(refusal([](PumpParameters& p) {
                p.gear.pressure_angle = radians(5.0);
                p.geometry.tilt = radians(80.0);
              }),
              testing::AllOf(StartsWith("[gear] addendum_mm"), HasSubstr("interference")));
  // Before tips reach below the base cone a plane flank of a crown gear would undercut.
  EXPECT_THAT(refusal([](PumpParameters& p) {
                p.geometry.tilt = radians(88.0);
                p.gear.pressure_angle = radians(14.5);
                p.gear.teeth->addendum = 5.7e-3;
                p.gear.teeth->dedendum = 7e-3;
              }),
              testing::AllOf(StartsWith("[gear] addendum_mm"), HasSubstr("undercut")));
  EXPECT_THAT(refusal([](PumpParameters& p) {
                p.gear.pressure_angle = radians(35.0);
                p.gear.teeth->addendum = 6e-3;
                p.gear.teeth->dedendum = 7e-3;
              }),
              testing::AllOf(StartsWith("[gear] addendum_mm"), HasSubstr("pointed")));
  EXPECT_THAT(refusal([](PumpParameters& p) { p.gear.teeth->dedendum = p.gear.teeth->addendum; }),
              testing::AllOf(StartsWith("[gear] dedendum_mm"), HasSubstr("clearance")));
  EXPECT_THAT(refusal([](PumpParameters& p) { p.gear.teeth->face_width = 0.12; }),
              StartsWith("[gear] face_width_mm = 120"));
}

// What a refusal says would do is what does: on one side of it that reason is no longer given.
TEST(BevelGeometry, RefusalsNameTheLimit) {
  const auto refusal = [](const PumpParameters& pump) {
    try {
      analytic::closed_form::require_mesh(pump.gear, analytic::closed_form::bevel(pump));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto expect_limit = [&](PumpParameters pump, double ToothData::*length,
                                const std::string& reason, double inwards) {
    SCOPED_TRACE(reason);
    const std::string text = refusal(pump);
    ASSERT_THAT(text, testing::HasSubstr(reason));
    const auto below = text.rfind("be < ");  // what follows explains the limit
    const double limit =
        std::stod(text.substr(below != std::string::npos ? below + 5 : text.rfind(' '))) * 1e-3;
    (*pump.gear.teeth).*length = limit * (1 + inwards);
    EXPECT_THAT(refusal(pump), testing::Not(testing::HasSubstr(reason)));
    (*pump.gear.teeth).*length = limit * (1 - inwards);
    EXPECT_THAT(refusal(pump), testing::HasSubstr(reason));
  };
  constexpr double kNear = 0.01;  // limits have three digits
  PumpParameters pump = toothed();
  pump.gear.teeth->dedendum = 20e-3;
  pump.gear.teeth->addendum = 1e-3;
  expect_limit(pump, &ToothData::addendum, "must be >= 1", kNear);
  pump.gear.teeth->face_width = 0.12;
  expect_limit(pump, &ToothData::face_width, "face_width_mm", -kNear);
  pump = toothed();
  pump.gear.teeth->dedendum = 20e-3;
  pump.gear.teeth->count = 60;
  pump.gear.teeth->addendum = 2e-3;
  pump.gear.pressure_angle = radians(12.0);
  expect_limit(pump, &ToothData::addendum, "needs at most", -kNear);
  pump.gear.pressure_angle = radians(5.0);
  pump.geometry.tilt = radians(80.0);
  pump.gear.teeth->addendum = 4e-3;
  expect_limit(pump, &ToothData::addendum, "interference", -kNear);
  pump.geometry.tilt = radians(88.0);
  pump.gear.pressure_angle = radians(14.5);
  pump.gear.teeth->addendum = 5.7e-3;
  expect_limit(pump, &ToothData::addendum, "undercut", -kNear);
}

// The deepest place to which a crown gear's plane flank cuts a gear that rolls on its pitch plane
// without undercut: there the point of contact turns back on the flank of the gear.
TEST(BevelGeometry, UndercutBeginsWhereTheCutFlankTurnsBack) {
  PumpParameters pump = toothed();
  pump.geometry.tilt = radians(88.0);
  pump.gear.pressure_angle = radians(14.5);
  pump.gear.teeth->dedendum = 20e-3;
  const auto undercut = [&](double addendum) {
    pump.gear.teeth->addendum = addendum;
    try {
      analytic::closed_form::require_mesh(pump.gear, analytic::closed_form::bevel(pump));
    } catch (const InputError& error) {
      return std::string(error.what()).find("undercut") != std::string::npos;
    }
    return false;
  };
  double below = 4e-3, above = 5.7e-3;
  ASSERT_FALSE(undercut(below));
  ASSERT_TRUE(undercut(above));
  while (above - below > 1e-12)
    (undercut((below + above) / 2) ? above : below) = (below + above) / 2;

  // The crown gear turns about z, the gear about an axis at its pitch cone's angle from x, where
  // both touch; the flank is a plane through the middle of the sphere.
  const double pitch_cone = kPi / 2 - pump.geometry.tilt / 2, ap = pump.gear.pressure_angle;
  const V x = {1, 0, 0}, z = {0, 0, 1};
  const V axis = {std::cos(pitch_cone), 0, std::sin(pitch_cone)};
  const auto normal = [&](double turn) {
    return turned({0, std::cos(ap), -std::sin(ap)}, z, turn);
  };
  // Flanks touch where their common normal meets the axis about which one rolls on the other.
  const auto touch = [&](double turn) {
    const V n = normal(turn);
    return unit(x - dot(x, n) * n);
  };
  const auto on_gear = [&](const V& v, double turn) {
    return turned(v, axis, -turn / std::sin(pitch_cone));
  };
  const auto speed = [&](double turn) {  // along the gear's flank
    constexpr double kStep = 1e-5;
    const V moved =
        on_gear(touch(turn + kStep), turn + kStep) - on_gear(touch(turn - kStep), turn - kStep);
    return dot(moved, on_gear(cross(normal(turn), touch(turn)), turn)) / (2 * kStep);
  };
  double near = 0, far = 0;
  while (speed(far) * speed(0) > 0 && far > -kPi / 2) far -= 0.01;
  ASSERT_GT(far, -kPi / 2);
  while (near - far > 1e-10)
    (speed((near + far) / 2) * speed(0) > 0 ? near : far) = (near + far) / 2;
  const double distance = pump.gear.pitch_diameter / 2 / std::sin(pitch_cone);
  EXPECT_NEAR(std::atan(above / distance), std::asin(std::abs(dot(touch(far), z))), 1e-7);
}

// Teeth with all that they can have.
PumpParameters imperfect() {
  PumpParameters pump = toothed();
  ToothData& t = *pump.gear.teeth;
  t.tip_relief = 8e-6;
  t.lead_crowning = 5e-6;
  t.shaft.runout = 4e-6;
  t.shaft.runout_angle = 0.3;
  t.block.runout = 3e-6;
  t.block.runout_angle = 2.1;
  for (int i = 0; i < t.count; ++i) {
    t.shaft.pitch.push_back(3e-6 * std::sin(7.0 * i));
    t.block.pitch.push_back(2e-6 * std::cos(5.0 * i));
  }
  return pump;
}

constexpr double kAngles[] = {-4.321, -0.6, -0.05, 0.0, 0.013, 0.08,
                              0.1163, 0.15, 0.2,   1.0, 3.0,   12.34};
// Enough to have both flanks, one, none and corners in touch, rad.
constexpr double kLags[] = {-1.5e-3, -6e-4, 0.0, 5e-4, 8e-4, 2e-3};

TEST(BevelTeeth, SumsAreThoseOfThePairs) {
  const PumpParameters pump = imperfect();
  const BevelTeeth teeth(pump);
  const Gears gears(pump);
  int carrying = 0, corners = 0;
  for (const double theta : kAngles)
    for (const double angle : kLags) {
      const ToothLag lag = {angle, 0.2};
      const TeethAction action = teeth.act(theta, 150, lag);
      V force = {}, moment = {};
      for (const PairContact& pair : action.pairs) {
        if (!(pair.force > 0)) continue;
        ++carrying;
        EXPECT_NEAR(size(pair.normal), 1, 1e-14);
        EXPECT_NEAR(dot(pair.normal, pair.point), 0, 1e-15);
        force = force + pair.force * pair.normal;
        moment = moment + pair.force * cross(pair.point, pair.normal);
        // On the plane of action of its flank, unless a tip's edge touches.
        const V n0 = {pair.flank * gears.n0[0], gears.n0[1], gears.n0[2]};
        if (std::abs(dot(cross(gears.u0, n0), unit(pair.point))) > 1e-12) ++corners;
      }
      const BevelTeeth::Wrench wrench = teeth.wrench(theta, 150, lag);
      for (int i = 0; i < 3; ++i) {
        const double scale = 1e-13 * (1 + size(force));
        EXPECT_NEAR(action.force[i], force[i], scale);
        EXPECT_NEAR(action.moment[i], moment[i], scale);
        EXPECT_NEAR(wrench.force[i], force[i], scale);
        EXPECT_NEAR(wrench.moment[i], moment[i], scale);
      }
      EXPECT_EQ(action.lag, angle);
    }
  EXPECT_GT(carrying, 40);
  EXPECT_GT(corners, 5);
  for (int i = 0; i < 1000; ++i)
    for (const double angle : kLags) {
      const TeethAction action = teeth.act(7e-4 * i, 150, {angle, 0.2});
      const BevelTeeth::Wrench wrench = teeth.wrench(7e-4 * i, 150, {angle, 0.2});
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(wrench.force[k], action.force[k], 1e-13 * (1 + size(action.force))) << i;
    }
}

TEST(BevelTeeth, ForceIsApproachOverTheLawsFlexibility) {
  // Perfect teeth within the path: slices' forces grow with their distance from O2, so their sum is
  // what all of them at O4's distance would have.
  const PumpParameters pump = toothed();
  const BevelTeeth teeth(pump);
  const BevelGeometry& g = teeth.geometry();
  const ToothFlexibility law(pump.gear, g.pitch_cone);
  const Gears gears(pump);
  const double lag = 5.5e-4;
  const double depth = std::sin(g.base_cone) * lag;
  const double roll = std::acos(std::cos(g.pitch_cone) / std::cos(g.base_cone));
  int seen = 0;
  for (int i = 0; i < 1000; ++i)
    for (const PairContact& pair : teeth.act(7e-4 * i, 0, {lag, 0}).pairs) {
      const V u = unit(pair.point);
      if (!(pair.force > 0) || std::abs(dot(cross(gears.u0, gears.n0), u)) > 1e-12) continue;
      const double phi = std::atan2(dot(u, gears.n0), dot(u, gears.u0));
      const auto flexible = [&](double arc) {
        return law.tooth(g.distance *
                         (std::acos(std::cos(g.base_cone) * std::cos(arc)) - g.pitch_cone));
      };
      const double q =
          flexible(roll + phi + depth / 2) + flexible(roll - phi + depth / 2) + law.contact();
      EXPECT_NEAR(pair.force, pair.approach * pump.gear.teeth->face_width / q, 1e-11 * pair.force);
      ++seen;
    }
  EXPECT_GT(seen, 1000);
}

TEST(BevelTeeth, SlicesAreIntegratedExactly) {
  PumpParameters pump = imperfect();
  pump.gear.teeth->dissipation = 0.5;
  const BevelTeeth teeth(pump);
  const BevelGeometry& g = teeth.geometry();
  const ToothData& t = *pump.gear.teeth;
  const ToothFlexibility flexibility(pump.gear, g.pitch_cone);
  const double half = t.face_width / 2;
  int partly = 0, carrying = 0;
  for (const double rate : {0.0, 0.3, -20.0, -41.0})  // rad/s: the last ones end damping's factor
    for (const double theta : {0.0, 0.05, 0.1163}) {
      const ToothLag lag = {5.6e-4, rate};
      const TeethAction action = teeth.act(theta, 157, lag);
      for (const PairContact& pair : action.pairs) {
        if (!(pair.force > 0)) continue;
        const V u = unit(pair.point);
        const Gears gears(pump);
        const V n0 = {pair.flank * gears.n0[0], gears.n0[1], gears.n0[2]};
        if (std::abs(dot(cross(gears.u0, n0), u)) > 1e-12) continue;  // not a corner
        const double phi = std::atan2(dot(u, n0), dot(u, gears.u0));
        const double depth = std::sin(g.base_cone) * lag.angle * pair.flank;
        const double roll = std::acos(std::cos(g.pitch_cone) / std::cos(g.base_cone));
        const double shaft = std::acos(std::cos(g.base_cone) * std::cos(roll + phi + depth / 2));
        const double block = std::acos(std::cos(g.base_cone) * std::cos(roll - phi + depth / 2));
        const double q = flexibility.tooth(g.distance * (shaft - g.pitch_cone)) +
                         flexibility.tooth(g.distance * (block - g.pitch_cone)) +
                         flexibility.contact();
        const double speed = dot(pair.normal, cross(157 * gears.z1 - (157 - rate) * gears.z2, u));
        double force = 0, moment = 0;
        constexpr int kSlices = 200000;
        for (int i = 0; i < kSlices; ++i) {
          const double r = g.distance + half * (2 * (i + 0.5) / kSlices - 1);
          const double x = (r - g.distance) / half;
          const double a = r / g.distance * pair.approach - t.lead_crowning * x * x;
          const double f = std::max(0.0, a) / q * std::max(0.0, 1 + t.dissipation * r * speed);
          if (f == 0) ++partly;
          force += f * 2 * half / kSlices;
          moment += r * f * 2 * half / kSlices;
        }
        ++carrying;
        EXPECT_NEAR(pair.force, force, 1e-8 * force);
        EXPECT_NEAR(size(pair.point), moment / force, 1e-8 * moment / force);
      }
    }
  EXPECT_GT(carrying, 8);
  EXPECT_GT(partly, 1000);
}

TEST(BevelTeeth, SpeedOfApproachIsItsDerivative) {
  PumpParameters pump = imperfect();
  pump.gear.teeth->tip_relief = 0;  // the law's speed is that of unmodified flanks
  const BevelTeeth teeth(pump);
  const double speed = 150, step = 1e-7;
  for (const double theta : kAngles)
    for (const double angle : kLags)
      for (const int flank : {1, -1}) {
        const double rate = 3;
        const auto there = [&](double t) {
          return teeth.approach(theta + speed * t, speed, {angle + rate * t, rate}, flank);
        };
        const double difference = (there(step).distance - there(-step).distance) / (2 * step);
        // Crowning moves the slice; which one is nearest does not matter to first order.
        EXPECT_NEAR(there(0).rate, difference, 2e-5) << theta << ' ' << angle << ' ' << flank;
      }
}

TEST(BevelTeeth, ForcesPointWhereApproachGrows) {
  // By virtual work: the approach of a pair grows as the bodies' points move along its normal
  // there, tips' edges and all.
  PumpParameters pump = imperfect();
  pump.gear.teeth->tip_relief = 0;
  const BevelTeeth teeth(pump);
  const Gears gears(pump);
  const double r = teeth.geometry().distance;
  int corners = 0;
  for (const double lag : {-8e-4, 6e-4, 9e-4})
    for (int i = 0; i < 300; ++i) {
      const double theta = 8e-4 * i + 1e-5;
      const TeethAction action = teeth.act(theta, 0, {lag, 0});
      for (const double shaft : {1.0, 0.0}) {
        const double block = 1 - shaft;
        const double step = 1e-6;
        const auto there = [&](double t) {
          return teeth.act(theta + shaft * t, 0, {lag + (shaft - block) * t, 0});
        };
        const TeethAction after = there(step), before = there(-step);
        for (std::size_t k = 0; k < action.pairs.size(); ++k) {
          const PairContact& pair = action.pairs[k];
          if (!(pair.force > 0) || after.pairs[k].shaft_tooth != pair.shaft_tooth) continue;
          const V u = unit(pair.point);
          const double expected =
              r * dot(pair.normal, cross(shaft * gears.z1 - block * gears.z2, u));
          EXPECT_NEAR((after.pairs[k].approach - before.pairs[k].approach) / (2 * step), expected,
                      1e-8);
          const V n0 = {pair.flank * gears.n0[0], gears.n0[1], gears.n0[2]};
          if (std::abs(dot(cross(gears.u0, n0), u)) > 1e-9) ++corners;
        }
      }
    }
  EXPECT_GT(corners, 50);
}

TEST(BevelTeeth, ApproachIsContinuousAndThatOfThePairs) {
  const BevelTeeth teeth(imperfect());
  for (const int flank : {1, -1})
    for (const double lag : kLags) {
      double before = teeth.approach(-0.01, 0, {lag, 0}, flank).distance;
      for (int i = 1; i < 5000; ++i) {
        const double theta = -0.01 + 0.5 * i / 5000;
        const double now = teeth.approach(theta, 0, {lag, 0}, flank).distance;
        EXPECT_NEAR(now, before, 2e-6) << theta;  // 0.1 mm of turning
        before = now;
        bool carries = false;
        for (const PairContact& pair : teeth.act(theta, 0, {lag, 0}).pairs)
          carries |= pair.flank == flank && pair.force > 0;
        EXPECT_EQ(carries, now > 0);
      }
    }
}

TEST(BevelTeeth, ForceIsContinuousWherePairsComeAndLeave) {
  const BevelTeeth teeth(imperfect());
  // Up to 800 Nm; 1000 Nm deform the teeth so far that pairs touch that are not looked at.
  for (const double lag : {-8e-4, 6e-4, 9e-4, 1.2e-3}) {
    BevelTeeth::Wrench before = teeth.wrench(-0.01, 0, {lag, 0});
    for (int i = 1; i < 20000; ++i) {
      const BevelTeeth::Wrench now = teeth.wrench(-0.01 + 0.3 * i / 20000, 0, {lag, 0});
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(now.force[k], before.force[k], 2e-3 * (30 + size(now.force))) << i;
        EXPECT_NEAR(now.moment[k], before.moment[k], 2e-3 * (3 + size(now.moment))) << i;
      }
      before = now;
    }
  }
}

TEST(BevelTeeth, RestInvertsTheLaw) {
  for (const PumpParameters& pump : {toothed(), imperfect()}) {
    const BevelTeeth teeth(pump);
    for (const double theta : kAngles)
      for (const double torque : {-20.0, -0.3, 1e-5, 0.7, 15.0, 200.0}) {
        const ToothLag lag = teeth.rest(theta, torque);
        EXPECT_EQ(lag.rate, 0);
        const TeethAction action = teeth.act(theta, 150, lag, false);
        EXPECT_NEAR(teeth.about_block_axis(action.moment), torque, 1e-12 * std::abs(torque) + 2e-10)
            << theta;
      }
  }
}

TEST(BevelTeeth, SaysWhichTorqueNoLagCarries) {
  try {
    BevelTeeth(toothed()).rest(0.3, 1e9);
    FAIL();
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("1e+09 Nm at theta = 17.2 deg"));
  }
  PumpParameters pump = toothed();
  for (const double modulus : {1e-3, 1e-100, 1e-290}) {  // any force bends them round and round
    pump.gear.teeth->youngs_modulus = modulus;
    EXPECT_THROW(BevelTeeth(pump).rest(0.3, 10), ComputationError) << modulus;
  }
}

TEST(BevelTeeth, UnloadedPerfectTeethHaveARatioOfOne) {
  // The lag at which the flank touches stays half the backlash at every angle.
  const PumpParameters pump = toothed();
  const BevelTeeth teeth(pump);
  const double arm = pump.gear.pitch_diameter / 2 * std::cos(pump.gear.pressure_angle);
  const double expected = pump.gear.teeth->backlash / 2 / arm;
  for (int i = 0; i < 2000; ++i)
    EXPECT_NEAR(teeth.rest(-30 + 0.03137 * i, 0).angle, expected, 1e-12 * expected) << i;
}

TEST(BevelTeeth, TorqueDoesNotDependOnThePlaceOfTheContact) {
  // Of a pair within the path: the moment about either axis is the force's share along the plane of
  // action's normal, at every angle; pin and bearings see the force turn.
  const PumpParameters pump = toothed();
  const BevelTeeth teeth(pump);
  const BevelGeometry& g = teeth.geometry();
  int seen = 0;
  V first = {};
  double turned_by = 0;
  for (int i = 0; i < 500; ++i)
    for (const PairContact& pair : teeth.act(1e-3 * i, 0, {5.5e-4, 0}).pairs) {
      if (!(pair.force > 0) ||
          std::abs(pair.approach - (5.5e-4 * g.distance * std::sin(g.base_cone) - 25e-6)) > 1e-15)
        continue;
      const V moment = pair.force * cross(pair.point, pair.normal);
      const double lever = size(pair.point) * std::sin(g.base_cone);
      EXPECT_NEAR(moment[2], pair.force * lever, 1e-13 * pair.force);
      EXPECT_NEAR(teeth.about_block_axis(moment), pair.force * lever, 1e-13 * pair.force);
      if (seen++ == 0) first = pair.normal;
      turned_by = std::max(turned_by, angle_between(first, pair.normal));
    }
  EXPECT_GT(seen, 500);
  EXPECT_GT(turned_by, 0.2);  // of the 0.37 of the whole path
}

TEST(BevelTeeth, FlanksAreMirrorImages) {
  const PumpParameters pump = toothed();
  const BevelTeeth teeth(pump);
  for (const double theta : {0.01, 0.09, 0.11, 0.7}) {
    const TeethAction plus = teeth.act(theta, 150, {7e-4, 0.1});
    const TeethAction minus = teeth.act(-theta, -150, {-7e-4, -0.1});
    EXPECT_GT(size(plus.force), 100);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(plus.force[i], (i == 0 ? -1 : 1) * minus.force[i], 1e-9);
      EXPECT_NEAR(plus.moment[i], (i == 0 ? 1 : -1) * minus.moment[i], 1e-9);
    }
  }
}

TEST(BevelTeeth, WholeTurnsChangeNothingButTheNumbersOfPitches) {
  const PumpParameters pump = imperfect();
  const BevelTeeth teeth(pump);
  const long double turn = 2 * 3.14159265358979323846264338327950288L;
  const TeethAction here = teeth.act(0.4, 150, {9e-4, 0});
  const auto there = static_cast<double>(0.4L + 1000 * turn);
  const TeethAction later = teeth.act(there, 150, {9e-4, 0});
  for (std::size_t i = 0; i < here.pairs.size(); ++i) {
    EXPECT_EQ(here.pairs[i].shaft_tooth, later.pairs[i].shaft_tooth);
    EXPECT_EQ(here.pairs[i].block_tooth, later.pairs[i].block_tooth);
    EXPECT_NEAR(here.pairs[i].force, later.pairs[i].force, 1e-6);
  }
  // Numbers as the results say: the tooth i for which theta Z / 2 pi + 1/2 lies in [i - 1, i).
  const int i = static_cast<int>(std::floor(0.4 * pump.gear.teeth->count / (2 * kPi) + 0.5)) + 1;
  EXPECT_EQ(here.pairs[0].shaft_tooth, i);
  EXPECT_EQ(here.pairs[1].shaft_tooth, i - 1);
  EXPECT_EQ(here.pairs[2].shaft_tooth, i + 1);
  EXPECT_EQ(here.pairs[0].block_tooth, i - 1);
  EXPECT_EQ(here.pairs[3].block_tooth, i);
}

TEST(BevelTeeth, ActingAllocatesNothing) {
  const BevelTeeth teeth(imperfect());
  const long before = allocations;
  double sum = 0;
  for (const double lag : kLags) {
    sum += teeth.act(0.3, 150, {lag, 0}).force[0] + teeth.wrench(0.3, 150, {lag, 0}).moment[1] +
           teeth.approach(0.3, 150, {lag, 0}, 1).distance;
  }
  EXPECT_EQ(allocations, before);
  EXPECT_NE(sum, 0);
}

// ---- a pump with teeth -------------------------------------------------------------------------

Case toothed_case() {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_teeth.toml");
}

// The instant of a run's row.
TEST(ToothedModel, FreeBodiesBalanceUnderTheForcesOfThePairs) {
  Case the_case = toothed_case();
  the_case.pump.gear.teeth = imperfect().gear.teeth;
  const analytic::Model model(the_case.pump, the_case.analytic);
  std::vector<double> values(model.layout().size());
  MotionChecks checks;
  TeethAction action;
  int back = 0;
  for (const double speed : {157.0, -157.0})
    for (double theta = 0; theta < 360; theta += 7.3) {
      const Instant instant = instant_at(the_case, theta, speed);
      model.evaluate(instant, values, &checks, &action);
      EXPECT_LT(free_body_residual(the_case.pump, the_case.analytic, instant, values, &action),
                1e-12)
          << theta;
      EXPECT_NEAR(checks.power_balance, 0, 1e-9) << theta;
      EXPECT_NEAR(values[model.layout().power_residual()], 0, 1e-11) << theta;
      const double rcs = (speed < 0 ? -1 : 1) * values[model.layout().Rcs()];
      EXPECT_NEAR(checks.tooth_law, rcs, 1e-10 * std::abs(rcs) + 1e-8) << theta;
      if (action.lag < 0) ++back;
    }
  EXPECT_GT(back, 10);
}

TEST(ToothedModel, TakesTheLagOfAnInstant) {
  // Block that moves on its own with teeth at a lag: the law's forces act, whatever the block's
  // balance needs, and power balances with what the block takes.
  Case the_case = toothed_case();
  the_case.pump.gear.teeth = imperfect().gear.teeth;
  const analytic::Model model(the_case.pump, the_case.analytic);
  std::vector<double> values(model.layout().size());
  MotionChecks checks;
  TeethAction action;
  const BevelTeeth teeth(the_case.pump);
  for (double theta = 3; theta < 360; theta += 17.3) {
    Instant instant = instant_at(the_case, theta, 157.0);
    instant.lag = ToothLag{6e-4, 0.4};
    instant.block = {instant.shaft.angle - 6e-4, 157.0 - 0.4, -300.0};
    instant.shaft.acceleration = 100;
    model.evaluate(instant, values, &checks, &action);
    const BevelTeeth::Wrench w = teeth.wrench(instant.shaft.angle, 157.0, *instant.lag);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(action.force[i], w.force[i], 1e-9);
    const double arm =
        the_case.pump.gear.pitch_diameter / 2 * std::cos(the_case.pump.gear.pressure_angle);
    EXPECT_NEAR(checks.tooth_law, teeth.about_block_axis(w.moment) / arm, 1e-8);
    EXPECT_NEAR(checks.power_balance, 0, 1e-8) << theta;
  }
}

TEST(ToothedModel, LongDoubleSeesTheSame) {
  const Case the_case = toothed_case();
  const analytic::Model model(the_case.pump, the_case.analytic);
  std::vector<double> values(model.layout().size());
  std::vector<long double> wide(model.layout().size());
  const Instant instant = instant_at(the_case, 100, 157);
  model.reactions(instant, values);
  model.reactions(instant, wide);
  for (std::size_t c = 0; c < model.layout().reactions(); ++c)
    EXPECT_NEAR(values[c], static_cast<double>(wide[c]), 1e-9) << c;
}

TEST(ToothedModel, StiffTeethTendToTwoRigidFlanksAsOneOverTheirStiffness) {
  // A single pair at O4 on a narrow face, without backlash: what is left is the deflection. (At a
  // tenth of the least stiffness here the neighbours' tips would touch.)
  Case the_case = toothed_case();
  ToothData& teeth = *the_case.pump.gear.teeth;
  teeth.backlash = 0;
  teeth.face_width = 2e-6;
  PumpParameters rigid = the_case.pump;
  rigid.gear.contact = ToothContact::rigid;
  rigid.gear.teeth.reset();
  const double theta = -90.0 / teeth.count;  // flank +1 of tooth 1 at O4
  const Instant instant = instant_at(the_case, theta, 157);
  const analytic::Model flanks(rigid, the_case.analytic);
  std::vector<double> expected(flanks.layout().size());
  flanks.evaluate(instant, expected);
  ASSERT_GT(expected[flanks.layout().Rcs()], 50);
  double before = 0;
  for (const double stiffness : {1e15, 1e16, 1e17}) {
    teeth.youngs_modulus = stiffness;
    const analytic::Model model(the_case.pump, the_case.analytic);
    std::vector<double> values(model.layout().size());
    model.evaluate(instant, values);
    const ChannelLayout& at = model.layout();
    double largest = 0;
    for (std::size_t c = at.Fh(); c < at.reactions(); ++c)
      largest = std::max(largest, std::abs(values[c] - expected[c]));
    EXPECT_GT(largest, 0);
    EXPECT_NEAR(values[at.Td()], expected[at.Td()], 1e-10);
    if (before > 0) {
      EXPECT_NEAR(before / largest, 10, 0.5) << stiffness;
    }
    before = largest;
  }
  EXPECT_LT(before, 1e-4);  // N, of tens of thousands
}

TEST(ToothedModel, StiffTeethTakeAsMuchFromTheShaftAsTheyGive) {
  // Edges of tips carry the less the stiffer the teeth: the ratio under load tends to 1.
  Case the_case = toothed_case();
  double before = std::numeric_limits<double>::infinity();
  for (const double stiffness : {206e9, 206e11, 206e13}) {
    the_case.pump.gear.teeth->youngs_modulus = stiffness;
    const BevelTeeth teeth(the_case.pump);
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
      const double theta = 6e-4 * i;
      const auto m = teeth.wrench(theta, 0, teeth.rest(theta, 16.0), false).moment;
      worst = std::max(worst, std::abs(m[2] - teeth.about_block_axis(m)));
    }
    EXPECT_LT(worst, 0.2 * before) << stiffness;
    before = worst;
  }
  EXPECT_GT(before, 0);
}

TEST(ToothedModel, RunWritesWhatTheTeethDo) {
  const Case the_case = toothed_case();
  const Samples samples = sample_case(the_case, PressureTrace(the_case.pressure));
  ResultTable teeth;
  const ResultTable table = analytic::run(the_case, the_case.analytic, samples, {}, &teeth);
  ASSERT_EQ(teeth.rows(), table.rows());
  const ChannelLayout at(the_case.pump.geometry.pistons);
  const double arm =
      the_case.pump.gear.pitch_diameter / 2 * std::cos(the_case.pump.gear.pressure_angle);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    EXPECT_NEAR(table.at(row, at.power_residual()), 0, 1e-11);
    // A pair's force is as far from O2 as its slices' middle: within 2 % of the force at O4.
    const double sum =
        teeth.at(row, teeth.find("plus_force_N")) - teeth.at(row, teeth.find("minus_force_N"));
    const double rcs = table.at(row, at.Rcs());
    EXPECT_NEAR(sum, rcs, 0.02 * std::abs(rcs) + 1e-6);
    EXPECT_NEAR(teeth.at(row, teeth.find("transmission_error_um")),
                teeth.at(row, teeth.find("lag_urad")) * arm, 1e-9);
  }
  for (const auto& [flank, way] : {std::pair{"plus", "+psi"}, {"minus", "-psi"}}) {
    const Channel& force = teeth.channels[teeth.find(flank + std::string("_force_N"))];
    EXPECT_EQ(force.meaning.substr(force.meaning.size() - 4), way);
  }
  // No teeth, no table.
  Case rigid = the_case;
  rigid.pump.gear.contact = ToothContact::rigid;
  rigid.pump.gear.teeth.reset();
  ResultTable none;
  analytic::run(rigid, rigid.analytic, samples, {}, &none);
  EXPECT_EQ(none.rows(), 0U);
}

TEST(ToothedModel, StatesAreThoseOfTheInstants) {
  Case the_case = toothed_case();
  the_case.pump.gear.teeth = imperfect().gear.teeth;
  const analytic::Model model(the_case.pump, the_case.analytic);
  States states;
  states.pistons = the_case.pump.geometry.pistons;
  for (const double theta_deg : {10.0, 100.0, 370.0}) {
    states.motion.push_back(
        {theta_deg, theta_deg - 0.2, 157, 155, 30, -500, the_case.pressure.ports});
    const Instant at = instant_at(the_case, theta_deg, 157);
    states.chamber_pressure.insert(states.chamber_pressure.end(), at.chamber_pressure.begin(),
                                   at.chamber_pressure.end());
  }
  ResultTable teeth;
  const MotionTable table = analytic::run_states(the_case, the_case.analytic, states, {}, &teeth);
  ASSERT_EQ(teeth.rows(), states.rows());
  std::vector<double> values(model.layout().size());
  Instant instant;
  TeethAction action;
  for (std::size_t row = 0; row < states.rows(); ++row) {
    states.instant(row, instant);
    model.evaluate(instant, values, nullptr, &action);
    for (std::size_t c = 0; c < model.layout().reactions(); ++c)
      EXPECT_EQ(table.results.at(row, c), values[c]);
    EXPECT_EQ(teeth.theta_deg[row], states.motion[row].theta_deg);
    EXPECT_EQ(teeth.at(row, teeth.find("lag_urad")), action.lag * 1e6);
    EXPECT_NEAR(table.results.at(row, table.results.find("power_balance_W")), 0, 1e-8);
  }
}

TEST(ToothedModel, SaysWhereFurtherPairsWouldTouch) {
  Case the_case = toothed_case();
  const auto limit = [&] {
    const Samples samples = sample_case(the_case, PressureTrace(the_case.pressure));
    const ResultTable table = analytic::run(the_case, the_case.analytic, samples);
    const auto limits = analytic::check_validity(the_case, the_case.analytic, samples, table);
    EXPECT_EQ(limits.back().name, "further pairs of teeth touch");
    return limits.back();
  };
  EXPECT_EQ(limit().violated_share, 0);
  EXPECT_LT(limit().worst, 5);
  // At the reach a pair on the border of those looked at nearly touches: it was measured without
  // the lag, by which the block's tooth has still farther to go.
  const BevelTeeth teeth(the_case.pump);
  const double arm =
      the_case.pump.gear.pitch_diameter / 2 * std::cos(the_case.pump.gear.pressure_angle);
  const double lag = (teeth.geometry().reach + the_case.pump.gear.teeth->backlash / 2) / arm;
  const double border = -kPi / the_case.pump.gear.teeth->count;  // half a pitch
  const double gap = -teeth.act(border, 0, {lag, 0}).pairs[2].approach;
  EXPECT_GT(gap, 0);
  EXPECT_LT(gap, 0.1 * teeth.geometry().reach);
  // Ever softer teeth are pressed that far.
  the_case.pump.gear.teeth->youngs_modulus = 1e9;
  EXPECT_GT(limit().violated_share, 0);
  EXPECT_GT(limit().worst, teeth.geometry().reach * 1e6);
}

TEST(ToothedModel, WhatCannotFollowTeethSaysSo) {
  const Case the_case = toothed_case();
  EXPECT_THROW(analytic::BatchModel(the_case.pump, the_case.analytic), InputError);
  EXPECT_THROW(analytic::PumpBatch({the_case.pump}, the_case.analytic), InputError);
  EXPECT_THROW(analytic::simulate(the_case, the_case.analytic, PressureTrace(the_case.pressure)),
               InputError);
  PumpParameters pump = the_case.pump;
  pump.gear.teeth->dedendum = 1e-3;
  EXPECT_THROW(analytic::Model(pump, the_case.analytic), InputError);
}

TEST(ToothedModel, RoundingIsEstimated) {
  const Case the_case = toothed_case();
  const PressureTrace trace(the_case.pressure);
  const Samples samples = sample_case(the_case, trace);
  for (const analytic::GroupRounding& group :
       analytic::estimate_rounding(the_case, the_case.analytic, samples, trace, 12)) {
    EXPECT_TRUE(std::isfinite(group.total())) << group.group;
    EXPECT_LT(group.total(), 1e-6) << group.group;
  }
}

// ---- in motion ---------------------------------------------------------------------------------

OilLoads loads_at(const Case& the_case, double psi) {
  const Instant instant = instant_at(the_case, psi / kRadPerDegree, 0);
  return {instant.chamber_pressure, instant.ports};
}

TEST(ToothedMechanics, EnergyIsWhatTheLoadsFeedIn) {
  for (const DriveKind kind : {DriveKind::speed, DriveKind::torque}) {
    Case the_case = toothed_case();
    the_case.pump.gear.teeth = imperfect().gear.teeth;
    the_case.drive->kind = kind;
    the_case.drive->torque = 250;
    the_case.pump.friction.block_viscous = 1e-3;
    const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
    EXPECT_TRUE(mechanics->compliant());
    std::vector<double> state, row(mechanics->layout().size());
    MotionChecks checks;
    int pressing = 0;
    for (int i = 0; i < 40; ++i) {
      const double time = 1e-3 * i + 1e-4;
      MotionVector y = mechanics->start();
      y[kLag] = 9e-4 * std::sin(3.0 * i);
      y[kLagRate] = 0.5 * std::cos(2.0 * i);
      if (kind == DriveKind::torque) y[kTurn] = 0.02 * i, y[kTurnRate] = 3 * std::sin(1.0 * i);
      const OilLoads loads = loads_at(the_case, mechanics->block(time, y).angle);
      MotionVector dy;
      mechanics->rates(time, y, loads, dy);
      mechanics->row(time, y, loads, state, row, checks);
      EXPECT_NEAR(checks.power_balance, 0, 1e-7);
      const double rcs = row[mechanics->layout().Rcs()];
      EXPECT_NEAR(checks.tooth_law, rcs, 1e-9 * (100 + std::abs(rcs)));
      EXPECT_NEAR(dy[kImpulse], std::abs(rcs), 1e-9 * (100 + std::abs(rcs)));
      if (std::abs(rcs) > 1e-6) ++pressing;
      const double step = 1e-7;
      const auto energy = [&](double t) {
        MotionVector there = y;
        for (const std::size_t s : {kTurn, kTurnRate, kLag, kLagRate}) there[s] += dy[s] * t;
        return mechanics->kinetic_energy(time + t, there);
      };
      const double gained = (energy(step) - energy(-step)) / (2 * step);
      const double fed = dy[kWorkOfLoads] + dy[kWorkOfDrive];
      EXPECT_NEAR(gained, fed, 1e-5 * (1e4 + std::abs(dy[kWorkOfDrive]))) << i;
      EXPECT_EQ(mechanics->potential_energy(y), 0);

      TeethAction action;
      ASSERT_TRUE(mechanics->teeth(time, y, action));
      EXPECT_EQ(action.lag, y[kLag]);
      const double nearest =
          std::max(mechanics->approach(time, y, 1), mechanics->approach(time, y, -1));
      double force = 0;
      for (const PairContact& pair : action.pairs) force += pair.force;
      if (force > 0) {
        EXPECT_GT(nearest, 0);
      }
    }
    EXPECT_GT(pressing, 10);
  }
}

TEST(ToothedMechanics, RestsWhereTheQuasiStaticTeethDo) {
  // At the lag of a run, with its rate, the block keeps nearly the shaft's pace: what is left is
  // the motion of the lag itself.
  Case the_case = toothed_case();
  the_case.pump.gear.teeth->backlash = 0;
  the_case.pump.gear.teeth->dissipation = 0;
  const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
  const analytic::Model model(the_case.pump, the_case.analytic);
  const double omega = rad_per_second(the_case.operation.speed_rpm);
  for (const double theta_deg : {0.0, 50.0, 100.0, 200.0}) {
    const double time = radians(theta_deg) / omega;
    const Instant instant = instant_at(the_case, theta_deg, omega);
    TeethAction action;
    std::vector<double> values(model.layout().reactions());
    model.reactions(instant, values, &action);
    MotionVector y = mechanics->start();
    y[kLag] = action.lag;
    MotionVector dy;
    mechanics->rates(time, y, {instant.chamber_pressure, instant.ports}, dy);
    // The lag turns the block by as much: a change of some parts in 1e5 of its torques.
    EXPECT_LT(std::abs(dy[kLagRate]), 20) << theta_deg;  // of 1e4 rad/s2 without teeth
    y[kLag] = 0;
    mechanics->rates(time, y, {instant.chamber_pressure, instant.ports}, dy);
    EXPECT_GT(std::abs(dy[kLagRate]), 200) << theta_deg;
  }
}

TEST(ToothedMechanics, ScalesAreThoseOfTheTeeth) {
  const Case the_case = toothed_case();
  const auto mechanics = analytic::mechanics(the_case, the_case.analytic);
  const MotionVector scale = mechanics->scales();
  const BevelTeeth teeth(the_case.pump);
  const double arm =
      the_case.pump.gear.pitch_diameter / 2 * std::cos(the_case.pump.gear.pressure_angle);
  // A force of the size that acts deflects a pair by about the lag's scale.
  const double force = scale[kLag] * arm * teeth.stiffness();
  EXPECT_GT(force, 50);
  EXPECT_LT(force, 5000);
  EXPECT_GT(scale[kLagRate] / scale[kLag], 1e3);  // rad/s
}

}  // namespace
}  // namespace bentaxis::test
