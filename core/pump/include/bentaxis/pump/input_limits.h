// Bounds of inputs that no physics sets.
#pragma once

#include "bentaxis/pump/number.h"

namespace bentaxis {

/// Largest magnitude of an input in SI units, and of a number in a file of points: what is computed
/// of it stays within the range of double.
inline constexpr double kLargestInput = 1e30;

/// Allowed pressures of ports and curves, bar gauge: far above those of any pump, and of any in
/// pascals.
inline constexpr NumberRange kPressureRange{-1e9, 1e9};

}  // namespace bentaxis
