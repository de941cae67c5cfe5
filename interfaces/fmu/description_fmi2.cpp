// The description of FMI 2.0: a list of scalar variables, named by their place in it.
#include <algorithm>

#include "bentaxis/pump/lists.h"
#include "description_parts.h"

namespace bentaxis::fmu {
namespace {

void set_capabilities(pugi::xml_node node) {
  node.append_attribute("modelIdentifier") = kModelIdentifier;
  set(node, "needsExecutionTool", false);
  set(node, "canBeInstantiatedOnlyOncePerProcess", false);
  set(node, "canNotUseMemoryManagementFunctions", true);  // C++ has its own
  set(node, "canGetAndSetFMUstate", true);
  set(node, "canSerializeFMUstate", true);
  set(node, "providesDirectionalDerivative", true);
}

void add_kinds(pugi::xml_node root) {
  pugi::xml_node exchange = root.append_child("ModelExchange");
  set_capabilities(exchange);
  set(exchange, "completedIntegratorStepNotNeeded", false);
  pugi::xml_node simulation = root.append_child("CoSimulation");
  set_capabilities(simulation);
  set(simulation, "canHandleVariableCommunicationStepSize", true);
  set(simulation, "canInterpolateInputs", true);
  simulation.append_attribute("maxOutputDerivativeOrder") = 0;
  set(simulation, "canRunAsynchronuously", false);  // the standard spells it so
}

// The place of a variable, which is its reference, counts from 1.
unsigned index_of(std::uint32_t reference) { return reference + 1; }

void add_variables(pugi::xml_node root, const std::vector<Variable>& variables) {
  pugi::xml_node all = root.append_child("ModelVariables");
  for (const Variable& variable : variables) {
    pugi::xml_node scalar = all.append_child("ScalarVariable");
    set_identity(scalar, variable);
    pugi::xml_node type = scalar.append_child(variable.boolean ? "Boolean" : "Real");
    set_values(type, variable);
    if (variable.role == Role::derivative && variable.state)
      type.append_attribute("derivative") = index_of(*variable.state);
  }
}

template <class Pick>
void add_list(pugi::xml_node structure, const char* name, const std::vector<Variable>& variables,
              const DependencesOf& dependencies, Pick pick) {
  if (std::none_of(variables.begin(), variables.end(), pick)) return;
  pugi::xml_node list = structure.append_child(name);
  for (const Variable& variable : variables) {
    if (!pick(variable)) continue;
    pugi::xml_node unknown = list.append_child("Unknown");
    unknown.append_attribute("index") = index_of(variable.reference);
    set_dependencies(unknown, dependencies, variable, index_of(0));
  }
}

void add_structure(pugi::xml_node root, const Description& description) {
  const std::vector<Variable>& variables = description.variables;
  const Dependencies& depend = description.dependencies;
  pugi::xml_node structure = root.append_child("ModelStructure");
  add_list(structure, "Outputs", variables, depend.running,
           [](const Variable& variable) { return variable.causality == Causality::output; });
  add_list(structure, "Derivatives", variables, depend.running,
           [](const Variable& variable) { return variable.role == Role::derivative; });
  const auto unknowns = initial_unknowns(variables);
  add_list(structure, "InitialUnknowns", variables, depend.initial,
           [&](const Variable& variable) { return contains(unknowns, &variable); });
}

}  // namespace

std::string description_fmi2(const Description& description) {
  const std::vector<Variable>& variables = description.variables;
  pugi::xml_document document;
  pugi::xml_node root = add_root(document, description, "2.0", "guid");
  root.append_attribute("numberOfEventIndicators") = static_cast<unsigned>(
      std::count_if(variables.begin(), variables.end(),
                    [](const Variable& variable) { return variable.role == Role::indicator; }));
  add_kinds(root);
  add_units(root, variables);
  add_types(root, variables, Version::fmi2);
  add_log_categories(root);
  add_experiment(root, description);
  add_variables(root, variables);
  add_structure(root, description);
  return to_text(document);
}

}  // namespace bentaxis::fmu
