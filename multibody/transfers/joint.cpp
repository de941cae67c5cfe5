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

// Arm of a fork and centre of its cross, in the body of the fork.
struct Fork {
  Vec3 arm, centre;
};

// (P2 - P1).(a1 x a2) = 0 of the centres P of the crosses and the arms a of the forks of shaft and
// block. The error is a length: times a radius, over twice the distance of a centre from O2.
class CrossesEquation : public SimTK::Constraint::Custom::Implementation {
 public:
  CrossesEquation(SimTK::MobilizedBody& shaft, const Fork& on_shaft, SimTK::MobilizedBody& block,
                  const Fork& on_block, double scale)
      : Implementation(shaft.updMatterSubsystem(), 1, 0, 0),
        on_shaft_(on_shaft),
        on_block_(on_block),
        scale_(scale) {
    shaft_ = addConstrainedBody(shaft);
    block_ = addConstrainedBody(block);
  }
  Implementation* clone() const override { return new CrossesEquation(*this); }

  void calcPositionErrors(const State&, const Bodies<SimTK::Transform>& bodies, const Coordinates&,
                          SimTK::Array_<Real>& error) const override {
    const SimTK::Transform& s = bodies[shaft_];
    const SimTK::Transform& b = bodies[block_];
    error[0] = scale_ * dot(b * on_block_.centre - s * on_shaft_.centre,
                            (s.R() * on_shaft_.arm) % (b.R() * on_block_.arm));
  }
  void calcPositionDotErrors(const State& state, const Bodies<SpatialVec>& velocities,
                             const Coordinates&, SimTK::Array_<Real>& error) const override {
    const Placed at(*this, state);
    const Vec3 apart = findStationVelocity(state, velocities, block_, on_block_.centre) -
                       findStationVelocity(state, velocities, shaft_, on_shaft_.centre);
    error[0] =
        scale_ * (dot(at.normal(), apart) + dot(at.couple_on_block(), velocities[block_][0]) +
                  dot(at.couple_on_shaft(), velocities[shaft_][0]));
  }
  void calcPositionDotDotErrors(const State& state, const Bodies<SpatialVec>& accelerations,
                                const Coordinates&, SimTK::Array_<Real>& error) const override {
    const Placed at(*this, state);
    const Vec3 apart_rate = findStationVelocityFromState(state, block_, on_block_.centre) -
                            findStationVelocityFromState(state, shaft_, on_shaft_.centre);
    const Vec3 apart_second =
        findStationAcceleration(state, accelerations, block_, on_block_.centre) -
        findStationAcceleration(state, accelerations, shaft_, on_shaft_.centre);
    const Vec3& ws = getBodyVelocityFromState(state, shaft_)[0];
    const Vec3& wb = getBodyVelocityFromState(state, block_)[0];
    const Vec3 a_rate = ws % at.shaft_arm, b_rate = wb % at.block_arm;
    const Vec3 a_second = accelerations[shaft_][0] % at.shaft_arm + ws % a_rate;
    const Vec3 b_second = accelerations[block_][0] % at.block_arm + wb % b_rate;
    const Vec3 normal_rate = a_rate % at.block_arm + at.shaft_arm % b_rate;
    const Vec3 normal_second =
        a_second % at.block_arm + 2.0 * (a_rate % b_rate) + at.shaft_arm % b_second;
    error[0] = scale_ * (dot(at.normal(), apart_second) + 2 * dot(normal_rate, apart_rate) +
                         dot(normal_second, at.apart));
  }
  void addInPositionConstraintForces(
      const State& state, const SimTK::Array_<Real>& multipliers, Bodies<SpatialVec>& forces,
      SimTK::Array_<Real, SimTK::ConstrainedQIndex>&) const override {
    const Placed at(*this, state);
    const Real size = scale_ * multipliers[0];
    addInStationForce(state, block_, on_block_.centre, size * at.normal(), forces);
    addInStationForce(state, shaft_, on_shaft_.centre, -size * at.normal(), forces);
    forces[block_][0] += size * at.couple_on_block();
    forces[shaft_][0] += size * at.couple_on_shaft();
  }

 private:
  // In Ground: from the shaft's cross to the block's, and the arms.
  struct Placed {
    Placed(const CrossesEquation& of, const State& state)
        : apart(of.findStationLocationFromState(state, of.block_, of.on_block_.centre) -
                of.findStationLocationFromState(state, of.shaft_, of.on_shaft_.centre)),
          shaft_arm(of.getBodyRotationFromState(state, of.shaft_) * of.on_shaft_.arm),
          block_arm(of.getBodyRotationFromState(state, of.block_) * of.on_block_.arm) {}
    // Gradients of the equation over its scale: by the place of the block's cross, and by turns of
    // either body about the centre of its cross.
    Vec3 normal() const { return shaft_arm % block_arm; }
    Vec3 couple_on_block() const { return block_arm % (apart % shaft_arm); }
    Vec3 couple_on_shaft() const { return shaft_arm % (block_arm % apart); }

    Vec3 apart, shaft_arm, block_arm;
  };

  Fork on_shaft_, on_block_;
  double scale_;
  SimTK::ConstrainedBodyIndex shaft_, block_;
};

SimTK::Constraint joint_of(const PumpParameters& pump, SimTK::MobilizedBody& shaft,
                           SimTK::MobilizedBody& block) {
  if (pump.transfer.kind == TransferKind::constant_velocity)
    return SimTK::Constraint::Custom(
        new MirrorEquation(shaft, block, pump.geometry.joint_circle_radius));
  // The arms as they lie in the bodies at theta = psi = 0. At theta = psi = phase those of shaft
  // and block point along x and y, of two universal joints both along x.
  const Rotation back(-pump.transfer.phase(), SimTK::ZAxis);
  if (pump.transfer.kind == TransferKind::double_cardan) {
    // The bodies' frames are S1 and S2.
    const double distance = pump.transfer.double_cardan->cross_distance;
    const Vec3 arm(back.x());
    return SimTK::Constraint::Custom(new CrossesEquation(
        shaft, {arm, Vec3(0, 0, pump.geometry.axis_offset - distance)}, block,
        {arm, Vec3(0, 0, distance)}, pump.geometry.joint_circle_radius / (2 * distance)));
  }
  return SimTK::Constraint::ConstantAngle(shaft, back.x(), block, back.y(), kPi / 2);
}

}  // namespace

BlockJoint::BlockJoint(const PumpParameters& pump, SimTK::MobilizedBody& shaft,
                       SimTK::MobilizedBody& block)
    : shaft_(shaft),
      block_(block),
      centre_(block_frame(pump.geometry).p()),
      constraint_(joint_of(pump, shaft, block)) {}

SpatialVec BlockJoint::on_block(const State& state) const {
  return about_centre(state, block_, constraint_force_on(state, constraint_, block_));
}
SpatialVec BlockJoint::unit_on_block(const State& state) const { return unit_on(state, block_); }
SpatialVec BlockJoint::unit_on_shaft(const State& state) const { return unit_on(state, shaft_); }

SpatialVec BlockJoint::unit_on(const State& state, const SimTK::MobilizedBody& body) const {
  return about_centre(state, body, unit_constraint_force_on(state, constraint_, body));
}

// From a force at the body's origin with the moment about it.
SpatialVec BlockJoint::about_centre(const State& state, const SimTK::MobilizedBody& body,
                                    SpatialVec force) const {
  force[0] += (body.getBodyOriginLocation(state) - centre_) % force[1];
  return force;
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
