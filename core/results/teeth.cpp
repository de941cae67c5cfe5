#include "bentaxis/results/teeth.h"

#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/unit_of_measure.h"

namespace bentaxis {
namespace {

constexpr const char* kFlanks[] = {"plus", "minus"};
constexpr const char* kWhich[] = {"at", "before", "after"};  // O4, by the shaft's tooth
constexpr const char* kAxes[] = {"x1", "y1", "z1"};

std::string prefix(int flank, int pair) {
  return std::string(kFlanks[flank]) + "_" + kWhich[pair] + "_";
}

}  // namespace

ResultTable teeth_table(const std::string& model) {
  ResultTable table;
  table.name = model;
  const auto add = [&](const std::string& name, const std::string& meaning, const std::string& unit,
                       const std::string& group, const std::string& axis = "") {
    Channel channel;
    channel.name = channel.quantity = name;
    channel.meaning = meaning;
    channel.unit = unit;
    channel.unit_in_si = unit_in_si(unit);
    channel.group = group;
    channel.axis = axis;
    channel.frame = axis.empty() ? "" : "S1";
    channel.on_body = "block";
    channel.by_body = "shaft";
    channel.kind = ChannelKind::derived;
    table.channels.push_back(std::move(channel));
  };
  add("lag_urad", "angle by which the shaft's teeth are ahead of the block's", "urad", "lag");
  add("transmission_error_um", "the lag along the line of action at O4", "um",
      "transmission_error");
  for (int flank = 0; flank < 2; ++flank)
    add(std::string(kFlanks[flank]) + "_force_N",
        std::string("force of the flank that pushes the block towards ") +
            (flank == 0 ? "+psi" : "-psi"),
        "N", "tooth_force");
  for (int flank = 0; flank < 2; ++flank)
    for (int pair = 0; pair < kPairsPerFlank; ++pair) {
      const std::string name = prefix(flank, pair);
      add(name + "shaft_tooth", "number of the shaft's tooth", "", "tooth");
      add(name + "force_N", "force of the pair", "N", "tooth_force");
      add(name + "share", "its share of the flank's force", "", "share");
      for (const char* axis : kAxes)
        add(name + axis + "_mm", "where the pair's force acts, from O2", "mm", "contact_point",
            axis);
      for (const char* axis : kAxes)
        add(name + "normal_" + axis, "direction of the pair's force on the block", "",
            "contact_normal", axis);
    }
  return table;
}

void append_teeth(ResultTable& table, double theta_deg, const Gear& gear,
                  const TeethAction& action) {
  const std::size_t first = table.values.size();
  const auto add = [&](double value) { table.values.push_back(value); };
  add(action.lag * 1e6);
  add(action.lag * gear.pitch_diameter / 2 * std::cos(gear.pressure_angle) * 1e6);
  double sums[2] = {};
  for (int flank = 0; flank < 2; ++flank) {
    for (int pair = 0; pair < kPairsPerFlank; ++pair)
      sums[flank] += action.pairs[flank * kPairsPerFlank + pair].force;
    add(sums[flank]);
  }
  for (int flank = 0; flank < 2; ++flank)
    for (int pair = 0; pair < kPairsPerFlank; ++pair) {
      const PairContact& contact = action.pairs[flank * kPairsPerFlank + pair];
      const bool carries = contact.force > 0;
      add(contact.shaft_tooth);
      add(contact.force);
      add(carries ? contact.force / sums[flank] : 0);
      for (const double x : contact.point) add(carries ? x * 1e3 : not_computed());
      for (const double x : contact.normal) add(carries ? x : not_computed());
    }
  table.theta_deg.push_back(theta_deg);
  for (std::size_t c = 0; c < table.columns(); ++c) {
    const double value = table.values[first + c];
    if (std::isfinite(value) || (std::isnan(value) && !is_stray_nan(value))) continue;
    throw ComputationError(table.name + " model: " + table.channels[c].name +
                           " is not finite at theta = " + number_text(theta_deg) + " deg");
  }
}

}  // namespace bentaxis
