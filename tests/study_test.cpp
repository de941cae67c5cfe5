// Studies: one call from a case to a verdict; the inertia study: what lumping does, against the
// paper's appendix and against scaling laws.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <iterator>

#include "bentaxis/compare/difference.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/achieved_error.h"
#include "bentaxis/study/block_torque.h"
#include "bentaxis/study/calibration.h"
#include "bentaxis/study/comparison.h"
#include "bentaxis/study/comparison_document.h"
#include "bentaxis/study/friction_calibration.h"
#include "bentaxis/study/hard_cases.h"
#include "bentaxis/study/hard_cases_document.h"
#include "bentaxis/study/in_threads.h"
#include "bentaxis/study/inertia.h"
#include "bentaxis/study/inertia_document.h"
#include "bentaxis/study/inertia_study.h"
#include "bentaxis/study/lost_digits.h"
#include "bentaxis/study/memory.h"
#include "bentaxis/study/operating_points.h"
#include "bentaxis/study/paper_figures.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/reference_curves.h"
#include "bentaxis/study/reference_set.h"
#include "bentaxis/study/regression.h"
#include "bentaxis/study/rounding_spread.h"
#include "bentaxis/study/tradeoff.h"
#include "bentaxis/study/tradeoff_study.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using multibody::Scene;
using study::InertiaRun;

Case shipped_case() {
  Case the_case =
      read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated.toml");
  the_case.pump.piston.real = PistonMass::Real{0.019, 24e-6, 5e-6, 0};
  the_case.operation.samples_per_revolution = 120;
  return the_case;
}

// More rows than are held in the memory where there is a folder to keep them in.
TEST(Comparison, ManyRowsInAFileAreThoseInTheMemory) {
  Case many = shipped_case();
  many.operation.samples_per_revolution = 10'000;
  study::ComparisonOptions options;
  const study::ComparisonResult held = study::compare_models(many, {}, options);
  options.scratch = std::filesystem::temp_directory_path();
  const study::ComparisonResult kept = study::compare_models(many, {}, options);
  for (const auto table :
       {&study::ComparisonResult::analytic, &study::ComparisonResult::multibody}) {
    EXPECT_FALSE((held.*table).stored);
    EXPECT_TRUE((kept.*table).stored);
    for (std::size_t c = 0; c < (held.*table).columns(); ++c) {
      const Channel& channel = (held.*table).channels[c];
      if (channel.kind == ChannelKind::check) continue;  // round-off
      // Simbody beside another run of itself gives other last digits at some angles.
      const double last_digits = table == &study::ComparisonResult::analytic
                                     ? 0
                                     : 1e-10 * held.analytic.peak(channel.group);
      for (std::size_t row = 0; row < 10'000; row += 7)
        if (const double value = (held.*table).at(row, c); is_computed(value)) {
          ASSERT_NEAR((kept.*table).at(row, c), value, last_digits) << row << " " << channel.name;
        }
    }
  }
  EXPECT_TRUE(kept.budget->analytic.stored);
  EXPECT_TRUE(kept.budget->multibody.stored);
  ASSERT_EQ(kept.comparison.channels.size(), held.comparison.channels.size());
  for (std::size_t c = 0; c < held.comparison.channels.size(); ++c) {
    EXPECT_EQ(kept.comparison.channels[c].verdict, held.comparison.channels[c].verdict);
    EXPECT_EQ(kept.comparison.channels[c].own_peak, held.comparison.channels[c].own_peak);
    EXPECT_EQ(kept.comparison.channels[c].peak, held.comparison.channels[c].peak);
    EXPECT_EQ(kept.comparison.channels[c].mean[0], held.comparison.channels[c].mean[0]);
  }
  ASSERT_EQ(kept.limits.size(), held.limits.size());
  for (std::size_t i = 0; i < held.limits.size(); ++i)
    EXPECT_EQ(kept.limits[i].worst, held.limits[i].worst);
}

// Of a group in one model: channels by how much of what is allowed they differ.
study::GroupLine line_of(const std::string& model, const std::string& group,
                         const std::vector<double>& severities) {
  study::GroupLine line;
  line.model = model;
  line.group = group;
  for (std::size_t i = 0; i < severities.size(); ++i) {
    compare::ReferenceChannel channel;
    channel.comparison.channel.name = group + "_" + "xyz"[i] + "1_N";
    channel.comparison.channel.unit = "N";
    channel.comparison.peak = 1000;
    channel.comparison.allowed = 10;
    channel.comparison.largest = 10 * severities[i];
    channel.comparison.verdict =
        severities[i] > 1 ? compare::Verdict::differs : compare::Verdict::agrees;
    channel.finding = severities[i] > 1 ? compare::Finding::differs : compare::Finding::agrees;
    line.failed += channel.failed() ? 1 : 0;
    ++line.compared;
    line.channels.push_back(channel);
  }
  return line;
}

TEST(Regression, TheWorstIsThatFurthestBeyondOrNearestToItsLimit) {
  study::Outcome outcome;
  outcome.lines = {line_of("analytic", "Rb1", {0.1, 0.3, 0.2}), line_of("multibody", "Rb1", {0.6}),
                   line_of("analytic", "Td", {0.5, 0.4}), line_of("multibody", "Td", {0.1})};
  EXPECT_EQ(outcome.lines[0].worst()->comparison.channel.name, "Rb1_y1_N");
  EXPECT_EQ(outcome.worst_line("Rb1")->model, "multibody");
  EXPECT_EQ(outcome.worst_line("Td")->model, "analytic");
  EXPECT_EQ(outcome.worst_line("Rcs"), nullptr);
  EXPECT_EQ(study::held_text(outcome),
            "2 of 2 reactions compared agree. Worst: Rb1 agrees: 0.6 % of peak (6 N), 1 % allowed; "
            "Rb1_x1_N at 0 deg (multibody).");
  // Both models differ in the one group: it is one reaction.
  outcome.lines[0] = line_of("analytic", "Rb1", {2, 7, 3});
  outcome.lines[1] = line_of("multibody", "Rb1", {1.5});
  EXPECT_EQ(
      study::held_text(outcome),
      "1 of 2 reactions compared differ. Worst: Rb1 differs: 7 % of peak (70 N), 1 % allowed; "
      "Rb1_y1_N at 0 deg and 2 more (analytic).");
  // What lacks values is not one that differs.
  outcome.lines[3].channels[0].finding = compare::Finding::incomplete;
  outcome.lines[3].channels[0].hint = "no value at 3 deg";
  outcome.lines[3].failed = 1;
  outcome.lines[3].compared = 0;
  EXPECT_EQ(
      study::held_text(outcome),
      "1 of 2 reactions compared differ. Worst: Rb1 differs: 7 % of peak (70 N), 1 % allowed; "
      "Rb1_y1_N at 0 deg and 2 more (analytic). Not compared: Td_x1_N (no value at 3 deg).");
  outcome.state = study::Outcome::State::differs;
  EXPECT_TRUE(outcome.differs());
  EXPECT_THAT(study::summary({outcome}), testing::HasSubstr("0 agree, 1 differ; 3 groups"));
  outcome.lines[0] = line_of("analytic", "Rb1", {0.2});
  outcome.lines[1] = line_of("multibody", "Rb1", {0.1});
  EXPECT_FALSE(outcome.differs());
  EXPECT_THAT(study::held_text(outcome),
              testing::StartsWith("2 of 2 reactions compared agree. Worst: Td agrees"));
  EXPECT_THAT(study::summary({outcome}), testing::HasSubstr("0 agree, 0 differ, 1 incomplete"));
}

// Smallest and largest magnitude of a vector of piston 1 over the turn, and its mean.
struct Magnitude {
  double low = 1e300, high = 0, mean = 0;
};
Magnitude magnitude(const ResultTable& table, const std::string& symbol) {
  Magnitude result;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    double square = 0;
    for (const char* axis : {"x2", "y2", "z2"}) {
      const std::size_t column = table.find(symbol + "_1_" + axis + "_N");
      if (column < table.columns()) square += std::pow(table.at(row, column), 2);
    }
    const double value = std::sqrt(square);
    result.low = std::min(result.low, value);
    result.high = std::max(result.high, value);
    result.mean += value / static_cast<double>(table.rows());
  }
  return result;
}

// Appendix, Fig. 36 and 37: axes 10..70 N for Rc and 20..110 N for Rs; two masses above the real
// piston for Rc and below it for Rs.
// A page has the case's angles, a reference its own: drawn on straight lines between its points,
// and not within its gaps.
TEST(ReferenceCurves, AreDrawnAtTheAnglesOfAPage) {
  Channel x;
  x.name = x.group = "X_N";
  x.kind = ChannelKind::reaction;
  const auto table = [&](const char* name, std::vector<double> theta, std::vector<double> values) {
    ResultTable made;
    made.name = name;
    made.channels = {x};
    made.theta_deg = std::move(theta);
    made.values = std::move(values);
    return made;
  };
  const std::vector<double> own = {10, 100, 190, 280};
  study::Outcome outcome;
  outcome.held["analytic"] = {table("analytic", own, {1, 3, 5, 3}),
                              table("reference", own, {1, 2, 3, 4}),
                              {},
                              {},
                              {},
                              {{190, 280}}};
  study::GroupLine line;
  line.model = "analytic";
  compare::ReferenceChannel channel;
  channel.comparison.channel = x;
  channel.comparison.allowed = 0.5;
  channel.finding = compare::Finding::differs;
  line.channels = {channel};
  outcome.lines = {line};
  const auto at = [&](const std::vector<double>& theta) {
    return study::reference_curves(outcome, {"X_N"}, theta)->held.at(0);
  };
  EXPECT_EQ(at(own).values, (std::vector<double>{1, 2, 3, 4}));
  const auto drawn = at({0, 55, 100, 145, 190, 235, 280});
  const std::vector<double> values = {4 - 3.0 * 80 / 90, 1.5, 2, 2.5, 3, not_computed(), 4};
  const std::vector<double> apart = {-1 + 80.0 / 90, 0.5, 1, 1.5, 2, not_computed(), -1};
  ASSERT_EQ(drawn.values.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(is_computed(drawn.values[i]), is_computed(values[i])) << i;
    if (!is_computed(values[i])) continue;
    EXPECT_NEAR(drawn.values[i], values[i], 1e-12) << i;
    EXPECT_NEAR(drawn.differences.at(0).second[i], apart[i], 1e-12) << i;
  }
  EXPECT_EQ(drawn.allowed, 0.5);
}

TEST(InertiaStudy, ResolvedTeethHaveTheRoundOffOfTheirStiffness) {
  Case the_case = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_teeth.toml");
  const double as_is = study::tooth_round_off(the_case.pump);
  // More than what the models differ by without load (docs/inertia.md), and no more than ten times.
  EXPECT_GT(as_is, 3.5e-9);
  EXPECT_LT(as_is, 3.5e-8);
  the_case.pump.gear.teeth->youngs_modulus *= 10;
  EXPECT_DOUBLE_EQ(study::tooth_round_off(the_case.pump), 10 * as_is);
  EXPECT_EQ(study::tooth_round_off(shipped_case().pump), 0);
}

TEST(InertiaStudy, CurvesLieInThePapersWindowsInThePapersOrder) {
  for (const double speed : {1500.0, 2350.0}) {
    const InertiaRun run = study::run_both_pistons(shipped_case(), speed, false, Scene::piston);
    for (const auto& [lumped, real] : {std::pair{&run.analytic_lumped, &run.analytic_real},
                                       std::pair{&run.multibody_lumped, &run.multibody_real}}) {
      for (const ResultTable* table : {lumped, real}) {
        EXPECT_GT(magnitude(*table, "Rc").low, 10);
        EXPECT_LT(magnitude(*table, "Rc").high, 70);
        EXPECT_GT(magnitude(*table, "Rs").low, 20);
        EXPECT_LT(magnitude(*table, "Rs").high, 110);
      }
      EXPECT_GT(magnitude(*lumped, "Rc").mean, magnitude(*real, "Rc").mean);
      EXPECT_LT(magnitude(*lumped, "Rs").mean, magnitude(*real, "Rs").mean);
    }
  }
}

// Inertia alone: omega^2, to round-off of the largest force (and the spin scaled likewise).
TEST(InertiaStudy, InertiaReactionsScaleWithTheSquareOfTheSpeed) {
  Case slow_case = shipped_case();
  slow_case.pump.piston.real->spin = 30;
  Case fast_case = slow_case;
  fast_case.pump.piston.real->spin *= 2350.0 / 1500.0;
  const InertiaRun slow = study::run_both_pistons(slow_case, 1500, false, Scene::full);
  const InertiaRun fast = study::run_both_pistons(fast_case, 2350, false, Scene::full);
  const double ratio = std::pow(2350.0 / 1500.0, 2);
  EXPECT_NEAR(ratio, 2.4544, 5e-5);
  const auto check = [&](const ResultTable& a, const ResultTable& b, double tolerance) {
    const double peak = b.peak("Rs");
    for (std::size_t c = 0; c < a.columns(); ++c) {
      if (a.channels[c].kind != ChannelKind::reaction) continue;
      for (std::size_t row = 0; row < a.rows(); ++row)
        ASSERT_NEAR(ratio * a.at(row, c), b.at(row, c), scaled(tolerance) * peak)
            << a.channels[c].name;
    }
  };
  check(slow.analytic_lumped, fast.analytic_lumped, 2e-14);
  check(slow.analytic_real, fast.analytic_real, 2e-14);
  check(slow.multibody_lumped, fast.multibody_lumped, 1e-12);
  check(slow.multibody_real, fast.multibody_real, 1e-12);
}

TEST(InertiaStudy, OnePistonSceneHasTheNumbersOfTheFullPump) {
  for (const bool loaded : {false, true}) {
    const InertiaRun one = study::run_both_pistons(shipped_case(), 2350, loaded, Scene::piston);
    const InertiaRun full = study::run_both_pistons(shipped_case(), 2350, loaded, Scene::full);
    const auto of_pistons = [](const Channel& channel) {
      return multibody::computes(Scene::piston, channel);
    };
    for (const auto table : {&InertiaRun::multibody_lumped, &InertiaRun::multibody_real})
      EXPECT_LE(study::largest_difference(full.*table, one.*table, of_pistons, 0, 1).share(),
                scaled(1e-11));
  }
}

// What the scene of one piston leaves out is named; a value that is missing beside that, or that is
// not finite, is no agreement.
TEST(InertiaStudy, AMissingValueIsNoAgreement) {
  const ResultTable full =
      study::run_both_pistons(shipped_case(), 2350, true, Scene::full).analytic_real;
  const auto all = [](const Channel&) { return true; };
  EXPECT_EQ(study::largest_difference(full, full, all, 0, 1).share(), 0);
  for (const double wrong : {not_computed(), std::nan(""), HUGE_VAL}) {
    ResultTable other = full;
    other.values[full.columns() + full.find("Rc_1_x2_N")] = wrong;
    EXPECT_FALSE(study::largest_difference(full, other, all, 0, 1).within(1));
    EXPECT_FALSE(study::largest_difference(other, full, all, 0, 1).within(1));
    EXPECT_FALSE(study::largest_difference(other, other, all, 0, 1).within(1));
  }
}

// Load does not change what lumping changes, but for the weight.
TEST(InertiaStudy, ErrorDoesNotDependOnPressureAndFriction) {
  Case the_case = shipped_case();
  the_case.pump.gravity = 0;
  const auto errors = [&](bool loaded) {
    const InertiaRun run = study::run_both_pistons(the_case, 2350, loaded, Scene::full);
    return study::lumping_errors(run, run);
  };
  const auto bare = errors(false);
  const auto loaded = errors(true);
  ASSERT_EQ(bare.size(), loaded.size());
  const double scale = 45000;  // N, largest loaded reaction: its round-off is in the difference
  for (std::size_t i = 0; i < bare.size(); ++i) {
    EXPECT_NEAR(bare[i].analytic, loaded[i].analytic, scaled(1e-14) * scale) << bare[i].group;
    EXPECT_NEAR(bare[i].analytic, bare[i].multibody, scaled(1e-12) * scale) << bare[i].group;
  }
}

TEST(InertiaStudy, CausesOfErrorAddUp) {
  Case the_case = shipped_case();
  the_case.pump.piston.real->spin = 100;
  for (const auto by : {study::By::analytic, study::By::multibody}) {
    const auto causes = study::causes_of_error(the_case, 2350, by);
    EXPECT_LE(causes.rest, scaled(1e-11));  // N of 110
    EXPECT_GT(causes.centre.peak("Rs"), 1);
    EXPECT_GT(causes.transverse.peak("Rs"), 0.1);
    EXPECT_GT(causes.spin.peak("Rs"), 0.01);
    // Whose result it is: the multibody scene of one piston has no bearings.
    const std::size_t bearing = causes.all.find("Rb2_y1_N");
    EXPECT_EQ(bearing < causes.all.columns() && is_computed(causes.all.at(0, bearing)),
              by == study::By::analytic);
  }
}

TEST(Plausibility, OilThatIsNotUsedIsNotDoubted) {
  Case the_case = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" /
                            "bap63_rated_hydraulic.toml");
  the_case.hydraulics->density = 100;
  const std::size_t with_oil = study::plausibility(the_case).warnings.size();
  the_case.pressure.kind = PressureKind::ideal;
  the_case.pressure.transition_deg = 20;
  EXPECT_EQ(study::plausibility(the_case).warnings.size() + 1, with_oil);
}

TEST(InertiaStudy, KeepingTheCentreIsNearlyTheBestLumpingAndThreeMassesAreExact) {
  const auto list = study::lumpings(shipped_case(), 2350);
  ASSERT_EQ(list.size(), 5U);
  EXPECT_NEAR(list[1].joint_mass_fraction, 1 - 19.0 / 46.0, 1e-15);
  EXPECT_LT(list[1].error_rs, list[0].error_rs / 5);
  EXPECT_LE(list[2].error_rs, list[1].error_rs);
  EXPECT_LE(list[3].error_rc, list[1].error_rc);
  EXPECT_NEAR(list[2].joint_mass_fraction, list[1].joint_mass_fraction, 1e-3);
  EXPECT_LE(list[4].error_rs, scaled(1e-12));
  EXPECT_LE(list[4].error_rc, scaled(1e-12));
  // What keeping the centre leaves is the transverse inertia alone: It - m s_G (b1 - s_G).
  Case the_case = shipped_case();
  the_case.pump.piston.joint_mass_fraction = list[1].joint_mass_fraction;
  const auto causes = study::causes_of_error(the_case, 2350, study::By::analytic);
  EXPECT_LE(causes.centre.peak("Rs"), scaled(1e-11));
  EXPECT_NEAR(causes.transverse.peak("Rs"), list[1].error_rs, scaled(1e-10));
}

TEST(InertiaStudy, ThreeMassesHaveTheMomentsOfTheRealPiston) {
  Case the_case = shipped_case();
  const auto masses = study::three_masses(the_case.pump);
  ASSERT_TRUE(masses.exists);
  EXPECT_TRUE(masses.positive);
  const double b1 = the_case.pump.geometry.piston_length;
  const double centre = 0.019;
  EXPECT_NEAR(masses.at_joint + masses.at_centre + masses.at_ring, 0.09, 1e-17);
  EXPECT_NEAR(masses.at_centre * centre + masses.at_ring * b1, 0.09 * centre, 1e-17);
  EXPECT_NEAR(masses.at_joint * centre * centre + masses.at_ring * std::pow(b1 - centre, 2), 24e-6,
              1e-19);
  // A ring-shaped piston has more transverse inertia than two masses at the ends could give.
  the_case.pump.piston.real->transverse_inertia = 60e-6;
  EXPECT_FALSE(study::three_masses(the_case.pump).positive);
  the_case.pump.piston.real->centre_of_mass = 0;
  EXPECT_FALSE(study::three_masses(the_case.pump).exists);
}

TEST(InertiaStudy, RealPistonTendsToTheLumpedOneAsItsInertiaDoes) {
  const auto steps = study::approach_to_lumped(shipped_case(), 2350);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    // First order in t once the quadratic part (m s_G^2) is small.
    EXPECT_NEAR(steps[i].error_rs / steps[i].t, steps.back().error_rs / steps.back().t,
                0.2 * steps[i].t * steps[0].error_rs + 1e-5 * steps[0].error_rs);
  }
  EXPECT_LT(steps.back().error_rs, 2e-6 * steps[0].error_rs);
}

TEST(InertiaStudy, SpinStaysWhileThePumpIsIntegrated) {
  const auto spin = study::spin_run(shipped_case(), 2350, 600);
  EXPECT_LT(spin.worst_change, 1e-5);  // rad/s of 63: 3e-6 measured at accuracy 1e-7
  // Teeth, which Simbody does not integrate, turn no piston about its own axis.
  const Case toothed =
      read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_teeth.toml");
  EXPECT_LT(study::spin_run(toothed, 2350, 600).worst_change, 1e-5);
}

TEST(InertiaStudy, MapGrowsWithSpeedAndMassAndLeavesOutWhatCannotBeAssembled) {
  const auto map = study::error_map(shipped_case(), study::MapAxis::mass, {1000, 2000}, {1, 2});
  EXPECT_NEAR(map.rc[0][1] / map.rc[0][0], 4, 0.5);  // the loaded reaction grows a little too
  EXPECT_NEAR(map.rc[1][0] / map.rc[0][0], 2, 0.2);
  const auto lengths = study::error_map(shipped_case(), study::MapAxis::length, {1000}, {0.05, 1});
  EXPECT_FALSE(is_computed(lengths.rs[0][0]));
  EXPECT_TRUE(is_computed(lengths.rs[1][0]));
}

// Figures show the runs that they name, rows each model's own number: one of the multibody tables
// is twice what it was.
TEST(InertiaStudy, ReportIsOfTheRunsThatItNames) {
  study::InertiaOptions options;
  options.map_size = 2;
  Case the_case = shipped_case();
  the_case.operation.samples_per_revolution = 36;
  study::InertiaStudy study = study::run_inertia_study(the_case, options, study::silent());
  const auto of = [&](std::vector<InertiaRun>& runs, bool loaded) -> InertiaRun& {
    return *std::find_if(runs.begin(), runs.end(), [&](const InertiaRun& run) {
      return run.speed_rpm == 2350 && run.loaded == loaded;
    });
  };
  InertiaRun& bare = of(study.one_piston, false);
  for (double& value : bare.multibody_lumped.values) value *= 2;
  const auto published =
      compare::read_published(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" /
                              "published" / "bap63" / "numbers.toml");
  const study::InertiaReport report =
      study::inertia_report(study, study::judge_inertia(study, published), {}, {});

  std::map<std::string, report::Values> analytic, multibody;
  for (const auto& [name, values] : report.curves.tables[0].columns) analytic[name] = values;
  for (const auto& [name, values] : report.curves.tables[1].columns) multibody[name] = values;
  EXPECT_EQ(analytic.at("Rc_1_x2_N, 2 masses"),
            report::values_of(bare.analytic_lumped, "Rc_1_x2_N"));
  EXPECT_EQ(multibody.at("Rc_1_x2_N, 2 masses"),
            report::values_of(bare.multibody_lumped, "Rc_1_x2_N"));
  const InertiaRun& full = of(study.full, true);
  EXPECT_EQ(analytic.at("Td_z1_Nm, 2 masses - real"),
            report::values_of(study::difference(full.analytic_lumped, full.analytic_real, ""),
                              "Td_z1_Nm"));
  // The figures of the paper: Figs. 36, 37 without load, Figs. 14, 12 of the loaded pump.
  const std::map<std::string, std::pair<std::string, bool>> of_the_paper = {
      {"Fig. 36", {"Rc", false}},
      {"Fig. 37", {"Rs", false}},
      {"Fig. 14", {"Rc", true}},
      {"Fig. 12", {"Rs", true}}};
  std::size_t shown = 0;
  for (const report::Figure& figure : report.document.figures.value()) {
    const auto found = of_the_paper.find(figure.paper);
    if (found == of_the_paper.end()) continue;
    ++shown;
    const auto& [symbol, loaded] = found->second;
    const std::string name =
        "|" + symbol + "| 2350 rpm, 2 masses, " + (loaded ? "loaded" : "no load");
    EXPECT_THAT(std::get<report::ChannelFigure>(figure.content).channels, testing::Contains(name));
    const Magnitude expected = magnitude(of(study.one_piston, loaded).analytic_lumped, symbol);
    EXPECT_DOUBLE_EQ(*std::max_element(analytic.at(name).begin(), analytic.at(name).end()),
                     expected.high);
  }
  EXPECT_EQ(shown, of_the_paper.size());

  // A piston that does not spin in the case spins in the run that shows that spin stays.
  EXPECT_EQ(the_case.pump.piston.real->spin, 0);
  EXPECT_GT(study.spin.value().spin_rpm, 100);

  int rows = 0;
  for (const auto& row : report.document.published.value().section.rows) {
    if (row.at.find("2350 rpm") == std::string::npos ||
        row.at.find("two masses") == std::string::npos || row.at.find("minus") != std::string::npos)
      continue;
    ++rows;
    const double expected = 2 * row.values.at(0)->high;
    EXPECT_NEAR(row.values.at(1)->high, expected, 1e-6 * expected) << row.at;
  }
  EXPECT_EQ(rows, 2);  // Rc and Rs
}

TEST(InertiaStudy, RefusesStandstillAndPistonsWithoutData) {
  Case the_case = shipped_case();
  EXPECT_THROW(study::run_both_pistons(the_case, 0, false, Scene::piston), InputError);
  the_case.pump.piston.real.reset();
  EXPECT_THROW(study::run_both_pistons(the_case, 1500, false, Scene::piston), InputError);
}

// A massless piston: nothing is left of the inertia forces, by any model.
TEST(InertiaStudy, MasslessPistonHasNoReactionsWithoutLoad) {
  Case the_case = shipped_case();
  the_case.pump.piston.mass = 0;
  the_case.pump.piston.real = PistonMass::Real{0.019, 0, 0, 0};
  const InertiaRun run = study::run_both_pistons(the_case, 2350, false, Scene::piston);
  for (const ResultTable* table :
       {&run.analytic_lumped, &run.analytic_real, &run.multibody_lumped, &run.multibody_real}) {
    EXPECT_LE(table->peak("Rs"), scaled(1e-15));
    EXPECT_LE(table->peak("Rc"), scaled(1e-15));
  }
  EXPECT_EQ(run.by_inverse_dynamics,
            (std::vector<PistonInertia>{PistonInertia::lumped, PistonInertia::real}));
}

// Only pistons without inertia about their joint are solved by inverse dynamics, and the run says
// which; any other failure comes through instead of switching the method in silence.
TEST(InertiaStudy, InverseDynamicsReplacesMissingInertiaAloneAndIsSaid) {
  Case the_case = shipped_case();
  EXPECT_TRUE(
      study::run_both_pistons(the_case, 2350, false, Scene::piston).by_inverse_dynamics.empty());
  the_case.pump.piston.joint_mass_fraction = 1;
  EXPECT_EQ(study::run_both_pistons(the_case, 2350, false, Scene::piston).by_inverse_dynamics,
            std::vector<PistonInertia>{PistonInertia::lumped});
  // Simbody's multipliers lose the reactions between pistons of 1e-12 kg and bodies of 2 kg.
  the_case = shipped_case();
  the_case.pump.piston.mass = 1e-12;
  the_case.pump.piston.real->transverse_inertia *= 1e-11;
  the_case.pump.piston.real->axial_inertia *= 1e-11;
  EXPECT_THROW(study::run_both_pistons(the_case, 2350, true, Scene::full), ComputationError);
}

// ---- what rounding decides
// -----------------------------------------------------------------------

TEST(RoundingSpread, CopiesThatAreAllRefusedAreNoEstimate) {
  const Case the_case = shipped_case();
  const Samples samples = one_turn(the_case);
  const ResultTable table = analytic::run(the_case, the_case.analytic, samples);
  int refused = 4;
  const auto run = [&](const Case& c) {
    if (refused-- > 0) throw ComputationError("no assembly found");
    return analytic::run(c, c.analytic, samples);
  };
  try {
    study::rounding_spread(the_case, table, {}, run);
    FAIL() << "nothing lost";
  } catch (const study::NoEstimate& none) {
    EXPECT_NE(std::string(none.what()).find("no assembly found"), std::string::npos);
  }
  refused = 3;
  const auto spread = study::rounding_spread(the_case, table, {}, run);
  EXPECT_GT(spread.at("Rs"), 0);
  EXPECT_LT(spread.at("Rs"), 1e-14);
}

// ---- long runs
// -----------------------------------------------------------------------------------

// Two turns of two samples of two groups, the second of which nothing loads.
TEST(LongRun, AGroupThatNothingLoadsIsHeldToTheScaleOfItsUnit) {
  const Case the_case = shipped_case();
  Case idle = study::without_loads(the_case);
  idle.operation.samples_per_revolution = 2;
  const PressureTrace pressure(idle.pressure);
  const Samples samples = sample_case(idle, pressure, 2);
  ResultTable reference = analytic::run(idle, idle.analytic, samples);
  const std::size_t column = reference.find("Rs_1_x2_N");
  const std::string group = reference.channels[column].group;
  for (std::size_t row = 0; row < reference.rows(); ++row)
    for (std::size_t c = 0; c < reference.columns(); ++c)
      if (reference.channels[c].group == group) reference.values[row * reference.columns() + c] = 0;
  const compare::ZeroScales scales = {{"N", 1000}, {"Nm", 10}, {"mm", 1}};
  ResultTable table = reference;
  EXPECT_EQ(study::errors_of_turns(reference, table, scales, 2), (std::vector<double>{0, 0}));
  table.values[2 * table.columns() + column] = 1;
  EXPECT_EQ(study::errors_of_turns(reference, table, scales, 2), (std::vector<double>{0, 1e-3}));
  table.values[column] = std::nan("");
  EXPECT_TRUE(std::isnan(study::errors_of_turns(reference, table, scales, 2)[0]));
}

// What the commands "hardcases", "tradeoff" and the estimates of round-off make of two tables.
TEST(Errors, AMissingValueIsNoAgreement) {
  const Case the_case = shipped_case();
  const Samples samples = sample_case(the_case, PressureTrace(the_case.pressure), 1);
  const ResultTable right = analytic::run(the_case, the_case.analytic, samples);
  const auto losses = [&](const ResultTable& table) {
    return study::largest_of_groups(compare::compare_tables(right, table, {}));
  };
  EXPECT_EQ(losses(right).at("Rcs"), 0);
  EXPECT_EQ(study::achieved_error(the_case, samples, right, right).worst, 0);
  for (const double wrong : {not_computed(), HUGE_VAL}) {
    ResultTable table = right;
    table.values[3 * table.columns() + table.find("Rcs_z4_N")] = wrong;
    table.values[5 * table.columns() + table.find("Rs_2_x2_N")] += 1;
    EXPECT_FALSE(is_computed(losses(table).at("Rcs")));
    EXPECT_GT(losses(table).at("Rs"), 1e-6);
    const study::AchievedError error = study::achieved_error(the_case, samples, right, table);
    EXPECT_FALSE(is_computed(error.rcs));
    EXPECT_FALSE(is_computed(error.worst));
    EXPECT_EQ(error.worst_channel, "Rcs_z4_N");
    EXPECT_GT(error.rs, 1e-6);
    // The scene of one piston leaves it out.
    EXPECT_EQ(study::achieved_error(the_case, samples, right, table, Scene::piston).worst,
              error.rs);
  }
}

TEST(Errors, ALossThatCouldNotBeEstimatedIsWarnedOf) {
  const auto warnings = [](double loss) {
    return study::rounding_warnings({{"Rcs", loss, 0, 30, "d"}});
  };
  EXPECT_THAT(warnings(1e-10), testing::IsEmpty());
  EXPECT_THAT(warnings(2e-9),
              testing::ElementsAre(testing::HasSubstr("Rcs is accurate to 2.0e-09")));
  EXPECT_THAT(warnings(not_computed()),
              testing::ElementsAre(testing::HasSubstr("Rcs is accurate to an unknown share")));
  study::MultibodyLosses lost;
  lost.groups["Rcs"] = not_computed();
  EXPECT_THAT(study::multibody_warnings(shipped_case(), {}, {}, lost),
              testing::ElementsAre(testing::HasSubstr("Rcs an unknown share")));
}

TEST(Paper, SaysWhereAModelHasNoValue) {
  study::PaperStudy s;
  study::DrawnPanel panel;
  panel.curves.resize(2);
  panel.curves[0].other_model = compare::difference(1, 1 + 0x1p-20, 1);
  s.panels = {panel};
  EXPECT_THAT(study::paper_text(s), testing::HasSubstr("differ by up to 9.5e-07 of peak"));
  s.panels[0].curves[1].other_model = compare::difference(1, not_computed(), 1);
  EXPECT_THAT(study::paper_text(s), testing::HasSubstr("differ by up to an unknown share (the "
                                                       "second result has no value) of peak"));
}

// ---- hard cases
// -----------------------------------------------------------------------------------

TEST(HardOutcome, WorstIsTheLargestLossAndNoNumberIsWorse) {
  study::HardOutcome outcome;
  EXPECT_EQ(outcome.worst(), nullptr);
  outcome.groups = {{"a", 1e-6, 1e-6}, {"b", 1e-3, 1e-3}, {"c", 1e-3, 1e-3}, {"d", 1e-4, 1e-4}};
  EXPECT_EQ(outcome.worst()->group, "b");  // the first of equals
  outcome.groups.insert(outcome.groups.begin() + 1, {"nan", std::nan(""), 1});
  EXPECT_EQ(outcome.worst()->group, "nan");
}

TEST(HardOutcome, WorstRatioIsTheFarthestFromOneOfNoticeableLosses) {
  study::HardOutcome outcome;
  outcome.groups = {{"unnoticed", 1e-11, 1e-3}};
  EXPECT_FALSE(outcome.worst_ratio());
  for (const auto& [name, measured] : std::map<std::string, double>{
           {"twice", 2e-6}, {"a tenth", 1e-7}, {"a half", 5e-7}, {"fivefold", 5e-6}})
    outcome.groups.push_back({name, measured, 1e-6});
  EXPECT_NEAR(outcome.worst_ratio().value(), 0.1, 1e-12);
}

// Where the ring touches off B there are no multipliers: refused as input, by that way alone.
TEST(HardCases, ARefusalCountsAsOneWhereItIsExpected) {
  const Scratch scratch;
  const std::filesystem::path& folder = scratch.path();
  std::ifstream shipped(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml");
  std::string text((std::istreambuf_iterator<char>(shipped)), {});
  text.replace(text.find("[piston]\n"), 9, "[piston]\ncontact_mm = 41.5\n");
  const auto at = text.find("samples_per_revolution");
  text.replace(at, text.find('\n', at) - at, "samples_per_revolution = 12");
  std::ofstream(folder / "case.toml") << text;
  const Case the_case = read_case(folder / "case.toml");
  const ResultTable table = analytic::run(the_case, the_case.analytic, one_turn(the_case));
  std::string reference = "theta_deg";
  for (const Channel& c : table.channels)
    if (c.kind == ChannelKind::reaction) reference += "," + c.name;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    reference += "\n" + number_text(table.theta_deg[row]);
    for (std::size_t c = 0; c < table.columns(); ++c)
      if (table.channels[c].kind == ChannelKind::reaction)
        reference += "," + number_text(table.at(row, c));
  }
  std::ofstream(folder / "reference.csv") << reference << "\n";
  using study::HardVerdict;
  for (const bool expected : {true, false}) {
    study::HardCase hard{"ring", "contact", "off B", {}, {}, folder};
    if (expected) hard.refused = {"multibody"};
    const auto outcomes = study::run_hard_case(hard, [](const std::string&) { return Progress(); });
    ASSERT_EQ(outcomes.size(), 3U);
    EXPECT_EQ(outcomes[0].verdict, HardVerdict::as_predicted) << outcomes[0].message;
    EXPECT_EQ(outcomes[1].verdict, expected ? HardVerdict::refused : HardVerdict::wrong);
    EXPECT_THAT(outcomes[1].message, testing::HasSubstr("contact_mm = 41.5"));
    EXPECT_EQ(outcomes[2].verdict, HardVerdict::as_predicted) << outcomes[2].message;
  }
}

TEST(HardCases, TableIsInItsUnits) {
  study::HardCaseStudy study;
  study::HardOutcome outcome;
  outcome.model = "analytic";
  outcome.verdict = study::HardVerdict::as_predicted;
  outcome.groups = {{"Rs", 1e-6, 2e-6}};
  outcome.seconds_per_angle = 12.5e-6;
  study.runs.push_back({{"one", "group", "why", {}, {}, {}}, outcome});
  EXPECT_NE(
      study::hard_cases_csv(study).find("one,analytic,accurate,accurate,Rs,1e-06,2e-06,6.0,12.5\n"),
      std::string::npos)
      << study::hard_cases_csv(study);
}

// ---- One call from a case to a verdict

Case case_named(const std::string& name, int samples) {
  Case the_case = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / name);
  the_case.operation.samples_per_revolution = samples;
  return the_case;
}

TEST(Run, OneCallSolvesTheHydraulicsAndGivesATable) {
  const study::PreparedCase ready = study::prepare(case_named("bap63_rated_hydraulic.toml", 36));
  ASSERT_TRUE(ready.hydraulics);
  for (const study::Model model : study::kModels) {
    const ResultTable table = study::run_turn(ready, model);
    EXPECT_EQ(table.name, to_string(model));
    ASSERT_EQ(table.rows(), 36U);
    const std::size_t pressure = table.find("p_1_bar");
    for (std::size_t row = 0; row < table.rows(); ++row)
      EXPECT_NEAR(table.at(row, pressure), ready.pressure(table.theta_deg[row]) / 1e5, 1e-12);
  }
}

TEST(Run, RefusesOptionsThatContradictEachOther) {
  const study::PreparedCase ready = study::prepare(case_named("bap63_rated.toml", 12));
  study::RunOptions options;
  options.way = study::Way::integrated;
  EXPECT_THROW(study::run(ready, options), InputError);  // the analytic model
  options.model = study::Model::multibody;
  options.scene.scene = Scene::piston;
  EXPECT_THROW(study::run(ready, options), InputError);
  options.scene = {multibody::Scene::full, multibody::Method::residual};
  EXPECT_THROW(study::run(ready, options), InputError);
  study::RunOptions to_error;
  to_error.model = study::Model::multibody;
  to_error.target = study::ErrorTarget{1e-6, {}};
  EXPECT_THROW(study::run(ready, to_error), InputError);  // driven runs have no error to choose
}

TEST(CompareModels, OneCallOnAHydraulicCase) {
  const study::ComparisonResult result =
      study::compare_models(case_named("bap63_rated_hydraulic.toml", 36), {}, {});
  EXPECT_TRUE(result.first.hydraulics);
  EXPECT_TRUE(result.agrees()) << result.headline();
  EXPECT_EQ(result.tolerance, study::kDrivenTolerance);
  EXPECT_EQ(result.comparison.incomplete(), nullptr);
  EXPECT_GT(result.comparison.compared(), 40);
  // One curve for both.
  for (std::size_t row = 0; row < result.analytic.rows(); ++row)
    EXPECT_EQ(result.analytic.at(row, result.analytic.find("p_3_bar")),
              result.multibody.at(row, result.multibody.find("p_3_bar")));
}

TEST(CompareModels, TheLawOfFrictionIsSaid) {
  for (const auto& [regularization, law] :
       std::map<double, std::string>{{0, "Fc sign(v) + cv v"}, {0.02, "Fc tanh(v/v_reg) + cv v"}}) {
    Case the_case = case_named("bap63_rated.toml", 10);
    the_case.pump.friction.regularization = regularization;
    const auto document =
        study::comparison_document(study::compare_models(the_case, the_case, {}), {}, {});
    std::vector<std::string> laws;
    for (const auto& common : document.common.value())
      if (common.input == "law of piston friction") laws.push_back(common.value);
    EXPECT_EQ(laws, std::vector<std::string>{law});
  }
}

TEST(CompareModels, AWrongInputToOneModelIsNoticed) {
  Case wrong = case_named("bap63_rated.toml", 36);
  wrong.pump.geometry.tilt *= 1 + 1e-6;
  const auto result = study::compare_models(case_named("bap63_rated.toml", 36), wrong, {});
  EXPECT_FALSE(result.agrees());
  EXPECT_NE(result.headline().find("differ"), std::string::npos);
  wrong.operation.samples_per_revolution = 72;
  EXPECT_THROW(study::compare_models(case_named("bap63_rated.toml", 36), wrong, {}), InputError);
}

TEST(ReferenceSet, FrameOfTheBlockIsTurnedByTheTilt) {
  const Case the_case = case_named("bap63_rated.toml", 36);
  const double tilt = the_case.pump.geometry.tilt;
  const auto frames = study::frames_of(the_case);
  const auto& shaft = frames.at("S1");
  const auto& block = frames.at("S2");
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      double cosine = 0, between = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        cosine += block[i][k] * block[j][k];
        between += shaft[i][k] * block[j][k];
      }
      EXPECT_NEAR(cosine, i == j, 1e-15);
      const bool about_x = i != 0 && j != 0;
      EXPECT_NEAR(std::abs(between),
                  i == j ? (i == 0 ? 1 : std::cos(tilt)) : about_x * std::sin(tilt), 1e-15);
    }
}

TEST(ReferenceSet, FilesOfACaseAreThoseThatItReads) {
  Case the_case = case_named("bap63_rated.toml", 36);
  EXPECT_TRUE(study::files_of(the_case).empty());
  the_case.pressure.kind = PressureKind::curve;
  the_case.pressure.file = "pressure.csv";
  the_case.hydraulics.emplace().suction.table.file = "opening.csv";
  the_case.drive.emplace();
  EXPECT_EQ(study::files_of(the_case).size(), 2U);
  the_case.drive->curve.file = "speed.csv";
  using Path = std::filesystem::path;
  EXPECT_THAT(
      study::files_of(the_case),
      testing::UnorderedElementsAre(Path("pressure.csv"), Path("opening.csv"), Path("speed.csv")));
  the_case.hydraulics->load.emplace().share.file = "share.csv";
  EXPECT_EQ(study::files_of(the_case).size(), 4U);
  the_case.pump.gear.contact = ToothContact::teeth;
  the_case.pump.gear.teeth.emplace().error_file = "pitch.csv";
  EXPECT_EQ(study::files_of(the_case).size(), 5U);
  the_case.pressure.kind = PressureKind::ideal;
  EXPECT_THAT(study::files_of(the_case), testing::Not(testing::Contains(Path("pressure.csv"))));
}

// Imposed gear, a smaller scene, a film force of zero: absent channels, all of them expected.
TEST(CompareModels, WhatARunIsKnownNotToComputeDoesNotCountAgainstIt) {
  Case the_case = case_named("bap63_rated.toml", 36);
  the_case.analytic.gear = the_case.multibody.gear = BlockDrive::imposed;
  const auto imposed = study::compare_models(the_case, {}, {});
  EXPECT_EQ(imposed.comparison.find("Rcs_z4_N")->verdict, compare::Verdict::not_computed);
  EXPECT_TRUE(imposed.agrees()) << imposed.headline();

  study::ComparisonOptions options;
  options.scene.scene = Scene::piston;
  const auto piston = study::compare_models(case_named("bap63_rated.toml", 35), {}, options);
  EXPECT_EQ(piston.comparison.find("Td_z1_Nm")->verdict, compare::Verdict::not_computed);
  EXPECT_TRUE(piston.agrees()) << piston.headline();

  // Nothing presses the block along its axis: a force of zero, or in one model or both round-off.
  the_case.pump.geometry.tilt = the_case.pump.geometry.axis_offset = 0;
  the_case.pressure.ports = {0, 0};
  the_case.pump.block.spring_force = the_case.pump.friction.piston_coulomb = 0;
  the_case.pump.friction.block_viscous = 0;
  const auto still = study::compare_models(the_case, {}, {});
  EXPECT_EQ(still.comparison.find("xh_x2_mm")->verdict, compare::Verdict::not_computed);
  EXPECT_EQ(still.comparison.incomplete(), nullptr) << still.headline();
  the_case.analytic.gear = the_case.multibody.gear = BlockDrive::mesh;
  the_case.pump.gravity = 0;
  const auto weightless = study::compare_models(the_case, {}, {});
  EXPECT_EQ(weightless.comparison.incomplete(), nullptr) << weightless.headline();
}

TEST(CompareModels, AGapIsNoAgreementWhateverExplainsTheRest) {
  for (const bool unequal : {false, true}) {
    Case the_case = case_named("bap63_rated.toml", 36);
    if (unequal) the_case.multibody.piston_friction = false;
    auto result = study::compare_models(the_case, {}, {});
    EXPECT_TRUE(result.agrees());
    EXPECT_EQ(result.split.has_value(), unequal);
    auto& channel = result.comparison.channels[3];
    channel.verdict = compare::Verdict::incomplete;
    channel.gap = "no value of multibody at 30 deg";
    EXPECT_FALSE(result.agrees());
    EXPECT_EQ(result.headline(), "Agreement of the two models cannot be shown: " + channel.gap +
                                     " of " + channel.channel.name + ".");
  }
}

// Under unequal assumptions the rest is held to 1e-10, unless the user says otherwise.
TEST(CompareModels, AToleranceThatTheUserNamesCountsForTheRestToo) {
  Case the_case = case_named("bap63_rated.toml", 36);
  the_case.multibody.piston_friction = false;
  study::ComparisonOptions options;
  EXPECT_EQ(study::compare_models(the_case, {}, options).split->tolerance,
            study::kDrivenRestTolerance);
  for (const double tolerance : {1e-3, 1e-25}) {
    options.tolerance = tolerance;
    const auto result = study::compare_models(the_case, {}, options);
    EXPECT_EQ(result.split->tolerance, tolerance);
    EXPECT_EQ(result.agrees(), tolerance == 1e-3);
    EXPECT_NE(result.headline().find(tolerance == 1e-3 ? "(tolerance 0.001)" : "(tolerance 1e-25)"),
              std::string::npos);
  }
  // A difference that no assumption explains, between both tolerances.
  Case wrong = the_case;
  wrong.pump.geometry.tilt *= 1 + 1e-6;
  options.tolerance = 1e-3;
  EXPECT_TRUE(study::compare_models(the_case, wrong, options).agrees());
  options.tolerance.reset();
  EXPECT_FALSE(study::compare_models(the_case, wrong, options).agrees());
}

TEST(CompareModels, IntegratedRunsAreTabledAndTheLastIsCompared) {
  study::ComparisonOptions options;
  options.way = study::Way::integrated;
  options.accuracies = {1e-3, 1e-5};
  const auto result = study::compare_models(case_named("bap63_rated.toml", 20), {}, options);
  ASSERT_EQ(result.integrations.size(), 2U);
  EXPECT_GT(result.integrations[0].rs, result.integrations[1].rs);
  EXPECT_EQ(result.tolerance, study::kIntegratedFactor * 1e-5);
  EXPECT_LT(result.integrations[1].torque_driven_speed_error, 1e-5);
  EXPECT_TRUE(result.agrees()) << result.headline();
}

TEST(OperatingPoints, PressureForATorqueIsFoundAgain) {
  Case the_case = case_named("bap63_rated_hydraulic.toml", 36);
  const study::OperatingPoint start = study::run_point(the_case);
  const auto torque = [](const ResultTable& table) { return study::mean(table, "Td_z1_Nm"); };
  the_case.pressure.ports.delivery *= 1.2;
  const study::OperatingPoint wanted = study::run_point(the_case);
  EXPECT_NEAR(study::delivery_pressure_for(start, "torque", torque(wanted.analytic), torque) /
                  the_case.pressure.ports.delivery,
              1, 2e-6);
  EXPECT_THROW(study::delivery_pressure_for(start, "torque", -5, torque), ComputationError);
  EXPECT_THROW(study::run_point(case_named("bap63_rated.toml", 36)), InputError);
}

// In threads, and yet each point is what it is alone; an error or an interruption gets out.
TEST(OperatingPoints, TorqueCurveIsItsPoints) {
  const Case the_case = case_named("bap63_rated_hydraulic.toml", 20);
  const study::TorqueCurve curve = study::torque_curve(the_case, {100, 200, 300});
  for (std::size_t i = 0; i < curve.bar.size(); ++i) {
    Case at = the_case;
    at.pressure.ports.delivery = curve.bar[i] * 1e5;
    const study::OperatingPoint point = study::run_point(at);
    EXPECT_EQ(curve.analytic[i], study::mean(point.analytic, "Td_z1_Nm"));
    EXPECT_EQ(curve.multibody[i], study::mean(point.multibody, "Td_z1_Nm"));
    EXPECT_EQ(curve.flow[i], point.state().summary.flow * 6e4);
  }
  Case slow = the_case;
  slow.operation.speed_rpm = 5;
  EXPECT_THROW(study::torque_curve(slow, {100, 200}), ComputationError);
  EXPECT_THROW(study::torque_curve(the_case, {100, 200, 300}, [](double) { throw Interrupted(); }),
               Interrupted);
}

// From far away to the shipped, calibrated case (docs/hydraulics.md).
TEST(FrictionCalibration, FindsTheParametersOfTwoMeanTorques) {
  Case the_case = case_named("bap63_rated_hydraulic.toml", 720);
  const Friction shipped = the_case.pump.friction;
  the_case.pump.friction.piston_coulomb = 5;
  the_case.pump.friction.shaft_torque_factor = 0.9;
  const auto steps = study::calibrate_friction(the_case, {294.7, 293.4});
  EXPECT_EQ(steps.front().piston_coulomb, 5);
  EXPECT_GT(std::abs(steps.front().torques.with_friction - 294.7), 1);
  EXPECT_NEAR(steps.back().torques.with_friction, 294.7, 1e-3);
  EXPECT_NEAR(steps.back().torques.without_friction, 293.4, 1e-3);
  EXPECT_NEAR(steps.back().piston_coulomb, shipped.piston_coulomb, 0.01);
  EXPECT_NEAR(steps.back().torque_factor, shipped.shaft_torque_factor, 1e-5);
  EXPECT_THROW(study::calibrate_friction(the_case, {100, 99}), InputError);  // a factor above 1
  the_case.pump.friction.piston_coulomb = 0;
  EXPECT_THROW(study::calibrate_friction(the_case, {294.7, 293.4}), InputError);
}

// The table of docs/shaft_to_block_torque.md.
TEST(BlockTorque, RowsAreThoseOfTheDocument) {
  std::ifstream in(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "docs" /
                   "shaft_to_block_torque.md");
  const std::string document((std::istreambuf_iterator<char>(in)), {});
  const auto rows = study::block_torques(case_named("bap63_rated.toml", 720),
                                         case_named("bap63_rated_hydraulic.toml", 720));
  EXPECT_EQ(rows.size(), 18U);
  EXPECT_NE(document.find(study::block_torque_text(rows)), std::string::npos)
      << study::block_torque_text(rows);
}

// Runs to three steps with an error of exactly the power p of the step.
std::vector<study::TradeoffRun> runs_of_order(double p) {
  std::vector<study::TradeoffRun> runs;
  for (const int steps : {100, 200, 400}) {
    study::TradeoffRun run;
    run.method = "integrated";
    run.variant = "any";
    run.error.worst = std::pow(10.0 / steps, p) * 1e-2;
    run.record.emplace().steps = steps;
    runs.push_back(std::move(run));
  }
  return runs;
}

TEST(Calibration, WhatItChoosesHasHalfTheErrorAskedFor) {
  const Case the_case = case_named("bap63_rated.toml", 36);
  const PressureTrace pressure(the_case.pressure);
  for (const double asked : {1e-3, 1e-7}) {
    const auto found =
        study::calibrate(the_case, the_case.multibody, pressure, asked,
                         {multibody::Integrator::runge_kutta_merson}, study::silent());
    EXPECT_LE(found.error_in_trial, asked / 2);
    EXPECT_GT(found.error_in_trial, 0);
  }
}

study::TradeoffRun integrated(double accuracy, double seconds, double error) {
  study::TradeoffRun run;
  run.model = "multibody";
  run.method = "integrated";
  run.variant = "rk3";
  run.accuracy = accuracy;
  run.seconds_per_turn = seconds;
  run.error.worst = error;
  run.record.emplace();
  return run;
}

TEST(Tradeoff, TheFastestThatIsGoodEnough) {
  std::vector<study::TradeoffRun> runs = {integrated(1e-3, 1, 1e-2), integrated(1e-4, 4, 1e-4),
                                          integrated(1e-5, 2, 1e-3), integrated(1e-6, 3, 1e-6)};
  runs.push_back(integrated(1e-7, 0.1, 1e-9));
  runs.back().failure = "stopped";
  runs.push_back(integrated(0, 0.01, 1e-15));
  runs.back().method = "driven";
  EXPECT_EQ(study::fastest_within(runs, 1e-2), &runs[0]);
  EXPECT_EQ(study::fastest_within(runs, 1e-3), &runs[2]);
  EXPECT_EQ(study::fastest_within(runs, 1e-4), &runs[3]);
  EXPECT_EQ(study::fastest_within(runs, 1e-8), nullptr);
}

// Error over time holds every run and the front; over accuracy, the runs that have one.
TEST(Tradeoff, FiguresHoldTheRunsThatAreDone) {
  study::TradeoffStudy study{shipped_case(), {}, {{"smooth", {}}}};
  auto& runs = study.pressures.front().runs;
  runs = {integrated(1e-3, 1, 1e-2), integrated(1e-5, 2, 1e-3), integrated(1e-7, 9, 0)};
  runs.back().failure = "stopped";
  study::TradeoffRun driven;
  driven.model = "multibody";
  driven.method = "driven";
  driven.variant = "full";
  runs.push_back(driven);
  const auto document = study::tradeoff_document(study, {}, {});
  const auto series = [&](std::size_t figure) {
    std::map<std::string, std::size_t> points;
    for (const auto& s :
         std::get<report::ScatterFigure>(document.figures->at(figure).content).series)
      points[s.name] = s.points.size();
    return points;
  };
  using Points = std::map<std::string, std::size_t>;
  EXPECT_EQ(
      series(0),
      (Points{{"rk3", 2}, {"multibody driven full", 1}, {"front of the integrated runs", 2}}));
  EXPECT_EQ(series(1), (Points{{"rk3", 2}}));
}

TEST(Memory, WhatDoesNotFitIsRefusedWithWhatIsNeededAndAvailable) {
  EXPECT_EQ(refusal([] { study::require_memory(4e9, "samples = 9", "lower samples", 4e9); }),
            "accepted");
  EXPECT_EQ(
      refusal([] { study::require_memory(4.1e9, "samples = 9", "lower samples", 4e9); }),
      "samples = 9: about 4.1 GB of memory are needed, and 4 GB are available; lower samples");
}

class SystemFolders : public testing::Test {
 protected:
  void SetUp() override { write("proc/meminfo", "MemTotal: 99 kB\nMemAvailable: 8000000 kB\n"); }
  void TearDown() override { std::filesystem::remove_all(root_); }
  void write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  void group(const std::string& folder, const std::string& limit, const std::string& used) const {
    write("sys/fs/cgroup/" + folder + "/memory.max", limit + "\n");
    write("sys/fs/cgroup/" + folder + "/memory.current", used + "\n");
  }
  double available() const { return study::available_memory(root_); }

  const std::filesystem::path root_ =
      std::filesystem::temp_directory_path() / ("system_" + std::to_string(getpid()));
};

TEST_F(SystemFolders, TheMachinesMemoryIsAvailable) { EXPECT_EQ(available(), 8192e6); }

TEST_F(SystemFolders, EveryControlGroupAboveLimits) {
  write("proc/self/cgroup", "0::/slurm/job_1/step_0\n");
  group("slurm/job_1/step_0", "max", "3000");
  EXPECT_EQ(available(), 8192e6);
  group("slurm/job_1", "1000000000", "250000000");
  EXPECT_EQ(available(), 750e6);
  // Of files that the group holds it can give up those that nobody uses.
  write("sys/fs/cgroup/slurm/job_1/memory.stat", "anon 7\ninactive_file 50000000\n");
  EXPECT_EQ(available(), 800e6);
  group("slurm/job_1/step_0", "500000000", "600000000");
  EXPECT_EQ(available(), 0);
}

// In a container the path is that of the host, and the group's files lie at the top.
TEST_F(SystemFolders, AContainersControlGroupLimits) {
  write("proc/self/cgroup", "0::/docker/0123\n");
  group("", "1000000000", "250000000");
  EXPECT_EQ(available(), 750e6);
  write("proc/self/cgroup", "0::/\n");
  EXPECT_EQ(available(), 750e6);
}

TEST_F(SystemFolders, ControlGroupsOfTheFirstVersionLimit) {
  write("proc/self/cgroup", "5:cpuset:/\n4:memory,hugetlb:/batch/job\n0::/\n");
  const std::string job = "sys/fs/cgroup/memory/batch/job/";
  write(job + "memory.limit_in_bytes", "2000000000\n");
  write(job + "memory.usage_in_bytes", "500000000\n");
  write(job + "memory.stat", "inactive_file 7\ntotal_inactive_file 100000000\n");
  EXPECT_EQ(available(), 1600e6);
  write("sys/fs/cgroup/memory/batch/memory.limit_in_bytes", "1000000000\n");
  write("sys/fs/cgroup/memory/batch/memory.usage_in_bytes", "900000000\n");
  EXPECT_EQ(available(), 100e6);
  write("proc/self/cgroup", "5:cpuset:/batch/job\n");  // memory is not among what it limits
  EXPECT_EQ(available(), 8192e6);
}

// The limit of the address space counts, less what the process has of it already.
TEST(Memory, IsThatOfTheProcess) {
  const double before = study::available_memory();
  EXPECT_GT(before, 1e7);
  EXPECT_LT(before, 1e15);
  rlimit former{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &former), 0);
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const double taken = pages * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  rlimit limit = former;
  limit.rlim_cur = static_cast<rlim_t>(taken) + (1 << 26);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
  const double left = study::available_memory();
  Case large = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated.toml");
  const auto refused = [&](int samples, study::Kept kept) {
    large.operation.samples_per_revolution = samples;
    return refusal([&] { study::require_memory(large, kept, study::Way::driven); });
  };
  const std::string little = refused(2000, study::Kept::compared);
  const std::string compared = refused(40000, study::Kept::compared);
  const std::string table = refused(10000, study::Kept::table);
  setrlimit(RLIMIT_AS, &former);
  EXPECT_NEAR(left, 1 << 26, 2e6);
  EXPECT_EQ(little, "accepted");
  EXPECT_EQ(table, "accepted");
  EXPECT_THAT(compared, testing::AllOf(testing::HasSubstr("samples_per_revolution = 40000: "),
                                       testing::HasSubstr("lower samples_per_revolution")));
}

TEST(Tradeoff, AnOrderOutsideThatOfItsMethodIsMarked) {
  using multibody::Integrator;
  EXPECT_EQ(multibody::method_orders(Integrator::runge_kutta_merson), std::pair(4, 4));
  EXPECT_EQ(multibody::method_orders(Integrator::verlet), std::pair(2, 3));
  EXPECT_EQ(multibody::method_orders(Integrator::cpodes), std::pair(1, 5));
  const auto marked = [](double p, std::pair<int, int> theory) {
    return study::outside_theory(study::order_of(runs_of_order(p), "any"), theory);
  };
  for (const double p : {3.6, 4.0, 4.4}) EXPECT_EQ(marked(p, {4, 4}), "") << p;
  EXPECT_EQ(marked(3.4, {4, 4}), "last pair below and least squares below");
  EXPECT_EQ(marked(5.6, {1, 5}), "last pair above and least squares above");
  EXPECT_EQ(marked(2.2, {2, 3}), "");
  EXPECT_EQ(study::outside_theory({"any", 1, {}, {}}, {4, 4}), "") << "nothing was found";
  EXPECT_EQ(study::outside_theory({"any", 2, 7.0, 4.0}, {4, 4}), "last pair above");
}

// The name of version 1.0.0.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
TEST(ParallelFor, HasItsOldName) {
  std::atomic<int> calls{0};
  study::in_threads(2, 20, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 20);
}
#pragma GCC diagnostic pop

}  // namespace
}  // namespace bentaxis::test
