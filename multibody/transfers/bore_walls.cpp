#include "transfers/bore_walls.h"

#include <algorithm>
#include <cmath>

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

namespace {

// The law's elastic part. Beyond the touch it goes on as it began, for a step that lands on it.
double elastic_force(const WallContact& law, double approach) {
  const double size =
      law.stiffness * kWallApproach * std::pow(std::abs(approach) / kWallApproach, law.exponent);
  return std::copysign(size, approach);
}

}  // namespace

class BoreWalls::Element : public SimTK::Force::Custom::Implementation {
 public:
  explicit Element(const BoreWalls& walls) : walls_(walls) {}

  void calcForce(const State& state, SimTK::Vector_<SpatialVec>& forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector&) const override {
    if (walls_.setting_.apart) return;
    for (std::size_t k = 0; k < walls_.size(); ++k) {
      const WallTouch touch = walls_.touch(state, k);
      if (touch.force == 0) continue;
      const Vec3 on_block = touch.force * touch.outward;
      const auto push = [&](const SimTK::MobilizedBody& body, const Vec3& force) {
        forces[body.getMobilizedBodyIndex()] +=
            SpatialVec((touch.centre - body.getBodyOriginLocation(state)) % force, force);
      };
      push(walls_.block_, on_block);
      push(walls_.pistons_[k], -on_block);
    }
  }
  SimTK::Real calcPotentialEnergy(const State&) const override { return 0; }

 private:
  const BoreWalls& walls_;
};

BoreWalls::BoreWalls(SimTK::GeneralForceSubsystem& forces, const PumpParameters& pump,
                     const PumpBodies& bodies, const Pistons& pistons, const WallSetting& setting)
    : law_(*pump.transfer.wall),
      bore_radius_(pump.geometry.bore_diameter / 2),
      arm_(pump.geometry.bore_circle_radius * (1 - law_.from_joint / pump.geometry.piston_length)),
      block_(bodies.block),
      pistons_(bodies.pistons),
      bore_points_(pistons.bore_points),
      setting_(setting),
      force_(SimTK::Force::Custom(forces, new Element(*this))) {
  for (std::size_t k = 0; k < pistons_.size(); ++k)
    sphere_radii_.push_back(bore_radius_ - law_.clearance_of(k));
}

WallTouch BoreWalls::touch(const State& state, std::size_t piston) const {
  const SimTK::MobilizedBody& body = pistons_[piston];
  const Vec3 station(0, 0, law_.from_joint);
  WallTouch touch;
  touch.centre = body.findStationLocationInGround(state, station);
  // In the block, where the bore's axis is at rest.
  const Vec3 seen = block_.findStationAtGroundPoint(state, touch.centre);
  const Vec3 off(seen[0] - bore_points_[piston][0], seen[1] - bore_points_[piston][1], 0);
  const double distance = off.norm();
  touch.approach = distance + sphere_radii_[piston] - bore_radius_;
  if (!(distance > 0)) return touch;  // no side is nearer than another
  const Vec3 outward = off / distance;
  touch.outward = block_.expressVectorInGroundFrame(state, outward);
  touch.rate = dot(outward, body.findStationVelocityInAnotherBody(state, station, block_));
  touch.force = force_of(touch, piston);
  return touch;
}

double BoreWalls::force_of(const WallTouch& touch, std::size_t piston) const {
  if (setting_.apart) return 0;
  const double force = elastic_force(law_, touch.approach) * (1 + law_.dissipation * touch.rate);
  if (setting_.held.empty()) return touch.approach > 0 ? std::max(0.0, force) : 0;
  const WallBranch& held = setting_.held[piston];
  return held.touching && !held.released ? force : 0;
}

Vec3 BoreWalls::force_on_piston(const State& state, std::size_t piston) const {
  const WallTouch found = touch(state, piston);
  return found.force == 0 ? Vec3(0) : Vec3(-found.force * found.outward);
}

WallBranch BoreWalls::branch_at(const State& state, std::size_t piston) const {
  const WallTouch found = touch(state, piston);
  return {found.approach > 0, found.approach > 0 && !(1 + law_.dissipation * found.rate > 0)};
}

double BoreWalls::elastic_energy(const State& state) const {
  double energy = 0;
  for (std::size_t k = 0; k < size(); ++k) {
    const double pressed = std::max(0.0, touch(state, k).approach);
    energy += elastic_force(law_, pressed) * pressed / (law_.exponent + 1);
  }
  return energy;
}

double BoreWalls::elastic_power(const State& state) const {
  double power = 0;
  for (std::size_t k = 0; k < size(); ++k) {
    const WallTouch found = touch(state, k);
    power += elastic_force(law_, std::max(0.0, found.approach)) * found.rate;
  }
  return power;
}

double BoreWalls::total_force(const State& state) const {
  double total = 0;
  for (std::size_t k = 0; k < size(); ++k) total += touch(state, k).force;
  return total;
}

double BoreWalls::torsional_stiffness(double torque) const {
  const double force = torque / arm_;
  const double pressed =
      kWallApproach * std::pow(force / (law_.stiffness * kWallApproach), 1 / law_.exponent);
  return law_.exponent * force / pressed * arm_ * arm_;
}

}  // namespace bentaxis::multibody
