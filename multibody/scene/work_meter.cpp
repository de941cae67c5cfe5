#include "scene/work_meter.h"

#include <utility>

namespace bentaxis::multibody {

using SimTK::Real;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vector;

// A force element without force.
class WorkMeter::Implementation : public SimTK::Force::Custom::Implementation {
 public:
  Implementation(const SimTK::MultibodySystem& system, const SimTK::SimbodyMatterSubsystem& matter,
                 const SimTK::GeneralForceSubsystem& forces,
                 std::function<double(const State&)> drives, double unit)
      : system_(system),
        matter_(matter),
        forces_(forces),
        drives_(std::move(drives)),
        unit_(unit) {}

  void calcForce(const State&, SimTK::Vector_<SpatialVec>&, SimTK::Vector_<SimTK::Vec3>&,
                 Vector&) const override {}
  Real calcPotentialEnergy(const State&) const override { return 0; }
  void realizeTopology(State& state) const override {
    first_ = forces_.allocateZ(state, Vector(2, Real(0)));
  }
  void realizeAcceleration(const State& state) const override {
    Vector& rate = forces_.updZDot(state);
    rate[first_] = power_of_loads(state) / unit_;
    rate[first_ + 1] = drives_(state) / unit_;
  }
  double power_of_loads(const State& state) const {
    const auto& forces = system_.getRigidBodyForces(state, SimTK::Stage::Dynamics);
    double loads = 0;
    for (SimTK::MobilizedBodyIndex i(1); i < matter_.getNumBodies(); ++i) {
      const SpatialVec& v = matter_.getMobilizedBody(i).getBodyVelocity(state);
      loads += SimTK::dot(forces[i][0], v[0]) + SimTK::dot(forces[i][1], v[1]);
    }
    return loads;
  }
  double value(const State& state, int which) const {
    return unit_ * forces_.getZ(state)[first_ + which];
  }

 private:
  const SimTK::MultibodySystem& system_;
  const SimTK::SimbodyMatterSubsystem& matter_;
  const SimTK::GeneralForceSubsystem& forces_;
  std::function<double(const State&)> drives_;
  double unit_;
  mutable SimTK::ZIndex first_;
};

WorkMeter::WorkMeter(const SimTK::MultibodySystem& system,
                     const SimTK::SimbodyMatterSubsystem& matter,
                     SimTK::GeneralForceSubsystem& forces,
                     std::function<double(const State&)> drives, double unit)
    : implementation_(new Implementation(system, matter, forces, std::move(drives), unit)) {
  SimTK::Force::Custom(forces, implementation_);
}

double WorkMeter::of_loads(const State& state) const { return implementation_->value(state, 0); }
double WorkMeter::of_drives(const State& state) const { return implementation_->value(state, 1); }
double WorkMeter::power_of_loads(const State& state) const {
  return implementation_->power_of_loads(state);
}

}  // namespace bentaxis::multibody
