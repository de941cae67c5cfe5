// Pumps whose pistons turn the block, at constant speed: how far the block lags at an angle.
#pragma once

#include <functional>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/parameters.h"

namespace bentaxis::multibody {

/// Lags theta - psi between which no piston touches its bore, rad.
struct FreePlay {
  double low = 0, high = 0;
  double middle() const { return (low + high) / 2; }
};

/// The free play at an angle of the shaft, found by turning the block: how far the projections of
/// the joints A on the block are from the axes of their bores. The contact point lies on the line
/// from A to B on the bore's axis, so it is off that axis by the share of the length that is left.
/// @throws InputError where there is none, or no piston bounds it
FreePlay free_play(const PumpParameters& pump, double theta);

struct FrozenLag {
  double lag = 0;  ///< rad
  LagRule rule = LagRule::unloaded;
};

/// Moments on the block about z2, Nm, at a lag: with or without the walls' forces.
using BlockMoment = std::function<double(double lag, bool walls)>;

/// The lag at which the block is in balance. Where there are several, the specified one:
///  1. without load in the free play, its middle;
///  2. a root beyond the free play, where the block is pushed against the walls; if both sides have
///     one, that of the direction of rotation; the first outwards;
///  3. else the root in the free play that is nearest to its middle.
/// @param load_scale  Nm
/// @param omega       rad/s of the shaft; 0 is positive
/// @throws ComputationError where the moment cannot be evaluated before a root, or none is found
FrozenLag find_frozen_lag(const FreePlay& play, const BlockMoment& moment, double load_scale,
                          double omega);

}  // namespace bentaxis::multibody
