// The multibody model's laws of friction (25), (38), written from the theory and not shared with
// the analytic model.
#pragma once

#include "bentaxis/pump/parameters.h"

namespace bentaxis::multibody {

/// Force Fpf of the bore on a piston along z2 at B, N: dry friction of constant size and a viscous
/// part, both against the motion (25). With a regularization speed the dry part grows from 0 as the
/// tanh of the speed over it; without, it jumps with the direction.
/// @param velocity    of B along z2, m/s
/// @param rest_speed  m/s: a piston this slow is at rest where dry friction jumps, and has none
/// @param direction   0, or the way the piston is taken to move where dry friction jumps
double piston_friction(const Friction& friction, double velocity, double rest_speed,
                       double direction = 0);

/// The share of the speed of the joint circle, |omega| Ra, up to which a piston is at rest. At a
/// dead centre the velocity of B is what is left of terms as large as the joints' own speed: some
/// thousand of their roundings, with any sign.
inline constexpr double kRestShare = 1e-12;

/// Speed up to which a piston of a pump that turns at `omega` is at rest, m/s.
double rest_speed_at(const Geometry& geometry, double omega);

/// Torque on the block about z2, Nm.
inline double block_friction(const Friction& friction, double speed) {
  return -friction.block_viscous * speed;
}
/// Torque on the shaft about z1 without the share of the drive torque that is lost, Nm (38).
inline double shaft_friction(const Friction& friction, double speed) {
  return -friction.shaft_viscous * speed;
}

}  // namespace bentaxis::multibody
