// The numbers that a report says first, from tables whose peaks and means are known.
#include "key_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/pump/number.h"

namespace bentaxis::study {
namespace {

// A pump of two pistons at four angles: what is not set below is 0.
ResultTable table(const std::string& name) {
  ResultTable made;
  made.name = name;
  made.channels = ChannelLayout(2).channels();
  made.theta_deg = {0, 90, 180, 270};
  made.values.assign(made.rows() * made.columns(), 0);
  return made;
}

double& value(ResultTable& t, const std::string& channel, std::size_t row) {
  return t.values.at(row * t.columns() + t.find(channel));
}

const report::KeyFigures::Row* find(const std::vector<report::KeyFigures::Row>& rows,
                                    const std::string& symbol, const std::string& unit) {
  for (const auto& row : rows)
    if (row.symbol == symbol && row.unit == unit) return &row;
  return nullptr;
}

TEST(KeyFiguresTest, PeaksAreOfWholeVectorsAndSayWhichPistonAndWhen) {
  ResultTable first = table("first"), second = table("second");
  // 3-4-12: 13; one component alone is larger elsewhere.
  value(first, "Rs_2_x2_N", 2) = 3;
  value(first, "Rs_2_y2_N", 2) = -4;
  value(first, "Rs_2_z2_N", 2) = 12;
  value(first, "Rs_1_z2_N", 1) = -12.5;
  value(second, "Rs_1_z2_N", 3) = -13.5;
  const auto rows = turn_figures({&first, &second});
  const auto* rs = find(rows, "Rs", "N");
  ASSERT_NE(rs, nullptr);
  EXPECT_DOUBLE_EQ(rs->values.at(0), 13);
  EXPECT_DOUBLE_EQ(rs->values.at(1), 13.5);
  EXPECT_DOUBLE_EQ(rs->difference.value(), 0.5);
  EXPECT_DOUBLE_EQ(rs->over_value.value(), 0.5 / 13);
  EXPECT_DOUBLE_EQ(rs->at.value(), 180);
  EXPECT_EQ(rs->note, "piston 2");
}

// Pistons have the same peak one after the other, each with its own round-off: the first is named.
TEST(KeyFiguresTest, RoundOffDoesNotChooseThePiston) {
  ResultTable only = table("only");
  value(only, "Rc_1_x2_N", 1) = 1000;
  value(only, "Rc_2_x2_N", 3) = 1000 * (1 + 1e-13);
  const auto rows = turn_figures({&only});
  const auto* rc = find(rows, "Rc", "N");
  ASSERT_NE(rc, nullptr);
  EXPECT_DOUBLE_EQ(rc->at.value(), 90);
  EXPECT_EQ(rc->note, "piston 1");
  EXPECT_FALSE(rc->difference.has_value());
}

TEST(KeyFiguresTest, TorqueHasAMeanOverATurnAndAPeakInAMotion) {
  ResultTable only = table("only");
  const double torque[] = {90, 100, 110, 100};
  for (std::size_t row = 0; row < 4; ++row) value(only, "Td_z1_Nm", row) = torque[row];
  const auto turn = turn_figures({&only});
  EXPECT_DOUBLE_EQ(find(turn, "Td", "Nm")->values.at(0), 100);
  EXPECT_DOUBLE_EQ(find(turn, "Td", "%")->values.at(0), 20);
  const auto motion = motion_figures({&only}, {0, 1, 2, 3});
  EXPECT_DOUBLE_EQ(find(motion, "Td", "Nm")->values.at(0), 110);
  EXPECT_EQ(find(motion, "Td", "%"), nullptr);
}

// Without load there is no mean to measure ripple by; what no table has is no row.
TEST(KeyFiguresTest, WhatIsNotThereIsLeftOut) {
  ResultTable first = table("first"), second = table("second");
  for (std::size_t row = 0; row < 4; ++row) {
    value(first, "Td_z1_Nm", row) = row % 2 == 0 ? 1 : -1;
    for (ResultTable* t : {&first, &second}) value(*t, "Rcs_z4_N", row) = not_computed();
    value(second, "Fh_z2_N", row) = not_computed();
    value(first, "Fh_z2_N", row) = -7;
  }
  const auto rows = turn_figures({&first, &second});
  EXPECT_EQ(find(rows, "Td", "%"), nullptr);
  EXPECT_EQ(find(rows, "Rcs", "N"), nullptr);
  const auto* film = find(rows, "Fh", "N");
  ASSERT_NE(film, nullptr);
  EXPECT_DOUBLE_EQ(film->values.at(0), 7);
  EXPECT_TRUE(std::isnan(film->values.at(1)));
  EXPECT_FALSE(film->difference.has_value());
}

TEST(KeyFiguresTest, WhatTheOilDoesIsInUnitsOfTheField) {
  hydraulics::Summary summary;
  summary.flow = 1e-3;  // m3/s
  summary.flow_ripple = 0.05;
  summary.volumetric_efficiency = 0.97;
  summary.chamber_least = -5e4;
  summary.chamber_least_deg = 12;
  const auto rows = oil_figures(summary, 2);
  EXPECT_DOUBLE_EQ(rows.at(0).values.at(1), 60);
  EXPECT_DOUBLE_EQ(rows.at(1).values.at(0), 5);
  EXPECT_DOUBLE_EQ(rows.at(2).values.at(0), 97);
  EXPECT_DOUBLE_EQ(rows.at(3).values.at(0), -0.5);
  EXPECT_DOUBLE_EQ(rows.at(3).at.value(), 12);
  EXPECT_FALSE(rows.at(0).difference.has_value());
}

}  // namespace
}  // namespace bentaxis::study
