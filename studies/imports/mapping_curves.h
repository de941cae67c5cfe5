// Curves over the turn, as guess_mapping() compares them.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace bentaxis::study::mapping {

using Series = std::vector<double>;  // over the turn at equal steps

// The coarse search for the phase has this many angles in the turn.
inline constexpr std::size_t kCoarse = 180;

double dot(const Series& a, const Series& b);
// About the mean.
Series centred(Series values);
// About the mean and of length 1; zero where the curve is constant.
Series normalised(const Series& values);
// Of a vector, row by row; a component may be empty.
Series length_of(const std::array<Series, 3>& vector);
bool is_constant(const Series& values);
// The curve at the angles of the coarse search.
Series coarse(const Series& fine);
// Sum of ours(i) x theirs(i - shift) over the turn; both have kCoarse angles.
double shifted_product(const Series& ours, const Series& theirs, std::size_t shift);
// Rounds angles in degrees to a common step, the roundest at which they cost as little.
// @returns  the step; 0 where the angles stay as they are
double roundest(const std::function<double(const std::vector<double>&)>& cost,
                std::vector<double>& angles);

}  // namespace bentaxis::study::mapping
