#include "documentation.h"

#include <pugixml.hpp>
#include <sstream>

#include "bentaxis/pump/number.h"
#include "embedded.h"

namespace bentaxis::fmu {
namespace {

void say(pugi::xml_node body, const char* element, const std::string& text) {
  body.append_child(element).text().set(text.c_str());
}

const char* sentence_of(Drive drive) {
  switch (drive) {
    case Drive::speed:
      return "The inputs drive_speed and drive_acceleration set the motion of the shaft. Without "
             "the acceleration the reactions do not contain its inertia forces, and "
             "inertia_reactions_valid is false.";
    case Drive::torque:
      return "The input drive_torque drives the shaft.";
    case Drive::as_in_case:
      break;
  }
  return "The drive of the case turns the shaft; it has no input.";
}

void add_table(pugi::xml_node body, const std::string& title, Causality causality,
               const std::vector<Variable>& variables) {
  say(body, "h2", title);
  pugi::xml_node table = body.append_child("table");
  pugi::xml_node head = table.append_child("tr");
  for (const char* name : {"name", "unit", "start", "meaning"}) say(head, "th", name);
  for (const Variable& variable : variables) {
    if (variable.causality != causality) continue;
    pugi::xml_node row = table.append_child("tr");
    const bool starts = variable.start && causality != Causality::output;
    for (const std::string& cell :
         {variable.name, variable.boolean ? std::string("true, false") : variable.unit,
          starts ? number_text(*variable.start) : std::string(), variable.description})
      say(row, "td", cell);
  }
}

}  // namespace

std::string documentation_page(const Description& description, const UnitOptions& options,
                               const std::string& needs) {
  pugi::xml_document document;
  document.append_child(pugi::node_doctype).set_value("html");
  pugi::xml_node html = document.append_child("html");
  pugi::xml_node head = html.append_child("head");
  head.append_child("meta").append_attribute("charset") = "utf-8";
  say(head, "title", description.model_name);
  say(head, "style",
      "body{font-family:sans-serif;max-width:70em;margin:2em auto}td,th{text-align:left;"
      "padding:.1em .8em .1em 0;vertical-align:top}");
  pugi::xml_node body = html.append_child("body");
  say(body, "h1", description.model_name);
  say(body, "p", description.text);
  say(body, "p", sentence_of(options.drive));
  say(body, "p",
      "Co-simulation integrates to " + number_text(description.tolerance) +
          " of the scale of each state per step, for any length of the communication steps. The "
          "case is in resources/case.toml. For " +
          needs +
          ". Angles are those of the paper (Roccatello "
          "and Nervegna 2009); forces act on the body that is named first, at its point, in its "
          "frame.");
  add_table(body, "Inputs", Causality::input, description.variables);
  add_table(body, "Outputs", Causality::output, description.variables);
  add_table(body, "Parameters", Causality::parameter, description.variables);
  std::ostringstream text;
  document.save(
      text, " ",
      pugi::format_indent | pugi::format_no_declaration | pugi::format_no_empty_element_tags);
  return text.str();
}

}  // namespace bentaxis::fmu
