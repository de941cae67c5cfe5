#include "scene/drive.h"

#include <cmath>

#include "conventions.h"

namespace bentaxis::multibody {

using SimTK::Real;
using SimTK::State;

namespace {

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

}  // namespace

SimTK::Motion turning_motion(SimTK::MobilizedBody& body, const Turning& turning, bool is_ball) {
  return SimTK::Motion::Custom(body, new TurningMotion(turning, is_ball));
}

ShaftDrive::ShaftDrive(Drive drive, SimTK::MobilizedBody& shaft, double omega) : drive_(drive) {
  constexpr int kAboutZ = 2;
  if (drive == Drive::constant_speed)
    speed_ = SimTK::Constraint::ConstantSpeed(shaft, SimTK::MobilizerUIndex(kAboutZ), omega);
  if (drive == Drive::given_acceleration)
    acceleration_ =
        SimTK::Constraint::ConstantAcceleration(shaft, SimTK::MobilizerUIndex(kAboutZ), 0);
}

void ShaftDrive::disable(State& state) const {
  if (drive_ == Drive::constant_speed) speed_.disable(state);
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
    case Drive::torque:
    case Drive::prescribed:
      break;
  }
  return 0;
}

}  // namespace bentaxis::multibody
