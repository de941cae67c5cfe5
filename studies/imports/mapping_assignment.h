// Which vector or channel of the model each column of a foreign record is, in one frame, with one
// numbering of the pistons and one sign per quantity.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "mapping_match.h"
#include "mapping_model.h"
#include "mapping_record.h"

namespace bentaxis::study::mapping {

// A column or vector whose curve has a smaller correlation with that of its channel is not
// recognised, whatever its name says. Of a vector single components may have the other sign. At 0.8
// the channel explains 0.8^2 = 64 % of the variance of the record.
inline constexpr double kMinCorrelation = 0.8;

struct FrameChoice {
  std::string axes_of;
  Axes axes = compare::kNoTurn;
  std::string euler;  // sequence, where it was turned by such angles
  std::array<double, 3> angles{};
  bool plain() const { return axes == compare::kNoTurn; }
};

// Axes of the file in those of a vector.
Axes to_own(const FrameChoice& frame, const ModelVector& vector, const ModelCurves& model);

struct Assignment {
  double cost = 0;   // sum over groups and columns
  double score = 0;  // of the groups, by which frames are chosen: the smaller the better
  FrameChoice frame;
  std::vector<Match> groups, columns;
  int numbered = 0;  // pistons that have the number which their names say
  // Groups of which one has a component of the wrong sign, where the others do not show which.
  std::vector<std::size_t> one_is_wrong;
};

// The best assignment of a record that turns so.
Assignment assignment_of(const Record& record, const ModelCurves& model, const Turning& turning);

}  // namespace bentaxis::study::mapping
