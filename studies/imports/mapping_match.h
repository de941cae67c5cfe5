// How well a column or vector of a foreign record is one of the model's, by scalar products.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "mapping_frames.h"

namespace bentaxis::study::mapping {

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
  Axes theirs_ours{};
  Axes ours_ours{};
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

}  // namespace bentaxis::study::mapping
