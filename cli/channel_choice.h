// Channels a user asks for, and the smallest multibody scene that computes them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "bentaxis/multibody/scene.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::cli {

/// The channels asked for by quantity ("Rs") or by column ("Rs_1_z2_N"); none given = all.
class ChannelChoice {
 public:
  /// Adds --channels to a command that has --scene.
  void add_to(CLI::App& command, const CLI::Option* scene);

  bool all() const { return names_.empty(); }
  bool wants(const Channel& channel) const;
  /// Every channel of a pump that is asked for.
  /// @throws InputError if a name is of no channel
  std::vector<Channel> of(const ChannelLayout& layout) const;

  /// The scene to use: `choice`, where the user chose it or all channels are asked for, else the
  /// smallest that computes what is asked for; then standard error says so.
  /// @throws InputError if the scene the user chose lacks a channel asked for
  multibody::SceneChoice scene_for(const ChannelLayout& layout,
                                   multibody::SceneChoice choice) const;

 private:
  std::vector<std::string> names_;
  const CLI::Option* scene_ = nullptr;
};

}  // namespace bentaxis::cli
