#include "channel_choice.h"

#include <algorithm>
#include <cstdio>

#include "bentaxis/pump/error.h"

namespace bentaxis::cli {
namespace {

bool is_called(const Channel& channel, const std::string& name) {
  return channel.quantity == name || channel.name == name;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string quantities(const ChannelLayout& layout) {
  std::vector<std::string> known;
  for (const Channel& channel : layout.channels())
    if (std::find(known.begin(), known.end(), channel.quantity) == known.end())
      known.push_back(channel.quantity);
  return joined(known);
}

std::string name_of(multibody::Scene scene) {
  return multibody::scene_names()[static_cast<std::size_t>(scene)];
}

}  // namespace

void ChannelChoice::add_to(CLI::App& command, const CLI::Option* scene) {
  scene_ = scene;
  command
      .add_option(
          "--channels", names_,
          "only these: quantities (Rs) or columns (Rs_1_z2_N); without --scene the smallest "
          "scene that computes them is built")
      ->delimiter(',')
      ->option_text("NAME[,NAME..] [all]");
}

bool ChannelChoice::wants(const Channel& channel) const {
  return all() || std::any_of(names_.begin(), names_.end(),
                              [&](const auto& name) { return is_called(channel, name); });
}

std::vector<Channel> ChannelChoice::of(const ChannelLayout& layout) const {
  const auto& channels = layout.channels();
  for (const auto& name : names_)
    if (std::none_of(channels.begin(), channels.end(),
                     [&](const Channel& c) { return is_called(c, name); }))
      throw InputError("--channels: no channel is called " + name +
                       "; there are: " + quantities(layout) + ", and the columns of a result");
  std::vector<Channel> wanted;
  std::copy_if(channels.begin(), channels.end(), std::back_inserter(wanted),
               [&](const Channel& c) { return wants(c); });
  return wanted;
}

multibody::SceneChoice ChannelChoice::scene_for(const ChannelLayout& layout,
                                                multibody::SceneChoice choice) const {
  const auto wanted = of(layout);
  if (all()) return choice;
  if (scene_->count() == 0) {
    choice.scene = multibody::smallest_scene(wanted);
    if (choice.scene != multibody::Scene::full)
      std::fprintf(stderr,
                   "scene \"%s\": the smallest that computes %s; --scene full builds the whole "
                   "pump\n",
                   name_of(choice.scene).c_str(), joined(names_).c_str());
    return choice;
  }
  for (const Channel& channel : wanted)
    if (!multibody::computes(choice.scene, channel))
      throw InputError("--scene " + name_of(choice.scene) + " does not compute " + channel.name +
                       ", which --channels asks for; leave --scene out or take full");
  return choice;
}

}  // namespace bentaxis::cli
