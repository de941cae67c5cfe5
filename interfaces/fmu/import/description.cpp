// modelDescription.xml of FMI 2.0 and 3.0: what an importer for co-simulation needs of it.
#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <pugixml.hpp>

#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::fmu {
namespace {

constexpr std::size_t kLongestName = 400;  // bytes that a message shows

using Types = std::map<std::string, std::string, std::less<>>;  // names of types -> units

class Reader {
 public:
  Reader(const std::string& xml, std::string place) : place_(std::move(place)) {
    const auto parsed = document_.load_buffer(xml.data(), xml.size());
    if (!parsed)
      fail("is no XML: " + std::string(parsed.description()) + " at byte " +
           std::to_string(parsed.offset));
    root_ = document_.document_element();
    if (std::string_view(root_.name()) != "fmiModelDescription")
      fail("begins with <" + without_control_characters(root_.name()) +
           ">: must be <fmiModelDescription>");
  }

  UnitDescription read() {
    UnitDescription d;
    const std::string version = needed(root_, "fmiVersion");
    if (!version.starts_with("2.") && !version.starts_with("3."))
      fail("fmiVersion = \"" + version + "\": must be 2.0 or 3.0");
    d.version = version[0] - '0';
    d.model_name = plain(root_, "modelName");
    d.tool = plain(root_, "generationTool");
    d.token = needed(root_, d.version == 2 ? "guid" : "instantiationToken");
    d.identifier = identifier("CoSimulation");
    d.exchange_identifier = identifier("ModelExchange");
    const auto experiment = root_.child("DefaultExperiment");
    d.start_time = number(experiment, "startTime");
    d.stop_time = number(experiment, "stopTime");
    d.tolerance = number(experiment, "tolerance");
    d.step_size = number(experiment, "stepSize");
    read_measures();
    read_types();
    for (const auto& node : root_.child("ModelVariables").children())
      if (node.type() == pugi::node_element) d.variables.push_back(variable(node, d.version));
    check_names(d.variables);
    return d;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { throw InputError(place_ + ": " + why); }

  std::string needed(const pugi::xml_node& node, const char* key) const {
    const auto attribute = node.attribute(key);
    if (!attribute) fail("<" + std::string(node.name()) + "> has no " + key);
    return plain(node, key);
  }

  // The value of an attribute, "" where it is missing. It is printed, and names files and columns.
  std::string plain(const pugi::xml_node& node, const char* key) const {
    std::string text = node.attribute(key).value();
    if (has_control_characters(text, false) || !is_utf8(text))
      fail("<" + std::string(node.name()) + "> " + key + " = \"" +
           without_control_characters(text) + "\": contains a control character or is not UTF-8");
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
    return text;
  }

  std::optional<double> number(const pugi::xml_node& node, const char* key) const {
    const auto attribute = node.attribute(key);
    if (!attribute) return std::nullopt;
    const auto value = number_in(attribute.value());
    if (!value)
      fail("<" + std::string(node.name()) + "> " + key + " = \"" + attribute.value() +
           "\": must be a number");
    return value;
  }

  // It names a file, and nothing but one.
  std::string identifier(const char* kind) const {
    const auto node = root_.child(kind);
    if (!node) return "";
    std::string name = needed(node, "modelIdentifier");
    const auto good = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    };
    if (name.empty() || !std::all_of(name.begin(), name.end(), good))
      fail("modelIdentifier = \"" + name + "\": must be letters, digits and _");
    return name;
  }

  void read_measures() {
    static const std::array<const char*, 8> bases = {"kg", "m", "s", "A", "K", "mol", "cd", "rad"};
    for (const auto& unit : root_.child("UnitDefinitions").children("Unit")) {
      const std::string name = needed(unit, "name");
      const auto base = unit.child("BaseUnit");
      if (!base) continue;
      Measure measure;
      for (std::size_t i = 0; i < bases.size(); ++i)
        measure.exponents[i] = base.attribute(bases[i]).as_int(0);
      measure.factor = number(base, "factor").value_or(1);
      measure.offset = number(base, "offset").value_or(0);
      if (measure.factor == 0) fail("unit \"" + name + "\": factor = 0: must be another number");
      measures_[name] = measure;
    }
  }

  void read_types() {
    for (const auto& type : root_.child("TypeDefinitions").children()) {
      const std::string name = plain(type, "name");
      types_[name] = plain(type, "unit");  // FMI 3
      if (const auto real = type.child("Real")) types_[name] = plain(real, "unit");
    }
  }

  UnitVariable variable(const pugi::xml_node& node, int version) const {
    UnitVariable v;
    v.name = needed(node, "name");
    v.description = plain(node, "description");
    const std::string reference = needed(node, "valueReference");
    const char* end = reference.data() + reference.size();
    const auto [stop, error] = std::from_chars(reference.data(), end, v.reference);
    if (error != std::errc() || stop != end)
      fail("variable \"" + v.name + "\": valueReference = \"" + reference +
           "\": must be a whole number, >= 0");
    pugi::xml_node type = node;  // where type, unit and start are said
    if (version == 2)
      for (const auto& below : node.children()) {
        const std::string_view name = below.name();
        if (name == "Real" || name == "Integer" || name == "Boolean" || name == "String" ||
            name == "Enumeration")
          type = below;
      }
    v.type = type == node && version == 2 ? "" : type.name();
    v.causality = node.attribute("causality") ? plain(node, "causality") : "local";
    v.variability = node.attribute("variability") ? plain(node, "variability") : "continuous";
    v.start = plain(type, "start");
    v.array = version == 3 && node.child("Dimension");
    v.unit = plain(type, "unit");
    if (v.unit.empty())
      if (const auto declared = types_.find(type.attribute("declaredType").value());
          declared != types_.end())
        v.unit = declared->second;
    const auto measure = measures_.find(v.unit);
    if (measure != measures_.end())
      v.measure = measure->second;
    else if (!v.unit.empty())
      v.measure = measure_named(v.unit);
    return v;
  }

  // A name says which variable is meant: of one that stands twice nobody could.
  void check_names(const std::vector<UnitVariable>& variables) const {
    std::map<std::string_view, std::uint32_t> references;
    for (const UnitVariable& v : variables)
      if (const auto [first, fresh] = references.emplace(v.name, v.reference); !fresh)
        fail("variable \"" + plain_text(v.name, kLongestName) +
             "\": duplicate name, of valueReference " + std::to_string(first->second) + " and " +
             std::to_string(v.reference) + ": names must be unique");
  }

  std::string place_;
  pugi::xml_document document_;
  pugi::xml_node root_;
  std::map<std::string, Measure, std::less<>> measures_;
  Types types_;
};

}  // namespace

bool UnitVariable::numeric() const {
  if (array) return false;
  return !type.empty() && type != "String" && type != "Binary" && type != "Clock";
}

const UnitVariable* UnitDescription::find(std::string_view name) const {
  const auto found = std::find_if(variables.begin(), variables.end(),
                                  [&](const UnitVariable& v) { return v.name == name; });
  return found == variables.end() ? nullptr : &*found;
}

UnitDescription read_description(const std::string& xml, const std::string& place) {
  return Reader(xml, place).read();
}

}  // namespace bentaxis::fmu
