// Mass properties as Simbody takes them, also of bodies that have none.
#pragma once

#include <SimTKsimbody.h>

namespace bentaxis::multibody {

/// A body that is symmetric about z with its centre of mass on z.
/// @param transverse_about_origin  moment of inertia about x and y through the body's origin, kg m2
SimTK::MassProperties symmetric_body(double mass, double centre_z, double transverse_about_origin,
                                     double axial);

/// What stands for an inertia of shaft or block that is not given (0), kg m2. It never acts: across
/// their axis these bodies do not turn, and about it an inertia acts only where the speed changes,
/// which needs one that is given. Simbody wants it positive, and of the order of real ones its
/// equations stay well scaled.
inline constexpr double kNominalInertia = 1e-3;
/// What stands for a mass of shaft or block of 0, kg: on a fixed axis a mass acts by its weight
/// alone, and this one's is far below the round-off of any load. Simbody has no inertia without
/// mass.
inline constexpr double kNominalMass = 1e-30;

/// A shaft or block, its centre of mass on its axis: what is given, or what stands for it.
/// @param centre_z  of the centre of mass from the body's origin, m
SimTK::MassProperties rotor(double mass, double centre_z, double axial_inertia);

}  // namespace bentaxis::multibody
