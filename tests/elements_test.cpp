// Each element of the hydraulic circuit alone between the volumes of both ports: its Jacobian is
// the derivative of its rates, and what it takes, loses and holds adds up.
#include "elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/units.h"
#include "chambers.h"
#include "support.h"

namespace bentaxis::hydraulics {
namespace {

using test::scaled;

// Written down before any element was measured: errors of the differences, of the largest entry of
// a column and of the sum of all powers.
constexpr double kJacobian = 1e-5, kPower = 1e-6;

Case rated(const std::vector<std::string>& changes = {}) {
  return read_case(
      std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated_hydraulic.toml", changes);
}

// A circuit of few elements, held by nothing but tank and atmosphere.
struct Bench {
  explicit Bench(Case c) : the_case(std::move(c)) {}

  template <class E, class... Arguments>
  E& add(Arguments&&... arguments) {
    auto element = std::make_unique<E>(std::forward<Arguments>(arguments)...);
    E& added = *element;
    added.begin_at(states);
    states += added.states();
    elements.push_back(std::move(element));
    return added;
  }
  System connected(const double* y) const {
    System sys(fluid, now, y, load_size);
    sys.hold(kTank, tank);
    sys.hold(kOutside, outside);
    sys.hold(kSuction, tank);
    sys.hold(kDelivery, high);
    for (const auto& each : elements) each->connect(sys);
    return sys;
  }
  void run(System& sys) const {
    for (const auto& each : elements) each->connect(sys);
    for (const auto& each : elements) each->stamp(sys);
    for (const auto& each : elements) each->finish(sys);
  }
  std::vector<double> rates(const std::vector<double>& y, Flows* flows = nullptr) const {
    std::vector<double> dy(y.size());
    System sys = connected(y.data());
    sys.rates = dy.data();
    sys.flows = flows;
    run(sys);
    return dy;
  }
  Stored stored(const std::vector<double>& y) const {
    System sys = connected(y.data());
    Stored all;
    for (const auto& each : elements) each->stored(sys, all);
    return all;
  }

  Case the_case;
  const HydraulicData& data = *the_case.hydraulics;
  Fluid fluid{data};
  Orifice orifice{data.discharge_coefficient, data.transition_pressure* data.transition_pressure};
  Held tank{fluid, 20e5}, outside{fluid, 0}, high{fluid, 200e5};
  Moment now{37, 1, 0, {}, {}, true};  // per second, the pistons at rest
  double load_size = 0;
  int states = 0;
  std::vector<std::unique_ptr<Element>> elements;
};

void expect_jacobian(Bench& bench, const std::vector<double>& y, const std::string& name) {
  const int n = bench.states;
  constexpr double kStep = 1e-6;
  std::vector<double> by_state(static_cast<std::size_t>(n) * n), by_load(n);
  System sys = bench.connected(y.data());
  sys.want(by_state.data(), by_load.data(), n);
  bench.run(sys);
  const auto expect_column = [&](const double* column, const std::vector<double>& low,
                                 const std::vector<double>& high) {
    double scale = 1;
    for (int row = 0; row < n; ++row) scale = std::max(scale, std::abs(column[row]));
    for (int row = 0; row < n; ++row)
      EXPECT_NEAR((high[row] - low[row]) / (2 * kStep), column[row], scaled(kJacobian) * scale)
          << name << " " << row;
  };
  for (int j = 0; j < n; ++j) {
    auto low = y, high = y;
    low[j] -= kStep;
    high[j] += kStep;
    expect_column(by_state.data() + static_cast<std::ptrdiff_t>(j) * n, bench.rates(low),
                  bench.rates(high));
  }
  const double size = bench.load_size;
  bench.load_size = size * std::exp(-kStep);
  const auto low = bench.rates(y);
  bench.load_size = size * std::exp(kStep);
  expect_column(by_load.data(), low, bench.rates(y));
  bench.load_size = size;
}

// d(energy)/dt is what comes from the tank and the pistons less all else, and d(mass)/dt what comes
// from the tank less what the load and the case get. Returns the power by place.
PowerBudget expect_balance(const Bench& bench, const std::vector<double>& y, bool loop,
                           const std::string& name) {
  Flows flows;
  const std::vector<double> dy = bench.rates(y, &flows);
  PowerBudget power;
  System sys = bench.connected(y.data());
  power[Place::tank] = flows.taken * sys.potential(kTank);
  for (const auto& each : bench.elements) each->power(sys, flows, power);
  double fastest = 1, sum = 1e-3, leaks = 0;
  for (const double rate : dy) fastest = std::max(fastest, std::abs(rate));
  const double h = 1e-5 / fastest;
  auto before = y, after = y;
  for (std::size_t i = 0; i < y.size(); ++i) {
    before[i] -= h * dy[i];
    after[i] += h * dy[i];
  }
  const Stored first = bench.stored(before), last = bench.stored(after);
  for (int i = 0; i < kPlaces; ++i) sum += std::abs(power[static_cast<Place>(i)]);
  EXPECT_NEAR((last.energy - first.energy) / (2 * h), left_over(power), scaled(kPower) * sum)
      << name;
  for (const double leak : flows.leakage) leaks += leak;
  const double out = (loop ? 0 : flows.load) + leaks;
  EXPECT_NEAR((last.mass - first.mass) / (2 * h), flows.taken - out,
              scaled(kPower) * (std::abs(flows.taken) + std::abs(flows.load) +
                                std::abs(flows.accumulator) + leaks + 1e-3))
      << name;
  // Every place that takes power is one that the elements name.
  std::vector<Place> places = {Place::tank, Place::load};
  for (const auto& each : bench.elements) each->places(places);
  for (int i = 0; i < kPlaces; ++i)
    EXPECT_TRUE(power[static_cast<Place>(i)] == 0 ||
                std::find(places.begin(), places.end(), static_cast<Place>(i)) != places.end())
        << name << " " << key_of(static_cast<Place>(i));
  return power;
}

// At states about these, moved at random.
void expect_element(Bench& bench, const std::vector<double>& about, const std::string& name,
                    bool loop = false) {
  ASSERT_EQ(bench.states, static_cast<int>(about.size())) << name;
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> moved(-0.3, 0.3);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> y = about;
    for (double& value : y) value += moved(engine);
    expect_jacobian(bench, y, name);
    const PowerBudget power = expect_balance(bench, y, loop, name);
    for (const Place loss : {Place::suction_line, Place::delivery_line, Place::damped_waves,
                             Place::relief_valve, Place::accumulator_inlet, Place::charge_valves})
      EXPECT_GE(power[loss], -1e-9) << name << " " << key_of(loss);
  }
}

TEST(Elements, LoadsBetweenPorts) {
  for (const LoadKind kind :
       {LoadKind::orifice, LoadKind::laminar, LoadKind::relief_valve, LoadKind::flow})
    for (const bool loop : {false, true}) {
      Bench bench(rated());
      LoadData data;
      data.kind = kind;
      data.opening = 1e-6 / 1e5;
      data.full_area = 10e-6;
      const Load load(data, bench.orifice, bench.fluid, 1.2, loop);
      bench.load_size = kind == LoadKind::orifice        ? 9e-6
                        : kind == LoadKind::laminar      ? 6e-11
                        : kind == LoadKind::relief_valve ? 100e5
                                                         : 1;
      bench.add<PortVolume>(kDelivery, 1e-3);
      std::vector<double> y = {5};
      if (loop) {
        bench.add<PortVolume>(kSuction, 5e-4);
        y.push_back(3);
      }
      bench.add<LoadBranch>(load, kDelivery, loop ? kSuction : kOutside);
      expect_element(bench, y, std::to_string(static_cast<int>(kind)), loop);
    }
}

TEST(Elements, SuctionPipe) {
  Bench bench(rated());
  bench.add<PortVolume>(kSuction, 1e-3);
  bench.add<SuctionPipe>(SuctionLine({1, 0.04, 2, 1e-3}, bench.tank.oil, 4e-5), 1.5);
  expect_element(bench, {3, 0.5}, "suction pipe");
  expect_element(bench, {3, -0.5}, "suction pipe, backwards");
}

TEST(Elements, DeliveryPipeToALoadOrAHeldEnd) {
  for (const bool held : {false, true}) {
    Bench bench(rated());
    LoadData data;
    data.kind = LoadKind::orifice;
    const Load load(data, bench.orifice, bench.fluid, 0);
    bench.load_size = 9e-6;
    using End = TransmissionLine::End;
    const TransmissionLine line({1, 0.02, 1000, 1000}, held ? End::given_pressure : End::given_flow,
                                bench.high.oil, 4e-5);
    bench.add<PortVolume>(kDelivery, 1e-3);
    const auto& pipe = bench.add<DeliveryPipe>(line, bench.high, held ? &bench.high : nullptr);
    if (held)
      bench.add<HeldEnd>(kFarEnd);
    else
      bench.add<LoadBranch>(load, kFarEnd, kOutside);
    std::vector<double> y(bench.states);
    y[0] = bench.high.s;
    line.uniform(bench.high.oil.pressure, 1.5, y.data() + pipe.at());
    // Modes that keep the pressure at the far end above the atmosphere.
    for (int i = 0; i < line.size(); ++i) y[pipe.at() + i] *= 0.5;
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> moved(-0.02, 0.02);
    for (int trial = 0; trial < 20; ++trial) {
      auto near = y;
      for (double& value : near) value += moved(engine);
      expect_jacobian(bench, near, "delivery pipe");
      expect_balance(bench, near, false, "delivery pipe");
    }
  }
}

TEST(Elements, ChargeSupply) {
  Bench bench(rated());
  bench.add<PortVolume>(kDelivery, 1e-3);
  bench.add<PortVolume>(kSuction, 1e-3);
  bench.add<ChargeSupply>(bench.orifice, 3e-5, 2e5);
  expect_element(bench, {bench.tank.s - 0.05, 5}, "delivery side", true);
  expect_element(bench, {5, bench.tank.s - 0.05}, "suction side", true);
  Flows flows;
  bench.rates({5, 5}, &flows);
  EXPECT_EQ(flows.taken, 0) << "takes nothing back";
}

TEST(Elements, Accumulator) {
  Bench bench(rated());
  bench.add<PortVolume>(kDelivery, 1e-3);
  AccumulatorData data;
  data.gas_volume = 5e-4;
  data.precharge = 50e5;
  data.exponent = 1.4;
  data.inlet_area = 5e-5;
  bench.add<AccumulatorBranch>(hydraulics::Accumulator(data, bench.fluid), bench.orifice,
                               data.inlet_area);
  expect_element(bench, {5.2, 5}, "charging");
  expect_element(bench, {5, 5.2}, "discharging");
}

TEST(Elements, ChambersWithGapsAndLateAir) {
  const std::vector<std::vector<std::string>> kinds = {
      {},
      {"oil.temperature_C=60", "leakage.piston_gap_um=15", "leakage.piston_gap_length_mm=10",
       "leakage.plate_gap_um=8"},
      {"hydraulics.cavitation=rate"}};
  for (const auto& changes : kinds)
    for (const bool suction : {false, true}) {
      Bench bench(rated(changes));
      bench.now.turning = 150;  // rad/s
      auto& chambers = bench.add<Chambers>(bench.the_case, bench.fluid, bench.orifice);
      std::vector<double> y(bench.states, 3);
      bench.add<PortVolume>(kDelivery, 1e-3);
      y.push_back(3.5);
      if (suction) {
        bench.add<PortVolume>(kSuction, 1e-3);
        y.push_back(2.5);
      }
      const int air = chambers.begin_air_at(bench.states);
      bench.states += air;
      y.resize(bench.states, 0.5);
      EXPECT_EQ(air > 0, changes == kinds[2]);
      for (int k = 0; k < chambers.count(); ++k)
        y[k] += 0.2 * k - 0.53;  // no flow is just 0, where air comes or goes
      expect_jacobian(bench, y, "chambers");
      // A port of its own takes nothing from the tank.
      if (!suction) {
        Bench& still = bench;
        Flows flows;
        const auto dy = still.rates(y, &flows);
        double sum = 0;
        for (const double out : flows.delivery) sum += out;
        const double rho = still.fluid.state(y[chambers.count()]).density;
        const double stiffness = still.fluid.state(y[chambers.count()]).stiffness;
        EXPECT_NEAR(dy[chambers.count()], stiffness * sum / (rho * 1e-3),
                    scaled(1e-12) * std::abs(dy[chambers.count()]));
        PowerBudget power;
        System sys = still.connected(y.data());
        power[Place::tank] = flows.taken * sys.potential(kTank);
        for (const auto& each : still.elements) each->power(sys, flows, power);
        double all = 0;
        for (int i = 0; i < kPlaces; ++i) all += std::abs(power[static_cast<Place>(i)]);
        // The block turns while the states change.
        const double h = 1e-5 / 1e5;
        const auto stored_at = [&](double t) {
          auto moved = y;
          for (std::size_t i = 0; i < y.size(); ++i) moved[i] += t * dy[i];
          const Moment before = still.now;
          still.now.block_deg += t * still.now.turning / kRadPerDegree;
          const double energy = still.stored(moved).energy;
          still.now = before;
          return energy;
        };
        EXPECT_NEAR((stored_at(h) - stored_at(-h)) / (2 * h), left_over(power), scaled(1e-5) * all);
      }
    }
}

}  // namespace
}  // namespace bentaxis::hydraulics
