#include "mapping_model.h"

#include <algorithm>

#include "bentaxis/pump/number.h"
#include "bentaxis/results/column_values.h"

namespace bentaxis::study::mapping {

ModelCurves::ModelCurves(const ResultTable& model, const compare::FrameAxes& frames)
    : table_(model), frames_(frames) {
  for (std::size_t c = 0; c < model.columns(); ++c) {
    const Channel& channel = model.channels[c];
    if (channel.kind == ChannelKind::check) continue;
    pistons_ = std::max(pistons_, channel.piston);
    ModelChannel one{channel, model.peak(channel.group), column_of(model, c)};
    if (!std::all_of(one.values.begin(), one.values.end(), is_computed) || one.peak == 0) continue;
    channels_.push_back(one);
    if (!channel.axis.empty() && (channel.frame == "S1" || channel.frame == "S2"))
      add_component(one);
  }
  // One component is a number, not a vector.
  std::erase_if(vectors_, [](const ModelVector& v) {
    return v.has_channel[0] + v.has_channel[1] + v.has_channel[2] < 2;
  });
}

void ModelCurves::add_component(const ModelChannel& one) {
  const std::string name = compare::vector_name(one.channel);
  auto vector = std::find_if(vectors_.begin(), vectors_.end(),
                             [&](const ModelVector& v) { return v.channel.name == name; });
  if (vector == vectors_.end()) {
    vector = vectors_.insert(vector, {one.channel, one.peak, {}, {}, {}});
    vector->channel.name = name;
    vector->channel.axis.clear();
    for (auto& part : vector->parts) part.assign(rows(), 0);
  }
  const auto axis = static_cast<std::size_t>(one.channel.axis.front() - 'x');
  vector->parts[axis] = one.values;
  vector->has_channel[axis] = true;
  vector->names[axis] = one.channel.name;
}

}  // namespace bentaxis::study::mapping
