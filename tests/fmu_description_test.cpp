// What a unit says of itself: its units of measure, and modelDescription.xml by the rules of both
// standards, for a list of variables made by hand. Descriptions of real cases: fmu_archive_test.py.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <pugixml.hpp>
#include <set>

#include "bentaxis/pump/registry.h"
#include "bentaxis/results/channels.h"
#include "description.h"
#include "units.h"

namespace bentaxis::fmu {
namespace {

using testing::ElementsAre;

TEST(Units, EveryUnitOfAParameterIsDefinedWithTheFactorOfItsConversion) {
  int converted = 0;
  for (const Table& table : standard_registry().tables)
    for (const Parameter& parameter : table.parameters) {
      const UnitOfMeasure* unit = unit_definition(parameter.unit.name);
      if (unit == nullptr || parameter.unit.to_si == nullptr) continue;
      for (const double value : {1.0, 7.25}) {
        const double si = unit->factor * value + unit->offset;
        EXPECT_NEAR(si / parameter.unit.to_si(value), 1, 1e-15) << parameter.key;
      }
      ++converted;
    }
  EXPECT_GT(converted, 50);
}

TEST(Units, EveryUnitOfAChannelIsDefinedWithItsFactor) {
  const ChannelLayout layout(7);
  for (const Channel& channel : layout.channels())
    EXPECT_DOUBLE_EQ(unit_definition(channel.unit)->factor, channel.unit_in_si) << channel.name;
}

TEST(Units, OneThatIsNotKnownIsAnErrorAndNoneIsNone) {
  EXPECT_THROW(unit_definition("furlong"), std::logic_error);
  EXPECT_EQ(unit_definition(""), nullptr);
  EXPECT_EQ(unit_definition("-"), nullptr);
}

// A unit and what it is a product of, by hand: 1 N m = 1 kg m2/s2.
TEST(Units, ExponentsAreThoseOfTheBaseUnits) {
  const auto exponents = [](const char* name) {
    const UnitOfMeasure* unit = unit_definition(name);
    const Dimension& d = unit->dimension;
    return std::vector{d.kg, d.m, d.s, d.kelvin, d.rad};
  };
  EXPECT_THAT(exponents("Nm"), ElementsAre(1, 2, -2, 0, 0));
  EXPECT_THAT(exponents("bar"), ElementsAre(1, -1, -2, 0, 0));
  EXPECT_THAT(exponents("l/min"), ElementsAre(0, 3, -1, 0, 0));
  EXPECT_THAT(exponents("l/min/bar"), ElementsAre(-1, 4, 1, 0, 0));
  EXPECT_THAT(exponents("mm2/bar"), ElementsAre(-1, 3, 2, 0, 0));
  EXPECT_THAT(exponents("rpm"), ElementsAre(0, 0, -1, 0, 1));
  EXPECT_THAT(exponents("Nm/rpm"), ElementsAre(1, 2, -1, 0, -1));
  EXPECT_THAT(exponents("C"), ElementsAre(0, 0, 0, 1, 0));
  EXPECT_THAT(exponents("cSt"), ElementsAre(0, 2, -1, 0, 0));
}

TEST(Units, WhatPeopleReadIsTheUnitOfThatName) {
  for (const char* name : {"rad/s", "Pa", "m3/s", "rad", "m"}) {
    const UnitOfMeasure* unit = unit_definition(name);
    ASSERT_FALSE(unit->display.empty()) << name;
    const std::string ours = unit->display == "L/min" ? "l/min"
                             : unit->display == "L"   ? "l"
                                                      : unit->display;
    EXPECT_NEAR(unit->display_factor * unit_definition(ours)->factor, 1, 1e-15) << name;
  }
}

Description small_unit() {
  Description it;
  it.model_name = "a <pump> & \"more\"";
  it.text = "one line\nand another";
  it.token = "{01234567-89ab-cdef-0123-456789abcdef}";
  it.stop_time = 0.04;
  it.tolerance = 1e-9;
  const auto add = [&](const std::string& name, const std::string& unit, Causality causality,
                       Role role) -> Variable& {
    Variable variable;
    variable.reference = static_cast<std::uint32_t>(it.variables.size());
    variable.name = name;
    variable.unit = unit;
    variable.causality = causality;
    variable.role = role;
    it.variables.push_back(std::move(variable));
    return it.variables.back();
  };
  add("time", "s", Causality::independent, Role::time);
  Variable& tilt = add("pump.tilt_deg", "deg", Causality::parameter, Role::parameter);
  tilt.variability = Variability::fixed;
  tilt.start = 40;
  tilt.least = 0;
  add("drive_speed", "rad/s", Causality::input, Role::input).start = 157;
  add("state.shaft_angle", "rad", Causality::local, Role::state).start = 0;
  add("state.p_1", "Pa", Causality::local, Role::state).nominal = 1e5;
  add("der(state.shaft_angle)", "rad/s", Causality::local, Role::derivative).state = 3;
  add("der(state.p_1)", "Pa/s", Causality::local, Role::derivative).state = 4;
  add("Td_z1_Nm", "Nm", Causality::output, Role::output);
  Variable& flag = add("cavitation", "", Causality::output, Role::flag);
  flag.variability = Variability::discrete;
  flag.boolean = true;
  flag.start = 0;
  add("indicator.edge", "", Causality::local, Role::indicator);
  return it;
}

pugi::xml_document parsed(const std::string& text) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(text.c_str()));
  return document;
}

std::vector<std::string> children(pugi::xml_node node) {
  std::vector<std::string> names;
  for (const pugi::xml_node child : node.children()) names.emplace_back(child.name());
  return names;
}

std::vector<int> numbers(pugi::xml_node node, const char* child, const char* attribute) {
  std::vector<int> all;
  for (const pugi::xml_node one : node.children(child))
    all.push_back(one.attribute(attribute).as_int(-1));
  return all;
}

TEST(Description, ElementsStandInTheOrderOfTheSchemas) {
  const auto fmi2 = parsed(description_fmi2(small_unit()));
  const auto fmi3 = parsed(description_fmi3(small_unit()));
  for (const auto* document : {&fmi2, &fmi3})
    EXPECT_THAT(
        children(document->child("fmiModelDescription")),
        ElementsAre("ModelExchange", "CoSimulation", "UnitDefinitions", "TypeDefinitions",
                    "LogCategories", "DefaultExperiment", "ModelVariables", "ModelStructure"));
}

TEST(Description, NamesOfPeopleAreEscapedAndOnOneLine) {
  const auto document = parsed(description_fmi3(small_unit()));
  const pugi::xml_node root = document.child("fmiModelDescription");
  EXPECT_STREQ(root.attribute("modelName").value(), "a <pump> & \"more\"");
  EXPECT_STREQ(root.attribute("description").value(), "one line and another");
}

TEST(Description, PlacesOfFmi2CountFromOne) {
  const auto document = parsed(description_fmi2(small_unit()));
  const pugi::xml_node root = document.child("fmiModelDescription");
  EXPECT_EQ(root.attribute("numberOfEventIndicators").as_int(), 1);
  const pugi::xml_node structure = root.child("ModelStructure");
  EXPECT_THAT(numbers(structure.child("Outputs"), "Unknown", "index"), ElementsAre(8, 9));
  EXPECT_THAT(numbers(structure.child("Derivatives"), "Unknown", "index"), ElementsAre(6, 7));
  // Not the angle, which begins as it is said; its rate, the pressure that is found, its rate.
  EXPECT_THAT(numbers(structure.child("InitialUnknowns"), "Unknown", "index"),
              ElementsAre(5, 6, 7, 8, 9));
  const pugi::xml_node rate =
      root.child("ModelVariables").find_child_by_attribute("name", "der(state.p_1)");
  EXPECT_EQ(rate.child("Real").attribute("derivative").as_int(), 5);
}

TEST(Description, ReferencesOfFmi3AreThose) {
  const auto document = parsed(description_fmi3(small_unit()));
  const pugi::xml_node root = document.child("fmiModelDescription");
  const pugi::xml_node structure = root.child("ModelStructure");
  EXPECT_THAT(numbers(structure, "Output", "valueReference"), ElementsAre(7, 8));
  EXPECT_THAT(numbers(structure, "ContinuousStateDerivative", "valueReference"), ElementsAre(5, 6));
  EXPECT_THAT(numbers(structure, "InitialUnknown", "valueReference"), ElementsAre(4, 5, 6, 7, 8));
  EXPECT_THAT(numbers(structure, "EventIndicator", "valueReference"), ElementsAre(9));
  const pugi::xml_node rate =
      root.child("ModelVariables").find_child_by_attribute("name", "der(state.p_1)");
  EXPECT_STREQ(rate.name(), "Float64");
  EXPECT_EQ(rate.attribute("derivative").as_int(), 4);
}

TEST(Description, StartValuesStandWhereTheyMustAndNowhereElse) {
  const auto document = parsed(description_fmi3(small_unit()));
  const pugi::xml_node all = document.child("fmiModelDescription").child("ModelVariables");
  std::set<std::string> starting;
  for (const pugi::xml_node variable : all.children()) {
    const std::string initial = variable.attribute("initial").value();
    const std::string causality = variable.attribute("causality").value();
    const bool starts = variable.attribute("start");
    if (starts) starting.insert(variable.attribute("name").value());
    EXPECT_EQ(starts, initial == "exact" || causality == "input");
    EXPECT_EQ(initial.empty(), causality == "input" || causality == "independent");
  }
  EXPECT_EQ(starting, (std::set<std::string>{"pump.tilt_deg", "drive_speed", "state.shaft_angle"}));
}

TEST(Description, ListsThatWouldBeEmptyAreLeftOut) {
  Description it = small_unit();
  it.variables.resize(3);
  const auto document = parsed(description_fmi2(it));
  EXPECT_THAT(children(document.child("fmiModelDescription").child("ModelStructure")),
              ElementsAre());
}

}  // namespace
}  // namespace bentaxis::fmu
