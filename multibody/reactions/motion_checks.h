// What is found beside the reactions where shaft and block move on their own.
#pragma once

#include <SimTKsimbody.h>

#include "bentaxis/results/instant.h"
#include "bentaxis/results/motion.h"
#include "reactions/reactions.h"

namespace bentaxis::multibody {

/// The tooth force as the column of results signs it: positive where the shaft pushes the block in
/// the direction of rotation, that of the shaft's speed.
double tooth_force_column(const PumpSystem& pump, double tooth, double shaft_speed);

/// Power of the bores' forces on the motion of the pistons' contact points past the block's
/// material, W; 0 where these points lie on the axis that the bore guides.
/// @param rate  a state realized to Velocity whose velocities are taken
double ring_power(const PumpSystem& pump, const Reactions& reactions, const SimTK::State& rate);

/// Power of all that acts on the bodies less the rate of their kinetic energy, W: Simbody's applied
/// forces, and of the reactions those that do work, along Simbody's velocities.
/// @param state  dynamics state realized to Dynamics
/// @param udot   accelerations of all mobilities there
double power_balance(const PumpSystem& pump, const SimTK::State& state, const Reactions& reactions,
                     const SimTK::Vector& udot);

/// Force of the contact law of compliant or bevel teeth at this motion, N, signed towards +psi;
/// not_computed() where teeth are rigid or there is no gear.
double contact_law_force(const PumpSystem& pump, const SimTK::State& state, double lag);

/// All three.
/// @param lag  theta - psi, rad
MotionChecks motion_checks(const PumpSystem& pump, const SimTK::State& state,
                           const Reactions& reactions, const SimTK::Vector& udot, double lag);

}  // namespace bentaxis::multibody
