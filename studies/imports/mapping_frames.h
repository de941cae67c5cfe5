// Axes and numberings of foreign records, as guess_mapping() tries them.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "mapping_curves.h"

namespace bentaxis::study::mapping {

using compare::Axes;
using compare::carried;

// A vector's components in other axes.
std::array<Series, 3> in_axes(const std::array<Series, 3>& parts, const Axes& from, const Axes& to);
// All 24 frames that right angles turn into each other, the plain one first.
const std::vector<Axes>& right_angles();
// Sum of the products of their elements.
double trace_of(const Axes& a, const Axes& b);
// The smallest angle of a turn from axes at right angles to these, in degrees.
double angle_from_right_angles(const Axes& axes);
// The angles in degrees of axes that were turned by compare::turned_axes, "ZXZ" or "XYZ".
std::array<double, 3> euler_angles(const Axes& axes, const std::string& sequence);
// The rotation whose trace with the weighted sum of matrices is the largest: Wahba's problem, by a
// singular value decomposition (F. L. Markley, J. Astronautical Sciences 36, 1988).
// @param products  scalar products of the components of vectors, theirs by rows and ours by columns
Axes nearest_rotation(const std::vector<Axes>& products, const std::vector<double>& weights);
// One numbering of the pistons for a file: which of ours a number in a name is.
// @param votes  the number that a name says, and which of ours its curve looks like
std::function<int(int)> best_numbering(const std::vector<std::pair<int, int>>& votes, int pistons);

}  // namespace bentaxis::study::mapping
