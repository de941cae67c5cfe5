// Force of the oil film on the lands of the port plate (49).
#pragma once

#include "bentaxis/pump/parameters.h"

namespace bentaxis::analytic {

/// Resultant on the block per pascal of port pressure: force along z2 and moment about O2, in S2.
struct LandForce {
  double force_z = 0;   ///< m2, negative: pushes the block off the plate
  double moment_x = 0;  ///< m3
  double moment_y = 0;  ///< m3
};

/// Exact integral over one port: full pressure between r2 and r3, linear to 0 at r1 and r4.
LandForce land_force(const PortPlate& plate, const PortArc& arc);

}  // namespace bentaxis::analytic
