// The description of the pump for engines, and what comes of it: motion of the closed loops, the
// twelve curves of 50 digits, faults planted in the description, modules that fail.
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <functional>

#include "bentaxis/engines/mechanism.h"
#include "bentaxis/engines/run.h"
#include "bentaxis/study/engine_comparison.h"
#include "support.h"
#include "tree_motion.h"

namespace bentaxis::test {
namespace {

using engines::Mechanism;

Case rated(int samples) {
  Case the_case = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases/bap63_rated.toml");
  the_case.operation.samples_per_revolution = samples;
  return the_case;
}

Mechanism mechanism_of(const Case& the_case) {
  const study::PreparedCase ready = study::prepare(the_case);
  return engines::assemble(the_case, the_case.analytic, ready.samples(study::Way::driven));
}

// Both models and the engines at the case's samples.
study::EngineComparison compared(const Case& the_case, study::EngineOptions options,
                                 bool with_curve = true) {
  const study::PreparedCase ready = study::prepare(the_case);
  if (with_curve) options.curves = {reference_folder()};
  const ResultTable multibody = study::run_turn(ready, study::Model::multibody);
  return study::compare_engines(ready, options, study::run_turn(ready, study::Model::analytic),
                                &multibody, 1e-9);
}
study::EngineComparison compared(const Case& the_case, const std::vector<std::string>& names,
                                 const std::function<void(Mechanism&)>& change = {}) {
  study::EngineOptions options;
  options.names = names;
  options.change = change;
  return compared(the_case, options);
}

study::EngineOptions integrated_by(const std::string& engine) {
  study::EngineOptions options;
  options.names = {engine};
  options.way = study::EngineWay::integrated;
  return options;
}

// The largest difference of an engine from the analytic model, over the peak of a reaction.
double worst_of(const study::EngineComparison& result) {
  double worst = 0;
  for (const study::EngineRow& row : result.rows)
    worst = std::max(worst, row.pairs[0].back().difference.share());
  return worst;
}

class EachEngine : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const engines::Answer answer =
        engines::run_engine(GetParam(), mechanism_of(rated(1)), [](double) {});
    if (answer.failure.find("is not installed") != std::string::npos)
      GTEST_SKIP() << answer.failure;
    ASSERT_EQ(answer.failure, "");
  }
};
INSTANTIATE_TEST_SUITE_P(All, EachEngine, testing::ValuesIn(engines::known_engines()),
                         [](const auto& engine) { return engine.param; });

// Written down before the engines were run: 1e-9, as of Simbody (studies/verification).
TEST_P(EachEngine, AgreesWithEveryCurveOf50Digits) {
  for (const std::string& name : reference_cases()) {
    const study::EngineComparison result = compared(reference_case(name), {GetParam()});
    EXPECT_TRUE(result.agrees()) << name << ": " << result.headline();
    EXPECT_EQ(result.curve, name);
    EXPECT_GE(result.curve_angles, 72U) << name;
    for (const study::EngineRow& row : result.rows) {
      EXPECT_EQ(row.odd, "") << name << ", " << row.group;
      EXPECT_EQ(row.curve.empty(), row.group == "Tcs") << name << ", " << row.group;
    }
    // What the engine has is not what both models have, to the bit.
    EXPECT_NE(result.runs.front().table.values,
              select_channels(
                  study::run_turn(study::prepare(reference_case(name)), study::Model::analytic),
                  [&](const Channel& channel) {
                    return result.runs.front().table.find(channel.name) <
                           result.runs.front().table.columns();
                  })
                  .values)
        << name;
  }
}

// Pistons that stand almost across their bores: the loop has a second solution close by.
TEST_P(EachEngine, PistonsAcrossTheirBoresAreOnTheRightSide) {
  for (const char* name : {"assembly_1e-2", "assembly_1e-6"}) {
    const study::EngineComparison result = compared(
        read_case(reference_folder().parent_path() / "hard" / name / "case.toml"), {GetParam()});
    EXPECT_TRUE(result.agrees()) << name << ": " << result.headline();
  }
}

// Universal joint, two of them, Rc away from B, and two flanks with a tooth force of either sign.
TEST_P(EachEngine, AgreesBeyondTheShippedCurves) {
  const std::filesystem::path source = BENTAXIS_SOURCE_DIR;
  std::vector<Case> cases;
  for (const double phase : {0.0, 0.7}) {
    cases.push_back(read_case(source / "cases/bap63_cardan.toml"));
    cases.back().pump.transfer.cardan->phase = phase;
    cases.back().pump.block.axial_inertia = 2.5e-3;
    cases.push_back(read_case(source / "cases/bap63_double_cardan.toml"));
    cases.back().pump.transfer.cardan->phase = phase;
    cases.back().pump.geometry.axis_offset = 1.5e-3;
  }
  cases.push_back(rated(72));
  cases.back().pump.piston.contact = 0.04;
  for (const double speed : {1500.0, -1500.0}) {
    // No oil in the block's friction: the sign of the tooth force changes over the turn.
    cases.push_back(rated(72));
    cases.back().pump.gear.flanks = Flanks::two;
    cases.back().pump.friction.block_viscous = 0;
    cases.back().operation.speed_rpm = speed;
  }
  for (Case& the_case : cases) {
    the_case.operation.samples_per_revolution = 72;
    study::EngineOptions options;
    options.names = {GetParam()};
    const study::EngineComparison result = compared(the_case, options, false);
    EXPECT_TRUE(result.failures().empty()) << result.failures().front();
    EXPECT_TRUE(result.agrees()) << &the_case - cases.data() << ": " << result.headline();
  }
  const ResultTable table = study::run_turn(study::prepare(cases.back()), study::Model::analytic);
  const std::size_t tooth = ChannelLayout(cases.back().pump).Rcs();
  double low = 0, high = 0;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    low = std::min(low, table.at(row, tooth));
    high = std::max(high, table.at(row, tooth));
  }
  EXPECT_LT(low, -1);
  EXPECT_GT(high, 1);
}

// A fault in what engines are given is found by compare, in a reaction that it acts on.
TEST_P(EachEngine, FaultsInTheDescriptionAreFound) {
  const struct {
    const char* fault;
    std::function<void(Mechanism&)> plant;
    const char* group;  // in which it is found; "": the description contradicts itself
  } faults[] = {
      {"shaft's centre of mass 1 mm off", [](Mechanism& m) { m.bodies[0].centre.z() += 1e-3; },
       "Rb2"},
      {"block's centre of mass 1 mm off", [](Mechanism& m) { m.bodies[1].centre.z() += 1e-3; },
       "Th"},
      {"a piston's centre of mass 1 mm off", [](Mechanism& m) { m.bodies[3].centre.z() += 1e-3; },
       "Rc"},
      {"a piston's inertia 1 % off", [](Mechanism& m) { m.bodies[2].inertia *= 1.01; }, "Rc"},
      {"a piston heavier by a millionth", [](Mechanism& m) { m.bodies[2].mass *= 1 + 1e-6; }, "Rc"},
      {"bent by a millionth more",
       [](Mechanism& m) {
         m.bodies[1].axes = Eigen::AngleAxisd(-1e-6, engines::Vector::UnitX()).toRotationMatrix() *
                            m.bodies[1].axes;
       },
       ""},
      {"weight along z",
       [](Mechanism& m) {
         m.gravity = {0, 0, -9.80665};
       },
       "Rb1"},
      {"no acceleration of a slide",
       [](Mechanism& m) {
         for (auto& state : m.states) state.acceleration[2] = 0;
       },
       "Rs"},
      {"tooth force 1 um off",
       [](Mechanism& m) {
         for (auto& state : m.states)
           state.actions.back().tail<3>() +=
               engines::Vector(1e-6, 0, 0).cross(engines::Vector(state.actions.back().head<3>()));
       },
       "Rb2"},
      {"a pressure 1 ppm off",
       [](Mechanism& m) {
         for (auto& state : m.states) state.loads[4] *= 1 + 1e-6;
       },
       "Rs"},
  };
  const Case the_case = rated(72);
  for (const auto& [fault, plant, group] : faults) {
    const study::EngineComparison result = compared(the_case, {GetParam()}, plant);
    if (std::string(group).empty()) {
      ASSERT_EQ(result.failures().size(), 1U) << fault;
      EXPECT_NE(result.failures().front().find("outside of their supports"), std::string::npos)
          << fault;
      continue;
    }
    ASSERT_TRUE(result.failures().empty()) << fault << ": " << result.failures().front();
    EXPECT_FALSE(result.agrees()) << fault;
    for (const study::EngineRow& row : result.rows)
      if (row.group == group) {
        EXPECT_EQ(row.odd, GetParam()) << fault << ", " << group;
      }
  }
}

// The tolerance of the mode was written down before the first run, in engine_tolerance().
TEST_P(EachEngine, IntegratesWithinItsTolerance) {
  const study::EngineComparison result = compared(rated(72), integrated_by(GetParam()));
  EXPECT_TRUE(result.failures().empty());
  EXPECT_TRUE(result.agrees()) << result.headline();
  EXPECT_EQ(result.angles, 72);
  EXPECT_EQ(result.curve_angles, 72U);
  EXPECT_GT(worst_of(result), 1e-9);  // integrated, not given
}

TEST_P(EachEngine, HalfTheStepHasASmallerError) {
  study::EngineOptions options = integrated_by(GetParam());
  double before = 1;
  for (const int steps : {360, 720, 1440}) {
    options.steps = steps;
    const double now = worst_of(compared(rated(36), options));
    EXPECT_LT(now, before / 1.5) << steps;
    before = now;
  }
}

TEST_P(EachEngine, FaultsInAnIntegratedPumpAreFound) {
  study::EngineOptions options = integrated_by(GetParam());
  const double right = worst_of(compared(rated(36), options));
  const std::function<void(Mechanism&)> faults[] = {[](Mechanism& m) {
                                                      for (engines::Loop& loop : m.loops)
                                                        loop.point_on.z() *= 1.05;
                                                    },
                                                    [](Mechanism& m) { m.bodies[2].mass *= 1.5; },
                                                    [](Mechanism& m) {
                                                      for (auto& state : m.states)
                                                        state.loads[4] *= 1.05;
                                                    }};
  for (const auto& fault : faults) {
    options.change = fault;
    const study::EngineComparison result = compared(rated(36), options);
    EXPECT_TRUE(!result.agrees() || !result.failures().empty());
    EXPECT_GT(worst_of(result), 10 * right);
  }
}

// Against the direction of rotation angles fall, and real pistons spin.
TEST_P(EachEngine, IntegratesBackwardsAndWithPistonsThatSpin) {
  int found = 0;
  for (const std::string& name : reference_cases()) {
    const Case the_case = reference_case(name);
    const bool backwards = the_case.operation.speed_rpm < 0;
    const bool spins =
        the_case.analytic.inertia == PistonInertia::real && the_case.pump.piston.real->spin != 0;
    if (!backwards && !spins) continue;
    ++found;
    const study::EngineComparison result = compared(the_case, integrated_by(GetParam()));
    EXPECT_TRUE(result.failures().empty()) << name << ": " << result.failures().front();
    EXPECT_TRUE(result.agrees()) << name << ": " << result.headline();
  }
  EXPECT_GE(found, 2);
}

TEST_P(EachEngine, SettingsAreThoseItSays) {
  const std::vector<engines::Setting> settings = engines::settings_of(GetParam());
  ASSERT_FALSE(settings.empty());
  study::EngineOptions options = integrated_by(GetParam());
  options.steps = 72;
  for (const engines::Setting& setting : settings) {
    ASSERT_GE(setting.values.size(), 2U) << setting.name;
    options.settings = {GetParam() + "." + setting.name + "=" + setting.values[1]};
    const study::EngineComparison result = compared(rated(4), options);
    ASSERT_TRUE(result.failures().empty()) << result.failures().front();
    EXPECT_NE(result.runs.front().text.find(setting.name + " " + setting.values[1]),
              std::string::npos)
        << result.runs.front().text;
  }
  options.settings = {GetParam() + ".colour=red"};
  EXPECT_THROW(compared(rated(4), options), InputError);
  options.settings = {GetParam() + "." + settings.front().name + "=none"};
  EXPECT_THROW(compared(rated(4), options), InputError);
  for (const engines::Setting& setting : settings) {
    EXPECT_EQ(setting.refusal(setting.values.front()), "") << setting.name;
    EXPECT_NE(setting.refusal("-1"), "") << setting.name;
    if (!setting.most.empty()) {
      EXPECT_EQ(setting.refusal(setting.most), "") << setting.name;
      EXPECT_NE(setting.refusal("1e99"), "") << setting.name;
    }
  }
}

TEST(Mechanisms, LoopsAreClosedInPositionVelocityAndAcceleration) {
  for (const std::string& name : reference_cases()) {
    const Case the_case = reference_case(name);
    const Mechanism m = mechanism_of(the_case);
    const double length = the_case.pump.geometry.piston_length;
    const double speed = std::abs(rad_per_second(the_case.operation.speed_rpm)) + 1;
    for (std::size_t row = 0; row < m.states.size(); row += 5) {
      const engines::State& state = m.states[row];
      std::vector<engines::FrameMotion> frames;
      std::size_t next = 0;
      for (const engines::Body& body : m.bodies) {
        std::vector<engines::Coordinate> coordinates;
        for (std::size_t i = 0; i < body.freedoms.size(); ++i, ++next)
          coordinates.push_back(
              {state.position[next], state.velocity[next], state.acceleration[next]});
        frames.push_back(
            engines::moved(body.parent < 0 ? engines::FrameMotion{} : frames[body.parent], body,
                           coordinates.data()));
      }
      for (int k = 0; k < the_case.pump.geometry.pistons; ++k) {
        const double angle = -2 * kPi * k / the_case.pump.geometry.pistons;
        const engines::Vector on_shaft = the_case.pump.geometry.joint_circle_radius *
                                         engines::Vector(-std::sin(angle), std::cos(angle), 0);
        const engines::Vector on_piston(0, 0, -length);
        const auto& piston = frames[2 + k];
        // A hundred roundings of each.
        EXPECT_LT((piston.point(on_piston) - frames[0].point(on_shaft)).norm(), 2e-14 * length);
        EXPECT_LT((piston.velocity_of(on_piston) - frames[0].velocity_of(on_shaft)).norm(),
                  2e-14 * speed * length);
        EXPECT_LT((piston.acceleration_of(on_piston) - frames[0].acceleration_of(on_shaft)).norm(),
                  1e-13 * speed * speed * length);
        if (the_case.analytic.inertia == PistonInertia::real) {
          EXPECT_NEAR(piston.turning.dot(piston.axes.col(2)), the_case.pump.piston.real->spin,
                      1e-12 * speed);
        }
      }
    }
  }
}

// Velocities and accelerations of a tree against differences of its positions.
TEST(Mechanisms, MotionOfATreeIsTheDerivativeOfItsPositions) {
  engines::Body body;
  body.place = {0.3, -0.2, 0.5};
  body.axes = Eigen::AngleAxisd(0.7, engines::Vector(1, 2, 3).normalized()).toRotationMatrix();
  body.freedoms = {
      {false, {0.6, 0, 0.8}}, {true, {0, 1, 0}}, {true, {0.8, 0, 0.6}}, {false, {1, 0, 0}}};
  const engines::Vector point(0.1, 0.4, -0.3);
  const auto at = [&](double t) {
    const engines::Coordinate turn{0.4 + 0.9 * t + 0.3 * t * t, 0.9 + 0.6 * t, 0.6};
    engines::Body base;
    base.freedoms = {{}};
    std::vector<engines::Coordinate> coordinates;
    for (int i = 0; i < 4; ++i)
      coordinates.push_back(
          {0.2 * i + (1 + i) * t - 0.2 * i * t * t, 1 + i - 0.4 * i * t, -0.4 * i});
    return engines::moved(engines::moved({}, base, &turn), body, coordinates.data());
  };
  constexpr double kStep =
      1e-4;  // error of central differences: about its square, 1e-8 of values near 10
  const auto before = at(-kStep), now = at(0), after = at(kStep);
  const engines::Vector velocity = (after.point(point) - before.point(point)) / (2 * kStep);
  const engines::Vector acceleration =
      (after.velocity_of(point) - before.velocity_of(point)) / (2 * kStep);
  const engines::Vector turning_rate = (after.turning - before.turning) / (2 * kStep);
  EXPECT_LT((velocity - now.velocity_of(point)).norm(), 1e-5);
  EXPECT_LT((acceleration - now.acceleration_of(point)).norm(), 1e-5);
  EXPECT_LT((turning_rate - now.turning_rate).norm(), 1e-5);
}

TEST(Mechanisms, WhatTheyLackIsRefused) {
  for (const char* name : {"bap63_tapered_pistons", "bap63_teeth"}) {
    const Case the_case = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" /
                                    (std::string(name) + ".toml"));
    EXPECT_THROW(engines::assemble(the_case, the_case.analytic, {}), InputError) << name;
  }
}

TEST(Modules, OneThatFailsIsNamedInALine) {
  ASSERT_EQ(setenv("BENTAXIS_ENGINE_PATH", BENTAXIS_TEST_ENGINES, 1), 0);
  const Mechanism m = mechanism_of(rated(2));
  const std::pair<const char*, const char*> modules[] = {
      {"crashes", "crashes: crashed (signal 6, Aborted): about to fail"},
      {"leaves", "leaves: ended before it had answered (exit status 7)"},
      {"old", "has interface 3, this program 2"},
      {"says_nothing", "says_nothing: a faulty engine"},
      {"no_library", "is no module of an engine: /"},
      {"absent",
       "absent: is not installed: there is no bentaxis_engine_absent.so beside the program "
       "or in BENTAXIS_ENGINE_PATH"}};
  for (const auto& [name, text] : modules) {
    const engines::Answer answer = engines::run_engine(name, m, [](double) {});
    EXPECT_NE(answer.failure.find(text), std::string::npos) << answer.failure;
    EXPECT_EQ(answer.failure.find('\n'), std::string::npos);
    EXPECT_EQ(engines::is_engine(name), std::string(name) != "absent");
  }
  EXPECT_FALSE(engines::is_engine("../crashes"));
  EXPECT_FALSE(engines::is_engine(""));
}

// Whether it computes on and on or has ended already; no process is left.
TEST(Modules, AnInterruptedRunIsEnded) {
  ASSERT_EQ(setenv("BENTAXIS_ENGINE_PATH", BENTAXIS_TEST_ENGINES, 1), 0);
  for (const char* name : {"waits", "crashes"}) {
    EXPECT_THROW(
        engines::run_engine(name, mechanism_of(rated(2)), [](double) { throw Interrupted(); }),
        Interrupted)
        << name;
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
  }
}

// One that gives zeros for all stands alone, by the curve and without one.
TEST(Modules, AWrongOneStandsAlone) {
  ASSERT_EQ(setenv("BENTAXIS_ENGINE_PATH", BENTAXIS_TEST_ENGINES, 1), 0);
  for (const double more : {0.0, 1e-3}) {
    Case the_case = rated(72);
    the_case.pump.block.pin_z += more;
    if (more != 0)  // no longer the case of the curve
      for (InputEntry& entry : the_case.entries)
        if (entry.key == "pin_z_mm") entry.value = "61";
    const study::EngineComparison result = compared(the_case, {"gives_zero"});
    EXPECT_EQ(result.curve.empty(), more != 0);
    EXPECT_FALSE(result.agrees());
    for (const study::EngineRow& row : result.rows) EXPECT_EQ(row.odd, "gives_zero") << row.group;
  }
}

// Nearest to its own tolerance, not largest; what is not known is passed over.
TEST(EngineVerdict, HeadlineNamesWhatIsNearestToItsTolerance) {
  const auto cell = [](double share, double tolerance, const char* channel) {
    study::EngineCell made{compare::difference(1, 1 + share, 1), channel, 30, tolerance};
    return made;
  };
  study::EngineComparison found;
  found.results = {"analytic", "a", "b"};
  found.models = 1;
  study::EngineRow unknown, row;
  unknown.pairs.assign(3, std::vector<study::EngineCell>(3));
  row.group = "Rs";
  row.pairs = unknown.pairs;
  row.pairs[0][1] = cell(0.5e-3, 1e-3, "Rs_1_x2_N");
  row.pairs[0][2] = cell(4e-3, 1e-2, "Rs_2_x2_N");
  found.rows = {unknown, row};
  EXPECT_TRUE(found.agrees());
  EXPECT_EQ(found.headline(),
            "All engines agree. Largest difference: Rs_1_x2_N of a at 30 deg: 5.0e-04 of peak from "
            "the analytic model (tolerance 0.001).");
  found.rows[1].pairs[0][2] = cell(4e-2, 1e-2, "Rs_2_x2_N");
  found.rows[1].odd = "b";
  EXPECT_FALSE(found.agrees());
  EXPECT_EQ(found.headline(),
            "Engines differ: Rs_2_x2_N of b at 30 deg: 4.0e-02 of peak from the analytic model "
            "(tolerance 0.01). Alone against the others: b.");
  found.rows = {unknown};
  EXPECT_EQ(found.headline(), "No engine has given results.");
}

}  // namespace
}  // namespace bentaxis::test
