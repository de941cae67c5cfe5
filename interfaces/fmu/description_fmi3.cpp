// The description of FMI 3.0: variables by type, named by their references.
#include "description_parts.h"

namespace bentaxis::fmu {
namespace {

void set_capabilities(pugi::xml_node node) {
  node.append_attribute("modelIdentifier") = kModelIdentifier;
  set(node, "needsExecutionTool", false);
  set(node, "canBeInstantiatedOnlyOncePerProcess", false);
  set(node, "canGetAndSetFMUState", true);
  set(node, "canSerializeFMUState", true);
  set(node, "providesDirectionalDerivatives", true);
  set(node, "providesAdjointDerivatives", false);
}

void add_kinds(pugi::xml_node root) {
  pugi::xml_node exchange = root.append_child("ModelExchange");
  set_capabilities(exchange);
  set(exchange, "needsCompletedIntegratorStep", true);
  pugi::xml_node simulation = root.append_child("CoSimulation");
  set_capabilities(simulation);
  set(simulation, "canHandleVariableCommunicationStepSize", true);
  for (const char* ability : {"providesIntermediateUpdate", "mightReturnEarlyFromDoStep",
                              "canReturnEarlyAfterIntermediateUpdate", "hasEventMode"})
    set(simulation, ability, true);
}

void add_variables(pugi::xml_node root, const std::vector<Variable>& variables) {
  pugi::xml_node all = root.append_child("ModelVariables");
  for (const Variable& variable : variables) {
    pugi::xml_node node = all.append_child(variable.boolean ? "Boolean" : "Float64");
    set_identity(node, variable);
    set_values(node, variable);
    if (has_intermediate_values(variable)) set(node, "intermediateUpdate", true);
    if (variable.role == Role::derivative && variable.state)
      node.append_attribute("derivative") = *variable.state;
  }
}

void add_structure(pugi::xml_node root, const Description& description) {
  const std::vector<Variable>& variables = description.variables;
  const Dependencies& depend = description.dependencies;
  pugi::xml_node structure = root.append_child("ModelStructure");
  const auto add = [&](const char* name, const Variable& variable, const DependencesOf& of) {
    pugi::xml_node unknown = structure.append_child(name);
    unknown.append_attribute("valueReference") = variable.reference;
    set_dependencies(unknown, of, variable, 0);
  };
  for (const Variable& variable : variables)
    if (variable.causality == Causality::output) add("Output", variable, depend.running);
  for (const Variable& variable : variables)
    if (variable.role == Role::derivative)
      add("ContinuousStateDerivative", variable, depend.running);
  for (const Variable* variable : initial_unknowns(variables)) {
    add("InitialUnknown", *variable, depend.initial);
  }
  for (const Variable& variable : variables)
    if (variable.role == Role::indicator) add("EventIndicator", variable, depend.running);
}

}  // namespace

std::string description_fmi3(const Description& description) {
  pugi::xml_document document;
  pugi::xml_node root = add_root(document, description, "3.0", "instantiationToken");
  add_kinds(root);
  add_units(root, description.variables);
  add_types(root, description.variables, Version::fmi3);
  add_log_categories(root);
  add_experiment(root, description);
  add_variables(root, description.variables);
  add_structure(root, description);
  return to_text(document);
}

}  // namespace bentaxis::fmu
