#include "teeth/teeth_element.h"

#include "scene/gear_mesh.h"

namespace bentaxis::multibody {

using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

namespace {

TeethAction action_of(const BevelTeeth& teeth, const TeethSetting& setting,
                      const SimTK::MobilizedBody& shaft, const State& state) {
  return teeth.act(turn_angle(shaft.getBodyRotation(state), SimTK::Rotation()),
                   shaft.getBodyAngularVelocity(state)[2], setting.lag, setting.dissipation);
}

}  // namespace

class TeethElement::Element : public SimTK::Force::Custom::Implementation {
 public:
  Element(const BevelTeeth& teeth, const SimTK::MobilizedBody& shaft,
          const SimTK::MobilizedBody& block, const Vec3& origin, const TeethSetting& setting)
      : teeth_(teeth), shaft_(shaft), block_(block), origin_(origin), setting_(setting) {}

  void calcForce(const State& state, SimTK::Vector_<SpatialVec>& forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector&) const override {
    if (setting_.apart) return;
    const TeethAction action = action_of(teeth_, setting_, shaft_, state);
    const Vec3 force = vector_of(action.force), moment = vector_of(action.moment);
    const auto at_origin_of = [&](const SimTK::MobilizedBody& body) {
      return SpatialVec(moment + (origin_ - body.getBodyOriginLocation(state)) % force, force);
    };
    forces[block_.getMobilizedBodyIndex()] += at_origin_of(block_);
    forces[shaft_.getMobilizedBodyIndex()] -= at_origin_of(shaft_);
  }
  SimTK::Real calcPotentialEnergy(const State&) const override { return 0; }

 private:
  const BevelTeeth& teeth_;
  const SimTK::MobilizedBody &shaft_, &block_;
  Vec3 origin_;
  const TeethSetting& setting_;
};

TeethElement::TeethElement(SimTK::GeneralForceSubsystem& forces, const BevelTeeth& teeth,
                           const SimTK::MobilizedBody& shaft, const SimTK::MobilizedBody& block,
                           const Vec3& origin, const TeethSetting& setting)
    : teeth_(teeth),
      shaft_(shaft),
      setting_(setting),
      force_(SimTK::Force::Custom(forces, new Element(teeth, shaft, block, origin, setting))) {}

TeethAction TeethElement::action(const State& state) const {
  return setting_.apart ? TeethAction() : action_of(teeth_, setting_, shaft_, state);
}

ToothLag TeethElement::rest(const State& state, double torque_on_block) const {
  return teeth_.rest(turn_angle(shaft_.getBodyRotation(state), SimTK::Rotation()), torque_on_block);
}

}  // namespace bentaxis::multibody
