// The library of a unit as an importer loads it, and folders of resources.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "bentaxis/files/case_file.h"
#include "interface/fmi2.h"
#include "interface/fmi3.h"
#include "runtime/variables.h"

namespace bentaxis::fmu {

/// Every function by its name.
struct Functions {
// NOLINTNEXTLINE(bugprone-macro-parentheses)
#define BENTAXIS_MEMBER(result, name, arguments) name##TYPE* name = nullptr;
  BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_MEMBER)
  BENTAXIS_FMI3_FUNCTIONS(BENTAXIS_MEMBER)
#undef BENTAXIS_MEMBER

  Functions() {
    void* const library = dlopen(BENTAXIS_FMU_LIBRARY, RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) throw std::runtime_error(dlerror());
#define BENTAXIS_FIND(result, name, arguments) \
  name = reinterpret_cast<name##TYPE*>(dlsym(library, #name));
    BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_FIND)
    BENTAXIS_FMI3_FUNCTIONS(BENTAXIS_FIND)
#undef BENTAXIS_FIND
  }
};

inline const Functions& library() {
  static const Functions functions;
  return functions;
}

/// What an instance has said, and what it calls within a step.
struct Messages {
  std::string text;  // all, one line each: "status category: message"
  std::function<void(double time, bool may_set, bool& returns, double& when)> update;
  bool has(const std::string& words) const { return text.find(words) != std::string::npos; }
};

inline void log2(fmi2ComponentEnvironment environment, fmi2String /*name*/, fmi2Status status,
                 fmi2String category, fmi2String message, ...) {
  char line[4096];
  va_list arguments;
  va_start(arguments, message);
  std::vsnprintf(line, sizeof line, message, arguments);
  va_end(arguments);
  if (environment == nullptr) return;
  static_cast<Messages*>(environment)->text +=
      std::to_string(status) + " " + category + ": " + line + "\n";
}

inline void log3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                 fmi3String message) {
  if (environment == nullptr) return;
  static_cast<Messages*>(environment)->text +=
      std::to_string(status) + " " + category + ": " + message + "\n";
}

// The type is FMI's, and both are written by what is called.
// NOLINTBEGIN(readability-non-const-parameter)
inline void update3(fmi3InstanceEnvironment environment, fmi3Float64 time,
                    fmi3Boolean set_requested, fmi3Boolean get_allowed, fmi3Boolean finished,
                    fmi3Boolean /*can_return*/, fmi3Boolean* returns, fmi3Float64* when) {
  EXPECT_TRUE(get_allowed && finished);
  static_cast<Messages*>(environment)->update(time, set_requested, *returns, *when);
}
// NOLINTEND(readability-non-const-parameter)

constexpr const char* kToken = "{01234567-89ab-cdef-0123-456789abcdef}";

/// A folder of resources as an archive has it, gone with this.
class Resources {
 public:
  explicit Resources(const std::string& case_name, const std::string& drive = "speed",
                     const std::string& folder = "resources") {
    static int count = 0;
    top_ = std::filesystem::temp_directory_path() /
           ("bentaxis_fmu_" + std::to_string(getpid()) + "_" + std::to_string(++count));
    path_ = top_ / folder;
    std::filesystem::create_directories(path_);
    std::filesystem::copy_file(BENTAXIS_SOURCE_DIR "/cases/" + case_name, path_ / "case.toml");
    std::filesystem::copy(BENTAXIS_SOURCE_DIR "/cases/curves", path_ / "curves");
    write("unit.txt", "drive " + drive + "\ntolerance 1e-9\ntoken " + kToken + "\n");
    choice_.drive = drive == "speed"    ? Drive::speed
                    : drive == "torque" ? Drive::torque
                                        : Drive::as_in_case;
    variables_ = variables_of(read_case(path_ / "case.toml"), choice_);
  }
  ~Resources() { std::filesystem::remove_all(top_); }
  Resources(const Resources&) = delete;
  Resources& operator=(const Resources&) = delete;

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }
  void replace(const std::string& from, const std::string& to) const {
    std::ostringstream text;
    text << std::ifstream(path_ / "case.toml").rdbuf();
    std::string all = text.str();
    const auto at = all.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write("case.toml", all.replace(at, from.size(), to));
  }
  /// The variables of the case as it now is.
  void read_again() { variables_ = variables_of(read_case(path_ / "case.toml"), choice_); }
  Drive drive() const { return choice_.drive; }
  const std::filesystem::path& path() const { return path_; }
  std::string uri() const { return "file://" + path_.string(); }
  const std::vector<Variable>& variables() const { return variables_; }
  unsigned operator[](const std::string& name) const {
    for (const Variable& it : variables_)
      if (it.name == name) return it.reference;
    throw std::runtime_error("no variable " + name);
  }
  std::vector<unsigned> of(Causality causality) const {
    std::vector<unsigned> references;
    for (const Variable& it : variables_)
      if (it.causality == causality && !it.boolean) references.push_back(it.reference);
    return references;
  }

 private:
  std::filesystem::path top_, path_;
  UnitChoice choice_;
  std::vector<Variable> variables_;
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// An instance of FMI 2 with its messages; freed with this.
struct Unit2 {
  explicit Unit2(const Resources& from, fmi2Type type = fmi2CoSimulation, bool debug = false)
      : resources(from) {
    functions = {log2, nullptr, nullptr, nullptr, &messages};
    it = f.fmi2Instantiate("pump", type, kToken, from.uri().c_str(), &functions, fmi2False,
                           debug ? fmi2True : fmi2False);
    EXPECT_NE(it, nullptr) << messages.text;
  }
  ~Unit2() { f.fmi2FreeInstance(it); }
  Unit2(const Unit2&) = delete;
  Unit2& operator=(const Unit2&) = delete;

  void start(double stop = 1) const {
    ASSERT_EQ(f.fmi2SetupExperiment(it, fmi2False, 0, 0, fmi2True, stop), fmi2OK) << messages.text;
    ASSERT_EQ(f.fmi2EnterInitializationMode(it), fmi2OK) << messages.text;
    ASSERT_EQ(f.fmi2ExitInitializationMode(it), fmi2OK) << messages.text;
  }
  double get(const std::string& name) {
    const unsigned reference = resources[name];
    double value = kNan;
    EXPECT_EQ(f.fmi2GetReal(it, &reference, 1, &value), fmi2OK) << name << messages.text;
    return value;
  }
  fmi2Status set(const std::string& name, double value) {
    const unsigned reference = resources[name];
    return f.fmi2SetReal(it, &reference, 1, &value);
  }
  std::vector<double> outputs() {
    const auto references = resources.of(Causality::output);
    std::vector<double> values(references.size());
    EXPECT_EQ(f.fmi2GetReal(it, references.data(), references.size(), values.data()), fmi2OK)
        << messages.text;
    return values;
  }
  void steps(int count, double size) {
    for (int i = 0; i < count; ++i, ++done)
      ASSERT_EQ(f.fmi2DoStep(it, done * size, size, fmi2True), fmi2OK) << messages.text;
  }

  const Functions& f = library();
  const Resources& resources;
  Messages messages;
  fmi2CallbackFunctions functions{};
  fmi2Component it = nullptr;
  int done = 0;
};

// What an importer of FMI 3 says of its co-simulation.
struct Steps3 {
  bool event_mode = false, early_return = false;
  std::vector<unsigned> intermediate = {};
};

// The same of FMI 3.
struct Unit3 {
  Unit3(const Resources& from, const Steps3& steps) : resources(from) {
    it = f.fmi3InstantiateCoSimulation(
        "pump", kToken, from.path().c_str(), false, true, steps.event_mode, steps.early_return,
        steps.intermediate.data(), steps.intermediate.size(), &messages, log3,
        steps.intermediate.empty() ? nullptr : update3);
    EXPECT_NE(it, nullptr) << messages.text;
  }
  explicit Unit3(const Resources& from, bool exchange = false) : resources(from) {
    const std::string path = from.path().string() + "/";
    it = exchange ? f.fmi3InstantiateModelExchange("pump", kToken, path.c_str(), false, false,
                                                   &messages, log3)
                  : f.fmi3InstantiateCoSimulation("pump", kToken, path.c_str(), false, false, false,
                                                  false, nullptr, 0, &messages, log3, nullptr);
    EXPECT_NE(it, nullptr) << messages.text;
  }
  ~Unit3() { f.fmi3FreeInstance(it); }
  Unit3(const Unit3&) = delete;
  Unit3& operator=(const Unit3&) = delete;

  void start(double stop = 1) const {
    ASSERT_EQ(f.fmi3EnterInitializationMode(it, false, 0, 0, true, stop), fmi3OK) << messages.text;
    ASSERT_EQ(f.fmi3ExitInitializationMode(it), fmi3OK) << messages.text;
  }
  std::vector<double> outputs() {
    const auto references = resources.of(Causality::output);
    std::vector<double> values(references.size());
    EXPECT_EQ(
        f.fmi3GetFloat64(it, references.data(), references.size(), values.data(), values.size()),
        fmi3OK)
        << messages.text;
    return values;
  }
  fmi3Status step(double time, double size) {
    return f.fmi3DoStep(it, time, size, true, &event, &terminate, &early, &last);
  }

  const Functions& f = library();
  const Resources& resources;
  Messages messages;
  fmi3Instance it = nullptr;
  bool event = false, terminate = false, early = false;
  double last = kNan;
};

inline void expect_near(const std::vector<double>& a, const std::vector<double>& b,
                        double relative) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::isnan(a[i]) || std::isnan(b[i]))
      EXPECT_EQ(std::isnan(a[i]), std::isnan(b[i])) << i;
    else
      EXPECT_NEAR(a[i], b[i], relative * std::max(100.0, std::abs(b[i]))) << i;
}

}  // namespace bentaxis::fmu
