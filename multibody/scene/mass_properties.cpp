#include "scene/mass_properties.h"

#include <algorithm>

namespace bentaxis::multibody {

SimTK::MassProperties symmetric_body(double mass, double centre_z, double transverse_about_origin,
                                     double axial) {
  // Simbody takes the centre's share off again and refuses a body where rounding then leaves less
  // than nothing.
  const double of_centre = mass * centre_z * centre_z;
  transverse_about_origin = std::max(transverse_about_origin, of_centre * (1 + 8 * SimTK::Eps));
  return {mass, SimTK::Vec3(0, 0, centre_z),
          SimTK::Inertia(transverse_about_origin, transverse_about_origin, axial)};
}

SimTK::MassProperties rotor(double mass, double centre_z, double axial_inertia) {
  const double inertia = axial_inertia > 0 ? axial_inertia : kNominalInertia;
  const double some_mass = mass > 0 ? mass : kNominalMass;
  return symmetric_body(some_mass, centre_z, inertia + some_mass * centre_z * centre_z, inertia);
}

}  // namespace bentaxis::multibody
