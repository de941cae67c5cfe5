// Transfers from shaft to block beside the gear: what a case may say, stored curves, and properties
// that no curve is needed for. docs/transfer.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <fstream>
#include <map>

#include "bentaxis/analytic/batch.h"
#include "bentaxis/analytic/body_loads.h"
#include "bentaxis/analytic/budget.h"
#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/analytic/derived.h"
#include "bentaxis/analytic/rounding.h"
#include "bentaxis/analytic/simulation.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/validate.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using analytic::FrozenLag;
using analytic::Model;
using testing::HasSubstr;

std::filesystem::path folder_of(const std::string& name) {
  const std::string set = name == "pistons_seven_free" ? "motion" : "transfers";
  return std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / set / name;
}
Case transfer_case(const std::string& name, const std::vector<std::string>& changes = {}) {
  return read_case(folder_of(name) / "case.toml", changes);
}
const std::vector<std::string> kCurves = {"constant_velocity", "cardan", "pistons_seven"};

// The stored pumps, and that of the constant-velocity joint with two crosses in its place.
Case joint_case(const std::string& kind, std::vector<std::string> changes = {}) {
  if (kind != "double_cardan") return transfer_case(kind, changes);
  changes.insert(changes.begin(), {"transfer.kind=double_cardan", "transfer.phase_deg=25",
                                   "transfer.cross_distance_mm=17"});
  return transfer_case("constant_velocity", changes);
}
const std::vector<std::string> kJoints = {"constant_velocity", "cardan", "double_cardan"};

ResultTable turn(const Case& the_case) {
  return analytic::run(the_case, the_case.analytic, one_turn(the_case));
}

// Of double precision: a wall force is a stiffness times a small difference of lengths.
double wall_rounding(const Case& the_case) {
  const auto& wall = the_case.pump.transfer.wall;
  return wall ? 4 * std::numeric_limits<double>::epsilon() *
                    the_case.pump.geometry.joint_circle_radius * wall->stiffness
              : 0;
}

// ---- What a case may say

TEST(TransferCase, IsReadWrittenAndReadAgain) {
  for (const std::string name : {"constant_velocity", "cardan", "pistons_seven"}) {
    const Case first = transfer_case(name);
    const Case again = parse_case(case_text(first), first.file);
    EXPECT_EQ(case_text(first), case_text(again));
    EXPECT_EQ(first.pump.transfer.kind, again.pump.transfer.kind);
    EXPECT_EQ(first.pump.transfer.cardan.has_value(), name == "cardan");
    EXPECT_EQ(first.pump.transfer.wall.has_value(), name == "pistons_seven");
    validate(first);
  }
  const Case two = joint_case("double_cardan");
  const Case again = parse_case(case_text(two), two.file);
  EXPECT_EQ(case_text(two), case_text(again));
  EXPECT_EQ(again.pump.transfer.kind, TransferKind::double_cardan);
  EXPECT_EQ(again.pump.transfer.double_cardan->cross_distance, 17e-3);
  EXPECT_EQ(again.pump.transfer.cardan->phase, radians(25.0));
  EXPECT_EQ(transfer_case("cardan").pump.transfer.cardan->phase, radians(30.0));
  EXPECT_EQ(transfer_case("pistons_seven").pump.transfer.wall->clearance, 1.55e-3);
}

TEST(TransferCase, RefusesWhatContradictsTheKind) {
  const auto refused = [](const std::string& name, const std::vector<std::string>& changes) {
    return refusal([&] { transfer_case(name, changes); });
  };
  EXPECT_THAT(refused("cardan", {"pump.type=bent_axis_bevel"}),
              HasSubstr("[transfer] kind = \"cardan\": must be \"gear\" beside [pump] type"));
  EXPECT_EQ(refused("cardan", {"pump.type=bent_axis"}), "accepted");
  EXPECT_THAT(refused("cardan", {"transfer.kind=gear"}), HasSubstr("[gear]"));
  EXPECT_EQ(refused("cardan", {"gear.pitch_diameter_mm=100", "gear.pressure_angle_deg=20"}),
            "accepted");
  EXPECT_THAT(refused("cardan", {"gear.pitch_diameter_mm=100", "gear.pressure_angle_deg=20",
                                 "gear.contact=compliant", "gear.stiffness_N_per_um=100"}),
              HasSubstr("must be \"rigid\" beside [transfer] kind = \"cardan\""));
  EXPECT_THAT(refused("cardan", {"transfer.phase_deg=181"}), HasSubstr("[-180, 180]"));
  EXPECT_THAT(refused("cardan", {"transfer.kind=double_cardan"}), HasSubstr("cross_distance_mm"));
  for (const char* distance : {"0", "-3"})
    EXPECT_THAT(
        refused("constant_velocity", {"transfer.kind=double_cardan",
                                      std::string("transfer.cross_distance_mm=") + distance}),
        HasSubstr("transfer.cross_distance_mm"));
  PumpParameters without = joint_case("double_cardan").pump;
  without.transfer.double_cardan.reset();
  EXPECT_THAT(refusal([&] { validate(without); }), HasSubstr("cross_distance_mm"));
  EXPECT_THAT(refused("cardan", {"transfer.clearance_mm=-1"}), HasSubstr("clearance_mm"));
  EXPECT_EQ(refused("cardan", {"transfer.clearance_mm=1"}), "accepted");
  // Too short for the joint alone: a gear's block would take it.
  const PumpParameters pump = transfer_case("cardan").pump;
  const double locked = assembly_margin(pump.geometry).longest_distance;
  const double behind_joint = assembly_margin(pump).longest_distance;
  ASSERT_GT(behind_joint, locked);
  const std::string length =
      "pump.piston_length_mm=" + number_text((locked + behind_joint) / 2 * 1e3);
  EXPECT_THAT(refused("cardan", {length}), HasSubstr("a piston cannot be assembled at theta"));
  EXPECT_EQ(refused("cardan", {length, "transfer.kind=constant_velocity"}), "accepted");
  EXPECT_THAT(refused("constant_velocity", {"transfer.kind=pistons"}),
              HasSubstr("contact_from_joint_mm"));
  EXPECT_THAT(refused("pistons_seven", {"transfer.contact_from_joint_mm=46"}),
              HasSubstr("must be in [0, 46)"));
  EXPECT_THAT(refused("pistons_seven", {"transfer.stiffness_exponent=3.5"}), HasSubstr("[1, 3]"));
  EXPECT_THAT(refused("pistons_seven", {"friction.regularization_m_per_s=0"}),
              HasSubstr("must be > 0 beside [transfer] kind = \"pistons\""));
  EXPECT_THAT(refused("cardan", {"assumptions.analytic.gear=imposed"}),
              HasSubstr("must be \"mesh\" beside [transfer] kind = \"cardan\""));
}

TEST(TransferCase, RefusesAtConstantSpeedWhatHasNoAnswer) {
  const auto refused = [](const std::string& name, const std::vector<std::string>& changes) {
    return refusal([&] { turn(transfer_case(name, changes)); });
  };
  EXPECT_THAT(refused("pistons_seven", {"pressure.transition_deg=0"}),
              HasSubstr("[pressure] transition_deg = 0: must be > 0 beside [transfer] kind"));
  EXPECT_EQ(refused("cardan", {"pressure.transition_deg=0"}), "accepted");
  // w E = 1.3943 mm here.
  EXPECT_THAT(refused("pistons_seven", {"transfer.clearance_mm=1.3"}),
              HasSubstr("[transfer] clearance_mm = 1.3: the block has no free play at theta"));
  EXPECT_THAT(refused("pistons_seven", {"transfer.clearance_mm=40"}), HasSubstr("clearance_mm"));
}

TEST(TransferColumns, FollowThePointOfTheFilm) {
  const auto names = [](const std::string& name) {
    std::vector<std::string> list;
    for (const Channel& channel : ChannelLayout(transfer_case(name).pump).channels())
      list.push_back(channel.name);
    return list;
  };
  const auto after_film = [&](const std::string& name) {
    const auto list = names(name);
    const auto film = std::find(list.begin(), list.end(), "yh_y2_mm");
    return std::vector<std::string>(film + 1, list.end());
  };
  const auto joint = after_film("constant_velocity");
  EXPECT_EQ(std::vector<std::string>(joint.begin(), joint.begin() + 4),
            (std::vector<std::string>{"Tcs_x2_Nm", "Tcs_y2_Nm", "Tcs_z2_Nm", "p_1_bar"}));
  std::vector<std::string> two;
  for (const Channel& channel : ChannelLayout(joint_case("double_cardan").pump).channels())
    two.push_back(channel.name);
  const auto force = std::find(two.begin(), two.end(), "Tcs_z2_Nm");
  ASSERT_GT(two.end() - force, 4);
  EXPECT_EQ(std::vector<std::string>(force + 1, force + 5),
            (std::vector<std::string>{"Fcs_x2_N", "Fcs_y2_N", "Fcs_z2_N", "p_1_bar"}));
  const auto cardan = after_film("cardan");
  EXPECT_EQ(std::vector<std::string>(cardan.begin() + 3, cardan.begin() + 7),
            (std::vector<std::string>{"psi_deg", "psi_rpm", "psi_rad_per_s2", "p_1_bar"}));
  const auto pistons = after_film("pistons_seven");
  EXPECT_EQ(pistons.front(), "Rw_1_x2_N");
  EXPECT_EQ(pistons[13], "Rw_7_y2_N");
  EXPECT_EQ(std::vector<std::string>(pistons.begin() + 14, pistons.begin() + 18),
            (std::vector<std::string>{"psi_deg", "lag_deg", "Tb_z2_Nm", "p_1_bar"}));
}

// ---- Stored curves

double over_peak(const Case& the_case, const ResultTable& table, const NumericTable& curve,
                 std::string& where) {
  // The largest difference over what is allowed: 1e-12 of peak and what rounding takes of a wall.
  double worst = 0;
  for (std::size_t c = 0; c < curve.header.size(); ++c) {
    const std::size_t column = table.find(curve.header[c]);
    if (column == table.columns()) continue;
    const double allowed =
        1e-12 * table.peak(table.channels[column].group) + wall_rounding(the_case);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double share = std::abs(table.at(row, column) - curve.rows[row][c]) / allowed;
      if (!(share <= worst)) {
        worst = share;
        where = curve.header[c] + " in row " + std::to_string(row);
      }
    }
  }
  return worst;
}

TEST(TransferCurves, AreMet) {
  for (const std::string& name : kCurves) {
    const Case the_case = transfer_case(name);
    const ResultTable table = turn(the_case);
    const NumericTable curve = read_numeric_csv(folder_of(name) / "reference.csv");
    ASSERT_EQ(curve.rows.size(), table.rows());
    std::size_t compared = 0;
    for (const std::string& header : curve.header) compared += table.find(header) < table.columns();
    EXPECT_EQ(compared + 1, curve.header.size()) << "all but theta_deg";
    std::string where;
    EXPECT_LE(over_peak(the_case, table, curve, where), scaled(1)) << name << ": " << where;
    // Off by a millionth: it is noticed.
    const ResultTable wrong = turn(
        transfer_case(name, {name == "cardan"              ? "transfer.phase_deg=30.00003"
                             : name == "constant_velocity" ? "pump.tilt_deg=40.00004"
                                                           : "transfer.clearance_mm=1.550002"}));
    EXPECT_GT(over_peak(the_case, wrong, curve, where), 100) << name;
  }
}

// ---- Properties

// Pumps that no curve is stored of: all kinds, even and odd N, real spinning pistons, b != 0,
// Rd != Ra, contact off B, against the direction of the ports.
std::vector<Case> various(const std::string& kind) {
  const auto make = [&](std::vector<std::string> changes) {
    changes.push_back("transfer.kind=" + kind);
    changes.emplace_back("transfer.cross_distance_mm=13");
    changes.emplace_back("transfer.phase_deg=-40");
    return transfer_case("pistons_seven", changes);
  };
  const std::vector<std::string> real = {"piston.inertia=real", "piston.centre_of_mass_mm=19",
                                         "piston.transverse_inertia_kg_mm2=24",
                                         "piston.axial_inertia_kg_mm2=5", "piston.spin_rpm=900"};
  auto real_reversed = real;
  real_reversed.insert(real_reversed.end(), {"operation.speed_rpm=-1500", "pump.pistons=6"});
  auto even = real;
  even.insert(even.end(), {"pump.pistons=8", "pump.bore_diameter_mm=14", "pump.axis_offset_mm=-0.2",
                           "transfer.stiffness_exponent=1.5"});
  return {make({}), make(real_reversed), make(even),
          make({"piston.contact_mm=44", "pump.axis_offset_mm=0", "pump.tilt_deg=25",
                "pump.bore_circle_radius_mm=23.7", "transfer.clearance_mm=0.8"})};
}
const std::vector<std::string> kKinds = {"constant_velocity", "cardan", "pistons", "double_cardan"};

TEST(TransferProperties, PowerCloses) {
  for (const std::string& kind : kKinds)
    for (const Case& the_case : various(kind)) {
      const ResultTable table = turn(the_case);
      const std::size_t residual = table.find("power_residual_Nm");
      for (std::size_t row = 0; row < table.rows(); ++row)
        EXPECT_NEAR(table.at(row, residual), 0, scaled(1e-11) * table.peak("Td"))
            << kind << " N = " << the_case.pump.geometry.pistons << " row " << row;
    }
}

// Forces and moments of everything on a body, as the body loads list them.
TEST(TransferProperties, FreeBodiesClose) {
  for (const std::string& kind : kKinds)
    for (const Case& the_case : various(kind)) {
      const BodyLoadTable loads =
          analytic::run_body_loads(the_case, the_case.analytic, one_turn(the_case));
      for (const BodySum& sum : worst_sums(loads)) {
        EXPECT_LE(sum.force_over_sum, scaled(1e-13)) << kind << " " << sum.body;
        EXPECT_LE(sum.moment_over_sum, scaled(1e-13)) << kind << " " << sum.body;
      }
    }
}

TEST(TransferProperties, ConstantVelocityGivesTheGearsPistonsAndTorque) {
  Case joint = transfer_case("constant_velocity");
  Case gear = reference_case("bap63_rated");
  const ResultTable a = turn(joint), b = turn(gear);
  for (const char* group : {"Rs", "Rc", "Td"})
    for (std::size_t c = 0; c < a.columns(); ++c) {
      if (a.channels[c].group != group || a.channels[c].frame == "S3") continue;
      const std::size_t other = b.find(a.channels[c].name);
      for (std::size_t row = 0; row < a.rows(); ++row)
        EXPECT_NEAR(a.at(row, c), b.at(row, other), scaled(1e-14) * a.peak(group));
    }
  // Side couples (T3).
  const double half = joint.pump.geometry.tilt / 2;
  for (std::size_t row = 0; row < a.rows(); ++row) {
    const double z = a.at(row, a.find("Tcs_z2_Nm"));
    EXPECT_NEAR(a.at(row, a.find("Tcs_y2_Nm")), -z * std::tan(half), 1e-12);
    EXPECT_NEAR(z, b.at(row, b.find("Tcs_z2_Nm")), 1e-11);
  }
}

TEST(TransferProperties, CardanBecomesConstantVelocityWithoutTilt) {
  // The joints differ by alpha squared: most by the block's inertia, Nm.
  double before = 0;
  for (const double tilt : {4.0, 2.0, 1.0}) {
    const auto at = [&](const char* kind) {
      return turn(transfer_case(
          "cardan", {std::string("transfer.kind=") + kind, "pump.tilt_deg=" + number_text(tilt)}));
    };
    const ResultTable a = at("cardan"), b = at("constant_velocity");
    double worst = 0;
    for (std::size_t row = 0; row < a.rows(); ++row)
      worst =
          std::max(worst, std::abs(a.at(row, a.find("Td_z1_Nm")) - b.at(row, b.find("Td_z1_Nm"))));
    if (before > 0) {
      EXPECT_NEAR(before / worst, 4, 0.8) << tilt;
    }
    before = worst;
  }
  EXPECT_LT(before, 0.1);
}

// Third opinion: positions alone of shaft, crosses and the shaft between them, whose forks are
// parallel. The angle of the block where the block's frame is moved and turned about O2 (S2).
double block_angle_of_two_crosses(const PumpParameters& pump, double theta,
                                  const Eigen::Vector3d& moved, const Eigen::Vector3d& turned) {
  using Eigen::AngleAxisd, Eigen::Matrix3d, Eigen::Vector3d;
  const double distance = pump.transfer.double_cardan->cross_distance;
  const double t = theta - pump.transfer.cardan->phase;
  // In S1: the frame S2 as it stands, the crosses' centres, the arm of the shaft's fork.
  Matrix3d s2 = AngleAxisd(-pump.geometry.tilt, Vector3d::UnitX()).toRotationMatrix();
  const Vector3d o2 = Vector3d(0, 0, pump.geometry.axis_offset) + s2 * moved;
  if (turned.norm() > 0)
    s2 = s2 * AngleAxisd(turned.norm(), turned.normalized()).toRotationMatrix();
  const Vector3d first(0, 0, pump.geometry.axis_offset - distance);
  const Vector3d second = o2 + distance * s2.col(2);
  const Vector3d along = (second - first).normalized();
  const Vector3d arm(std::cos(t), std::sin(t), 0);
  // Arms of the shaft between the crosses: across its axis and across the other arm of the cross.
  const Vector3d fork = along.cross(arm).normalized();
  const Vector3d out = s2.transpose() * fork.cross(s2.col(2));
  return std::atan2(out.y(), out.x()) + pump.transfer.cardan->phase;
}

// What ideal joints exert on the block does no work where the shaft is held and the block's frame
// is moved or turned while the block follows: force and couple by differences of the block's angle.
TEST(TransferProperties, DoubleCardanForceAndCoupleAreThoseOfVirtualWork) {
  for (const Case& the_case : various("double_cardan")) {
    const ResultTable table = turn(the_case);
    const auto at = [&](std::size_t row, const char* name) {
      return table.at(row, table.find(name));
    };
    for (std::size_t row = 0; row < table.rows(); row += 5) {
      const double theta = radians(table.theta_deg[row]);
      const double torque = at(row, "Tcs_z2_Nm");
      const Eigen::Vector3d none(0, 0, 0);
      // The block turns as the shaft does.
      EXPECT_NEAR(
          std::remainder(block_angle_of_two_crosses(the_case.pump, theta, none, none) - theta, kPi),
          0, 1e-14);
      const auto slope = [&](const Eigen::Vector3d& move, const Eigen::Vector3d& turn, double h) {
        return std::remainder(
                   block_angle_of_two_crosses(the_case.pump, theta, h * move, h * turn) -
                       block_angle_of_two_crosses(the_case.pump, theta, -h * move, -h * turn),
                   kPi) /
               (2 * h);
      };
      const char* const forces[] = {"Fcs_x2_N", "Fcs_y2_N", "Fcs_z2_N"};
      const char* const couples[] = {"Tcs_x2_Nm", "Tcs_y2_Nm"};
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d axis = Eigen::Vector3d::Unit(i);
        EXPECT_NEAR(at(row, forces[i]), -torque * slope(axis, none, 1e-7),
                    1e-6 * (std::abs(torque) / 13e-3))
            << forces[i];
        if (i < 2) {
          EXPECT_NEAR(at(row, couples[i]), -torque * slope(none, axis, 1e-5),
                      1e-7 * std::abs(torque))
              << couples[i];
        }
      }
    }
  }
}

// About the centre of the block's cross the couple across z2 is |Tz2| tan(alpha/2) |cos t|.
TEST(TransferProperties, DoubleCardanLoadsItsCrossesByTheCosineOfTheArm) {
  const Case the_case = joint_case("double_cardan");
  const ResultTable table = turn(the_case);
  const double distance = the_case.pump.transfer.double_cardan->cross_distance;
  const double half = the_case.pump.geometry.tilt / 2;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto at = [&](const char* name) { return table.at(row, table.find(name)); };
    const double t = radians(table.theta_deg[row]) - the_case.pump.transfer.cardan->phase;
    const double torque = at("Tcs_z2_Nm");
    // r x F with r = -d z2.
    const double x = at("Tcs_x2_Nm") + distance * at("Fcs_y2_N");
    const double y = at("Tcs_y2_Nm") - distance * at("Fcs_x2_N");
    EXPECT_NEAR(std::hypot(x, y), std::abs(torque * std::tan(half) * std::cos(t)),
                1e-13 * std::abs(torque));
    // In a plane with the arm, which carries none of it.
    EXPECT_NEAR(x * std::cos(t) + y * std::sin(t), 0, 1e-13 * std::abs(torque));
  }
}

// Beside a constant-velocity joint the force at O2 alone is new: pin, film and bearings carry it.
TEST(TransferProperties, DoubleCardanIsAConstantVelocityJointAndAForce) {
  const Case two = joint_case("double_cardan");
  Case one = two;
  one.pump.transfer.kind = TransferKind::constant_velocity;
  const ResultTable a = turn(two), b = turn(one);
  const double s = std::sin(two.pump.geometry.tilt), c = std::cos(two.pump.geometry.tilt);
  const double z1 = two.pump.bearings.tapered_z, z2 = two.pump.bearings.cylindrical_z;
  const double offset = two.pump.geometry.axis_offset;
  double largest = 0;
  for (std::size_t row = 0; row < a.rows(); ++row) {
    const auto change = [&](const char* name) {
      return a.at(row, a.find(name)) - b.at(row, b.find(name));
    };
    const auto force = [&](const char* name) { return a.at(row, a.find(name)); };
    const double x = force("Fcs_x2_N"), y = force("Fcs_y2_N"), z = force("Fcs_z2_N");
    largest = std::max(largest, std::hypot(x, y, z));
    for (const char* name :
         {"Rs_1_x2_N", "Rs_3_z2_N", "Rc_2_y2_N", "Td_z1_Nm", "Tcs_x2_Nm", "Tcs_y2_Nm", "Tcs_z2_Nm"})
      EXPECT_EQ(change(name), 0) << name;
    const double near = 1e-10;  // N, of some ten kN
    EXPECT_NEAR(change("Rcn_x2_N"), -x, near);
    EXPECT_NEAR(change("Rcn_y2_N"), -y, near);
    EXPECT_NEAR(change("Fh_z2_N"), -z, near);
    const double pin = two.pump.block.pin_z;
    EXPECT_NEAR(change("Th_x2_Nm"), -pin * y, near);
    EXPECT_NEAR(change("Th_y2_Nm"), pin * x, near);
    // On the shaft -Fcs acts at (0, 0, b) in S1; z2 is (0, s, c) there.
    const double fx = -x, fy = -(c * y + s * z), fz = -(c * z - s * y);
    const double share = (offset - z1) / (z2 - z1);
    EXPECT_NEAR(change("Rb2_x1_N"), -share * fx, near);
    EXPECT_NEAR(change("Rb2_y1_N"), -share * fy, near);
    EXPECT_NEAR(change("Rb1_x1_N"), -(1 - share) * fx, near);
    EXPECT_NEAR(change("Rb1_y1_N"), -(1 - share) * fy, near);
    EXPECT_NEAR(change("Rb1_z1_N"), -fz, near);
  }
  EXPECT_GT(largest, 100);
  // The force falls as 1/d, and vanishes without tilt.
  const auto peak = [](const char* distance, const char* tilt) {
    return turn(joint_case("double_cardan", {std::string("transfer.cross_distance_mm=") + distance,
                                             std::string("pump.tilt_deg=") + tilt}))
        .peak("Fcs");
  };
  EXPECT_NEAR(peak("10", "40") / peak("30", "40"), 3, 1e-12);
  EXPECT_EQ(peak("10", "0"), 0);
}

// The joint's arms by their definition, with differences for the rates.
TEST(TransferProperties, CardanKeepsItsArmsAcross) {
  const Case the_case = transfer_case("cardan");
  const Model model(the_case.pump, the_case.analytic);
  const double tilt = the_case.pump.geometry.tilt, phase = the_case.pump.transfer.cardan->phase;
  const auto psi = [&](double theta) { return model.block_motion({theta, 1, 0}).angle; };
  for (double theta = -7; theta < 7; theta += 0.37) {
    const double t = theta - phase, p = psi(theta) - phase;
    // (-sin p, cos p, 0) of S2 in S1.
    EXPECT_NEAR(std::cos(t) * -std::sin(p) + std::sin(t) * std::cos(tilt) * std::cos(p), 0, 1e-15);
    EXPECT_LT(std::abs(psi(theta) - theta), 0.04);
    const double h = 1e-4;
    const AxisMotion block = model.block_motion({theta, 3.0, -5.0});
    EXPECT_NEAR(block.speed, 3 * (psi(theta + h) - psi(theta - h)) / (2 * h), 1e-7);
    EXPECT_NEAR(block.acceleration,
                9 * (psi(theta + h) - 2 * psi(theta) + psi(theta - h)) / (h * h) -
                    5 * (psi(theta + h) - psi(theta - h)) / (2 * h),
                1e-5);  // the quotient's own round-off: 9 eps |psi| / h^2 is 1.4e-6
  }
}

// Without mass and friction the drive torque is that of virtual work along psi(theta).
TEST(TransferProperties, DriveTorqueIsTheWorkOfThePressures) {
  for (const std::string kind : {"constant_velocity", "cardan"}) {
    const Case the_case = transfer_case(
        "cardan", {"transfer.kind=" + kind, "piston.inertia=lumped", "piston.mass_kg=0",
                   "block.mass_kg=0", "shaft.mass_kg=0", "friction.piston_coulomb_N=0",
                   "friction.block_viscous_Nm_per_rpm=0", "friction.shaft_viscous_Nm_per_rpm=0",
                   "friction.shaft_torque_factor=1", "block.axial_inertia_kg_mm2=1e-9"});
    const ResultTable table = turn(the_case);
    const Geometry& g = the_case.pump.geometry;
    const double area = kPi / 4 * g.bore_diameter * g.bore_diameter;
    const Model model(the_case.pump, the_case.analytic);
    const auto z = [&](double theta, int k) {
      const double phase = 2 * kPi * k / g.pistons;
      const double psi = model.block_motion({theta, 0, 0}).angle;
      const double off = joint_distance(g, theta - phase, psi - phase);
      return g.joint_circle_radius * std::sin(g.tilt) * std::cos(theta - phase) +
             std::sqrt(g.piston_length * g.piston_length - off * off);
    };
    for (std::size_t row = 0; row < table.rows(); row += 5) {
      const double theta = radians(table.theta_deg[row]), h = 1e-5;
      double torque = 0;
      for (int k = 0; k < g.pistons; ++k)
        torque += pascals(table.at(row, table.find("p_" + std::to_string(k + 1) + "_bar"))) * area *
                  (z(theta + h, k) - z(theta - h, k)) / (2 * h);
      EXPECT_NEAR(table.at(row, table.find("Td_z1_Nm")), torque, 1e-7) << kind << row;
    }
  }
}

TEST(TransferProperties, AtConstantSpeedOnlyTheCardansBlockInertiaCounts) {
  for (const std::string& kind : kKinds) {
    const auto with = [&](const char* shaft, const char* block) {
      return turn(
          transfer_case("pistons_seven", {"transfer.kind=" + kind, "transfer.cross_distance_mm=20",
                                          std::string("shaft.axial_inertia_kg_mm2=") + shaft,
                                          std::string("block.axial_inertia_kg_mm2=") + block}));
    };
    const ResultTable base = with("2000", "1500");
    EXPECT_EQ(worst_difference(base, with("9000", "1500")).over_peak, 0) << kind;
    const double by_block = worst_difference(base, with("2000", "9000"), true).over_peak;
    if (kind == "cardan")
      EXPECT_GT(by_block, 1e-2);
    else
      EXPECT_EQ(by_block, 0) << kind;
  }
}

// ---- Pistons at constant speed

FrozenLag lag_at(const Case& the_case, double theta_deg) {
  const Model model(the_case.pump, the_case.analytic);
  return model.frozen_lag(
      instant_at(the_case, theta_deg, rad_per_second(the_case.operation.speed_rpm)),
      PressureTrace(the_case.pressure));
}

// Third opinion: positions alone. The smallest lag at which some piston's axis is clearance away
// from its bore's, and which piston that is.
struct Touch {
  double lag = 0;
  int piston = 0;
};
Touch first_touch(const Case& the_case, double theta) {
  const Geometry& g = the_case.pump.geometry;
  const WallContact& wall = *the_case.pump.transfer.wall;
  const double share = 1 - wall.from_joint / g.piston_length;
  // By how much a piston's axis is beyond its clearance, of the one that is so most.
  const auto furthest = [&](double lag) {
    Touch far{-1, 0};
    for (int k = 0; k < g.pistons; ++k) {
      const double phase = 2 * kPi * k / g.pistons;
      const double off = share * joint_distance(g, theta - phase, theta - lag - phase) -
                         wall.clearance_of(static_cast<std::size_t>(k));
      if (off > far.lag) far = {off, k};
    }
    return far;
  };
  double low = 0, high = 0.5;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (furthest(middle).lag < 0 ? low : high) = middle;
  }
  return {low, furthest(low).piston};
}

// Deviations of the clearances, um, of pistons 1..N.
Case with_deviations(Case the_case, const std::vector<double>& um) {
  WallContact& wall = *the_case.pump.transfer.wall;
  wall.deviation.clear();
  for (const double each : um) wall.deviation.push_back(each * 1e-6);
  return the_case;
}

TEST(ClearanceOfEachPiston, IsReadAndRefused) {
  const Scratch scratch;
  const auto file = scratch.path() / "plays.csv";
  const auto read = [&](const std::string& text, std::vector<std::string> changes = {}) {
    std::ofstream(file) << text;
    changes.push_back("transfer.clearance_deviation_file=\"" + file.string() + "\"");
    return transfer_case("pistons_seven", changes);
  };
  const std::string good = "piston,deviation_um\n3,-7\n1,10\n2,0\n4,0\n5,0\n7,1.5\n6,0\n";
  const Case the_case = read(good);
  const WallContact& wall = *the_case.pump.transfer.wall;
  ASSERT_EQ(wall.deviation.size(), 7);
  EXPECT_EQ(wall.clearance_of(0), wall.clearance + 10e-6);
  EXPECT_EQ(wall.smallest_clearance(), wall.clearance - 7e-6);
  EXPECT_NEAR(wall.deviation[6], 1.5e-6, 1e-21);
  EXPECT_TRUE(std::any_of(the_case.inputs.begin(), the_case.inputs.end(),
                          [&](const InputFile& input) { return input.file == file; }));
  const Case again = parse_case(case_text(the_case), the_case.file);
  EXPECT_EQ(again.pump.transfer.wall->deviation, wall.deviation);
  const auto refused = [&](const std::string& text, std::vector<std::string> changes = {}) {
    return refusal([&] { read(text, std::move(changes)); });
  };
  EXPECT_EQ(refused(good), "accepted");
  EXPECT_THAT(refused("piston,um\n1,0\n"), HasSubstr("header must be piston,deviation_um"));
  EXPECT_THAT(refused("piston,deviation_um\n1,0\n"),
              HasSubstr("has 1 piston, must be [pump] pistons = 7"));
  EXPECT_THAT(refused(good, {"pump.pistons=5"}), HasSubstr("[pump] pistons = 5"));
  const auto with = [&](const std::string& row, const std::string& other) {
    std::string text = good;
    return text.replace(text.find(row), row.size(), other);
  };
  EXPECT_THAT(refused(with("2,0", "1,0")), HasSubstr("plays.csv:4"));
  EXPECT_THAT(refused(with("2,0", "2.5,0")), HasSubstr("whole number in [1, 7]"));
  EXPECT_THAT(refused(with("2,0", "8,0")), HasSubstr("whole number in [1, 7]"));
  EXPECT_THAT(refused(with("3,-7", "3,-1550")),
              HasSubstr("deviation_um of piston 3: must be > -1550"));
  EXPECT_EQ(refused(with("3,-7", "3,-1549"), {"transfer.kind=constant_velocity"}), "accepted");
  // Through the API too.
  Case fewer = the_case;
  fewer.pump.geometry.pistons = 5;
  EXPECT_THAT(refusal([&] { validate(fewer); }), HasSubstr("clearance_deviation_file"));
}

TEST(ClearanceOfEachPiston, DeviationsOfZeroChangeNoBit) {
  for (const Case& the_case : various("pistons")) {
    const std::vector<double> none(static_cast<std::size_t>(the_case.pump.geometry.pistons));
    const Case same = with_deviations(the_case, none);
    EXPECT_EQ(turn(the_case).values.size(), turn(same).values.size());
    const ResultTable a = turn(the_case), b = turn(same);
    for (std::size_t i = 0; i < a.values.size(); ++i) {
      if (is_computed(a.values[i]) || is_computed(b.values[i])) {
        ASSERT_EQ(a.values[i], b.values[i]) << i;
      }
    }
  }
}

// The piston that carries, by positions alone, with stiff walls. Pistons with large clearances
// never carry; the pattern is that of a turn.
TEST(ClearanceOfEachPiston, HandsOverAsTheGeometrySays) {
  // By w (1 - cos alpha) Ra = 2.8 mm the pistons' axes differ from each other at most.
  const std::pair<const char*, std::vector<double>> pumps[] = {{"1.55", {0, -12, 6, 3, -9, 14, 1}},
                                                               {"1.55", {5, -3, 0, 8, -6, 2}},
                                                               {"5", {0, 0, -3000, 0, 0}}};
  for (const auto& [clearance, um] : pumps) {
    const auto pistons = static_cast<int>(um.size());
    const Case the_case = with_deviations(
        transfer_case("pistons_seven",
                      {"pump.axis_offset_mm=0", "pump.bore_circle_radius_mm=22.00478",
                       "pump.pistons=" + std::to_string(pistons),
                       std::string("transfer.clearance_mm=") + clearance,
                       "transfer.stiffness_N_per_um=1000000", "transfer.dissipation_s_per_m=0"}),
        um);
    const Model model(the_case.pump, the_case.analytic);
    const PressureTrace pressure(the_case.pressure);
    std::vector<double> values(model.layout().size());
    std::map<int, int> carried;
    for (int i = 0; i < 360; ++i) {
      const double theta_deg = i + 0.5;
      const Touch touch = first_touch(the_case, radians(theta_deg));
      Instant instant = instant_at(the_case, theta_deg, rad_per_second(1500));
      model.place_at_constant_speed(instant, pressure);
      // One piston carries where two of equal clearances would share.
      EXPECT_NEAR(instant.lag->angle, touch.lag, pistons == 5 ? 2e-6 : 6e-7) << theta_deg;
      const analytic::FreePlay play = model.free_play(radians(theta_deg));
      EXPECT_NEAR(play.high, touch.lag, 1e-13);
      EXPECT_EQ(play.high_piston, touch.piston);
      model.evaluate(instant, values);
      const auto force = [&](int k) {
        return std::hypot(values[model.layout().Rw(k, 0)], values[model.layout().Rw(k, 1)]);
      };
      int carries = 0;
      for (int k = 1; k < pistons; ++k)
        if (force(k) > force(carries)) carries = k;
      EXPECT_GT(force(carries), 100);
      EXPECT_EQ(carries, touch.piston) << theta_deg;
      // Beyond its own clearance by what its wall gives.
      const WallContact& wall = *the_case.pump.transfer.wall;
      const double theta = instant.shaft.angle - 2 * kPi * carries / pistons;
      const double approach =
          (1 - wall.from_joint / the_case.pump.geometry.piston_length) *
              joint_distance(the_case.pump.geometry, theta, theta - instant.lag->angle) -
          wall.clearance_of(static_cast<std::size_t>(carries));
      EXPECT_NEAR(approach * wall.stiffness, force(carries), 1e-6 * force(carries));
      ++carried[carries];
    }
    if (pistons == 5) {
      EXPECT_EQ(carried.size(), 1);
      EXPECT_EQ(carried[2], 360);
      continue;
    }
    // The piston with the largest clearance carries less than that with the smallest.
    const auto smallest = std::min_element(um.begin(), um.end()) - um.begin();
    const auto largest = std::max_element(um.begin(), um.end()) - um.begin();
    EXPECT_LT(carried[static_cast<int>(largest)], carried[static_cast<int>(smallest)]);
  }
}

// In time: touches are where a piston reaches its own wall, and the work closes.
TEST(ClearanceOfEachPiston, IsThatOfTheMotion) {
  Case the_case = with_deviations(transfer_case("pistons_seven_free"), {8, -5, 0, 12, -10, 3, 0});
  const Trajectory run =
      analytic::simulate(the_case, the_case.analytic, PressureTrace(the_case.pressure));
  EXPECT_FALSE(run.record.events.empty());
  EXPECT_LE(run.record.worst_work_residual, scaled(1e-6) * std::abs(run.record.work_of_loads));
  const WallContact& wall = *the_case.pump.transfer.wall;
  const Geometry& g = the_case.pump.geometry;
  const double share = 1 - wall.from_joint / g.piston_length;
  int pressed = 0;
  for (std::size_t row = 0; row < run.table.results.rows(); ++row) {
    const double theta = radians(run.state(row, StateColumn::theta));
    const double psi = radians(run.state(row, StateColumn::psi));
    for (int k = 0; k < g.pistons; ++k) {
      const double phase = 2 * kPi * k / g.pistons;
      const double approach = share * joint_distance(g, theta - phase, psi - phase) -
                              wall.clearance_of(static_cast<std::size_t>(k));
      const std::string n = "Rw_" + std::to_string(k + 1);
      const ResultTable& table = run.table.results;
      const double force = std::hypot(table.at(row, table.find(n + "_x2_N")),
                                      table.at(row, table.find(n + "_y2_N")));
      if (std::abs(approach) > 1e-9) {
        EXPECT_EQ(force > 0, approach > 0) << row << " " << k;
      }
      pressed += force > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(pressed, 10);
}

const std::vector<std::string> kSymmetric = {
    "pump.axis_offset_mm=0", "pump.bore_circle_radius_mm=22.00478"};  // Rd = Ra (1 + cos)/2

TEST(FrozenLagOfPistons, HandsOverAsTheGeometrySays) {
  for (const int pistons : {5, 7, 6}) {
    auto changes = kSymmetric;
    changes.push_back("pump.pistons=" + std::to_string(pistons));
    changes.emplace_back("transfer.stiffness_N_per_um=1000000");
    changes.emplace_back("transfer.dissipation_s_per_m=0");
    const Case the_case = transfer_case("pistons_seven", changes);
    const Geometry& g = the_case.pump.geometry;
    const bool odd = pistons % 2 == 1;
    int hand_overs = 0, first = -1, last = -1;
    double least = 1, most = 0;
    const int rows = 1440;
    const Model model(the_case.pump, the_case.analytic);
    const PressureTrace pressure(the_case.pressure);
    std::vector<double> values(model.layout().size());
    for (int i = 0; i < rows; ++i) {
      const double theta_deg = 360.0 * (i + 0.5) / rows;
      const Touch touch = first_touch(the_case, radians(theta_deg));
      const int carrier = odd ? touch.piston : touch.piston % (pistons / 2);
      if (last >= 0 && carrier != last) ++hand_overs;
      if (first < 0) first = carrier;
      last = carrier;
      const double d = 2 * g.bore_circle_radius * std::sin(touch.lag / 2);
      least = std::min(least, d);
      most = std::max(most, d);
      if (i % 36 != 0) continue;
      Instant instant = instant_at(the_case, theta_deg, rad_per_second(1500));
      model.place_at_constant_speed(instant, pressure);
      EXPECT_NEAR(instant.lag->angle, touch.lag, 3e-7) << theta_deg;
      model.evaluate(instant, values);
      double largest = 0;
      int carries = 0;
      for (int k = 0; k < pistons; ++k) {
        const double force =
            std::hypot(values[model.layout().Rw(k, 0)], values[model.layout().Rw(k, 1)]);
        if (force > largest) {
          largest = force;
          carries = k;
        }
      }
      EXPECT_GT(largest, 100);
      if (odd) {
        EXPECT_EQ(carries, touch.piston) << theta_deg;
      }
    }
    hand_overs += first != last;  // at the end of the turn
    EXPECT_EQ(hand_overs, odd ? 2 * pistons : pistons);
    // Extremes of |D| (docs/transfer.md).
    const WallContact& wall = *the_case.pump.transfer.wall;
    const double reach = wall.clearance / (1 - wall.from_joint / g.piston_length);
    const double e = g.joint_circle_radius * (1 - std::cos(g.tilt)) / 2;
    const double angle = radians((odd ? 180.0 : 360.0) / pistons);
    EXPECT_NEAR(least, reach - e, 1e-6);
    EXPECT_NEAR(most,
                std::sqrt(reach * reach - std::pow(e * std::sin(angle), 2)) - e * std::cos(angle),
                2e-6);
  }
}

// With an offset of the axes pistons carry in one sector alone, near 225 deg for b > 0 and 45 deg
// for b < 0: N hand-overs for odd and for even N. By positions, and by the largest wall force.
// The joints' circle is seen as an ellipse from the block, which moves the middle of the sector:
// by 4.3 deg at most here, so its half width is a half pitch and 6 deg (3 deg, written first, were
// too few).
TEST(FrozenLagOfPistons, AnOffsetOfTheAxesMakesOneSectorCarry) {
  for (const double offset : {0.3, -0.3})
    for (const int pistons : {7, 6}) {
      auto changes = kSymmetric;
      changes.push_back("pump.axis_offset_mm=" + number_text(offset));
      changes.push_back("pump.pistons=" + std::to_string(pistons));
      changes.emplace_back("transfer.stiffness_N_per_um=1000000");
      changes.emplace_back("transfer.dissipation_s_per_m=0");
      const Case the_case = transfer_case("pistons_seven", changes);
      const Model model(the_case.pump, the_case.analytic);
      const PressureTrace pressure(the_case.pressure);
      std::vector<double> values(model.layout().size());
      int hand_overs = 0, first = -1, last = -1;
      for (int i = 0; i < 720; ++i) {
        const double theta_deg = (i + 0.5) / 2;
        const Touch touch = first_touch(the_case, radians(theta_deg));
        const double middle = offset > 0 ? 225 : 45;
        const double at = piston_angle_deg(theta_deg, touch.piston + 1, pistons);
        EXPECT_LT(std::abs(std::remainder(at - middle, 360)), 180.0 / pistons + 6) << theta_deg;
        hand_overs += last >= 0 && touch.piston != last;
        if (first < 0) first = touch.piston;
        last = touch.piston;
        if (i % 24 != 0) continue;
        Instant instant = instant_at(the_case, theta_deg, rad_per_second(1500));
        model.place_at_constant_speed(instant, pressure);
        model.evaluate(instant, values);
        int carries = 0;
        const auto force = [&](int k) {
          return std::hypot(values[model.layout().Rw(k, 0)], values[model.layout().Rw(k, 1)]);
        };
        for (int k = 1; k < pistons; ++k)
          if (force(k) > force(carries)) carries = k;
        EXPECT_EQ(carries, touch.piston) << theta_deg;
      }
      EXPECT_EQ(hand_overs + (first != last), pistons);
    }
}

TEST(FrozenLagOfPistons, GoesToTheRigidLimitAsOneOverTheStiffness) {
  double before = 0;
  for (const char* stiffness : {"1000", "2000", "4000"}) {
    const Case the_case =
        transfer_case("pistons_seven", {std::string("transfer.stiffness_N_per_um=") + stiffness});
    const FrozenLag lag = lag_at(the_case, 35);
    EXPECT_EQ(lag.rule, FrozenLag::Rule::one_side);
    const double beyond = lag.angle - lag.high;
    EXPECT_GT(beyond, 0);
    if (before > 0) {
      EXPECT_NEAR(before / beyond, 2, 0.02);
    }
    before = beyond;
  }
}

TEST(FrozenLagOfPistons, FollowsItsRules) {
  // Nothing acts: the middle.
  const Case unloaded =
      transfer_case("pistons_seven",
                    {"pressure.delivery_bar=0", "piston.mass_kg=0", "friction.piston_coulomb_N=0",
                     "friction.block_viscous_Nm_per_rpm=0", "block.mass_kg=0"});
  const FrozenLag middle = lag_at(unloaded, 20);
  EXPECT_EQ(middle.rule, FrozenLag::Rule::no_load);
  EXPECT_DOUBLE_EQ(middle.angle, (middle.low + middle.high) / 2);
  // Drag on the block: the driving side, whichever way the shaft turns.
  const Case forwards = transfer_case("pistons_seven");
  const Case backwards = transfer_case("pistons_seven", {"operation.speed_rpm=-1500"});
  EXPECT_GT(lag_at(forwards, 35).angle, lag_at(forwards, 35).high);
  EXPECT_LT(lag_at(backwards, 35).angle, lag_at(backwards, 35).low);
  // Struts under pressure push off the middle: roots on both sides without drag.
  const Case struts = transfer_case(
      "pistons_seven", {"friction.block_viscous_Nm_per_rpm=0", "friction.piston_coulomb_N=0"});
  analytic::LagRules rules;
  const Model model(struts.pump, struts.analytic);
  const PressureTrace pressure(struts.pressure);
  for (int i = 0; i < 72; ++i) {
    Instant instant = instant_at(struts, 5.0 * i, rad_per_second(1500));
    rules.count(model.frozen_lag(instant, pressure));
  }
  EXPECT_GT(rules.rows[static_cast<int>(FrozenLag::Rule::driving)], 0u);
  EXPECT_EQ(rules.rows[0] + rules.rows[1] + rules.rows[2] + rules.rows[3], 72u);
  EXPECT_THAT(rules.text(), HasSubstr("rows by rule"));
  // Small loads: within the free play, where no wall pushes.
  const Case light = transfer_case(
      "pistons_seven", {"pressure.delivery_bar=0", "friction.block_viscous_Nm_per_rpm=0"});
  int free = 0;
  for (int i = 0; i < 72; ++i) {
    const FrozenLag lag = lag_at(light, 5.0 * i);
    free += lag.rule == FrozenLag::Rule::free;
    if (lag.rule == FrozenLag::Rule::free) {
      EXPECT_LE(lag.angle, lag.high);
      EXPECT_GE(lag.angle, lag.low);
    }
  }
  EXPECT_GT(free, 0);
}

TEST(FrozenLagOfPistons, FailsWhereAPistonLeavesItsBoreFirst) {
  const Case soft = transfer_case("pistons_seven", {"transfer.stiffness_N_per_um=1e-6"});
  EXPECT_THROW(turn(soft), ComputationError);
}

// ---- What follows from the geometry

// Stroke, displacement and tilts against a turn of the model's own positions.
TEST(TransferDerived, AreThoseOfATurn) {
  for (const std::string& kind : kKinds)
    for (Case the_case : various(kind)) {
      if (kind == "pistons") continue;  // of a block without lag
      the_case.operation.samples_per_revolution = 3600;
      const ResultTable table = turn(the_case);
      const ChannelLayout at(the_case.pump);
      const int pistons = the_case.pump.geometry.pistons;
      double strokes = 0;
      for (int k = 0; k < pistons; ++k) {
        const auto z = column(table, at.channels()[at.zB(k)].name);
        const auto [low, high] = std::minmax_element(z.begin(), z.end());
        strokes += (*high - *low) * 1e-3;
      }
      const auto derived = analytic::derived_quantities(the_case.pump);
      EXPECT_NEAR(derived.displacement, derived.piston_area * strokes, 2e-6 * derived.displacement);
      EXPECT_NEAR(derived.stroke, strokes / pistons, 2e-6 * derived.stroke);
      EXPECT_NEAR(std::sin(derived.largest_tilt) * the_case.pump.geometry.piston_length,
                  assembly_margin(the_case.pump).longest_distance, 1e-9);
      const auto as_gear = analytic::derived_quantities(the_case.pump.geometry);
      if (kind == "constant_velocity" || kind == "double_cardan")
        EXPECT_EQ(derived.displacement, as_gear.displacement);
      else
        EXPECT_GT(std::abs(derived.displacement / as_gear.displacement - 1), 1e-6);
    }
}

// Tilts of pistons that turn the block: the block is behind the shaft by its free play. By vectors,
// at many angles of one piston after the other.
TEST(TransferDerived, TiltsOfPistonsAreThoseOfABlockThatLags) {
  for (const Case& the_case : various("pistons")) {
    const Geometry& g = the_case.pump.geometry;
    const Model model(the_case.pump, the_case.analytic);
    double least = 90, most = 0;
    for (int i = 0; i < 3600; ++i) {
      const double theta = radians(0.1 * i), psi = theta - model.free_play(theta).high;
      for (int k = 0; k < g.pistons; ++k) {
        const double of_joint = theta - 2 * kPi * k / g.pistons,
                     of_bore = psi - 2 * kPi * k / g.pistons;
        // A on its circle about z1, which is tilted about x, against the bore's axis along z2.
        const double x =
            g.joint_circle_radius * std::sin(of_joint) - g.bore_circle_radius * std::sin(of_bore);
        const double y = g.joint_circle_radius * std::cos(of_joint) * std::cos(g.tilt) +
                         g.axis_offset * std::sin(g.tilt) -
                         g.bore_circle_radius * std::cos(of_bore);
        const double tilt = std::asin(std::hypot(x, y) / g.piston_length);
        least = std::min(least, tilt);
        most = std::max(most, tilt);
      }
    }
    const auto derived = analytic::derived_quantities(the_case.pump);
    EXPECT_NEAR(derived.largest_tilt, most, 2e-6 * most);
    // Where another piston ends the free play the tilt has a corner, which lies between two angles.
    EXPECT_LE(derived.smallest_tilt, least + 1e-12);
    EXPECT_GT(derived.smallest_tilt, least - 5e-6);
    EXPECT_GT(most, 1.01 * analytic::derived_quantities(g).largest_tilt);
  }
}

// Ends of the free play by bisection of positions, and which piston stands there.
TEST(TransferDerived, FreePlayEndsWhereAPistonTouches) {
  const Case the_case = transfer_case("pistons_seven");
  const Model model(the_case.pump, the_case.analytic);
  for (double theta = 0; theta < 6.3; theta += 0.1) {
    const analytic::FreePlay play = model.free_play(theta);
    const Touch touch = first_touch(the_case, theta);
    ASSERT_TRUE(play.exists);
    EXPECT_NEAR(play.high, touch.lag, 1e-13);
    EXPECT_EQ(play.high_piston, touch.piston);
    EXPECT_LT(play.low, play.high);
  }
  EXPECT_FALSE(Model(transfer_case("cardan").pump, the_case.analytic).free_play(1).exists);
}

// ---- Round-off

std::map<std::string, double> estimated(const Case& the_case) {
  std::map<std::string, double> groups;
  for (const auto& group : analytic::estimate_rounding(
           the_case, the_case.analytic, one_turn(the_case), PressureTrace(the_case.pressure), 1000))
    groups[group.group] = group.total();
  return groups;
}

// The estimate bounds the distance from curves of 50 digits, and is not far from it. Walls that are
// stiffer by a factor carry forces whose round-off grows with it.
TEST(TransferRounding, IsThatOfTheStoredCurves) {
  for (const std::string& name : kCurves) {
    const Case the_case = transfer_case(name);
    const ResultTable table = turn(the_case);
    const NumericTable curve = read_numeric_csv(folder_of(name) / "reference.csv");
    const auto rounding = estimated(the_case);
    std::map<std::string, double> off;
    for (std::size_t c = 0; c < curve.header.size(); ++c) {
      const std::size_t at = table.find(curve.header[c]);
      if (at == table.columns() || table.channels[at].kind != ChannelKind::reaction) continue;
      double& largest = off[table.channels[at].group];
      for (std::size_t row = 0; row < table.rows(); ++row)
        largest = std::max(largest, std::abs(table.at(row, at) - curve.rows[row][c]));
    }
    EXPECT_EQ(off.size() + 1, rounding.size()) << name << ": and Rcs, which is not computed";
    for (const auto& [group, difference] : off) {
      ASSERT_TRUE(rounding.contains(group)) << name << " " << group;
      EXPECT_LE(difference, rounding.at(group)) << name << " " << group;
      EXPECT_LE(rounding.at(group), 1e-11 * table.peak(group)) << name << " " << group;
    }
  }
  const auto soft = estimated(transfer_case("pistons_seven"));
  const auto stiff = estimated(transfer_case("pistons_seven", {"transfer.stiffness_N_per_um=1e8"}));
  EXPECT_GT(stiff.at("Rw"), 100 * soft.at("Rw"));
}

// ---- Given states

TEST(TransferStates, JointsPrescribeTheBlock) {
  const Scratch scratch;
  for (const std::string name : {"constant_velocity", "cardan"}) {
    const Case the_case = transfer_case(name);
    const PressureTrace pressure(the_case.pressure);
    const auto file = scratch.file(
        "states.csv", "theta_deg,theta_rpm,theta_rad_per_s2\n50,1500,0\n410,1500,0\n77,900,250\n");
    const States states = read_states(file, the_case, pressure);
    const MotionTable table = analytic::run_states(the_case, the_case.analytic, states);
    const ResultTable driven = turn(the_case);
    const std::size_t td = driven.find("Td_z1_Nm");
    EXPECT_NEAR(table.results.at(0, td), driven.at(10, td), 1e-11);
    EXPECT_NEAR(table.results.at(1, td), driven.at(10, td), 1e-9);
    const std::size_t balance = table.results.find("power_balance_W");
    EXPECT_NEAR(table.results.at(2, balance), 0, 1e-9);
    // Given as well: they must match.
    const Model model(the_case.pump, the_case.analytic);
    const AxisMotion block = model.block_motion({radians(77), rad_per_second(900), 250});
    const auto row = [&](double more) {
      return "theta_deg,psi_deg,theta_rpm,psi_rpm,theta_rad_per_s2,psi_rad_per_s2\n77," +
             number_text(block.angle / kRadPerDegree + more) + ",900," +
             number_text(block.speed / kRadPerSecondPerRpm) + ",250," +
             number_text(block.acceleration) + "\n";
    };
    const auto read = [&](double more) {
      return refusal(
          [&] { read_states(scratch.file("given.csv", row(more)), the_case, pressure); });
    };
    EXPECT_EQ(read(0), "accepted");
    EXPECT_EQ(read(5e-10), "accepted");
    EXPECT_THAT(read(2e-9), HasSubstr("psi_deg"));
  }
}

TEST(TransferStates, OfPistonsNeedATorqueOnTheBlock) {
  const Scratch scratch;
  const Case the_case = transfer_case("pistons_seven");
  const PressureTrace pressure(the_case.pressure);
  const auto row = [&](double psi_deg, double acceleration) {
    const auto file =
        scratch.file("states.csv",
                     "theta_deg,psi_deg,theta_rpm,psi_rpm,theta_rad_per_s2,psi_rad_per_s2\n35," +
                         number_text(psi_deg) + ",1500,1500,0," + number_text(acceleration) + "\n");
    return analytic::run_states(the_case, the_case.analytic, read_states(file, the_case, pressure));
  };
  const ResultTable driven = turn(the_case);
  const double psi = driven.at(7, driven.find("psi_deg"));
  const MotionTable frozen = row(psi, 0), moved = row(psi, 1000), free = row(35, 0);
  const std::size_t tb = frozen.results.find("Tb_z2_Nm");
  EXPECT_NEAR(frozen.results.at(0, tb), 0, 1e-8);
  EXPECT_FALSE(is_computed(driven.at(7, tb)));
  // The block's inertia and that of the pistons that follow it.
  EXPECT_GT(moved.results.at(0, tb), 1000 * the_case.pump.block.axial_inertia);
  EXPECT_EQ(free.results.at(0, free.results.find("lag_deg")), 0);
  for (int k = 1; k <= 7; ++k)
    EXPECT_EQ(free.results.at(0, free.results.find("Rw_" + std::to_string(k) + "_x2_N")), 0);
  for (const MotionTable* table : {&frozen, &moved, &free})
    EXPECT_NEAR(table->results.at(0, table->results.find("power_balance_W")), 0, 1e-7);
  EXPECT_THAT(to_csv(frozen), HasSubstr("Rw_7_y2_N,lag_deg,Tb_z2_Nm,")) << "psi_deg stands first";
}

// ---- Motion

Trajectory simulated(const Case& the_case, const analytic::SimulationOptions& options = {}) {
  return analytic::simulate(the_case, the_case.analytic, PressureTrace(the_case.pressure), options);
}

double column_difference(const MotionTable& table, const NumericTable& curve,
                         const std::string& name) {
  const auto place = std::find(curve.header.begin(), curve.header.end(), name);
  const auto theirs = static_cast<std::size_t>(place - curve.header.begin());
  const auto state = std::find(table.state_names.begin(), table.state_names.end(), name);
  double worst = 0;
  for (std::size_t row = 0; row < curve.rows.size(); ++row) {
    const double ours =
        state != table.state_names.end()
            ? table.state(row, static_cast<std::size_t>(state - table.state_names.begin()))
            : table.results.at(row, table.results.find(name));
    worst = std::max(worst, std::abs(ours - curve.rows[row][theirs]));
  }
  return worst;
}

TEST(TransferMotion, OfPistonsFollowsTheStoredTrajectory) {
  const Case the_case = transfer_case("pistons_seven_free");
  const NumericTable curve = read_numeric_csv(folder_of("pistons_seven_free") / "reference.csv");
  const Trajectory run = simulated(the_case);
  ASSERT_EQ(run.table.results.rows(), curve.rows.size());
  EXPECT_LE(column_difference(run.table, curve, "psi_deg") * kRadPerDegree, scaled(1e-9));
  EXPECT_LE(column_difference(run.table, curve, "block_rpm"), scaled(2e-5));
  std::size_t compared = 0;
  for (const std::string& name : curve.header) {
    const std::size_t column = run.table.results.find(name);
    if (column == run.table.results.columns()) continue;
    ++compared;
    EXPECT_LE(column_difference(run.table, curve, name),
              scaled(1e-7) * run.table.results.peak(run.table.results.channels[column].group))
        << name;
  }
  EXPECT_EQ(compared + 4, curve.header.size()) << "all but time, theta and both speeds";
  std::size_t touches = 0;
  for (const ToothEvent& event : run.record.events) {
    touches += event.touch;
    EXPECT_GE(event.piston, 1);
  }
  EXPECT_EQ(touches, 21u);
  EXPECT_LE(run.record.worst_work_residual, scaled(1e-8) * std::abs(run.record.work_of_loads));
}

TEST(TransferMotion, OfJointsHasTheShaftsStateAlone) {
  const std::vector<std::string> torque = {"drive.kind=torque", "drive.torque_Nm=150",
                                           "drive.duration_s=0.02", "drive.samples=20",
                                           "friction.regularization_m_per_s=0.01"};
  for (const std::string& name : kJoints) {
    const Case the_case = joint_case(name, torque);
    const Model model(the_case.pump, the_case.analytic);
    const Trajectory run = simulated(the_case);
    for (std::size_t row = 0; row < run.table.results.rows(); ++row) {
      const double theta = run.state(row, StateColumn::theta);
      const AxisMotion block = model.block_motion(
          {radians(theta), rad_per_second(run.state(row, StateColumn::shaft_speed)), 0});
      EXPECT_NEAR(run.state(row, StateColumn::psi), block.angle / kRadPerDegree, 1e-9);
      EXPECT_NEAR(run.state(row, StateColumn::block_speed), block.speed / kRadPerSecondPerRpm,
                  1e-7);
    }
    EXPECT_LE(run.record.worst_work_residual, scaled(1e-7) * std::abs(run.record.work_of_loads))
        << name;
    EXPECT_TRUE(run.record.events.empty());
  }
}

// ---- The kernel of many instants

TEST(TransferBatch, IsTheModelAtOneInstant) {
  for (const std::string& name : kJoints) {
    const Case the_case = joint_case(name);
    const Model model(the_case.pump, the_case.analytic);
    const analytic::BatchModel batch(the_case.pump, the_case.analytic);
    constexpr std::size_t kCount = 37;
    std::vector<double> theta(kCount);
    for (std::size_t i = 0; i < kCount; ++i) theta[i] = 0.3 * static_cast<double>(i) - 4;
    std::vector<analytic::Varying> pressures(5);
    for (std::size_t k = 0; k < 5; ++k)
      pressures[k] = {nullptr, 1e5 * (10 + 50 * static_cast<double>(k))};
    analytic::BatchInstants instants;
    instants.count = kCount;
    instants.theta = {theta.data(), 0};
    instants.omega = {nullptr, 150};
    instants.omega_dot = {nullptr, -40};
    instants.chamber_pressure = pressures;
    for (const auto set : analytic::available_instruction_sets()) {
      analytic::BatchColumns columns(model.layout().size(), kCount);
      analytic::BatchOutputs outputs =
          analytic::outputs_of(model.layout(), analytic::ChannelGroup::all, columns);
      outputs.resize(model.layout().size(), nullptr);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t c = model.layout().TcsJoint(axis);
        outputs[c] = columns.column(c);
        if (!model.layout().has(Quantity::Fcs)) continue;
        const std::size_t force = model.layout().Fcs(axis);
        outputs[force] = columns.column(force);
      }
      batch.reactions(instants, outputs, {set, 1});
      std::vector<double> values(model.layout().size());
      Instant instant;
      for (std::size_t k = 0; k < 5; ++k) instant.chamber_pressure.push_back(pressures[k].all);
      for (std::size_t i = 0; i < kCount; ++i) {
        instant.turn(theta[i], 150, -40);
        model.evaluate(instant, values);
        for (std::size_t c = 0; c < outputs.size(); ++c) {
          if (outputs[c] == nullptr || c == model.layout().Rcs()) continue;
          EXPECT_NEAR(columns.column(c)[i], values[c], scaled(1e-12) * (1e4 + std::abs(values[c])))
              << to_string(set) << " " << model.layout().channels()[c].name;
        }
      }
    }
  }
  EXPECT_THAT(refusal([] {
                const Case the_case = transfer_case("pistons_seven");
                const analytic::BatchModel batch(the_case.pump, the_case.analytic);
              }),
              HasSubstr("[transfer] kind = \"pistons\""));
}

}  // namespace
}  // namespace bentaxis::test
