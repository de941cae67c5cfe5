#include "fmu_connections.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>

#include "bentaxis/hydraulics/oil_in_time.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/unit_of_measure.h"
#include "bentaxis/pump/words.h"
#include "bentaxis/results/channels.h"
#include "bentaxis/results/motion.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::study {
namespace {

// As descriptions of FMUs call it.
std::string unit_in_descriptions(const std::string& unit) {
  const UnitOfMeasure* const found = find_unit_of_measure(unit);
  return found == nullptr ? "?" : found->standard;
}

std::string first_of(const std::vector<std::string>& names) {
  constexpr std::size_t kMax = 12;
  if (names.size() <= kMax) return joined(names);
  return joined(std::span(names).first(kMax)) + ", ..";
}

std::string inputs_of_pump() {
  std::vector<std::string> names;
  for (const PumpInput& input : pump_inputs()) names.emplace_back(input.name);
  return first_of(names);
}

// Before the input of a wanted connection: whose it is.
constexpr const char* kOfPump = "pump:";
constexpr const char* kOfUnit = "fmu:";

const PumpInput* input_named(std::string_view name) {
  for (const PumpInput& input : pump_inputs())
    if (name == input.name) return &input;
  return nullptr;
}

class Connector {
 public:
  Connector(const fmu::UnitDescription& unit, const PumpSide& pump, std::string place)
      : unit_(unit), pump_(pump), place_(std::move(place)) {}

  std::vector<Connection> connect(const std::vector<std::string>& wanted) {
    for (const std::string& text : wanted) add_wanted(text);
    add_automatic();
    check_drive();
    return made_;
  }

 private:
  const fmu::UnitVariable* variable(std::string_view name, const char* causality) const {
    const fmu::UnitVariable* found = unit_.find(name);
    return found != nullptr && found->causality == causality ? found : nullptr;
  }
  std::vector<std::string> names(const char* causality) const {
    std::vector<std::string> all;
    for (const auto& v : unit_.variables)
      if (v.causality == causality) all.push_back(v.name);
    return all;
  }
  bool has_column(std::string_view name) const { return contains(pump_.columns, name); }
  bool is_made(bool to_pump, std::string_view receiver) const {
    return std::any_of(made_.begin(), made_.end(), [&](const Connection& c) {
      return c.to_pump == to_pump && (to_pump ? c.pump : c.unit.name) == receiver;
    });
  }
  // "": it is taken.
  std::string why_not_taken(std::string_view input) const {
    const bool is_load = input == "load_share";
    const bool taken = input == "suction_pressure"    ? pump_.takes.suction
                       : input == "delivery_pressure" ? pump_.takes.delivery
                       : is_load                      ? pump_.takes.load_share
                                                      : true;
    if (taken) return "";
    return is_load ? "the case has no load whose size could change: its oil must follow the motion "
                     "([pressure] kind = \"hydraulic\") and its delivery side must have a [load]"
                   : "the case does not take a pressure there: it has a curve, or [load] sets it";
  }

  void add_wanted(const std::string& text) {
    const std::string option = "--connect " + text;
    const auto sign = text.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == text.size())
      throw InputError(option + ": must be A=B: A gets the value of B");
    std::string to = text.substr(0, sign);
    const std::string from = text.substr(sign + 1);
    // Whose input it is may be said before it.
    const auto said = [&to](std::string_view whose) {
      const bool is = to.starts_with(whose);
      if (is) to.erase(0, whose.size());
      return is;
    };
    const bool of_pump = said(kOfPump), of_unit = !of_pump && said(kOfUnit);
    const fmu::UnitVariable* output = of_unit ? nullptr : variable(from, "output");
    const fmu::UnitVariable* input = of_pump ? nullptr : variable(to, "input");
    const bool to_pump = !of_unit && input_named(to) != nullptr && output != nullptr;
    const bool to_unit = input != nullptr && has_column(from);
    if (to_pump && to_unit)
      throw InputError(option +
                       ": is ambiguous: both the pump and the FMU have such an input and output; "
                       "write " +
                       kOfPump + text + " or " + kOfUnit + text + ", whose input it is");
    if (!to_pump && !to_unit) refuse_unknown(option, to, !of_unit && input == nullptr, input, from);
    if (is_made(to_pump, to)) throw InputError(option + ": \"" + to + "\" is connected already");
    if (to_pump) {
      if (const std::string why = why_not_taken(to); !why.empty())
        throw InputError(option + ": " + why);
      add(*input_named(to), *output, option, false);
    } else {
      add(from, *input, option, false);
    }
  }

  // @param of_unit  the FMU's input of that name, where it may be meant
  [[noreturn]] void refuse_unknown(const std::string& option, const std::string& to, bool of_pump,
                                   const fmu::UnitVariable* of_unit,
                                   const std::string& from) const {
    const auto meant_of = [&](const std::vector<std::string>& known, const char* more) {
      return suggestion(from, {known.begin(), known.end()}, more);
    };
    if (of_pump && input_named(to) != nullptr)
      throw InputError(fmt::format("{}: the FMU has no output \"{}\"{}", option, from,
                                   meant_of(names("output"), "in modelDescription.xml")));
    if (of_unit != nullptr)
      throw InputError(fmt::format("{}: the pump has no column \"{}\"{}", option, from,
                                   meant_of(pump_.columns, "in its tables")));
    throw InputError(
        fmt::format("{}: neither the pump nor the FMU has an input \"{}\": those of the pump are "
                    "{}; those of the FMU: {}",
                    option, to, inputs_of_pump(), first_of(names("input"))));
  }

  // Equal names; what was asked for stands.
  void add_automatic() {
    for (const PumpInput& input : pump_inputs())
      if (const auto* output = variable(input.name, "output");
          output != nullptr && !is_made(true, input.name) && why_not_taken(input.name).empty() &&
          !excluded(input.name))
        add(input, *output, place_ + ": output \"" + output->name + "\"", true);
    for (const auto& v : unit_.variables)
      if (v.causality == "input" && !is_made(false, v.name) && has_column(v.name))
        add(v.name, v, place_ + ": input \"" + v.name + "\"", true);
  }

  // A torque beside a motion that was asked for, or the other way.
  bool excluded(std::string_view input) const {
    const auto asked = [&](const char* name) {
      return std::any_of(made_.begin(), made_.end(), [&](const Connection& c) {
        return c.to_pump && !c.automatic && c.pump == name;
      });
    };
    if (input == "drive_torque") return asked("drive_speed");
    if (input == "drive_speed" || input == "drive_acceleration") return asked("drive_torque");
    return false;
  }

  void check_drive() const {
    if (is_made(true, "drive_torque") && is_made(true, "drive_speed"))
      throw InputError(place_ +
                       ": is ambiguous: its outputs drive_torque and drive_speed would both turn "
                       "the shaft; choose one by --connect drive_torque=NAME or drive_speed=NAME");
    if (is_made(true, "drive_acceleration") && !is_made(true, "drive_speed"))
      throw InputError(place_ + ": drive_acceleration without drive_speed: connect both");
    if (std::any_of(made_.begin(), made_.end(), [](const Connection& c) { return c.to_pump; }))
      return;
    for (const PumpInput& input : pump_inputs())
      if (variable(input.name, "output") != nullptr)
        throw InputError(fmt::format("{}: no output acts on the pump: {}: {}", place_, input.name,
                                     why_not_taken(input.name)));
    throw InputError(fmt::format(
        "{}: no output acts on the pump: connect an output ({}) by --connect to one of {}", place_,
        first_of(names("output")), inputs_of_pump()));
  }

  void add(const PumpInput& input, const fmu::UnitVariable& output, const std::string& what,
           bool automatic) {
    Connection c{true, input.name, input.unit, output, {}, {}, automatic};
    c.to = *fmu::measure_named(input.unit);
    c.from = measure_of(output, c.to, input.unit, what);
    made_.push_back(std::move(c));
  }
  void add(const std::string& column, const fmu::UnitVariable& input, const std::string& what,
           bool automatic) {
    const auto at = std::find(pump_.columns.begin(), pump_.columns.end(), column);
    const std::string unit = pump_.units[static_cast<std::size_t>(at - pump_.columns.begin())];
    Connection c{false, column, unit, input, {}, {}, automatic};
    const auto measure = fmu::measure_named(unit);
    if (!measure && !input.unit.empty())
      throw InputError(
          fmt::format("{}: {} has a unit that cannot be converted: \"{}\" must have "
                      "none",
                      what, column, input.name));
    c.from = measure.value_or(fmu::Measure{});
    c.to = measure_of(input, c.from, unit, what);
    made_.push_back(std::move(c));
  }

  // Of the unit's variable; one without a unit has that of the pump's.
  static fmu::Measure measure_of(const fmu::UnitVariable& v, const fmu::Measure& other,
                                 const std::string& other_unit, const std::string& what) {
    if (!v.numeric())
      throw InputError(fmt::format("{}: \"{}\" is of type {}{}: must be a single number", what,
                                   v.name, v.type, v.array ? " with dimensions" : ""));
    if (v.unit.empty()) return other;
    if (!v.measure)
      throw InputError(
          fmt::format("{}: the unit \"{}\" of \"{}\" has no BaseUnit in modelDescription.xml and "
                      "its name is unknown",
                      what, v.unit, v.name));
    if (!fmu::same_quantity(*v.measure, other))
      throw InputError(
          fmt::format("{}: units do not fit: \"{}\" is in {}, must be convertible to {}", what,
                      v.name, v.unit, other_unit.empty() ? "a share" : other_unit));
    return *v.measure;
  }

  const fmu::UnitDescription& unit_;
  const PumpSide& pump_;
  std::string place_;
  std::vector<Connection> made_;
};

}  // namespace

const std::vector<PumpInput>& pump_inputs() {
  static const std::vector<PumpInput> inputs = {
      {"drive_speed", "rad/s"},   {"drive_acceleration", "rad/s2"}, {"drive_torque", "Nm"},
      {"suction_pressure", "Pa"}, {"delivery_pressure", "Pa"},      {"load_share", ""}};
  return inputs;
}

PumpSide pump_side(const Case& the_case, bool oil_follows) {
  PumpSide side;
  const auto add_columns = [&](const std::vector<Column>& columns) {
    for (const Column& column : columns) {
      side.columns.push_back(column.name);
      side.units.push_back(unit_in_descriptions(column.unit));
    }
  };
  add_columns(state_columns(*the_case.drive));
  const auto add = [&](const std::vector<Channel>& channels) {
    for (const Channel& channel : channels) {
      side.columns.push_back(channel.name);
      side.units.push_back(fmu::measure_named(channel.unit) ? channel.unit : "?");
    }
  };
  add(ChannelLayout(the_case.pump).channels());
  add(motion_channels());
  side.takes.shaft = side.takes.torque = true;
  if (!oil_follows) {
    side.takes.suction = side.takes.delivery = the_case.pressure.kind == PressureKind::ideal;
    return side;
  }
  const auto oil = hydraulics::oil_in_time(the_case, {});
  add_columns(oil->columns());
  const TakesFromOutside of_oil = oil->takes();
  side.takes.suction = of_oil.suction;
  side.takes.delivery = of_oil.delivery;
  side.takes.load_share = of_oil.load_share;
  return side;
}

std::vector<Connection> connect(const fmu::UnitDescription& unit, const PumpSide& pump,
                                const std::vector<std::string>& wanted, const std::string& place) {
  return Connector(unit, pump, place).connect(wanted);
}

}  // namespace bentaxis::study
