// Flanks of the multibody model's bevel teeth and how they touch: shapes, ratio, path of contact,
// corners, independence of the search's start.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "placement/placement.h"
#include "scene/pump_system.h"
#include "teeth/bevel_teeth.h"

namespace bentaxis::multibody {
namespace {

using SimTK::dot;
using SimTK::Vec3;

PumpParameters perfect_pump() {
  PumpParameters pump =
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_teeth.toml").pump;
  pump.gear.teeth->backlash = 0;
  return pump;
}

const FlankShape kShapes[] = {FlankShape::involute, FlankShape::octoid};

// The plane in which spherical involutes touch that push towards +psi: through O2 and O4, at the
// pressure angle.
Vec3 force_at_o4(const PumpParameters& pump) {
  const double delta = kPi / 2 - pump.geometry.tilt / 2, ap = pump.gear.pressure_angle;
  return {-std::cos(ap), std::sin(ap) * std::cos(delta), std::sin(ap) * std::sin(delta)};
}
Vec3 towards_o4(const PumpParameters& pump) {
  const double half = pump.geometry.tilt / 2;
  return {0, std::cos(half), -std::sin(half)};
}

TEST(FlankCurve, DerivativesAreThoseOfItsPoints) {
  for (const FlankShape shape : kShapes)
    for (const double ap : {0.25, 0.35, 0.45}) {
      const auto curve = flank_curve(shape, 1.2, ap);
      for (const double roll : {-0.2, -0.05, 0.0, 0.1, 0.3}) {
        constexpr double kStep = 1e-5;
        const FlankPoint at = curve->at(roll);
        const FlankPoint before = curve->at(roll - kStep), after = curve->at(roll + kStep);
        EXPECT_NEAR(at.point.norm(), 1, 1e-15);
        EXPECT_NEAR(at.tangent.norm(), 1, 1e-15);
        EXPECT_NEAR(dot(at.point, at.tangent), 0, 1e-15);
        EXPECT_LT(((after.point - before.point) / (2 * kStep) - at.rate * at.tangent).norm(), 1e-9);
        EXPECT_LT(((after.tangent - before.tangent) / (2 * kStep) - at.tangent_rate).norm(), 1e-9);
        EXPECT_GT(at.rate, 0);
      }
      // At the pitch cone in the pressure angle, the tooth behind.
      const FlankPoint pitch = curve->at(0);
      EXPECT_LT((pitch.point - Vec3(std::sin(1.2), 0, std::cos(1.2))).norm(), 1e-15);
      EXPECT_NEAR(pitch.outward()[1], -std::cos(ap), 1e-15);
      EXPECT_NEAR(curve->at(curve->roll_at(1.25)).polar_angle(), 1.25, 1e-15);
    }
}

TEST(FlankCurve, NormalsOfAnInvoluteTouchItsBaseCircle) {
  const SphericalInvolute curve(1.2, 0.35);
  EXPECT_NEAR(std::sin(curve.base_cone()), std::sin(1.2) * std::cos(0.35), 1e-15);
  for (const double roll : {curve.first_roll(), -0.3, 0.0, 0.4})
    EXPECT_NEAR(curve.at(roll).tangent[2], -std::sin(curve.base_cone()), 1e-15);
  EXPECT_NEAR(curve.at(curve.first_roll()).polar_angle(), curve.base_cone(), 1e-15);
  EXPECT_NEAR(curve.at(curve.first_roll()).rate, 0, 1e-15);
}

TEST(FlankCurve, ShapesAgreeAtThePitchConeAndPartFromThere) {
  const auto involute = flank_curve(FlankShape::involute, 1.2, 0.35);
  const auto octoid = flank_curve(FlankShape::octoid, 1.2, 0.35);
  EXPECT_LT((involute->at(0).tangent - octoid->at(0).tangent).norm(), 1e-15);
  EXPECT_GT((involute->at(0.2).point - octoid->at(0.2).point).norm(), 1e-5);
  EXPECT_LT((involute->at(0.2).point - octoid->at(0.2).point).norm(), 1e-2);
}

// Perfect teeth without load, over the path of contact: they touch with no lag, and the force's
// torque about both axes is the same, which is a ratio of 1.
TEST(BevelTeeth, PerfectTeethHaveARatioOfOne) {
  const PumpParameters pump = perfect_pump();
  for (const FlankShape shape : kShapes) {
    const BevelTeeth teeth(pump, shape);
    for (int i = -20; i <= 20; ++i) {
      const double ahead = 0.999 * teeth.tip_roll() * i / 20;
      const Touch touch = teeth.touch(ahead, ahead);
      ASSERT_TRUE(touch.found && !touch.at_tip);
      EXPECT_NEAR(touch.pressed_in, 0, 5e-16);
      const double on_shaft = dot(touch.normal, teeth.shaft_axis() % touch.point);
      const double on_block = dot(touch.normal, teeth.block_axis() % touch.point);
      EXPECT_NEAR(on_shaft / on_block, 1, 1e-12) << "at " << ahead;
    }
    for (int deg = 0; deg < 60; ++deg) {
      const double theta = deg * kRadPerDegree;
      EXPECT_NEAR(teeth.rest(theta, 0).angle, 0, 1e-15) << "at " << deg;
    }
  }
}

TEST(BevelTeeth, InvolutesTouchOnAGreatCircleAndOctoidsBesideIt) {
  const PumpParameters pump = perfect_pump();
  const Vec3 force = force_at_o4(pump);
  const Vec3 plane = force % towards_o4(pump);  // normal of the plane of action
  double off[2] = {};
  for (const FlankShape shape : kShapes) {
    const BevelTeeth teeth(pump, shape);
    EXPECT_LT((teeth.touch(0, 0).point - towards_o4(pump)).norm(), 1e-15);
    EXPECT_LT((teeth.touch(0, 0).normal - force).norm(), 1e-15);
    for (int i = -20; i <= 20; ++i) {
      const double ahead = 0.999 * teeth.tip_roll() * i / 20;
      double& worst = off[static_cast<int>(shape)];
      worst = std::max(worst, std::abs(dot(plane, teeth.touch(ahead, ahead).point)));
    }
  }
  EXPECT_LT(off[0], 1e-15);
  RecordProperty("octoid_off_great_circle_urad", static_cast<int>(off[1] * 1e6));
  EXPECT_GT(off[1], 1e-4);
  EXPECT_LT(off[1], 1e-2);
}

TEST(BevelTeeth, InvolutesPressedInByALagDoNotDependOnThePlace) {
  const PumpParameters pump = perfect_pump();
  const BevelTeeth teeth(pump, FlankShape::involute);
  const double base_sine =
      std::sin(kPi / 2 - pump.geometry.tilt / 2) * std::cos(pump.gear.pressure_angle);
  for (const double lag : {-1e-3, 1e-6, 1e-4, 3e-3})
    for (int i = -9; i <= 9; ++i) {
      const double ahead = 0.9 * teeth.tip_roll() * i / 9;
      EXPECT_NEAR(teeth.touch(ahead, ahead - lag).pressed_in, base_sine * lag, 5e-16);
    }
}

TEST(BevelTeeth, WhatIsFoundDoesNotDependOnTheStart) {
  const PumpParameters pump = perfect_pump();
  for (const FlankShape shape : kShapes) {
    const BevelTeeth teeth(pump, shape);
    int tips = 0, more = 0;
    for (const double ahead : {-0.25, -0.215, -0.1, 0.0, 0.15, 0.22, 0.26})
      for (const double lag : {-2e-4, 0.0, 4e-3}) {
        const Touch usual = teeth.touch(ahead, ahead - lag);
        ASSERT_TRUE(usual.found);
        tips += usual.at_tip;
        for (const double a : {-0.5, -0.2, 0.0, 0.3})
          for (const double b : {-0.4, 0.1, 0.5}) {
            const Touch other = teeth.touch(ahead, ahead - lag, TouchGuess{a, b});
            ASSERT_TRUE(other.found);
            more = std::max(more, other.iterations);
            EXPECT_NEAR(other.shaft_roll, usual.shaft_roll, 1e-14);
            EXPECT_NEAR(other.block_roll, usual.block_roll, 1e-14);
            EXPECT_NEAR(other.pressed_in, usual.pressed_in, 5e-16);
            EXPECT_LT((other.normal - usual.normal).norm(), 1e-14);
          }
      }
    EXPECT_GT(tips, 6);
    EXPECT_GT(more, 4);
    EXPECT_LT(more, 20);
  }
}

// Where a pair comes in or leaves: at a tip, whose edge the mate's normal passes through.
TEST(BevelTeeth, TipsTouchBeyondThePathWithoutAJump) {
  const PumpParameters pump = perfect_pump();
  for (const FlankShape shape : kShapes) {
    const BevelTeeth teeth(pump, shape);
    const double base_sine = std::sin(teeth.pitch_cone()) * std::cos(pump.gear.pressure_angle);
    const double tip = teeth.curve().at(teeth.tip_roll()).polar_angle();
    for (const double sign : {1.0, -1.0})
      for (const double lag : {0.0, 1e-3}) {
        // Where the stationary point is at the tip: found by halving.
        double in = 0, out = sign * 1.2 * teeth.tip_roll();
        for (int i = 0; i < 60; ++i)
          (teeth.touch((in + out) / 2, (in + out) / 2 - lag).at_tip ? out : in) = (in + out) / 2;
        const auto touch = [&](double ahead) { return teeth.touch(ahead, ahead - lag); };
        EXPECT_NEAR(touch(in).pressed_in, touch(out).pressed_in, 1e-15);
        EXPECT_LT((touch(in).normal - touch(out).normal).norm(), 1e-12);
        EXPECT_LT((touch(in).point - touch(out).point).norm(), 1e-12);
        for (const double beyond : {0.01, 0.04}) {
          const Touch corner = touch(out + sign * beyond);
          ASSERT_TRUE(corner.found && corner.at_tip);
          EXPECT_NEAR(sign > 0 ? corner.shaft_angle : corner.block_angle, tip, 1e-15);
          EXPECT_LT(corner.pressed_in, touch(in).pressed_in);
          if (shape == FlankShape::octoid) continue;
          // Tangent to the base circle of the mate.
          const Vec3 pole = corner.normal % corner.point;
          const Vec3 axis = sign > 0 ? teeth.block_axis() : teeth.shaft_axis();
          EXPECT_NEAR(std::abs(dot(pole, axis)), base_sine, 1e-12);
        }
      }
  }
}

// Tips that reach nearly to where the mate's flanks begin: beyond the path the point with the
// stationary distance lies on no flank, from where a search would slip to the far side of the base
// circle.
TEST(BevelTeeth, FindsTheCornerWhereTipsReachAsDeepAsFlanksGo) {
  PumpParameters pump = perfect_pump();
  pump.geometry.tilt = 0.308673;
  pump.gear.pressure_angle = 0.161122;
  ToothData& data = *pump.gear.teeth;
  data.count = 8;
  const double module = pump.gear.pitch_diameter / data.count;
  const double delta = kPi / 2 - pump.geometry.tilt / 2;
  const double radius = pump.gear.pitch_diameter / 2 / std::sin(delta);
  const SphericalInvolute curve(delta, pump.gear.pressure_angle);
  data.addendum = radius * std::tan(curve.at(-0.98 * curve.first_roll()).polar_angle() - delta);
  data.dedendum = data.addendum + 0.25 * module;
  const BevelTeeth teeth(pump, FlankShape::involute);
  double last = 0;
  for (int i = 0; i <= 100; ++i) {
    const double ahead = -teeth.tip_roll() * (1 + 0.003 * i);
    const Touch touch = teeth.touch(ahead, ahead - 7e-4);
    ASSERT_TRUE(touch.found) << i;
    if (i > 0) {
      EXPECT_LE(touch.pressed_in, last) << i;
      EXPECT_NEAR(touch.pressed_in, last, 4e-4) << i;
    }
    last = touch.pressed_in;
  }
}

// Forces over an angle of the shaft in which pairs come and go have no jump, and they rest where
// they carry what is asked for.
TEST(BevelTeeth, ForcesAreContinuousAndCarryTheTorqueAskedFor) {
  PumpParameters pump = perfect_pump();
  ToothData& data = *pump.gear.teeth;
  data.backlash = 40e-6;
  data.lead_crowning = 4e-6;
  data.tip_relief = 6e-6;
  data.relief_height = 1.5e-3;
  data.shaft.runout = 8e-6;
  data.block.pitch.assign(static_cast<std::size_t>(data.count), 0.0);
  for (std::size_t i = 0; i < data.block.pitch.size(); ++i)
    data.block.pitch[i] = 3e-6 * std::sin(5.0 * static_cast<double>(i));
  for (const FlankShape shape : kShapes) {
    const BevelTeeth teeth(pump, shape);
    for (const double torque : {150.0, -40.0, 1e-3}) {
      double last = 0;
      constexpr int kRows = 3000;
      for (int i = 0; i <= kRows; ++i) {
        const double theta = 0.6 * i / kRows;
        const ToothLag lag = teeth.rest(theta, torque);
        if (i % 100 == 0) {
          const TeethAction action = teeth.act(theta, 100, lag, false);
          EXPECT_NEAR(teeth.torque_on_block(action), torque, 1e-11 * std::abs(torque) + 1e-9);
          EXPECT_NEAR(teeth.torque_on_shaft(action), -torque, 2e-3 * std::abs(torque));
        }
        // The lag moves with the errors: some micrometres a tooth, that is a mrad a rad.
        if (i > 0) {
          EXPECT_NEAR(lag.angle, last, 2e-6) << i;
        }
        last = lag.angle;
      }
    }
  }
}

// What Simbody has of the element does the work of its wrench, with no lever left out: shaft and
// block have their origins at C1 and O2.
TEST(TeethElement, DoesTheWorkOfItsWrench) {
  for (const FlankShape shape : kShapes) {
    PumpParameters pump = perfect_pump();
    pump.gear.teeth->shaft.runout = 5e-6;
    Assumptions assumptions;
    assumptions.flanks = shape;
    PumpSystem system(pump, assumptions, 1, Drive::given_acceleration);
    Placement placement(system);
    int corners = 0;
    for (int i = 0; i < 50; ++i) {
      const double theta = 0.3 * i, shaft_speed = 150, block_speed = 149.5 + 0.02 * i;
      placement.place({theta, shaft_speed, 0}, {theta, block_speed, 0});
      SimTK::State& state = system.dynamics();
      system.teeth_setting().lag = {(i % 2 == 0 ? 1 : -1) * 4e-4, shaft_speed - block_speed};
      SimTK::Vector_<SimTK::SpatialVec> forces;
      SimTK::Vector_<Vec3> particles;
      SimTK::Vector mobilities;
      system.bevel()->force().calcForceContribution(state, forces, particles, mobilities);
      double power = 0;
      Vec3 sum(0);
      for (SimTK::MobilizedBodyIndex b(1); b < system.matter().getNumBodies(); ++b) {
        const SimTK::SpatialVec& v = system.matter().getMobilizedBody(b).getBodyVelocity(state);
        power += dot(forces[b][0], v[0]) + dot(forces[b][1], v[1]);
        sum += forces[b][1];
      }
      const TeethAction action = system.bevel()->action(state);
      const Vec3 moment = vector_of(action.moment);
      const BevelTeeth& teeth = system.bevel()->teeth();
      const double on_block = dot(moment, teeth.block_axis());
      const double on_shaft = -dot(moment, teeth.shaft_axis());
      EXPECT_GT(std::abs(on_block), 1);
      EXPECT_NEAR(power, on_block * block_speed + on_shaft * shaft_speed,
                  1e-12 * std::abs(on_block * block_speed));
      EXPECT_LT(sum.norm(), 1e-12 * vector_of(action.force).norm());
      corners += std::abs(on_block + on_shaft) > 1e-6 * std::abs(on_block);
    }
    EXPECT_GT(corners, 0);
  }
}

TEST(BevelTeeth, RefusesWhatDoesNotMeshByName) {
  const auto message = [](const auto& change) -> std::string {
    PumpParameters pump = perfect_pump();
    change(pump);
    try {
      BevelTeeth(pump, FlankShape::involute);
    } catch (const InputError& error) {
      return error.what();
    }
    return "nothing";
  };
  EXPECT_EQ(message([](PumpParameters&) {}), "nothing");
  const auto expect = [&](const char* text, const auto& change) {
    EXPECT_NE(message(change).find(text), std::string::npos) << message(change);
  };
  expect("face_width_mm", [](PumpParameters& p) { p.gear.teeth->face_width = 0.12; });
  expect("dedendum_mm", [](PumpParameters& p) { p.gear.teeth->dedendum = 1e-3; });
  expect("contact ratio", [](PumpParameters& p) { p.gear.teeth->addendum = 1.5e-3; });
  expect("pointed", [](PumpParameters& p) {
    p.gear.teeth->addendum = 8e-3;
    p.gear.teeth->dedendum = 9e-3;
  });
}

}  // namespace
}  // namespace bentaxis::multibody
