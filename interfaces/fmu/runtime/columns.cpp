#include "columns.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bentaxis/coupled/open_system.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/trajectory.h"
#include "machine.h"
#include "plant.h"

namespace bentaxis::fmu {
namespace {

std::string meaning_of(const Channel& channel) {
  std::string text = channel.meaning;
  const auto add = [&](const char* how, const std::string& what) {
    if (!what.empty()) text += std::string(text.empty() ? "" : ", ") + how + what;
  };
  add("on ", channel.on_body);
  add("by ", channel.by_body);
  add("at ", channel.point);
  add("in ", channel.frame);
  return text;
}

// "l/min" at the end of a name: "_l_per_min".
std::string ending_of(const std::string& unit) {
  const auto slash = unit.find('/');
  return "_" + (slash == std::string::npos
                    ? unit
                    : unit.substr(0, slash) + "_per_" + unit.substr(slash + 1));
}

// The unit of the SI for the same quantity; null where the table has none, or it is one.
const UnitOfMeasure* si_unit_for(const UnitOfMeasure& unit) {
  const auto& all = units_of_measure();
  if (unit.factor == 1 || unit.offset != 0) return nullptr;
  const auto found = std::find_if(all.begin(), all.end(), [&](const UnitOfMeasure& other) {
    return other.quantity == unit.quantity && other.dimension == unit.dimension &&
           other.factor == 1 && other.offset == 0;
  });
  return found == all.end() ? nullptr : &*found;
}

// The column in its SI unit, with a name that ends in it.
void make_si(OutputPlace& place) {
  PlantColumn& column = place.column;
  const UnitOfMeasure* const unit = find_unit_of_measure(column.unit);
  const UnitOfMeasure* const si = unit == nullptr ? nullptr : si_unit_for(*unit);
  if (si == nullptr) return;
  if (const std::string ending = ending_of(column.unit); column.name.ends_with(ending))
    column.name.replace(column.name.size() - ending.size(), ending.size(), ending_of(si->name));
  column.unit = si->name;
  if (place.unit_in_si == unit->factor)
    place.unit_in_si = 1;  // as the model has it
  else
    place.factor = unit->factor;
}

}  // namespace

std::vector<FlagRule> flag_rules(const Machine& machine) {
  std::vector<FlagRule> rules = {
      {Flag::inertia,
       {"inertia_reactions_valid", "",
        "false where drive_speed has changed and drive_acceleration was never given: inertia "
        "forces and Td then use the former acceleration"}}};
  if (machine.mechanics->compliant())
    rules.push_back({Flag::contact, {"tooth_contact", "", "a flank of the teeth touches"}});
  rules.push_back(
      {Flag::flank,
       {"valid_flank", "", "Rcs >= 0: the tooth force is on the flank that is modelled"}});
  rules.push_back(
      {Flag::film, {"valid_film", "", "Fh <= 0: the film pushes the block off the port plate"}});
  if (machine.the_case.pump.port_plate)
    rules.push_back(
        {Flag::point, {"valid_point", "", "the film force acts within the port plate"}});
  rules.push_back(
      {Flag::thrust,
       {"valid_thrust", "", "Rb1_z1 >= 0: the tapered bearing is loaded in its direction"}});
  if (machine.oil->limits()) {
    rules.push_back(
        {Flag::saturation,
         {"cavitation", "",
          "pressure in a chamber below the saturation pressure (dissolved air is released)"}});
    rules.push_back(
        {Flag::vapour, {"vapour", "", "pressure in a chamber below the vapour pressure"}});
  }
  return rules;
}

std::vector<OutputPlace> output_places(const Machine& machine, bool si) {
  std::vector<OutputPlace> places;
  std::vector<std::string> names;
  const auto add = [&](PlantColumn column, OutputPlace::From from, std::size_t index, double unit) {
    // What is a channel too is not shown twice.
    if (contains(names, column.name)) return;
    names.push_back(column.name);
    places.push_back({std::move(column), from, index, unit});
  };
  const std::vector<Column> states = state_columns(*machine.the_case.drive);
  for (auto i = static_cast<std::size_t>(StateColumn::theta); i < states.size(); ++i)
    add({states[i].name, states[i].unit, states[i].meaning}, OutputPlace::From::state, i, 1);
  const std::vector<Channel>& channels = machine.mechanics->layout().channels();
  for (std::size_t i = 0; i < channels.size(); ++i)
    add({channels[i].name, channels[i].unit, meaning_of(channels[i])}, OutputPlace::From::row, i,
        channels[i].unit_in_si);
  const std::vector<Channel> checks = motion_channels();
  for (std::size_t i = 0; i < checks.size(); ++i)
    // Of teeth that give way alone.
    if (i != 0 || machine.mechanics->compliant())
      add({checks[i].name, checks[i].unit, meaning_of(checks[i])}, OutputPlace::From::check, i,
          checks[i].unit_in_si);
  const std::vector<OilColumn> oil = machine.oil->columns();
  for (std::size_t i = 0; i < oil.size(); ++i)
    add({oil[i].name, oil[i].unit, oil[i].meaning}, OutputPlace::From::oil, i, 1);
  if (si) std::for_each(places.begin(), places.end(), make_si);
  return places;
}

Case with_drive(Case the_case, Drive drive) {
  if (drive == Drive::as_in_case) {
    drive_of(the_case);
    return the_case;
  }
  DriveSpec spec = the_case.drive.value_or(DriveSpec());
  const double omega = rad_per_second(the_case.operation.speed_rpm);
  if (drive == Drive::speed) {
    spec.start_speed.reset();
    spec.torque = 0;
    spec.kind = DriveKind::speed;
  } else {
    if (spec.kind != DriveKind::torque)
      spec.torque = 0;
    else if (!spec.curve.time.empty())
      spec.torque = TimeSignal(spec.curve).value(0);
    if (!spec.start_speed) spec.start_speed = omega;
    spec.kind = DriveKind::torque;
  }
  spec.curve = {};
  spec.motor.reset();
  if (!(spec.duration > 0)) {
    constexpr double kTurn = 60;  // s rpm
    spec.duration = omega != 0 ? kTurn / std::abs(the_case.operation.speed_rpm) : 1;
    spec.samples = the_case.operation.samples_per_revolution;
  }
  the_case.drive = spec;
  return the_case;
}

PlantColumns columns_of(const Case& the_case, const UnitChoice& choice) {
  const Machine machine(with_drive(the_case, choice.drive), {});
  PlantColumns all;
  for (OutputPlace& place : output_places(machine, choice.si_outputs))
    all.outputs.push_back(std::move(place.column));
  for (FlagRule& rule : flag_rules(machine)) all.flags.push_back(std::move(rule.column));
  const coupled::OpenSystem open(*machine.mechanics, *machine.oil, choice.drive == Drive::speed);
  for (const coupled::OpenState& state : open.states())
    all.states.push_back({state.name, state.unit, state.meaning, state.nominal});
  for (const coupled::OpenIndicator& indicator : open.indicators())
    all.indicators.push_back({indicator.name, indicator.unit, indicator.meaning});
  return all;
}

}  // namespace bentaxis::fmu
