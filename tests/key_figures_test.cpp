// The numbers that a report says first, from tables whose peaks and means are known.
#include "key_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

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

// A block that turns at 1500 rpm 0.1 sin(2 theta) deg behind the shaft, with a couple of known
// size.
TEST(KeyFiguresTest, AUniversalJointHasLagRippleAndSideCouples) {
  PumpParameters pump;
  pump.geometry.pistons = 2;
  pump.geometry.tilt = kPi / 6;
  pump.transfer.kind = TransferKind::cardan;
  ResultTable made;
  made.name = "only";
  made.channels = ChannelLayout(pump).channels();
  for (int i = 0; i < 72; ++i) made.theta_deg.push_back(5.0 * i);
  made.values.assign(made.rows() * made.columns(), 0);
  for (std::size_t row = 0; row < made.rows(); ++row) {
    const double t = made.theta_deg[row] * kPi / 180;
    const double psi = made.theta_deg[row] - 0.1 * std::sin(2 * t);
    value(made, "psi_deg", row) = psi;
    value(made, "psi_rpm", row) = 1500 + 75 * std::cos(2 * t);
    value(made, "Tcs_x2_Nm", row) = row == 9 ? 3 : 0;
    value(made, "Tcs_y2_Nm", row) = row == 9 ? 4 : 0;
    // Ends of the strokes at 1 and 181 deg of the first bore, 0 and 180 of the other.
    value(made, "zB_1_z2_mm", row) = 10 * std::cos((psi - 1) * kPi / 180);
    value(made, "zB_2_z2_mm", row) = 10 * std::cos((psi - 180) * kPi / 180);
  }
  const auto rows = transfer_figures({&made}, pump);
  const auto of = [&](const std::string& quantity) {
    for (const auto& row : rows)
      if (row.quantity == quantity) return row;
    ADD_FAILURE() << "no " << quantity;
    return report::KeyFigures::Row{};
  };
  EXPECT_NEAR(of("lag of the block, smallest").values.at(0), -0.1, 1e-9);
  EXPECT_NEAR(of("lag of the block, largest").values.at(0), 0.1, 1e-9);
  EXPECT_EQ(of("lag of the block, largest").at, 45);
  EXPECT_NEAR(of("speed of the block, maximum less minimum over the mean").values.at(0), 10, 1e-9);
  EXPECT_DOUBLE_EQ(of("side couple on the block, peak").values.at(0), 5);
  EXPECT_EQ(of("side couple on the block, peak").at, 45);
  EXPECT_NEAR(of("side couple on the shaft, peak").values.at(0),
              std::hypot(3, 4 * std::cos(kPi / 6)), 1e-12);
  EXPECT_NEAR(of("inner dead centre, earliest of the pistons").values.at(0), 0, 2e-3);
  EXPECT_NEAR(of("inner dead centre, latest of the pistons").values.at(0), 1, 2e-3);
  EXPECT_NEAR(of("outer dead centre, earliest of the pistons").values.at(0), 180, 2e-3);
  EXPECT_NEAR(of("outer dead centre, latest of the pistons").values.at(0), 181, 2e-3);
  // A gear has none of this.
  ResultTable gear = table("gear");
  EXPECT_TRUE(transfer_figures({&gear}, PumpParameters()).empty());
}

// Two pistons push alike to round-off. At 120 deg piston 2 pushes more: it takes over there, and
// piston 1 does again where the turn closes on itself.
TEST(KeyFiguresTest, PistonsThatCarryHandOver) {
  PumpParameters pump;
  pump.geometry.pistons = 2;
  pump.transfer.kind = TransferKind::pistons;
  ResultTable made;
  made.name = "only";
  made.channels = ChannelLayout(pump).channels();
  for (int i = 0; i < 36; ++i) made.theta_deg.push_back(10.0 * i);
  made.values.assign(made.rows() * made.columns(), 0);
  for (std::size_t row = 0; row < made.rows(); ++row) {
    const bool first = row < 9 || row >= 27;
    value(made, "lag_deg", row) = 1 + 0.01 * static_cast<double>(row);
    value(made, first ? "Rw_1_x2_N" : "Rw_2_x2_N", row) = 100;
    value(made, first ? "Rw_2_y2_N" : "Rw_1_y2_N", row) = 100 * (1 - 1e-9);  // no hand-over
  }
  value(made, "Rw_2_y2_N", 12) = 300;
  const auto rows = transfer_figures({&made}, pump);
  const auto values_of = [&](const std::string& quantity) {
    std::vector<double> values;
    for (const auto& row : rows)
      if (row.quantity == quantity) values.push_back(row.values.at(0));
    return values;
  };
  EXPECT_EQ(values_of("hand-overs from piston to piston per turn"), std::vector<double>{2});
  EXPECT_EQ(values_of("pistons that push at a time, at most"), std::vector<double>{2});
  ASSERT_EQ(values_of("lag of the block, largest").size(), 1);
  EXPECT_NEAR(values_of("lag of the block, largest")[0], 1.35, 1e-12);
  EXPECT_EQ(values_of("angle from which piston 1 carries most"), std::vector<double>{0});
  EXPECT_EQ(values_of("angle to which piston 1 carries most"), std::vector<double>{110});
  const auto peaks = turn_figures({&made});
  const auto* wall = find(peaks, "Rw", "N");
  ASSERT_NE(wall, nullptr);
  EXPECT_EQ(wall->note, "piston 2");
  EXPECT_EQ(wall->at.value(), 120);
}

// Where a piston carries over the end of the turn, its sector is one and ends above 360 deg.
TEST(KeyFiguresTest, ASectorMayCloseTheTurn) {
  PumpParameters pump;
  pump.geometry.pistons = 2;
  pump.transfer.kind = TransferKind::pistons;
  ResultTable made;
  made.name = "only";
  made.channels = ChannelLayout(pump).channels();
  for (int i = 0; i < 36; ++i) made.theta_deg.push_back(10.0 * i);
  made.values.assign(made.rows() * made.columns(), 0);
  for (std::size_t row = 0; row < made.rows(); ++row)
    value(made, row < 9 || row >= 27 ? "Rw_1_x2_N" : "Rw_2_x2_N", row) = 100;
  std::map<std::string, double> figures;
  for (const auto& row : transfer_figures({&made}, pump))
    EXPECT_TRUE(figures.emplace(row.quantity, row.values.at(0)).second) << row.quantity;
  EXPECT_EQ(figures["angle from which piston 1 carries most"], 270);
  EXPECT_EQ(figures["angle to which piston 1 carries most"], 440);
  EXPECT_EQ(figures["hand-overs from piston to piston per turn"], 2);
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
