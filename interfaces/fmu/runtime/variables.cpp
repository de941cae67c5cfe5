#include "variables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/validate.h"
#include "plant.h"

namespace bentaxis::fmu {
namespace {

// Masses of a piston that its inertia, as this model assumes it, does not go by.
bool is_of_other_inertia(const std::string& name, PistonInertia inertia) {
  if (name == "piston.joint_mass_fraction") return inertia != PistonInertia::lumped;
  const bool real = name == "piston.centre_of_mass_mm" ||
                    name == "piston.transverse_inertia_kg_mm2" ||
                    name == "piston.axial_inertia_kg_mm2" || name == "piston.spin_rpm";
  return real && inertia == PistonInertia::lumped;
}

// Numbers that an input stands for.
bool is_replaced(const std::string& name, const Case& the_case, const TakesFromOutside& takes) {
  if (name == "operation.speed_rpm") return takes.shaft;
  if (name == "drive.torque_Nm") return takes.torque || !the_case.drive->curve.time.empty();
  if (name == "pressure.suction_bar") return takes.suction;
  if (name == "pressure.delivery_bar") return takes.delivery;
  return false;
}

std::string words_of(const Parameter& parameter) {
  std::string text = (parameter.symbol.empty() ? "" : parameter.symbol + ": ") + parameter.meaning;
  std::erase(text, '`');
  return text;
}

std::string rate_unit(const std::string& unit) {
  if (unit == "rad/s") return "rad/s2";
  if (unit == "m/s") return "m/s2";
  return unit.empty() || unit == "-" ? "1/s" : unit + "/s";
}

class List {
 public:
  std::vector<Variable> take() { return std::move(all_); }

  Variable& add(std::string name, const std::string& unit, Role role, Causality causality,
                Variability variability) {
    if (!names_.insert(name).second) throw std::logic_error("two variables of a unit are " + name);
    Variable variable;
    variable.reference = static_cast<std::uint32_t>(all_.size());
    variable.name = std::move(name);
    variable.unit = unit;
    variable.role = role;
    variable.causality = causality;
    variable.variability = variability;
    all_.push_back(std::move(variable));
    return all_.back();
  }

  void add_parameter(const Table& table, const Parameter& parameter, const std::string& name,
                     std::size_t place, double start) {
    Variable& it =
        add(name, parameter.unit.name, Role::parameter, Causality::parameter,
            parameter.in_fmu == InFmu::tunable ? Variability::tunable : Variability::fixed);
    it.description = words_of(parameter);
    it.table = table.name;
    it.key = parameter.key;
    it.place = place;
    it.start = start;
    // A range that depends on other parameters holds for their present values alone.
    if (parameter.range_here != nullptr) return;
    const NumberRange& range = parameter.range;
    // A start may be off a bound by its conversion.
    if (std::isfinite(range.low) && !range.low_open && start >= range.low) it.least = range.low;
    if (std::isfinite(range.high) && !range.high_open && start <= range.high) it.most = range.high;
  }

  void add_parameters(const Case& the_case, const TakesFromOutside& takes) {
    const Registry& registry = standard_registry();
    for (const Table& table : registry.tables)
      for (const Parameter& parameter : table.parameters) {
        const std::string name = table.name + "." + parameter.key;
        if (!is_active(table, parameter, registry, the_case) || parameter.in_fmu == InFmu::absent ||
            is_replaced(name, the_case, takes) ||
            is_of_other_inertia(name, the_case.analytic.inertia))
          continue;
        const std::optional<Value> value = value_of(parameter, the_case);
        if (!value) continue;
        if (const double* number = std::get_if<double>(&*value))
          add_parameter(table, parameter, name, 0, *number);
        if (const auto* pair = std::get_if<std::array<double, 2>>(&*value))
          for (const std::size_t place : {0U, 1U})
            add_parameter(table, parameter, name + (place == 0 ? "[1]" : "[2]"), place,
                          (*pair)[place]);
      }
  }

  void add_switch(Input input, const char* name, const char* description) {
    Variable& it = add(name, "", Role::input, Causality::input, Variability::discrete);
    it.description = description;
    it.input = input;
    it.boolean = true;
    it.start = 0;
  }

  void add_input(Input input, const char* name, const char* unit, const char* description,
                 double start) {
    Variable& it = add(name, unit, Role::input, Causality::input, Variability::continuous);
    it.description = description;
    it.input = input;
    it.start = start;
  }

  /// @param the_case  whose atmosphere and load they are
  void add_inputs(const Case& the_case, const Inputs& first, const TakesFromOutside& takes) {
    if (takes.shaft) {
      add_input(Input::speed, "drive_speed", "rad/s", "speed of the shaft, positive about +z1",
                first.speed);
      add_input(Input::acceleration, "drive_acceleration", "rad/s2",
                "acceleration of the shaft, used to extrapolate the speed between two "
                "communication points; without it inertia forces of a changing speed are missing",
                first.acceleration);
    }
    if (takes.torque)
      add_input(Input::torque, "drive_torque", "Nm", "torque on the shaft, positive about +z1",
                first.torque);
    if (takes.suction)
      add_input(Input::suction, "suction_pressure", "Pa", "gauge, of what the pump draws from",
                first.suction);
    if (takes.suction) bound_pressure(the_case);
    if (takes.delivery)
      add_input(Input::delivery, "delivery_pressure", "Pa", "gauge, of what the pump delivers to",
                first.delivery);
    if (takes.delivery) bound_pressure(the_case);
    if (takes.load_share) {
      add_input(Input::load_share, "load_share", "",
                "fraction of the size of the load: of an orifice's area, a laminar load's "
                "conductance, a motor's flow or the opening of a valve",
                first.load_share);
      all_.back().least = 0;
      if (!the_case.hydraulics->load.value_or(LoadData()).share.time.empty())
        add_switch(
            Input::load_share_replaces_curve, "load_share_replaces_curve",
            "true: load_share acts at every value, in place of the load's curve over time; "
            "false: the curve acts while load_share is 1, and load_share at any other value");
    }
  }

  void add_states(const std::vector<PlantColumn>& states) {
    std::vector<std::uint32_t> references;
    for (std::size_t i = 0; i < states.size(); ++i) {
      Variable& it = add("state." + states[i].name, states[i].unit, Role::state, Causality::local,
                         Variability::continuous);
      it.description = states[i].description;
      it.nominal = states[i].nominal;
      it.place = i;
      references.push_back(it.reference);
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      Variable& it = add("der(state." + states[i].name + ")", rate_unit(states[i].unit),
                         Role::derivative, Causality::local, Variability::continuous);
      it.description = "rate of state." + states[i].name;
      it.state = references[i];
      it.place = i;
    }
  }

  void add_columns(const std::vector<PlantColumn>& columns, Role role, const std::string& prefix) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      Variable& it = add(prefix + columns[i].name, columns[i].unit, role,
                         role == Role::indicator ? Causality::local : Causality::output,
                         role == Role::flag ? Variability::discrete : Variability::continuous);
      it.description = columns[i].description;
      it.place = i;
      it.boolean = role == Role::flag;
      if (columns[i].nominal != 1) it.nominal = columns[i].nominal;
    }
  }

 private:
  void bound_pressure(const Case& the_case) {
    const double least = least_pressure(the_case);
    if (all_.back().start >= least) all_.back().least = least;
  }

  std::vector<Variable> all_;
  std::set<std::string> names_;
};

}  // namespace

double least_pressure(const Case& the_case) {
  constexpr double kStandard = 101325, kMinAbsolute = 1;  // Pa
  const double atmosphere = the_case.hydraulics ? the_case.hydraulics->atmosphere : kStandard;
  return kMinAbsolute - atmosphere;
}

Case case_with(Case the_case, const std::vector<Variable>& variables,
               const std::vector<double>& values) {
  for (const Variable& it : variables) {
    if (it.role != Role::parameter || values[it.reference] == *it.start) continue;
    const Parameter& parameter = parameter_of(standard_registry(), it.table, it.key);
    Value whole = value_of(parameter, the_case).value();
    if (auto* pair = std::get_if<std::array<double, 2>>(&whole))
      (*pair)[it.place] = values[it.reference];
    else
      whole = values[it.reference];
    store(parameter, the_case, whole);
  }
  return validate(the_case);
}

std::vector<Variable> variables_of(const Case& the_case, const UnitChoice& choice) {
  const Case driven = with_drive(the_case, choice.drive);
  const Plant plant(driven, choice, Plant::Kind::model_exchange);
  const PlantColumns columns = columns_of(driven, choice);
  List list;
  list.add("time", "s", Role::time, Causality::independent, Variability::continuous).description =
      "time of the simulation";
  list.add_parameters(driven, plant.takes());
  list.add_inputs(driven, plant.first_inputs(), plant.takes());
  list.add_states(columns.states);
  list.add_columns(columns.outputs, Role::output, "");
  list.add_columns(columns.flags, Role::flag, "");
  list.add_columns(columns.indicators, Role::indicator, "indicator.");
  return list.take();
}

}  // namespace bentaxis::fmu
