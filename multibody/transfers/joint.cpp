#include "transfers/joint.h"

#include <cmath>

#include "bentaxis/pump/units.h"
#include "conventions.h"
#include "scene/block.h"
#include "scene/mass_properties.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::Real;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::UnitVec3;
using SimTK::Vec3;

namespace {

template <class T>
using Bodies = SimTK::Array_<T, SimTK::ConstrainedBodyIndex>;
using Coordinates = SimTK::Array_<Real, SimTK::ConstrainedQIndex>;

// The error of the equation is a length, like those of the others: times a radius.
class MirrorEquation : public SimTK::Constraint::Custom::Implementation {
 public:
  MirrorEquation(SimTK::MobilizedBody& shaft, SimTK::MobilizedBody& block, double radius)
      : Implementation(shaft.updMatterSubsystem(), 1, 0, 0), radius_(radius) {
    shaft_ = addConstrainedBody(shaft);
    block_ = addConstrainedBody(block);
  }
  Implementation* clone() const override { return new MirrorEquation(*this); }

  void calcPositionErrors(const State&, const Bodies<SimTK::Transform>& bodies, const Coordinates&,
                          SimTK::Array_<Real>& error) const override {
    const Rotation& s = bodies[shaft_].R();
    const Rotation& b = bodies[block_].R();
    error[0] = radius_ * (dot(Vec3(s.x()), Vec3(b.y())) - dot(Vec3(s.y()), Vec3(b.x())));
  }
  void calcPositionDotErrors(const State& state, const Bodies<SpatialVec>& velocities,
                             const Coordinates&, SimTK::Array_<Real>& error) const override {
    error[0] = dot(gradient(state), velocities[block_][0] - velocities[shaft_][0]);
  }
  void calcPositionDotDotErrors(const State& state, const Bodies<SpatialVec>& accelerations,
                                const Coordinates&, SimTK::Array_<Real>& error) const override {
    const Rotation& s = getBodyRotationFromState(state, shaft_);
    const Rotation& b = getBodyRotationFromState(state, block_);
    const Vec3& ws = getBodyVelocityFromState(state, shaft_)[0];
    const Vec3& wb = getBodyVelocityFromState(state, block_)[0];
    const Vec3 xs(s.x()), ys(s.y()), xb(b.x()), yb(b.y());
    const Vec3 gradient_rate = (wb % yb) % xs + yb % (ws % xs) - (wb % xb) % ys - xb % (ws % ys);
    error[0] = dot(gradient(state), accelerations[block_][0] - accelerations[shaft_][0]) +
               radius_ * dot(gradient_rate, wb - ws);
  }
  void addInPositionConstraintForces(
      const State& state, const SimTK::Array_<Real>& multipliers, Bodies<SpatialVec>& forces,
      SimTK::Array_<Real, SimTK::ConstrainedQIndex>&) const override {
    const Vec3 couple = multipliers[0] * gradient(state);
    forces[block_][0] += couple;
    forces[shaft_][0] -= couple;
  }

 private:
  // Of the error by a turn of the block; by one of the shaft it is the opposite.
  Vec3 gradient(const State& state) const {
    const Rotation& s = getBodyRotationFromState(state, shaft_);
    const Rotation& b = getBodyRotationFromState(state, block_);
    return radius_ * (Vec3(b.y()) % Vec3(s.x()) - Vec3(b.x()) % Vec3(s.y()));
  }

  double radius_;
  SimTK::ConstrainedBodyIndex shaft_, block_;
};

SimTK::Constraint joint_of(const PumpParameters& pump, SimTK::MobilizedBody& shaft,
                           SimTK::MobilizedBody& block) {
  if (pump.transfer.kind == TransferKind::constant_velocity)
    return SimTK::Constraint::Custom(
        new MirrorEquation(shaft, block, pump.geometry.joint_circle_radius));
  // The arms as they lie in the bodies at theta = psi = 0. At theta = psi = phase those of shaft
  // and block point along x and y.
  const Rotation back(-pump.transfer.cardan.value_or(CardanJoint()).phase, SimTK::ZAxis);
  return SimTK::Constraint::ConstantAngle(shaft, back.x(), block, back.y(), kPi / 2);
}

}  // namespace

BlockJoint::BlockJoint(const PumpParameters& pump, SimTK::MobilizedBody& shaft,
                       SimTK::MobilizedBody& block)
    : shaft_(shaft), block_(block), constraint_(joint_of(pump, shaft, block)) {}

Vec3 BlockJoint::couple_on_block(const State& state) const {
  return constraint_force_on(state, constraint_, block_)[0];
}
Vec3 BlockJoint::unit_couple_on_block(const State& state) const {
  return unit_couple(state, block_);
}
Vec3 BlockJoint::unit_couple_on_shaft(const State& state) const {
  return unit_couple(state, shaft_);
}

Vec3 BlockJoint::unit_couple(const State& state, const SimTK::MobilizedBody& body) const {
  return unit_constraint_force_on(state, constraint_, body)[0];
}

JointMotion::JointMotion(const PumpParameters& pump) : matter_(system_) {
  const SimTK::Body::Rigid body(rotor(0, 0, 0));
  shaft_ =
      SimTK::MobilizedBody::Pin(matter_.updGround(), SimTK::Transform(), body, SimTK::Transform());
  block_ = SimTK::MobilizedBody::Pin(matter_.updGround(), block_frame(pump.geometry), body,
                                     SimTK::Transform());
  joint_of(pump, shaft_, block_);
  system_.realizeTopology();
  state_ = system_.getDefaultState();
  system_.realize(state_, SimTK::Stage::Instance);
}

double JointMotion::error_at(double shaft_angle, double block_angle) {
  shaft_.setOneQ(state_, 0, shaft_angle);
  block_.setOneQ(state_, 0, block_angle);
  system_.realize(state_, SimTK::Stage::Position);
  return state_.getQErr()[0];
}

AxisMotion JointMotion::block(const AxisMotion& shaft) {
  // The block's axes, and with them the equation, are linear in cosine and sine of its angle: two
  // of its errors a right angle apart give the root. A step of Newton's method takes the round-off.
  const double here = error_at(shaft.angle, shaft.angle);
  const double across = error_at(shaft.angle, shaft.angle + kPi / 2);
  AxisMotion block{shaft.angle - std::atan(here / across), 0, 0};
  const double left = error_at(shaft.angle, block.angle);
  SimTK::Matrix g;
  state_.updU() = 0;
  system_.realize(state_, SimTK::Stage::Velocity);
  matter_.calcG(state_, g);
  block.angle -= left / g(0, 1);
  block.speed = -g(0, 0) * shaft.speed / g(0, 1);
  shaft_.setOneU(state_, 0, shaft.speed);
  block_.setOneU(state_, 0, block.speed);
  system_.realize(state_, SimTK::Stage::Velocity);
  SimTK::Vector bias;
  matter_.calcBiasForAccelerationConstraints(state_, bias);
  block.acceleration = -(g(0, 0) * shaft.acceleration + bias[0]) / g(0, 1);
  return block;
}

}  // namespace bentaxis::multibody
