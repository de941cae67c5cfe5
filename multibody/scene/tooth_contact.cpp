#include "scene/tooth_contact.h"

#include <algorithm>
#include <cmath>

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

namespace {

// A tooth force of ordinary size, N: errors of the approach matter by what they do to forces.
constexpr double kUnitForce = 100;

// The law's elastic part; beyond the touch it goes on as it began, for a step that lands on it.
double elastic_force(const ToothCompliance& teeth, double approach) {
  const double size = teeth.stiffness * kToothApproach *
                      std::pow(std::abs(approach) / kToothApproach, teeth.exponent);
  return std::copysign(size, approach);
}

}  // namespace

double flank_force(const ToothCompliance& teeth, double approach, double rate) {
  if (!(approach > 0)) return 0;
  return std::max(0.0, elastic_force(teeth, approach) * (1 + teeth.dissipation * rate));
}

double tooth_force(const ToothCompliance& teeth, double advance, double rate) {
  const double play = teeth.backlash / 2;
  return flank_force(teeth, advance - play, rate) - flank_force(teeth, -advance - play, -rate);
}

ToothBranch tooth_branch_at(const ToothCompliance& teeth, double advance, double rate) {
  for (const int flank : {1, -1})
    if (flank * advance - teeth.backlash / 2 > 0)
      return {flank, !(1 + teeth.dissipation * flank * rate > 0)};
  return {};
}

double flank_energy(const ToothCompliance& teeth, double approach) {
  const double pressed = std::max(0.0, approach);
  return elastic_force(teeth, pressed) * pressed / (teeth.exponent + 1);
}

class CompliantTeeth::Element : public SimTK::Force::Custom::Implementation {
 public:
  Element(const SimTK::GeneralForceSubsystem& forces, const ToothCompliance& teeth, double unit,
          const GearMesh& gear, const SimTK::MobilizedBody& shaft,
          const SimTK::MobilizedBody& block, const ToothBranch& branch)
      : forces_(forces),
        teeth_(teeth),
        unit_(unit),
        gear_(gear),
        shaft_(shaft),
        block_(block),
        branch_(branch) {}

  void realizeTopology(State& state) const override {
    first_ = forces_.allocateZ(state, SimTK::Vector(2, 0.0));
  }
  void calcForce(const State& state, SimTK::Vector_<SpatialVec>& forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector&) const override {
    const double size = force(state);
    if (size == 0) return;
    const Vec3 on_block = size * gear_.line_for(size);
    forces[block_.getMobilizedBodyIndex()] += SpatialVec(lever(state, block_) % on_block, on_block);
    forces[shaft_.getMobilizedBodyIndex()] -= SpatialVec(lever(state, shaft_) % on_block, on_block);
  }
  double calcPotentialEnergy(const State&) const override { return 0; }
  void realizeAcceleration(const State& state) const override {
    SimTK::Vector& rates = forces_.updZDot(state);
    rates[first_] = rate(state) / unit_;
    rates[first_ + 1] = std::abs(force(state)) / kUnitForce;
  }

  double advance(const State& state) const { return unit_ * forces_.getZ(state)[first_]; }
  void set_advance(State& state, double advance) const {
    forces_.updZ(state)[first_] = advance / unit_;
  }
  double impulse(const State& state) const { return kUnitForce * forces_.getZ(state)[first_ + 1]; }
  double rate(const State& state) const {
    return dot(gear_.line_for(1), velocity(state, shaft_) - velocity(state, block_));
  }
  double approach(const State& state, int flank) const {
    return flank * advance(state) - teeth_.backlash / 2;
  }
  double force(const State& state) const {
    const int flank = branch_.flank;
    if (flank == 0 || branch_.released) return 0;
    return flank * elastic_force(teeth_, approach(state, flank)) *
           (1 + teeth_.dissipation * flank * rate(state));
  }

 private:
  // Mesh point from the body's origin, in Ground.
  Vec3 lever(const State& state, const SimTK::MobilizedBody& body) const {
    return gear_.point() - body.getBodyOriginLocation(state);
  }
  // Of the body's material that passes the mesh point.
  Vec3 velocity(const State& state, const SimTK::MobilizedBody& body) const {
    const SpatialVec& v = body.getBodyVelocity(state);
    return v[1] + v[0] % lever(state, body);
  }

  const SimTK::GeneralForceSubsystem& forces_;
  ToothCompliance teeth_;
  double unit_;
  const GearMesh& gear_;
  const SimTK::MobilizedBody &shaft_, &block_;
  const ToothBranch& branch_;
  mutable SimTK::ZIndex first_;
};

CompliantTeeth::CompliantTeeth(SimTK::GeneralForceSubsystem& forces, const ToothCompliance& teeth,
                               const GearMesh& gear, const SimTK::MobilizedBody& shaft,
                               const SimTK::MobilizedBody& block, const ToothBranch& branch)
    : teeth_(teeth),
      unit_(kToothApproach *
            std::pow(kUnitForce / (teeth.stiffness * kToothApproach), 1 / teeth.exponent)),
      element_(new Element(forces, teeth, unit_, gear, shaft, block, branch)) {
  SimTK::Force::Custom(forces, element_);
}

double CompliantTeeth::advance(const State& state) const { return element_->advance(state); }
void CompliantTeeth::set_advance(State& state, double advance) const {
  element_->set_advance(state, advance);
}
double CompliantTeeth::rate(const State& state) const { return element_->rate(state); }
double CompliantTeeth::force(const State& state) const { return element_->force(state); }
double CompliantTeeth::impulse(const State& state) const { return element_->impulse(state); }
double CompliantTeeth::approach(const State& state, int flank) const {
  return element_->approach(state, flank);
}
double CompliantTeeth::approach_rate(const State& state, int flank) const {
  return flank * element_->rate(state);
}

double CompliantTeeth::elastic_energy(const State& state) const {
  double energy = 0;
  for (const int flank : {1, -1}) energy += flank_energy(teeth_, approach(state, flank));
  return energy;
}

}  // namespace bentaxis::multibody
