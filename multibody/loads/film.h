// Force of the port-plate film on the block, by numerical integration over the lands.
#pragma once

#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"

namespace bentaxis::multibody {

/// Resultant on the block: force along z2, moment about O2 in S2.
struct FilmLoad {
  double force_z = 0;   ///< N
  double moment_x = 0;  ///< Nm
  double moment_y = 0;  ///< Nm
};

/// Sums pressure x area over both ports by Gauss-Legendre quadrature, fine enough to be exact to
/// round-off for pressures that are linear in the radius.
FilmLoad film_load(const PortPlate& plate, const PortPressures& ports);

}  // namespace bentaxis::multibody
