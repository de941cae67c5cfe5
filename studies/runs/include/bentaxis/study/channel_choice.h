// Channels a user asks for, and the smallest multibody scene that computes them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/multibody/scene.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::study {

/// What a channel is of: "Rs", "Rc" ..; the same for every pump.
std::vector<std::string> quantity_names();

/// The channels asked for by quantity ("Rs") or by column ("Rs_1_z2_N"); none given = all.
class ChannelChoice {
 public:
  ChannelChoice() = default;
  explicit ChannelChoice(std::vector<std::string> names) : names_(std::move(names)) {}

  bool all() const { return names_.empty(); }
  bool wants(const Channel& channel) const;
  /// What was asked for, in words.
  std::string text() const;
  /// Every channel of a pump that is asked for.
  /// @throws InputError if a name is of no channel
  std::vector<Channel> of(const ChannelLayout& layout) const { return of(layout.channels()); }
  std::vector<Channel> of(const std::vector<Channel>& channels) const;

  /// The scene to build: `asked` where there is one, the full pump where all channels are asked
  /// for, else the smallest that computes what is asked for.
  /// @throws InputError if a name is of no channel or the scene asked for lacks a channel asked for
  multibody::Scene scene_for(const ChannelLayout& layout,
                             std::optional<multibody::Scene> asked) const;

 private:
  std::vector<std::string> names_;
};

}  // namespace bentaxis::study
