// The pieces of guess_mapping() that judge a name, a column or a pair of curves by themselves.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::study::mapping {

using compare::AngleMap;
using compare::Axes;
using Series = std::vector<double>;  // over the turn at equal steps

// A curve that differs by more than this share of itself from every channel is none of them.
inline constexpr double kNoChannel = 0.5;
// A column or vector whose curve has a smaller correlation with that of its channel is not
// recognised, whatever its name says. Of a vector single components may have the other sign. At 0.8
// the channel explains 0.8^2 = 64 % of the variance of the record.
inline constexpr double kMinCorrelation = 0.8;
// The coarse search for the phase has this many angles in the turn.
inline constexpr std::size_t kCoarse = 180;

// ---- Curves

double dot(const Series& a, const Series& b);
// About the mean.
Series centred(Series values);
// About the mean and of length 1; zero where the curve is constant.
Series normalised(const Series& values);
// Of a vector, row by row; a component may be empty.
Series length_of(const std::array<Series, 3>& vector);
// The curve at the angles of the coarse search.
Series coarse(const Series& fine);
// Sum of ours(i) x theirs(i - shift) over the turn; both have kCoarse angles.
double shifted_product(const Series& ours, const Series& theirs, std::size_t shift);
// Rounds angles in degrees to a common step, the roundest at which they cost as little.
// @returns  the step; 0 where the angles stay as they are
double roundest(const std::function<double(const std::vector<double>&)>& cost,
                std::vector<double>& angles);

// ---- Names

std::vector<std::string> words_of(const std::string& name);
// Places in a name that may be the letter of an axis: a word's last letter but for one digit behind
// it ("FX", "x2", "Force_y"), or columns 1 to 3 of a matrix. The name with '?' there, and the axis.
std::vector<std::pair<std::string, int>> axis_readings(const std::string& name);
// The number of a piston that a name has; 0 = none. Never that of an axis.
int piston_in(const std::string& name, int pistons);
bool is_quantity(const std::vector<std::string>& words, const std::string& quantity);
// Whether the words of a column's name are those of a channel: quantity, piston, axis.
bool named(const std::vector<std::string>& words, const Channel& channel);

// ---- Columns

// Half a unit of the last of so many significant digits of a number.
double half_of_last_digit(double number, int digits);
// Whether a column makes a turn; completes where the turn begins and the rounding.
bool is_record(const ForeignTable& table, std::size_t column, double degrees_per_second,
               AngleMap& map);
// Columns that can be the angle, with their units; only those of the best rank.
std::vector<AngleMap> angle_choices(const ForeignTable& table, double degrees_per_second);
// Whether a column rises or falls all along the record, which no periodic curve does.
bool runs_along(const ForeignTable& table, std::size_t column);
bool is_constant(const Series& values);

struct Group {
  std::string key;
  std::array<std::optional<std::size_t>, 3> columns;
  std::string unit;
  std::size_t count() const;
};
// Whether a column is the length of a vector of the file.
bool is_length(const ForeignTable& table, std::size_t column, const Group& group);

struct Grouping {
  std::vector<Group> groups;
  std::vector<std::size_t> singles;
  std::vector<std::pair<std::string, std::string>> ignored;  // columns, and why
};
// Vectors and single columns of a file, of those columns that have a curve.
Grouping find_groups(const ForeignTable& table, const std::vector<bool>& has_curve,
                     const std::vector<bool>& constant);

// ---- Matches

// A vector or a channel that stands for a group or column.
struct Match {
  std::size_t index = std::numeric_limits<std::size_t>::max();
  int sign = 1;
  std::string unit;
  double cost = 2;            // rms of the difference over rms of theirs
  bool signs_differ = false;  // it would fit with other signs of single components
  bool found() const { return index != std::numeric_limits<std::size_t>::max(); }
};

// The unit whose factor (theirs over ours, in our unit) is nearest to one that fits.
std::string unit_for(double fit, const std::string& ours, double unit_in_si,
                     const std::string& said);
// How well theirs is ours: of both signs the better or the one wanted (0 = either).
// @param square, product, own  of theirs by itself, of both, of ours by itself
Match match_of(double square, double product, double own, const std::string& ours,
               double unit_in_si, const std::string& said, int wanted);

// Scalar products of a group's columns with a vector's components: enough for every frame.
struct Products {
  std::array<std::array<double, 3>, 3> theirs_ours{};
  std::array<std::array<double, 3>, 3> ours_ours{};
  std::array<std::optional<double>, 3> theirs_theirs{};  // none: the file lacks the component
};
// Adds those of component j of theirs with the vector in some axes, and of the vector by itself.
void add_component(const Products& p, const Axes& axes, std::size_t j, double& product,
                   double& own);
// As a match's cost, with the better sign of each component: what is found so has a wrong sign
// somewhere, and must be compared, not left out.
double cost_without_signs(const Products& p, const Axes& axes, double factor);
// Likewise with the components in the order that fits best: two of them may have been exchanged.
double cost_of_mixed(const Products& p, const Axes& axes, double factor);

// ---- Frames and numbers

// Axes that are given in one frame, in the axes of another.
Axes carried(const Axes& axes, const Axes& from, const Axes& to);
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
