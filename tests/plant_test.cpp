// The pump of a unit: as simulate has it, under inputs, kept and restored, and for an integrator
// outside.
#include "plant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <thread>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/simulation.h"
#include "coupled_pump.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using fmu::Drive;
using fmu::Inputs;
using fmu::Plant;
using fmu::UnitChoice;

constexpr auto kSteps = Plant::Kind::co_simulation;
constexpr auto kOpen = Plant::Kind::model_exchange;

Case shipped(const std::string& name, double duration, int samples) {
  Case c = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / (name + ".toml"));
  if (!c.drive) c.drive = DriveSpec();
  c.drive->duration = duration;
  c.drive->samples = samples;
  return c;
}

Case rated(double duration = 0.01, int samples = 20) {
  return shipped("bap63_rated_hydraulic", duration, samples);
}

Case with_torque(double duration = 0.01, int samples = 20) {
  Case c = rated(duration, samples);
  c.drive->kind = DriveKind::torque;
  c.drive->torque = 250;
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  return c;
}

UnitChoice driven_by(Drive drive) {
  UnitChoice choice;
  choice.drive = drive;
  return choice;
}

using Values = std::vector<std::vector<double>>;

// Outputs at equal parts of a duration, `between` steps for each.
Values stepped(Plant& plant, double duration, int samples, int between = 1) {
  Values values = {plant.outputs()};
  const double from = plant.time();
  const int points = samples * between;
  for (int i = 1; i <= points; ++i) {
    plant.step(from + duration * i / points);
    if (i % between == 0) values.push_back(plant.outputs());
  }
  return values;
}

// Largest difference, of each column's peak.
double apart(const Values& a, const Values& b) {
  if (a.size() != b.size() || a[0].size() != b[0].size()) return HUGE_VAL;
  constexpr double kNothing = 1e-4;
  double worst = 0;
  for (std::size_t c = 0; c < a[0].size(); ++c) {
    double peak = 0, difference = 0;
    for (std::size_t r = 0; r < a.size(); ++r) {
      if (std::isnan(a[r][c]) != std::isnan(b[r][c])) return HUGE_VAL;
      if (std::isnan(a[r][c])) continue;
      peak = std::max(peak, std::abs(a[r][c]));
      difference = std::max(difference, std::abs(a[r][c] - b[r][c]));
    }
    if (peak > kNothing) worst = std::max(worst, difference / peak);
  }
  return worst;
}

// What a simulation's tables have under the names of a plant's outputs.
Values tables_of(const Trajectory& run, const fmu::PlantColumns& columns) {
  Values values;
  for (std::size_t row = 0; row < run.lag.size(); ++row) {
    values.emplace_back();
    for (const fmu::PlantColumn& column : columns.outputs) {
      double value = std::numeric_limits<double>::infinity();
      const auto& names = run.table.state_names;
      const auto state = std::find(names.begin(), names.end(), column.name);
      const std::size_t channel = run.table.results.find(column.name);
      if (state != names.end())
        value = run.table.state(row, static_cast<std::size_t>(state - names.begin()));
      else if (channel < run.table.results.columns())
        value = run.table.results.at(row, channel);
      else
        for (std::size_t c = 0; run.oil && c < run.oil->columns.size(); ++c)
          if (run.oil->columns[c].name == column.name) value = run.oil->value(row, c);
      values.back().push_back(value);
    }
  }
  return values;
}

struct AsSimulated {
  std::string name;
  Drive drive;
  Case (*the_case)();
};
std::ostream& operator<<(std::ostream& to, const AsSimulated& what) { return to << what.name; }

Case touching_pistons() {
  Case c = shipped("bap63_tapered_pistons", 0.01, 20);
  c.pump.block.axial_inertia = 2.5e-3;
  return c;
}

class PlantAsSimulated : public testing::TestWithParam<AsSimulated> {};

// Written before the first run: 1e-8 of peak, every output, however many steps.
TEST_P(PlantAsSimulated, EveryOutput) {
  const Case c = GetParam().the_case();
  const UnitChoice choice = driven_by(GetParam().drive);
  const study::PreparedCase ready = study::prepare_simulation(c, {});
  const study::CoupledPump pump(ready, c.pressure.kind == PressureKind::hydraulic);
  coupled::Options options;
  options.tolerance = choice.tolerance;
  const Values wanted =
      tables_of(pump.simulate(study::Model::analytic, options), fmu::columns_of(c, choice));
  for (const int between : {1, 20}) {
    Plant plant(c, choice, kSteps);
    plant.start(plant.first_inputs());
    EXPECT_LT(apart(stepped(plant, c.drive->duration, c.drive->samples, between), wanted), 1e-8)
        << between;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Cases, PlantAsSimulated,
    testing::Values(
        AsSimulated{"rated", Drive::speed, [] { return rated(); }},
        AsSimulated{"torque", Drive::torque, [] { return with_torque(); }},
        AsSimulated{"motor", Drive::as_in_case, [] { return shipped("bap63_start_up", 0.02, 20); }},
        AsSimulated{"running_motor", Drive::as_in_case,
                    [] { return shipped("bap63_load_step", 0.01, 20); }},
        AsSimulated{"curve", Drive::as_in_case, [] { return shipped("bap63_reversal", 0.02, 20); }},
        AsSimulated{"compliant_teeth", Drive::speed,
                    [] { return shipped("bap63_tooth_rattle", 0.01, 20); }},
        AsSimulated{"ideal_pressure", Drive::speed,
                    [] { return shipped("bap63_rated", 0.01, 20); }},
        AsSimulated{"constant_velocity_joint", Drive::speed,
                    [] { return shipped("bap63_constant_velocity", 0.01, 20); }},
        AsSimulated{"universal_joint", Drive::speed,
                    [] { return shipped("bap63_cardan", 0.01, 20); }},
        AsSimulated{"double_universal_joint", Drive::speed,
                    [] { return shipped("bap63_double_cardan", 0.01, 20); }},
        AsSimulated{"universal_joint_free_shaft", Drive::torque,
                    [] {
                      Case c = shipped("bap63_cardan", 0.01, 20);
                      c.drive->kind = DriveKind::torque;
                      c.drive->torque = 150;
                      c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
                      return c;
                    }},
        AsSimulated{"pistons_that_touch", Drive::speed, [] { return touching_pistons(); }},
        AsSimulated{"pistons_with_oil", Drive::speed,
                    [] {
                      Case c = touching_pistons();
                      const Case oil = rated();
                      c.pressure = oil.pressure;
                      c.hydraulics = oil.hydraulics;
                      return c;
                    }},
        AsSimulated{"universal_joint_with_oil", Drive::speed,
                    [] {
                      Case c = rated();
                      c.pump.transfer.kind = TransferKind::cardan;
                      return c;
                    }}),
    [](const auto& parameter) { return parameter.param.name; });

// Where the end is not known beforehand steps are others, by what is left of errors: of impacts,
// which magnify them, more.
TEST_P(PlantAsSimulated, WithoutAnEnd) {
  const Case c = GetParam().the_case();
  Plant known(c, driven_by(GetParam().drive), kSteps), open(c, driven_by(GetParam().drive), kSteps);
  known.start(known.first_inputs(), c.drive->duration);
  open.start(open.first_inputs(), 1000);
  const Values wanted = stepped(known, c.drive->duration, c.drive->samples);
  const double difference = apart(stepped(open, c.drive->duration, c.drive->samples), wanted);
  EXPECT_LT(difference, GetParam().name == "motor" ? 1e-5 : 1e-6);  // from rest
}

TEST(Plant, ColumnsAreThoseOfOutputs) {
  for (const Drive drive : {Drive::speed, Drive::torque}) {
    const Case c = with_torque();
    Plant plant(c, driven_by(drive), kOpen);
    plant.start(plant.first_inputs());
    const fmu::PlantColumns columns = fmu::columns_of(c, driven_by(drive));
    EXPECT_EQ(columns.outputs.size(), plant.outputs().size());
    EXPECT_EQ(columns.flags.size(), plant.flags().size());
    EXPECT_EQ(columns.states.size(), plant.states().size());
    EXPECT_EQ(columns.states.size(), plant.state_count());
    EXPECT_EQ(columns.states.size(), plant.nominals().size());
    EXPECT_EQ(columns.indicators.size(), plant.indicator_count());
    std::set<std::string> names;
    for (const auto* list : {&columns.outputs, &columns.flags, &columns.states})
      for (const fmu::PlantColumn& column : *list) {
        EXPECT_TRUE(names.insert(column.name).second) << column.name;
        EXPECT_FALSE(column.description.empty()) << column.name;
      }
  }
}

// A load that falls to a share at once, told at a step, is the case's with that curve of a share,
// which is as steep as it can be.
TEST(Plant, LoadShareMidwayIsTheCurve) {
  Case c = shipped("bap63_reversal", 0.01, 20);
  c.drive->curve = {};
  Case over_time = c;
  constexpr double kWhen = 0.004, kSteep = 1e-8;
  over_time.hydraulics->load->share.time = {0, kWhen - kSteep, kWhen, 1};
  over_time.hydraulics->load->share.value = {1, 1, 0.7, 0.7};
  Plant truth(over_time, driven_by(Drive::speed), kSteps);
  truth.start(truth.first_inputs(), 0.01);
  Plant plant(c, driven_by(Drive::speed), kSteps);
  Inputs inputs = plant.first_inputs();
  plant.start(inputs, 0.01);
  stepped(truth, kWhen, 8);
  stepped(plant, kWhen, 8);
  inputs.load_share = 0.7;
  plant.set_inputs(inputs);
  EXPECT_LT(apart(stepped(plant, 0.006, 12), stepped(truth, 0.006, 12)), 1e-5);
}

// Speeds told at points with their acceleration, as those of a case's curve: its chords.
TEST(Plant, SpeedWithAccelerationIsTheCurve) {
  Case c = with_torque(0.01, 20);
  c.drive->kind = DriveKind::speed;
  const double omega = rad_per_second(c.operation.speed_rpm);
  // A ramp: the curve is monotone, so that it is straight within.
  c.drive->curve.time = {0, 0.1, 0.2, 0.3};
  c.drive->curve.value = {omega, 0.9 * omega, 0.8 * omega, 0.7 * omega};
  Plant truth(c, driven_by(Drive::as_in_case), kSteps);
  truth.start(truth.first_inputs(), 0.01);
  Plant plant(c, driven_by(Drive::speed), kSteps);
  Inputs inputs = plant.first_inputs();
  EXPECT_NEAR(inputs.speed, omega, 1e-12);
  inputs.acceleration = -omega;
  inputs.acceleration_given = true;
  plant.start(inputs, 0.01);
  // Said once, the speed goes on by itself; said at a point, it is the same.
  const Values wanted = stepped(truth, 0.01, 20);
  Values found = stepped(plant, 0.005, 10);
  inputs.speed = 0.995 * omega;
  plant.set_inputs(inputs);
  const Values rest = stepped(plant, 0.005, 10);
  found.insert(found.end(), rest.begin() + 1, rest.end());
  EXPECT_LT(apart(found, wanted), 1e-6);
}

// Curves over time whose middle is straight: both ways to the same line share no code of inputs.
// Written before the first run: 1e-6 of peak, as for the speed.
TEST(Plant, InputsThatChangeLinearlyAreTheCurve) {
  Case load = shipped("bap63_reversal", 0.01, 20);
  load.drive->curve = {};
  Case load_over_time = load;
  load_over_time.hydraulics->load->share.time = {0, 0.01, 0.02, 0.03};
  load_over_time.hydraulics->load->share.value = {1, 0.8, 0.6, 0.4};
  Case torque_over_time = with_torque();
  torque_over_time.drive->curve.time = {0, 0.01, 0.02, 0.03};
  torque_over_time.drive->curve.value = {250, 200, 150, 100};
  struct Line {
    Case here, over_time;
    Drive drive, of_truth;
    double Inputs::*value;
    double Inputs::*rate;
    double start, slope;
  };
  const Line lines[] = {{load, load_over_time, Drive::speed, Drive::speed, &Inputs::load_share,
                         &Inputs::load_share_rate, 1, -20},
                        {with_torque(), torque_over_time, Drive::torque, Drive::as_in_case,
                         &Inputs::torque, &Inputs::torque_rate, 250, -5000}};
  for (const Line& line : lines) {
    Plant truth(line.over_time, driven_by(line.of_truth), kSteps);
    truth.start(truth.first_inputs(), 0.01);
    const Values wanted = stepped(truth, 0.01, 20);
    Plant plant(line.here, driven_by(line.drive), kSteps);
    Inputs inputs = plant.first_inputs();
    inputs.*line.value = line.start;
    inputs.*line.rate = line.slope;
    plant.start(inputs, 0.01);
    // Said once it goes on; said anew where it is by then, it is the same.
    Values found = stepped(plant, 0.005, 10);
    fmu::advance(inputs, 0.005);
    EXPECT_NEAR(inputs.*line.value, line.start + 0.005 * line.slope, 1e-12 * line.start);
    plant.set_inputs(inputs);
    const Values rest = stepped(plant, 0.005, 10);
    found.insert(found.end(), rest.begin() + 1, rest.end());
    EXPECT_LT(apart(found, wanted), 1e-6);
    // Without the slope it is another motion.
    Plant held(line.here, driven_by(line.drive), kSteps);
    inputs.*line.value = line.start;
    inputs.*line.rate = 0;
    held.start(inputs, 0.01);
    EXPECT_GT(apart(stepped(held, 0.01, 20), wanted), 1e-3);
  }
}

// Of pressures there are no curves. Held in the middle of ever shorter pieces they come to the line
// by the square of the pieces. Written before the first run: a factor of 3 to 5 for half of them.
TEST(Plant, PressuresThatChangeLinearlyAreTheLimitOfSteps) {
  Case held_pressure = rated();
  held_pressure.hydraulics->load->kind = LoadKind::constant_pressure;
  const Case ideal = shipped("bap63_rated", 0.01, 20);
  for (const Case& c : {ideal, held_pressure}) {
    const auto started = [&](double suction_rate, double delivery_rate) {
      auto plant = std::make_unique<Plant>(c, driven_by(Drive::speed), kSteps);
      Inputs inputs = plant->first_inputs();
      inputs.suction_rate = suction_rate;
      inputs.delivery_rate = delivery_rate;
      plant->start(inputs, 0.01);
      return plant;
    };
    constexpr double kSuction = 2e7, kDelivery = -5e8;  // Pa/s: 1 and -25 bar in 5 ms
    const Values line = stepped(*started(kSuction, kDelivery), 0.005, 1);
    const auto by_pieces = [&](int pieces) {
      const auto plant = started(0, 0);
      const Inputs first = plant->first_inputs();
      const double piece = 0.005 / pieces;
      Values values = {plant->outputs()};
      for (int i = 0; i < pieces; ++i) {
        Inputs middle = first;
        middle.suction += kSuction * (i + 0.5) * piece;
        middle.delivery += kDelivery * (i + 0.5) * piece;
        plant->set_inputs(middle);
        plant->step((i + 1) * piece);
      }
      Inputs last = first;
      last.suction += kSuction * 0.005;
      last.delivery += kDelivery * 0.005;
      plant->set_inputs(last);
      values.push_back(plant->outputs());
      return values;
    };
    if (!c.hydraulics) {  // which has no memory: the end alone counts
      EXPECT_LT(apart(by_pieces(1), line), 1e-12);
      EXPECT_GT(apart({line[0], line[0]}, line), 1e-2);
      continue;
    }
    // Of first order: the last half of a piece comes at once, and a chamber takes time to follow.
    const double coarse = apart(by_pieces(16), line), fine = apart(by_pieces(32), line);
    EXPECT_GT(coarse, 1e-5);
    EXPECT_GT(coarse / fine, 1.8) << coarse << " " << fine;
    EXPECT_LT(coarse / fine, 2.2) << coarse << " " << fine;
  }
}

TEST(Plant, KeptStateGoesOnWithItsSlopes) {
  Plant plant(rated(), driven_by(Drive::speed), kSteps);
  Inputs inputs = plant.first_inputs();
  inputs.load_share_rate = -20;
  inputs.suction_rate = 1e7;
  plant.start(inputs, 0.01);
  stepped(plant, 0.003, 5);
  const fmu::PlantState kept = plant.state();
  const Values once = stepped(plant, 0.003, 5);
  Plant other(rated(), driven_by(Drive::speed), kSteps);
  other.start(other.first_inputs(), 0.01);
  other.set_state(kept);
  EXPECT_LT(apart(stepped(other, 0.003, 5), once), 1e-6);
}

TEST(Plant, KeptStateGoesOnInAnotherPlant) {
  for (const Drive drive : {Drive::speed, Drive::torque}) {
    const Case c = with_torque();
    Plant plant(c, driven_by(drive), kSteps);
    Inputs inputs = plant.first_inputs();
    inputs.speed *= 0.9;  // not the case's
    inputs.suction = 1e5;
    plant.start(inputs, 0.01);
    stepped(plant, 0.003, 5);
    const fmu::PlantState kept = plant.state();
    const Values here = {plant.outputs()};
    const Values once = stepped(plant, 0.003, 5);
    plant.set_state(kept);
    EXPECT_EQ(plant.time(), kept.time);
    EXPECT_LT(apart({plant.outputs()}, here), 1e-13);
    const Values again = stepped(plant, 0.003, 5);
    EXPECT_LT(apart(again, once), 1e-6);
    Plant other(c, driven_by(drive), kSteps);
    other.start(other.first_inputs(), 0.01);
    other.set_state(kept);
    EXPECT_LT(apart({other.outputs()}, here), 1e-13);
    EXPECT_EQ(apart(stepped(other, 0.003, 5), again), 0);
  }
}

TEST(Plant, StateOfAnotherPumpIsRefused) {
  Plant plant(rated(), driven_by(Drive::speed), kSteps);
  plant.start(plant.first_inputs());
  fmu::PlantState state = plant.state();
  state.oil.pop_back();
  EXPECT_THAT(refusal([&] { plant.set_state(state); }), testing::HasSubstr("another pump"));
}

// Bytes of a state may hold a vector of any length.
TEST(Plant, StateOfAnotherLengthIsRefused) {
  Plant plant(rated(), driven_by(Drive::speed), kSteps);
  plant.start(plant.first_inputs());
  const fmu::PlantState right = plant.state();
  using Part = std::vector<double> fmu::PlantState::*;
  for (const Part part :
       {&fmu::PlantState::motion, &fmu::PlantState::oil, &fmu::PlantState::started})
    for (const int more : {-1, 1, 1000}) {
      fmu::PlantState state = right;
      (state.*part).resize((state.*part).size() + more);
      EXPECT_THAT(refusal([&] { plant.set_state(state); }), testing::HasSubstr("another pump"));
    }
  plant.set_state(right);
}

TEST(Plant, InterleavedPlantsAreAsAlone) {
  const Case cases[] = {rated(), with_torque()};
  const Drive drives[] = {Drive::speed, Drive::torque};
  Values alone[2], together[2];
  std::unique_ptr<Plant> plants[2];
  for (int p = 0; p < 2; ++p) {
    Plant plant(cases[p], driven_by(drives[p]), kSteps);
    plant.start(plant.first_inputs(), 0.01);
    alone[p] = stepped(plant, 0.01, 20);
    plants[p] = std::make_unique<Plant>(cases[p], driven_by(drives[p]), kSteps);
  }
  for (auto& plant : plants) plant->start(plant->first_inputs(), 0.01);
  for (int i = 0; i <= 20; ++i)
    for (int p = 0; p < 2; ++p) {
      if (i > 0) plants[p]->step(0.01 * i / 20);
      together[p].push_back(plants[p]->outputs());
    }
  for (int p = 0; p < 2; ++p) EXPECT_EQ(apart(alone[p], together[p]), 0);
}

TEST(Plant, ThreadsDoNotMeet) {
  const auto run = [](Values& values) {
    Plant plant(rated(), driven_by(Drive::speed), kSteps);
    plant.start(plant.first_inputs(), 0.01);
    values = stepped(plant, 0.01, 20);
  };
  Values alone, values[2];
  run(alone);
  std::thread threads[] = {std::thread(run, std::ref(values[0])),
                           std::thread(run, std::ref(values[1]))};
  for (std::thread& thread : threads) thread.join();
  for (const Values& of_thread : values) EXPECT_EQ(apart(of_thread, alone), 0);
}

// What inputs begin with is what the case says at its start.
TEST(Plant, FirstInputsAreTheCases) {
  Case c = shipped("bap63_reversal", 0.01, 10);
  const double omega = rad_per_second(c.operation.speed_rpm);
  c.drive->curve.value[0] = c.drive->curve.value[1] = 0.5 * omega;
  Plant by_curve(c, driven_by(Drive::speed), kSteps);
  EXPECT_NEAR(by_curve.first_inputs().speed, 0.5 * omega, 1e-9);
  by_curve.start(by_curve.first_inputs());
  EXPECT_NEAR(by_curve.outputs()[2], 0.5 * c.operation.speed_rpm, 1e-9);  // shaft_rpm
  EXPECT_EQ(by_curve.first_inputs().suction, c.pressure.ports.suction);
  EXPECT_TRUE(by_curve.takes().load_share);
  EXPECT_FALSE(by_curve.takes().delivery);
  EXPECT_FALSE(by_curve.takes().torque);
  c.drive->kind = DriveKind::torque;
  c.drive->curve.value = {40, 50, 60, 70, 80};
  c.pump.shaft.axial_inertia = c.pump.block.axial_inertia = 2e-3;
  Plant by_torque(c, driven_by(Drive::torque), kSteps);
  EXPECT_EQ(by_torque.first_inputs().torque, 40);
  EXPECT_TRUE(by_torque.takes().torque);
}

// From rest: nothing moves until the speed is given.
TEST(Plant, StartsFromRest) {
  Plant plant(rated(), driven_by(Drive::speed), kSteps);
  Inputs inputs = plant.first_inputs();
  inputs.speed = 0;
  plant.start(inputs, 0.01);
  plant.step(0.002);
  EXPECT_EQ(plant.outputs()[0], 0);  // theta_deg
  inputs.acceleration = 1e4;
  inputs.acceleration_given = true;
  plant.set_inputs(inputs);
  plant.step(0.004);
  EXPECT_NEAR(plant.outputs()[0], 1e4 / 2 * 0.002 * 0.002 / kRadPerDegree, 1e-9);
  EXPECT_NEAR(plant.outputs()[2], 1e4 * 0.002 / kRadPerSecondPerRpm, 1e-9);
}

// A parameter that changes while the pump runs: the states stay, what depends on it does not.
TEST(Plant, ChangedParametersActFromThenOn) {
  const Case c = rated();
  const UnitChoice choice = driven_by(Drive::speed);
  Plant plant(c, choice, kSteps);
  plant.start(plant.first_inputs(), 0.01);
  stepped(plant, 0.004, 4);
  const auto columns = fmu::columns_of(c, choice);
  const auto output = [&](const std::string& name) {
    for (std::size_t i = 0; i < columns.outputs.size(); ++i)
      if (columns.outputs[i].name == name) return plant.outputs()[i];
    ADD_FAILURE() << name;
    return 0.0;
  };
  const double film = output("Fh_z2_N"), pressure = output("p_2_bar"), angle = output("theta_deg");
  Case stiffer = c;
  stiffer.pump.block.spring_force += 100;
  plant.change(stiffer);
  EXPECT_EQ(output("p_2_bar"), pressure);
  EXPECT_NEAR(output("theta_deg"), angle, 1e-10);
  EXPECT_NEAR(std::abs(output("Fh_z2_N") - film), 100, 1e-6);
  stepped(plant, 0.004, 4);
  EXPECT_NEAR(plant.time(), 0.008, 1e-15);
}

TEST(Plant, RefusedParametersChangeNothing) {
  const auto run = [](bool tries) {
    Plant plant(rated(), driven_by(Drive::speed), kSteps);
    plant.start(plant.first_inputs());
    stepped(plant, 0.004, 4);
    if (tries) {
      Case flat = rated();
      flat.pump.geometry.tilt = 0;
      EXPECT_THROW(plant.change(flat), InputError);
    }
    return stepped(plant, 0.004, 4);
  };
  EXPECT_EQ(apart(run(true), run(false)), 0);
}

// Pressures of the ports that no input gives are parameters, which may change too.
TEST(Plant, ChangedPortsAct) {
  const Case c = shipped("bap63_rated", 0.01, 10);
  Plant plant(c, driven_by(Drive::as_in_case), kSteps);
  plant.start(plant.first_inputs());
  const auto suction = plant.first_inputs().suction;
  EXPECT_EQ(suction, c.pressure.ports.suction);
  plant.step(0.004);
  Case other = c;
  other.pressure.ports.delivery *= 0.5;
  plant.change(other);
  Plant truth(other, driven_by(Drive::as_in_case), kSteps);
  Inputs inputs = truth.first_inputs();
  truth.start(inputs);
  truth.step(0.004);
  Inputs same = plant.inputs();
  same.delivery = other.pressure.ports.delivery;
  plant.set_inputs(same);
  EXPECT_LT(apart({plant.outputs()}, {truth.outputs()}), 1e-9);
}

// What cannot be followed leaves the plant where it stood; it goes on under better inputs.
TEST(Plant, FailedStepLeavesItWhereItStood) {
  Plant plant(with_torque(), driven_by(Drive::torque), kSteps);
  Inputs inputs = plant.first_inputs();
  plant.start(inputs, 0.01);
  plant.step(0.001);
  const Values here = {plant.outputs()};
  Inputs bad = inputs;
  bad.torque = std::nan("");
  plant.set_inputs(bad);
  EXPECT_THROW(plant.step(0.002), ComputationError);
  EXPECT_EQ(plant.time(), 0.001);
  plant.set_inputs(inputs);
  EXPECT_LT(apart({plant.outputs()}, here), 1e-14);
  plant.step(0.002);
  EXPECT_EQ(plant.time(), 0.002);
}

class Flags {
 public:
  Flags(const Case& c, const UnitChoice& choice) : columns_(fmu::columns_of(c, choice)) {}
  bool of(Plant& plant, const std::string& name) const {
    for (std::size_t i = 0; i < columns_.flags.size(); ++i)
      if (columns_.flags[i].name == name) return plant.flags()[i];
    ADD_FAILURE() << name;
    return false;
  }

 private:
  fmu::PlantColumns columns_;
};

TEST(Plant, FlagsSayWhatDoesNotHold) {
  const Case c = rated();
  const UnitChoice choice = driven_by(Drive::speed);
  const Flags flags(c, choice);
  Plant plant(c, choice, kSteps);
  Inputs inputs = plant.first_inputs();
  plant.start(inputs, 0.01);
  EXPECT_TRUE(flags.of(plant, "inertia_reactions_valid"));
  plant.step(0.001);
  EXPECT_TRUE(flags.of(plant, "inertia_reactions_valid"));
  inputs.speed *= 1.01;
  plant.set_inputs(inputs);
  EXPECT_FALSE(flags.of(plant, "inertia_reactions_valid"));
  // That it is given counts, be it as large as before.
  inputs.acceleration_given = true;
  plant.set_inputs(inputs);
  EXPECT_TRUE(flags.of(plant, "inertia_reactions_valid"));
  // Nearly a vacuum in the tank: air comes out and oil boils in the chambers.
  EXPECT_FALSE(flags.of(plant, "vapour"));
  inputs.suction = -0.99e5;
  plant.set_inputs(inputs);
  bool air = false, vapour = false;
  for (int i = 1; i <= 40; ++i) {
    plant.step(0.001 + 0.01 * i / 40);
    air = air || flags.of(plant, "cavitation");
    vapour = vapour || flags.of(plant, "vapour");
  }
  EXPECT_TRUE(air);
  EXPECT_TRUE(vapour);
}

// The classical Runge-Kutta method of order 4 over the plant, with events.
class RungeKutta {
 public:
  explicit RungeKutta(Plant& plant) : plant_(plant) {}

  void run(double end, double step) {
    Plant::Event next = plant_.pass_event();
    while (plant_.time() < end) {
      double h = std::min(step, end - plant_.time());
      if (next.next_time) h = std::min(h, *next.next_time - plant_.time());
      const double time = plant_.time();
      const std::vector<double> values = plant_.states();
      const std::vector<bool> before = signs();
      advance(time, values, h);
      bool event = plant_.wants_event();
      if (signs() != before) {
        double low = 0, high = h;
        for (int i = 0; i < 45 && high - low > 1e-15; ++i) {
          const double middle = (low + high) / 2;
          advance(time, values, middle);
          (signs() == before ? low : high) = middle;
        }
        advance(time, values, high);
        event = true;
      }
      if (next.next_time && plant_.time() >= *next.next_time) event = true;
      if (event) {
        next = plant_.pass_event();
        ++events;
      }
    }
  }
  int events = 0;

 private:
  std::vector<bool> signs() {
    plant_.indicators(indicators_);
    std::vector<bool> signs;
    for (const double value : indicators_) signs.push_back(value > 0);
    return signs;
  }
  void advance(double time, const std::vector<double>& y, double h) {
    std::array<std::vector<double>, 4> k;
    const double at[] = {0, h / 2, h / 2, h};
    for (std::size_t stage = 0; stage < 4; ++stage) {
      std::vector<double> here = y;
      for (std::size_t i = 0; i < y.size() && stage > 0; ++i)
        here[i] += at[stage] * k[stage - 1][i];
      plant_.set_time(time + at[stage]);
      plant_.set_states(here);
      plant_.rates(k[stage]);
    }
    std::vector<double> next = y;
    for (std::size_t i = 0; i < y.size(); ++i)
      next[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    plant_.set_time(time + h);
    plant_.set_states(next);
  }

  Plant& plant_;
  std::vector<double> indicators_;
};

TEST(Plant, IntegratedOutsideIsAsStepped) {
  for (const Drive drive : {Drive::speed, Drive::torque, Drive::as_in_case}) {
    const Case c = with_torque();
    UnitChoice choice = driven_by(drive);
    choice.tolerance = 1e-10;
    Plant open(c, choice, kOpen), plant(c, choice, kSteps);
    open.start(open.first_inputs(), 0.004);
    plant.start(plant.first_inputs(), 0.004);
    EXPECT_LT(apart({open.outputs()}, {plant.outputs()}), 1e-13);
    RungeKutta integrator(open);
    integrator.run(0.004, 2e-7);
    plant.step(0.004);
    EXPECT_GT(integrator.events, 3);
    EXPECT_LT(apart({open.outputs()}, {plant.outputs()}), 1e-6);
  }
}

fmu::Variable variable(fmu::Role role, std::size_t place) {
  fmu::Variable v;
  v.role = role;
  v.place = place;
  return v;
}

// Where the states have no finite rates there is no derivative, and the plant stays where it was.
TEST(Plant, NoDirectionalDerivativeWithoutRates) {
  Plant plant(rated(), driven_by(Drive::speed), kOpen);
  plant.start(plant.first_inputs(), 0.01);
  std::vector<double> states = plant.states();
  states.back() = 1e4;  // the logarithm of a pressure
  plant.set_states(states);
  const fmu::Variable unknown = variable(fmu::Role::derivative, states.size() - 1);
  const fmu::Variable known = variable(fmu::Role::state, 0);
  EXPECT_THROW(plant.directional_derivative({&unknown}, {&known}, {1}), ComputationError);
  EXPECT_EQ(plant.states(), states);

  Plant driven(with_torque(), driven_by(Drive::torque), kOpen);
  Inputs inputs = driven.first_inputs();
  driven.start(inputs, 0.01);
  inputs.torque = std::nan("");
  driven.set_inputs(inputs);
  EXPECT_THROW(driven.directional_derivative({&unknown}, {&known}, {1}), ComputationError);
}

// Against rates and outputs at places so near that differences of fourth order are exact.
TEST(Plant, DirectionalDerivatives) {
  const Case c = with_torque();
  Plant plant(c, driven_by(Drive::speed), kOpen);
  Inputs inputs = plant.first_inputs();
  plant.start(inputs, 0.01);
  plant.set_time(0.0007);
  std::vector<double> states = plant.states();
  states[0] += 0.2;
  plant.set_states(states);
  plant.pass_event();
  std::vector<fmu::Variable> list;
  const std::size_t count = plant.state_count(), outputs = plant.outputs().size();
  for (std::size_t i = 0; i < count; ++i) list.push_back(variable(fmu::Role::derivative, i));
  for (std::size_t i = 0; i < outputs; ++i) list.push_back(variable(fmu::Role::output, i));
  std::vector<const fmu::Variable*> unknowns;
  for (const fmu::Variable& v : list) unknowns.push_back(&v);
  const auto values = [&] {
    std::vector<double> all;
    plant.rates(all);
    all.insert(all.end(), plant.outputs().begin(), plant.outputs().end());
    return all;
  };
  const std::vector<double> here = values();
  const auto expect_slopes = [&](const fmu::Variable& known, double seed,
                                 const std::function<void(double)>& move, double h) {
    std::array<std::vector<double>, 4> at;
    const double place[] = {-2, -1, 1, 2};
    for (int i = 0; i < 4; ++i) {
      move(place[i] * h);
      at[i] = values();
    }
    move(0);
    const std::vector<double> slope = plant.directional_derivative(unknowns, {&known}, {seed});
    ASSERT_EQ(slope.size(), here.size());
    for (std::size_t i = 0; i < slope.size(); ++i) {
      constexpr double kRoundOff = 1e-6;
      if (std::isnan(here[i]) || std::abs(here[i]) < kRoundOff) continue;
      const double wanted = (at[0][i] - 8 * at[1][i] + 8 * at[2][i] - at[3][i]) / (12 * h) * seed;
      const double size = std::abs(here[i]) / h * 1e-3 * std::abs(seed);
      EXPECT_NEAR(slope[i], wanted, 1e-6 * std::abs(wanted) + 1e-8 * size + 1e-9) << i;
    }
    EXPECT_EQ(values(), here);  // it is where it was
  };
  const auto state = [&](std::size_t i) {
    return [&plant, &states, i](double by) {
      std::vector<double> moved = states;
      moved[i] += by;
      plant.set_states(moved);
    };
  };
  expect_slopes(variable(fmu::Role::state, 0), 1, state(0), 1e-5);
  for (const std::size_t i : {std::size_t{1}, std::size_t{4}, count - 1})
    expect_slopes(variable(fmu::Role::state, i), 0.5, state(i), 2e-6);
  const auto input = [&](fmu::Input which, double Inputs::*member, double h) {
    fmu::Variable known = variable(fmu::Role::input, 0);
    known.input = which;
    expect_slopes(
        known, 2,
        [&](double by) {
          Inputs moved = inputs;
          moved.*member += by;
          plant.set_inputs(moved);
        },
        h);
  };
  input(fmu::Input::speed, &Inputs::speed, 1e-3);
  input(fmu::Input::acceleration, &Inputs::acceleration, 1);
  input(fmu::Input::suction, &Inputs::suction, 10);
}

}  // namespace
}  // namespace bentaxis::test
