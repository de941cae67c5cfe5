#include "bentaxis/report/junit.h"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

namespace bentaxis::report {
namespace {

// Without the control characters that XML 1.0 excludes.
std::string text_of(const std::string& text) {
  std::string out;
  std::ranges::copy_if(text, std::back_inserter(out), [](char c) {
    return static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t';
  });
  return out;
}

void set(pugi::xml_node node, const char* name, const std::string& value) {
  node.append_attribute(name) = text_of(value).c_str();
}

void set_time(pugi::xml_node node, double seconds) {
  set(node, "time", fmt::format("{:.6f}", std::max(0.0, seconds)));
}

void set_counts(pugi::xml_node node, const std::vector<TestCase>& cases) {
  const auto count = [&](TestOutcome outcome) {
    return std::to_string(std::ranges::count_if(
        cases, [&](const TestCase& test) { return test.outcome == outcome; }));
  };
  set(node, "tests", std::to_string(cases.size()));
  set(node, "failures", count(TestOutcome::failed));
  set(node, "errors", count(TestOutcome::error));
  set(node, "skipped", count(TestOutcome::skipped));
}

}  // namespace

std::string junit_xml(const std::string& name, const std::vector<TestSuite>& suites) {
  pugi::xml_document document;
  auto declaration = document.append_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  auto root = document.append_child("testsuites");
  set(root, "name", name);
  std::vector<TestCase> all;
  double seconds = 0;
  for (const auto& suite : suites) {
    all.insert(all.end(), suite.cases.begin(), suite.cases.end());
    seconds += suite.seconds;
  }
  set_counts(root, all);
  set_time(root, seconds);
  for (const auto& suite : suites) {
    auto node = root.append_child("testsuite");
    set(node, "name", suite.name);
    set_counts(node, suite.cases);
    set_time(node, suite.seconds);
    if (!suite.properties.empty()) {
      auto properties = node.append_child("properties");
      for (const auto& [key, value] : suite.properties) {
        auto property = properties.append_child("property");
        set(property, "name", key);
        set(property, "value", value);
      }
    }
    for (const auto& test : suite.cases) {
      auto child = node.append_child("testcase");
      set(child, "name", test.name);
      set(child, "classname", test.class_name);
      set_time(child, test.seconds);
      if (test.outcome == TestOutcome::passed) {
        if (!test.details.empty())
          child.append_child("system-out").text() = text_of(test.details).c_str();
        continue;
      }
      auto why = child.append_child(test.outcome == TestOutcome::failed  ? "failure"
                                    : test.outcome == TestOutcome::error ? "error"
                                                                         : "skipped");
      set(why, "message", test.message);
      if (test.outcome != TestOutcome::skipped) {
        set(why, "type", test.outcome == TestOutcome::failed ? "out of tolerance" : "error");
        if (!test.details.empty()) why.text() = text_of(test.details).c_str();
      }
    }
  }
  std::ostringstream out;
  document.save(out, " ");
  return out.str();
}

}  // namespace bentaxis::report
