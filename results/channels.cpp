#include "bentaxis/results/channels.h"

#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace bentaxis {
namespace {

// What the components of one vector have in common.
struct Vector {
  std::string quantity, meaning, equation, on_body, by_body, point, frame, unit, group;
  ChannelKind kind = ChannelKind::reaction;
  int piston = 0;
};

void add(std::vector<Channel>& list, const Vector& vector, const std::string& axes) {
  const double unit_in_si = vector.unit == "mm" ? 1e-3 : vector.unit == "bar" ? 1e5 : 1.0;
  for (const char letter : axes) {
    const std::string axis = letter == '-' ? "" : letter + vector.frame.substr(1);
    const std::string who =
        vector.piston > 0 ? vector.quantity + "_" + std::to_string(vector.piston) : vector.quantity;
    Channel channel;
    channel.name = who + (axis.empty() ? "" : "_" + axis) + "_" + vector.unit;
    channel.quantity = vector.quantity;
    channel.meaning = vector.meaning;
    channel.equation = vector.equation;
    channel.piston = vector.piston;
    channel.axis = axis;
    channel.frame = vector.frame;
    channel.on_body = vector.on_body;
    channel.by_body = vector.by_body;
    channel.point = vector.point;
    channel.unit = vector.unit;
    channel.unit_in_si = unit_in_si;
    channel.group = vector.group;
    channel.kind = vector.kind;
    list.push_back(std::move(channel));
  }
}

std::vector<Channel> list_channels(int pistons) {
  std::vector<Channel> list;
  const auto label = [](const std::string& letter, int k) { return letter + std::to_string(k); };
  using Kind = ChannelKind;
  for (int k = 1; k <= pistons; ++k) {
    const std::string piston = label("piston ", k);
    add(list,
        {"Rs", "joint force", "(29)-(33)", piston, "shaft", label("A", k), "S2", "N", "Rs",
         Kind::reaction, k},
        "xyz");
    add(list,
        {"Rc", "bore force", "(30)-(33)", piston, "block", label("B", k), "S2", "N", "Rc",
         Kind::reaction, k},
        "xy");
  }
  add(list,
      {"Fh", "hydrodynamic force of the port-plate film", "(51), (56)", "block", "port-plate film",
       "(xh, yh)", "S2", "N", "Fh"},
      "z");
  add(list,
      {"Th", "moment of Fh by its offset", "(52), (57)", "block", "port-plate film", "about O2",
       "S2", "Nm", "Th"},
      "xy");
  add(list, {"Rcn", "pin force", "(54), (56)", "block", "pin", "(0, 0, z_pin)", "S2", "N", "Rcn"},
      "xy");
  add(list, {"Rcs", "gear tooth force", "(55), (57)", "block", "shaft", "O4", "S4", "N", "Rcs"},
      "z");
  add(list,
      {"Rb1", "tapered bearing force", "(39), (42)", "shaft", "tapered bearing", "C1", "S1", "N",
       "Rb1"},
      "xyz");
  add(list,
      {"Rb2", "cylindrical bearing force", "(40), (42)", "shaft", "cylindrical bearing", "C2", "S1",
       "N", "Rb2"},
      "xy");
  add(list,
      {"Td", "drive torque", "(41), (43)", "shaft", "prime mover", "about z1", "S1", "Nm", "Td"},
      "z");
  add(list,
      {"xh", "point where Fh acts", "(53)", "block", "port-plate film", "from z2", "S2", "mm",
       "xh_yh", Kind::derived},
      "x");
  add(list,
      {"yh", "point where Fh acts", "(53)", "block", "port-plate film", "from z2", "S2", "mm",
       "xh_yh", Kind::derived},
      "y");
  add(list,
      {"Tcs", "torque that carries the block round", "(57)", "block",
       "shaft (gear) or imposed drive", "about z2", "S2", "Nm", "Tcs", Kind::derived},
      "z");
  for (int k = 1; k <= pistons; ++k)
    add(list,
        {"p", "chamber pressure, gauge", "(24)", label("piston ", k), "oil", label("B", k), "",
         "bar", "p", Kind::input, k},
        "-");
  for (int k = 1; k <= pistons; ++k)
    add(list,
        {"zB", "position of B on its bore axis", "(11)", label("piston ", k), "", label("B", k),
         "S2", "mm", "zB", Kind::derived, k},
        "z");
  for (int k = 1; k <= pistons; ++k)
    add(list,
        {"Rs", "joint force along the piston (z3) and across it", "(17), (29)", label("piston ", k),
         "shaft", label("A", k), "S3", "N", "Rs", Kind::derived, k},
        "xyz");
  for (int k = 1; k <= pistons; ++k)
    add(list,
        {"Tc", "share of the pistons' torque on the block", "(57)", "block", label("piston ", k),
         "about z2", "S2", "Nm", "Tc", Kind::derived, k},
        "z");
  add(list,
      {"power_residual", "sum of all power over omega (virtual work per radian)", "", "pump", "",
       "", "", "Nm", "power_residual", Kind::check},
      "-");
  for (int k = 1; k <= pistons; ++k)
    add(list,
        {"axis_moment", "moment about the piston's own axis", "", label("piston ", k), "",
         "centre of mass", "", "Nm", "axis_moment", Kind::check, k},
        "-");
  return list;
}

}  // namespace

ChannelLayout::ChannelLayout(int pistons) : n_(pistons) {
  static std::mutex mutex;
  static std::map<int, std::shared_ptr<const std::vector<Channel>>> lists;
  const std::lock_guard<std::mutex> lock(mutex);
  auto& list = lists[pistons];
  if (!list) list = std::make_shared<const std::vector<Channel>>(list_channels(pistons));
  channels_ = list;
}

}  // namespace bentaxis
