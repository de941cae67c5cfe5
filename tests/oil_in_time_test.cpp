// Oil in the chambers of a pump that turns anyhow: its equations per second, and its balances.
#include "bentaxis/hydraulics/oil_in_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "accumulator.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "chamber.h"
#include "integrator.h"
#include "network.h"
#include "support.h"

namespace bentaxis::hydraulics {
namespace {

using test::scaled;
using testing::ElementsAre;
using testing::HasSubstr;

Case rated(const std::vector<std::string>& changes = {}) {
  return read_case(
      std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated_hydraulic.toml", changes);
}

struct Circuit {
  std::string name;
  std::vector<std::string> changes;
};
const std::vector<std::string> kLine = {"delivery_line.length_m=1", "delivery_line.diameter_mm=20",
                                        "oil.temperature_C=60"};
const std::vector<std::string> kSuction = {"suction_line.length_m=1",
                                           "suction_line.diameter_mm=40"};
const std::vector<std::string> kGaps = {"oil.temperature_C=60",
                                        "leakage.piston_gap_um=15",
                                        "leakage.piston_gap_length_mm=10",
                                        "leakage.piston_gap_kind=engaged",
                                        "leakage.eccentricity=0.8",
                                        "leakage.plate_gap_um=8",
                                        "leakage.ring_slot_um=50",
                                        "leakage.ring_slot_width_mm=0.3",
                                        "leakage.ring_slot_length_mm=2",
                                        "hydraulics.case_bar=1"};
const std::vector<std::string> kAccumulator = {
    "accumulator.gas_volume_l=0.7", "accumulator.precharge_bar=5", "accumulator.inlet_area_mm2=40"};
const std::vector<std::string> kLoop = {"loop.volume_l=0.3", "pressure.suction_bar=20"};
const std::vector<std::string> kRate = {"hydraulics.cavitation=rate"};

std::vector<std::string> joined(const std::vector<std::vector<std::string>>& parts) {
  std::vector<std::string> all;
  for (const auto& part : parts)
    for (const auto& change : part)
      if (std::find(all.begin(), all.end(), change) == all.end()) all.push_back(change);
  return all;
}

std::vector<Circuit> circuits() {
  return {
      {"orifice", {}},
      {"open", {"pressure.delivery_bar=0"}},
      {"laminar", {"load.kind=laminar", "pressure.suction_bar=1"}},
      {"relief valve", {"load.kind=relief_valve", "load.cracking_bar=200"}},
      {"constant pressure", {"load.kind=constant_pressure"}},
      {"given flow", {"load.kind=flow", "load.flow_l_per_min=90"}},
      {"suction line", kSuction},
      {"delivery line", kLine},
      {"delivery line, constant pressure", joined({kLine, {"load.kind=constant_pressure"}})},
      {"equilibrium", {"hydraulics.cavitation=equilibrium"}},
      {"gaps", kGaps},
      {"rate", kRate},
      {"orifice, given", {"load.area_mm2=9"}},
      {"relief valve beside",
       {"load.kind=laminar", "load.conductance_l_per_min_per_bar=0.3", "load.relief_bar=20",
        "load.full_area_mm2=40"}},
      {"line, relief valve beside a given flow",
       joined({kLine, {"load.kind=flow", "load.flow_l_per_min=50", "load.relief_bar=10"}})},
      {"accumulator", kAccumulator},
      {"accumulator, isothermal, line held at a pressure",
       joined(
           {kAccumulator, kLine, {"accumulator.gas_exponent=1", "load.kind=constant_pressure"}})},
      {"loop", kLoop},
      {"loop, laminar, relief valve", joined({kLoop, {"load.kind=laminar", "load.relief_bar=15"}})},
      {"loop, relief valve", joined({kLoop, {"load.kind=relief_valve", "load.cracking_bar=5"}})},
      {"loop, given flow", joined({kLoop,
                                   {"load.kind=flow", "load.flow_l_per_min=90",
                                    "hydraulics.transition_pressure_bar=5"}})},
      {"loop with all", joined({kLoop, kLine, kAccumulator, kRate, {"load.relief_bar=12"}})},
      {"all", joined({kLine,
                      kSuction,
                      kGaps,
                      kRate,
                      {"load.kind=relief_valve", "hydraulics.bulk_modulus_slope=10"}})}};
}

std::mt19937& engine() {
  static std::mt19937 one(15);
  return one;
}
double random(double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(engine());
}

// A circuit at an instant of any motion.
struct Anything {
  AxisMotion shaft, block;
  std::vector<double> y;
};
Anything anything(const Oil& oil, const Case& the_case) {
  const Network network(the_case, Network::Use::time);
  Anything at;
  at.shaft = {random(-20, 20), random(-200, 200), 0};
  at.block = {at.shaft.angle + random(-0.05, 0.05), at.shaft.speed + random(-5, 5), 0};
  at.y = network.uniform(0, random(-1, 6), network.ideal_mass_flow() * random(-1, 1));
  for (double& value : at.y) value += random(-0.4, 0.4);
  // Of chambers any pressure, the ports' below as well.
  for (int k = 0; k < oil.pistons(); ++k) at.y[k] = random(-1.5, 6);
  // What else is renumbered with the chambers is the air that is out in them.
  const auto order = oil.order_after_period();
  for (int i = oil.pistons(); i < oil.states(); ++i)
    if (order[i] != i) at.y[i] = random(0, 1);
  return at;
}

double size_for_tests(const Case& the_case) {
  const Network network(the_case);
  return network.load_size_for(0.9 * network.ideal_mass_flow());
}

std::unique_ptr<Oil> with_load(const Case& the_case) {
  return oil_in_time(the_case, {size_for_tests(the_case), {}});
}

// Of a function of time at 0, by 8 points at +-h .. +-4h.
double slope(const std::function<double(double)>& f, double h) {
  const double weights[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += weights[i] * (f((i + 1) * h) - f(-(i + 1) * h));
  return sum / h;
}

TEST(ChamberInTime, IsTheChamberWhereBothTurnAlike) {
  for (const double offset : {0.0, 0.4e-3}) {
    Case the_case = rated();
    the_case.pump.geometry.axis_offset = offset;
    const Chamber chamber(the_case.pump.geometry, 3e-6);
    for (double angle = -7; angle < 7; angle += 0.37) {
      const Chamber::Volume both = chamber.volume(angle);
      const Chamber::Turned each = chamber.volume(angle, angle);
      EXPECT_NEAR(each.value / both.value, 1, scaled(1e-13));
      EXPECT_NEAR(each.by_joint + each.by_bore, both.slope, scaled(1e-13) * chamber.swept());
    }
  }
}

TEST(ChamberInTime, SlopesAreThoseOfTheVolume) {
  Case the_case = rated();
  the_case.pump.geometry.axis_offset = 0.3e-3;
  const Chamber chamber(the_case.pump.geometry, 3e-6);
  for (int i = 0; i < 50; ++i) {
    const double theta = random(-4, 4), psi = theta + random(-0.2, 0.2);
    const Chamber::Turned at = chamber.volume(theta, psi);
    const double h = 0.02;
    EXPECT_NEAR(slope([&](double t) { return chamber.volume(theta + t, psi).value; }, h),
                at.by_joint, scaled(1e-10) * chamber.swept());
    EXPECT_NEAR(slope([&](double t) { return chamber.volume(theta, psi + t).value; }, h),
                at.by_bore, scaled(1e-10) * chamber.swept());
  }
}

void expect_rates_of_a_period(const Case& the_case, const std::string& name) {
  const Network network(the_case);
  const double size = network.load_size_for(0.9 * network.ideal_mass_flow());
  const auto oil = oil_in_time(the_case, {size, {}});
  ASSERT_EQ(oil->states(), network.states()) << name;
  const double sign = the_case.operation.speed_rpm > 0 ? 1 : -1;
  for (int trial = 0; trial < 20; ++trial) {
    Anything at = anything(*oil, the_case);
    const double x = random(0, network.period_deg());
    at.shaft =
        at.block = {sign * radians(x), sign * kRadPerDegree / network.seconds_per_degree(), 0};
    std::vector<double> per_second(oil->states()), per_degree(network.size());
    ASSERT_TRUE(oil->rates(0, at.shaft, at.block, at.y.data(), per_second.data()));
    std::vector<double> with_mean = at.y;
    with_mean.resize(network.size());
    ASSERT_TRUE(network.rates(x, with_mean.data(), size, per_degree.data()));
    double scale = 0;
    for (const double rate : per_second) scale = std::max(scale, std::abs(rate));
    for (int i = 0; i < oil->states(); ++i)
      EXPECT_NEAR(per_second[i] * network.seconds_per_degree(), per_degree[i],
                  scaled(1e-12) * scale * network.seconds_per_degree())
          << name << " " << i;
  }
}

TEST(OilInTime, AtConstantSpeedItsRatesAreThoseOfThePeriodTimesSpeed) {
  int backwards = 0;
  for (const Circuit& circuit : circuits()) {
    Case the_case = rated(circuit.changes);
    expect_rates_of_a_period(the_case, circuit.name);
    if (Network(the_case).load_sought()) continue;
    the_case.operation.speed_rpm *= -1;
    expect_rates_of_a_period(the_case, circuit.name + ", backwards");
    ++backwards;
  }
  EXPECT_GT(backwards, 5);
}

TEST(OilInTime, EnergyAndMassBalanceAtAnyState) {
  for (const Circuit& circuit : circuits()) {
    const Case the_case = rated(circuit.changes);
    const auto oil = with_load(the_case);
    const auto places = oil->places();
    ASSERT_EQ(places.front().key, "pistons");
    for (int trial = 0; trial < 40; ++trial) {
      const Anything at = anything(*oil, the_case);
      std::vector<double> dy(oil->states()), power(places.size());
      ASSERT_TRUE(oil->rates(0, at.shaft, at.block, at.y.data(), dy.data())) << circuit.name;
      double mass_in = 0, mass_out = 0;
      oil->powers(0, at.shaft, at.block, at.y.data(), power.data(), mass_in, mass_out);
      double left = 0, all = 0;
      for (std::size_t i = 0; i < places.size(); ++i) {
        left += places[i].use == PowerUse::source ? power[i] : -power[i];
        all += std::abs(power[i]);
      }
      // What is stored, along the way that states and angles take.
      double fastest = std::max(std::abs(at.shaft.speed), std::abs(at.block.speed));
      for (const double rate : dy) fastest = std::max(fastest, std::abs(rate));
      const auto stored = [&](double time, bool mass) {
        AxisMotion shaft = at.shaft, block = at.block;
        shaft.angle += time * shaft.speed;
        block.angle += time * block.speed;
        std::vector<double> y = at.y;
        for (std::size_t i = 0; i < y.size(); ++i) y[i] += time * dy[i];
        double energy = 0, kilograms = 0;
        oil->stored(0, shaft, block, y.data(), energy, kilograms);
        return mass ? kilograms : energy;
      };
      const double h = 2e-3 / fastest;
      const double energy = slope([&](double t) { return stored(t, false); }, h);
      const double mass = slope([&](double t) { return stored(t, true); }, h);
      // Differences are exact to the round-off of what is stored.
      const double energy_noise = 1e-14 * std::abs(stored(0, false)) / h;
      const double mass_noise = 1e-14 * std::abs(stored(0, true)) / h;
      EXPECT_NEAR(left, energy, scaled(1e-8) * all + energy_noise) << circuit.name;
      EXPECT_LT(energy_noise, 1e-4 * all) << circuit.name;
      EXPECT_NEAR(mass_in - mass_out, mass,
                  scaled(1e-8) * (std::abs(mass_in) + std::abs(mass_out)) + mass_noise)
          << circuit.name;
    }
  }
}

TEST(OilInTime, JacobianIsTheDerivativeOfTheRates) {
  for (const Circuit& circuit : circuits()) {
    const Case the_case = rated(circuit.changes);
    const auto oil = with_load(the_case);
    const int n = oil->states();
    for (int trial = 0; trial < 20; ++trial) {
      const Anything at = anything(*oil, the_case);
      std::vector<double> by_state(n * n), low(n), high(n);
      oil->jacobian(0, at.shaft, at.block, at.y.data(), by_state.data());
      for (int column = 0; column < n; ++column) {
        const double h = 1e-6;
        auto moved = at.y;
        moved[column] += h;
        oil->rates(0, at.shaft, at.block, moved.data(), high.data());
        moved[column] -= 2 * h;
        oil->rates(0, at.shaft, at.block, moved.data(), low.data());
        const double* expected = by_state.data() + column * n;
        double scale = 1;
        for (int row = 0; row < n; ++row) scale = std::max(scale, std::abs(expected[row]));
        for (int row = 0; row < n; ++row)
          EXPECT_NEAR((high[row] - low[row]) / (2 * h), expected[row], scaled(1e-5) * scale)
              << circuit.name << " " << row << " " << column;
      }
    }
  }
}

TEST(OilInTime, NothingIsDividedByTheSpeed) {
  for (const double speed : {0.0, -1600.0}) {
    for (const Circuit& circuit : circuits()) {
      Case the_case = rated(circuit.changes);
      const double size = size_for_tests(the_case);
      the_case.operation.speed_rpm = speed;
      const auto oil = oil_in_time(the_case, {size, {}});
      const std::vector<double> y = oil->start();
      std::vector<double> dy(oil->states());
      EXPECT_TRUE(oil->rates(0, {}, {}, y.data(), dy.data())) << circuit.name;
      Anything at = anything(*oil, the_case);
      at.shaft.speed = at.block.speed = 0;
      EXPECT_TRUE(oil->rates(0, at.shaft, at.block, at.y.data(), dy.data())) << circuit.name;
      for (const double rate : dy) EXPECT_TRUE(std::isfinite(rate)) << circuit.name;
    }
  }
}

TEST(OilInTime, AtRestNothingFlowsFromWhatIsEvenlyLoaded) {
  // Suction, case and surroundings at atmospheric pressure: the start is an equilibrium.
  const auto oil = with_load(rated());
  const std::vector<double> y = oil->start();
  std::vector<double> dy(oil->states());
  ASSERT_TRUE(oil->rates(0, {}, {}, y.data(), dy.data()));
  for (const double rate : dy) EXPECT_EQ(rate, 0);
  // Held at a pressure, the chambers that are open to it have it.
  const auto held = with_load(rated({"load.kind=constant_pressure"}));
  OilLoads loads;
  const std::vector<double> start = held->start();
  held->loads(0, {}, start.data(), loads);
  const Case the_case = rated();
  const Network network(the_case);
  int high = 0;
  for (int k = 0; k < held->pistons(); ++k) {
    const double angle = network.angle_deg(0, k);
    const bool open = network.delivery().area(angle) > network.suction().area(angle);
    high += open ? 1 : 0;
    EXPECT_NEAR(loads.chamber_pressure[k], open ? the_case.pressure.ports.delivery : 0, 1e-3) << k;
  }
  EXPECT_GT(high, 1);
  EXPECT_NEAR(loads.ports.delivery, the_case.pressure.ports.delivery, 1e-3);
}

TEST(OilInTime, AfterAPeriodEveryPistonStandsWhereTheOneBeforeItStood) {
  const std::vector<std::vector<std::string>> cases = {{}, joined({kSuction, kRate})};
  for (const auto& changes : cases) {
    const Case the_case = rated(changes);
    const SteadyState state = steady_state(the_case);
    const auto oil = oil_in_time(the_case, running(state));
    const Network network(the_case);
    Integrator integrator(network);
    const auto end = integrator.over_period(oil->start(), state.corrected_load_size, 1e-11);
    const auto order = oil->order_after_period();
    const auto start = oil->start();
    double moved = 0;
    for (int i = 0; i < oil->states(); ++i) {
      EXPECT_NEAR(end[order[i]], start[i], scaled(1e-7)) << i;
      moved = std::max(moved, std::abs(end[i] - start[i]));
    }
    EXPECT_GT(moved, 1);  // without the new numbers it has not returned
  }
}

TEST(OilInTime, EdgesAreThoseOfEveryChamber) {
  const Case the_case = rated();
  const auto oil = oil_in_time(the_case, {});
  const Network network(the_case);
  const auto edges = oil->edges_deg();
  EXPECT_TRUE(std::is_sorted(edges.begin(), edges.end()));
  EXPECT_GE(edges.front(), 0);
  EXPECT_LT(edges.back(), 360);
  const auto has = [&](double angle) {
    return std::any_of(edges.begin(), edges.end(), [&](double edge) {
      const double off = std::fmod(std::abs(edge - angle), 360);
      return std::min(off, 360 - off) < 1e-8;
    });
  };
  std::size_t expected = 0;
  for (const auto* port : {&network.delivery(), &network.suction()})
    for (const double edge : port->edges_deg())
      for (int k = 0; k < 5; ++k, ++expected) EXPECT_TRUE(has(edge + 72 * k)) << edge << " " << k;
  EXPECT_LE(edges.size(), expected);
}

TEST(OilInTime, RowsAreThePressuresAndFlows) {
  const Case the_case = rated();
  const SteadyState state = steady_state(the_case);
  const auto oil = oil_in_time(the_case, running(state));
  std::vector<std::string> names;
  for (const OilColumn& column : oil->columns()) names.push_back(column.name);
  EXPECT_THAT(names, ElementsAre("p_1_bar", "p_2_bar", "p_3_bar", "p_4_bar", "p_5_bar",
                                 "p_suction_bar", "p_delivery_bar", "flow_suction_l_per_min",
                                 "flow_delivery_l_per_min", "leakage_l_per_min", "power_useful_W"));
  const double speed = the_case.operation.speed_rpm * 2 * kPi / 60;
  std::vector<double> row(names.size());
  const auto start = oil->start();
  oil->row(0, {0, speed, 0}, {0, speed, 0}, start.data(), row.data());
  const auto column = [&](const std::string& name) {
    for (std::size_t c = 0; c < state.table.columns(); ++c)
      if (state.table.channels[c].name == name) return state.table.values[c];
    ADD_FAILURE() << name;
    return 0.0;
  };
  EXPECT_NEAR(row[0], column("p_1_bar"), 1e-5);
  EXPECT_NEAR(row[6], column("p_delivery_bar"), 1e-5);
  EXPECT_NEAR(row[8], column("Qload_l_per_min"), 1e-5);
  // From a tank at atmospheric pressure, without a line: what goes into the load.
  EXPECT_NEAR(row[10] / column("power_load_W"), 1, 1e-6);
}

// ---- What is connected
// ---------------------------------------------------------------------------------------

TEST(Accumulator, GasFollowsItsLawAndKeepsItsWork) {
  for (const double exponent : {1.0, 1.4}) {
    const Case the_case = rated();
    const Fluid fluid(*the_case.hydraulics);
    const AccumulatorData data{2e-3, 1e7, exponent, 1e-4};
    const Accumulator accumulator(data, fluid);
    const double precharge = 1e7 + fluid.atmosphere();
    const double none = accumulator.oil(fluid.log_pressure(9e6)).volume;
    EXPECT_NEAR(none, 2e-5, 1e-18);
    EXPECT_EQ(accumulator.energy(fluid.log_pressure(9e6)), 0);
    for (const double gauge : {1.01e7, 2e7, 4e7}) {
      const double s = fluid.log_pressure(gauge);
      const Accumulator::Oil oil = accumulator.oil(s);
      const double gas = data.gas_volume - (oil.volume - none);
      EXPECT_NEAR((gauge + fluid.atmosphere()) * std::pow(gas, exponent) /
                      (precharge * std::pow(data.gas_volume, exponent)),
                  1, scaled(1e-12));
      const auto volume = [&](double t) { return accumulator.oil(s + t).volume; };
      const auto first = [&](double t) { return accumulator.oil(s + t).first; };
      const auto energy = [&](double t) { return accumulator.energy(s + t); };
      const double h = 1e-3;
      EXPECT_NEAR(slope(volume, h) / oil.first, 1, scaled(1e-9));
      EXPECT_NEAR(slope(first, h) / oil.second, 1, scaled(1e-9));
      EXPECT_NEAR(slope(energy, h) / (gauge * oil.first), 1, scaled(1e-9));
    }
  }
}

TEST(ClosedLoop, LoadAndReliefValveActAlikeInBothDirections) {
  const Case the_case = rated();
  const Fluid fluid(*the_case.hydraulics);
  const Orifice orifice{0.67, 1e8};
  const auto at = [&](double gauge) { return fluid.state(fluid.log_pressure(gauge)); };
  for (const LoadKind kind :
       {LoadKind::orifice, LoadKind::laminar, LoadKind::flow, LoadKind::relief_valve}) {
    LoadData data;
    data.kind = kind;
    data.cracking_pressure = 1e7;
    data.relief_pressure = 1.5e7;
    const Load both(data, orifice, fluid, 1, true), open(data, orifice, fluid, 1, false);
    const double size = kind == LoadKind::relief_valve ? both.size()
                        : kind == LoadKind::flow       ? 1
                                                       : 1e-9;
    const Load::Flow there = both.flow(at(2e7), at(2e6), size);
    const Load::Flow back = both.flow(at(2e6), at(2e7), size);
    EXPECT_GT(there.value, 0);
    EXPECT_EQ(there.value, -back.value);
    EXPECT_EQ(there.relief, -back.relief);
    EXPECT_EQ(there.relief > 0, kind != LoadKind::relief_valve);
    EXPECT_NEAR(there.by_side, -back.by_outside, scaled(1e-12) * std::abs(there.by_side));
    // A relief valve of an open circuit lets nothing in.
    if (kind == LoadKind::relief_valve) {
      EXPECT_EQ(open.flow(at(2e6), at(2e7), size).value, 0);
    }
    EXPECT_NEAR(open.flow(at(2e7), at(2e6), size).value, there.value, 0);
  }
}

TEST(ClosedLoop, ChargeSupplyFeedsEitherSideAndTakesNothingBack) {
  const Case the_case = rated({"loop.volume_l=0.3", "pressure.suction_bar=20"});
  const Network network(the_case, Network::Use::time);
  const auto oil = oil_in_time(the_case, {1e-6, {}});
  const auto columns = oil->columns();
  std::vector<double> row(columns.size());
  const auto fed = [&](double low, double high) {
    std::vector<double> y = oil->start();
    y[5] = network.fluid().log_pressure(high * kPascalPerBar);  // delivery volume
    y[6] = network.fluid().log_pressure(low * kPascalPerBar);   // suction port
    oil->row(0, {}, {}, y.data(), row.data());
    EXPECT_EQ(columns[7].name, "flow_suction_l_per_min");
    return row[7];
  };
  EXPECT_NEAR(fed(20, 200), 0, 1e-2);
  EXPECT_GT(fed(19, 200), 1);
  EXPECT_NEAR(fed(200, 19), fed(19, 200), 1e-9);
  EXPECT_EQ(fed(21, 300), 0);
  EXPECT_EQ(fed(300, 21), 0);
  // At rest all of it is at the charge pressure.
  const auto start = oil->start();
  OilLoads loads;
  oil->loads(0, {}, start.data(), loads);
  EXPECT_NEAR(loads.ports.delivery, 2e6, 1e-6);
  EXPECT_NEAR(loads.ports.suction, 2e6, 1e-6);
}

TEST(Load, ShareOverTimeIsTimesTheSize) {
  for (const std::string kind : {"orifice", "laminar", "flow", "relief_valve"}) {
    Case the_case = rated({"load.kind=" + kind, "load.flow_l_per_min=80", "load.cracking_bar=150"});
    the_case.hydraulics->load->area = 9e-6;
    the_case.hydraulics->load->conductance = 5e-11;
    Case with_curve = the_case;
    with_curve.hydraulics->load->share = {"x.csv", {0, 1, 2, 3}, {1, 1, 0.5, 0.5}};
    Case half = the_case;
    LoadData& load = *half.hydraulics->load;
    for (double* one : {&load.area, &load.conductance, &load.flow, &load.cracking_pressure})
      *one /= 2;
    const auto plain = oil_in_time(the_case, {}), curve = oil_in_time(with_curve, {}),
               halved = oil_in_time(half, {});
    EXPECT_THAT(curve->breakpoints(), ElementsAre(0, 1, 2, 3));
    EXPECT_TRUE(plain->breakpoints().empty());
    std::vector<double> y = plain->start();
    y[5] = 5.3;
    const std::size_t flow = plain->columns().size() - 3;
    ASSERT_EQ(plain->columns()[flow].name, "flow_delivery_l_per_min");
    const auto value = [&](const Oil& oil, double time) {
      std::vector<double> row(oil.columns().size());
      oil.row(time, {}, {}, y.data(), row.data());
      return row[flow];
    };
    EXPECT_GT(value(*plain, 0), 1) << kind;
    EXPECT_EQ(value(*curve, 0.5), value(*plain, 0)) << kind;
    EXPECT_NEAR(value(*curve, 2.5) / value(*halved, 0), 1, scaled(1e-12)) << kind;
    EXPECT_GT(std::abs(value(*curve, 2.5) / value(*curve, 0.5) - 1), 0.05) << kind;
  }
}

TEST(Load, CurveOfItsShareIsRead) {
  const auto folder = std::filesystem::temp_directory_path() /
                      ("bentaxis_oil_in_time_" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  const auto write = [&](const std::string& text) {
    std::ofstream(folder / "share.csv") << text;
    return folder / "share.csv";
  };
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      read_share_curve(write(text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "not refused";
  };
  const TimeCurve curve = read_share_curve(write("time_s,share\n0,1\n1,1\n1.1,2\n2,0\n"));
  EXPECT_THAT(curve.value, ElementsAre(1, 1, 2, 0));
  EXPECT_THAT(refusal("time_s,torque_Nm\n0,1\n"), HasSubstr("header must be time_s,share"));
  EXPECT_THAT(refusal("time_s,share\n0,1\n1,-1\n"), HasSubstr(">= 0"));
  EXPECT_THAT(refusal("time_s,share\n0,1\n1,1\n"), HasSubstr("at least 4"));
  write("time_s,share\n0,1\n1,1\n2,0.5\n3,0.5\n");
  const Case with_file = rated({"load.file=" + (folder / "share.csv").string()});
  EXPECT_THAT(with_file.hydraulics->load->share.time, ElementsAre(0, 1, 2, 3));
  std::filesystem::remove_all(folder);
}

// With the supply at the delivery port oil may enter there: a motor.
TEST(OilInTime, HeldDeliveryTakesAndGives) {
  const Case the_case = rated({"load.kind=constant_pressure"});
  const auto oil = oil_in_time(the_case, {});
  const auto columns = oil->columns();
  std::vector<double> y = oil->start(), row(columns.size());
  const auto into_load = [&](double chambers) {
    for (int k = 0; k < 5; ++k) y[k] = chambers;
    oil->row(0, {}, {}, y.data(), row.data());
    EXPECT_EQ(columns[8].name, "flow_delivery_l_per_min");
    return row[8];
  };
  EXPECT_GT(into_load(6), 1);
  EXPECT_LT(into_load(5), -1);
}

TEST(OilInTime, LoadOfSizeZeroIsClosed) {
  for (const std::string kind : {"orifice", "laminar", "relief_valve"}) {
    const auto oil = oil_in_time(rated({"load.kind=" + kind}), {});
    std::vector<double> y = oil->start(), row(oil->columns().size());
    y[5] = 6;
    oil->row(0, {}, {}, y.data(), row.data());
    ASSERT_EQ(oil->columns()[8].name, "flow_delivery_l_per_min");
    EXPECT_EQ(row[8], 0) << kind;
  }
}

TEST(OilInTime, StatesOfAnotherCircuitAreRefused) {
  EXPECT_THROW(oil_in_time(rated(), {1e-5, {0, 0, 0}}), InputError);
}

}  // namespace
}  // namespace bentaxis::hydraulics
