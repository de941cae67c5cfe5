#include "loads/friction.h"

#include <cmath>

namespace bentaxis::multibody {

double piston_friction(const Friction& friction, double velocity, double rest_speed,
                       double direction) {
  const double viscous = friction.piston_viscous * velocity;
  const bool jumps = friction.regularization == 0;
  if (jumps && direction != 0) return -(friction.piston_coulomb * direction + viscous);
  if (jumps && std::abs(velocity) <= rest_speed) return -viscous;
  const double share =
      jumps ? std::copysign(1.0, velocity) : std::tanh(velocity / friction.regularization);
  return -(friction.piston_coulomb * share + viscous);
}

double rest_speed_at(const Geometry& geometry, double omega) {
  return kRestShare * std::abs(omega) * geometry.joint_circle_radius;
}

}  // namespace bentaxis::multibody
