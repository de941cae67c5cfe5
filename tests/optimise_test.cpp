// Optima of pumps that are known from elsewhere, and what a search keeps and refuses.
#include "bentaxis/designs/optimise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <barrier>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "bentaxis/designs/evaluator.h"
#include "bentaxis/designs/pareto.h"
#include "bentaxis/designs/robust.h"
#include "bentaxis/designs/uncertainty.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "support.h"

namespace bentaxis::designs {
namespace {

namespace fs = std::filesystem;
using test::refusal;
using testing::ElementsAre;
using testing::HasSubstr;

Case shipped(const std::string& name, std::vector<std::string> changes = {}) {
  changes.emplace_back("operation.samples_per_revolution=36");
  return read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/" + name + ".toml", changes);
}
Case rated() { return shipped("bap63_rated"); }

OptimiseRequest small(const std::vector<std::pair<std::string, std::string>>& vary) {
  OptimiseRequest request;
  request.vary = vary;
  request.search = {.population = 16, .generations = 12, .restarts = 2};
  return request;
}

Optimisation run(const Case& base, const OptimiseRequest& request, const OptimiseWork& work = {}) {
  return Optimiser(base, optimise_plan(request, base)).run(work, {});
}

double result(const Optimisation& found, std::size_t design, std::size_t output) {
  return found.designs.results[design * found.plan.designs.outputs.size() + output];
}
double value(const Optimisation& found, std::size_t design, std::size_t variable) {
  return found.designs.values[design * found.plan.designs.varied.size() + variable];
}

// ISO 281 of a tapered bearing at C1 and a cylindrical one at C2, from the loads of another place:
// their sum T and their moment N about the origin stay, R1 = (N - z2 T) / (z1 - z2).
class BearingPlace {
 public:
  explicit BearingPlace(const Case& base) : z1_(base.pump.bearings.tapered_z) {
    const ResultTable table = study::run(study::prepare(base), {}).table;
    z2_ = base.pump.bearings.cylindrical_z;
    ratings_ = base.ratings;
    for (std::size_t row = 0; row < table.rows(); ++row)
      for (const char* name : {"Rb1_x1_N", "Rb1_y1_N", "Rb1_z1_N", "Rb2_x1_N", "Rb2_y1_N"})
        forces_.push_back(table.at(row, table.find(name)));
  }
  // h, at a speed
  double system_life(double z1, double rpm) const {
    constexpr double kExponent = 10.0 / 3, kWeibull = 9.0 / 8;
    double first = 0, second = 0;
    const auto rows = static_cast<double>(forces_.size()) / 5;
    for (std::size_t i = 0; i < forces_.size(); i += 5) {
      double r1 = 0, r2 = 0;
      for (std::size_t k = 0; k < 2; ++k) {
        const double a = forces_[i + k], b = forces_[i + 3 + k];
        const double sum = a + b, moment = z1_ * a + z2_ * b;
        r1 = std::hypot(r1, (moment - z2_ * sum) / (z1 - z2_));
        r2 = std::hypot(r2, (z1 * sum - moment) / (z1 - z2_));
      }
      const double axial = std::abs(forces_[i + 2]);
      const auto& tapered = *ratings_.tapered;
      const double p1 = axial <= tapered.ratio_limit * r1
                            ? r1
                            : std::max(r1, 0.4 * r1 + tapered.axial_factor * axial);
      first += std::pow(p1, kExponent) / rows;
      second += std::pow(r2, kExponent) / rows;
    }
    const auto hours = [&](double rating, double mean) {
      return std::pow(rating, kExponent) / mean * 1e6 / 60 / rpm;
    };
    const double tapered = hours(ratings_.tapered->dynamic_rating, first);
    const double cylindrical = hours(ratings_.cylindrical->dynamic_rating, second);
    return std::pow(std::pow(tapered, -kWeibull) + std::pow(cylindrical, -kWeibull), -1 / kWeibull);
  }

 private:
  double z1_ = 0, z2_ = 0;
  BearingRatings ratings_;
  std::vector<double> forces_;
};

TEST(OptimiseTest, FindsThePlaceOfTheBearingThatLivesLongest) {
  const Case base = shipped("bap63_bearing_life", {"pressure.kind=ideal"});
  const BearingPlace place(base);
  const double rpm = base.operation.speed_rpm;
  const Evaluator own(Family(base, {Variable("bearings.tapered_z_mm", base)}),
                      {output("life.system_h", base)});
  for (const double z : {-26.0, -10.0, 15.0})
    EXPECT_NEAR(place.system_life(z * 1e-3, rpm) / own.outputs_at(std::vector<double>{z})[0], 1,
                1e-9)
        << z;
  // Far from where a shaft could have it: what counts is that both find the same place.
  double best = -60e-3;
  for (double z = -60e-3; z <= 300e-3; z += 2e-6)
    if (place.system_life(z, rpm) > place.system_life(best, rpm)) best = z;
  ASSERT_GT(best, -59e-3);
  ASSERT_LT(best, 299e-3);

  OptimiseRequest request = small({{"bearings.tapered_z_mm", "-60:300"}});
  request.maximise = {"life.system_h"};
  const Optimisation found = run(base, request);
  ASSERT_EQ(found.chosen.size(), 1U);
  const std::size_t design = found.chosen[0].design;
  EXPECT_NEAR(result(found, design, 0) / place.system_life(best, rpm), 1, 1e-6);
  EXPECT_NEAR(value(found, design, 0), best * 1e3, 0.05);
  EXPECT_GT(result(found, design, 0), found.own.values[0]);
}

// Displacement grows with the tilt: the least tilt that gives 50 cm3 is where it is 50 cm3.
TEST(OptimiseTest, EndsOnAConstraint) {
  OptimiseRequest request = small({{"pump.tilt_deg", "10:42"}});
  request.minimise = {"pump.tilt_deg"};
  EXPECT_THAT(refusal([&] { run(rated(), request); }), HasSubstr("pump.tilt_deg"));
  request.minimise = {"peak:Rb1"};
  request.subject_to = {"displacement_cm3 >= 50"};
  const Optimisation found = run(rated(), request);
  ASSERT_EQ(found.chosen.size(), 1U);
  const std::size_t design = found.chosen[0].design;
  EXPECT_NEAR(result(found, design, 1), 50, 1e-4);
  EXPECT_GE(result(found, design, 1), 50);
  EXPECT_EQ(found.plan.text(found.plan.constraints[0]), "displacement_cm3 >= 50 cm3");
  std::size_t violating = 0;
  for (std::size_t i = 0; i < found.evaluated(); ++i) {
    const double measured = found.measured[2 * i + 1];
    EXPECT_EQ(found.violations[i] > 0, measured < 50);
    EXPECT_EQ(std::isnan(result(found, i, 0)), measured < 50);
    violating += measured < 50 ? 1 : 0;
  }
  EXPECT_GT(violating, 0U);
  EXPECT_EQ(found.designs.infeasible.size(), violating);
  EXPECT_THAT(found.designs.infeasible[0].second,
              HasSubstr("displacement_cm3 >= 50 cm3: missed by"));
}

TEST(OptimiseTest, ChoosesTheEndsOfTheFrontAndItsMiddle) {
  OptimiseRequest request = small({{"pump.tilt_deg", "20:42"}, {"pump.bore_diameter_mm", "18:26"}});
  request.minimise = {"peak:Rb1"};
  request.maximise = {"displacement_cm3"};
  const Optimisation found = run(rated(), request);
  ASSERT_EQ(found.chosen.size(), 3U);
  EXPECT_EQ(found.chosen[0].why, "lowest peak:Rb1");
  EXPECT_EQ(found.chosen[1].why, "largest displacement_cm3");
  EXPECT_EQ(found.chosen[2].why, "balanced");
  const auto& outputs = found.plan.designs.outputs;
  ASSERT_EQ(outputs[0].name, "peak:Rb1");
  EXPECT_LT(result(found, found.chosen[0].design, 0), result(found, found.chosen[2].design, 0));
  EXPECT_LT(result(found, found.chosen[2].design, 1), result(found, found.chosen[1].design, 1));
  for (const auto& [why, design] : found.chosen) {
    const Case chosen = case_of(found, design);
    const Evaluator own(Family(chosen, {}), outputs);
    EXPECT_EQ(own.outputs_at({})[0], result(found, design, 0)) << why;
  }
  ASSERT_EQ(found.shares_of_front.size(), 2U);
  for (const double share : found.shares_of_front) {
    EXPECT_GT(share, 0.9);
    EXPECT_LE(share, 1 + 1e-12);
  }
}

TEST(OptimiseTest, ListsAndWholeNumbersAreTakenAsTheyAre) {
  OptimiseRequest request = small(
      {{"piston.inertia", "lumped,real"}, {"pump.pistons", "5:9"}, {"pump.tilt_deg", "20,30,35"}});
  request.minimise = {"peak:Rb1"};
  request.outputs = {"displacement_cm3"};
  const Optimisation found = run(rated(), request);
  for (std::size_t i = 0; i < found.evaluated(); ++i) {
    EXPECT_EQ(value(found, i, 1), std::round(value(found, i, 1)));
    EXPECT_TRUE(value(found, i, 2) == 20 || value(found, i, 2) == 30 || value(found, i, 2) == 35);
  }
  // Every combination, one by one.
  double least = INFINITY;
  const Evaluator all(
      found.designs.plan.varied.empty()
          ? Family(rated(), {})
          : Family(rated(), {Variable("piston.inertia", rated()), Variable("pump.pistons", rated()),
                             Variable("pump.tilt_deg", rated())}),
      {output("peak:Rb1", rated())});
  for (const double inertia : {0.0, 1.0})
    for (const double pistons : {5.0, 6.0, 7.0, 8.0, 9.0})
      for (const double tilt : {20.0, 30.0, 35.0}) {
        const Evaluation one = all.evaluate(std::vector<double>{inertia, pistons, tilt});
        if (one.feasible()) least = std::min(least, one.values[0]);
      }
  ASSERT_EQ(found.chosen.size(), 1U);
  EXPECT_EQ(result(found, found.chosen[0].design, 0), least);
}

TEST(OptimiseTest, SaysThatNoDesignIsFeasible) {
  OptimiseRequest request = small({{"pump.tilt_deg", "10:42"}});
  request.minimise = {"peak:Rb1"};
  request.subject_to = {"displacement_cm3 >= 500"};
  const Optimisation found = run(rated(), request);
  EXPECT_TRUE(found.chosen.empty());
  EXPECT_EQ(found.feasible(), 0U);
  EXPECT_TRUE(found.shares_of_front.empty());
  // Joints beyond the bores' reach: no design has values.
  OptimiseRequest broken = small({{"pump.piston_length_mm", "1:2"}});
  broken.minimise = {"peak:Rb1"};
  EXPECT_THROW(run(rated(), broken), ComputationError);
}

TEST(OptimiseTest, ConditionsAreWeighedAndConstraintsHoldAtEach) {
  const fs::path file =
      fs::temp_directory_path() / ("bentaxis_conditions_" + std::to_string(getpid()) + ".csv");
  std::ofstream(file) << "share,speed_rpm,delivery_bar\n3,1500,275\n1,2500,100\n";
  OptimiseRequest request = small({{"pump.tilt_deg", "20:42"}});
  request.search.generations = 2;
  request.minimise = {"peak:Rb1"};
  request.subject_to = {"max:Td <= 400"};
  request.conditions = file;
  const Case base = rated();
  const Optimisation found = run(base, request);
  const std::vector<Output> outputs = {output("peak:Rb1", base), output("max:Td", base)};
  const Evaluator single(
      Family(base, {Variable("pump.tilt_deg", base), Variable("operation.speed_rpm", base),
                    Variable("pressure.delivery_bar", base)}),
      outputs);
  for (const std::size_t design : {std::size_t{0}, std::size_t{5}, std::size_t{20}}) {
    const double tilt = value(found, design, 0);
    const auto first = single.outputs_at(std::vector<double>{tilt, 1500, 275});
    const auto second = single.outputs_at(std::vector<double>{tilt, 2500, 100});
    EXPECT_DOUBLE_EQ(found.measured[2 * design], (3 * first[0] + second[0]) / 4);
    EXPECT_DOUBLE_EQ(found.measured[2 * design + 1], std::max(first[1], second[1]));
  }
  // One operating point alone.
  request.minimise = {"peak:Rb1@2"};
  request.subject_to = {"max:Td@1 <= 300"};
  const Optimisation second_row = run(base, request);
  EXPECT_EQ(second_row.plan.designs.outputs[0].name, "peak:Rb1@2");
  for (const std::size_t design : {std::size_t{0}, std::size_t{7}}) {
    const double tilt = value(second_row, design, 0);
    EXPECT_EQ(second_row.measured[2 * design],
              single.outputs_at(std::vector<double>{tilt, 2500, 100})[0]);
    EXPECT_EQ(second_row.measured[2 * design + 1],
              single.outputs_at(std::vector<double>{tilt, 1500, 275})[1]);
    EXPECT_EQ(second_row.violations[design] > 0, second_row.measured[2 * design + 1] > 300);
  }
  for (const char* row : {"0", "3", "1.5", "x", ""}) {
    request.minimise = {std::string("peak:Rb1@") + row};
    EXPECT_THAT(refusal([&] { optimise_plan(request, base); }), HasSubstr("1 to 2")) << row;
  }
  request.minimise = {"peak:Rb1"};
  request.vary = {{"operation.speed_rpm", "1000:2000"}};
  EXPECT_THAT(refusal([&] { optimise_plan(request, base); }),
              HasSubstr("--vary operation.speed_rpm"));
  fs::remove(file);
}

TEST(OptimiseTest, RefusesWhatCannotBeMeant) {
  const Case base = rated();
  const auto plan = [&](const std::function<void(OptimiseRequest&)>& change) {
    OptimiseRequest request = small({{"pump.tilt_deg", "20:42"}});
    request.minimise = {"peak:Rb1"};
    change(request);
    return refusal([&] { run(base, request); });
  };
  EXPECT_THAT(plan([](auto& r) { r.minimise.clear(); }), HasSubstr("--minimise"));
  EXPECT_THAT(plan([](auto& r) { r.subject_to = {"peak:Rb1 < 3"}; }), HasSubstr("peak:Rb1 < 3"));
  EXPECT_THAT(plan([](auto& r) { r.subject_to = {"peak:Rb1 <= much"}; }), HasSubstr("much"));
  EXPECT_THAT(plan([](auto& r) { r.subject_to = {"peak:Rb1 <= inf"}; }), HasSubstr("inf"));
  EXPECT_THAT(plan([](auto& r) { r.minimise = {"peak:Rb1@1"}; }),
              HasSubstr("--conditions, which is not given"));
  EXPECT_THAT(plan([](auto& r) { r.subject_to = {"peak:Rbx <= 1"}; }), HasSubstr("Rbx"));
  EXPECT_THAT(plan([](auto& r) {
                r.vary = {{"pump.tilt_deg", "normal(40,1)"}};
              }),
              HasSubstr("FROM:TO"));
  EXPECT_THAT(plan([](auto& r) { r.vary = {{"pump.tilt_deg", "40"}}; }), HasSubstr("two values"));
  EXPECT_THAT(plan([](auto& r) { r.search.population = 10; }), HasSubstr("multiple of 4"));
  EXPECT_THAT(plan([](auto& r) { r.maximise = {"peak:Rb1"}; }), HasSubstr("both"));
}

class FolderTest : public testing::Test {
 protected:
  FolderTest() { fs::remove_all(path); }
  ~FolderTest() override { fs::remove_all(path); }
  const fs::path path =
      fs::temp_directory_path() / ("bentaxis_optimise_" + std::to_string(getpid()));
};

OptimiseRequest front_request() {
  OptimiseRequest request = small({{"pump.tilt_deg", "20:42"}, {"pump.bore_diameter_mm", "18:26"}});
  request.minimise = {"peak:Rb1"};
  request.maximise = {"displacement_cm3"};
  return request;
}

TEST_F(FolderTest, AnInterruptedRunGoesOn) {
  const Case base = rated();
  const Optimiser optimiser(base, optimise_plan(front_request(), base));
  const Optimisation whole = optimiser.run({}, {});
  const SweepParts parts(path, optimiser.record("test"));
  OptimiseWork work;
  work.parts = &parts;
  {
    const RunLock lock = parts.begin();
    struct Stop {};
    EXPECT_THROW(optimiser.run(work,
                               [](double part) {
                                 if (part > 0.4) throw Stop();
                               }),
                 Stop);
  }
  const std::size_t kept = parts.count();
  EXPECT_GT(kept, 0U);
  EXPECT_LT(kept, optimiser.batches());
  work.resume = true;
  const RunLock lock = parts.begin();
  const Optimisation resumed = optimiser.run(work, {});
  EXPECT_EQ(resumed.kept, kept);
  EXPECT_EQ(resumed.designs.values, whole.designs.values);
  EXPECT_EQ(evaluations_csv(resumed), evaluations_csv(whole));
  EXPECT_EQ(optimiser.run(work, {}).kept, optimiser.batches());
  // What was damaged is computed again.
  fs::resize_file(path / "block-000003.bin", 100);
  EXPECT_EQ(optimiser.run(work, {}).kept, optimiser.batches() - 1);
}

TEST_F(FolderTest, AnotherStudyIsRefused) {
  const Case base = rated();
  const auto parts_of = [&](const std::function<void(OptimiseRequest&)>& change) {
    OptimiseRequest request = front_request();
    change(request);
    return SweepParts(path, Optimiser(base, optimise_plan(request, base)).record("test"));
  };
  {
    const RunLock lock = parts_of([](auto&) {}).begin();
  }
  {
    const RunLock lock = parts_of([](auto&) {}).begin();
  }
  const std::vector<std::function<void(OptimiseRequest&)>> changes = {
      [](auto& r) { r.subject_to = {"peak:Rb1 <= 50000"}; },
      [](auto& r) { r.search.seed = 2; },
      [](auto& r) { r.search.population = 20; },
      [](auto& r) { r.vary[0].second = "20:41"; },
      [](auto& r) {
        r.maximise = {"displacement_cm3", "peak:Td"};
      },
      [](auto& r) { std::swap(r.minimise, r.maximise); }};
  for (const auto& change : changes)
    EXPECT_THAT(refusal([&] { parts_of(change).begin(); }), HasSubstr("another case or plan"));
}

TEST_F(FolderTest, ThreadsAndProcessesChangeNothing) {
  const Case base = rated();
  const Optimiser optimiser(base, optimise_plan(front_request(), base));
  const std::string alone = evaluations_csv(optimiser.run({.threads = 1}, {}));
  EXPECT_EQ(evaluations_csv(optimiser.run({.threads = 3}, {})), alone);
  // Two processes: each computes every second piece, the numbers of both are added.
  std::barrier meeting(2);
  std::array<std::span<double>, 2> both;
  std::array<std::string, 2> found;
  const auto process = [&](std::size_t rank) {
    OptimiseWork work;
    work.threads = 1;
    work.rank = rank;
    work.ranks = 2;
    work.sum = [&, rank](std::span<double> numbers) {
      both[rank] = numbers;
      meeting.arrive_and_wait();
      if (rank == 0)
        for (std::size_t i = 0; i < numbers.size(); ++i)
          both[0][i] = both[1][i] = both[0][i] + both[1][i];
      meeting.arrive_and_wait();
    };
    found[rank] = front_csv(optimiser.run(work, {}));
  };
  std::thread second(process, 1);
  process(0);
  second.join();
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], front_csv(optimiser.run({}, {})));
}

// ---- Quantiles under [uncertainty]

constexpr double kBoreDeviation = 0.05;          // mm
constexpr double kScore95 = 1.6448536269514722;  // of a standard normal number

Case uncertain_bore() {
  Case base = rated();
  base.uncertainty.parameters = {{"pump.bore_diameter_mm", "normal(0.05)"}};
  return base;
}

// The displacement goes with the square of the bore: where it is so large.
double bore_of(double displacement, const Case& base) {
  const Evaluator own(Family(base, {}), {output("displacement_cm3", base)});
  return Variable("pump.bore_diameter_mm", base).value(base) *
         std::sqrt(displacement / own.outputs_at({})[0]);
}

TEST(QuantileEvaluatorTest, IsTheQuantileOfANormalDistribution) {
  const Case base = uncertain_bore();
  const double bore = Variable("pump.bore_diameter_mm", base).value(base);
  constexpr std::size_t kSamples = 20000;
  for (const auto& [share, score] :
       {std::pair{0.95, kScore95}, {0.5, 0.0}, {0.05, -kScore95}, {0.8, 0.8416212335729143}}) {
    const QuantileEvaluator of(base, {}, {{output("displacement_cm3", base), share}}, kSamples, 1,
                               study::Model::analytic);
    std::vector<double> found(1);
    ASSERT_EQ(of.evaluate({}, found), "");
    // Four standard errors of a quantile: sqrt(share (1 - share) / samples) over the density.
    const double density = std::exp(-score * score / 2) / std::sqrt(2 * kPi);
    const double allowed = 4 * std::sqrt(share * (1 - share) / kSamples) / density;
    EXPECT_NEAR((bore_of(found[0], base) - bore) / kBoreDeviation, score, allowed) << share;
  }
}

TEST(QuantileEvaluatorTest, IsWhatUncertaintyStates) {
  const Case base = uncertain_bore();
  const std::vector<Output> outputs = {output("peak:Rb1", base), output("displacement_cm3", base)};
  const UncertaintyResult stated = uncertainty(
      base, {.outputs = outputs, .samples = 200, .seed = 3, .level = 0.9, .curves = false});
  OptimiseRequest request = small({{"pump.tilt_deg", "20:42"}});
  request.minimise = {"q95:peak:Rb1"};
  request.outputs = {"q5:displacement_cm3", "displacement_cm3"};
  request.samples = 200;
  request.search.seed = 3;
  request.search.generations = 0;
  const Optimisation found = run(base, request);
  EXPECT_EQ(found.plan.designs.outputs[0].name, "q95:peak:Rb1");
  EXPECT_NEAR(found.own.values[0] / stated.outputs[0].spread.high.value, 1, 1e-12);
  EXPECT_NEAR(found.own.values[1] / stated.outputs[1].spread.low.value, 1, 1e-12);
  EXPECT_NEAR(found.own.values[2] / stated.outputs[1].nominal, 1, 1e-12);
}

// The largest bore of whose pumps 95 % stay below a displacement lies 1.645 standard deviations
// below the bore that has it.
TEST(OptimiseTest, AQuantileAsConstraintKeepsTheDistanceOfItsScore) {
  const Case base = uncertain_bore();
  OptimiseRequest request = small({{"pump.bore_diameter_mm", "18:26"}});
  request.maximise = {"displacement_cm3"};
  request.subject_to = {"q95:displacement_cm3 <= 60"};
  request.samples = 400;
  const Optimisation found = run(base, request);
  ASSERT_EQ(found.chosen.size(), 1U);
  const double bore = value(found, found.chosen[0].design, 0);
  const double margin = (bore_of(60, base) - bore) / kBoreDeviation;
  const double density = std::exp(-kScore95 * kScore95 / 2) / std::sqrt(2 * kPi);
  EXPECT_NEAR(margin, kScore95, 4 * std::sqrt(0.95 * 0.05 / 400) / density);
  // The same random numbers for all designs: a sample's own score to the digit.
  std::vector<double> own(1);
  const QuantileEvaluator of(base, {}, {{output("displacement_cm3", base), 0.95}}, 400, 1,
                             study::Model::analytic);
  ASSERT_EQ(of.evaluate({}, own), "");
  const double case_bore = Variable("pump.bore_diameter_mm", base).value(base);
  EXPECT_NEAR(margin, (bore_of(own[0], base) - case_bore) / kBoreDeviation, 1e-3);
  // Without uncertainty the bore itself.
  request.subject_to = {"displacement_cm3 <= 60"};
  const Optimisation sharp = run(base, request);
  EXPECT_NEAR(value(sharp, sharp.chosen.at(0).design, 0), bore_of(60, base), 1e-4);
}

TEST(OptimiseTest, QuantilesThatCannotBeAreRefused) {
  const Case base = uncertain_bore();
  const auto of = [](const Case& the_case, const std::string& name, std::size_t samples = 100) {
    OptimiseRequest request = small({{"pump.bore_diameter_mm", "20:26"}});
    request.search.generations = 0;
    request.minimise = {name};
    request.samples = samples;
    return refusal([&] { run(the_case, request); });
  };
  EXPECT_EQ(of(base, "q95:peak:Rb1"), "accepted");
  EXPECT_THAT(of(rated(), "q95:peak:Rb1"), HasSubstr("needs [uncertainty]"));
  for (const char* share : {"q0:peak:Rb1", "q100:peak:Rb1", "q-5:peak:Rb1"})
    EXPECT_THAT(of(base, share), HasSubstr("above 0 and below 100")) << share;
  EXPECT_THAT(of(base, "q:peak:Rb1"), HasSubstr("no statistic q"));
  EXPECT_THAT(of(base, "q95:peak:Rbx"), HasSubstr("Rbx"));
  EXPECT_THAT(of(base, "q95:peak:Rb1", 20), HasSubstr("--samples 20"));
  Case fixed = base;
  fixed.uncertainty.parameters[0].distribution = "normal(22.5, 0.05)";
  EXPECT_THAT(of(fixed, "q95:peak:Rb1"), HasSubstr("does not follow its value"));
}

TEST(OptimiseTest, ASampleWithoutValuesTakesTheDesignsQuantile) {
  Case base = rated();
  base.uncertainty.parameters = {{"pump.piston_length_mm", "normal(1)"}};
  OptimiseRequest request = small({{"pump.piston_length_mm", "1:20"}});
  request.minimise = {"q95:peak:Rb1"};
  request.search.generations = 2;
  const Optimisation found = run(base, request);
  // Pistons near the shortest that reach from joint to bore have samples that do not.
  ASSERT_FALSE(found.designs.infeasible.empty());
  EXPECT_GT(found.feasible(), 0U);
  bool said = false;
  for (const auto& [design, reason] : found.designs.infeasible)
    said =
        said || reason.find("of 100 samples of [uncertainty] have no values") != std::string::npos;
  EXPECT_TRUE(said);
}

// ---- Evaluations that fail, refinements that go on, searches beside it

TEST(OptimiseTest, EvaluationsThatFailAreNamedAndTheOthersCount) {
  OptimiseRequest request = small({{"pump.piston_length_mm", "1:60"}});
  request.minimise = {"peak:Rb1"};
  const Optimisation found = run(rated(), request);
  EXPECT_GT(found.designs.infeasible.size(), 0U);
  EXPECT_GT(found.feasible(), 0U);
  ASSERT_EQ(found.chosen.size(), 1U);
  for (const auto& [design, reason] : found.designs.infeasible) {
    EXPECT_FALSE(reason.empty());
    EXPECT_TRUE(std::isnan(result(found, design, 0)));
    EXPECT_TRUE(std::isinf(found.violations[design]));
  }
}

// Not by the kernel: each design takes a run.
OptimiseRequest slow_request() {
  OptimiseRequest request = small({{"pump.tilt_deg", "20:42"}, {"pump.bore_diameter_mm", "18:26"}});
  request.search = {.population = 8, .generations = 1, .restarts = 1};
  request.minimise = {"rms:budget.Td_inertia"};
  request.subject_to = {"displacement_cm3 >= 50"};
  return request;
}

TEST_F(FolderTest, ARefinementGoesOnWithTheDesignsThatItHas) {
  const Case base = rated();
  const Optimiser optimiser(base, optimise_plan(slow_request(), base));
  const Optimisation whole = optimiser.run({}, {});
  const std::size_t refined = whole.search.evaluations.back();
  ASSERT_GT(refined, 12U);
  EXPECT_TRUE(whole.comparisons.empty());  // by default of the closed form alone
  const SweepParts parts(path, optimiser.record("test"));
  OptimiseWork work;
  work.parts = &parts;
  {
    const RunLock lock = parts.begin();
    struct Stop {};
    int told = 0;
    EXPECT_THROW(optimiser.run(work,
                               [&](double part) {
                                 if (part >= 1 && ++told > 12) throw Stop();
                               }),
                 Stop);
  }
  EXPECT_EQ(parts.count(), optimiser.batches());
  const std::size_t kept = parts.count_singles();
  EXPECT_GT(kept, 0U);
  EXPECT_LT(kept, refined);
  work.resume = true;
  const RunLock lock = parts.begin();
  const Optimisation resumed = optimiser.run(work, {});
  EXPECT_EQ(resumed.kept, optimiser.batches());
  EXPECT_EQ(resumed.kept_singles, kept);
  EXPECT_EQ(evaluations_csv(resumed), evaluations_csv(whole));
  EXPECT_EQ(parts.count_singles(), refined);
  EXPECT_EQ(optimiser.run(work, {}).kept_singles, refined);
  parts.remove(optimiser.batches());
  EXPECT_FALSE(fs::exists(path));
}

TEST(OptimiseTest, IsComparedWithAsManyDesignsAtRandomAndOnAGrid) {
  const Case base = rated();
  OptimiseRequest request = small({{"pump.tilt_deg", "10:42"}, {"pump.bore_diameter_mm", "18:26"}});
  request.minimise = {"peak:Rb1"};
  request.subject_to = {"displacement_cm3 >= 50"};
  const Optimisation found = run(base, request);
  ASSERT_EQ(found.comparisons.size(), 2U);
  EXPECT_EQ(found.comparisons[0].name, "random");
  EXPECT_EQ(found.comparisons[0].evaluations, found.evaluated());
  EXPECT_EQ(found.comparisons[1].name, "grid");
  EXPECT_LE(found.comparisons[1].evaluations, found.evaluated());
  EXPECT_GT(2 * found.comparisons[1].evaluations, found.evaluated());
  // The same designs, one by one.
  SearchProblem problem;
  problem.low = {10, 18};
  problem.high = {42, 26};
  problem.whole = {false, false};
  const Evaluator own(
      Family(base, {Variable("pump.tilt_deg", base), Variable("pump.bore_diameter_mm", base)}),
      {output("peak:Rb1", base), output("displacement_cm3", base)});
  const double best = result(found, found.chosen.at(0).design, 0);
  for (const SearchComparison& other : found.comparisons) {
    const std::vector<double> points = other.name == "grid"
                                           ? grid_search_points(problem, found.evaluated())
                                           : random_search_points(problem, found.evaluated(), 1);
    ASSERT_EQ(points.size(), 2 * other.evaluations);
    double least = INFINITY;
    std::size_t feasible = 0;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      const Evaluation one = own.evaluate(std::span(points).subspan(i, 2));
      if (!one.feasible() || !(one.values[1] >= 50)) continue;
      ++feasible;
      least = std::min(least, one.values[0]);
    }
    EXPECT_EQ(other.feasible, feasible);
    EXPECT_EQ(other.best.at(0), least);
    EXPECT_GE(other.best.at(0), best);
  }
  request.comparison = SearchComparisonChoice::no;
  EXPECT_TRUE(run(base, request).comparisons.empty());
  // Of several objectives by the volume of the front.
  const Optimisation front = run(base, front_request());
  std::vector<double> low(2, INFINITY), high(2, -INFINITY);
  for (const std::size_t design : pareto_front(front.designs.results, front.plan.designs.direction))
    for (std::size_t k = 0; k < 2; ++k) {
      const double cost = (k == 0 ? 1 : -1) * result(front, design, k);
      low[k] = std::min(low[k], cost);
      high[k] = std::max(high[k], cost);
    }
  // Area below a tenth beyond the worst point, stripe by stripe.
  const auto area = [&](std::vector<std::pair<double, double>> points) {
    for (auto& [first, second] : points) {
      first = (first - low[0]) / (high[0] - low[0]);
      second = (second - low[1]) / (high[1] - low[1]);
    }
    std::sort(points.begin(), points.end());
    double sum = 0, lowest = 1.1;
    for (const auto& [first, second] : points) {
      if (!(first < 1.1 && second < lowest)) continue;
      sum += (1.1 - first) * (lowest - second);
      lowest = second;
    }
    return sum;
  };
  const auto measured = [&](const std::vector<double>& points) {
    std::vector<std::pair<double, double>> costs;
    for (std::size_t i = 0; i < points.size(); i += 2) {
      const Evaluation one = own.evaluate(std::span(points).subspan(i, 2));
      if (one.feasible()) costs.emplace_back(one.values[0], -one.values[1]);
    }
    return area(std::move(costs));
  };
  problem.low = {20, 18};
  const double whole = measured(front.designs.values);
  ASSERT_EQ(front.comparisons.size(), 2U);
  EXPECT_NEAR(front.comparisons[0].share_of_front,
              measured(random_search_points(problem, front.evaluated(), 1)) / whole, 1e-9);
  EXPECT_NEAR(front.comparisons[1].share_of_front,
              measured(grid_search_points(problem, front.evaluated())) / whole, 1e-9);
}

TEST_F(FolderTest, AnotherNumberOfSamplesIsAnotherStudy) {
  const Case base = uncertain_bore();
  OptimiseRequest request = small({{"pump.tilt_deg", "20:42"}});
  request.minimise = {"q95:peak:Rb1"};
  const auto identity = [&] {
    return Optimiser(base, optimise_plan(request, base)).record("test").identity;
  };
  const std::string before = identity();
  EXPECT_EQ(identity(), before);
  request.samples = 200;
  EXPECT_NE(identity(), before);
  request.samples = 100;
  request.minimise = {"q90:peak:Rb1"};
  EXPECT_NE(identity(), before);
}

}  // namespace
}  // namespace bentaxis::designs
