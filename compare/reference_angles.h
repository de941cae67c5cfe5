// Angles of a turn, as all sources of references take them.
#pragma once

#include <cstddef>
#include <vector>

namespace bentaxis::compare {

// Angles this close are the same: a thousandth of the round-off of an angle written in 9 digits.
constexpr double kSameAngle = 1e-9;
// A spline across a wider gap would invent the curve there.
constexpr double kLargestGap = 30;

// Index of an angle among rising ones, or their number.
std::size_t find_angle(const std::vector<double>& theta, double angle, double same);
// The turn's angle of a sample.
double reduced(double theta_deg);

}  // namespace bentaxis::compare
