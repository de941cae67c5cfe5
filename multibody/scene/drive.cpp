#include "scene/drive.h"

#include <cmath>
#include <utility>

#include "conventions.h"
#include "scene/gear_mesh.h"

namespace bentaxis::multibody {

using SimTK::Real;
using SimTK::State;

namespace {

template <class T>
using Bodies = SimTK::Array_<T, SimTK::ConstrainedBodyIndex>;

class TurningMotion : public SimTK::Motion::Custom::Implementation {
 public:
  TurningMotion(const Turning& turning, bool is_ball) : turning_(turning), is_ball_(is_ball) {}
  TurningMotion* clone() const override { return new TurningMotion(*this); }
  SimTK::Motion::Level getLevel(const State&) const override { return SimTK::Motion::Position; }
  SimTK::Motion::Method getLevelMethod(const State&) const override {
    return SimTK::Motion::Prescribed;
  }
  void calcPrescribedPosition(const State& s, int, Real* q) const override {
    const double angle = turning_.angle(s.getTime());
    if (!is_ball_) {
      q[0] = angle;
      return;
    }
    q[0] = std::cos(angle / 2);
    q[1] = q[2] = 0;
    q[3] = std::sin(angle / 2);
  }
  void calcPrescribedPositionDot(const State& s, int, Real* qdot) const override {
    const double angle = turning_.angle(s.getTime());
    if (!is_ball_) {
      qdot[0] = turning_.omega;
      return;
    }
    qdot[0] = -std::sin(angle / 2) * turning_.omega / 2;
    qdot[1] = qdot[2] = 0;
    qdot[3] = std::cos(angle / 2) * turning_.omega / 2;
  }
  void calcPrescribedPositionDotDot(const State& s, int, Real* qdotdot) const override {
    const double angle = turning_.angle(s.getTime());
    const double half = turning_.omega / 2;
    const double half_dot = turning_.omega_dot / 2;
    if (!is_ball_) {
      qdotdot[0] = turning_.omega_dot;
      return;
    }
    qdotdot[0] = -std::cos(angle / 2) * half * half - std::sin(angle / 2) * half_dot;
    qdotdot[1] = qdotdot[2] = 0;
    qdotdot[3] = -std::sin(angle / 2) * half * half + std::cos(angle / 2) * half_dot;
  }

 private:
  const Turning& turning_;
  bool is_ball_;
};

// Holds the shaft's angle: the arc at a radius, so that its multiplier is a force and its error a
// length, like those of the other equations.
class GivenTurning : public SimTK::Constraint::Custom::Implementation {
 public:
  GivenTurning(SimTK::MobilizedBody& shaft, TurningInTime turning, double radius)
      : Implementation(shaft.updMatterSubsystem(), 1, 0, 0),
        turning_(std::move(turning)),
        radius_(radius) {
    addConstrainedBody(shaft.updMatterSubsystem().updGround());
    shaft_ = addConstrainedBody(shaft);
  }
  Implementation* clone() const override { return new GivenTurning(*this); }

  void calcPositionErrors(const State& state, const Bodies<SimTK::Transform>& bodies,
                          const SimTK::Array_<Real, SimTK::ConstrainedQIndex>&,
                          SimTK::Array_<Real>& error) const override {
    const double angle = turn_angle(bodies[shaft_].R(), SimTK::Rotation());
    error[0] = radius_ * std::remainder(angle - turning_(state.getTime()).angle, 2 * SimTK::Pi);
  }
  void calcPositionDotErrors(const State& state, const Bodies<SimTK::SpatialVec>& velocities,
                             const SimTK::Array_<Real, SimTK::ConstrainedQIndex>&,
                             SimTK::Array_<Real>& error) const override {
    error[0] = radius_ * (velocities[shaft_][0][2] - turning_(state.getTime()).speed);
  }
  void calcPositionDotDotErrors(const State& state, const Bodies<SimTK::SpatialVec>& accelerations,
                                const SimTK::Array_<Real, SimTK::ConstrainedQIndex>&,
                                SimTK::Array_<Real>& error) const override {
    error[0] = radius_ * (accelerations[shaft_][0][2] - turning_(state.getTime()).acceleration);
  }
  void addInPositionConstraintForces(
      const State&, const SimTK::Array_<Real>& multipliers, Bodies<SimTK::SpatialVec>& forces,
      SimTK::Array_<Real, SimTK::ConstrainedQIndex>&) const override {
    forces[shaft_][0][2] += radius_ * multipliers[0];
  }

 private:
  TurningInTime turning_;
  double radius_;
  SimTK::ConstrainedBodyIndex shaft_;
};

}  // namespace

SimTK::Motion turning_motion(SimTK::MobilizedBody& body, const Turning& turning, bool is_ball) {
  return SimTK::Motion::Custom(body, new TurningMotion(turning, is_ball));
}

ShaftDrive::ShaftDrive(Drive drive, SimTK::MobilizedBody& shaft, double omega,
                       const TurningInTime& turning, double radius)
    : drive_(drive), radius_(radius) {
  constexpr int kAboutZ = 2;
  if (drive == Drive::constant_speed)
    speed_ = SimTK::Constraint::ConstantSpeed(shaft, SimTK::MobilizerUIndex(kAboutZ), omega);
  if (drive == Drive::given_turning)
    turning_ = SimTK::Constraint::Custom(new GivenTurning(shaft, turning, radius));
  if (drive == Drive::given_acceleration)
    acceleration_ =
        SimTK::Constraint::ConstantAcceleration(shaft, SimTK::MobilizerUIndex(kAboutZ), 0);
}

void ShaftDrive::disable(State& state) const {
  if (drive_ == Drive::constant_speed) speed_.disable(state);
  if (drive_ == Drive::given_turning) turning_.disable(state);
  if (drive_ == Drive::given_acceleration) acceleration_.disable(state);
}

void ShaftDrive::set_acceleration(State& state, double omega_dot) const {
  if (acceleration_.getAcceleration(state) != omega_dot)
    acceleration_.setAcceleration(state, omega_dot);
}

double ShaftDrive::torque(const State& state) const {
  switch (drive_) {
    case Drive::constant_speed:
      return applied_generalized_force(state, speed_);
    case Drive::given_acceleration:
      return applied_generalized_force(state, acceleration_);
    case Drive::given_turning:
      return -radius_ * turning_.getMultipliersAsVector(state)[0];
    case Drive::torque:
    case Drive::prescribed:
      break;
  }
  return 0;
}

}  // namespace bentaxis::multibody
