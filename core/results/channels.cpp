#include "bentaxis/results/channels.h"

#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "bentaxis/pump/unit_of_measure.h"

namespace bentaxis {
namespace {

// The text with '#' replaced by the number of a piston.
std::string of_piston(std::string_view text, int piston) {
  std::string result;
  for (const char letter : text)
    result += letter == '#' ? std::to_string(piston) : std::string(1, letter);
  return result;
}

// "rad/s2" -> "rad_per_s2"
std::string in_name(std::string unit) {
  if (const auto slash = unit.find('/'); slash != std::string::npos)
    unit.replace(slash, 1, "_per_");
  return unit;
}

// One component of a quantity, of piston 1.. or of none (0).
Channel describe(const QuantityEntry& entry, char component, int piston) {
  Channel channel;
  channel.quantity = entry.symbol;
  channel.meaning = entry.meaning;
  channel.equation = entry.equation;
  channel.piston = piston;
  if (component != '-') channel.axis = component + std::string(entry.frame.substr(1));
  channel.frame = entry.frame;
  channel.on_body = of_piston(entry.on_body, piston);
  channel.by_body = of_piston(entry.by_body, piston);
  channel.point = of_piston(entry.point, piston);
  channel.unit = entry.unit;
  channel.unit_in_si = unit_in_si(entry.unit);
  channel.group = entry.group;
  channel.kind = entry.kind;
  channel.name = channel.quantity;
  if (piston > 0) channel.name += "_" + std::to_string(piston);
  if (!channel.axis.empty()) channel.name += "_" + channel.axis;
  channel.name += "_" + in_name(channel.unit);
  return channel;
}

std::vector<Channel> list_channels(int pistons, TransferKind transfer) {
  std::vector<Channel> list(quantity_place(std::size(kQuantities), transfer).column(pistons, 0, 0));
  for (std::size_t q = 0; q < std::size(kQuantities); ++q) {
    if ((kQuantities[q].transfers & transfers::bit(transfer)) == 0) continue;
    const QuantityPlace place = quantity_place(q, transfer);
    for (int k = 0; k < (place.repeated ? pistons : 1); ++k)
      for (int i = 0; i < place.components; ++i)
        list[place.column(pistons, k, i)] =
            describe(kQuantities[q], kQuantities[q].components[i], place.repeated ? k + 1 : 0);
  }
  for (Channel& channel : list)
    channel.of_pump = !is_of_given_motion(channel) &&
                      (channel.quantity != "Rcs" || transfer == TransferKind::gear);
  return list;
}

}  // namespace

bool is_of_given_motion(const Channel& channel) { return channel.quantity == "Tb"; }

ChannelLayout::ChannelLayout(int pistons, TransferKind transfer)
    : n_(pistons), transfer_(transfer) {
  static std::mutex mutex;
  static std::map<std::pair<int, TransferKind>, std::shared_ptr<const std::vector<Channel>>> lists;
  const std::lock_guard<std::mutex> lock(mutex);
  auto& list = lists[{pistons, transfer}];
  if (!list) list = std::make_shared<const std::vector<Channel>>(list_channels(pistons, transfer));
  channels_ = list;
}

}  // namespace bentaxis
