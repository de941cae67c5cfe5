// All loads on every body: they balance, they have their opposites, and what is left out or put
// elsewhere shows.
#include "bentaxis/results/body_loads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "bentaxis/analytic/body_loads.h"
#include "bentaxis/analytic/mechanics.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/coupled/prescribed_oil.h"
#include "bentaxis/coupled/simulation.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/multibody/mechanics.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/multibody/simulation.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/run.h"
#include "free_bodies.h"
#include "stored_cases.h"
#include "support.h"

namespace bentaxis::test {
namespace {

// What is left of all loads on a body, of the sum of their magnitudes.
constexpr double kSum = 1e-12;

std::string name_of(const BodyLoad& load) {
  return load.symbol + " on " + load.on + " by " + load.by + " at " + load.point;
}

double norm(const std::array<double, 3>& v) { return std::hypot(v[0], v[1], v[2]); }

// Of the two sums of a body the larger.
double left(const BodySum& sum) { return std::max(sum.force_over_sum, sum.moment_over_sum); }

void expect_balance(const std::vector<BodySum>& sums, std::size_t bodies) {
  ASSERT_EQ(sums.size(), bodies);
  for (const BodySum& sum : sums) {
    EXPECT_LE(sum.force_over_sum, scaled(kSum)) << sum.body;
    EXPECT_LE(sum.moment_over_sum, scaled(kSum)) << sum.body;
  }
}

// A random pump at a random instant.
struct Drawn {
  explicit Drawn(unsigned seed, bool on_its_own)
      : random(seed),
        pump(random.free(random.pump())),
        assumptions(random.assumptions(pump)),
        instant(on_its_own ? random.free_instant(pump, 0.1) : random.instant(pump, seed % 2 == 0)) {
    if (!on_its_own && seed % 3 == 0) assumptions.gear = BlockDrive::imposed;
  }
  std::vector<BodyLoad> loads() const {
    return analytic::BodyLoads(pump, assumptions).evaluate(instant);
  }
  RandomPump random;
  PumpParameters pump;
  Assumptions assumptions;
  Instant instant;
};

void for_each_pump(unsigned count, const std::function<void(const Drawn&)>& look) {
  for (unsigned seed = 0; seed < count; ++seed)
    for (const bool on_its_own : {false, true}) {
      SCOPED_TRACE("pump " + std::to_string(seed) + (on_its_own ? ", free" : ", locked"));
      look(Drawn(seed, on_its_own));
      if (testing::Test::HasFatalFailure()) return;
    }
}

// ---- sums --------------------------------------------------------------------------------------

BodyLoad load_on(const std::string& body, std::array<double, 3> at, std::array<double, 3> force,
                 std::array<double, 3> moment = {}) {
  BodyLoad load;
  load.on = body;
  load.at = at;
  load.force = force;
  load.moment = moment;
  return load;
}

TEST(BodySums, AreForcesAndMomentsAboutTheFirstLoadsPoint) {
  // A lever of 2 m with 3 N at its end, a force against it at the middle, and a moment.
  const auto sums = sums_of({load_on("a", {1, 0, 0}, {0, -4, 0}), load_on("b", {0, 0, 0}, {}),
                             load_on("a", {3, 0, 0}, {0, 3, 0}, {0, 0, -5})});
  ASSERT_EQ(sums.size(), 2);
  EXPECT_EQ(sums[0].body, "a");
  EXPECT_EQ(sums[0].force, (std::array<double, 3>{0, -1, 0}));
  EXPECT_EQ(sums[0].moment, (std::array<double, 3>{0, 0, 1}));
  EXPECT_DOUBLE_EQ(sums[0].force_over_sum, 1.0 / 7);
  EXPECT_DOUBLE_EQ(sums[0].moment_over_sum, 1.0 / 11);
  EXPECT_EQ(sums[1].body, "b");
  EXPECT_EQ(sums[1].force_over_sum, 0);
  EXPECT_EQ(sums[1].moment_over_sum, 0);
}

TEST(BodySums, OfManyRowsAreTheWorst) {
  BodyLoadTable table;
  for (const double force : {1.0, 3.0, 2.0})
    table.append({load_on("a", {}, {force, 0, 0}), load_on("a", {0, 1, 0}, {-1, 0, 0})});
  EXPECT_EQ(table.rows(), 3);
  EXPECT_EQ(table.row(1)[0].force[0], 3);
  const auto worst = worst_sums(table);
  ASSERT_EQ(worst.size(), 1);
  EXPECT_DOUBLE_EQ(worst[0].force_over_sum, 0.5);  // of the second row: (3 - 1) / (3 + 1)
  EXPECT_EQ(worst[0].force[0], 2);
  EXPECT_DOUBLE_EQ(worst[0].moment_over_sum, 1);  // of every row: nothing holds it
  table.append({load_on("a", {}, {std::nan(""), 0, 0}), load_on("a", {}, {})});
  EXPECT_TRUE(std::isnan(worst_sums(table)[0].force_over_sum));
}

TEST(BodyLoadTable, KeepsSomeOfManyRowsAndTheWorstOfAll) {
  EXPECT_EQ(BodyLoadTable::of(kMaxLoadRows).step, 1);
  EXPECT_EQ(BodyLoadTable::of(kMaxLoadRows + 1).step, 2);
  BodyLoadTable table = BodyLoadTable::of(3 * kMaxLoadRows);
  EXPECT_EQ(table.step, 3);
  for (int row = 0; row < 10; ++row)
    table.append({load_on("a", {}, {row == 7 ? 5.0 : 1.0, row * 1.0, 0}),
                  load_on("a", {0, 1, 0}, {-1, -row * 1.0, 0})});
  EXPECT_EQ(table.run_rows(), 10);
  ASSERT_EQ(table.rows(), 4);
  EXPECT_EQ(table.at(2, 0).force[1], 6);
  EXPECT_EQ(worst_sums(table)[0].force[0], 4) << "of row 7, which is not kept";
  const BodyLoadTable by_hand{table.loads, table.values};
  EXPECT_EQ(by_hand.run_rows(), 4);
  EXPECT_EQ(worst_sums(by_hand)[0].force_over_sum, 0);
}

TEST(BodyLoadTable, RefusesARowWithOtherLoads) {
  BodyLoadTable table;
  table.append({load_on("a", {}, {})});
  EXPECT_THROW(table.append({load_on("b", {}, {})}), ComputationError);
  EXPECT_THROW(table.append({}), ComputationError);
  EXPECT_EQ(table.rows(), 1);
}

// ---- the closed form ---------------------------------------------------------------------------

TEST(AnalyticLoads, BalanceOnRandomPumps) {
  for_each_pump(
      300, [](const Drawn& d) { expect_balance(sums_of(d.loads()), d.pump.geometry.pistons + 2); });
}

TEST(AnalyticLoads, BalanceInEveryRowOfTheStoredCases) {
  for (const auto& file : cases_with_a_turn()) {
    SCOPED_TRACE(file);
    const study::PreparedCase ready = study::prepare(read_case(file));
    const Samples samples = ready.samples(study::Way::driven);
    const BodyLoadTable table =
        analytic::run_body_loads(ready.the_case, ready.the_case.analytic, samples);
    ASSERT_EQ(table.rows(), samples.theta_deg.size());
    expect_balance(worst_sums(table), ready.the_case.pump.geometry.pistons + 2);
  }
}

// What a body does to another, that one does to it.
TEST(AnalyticLoads, OfOneBodyOnAnotherAreOpposite) {
  for_each_pump(50, [](const Drawn& d) {
    const std::vector<BodyLoad> loads = d.loads();
    int pairs = 0;
    for (const BodyLoad& load : loads) {
      const bool other = std::any_of(loads.begin(), loads.end(),
                                     [&](const BodyLoad& l) { return l.on == load.by; });
      if (!other || load.kind == ForceKind::inertia) continue;
      const auto back = std::find_if(loads.begin(), loads.end(), [&](const BodyLoad& l) {
        return l.on == load.by && l.by == load.on && l.symbol == load.symbol;
      });
      ASSERT_NE(back, loads.end()) << name_of(load);
      EXPECT_EQ(back->point, load.point);
      EXPECT_EQ(back->at, load.at) << name_of(load);
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(back->force[i], -load.force[i], scaled(1e-15) * norm(load.force))
            << name_of(load);
      ++pairs;
    }
    const int gear = d.assumptions.gear == BlockDrive::mesh ? 1 : 0;
    EXPECT_EQ(pairs, 2 * (3 * d.pump.geometry.pistons + gear + 1));
  });
}

// A load left out, turned round, or put a millimetre from its point leaves a sum.
TEST(BodyLoads, ThatAreWrongAreNoticed) {
  for_each_pump(30, [](const Drawn& d) {
    const std::vector<BodyLoad> loads = d.loads();
    const auto left_on = [](const std::vector<BodyLoad>& all, const std::string& body) {
      for (const BodySum& sum : sums_of(all))
        if (sum.body == body) return left(sum);
      return 0.0;
    };
    int tried = 0;
    for (std::size_t i = 0; i < loads.size(); ++i) {
      double largest = 0;
      for (const BodyLoad& load : loads)
        if (load.on == loads[i].on)
          largest = std::max(largest, norm(load.force) + norm(load.moment));
      // Whose own share of the body's loads is far above round-off.
      const double share = (norm(loads[i].force) + norm(loads[i].moment)) / largest;
      if (share < 1e-6) continue;
      ++tried;
      std::vector<BodyLoad> wrong = loads;
      wrong.erase(wrong.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_GT(left_on(wrong, loads[i].on), 100 * kSum) << "without " << name_of(loads[i]);
      wrong = loads;
      for (double& x : wrong[i].force) x = -x;
      for (double& x : wrong[i].moment) x = -x;
      EXPECT_GT(left_on(wrong, loads[i].on), 100 * kSum) << "turned round " << name_of(loads[i]);
      if (norm(loads[i].force) / largest < 1e-6) continue;
      // Across the force: along it a point is free.
      wrong = loads;
      const auto& f = loads[i].force;
      const std::array<double, 3> across = std::abs(f[0]) < std::abs(f[2])
                                               ? std::array<double, 3>{0, f[2], -f[1]}
                                               : std::array<double, 3>{-f[1], f[0], 0};
      for (int axis = 0; axis < 3; ++axis) wrong[i].at[axis] += 1e-3 * across[axis] / norm(across);
      EXPECT_GT(left_on(wrong, loads[i].on), 100 * kSum) << "moved " << name_of(loads[i]);
    }
    EXPECT_GT(tried, 5 * d.pump.geometry.pistons);
  });
}

// The row that balances here does so by the free bodies written out from its columns too.
TEST(AnalyticLoads, AreThoseOfTheFreeBodiesWrittenOut) {
  for_each_pump(100, [](const Drawn& d) {
    if (d.assumptions.gear == BlockDrive::imposed) return;
    const analytic::Model model(d.pump, d.assumptions);
    std::vector<double> values(model.layout().size());
    model.evaluate(d.instant, values);
    ASSERT_LE(free_body_residual(d.pump, d.assumptions, d.instant, values), scaled(kSum));
    // A reaction that is off unbalances both alike: they read the same columns.
    for (std::size_t c = 0; c < model.layout().reactions(); ++c) {
      std::vector<double> off = values;
      off[c] += 1e-3 * (1 + std::abs(off[c]));
      double worst = 0;
      for (const BodySum& sum : sums_of(
               analytic::BodyLoads(d.pump, d.assumptions).of_row(d.instant, off, TeethAction())))
        worst = std::max(worst, left(sum));
      EXPECT_GT(worst, 100 * kSum) << model.layout().channels()[c].name;
      EXPECT_GT(free_body_residual(d.pump, d.assumptions, d.instant, off), 100 * kSum)
          << model.layout().channels()[c].name;
    }
  });
}

// ---- the multibody model -----------------------------------------------------------------------

// Of a body's largest load: what both models may differ by.
constexpr double kAgreement = 1e-9;

// Largest force on a body, and largest moment about its first load's point.
struct Largest {
  double force = 0, moment = 0;
};

std::array<double, 3> moment_about(const BodyLoad& load, const std::array<double, 3>& point) {
  std::array<double, 3> r = {};
  for (int i = 0; i < 3; ++i) r[i] = load.at[i] - point[i];
  const auto& f = load.force;
  return {load.moment[0] + r[1] * f[2] - r[2] * f[1], load.moment[1] + r[2] * f[0] - r[0] * f[2],
          load.moment[2] + r[0] * f[1] - r[1] * f[0]};
}

void expect_agreement(const std::vector<BodyLoad>& first, const std::vector<BodyLoad>& second) {
  ASSERT_EQ(first.size(), second.size());
  std::map<std::string, Largest> largest;
  std::map<std::string, std::array<double, 3>> about;
  for (const BodyLoad& load : first) {
    about.emplace(load.on, load.at);
    Largest& on = largest[load.on];
    on.force = std::max(on.force, norm(load.force));
    on.moment = std::max(on.moment, norm(moment_about(load, about[load.on])));
  }
  for (std::size_t i = 0; i < first.size(); ++i) {
    const BodyLoad& a = first[i];
    const BodyLoad& b = second[i];
    ASSERT_TRUE(same_load(a, b)) << name_of(a) << ", but " << name_of(b);
    const Largest& on = largest[a.on];
    const auto moment_a = moment_about(a, about[a.on]);
    const auto moment_b = moment_about(b, about[a.on]);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(a.at[axis], b.at[axis], scaled(1e-10)) << name_of(a);
      EXPECT_NEAR(a.force[axis], b.force[axis], scaled(kAgreement) * on.force) << name_of(a);
      EXPECT_NEAR(moment_a[axis], moment_b[axis], scaled(kAgreement) * on.moment) << name_of(a);
    }
  }
}

TEST(MultibodyLoads, BalanceAndAgreeWithTheClosedFormOnRandomPumps) {
  for_each_pump(40, [](const Drawn& d) {
    multibody::Model model(d.pump, d.assumptions, d.instant.shaft.speed);
    std::vector<double> values(model.layout().size());
    model.evaluate(d.instant, values);
    const std::vector<BodyLoad> loads = model.body_loads();
    expect_balance(sums_of(loads), d.pump.geometry.pistons + 2);
    expect_agreement(d.loads(), loads);
  });
}

TEST(MultibodyLoads, BalanceByEitherMethod) {
  for_each_pump(20, [](const Drawn& d) {
    if (d.pump.piston.contact) return;
    for (const auto method : {multibody::Method::multipliers, multibody::Method::residual}) {
      multibody::Model model(d.pump, d.assumptions, d.instant.shaft.speed, multibody::Scene::full,
                             method);
      std::vector<double> values(model.layout().size());
      model.evaluate(d.instant, values);
      expect_balance(sums_of(model.body_loads()), d.pump.geometry.pistons + 2);
    }
  });
}

TEST(MultibodyLoads, BalanceAndAgreeInEveryRowOfTheStoredCases) {
  for (const auto& file : cases_with_a_turn()) {
    SCOPED_TRACE(file);
    study::PreparedCase ready = study::prepare(read_case(file));
    const Case& the_case = ready.the_case;
    const Samples samples = ready.samples(study::Way::driven);
    BodyLoadTable loads;
    multibody::run_driven(the_case, the_case.analytic, samples, {}, multibody::Scene::full, {},
                          nullptr, nullptr, &loads);
    const BodyLoadTable analytic = analytic::run_body_loads(the_case, the_case.analytic, samples);
    ASSERT_EQ(loads.rows(), samples.theta_deg.size());
    expect_balance(worst_sums(loads), the_case.pump.geometry.pistons + 2);
    for (std::size_t row = 0; row < loads.rows(); row += 5) {
      SCOPED_TRACE("row " + std::to_string(row));
      expect_agreement(analytic.row(row), loads.row(row));
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(MultibodyLoads, AnImposedBlockHasItsTorqueInsteadOfTheToothForce) {
  const Drawn d(7, false);
  Assumptions imposed = d.assumptions;
  imposed.gear = BlockDrive::imposed;
  const auto loads = analytic::BodyLoads(d.pump, imposed).evaluate(d.instant);
  const auto count = [&](const std::string& symbol) {
    return std::count_if(loads.begin(), loads.end(),
                         [&](const BodyLoad& load) { return load.symbol == symbol; });
  };
  EXPECT_EQ(count("Rcs"), 0);
  EXPECT_EQ(count("Tcs"), 1);
  multibody::Model model(d.pump, imposed, d.instant.shaft.speed);
  std::vector<double> values(model.layout().size());
  model.evaluate(d.instant, values);
  expect_agreement(loads, model.body_loads());
}

TEST(MultibodyLoads, BalanceAndAgreeAtGivenStates) {
  const auto folder =
      std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "motion" / "free_block";
  const study::PreparedCase ready = study::prepare(read_case(folder / "case.toml"));
  const States states = read_states(folder / "states.csv", ready.the_case, ready.pressure);
  study::RunOptions options;
  options.assumptions = ready.the_case.analytic;
  BodyLoadTable loads[2];
  for (const study::Model model : study::kModels) {
    options.model = model;
    BodyLoadTable& found = loads[static_cast<int>(model)];
    study::run_states(ready, states, options, study::silent(), nullptr, &found);
    ASSERT_EQ(found.rows(), states.rows());
    expect_balance(worst_sums(found), ready.the_case.pump.geometry.pistons + 2);
  }
  for (std::size_t row = 0; row < states.rows(); ++row)
    expect_agreement(loads[0].row(row), loads[1].row(row));
}

// One run collects them, one that is integrated and a smaller scene find them beside.
TEST(MultibodyLoads, AreThoseOfTheDrivenFullPumpWhateverIsRun) {
  Case the_case = reference_case("bap63_rated");
  the_case.operation.samples_per_revolution = 20;
  the_case.operation.revolutions = 1;
  const study::PreparedCase ready = study::prepare(the_case);
  study::RunOptions options;
  options.model = study::Model::multibody;
  EXPECT_EQ(study::run(ready, options).loads.rows(), 0);
  options.loads = true;
  const BodyLoadTable driven = study::run(ready, options).loads;
  ASSERT_EQ(driven.rows(), 20);
  options.scene.scene = multibody::Scene::piston;
  const BodyLoadTable of_one = study::run(ready, options).loads;
  options.scene.scene = multibody::Scene::full;
  options.way = study::Way::integrated;
  const BodyLoadTable integrated = study::run(ready, options).loads;
  for (const BodyLoadTable* other : {&of_one, &integrated}) {
    ASSERT_EQ(other->rows(), 20);
    for (std::size_t row = 0; row < 20; ++row) expect_agreement(driven.row(row), other->row(row));
  }
}

// ---- simulations -------------------------------------------------------------------------------

Case simulated_case(const std::string& name, double duration, int samples) {
  Case the_case =
      read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / (name + ".toml"));
  the_case.drive->duration = duration;
  the_case.drive->samples = samples;
  return the_case;
}

void expect_balanced_rows(const Case& the_case, const Trajectory& run) {
  ASSERT_EQ(run.loads.rows(), run.lag.size());
  expect_balance(worst_sums(run.loads), the_case.pump.geometry.pistons + 2);
}

// Td of the rows is that of the loads.
void expect_torque_of_rows(const Trajectory& run) {
  std::size_t drive = 0;
  while (run.loads.loads[drive].symbol != "Td") ++drive;
  const ResultTable& table = run.table.results;
  const double peak = table.peak("Td");
  for (std::size_t row = 0; row < run.loads.rows(); ++row)
    EXPECT_NEAR(run.loads.at(row, drive).moment[2], table.at(row, table.find("Td_z1_Nm")),
                scaled(1e-12) * peak);
}

TEST(SimulatedLoads, BalanceInEveryRowOfBothModels) {
  for (const std::string name : {"bap63_motor_start", "bap63_tooth_rattle"}) {
    SCOPED_TRACE(name);
    const Case the_case = simulated_case(name, 0.01, 60);
    const PressureTrace pressure(the_case.pressure);
    analytic::SimulationOptions options;
    options.body_loads = true;
    const Trajectory a = analytic::simulate(the_case, the_case.analytic, pressure, options);
    expect_balanced_rows(the_case, a);
    expect_torque_of_rows(a);
    SimulationOptions coarse;
    coarse.accuracy = 1e-6;
    coarse.body_loads = true;
    const Trajectory m = multibody::simulate(the_case, the_case.analytic, pressure, coarse);
    expect_balanced_rows(the_case, m);
    expect_torque_of_rows(m);
    EXPECT_TRUE(std::equal(a.loads.loads.begin(), a.loads.loads.end(), m.loads.loads.begin(),
                           m.loads.loads.end(), same_load));
    coarse.body_loads = false;
    EXPECT_EQ(multibody::simulate(the_case, the_case.analytic, pressure, coarse).loads.rows(), 0);
  }
}

// Teeth in contact, and the rows of what is integrated with oil.
TEST(SimulatedLoads, BalanceWhereTeethTouch) {
  Case the_case = simulated_case("bap63_tooth_rattle", 0.01, 60);
  const Case toothed = simulated_case("bap63_teeth", 0, 0);
  the_case.pump.gear = toothed.pump.gear;
  const PressureTrace pressure(the_case.pressure);
  coupled::Options options;
  options.tolerance = 1e-7;
  options.body_loads = true;
  for (const study::Model model : study::kModels) {
    SCOPED_TRACE(to_string(model));
    const auto oil =
        coupled::prescribed_oil(the_case.pump.geometry.pistons, pressure, the_case.pressure.ports);
    const auto mechanics = model == study::Model::analytic
                               ? analytic::mechanics(the_case, the_case.analytic)
                               : multibody::mechanics(the_case, the_case.analytic);
    const Trajectory run =
        coupled::simulate(to_string(model), *mechanics, *oil, *the_case.drive, options);
    expect_balanced_rows(the_case, run);
    expect_torque_of_rows(run);
    // Some rows have pairs that carry: their forces are what the teeth do.
    ASSERT_EQ(run.teeth.size(), run.loads.rows());
    int carrying = 0;
    for (std::size_t row = 0; row < run.loads.rows(); ++row) {
      std::array<double, 3> sum = {};
      for (const BodyLoad& load : run.loads.row(row)) {
        if (load.symbol != "Rcs" || load.on != "block") continue;
        for (int i = 0; i < 3; ++i) sum[i] += load.force[i];
        if (norm(load.force) > 0) ++carrying;
      }
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(sum[i], run.teeth[row].force[i], scaled(1e-12) * norm(run.teeth[row].force));
    }
    EXPECT_GT(carrying, 10);
    EXPECT_EQ(std::count_if(run.loads.loads.begin(), run.loads.loads.end(),
                            [](const BodyLoad& load) { return load.symbol == "Rcs"; }),
              2 * 2 * kPairsPerFlank);
  }
}

}  // namespace
}  // namespace bentaxis::test
