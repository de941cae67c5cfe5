// Reports of sweeps: what is drawn and told of which designs.
#include "bentaxis/designs/sweep_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "bentaxis/designs/pareto.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::designs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// Whether a design is beaten, by the definition.
bool beaten(const std::vector<double>& results, const std::vector<int>& direction, std::size_t i) {
  const std::size_t n = direction.size();
  for (std::size_t j = 0; j * n < results.size(); ++j) {
    bool as_good = true, better = false;
    for (std::size_t k = 0; k < n; ++k) {
      const double gain = direction[k] * (results[j * n + k] - results[i * n + k]);
      as_good = as_good && gain >= 0;
      better = better || gain > 0;
    }
    if (as_good && better) return true;
  }
  return false;
}

TEST(Pareto, FrontIsWhatNobodyBeats) {
  std::mt19937 random(3);
  for (const std::vector<int>& direction :
       {std::vector<int>{-1}, {1, -1}, {0, 1, 1}, {-1, -1, 1, 0}}) {
    std::vector<double> results;
    for (std::size_t i = 0; i < 200 * direction.size(); ++i)
      results.push_back(static_cast<double>(random() % 30));  // with ties
    std::vector<std::size_t> expected;
    for (std::size_t i = 0; i < 200; ++i)
      if (!beaten(results, direction, i)) expected.push_back(i);
    ASSERT_FALSE(expected.empty());
    EXPECT_LT(expected.size(), 200U);
    EXPECT_EQ(pareto_front(results, direction), expected);
  }
}

TEST(Pareto, WhatWasNotComputedTakesNoPart) {
  const double gap = not_computed();
  const std::vector<double> results = {1, gap, gap, 5, 3, 4, 2, 2};
  EXPECT_THAT(pareto_front(results, std::vector<int>{-1, 1}), ElementsAre(2, 3));
  // Where the second output does not matter its gap does no harm.
  EXPECT_THAT(pareto_front(results, std::vector<int>{-1, 0}), ElementsAre(0));
  EXPECT_THAT(pareto_front(results, std::vector<int>{0, 0}), ElementsAre());
}

class SweepDocument : public testing::Test {
 protected:
  SweepDocument() {
    result_.base = read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml");
    vary("pump.tilt_deg", {30, 40, 20});
    vary("pressure.delivery_bar", {100, 200});
    result_.plan.outputs = {output("max:Rb1_z1", result_.base), output("mean:Td", result_.base)};
    result_.plan.direction = {-1, 1};
    // Numbers that tell where they belong: tilt and pressure, pressure and tilt.
    for (const double tilt : {30., 40., 20.})
      for (const double pressure : {100., 200.}) {
        result_.values.insert(result_.values.end(), {tilt, pressure});
        result_.results.insert(result_.results.end(), {10 * tilt + pressure, pressure - tilt});
      }
    result_.designs = 6;
  }

  void vary(const std::string& name, const std::vector<double>& levels) {
    result_.plan.varied.push_back({Variable(name, result_.base), levels, {}});
  }
  void refuse(std::size_t design, const std::string& reason) {
    for (const std::size_t k : {0, 1}) result_.results[2 * design + k] = not_computed();
    result_.infeasible.emplace_back(design, reason);
    ++result_.all_infeasible;
  }

  report::Document document() const {
    return sweep_document(result_, {{"bentaxis", "test"}}, study::describe(result_.base));
  }
  static const report::Section* section(const report::Document& document,
                                        const std::string& title) {
    for (const auto& one : *document.runs)
      if (one.title == title) return &one;
    return nullptr;
  }
  template <class Content>
  static const Content& figure(const report::Document& document, const std::string& id) {
    for (const auto& one : *document.figures)
      if (one.id == id) return std::get<Content>(one.content);
    throw std::out_of_range("no figure " + id);
  }

  SweepResult result_;
};

TEST_F(SweepDocument, SaysWhereNothingChangesAnOutput) {
  EXPECT_THAT(sweep_answers(result_).front(), HasSubstr("best, lowest"));
  for (std::size_t d = 0; d < result_.designs; ++d) result_.results[2 * d] = 7;
  const auto answers = sweep_answers(result_);
  EXPECT_THAT(answers.at(0), HasSubstr("max:Rb1_z1_N is 7 N in every design"));
  EXPECT_THAT(answers.at(0), Not(HasSubstr("best")));
  EXPECT_THAT(answers.at(1), HasSubstr("best, highest"));
}

TEST_F(SweepDocument, MapsHoldEveryDesignAtItsPlace) {
  const auto found = document();
  const auto& map = figure<report::MapFigure>(found, "map_1_2_1");
  EXPECT_EQ(map.x.label, "pump.tilt_deg");
  EXPECT_EQ(map.x.unit, "");                           // in the name
  EXPECT_THAT(map.x_values, ElementsAre(20, 30, 40));  // rising, as no level was
  EXPECT_THAT(map.y_values, ElementsAre(100, 200));
  EXPECT_THAT(map.values, ElementsAre(ElementsAre(300, 400, 500), ElementsAre(400, 500, 600)));
  EXPECT_TRUE(map.linear);
  EXPECT_EQ(map.z.from, 300);
  EXPECT_TRUE(map.reasons.empty());
  ASSERT_FALSE(map.contours.empty());
  for (const double level : map.contours) EXPECT_TRUE(level > 300 && level < 600);
}

TEST_F(SweepDocument, InfeasibleDesignsAreCountedByReasonAndHatched) {
  refuse(0, "pump.tilt_deg = 30: too much, 1.5 mm left");
  refuse(3, "pump.tilt_deg = 40: too much, -2 mm left");
  refuse(4, "no assembly found");
  const auto found = document();
  const auto* table = section(found, "Infeasible designs");
  ASSERT_NE(table, nullptr);
  ASSERT_EQ(table->table.rows.size(), 2U);
  EXPECT_THAT(
      table->table.rows[0],
      ElementsAre(report::Cell("pump.tilt_deg = 30: too much, 1.5 mm left"), report::Cell(2L),
                  report::Cell("0: pump.tilt_deg 30, pressure.delivery_bar 100")));
  EXPECT_EQ(table->facts[0].second, "3 of 6 designs, 50 %");
  const auto& map = figure<report::MapFigure>(found, "map_1_2_2");
  EXPECT_FALSE(is_computed(map.values[0][1]));
  EXPECT_EQ(map.reasons[0][1], "pump.tilt_deg = 30: too much, 1.5 mm left");
  EXPECT_EQ(map.reasons[0][0], "no assembly found");
  EXPECT_EQ(map.reasons[1][1], "");
  EXPECT_THAT(headline(result_), HasSubstr("6 designs in 2 parameters, 3 infeasible"));
}

TEST_F(SweepDocument, SlicesHaveALineForEachLevelOfTheNextParameter) {
  const auto found = document();
  const auto& xy = figure<report::XyFigure>(found, "slice_1_1");
  ASSERT_EQ(xy.series.size(), 2U);
  EXPECT_EQ(xy.series[1].label, "pressure.delivery_bar 200");
  EXPECT_THAT(xy.series[1].x, ElementsAre(20, 30, 40));
  EXPECT_THAT(xy.series[1].y, ElementsAre(400, 500, 600));
  EXPECT_EQ(figure<report::XyFigure>(found, "slice_2_1").series.size(), 3U);
}

// A third parameter stays at the level next to the case's own value.
TEST_F(SweepDocument, OthersStayWhereTheCaseIs) {
  vary("operation.speed_rpm", {1000, 1600, 3000});  // the case: 1500
  const auto values = result_.values, results = result_.results;
  result_.values.clear();
  result_.results.clear();
  for (std::size_t i = 0; i < 6; ++i)
    for (const double speed : {1000., 1600., 3000.}) {
      result_.values.insert(result_.values.end(), {values[2 * i], values[2 * i + 1], speed});
      result_.results.insert(result_.results.end(), {results[2 * i] + speed, 1});
    }
  result_.designs = 18;
  const auto found = document();
  EXPECT_EQ(figure<report::MapFigure>(found, "map_1_2_1").values[0][0], 300 + 1600);
  // Tilt 40 is the case's; 275 bar are nearest to 200.
  EXPECT_THAT(figure<report::MapFigure>(found, "map_1_3_1").values[2],
              ElementsAre(400 + 3000, 500 + 3000, 600 + 3000));
  const auto& slice = figure<report::XyFigure>(found, "slice_3_1");
  EXPECT_EQ(slice.series[0].label, "pump.tilt_deg 30");
  EXPECT_THAT(slice.series[0].y, ElementsAre(500 + 1000, 500 + 1600, 500 + 3000));
  EXPECT_THAT(found.figures->front().note, HasSubstr("At operation.speed_rpm 1600"));
}

TEST_F(SweepDocument, FrontIsMarkedAndTold) {
  // Smallest first, largest second: 20 deg at both pressures.
  const auto found = document();
  const auto* front = section(found, "Pareto front");
  ASSERT_NE(front, nullptr);
  ASSERT_EQ(front->table.rows.size(), 2U);
  EXPECT_EQ(front->table.rows[0][0], report::Cell(4L));
  EXPECT_EQ(front->table.rows[1][0], report::Cell(5L));
  EXPECT_THAT(figure<report::ParallelFigure>(found, "parallel").marked, ElementsAre(4, 5));
  const auto& pair = figure<report::ScatterFigure>(found, "pair_1_2");
  ASSERT_EQ(pair.series.size(), 2U);
  EXPECT_EQ(pair.series[0].points.size(), 4U);
  EXPECT_EQ(pair.series[1].points[0].x, 300);
  EXPECT_EQ(pair.series[1].points[0].y, 80);
  EXPECT_EQ(pair.series[1].points[0].note, "design 4: pump.tilt_deg 20, pressure.delivery_bar 100");

  result_.plan.direction = {0, 1};
  const auto best = document();
  EXPECT_EQ(section(best, "Pareto front"), nullptr);
  ASSERT_NE(section(best, "Best designs"), nullptr);
  EXPECT_EQ(section(best, "Best designs")->table.rows[0][0], report::Cell(5L));
}

TEST_F(SweepDocument, ManyDesignsAreThinnedEvenlyWithTheFront) {
  result_.plan.sampling = Sampling::random;
  result_.plan.samples = 5000;
  result_.plan.varied[0].levels.clear();
  result_.plan.varied[1].levels.clear();
  result_.values.clear();
  result_.results.clear();
  result_.designs = 5000;
  for (int i = 0; i < 5000; ++i) {
    const double t = i == 4321 ? 7 : 1;  // better in both than any other
    result_.values.insert(result_.values.end(), {20 + i * 0.001, 100});
    result_.results.insert(result_.results.end(), {100 - t, t});
  }
  const auto found = document();
  const auto& parallel = figure<report::ParallelFigure>(found, "parallel");
  EXPECT_EQ(parallel.columns[0].values.size(), 296U);  // every 17th, and the front
  ASSERT_EQ(parallel.marked.size(), 1U);
  EXPECT_EQ(parallel.columns[0].values[parallel.marked[0]], 20 + 4321 * 0.001);
  EXPECT_THAT(found.figures->back().note, HasSubstr("296 of 5000 designs are drawn"));
  EXPECT_EQ(figure<report::ScatterFigure>(found, "cloud_1_1").series[1].points.size(), 1U);
}

TEST_F(SweepDocument, ChecksAreTold) {
  SweepCheck good{1, {500, 70}, {500, 70}, "", "", {1000, 100}};
  SweepCheck bad{2, {500, 60}, {500.1, 60}, "", "", {1000, 100}};
  SweepCheck both{3, {}, {}, "refused", "refused", {}};
  result_.checks = {good, both};
  auto found = document();
  EXPECT_EQ(found.verdict->agrees, true);
  EXPECT_EQ(section(found, "Designs in which the models differ"), nullptr);
  EXPECT_THAT(found.verdict->headline, HasSubstr("Simbody agrees at 1 of 1 designs; 1 of 2 checked "
                                                 "designs not compared"));
  result_.checks = {both};
  found = document();
  EXPECT_EQ(found.verdict->agrees, false);
  EXPECT_EQ(found.verdict->word, "Nothing compared");
  EXPECT_EQ(section(found, "Designs in which the models differ"), nullptr);
  result_.checks = {good, bad, both};
  found = document();
  EXPECT_EQ(found.verdict->agrees, false);
  EXPECT_THAT(found.verdict->headline, HasSubstr("Simbody agrees at 1 of 2 designs"));
  const auto* differing = section(found, "Designs in which the models differ");
  ASSERT_NE(differing, nullptr);
  ASSERT_EQ(differing->table.rows.size(), 1U);
  EXPECT_EQ(differing->table.rows[0][0], report::Cell(2L));
  EXPECT_NEAR(std::get<double>(differing->table.rows[0][4]), 1e-4, 1e-10);
  const auto* checks = section(found, "Recomputed by Simbody");
  ASSERT_NE(checks, nullptr);
  EXPECT_EQ(checks->table.rows[0][1], report::Cell(2L));
  EXPECT_EQ(checks->table.rows[0][3], report::Cell(2L));
}

// Words of a choice are no axis of a map; they are the lines of a slice and an axis of words.
TEST_F(SweepDocument, ChoicesAreTold) {
  result_.plan.varied.pop_back();
  vary("piston.inertia", {0, 1});
  for (std::size_t i = 0; i < 6; ++i) result_.values[2 * i + 1] = i % 2 == 0 ? 0 : 1;
  const auto found = document();
  EXPECT_THROW(figure<report::MapFigure>(found, "map_1_2_1"), std::out_of_range);
  const auto& slice = figure<report::XyFigure>(found, "slice_1_1");
  EXPECT_EQ(slice.series[1].label, "piston.inertia real");
  EXPECT_THAT(figure<report::ParallelFigure>(found, "parallel").columns[1].words,
              ElementsAre("lumped", "real", "dynamically_equivalent"));
}

}  // namespace
}  // namespace bentaxis::designs
