#include "scene/shaft.h"

#include "scene/mass_properties.h"

namespace bentaxis::multibody {

using SimTK::Transform;
using SimTK::Vec3;

SimTK::MobilizedBody::Ball shaft_on_tapered_bearing(SimTK::SimbodyMatterSubsystem& matter,
                                                    const PumpParameters& pump) {
  const Transform c1(Vec3(0, 0, pump.bearings.tapered_z));
  const Shaft& shaft = pump.shaft;
  return {matter.updGround(), c1,
          SimTK::Body::Rigid(rotor(shaft.mass, shaft.centre_of_mass_z, shaft.axial_inertia)), c1};
}

InlineJoint cylindrical_bearing(SimTK::SimbodyMatterSubsystem& matter, SimTK::MobilizedBody& shaft,
                                const PumpParameters& pump) {
  const Vec3 c2(0, 0, pump.bearings.cylindrical_z);
  return {matter.updGround(), SimTK::UnitVec3(SimTK::ZAxis), c2, shaft, c2};
}

}  // namespace bentaxis::multibody
