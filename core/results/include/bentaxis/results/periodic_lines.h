// A curve over the turn drawn by straight lines between its points.
#pragma once

#include <vector>

namespace bentaxis {

/// Values at angles, on the straight lines between points of a turn.
/// @param theta_deg  of the points, in any order and turn
/// @param values     at these; a point without a value is left out
/// @param wanted_deg angles, likewise
/// @return not_computed() everywhere where no point has a value
std::vector<double> on_lines(const std::vector<double>& theta_deg,
                             const std::vector<double>& values,
                             const std::vector<double>& wanted_deg);

}  // namespace bentaxis
