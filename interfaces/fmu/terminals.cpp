// terminalsAndIcons.xml of FMI 3.0: which variables together are a connection.
#include "terminals.h"

#include "description_parts.h"

namespace bentaxis::fmu {
namespace {

// What a variable of a connection is (FMI 3.0, 2.4.9): the same on both sides, or a flow whose sum
// over all sides is zero, counted positive into or out of the unit.
constexpr const char *kSignal = "signal", *kInflow = "inflow", *kOutflow = "outflow";

struct Member {
  const Variable* variable;  ///< null: this unit has none
  const char *name, *kind;
};

const Variable* input_of(const std::vector<Variable>& all, Input which) {
  for (const Variable& it : all)
    if (it.role == Role::input && it.input == which) return &it;
  return nullptr;
}

// By the name without its unit, which is the case's own choice.
const Variable* output_of(const std::vector<Variable>& all, const std::string& quantity) {
  for (const Variable& it : all)
    if (it.role == Role::output && it.name.starts_with(quantity + "_")) return &it;
  return nullptr;
}

// A connection that lacks a member is none: a simulator could not connect it.
void add(pugi::xml_node terminals, const char* name, const char* meaning,
         const std::vector<Member>& members) {
  for (const Member& member : members)
    if (member.variable == nullptr) return;
  pugi::xml_node terminal = terminals.append_child("Terminal");
  terminal.append_attribute("name") = name;
  terminal.append_attribute("matchingRule") = "plug";
  terminal.append_attribute("description") = meaning;
  for (const Member& member : members) {
    pugi::xml_node node = terminal.append_child("TerminalMemberVariable");
    set(node, "variableName", member.variable->name);
    node.append_attribute("memberName") = member.name;
    node.append_attribute("variableKind") = member.kind;
  }
}

}  // namespace

std::string terminals_fmi3(const std::vector<Variable>& variables) {
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  pugi::xml_node root = document.append_child("fmiTerminalsAndIcons");
  root.append_attribute("fmiVersion") = "3.0";
  pugi::xml_node terminals = root.append_child("Terminals");

  const Variable* torque = input_of(variables, Input::torque);
  const Variable* speed = input_of(variables, Input::speed);
  if (torque != nullptr || speed != nullptr)
    add(terminals, "shaft", "the shaft: speed, and the drive torque on it, both about +z1",
        {{speed != nullptr ? speed : output_of(variables, "shaft"), "w", kSignal},
         {torque != nullptr ? torque : output_of(variables, "Td_z1"), "tau", kInflow}});
  add(terminals, "suction", "the suction port: gauge pressure, and the flow into the pump",
      {{input_of(variables, Input::suction), "p", kSignal},
       {output_of(variables, "flow_suction"), "q", kInflow}});
  // Where the load is in the unit there is nothing to connect.
  add(terminals, "delivery", "the delivery side: gauge pressure, and the flow out of the pump",
      {{input_of(variables, Input::delivery), "p", kSignal},
       {output_of(variables, "flow_delivery"), "q", kOutflow}});
  return terminals.first_child() ? to_text(document) : "";
}

}  // namespace bentaxis::fmu
