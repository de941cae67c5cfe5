#include "scene/drive_torque.h"

namespace bentaxis::multibody {

namespace {

// A torque of ordinary size, Nm: errors of the twist matter by what they do to it.
constexpr double kUnitTorque = 100;

}  // namespace

using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

class DriveTorque::Element : public SimTK::Force::Custom::Implementation {
 public:
  Element(const SimTK::GeneralForceSubsystem& forces, const TorqueInTime& drive,
          const SimTK::MobilizedBody& shaft, const SimTK::MobilizedBody& rotor)
      : forces_(forces), drive_(drive), shaft_(shaft), rotor_(rotor) {}

  void realizeTopology(State& state) const override {
    if (drive_.motor) twist_ = forces_.allocateZ(state, SimTK::Vector(1, 0.0));
  }
  void calcForce(const State& state, SimTK::Vector_<SpatialVec>& forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector&) const override {
    const double td = torque(state);
    forces[shaft_.getMobilizedBodyIndex()][0] += drive_.kept * td * z1();
    if (drive_.motor)
      forces[rotor_.getMobilizedBodyIndex()][0] += (motor_torque(state) - td) * z1();
  }
  double calcPotentialEnergy(const State&) const override { return 0; }
  void realizeAcceleration(const State& state) const override {
    if (drive_.motor)
      forces_.updZDot(state)[twist_] = (speed(state, rotor_) - speed(state, shaft_)) / unit();
  }

  double torque(const State& state) const {
    if (!drive_.motor) return drive_.torque(state.getTime());
    return drive_.motor->coupling_stiffness * twist(state) +
           drive_.motor->coupling_damping * (speed(state, rotor_) - speed(state, shaft_));
  }
  double power(const State& state) const {
    return drive_.motor ? motor_torque(state) * speed(state, rotor_)
                        : drive_.kept * torque(state) * speed(state, shaft_);
  }
  double twist(const State& state) const { return unit() * forces_.getZ(state)[twist_]; }
  void set_twist(State& state, double twist) const { forces_.updZ(state)[twist_] = twist / unit(); }
  double rotor_speed(const State& state) const { return speed(state, rotor_); }
  void set_rotor_speed(State& state, double speed) const { rotor_.setOneU(state, 0, speed); }
  int rotor_u(const State& state) const { return rotor_.getFirstUIndex(state); }

 private:
  double unit() const { return kUnitTorque / drive_.motor->coupling_stiffness; }
  static Vec3 z1() { return {0, 0, 1}; }
  static double speed(const State& state, const SimTK::MobilizedBody& body) {
    return body.getBodyAngularVelocity(state)[2];
  }
  double motor_torque(const State& state) const {
    return drive_.motor_torque(speed(state, rotor_));
  }

  const SimTK::GeneralForceSubsystem& forces_;
  TorqueInTime drive_;
  const SimTK::MobilizedBody& shaft_;
  SimTK::MobilizedBody rotor_;
  mutable SimTK::ZIndex twist_;
};

DriveTorque::DriveTorque(SimTK::SimbodyMatterSubsystem& matter,
                         SimTK::GeneralForceSubsystem& forces, const TorqueInTime& drive,
                         const SimTK::MobilizedBody& shaft)
    : drive_(drive) {
  SimTK::MobilizedBody rotor;
  if (drive.motor) {
    // Only its axial inertia acts: it turns about a fixed axis through its centre of mass.
    const double inertia = drive.motor->rotor_inertia;
    rotor = SimTK::MobilizedBody::Pin(
        matter.updGround(), SimTK::Transform(),
        SimTK::Body::Rigid(SimTK::MassProperties(1, Vec3(0), SimTK::Inertia(inertia))),
        SimTK::Transform());
  }
  element_ = new Element(forces, drive, shaft, rotor);
  SimTK::Force::Custom(forces, element_);
}

double DriveTorque::rotor_speed(const State& state) const { return element_->rotor_speed(state); }
double DriveTorque::torque(const State& state) const { return element_->torque(state); }
double DriveTorque::power(const State& state) const { return element_->power(state); }

int DriveTorque::rotor_u(const State& state) const { return element_->rotor_u(state); }

void DriveTorque::set_rotor_speed(State& state, double speed) const {
  if (drive_.motor) element_->set_rotor_speed(state, speed);
}
void DriveTorque::set_twist(State& state, double twist) const {
  if (drive_.motor) element_->set_twist(state, twist);
}

void DriveTorque::start(State& state, double speed, double torque) const {
  if (!drive_.motor) return;
  set_rotor_speed(state, speed);
  set_twist(state, torque / drive_.motor->coupling_stiffness);
}

double DriveTorque::elastic_energy(const State& state) const {
  if (!drive_.motor) return 0;
  const double twist = element_->twist(state);
  return drive_.motor->coupling_stiffness * twist * twist / 2;
}

}  // namespace bentaxis::multibody
