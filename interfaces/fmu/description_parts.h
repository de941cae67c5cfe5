// What the descriptions of both versions write alike. Internal.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "description.h"

namespace bentaxis::fmu {

/// An attribute; characters that XML excludes are left out.
void set(pugi::xml_node node, const char* name, const std::string& value);
void set(pugi::xml_node node, const char* name, double value);
void set(pugi::xml_node node, const char* name, bool value);
void set(pugi::xml_node node, const char* name, const char* value) = delete;  // no bool

/// The root with its attributes. @param token_name  "guid", "instantiationToken"
pugi::xml_node add_root(pugi::xml_document& document, const Description& description,
                        const char* version, const char* token_name);
void add_units(pugi::xml_node root, const std::vector<Variable>& variables);
/// A type for each unit: quantity, unit, displayUnit. @param version  names their elements
void add_types(pugi::xml_node root, const std::vector<Variable>& variables, Version version);
void add_log_categories(pugi::xml_node root);
void add_experiment(pugi::xml_node root, const Description& description);
/// name, valueReference, description, causality, variability, initial.
void set_identity(pugi::xml_node node, const Variable& variable);
/// declaredType, unit, displayUnit, min, max, nominal, start of a number; start of a flag.
void set_values(pugi::xml_node node, const Variable& variable);

/// dependencies, and dependenciesKind where a factor is constant; nothing where the unknown is not
/// among them.
/// @param first  number of the first variable: 1 where places count, 0 where references do
void set_dependencies(pugi::xml_node node, const DependencesOf& all, const Variable& unknown,
                      unsigned first);

std::string to_text(const pugi::xml_document& document);

}  // namespace bentaxis::fmu
