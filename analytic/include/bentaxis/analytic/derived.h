// Quantities that follow from the geometry alone.
#pragma once

#include "bentaxis/pump/parameters.h"

namespace bentaxis::analytic {

/// What an engineer checks first about a pump.
struct DerivedQuantities {
  double stroke = 0;         ///< m, max - min of z_B over a turn
  double displacement = 0;   ///< m3 per revolution, N A stroke
  double piston_area = 0;    ///< m2
  double smallest_tilt = 0;  ///< rad, of a piston against the block axis
  double largest_tilt = 0;   ///< rad
};

/// Exact: z_B depends on theta through cos(theta) alone and its stationary points are the roots of
/// a quadratic.
DerivedQuantities derived_quantities(const Geometry& geometry);

/// The same of a pump with its transfer. With a universal joint each piston has its own trajectory:
/// displacement is A times the sum of the strokes, stroke is their mean, and tilts are the extremes
/// of all pistons. With pistons that turn the block, displacement and stroke are those of a block
/// without lag, and tilts those at the end of the free play where pistons push.
DerivedQuantities derived_quantities(const PumpParameters& pump);

}  // namespace bentaxis::analytic
