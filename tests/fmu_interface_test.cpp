// The calls of FMI 2 and 3 on the library of a unit, as an importer makes them.
#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <random>

#include "fmu_support.h"

namespace bentaxis::fmu {
namespace {

using testing::HasSubstr;

constexpr const char* kRated = "bap63_rated.toml";
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(UnitLibrary, HasEveryFunctionOfBothVersions) {
#define BENTAXIS_EXPECT(result, name, arguments) EXPECT_NE(library().name, nullptr) << #name;
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
    EXPECT_EQ(
        library().fmi2Instantiate("pump", fmi2ModelExchange, kToken, uri.c_str(), &functions, 0, 0),
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
  for (const std::string& uri :
       {"file://" + parent + "/with%20space%20100%25", "file:" + parent + "/with%20space%20100%25/",
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
  const auto refused_with = [&](std::vector<unsigned> intermediate,
                                fmi3IntermediateUpdateCallback update, const char* words) {
    messages.text.clear();
    EXPECT_EQ(library().fmi3InstantiateCoSimulation("p", kToken, resources.path().c_str(), false,
                                                    false, true, true, intermediate.data(),
                                                    intermediate.size(), &messages, log3, update),
              nullptr);
    EXPECT_TRUE(messages.has(words)) << messages.text;
  };
  refused_with({resources["pump.tilt_deg"]}, update3, "pump.tilt_deg has no intermediate values");
  refused_with({100000}, update3, "no variable with the reference 100000");
  refused_with({resources["Td_z1_Nm"]}, nullptr, "no function to call for them");
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
  constexpr std::size_t kStates = 1, kIndicators = 2;
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
       [&f](Unit2& u) { return f.fmi2SetContinuousStates(u.it, x, kStates); }},
      {"GetDerivatives", exchange, "iect",
       [&f](Unit2& u) { return f.fmi2GetDerivatives(u.it, x, kStates); }},
      {"GetContinuousStates", exchange, "iect",
       [&f](Unit2& u) { return f.fmi2GetContinuousStates(u.it, x, kStates); }},
      {"GetEventIndicators", exchange, "iect",
       [&f](Unit2& u) { return f.fmi2GetEventIndicators(u.it, x, kIndicators); }},
      {"GetNominals", exchange, "niect",
       [&f](Unit2& u) { return f.fmi2GetNominalsOfContinuousStates(u.it, x, kStates); }},
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
      {"SetRealInputDerivatives", simulation, "nis", [&f, speed](Unit2& u) {
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
  EXPECT_TRUE(unit.messages.has("begins at 0.05 s, the pump is at 0 s"));
  EXPECT_EQ(unit.f.fmi2DoStep(unit.it, 0, 0.1, 1), fmi2OK) << unit.messages.text;
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
        reference = static_cast<unsigned>(pick(20) == 0 ? random()
                                                        : random() % resources.variables().size());
      for (double& value : values) value = number();
      fmi2Boolean flag = 0, other = 0;
      fmi2EventInfo info;
      const std::size_t count = pick(3) + 1;
      int status = fmi2OK;
      switch (pick(22)) {
        case 0:
          status = f.fmi2SetupExperiment(unit.it, pick(2), number(), number(), pick(2), number());
          break;
        case 1:
          status = f.fmi2EnterInitializationMode(unit.it);
          break;
        case 2:
          status = f.fmi2ExitInitializationMode(unit.it);
          break;
        case 3:
          status = pick(8) == 0 ? f.fmi2Terminate(unit.it) : fmi2OK;
          break;
        case 4:
          status = pick(4) == 0 ? f.fmi2Reset(unit.it) : fmi2OK;
          break;
        case 5:
        case 6:
          status = f.fmi2GetReal(unit.it, vr, count, values);
          break;
        case 7:
        case 8:
        case 9:
          status = f.fmi2SetReal(unit.it, vr, count, values);
          break;
        case 10:
          status = f.fmi2GetBoolean(unit.it, vr, 1, &flag);
          break;
        case 11:
          status = f.fmi2GetFMUstate(unit.it, &state);
          break;
        case 12:
          status = f.fmi2SetFMUstate(unit.it, state);
          break;
        case 13:
          status = f.fmi2FreeFMUstate(unit.it, &state);
          break;
        case 14:
          status = f.fmi2DoStep(unit.it, pick(2) ? 0 : number(), sizes[pick(8)], 1);
          break;
        case 15:
          status = f.fmi2NewDiscreteStates(unit.it, &info);
          break;
        case 16:
          status = f.fmi2EnterContinuousTimeMode(unit.it);
          break;
        case 17:
          status = f.fmi2SetContinuousStates(unit.it, values, pick(8));
          break;
        case 18:
          status = f.fmi2GetDerivatives(unit.it, values, pick(8));
          break;
        case 19:
          status = f.fmi2CompletedIntegratorStep(unit.it, 1, &flag, &other);
          break;
        case 20:
          status = f.fmi2GetDirectionalDerivative(unit.it, vr, 1, vr + 1, 1, values, values + 1);
          break;
        default:
          status = f.fmi2SetTime(unit.it, number());
          break;
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
