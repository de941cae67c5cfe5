// Test results as JUnit XML, which continuous integration systems read.
#pragma once

#include <string>
#include <vector>

namespace bentaxis::report {

enum class TestOutcome { passed, failed, error, skipped };

struct TestCase {
  std::string name, class_name;
  double seconds = 0;
  TestOutcome outcome = TestOutcome::passed;
  std::string message = {};  ///< one line: why it did not pass
  std::string details = {};  ///< any number of lines; of a passed test its figures
};

struct TestSuite {
  std::string name;
  double seconds = 0;
  std::vector<std::pair<std::string, std::string>> properties;
  std::vector<TestCase> cases;
};

/// The document: testsuites, testsuite, testcase with failure, error, skipped and system-out, as
/// tests/junit.xsd describes them. Characters that XML cannot hold are left out.
std::string junit_xml(const std::string& name, const std::vector<TestSuite>& suites);

}  // namespace bentaxis::report
