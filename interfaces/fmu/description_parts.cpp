#include "description_parts.h"

#include <algorithm>
#include <iterator>
#include <sstream>

#include "bentaxis/pump/number.h"
#include "units.h"

namespace bentaxis::fmu {
namespace {

// In the order of Causality and of Variability.
constexpr const char* kCausalities[] = {"independent", "parameter", "input", "output", "local"};
constexpr const char* kVariabilities[] = {"fixed", "tunable", "discrete", "continuous"};

void add_base(pugi::xml_node unit, const UnitOfMeasure& definition) {
  pugi::xml_node base = unit.append_child("BaseUnit");
  for (const auto& [name, exponent] :
       {std::pair{"kg", definition.dimension.kg}, std::pair{"m", definition.dimension.m},
        std::pair{"s", definition.dimension.s}, std::pair{"K", definition.dimension.kelvin},
        std::pair{"rad", definition.dimension.rad}})
    if (exponent != 0) base.append_attribute(name) = exponent;
  if (definition.factor != 1) set(base, "factor", definition.factor);
  if (definition.offset != 0) set(base, "offset", definition.offset);
}

void set_unit(pugi::xml_node node, const UnitOfMeasure& unit) {
  set(node, "unit", unit.standard);
  if (!unit.display.empty()) set(node, "displayUnit", unit.display);
}

std::vector<const UnitOfMeasure*> definitions_for(const std::vector<Variable>& variables) {
  std::vector<std::string> used;
  for (const Variable& variable : variables)
    if (!variable.boolean) used.push_back(variable.unit);
  return unit_definitions(used);
}

}  // namespace

Initial initial_of(const Variable& variable) {
  if (variable.causality == Causality::independent || variable.causality == Causality::input)
    return Initial::none;
  if (variable.causality == Causality::parameter) return Initial::exact;
  const bool begins_as_said = variable.role == Role::state && variable.start.has_value();
  return begins_as_said ? Initial::exact : Initial::calculated;
}

std::vector<const Variable*> initial_unknowns(const std::vector<Variable>& variables) {
  std::vector<const Variable*> unknowns;
  for (const Variable& variable : variables) {
    const bool listed = variable.causality == Causality::output || variable.role == Role::state ||
                        variable.role == Role::derivative;
    if (listed && initial_of(variable) == Initial::calculated) unknowns.push_back(&variable);
  }
  return unknowns;
}

void set(pugi::xml_node node, const char* name, const std::string& value) {
  std::string text;
  std::transform(value.begin(), value.end(), std::back_inserter(text), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 ? ' ' : c;  // names are to be on one line
  });
  node.append_attribute(name) = text.c_str();
}

void set(pugi::xml_node node, const char* name, double value) {
  set(node, name, number_text(value));
}

void set(pugi::xml_node node, const char* name, bool value) { node.append_attribute(name) = value; }

pugi::xml_node add_root(pugi::xml_document& document, const Description& description,
                        const char* version, const char* token_name) {
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node root = document.append_child("fmiModelDescription");
  root.append_attribute("fmiVersion") = version;
  set(root, "modelName", description.model_name);
  set(root, token_name, description.token);
  set(root, "description", description.text);
  root.append_attribute("version") = BENTAXIS_VERSION;
  root.append_attribute("license") = "Apache-2.0";
  root.append_attribute("generationTool") = "bentaxis " BENTAXIS_VERSION;
  if (!description.generated.empty()) set(root, "generationDateAndTime", description.generated);
  root.append_attribute("variableNamingConvention") = "structured";
  return root;
}

void add_units(pugi::xml_node root, const std::vector<Variable>& variables) {
  const auto definitions = definitions_for(variables);
  if (definitions.empty()) return;
  pugi::xml_node all = root.append_child("UnitDefinitions");
  for (const UnitOfMeasure* definition : definitions) {
    pugi::xml_node unit = all.append_child("Unit");
    set(unit, "name", definition->standard);
    add_base(unit, *definition);
    if (definition->display.empty()) continue;
    pugi::xml_node display = unit.append_child("DisplayUnit");
    set(display, "name", definition->display);
    set(display, "factor", definition->display_factor);
  }
}

void add_types(pugi::xml_node root, const std::vector<Variable>& variables, Version version) {
  const auto definitions = definitions_for(variables);
  if (definitions.empty()) return;
  pugi::xml_node all = root.append_child("TypeDefinitions");
  for (const UnitOfMeasure* definition : definitions) {
    const bool nested = version == Version::fmi2;
    pugi::xml_node type = all.append_child(nested ? "SimpleType" : "Float64Type");
    set(type, "name", type_name(*definition));
    if (nested) type = type.append_child("Real");
    set(type, "quantity", definition->quantity);
    set_unit(type, *definition);
  }
}

void add_log_categories(pugi::xml_node root) {
  pugi::xml_node all = root.append_child("LogCategories");
  const std::pair<const char*, const char*> categories[] = {
      {"logEvents", "events: port edges, contact of teeth, breakpoints of curves"},
      {"logStatusWarning", "warnings of calls that return fmi*Warning"},
      {"logStatusDiscard", "reason why a call was refused"},
      {"logStatusError", "what was wrong"},
      {"logStatusFatal", "reason why the instance cannot continue"},
      {"logAll", "all of these"}};
  for (const auto& [name, meaning] : categories) {
    pugi::xml_node category = all.append_child("Category");
    category.append_attribute("name") = name;
    category.append_attribute("description") = meaning;
  }
}

void add_experiment(pugi::xml_node root, const Description& description) {
  pugi::xml_node experiment = root.append_child("DefaultExperiment");
  set(experiment, "startTime", 0.0);
  set(experiment, "stopTime", description.stop_time);
  set(experiment, "tolerance", description.tolerance);
  if (description.step > 0) set(experiment, "stepSize", description.step);
}

void set_identity(pugi::xml_node node, const Variable& variable) {
  set(node, "name", variable.name);
  node.append_attribute("valueReference") = variable.reference;
  if (!variable.description.empty()) set(node, "description", variable.description);
  node.append_attribute("causality") = kCausalities[static_cast<int>(variable.causality)];
  node.append_attribute("variability") = kVariabilities[static_cast<int>(variable.variability)];
  const Initial initial = initial_of(variable);
  if (initial != Initial::none)
    node.append_attribute("initial") = initial == Initial::exact ? "exact" : "calculated";
}

void set_values(pugi::xml_node node, const Variable& variable) {
  const bool starts = variable.start && variable.causality != Causality::independent &&
                      initial_of(variable) != Initial::calculated;
  if (variable.boolean) {
    if (starts) set(node, "start", *variable.start != 0);
    return;
  }
  if (const UnitOfMeasure* unit = unit_definition(variable.unit)) {
    set(node, "declaredType", type_name(*unit));
    set_unit(node, *unit);
  }
  if (variable.least) set(node, "min", *variable.least);
  if (variable.most) set(node, "max", *variable.most);
  if (variable.nominal) set(node, "nominal", *variable.nominal);
  if (starts) set(node, "start", *variable.start);
}

void set_dependencies(pugi::xml_node node, const DependencesOf& all, const Variable& unknown,
                      unsigned first) {
  const auto found = all.find(unknown.reference);
  if (found == all.end()) return;
  std::string knowns, kinds;
  bool constant = false;
  for (const Dependence& one : found->second) {
    const std::string blank = knowns.empty() ? "" : " ";
    knowns += blank + std::to_string(one.known + first);
    kinds += blank + (one.constant ? "constant" : "dependent");
    constant = constant || one.constant;
  }
  set(node, "dependencies", knowns);
  if (constant) set(node, "dependenciesKind", kinds);
}

std::string to_text(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "  ", pugi::format_default, pugi::encoding_utf8);
  return text.str();
}

}  // namespace bentaxis::fmu
