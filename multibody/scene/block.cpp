#include "scene/block.h"

#include "scene/mass_properties.h"

namespace bentaxis::multibody {

SimTK::Transform block_frame(const Geometry& geometry) {
  return {SimTK::Rotation(-geometry.tilt, SimTK::XAxis), SimTK::Vec3(0, 0, geometry.axis_offset)};
}

SimTK::MobilizedBody::Pin block_on_pin(SimTK::SimbodyMatterSubsystem& matter,
                                       const PumpParameters& pump, const SimTK::Transform& frame) {
  const Block& block = pump.block;
  return {matter.updGround(), frame,
          SimTK::Body::Rigid(rotor(block.mass, block.centre_of_mass_z, block.axial_inertia)),
          SimTK::Transform()};
}

}  // namespace bentaxis::multibody
