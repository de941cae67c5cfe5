// The model's curves that the columns of a foreign record may be.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/results/result_table.h"
#include "mapping_curves.h"

namespace bentaxis::study::mapping {

struct ModelVector {
  Channel channel;  // of its components, without an axis
  double peak = 0;
  std::array<Series, 3> parts;
  std::array<bool, 3> has_channel{};
  std::array<std::string, 3> names;
};

struct ModelChannel {
  Channel channel;
  double peak = 0;
  Series values;
};

// Those that are computed and not zero, over one turn at equal steps.
class ModelCurves {
 public:
  ModelCurves(const ResultTable& model, const compare::FrameAxes& frames);

  std::size_t rows() const { return table_.rows(); }
  int pistons() const { return pistons_; }
  double pitch_deg() const { return 360.0 / std::max(1, pistons_); }
  const ResultTable& table() const { return table_; }
  const std::vector<ModelVector>& vectors() const { return vectors_; }
  const std::vector<ModelChannel>& channels() const { return channels_; }
  const compare::Axes& frame(const std::string& name) const { return frames_.at(name); }

 private:
  void add_component(const ModelChannel& one);

  const ResultTable& table_;
  const compare::FrameAxes& frames_;
  int pistons_ = 0;
  std::vector<ModelVector> vectors_;
  std::vector<ModelChannel> channels_;
};

}  // namespace bentaxis::study::mapping
