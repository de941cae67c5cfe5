// The circuit around the pump: loads, lines, gaps, viscosity: laws, limits with known answers, the
// periodic state with each.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/error.h"
#include "integrator.h"
#include "leakage.h"
#include "load.h"
#include "network.h"
#include "suction_line.h"
#include "support.h"
#include "transmission_line.h"
#include "viscosity.h"

namespace bentaxis::hydraulics {
namespace {

using test::column;
using test::mean;
using test::scaled;
using testing::HasSubstr;

constexpr double kRoundOff = 1e-13;
constexpr double kMassBalance = 1e-9;
constexpr double kEnergyBalance = 1e-9;  // of the pistons' power: what the issue asks for
// Waves within the bandwidth: what docs/hydraulics.md says.
constexpr double kBandwidthError = 1e-3;

Case rated(const std::vector<std::string>& changes = {}) {
  return read_case(
      std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / "bap63_rated_hydraulic.toml", changes);
}

// Oil that is hardly compressible, wide ports that change at the dead centres, no ripple.
Case hardly_compressible(const std::vector<std::string>& changes) {
  Case the_case = rated(changes);
  Geometry& g = the_case.pump.geometry;
  g.axis_offset = 0;
  g.bore_circle_radius = g.joint_circle_radius * (1 + std::cos(g.tilt)) / 2;
  HydraulicData& h = *the_case.hydraulics;
  h.delivery = {{180 + 26, 360 - 26}, {}};
  h.suction = {{26, 180 - 26}, {}};
  h.kidney_width_deg = 52;
  h.kidney_rounding_deg = 0;
  h.kidney_height = 0.1;  // m
  h.bulk_modulus = 1e12;
  h.air_share = 1e-9;
  h.dead_volume = 1e-9;
  h.delivery_volume = 1;
  return the_case;
}

// One of everything, alone and together.
struct Circuit {
  std::string name;
  std::vector<std::string> changes;
};
const std::vector<Circuit> kCircuits = {
    {"laminar", {"load.kind=laminar"}},
    {"relief valve, sought", {"load.kind=relief_valve"}},
    {"relief valve, given", {"load.kind=relief_valve", "load.cracking_bar=200"}},
    {"relief valve, fully open",
     {"load.kind=relief_valve", "load.cracking_bar=20", "load.full_area_mm2=9"}},
    {"constant pressure", {"load.kind=constant_pressure"}},
    {"given flow", {"load.kind=flow", "load.flow_l_per_min=90"}},
    {"suction line", {"suction_line.length_m=1", "suction_line.diameter_mm=40"}},
    {"suction line, open delivery",
     {"suction_line.length_m=1", "suction_line.diameter_mm=40", "pressure.delivery_bar=0"}},
    {"delivery line", {"delivery_line.length_m=1", "delivery_line.diameter_mm=20"}},
    {"delivery line with friction, laminar",
     {"delivery_line.length_m=1", "delivery_line.diameter_mm=20", "load.kind=laminar",
      "oil.temperature_C=60"}},
    {"delivery line, relief valve",
     {"delivery_line.length_m=1", "delivery_line.diameter_mm=20", "load.kind=relief_valve"}},
    {"delivery line, constant pressure",
     {"delivery_line.length_m=1", "delivery_line.diameter_mm=20", "load.kind=constant_pressure"}},
    {"delivery line, given flow",
     {"delivery_line.length_m=1", "delivery_line.diameter_mm=20", "load.kind=flow",
      "load.flow_l_per_min=90", "oil.temperature_C=60"}},
    {"delivery line, open",
     {"delivery_line.length_m=1", "delivery_line.diameter_mm=20", "pressure.delivery_bar=0",
      "delivery_line.wave_speed_m_per_s=1300"}},
    {"gaps",
     {"oil.temperature_C=60", "leakage.piston_gap_um=15", "leakage.piston_gap_length_mm=10",
      "leakage.piston_gap_kind=engaged", "leakage.eccentricity=0.8", "leakage.plate_gap_um=8",
      "leakage.ring_slot_um=50", "leakage.ring_slot_width_mm=0.3", "leakage.ring_slot_length_mm=2",
      "hydraulics.leakage_l_per_min_per_bar=0"}},
    {"orifice, given", {"load.area_mm2=9"}},
    {"laminar, given", {"load.kind=laminar", "load.conductance_l_per_min_per_bar=0.35"}},
    {"relief valve beside an orifice", {"load.relief_bar=270", "load.opening_mm2_per_bar=0.3"}},
    {"relief valve beside a given flow",
     {"load.kind=flow", "load.flow_l_per_min=60", "load.relief_bar=200"}},
    {"accumulator",
     {"accumulator.gas_volume_l=0.5", "accumulator.precharge_bar=200",
      "accumulator.inlet_area_mm2=60"}},
    {"accumulator below its precharge",
     {"accumulator.gas_volume_l=0.5", "accumulator.precharge_bar=300"}},
    {"loop", {"loop.volume_l=0.5", "pressure.suction_bar=20"}},
    {"loop, relief valve", {"loop.volume_l=0.5", "pressure.suction_bar=20", "load.relief_bar=250"}},
    {"loop, relief valve, delivery line, accumulator",
     {"loop.volume_l=0.5", "pressure.suction_bar=20", "load.relief_bar=250",
      "delivery_line.length_m=1", "delivery_line.diameter_mm=20", "accumulator.gas_volume_l=0.2",
      "accumulator.precharge_bar=150"}},
    {"all",
     {"oil.temperature_C=60", "leakage.piston_gap_um=15", "leakage.piston_gap_length_mm=10",
      "leakage.piston_gap_kind=engaged", "leakage.eccentricity=0.8", "suction_line.length_m=1",
      "suction_line.diameter_mm=40", "delivery_line.length_m=1", "delivery_line.diameter_mm=20",
      "load.kind=relief_valve"}}};

// ---- Viscosity and gaps
// --------------------------------------------------------------------------

TEST(Viscosity, GoesThroughBothPointsByWalthersLaw) {
  for (const double celsius : {40.0, 100.0, 60.0, -20.0}) {
    const Viscosity oil({celsius, 46e-6, 6.8e-6, 0}, 850);
    // Written out here again, in decades.
    const auto w = [](double nu) { return std::log10(std::log10(nu + 0.7)); };
    const auto t = [](double c) { return std::log10(c + 273.15); };
    const double slope = (w(6.8) - w(46)) / (t(100) - t(40));
    const double nu = std::pow(10, std::pow(10, w(46) + slope * (t(celsius) - t(40)))) - 0.7;
    EXPECT_NEAR(oil.kinematic() * 1e6 / nu, 1, scaled(1e-12)) << celsius;
    if (celsius == 40) {
      EXPECT_NEAR(oil.kinematic() * 1e6, 46, scaled(1e-11));
    }
    if (celsius == 100) {
      EXPECT_NEAR(oil.kinematic() * 1e6, 6.8, scaled(1e-11));
    }
  }
}

TEST(Viscosity, DriveIsTheIntegralOfPressureOverViscosity) {
  for (const double alpha : {0.0, 1e-16, 2e-8, 1e-7}) {
    const Viscosity oil({40, 46e-6, 6.8e-6, alpha}, 850);
    EXPECT_NEAR(oil.dynamic(1e8) / (46e-6 * 850 * std::exp(alpha * 1e8)), 1, scaled(1e-12));
    const double low = -5e4, high = 4e7;
    const int n = 2000;  // Simpson
    double sum = 0;
    for (int i = 0; i <= n; ++i)
      sum += (i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2) / oil.dynamic(low + (high - low) * i / n);
    EXPECT_NEAR(oil.drive(high, low) / (sum * (high - low) / n / 3), 1, scaled(1e-12)) << alpha;
    EXPECT_NEAR(oil.drive(low, high), -oil.drive(high, low), scaled(1e-12) * oil.drive(high, low));
  }
}

TEST(Leakage, PistonGapGrowsWithEccentricity) {
  for (const double e : {0.0, 0.5, 1.0}) {
    Case the_case = rated({"oil.temperature_C=40", "oil.pressure_viscosity_per_GPa=0",
                           "leakage.piston_gap_um=20", "leakage.piston_gap_length_mm=12",
                           "hydraulics.leakage_l_per_min_per_bar=0"});
    the_case.hydraulics->gaps->eccentricity = e;
    const Fluid fluid(*the_case.hydraulics);
    const Chamber chamber(the_case.pump.geometry, 3e-6);
    const Leakage leakage(the_case, fluid, chamber);
    const auto at = fluid.state(fluid.log_pressure(2e7));
    const double volume_flow =
        leakage.flow(at, 1e-5).value / ((at.density + fluid.state(0).density) / 2);
    // Slot flow h^3 dp/(12 mu l) per width, summed round the piston.
    double sum = 0;
    const int n = 360;
    for (int i = 0; i < n; ++i) sum += std::pow(20e-6 * (1 + e * std::cos(2 * kPi * i / n)), 3) / n;
    const double expected = kPi * 22.5e-3 * sum * 2e7 / (12 * 46e-6 * 850 * 12e-3);
    EXPECT_NEAR(volume_flow / expected, 1, scaled(1e-11)) << e;
    EXPECT_NEAR(sum / std::pow(20e-6, 3), 1 + 1.5 * e * e, scaled(1e-12));
  }
}

TEST(Leakage, EngagedLengthGrowsByThePistonsWay) {
  Case the_case = rated({"oil.temperature_C=40", "leakage.piston_gap_um=20",
                         "leakage.piston_gap_length_mm=12", "leakage.piston_gap_kind=engaged"});
  const Fluid fluid(*the_case.hydraulics);
  const Chamber chamber(the_case.pump.geometry, the_case.hydraulics->dead_volume);
  const Leakage leakage(the_case, fluid, chamber);
  const double stroke = chamber.swept() / (kPi / 4 * 22.5e-3 * 22.5e-3);
  const double deep = leakage.gaps(chamber.volume(0).value);
  const double out = leakage.gaps(the_case.hydraulics->dead_volume + chamber.swept());
  EXPECT_NEAR(out / deep, (12e-3 + stroke) / 12e-3, scaled(1e-9));
  EXPECT_GT(stroke, 20e-3);
}

TEST(Leakage, PlateAndRingAddTheirs) {
  Case the_case = rated({"oil.temperature_C=40", "leakage.plate_gap_um=10"});
  const Fluid fluid(*the_case.hydraulics);
  const Chamber chamber(the_case.pump.geometry, the_case.hydraulics->dead_volume);
  const double plate = Leakage(the_case, fluid, chamber).gaps(1e-5);
  // Slots in series along the radius, each as wide as the sector there.
  double resistance[2] = {0, 0};
  const double lands[2][2] = {{26e-3, 27e-3}, {17e-3, 18e-3}};
  const int n = 20000;
  for (int land = 0; land < 2; ++land)
    for (int i = 0; i < n; ++i) {
      const double dr = (lands[land][1] - lands[land][0]) / n;
      const double r = lands[land][0] + (i + 0.5) * dr;
      resistance[land] += 12 * dr / (radians(52) * r * std::pow(10e-6, 3));
    }
  EXPECT_NEAR(plate / (1 / resistance[0] + 1 / resistance[1]), 1, scaled(1e-8));
  GapData& gaps = *the_case.hydraulics->gaps;
  gaps.ring_slot_height = 50e-6;
  gaps.ring_slot_width = 0.3e-3;
  gaps.ring_slot_length = 2e-3;
  const double ring = 0.3e-3 * std::pow(50e-6, 3) / (12 * 2e-3);
  EXPECT_NEAR(Leakage(the_case, fluid, chamber).gaps(1e-5) / (plate + ring), 1, scaled(1e-12));
}

// ---- Loads
// ---------------------------------------------------------------------------------------

TEST(Load, ReliefValveCharacteristic) {
  const HydraulicData data = *rated().hydraulics;
  const Fluid fluid(data);
  const Orifice orifice{0.67, 1e2};
  const double per_pressure = 1e-6 / 1e5;  // 1 mm2 per bar
  const Load valve({LoadKind::relief_valve, 2e7, per_pressure, 10e-6, 0}, orifice, fluid, 0);
  EXPECT_FALSE(valve.sought());
  EXPECT_EQ(valve.size(), 2e7 + data.atmosphere);
  const auto flow = [&](double gauge) {
    return valve.flow(fluid.state(fluid.log_pressure(gauge)), valve.size()).value;
  };
  EXPECT_EQ(flow(1.9e7), 0);
  EXPECT_EQ(flow(2e7), 0);
  // p_cr of 10 Pa is nothing at 200 bar: the plain law of an orifice.
  for (const double above : {1e4, 1e5, 5e5, 9.9e5, 2e6}) {
    const double density = (fluid.density(2e7 + above) + fluid.density(0)) / 2;
    const double area = std::min(per_pressure * above, 10e-6);
    EXPECT_NEAR(flow(2e7 + above) / (0.67 * area * std::sqrt(2 * density * (2e7 + above))), 1,
                scaled(1e-9))
        << above;
  }
  // What is sought: the cracking pressure that lets a flow pass.
  const Side side = fluid.state(fluid.log_pressure(2e7));
  EXPECT_NEAR(valve.flow(side, valve.size_for(0.5, side)).value, 0.5, scaled(1e-12));
  EXPECT_EQ(valve.flow(side, valve.closed()).value, 0);
}

TEST(Network, JacobianIsTheDerivativeOfTheRates) {
  std::mt19937 engine(3);
  const auto random = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(engine);
  };
  auto circuits = kCircuits;
  circuits.push_back({"orifice", {}});
  circuits.push_back({"open", {"pressure.delivery_bar=0"}});
  for (const Circuit& circuit : circuits) {
    const Network network(rated(circuit.changes));
    const int n = network.size();
    for (int trial = 0; trial < 30; ++trial) {
      // Pressures around those of a circuit: of all chambers and volumes any; the modes small.
      auto y = network.uniform(0, random(-2, 6), network.ideal_mass_flow() * random(-1, 2));
      for (double& value : y) value += random(-0.1, 0.1);
      for (int k = 0; k < network.pistons(); ++k) y[k] = random(-2, 6);
      y.resize(n, random(0, 1));
      const double x = random(0, 72);
      const double size = network.load_size_for(network.ideal_mass_flow()) * random(0.3, 1);
      std::vector<double> by_state(n * n), by_load(n), low(n), high(n);
      network.jacobian(x, y.data(), size, by_state.data(), by_load.data());
      const double h = 1e-6;
      const auto expect_column = [&](const double* expected, double scale) {
        for (int row = 0; row < n; ++row)
          EXPECT_NEAR((high[row] - low[row]) / (2 * h), expected[row], scaled(1e-5) * (scale + 1))
              << circuit.name << " " << row;
      };
      const auto scale_of = [&](const double* column) {
        double scale = 0;
        for (int row = 0; row < n; ++row) scale = std::max(scale, std::abs(column[row]));
        return scale;
      };
      for (int column = 0; column < n; ++column) {
        auto moved = y;
        moved[column] = y[column] + h;
        ASSERT_TRUE(network.rates(x, moved.data(), size, high.data()));
        moved[column] = y[column] - h;
        ASSERT_TRUE(network.rates(x, moved.data(), size, low.data()));
        expect_column(by_state.data() + column * n, scale_of(by_state.data() + column * n));
      }
      network.rates(x, y.data(), size * std::exp(h), high.data());
      network.rates(x, y.data(), size * std::exp(-h), low.data());
      if (network.load_sought()) expect_column(by_load.data(), scale_of(by_load.data()));
    }
  }
}

// ---- Delivery line
// -------------------------------------------------------------------------------

const DeliveryLineData kPipe{2, 0.02, 2000, 1000};  // 2 m at 1000 m/s: 2 ms
Fluid::State oil_in_pipe() { return {2e7, 850, 70, 0}; }

// Frequencies, Hz, of undriven motion, rising; and the decay of each, 1/s.
std::vector<std::pair<double, double>> eigenfrequencies(const TransmissionLine& line) {
  Eigen::MatrixXd matrix(line.size(), line.size());
  for (int i = 0; i < line.size(); ++i)
    for (int j = 0; j < line.size(); ++j) matrix(i, j) = line.by_state(i, j);
  std::vector<std::pair<double, double>> all;
  for (const auto& value : matrix.eigenvalues())
    if (value.imag() > 1) all.emplace_back(value.imag() / (2 * kPi), -value.real());
  std::sort(all.begin(), all.end());
  return all;
}

TEST(DeliveryLine, EigenfrequenciesAreThoseOfAPipe) {
  using End = TransmissionLine::End;
  for (const End end : {End::given_flow, End::given_pressure})
    for (const double viscosity : {0.0, 2e-5}) {
      const TransmissionLine line(kPipe, end, oil_in_pipe(), viscosity);
      const auto found = eigenfrequencies(line);
      // Closed at one end: odd multiples of c/4L = 125 Hz; open at both: multiples of c/2L.
      const double first = end == End::given_flow ? 125 : 250, step = 250;
      for (int n = 0; first + n * step <= kPipe.bandwidth; ++n) {
        ASSERT_LT(n, found.size());
        EXPECT_NEAR(found[n].first / (first + n * step), 1, scaled(kBandwidthError)) << n;
        // Half of the rate at which friction stops a flow: 32 nu/D^2.
        EXPECT_NEAR(found[n].second, 32 * viscosity / (0.02 * 0.02) / 2,
                    scaled(kBandwidthError) * 2 * kPi * found[n].first)
            << n;
      }
    }
}

// A pulse enters at x = 0, where the pressure is given, and runs to and fro.
TEST(DeliveryLine, PulsesRunAsDAlembertSays) {
  using End = TransmissionLine::End;
  const double travel = 2e-3, reference = 2e7, height = 1e5;
  const double width = 3.7 / (kPi * kPipe.bandwidth);  // 1e-6 of its spectrum is above
  const auto pulse = [&](double t) {
    const double u = (t - 5 * width) / width;
    return height * std::exp(-u * u);
  };
  const double impedance = 1000 / (kPi / 4 * 0.02 * 0.02);
  enum class Case { closed, open, matched };
  for (const Case end : {Case::closed, Case::open, Case::matched}) {
    const TransmissionLine line(kPipe, end == Case::open ? End::given_pressure : End::given_flow,
                                oil_in_pipe(), 0);
    EXPECT_NEAR(line.impedance() / impedance, 1, scaled(kRoundOff));
    const int size = line.size();
    std::vector<double> y(size);
    line.uniform(reference, 0, y.data());
    const auto at_end = [&](const std::vector<double>& state) {
      if (end == Case::open) return reference;
      if (end == Case::closed) return 0.0;
      return (line.end_pressure(state.data()) - reference) / impedance;
    };
    // The wave that has run to the right, at x = 0: the pulse and its reflections there.
    const double reflection = end == Case::matched ? 0 : end == Case::closed ? -1 : 1;
    const auto forward = [&](double t) {
      double sum = 0;
      for (int n = 0; n < 4; ++n) sum += std::pow(reflection, n) * pulse(t - 2 * n * travel);
      return sum;
    };
    const double back = end == Case::matched ? 0 : end == Case::closed ? 1 : -1;
    double seen = 0, worst = 0;
    const double h = 1e-6;
    std::vector<double> k[4], trial(size);
    for (int i = 0; i < 10000; ++i) {  // 5 travel times, by Runge and Kutta
      const double t = i * h;
      const double out = end == Case::open ? line.outflow(y.data()) * impedance
                                           : line.end_pressure(y.data()) - reference;
      const double expected = (1 + std::abs(back)) * forward(t - travel);
      worst = std::max(worst, std::abs(out - expected));
      const double in = line.inflow(y.data()) * impedance;
      worst = std::max(worst, std::abs(in - (forward(t) - back * forward(t - 2 * travel))));
      seen = std::max(seen, std::abs(out));
      for (int stage = 0; stage < 4; ++stage) {
        const double step = stage == 0 ? 0 : stage == 3 ? h : h / 2;
        for (int j = 0; j < size; ++j) trial[j] = y[j] + (stage == 0 ? 0 : step * k[stage - 1][j]);
        k[stage].resize(size);
        line.rates(trial.data(), reference + pulse(t + step), at_end(trial), k[stage].data());
      }
      for (int j = 0; j < size; ++j)
        y[j] += h / 6 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
    }
    EXPECT_NEAR(seen, (1 + std::abs(back)) * height, scaled(0.003) * height);
    EXPECT_LT(worst, scaled(0.003) * height) << static_cast<int>(end);
  }
}

double largest_difference(const SteadyState& a, const SteadyState& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.chamber.pressure.size(); ++i)
    worst = std::max(worst, std::abs(a.chamber.pressure[i] - b.chamber.pressure[i]));
  return worst;
}

// A load with the pipe's impedance sends nothing back: the pump cannot tell the pipe from the load.
TEST(DeliveryLine, MatchedLoadIsNoLine) {
  const SteadyState lumped = steady_state(rated({"load.kind=laminar"}));
  const Summary& s = lumped.summary;
  const double impedance = s.delivery_mean / s.mass_flow;
  const double diameter = std::sqrt(1300 / impedance * 4 / kPi);
  const auto with = [&](double d) {
    return steady_state(
        rated({"load.kind=laminar", "delivery_line.length_m=1.5", "delivery_line.bandwidth_Hz=2000",
               "delivery_line.wave_speed_m_per_s=1300",
               "delivery_line.diameter_mm=" + number_text(d * 1e3)}));
  };
  // What is left: the load's density follows the pressure, the pipe's does not: 1 % of the ripple.
  const double ripple = s.delivery_greatest - s.delivery_least;
  const SteadyState matched = with(diameter), wide = with(2 * diameter);
  EXPECT_NEAR(matched.summary.delivery_greatest, s.delivery_greatest, scaled(0.02) * ripple);
  EXPECT_NEAR(matched.summary.delivery_least, s.delivery_least, scaled(0.02) * ripple);
  EXPECT_LT(largest_difference(matched, lumped), scaled(0.02) * ripple);
  EXPECT_GT(largest_difference(wide, lumped), 0.1 * ripple);  // negative control
}

// ---- The periodic state with each
// ----------------------------------------------------------------

TEST(Circuit, MassThatEntersLeavesAndTheMeanIsTheOneAskedFor) {
  for (const Circuit& circuit : kCircuits) {
    const Case the_case = rated(circuit.changes);
    const SteadyState state = steady_state(the_case);
    const Summary& s = state.summary;
    const double turn = 60 / the_case.operation.speed_rpm;
    EXPECT_NEAR(s.mass_in / s.mass_out, 1, scaled(kMassBalance)) << circuit.name;
    EXPECT_NEAR((s.mass_flow + s.leakage * s.density) * turn / s.mass_out, 1, scaled(kMassBalance))
        << circuit.name;
    EXPECT_LE(state.computed->error, the_case.hydraulics->curve_error * state.computed->peak)
        << circuit.name;
    const Network network(the_case);
    if (network.load_sought() || network.fixed_line()) {
      EXPECT_NEAR(s.delivery_mean, the_case.pressure.ports.delivery, scaled(1e-7) * 275e5)
          << circuit.name;
    }
    EXPECT_LT(state.convergence.seconds, 30) << circuit.name;
  }
}

// ---- Power by place
// -------------------------------------------------------------------------------

// Every circuit, every law of the oil, oil that tears, one piston and nine.
void expect_closed(const Case& the_case, const std::string& name) {
  const SteadyState state = steady_state(the_case);
  const PowerBudget power = power_by_place(state);
  EXPECT_LT(std::abs(left_over(power)), scaled(kEnergyBalance) * std::abs(power[Place::pistons]))
      << name;
  // The p-V diagram of the curve, and the work by the integral that goes with it: within the error
  // stated of the curve, which counts once on each way of the piston.
  const double turns_per_second = the_case.operation.speed_rpm / 60;
  const double chambers = the_case.pump.geometry.pistons;
  for (const double work : {chambers * state.indicated_work, state.summary.work})
    EXPECT_NEAR(
        turns_per_second * work, power[Place::pistons],
        scaled(2) * std::abs(turns_per_second) * state.summary.displacement * state.computed->error)
        << name;
  double lost = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const auto place = static_cast<Place>(i);
    const bool there =
        std::find(state.places.begin(), state.places.end(), place) != state.places.end();
    if (!there) {
      EXPECT_EQ(power[place], 0) << name << ": " << name_of(place);
    }
    if (use_of(place) == PowerUse::loss) {
      EXPECT_GE(power[place], 0) << name << ": " << name_of(place);
      lost += power[place];
    }
  }
  EXPECT_DOUBLE_EQ(losses(power), lost) << name;
}

TEST(Power, WhatGoesInComesOut) {
  auto circuits = kCircuits;
  for (const Circuit& more : std::vector<Circuit>{
           {"as shipped", {}},
           {"open", {"pressure.delivery_bar=0"}},
           {"boosted, case under pressure", {"pressure.suction_bar=3", "hydraulics.case_bar=2"}},
           {"cavitation", {"hydraulics.cavitation=equilibrium"}},
           {"cavitation, isothermal, boiling early",
            {"hydraulics.cavitation=equilibrium", "hydraulics.air_exponent=1",
             "hydraulics.vapour_bar=0.05"}},
           {"motor", {"operation.speed_rpm=-1600", "load.kind=constant_pressure"}},
           {"motor at the end of a line, air takes time",
            {"operation.speed_rpm=-900", "load.kind=constant_pressure",
             "hydraulics.cavitation=rate", "hydraulics.saturation_bar=2",
             "delivery_line.length_m=1", "delivery_line.diameter_mm=20"}},
           {"loop, backwards",
            {"operation.speed_rpm=-1600", "loop.volume_l=0.5", "pressure.suction_bar=20",
             "load.area_mm2=9", "load.relief_bar=250", "load.opening_mm2_per_bar=0.1"}},
           {"no vapour", {"hydraulics.cavitation=equilibrium", "hydraulics.vapour_bar=0"}},
           {"air takes time", {"hydraulics.cavitation=rate"}},
           {"air takes time, both lines, boosted case",
            {"hydraulics.cavitation=rate", "hydraulics.case_bar=2", "suction_line.length_m=1",
             "suction_line.diameter_mm=40", "delivery_line.length_m=1",
             "delivery_line.diameter_mm=20"}},
           {"oil tears", {"operation.speed_rpm=3000"}},
           {"oil tears and boils",
            {"operation.speed_rpm=3000", "hydraulics.cavitation=equilibrium"}},
           {"stiffer under pressure", {"hydraulics.bulk_modulus_slope=10"}},
           {"K' = 1", {"hydraulics.bulk_modulus_slope=1", "hydraulics.air_exponent=1"}},
           {"one piston", {"pump.pistons=1"}},
           {"nine pistons", {"pump.pistons=9"}},
           {"much air", {"hydraulics.air_percent=10"}},
           {"plain ports", {"hydraulics.kidney_rounding_deg=0", "hydraulics.delivery_notch_deg=0"}},
           {"circular ends, hole, groove",
            {"hydraulics.kidney_ends=circular", "hydraulics.delivery_hole_deg=176",
             "hydraulics.delivery_hole_diameter_mm=1.5", "hydraulics.suction_groove_deg=[-8,0]",
             "hydraulics.suction_groove_width_mm=1", "hydraulics.suction_groove_area_mm2=0.5"}}})
    circuits.push_back(more);
  for (const Circuit& circuit : circuits) {
    expect_closed(rated(circuit.changes), circuit.name);
  }
  Case by_table = rated();
  by_table.hydraulics->suction.table = {{}, {0, 30, 150, 182, 270}, {0, 90e-6, 90e-6, 0, 0}};
  expect_closed(by_table, "openings from a table");
}

// Pressure times flow by the table's columns: no potential, no part of the power's own equations.
// What is left is the compression of oil in its density, and rows a tenth of a degree apart.
TEST(Power, EachPlaceIsItsPressureTimesItsFlow) {
  std::vector<std::string> changes = kCircuits.back().changes;
  for (const char* more :
       {"pressure.suction_bar=3", "hydraulics.case_bar=2", "operation.samples_per_revolution=3600"})
    changes.emplace_back(more);
  const Case the_case = rated(changes);
  const SteadyState state = steady_state(the_case);
  const Fluid fluid(*the_case.hydraulics);
  const auto get = [&](const std::string& name) { return column(state.table, name); };
  const auto p = get("p_1_bar"), p_delivery = get("p_delivery_bar"), p_load = get("p_load_bar"),
             p_suction = get("p_suction_bar"), suction = get("ms_1_g_per_s"),
             delivery = get("md_1_g_per_s"), leakage = get("ml_1_g_per_s"),
             load = get("mload_g_per_s");
  const std::size_t rows = p.size();
  const double n = the_case.pump.geometry.pistons;
  // Mass flow in g/s, pressures in bar, density the mean of both.
  const auto lost = [&](double flow, double from, double to) {
    return 1e-3 * flow * (from - to) * 1e5 /
           ((fluid.density(from * 1e5) + fluid.density(to * 1e5)) / 2);
  };
  PowerBudget expected;
  for (std::size_t i = 0; i < rows; ++i) {
    const double each = 1 / static_cast<double>(rows);
    expected[suction[i] < 0 ? Place::suction_backflow : Place::suction_port] +=
        n * each * lost(suction[i], p_suction[i], p[i]);
    expected[delivery[i] < 0 ? Place::delivery_backflow : Place::delivery_port] +=
        n * each * lost(delivery[i], p[i], p_delivery[i]);
    expected[Place::conductance] += n * each * lost(leakage[i], p[i], 2);  // all leakage, for now
    expected[Place::drain] += n * each * lost(leakage[i], 2, 0);
    expected[Place::tank] += n * each * lost(suction[i], 3, 0);
    expected[Place::load] += each * lost(load[i], p_load[i], 0);
  }
  const PowerBudget power = power_by_place(state);
  for (const Place place : {Place::suction_port, Place::suction_backflow, Place::delivery_port,
                            Place::delivery_backflow, Place::drain, Place::tank, Place::load}) {
    EXPECT_NEAR(power[place] / expected[place], 1, scaled(5e-3)) << name_of(place);
    EXPECT_GT(power[place], 1) << name_of(place);
  }
  EXPECT_NEAR((power[Place::conductance] + power[Place::piston_gap]) / expected[Place::conductance],
              1, scaled(5e-3));
  // At each instant too: the columns of power are of these.
  double sum = 0;
  for (const Place place : state.places)
    sum += (use_of(place) == PowerUse::source ? 1 : -1) *
           mean(get(std::string("power_") + key_of(place) + "_W"));
  EXPECT_NEAR(sum / power[Place::pistons], 0, scaled(1e-3));
}

TEST(Power, OneLeakAloneTakesAllThatLeakageTakes) {
  const std::vector<std::string> oil = {"oil.temperature_C=60",
                                        "hydraulics.leakage_l_per_min_per_bar=0"};
  const struct {
    Place place;
    std::vector<std::string> changes;
  } leaks[] = {{Place::conductance, {"hydraulics.leakage_l_per_min_per_bar=0.002"}},
               {Place::piston_gap, {"leakage.piston_gap_um=15", "leakage.piston_gap_length_mm=10"}},
               {Place::plate_gap, {"leakage.plate_gap_um=8"}},
               {Place::ring_slot,
                {"leakage.ring_slot_um=50", "leakage.ring_slot_width_mm=0.3",
                 "leakage.ring_slot_length_mm=2"}}};
  for (const auto& leak : leaks) {
    std::vector<std::string> changes = oil;
    for (const std::string& change : leak.changes) changes.push_back(change);
    const SteadyState state = steady_state(rated(changes));
    const PowerBudget power = power_by_place(state);
    double expected = 0;  // p Q, Q of all chambers in the end
    const auto p = column(state.table, "p_1_bar"), q = column(state.table, "Ql_1_l_per_min");
    for (std::size_t i = 0; i < p.size(); ++i)
      expected += 5 * p[i] * 1e5 * q[i] / 6e4 / static_cast<double>(p.size());
    EXPECT_NEAR(power[leak.place] / expected, 1, scaled(0.02)) << name_of(leak.place);
    for (const Place other :
         {Place::conductance, Place::piston_gap, Place::plate_gap, Place::ring_slot})
      if (other != leak.place) {
        EXPECT_EQ(power[other], 0) << name_of(leak.place);
      }
  }
}

// What an orifice takes of oil that is hardly compressible is p Q.
TEST(Power, OrificeAloneTakesPressureTimesFlow) {
  for (const char* load : {"orifice", "laminar", "constant_pressure"}) {
    Case the_case = hardly_compressible({std::string("load.kind=") + load});
    the_case.hydraulics->leakage = 0;
    const SteadyState state = steady_state(the_case);
    const Summary& s = state.summary;
    const PowerBudget power = power_by_place(state);
    // But for what it is compressed by: the integral of exp(-p/K) dp.
    const double modulus = the_case.hydraulics->bulk_modulus;
    const double energy = -modulus * std::expm1(-s.delivery_mean / modulus);  // per volume at 0 bar
    EXPECT_NEAR(energy / s.delivery_mean, 1, 2e-5);
    EXPECT_NEAR(power[Place::load] / (energy * s.flow), 1, scaled(1e-6)) << load;
    EXPECT_NEAR(power[Place::pistons] / (s.delivery_mean * s.ideal_flow), 1, scaled(1e-3)) << load;
    EXPECT_LT(losses(power), 1e-3 * power[Place::load]) << load;
  }
}

TEST(Power, LinesTakeWhatTheirLawsSay) {
  // No ripple behind 100 l: steady flow.
  const Case delivery =
      rated({"hydraulics.delivery_volume_l=100", "delivery_line.length_m=2",
             "delivery_line.diameter_mm=15", "oil.temperature_C=40", "load.kind=laminar"});
  const SteadyState by_delivery = steady_state(delivery);
  const PowerBudget pipe = power_by_place(by_delivery);
  const double density = Fluid(*delivery.hydraulics).density(275e5);
  const double area = kPi / 4 * 0.015 * 0.015;
  const double v = by_delivery.summary.mass_flow / (density * area);
  const double drop = 32 * 46e-6 * density * 2 * v / (0.015 * 0.015);
  EXPECT_NEAR(pipe[Place::delivery_line] / (drop * v * area), 1, scaled(1e-3));
  // Without ripple the oil's own law and that in the line are the same: nothing is hidden there.
  EXPECT_LT(std::abs(pipe[Place::line_density]), 1e-2 * pipe[Place::delivery_line]);
  EXPECT_LT(pipe[Place::damped_waves], 1e-3 * pipe[Place::delivery_line]);
  // 5 l at the port: the flow in the pipe hardly swings.
  const SteadyState by_suction =
      steady_state(rated({"suction_line.length_m=1", "suction_line.diameter_mm=30",
                          "suction_line.volume_l=5", "suction_line.loss_coefficient=4",
                          "oil.temperature_C=40", "hydraulics.leakage_l_per_min_per_bar=0"}));
  const PowerBudget column_of_oil = power_by_place(by_suction);
  const double bore = kPi / 4 * 0.03 * 0.03, oil = by_suction.summary.density;
  const double u = by_suction.summary.mass_flow / (oil * bore);
  const double loss = 4 * oil * u * u / 2 + 32 * 46e-6 * oil * u / (0.03 * 0.03);
  EXPECT_NEAR(column_of_oil[Place::suction_line] / (loss * u * bore), 1, scaled(1e-2));
}

// Whatever the modes: what passes the ends is stored, rubbed off or damped.
TEST(DeliveryLine, KeepsItsEnergy) {
  using End = TransmissionLine::End;
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> random(-1, 1);
  for (const End end : {End::given_flow, End::given_pressure})
    for (int trial = 0; trial < 20; ++trial) {
      const TransmissionLine line(kPipe, end, oil_in_pipe(), 2e-3);
      std::vector<double> y(line.size()), rate(line.size());
      for (double& mode : y) mode = random(engine);
      const double start = 2e7 * (1 + random(engine));
      const double given = end == End::given_flow ? 3 * random(engine) : 2e7 * (1 + random(engine));
      line.rates(y.data(), start, given, rate.data());
      // Energy of the linear pipe: (A L/2)(mean of p^2/(rho c^2) + mean of (m/(rho A))^2 rho), of
      // Legendre polynomials: mean of P_i^2 = 1/(2i+1).
      const double pascal = 2e7, area = kPi / 4 * 0.02 * 0.02, rho = 850, c = 1000;
      double stored = 0, rubbed = 0;
      for (int i = 0; i < line.size(); ++i) {
        const int degree = i < line.pressures() ? i : i - line.pressures();
        stored += area * 2 * pascal * pascal / (rho * c * c) * y[i] * rate[i] / (2 * degree + 1);
        if (i >= line.pressures()) {
          const double v = pascal / (rho * c) * y[i];
          rubbed += 32 * 2e-3 * rho / (0.02 * 0.02) * v * v * area * 2 / (2 * degree + 1);
        }
      }
      const double out = end == End::given_flow ? given : line.outflow(y.data());
      const double at_end = end == End::given_flow ? line.end_pressure(y.data()) : given;
      const double passed = ((start - 2e7) * line.inflow(y.data()) - (at_end - 2e7) * out) / rho;
      EXPECT_NEAR(line.friction_power(y.data()) / rubbed, 1, scaled(1e-12));
      EXPECT_NEAR((stored + rubbed + line.damped_power(y.data()) - passed) / rubbed, 0,
                  scaled(1e-9));
      EXPECT_GE(line.damped_power(y.data()), 0);
    }
}

TEST(Circuit, LaminarLoadPassesInProportion) {
  const Case the_case = rated({"load.kind=laminar"});
  const SteadyState state = steady_state(the_case);
  const Fluid fluid(*the_case.hydraulics);
  const auto pressure = column(state.table, "p_delivery_bar");
  const auto flow = column(state.table, "mload_g_per_s");
  for (std::size_t i = 0; i < flow.size(); i += 7) {
    const double p = pressure[i] * 1e5;
    const double density = (fluid.density(p) + fluid.density(0)) / 2;
    EXPECT_NEAR(flow[i] * 1e-3 / (state.summary.load_size * density * p), 1, scaled(1e-9)) << i;
  }
  EXPECT_NEAR(mean(pressure), 275, scaled(0.01));
}

TEST(Circuit, ConstantPressureIsAnEndlessDeliveryVolume) {
  const SteadyState constant = steady_state(rated({"load.kind=constant_pressure"}));
  const SteadyState endless = steady_state(rated({"hydraulics.delivery_volume_l=1000"}));
  // 0.5 l ripple by 13 bar: 1000 l by 6 mbar.
  EXPECT_LT(largest_difference(constant, endless), scaled(2e-2) * 1e5);
  EXPECT_EQ(constant.summary.delivery_greatest, constant.summary.delivery_least);
  EXPECT_NEAR(constant.summary.delivery_mean, 275e5, 1e-6);
  // Open line: the same at 0 bar, to the last bit.
  const SteadyState open = steady_state(rated({"pressure.delivery_bar=0"}));
  const SteadyState at_zero =
      steady_state(rated({"pressure.delivery_bar=0", "load.kind=constant_pressure"}));
  EXPECT_EQ(largest_difference(open, at_zero), 0);
}

// Hardly compressible oil: what is not taken leaks, and leakage says at which pressure.
TEST(Circuit, GivenFlowSetsThePressureByLeakage) {
  Case the_case =
      hardly_compressible({"load.kind=flow", "load.flow_l_per_min=1", "pressure.delivery_bar=40"});
  HydraulicData& h = *the_case.hydraulics;
  const Network ideal(the_case);
  const double flow = ideal.displacement() * the_case.operation.speed_rpm / 60;
  h.load->flow = 0.98 * flow;
  h.leakage = 0.02 * flow / (2.5 * 100e5);  // half of five chambers at 100 bar
  const SteadyState state = steady_state(the_case);
  EXPECT_NEAR(state.summary.delivery_mean / 100e5, 1, scaled(1e-3));
  EXPECT_NEAR(state.summary.flow / h.load->flow, 1, scaled(1e-9));
}

TEST(Circuit, GivenFlowBeyondTheDisplacementIsRefused) {
  try {
    steady_state(rated({"load.kind=flow", "load.flow_l_per_min=96"}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr(
            "[load] flow_l_per_min = 96: must be above 0 and below the ideal flow of the pump"));
  }
}

// No key is read and forgotten: 5 % of each moves the pressure by more than the error of the curve.
std::string refusal(const std::vector<std::string>& changes) {
  try {
    Network{rated(changes)};
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(Circuit, EveryKeyCounts) {
  const auto expect_changes = [](std::vector<std::string> base,
                                 const std::vector<std::string>& changes) {
    const SteadyState before = steady_state(rated(base));
    base.emplace_back();
    for (const std::string& change : changes) {
      base.back() = change;
      const SteadyState after = steady_state(rated(base));
      EXPECT_GT(largest_difference(before, after), 100 * before.computed->error) << change;
    }
  };
  std::vector<std::string> all = kCircuits.back().changes;
  for (const char* more : {"leakage.plate_gap_um=8", "leakage.ring_slot_um=50",
                           "leakage.ring_slot_width_mm=1", "leakage.ring_slot_length_mm=2"})
    all.emplace_back(more);
  expect_changes(all, {"oil.temperature_C=63",
                       "oil.viscosity_40C_cSt=44",
                       "oil.viscosity_100C_cSt=6.5",
                       "oil.pressure_viscosity_per_GPa=19",
                       "leakage.piston_gap_um=15.5",
                       "leakage.piston_gap_length_mm=10.5",
                       "leakage.piston_gap_kind=land",
                       "leakage.eccentricity=0.84",
                       "leakage.plate_gap_um=8.4",
                       "leakage.ring_slot_um=52",
                       "leakage.ring_slot_width_mm=1.05",
                       "leakage.ring_slot_length_mm=2.1",
                       "suction_line.length_m=1.05",
                       "suction_line.diameter_mm=42",
                       "suction_line.loss_coefficient=1.05",
                       "suction_line.volume_l=0.66",
                       "delivery_line.length_m=1.05",
                       "delivery_line.diameter_mm=21",
                       "delivery_line.wave_speed_m_per_s=1200",
                       "delivery_line.bandwidth_Hz=500",
                       "load.opening_mm2_per_bar=1.05"});
  const auto with = [](const std::string& name) {
    return std::find_if(kCircuits.begin(), kCircuits.end(),
                        [&](const Circuit& circuit) { return circuit.name == name; })
        ->changes;
  };
  expect_changes(with("orifice, given"), {"load.area_mm2=9.05"});
  expect_changes(with("laminar, given"), {"load.conductance_l_per_min_per_bar=0.351"});
  expect_changes(with("relief valve beside an orifice"),
                 {"load.relief_bar=269", "load.opening_mm2_per_bar=0.32"});
  expect_changes(with("accumulator"),
                 {"accumulator.gas_volume_l=0.55", "accumulator.precharge_bar=190",
                  "accumulator.gas_exponent=1.3", "accumulator.inlet_area_mm2=55"});
  expect_changes(with("loop"), {"loop.volume_l=0.4", "loop.charge_area_mm2=40",
                                "loop.charge_opening_bar=1.5", "pressure.suction_bar=19"});
  expect_changes(kCircuits[2].changes, {"load.cracking_bar=201"});
  expect_changes(kCircuits[3].changes, {"load.full_area_mm2=9.1"});
  expect_changes(kCircuits[5].changes, {"load.flow_l_per_min=90.1"});
}

// ---- Backwards
// ---------------------------------------------------------------------------------------

// A chamber's volume is the same at theta and -theta, so that a pump that turns backwards over the
// mirror image of its plate is the pump.
TEST(Backwards, OverTheMirroredPlateIsForwards) {
  const OpeningTable suction = {{}, {10, 40, 150, 182, 270}, {0, 90e-6, 80e-6, 0, 0}};
  const OpeningTable delivery = {{}, {5, 100, 190, 225, 330, 350}, {0, 0, 0, 85e-6, 90e-6, 0}};
  const auto mirrored = [](const OpeningTable& table) {
    OpeningTable other;
    for (std::size_t i = table.theta_deg.size(); i-- > 0;) {
      other.theta_deg.push_back(360 - table.theta_deg[i]);
      other.area.push_back(table.area[i]);
    }
    return other;
  };
  for (const std::vector<std::string>& changes : std::vector<std::vector<std::string>>{
           {"load.kind=constant_pressure"},
           {"load.area_mm2=9", "suction_line.length_m=1", "suction_line.diameter_mm=40",
            "hydraulics.cavitation=rate"}}) {
    Case forwards = rated(changes);
    forwards.hydraulics->suction.table = suction;
    forwards.hydraulics->delivery.table = delivery;
    Case backwards = forwards;
    backwards.operation.speed_rpm *= -1;
    backwards.hydraulics->suction.table = mirrored(suction);
    backwards.hydraulics->delivery.table = mirrored(delivery);
    const SteadyState a = steady_state(forwards), b = steady_state(backwards);
    const double error = a.computed->error + b.computed->error;
    for (double angle = 0; angle < 360; angle += 0.7)
      EXPECT_NEAR(a.computed->gauge(angle), b.computed->gauge(-angle), error) << angle;
    EXPECT_NEAR(b.summary.work, -a.summary.work, scaled(1e-7) * a.summary.work);
    EXPECT_NEAR(b.summary.flow, a.summary.flow, scaled(1e-7) * a.summary.flow);
    EXPECT_NEAR(b.summary.ideal_flow, -a.summary.ideal_flow, 1e-15);
    EXPECT_NEAR(b.summary.volumetric_efficiency, a.summary.volumetric_efficiency, 1e-6);
    EXPECT_FALSE(b.summary.motors());
    EXPECT_NEAR(wrap_degrees(-b.summary.chamber_greatest_deg), a.summary.chamber_greatest_deg, 0.2);
    EXPECT_NEAR(b.timing.backflow, a.timing.backflow, 1e-3 * a.timing.backflow + 1e-12);
    // Row i of one is row -i of the other; rates change their sign.
    const std::size_t rows = a.table.theta_deg.size();
    for (const char* name : {"p_1_bar", "p_delivery_bar", "Qd_1_l_per_min", "ms_1_g_per_s",
                             "V_1_cm3", "ad_1_mm2", "dp_1_bar_per_deg", "power_pistons_W"}) {
      const auto there = column(a.table, name), back = column(b.table, name);
      double peak = 0;
      for (const double value : there) peak = std::max(peak, std::abs(value));
      const double sign = std::string(name) == "dp_1_bar_per_deg" ? -1 : 1;
      for (std::size_t i = 0; i < rows; ++i)
        EXPECT_NEAR(there[i], sign * back[(rows - i) % rows], 1e-5 * peak) << name << " " << i;
    }
    for (std::size_t i = 0; i < a.orders.size(); ++i)
      EXPECT_NEAR(a.orders[i].flow, b.orders[i].flow, 1e-6 * a.summary.mass_flow);
  }
}

// A leak costs a pump oil that it does not deliver, and a motor oil that does not turn it.
TEST(Backwards, LeaksMakeBothWorse) {
  for (const bool motor : {false, true}) {
    const auto efficiency = [&](const std::string& leakage) {
      const Summary s =
          steady_state(rated({motor ? "operation.speed_rpm=-1500" : "operation.speed_rpm=1500",
                              "load.kind=constant_pressure",
                              "hydraulics.leakage_l_per_min_per_bar=" + leakage}))
              .summary;
      EXPECT_EQ(s.motors(), motor);
      return s.volumetric_efficiency;
    };
    const double tight = efficiency("0.0001"), leaky = efficiency("0.01");
    EXPECT_LT(tight, 1);
    EXPECT_LT(leaky, tight - 0.05) << motor;
  }
}

// A loop keeps too much oil for long: its search must not depend on where it begins.
TEST(ClosedLoop, IsFoundFromAnywhereAndTurnsRound) {
  const std::vector<std::string> changes = {"loop.volume_l=0.5", "pressure.suction_bar=20",
                                            "load.area_mm2=9"};
  const double usual = steady_state(rated(changes)).summary.delivery_mean;
  for (const char* more :
       {"pressure.delivery_bar=50", "pressure.delivery_bar=200", "pressure.delivery_bar=400"}) {
    auto other = changes;
    other.emplace_back(more);
    EXPECT_NEAR(steady_state(rated(other)).summary.delivery_mean, usual, scaled(1e-7) * usual);
  }
  for (const char* more :
       {"operation.speed_rpm=-1500", "operation.speed_rpm=-400", "operation.speed_rpm=2300",
        "load.area_mm2=0", "load.relief_bar=150", "loop.charge_area_mm2=5"}) {
    auto other = changes;
    other.emplace_back(more);
    const Case the_case = rated(other);
    const SteadyState state = steady_state(the_case);
    EXPECT_LT(state.summary.flow / state.summary.ideal_flow, 1) << more;
    EXPECT_GT(state.summary.flow / state.summary.ideal_flow, 0.5) << more;
    const double high = state.summary.chamber_greatest;
    EXPECT_EQ(state.summary.delivery_mean > high / 2, the_case.operation.speed_rpm > 0) << more;
  }
}

TEST(Backwards, WithASupplyThePumpIsAMotor) {
  const Case pump = rated({"load.kind=constant_pressure"});
  const Case motor = rated({"load.kind=constant_pressure", "operation.speed_rpm=-1600"});
  const SteadyState a = steady_state(pump), b = steady_state(motor);
  EXPECT_GT(power_by_place(a)[Place::pistons], 0);
  EXPECT_LT(power_by_place(b)[Place::pistons], 0);
  EXPECT_LT(b.summary.flow, 0);
  // It takes more than it displaces, and gives less than an ideal motor of that pressure.
  EXPECT_GT(b.summary.flow / b.summary.ideal_flow, 1);
  EXPECT_LT(b.summary.work, b.summary.displacement * 275e5);
  EXPECT_GT(b.summary.work, 0.9 * b.summary.displacement * 275e5);
  EXPECT_THAT(refusal({"operation.speed_rpm=-1600"}), HasSubstr("motoring"));
  EXPECT_THAT(refusal({"operation.speed_rpm=-1600", "load.kind=laminar"}), HasSubstr("motoring"));
}

// ---- Suction line
// --------------------------------------------------------------------------------

TEST(SuctionLine, AcceleratesByItsInertance) {
  const Fluid::State tank{101325, 850, 70, 0};
  const double area = kPi / 4 * 0.04 * 0.04;
  const SuctionLine plain({2, 0.04, 0, 1e-3}, tank, 0), lossy({2, 0.04, 3, 1e-3}, tank, 0);
  // dp = rho L/A dq/dt, with m = rho q.
  EXPECT_NEAR(plain.rate(101325, 101325 - 5000, 1.2) * (2 / area), 5000, scaled(1e-9));
  // Steady: dp = zeta rho v^2/2.
  const double v = 1.2 / (850 * area);
  EXPECT_NEAR(lossy.rate(101325, 101325 - 3 * 850 * v * v / 2, 1.2), 0, scaled(1e-9));
  const SuctionLine thick({2, 0.04, 0, 1e-3}, tank, 1e-3);
  EXPECT_NEAR(thick.rate(101325, 101325 - 32 * 1e-3 * 850 * 2 * v / (0.04 * 0.04), 1.2), 0,
              scaled(1e-9));
}

TEST(SuctionLine, OscillatesAtItsFrequency) {
  Case the_case =
      rated({"suction_line.length_m=1", "suction_line.diameter_mm=40", "suction_line.volume_l=2",
             "suction_line.loss_coefficient=0", "load.kind=constant_pressure"});
  the_case.hydraulics->suction = {{0, 1}, {}};
  const Network network(the_case);
  const int n = network.size(), s = network.pressures(), m = s + 1;
  const auto y = network.uniform(0, network.delivery_log_pressure(), 0);
  std::vector<double> by_state(n * n), by_load(n);
  network.jacobian(40, y.data(), 0, by_state.data(), by_load.data());
  const auto entry = [&](int row, int column) { return by_state[column * n + row]; };
  const double omega = std::sqrt(-entry(s, m) * entry(m, s)) / network.seconds_per_degree();
  // Spring K/V on the piston's area A, mass rho L A.
  const double area = kPi / 4 * 0.04 * 0.04;
  const double modulus = network.fluid().effective_bulk_modulus(0);
  EXPECT_NEAR(omega / std::sqrt(modulus * area / (network.fluid().density(0) * 1 * 2e-3)), 1,
              scaled(1e-12));
}

TEST(SuctionLine, MeanPressureAtThePortIsLessByTheLoss) {
  const Case the_case =
      rated({"suction_line.length_m=1", "suction_line.diameter_mm=30", "suction_line.volume_l=5",
             "suction_line.loss_coefficient=4", "hydraulics.leakage_l_per_min_per_bar=0"});
  const SteadyState state = steady_state(the_case);
  const double area = kPi / 4 * 0.03 * 0.03, density = state.summary.density;
  const double v = state.summary.mass_flow / (density * area);
  // The flow in the pipe hardly swings with 5 l between it and the pump.
  EXPECT_NEAR(mean(column(state.table, "p_suction_bar")) * 1e5 / (-4 * density * v * v / 2), 1,
              scaled(1e-2));
  EXPECT_GT(v, 2);
}

TEST(SuctionLine, ShortAndWideIsNone) {
  const SteadyState with =
      steady_state(rated({"suction_line.length_m=0.001", "suction_line.diameter_mm=500",
                          "suction_line.volume_l=100"}));
  EXPECT_LT(largest_difference(with, steady_state(rated())), scaled(1e-3) * 1e5);
}

// ---- Hard and bad inputs
// -------------------------------------------------------------------------

TEST(HardCircuit, EveryRunEndsAndSaysWhy) {
  const Circuit circuits[] = {
      {"no valve reaches it", {"load.kind=relief_valve", "load.full_area_mm2=1e-3"}},
      {"cracks far above", {"load.kind=relief_valve", "load.cracking_bar=9000"}},
      {"hard valve", {"load.kind=relief_valve", "load.opening_mm2_per_bar=1e6"}},
      {"next to nothing taken", {"load.kind=flow", "load.flow_l_per_min=0.01"}},
      {"more than is left", {"load.kind=flow", "load.flow_l_per_min=95.5"}},
      {"most modes", {"delivery_line.length_m=4", "delivery_line.diameter_mm=20"}},
      {"starved", {"suction_line.length_m=20", "suction_line.diameter_mm=10"}},
      {"wide gaps",
       {"oil.temperature_C=100", "leakage.piston_gap_um=100", "leakage.piston_gap_length_mm=5"}}};
  for (const Circuit& circuit : circuits) {
    const auto start = std::chrono::steady_clock::now();
    try {
      const SteadyState state = steady_state(rated(circuit.changes));
      EXPECT_LT(state.convergence.residual, 1e-6) << circuit.name;
    } catch (const ComputationError& error) {
      EXPECT_THAT(error.what(),
                  testing::AnyOf(HasSubstr("hydraulics"), HasSubstr("cannot be reached")))
          << circuit.name;
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 30) << circuit.name;
  }
}

TEST(BadCircuit, IsRefusedByItsKey) {
  EXPECT_THAT(refusal({"leakage.piston_gap_um=10", "leakage.piston_gap_length_mm=5"}),
              HasSubstr("leakage.piston_gap_um=10: needs the table [oil]"));
  EXPECT_THAT(refusal({"oil.temperature_C=60", "leakage.piston_gap_um=10"}),
              HasSubstr("[leakage] piston_gap_length_mm: must be > 0"));
  EXPECT_THAT(refusal({"oil.viscosity_100C_cSt=50"}), HasSubstr("must be below viscosity_40C_cSt"));
  EXPECT_THAT(refusal({"load.kind=flow"}), HasSubstr("flow_l_per_min"));
  EXPECT_THAT(refusal({"load.kind=valve"}), HasSubstr("kind"));
  EXPECT_THAT(refusal({"delivery_line.length_m=1"}), HasSubstr("diameter_mm"));
  EXPECT_THAT(refusal({"delivery_line.length_m=100", "delivery_line.diameter_mm=20"}),
              HasSubstr("more than 48: lower it, or length_m"));
  EXPECT_THAT(refusal({"oil.temperature_C=60", "leakage.eccentricity=1.1"}),
              HasSubstr("eccentricity"));
  EXPECT_EQ(refusal({"load.kind=laminar"}), "not refused");
  EXPECT_THAT(refusal({"accumulator.gas_volume_l=1"}), HasSubstr("precharge_bar"));
  EXPECT_THAT(refusal({"accumulator.gas_volume_l=1", "accumulator.precharge_bar=100",
                       "load.kind=constant_pressure"}),
              HasSubstr("accumulator.gas_volume_l=1: the delivery volume is held at a pressure"));
  EXPECT_THAT(refusal({"loop.volume_l=1", "pressure.delivery_bar=0"}),
              HasSubstr("loop.volume_l=1: a closed loop needs a load between its sides"));
  EXPECT_THAT(
      refusal({"loop.volume_l=1", "suction_line.length_m=1", "suction_line.diameter_mm=40"}),
      HasSubstr("leave out [suction_line]"));
  EXPECT_THAT(refusal({"load.area_mm2=-1"}), HasSubstr("area_mm2"));
}

// A case with every table reads back to itself.
TEST(CaseFile, TheCircuitSurvivesWriting) {
  Case the_case = rated(kCircuits.back().changes);
  const std::string text = case_text(the_case);
  for (const char* table : {"[oil]", "[leakage]", "[suction_line]", "[delivery_line]", "[load]"})
    EXPECT_THAT(text, HasSubstr(table));
  EXPECT_EQ(case_text(parse_case(text, "x.toml")), text);
  EXPECT_NEAR(the_case.hydraulics->suction_line->volume * 2, kPi / 4 * 0.04 * 0.04 * 1, 1e-15);
  const std::string more =
      case_text(rated({"loop.volume_l=0.5", "accumulator.gas_volume_l=0.2",
                       "accumulator.precharge_bar=150", "load.area_mm2=9", "load.relief_bar=20"}));
  for (const char* line : {"[loop]\nvolume_l = 0.5", "gas_volume_l = 0.2", "precharge_bar = 150",
                           "area_mm2 = 9", "relief_bar = 20"})
    EXPECT_THAT(more, HasSubstr(line));
  EXPECT_EQ(case_text(parse_case(more, "x.toml")), more);
}

}  // namespace
}  // namespace bentaxis::hydraulics
