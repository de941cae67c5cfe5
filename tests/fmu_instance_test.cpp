// What instances of a unit do: parameters, states, threads, steps, model exchange, derivatives.
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <thread>
#include <utility>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "fmu_support.h"

namespace bentaxis::fmu {
namespace {

constexpr const char* kRated = "bap63_rated.toml";
constexpr const char* kHydraulic = "bap63_rated_hydraulic.toml";

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
  // Only a reset leads on.
  unit.messages.text.clear();
  EXPECT_EQ(unit.set("pump.piston_length_mm", 47), fmi2Error);
  EXPECT_EQ(unit.f.fmi2ExitInitializationMode(unit.it), fmi2Error);
  EXPECT_TRUE(unit.messages.has("after an error")) << unit.messages.text;
  EXPECT_EQ(unit.f.fmi2Reset(unit.it), fmi2OK);
  unit.done = 0;
  unit.start();
  unit.steps(1, 1e-3);
}

// The case with one number changed, as --set changes it.
std::string change_of(const Resources& resources, const Variable& it, double value) {
  const std::string name = it.table + "." + it.key;
  if (it.name == name) return name + "=" + number_text(value);
  double pair[] = {value, value};
  const std::size_t other = 1 - it.place;
  pair[other] = *resources.variables()[resources[name + (other == 0 ? "[1]" : "[2]")]].start;
  return name + "=[" + number_text(pair[0]) + ", " + number_text(pair[1]) + "]";
}

TEST(Fmi2, EveryParameterDoesWhatSetDoes) {
  for (const char* name : {kRated, "bap63_teeth.toml"}) {
    const Resources resources(name);
    const auto changed_case = [&](const std::string& change) {
      return case_text(read_case(BENTAXIS_SOURCE_DIR "/cases/" + std::string(name), {change}));
    };
    const auto outputs_of = [](Unit2& unit) {
      unit.start();
      unit.steps(2, 1e-4);
      return unit.outputs();
    };
    Unit2 as_it_is(resources);
    const auto before = outputs_of(as_it_is);
    int with_effect = 0, parameters = 0;
    for (const Variable& it : resources.variables()) {
      if (it.role != Role::parameter) continue;
      SCOPED_TRACE(it.name);
      ++parameters;
      const double value = *it.start == 0 ? 1 : *it.start * 0.999;
      Unit2 unit(resources);
      ASSERT_EQ(unit.set(it.name, value), fmi2OK) << unit.messages.text;
      const auto values = outputs_of(unit);
      const Resources changed(name);
      changed.write("case.toml", changed_case(change_of(resources, it, value)));
      Unit2 other(changed);
      expect_near(values, outputs_of(other), 1e-13);
      if (values != before) ++with_effect;
    }
    EXPECT_GT(with_effect, parameters / 2) << "of " << parameters;
  }
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

std::vector<double> trajectory_of(Unit2& unit, int steps, double size) {
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
    return trajectory_of(unit, kSteps, kSize);
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
      for (const double value : trajectory_of(a, 1, kSize)) of_a.push_back(value);
      for (const double value : trajectory_of(b, 1, kSize)) of_b.push_back(value);
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
  const auto there = trajectory_of(unit, 10, 1e-4);
  EXPECT_EQ(unit.set("hydraulics.leakage_l_per_min_per_bar", 1), fmi2Error) << "fixed";
  unit.set("drive_speed", 50);
  unit.steps(2, 1e-4);
  ASSERT_EQ(f.fmi2SetFMUstate(unit.it, state), fmi2OK) << unit.messages.text;
  unit.done = 10;
  expect_near(unit.outputs(), here, 1e-12);
  expect_near(trajectory_of(unit, 10, 1e-4), there, 1e-6);

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
  expect_near(trajectory_of(other, 10, 1e-4), there, 1e-6);

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
  const auto first = trajectory_of(unit, 5, 1e-3);
  ASSERT_EQ(f.fmi2SetFMUstate(unit.it, state), fmi2OK);
  unit.done = 0;
  unit.start();
  EXPECT_EQ(unit.get("drive_speed"), 120);
  expect_near(trajectory_of(unit, 5, 1e-3), first, 0);
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

TEST(Fmi2, AStateTooFarAwayIsDiscardedAndTheSolverGoesOn) {
  const Resources resources(kRated, "torque");
  const Functions& f = library();
  Unit2 unit(resources, fmi2ModelExchange);
  unit.set("drive_torque", 290);
  unit.start();
  fmi2EventInfo info;
  ASSERT_EQ(f.fmi2NewDiscreteStates(unit.it, &info), fmi2OK);
  ASSERT_EQ(f.fmi2EnterContinuousTimeMode(unit.it), fmi2OK);
  const auto n = static_cast<std::size_t>(
      std::count_if(resources.variables().begin(), resources.variables().end(),
                    [](const Variable& it) { return it.role == Role::state; }));
  std::vector<double> x(n), rate(n), again(n);
  ASSERT_EQ(f.fmi2GetContinuousStates(unit.it, x.data(), n), fmi2OK);
  ASSERT_EQ(f.fmi2GetDerivatives(unit.it, rate.data(), n), fmi2OK);
  const std::vector<double> far(n, 1e300);
  ASSERT_EQ(f.fmi2SetContinuousStates(unit.it, far.data(), n), fmi2OK);
  EXPECT_EQ(f.fmi2GetDerivatives(unit.it, again.data(), n), fmi2Discard);
  EXPECT_TRUE(unit.messages.has("not finite")) << unit.messages.text;
  ASSERT_EQ(f.fmi2SetContinuousStates(unit.it, x.data(), n), fmi2OK);
  ASSERT_EQ(f.fmi2GetDerivatives(unit.it, again.data(), n), fmi2OK) << unit.messages.text;
  EXPECT_EQ(again, rate);
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

// Times and angles of the events that a run tells, of co-simulation.
std::vector<std::pair<double, double>> edges_told(Unit2& unit, int steps, double size) {
  unit.messages.text.clear();
  unit.steps(steps, size);
  std::vector<std::pair<double, double>> edges;
  std::istringstream lines(unit.messages.text);
  for (std::string line; std::getline(lines, line);) {
    double time = 0, angle = 0;
    if (std::sscanf(line.c_str(),
                    "0 logEvents: event at %lf s: the block passes a port edge at %lf", &time,
                    &angle) == 2)
      edges.emplace_back(time, angle);
  }
  return edges;
}

TEST(Fmi2, EdgesAreToldInCoSimulation) {
  const Resources resources(kHydraulic);
  Unit2 unit(resources, fmi2CoSimulation, true), finer(resources, fmi2CoSimulation, true);
  const fmi2String all[] = {"logAll"};
  EXPECT_EQ(unit.f.fmi2SetDebugLogging(unit.it, fmi2True, 1, all), fmi2OK);
  unit.start();
  finer.start();
  const auto edges = edges_told(unit, 40, 1e-3), again = edges_told(finer, 4000, 1e-5);
  // Four edges of kidneys and notches, at least, of five chambers in a turn of 40 ms.
  EXPECT_GE(edges.size(), 20U) << unit.messages.text;
  ASSERT_EQ(edges.size(), again.size());
  constexpr double kDegreesPerSecond = 9000;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    EXPECT_NEAR(edges[i].second, kDegreesPerSecond * edges[i].first, 1e-2) << i;
    EXPECT_NEAR(edges[i].first, again[i].first, 1e-9) << i;
    EXPECT_TRUE(i == 0 || edges[i].first > edges[i - 1].first) << i;
  }
  // Those that are not asked for are not told.
  const fmi2String other[] = {"logStatusWarning"};
  EXPECT_EQ(unit.f.fmi2SetDebugLogging(unit.it, fmi2True, 1, other), fmi2OK);
  EXPECT_TRUE(edges_told(unit, 40, 1e-3).empty());
}

TEST(Fmi2, TouchesOfTeethAndBreakpointsAreToldInCoSimulation) {
  const Resources rattle("bap63_tooth_rattle.toml"), load("bap63_load_step.toml");
  Unit2 teeth(rattle, fmi2CoSimulation, true), curve(load, fmi2CoSimulation, true);
  teeth.start();
  teeth.steps(20, 1e-3);
  EXPECT_TRUE(teeth.messages.has("teeth touch, ")) << teeth.messages.text;
  EXPECT_TRUE(teeth.messages.has("teeth leave contact, "));
  curve.start();
  curve.steps(11, 1e-2);
  EXPECT_TRUE(curve.messages.has("event at 0.1 s: breakpoint of a curve over time"))
      << curve.messages.text;
}

TEST(Fmi2, PressuresBelowVacuumAreRefused) {
  for (const char* name : {kRated, kHydraulic, "bap63_motoring.toml"}) {
    const Resources resources(name);
    for (const fmi2Type type : {fmi2CoSimulation, fmi2ModelExchange}) {
      Unit2 unit(resources, type);
      unit.start();
      for (const char* input : {"suction_pressure", "delivery_pressure"}) {
        if (std::none_of(resources.variables().begin(), resources.variables().end(),
                         [&](const Variable& it) { return it.name == input; }))
          continue;
        const double before = unit.get(input);
        unit.messages.text.clear();
        EXPECT_EQ(unit.set(input, -2e5), fmi2Error) << name;
        EXPECT_TRUE(unit.messages.has(std::string(input) + " = -2e+05: must be >= -101324 Pa"))
            << unit.messages.text;
        EXPECT_EQ(unit.set(input, -101326), fmi2Error) << name;
        EXPECT_EQ(unit.get(input), before);
        EXPECT_EQ(unit.set(input, -0.5e5), fmi2OK) << name << unit.messages.text;
      }
    }
  }
}

TEST(Fmi2, InputsAreInterpolatedLinearly) {
  const Resources resources(kHydraulic);
  const Functions& f = library();
  Unit2 unit(resources);
  unit.start();
  const auto slope = [&](const char* name, int order, double value) {
    const unsigned reference = resources[name];
    return f.fmi2SetRealInputDerivatives(unit.it, &reference, 1, &order, &value);
  };
  EXPECT_EQ(slope("load_share", 1, -32), fmi2OK) << unit.messages.text;
  EXPECT_EQ(slope("drive_speed", 1, -100), fmi2OK);
  EXPECT_EQ(unit.get("drive_acceleration"), -100);
  EXPECT_EQ(slope("drive_acceleration", 1, 0), fmi2OK);
  // A point further on, values go on; what is read is what acts.
  ASSERT_EQ(f.fmi2DoStep(unit.it, 0, 0.015625, fmi2True), fmi2OK) << unit.messages.text;
  EXPECT_NEAR(unit.get("load_share"), 0.5, 1e-12);
  const double speed = unit.get("shaft_rpm");
  EXPECT_NEAR(speed, 1500 - 0.015625 * 100 / kRadPerSecondPerRpm, 1e-9);
  // Below its least value it is refused before anything moves.
  unit.messages.text.clear();
  EXPECT_EQ(f.fmi2DoStep(unit.it, 0.015625, 0.046875, fmi2True), fmi2Error);
  EXPECT_TRUE(unit.messages.has("load_share would be -1 at the end of the step: must be >= 0"))
      << unit.messages.text;
  EXPECT_EQ(unit.get("shaft_rpm"), speed);
  Unit2 other(resources);
  other.start();
  for (const auto& [name, order, value, said] :
       {std::tuple{"load_share", 2, 1.0, "load_share: order 2 of a derivative"},
        std::tuple{"pump.tilt_deg", 1, 1.0, "pump.tilt_deg is not a continuous input"},
        std::tuple{"suction_pressure", 1, HUGE_VAL, "der(suction_pressure) must be a finite"},
        std::tuple{"drive_acceleration", 1, 1.0, "the acceleration is held"}}) {
    const unsigned reference = resources[name];
    other.messages.text.clear();
    EXPECT_EQ(f.fmi2SetRealInputDerivatives(other.it, &reference, 1, &order, &value), fmi2Error);
    EXPECT_TRUE(other.messages.has(said)) << other.messages.text;
  }
}

// The atmosphere is a parameter: the least gauge pressure follows it.
TEST(Fmi2, VacuumIsThatOfTheAtmosphere) {
  const Resources resources(kHydraulic);
  Unit2 unit(resources);
  EXPECT_EQ(unit.set("suction_pressure", -0.9e5), fmi2OK);
  EXPECT_EQ(unit.set("hydraulics.atmosphere_bar", 0.8), fmi2OK) << unit.messages.text;
  EXPECT_EQ(unit.set("suction_pressure", -0.85e5), fmi2Error);
  EXPECT_TRUE(unit.messages.has("must be >= -79999")) << unit.messages.text;
  EXPECT_EQ(unit.set("suction_pressure", -0.1e5), fmi2OK);
  unit.start();
}

TEST(Fmi2, ASwitchSaysWhoseLoadItIs) {
  const Resources resources("bap63_load_step.toml");
  const Functions& f = library();
  Unit2 unit(resources, fmi2ModelExchange);
  unit.start();
  const unsigned own = resources["load_share_replaces_curve"];
  const auto flow = [&](fmi2Boolean replaces, double share) {
    EXPECT_EQ(f.fmi2SetBoolean(unit.it, &own, 1, &replaces), fmi2OK) << unit.messages.text;
    EXPECT_EQ(unit.set("load_share", share), fmi2OK);
    fmi2Boolean is = 2;
    EXPECT_EQ(f.fmi2GetBoolean(unit.it, &own, 1, &is), fmi2OK);
    EXPECT_EQ(is, replaces);
    return unit.get("flow_delivery_l_per_min");
  };
  ASSERT_EQ(f.fmi2SetTime(unit.it, 0.2), fmi2OK);  // the curve says 60 %
  const double full = flow(fmi2True, 1);
  EXPECT_NEAR(flow(fmi2True, 0.999), 0.999 * full, 1e-9 * full);
  EXPECT_NEAR(flow(fmi2True, 0.6), 0.6 * full, 1e-9 * full);
  // As it was: 1 leaves the load to its curve, any other value takes its place.
  EXPECT_NEAR(flow(fmi2False, 1), 0.6 * full, 1e-9 * full);
  EXPECT_NEAR(flow(fmi2False, 0.999), 0.999 * full, 1e-9 * full);
  // It is part of the state.
  flow(fmi2True, 1);
  fmi2FMUstate state = nullptr;
  ASSERT_EQ(f.fmi2GetFMUstate(unit.it, &state), fmi2OK);
  flow(fmi2False, 1);
  ASSERT_EQ(f.fmi2SetFMUstate(unit.it, state), fmi2OK);
  EXPECT_NEAR(unit.get("flow_delivery_l_per_min"), full, 1e-9 * full);
  ASSERT_EQ(f.fmi2FreeFMUstate(unit.it, &state), fmi2OK);
  // Not between events, and not where it is no input.
  const unsigned film = resources["valid_film"], speed = resources["drive_speed"];
  const fmi2Boolean yes = fmi2True;
  EXPECT_EQ(f.fmi2SetBoolean(unit.it, &film, 1, &yes), fmi2Error);
  EXPECT_EQ(f.fmi2SetBoolean(unit.it, &speed, 1, &yes), fmi2Error);
  ASSERT_EQ(f.fmi2EnterContinuousTimeMode(unit.it), fmi2OK);
  EXPECT_EQ(f.fmi2SetBoolean(unit.it, &own, 1, &yes), fmi2Error);
  // Where no curve is, no switch is needed.
  const Resources without(kHydraulic);
  EXPECT_THROW(without["load_share_replaces_curve"], std::runtime_error);
}

TEST(Fmi2, StartsWithTheTorqueOfItsResources) {
  const Resources resources(kRated, "torque");
  resources.write(
      "unit.txt",
      std::string("drive torque\ntolerance 1e-9\nstart_torque 292.5\ntoken ") + kToken + "\n");
  Unit2 unit(resources);
  EXPECT_EQ(unit.get("drive_torque"), 292.5);
  unit.start();
  unit.steps(40, 1e-3);  // a turn
  EXPECT_NEAR(unit.get("shaft_rpm"), 1500, 15);
}

// However long what an importer gives is: a message is one line of a size that a log can hold.
TEST(UnitLibrary, MessagesStayShort) {
  const Resources resources(kRated);
  Messages messages;
  fmi2CallbackFunctions functions{log2, nullptr, nullptr, nullptr, &messages};
  constexpr std::size_t kLong = 1 << 20;
  const std::string text = std::string(kLong, 'x') + "\n\x1b[31m";
  const auto said = [&] { return std::exchange(messages.text, ""); };
  EXPECT_EQ(library().fmi2Instantiate("p", fmi2CoSimulation, text.c_str(), resources.uri().c_str(),
                                      &functions, 0, 0),
            nullptr);
  const std::string token = said();
  EXPECT_LT(token.size(), 2500U);
  EXPECT_NE(token.find(".. (1048582 bytes)"), std::string::npos) << token;
  const std::string place = "file:///" + text;
  EXPECT_EQ(
      library().fmi2Instantiate("p", fmi2CoSimulation, kToken, place.c_str(), &functions, 0, 0),
      nullptr);
  const std::string folder = said();
  EXPECT_LT(folder.size(), 2500U);
  EXPECT_EQ(std::count(folder.begin(), folder.end(), '\n'), 1);
  EXPECT_EQ(folder.find('\x1b'), std::string::npos);
  EXPECT_EQ(
      library().fmi3InstantiateModelExchange(text.c_str(), text.c_str(), resources.path().c_str(),
                                             false, false, &messages, log3),
      nullptr);
  EXPECT_LT(said().size(), 2500U);
}

TEST(Fmi3, MessagesNameTheFunctionThatWasCalled) {
  const Resources resources(kRated);
  const Functions& f = library();
  const unsigned none = 100000;
  double value = 0;
  bool flag = false, a = false, b = false, c = false, d = false, e = false;
  for (const bool exchange : {false, true}) {
    Unit3 unit(resources, exchange);
    const auto named = [&](const char* name, fmi3Status status) {
      EXPECT_EQ(status, fmi3Error) << name;
      EXPECT_TRUE(unit.messages.has(std::string(": ") + name + ": ")) << unit.messages.text;
      EXPECT_FALSE(unit.messages.has("fmi2")) << unit.messages.text;
      unit.messages.text.clear();
    };
    named("fmi3GetFloat64", f.fmi3GetFloat64(unit.it, &none, 1, &value, 1));
    named("fmi3SetFloat64", f.fmi3SetFloat64(unit.it, &none, 1, &value, 1));
    named("fmi3GetBoolean", f.fmi3GetBoolean(unit.it, &none, 1, &flag, 1));
    named("fmi3SetBoolean", f.fmi3SetBoolean(unit.it, &none, 1, &flag, 1));
    named("fmi3GetString", f.fmi3GetString(unit.it, &none, 1, nullptr, 1));
    named("fmi3ExitInitializationMode", f.fmi3ExitInitializationMode(unit.it));
    named("fmi3DoStep", f.fmi3DoStep(unit.it, 0, 1e-3, true, &a, &b, &c, &value));
    named("fmi3Terminate", f.fmi3Terminate(unit.it));
    named("fmi3EnterEventMode", f.fmi3EnterEventMode(unit.it));
    named("fmi3UpdateDiscreteStates",
          f.fmi3UpdateDiscreteStates(unit.it, &a, &b, &c, &d, &e, &value));
    named("fmi3EnterContinuousTimeMode", f.fmi3EnterContinuousTimeMode(unit.it));
    named("fmi3CompletedIntegratorStep", f.fmi3CompletedIntegratorStep(unit.it, true, &a, &b));
    named("fmi3SetTime", f.fmi3SetTime(unit.it, 1));
    named("fmi3SetContinuousStates", f.fmi3SetContinuousStates(unit.it, &value, 1));
    named("fmi3GetContinuousStates", f.fmi3GetContinuousStates(unit.it, &value, 1));
    named("fmi3GetContinuousStateDerivatives",
          f.fmi3GetContinuousStateDerivatives(unit.it, &value, 1));
    named("fmi3GetDirectionalDerivative",
          f.fmi3GetDirectionalDerivative(unit.it, &none, 1, &none, 1, &value, 1, &value, 1));
    named("fmi3SetFMUState", f.fmi3SetFMUState(unit.it, &value));
    named("fmi3EnterStepMode", f.fmi3EnterStepMode(unit.it));
    named("fmi3EnterConfigurationMode", f.fmi3EnterConfigurationMode(unit.it));
  }
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
#define BENTAXIS_NONE(Type)                                                            \
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
  ASSERT_EQ(f.fmi3UpdateDiscreteStates(unit.it, &again, &end, &nominals, &changed, &timed, &next),
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

// A step to a time by as many steps as events make of it; how many there were.
int step_with_events(Unit3& unit, double& time, double end) {
  const Functions& f = library();
  int events = 0;
  while (time < end) {
    EXPECT_EQ(unit.step(time, end - time), fmi3OK) << unit.messages.text;
    EXPECT_EQ(unit.early, unit.last < end);
    EXPECT_GT(unit.last, time);
    EXPECT_TRUE(unit.event || !unit.early);
    time = unit.last;
    if (!unit.event) continue;
    ++events;
    EXPECT_EQ(f.fmi3EnterEventMode(unit.it), fmi3OK) << unit.messages.text;
    EXPECT_EQ(unit.step(time, 1e-4), fmi3Error) << "in event mode";
    bool again = true, end_all = true, nominals = true, states = true, timed = true;
    double next = 0;
    EXPECT_EQ(
        f.fmi3UpdateDiscreteStates(unit.it, &again, &end_all, &nominals, &states, &timed, &next),
        fmi3OK);
    EXPECT_FALSE(again || end_all || nominals || states);
    EXPECT_EQ(f.fmi3EnterStepMode(unit.it), fmi3OK);
    unit.messages.text += "passed\n";
  }
  return events;
}

std::size_t count_in(const std::string& text, const std::string& words) {
  std::size_t count = 0;
  for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

TEST(Fmi3, EventModeEndsStepsAtEvents) {
  const Functions& f = library();
  for (const char* name : {kHydraulic, "bap63_tooth_rattle.toml"}) {
    const Resources resources(name);
    Unit3 plain(resources, Steps3{});
    Unit3 unit(resources, Steps3{true, true, {}});
    plain.start();
    unit.start();
    EXPECT_EQ(f.fmi3EnterEventMode(plain.it), fmi3Error);
    EXPECT_TRUE(plain.messages.has("eventModeUsed was false"));
    EXPECT_EQ(unit.step(0, 1e-3), fmi3Error) << "a run begins in event mode";
    EXPECT_EQ(f.fmi3EnterStepMode(unit.it), fmi3OK);
    double time = 0;
    int events = 0;
    for (int i = 1; i <= 10; ++i) {
      ASSERT_EQ(plain.step((i - 1) * 1e-3, 1e-3), fmi3OK) << plain.messages.text;
      EXPECT_FALSE(plain.event || plain.early);
      events += step_with_events(unit, time, i * 1e-3);
    }
    EXPECT_GT(events, 3);
    EXPECT_EQ(count_in(plain.messages.text, "event at "), static_cast<std::size_t>(events)) << name;
    expect_near(unit.outputs(), plain.outputs(), 1e-11);  // nothing else has changed
  }
}

TEST(Fmi3, EventsWithinAStepArePassedWhereItMayNotEndEarly) {
  const Resources resources(kHydraulic);
  Unit3 plain(resources, Steps3{});
  Unit3 unit(resources, Steps3{true, false, {}});
  plain.start();
  unit.start();
  ASSERT_EQ(library().fmi3EnterStepMode(unit.it), fmi3OK);
  ASSERT_EQ(plain.step(0, 0.01), fmi3OK);
  ASSERT_EQ(unit.step(0, 0.01), fmi3OK);
  EXPECT_FALSE(unit.event || unit.early);
  EXPECT_EQ(unit.last, 0.01);
  EXPECT_EQ(unit.outputs(), plain.outputs());
}

TEST(Fmi3, EventModeNamesTheNextBreakpoint) {
  const Resources resources("bap63_load_step.toml");
  const Functions& f = library();
  Unit3 unit(resources, Steps3{true, true, {}});
  unit.start();
  const auto next_event = [&] {
    bool again, end, nominals, states, timed = false;
    double next = 0;
    EXPECT_EQ(f.fmi3UpdateDiscreteStates(unit.it, &again, &end, &nominals, &states, &timed, &next),
              fmi3OK);
    return timed ? next : kNan;
  };
  EXPECT_EQ(next_event(), 0.1) << "where the throttle begins to close";
  ASSERT_EQ(f.fmi3EnterStepMode(unit.it), fmi3OK);
  double time = 0;
  step_with_events(unit, time, 0.0999);
  unit.messages.text.clear();
  while (time < 0.1) {
    ASSERT_EQ(unit.step(time, 0.001), fmi3OK) << unit.messages.text;
    time = unit.last;
    if (!unit.event) continue;
    ASSERT_EQ(f.fmi3EnterEventMode(unit.it), fmi3OK);
    if (time < 0.1) {
      EXPECT_EQ(next_event(), 0.1);
      ASSERT_EQ(f.fmi3EnterStepMode(unit.it), fmi3OK);
    }
  }
  EXPECT_EQ(time, 0.1);
  EXPECT_TRUE(unit.messages.has("event at 0.1 s: breakpoint")) << unit.messages.text;
  EXPECT_NEAR(next_event(), 0.105, 1e-12);
}

TEST(Fmi3, IntermediateUpdatesAreTheStepsOfTheIntegrator) {
  const Resources resources(kHydraulic);
  const Functions& f = library();
  const unsigned torque = resources["Td_z1_Nm"], other = resources["Rb1_x1_N"],
                 share = resources["load_share"];
  Unit3 unit(resources, Steps3{false, false, {torque, share}});
  unit.start();
  std::vector<std::pair<double, double>> seen;
  bool never_set = true;
  unit.messages.update = [&](double time, bool may_set, bool& returns, double& when) {
    double value = kNan;
    EXPECT_EQ(f.fmi3GetFloat64(unit.it, &torque, 1, &value, 1), fmi3OK);
    seen.emplace_back(time, value);
    EXPECT_EQ(f.fmi3GetFloat64(unit.it, &other, 1, &value, 1), fmi3Error);
    EXPECT_EQ(f.fmi3SetFloat64(unit.it, &torque, 1, &value, 1), fmi3Error);
    value = 1;
    EXPECT_EQ(f.fmi3SetFloat64(unit.it, &share, 1, &value, 1), may_set ? fmi3OK : fmi3Error);
    never_set = never_set && !may_set;
    for (const fmi3Status status :
         {f.fmi3Reset(unit.it), f.fmi3Terminate(unit.it), f.fmi3EnterEventMode(unit.it),
          f.fmi3GetFMUState(unit.it, nullptr), unit.step(time, 1e-3)})
      EXPECT_EQ(status, fmi3Error);
    EXPECT_TRUE(unit.messages.has("in an intermediate update"));
    if (seen.size() == 3) returns = true;  // which was not allowed
    when = time;
  };
  bool event = false, terminate = false, early = false;
  double last = 0;
  ASSERT_EQ(f.fmi3DoStep(unit.it, 0, 0.005, true, &event, &terminate, &early, &last), fmi3OK)
      << unit.messages.text;
  EXPECT_TRUE(unit.messages.has("Rb1_x1_N is not one of the intermediate variables"));
  EXPECT_TRUE(unit.messages.has("intermediateVariableSetRequested is false"));
  EXPECT_TRUE(unit.messages.has("cannot return early where earlyReturnAllowed was false"));
  EXPECT_FALSE(early || never_set);
  ASSERT_GT(seen.size(), 20U);
  EXPECT_EQ(seen.back().first, 0.005);
  EXPECT_EQ(last, 0.005);
  Unit3 plain(resources, Steps3{});
  plain.start();
  double time = 0;
  for (const auto& [when, value] : seen) {
    ASSERT_GT(when, time);
    ASSERT_EQ(plain.step(time, when - time), fmi3OK) << plain.messages.text;
    time = when;
    double there = kNan;
    ASSERT_EQ(f.fmi3GetFloat64(plain.it, &torque, 1, &there, 1), fmi3OK);
    EXPECT_NEAR(there, value, 1e-10 * std::abs(value)) << when;
  }
}

TEST(Fmi3, InputsOfIntermediateUpdatesAct) {
  const Resources resources(kHydraulic);
  const Functions& f = library();
  const unsigned share = resources["load_share"];
  constexpr double kRate = -40, kEnd = 0.005;
  Unit2 line(resources);
  line.start();
  const int order = 1;
  ASSERT_EQ(f.fmi2SetRealInputDerivatives(line.it, &share, 1, &order, &kRate), fmi2OK);
  line.steps(1, kEnd);
  // The end of what is held over one step, and over those between two updates.
  const auto error_of = [&](bool with_updates) {
    Unit3 unit(resources, Steps3{false, false, {share}});
    unit.start();
    unit.messages.update = [&](double time, bool may_set, bool&, double&) {
      const double value = 1 + kRate * time;
      if (may_set && with_updates) {
        EXPECT_EQ(f.fmi3SetFloat64(unit.it, &share, 1, &value, 1), fmi3OK) << unit.messages.text;
      }
    };
    EXPECT_EQ(unit.step(0, kEnd), fmi3OK) << unit.messages.text;
    const unsigned pressure = resources["p_delivery_bar"];
    double value = kNan;
    EXPECT_EQ(f.fmi3GetFloat64(unit.it, &pressure, 1, &value, 1), fmi3OK);
    return std::abs(value - line.get("p_delivery_bar"));
  };
  const double held = error_of(false), updated = error_of(true);
  EXPECT_GT(held, 1);
  EXPECT_LT(updated, held / 10) << held;
}

TEST(Fmi3, AnIntermediateUpdateEndsTheStep) {
  const Resources resources(kHydraulic);
  const unsigned torque = resources["Td_z1_Nm"];
  Unit3 unit(resources, Steps3{false, true, {torque}});
  Unit3 plain(resources, Steps3{});
  unit.start();
  plain.start();
  double asked = 0.002;
  unit.messages.update = [&](double time, bool, bool& returns, double& when) {
    EXPECT_LE(time, 0.002);
    returns = time > 0.001;
    when = asked;
  };
  ASSERT_EQ(unit.step(0, 0.005), fmi3OK) << unit.messages.text;
  EXPECT_TRUE(unit.early);
  EXPECT_FALSE(unit.event);
  EXPECT_EQ(unit.last, 0.002);
  ASSERT_EQ(plain.step(0, 0.002), fmi3OK);
  EXPECT_EQ(unit.outputs(), plain.outputs());
  // A time that has passed is now; one that is none is not heard.
  double first = 0;
  asked = 0.001;
  unit.messages.update = [&](double time, bool, bool& returns, double& when) {
    first = time;
    returns = true;
    when = asked;
  };
  ASSERT_EQ(unit.step(0.002, 0.005), fmi3OK) << unit.messages.text;
  EXPECT_TRUE(unit.early);
  EXPECT_EQ(unit.last, first);
  asked = kNan;
  const double here = unit.last;
  ASSERT_EQ(unit.step(here, 0.001), fmi3OK) << unit.messages.text;
  EXPECT_FALSE(unit.early);
  EXPECT_EQ(unit.last, here + 0.001);
}

TEST(Fmi3, AStepThatFailsOnItsWayLeavesAllAsItWas) {
  const Resources resources("bap63_motoring.toml", "torque");
  const Functions& f = library();
  const unsigned torque = resources["drive_torque"];
  Unit3 unit(resources, Steps3{false, false, {torque}});
  unit.start();
  const auto before = unit.outputs();
  const auto set = [&](double value) { return f.fmi3SetFloat64(unit.it, &torque, 1, &value, 1); };
  const auto read = [&] {
    double value = kNan;
    EXPECT_EQ(f.fmi3GetFloat64(unit.it, &torque, 1, &value, 1), fmi3OK);
    return value;
  };
  const double first = read();
  int updates = 0;
  unit.messages.update = [&](double time, bool may_set, bool&, double&) {
    ++updates;
    if (may_set && time > 0.005) {
      EXPECT_EQ(set(1e300), fmi3OK);
    }
  };
  ASSERT_EQ(unit.step(0, 0.01), fmi3Discard) << unit.messages.text;
  EXPECT_GT(updates, 3);
  EXPECT_FALSE(unit.early || unit.event);
  EXPECT_EQ(unit.last, 0);
  EXPECT_EQ(read(), first);
  expect_near(unit.outputs(), before, 0);
  unit.messages.update = [](double, bool, bool&, double&) {};
  ASSERT_EQ(unit.step(0, 0.01), fmi3OK) << unit.messages.text;
  Unit3 plain(resources, Steps3{});
  plain.start();
  ASSERT_EQ(plain.step(0, 0.01), fmi3OK);
  expect_near(unit.outputs(), plain.outputs(), 1e-12);
}

}  // namespace
}  // namespace bentaxis::fmu
