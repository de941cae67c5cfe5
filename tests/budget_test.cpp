// The torque budget: each cause's part from its own load, in both models, adding up to the drive
// torque; against closed forms, and against runs in which only that load is there.
#include "bentaxis/analytic/budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/results/budget.h"
#include "bentaxis/results/load_scale.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/comparison_document.h"
#include "bentaxis/study/run.h"
#include "stored_cases.h"
#include "support.h"

namespace bentaxis::test {
namespace {

// Of the peak of Td: what the issue asks of the sum.
constexpr double kClosing = 1e-12;

double peak_of(const ResultTable& table, const std::string& column) {
  double peak = 0;
  for (std::size_t row = 0; row < table.rows(); ++row)
    peak = std::max(peak, std::abs(table.at(row, table.find(column))));
  return peak;
}

double mean_of(const ResultTable& table, const std::string& column) {
  double mean = 0;
  for (std::size_t row = 0; row < table.rows(); ++row)
    mean += table.at(row, table.find(column)) / static_cast<double>(table.rows());
  return mean;
}

struct BothBudgets {
  ResultTable analytic, multibody;
  Samples samples;
};

BothBudgets budgets_of(const study::PreparedCase& ready,
                       multibody::Method method = multibody::Method::multipliers) {
  BothBudgets both;
  both.samples = ready.samples(study::Way::driven);
  both.analytic = analytic::run_budget(ready.the_case, ready.the_case.analytic, both.samples);
  multibody::run_driven(ready.the_case, ready.the_case.multibody, both.samples, {},
                        multibody::Scene::full, method, &both.multibody);
  return both;
}

// Largest magnitude of a column over that of another; of round-off alone where that one is 0.
double over_peak(const ResultTable& table, const std::string& column, const std::string& of) {
  const double peak = peak_of(table, of);
  return peak > 0 ? peak_of(table, column) / peak : peak_of(table, column);
}

TEST(Budget, ClosesOnAllStoredCasesInBothModels) {
  const auto files = cases_with_a_turn();
  ASSERT_EQ(files.size(), 29);
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const study::PreparedCase ready = study::prepare(read_case(file));
    const BothBudgets both = budgets_of(ready);
    const double force = load_scale(ready.the_case, both.samples).force;
    for (const ResultTable* table : {&both.analytic, &both.multibody}) {
      SCOPED_TRACE(table->name);
      ASSERT_EQ(table->rows(), both.samples.theta_deg.size());
      EXPECT_LE(over_peak(*table, "Td_open_Nm", "Td_z1_Nm"), scaled(kClosing));
      EXPECT_LE(over_peak(*table, "Tcs_open_Nm", "Tcs_z2_Nm"), scaled(kClosing));
      EXPECT_LE(peak_of(*table, "Fh_open_N"), scaled(kClosing) * force);
    }
  }
}

// Each line against its own peak, and not against that of the torque: a wrong small line shows.
// That of the teeth is a difference of torques, held to theirs.
TEST(Budget, TheModelsAgreeLineByLine) {
  for (const auto& file : cases_with_a_turn()) {
    SCOPED_TRACE(file);
    study::PreparedCase ready = study::prepare(read_case(file));
    ready.the_case.multibody = ready.the_case.analytic;
    const BothBudgets both = budgets_of(ready);
    const LoadScale scale = load_scale(ready.the_case, both.samples);
    for (std::size_t c = 0; c < both.analytic.columns(); ++c) {
      const Channel& channel = both.analytic.channels[c];
      if (channel.kind == ChannelKind::check) continue;
      const double floor = 1e-14 * (channel.unit == "N" ? scale.force : scale.moment);
      const double allowed = scaled(1e-11 * both.analytic.peak(channel.group) + floor);
      for (std::size_t row = 0; row < both.analytic.rows(); ++row)
        ASSERT_NEAR(both.analytic.at(row, c), both.multibody.at(row, c), allowed)
            << channel.name << " at " << both.analytic.theta_deg[row];
    }
  }
}

// Td of a pump by either model, at an instant.
double torque_of(study::Model model, const PumpParameters& pump, const Assumptions& assumptions,
                 const Instant& instant) {
  std::vector<double> values(ChannelLayout(pump.geometry.pistons).size());
  if (model == study::Model::analytic)
    analytic::Model(pump, assumptions).evaluate(instant, values);
  else
    multibody::Model(pump, assumptions, instant.shaft.speed, multibody::Scene::full,
                     multibody::Method::residual)
        .evaluate(instant, values);
  return values[ChannelLayout(pump.geometry.pistons).Td()];
}

Budget budget_of(study::Model model, const PumpParameters& pump, const Assumptions& assumptions,
                 const Instant& instant) {
  if (model == study::Model::analytic)
    return analytic::BudgetModel(pump, assumptions).evaluate(instant);
  multibody::Model multibody(pump, assumptions, instant.shaft.speed, multibody::Scene::full,
                             multibody::Method::residual);
  std::vector<double> values(multibody.layout().size());
  multibody.evaluate(instant, values);
  return multibody.budget();
}

// What a load is taken away from the pump for: its line is by how much Td falls, at Ct = 1.
TEST(Budget, EachLineIsTheTorqueThatGoesWithItsLoad) {
  for (const unsigned seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    RandomPump random(seed);
    PumpParameters pump = random.pump();
    pump.friction.shaft_torque_factor = 1;
    const Assumptions assumptions{true, PistonInertia::lumped, BlockDrive::mesh};
    const Instant instant = random.instant(pump, true);
    for (const study::Model model : study::kModels) {
      SCOPED_TRACE(std::to_string(seed) + " " + to_string(model));
      Budget budget = budget_of(model, pump, assumptions, instant);
      const double all = torque_of(model, pump, assumptions, instant);
      double largest = std::abs(all);
      for (const double part : budget.drive) largest = std::max(largest, std::abs(part));
      const auto expect = [&](Cause cause, double with, double without) {
        EXPECT_NEAR(budget.drive_of(cause), with - without, scaled(1e-11) * largest)
            << to_string(cause);
      };
      const auto without = [&](const auto& change) {
        PumpParameters other = pump;
        change(other);
        return torque_of(model, other, assumptions, instant);
      };
      Instant empty = instant;
      empty.chamber_pressure.assign(empty.chamber_pressure.size(), 0);
      expect(Cause::pressure, all, torque_of(model, pump, assumptions, empty));
      Assumptions smooth = assumptions;
      smooth.piston_friction = false;
      expect(Cause::piston_friction, all, torque_of(model, pump, smooth, instant));
      expect(Cause::weight, all, without([](auto& p) { p.gravity = 0; }));
      const double steady = without([](auto& p) {
        p.gravity = 0;
        p.piston.mass = 0;
        p.shaft.axial_inertia = p.block.axial_inertia = 1e-300;
      });
      expect(Cause::inertia, without([](auto& p) { p.gravity = 0; }), steady);
      expect(Cause::block_friction, all, without([](auto& p) { p.friction.block_viscous = 0; }));
      expect(Cause::shaft_friction, all, without([](auto& p) { p.friction.shaft_viscous = 0; }));
      // Spring and film turn nothing.
      const double bare = without([](auto& p) {
        p.block.spring_force = 0;
        p.port_plate.reset();
      });
      EXPECT_NEAR(bare, all, scaled(1e-11) * largest);
    }
  }
}

TEST(Budget, ClosesForAnyPumpAtAnyInstant) {
  for (unsigned seed = 100; seed < 160; ++seed) {
    RandomPump random(seed);
    const PumpParameters pump = random.pump();
    Assumptions assumptions = random.assumptions(pump);
    const Instant instant = random.instant(pump, true);
    for (const BlockDrive gear : {BlockDrive::mesh, BlockDrive::imposed}) {
      assumptions.gear = gear;
      for (const study::Model model : study::kModels) {
        SCOPED_TRACE(std::to_string(seed) + " " + to_string(model) + " " + to_string(gear));
        const Budget budget = budget_of(model, pump, assumptions, instant);
        double drive = 0, carrying = 0, largest = 0;
        for (std::size_t c = 0; c < kCauses; ++c) {
          drive += budget.drive[c];
          carrying += budget.carrying[c];
          largest = std::max({largest, std::abs(budget.drive[c]), std::abs(budget.carrying[c])});
        }
        EXPECT_NEAR(drive, budget.drive_torque, scaled(1e-12) * largest);
        EXPECT_NEAR(carrying, budget.carrying_torque, scaled(1e-12) * largest);
        EXPECT_NEAR(budget.pressing + budget.separating, -budget.film,
                    scaled(1e-11) * (std::abs(budget.pressing) + std::abs(budget.film)));
      }
    }
  }
}

// Two flanks, bore forces beside B, a block that moves on its own: the same causes in both models.
TEST(Budget, OfAnyMotionBothModelsFindTheSameCauses) {
  int with_ring = 0;
  for (unsigned seed = 300; seed < 340; ++seed) {
    RandomPump random(seed);
    const PumpParameters pump = random.free(random.pump());
    Assumptions assumptions = random.assumptions(pump);
    const Instant free = random.free_instant(pump, 0.05);
    Instant locked = free;
    locked.block = locked.shaft;
    for (const BlockDrive gear : {BlockDrive::mesh, BlockDrive::imposed})
      for (const Instant& instant : {free, locked}) {
        assumptions.gear = gear;
        SCOPED_TRACE(std::to_string(seed) + " " + to_string(gear) +
                     (instant.locked() ? " locked" : " free"));
        const Budget a = budget_of(study::Model::analytic, pump, assumptions, instant);
        const Budget b = budget_of(study::Model::multibody, pump, assumptions, instant);
        double largest = 0;
        double drive = 0;
        double carrying = 0;
        for (std::size_t c = 0; c < kCauses; ++c) {
          largest = std::max({largest, std::abs(a.drive[c]), std::abs(a.carrying[c])});
          drive += a.drive[c];
          carrying += a.carrying[c];
        }
        for (std::size_t c = 0; c < kCauses; ++c) {
          EXPECT_NEAR(a.drive[c], b.drive[c], scaled(1e-10) * largest)
              << to_string(static_cast<Cause>(c));
          EXPECT_NEAR(a.carrying[c], b.carrying[c], scaled(1e-10) * largest)
              << to_string(static_cast<Cause>(c));
        }
        EXPECT_NEAR(drive, a.drive_torque, scaled(1e-12) * largest);
        EXPECT_NEAR(carrying, a.carrying_torque, scaled(1e-12) * largest);
        EXPECT_NEAR(a.pressing + a.separating, -a.film,
                    scaled(1e-11) * (std::abs(a.pressing) + std::abs(a.film)));
        if (!pump.piston.contact)
          EXPECT_EQ(a.drive[static_cast<std::size_t>(Cause::ring)], 0);
        else if (std::abs(a.drive[static_cast<std::size_t>(Cause::ring)]) > 1e-9 * largest)
          ++with_ring;
      }
  }
  EXPECT_GT(with_ring, 40);
}

// Cc = 0.0054 Nm/rpm at 1500 rpm: 8.1 Nm (paper, section 7), all of it through the gear. With the
// block's speed imposed that motion supplies it and the drive does not.
TEST(Budget, BlockFrictionGoesThroughTheGear) {
  study::PreparedCase ready = study::prepare(
      read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated.toml"));
  const BothBudgets meshed = budgets_of(ready);
  ready.the_case.analytic.gear = ready.the_case.multibody.gear = BlockDrive::imposed;
  const BothBudgets imposed = budgets_of(ready);
  for (std::size_t row = 0; row < meshed.analytic.rows(); row += 90) {
    for (const ResultTable* table : {&meshed.analytic, &meshed.multibody}) {
      EXPECT_NEAR(table->at(row, table->find("Td_block_friction_Nm")), 8.1, scaled(1e-11));
      EXPECT_NEAR(table->at(row, table->find("Tcs_block_friction_Nm")), 8.1, scaled(1e-11));
    }
    for (const ResultTable* table : {&imposed.analytic, &imposed.multibody}) {
      EXPECT_NEAR(table->at(row, table->find("Td_block_friction_Nm")), 0, scaled(1e-11));
      EXPECT_NEAR(table->at(row, table->find("Tcs_block_friction_Nm")), 8.1, scaled(1e-11));
    }
  }
}

// The mean of the pressure's line is displacement x dp / 2 pi for an ideal trace without
// transition; with one of w rad it is lower by about w^2/40 of it.
TEST(Budget, MeanOfPressureIsTheIdealTorque) {
  Case the_case = reference_case("bap63_rated");
  the_case.pressure.transition_deg = 0;
  the_case.operation.samples_per_revolution = 7200;
  const Samples samples = one_turn(the_case);
  const ResultTable table = analytic::run_budget(the_case, the_case.analytic, samples);
  const PortPressures& ports = the_case.pressure.ports;
  const double ideal = analytic::derived_quantities(the_case.pump.geometry).displacement *
                       (ports.delivery - ports.suction) / (2 * kPi);
  EXPECT_NEAR(mean_of(table, "Td_pressure_Nm"), ideal, scaled(1e-6) * ideal);
  EXPECT_NEAR(mean_of(table, "Td_weight_Nm"), 0, scaled(1e-12));
  EXPECT_NEAR(mean_of(table, "Td_inertia_Nm"), 0, scaled(1e-12));
}

// What brakes the shaft alone does not pass the gear: it has no column of the block's.
TEST(Budget, OnlyWhatPassesTheGearCarriesTheBlock) {
  for (const auto& [ring, teeth] : {std::pair{false, false}, {true, false}, {false, true}}) {
    const ResultTable table = budget_table("analytic", ring, teeth);
    for (std::size_t c = 0; c < kCauses; ++c) {
      const auto cause = static_cast<Cause>(c);
      const bool there = (cause != Cause::ring || ring) && (cause != Cause::teeth || teeth);
      const bool shaft_alone =
          cause == Cause::shaft_friction || cause == Cause::torque_factor || cause == Cause::teeth;
      EXPECT_EQ(table.find(drive_column(cause)) < table.columns(), there) << to_string(cause);
      EXPECT_EQ(table.find(carrying_column(cause)) < table.columns(), there && !shaft_alone)
          << to_string(cause);
    }
  }
}

TEST(Budget, RefusesWhatIsNotFinite) {
  ResultTable table = budget_table("analytic");
  Budget budget;
  append_budget(table, 0, budget);
  budget.drive_of(Cause::weight) = std::nan("");
  try {
    append_budget(table, 0.5, budget);
    FAIL() << "was taken";
  } catch (const ComputationError& error) {
    EXPECT_STREQ(error.what(), "analytic model: Td_weight_Nm is not finite at 0.5 deg");
  }
}

Case rated() {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated.toml");
}

// A line that one model has wrong is a difference however small the line is beside the torque; and
// a part that is missing leaves the sum open.
TEST(BudgetComparison, AWrongLineDiffers) {
  // One piston: weight and inertia do not cancel as those of several do.
  const study::PreparedCase ready = study::prepare(reference_case("step_single"));
  const BothBudgets both = budgets_of(ready);
  const LoadScale scale = load_scale(ready.the_case, both.samples);
  const compare::ZeroScales scales = {{"N", scale.force}, {"Nm", scale.moment}};
  const auto compared = [&](const ResultTable& multibody) {
    return study::compare_budgets(both.analytic, multibody, 1e-9, scales);
  };
  const auto sound = compared(both.multibody);
  EXPECT_TRUE(sound.comparison.agrees());
  ASSERT_EQ(sound.checks.size(), 6);
  for (const auto& check : sound.checks) EXPECT_TRUE(check.holds()) << check.name;
  EXPECT_LT(peak_of(both.analytic, "Td_weight_Nm"), 1e-3 * peak_of(both.analytic, "Td_z1_Nm"));
  EXPECT_GT(peak_of(both.analytic, "Td_weight_Nm"), 0);
  for (std::size_t c = 0; c < kCauses; ++c) {
    const std::string column = drive_column(static_cast<Cause>(c));
    if (both.analytic.find(column) == both.analytic.columns()) continue;  // bore forces at B
    if (peak_of(both.analytic, column) == 0) continue;
    ResultTable wrong = both.multibody;
    for (std::size_t row = 0; row < wrong.rows(); ++row)
      wrong.values[row * wrong.columns() + wrong.find(column)] *= 1 + 1e-6;
    const auto found = compared(wrong);
    EXPECT_FALSE(found.comparison.agrees()) << column;
    EXPECT_EQ(found.comparison.find(column)->verdict, compare::Verdict::differs) << column;
  }
  ResultTable open = both.multibody;
  open.values[open.find("Td_open_Nm")] = 1e-6;
  const auto found = compared(open);
  EXPECT_FALSE(found.checks[3].holds());
  EXPECT_EQ(found.checks[3].table, "multibody");
}

TEST(BudgetComparison, DecidesWithTheChannels) {
  study::ComparisonResult result = study::compare_models(rated(), {}, {});
  ASSERT_TRUE(result.budget);
  EXPECT_TRUE(result.agrees()) << result.headline();
  for (auto& line : result.budget->comparison.channels)
    if (line.channel.name == "Td_inertia_Nm") line.verdict = compare::Verdict::differs;
  EXPECT_FALSE(result.agrees());
  EXPECT_NE(result.headline().find("torque budgets of the two models differ: Td_inertia_Nm"),
            std::string::npos)
      << result.headline();
}

TEST(BudgetComparison, DifferentAssumptionsExplainIt) {
  Case the_case = rated();
  the_case.multibody.piston_friction = false;
  the_case.multibody.gear = BlockDrive::imposed;
  const study::ComparisonResult result = study::compare_models(the_case, {}, {});
  ASSERT_TRUE(result.budget);
  EXPECT_TRUE(result.agrees()) << result.headline();
  EXPECT_EQ(result.budget->comparison.find("Td_piston_friction_Nm")->verdict,
            compare::Verdict::explained);
  EXPECT_EQ(result.budget->comparison.find("Td_shaft_friction_Nm")->verdict,
            compare::Verdict::agrees);

  // What the assumptions do not explain stays a difference.
  Case other = the_case;
  other.pump.friction.shaft_viscous *= 1 + 1e-6;
  const study::ComparisonResult wrong = study::compare_models(the_case, other, {});
  EXPECT_EQ(wrong.budget->comparison.find("Td_shaft_friction_Nm")->verdict,
            compare::Verdict::differs);
  EXPECT_FALSE(wrong.agrees());
}

TEST(BudgetComparison, OnlyOfDrivenFullPumpsWhoseTorqueIsWanted) {
  study::ComparisonOptions options;
  options.channels = study::ChannelChoice({"Rs"});
  EXPECT_FALSE(study::compare_models(rated(), {}, options).budget);
  options.channels = {};
  options.scene.scene = multibody::Scene::piston;
  EXPECT_FALSE(study::compare_models(rated(), {}, options).budget);
  study::RunOptions run;
  run.budget = true;
  run.model = study::Model::multibody;
  run.scene.scene = multibody::Scene::pistons;
  EXPECT_THROW(study::run(study::prepare(rated()), run), InputError);
}

const report::Budget::Quantity& named(const std::vector<report::Budget::Quantity>& list,
                                      const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& q) { return q.name == name; });
  if (found == list.end()) throw std::logic_error("no " + name);
  return *found;
}

// The power of the pressure by the mechanics and the work on the oil by the balance of mass come
// from different equations: equal but for the spline between them.
TEST(BudgetSection, PowerAndEfficiencyOfAHydraulicCase) {
  const auto source = std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases";
  const auto result =
      study::compare_models(read_case(source / "bap63_rated_hydraulic.toml"), {}, {});
  const report::Budget budget = *study::comparison_document(result, {}, {}).budget;
  for (const std::size_t model : {0, 1}) {
    const auto power = [&](const std::string& name) {
      return named(budget.power, name).values[model];
    };
    const double in = power("drive");
    EXPECT_NEAR(power("not accounted for"), 0, scaled(1e-12) * in);
    EXPECT_NEAR(power("pressure"), power("pistons on the oil, by the hydraulic model"),
                scaled(1e-7) * in);
    EXPECT_NEAR(power("flow to the load") + power("in the oil"),
                power("pistons on the oil, by the hydraulic model"), scaled(1e-12) * in);
    EXPECT_NEAR(power("in the oil"), 2998, 1);  // by an independent program
    const auto efficiency = [&](const std::string& name) {
      return named(budget.efficiency, name).values[model] / 100;
    };
    EXPECT_NEAR(efficiency("volumetric"), result.first.hydraulics->summary.volumetric_efficiency,
                1e-15);
    EXPECT_NEAR(efficiency("total"), power("flow to the load") / in, scaled(1e-12));
    EXPECT_NEAR(efficiency("total"),
                efficiency("volumetric") * efficiency("mass-based hydraulic-mechanical"),
                scaled(1e-14));
    EXPECT_NEAR(efficiency("ISO 4409 total"),
                efficiency("ISO 4409 volumetric") * efficiency("hydraulic-mechanical"),
                scaled(1e-14));
    EXPECT_LT(efficiency("ISO 4409 volumetric"), efficiency("volumetric"));
    // Table 5.1 and Fig. 30: 278.8 Nm of 294.7, at a pressure that the line meets to a thousandth.
    EXPECT_NEAR(efficiency("hydraulic-mechanical"), 278.8 / 294.7, 2e-3);
  }
}

TEST(BudgetSection, SaysWhatIsNotModelled) {
  Case the_case = rated();
  the_case.pump.port_plate.reset();
  const auto of = [](const Case& one) {
    return *study::comparison_document(study::compare_models(one, {}, {}), {}, {}).budget;
  };
  report::Budget budget = of(the_case);
  for (const char* name : {"volumetric", "total", "mass-based hydraulic-mechanical",
                           "ISO 4409 volumetric", "ISO 4409 total"}) {
    EXPECT_FALSE(is_computed(named(budget.efficiency, name).values[0]));
    EXPECT_EQ(named(budget.efficiency, name).note.substr(0, 12), "not modelled");
  }
  EXPECT_NEAR(named(budget.efficiency, "hydraulic-mechanical").values[1], 95.3, 0.1);
  EXPECT_FALSE(is_computed(named(budget.block, "separating force of the lands").values[0]));
  EXPECT_FALSE(is_computed(
      named(budget.block, "balance, separating over pressing force, minimum").values[0]));

  the_case.operation.speed_rpm = -1500;  // a motor
  budget = of(the_case);
  EXPECT_FALSE(is_computed(named(budget.efficiency, "hydraulic-mechanical").values[0]));
  EXPECT_LT(named(budget.power, "drive").values[0], 0);
  the_case.operation.speed_rpm = 0;
  budget = of(the_case);
  EXPECT_EQ(named(budget.power, "drive").values[0], 0);
  EXPECT_FALSE(is_computed(named(budget.efficiency, "hydraulic-mechanical").values[0]));
}

}  // namespace
}  // namespace bentaxis::test
