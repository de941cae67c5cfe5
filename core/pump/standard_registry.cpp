// The parameters of this program, put together; each table stands in a file of tables/.
#include "bentaxis/pump/number.h"
#include "tables/entries.h"

namespace bentaxis {

bool delivery_is_held(const Case& the_case) {
  const LoadData* load = tables::find(the_case, &HydraulicData::load);
  return the_case.pressure.ports.delivery == 0 ||
         (load != nullptr && load->kind == LoadKind::constant_pressure);
}

namespace tables {

std::string short_text(double value) { return rounded_text(value, 6); }

std::string arc_refusal(const PortArc& arc) {
  if (arc.from_deg < arc.to_deg && arc.to_deg <= arc.from_deg + 360) return "";
  return "must be [from, to] with from < to <= from + 360";
}

std::string path_in_pump(std::string place) {
  std::erase(place, ' ');
  for (auto arrow = place.find("->"); arrow != std::string::npos; arrow = place.find("->"))
    place.replace(arrow, 2, ".");
  return place.substr(std::string("c.pump.").size());
}

Parameter number(std::string key, std::string symbol, Field field, Unit unit, NumberRange range,
                 Default fallback, std::string meaning, Parameter more) {
  more.key = std::move(key);
  more.symbol = std::move(symbol);
  more.field = std::move(field);
  more.unit = unit;
  more.range = range;
  more.fallback = std::move(fallback);
  more.meaning = std::move(meaning);
  return more;
}

Parameter choice(std::string key, Field field, std::vector<std::string> words, Default fallback,
                 std::string meaning, Parameter more) {
  more.words = std::move(words);
  std::string symbol = more.symbol;
  return number(std::move(key), std::move(symbol), std::move(field), kNoUnit, kAny,
                std::move(fallback), std::move(meaning), std::move(more));
}

Parameter choice(std::string key, Field field, std::vector<std::string> words, const char* fallback,
                 std::string meaning, Parameter more) {
  return choice(std::move(key), std::move(field), std::move(words), Default{std::string(fallback)},
                std::move(meaning), std::move(more));
}

Parameter flag(std::string key, Field field, bool fallback, std::string meaning) {
  return choice(std::move(key), std::move(field), {}, Default{fallback}, std::move(meaning));
}

Parameter text(std::string key, Field field, std::string meaning, Parameter more) {
  return choice(std::move(key), std::move(field), {}, "", std::move(meaning), std::move(more));
}

Parameter required_text(std::string key, Field field, std::string meaning, Parameter more) {
  return choice(std::move(key), std::move(field), {}, kRequired, std::move(meaning),
                std::move(more));
}

}  // namespace tables

namespace {

// What an entry need not say twice.
void complete(Parameter& parameter, const Table& table) {
  if (parameter.differentiable == nullptr) parameter.differentiable = table.differentiable;
  if (!parameter.in_fmu) parameter.in_fmu = table.in_fmu;
  parameter.within = parameter.part != nullptr ? parameter.part : table.part;
  for (const Access<double>* place : numbers_of(parameter.field))
    if (place->in_pump != nullptr) parameter.path.push_back(place->path);
}

Registry make_registry() {
  using namespace tables;
  Registry registry{{top_level(),
                     pump_table(),
                     transfer_table(),
                     gear_table(),
                     bearings_table(),
                     piston_table(),
                     shaft_table(),
                     block_table(),
                     friction_table(),
                     operation_table(),
                     drive_table(),
                     pressure_table(),
                     port_plate_table(),
                     hydraulics_table(),
                     oil_table(),
                     leakage_table(),
                     suction_line_table(),
                     delivery_line_table(),
                     load_table(),
                     accumulator_table(),
                     loop_table(),
                     analytic_assumptions_table(),
                     multibody_assumptions_table(),
                     plausibility_table()}};
  for (Table& table : registry.tables)
    for (Parameter& parameter : table.parameters) complete(parameter, table);
  return registry;
}

}  // namespace

// In the order in which a case is read.
const Registry& standard_registry() {
  static const Registry registry = make_registry();
  return registry;
}

}  // namespace bentaxis
