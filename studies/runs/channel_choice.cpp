#include "bentaxis/study/channel_choice.h"

#include <algorithm>
#include <set>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/words.h"

namespace bentaxis::study {
namespace {

bool is_called(const Channel& channel, const std::string& name) {
  return channel.quantity == name || channel.name == name;
}

std::string hint(const std::string& name, const std::vector<Channel>& channels) {
  std::set<std::string> known;
  for (const Channel& channel : channels) {
    known.insert(channel.quantity);
    known.insert(channel.name);
  }
  if (const auto nearest = meant(name, known)) return "; did you mean \"" + *nearest + "\"?";
  return "; there are: " + joined(quantity_names()) + ", and the columns of a result";
}

}  // namespace

std::vector<std::string> quantity_names() {
  std::vector<std::string> known;
  for (const Channel& channel : ChannelLayout(1).channels()) add_once(known, channel.quantity);
  return known;
}

bool ChannelChoice::wants(const Channel& channel) const {
  return all() || std::any_of(names_.begin(), names_.end(),
                              [&](const auto& name) { return is_called(channel, name); });
}

std::string ChannelChoice::text() const { return all() ? "all" : joined(names_); }

std::vector<Channel> ChannelChoice::of(const std::vector<Channel>& channels) const {
  for (const auto& name : names_)
    if (std::none_of(channels.begin(), channels.end(),
                     [&](const Channel& c) { return is_called(c, name); }))
      throw InputError("--channels: no channel is called " + name + hint(name, channels));
  std::vector<Channel> wanted;
  std::copy_if(channels.begin(), channels.end(), std::back_inserter(wanted),
               [&](const Channel& c) { return wants(c); });
  return wanted;
}

multibody::Scene ChannelChoice::scene_for(const ChannelLayout& layout,
                                          std::optional<multibody::Scene> asked) const {
  const auto wanted = of(layout);
  if (all()) return asked.value_or(multibody::Scene::full);
  // Walls that turn the block need its balance, and with it the full pump.
  if (!asked && layout.transfer() == TransferKind::pistons) return multibody::Scene::full;
  if (!asked) return multibody::smallest_scene(wanted);
  for (const Channel& channel : wanted)
    if (!multibody::computes(*asked, channel))
      throw InputError("--scene " + multibody::scene_names()[static_cast<std::size_t>(*asked)] +
                       " does not compute " + channel.name +
                       ", which --channels asks for; leave --scene out or use --scene full");
  return *asked;
}

}  // namespace bentaxis::study
