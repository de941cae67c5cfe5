// Pins the signs and frames of Simbody 3.7 that multibody/conventions.h wraps, against free-body
// diagrams written here. Generic data: nothing is aligned with an axis by chance.
#include <SimTKsimbody.h>
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "conventions.h"
#include "scene/gear_mesh.h"
#include "scene/inline_joints.h"
#include "transfers/joint.h"

namespace bentaxis::multibody {
namespace {

using namespace SimTK;

struct World {
  World() : matter(system), forces(system) {}
  MultibodySystem system;
  SimbodyMatterSubsystem matter;
  GeneralForceSubsystem forces;
};

Body::Rigid some_body() {
  return Body::Rigid(MassProperties(1.7, Vec3(0.1, -0.2, 0.3), Inertia(0.9, 1.1, 1.3)));
}

double distance(const Vec3& a, const Vec3& b) { return (a - b).norm(); }

// A body welded to ground: the joint carries weight and applied force, with the sign of what
// ground exerts on the body, at M.
TEST(SimbodyConventions, JointForceIsWhatTheParentExertsOnTheBody) {
  World w;
  Force::UniformGravity(w.forces, w.matter, Vec3(0, -9, 0));
  const Transform frame(Rotation(0.4, ZAxis), Vec3(0.3, 0.2, 0.1));
  MobilizedBody::Weld body(w.matter.updGround(), frame, some_body(), Transform());
  State state = w.system.realizeTopology();
  w.system.realize(state, Stage::Acceleration);
  Vector_<SpatialVec> forces;
  joint_forces(state, w.matter, forces);
  const SpatialVec& f = forces[body.getMobilizedBodyIndex()];
  const Vec3 weight(0, -9 * 1.7, 0);
  const Vec3 lever = body.getBodyRotation(state) * Vec3(0.1, -0.2, 0.3);
  EXPECT_LT(distance(f[1], -weight), 1e-13);
  EXPECT_LT(distance(f[0], -(lever % weight)), 1e-13);
}

// A mass held on a line by PointOnLine: the constraint carries what is across the line.
TEST(SimbodyConventions, ConstraintForceOnTheFollowerBalancesItsLoad) {
  World w;
  MobilizedBody::Translation body(w.matter.updGround(), Transform(),
                                  Body::Rigid(MassProperties(2, Vec3(0), Inertia(1))), Transform());
  const UnitVec3 line(Vec3(1, 2, 3));
  const InlineJoint inline_joint(w.matter.updGround(), line, Vec3(0), body, Vec3(0));
  const Constraint& constraint = inline_joint.constraint();
  const Vec3 load(5, -7, 11);
  Force::ConstantForce(w.forces, body, Vec3(0), load);
  State state = w.system.realizeTopology();
  w.system.realize(state, Stage::Acceleration);
  const SpatialVec f = constraint_force_on(state, constraint, body);
  const Vec3 along = dot(load, Vec3(line)) * Vec3(line);
  EXPECT_LT(distance(f[1], -(load - along)), 1e-12);
  // The same through the wrapper that names its axes, and its equations measure along them.
  EXPECT_LT(distance(inline_joint.force_in_base(state), f[1]), 1e-12);
  body.setQToFitTranslation(state, Vec3(0.3, -0.2, 0.5));
  w.system.realize(state, Stage::Position);
  const int row = inline_joint.first_row(state);
  const Vec3 error = inline_joint.force_in_base(state.getQErr()[row], state.getQErr()[row + 1]);
  const Vec3 off = Vec3(0.3, -0.2, 0.5);
  EXPECT_LT(distance(error, off - dot(off, Vec3(line)) * Vec3(line)), 1e-15);
  w.system.realize(state, Stage::Acceleration);
  // Newton's third law on the other side.
  EXPECT_LT(distance(constraint_force_on(state, constraint, w.matter.getGround())[1], -f[1]),
            1e-12);
}

// Two followers on a shaft, each with a point on a line of a base that is on ground, or on the
// shaft too. Positions and speeds are anything: the equations are compared where they are not met.
struct TwoInlineJoints {
  TwoInlineJoints(bool as_one, bool base_on_shaft)
      : shaft(w.matter.updGround(), Transform(Vec3(0.1, 0.2, -0.3)), some_body(), Transform()),
        base(base_on_shaft ? static_cast<MobilizedBody&>(shaft) : w.matter.updGround(),
             Transform(Rotation(0.7, UnitVec3(1, 2, -1)), Vec3(0.3, -0.1, 0.2)), some_body(),
             Transform(Vec3(0.05, 0, 0.1))) {
    const UnitVec3 line(Vec3(1, -2, 3));
    const Vec3 point(0.2, 0.1, 0.4);
    const std::vector<Vec3> lines = {Vec3(0.1, 0.2, 0.3), Vec3(-0.2, 0.1, 0)};
    for (const Vec3& at : {Vec3(0.4, 0, 0.1), Vec3(-0.3, 0.2, 0)})
      followers.push_back(MobilizedBody::Ball(shaft, Transform(at), some_body(), Transform()));
    if (as_one) {
      all.emplace(base, line, lines, followers, point);
      for (int k = 0; k < 2; ++k) joints.emplace_back(*all, 2 * k, line);
    } else {
      for (int k = 0; k < 2; ++k) joints.emplace_back(base, line, lines[k], followers[k], point);
    }
    Force::UniformGravity(w.forces, w.matter, Vec3(1, -9, 2));
    state = w.system.realizeTopology();
    Random::Gaussian random(0, 1);
    random.setSeed(7);
    for (int i = 0; i < state.getNQ(); ++i) state.updQ()[i] = random.getValue();
    for (int i = 0; i < state.getNU(); ++i) state.updU()[i] = random.getValue();
    w.system.realize(state, Stage::Position);
    w.matter.normalizeQuaternions(state);
    w.system.realize(state, Stage::Acceleration);
  }
  World w;
  MobilizedBody::Ball shaft;
  MobilizedBody::Pin base;
  std::vector<MobilizedBody> followers;
  std::optional<InlineJoints> all;
  std::vector<InlineJoint> joints;
  State state;
};

TEST(InlineJoints, HaveTheEquationsOfSimbodysPointOnLine) {
  for (const bool base_on_shaft : {false, true}) {
    const TwoInlineJoints one(true, base_on_shaft), many(false, base_on_shaft);
    ASSERT_EQ(one.state.getNQErr(), many.state.getNQErr());
    EXPECT_GT(many.state.getQErr().normInf(), 0.1);
    EXPECT_GT(many.state.getUErr().normInf(), 0.1);
    EXPECT_LT((one.state.getQErr() - many.state.getQErr()).normInf(), 1e-15);
    EXPECT_LT((one.state.getUErr() - many.state.getUErr()).normInf(), 1e-13);
    Matrix g_one, g_many;
    one.w.matter.calcG(one.state, g_one);
    many.w.matter.calcG(many.state, g_many);
    EXPECT_LT((g_one - g_many).norm(), 1e-14 * g_many.norm());
    Vector bias_one, bias_many;
    one.w.matter.calcBiasForAccelerationConstraints(one.state, bias_one);
    many.w.matter.calcBiasForAccelerationConstraints(many.state, bias_many);
    EXPECT_GT(bias_many.norm(), 0.1);
    EXPECT_LT((bias_one - bias_many).norm(), 1e-13 * bias_many.norm());
    EXPECT_LT((one.state.getUDot() - many.state.getUDot()).norm(),
              1e-11 * many.state.getUDot().norm());
    for (int k = 0; k < 2; ++k) {
      const Vec3 force = many.joints[k].force_in_base(many.state);
      EXPECT_LT(distance(one.joints[k].force_in_base(one.state), force), 1e-11 * force.norm());
      EXPECT_EQ(one.joints[k].axis_x(), many.joints[k].axis_x());
      EXPECT_EQ(one.joints[k].first_row(one.state), many.joints[k].first_row(many.state));
    }
    const Vec3 on_base =
        constraint_force_on(many.state, many.joints[0].constraint(), many.base)[1] +
        constraint_force_on(many.state, many.joints[1].constraint(), many.base)[1];
    EXPECT_LT(
        distance(constraint_force_on(one.state, one.joints[0].constraint(), one.base)[1], on_base),
        1e-11 * on_base.norm());
  }
}

// A speed held against a load torque: the drive applies the opposite torque.
TEST(SimbodyConventions, SpeedAndAccelerationConstraintsApplyMinusTheirMultiplier) {
  for (const bool speed : {true, false}) {
    World w;
    MobilizedBody::Pin wheel(w.matter.updGround(), Transform(),
                             Body::Rigid(MassProperties(1, Vec3(0), Inertia(0.5))), Transform());
    Force::MobilityConstantForce(w.forces, wheel, -3.0);
    Constraint::ConstantSpeed hold_speed;
    Constraint::ConstantAcceleration hold_rate;
    if (speed)
      hold_speed = Constraint::ConstantSpeed(wheel, 0);
    else
      hold_rate = Constraint::ConstantAcceleration(wheel, 4.0);
    State state = w.system.realizeTopology();
    w.system.realize(state, Stage::Acceleration);
    const double torque = speed ? applied_generalized_force(state, hold_speed)
                                : applied_generalized_force(state, hold_rate);
    EXPECT_NEAR(torque, speed ? 3.0 : 3.0 + 0.5 * 4.0, 1e-13);
  }
}

// findMotionForces has the opposite sign too.
TEST(SimbodyConventions, MotionForcesAreMinusTheAppliedOnes) {
  World w;
  MobilizedBody::Pin wheel(w.matter.updGround(), Transform(),
                           Body::Rigid(MassProperties(1, Vec3(0), Inertia(0.5))), Transform());
  Motion::Steady motion(wheel, 2.0);
  Force::MobilityConstantForce(w.forces, wheel, -3.0);
  State state = w.system.realizeTopology();
  w.system.realize(state, Stage::Time);
  w.system.prescribeQ(state);
  w.system.realize(state, Stage::Position);
  w.system.prescribeU(state);
  w.system.realize(state, Stage::Acceleration);
  Vector torques;
  w.matter.findMotionForces(state, torques);
  EXPECT_NEAR(-torques[0], 3.0, 1e-13);
}

// Mobilizer reactions contain what a joint's own drive applies: a held pin reports the torque.
TEST(SimbodyConventions, JointForceIncludesTheTorqueOfItsMotion) {
  World w;
  MobilizedBody::Pin wheel(w.matter.updGround(), Transform(),
                           Body::Rigid(MassProperties(1, Vec3(0), Inertia(0.5))), Transform());
  Motion::Steady motion(wheel, 0.0);
  Force::ConstantTorque(w.forces, wheel, Vec3(1, 2, -3));
  State state = w.system.realizeTopology();
  w.system.realize(state, Stage::Acceleration);
  Vector_<SpatialVec> forces;
  joint_forces(state, w.matter, forces);
  EXPECT_LT(distance(forces[1][0], Vec3(-1, -2, 3)), 1e-13);
}

// Two wheels on crossing axes, meshed: the tooth force turns the driven one against its load, with
// the arm of the line about its axis, and its rate error vanishes at constant speed although the
// line has a part along the centripetal acceleration.
TEST(GearMesh, CarriesTheLoadOfTheDrivenWheelAndNoMore) {
  World w;
  const double tilt = 0.6;
  const double radius = 0.05;
  const double pressure_angle = 0.35;
  const Rotation frame(-tilt, XAxis);
  MobilizedBody::Pin shaft(w.matter.updGround(), Transform(),
                           Body::Rigid(MassProperties(1, Vec3(0), Inertia(2e-3))), Transform());
  MobilizedBody::Pin block(w.matter.updGround(), Transform(frame, Vec3(0)),
                           Body::Rigid(MassProperties(1, Vec3(0), Inertia(3e-3))), Transform());
  const double cone = Pi / 2 - tilt / 2;
  const Vec3 point(0, radius, -radius / std::tan(cone));
  const UnitVec3 line(Vec3(-std::cos(pressure_angle), std::sin(pressure_angle) * std::cos(cone),
                           std::sin(pressure_angle) * std::sin(cone)));
  GearMesh gear(w.matter, shaft, block, point, {Vec3(line), Vec3(line)}, frame);
  Constraint::ConstantSpeed drive(shaft, 100.0);
  Force::MobilityConstantForce(w.forces, block, -8.0);
  State state = w.system.realizeTopology();
  shaft.setOneQ(state, 0, 1.1);
  block.setOneQ(state, 0, 1.1);
  shaft.setOneU(state, 0, 100);
  block.setOneU(state, 0, 100);
  w.system.realize(state, Stage::Acceleration);
  EXPECT_LT(state.getQErr().normInf(), 1e-15);
  EXPECT_LT(state.getUErr().normInf(), 1e-12);
  EXPECT_LT(state.getUDot().normInf(), 1e-7);  // rad/s2; NoSlip1D would give thousands
  const double arm = radius * std::cos(pressure_angle);
  EXPECT_NEAR(gear.tooth_force(state), 8.0 / arm, 1e-9);
  EXPECT_NEAR(applied_generalized_force(state, drive), 8.0, 1e-10);
}

// The slow free-body twin of Simbody agrees with the fast routine on a loop.
TEST(SimbodyConventions, FreeBodyTwinGivesTheSameJointForces) {
  World w;
  Force::UniformGravity(w.forces, w.matter, Vec3(1, -9, 2));
  MobilizedBody::Ball first(w.matter.updGround(), Transform(Vec3(0.1, 0.2, 0.3)), some_body(),
                            Transform(Vec3(0.2, 0, -0.1)));
  MobilizedBody::Pin second(first, Transform(Rotation(0.3, YAxis), Vec3(0.5, 0.1, 0)), some_body(),
                            Transform(Vec3(0, 0.4, 0)));
  Constraint::PointOnLine loop(w.matter.updGround(), UnitVec3(Vec3(1, 1, 0.5)), Vec3(0.3, 0.2, 0.7),
                               second, Vec3(0.1, 0.2, 0.3));
  State state = w.system.realizeTopology();
  w.system.realize(state, Stage::Acceleration);
  Vector_<SpatialVec> fast;
  Vector_<SpatialVec> slow;
  joint_forces(state, w.matter, fast);
  w.matter.calcMobilizerReactionForcesUsingFreebodyMethod(state, slow);
  for (int i = 1; i < w.matter.getNumBodies(); ++i)
    EXPECT_LT((fast[i] - slow[i]).norm(), 1e-11 * slow[i].norm()) << i;
}

// A shaft and a block on axes that cross at an angle, turned at a speed and braked by a torque.
struct TurnedBlock {
  static constexpr double kTilt = 0.55, kSpeed = 37, kTorque = 11.3, kPhase = 0.4;

  // The block's inertia may be shared with a fork that turns with it.
  explicit TurnedBlock(double share_of_block)
      : frame(Rotation(-kTilt, XAxis), Vec3(0, 0, 0.02)),
        shaft(w.matter.updGround(), Transform(), Body::Rigid(rotor_of(0.002)), Transform()),
        block(w.matter.updGround(), frame, Body::Rigid(rotor_of(0.0015 * share_of_block)),
              Transform()),
        drive(shaft, MobilizerUIndex(0), kSpeed) {
    Force::ConstantTorque(w.forces, block, -kTorque * Vec3(frame.z()));
  }
  static MassProperties rotor_of(double inertia) { return {1, Vec3(0), Inertia(inertia)}; }

  void move(State& state, const AxisMotion& of_shaft, const AxisMotion& of_block) {
    shaft.setOneQ(state, 0, of_shaft.angle);
    block.setOneQ(state, 0, of_block.angle);
    shaft.setOneU(state, 0, of_shaft.speed);
    block.setOneU(state, 0, of_block.speed);
    w.system.realize(state, Stage::Velocity);
  }

  World w;
  Transform frame;
  MobilizedBody::Pin shaft, block;
  Constraint::ConstantSpeed drive;
};

// The equation of a universal joint against a real cross: Simbody's universal mobilizer is two
// forks with a cross that has no mass. Its outer fork turns with the block and has half of the
// block's inertia.
TEST(SimbodyConventions, UniversalJointIsTheUniversalMobilizer) {
  PumpParameters pump;
  pump.geometry.tilt = TurnedBlock::kTilt;
  pump.transfer.kind = TransferKind::cardan;
  pump.transfer.cardan = CardanJoint{TurnedBlock::kPhase};
  TurnedBlock by_equation(1);
  const BlockJoint joint(pump, by_equation.shaft, by_equation.block);

  TurnedBlock by_cross(0.5);
  // The mobilizer turns about x of the shaft's fork, then about y of the block's.
  const Transform fork(Rotation(-TurnedBlock::kPhase, ZAxis));
  MobilizedBody::Universal cross(by_cross.shaft, Transform(fork.R(), by_cross.frame.p()),
                                 Body::Rigid(MassProperties(1e-9, Vec3(0), Inertia(0.00075))),
                                 fork);
  const Constraint::ConstantOrientation with_block(by_cross.block, Rotation(), cross, Rotation());

  State one = by_equation.w.system.realizeTopology(), two = by_cross.w.system.realizeTopology();
  JointMotion law(pump);
  for (const double angle : {0.2, 0.9, 1.7, 2.4, 3.9, 5.5}) {
    const AxisMotion turning{angle, TurnedBlock::kSpeed, 0};
    const AxisMotion block = law.block(turning);
    by_equation.move(one, turning, block);
    by_equation.w.system.realize(one, Stage::Acceleration);
    by_cross.move(two, turning, block);
    // The cross fits between shaft and block, and lets their speeds through.
    const Rotation seen(~by_cross.shaft.getBodyRotation(two) * by_cross.block.getBodyRotation(two));
    cross.setQToFitRotation(two, Rotation(~fork.R() * seen * fork.R()));
    by_cross.w.system.realize(two, Stage::Velocity);
    const Vec3 rate =
        by_cross.block.getBodyAngularVelocity(two) - by_cross.shaft.getBodyAngularVelocity(two);
    cross.setUToFitAngularVelocity(two, ~fork.R() * (~by_cross.shaft.getBodyRotation(two) * rate));
    by_cross.w.system.realize(two, Stage::Acceleration);
    EXPECT_LT(two.getQErr().normInf(), 1e-14) << angle;
    EXPECT_LT(two.getUErr().normInf(), 1e-12) << angle;
    EXPECT_LT(one.getQErr().normInf(), 1e-14) << angle;
    EXPECT_NEAR(by_equation.block.getOneUDot(one, 0), block.acceleration, 1e-9) << angle;
    EXPECT_NEAR(by_cross.block.getOneUDot(two, 0), block.acceleration, 1e-7) << angle;
    // What the equation's couple and the constraint to the fork give the block: the fork's inertia
    // takes its half of the couple's part about the axis.
    Vec3 couple = constraint_force_on(two, with_block, by_cross.block)[0];
    couple += 0.00075 * by_cross.block.getOneUDot(two, 0) * Vec3(by_cross.frame.z());
    EXPECT_LT(distance(joint.on_block(one)[0], couple), 1e-8 * TurnedBlock::kTorque) << angle;
    EXPECT_EQ(joint.on_block(one)[1], Vec3(0)) << angle;
    EXPECT_NEAR(applied_generalized_force(one, by_equation.drive),
                applied_generalized_force(two, by_cross.drive), 1e-8 * TurnedBlock::kTorque);
  }
}

// The equation of two universal joints against two real crosses: Simbody's universal mobilizers on
// shaft and block, between them two pieces of a shaft that slide along each other. All is held at
// rest under a torque on the block: what the bodies exert does not depend on their masses, which
// Simbody needs.
TEST(SimbodyConventions, DoubleUniversalJointIsTwoUniversalMobilizersAndASlider) {
  constexpr double kDistance = 0.017, kOffset = 0.02;
  PumpParameters pump;
  pump.geometry.tilt = TurnedBlock::kTilt;
  pump.geometry.axis_offset = kOffset;
  pump.geometry.joint_circle_radius = 0.025;
  pump.transfer.kind = TransferKind::double_cardan;
  pump.transfer.cardan = CardanJoint{TurnedBlock::kPhase};
  pump.transfer.double_cardan = DoubleCardanJoint{kDistance};
  TurnedBlock by_equation(1);
  const BlockJoint joint(pump, by_equation.shaft, by_equation.block);

  TurnedBlock by_crosses(1);
  // Axes of either outer fork: its arm is x. A piece of the shaft between them has the line of the
  // crosses' centres as z and the arms of its fork as y.
  const Rotation fork(-TurnedBlock::kPhase, ZAxis);
  const Transform slide(Rotation(-Pi / 2, YAxis));   // its x is z
  const Transform swapped(Rotation(Pi / 2, ZAxis));  // its x and y are y and -x
  const Body::Rigid piece(MassProperties(0.1, Vec3(0), Inertia(1e-4)));
  MobilizedBody::Universal first(by_crosses.shaft, Transform(fork, Vec3(0, 0, kOffset - kDistance)),
                                 piece, Transform());
  MobilizedBody::Slider slider(first, slide, piece, slide);
  MobilizedBody::Universal second(slider, swapped, piece, swapped);
  const Constraint::Weld with_block(by_crosses.block, Transform(fork, Vec3(0, 0, kDistance)),
                                    second, Transform());

  State one = by_equation.w.system.realizeTopology(), two = by_crosses.w.system.realizeTopology();
  by_equation.drive.setSpeed(one, 0);
  by_crosses.drive.setSpeed(two, 0);
  JointMotion law(pump);
  for (const double angle : {0.2, 0.9, 1.7, 2.4, 3.9, 5.5}) {
    const AxisMotion block = law.block({angle, TurnedBlock::kSpeed, 120});
    EXPECT_NEAR(block.angle, angle, 1e-15);
    EXPECT_NEAR(block.speed, TurnedBlock::kSpeed, 1e-13 * TurnedBlock::kSpeed);
    EXPECT_NEAR(block.acceleration, 120, 1e-12 * std::pow(TurnedBlock::kSpeed, 2));
    const AxisMotion rest{angle, 0, 0};
    by_equation.move(one, rest, rest);
    by_equation.w.system.realize(one, Stage::Acceleration);

    by_crosses.move(two, rest, rest);
    const Rotation& of_shaft = by_crosses.shaft.getBodyRotation(two);
    const Rotation& of_block = by_crosses.block.getBodyRotation(two);
    const Vec3 o2 = by_crosses.frame.p();
    const Vec3 apart = o2 + kDistance * Vec3(of_block.z()) - (o2 - kDistance * Vec3(of_shaft.z()));
    const Rotation between(UnitVec3(apart), ZAxis, UnitVec3(apart % (of_shaft * Vec3(fork.x()))),
                           YAxis);
    first.setQToFitRotation(two, ~(of_shaft * fork) * between);
    slider.setLength(two, apart.norm());
    second.setQToFitRotation(two, ~(between * swapped.R()) * (of_block * fork * swapped.R()));
    by_crosses.w.system.realize(two, Stage::Acceleration);
    EXPECT_LT(two.getQErr().normInf(), 1e-14) << angle;
    EXPECT_LT(one.getQErr().normInf(), 1e-14) << angle;
    EXPECT_LT(two.getUDot().normInf(), 1e-8) << angle;

    const SpatialVec carried = joint.on_block(one);
    const SpatialVec real = constraint_force_on(two, with_block, by_crosses.block);
    const double force = TurnedBlock::kTorque / kDistance;
    EXPECT_LT(distance(carried[0], real[0]), 1e-9 * TurnedBlock::kTorque) << angle;
    EXPECT_LT(distance(carried[1], real[1]), 1e-9 * force) << angle;
    EXPECT_GT(real[1].norm(), 1e-2 * force) << angle;
    EXPECT_NEAR(applied_generalized_force(one, by_equation.drive),
                applied_generalized_force(two, by_crosses.drive), 1e-9 * TurnedBlock::kTorque);
    // What holds the shaft.
    Vector_<SpatialVec> held_one, held_two;
    joint_forces(one, by_equation.w.matter, held_one);
    joint_forces(two, by_crosses.w.matter, held_two);
    const SpatialVec off = held_one[by_equation.shaft.getMobilizedBodyIndex()] -
                           held_two[by_crosses.shaft.getMobilizedBodyIndex()];
    EXPECT_LT(off[0].norm(), 1e-9 * TurnedBlock::kTorque) << angle;
    EXPECT_LT(off[1].norm(), 1e-9 * force) << angle;
  }
}

}  // namespace
}  // namespace bentaxis::multibody
