// The guess of a foreign record's mapping: its pieces by hand, and whole records made of known
// curves by a known mapping, which must be found again.
#include "bentaxis/study/mapping_guess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <tuple>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "mapping_assignment.h"

namespace bentaxis::study::mapping {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

// ---- Curves

TEST(MappingCurves, MeanAndLength) {
  EXPECT_THAT(centred({1, 2, 6}), ElementsAre(-2, -1, 3));
  const double length = std::sqrt(14.0);
  EXPECT_THAT(normalised({1, 2, 6}),
              ElementsAre(DoubleNear(-2 / length, 1e-15), DoubleNear(-1 / length, 1e-15),
                          DoubleNear(3 / length, 1e-15)));
  EXPECT_THAT(length_of({Series{2, 1}, Series{}, Series{-3, 2}}),
              ElementsAre(DoubleNear(std::sqrt(13.0), 1e-15), DoubleNear(std::sqrt(5.0), 1e-15)));
}

TEST(MappingCurves, WhatMovesByRoundOffIsConstant) {
  struct {
    Series values;
    bool constant;
  } const cases[] = {{{0, 0}, true},
                     {{-4, -4}, true},
                     {{2000, 2000 + 1e-9}, true},
                     {{-2000, -2000 - 1e-9}, true},
                     {{-2, 2}, false},
                     {{2000, 2001}, false},
                     {{1e-9, 2e-9}, false}};
  for (const auto& c : cases) {
    EXPECT_EQ(is_constant(c.values), c.constant) << c.values[0];
    EXPECT_EQ(normalised(c.values) == Series({0, 0}), c.constant) << c.values[0];
  }
}

TEST(MappingCurves, ShiftedProductGoesRoundTheTurn) {
  Series ours(kCoarse, 0), theirs(kCoarse, 0);
  ours[4] = 3;
  ours[100] = 5;
  theirs[kCoarse - 3] = 7;  // 7 steps later it is at 4
  theirs[93] = 11;          // and this at 100
  EXPECT_EQ(shifted_product(ours, theirs, 7), 3 * 7 + 5 * 11);
  EXPECT_EQ(shifted_product(ours, theirs, 0), 0);
}

TEST(MappingCurves, TheRoundestOfAnglesThatFitAsWell) {
  // A cost that grows by 1 over `width` deg around the true angles: those that it lets through.
  struct {
    std::vector<double> angles;
    double width;
    std::vector<double> rounded;
    double step;
  } const cases[] = {{{17.3456789}, 0.6, {17.25}, 0.25},
                     {{17.3456789}, 0.1, {17.35}, 0.05},
                     {{17.3456789}, 1e-3, {17.3457}, 1e-4},
                     {{17.3456789}, 1e-12, {17.3456789}, 0},
                     {{89.9999}, 1, {90}, 90},
                     {{-19.9999}, 1, {-20}, 10},
                     {{30.001, 49.999, -20.001}, 0.1, {30, 50, -20}, 10},
                     {{17.3001, 41.9, -8.2}, 0.01, {17.3, 41.9, -8.2}, 0.1},
                     {{90, 17.3456789}, 1e-12, {90, 17.3456789}, 0}};
  for (const auto& c : cases) {
    std::vector<double> angles = c.angles;
    const double step = roundest(
        [&](const std::vector<double>& at) {
          double off = 0;
          for (std::size_t i = 0; i < at.size(); ++i)
            off = std::max(off, std::abs(at[i] - c.angles[i]));
          return off / c.width;
        },
        angles);
    EXPECT_EQ(step, c.step) << c.angles[0];
    EXPECT_THAT(angles, testing::Pointwise(testing::DoubleNear(1e-12), c.rounded));
  }
  // However flat the cost: an angle some degrees off is another one.
  std::vector<double> angles = {40};
  roundest([](const std::vector<double>&) { return 1.0; }, angles);
  EXPECT_EQ(angles[0], 40);
}

// ---- Names

TEST(MappingNames, WordsAndAxes) {
  EXPECT_THAT(words_of(" Force[2].X?/kN"), ElementsAre("force", "2", "x?", "kn"));
  EXPECT_THAT(words_of("--"), IsEmpty());
  EXPECT_TRUE(is_quantity({"of", "rb1"}, "Rb1"));
  EXPECT_FALSE(is_quantity({"of", "rb2"}, "Rb1"));
  EXPECT_THAT(axis_readings("FX"), ElementsAre(Pair("F?", 0)));
  EXPECT_THAT(axis_readings("Force_y2 [N]"), ElementsAre(Pair("Force_?2 [N]", 1)));
  EXPECT_THAT(axis_readings("z22"), IsEmpty());
  EXPECT_THAT(axis_readings("yes"), IsEmpty());
  EXPECT_THAT(axis_readings("x of Z"), ElementsAre(Pair("x of ?", 2), Pair("? of Z", 0)));
  EXPECT_THAT(axis_readings("f(:,1)"), ElementsAre(Pair("f(:,?)", 0)));
  EXPECT_THAT(axis_readings("f(:,3)"), ElementsAre(Pair("f(:,?)", 2)));
  EXPECT_THAT(axis_readings("f(:,0)"), IsEmpty());
  EXPECT_THAT(axis_readings("f(:,4)"), IsEmpty());
  EXPECT_THAT(axis_readings("f(:,2)b"), IsEmpty());
}

TEST(MappingNames, NumberOfAPiston) {
  EXPECT_EQ(piston_in("Rs_3", 7), 3);
  EXPECT_EQ(piston_in("Rs_7", 7), 7);
  for (const char* column : {"column 3", "Column_3", "ch3", "Channel 3 (N)", "AI3", "Kanal 3"})
    EXPECT_EQ(piston_in(column, 7), 0) << column;
  EXPECT_EQ(piston_in("channel 5 piston 3", 7), 3);
  EXPECT_EQ(piston_in("Rs_8", 7), 0);
  EXPECT_EQ(piston_in("Rs_0", 7), 0);
  EXPECT_EQ(piston_in("Rs_1", 7), 1);
  EXPECT_EQ(piston_in("F1 piston 4", 7), 4);  // behind a word for pistons first
  EXPECT_EQ(piston_in("F1 kolben4", 7), 4);
  EXPECT_EQ(piston_in("F1 cyl4", 7), 4);
  EXPECT_EQ(piston_in("F1 chamber_4", 7), 4);
  EXPECT_EQ(piston_in("F1 axial4", 7), 1);
  EXPECT_EQ(piston_in("F1 bicycl4", 7), 1);  // begins otherwise
  EXPECT_EQ(piston_in("F2?_5", 7), 5);       // never that of an axis
  EXPECT_EQ(piston_in("F2?", 7), 0);
  EXPECT_EQ(piston_in("run 0012 5", 20), 5);  // four digits number runs
  EXPECT_EQ(piston_in("run 012 5", 20), 12);
  EXPECT_EQ(piston_in("p3 4", 7), 3);
  EXPECT_EQ(piston_in("p", 7), 0);
}

TEST(MappingNames, AChannelsWords) {
  Channel channel;
  channel.name = "Rs_2_x2_N";
  channel.quantity = "Rs";
  EXPECT_TRUE(named({"x2", "rs", "2", "kn"}, channel));
  EXPECT_FALSE(named({"x2", "rs", "3", "kn"}, channel));
  EXPECT_FALSE(named({"torque"}, channel));
  channel = {};
  channel.name = "Td_z1_Nm";
  channel.quantity = "Td";
  EXPECT_TRUE(named({"shaft", "torque"}, channel));
  EXPECT_FALSE(named({"td"}, channel));
  EXPECT_TRUE(named({"td", "z1"}, channel));
}

// ---- Columns

ForeignTable table_of(const std::vector<std::string>& header,
                      const std::vector<std::vector<double>>& columns) {
  ForeignTable table;
  table.file = "theirs.txt";
  table.header = header;
  table.units.assign(header.size(), "");
  table.digits.assign(header.size(), 0);
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    table.rows.emplace_back();
    for (const auto& column : columns) table.rows.back().push_back(column[row]);
    table.lines.push_back(static_cast<unsigned>(row) + 2);
  }
  return table;
}

std::vector<double> steps(double from, double step, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(from + step * i);
  return out;
}

struct Record {
  bool is = false;
  AngleMap map;
};
Record record_of(const std::vector<double>& values, int digits = 0, double unit = 1,
                 std::optional<double> speed = std::nullopt) {
  ForeignTable table = table_of({"a"}, {values});
  table.digits[0] = digits;
  Record record;
  record.map.degrees_per_unit = unit;
  record.map.is_time = speed.has_value();
  record.is = is_record(table, 0, speed.value_or(1e9), record.map);
  return record;
}

TEST(MappingColumns, ARecordCoversATurnWithoutWideGaps) {
  struct {
    const char* what;
    double step;
    int count;
    bool is;
    std::optional<double> speed = std::nullopt;
  } const cases[] = {{"a turn", 10, 36, true},
                     {"a turn downwards", -10, 36, true},
                     {"a sample is missing at the end", 10, 35, true},
                     {"a tenth is missing", 10, 32, false},
                     {"half a turn", 10, 19, false},
                     {"more than a turn, cut anywhere", 10, 57, true},
                     {"too few rows", 90, 5, false},
                     {"steps too wide", 45, 9, false},
                     {"more turns than a record has", 20, 30000, false},
                     {"time of a turn", 0.02, 26, true, 720},
                     {"time of half a turn", 0.02, 13, false, 720}};
  for (const auto& c : cases)
    EXPECT_EQ(record_of(steps(3, c.step, c.count), 0, 1, c.speed).is, c.is) << c.what;
  EXPECT_TRUE(record_of(steps(0, 0.25, 25), 0, 60).is);  // in units of 60 deg
}

TEST(MappingColumns, ARecordRisesOrFallsStrictly) {
  auto angles = steps(0, 20, 19);
  angles[7] = angles[6];
  EXPECT_FALSE(record_of(angles).is);
  angles[7] = angles[6] - 1;
  EXPECT_FALSE(record_of(angles).is);
  angles = steps(0, -20, 19);
  angles[7] = angles[6];
  EXPECT_FALSE(record_of(angles).is);
  angles[7] = not_computed();
  EXPECT_FALSE(record_of(angles).is);
}

TEST(MappingColumns, AnAngleThatBeginsAnewGoesOn) {
  auto angles = steps(200, 20, 19);
  for (double& angle : angles)
    if (angle >= 360) angle -= 360;
  EXPECT_TRUE(record_of(angles).is);
  std::reverse(angles.begin(), angles.end());
  EXPECT_TRUE(record_of(angles).is);
  // Twice anew, and the last turn is taken.
  auto twice = steps(0, 20, 40);
  for (double& angle : twice) angle = std::fmod(angle, 360.0);
  const Record record = record_of(twice);
  ASSERT_TRUE(record.is);
  EXPECT_EQ(record.map.turn_from_deg, 780 - 360);
  // From -180 to 180: a step back by 180 deg is none, one of more is.
  EXPECT_FALSE(record_of({0, 30, 60, 90, 120, 150, 180, 0, 30, 60, 90, 120, 150, 180}).is);
  EXPECT_TRUE(record_of({0, 30, 60, 90, 120, 150, 180, -150, -120, -90, -60, -30, 0}).is);
  // A time never does.
  EXPECT_FALSE(record_of(angles, 0, 1, 1.0).is);
}

TEST(MappingColumns, OfALongerRecordTheLastTurn) {
  EXPECT_FALSE(record_of(steps(0, 20, 19)).map.turn_from_deg);
  EXPECT_EQ(record_of(steps(7, 20, 25)).map.turn_from_deg, 7 + 480 - 360);
  EXPECT_EQ(record_of(steps(7, -20, 25)).map.turn_from_deg, 7 - 480);
  auto angles = steps(0, 20, 19);
  angles.back() += 1e-12;  // round-off
  EXPECT_FALSE(record_of(angles).map.turn_from_deg);
}

TEST(MappingColumns, RoundingOfTheAngle) {
  EXPECT_DOUBLE_EQ(half_of_last_digit(360, 4), 0.05);
  EXPECT_DOUBLE_EQ(half_of_last_digit(0.0123, 2), 0.0005);
  // Row 5 lies off by so much; digits of the file.
  struct {
    const char* what;
    double from, off;
    int digits;
    double unit, rounding_deg;
  } const cases[] = {{"equal steps are exact", 0, 0, 4, 1, 0},
                     {"half of the last digit", 0, 0.3, 4, 1, 0.05},
                     {"the largest magnitude counts", -400, 0.3, 4, 1, 0.05},
                     {"no more than the steps are uneven", 0, 0.3, 2, 1, 0.3},
                     {"unevenness to both sides", 0, -0.3, 2, 1, 0.3},
                     {"digits that nobody knows", 0, 0.3, 0, 1, 0},
                     {"all digits of a double", 0, 0.3, 17, 1, 0},
                     {"in units of 60 deg", 0, 0.3, 4, 60, 0.03}};
  for (const auto& c : cases) {
    auto angles = steps(c.from, 20, 19);
    angles[5] += c.off;
    for (double& angle : angles) angle /= c.unit;
    EXPECT_NEAR(record_of(angles, c.digits, c.unit).map.rounding_deg, c.rounding_deg, 1e-12)
        << c.what;
  }
  // A turn and no more, as far as the rounding tells.
  auto angles = steps(0, 20, 19);
  angles[5] += 0.3;
  angles.back() = 360.05;
  EXPECT_FALSE(record_of(angles, 4).map.turn_from_deg);
  angles.back() = 360.5;
  EXPECT_TRUE(record_of(angles, 4).map.turn_from_deg);
}

// Column and unit of each choice.
std::vector<std::pair<std::string, std::string>> choices(const ForeignTable& table,
                                                         double speed = 720) {
  std::vector<std::pair<std::string, std::string>> out;
  for (const AngleMap& map : angle_choices(table, speed)) {
    out.emplace_back(map.column, map.unit);
    EXPECT_EQ(map.is_time, map.unit == "s" || map.unit == "ms");
    EXPECT_EQ(map.degrees_per_unit,
              map.is_time ? compare::seconds_per(map.unit) : compare::degrees_per(map.unit));
  }
  return out;
}

TEST(MappingColumns, TheAngleIsWhatSaysSoMostClearly) {
  const auto degrees = steps(0, 20, 19), seconds = steps(0, 1.0 / 36, 19);
  ForeignTable table =
      table_of({"foo", "bar", "time", "theta"}, {degrees, degrees, seconds, degrees});
  table.units = {"", "deg", "s", "deg"};
  EXPECT_THAT(choices(table), ElementsAre(Pair("theta", "deg")));
  table.units[3] = "";
  EXPECT_THAT(choices(table), ElementsAre(Pair("bar", "deg")));
  table.units[1] = "N";
  EXPECT_THAT(choices(table), ElementsAre(Pair("time", "s")));
  table.units[2] = "";
  EXPECT_THAT(choices(table), ElementsAre(Pair("theta", "deg")));
  table.header[3] = "x";
  EXPECT_THAT(choices(table), ElementsAre(Pair("time", "s")));
  table.header[2] = "y";
  table.units[1] = "";
  // Nothing says anything: 720 turns in 19 rows are none, 0.5 s at 720 deg/s are a turn.
  EXPECT_THAT(choices(table), ElementsAre(Pair("foo", "deg"), Pair("bar", "deg"), Pair("y", "s"),
                                          Pair("x", "deg")));
  // A name that says angle, over a curve that only as time is a turn, is the last resort.
  EXPECT_THAT(choices(table_of({"phi"}, {seconds})), ElementsAre(Pair("phi", "s")));
  EXPECT_THAT(choices(table_of({"phi", "what"}, {seconds, seconds})),
              ElementsAre(Pair("what", "s")));
  EXPECT_THAT(choices(table_of({"t", "what"}, {degrees, degrees})),
              ElementsAre(Pair("what", "deg")));
  EXPECT_THAT(choices(table_of({"what"}, {steps(0, 0.35, 19)})), ElementsAre(Pair("what", "rad")));
  EXPECT_THAT(choices(table_of({"what"}, {steps(0, 1.0 / 18, 19)}), 1e-3),
              ElementsAre(Pair("what", "turn")));
  EXPECT_THAT(choices(table_of({"t"}, {steps(0, 1000.0 / 36, 19)})), ElementsAre(Pair("t", "ms")));
  table = table_of({"t"}, {degrees});
  table.units[0] = "N";
  EXPECT_THROW(choices(table), InputError);
}

TEST(MappingColumns, WhatRunsAlongAndWhatIsALength) {
  const ForeignTable table =
      table_of({"up", "down", "flat", "x", "y", "r"},
               {{1, 2, 4}, {3, 2, -1}, {1, 2, 2}, {3, -6, 0}, {4, 8, 5}, {5, 10.00001, 5}});
  EXPECT_TRUE(runs_along(table, 0));
  EXPECT_TRUE(runs_along(table, 1));
  EXPECT_FALSE(runs_along(table, 2));
  EXPECT_FALSE(runs_along(table, 3));
  EXPECT_FALSE(runs_along(table_of({"down"}, {{2, 1, 1}}), 0));
  Group group;
  group.columns = {3, std::nullopt, 4};
  EXPECT_EQ(group.count(), 2U);
  EXPECT_TRUE(is_length(table, 5, group));
  ForeignTable off = table;
  off.rows[1][5] = 10.1;
  EXPECT_FALSE(is_length(off, 5, group));
  off.rows[1][5] = -10;
  EXPECT_FALSE(is_length(off, 5, group));
  EXPECT_FALSE(is_length(table, 0, group));
}

TEST(MappingColumns, VectorsAndSingleColumns) {
  // b: two components; F: three, one of them constant; C: constant; M: a single component.
  ForeignTable table =
      table_of({"by", "bz", "Fx", "Fy", "Fz", "F", "Cx", "Cy", "Mx", "p", "k", "gone"}, {{1, 2},
                                                                                         {5, 3},
                                                                                         {3, -6},
                                                                                         {0, 0},
                                                                                         {4, 8},
                                                                                         {5, 10},
                                                                                         {1, 1},
                                                                                         {2, 2},
                                                                                         {7, 9},
                                                                                         {3, 8},
                                                                                         {4, 4},
                                                                                         {1, 2}});
  table.units[3] = "kN";
  std::vector<bool> has(12, true), constant(12, false);
  has[11] = false;
  for (const std::size_t c : {3, 6, 7, 10}) constant[c] = true;
  const Grouping found = find_groups(table, has, constant);
  ASSERT_EQ(found.groups.size(), 2U);
  EXPECT_EQ(found.groups[0].key, "F?");  // whole ones first
  EXPECT_EQ(found.groups[0].unit, "kN");
  EXPECT_THAT(found.groups[0].columns, ElementsAre(2U, 3U, 4U));
  EXPECT_EQ(found.groups[1].key, "b?");
  EXPECT_THAT(found.groups[1].columns, ElementsAre(std::nullopt, 0U, 1U));
  EXPECT_THAT(found.singles, ElementsAre(8U, 9U));
  EXPECT_THAT(found.ignored,
              ElementsAre(Pair("F", "is the length of F?"), Pair("Cx", "is constant"),
                          Pair("Cy", "is constant"), Pair("k", "is constant")));
}

TEST(MappingColumns, AColumnIsOfOneVectorAndTheFirstOfTheFileWins) {
  // "xF_x": of "xF_?" with xF_y, and of "?F_x" with yF_x.
  const ForeignTable table =
      table_of({"q.z", "q.x", "x F_x", "x F_y", "y F_x"}, {{1}, {2}, {3}, {4}, {5}});
  const Grouping found =
      find_groups(table, std::vector<bool>(5, true), std::vector<bool>(5, false));
  ASSERT_EQ(found.groups.size(), 2U);
  EXPECT_EQ(found.groups[0].key, "q.?");
  EXPECT_THAT(found.groups[0].columns, ElementsAre(1U, std::nullopt, 0U));
  EXPECT_EQ(found.groups[1].count(), 2U);
  EXPECT_EQ(found.singles.size(), 1U);
}

// ---- Matches

TEST(MappingMatches, TheNearestUnit) {
  struct {
    double theirs_over_ours;
    const char* ours;
    double unit_in_si;
    const char *said, *unit;
  } const cases[] = {{1.1, "mm", 1e-3, "", "mm"},
                     {-1.1e-3, "mm", 1e-3, "", "m"},
                     {900, "mm", 1e-3, "", "um"},
                     {1.1e-3, "N", 1, "", "kN"},
                     {0.2248, "N", 1, "", "lbf"},
                     {8.85, "Nm", 1, "", "lbf in"},
                     {0.1, "bar", 1e5, "", "MPa"},
                     {1, "deg", 1, "", ""},
                     // What is said counts unless another fits and it does not.
                     {0.11, "N", 1, "daN", "daN"},
                     {0.11, "N", 1, "Nm", "lbf"},
                     {1.02, "N", 1, "kN", "N"},
                     {30, "N", 1, "kN", "kN"}};
  for (const auto& c : cases)
    EXPECT_EQ(unit_for(c.theirs_over_ours, c.ours, c.unit_in_si, c.said), c.unit)
        << c.theirs_over_ours << " " << c.said;
}

TEST(MappingMatches, CostIsTheDifferenceOverTheirs) {
  // theirs = {2, -3} kN, ours = {1900, -3100} N.
  const double square = 13, product = 2 * 1900 + 3 * 3100, own = 1900. * 1900 + 3100. * 3100;
  const double cost = std::sqrt(0.02 / 13);
  Match m = match_of(square, product, own, "N", 1, "", 0);
  EXPECT_FALSE(m.found());
  EXPECT_EQ(m.unit, "kN");
  EXPECT_EQ(m.sign, 1);
  EXPECT_NEAR(m.cost, cost, 1e-12);
  m = match_of(square, -product, own, "N", 1, "kN", 0);
  EXPECT_EQ(m.sign, -1);
  EXPECT_NEAR(m.cost, cost, 1e-12);
  m = match_of(square, product, own, "N", 1, "kN", -1);
  EXPECT_EQ(m.sign, -1);
  EXPECT_NEAR(m.cost, std::sqrt((3.9 * 3.9 + 6.1 * 6.1) / 13), 1e-12);
  m = match_of(square, product * 1e-3, own * 1e-6, "mm", 1e-3, "um", 1);
  EXPECT_EQ(m.unit, "mm");  // one unit for both
  EXPECT_NEAR(m.cost, cost, 1e-12);
  for (const Match& none :
       {match_of(square, 0, own, "N", 1, "", 0), match_of(square, product, 0, "N", 1, "", 0),
        match_of(square, product, own, "deg", 1, "", 0)}) {
    EXPECT_EQ(none.cost, 2);
    EXPECT_EQ(none.unit, "");
  }
}

TEST(MappingMatches, SignsOfSingleComponents) {
  const Axes axes = compare::turned_axes("XYZ", {35, 20, 75});
  const std::array<Series, 3> ours = {Series{2, 3, -1}, Series{0.5, -4, 1}, Series{7, 1, 2}};
  // In those axes, doubled, the second component turned round and the third left out.
  std::array<Series, 3> theirs;
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t row = 0; row < 3; ++row) {
      theirs[j].push_back(0);
      for (std::size_t i = 0; i < 3; ++i)
        theirs[j][row] += (j == 0 ? 2 : -2) * axes[j][i] * ours[i][row];
    }
  Products p;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      if (!theirs[j].empty()) p.theirs_ours[j][i] = dot(theirs[j], ours[i]);
      p.ours_ours[j][i] = dot(ours[j], ours[i]);
    }
  for (std::size_t j = 0; j < 2; ++j) p.theirs_theirs[j] = dot(theirs[j], theirs[j]);
  double product = 1, own = 2;  // added to
  add_component(p, axes, 0, product, own);
  EXPECT_NEAR(product, 1 + dot(theirs[0], theirs[0]) / 2, 1e-12);
  EXPECT_NEAR(own, 2 + dot(theirs[0], theirs[0]) / 4, 1e-12);
  EXPECT_NEAR(cost_without_signs(p, axes, 2), 0, 1e-7);
  EXPECT_NEAR(cost_without_signs(p, axes, 1.5), 0.25, 1e-12);
  EXPECT_NEAR(cost_without_signs(p, axes, 3), 0.5, 1e-12);
  EXPECT_NEAR(cost_of_mixed(p, axes, 2), 0, 1e-7);
  // The same two exchanged.
  std::swap(p.theirs_theirs[0], p.theirs_theirs[1]);
  std::swap(p.theirs_ours[0], p.theirs_ours[1]);
  EXPECT_GT(cost_without_signs(p, axes, 2), 0.3);
  EXPECT_NEAR(cost_of_mixed(p, axes, 2), 0, 1e-7);
  // A component that is 0 is not one that the file lacks.
  p.theirs_theirs[2] = 0;
  EXPECT_GT(cost_of_mixed(p, axes, 2), 0.3);
}

// ---- Frames and numbers

// Angles about moving axes; no multiples of 5 deg among them but where an angle has two names.
struct Turn {
  const char* sequence;
  std::array<double, 3> deg;
};
const Turn kTurns[] = {{"XYZ", {17.3, 41.9, -8.2}},
                       {"ZXZ", {17.3, 41.9, -8.2}},
                       {"ZXZ", {123.456, 78.9, -33.21}},
                       {"XYZ", {-61.25, 12.75, 171.05}},
                       {"ZXZ", {-152.3, 101.7, 64.4}},
                       {"ZXZ", {25, 40, 110}},
                       {"XYZ", {0, 0, 23.4}},
                       {"XYZ", {31.7, 90, 0}},
                       {"ZXZ", {0, 180, 36.6}}};

TEST(MappingFrames, EulerAnglesGiveTheirAxesBack) {
  for (const Turn& turn : kTurns) {
    const Axes axes = compare::turned_axes(turn.sequence, turn.deg);
    for (const std::string sequence : {"ZXZ", "XYZ"}) {
      const Axes again = compare::turned_axes(sequence, euler_angles(axes, sequence));
      EXPECT_NEAR(trace_of(axes, again), 3, 1e-14) << turn.sequence << turn.deg[0] << sequence;
    }
  }
  EXPECT_THAT(euler_angles(compare::turned_axes("ZXZ", {30, 50, -20}), "ZXZ"),
              ElementsAre(DoubleNear(30, 1e-12), DoubleNear(50, 1e-12), DoubleNear(-20, 1e-12)));
}

TEST(MappingFrames, AngleFromTheNearestAxesAtRightAngles) {
  for (const Axes& axes : right_angles()) EXPECT_NEAR(angle_from_right_angles(axes), 0, 1e-5);
  EXPECT_NEAR(angle_from_right_angles(compare::turned_axes("XYZ", {90, 3.3, 0})), 3.3, 1e-9);
  EXPECT_NEAR(angle_from_right_angles(compare::turned_axes("ZXZ", {38, 180, 0})), 38, 1e-9);
}

// Three vectors and their images, as sums of products.
Axes products_of(const Axes& rotation, int vectors) {
  const double ours[3][3] = {{2, -3, 5}, {1, 4, -0.5}, {-2, 0.3, 0.7}};
  Axes products{};
  for (int n = 0; n < vectors; ++n)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i)
          products[j][k] += rotation[j][i] * ours[n][i] * ours[n][k];
  return products;
}

TEST(MappingFrames, TheNearestRotationIsTheOneBetweenTheVectors) {
  for (const Turn& turn : kTurns)
    for (const int vectors : {2, 3}) {
      const Axes axes = compare::turned_axes(turn.sequence, turn.deg);
      EXPECT_NEAR(trace_of(nearest_rotation({products_of(axes, vectors)}, {3}), axes), 3, 1e-12)
          << turn.sequence << turn.deg[0];
    }
}

TEST(MappingFrames, TheNearestRotationIsNoReflection) {
  Axes mirror = compare::turned_axes("XYZ", {17.3, 41.9, -8.2});
  for (double& cosine : mirror[2]) cosine = -cosine;
  const Axes found = nearest_rotation({products_of(mirror, 3)}, {1});
  for (std::size_t i = 0; i < 3; ++i) {  // z = x cross y
    const std::size_t p = (i + 1) % 3, q = (i + 2) % 3;
    EXPECT_NEAR(found[2][i], found[0][p] * found[1][q] - found[0][q] * found[1][p], 1e-12);
  }
  // The weights decide between vectors that disagree.
  const Axes one = compare::turned_axes("XYZ", {17.3, 41.9, -8.2});
  const Axes other = compare::turned_axes("ZXZ", {123.4, 78.9, -33.2});
  const std::vector<Axes> both = {products_of(one, 3), products_of(other, 3)};
  EXPECT_NEAR(trace_of(nearest_rotation(both, {1, 1e-9}), one), 3, 1e-6);
  EXPECT_NEAR(trace_of(nearest_rotation(both, {1e-9, 1}), other), 3, 1e-6);
}

TEST(MappingFrames, ThereAre24AtRightAngles) {
  const auto& all = right_angles();
  ASSERT_EQ(all.size(), 24U);
  EXPECT_EQ(all.front(), compare::kNoTurn);
  for (std::size_t at = 0; at < all.size(); ++at) {
    const Axes& a = all[at];
    for (std::size_t i = 0; i < 3; ++i) {  // z = x cross y
      const std::size_t p = (i + 1) % 3, q = (i + 2) % 3;
      EXPECT_EQ(a[2][i], a[0][p] * a[1][q] - a[0][q] * a[1][p]);
      EXPECT_EQ(dot({a[i].begin(), a[i].end()}, {a[i].begin(), a[i].end()}), 1);
    }
    EXPECT_EQ(std::count(all.begin(), all.end(), a), 1);
  }
}

TEST(MappingFrames, AVectorStaysItselfInOtherAxes) {
  const Axes s1 = compare::turned_axes("XYZ", {10, 25, 40}),
             s2 = compare::turned_axes("ZXZ", {65, 35, 110});
  const Axes theirs = compare::turned_axes("XYZ", {50, 5, 15});  // out of s1
  const std::array<double, 3> v = {2, -3, 5};                    // in the common axes
  const auto in = [&](const Axes& axes, const std::array<double, 3>& w) {
    std::array<double, 3> out{};
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) out[j] += axes[j][i] * w[i];
    return out;
  };
  const auto expected = in(theirs, in(s1, v));
  const auto found = in(carried(theirs, s1, s2), in(s2, v));
  const auto of_s2 = in(s2, v), of_s1 = in(s1, v);
  const auto out = in_axes({Series{of_s2[0], 0}, Series{of_s2[1], 0}, Series{of_s2[2], 1}}, s2, s1);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(found[j], expected[j], 1e-14);
    ASSERT_EQ(out[j].size(), 2U);
    EXPECT_NEAR(out[j][0], of_s1[j], 1e-14);
    EXPECT_NEAR(out[j][1], in(s1, s2[2])[j], 1e-14);
  }
}

std::vector<int> numbering_of(const std::vector<std::pair<int, int>>& votes) {
  const auto ours = best_numbering(votes, 5);
  return {ours(1), ours(2), ours(3), ours(4), ours(5)};
}

TEST(MappingFrames, OneNumberingOfThePistons) {
  EXPECT_THAT(numbering_of({{1, 1}, {2, 2}}), ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(numbering_of({{1, 3}, {2, 4}}), ElementsAre(3, 4, 5, 1, 2));
  // The most votes; of as many the plain numbering.
  EXPECT_THAT(numbering_of({{1, 3}, {2, 4}, {3, 3}}), ElementsAre(3, 4, 5, 1, 2));
  EXPECT_THAT(numbering_of({{1, 2}, {2, 2}}), ElementsAre(1, 2, 3, 4, 5));
  // Against the rotation: four different numbers must show it.
  EXPECT_THAT(numbering_of({{1, 2}, {2, 1}, {3, 5}, {4, 4}}), ElementsAre(2, 1, 5, 4, 3));
  EXPECT_THAT(numbering_of({{1, 2}, {2, 1}, {3, 5}, {3, 5}}), ElementsAre(3, 4, 5, 1, 2));
}

// ---- Whole records

constexpr double kTurned = 22;  // deg, S2 about x

compare::FrameAxes frames() {
  return {{"S1", compare::kNoTurn}, {"S2", compare::turned_axes("XYZ", {kTurned, 0, 0})}};
}

// A curve of its own for each number.
double wave(int number, double theta_deg) {
  const double t = radians(theta_deg), n = number;
  return 3 + 0.4 * n + (5 + 0.3 * n) * std::sin(t + 0.37 * n * n) +
         (2 + 0.2 * n) * std::cos(2 * t - 0.61 * n) + 1.3 * std::sin(3 * t + 1.7 * n) +
         0.7 * std::cos(5 * t + 0.9 * n * n);
}

constexpr int kPistons = 5;

// Of a pump of five pistons: a force on each with two components in S2, another with three in S1, a
// torque and the pressures; the pistons' curves are one curve, a pitch apart.
struct Value {
  Channel channel;
  std::function<double(double)> at;
};
std::vector<Value> values_of_model() {
  std::vector<Value> out;
  const auto add = [&](const std::string& quantity, int piston, const std::string& axis,
                       const std::string& unit, double si, ChannelKind kind,
                       std::function<double(double)> at) {
    Channel c;
    c.quantity = c.group = quantity;
    c.piston = piston;
    c.axis = axis;
    c.frame = axis.empty() ? "" : "S" + axis.substr(1);
    c.unit = unit;
    c.unit_in_si = si;
    c.kind = kind;
    c.name = quantity + (piston > 0 ? "_" + std::to_string(piston) : "") +
             (axis.empty() ? "" : "_" + axis) + "_" + unit;
    out.push_back({c, std::move(at)});
  };
  for (int k = 1; k <= kPistons; ++k) {
    const double behind = 72.0 * (k - 1);
    add("Rs", k, "x2", "N", 1, ChannelKind::reaction,
        [=](double t) { return 100 * wave(1, t - behind); });
    add("Rs", k, "y2", "N", 1, ChannelKind::reaction,
        [=](double t) { return 170 * wave(2, t - behind); });
    add("p", k, "", "bar", 1e5, ChannelKind::input,
        [=](double t) { return 20 * wave(3, t - behind); });
  }
  for (int axis = 0; axis < 3; ++axis)
    add("Rb1", 0, std::string(1, "xyz"[axis]) + "1", "N", 1, ChannelKind::reaction,
        [=](double t) { return (900 + 300 * axis) * wave(4 + axis, t); });
  add("Td", 0, "z1", "Nm", 1, ChannelKind::reaction, [](double t) { return 40 * wave(7, t); });
  add("check", 0, "", "N", 1, ChannelKind::check, [](double t) { return 11 * wave(8, t); });
  return out;
}

ResultTable model() {
  ResultTable table;
  const auto values = values_of_model();
  for (const Value& value : values) table.channels.push_back(value.channel);
  for (int row = 0; row < 360; ++row) {
    table.theta_deg.push_back(row);
    for (const Value& value : values) table.values.push_back(value.at(row));
  }
  return table;
}

double ours(const std::string& name, double theta) {
  for (const Value& value : values_of_model())
    if (value.channel.name == name) return value.at(theta);
  ADD_FAILURE() << name;
  return 0;
}

using Curve = std::function<double(double theta)>;
struct Column {
  std::string name, unit;
  Curve at;
};
// theta = sign x angle + phase, a row per degree.
ForeignTable record(double sign, double phase, const std::vector<Column>& columns) {
  std::vector<std::string> header = {"angle"};
  std::vector<std::vector<double>> values = {steps(0, 1, 360)};
  for (const Column& column : columns) {
    header.push_back(column.name);
    values.emplace_back();
    for (const double angle : values[0]) values.back().push_back(column.at(sign * angle + phase));
  }
  ForeignTable table = table_of(header, values);
  table.units[0] = "deg";
  for (std::size_t c = 0; c < columns.size(); ++c) table.units[c + 1] = columns[c].unit;
  return table;
}
Curve of(const std::string& name, double factor = 1) {
  return [=](double theta) { return factor * ours(name, theta); };
}
MappingGuess guess(const ForeignTable& table) {
  return guess_mapping(table, model(), frames(), 3600);
}

// "theirs -> factor x ours, unit" of each column, sorted.
std::vector<std::string> columns_of(const MappingGuess& found) {
  std::vector<std::string> out;
  for (const auto& c : found.curve.columns)
    out.push_back(c.theirs + " -> " + number_text(c.factor) + " " + c.ours + ", " + c.unit);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(MappingRecords, ColumnsSignsUnitsAndPhase) {
  ForeignTable table = record(-1, 37.5,
                              {{"Fx", "kN", of("Rb1_x1_N", -1e-3)},
                               {"Fy", "kN", of("Rb1_y1_N", -1e-3)},
                               {"Fz", "kN", of("Rb1_z1_N", -1e-3)},
                               {"shaft", "", of("Td_z1_Nm", 1e3)},
                               {"p2", "MPa", of("p_2_bar", 0.1)},
                               {"p3", "bar", of("p_3_bar", 0.1)},
                               {"noise", "", [](double t) { return std::cos(radians(61 * t)); }}});
  table.digits = {0, 5, 4, 6, 0, 5, 5, 7};
  const MappingGuess found = guess(table);
  EXPECT_THAT(columns_of(found), ElementsAre("Fx -> -1 Rb1_x1_N, kN", "Fy -> -1 Rb1_y1_N, kN",
                                             "Fz -> -1 Rb1_z1_N, kN", "p2 -> 1 p_2_bar, MPa",
                                             "p3 -> 1 p_3_bar, MPa", "shaft -> 1 Td_z1_Nm, Nmm"));
  EXPECT_TRUE(found.curve.vectors.empty());
  EXPECT_TRUE(found.curve.guessed);
  EXPECT_EQ(found.curve.points, 360);
  EXPECT_EQ(found.curve.angle.column, "angle");
  EXPECT_EQ(found.curve.angle.sign, -1);
  EXPECT_EQ(found.curve.angle.offset_deg, 37.5);
  EXPECT_FALSE(found.curve.angle.turn_from_deg);
  EXPECT_EQ(found.samples, 0);  // half a step off
  EXPECT_EQ(found.digits, 4);
  EXPECT_EQ(found.recognised(), 6U);
  EXPECT_THAT(found.ignored, ElementsAre(Pair("noise", "no channel has a similar curve")));
  EXPECT_THAT(found.curve.ignored, ElementsAre("noise"));
  // Half of the last digit over the peak: of Fy, whose column reaches 10 kN and more, 5 N.
  double largest = 0;
  for (const auto& row : table.rows) largest = std::max(largest, std::abs(row[2]));
  ASSERT_GT(largest, 10);
  ASSERT_LT(largest, 100);
  EXPECT_DOUBLE_EQ(found.rounding, 5 / model().peak("Rb1"));
  ASSERT_EQ(found.proposals.size(), 4U);
  for (const MappingProposal& p : found.proposals) {
    EXPECT_NEAR(p.correlation, 1, 1e-9) << p.theirs;
    EXPECT_LT(p.difference, 1e-5) << p.theirs;
    EXPECT_EQ(p.remark, p.theirs == "p3" ? "the file says bar" : "") << p.theirs;
    EXPECT_EQ(p.sign, p.ours == "Rb1" ? -1 : 1);
  }
}

TEST(MappingRecords, WholeDegreesAreTheAnglesOfARun) {
  const MappingGuess found =
      guess(record(1, -23, {{"Td", "Nm", of("Td_z1_Nm")}, {"p1", "bar", of("p_1_bar")}}));
  EXPECT_EQ(found.curve.angle.offset_deg, -23);
  EXPECT_EQ(found.curve.angle.sign, 1);
  EXPECT_EQ(found.samples, 360);
  EXPECT_EQ(found.rounding, 0);
  EXPECT_EQ(found.digits, 0);
}

TEST(MappingRecords, SmallNumbersCorrelateToo) {
  const MappingGuess found = guess(record(1, 10,
                                          {{"Fx", "MN", of("Rb1_x1_N", 1e-6)},
                                           {"Fy", "MN", of("Rb1_y1_N", 1e-6)},
                                           {"Fz", "MN", of("Rb1_z1_N", 1e-6)}}));
  ASSERT_EQ(found.proposals.size(), 1U);
  EXPECT_NEAR(found.proposals[0].correlation, 1, 1e-9);
}

TEST(MappingRecords, ALongerRecordAndOneOverTime) {
  // 20 ms at 3600 deg/s are 72 deg: a turn is 100 ms. The last of 1.5 turns.
  ForeignTable table = record(1, 12, {{"Td", "Nm", of("Td_z1_Nm")}});
  for (int angle = 360; angle <= 540; ++angle)
    table.rows.push_back({double(angle), ours("Td_z1_Nm", angle + 12)}), table.lines.push_back(1);
  MappingGuess found = guess(table);
  EXPECT_EQ(found.curve.angle.offset_deg, 12);
  EXPECT_EQ(found.curve.angle.turn_from_deg, 12 + 180);
  for (auto& row : table.rows) row[0] /= 3600;
  table.header[0] = "time";
  table.units[0] = "s";
  found = guess(table);
  EXPECT_TRUE(found.curve.angle.is_time);
  EXPECT_EQ(found.curve.angle.offset_deg, 12);
  EXPECT_NEAR(*found.curve.angle.turn_from_deg, 12 + 180, 1e-9);
  EXPECT_EQ(found.curve.angle.sign, 1);
  // Against our direction: theta = -angle + 12, which turns from -540 + 12.
  table = record(-1, 12, {{"Td", "Nm", of("Td_z1_Nm")}});
  for (int angle = 360; angle <= 540; ++angle)
    table.rows.push_back({double(angle), ours("Td_z1_Nm", 12 - angle)}), table.lines.push_back(1);
  found = guess(table);
  EXPECT_EQ(found.curve.angle.sign, -1);
  EXPECT_EQ(found.curve.angle.turn_from_deg, 12 - 180 - 360);
}

// The force on the block, and those on two pistons, in one frame out of S1.
struct InFrame {
  Axes axes = compare::kNoTurn;
  double sign_of_rb1 = 1;
  double piston_tilt_deg = 0;  // by which the axes of the pistons are off
  double noise = 0;            // of Rb1, over its size
  bool without_pistons = false;
};
std::vector<Column> in_frame(const InFrame& theirs) {
  const Axes s2 = compare::turned_axes("XYZ", {kTurned + theirs.piston_tilt_deg, 0, 0});
  std::vector<Column> out;
  for (std::size_t j = 0; j < 3; ++j)
    out.push_back(
        {std::string("Rb1") + "xyz"[j], "N", [=](double t) {
           const double v[] = {ours("Rb1_x1_N", t), ours("Rb1_y1_N", t), ours("Rb1_z1_N", t)};
           double sum =
               7000 * theirs.noise * std::cos(radians((61.0 + 7 * static_cast<double>(j)) * t));
           for (std::size_t i = 0; i < 3; ++i) sum += theirs.sign_of_rb1 * theirs.axes[j][i] * v[i];
           return sum;
         }});
  for (const std::string piston : {"1", "3"})
    for (std::size_t j = 0; j < 3 && !theirs.without_pistons; ++j)
      out.push_back({"Rs_" + piston + " " + "xyz"[j], "N", [=](double t) {
                       const double x = ours("Rs_" + piston + "_x2_N", t);
                       const double y = ours("Rs_" + piston + "_y2_N", t);
                       double sum = 0;
                       for (std::size_t i = 0; i < 3; ++i)
                         sum += theirs.axes[j][i] * (s2[0][i] * x + s2[1][i] * y);
                       return sum;
                     }});
  return out;
}
double largest_difference(const MappingGuess& found) {
  double largest = 0;
  for (const MappingProposal& p : found.proposals) largest = std::max(largest, p.difference);
  return largest;
}

TEST(MappingRecords, OneFrameAtRightAngles) {
  const Axes theirs = {{{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}};
  const MappingGuess found = guess(record(1, 40, in_frame({theirs, -1})));
  EXPECT_EQ(found.curve.frame.axes_of, "S1");
  EXPECT_EQ(found.curve.frame.cosines, theirs);
  EXPECT_EQ(found.curve.frame.words, "the axes of S1, exchanged");
  EXPECT_EQ(found.euler, "");
  ASSERT_EQ(found.curve.vectors.size(), 3U);
  EXPECT_EQ(found.curve.vectors[0].ours, "Rb1");
  EXPECT_EQ(found.curve.vectors[0].factor, -1);
  EXPECT_THAT(found.curve.vectors[0].theirs, ElementsAre("Rb1x", "Rb1y", "Rb1z"));
  EXPECT_EQ(found.curve.vectors[1].ours, "Rs_1");
  EXPECT_EQ(found.curve.vectors[1].factor, 1);
  EXPECT_EQ(found.recognised(), 9U);
  EXPECT_EQ(found.curve.angle.offset_deg, 40);
  EXPECT_LT(largest_difference(found), 1e-5);
}

// The frame that a description says, out of S1.
Axes frame_of(const MappingGuess& found) {
  EXPECT_EQ(found.curve.frame.axes_of, "S1");
  const Axes axes = compare::turned_axes(found.euler, found.euler_deg);
  EXPECT_NEAR(trace_of(axes, found.curve.frame.cosines), 3, 1e-14);
  return axes;
}
double degrees_apart(const Axes& a, const Axes& b) {
  // By the sine of the half angle: the cosine of a small one tells little.
  double square = 0;
  for (std::size_t j = 0; j < 3; ++j)
    for (std::size_t i = 0; i < 3; ++i) square += std::pow(a[j][i] - b[j][i], 2);
  return 2 * std::asin(std::sqrt(square / 8)) / kRadPerDegree;
}

TEST(MappingRecords, OneFrameAtAnyAngle) {
  for (const Turn& turn : kTurns)
    for (const double sign_of_rb1 : {1.0, -1.0}) {
      SCOPED_TRACE(std::string(turn.sequence) + " " + number_text(turn.deg[0]) + " " +
                   number_text(turn.deg[1]) + " " + number_text(turn.deg[2]));
      const Axes theirs = compare::turned_axes(turn.sequence, turn.deg);
      const MappingGuess found = guess(record(1, 40, in_frame({theirs, sign_of_rb1})));
      EXPECT_LT(degrees_apart(frame_of(found), theirs), 1e-9);  // they are round
      EXPECT_EQ(found.recognised(), 9U);
      EXPECT_EQ(found.curve.angle.offset_deg, 40);
      EXPECT_LT(largest_difference(found), 1e-5);
      for (const auto& vector : found.curve.vectors)
        EXPECT_EQ(vector.factor, vector.ours == "Rb1" ? sign_of_rb1 : 1) << vector.ours;
    }
  const MappingGuess found =
      guess(record(1, 40, in_frame({compare::turned_axes("XYZ", {17.3, 41.9, -8.2})})));
  EXPECT_EQ(found.euler, "XYZ");
  EXPECT_THAT(found.euler_deg, ElementsAre(17.3, 41.9, -8.2));
  EXPECT_EQ(found.curve.frame.words, "the axes of S1, turned by 17.3, 41.9, -8.2 deg about XYZ");
}

TEST(MappingRecords, AnglesOfZeroHaveNoSign) {
  for (const double deg : {30.0, -30.0}) {
    for (const std::array<double, 3> turn :
         {std::array{deg, 0.0, 0.0}, std::array{0.0, 0.0, deg}}) {
      const MappingGuess found =
          guess(record(1, 40, in_frame({compare::turned_axes("XYZ", turn)})));
      for (const double angle : found.euler_deg) EXPECT_FALSE(angle == 0 && std::signbit(angle));
      EXPECT_THAT(found.curve.frame.words, testing::HasSubstr("turned by"));
      EXPECT_THAT(found.curve.frame.words, testing::Not(testing::HasSubstr("-0,")));
      EXPECT_THAT(found.curve.frame.words, testing::Not(testing::HasSubstr("-0 deg")));
    }
  }
}

TEST(MappingRecords, AFrameAtRandomAngles) {
  std::mt19937 random(20261);
  std::uniform_real_distribution<double> any(-180, 180);
  for (int i = 0; i < 12; ++i) {
    const std::array<double, 3> deg = {any(random), any(random), any(random)};
    const Axes theirs = compare::turned_axes("ZXZ", deg);
    const MappingGuess found = guess(record(-1, -63, in_frame({theirs, -1})));
    EXPECT_LT(degrees_apart(frame_of(found), theirs), 1e-3) << deg[0] << " " << deg[1];
    EXPECT_EQ(found.recognised(), 9U);
    EXPECT_LT(largest_difference(found), 1e-4);
  }
}

TEST(MappingRecords, NoiseTurnsTheFrameLittle) {
  const Axes theirs = compare::turned_axes("XYZ", {17.3, 41.9, -8.2});
  const MappingGuess found = guess(record(1, 40, in_frame({theirs, 1, 0, 0.05})));
  EXPECT_LT(degrees_apart(frame_of(found), theirs), 0.1);
  EXPECT_GT(largest_difference(found), 0.02);
}

// What no rotation explains, or what a small one would hide, stays different.
TEST(MappingRecords, AFrameDoesNotFitAWrongModel) {
  const Axes turned = compare::turned_axes("XYZ", {17.3, 41.9, -8.2});
  struct {
    const char* what;
    InFrame theirs;
    double least_difference;
  } const cases[] = {
      {"the pistons tilted by 2 deg, at right angles", {compare::kNoTurn, 1, 2}, 0.01},
      {"the pistons tilted by 2 deg, in a frame at any angle", {turned, 1, 2}, 0.01},
      {"axes off by 3 deg", {compare::turned_axes("XYZ", {2, 1, 2})}, 0.03},
      {"axes at right angles off by 4 deg", {compare::turned_axes("XYZ", {90, 4, 0})}, 0.04},
      {"a single vector whose axes are off by 3 deg",
       {compare::turned_axes("ZXZ", {90, 3, 0}), 1, 0, 0, true},
       0.01}};
  for (const auto& c : cases)
    EXPECT_GT(largest_difference(guess(record(1, 40, in_frame(c.theirs)))), c.least_difference)
        << c.what;
  // Left-handed axes, where no sign of the force on the other body is shown.
  Axes mirror = turned;
  for (double& cosine : mirror[1]) cosine = -cosine;
  EXPECT_THROW(guess(record(1, 40, in_frame({mirror, 1, 0, 0, true}))), InputError);
}

TEST(MappingRecords, AWrongVectorDoesNotTurnTheFrameOfTheOthers) {
  const Axes theirs = compare::turned_axes("XYZ", {17.3, 41.9, -8.2});
  const auto spoilt = [&](std::size_t column, double factor) {
    auto columns = in_frame({theirs});
    columns[column].at = [factor, right = columns[column].at](double t) {
      return factor * right(t);
    };
    return guess(record(1, 40, columns));
  };
  // Of Rb1 not y: the pistons' forces lie in a plane, so that half a turn with their other sign
  // would fit as well.
  for (const std::size_t column : {0U, 2U, 4U, 8U})
    for (const double factor : {-1.0, 1.02}) {
      const MappingGuess found = spoilt(column, factor);
      SCOPED_TRACE(testing::Message() << column << " " << factor);
      EXPECT_LT(degrees_apart(frame_of(found), theirs), 1e-3);
      int wrong = 0;
      for (const MappingProposal& p : found.proposals) wrong += p.difference > 1e-3;
      EXPECT_EQ(wrong + static_cast<int>(found.unrecognised.size()) / 3, 1);
    }
}

TEST(MappingRecords, AWrongSignOfOneComponentIsComparedNotLeftOut) {
  // Two vectors that are right show the frame.
  std::vector<Column> columns = {{"Rb1x", "N", of("Rb1_x1_N", -1)}, {"Rb1y", "N", of("Rb1_y1_N")},
                                 {"Rb1z", "N", of("Rb1_z1_N")},     {"f1_x", "N", of("Rs_1_x2_N")},
                                 {"f1_y", "N", of("Rs_1_y2_N")},    {"f3_x", "N", of("Rs_3_x2_N")},
                                 {"f3_y", "N", of("Rs_3_y2_N")}};
  const MappingGuess found = guess(record(1, 40, columns));
  EXPECT_EQ(found.recognised(), 7U);
  EXPECT_THAT(columns_of(found),
              testing::IsSupersetOf(
                  {"Rb1x -> 1 Rb1_x1_N, N", "Rb1y -> 1 Rb1_y1_N, N", "Rb1z -> 1 Rb1_z1_N, N"}));
  ASSERT_EQ(found.proposals.size(), 3U);
  EXPECT_EQ(found.proposals[0].theirs, "Rb1x, Rb1y, Rb1z");  // worst first
  EXPECT_EQ(found.proposals[0].remark, "signs differ, or only the name matches");
  double wrong = 0, all = 0;
  for (const auto& row : record(1, 40, columns).rows) {
    wrong += 4 * row[1] * row[1];
    all += row[1] * row[1] + row[2] * row[2] + row[3] * row[3];
  }
  EXPECT_NEAR(found.proposals[0].difference, std::sqrt(wrong / all), 1e-5);
  EXPECT_LT(found.proposals[1].difference, 1e-5);
}

// A force on the block, those on two pistons and the torque, one column of them wrong.
MappingGuess with_wrong(const std::string& column, const Curve& at) {
  std::vector<Column> columns = {{"Bx", "N", of("Rb1_x1_N")},    {"By", "N", of("Rb1_y1_N")},
                                 {"Bz", "N", of("Rb1_z1_N")},    {"f1_x", "N", of("Rs_1_x2_N")},
                                 {"f1_y", "N", of("Rs_1_y2_N")}, {"f3_x", "N", of("Rs_3_x2_N")},
                                 {"f3_y", "N", of("Rs_3_y2_N")}, {"Td", "Nm", of("Td_z1_Nm")}};
  for (Column& one : columns)
    if (one.name == column) one.at = at;
  return guess(record(1, 40, columns));
}

// A vector with one bad component is no other curve of the pump: it must not go unseen.
TEST(MappingRecords, AVectorOfWhichSomeFitsMustBeDecided) {
  const Curve nothing = [](double) { return 0.0; };
  for (const Curve& bad : {nothing, of("Rb1_y1_N", 1e-3), of("Rb1_y1_N", 5)}) {
    const MappingGuess found = with_wrong("By", bad);
    EXPECT_EQ(found.curve.angle.offset_deg, 40);
    EXPECT_THAT(found.unrecognised, ElementsAre("Bx", "By", "Bz"));
    EXPECT_THAT(found.ignored,
                testing::Contains(Pair("By", testing::HasSubstr("Bx looks like Rb1_x1_N"))));
    EXPECT_EQ(found.recognised(), 5U);
  }
}

TEST(MappingRecords, AColumnOfAnotherSizeMustBeDecided) {
  const MappingGuess found = guess(record(1, 0,
                                          {{"Bx", "N", of("Rb1_x1_N")},
                                           {"By", "N", of("Rb1_y1_N")},
                                           {"Bz", "N", of("Rb1_z1_N")},
                                           {"load", "Nm", of("Td_z1_Nm", 3)}}));
  EXPECT_THAT(found.unrecognised, ElementsAre("load"));
  EXPECT_THAT(
      found.ignored,
      ElementsAre(Pair("load", testing::HasSubstr("looks like Td_z1_Nm, but is of another"))));
}

// Whichever of the components it is: its vector is wrong, and no frame that turns the others.
TEST(MappingRecords, AWrongSignStaysOnItsVector) {
  for (const auto& [column, name] : std::vector<std::pair<std::string, std::string>>{
           {"Bx", "Rb1_x1_N"}, {"By", "Rb1_y1_N"}, {"Bz", "Rb1_z1_N"}}) {
    const MappingGuess found = with_wrong(column, of(name, -1));
    SCOPED_TRACE(column);
    EXPECT_TRUE(found.curve.vectors.empty());  // nothing is turned
    EXPECT_EQ(found.recognised(), 8U);
    for (const MappingProposal& p : found.proposals) {
      EXPECT_EQ(p.difference > 1e-4, p.ours == "Rb1") << p.ours;
      EXPECT_EQ(p.sign, 1) << p.ours;
    }
  }
}

TEST(MappingRecords, TwoComponentsExchangedMustBeDecided) {
  std::vector<Column> columns = {{"Bx", "N", of("Rb1_y1_N")},    {"By", "N", of("Rb1_x1_N")},
                                 {"Bz", "N", of("Rb1_z1_N")},    {"f1_x", "N", of("Rs_1_x2_N")},
                                 {"f1_y", "N", of("Rs_1_y2_N")}, {"f3_x", "N", of("Rs_3_x2_N")},
                                 {"f3_y", "N", of("Rs_3_y2_N")}, {"Td", "Nm", of("Td_z1_Nm")}};
  const MappingGuess found = guess(record(1, 40, columns));
  for (const MappingProposal& p : found.proposals)
    EXPECT_EQ(p.difference > 1e-4, p.ours == "Rb1") << p.ours;
  for (const auto& vector : found.curve.vectors) EXPECT_EQ(vector.ours, "Rb1");
}

TEST(MappingRecords, ACurveThatLagsDoesNotMoveTheOthers) {
  const MappingGuess found = with_wrong("Td", [](double t) { return ours("Td_z1_Nm", t - 5); });
  EXPECT_EQ(found.curve.angle.offset_deg, 40);
  for (const MappingProposal& p : found.proposals)
    EXPECT_EQ(p.difference > 1e-4, p.ours == "Td_z1_Nm") << p.ours;
}

// What pressure drives is late, what turns with the shaft is not: no shift of the file.
TEST(MappingRecords, ASmallShiftIsTakenOnlyWhereItFits) {
  const auto first_harmonic = [](const std::string& name) {
    double cosine = 0, sine = 0;
    for (int deg = 0; deg < 360; ++deg) {
      cosine += ours(name, deg) * std::cos(radians(deg)) / 180;
      sine += ours(name, deg) * std::sin(radians(deg)) / 180;
    }
    return [=](double t) { return cosine * std::cos(radians(t)) + sine * std::sin(radians(t)); };
  };
  const auto late = [&](bool all) {
    std::vector<Column> columns;
    for (const auto& [theirs, name] : std::vector<std::pair<std::string, std::string>>{
             {"Bx", "Rb1_x1_N"}, {"By", "Rb1_y1_N"}, {"Bz", "Rb1_z1_N"}, {"Td", "Td_z1_Nm"}})
      columns.push_back({theirs, "", [name = name, all, first = first_harmonic(name)](double t) {
                           return ours(name, t - 3) + (all ? 0 : first(t) - first(t - 3));
                         }});
    return guess(record(1, 0, columns));
  };
  const MappingGuess mixed = late(false);
  EXPECT_EQ(mixed.curve.angle.offset_deg, 0);
  EXPECT_LT(mixed.shift_not_taken_deg, -0.5);
  EXPECT_GT(mixed.shift_not_taken_deg, -2.5);
  const MappingGuess whole = late(true);
  EXPECT_EQ(whole.curve.angle.offset_deg, -3);
  EXPECT_EQ(whole.shift_not_taken_deg, 0);
}

TEST(MappingRecords, AColumnWithSomeEmptyFieldsMustBeDecided) {
  ForeignTable table = record(1, 0, {{"Td", "Nm", of("Td_z1_Nm")}, {"p_1", "bar", of("p_1_bar")}});
  table.rows[7][1] = not_computed();
  const MappingGuess found = guess(table);
  EXPECT_THAT(found.unrecognised, ElementsAre("Td"));
  EXPECT_THAT(found.ignored, ElementsAre(Pair("Td", "not recognised: has empty fields: 1 of 360")));
}

// The same pump a million times smaller: sizes mean nothing.
TEST(MappingRecords, AWrongSignIsComparedInASmallPumpToo) {
  constexpr double kSize = 1e-6;
  ResultTable small = model();
  for (double& value : small.values) value *= kSize;
  std::vector<Column> columns;
  for (const auto& [theirs, name, sign] :
       std::vector<std::tuple<std::string, std::string, int>>{{"Rb1x", "Rb1_x1_N", -1},
                                                              {"Rb1y", "Rb1_y1_N", 1},
                                                              {"Rb1z", "Rb1_z1_N", 1},
                                                              {"f1_x", "Rs_1_x2_N", 1},
                                                              {"f1_y", "Rs_1_y2_N", 1},
                                                              {"f3_x", "Rs_3_x2_N", 1},
                                                              {"f3_y", "Rs_3_y2_N", 1}})
    columns.push_back({theirs, "N", of(name, sign * kSize)});
  const MappingGuess found = guess_mapping(record(1, 40, columns), small, frames(), 3600);
  EXPECT_EQ(found.recognised(), 7U);
  EXPECT_EQ(found.proposals.at(0).remark, "signs differ, or only the name matches");
}

// Rs of pistons, each of which is number(k) of ours.
std::vector<Column> numbered(const std::function<int(int)>& number) {
  std::vector<Column> out;
  for (int k = 1; k <= kPistons; ++k) {
    const std::string ours_name = "Rs_" + std::to_string(number(k));
    const std::string theirs = "f" + std::to_string(k);
    out.push_back({theirs + "_x", "N", of(ours_name + "_x2_N")});
    out.push_back({theirs + "_y", "N", of(ours_name + "_y2_N")});
  }
  return out;
}

TEST(MappingRecords, PistonsMixedUpStaySo) {
  // 2 and 4 exchanged: the numbers in the names count, and the differences show.
  const MappingGuess found =
      guess(record(1, 40, numbered([](int k) { return k == 2   ? 4
                                                      : k == 4 ? 2
                                                               : k; })));
  for (const MappingProposal& p : found.proposals) {
    EXPECT_EQ(p.ours.substr(3), p.theirs.substr(1, 1)) << p.theirs;
    EXPECT_LT(p.difference, 1e-5) << p.theirs;
  }
  EXPECT_EQ(found.proposals.size(), 3U);
  EXPECT_THAT(found.unrecognised, testing::UnorderedElementsAre("f2_x", "f2_y", "f4_x", "f4_y"));
  EXPECT_EQ(found.recognised(), 6U);
  EXPECT_THAT(found.curve.ignored, testing::IsSupersetOf({"f2_x", "f4_y"}));
  EXPECT_EQ(found.curve.angle.offset_deg, 40);
}

TEST(MappingRecords, PistonsNumberedAgainstTheRotation) {
  const MappingGuess found = guess(record(1, 40, numbered([](int k) { return (7 - k) % 5 + 1; })));
  for (const MappingProposal& p : found.proposals) EXPECT_LT(p.difference, 1e-5) << p.theirs;
}

TEST(MappingRecords, AVectorWithoutAPistonShowsNoNumbering) {
  // Three pistons do not show a reversal, and the number in the name of another force adds none.
  auto columns = numbered([](int k) { return (7 - k) % 5 + 1; });
  columns.resize(6);
  for (const std::string axis : {"x", "y", "z"})
    columns.push_back({"Fb4 " + axis, "N", of("Rb1_" + axis + "1_N")});
  EXPECT_THAT(guess(record(1, 40, columns)).unrecognised, testing::Not(IsEmpty()));
}

// A column whose name says Td and whose curve has a given correlation with it.
TEST(MappingRecords, ACorrelationBelowTheLeastIsNotRecognised) {
  const auto with = [](double correlation) {
    const double other = std::sqrt(1 - correlation * correlation);
    // As large as Td about its mean, and without correlation to it: a harmonic that it lacks.
    double own = 0, mixed = 0, mean = 0;
    for (int i = 0; i < 360; ++i) mean += ours("Td_z1_Nm", i) / 360;
    for (int i = 0; i < 360; ++i) {
      own += std::pow(ours("Td_z1_Nm", i) - mean, 2);
      mixed += std::pow(std::cos(radians(61 * i)), 2);
    }
    const double size = std::sqrt(own / mixed);
    return guess(record(1, 40,
                        {{"Fx", "N", of("Rb1_x1_N")},
                         {"Fy", "N", of("Rb1_y1_N")},
                         {"Fz", "N", of("Rb1_z1_N")},
                         {"f1_x", "N", of("Rs_1_x2_N")},
                         {"f1_y", "N", of("Rs_1_y2_N")},
                         {"Td_z1", "Nm", [=](double t) {
                            return correlation * ours("Td_z1_Nm", t) +
                                   other * size * std::cos(radians(61 * t));
                          }}}));
  };
  const MappingGuess good = with(kMinCorrelation + 0.02);
  EXPECT_THAT(good.unrecognised, IsEmpty());
  EXPECT_EQ(good.recognised(), 6U);
  for (const double correlation : {kMinCorrelation - 0.02, 0.54}) {
    const MappingGuess found = with(correlation);
    EXPECT_THAT(found.unrecognised, ElementsAre("Td_z1")) << correlation;
    EXPECT_EQ(found.recognised(), 5U);
    EXPECT_THAT(found.curve.ignored, ElementsAre("Td_z1"));
    ASSERT_EQ(found.ignored.size(), 1U);
    EXPECT_THAT(found.ignored[0].second, testing::HasSubstr("not recognised: looks like Td_z1_Nm"));
    EXPECT_THAT(found.ignored[0].second, testing::HasSubstr("less than 0.8"));
  }
}

TEST(MappingRecords, OfAnotherPistonTheNumbersSayThePhase) {
  // One curve is piston 1 a pitch later or piston 2: its name says 2.
  EXPECT_EQ(guess(record(1, 31, {{"p_2", "bar", of("p_2_bar")}, {"p_3", "bar", of("p_3_bar")}}))
                .curve.angle.offset_deg,
            31);
  // Where no number says so the smallest shift.
  EXPECT_EQ(guess(record(1, 31 + 144, {{"p", "bar", of("p_2_bar")}})).curve.angle.offset_deg, 31);
}

TEST(MappingRecords, AColumnTwiceAndARecordOfAnotherPump) {
  const MappingGuess found = guess(record(1, 0,
                                          {{"Td", "Nm", of("Td_z1_Nm")},
                                           {"copy", "Nm", of("Td_z1_Nm")},
                                           {"empty", "Nm", [](double) { return not_computed(); }},
                                           {"along", "Nm", [](double t) { return t; }}}));
  EXPECT_THAT(found.ignored, ElementsAre(Pair("empty", "has empty fields: 360 of 360"),
                                         Pair("along", "is proportional to the angle"),
                                         Pair("copy", "like another column, looks like Td_z1_Nm")));
  EXPECT_THAT(found.unrecognised, IsEmpty());
  EXPECT_EQ(found.curve.angle.offset_deg, 0);
  EXPECT_THROW(guess(record(1, 0, {{"a", "", [](double t) { return std::cos(radians(61 * t)); }}})),
               InputError);
}

}  // namespace
}  // namespace bentaxis::study::mapping
