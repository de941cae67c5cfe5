#include "bentaxis/results/budget.h"

#include <cmath>
#include <vector>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis {
namespace {

struct CauseWords {
  const char* name;
  const char* meaning;
  bool carries;  // has a part in the torque on the block
};
constexpr CauseWords kWords[kCauses] = {
    {"pressure", "pressure on the pistons", true},
    {"piston_friction", "friction of the pistons in their bores", true},
    {"weight", "weight of the pistons", true},
    {"inertia", "inertia", true},
    {"block_friction", "viscous friction of the block, Cc", true},
    {"shaft_friction", "viscous friction of the shaft, Cs", false},
    {"torque_factor", "proportional loss of the shaft, (1 - Ct) Td", false},
    {"ring", "bore forces that do not act at B, on the play of the pistons", true},
    {"teeth", "deformation of the teeth", false}};

// Causes that a table has columns of.
std::vector<Cause> causes_of(bool ring, bool teeth) {
  std::vector<Cause> causes;
  for (std::size_t c = 0; c < kCauses; ++c) {
    const auto cause = static_cast<Cause>(c);
    if ((cause != Cause::ring || ring) && (cause != Cause::teeth || teeth)) causes.push_back(cause);
  }
  return causes;
}

const CauseWords& words_of(Cause cause) { return kWords[static_cast<std::size_t>(cause)]; }

Channel channel_of(const std::string& name, const std::string& meaning, const std::string& unit,
                   const std::string& body, ChannelKind kind) {
  Channel channel;
  channel.name = channel.quantity = channel.group = name;
  channel.meaning = meaning;
  channel.unit = unit;
  channel.on_body = body;
  channel.kind = kind;
  return channel;
}

}  // namespace

const char* to_string(Cause cause) { return words_of(cause).name; }

std::string drive_column(Cause cause) { return std::string("Td_") + to_string(cause) + "_Nm"; }
std::string carrying_column(Cause cause) { return std::string("Tcs_") + to_string(cause) + "_Nm"; }

ResultTable budget_table(const std::string& model, bool ring, bool teeth) {
  const std::vector<Cause> causes = causes_of(ring, teeth);
  ResultTable table;
  table.name = model;
  const auto add = [&](const std::string& name, const std::string& meaning, const std::string& unit,
                       const std::string& body, ChannelKind kind = ChannelKind::derived) {
    table.channels.push_back(channel_of(name, meaning, unit, body, kind));
  };
  for (const Cause cause : causes)
    add(drive_column(cause), std::string("drive torque for ") + words_of(cause).meaning, "Nm",
        "shaft");
  add("Td_z1_Nm", "drive torque", "Nm", "shaft");
  // A difference of two torques, it is known as well as these are.
  if (teeth) table.channels[table.find(drive_column(Cause::teeth))].group = "Td_z1_Nm";
  for (const Cause cause : causes)
    if (words_of(cause).carries)
      add(carrying_column(cause),
          std::string("torque that drives the block against ") + words_of(cause).meaning, "Nm",
          "block");
  add("Tcs_z2_Nm", "torque that drives the block", "Nm", "block");
  add("Fpress_z2_N", "force that presses the block onto the port plate", "N", "block");
  add("Fland_z2_N", "force of the pressure in the port-plate lands", "N", "block");
  const ChannelKind check = ChannelKind::check;
  add("Td_open_Nm", "drive torque less the sum of its causes", "Nm", "shaft", check);
  add("Tcs_open_Nm", "torque on the block less the sum of its causes", "Nm", "block", check);
  add("Fh_open_N", "forces along the block's axis: pressing, lands and film", "N", "block", check);
  return table;
}

void append_budget(ResultTable& table, double theta_deg, const Budget& budget) {
  const std::size_t first = table.values.size();
  const auto add = [&](double value) { table.values.push_back(value); };
  double drive = 0;
  double carrying = 0;
  const auto has = [&](Cause cause) { return table.find(drive_column(cause)) < table.columns(); };
  const std::vector<Cause> causes = causes_of(has(Cause::ring), has(Cause::teeth));
  for (const Cause cause : causes) {
    const double part = budget.drive[static_cast<std::size_t>(cause)];
    add(part);
    drive += part;
  }
  add(budget.drive_torque);
  for (const Cause cause : causes) {
    const double part = budget.carrying[static_cast<std::size_t>(cause)];
    if (words_of(cause).carries) add(part);
    carrying += part;
  }
  add(budget.carrying_torque);
  add(budget.pressing);
  add(budget.separating);
  add(budget.drive_torque - drive);
  add(budget.carrying_torque - carrying);
  add(budget.pressing + budget.separating + budget.film);
  table.theta_deg.push_back(theta_deg);
  for (std::size_t c = 0; c < table.columns(); ++c)
    if (!std::isfinite(table.values[first + c]))
      throw ComputationError(table.name + " model: " + table.channels[c].name +
                             " is not finite at " + number_text(theta_deg) + " deg");
}

}  // namespace bentaxis
