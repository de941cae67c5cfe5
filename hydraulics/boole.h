// Boole's rule, exact for polynomials of degree 5.
#pragma once

namespace bentaxis::hydraulics {

/// Weights of the nodes of a step, at equal distances with both its ends.
inline constexpr double kBoole[] = {7.0 / 90, 32.0 / 90, 12.0 / 90, 32.0 / 90, 7.0 / 90};
inline constexpr int kBooleNodes = 5;

}  // namespace bentaxis::hydraulics
