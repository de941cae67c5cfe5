// The calls of FMI 2 and 3 on the library of a unit, as an importer makes them.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "fmu_support.h"

namespace bentaxis::fmu {
namespace {

using testing::HasSubstr;

constexpr const char* kRated = "bap63_rated.toml";
constexpr const char* kHydraulic = "bap63_rated_hydraulic.toml";
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

  void start(double stop = 1) {
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

// The same of FMI 3.
struct Unit3 {
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

  void start(double stop = 1) {
    ASSERT_EQ(f.fmi3EnterInitializationMode(it, false, 0, 0, true, stop), fmi3OK) << messages.text;
    ASSERT_EQ(f.fmi3ExitInitializationMode(it), fmi3OK) << messages.text;
  }
  std::vector<double> outputs() {
    const auto references = resources.of(Causality::output);
    std::vector<double> values(references.size());
    EXPECT_EQ(f.fmi3GetFloat64(it, references.data(), references.size(), values.data(),
                               values.size()),
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

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double relative) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::isnan(a[i]) || std::isnan(b[i]))
      EXPECT_EQ(std::isnan(a[i]), std::isnan(b[i])) << i;
    else
      EXPECT_NEAR(a[i], b[i], relative * std::max(100.0, std::abs(b[i]))) << i;
}

TEST(UnitLibrary, HasEveryFunctionOfBothVersions) {
#define BENTAXIS_EXPECT(name) EXPECT_NE(library().name, nullptr) << #name;
  BENTAXIS_FMI2_FUNCTIONS(BENTAXIS_EXPECT)
  BENTAXIS_FMI3_FUNCTIONS(BENTAXIS_EXPECT)
#undef BENTAXIS_EXPECT
  EXPECT_STREQ(library().fmi2GetVersion(), "2.0");
  EXPECT_STREQ(library().fmi2GetTypesPlatform(), "default");
  EXPECT_STREQ(library().fmi3GetVersion(), "3.0");
}

TEST(UnitLibrary, RefusesToBeMadeOfWhatIsNotItsOwn) {
  const Resources resources(kRated);
  Messages messages;
  fmi2CallbackFunctions functions{log2, nullptr, nullptr, nullptr, &messages};
  const auto refused = [&](fmi2String name, fmi2String guid, fmi2String where,
                           const std::string& words) {
    messages.text.clear();
    EXPECT_EQ(library().fmi2Instantiate(name, fmi2CoSimulation, guid, where, &functions, 0, 0),
              nullptr);
    EXPECT_THAT(messages.text, HasSubstr(words));
    EXPECT_THAT(messages.text, HasSubstr("3 logStatusError: fmi2Instantiate: "));
    messages.text.clear();
    EXPECT_EQ(library().fmi3InstantiateModelExchange(
                  name, guid, where == nullptr ? nullptr : resources.path().c_str() + 0, false,
                  false, &messages, log3) == nullptr,
              name == nullptr || *name == 0 || guid == nullptr || where == nullptr ||
                  std::string(guid) != kToken);
  };
  const std::string uri = resources.uri();
  refused(nullptr, kToken, uri.c_str(), "needs a name");
  refused("", kToken, uri.c_str(), "needs a name");
  refused("pump", nullptr, uri.c_str(), "GUID is missing");
  refused("pump", "{other}", uri.c_str(), "{other}");
  refused("pump", kToken, nullptr, "resources is missing");
}

TEST(UnitLibrary, SaysWhatIsWrongWithItsResources) {
  const Resources resources(kRated);
  Messages messages;
  fmi2CallbackFunctions functions{log2, nullptr, nullptr, nullptr, &messages};
  const auto said = [&](const std::string& uri) {
    messages.text.clear();
    EXPECT_EQ(library().fmi2Instantiate("pump", fmi2ModelExchange, kToken, uri.c_str(), &functions,
                                        0, 0),
              nullptr);
    return messages.text;
  };
  EXPECT_THAT(said("http://example.org/x"), HasSubstr("must be a file URI"));
  EXPECT_THAT(said("file://elsewhere/x"), HasSubstr("this computer"));
  EXPECT_THAT(said("file:///x%2"), HasSubstr("hexadecimal"));
  EXPECT_THAT(said("file:///nowhere"), HasSubstr("/nowhere/unit.txt: cannot be read"));
  resources.replace("tilt_deg = 40", "tilt_deg = 95");
  EXPECT_THAT(said(resources.uri()), HasSubstr("[pump] tilt_deg = 95"));
  EXPECT_THAT(said(resources.uri()), HasSubstr("must be in [0, 90)"));
  resources.write("unit.txt", "drive by_hand\n");
  EXPECT_THAT(said(resources.uri()), HasSubstr("must be speed, torque or case"));
  EXPECT_EQ(library().fmi2Instantiate("p", fmi2CoSimulation, kToken, "x", nullptr, 0, 0), nullptr);
}

TEST(UnitLibrary, FindsResourcesByEncodedUrisAndByPaths) {
  const Resources resources(kRated, "speed", "with space 100%");
  fmi2CallbackFunctions functions{log2, nullptr, nullptr, nullptr, nullptr};
  const std::string parent = resources.path().parent_path().string();
  for (const std::string& uri : {"file://" + parent + "/with%20space%20100%25",
                                 "file:" + parent + "/with%20space%20100%25/",
                                 "FILE://localhost" + parent + "/with%20space%20100%25"}) {
    const auto it =
        library().fmi2Instantiate("p", fmi2CoSimulation, kToken, uri.c_str(), &functions, 0, 0);
    EXPECT_NE(it, nullptr) << uri;
    library().fmi2FreeInstance(it);
  }
  for (const char* end : {"", "/"}) {
    const auto it = library().fmi3InstantiateModelExchange(
        "p", kToken, (resources.path().string() + end).c_str(), false, false, nullptr, nullptr);
    EXPECT_NE(it, nullptr);
    library().fmi3FreeInstance(it);
  }
}

TEST(UnitLibrary, RefusesWhatItDoesNotHaveOfFmi3) {
  const Resources resources(kRated);
  Messages messages;
  EXPECT_EQ(library().fmi3InstantiateCoSimulation("p", kToken, resources.path().c_str(), false,
                                                  false, true, false, nullptr, 0, &messages, log3,
                                                  nullptr),
            nullptr);
  EXPECT_TRUE(messages.has("hasEventMode"));
  EXPECT_EQ(library().fmi3InstantiateScheduledExecution("p", kToken, resources.path().c_str(),
                                                        false, false, &messages, log3, nullptr,
                                                        nullptr, nullptr),
            nullptr);
  EXPECT_TRUE(messages.has("scheduled execution"));
  Unit3 unit(resources);
  const Functions& f = library();
  EXPECT_EQ(f.fmi3EnterConfigurationMode(unit.it), fmi3Error);
  EXPECT_EQ(f.fmi3ExitConfigurationMode(unit.it), fmi3Error);
  EXPECT_EQ(f.fmi3EnterStepMode(unit.it), fmi3Error);
  EXPECT_EQ(f.fmi3ActivateModelPartition(unit.it, 0, 0), fmi3Error);
  std::size_t count = 0;
  EXPECT_EQ(f.fmi3GetNumberOfVariableDependencies(unit.it, 0, &count), fmi3Error);
  EXPECT_EQ(f.fmi3GetVariableDependencies(unit.it, 0, nullptr, nullptr, nullptr, nullptr, 0),
            fmi3Error);
  EXPECT_EQ(f.fmi3GetAdjointDerivative(unit.it, nullptr, 0, nullptr, 0, nullptr, 0, nullptr, 0),
            fmi3Error);
  const unsigned reference = 0;
  EXPECT_EQ(f.fmi3GetIntervalDecimal(unit.it, &reference, 1, nullptr, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3GetIntervalFraction(unit.it, &reference, 1, nullptr, nullptr, nullptr),
            fmi3Error);
  EXPECT_EQ(f.fmi3GetShiftDecimal(unit.it, &reference, 1, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3GetShiftFraction(unit.it, &reference, 1, nullptr, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3SetIntervalDecimal(unit.it, &reference, 1, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3SetIntervalFraction(unit.it, &reference, 1, nullptr, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3SetShiftDecimal(unit.it, &reference, 1, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3SetShiftFraction(unit.it, &reference, 1, nullptr, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3SetShiftFraction(unit.it, nullptr, 0, nullptr, nullptr), fmi3OK);
}

// Every mode that a call may come in, of FMI 2; 'n' before, 'i' initialization, 'e' event mode,
// 'c' continuous time, 's' between steps, 't' terminated.
struct Order2 {
  const char* name;
  fmi2Type type;
  std::string modes;
  std::function<fmi2Status(Unit2&)> call;
};

void bring(Unit2& unit, char mode) {
  const Functions& f = library();
  if (mode == 'n') return;
  ASSERT_EQ(f.fmi2SetupExperiment(unit.it, fmi2True, 1e-9, 0, fmi2False, 0), fmi2OK);
  ASSERT_EQ(f.fmi2EnterInitializationMode(unit.it), fmi2OK);
  if (mode == 'i') return;
  ASSERT_EQ(f.fmi2ExitInitializationMode(unit.it), fmi2OK);
  if (mode == 'c') {
    ASSERT_EQ(f.fmi2EnterContinuousTimeMode(unit.it), fmi2OK);
  }
  if (mode == 't') {
    ASSERT_EQ(f.fmi2Terminate(unit.it), fmi2OK);
  }
}

std::vector<Order2> orders2(const Resources& r) {
  const Functions& f = library();
  const auto exchange = fmi2ModelExchange;
  const auto simulation = fmi2CoSimulation;
  const std::size_t states = 1, indicators = 2;
  static double x[8];
  static fmi2EventInfo info;
  static fmi2Boolean flag, other;
  static fmi2Real real;
  static fmi2Status status;
  static fmi2String text;
  const unsigned speed = r["drive_speed"], torque = r["Td_z1_Nm"], tilt = r["pump.tilt_deg"],
                 friction = r["friction.piston_viscous_N_s_per_m"], valid = r["valid_film"];
  const auto set = [&f](unsigned reference, double value) {
    return [&f, reference, value](Unit2& u) { return f.fmi2SetReal(u.it, &reference, 1, &value); };
  };
  std::vector<Order2> all = {
      {"SetupExperiment", exchange, "n",
       [&f](Unit2& u) { return f.fmi2SetupExperiment(u.it, 0, 0, 0, 0, 0); }},
      {"EnterInitializationMode", exchange, "n",
       [&f](Unit2& u) { return f.fmi2EnterInitializationMode(u.it); }},
      {"ExitInitializationMode", exchange, "i",
       [&f](Unit2& u) { return f.fmi2ExitInitializationMode(u.it); }},
      {"Terminate", exchange, "ec", [&f](Unit2& u) { return f.fmi2Terminate(u.it); }},
      {"Terminate", simulation, "s", [&f](Unit2& u) { return f.fmi2Terminate(u.it); }},
      {"Reset", exchange, "niect", [&f](Unit2& u) { return f.fmi2Reset(u.it); }},
      {"input", exchange, "niec", set(speed, 100)},
      {"input", simulation, "nis", set(speed, 100)},
      {"fixed parameter", exchange, "ni", set(tilt, 39)},
      {"fixed parameter", simulation, "ni", set(tilt, 39)},
      {"tunable parameter", exchange, "nie", set(friction, 1)},
      {"tunable parameter", simulation, "nis", set(friction, 1)},
      {"output that is set", exchange, "", set(torque, 1)},
      {"GetReal", exchange, "iect",
       [&f, torque](Unit2& u) { return f.fmi2GetReal(u.it, &torque, 1, x); }},
      {"GetBoolean", simulation, "ist",
       [&f, valid](Unit2& u) { return f.fmi2GetBoolean(u.it, &valid, 1, &flag); }},
      {"GetInteger", simulation, "nist",
       [&f](Unit2& u) { return f.fmi2GetInteger(u.it, nullptr, 0, nullptr); }},
      {"SetString", exchange, "nie",
       [&f](Unit2& u) { return f.fmi2SetString(u.it, nullptr, 0, nullptr); }},
      {"EnterEventMode", exchange, "ec", [&f](Unit2& u) { return f.fmi2EnterEventMode(u.it); }},
      {"EnterEventMode", simulation, "", [&f](Unit2& u) { return f.fmi2EnterEventMode(u.it); }},
      {"NewDiscreteStates", exchange, "e",
       [&f](Unit2& u) { return f.fmi2NewDiscreteStates(u.it, &info); }},
      {"EnterContinuousTimeMode", exchange, "e",
       [&f](Unit2& u) { return f.fmi2EnterContinuousTimeMode(u.it); }},
      {"CompletedIntegratorStep", exchange, "c",
       [&f](Unit2& u) { return f.fmi2CompletedIntegratorStep(u.it, 1, &flag, &other); }},
      {"SetTime", exchange, "ec", [&f](Unit2& u) { return f.fmi2SetTime(u.it, 0.1); }},
      {"SetContinuousStates", exchange, "c",
       [&f, states](Unit2& u) { return f.fmi2SetContinuousStates(u.it, x, states); }},
      {"GetDerivatives", exchange, "iect",
       [&f, states](Unit2& u) { return f.fmi2GetDerivatives(u.it, x, states); }},
      {"GetContinuousStates", exchange, "iect",
       [&f, states](Unit2& u) { return f.fmi2GetContinuousStates(u.it, x, states); }},
      {"GetEventIndicators", exchange, "iect",
       [&f, indicators](Unit2& u) { return f.fmi2GetEventIndicators(u.it, x, indicators); }},
      {"GetNominals", exchange, "niect",
       [&f, states](Unit2& u) { return f.fmi2GetNominalsOfContinuousStates(u.it, x, states); }},
      {"DoStep", simulation, "s", [&f](Unit2& u) { return f.fmi2DoStep(u.it, 0, 1e-3, 1); }},
      {"DoStep", exchange, "", [&f](Unit2& u) { return f.fmi2DoStep(u.it, 0, 1e-3, 1); }},
      {"CancelStep", simulation, "", [&f](Unit2& u) { return f.fmi2CancelStep(u.it); }},
      {"GetStatus", simulation, "st",
       [&f](Unit2& u) { return f.fmi2GetStatus(u.it, fmi2DoStepStatus, &status); }},
      {"GetRealStatus", simulation, "st",
       [&f](Unit2& u) { return f.fmi2GetRealStatus(u.it, fmi2LastSuccessfulTime, &real); }},
      {"GetBooleanStatus", simulation, "st",
       [&f](Unit2& u) { return f.fmi2GetBooleanStatus(u.it, fmi2Terminated, &flag); }},
      {"GetStringStatus", simulation, "st",
       [&f](Unit2& u) { return f.fmi2GetStringStatus(u.it, fmi2PendingStatus, &text); }},
      {"GetIntegerStatus", simulation, "",
       [&f](Unit2& u) { return f.fmi2GetIntegerStatus(u.it, fmi2Terminated, &flag); }},
      {"SetRealInputDerivatives", simulation, "", [&f, speed](Unit2& u) {
         const int order = 1;
         return f.fmi2SetRealInputDerivatives(u.it, &speed, 1, &order, x);
       }}};
  all.push_back({"GetRealOutputDerivatives", simulation, "", [&f, torque](Unit2& u) {
                   const int order = 1;
                   return f.fmi2GetRealOutputDerivatives(u.it, &torque, 1, &order, x);
                 }});
  return all;
}

TEST(Fmi2, EveryCallInEveryModeIsFollowedOrRefused) {
  const Resources resources(kRated);
  for (const Order2& order : orders2(resources))
    for (const char mode : std::string(order.type == fmi2ModelExchange ? "niect" : "nist")) {
      SCOPED_TRACE(std::string(order.name) + " in " + mode);
      Unit2 unit(resources, order.type);
      bring(unit, mode);
      unit.messages.text.clear();
      const bool may = order.modes.find(mode) != std::string::npos;
      EXPECT_EQ(order.call(unit), may ? fmi2OK : fmi2Error) << unit.messages.text;
      EXPECT_EQ(unit.messages.text.empty(), may) << unit.messages.text;
    }
}

TEST(Fmi2, NullPointersAreErrors) {
  const Resources resources(kRated);
  const Functions& f = library();
  for (const Order2& order : orders2(resources)) {
    struct None : Unit2 {
      using Unit2::Unit2;
    } unit(resources, order.type);
    const fmi2Component kept = unit.it;
    unit.it = nullptr;
    EXPECT_EQ(order.call(unit), fmi2Error) << order.name;
    unit.it = kept;
  }
  f.fmi2FreeInstance(nullptr);
  Unit2 unit(resources);
  unit.start();
  const unsigned reference = 0;
  double value = 0;
  EXPECT_EQ(f.fmi2GetReal(unit.it, nullptr, 1, &value), fmi2Error);
  EXPECT_EQ(f.fmi2GetReal(unit.it, &reference, 1, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2SetReal(unit.it, &reference, 1, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2GetBoolean(unit.it, nullptr, 1, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2GetFMUstate(unit.it, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2SetFMUstate(unit.it, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2SerializedFMUstateSize(unit.it, nullptr, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2SerializeFMUstate(unit.it, nullptr, nullptr, 0), fmi2Error);
  EXPECT_EQ(f.fmi2DeSerializeFMUstate(unit.it, nullptr, 0, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2GetRealStatus(unit.it, fmi2LastSuccessfulTime, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2GetDirectionalDerivative(unit.it, nullptr, 1, &reference, 1, &value, &value),
            fmi2Error);
  EXPECT_EQ(f.fmi2SetDebugLogging(unit.it, 1, 1, nullptr), fmi2Error);
  EXPECT_EQ(f.fmi2DoStep(unit.it, 0, 1e-3, 1), fmi2OK) << "none of it has harmed";
}

TEST(Fmi2, NumbersThatAreNoneAreRefusedAndChangeNothing) {
  const Resources resources(kRated);
  Unit2 unit(resources);
  unit.start(0.1);
  const double before = unit.get("drive_speed");
  for (const double value : {kNan, kInfinity, -kInfinity})
    EXPECT_EQ(unit.set("drive_speed", value), fmi2Error);
  // All or nothing.
  const unsigned references[] = {resources["drive_speed"], resources["Td_z1_Nm"]};
  const double values[] = {1, 2};
  EXPECT_EQ(unit.f.fmi2SetReal(unit.it, references, 2, values), fmi2Error);
  EXPECT_EQ(unit.get("drive_speed"), before);
  const unsigned far = 100000;
  double value = 0;
  EXPECT_EQ(unit.f.fmi2GetReal(unit.it, &far, 1, &value), fmi2Error);
  EXPECT_TRUE(unit.messages.has("no variable with the reference 100000"));
  const unsigned flag = resources["valid_film"];
  EXPECT_EQ(unit.f.fmi2GetReal(unit.it, &flag, 1, &value), fmi2Error);
  EXPECT_TRUE(unit.messages.has("valid_film is a Boolean"));
  for (const double size : {0.0, -1e-3, kNan, kInfinity, 0.2})
    EXPECT_EQ(unit.f.fmi2DoStep(unit.it, 0, size, 1), fmi2Error) << size;
  EXPECT_EQ(unit.f.fmi2DoStep(unit.it, 0.05, 1e-3, 1), fmi2Error);
  EXPECT_TRUE(unit.messages.has("begins at 0.05 s, the pump stands at 0 s"));
  EXPECT_EQ(unit.f.fmi2DoStep(unit.it, 0, 0.1, 1), fmi2OK) << unit.messages.text;
}

TEST(Fmi2, ParametersAreThoseOfTheCaseWithTheSameWords) {
  const Resources resources(kRated);
  Unit2 unit(resources);
  EXPECT_EQ(unit.get("pump.tilt_deg"), 40);
  EXPECT_EQ(unit.set("pump.tilt_deg", 95), fmi2Error);
  EXPECT_TRUE(unit.messages.has("pump.tilt_deg = 95: must be in [0, 90)")) << unit.messages.text;
  EXPECT_EQ(unit.set("pump.tilt_deg", 35), fmi2OK);
  EXPECT_EQ(unit.get("pump.tilt_deg"), 35);
  unit.start();
  EXPECT_EQ(unit.set("pump.tilt_deg", 36), fmi2Error);
  EXPECT_TRUE(unit.messages.has("fixed"));
  unit.steps(7, 1e-3);

  const Resources changed(kRated);
  changed.replace("tilt_deg = 40", "tilt_deg = 35");
  Unit2 other(changed);
  other.start();
  other.steps(7, 1e-3);
  EXPECT_EQ(unit.outputs(), other.outputs());

  // One that only others refuse is refused when it takes effect.
  EXPECT_EQ(unit.f.fmi2Reset(unit.it), fmi2OK);
  EXPECT_EQ(unit.get("pump.tilt_deg"), 40);
  EXPECT_EQ(unit.set("pump.piston_length_mm", 1), fmi2OK);
  EXPECT_EQ(unit.f.fmi2EnterInitializationMode(unit.it), fmi2OK);
  EXPECT_EQ(unit.f.fmi2ExitInitializationMode(unit.it), fmi2Error);
  EXPECT_TRUE(unit.messages.has("cannot be assembled")) << unit.messages.text;
  EXPECT_EQ(unit.f.fmi2DoStep(unit.it, 0, 1e-3, 1), fmi2Error);
  EXPECT_EQ(unit.f.fmi2Reset(unit.it), fmi2OK);
  unit.done = 0;
  unit.start();
  unit.steps(1, 1e-3);
}

TEST(Fmi2, TunableParametersChangeWhileItRuns) {
  const Resources resources(kRated);
  Unit2 unit(resources);
  unit.start();
  unit.steps(3, 1e-3);
  const double before = unit.get("Td_z1_Nm"), angle = unit.get("theta_deg");
  EXPECT_EQ(unit.set("friction.piston_viscous_N_s_per_m", 200), fmi2OK);
  EXPECT_GT(unit.get("Td_z1_Nm"), before + 1);
  EXPECT_NEAR(unit.get("theta_deg"), angle, 1e-12 * angle);
  EXPECT_EQ(unit.set("friction.piston_viscous_N_s_per_m", -1), fmi2Error);
  EXPECT_EQ(unit.set("friction.piston_viscous_N_s_per_m", 0), fmi2OK);
  EXPECT_NEAR(unit.get("Td_z1_Nm"), before, 1e-9 * std::abs(before));
  unit.steps(3, 1e-3);
}

TEST(Fmi2, DebugMessagesAreOfTheirCategories) {
  const Resources resources(kRated);
  Unit2 unit(resources, fmi2ModelExchange);
  const auto events = [&] {
    unit.messages.text.clear();
    EXPECT_EQ(unit.f.fmi2EnterEventMode(unit.it), fmi2OK);
    return unit.messages.has("logEvents");
  };
  unit.start();
  EXPECT_FALSE(events());
  const fmi2String wanted[] = {"logEvents"}, other[] = {"logStatusWarning"}, none[] = {"logX"};
  EXPECT_EQ(unit.f.fmi2SetDebugLogging(unit.it, fmi2True, 1, wanted), fmi2OK);
  EXPECT_TRUE(events());
  EXPECT_EQ(unit.f.fmi2SetDebugLogging(unit.it, fmi2True, 1, other), fmi2OK);
  EXPECT_FALSE(events());
  EXPECT_EQ(unit.f.fmi2SetDebugLogging(unit.it, fmi2True, 0, nullptr), fmi2OK);
  EXPECT_TRUE(events());
  EXPECT_EQ(unit.f.fmi2SetDebugLogging(unit.it, fmi2True, 1, none), fmi2Error);
  EXPECT_TRUE(events());
}

std::vector<double> course(Unit2& unit, int steps, double size) {
  std::vector<double> all;
  for (int i = 0; i < steps; ++i) {
    unit.steps(1, size);
    for (const double value : unit.outputs()) all.push_back(value);
  }
  return all;
}

TEST(Fmi2, TwoInstancesInterleavedOrInThreadsAreTwoAlone) {
  const Resources oil(kHydraulic), ideal(kRated);
  constexpr int kSteps = 20;
  constexpr double kSize = 2e-4;
  const auto alone = [&](const Resources& resources, double speed) {
    Unit2 unit(resources);
    EXPECT_EQ(unit.set("drive_speed", speed), fmi2OK);
    unit.start();
    return course(unit, kSteps, kSize);
  };
  const auto one = alone(oil, 157), two = alone(ideal, 100);
  {
    Unit2 a(oil), b(ideal);
    a.set("drive_speed", 157);
    b.set("drive_speed", 100);
    b.start();
    a.start();
    std::vector<double> of_a, of_b;
    for (int i = 0; i < kSteps; ++i) {
      for (const double value : course(a, 1, kSize)) of_a.push_back(value);
      for (const double value : course(b, 1, kSize)) of_b.push_back(value);
    }
    expect_near(of_a, one, 0);
    expect_near(of_b, two, 0);
  }
  std::vector<double> in_one, in_two;
  std::thread first([&] { in_one = alone(oil, 157); });
  std::thread second([&] { in_two = alone(ideal, 100); });
  first.join();
  second.join();
  expect_near(in_one, one, 0);
  expect_near(in_two, two, 0);
}

TEST(Fmi2, AStateCanBeTakenUpAgain) {
  const Resources resources(kHydraulic);
  Unit2 unit(resources);
  const Functions& f = library();
  unit.start();
  unit.steps(10, 1e-4);
  fmi2FMUstate state = nullptr;
  ASSERT_EQ(f.fmi2GetFMUstate(unit.it, &state), fmi2OK);
  const auto here = unit.outputs();
  const auto there = course(unit, 10, 1e-4);
  EXPECT_EQ(unit.set("hydraulics.leakage_l_per_min_per_bar", 1), fmi2Error) << "fixed";
  unit.set("drive_speed", 50);
  unit.steps(2, 1e-4);
  ASSERT_EQ(f.fmi2SetFMUstate(unit.it, state), fmi2OK) << unit.messages.text;
  unit.done = 10;
  expect_near(unit.outputs(), here, 1e-12);
  expect_near(course(unit, 10, 1e-4), there, 1e-6);

  // As bytes, in another instance.
  std::size_t size = 0;
  ASSERT_EQ(f.fmi2SerializedFMUstateSize(unit.it, state, &size), fmi2OK);
  std::vector<char> bytes(size);
  EXPECT_EQ(f.fmi2SerializeFMUstate(unit.it, state, bytes.data(), size - 1), fmi2Error);
  ASSERT_EQ(f.fmi2SerializeFMUstate(unit.it, state, bytes.data(), size), fmi2OK);
  Unit2 other(resources);
  fmi2FMUstate read = nullptr;
  EXPECT_EQ(f.fmi2SetFMUstate(other.it, state), fmi2Error) << "of another instance";
  ASSERT_EQ(f.fmi2DeSerializeFMUstate(other.it, bytes.data(), size, &read), fmi2OK)
      << other.messages.text;
  ASSERT_EQ(f.fmi2SetFMUstate(other.it, read), fmi2OK) << other.messages.text;
  other.done = 10;
  expect_near(other.outputs(), here, 1e-12);
  expect_near(course(other, 10, 1e-4), there, 1e-6);

  // Bytes that are none are refused, wherever they are wrong.
  fmi2FMUstate none = nullptr;
  for (std::size_t i = 0; i < size; i += 7) {
    std::vector<char> wrong = bytes;
    wrong[i] = static_cast<char>(wrong[i] ^ 0x10);
    EXPECT_EQ(f.fmi2DeSerializeFMUstate(other.it, wrong.data(), size, &none), fmi2Error) << i;
    EXPECT_EQ(f.fmi2DeSerializeFMUstate(other.it, bytes.data(), i, &none), fmi2Error) << i;
  }
  Unit2 exchange(resources, fmi2ModelExchange);
  EXPECT_EQ(f.fmi2DeSerializeFMUstate(exchange.it, bytes.data(), size, &none), fmi2Error);
  EXPECT_EQ(none, nullptr);
  EXPECT_EQ(f.fmi2FreeFMUstate(unit.it, &state), fmi2OK);
  EXPECT_EQ(state, nullptr);
  EXPECT_EQ(f.fmi2FreeFMUstate(unit.it, &state), fmi2OK);
}

TEST(Fmi2, AStateOfTheStartIsAStartAgain) {
  const Resources resources(kRated);
  Unit2 unit(resources);
  const Functions& f = library();
  fmi2FMUstate state = nullptr;
  unit.set("drive_speed", 120);
  ASSERT_EQ(f.fmi2GetFMUstate(unit.it, &state), fmi2OK);
  unit.start();
  const auto first = course(unit, 5, 1e-3);
  ASSERT_EQ(f.fmi2SetFMUstate(unit.it, state), fmi2OK);
  unit.done = 0;
  unit.start();
  EXPECT_EQ(unit.get("drive_speed"), 120);
  expect_near(course(unit, 5, 1e-3), first, 0);
}

TEST(Fmi2, ResultsDoNotDependOnTheSizeOfSteps) {
  const Resources resources(kHydraulic);
  Unit2 unit(resources), finer(resources);
  unit.start();
  finer.start();
  unit.steps(7, 1e-3);
  finer.steps(700, 1e-5);
  expect_near(finer.outputs(), unit.outputs(), 1e-8);
}

// Model exchange by a method of order four; both versions share everything below their calls.
TEST(Fmi2, ModelExchangeFollowsCoSimulation) {
  const Resources resources(kRated, "torque");
  const Functions& f = library();
  Unit2 unit(resources, fmi2ModelExchange), other(resources);
  const double torque = 290;
  for (Unit2* it : {&unit, &other}) {
    it->set("drive_torque", torque);
    it->start();
  }
  fmi2EventInfo info;
  ASSERT_EQ(f.fmi2NewDiscreteStates(unit.it, &info), fmi2OK);
  EXPECT_FALSE(info.newDiscreteStatesNeeded);
  ASSERT_EQ(f.fmi2EnterContinuousTimeMode(unit.it), fmi2OK);
  const auto n = static_cast<std::size_t>(
      std::count_if(resources.variables().begin(), resources.variables().end(),
                    [](const Variable& it) { return it.role == Role::state; }));
  std::vector<double> x(n), at(n), sum(n), rate(n);
  ASSERT_EQ(f.fmi2GetContinuousStates(unit.it, x.data(), n), fmi2OK);
  EXPECT_EQ(f.fmi2GetContinuousStates(unit.it, x.data(), n + 1), fmi2Error);
  constexpr double kStep = 2e-5, kEnd = 4e-3;
  for (int i = 0; i < 200; ++i) {
    sum = x;
    at = x;
    const double part[] = {0, 0.5, 0.5, 1}, weight[] = {1, 2, 2, 1};
    for (int k = 0; k < 4; ++k) {
      for (std::size_t j = 0; j < n; ++j) at[j] = x[j] + part[k] * kStep * rate[j];
      ASSERT_EQ(f.fmi2SetTime(unit.it, (i + part[k]) * kStep), fmi2OK);
      ASSERT_EQ(f.fmi2SetContinuousStates(unit.it, at.data(), n), fmi2OK);
      ASSERT_EQ(f.fmi2GetDerivatives(unit.it, rate.data(), n), fmi2OK) << unit.messages.text;
      for (std::size_t j = 0; j < n; ++j) sum[j] += kStep / 6 * weight[k] * rate[j];
    }
    x = sum;
    ASSERT_EQ(f.fmi2SetTime(unit.it, (i + 1) * kStep), fmi2OK);
    ASSERT_EQ(f.fmi2SetContinuousStates(unit.it, x.data(), n), fmi2OK);
    fmi2Boolean event = 0, end = 0;
    ASSERT_EQ(f.fmi2CompletedIntegratorStep(unit.it, 1, &event, &end), fmi2OK);
    if (event == 0) continue;
    ASSERT_EQ(f.fmi2EnterEventMode(unit.it), fmi2OK);
    ASSERT_EQ(f.fmi2NewDiscreteStates(unit.it, &info), fmi2OK);
    ASSERT_EQ(f.fmi2EnterContinuousTimeMode(unit.it), fmi2OK);
  }
  other.steps(1, kEnd);
  EXPECT_NEAR(unit.get("shaft_rpm"), other.get("shaft_rpm"), 1e-3);
  EXPECT_NEAR(unit.get("theta_deg"), other.get("theta_deg"), 1e-4);
  // States and rates of co-simulation, where they are asked for, are those of model exchange.
  EXPECT_NEAR(other.get("der(state.shaft_angle)"), unit.get("der(state.shaft_angle)"), 1e-3);
}

TEST(Fmi2, DirectionalDerivativesAreDifferences) {
  const Resources resources(kHydraulic);
  const Functions& f = library();
  Unit2 unit(resources);
  unit.start();
  unit.steps(3, 1e-3);
  const unsigned unknown = resources["Td_z1_Nm"], known = resources["drive_acceleration"];
  const double seed = 2;
  double slope = 0;
  ASSERT_EQ(f.fmi2GetDirectionalDerivative(unit.it, &unknown, 1, &known, 1, &seed, &slope), fmi2OK)
      << unit.messages.text;
  const double before = unit.get("Td_z1_Nm");
  unit.set("drive_acceleration", 1000);
  EXPECT_NEAR(slope, seed * (unit.get("Td_z1_Nm") - before) / 1000, 1e-6 * std::abs(slope));
  const unsigned parameter = resources["pump.tilt_deg"];
  EXPECT_EQ(f.fmi2GetDirectionalDerivative(unit.it, &unknown, 1, &parameter, 1, &seed, &slope),
            fmi2Error);
  EXPECT_EQ(f.fmi2GetDirectionalDerivative(unit.it, &known, 1, &known, 1, &seed, &slope),
            fmi2Error);
}

TEST(Fmi3, IsFmi2ByOtherNames) {
  const Resources resources(kHydraulic);
  Unit2 two(resources);
  Unit3 three(resources);
  two.start();
  three.start();
  EXPECT_EQ(three.outputs(), two.outputs());
  for (int i = 0; i < 5; ++i) {
    two.steps(1, 1e-4);
    ASSERT_EQ(three.step(i * 1e-4, 1e-4), fmi3OK) << three.messages.text;
    EXPECT_FALSE(three.event || three.terminate || three.early);
    EXPECT_NEAR(three.last, (i + 1) * 1e-4, 1e-15);
  }
  EXPECT_EQ(three.outputs(), two.outputs());
  EXPECT_EQ(three.step(0.4, 1e-4), fmi3Error);
  EXPECT_NEAR(three.last, 5e-4, 1e-15);
  const Functions& f = library();
  fmi3FMUState state = nullptr;
  std::size_t size = 0;
  ASSERT_EQ(f.fmi3GetFMUState(three.it, &state), fmi3OK);
  ASSERT_EQ(f.fmi3SerializedFMUStateSize(three.it, state, &size), fmi3OK);
  std::vector<fmi3Byte> bytes(size);
  ASSERT_EQ(f.fmi3SerializeFMUState(three.it, state, bytes.data(), size), fmi3OK);
  ASSERT_EQ(f.fmi3FreeFMUState(three.it, &state), fmi3OK);
  ASSERT_EQ(f.fmi3DeserializeFMUState(three.it, bytes.data(), size, &state), fmi3OK);
  ASSERT_EQ(f.fmi3SetFMUState(three.it, state), fmi3OK);
  expect_near(three.outputs(), two.outputs(), 1e-12);
  const unsigned reference = resources["Td_z1_Nm"];
  double values[2];
  EXPECT_EQ(f.fmi3GetFloat64(three.it, &reference, 1, values, 2), fmi3Error);
  const unsigned flag = resources["valid_film"];
  bool is = false;
  EXPECT_EQ(f.fmi3GetBoolean(three.it, &flag, 1, &is, 1), fmi3OK);
  EXPECT_EQ(f.fmi3SetBoolean(three.it, &flag, 1, &is, 1), fmi3Error);
#define BENTAXIS_NONE(Type)                                                          \
  EXPECT_EQ(f.fmi3Get##Type(three.it, &reference, 1, nullptr, 1), fmi3Error) << #Type; \
  EXPECT_EQ(f.fmi3Set##Type(three.it, &reference, 1, nullptr, 1), fmi3Error) << #Type; \
  EXPECT_EQ(f.fmi3Get##Type(three.it, nullptr, 0, nullptr, 0), fmi3OK) << #Type;
  BENTAXIS_NONE(Float32)
  BENTAXIS_NONE(Int8)
  BENTAXIS_NONE(UInt8)
  BENTAXIS_NONE(Int16)
  BENTAXIS_NONE(UInt16)
  BENTAXIS_NONE(Int32)
  BENTAXIS_NONE(UInt32)
  BENTAXIS_NONE(Int64)
  BENTAXIS_NONE(UInt64)
  BENTAXIS_NONE(String)
#undef BENTAXIS_NONE
  EXPECT_EQ(f.fmi3GetBinary(three.it, &reference, 1, nullptr, nullptr, 1), fmi3Error);
  EXPECT_EQ(f.fmi3SetBinary(three.it, &reference, 1, nullptr, nullptr, 1), fmi3Error);
  EXPECT_EQ(f.fmi3GetClock(three.it, &reference, 1, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3SetClock(three.it, &reference, 1, nullptr), fmi3Error);
  EXPECT_EQ(f.fmi3GetOutputDerivatives(three.it, &reference, 1, nullptr, nullptr, 1), fmi3Error);
  EXPECT_EQ(f.fmi3Terminate(three.it), fmi3OK);
  EXPECT_EQ(three.step(5e-4, 1e-4), fmi3Error);
  EXPECT_EQ(f.fmi3Reset(three.it), fmi3OK);
}

TEST(Fmi3, ModelExchangeHasItsModes) {
  const Resources resources(kHydraulic);
  const Functions& f = library();
  Unit3 unit(resources, true);
  std::size_t states = 0, indicators = 0;
  ASSERT_EQ(f.fmi3GetNumberOfContinuousStates(unit.it, &states), fmi3OK);
  ASSERT_EQ(f.fmi3GetNumberOfEventIndicators(unit.it, &indicators), fmi3OK);
  EXPECT_EQ(states, 7);
  EXPECT_EQ(indicators, 2);
  EXPECT_EQ(f.fmi3EnterContinuousTimeMode(unit.it), fmi3Error);
  EXPECT_EQ(unit.step(0, 1e-3), fmi3Error);
  unit.start();
  bool again = true, end = true, nominals = true, changed = true, timed = true;
  double next = 0;
  EXPECT_EQ(f.fmi3EvaluateDiscreteStates(unit.it), fmi3OK);
  EXPECT_EQ(f.fmi3UpdateDiscreteStates(unit.it, nullptr, &end, &nominals, &changed, &timed, &next),
            fmi3Error);
  ASSERT_EQ(
      f.fmi3UpdateDiscreteStates(unit.it, &again, &end, &nominals, &changed, &timed, &next),
      fmi3OK);
  EXPECT_FALSE(again || end || nominals);
  ASSERT_EQ(f.fmi3EnterContinuousTimeMode(unit.it), fmi3OK);
  std::vector<double> x(states), rates(states), z(indicators);
  ASSERT_EQ(f.fmi3GetContinuousStates(unit.it, x.data(), states), fmi3OK);
  ASSERT_EQ(f.fmi3GetNominalsOfContinuousStates(unit.it, rates.data(), states), fmi3OK);
  ASSERT_EQ(f.fmi3GetEventIndicators(unit.it, z.data(), indicators), fmi3OK);
  ASSERT_EQ(f.fmi3GetContinuousStateDerivatives(unit.it, rates.data(), states), fmi3OK);
  EXPECT_NEAR(rates[0], 157.07963, 1e-4);
  // The angle goes past an edge: an event.
  x[0] += 0.3;
  ASSERT_EQ(f.fmi3SetTime(unit.it, 0.3 / rates[0]), fmi3OK);
  ASSERT_EQ(f.fmi3SetContinuousStates(unit.it, x.data(), states), fmi3OK);
  bool event = false;
  ASSERT_EQ(f.fmi3CompletedIntegratorStep(unit.it, true, &event, &end), fmi3OK);
  EXPECT_TRUE(event);
  EXPECT_EQ(f.fmi3EnterEventMode(unit.it), fmi3OK);
  x[0] = kNan;
  EXPECT_EQ(f.fmi3SetContinuousStates(unit.it, x.data(), states), fmi3Error);
  EXPECT_EQ(f.fmi3SetTime(unit.it, kNan), fmi3Error);
  EXPECT_EQ(f.fmi3Terminate(unit.it), fmi3OK);
}

// Whatever comes in whatever order: a status, never a crash, and after a reset all is as new.
TEST(Unit, SurvivesCallsAtRandom) {
  const Resources resources(kRated, "torque");
  const Functions& f = library();
  std::mt19937 random(19);
  const auto pick = [&](int count) { return static_cast<int>(random() % unsigned(count)); };
  const auto number = [&] {
    const double values[] = {0,    1,   -1,  kNan, kInfinity, 1e300, -1e300, 1e-300,
                             100., 0.5, 39., 1e-3, -40.,      1e5,   300.,   12.3};
    return values[pick(16)];
  };
  const double sizes[] = {1e-4, 1e-4, 1e-4, 1e-3, 0, -1, kNan, kInfinity};
  for (const fmi2Type type : {fmi2CoSimulation, fmi2ModelExchange}) {
    Unit2 unit(resources, type);
    unit.start();
    const auto as_new = unit.outputs();
    fmi2FMUstate state = nullptr;
    for (int i = 0; i < 5000; ++i) {
      unsigned vr[3];
      double values[16];
      for (unsigned& reference : vr)
        reference = static_cast<unsigned>(pick(20) == 0 ? random() : random() % resources.variables().size());
      for (double& value : values) value = number();
      fmi2Boolean flag = 0, other = 0;
      fmi2EventInfo info;
      const std::size_t count = pick(3) + 1;
      int status = fmi2OK;
      switch (pick(22)) {
        case 0: status = f.fmi2SetupExperiment(unit.it, pick(2), number(), number(), pick(2), number()); break;
        case 1: status = f.fmi2EnterInitializationMode(unit.it); break;
        case 2: status = f.fmi2ExitInitializationMode(unit.it); break;
        case 3: status = pick(8) == 0 ? f.fmi2Terminate(unit.it) : fmi2OK; break;
        case 4: status = pick(4) == 0 ? f.fmi2Reset(unit.it) : fmi2OK; break;
        case 5: case 6: status = f.fmi2GetReal(unit.it, vr, count, values); break;
        case 7: case 8: case 9: status = f.fmi2SetReal(unit.it, vr, count, values); break;
        case 10: status = f.fmi2GetBoolean(unit.it, vr, 1, &flag); break;
        case 11: status = f.fmi2GetFMUstate(unit.it, &state); break;
        case 12: status = f.fmi2SetFMUstate(unit.it, state); break;
        case 13: status = f.fmi2FreeFMUstate(unit.it, &state); break;
        case 14: status = f.fmi2DoStep(unit.it, pick(2) ? 0 : number(), sizes[pick(8)], 1); break;
        case 15: status = f.fmi2NewDiscreteStates(unit.it, &info); break;
        case 16: status = f.fmi2EnterContinuousTimeMode(unit.it); break;
        case 17: status = f.fmi2SetContinuousStates(unit.it, values, pick(8)); break;
        case 18: status = f.fmi2GetDerivatives(unit.it, values, pick(8)); break;
        case 19: status = f.fmi2CompletedIntegratorStep(unit.it, 1, &flag, &other); break;
        case 20: status = f.fmi2GetDirectionalDerivative(unit.it, vr, 1, vr + 1, 1, values, values + 1); break;
        default: status = f.fmi2SetTime(unit.it, number()); break;
      }
      ASSERT_GE(status, 0);
      ASSERT_LE(status, fmi2Error) << unit.messages.text;
    }
    ASSERT_EQ(f.fmi2Reset(unit.it), fmi2OK);
    unit.start();
    expect_near(unit.outputs(), as_new, 0);
  }
}

}  // namespace
}  // namespace bentaxis::fmu
