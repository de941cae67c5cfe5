// Where in the turn a foreign record begins, and which way it runs.
#pragma once

#include <vector>

#include "mapping_model.h"
#include "mapping_record.h"

namespace bentaxis::study::mapping {

// A curve that differs by more than this share of itself from every channel is none of them.
inline constexpr double kNoChannel = 0.5;

struct Phase {
  AngleMap angle;
  Turning turning;
  double cost = 0;   // mean over the features
  double score = 0;  // by which phases are chosen: the smaller the better
};

// The phases at which curves of the record are like those of the model, over the angle that the
// record was taken by.
std::vector<Phase> phases_of(const Record& record, const ModelCurves& model);

}  // namespace bentaxis::study::mapping
