// A unit that acts on the pump: which variables go where, and what comes of it.
#include "bentaxis/study/fmu_coupling.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "bentaxis/fmu/slave.h"
#include "bentaxis/study/simulation.h"
#include "fmu_connections.h"
#include "support.h"

namespace bentaxis::study {
namespace {

using test::refusal;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::filesystem::path unit(const std::string& name, int version) {
  return std::filesystem::path(BENTAXIS_TEST_UNITS) /
         (name + "_fmi" + std::to_string(version) + ".fmu");
}

Case example(const std::string& name) {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / (name + ".toml"));
}

// Driven as the test's motor drives it: gear in mesh, pressure over the angle.
Case by_motor() {
  Case c = example("bap63_motor_start");
  c.pump.gear.contact = ToothContact::rigid;
  DriveSpec& drive = *c.drive;
  drive.kind = DriveKind::motor;
  drive.torque = 290;
  drive.motor = MotorData{20, 0.15, 30000, 20};
  drive.start_speed.reset();
  drive.duration = 0.02;
  drive.samples = 100;
  return c;
}

SimulationResult simulated(const Case& c, const UnitChoice& unit_choice, double error = 1e-7,
                           std::optional<Model> only = Model::analytic) {
  SimulationChoice choice;
  choice.only = only;
  choice.error = error;
  if (!unit_choice.file.empty())
    choice.unit =
        std::make_shared<UnitCoupling>(unit_choice, c, c.pressure.kind == PressureKind::hydraulic);
  return simulate(prepare_simulation(c, choice), choice);
}

// Largest difference of a column at equal times, of its peak.
double apart(const SimulationResult& a, const SimulationResult& b, const std::string& name) {
  const ResultTable& x = a.analytic->table.results;
  const ResultTable& y = b.analytic->table.results;
  EXPECT_EQ(x.rows(), y.rows());
  const auto column = x.find(name);
  double worst = 0;
  for (std::size_t row = 0; row < x.rows(); ++row)
    worst = std::max(worst, std::abs(x.at(row, column) - y.at(row, column)));
  return worst / y.peak(y.channels[column].group);
}

double speeds_apart(const SimulationResult& a, const SimulationResult& b) {
  double worst = 0;
  for (std::size_t row = 0; row < a.analytic->lag.size(); ++row)
    worst = std::max(worst,
                     std::abs(a.analytic->table.state(row, 3) - b.analytic->table.state(row, 3)));
  return worst;
}

// ---- Connections

fmu::UnitVariable variable(const std::string& name, const std::string& causality,
                           const std::string& unit, const std::string& type = "Real") {
  fmu::UnitVariable v;
  v.name = name;
  v.causality = causality;
  v.unit = unit;
  v.type = type;
  if (!unit.empty()) v.measure = fmu::measure_named(unit);
  return v;
}

class ConnectTest : public testing::Test {
 protected:
  std::string refused(const std::vector<std::string>& wanted) const {
    return refusal([&] { connect(unit_, pump_, wanted, "u.fmu"); });
  }
  static std::vector<std::string> made(const std::vector<Connection>& all) {
    std::vector<std::string> texts;
    for (const Connection& c : all)
      texts.push_back(c.to_pump ? c.pump + "<" + c.unit.name : c.unit.name + "<" + c.pump);
    return texts;
  }
  void add(const fmu::UnitVariable& v) { unit_.variables.push_back(v); }

  fmu::UnitDescription unit_;
  PumpSide pump_ = pump_side(by_motor(), false);
};

TEST_F(ConnectTest, EqualNamesNeedNoWord) {
  add(variable("drive_torque", "output", "N.m"));
  add(variable("Td_z1_Nm", "input", ""));
  add(variable("level", "input", "m"));
  EXPECT_THAT(made(connect(unit_, pump_, {}, "u.fmu")),
              ElementsAre("drive_torque<drive_torque", "Td_z1_Nm<Td_z1_Nm"));
}

TEST_F(ConnectTest, WordsComeBeforeNames) {
  add(variable("drive_torque", "output", "N.m"));
  add(variable("n", "output", "rpm"));
  // A speed that was asked for leaves the torque aside.
  EXPECT_THAT(made(connect(unit_, pump_, {"drive_speed=n"}, "u.fmu")),
              ElementsAre("drive_speed<n"));
}

TEST_F(ConnectTest, RefusesWhatIsNotThereOrNotClear) {
  add(variable("torque", "output", "N.m"));
  add(variable("n", "input", "rpm"));
  add(variable("local", "local", "rpm"));
  for (const char* text : {"torque", "=torque", "drive_torque="})
    EXPECT_THAT(refused({text}), HasSubstr("must be A=B"));
  EXPECT_THAT(refused({"drive_torque=moment"}),
              AllOf(HasSubstr("no output \"moment\""), HasSubstr("torque")));
  EXPECT_THAT(refused({"drive_torque=local"}), HasSubstr("no output \"local\""));
  EXPECT_THAT(refused({"n=motor_speed"}), HasSubstr("no column \"motor_speed\""));
  EXPECT_THAT(refused({"drive=torque"}),
              AllOf(HasSubstr("neither the pump nor the FMU"), HasSubstr("drive_speed")));
  EXPECT_THAT(refused({"drive_torque=torque", "drive_torque=torque"}),
              HasSubstr("connected already"));
  EXPECT_THAT(refused({"n=shaft_rpm"}), HasSubstr("no output acts on the pump"));
  // Of names that both sides have.
  add(variable("drive_torque", "input", "N.m"));
  add(variable("Td_z1_Nm", "output", "N.m"));
  EXPECT_THAT(refused({"drive_torque=Td_z1_Nm"}),
              AllOf(HasSubstr("is ambiguous"), HasSubstr("pump:drive_torque=Td_z1_Nm")));
}

TEST_F(ConnectTest, WhoseInputItIsMayBeSaid) {
  add(variable("drive_torque", "input", "N.m"));
  add(variable("Td_z1_Nm", "output", "N.m"));
  EXPECT_THAT(made(connect(unit_, pump_, {"pump:drive_torque=Td_z1_Nm"}, "u.fmu")),
              ElementsAre("drive_torque<Td_z1_Nm"));
  add(variable("drive_speed", "output", "rad/s"));
  EXPECT_THAT(made(connect(unit_, pump_, {"fmu:drive_torque=Td_z1_Nm"}, "u.fmu")),
              ElementsAre("drive_torque<Td_z1_Nm", "drive_speed<drive_speed"));
  EXPECT_THAT(refused({"fmu:drive_torque=drive_speed"}), HasSubstr("no column \"drive_speed\""));
  EXPECT_THAT(refused({"pump:drive_torque=shaft_rpm"}), HasSubstr("no output \"shaft_rpm\""));
}

TEST_F(ConnectTest, SaysWhatWasMeant) {
  add(variable("motor_torque", "output", "N.m"));
  add(variable("n", "input", "rpm"));
  EXPECT_THAT(refused({"drive_torque=motor_torqe"}), HasSubstr("did you mean \"motor_torque\"?"));
  EXPECT_THAT(refused({"n=shaft_rp"}), HasSubstr("did you mean \"shaft_rpm\"?"));
}

TEST_F(ConnectTest, RefusesTwoThatTurnTheShaftOrHalfAMotion) {
  add(variable("drive_torque", "output", "N.m"));
  add(variable("drive_speed", "output", "rad/s"));
  EXPECT_THAT(refused({}), AllOf(HasSubstr("is ambiguous"), HasSubstr("drive_torque")));
  unit_.variables = {variable("drive_acceleration", "output", "rad/s2")};
  EXPECT_THAT(refused({}), HasSubstr("drive_acceleration without drive_speed"));
}

TEST_F(ConnectTest, RefusesUnitsAndTypesThatDoNotFit) {
  add(variable("f", "output", "Hz"));
  add(variable("odd", "output", "furlong"));
  add(variable("text", "output", "", "String"));
  EXPECT_THAT(refused({"drive_speed=f"}),
              AllOf(HasSubstr("units do not fit"), HasSubstr("Hz"), HasSubstr("rad/s")));
  EXPECT_THAT(refused({"drive_speed=odd"}), HasSubstr("\"furlong\""));
  EXPECT_THAT(refused({"drive_speed=text"}), HasSubstr("type String"));
}

TEST_F(ConnectTest, RefusesWhatTheCaseDoesNotTake) {
  add(variable("load_share", "output", ""));
  EXPECT_THAT(refused({}), HasSubstr("no load whose size could change"));
  EXPECT_THAT(refused({"load_share=load_share"}), HasSubstr("no load whose size could change"));
  // With a load there is one, and its pressure is no input.
  pump_ = pump_side(example("bap63_load_step"), true);
  EXPECT_THAT(made(connect(unit_, pump_, {}, "u.fmu")), ElementsAre("load_share<load_share"));
  add(variable("p", "output", "bar"));
  EXPECT_THAT(refused({"delivery_pressure=p"}), HasSubstr("does not take a pressure there"));
}

TEST(UnitCouplingTest, StepsAreWholePartsOfTheDuration) {
  const auto step = [](std::optional<double> asked) {
    return UnitCoupling({unit("valve", 2), {"drive_speed=load_share"}, asked}, by_motor(), false);
  };
  EXPECT_THAT(refusal([&] { step({}); }), HasSubstr("units do not fit"));
  const auto of = [](std::optional<double> asked) {
    return UnitCoupling({unit("rotor", 2), {}, asked}, by_motor(), false).step();
  };
  EXPECT_DOUBLE_EQ(of({}), 1e-4);  // the unit's own
  EXPECT_DOUBLE_EQ(of(0.02), 0.02);
  EXPECT_DOUBLE_EQ(of(0.0075), 0.02 / 3);
  EXPECT_THAT(refusal([&] { of(0.03); }), HasSubstr("must be <= 0.02"));
  EXPECT_THAT(refusal([&] { of(1e-12); }), HasSubstr("at most 1e+06"));
}

// ---- Motion

// Pump and unit go on from point to point with what the other was: the error falls as the step
// does, by half where it is halved. The estimate that is reported is to be that error.
TEST(UnitCouplingTest, MotorUnitConvergesToTheCasesOwnMotor) {
  const Case c = by_motor();
  const SimulationResult truth = simulated(c, {});
  for (const int version : {2, 3}) {
    double before = 0;
    for (const double step : {1e-4, 5e-5, 2.5e-5}) {
      const SimulationResult r = simulated(
          c, {unit("motor", version), {"shaft_angle=theta_deg", "shaft_speed=shaft_rpm"}, step});
      const double error = apart(r, truth, "Td_z1_Nm");
      double estimate = 0;
      for (const CouplingChange& change : r.coupling)
        if (change.group == "Td") estimate = change.error();
      std::printf("FMI %d, %g s: error of Td %.3e, estimated %.3e\n", version, step, error,
                  estimate);
      EXPECT_NEAR(estimate / error, 1, 0.3);
      if (before > 0) {
        EXPECT_NEAR(before / error, 2, 0.25);
      }
      before = error;
    }
    EXPECT_LT(before, 2e-2);
  }
}

// A rotor on the shaft is inertia of the shaft: under speed and acceleration from a unit the pump
// moves as under the unit's torque with that inertia. Of first order too.
TEST(UnitCouplingTest, RotorUnitConvergesToAShaftWithItsInertia) {
  Case c = by_motor();
  c.drive->kind = DriveKind::torque;
  c.drive->motor.reset();
  c.drive->torque = 320;
  c.pump.friction.shaft_torque_factor = 1;  // its loss would be of Td, on one side with the rotor
  const double own = c.pump.shaft.axial_inertia;
  c.pump.shaft.axial_inertia = own + 0.2;
  const SimulationResult truth = simulated(c, {});
  c.pump.shaft.axial_inertia = own;
  for (const int version : {2, 3}) {
    double before = 0;
    for (const double step : {2e-4, 1e-4, 5e-5}) {
      const SimulationResult r = simulated(c, {unit("rotor", version), {}, step});
      const double error = speeds_apart(r, truth);
      std::printf("FMI %d, %g s: error of the speed %.3e rpm, of Rs %.3e of peak\n", version, step,
                  error, apart(r, truth, "Rs_1_z2_N"));
      if (before > 0) {
        EXPECT_NEAR(before / error, 2, 0.25);
      }
      before = error;
    }
    EXPECT_LT(before, 0.1);
  }
}

// Without an acceleration the speed goes straight from point to point: a speed that rises steadily
// is met exactly, with its acceleration.
TEST(UnitCouplingTest, SpeedAloneGoesStraightToTheNext) {
  Case c = by_motor();
  c.drive->duration = 0.008;
  c.drive->samples = 40;
  const SimulationResult r = simulated(c, {unit("stubborn", 3), {}, 1e-3});  // 150 rad/s + t
  for (std::size_t row = 0; row < r.analytic->lag.size(); ++row)
    EXPECT_NEAR(r.analytic->table.state(row, 3) * kRadPerSecondPerRpm,
                150 + r.analytic->table.state(row, 0), 1e-9);
  EXPECT_LT(r.coupling.front().change, 1e-6);
}

TEST(UnitCouplingTest, BothModelsMoveAlikeUnderTheSameUnit) {
  for (const int version : {2, 3}) {
    const SimulationResult r =
        simulated(by_motor(), {unit("rotor", version), {}, 2e-4}, 1e-8, std::nullopt);
    ASSERT_TRUE(r.analytic && r.multibody);
    EXPECT_TRUE(r.agrees()) << r.headline();
    for (const GroupDifference& group : r.groups) EXPECT_LT(group.in_time, 1e-9) << group.group;
    EXPECT_FALSE(r.coupling.empty());
  }
}

TEST(UnitCouplingTest, AnOpenValveChangesNothing) {
  Case c = example("bap63_load_step");
  c.drive->duration = 0.004;  // until it begins to close
  c.drive->samples = 40;
  const SimulationResult without = simulated(c, {});
  const SimulationResult with = simulated(c, {unit("valve", 3), {}, 1e-3});
  for (const char* name : {"Td_z1_Nm", "Rs_1_z2_N", "Rcs_z4_N"})
    EXPECT_LT(apart(with, without, name), 1e-8) << name;
  EXPECT_LT(with.coupling.front().change, 1e-8);
}

TEST(UnitCouplingTest, AUnitThatFailsEndsTheSimulationInItsWords) {
  for (const int version : {2, 3}) {
    std::string said;
    try {
      simulated(by_motor(), {unit("stubborn", version), {}, 1e-3});
    } catch (const ComputationError& error) {
      said = error.what();
    }
    EXPECT_THAT(said, AllOf(HasSubstr("DoStep at 0.009 s"), HasSubstr("no level of oil")));
  }
}

TEST(UnitCouplingTest, ASteadyMotionIsRefused) {
  SimulationChoice choice;
  choice.steady = true;
  choice.unit =
      std::make_shared<UnitCoupling>(UnitChoice{unit("rotor", 2), {}, {}}, by_motor(), false);
  EXPECT_THAT(refusal([&] { prepare_simulation(by_motor(), choice); }), HasSubstr("--steady"));
}

}  // namespace
}  // namespace bentaxis::study
