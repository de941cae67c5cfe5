// The hydraulic side: laws, limits with known answers, the periodic state and its solver.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/hydraulics/sensitivity.h"
#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "integrator.h"
#include "kinematics.h"
#include "network.h"
#include "support.h"

namespace bentaxis::hydraulics {
namespace {

namespace fs = std::filesystem;
using test::column;
using test::mean;
using test::scaled;

// Round-off of formulas of ten or so operations.
constexpr double kRoundOff = 1e-13;
// Mass in against mass out at the default tolerance of 1e-10 per step: what the issue asks for.
constexpr double kMassBalance = 1e-9;
// Error of ln P after a period over the error allowed per step: thousands of steps and a restart at
// every port edge.
constexpr double kStepsAddUp = 1e3;

Case shipped(const std::string& name) {
  return read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" / name);
}
Case rated() { return shipped("bap63_rated_hydraulic.toml"); }

// Pistons keep their tilt, so that z_B is a cosine exactly (closed form of docs/theory.md).
void make_sinusoidal(Case& the_case) {
  Geometry& g = the_case.pump.geometry;
  g.axis_offset = 0;
  g.bore_circle_radius = g.joint_circle_radius * (1 + std::cos(g.tilt)) / 2;
}

// Ports that open to one another exactly at the dead centres, without notches or rounding, wide
// enough to throttle nothing; hardly compressible oil, no leakage.
Case incompressible(int pistons) {
  Case the_case = rated();
  make_sinusoidal(the_case);
  the_case.pump.geometry.pistons = pistons;
  HydraulicData& h = *the_case.hydraulics;
  h.delivery = {{180 + 26, 360 - 26}, {}};
  h.suction = {{26, 180 - 26}, {}};
  h.kidney_width_deg = 52;
  h.kidney_rounding_deg = 0;
  h.kidney_height = 1;  // m
  h.bulk_modulus = 1e14;
  h.air_share = 1e-9;
  h.leakage = 0;
  h.dead_volume = 1e-9;
  the_case.pressure.ports.delivery = pascals(100);
  the_case.pressure.points = 720;
  return the_case;
}

double amplitude(const std::vector<double>& values, int order) {
  double c = 0, s = 0;
  const auto n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double angle = 2 * kPi * order * static_cast<double>(i) / n;
    c += values[i] * std::cos(angle);
    s += values[i] * std::sin(angle);
  }
  return 2 * std::hypot(c, s) / n;
}

// Largest difference of two curves in ln of absolute pressure.
double log_difference(const Case& the_case, const PressureCurve& a, const PressureCurve& b) {
  const Fluid fluid(*the_case.hydraulics);
  double worst = 0;
  for (std::size_t i = 0; i < a.pressure.size(); ++i)
    worst = std::max(
        worst, std::abs(fluid.log_pressure(a.pressure[i]) - fluid.log_pressure(b.pressure[i])));
  return worst;
}

// ---- Laws
// ----------------------------------------------------------------------------------------

TEST(Fluid, DensityFollowsItsOwnBulkModulus) {
  const Fluid fluid(*rated().hydraulics);
  const double h = 1e-5;
  for (double s = -6; s < 6; s += 0.37) {
    const auto at = fluid.state(s);
    const double low = fluid.state(s - h).density, high = fluid.state(s + h).density;
    // Central differences: h^2 and round-off over h.
    EXPECT_NEAR(std::log(high / low) / (2 * h) * at.stiffness, 1, scaled(1e-7)) << s;
    EXPECT_NEAR(
        (fluid.state(s + h).stiffness - fluid.state(s - h).stiffness) / (2 * h) / at.stiffness,
        at.d_stiffness / at.stiffness, scaled(1e-6))
        << s;
  }
}

TEST(Fluid, LimitsOfTheEffectiveBulkModulus) {
  const HydraulicData data = *rated().hydraulics;
  const Fluid fluid(data);
  // Compressed air takes no room: the oil's own modulus, but for x (P0/P)^(1/n) ~ 1e-5 and its
  // slope.
  EXPECT_NEAR(fluid.effective_bulk_modulus(pascals(3000)) / data.bulk_modulus, 1, scaled(5e-3));
  // Nearly no pressure: nothing but air, K = n P.
  const double low = -data.atmosphere * (1 - 1e-9);
  EXPECT_NEAR(fluid.effective_bulk_modulus(low) / (data.air_exponent * (data.atmosphere + low)), 1,
              scaled(1e-3));
  EXPECT_EQ(fluid.gauge(fluid.log_pressure(0)), 0);
}

TEST(ChamberVolume, AgreesWithTheKinematicsOfTheAnalyticModel) {
  test::RandomPump random(7);
  for (int i = 0; i < 50; ++i) {
    const Geometry g = random.pump().geometry;
    const double dead = 2e-6;
    const Chamber chamber(g, dead);
    const auto derived = analytic::derived_quantities(g);
    EXPECT_NEAR(chamber.swept(), derived.piston_area * derived.stroke,
                scaled(kRoundOff) * derived.piston_area * g.piston_length);
    const analytic::Kinematics kinematics(g);
    double highest = -1e300;
    for (int j = 0; j < 3600; ++j) {
      const double theta = 2 * kPi * j / 3600;
      highest = std::max(highest, kinematics.piston(std::sin(theta), std::cos(theta)).ring().z());
    }
    for (int j = 0; j < 20; ++j) {
      const double theta = random.in(-7, 7);
      const auto piston = kinematics.piston(std::sin(theta), std::cos(theta));
      const auto volume = chamber.volume(theta);
      // The highest z_B above is sampled each 0.1 deg: 1e-6 of the length at worst.
      EXPECT_NEAR(volume.value, dead + derived.piston_area * (highest - piston.ring().z()),
                  scaled(2e-6) * derived.piston_area * g.piston_length);
      EXPECT_NEAR(volume.slope,
                  -derived.piston_area * (piston.joint.first.z() + piston.axis.first.z()),
                  scaled(kRoundOff) * derived.piston_area * g.piston_length);
    }
  }
}

TEST(PortOpening, IsTheOverlapOfKidneyAndPort) {
  HydraulicData data = *rated().hydraulics;
  data.kidney_rounding_deg = 0;
  data.delivery.notch = {};
  const double radius = 0.02;
  const PortOpening port(data, data.delivery, radius);
  const double half = data.kidney_width_deg / 2;
  const PortArc arc = data.delivery.arc;
  for (double theta = 0; theta < 360; theta += 0.5) {
    // Overlap by counting, a hundredth of a degree at a time.
    double overlap = 0;
    for (double psi = theta - half + 0.005; psi < theta + half; psi += 0.01)
      for (const double turn : {-360.0, 0.0, 360.0})
        if (psi + turn >= arc.from_deg && psi + turn <= arc.to_deg) overlap += 0.01;
    EXPECT_NEAR(port.area(theta), radians(overlap) * radius * data.kidney_height,
                radians(0.03) * radius * data.kidney_height)
        << theta;
    EXPECT_EQ(port.area(theta), port.area(theta + 360));
  }
}

TEST(PortOpening, NotchLeadsThePortAndGrowsByItsLaw) {
  HydraulicData data = *rated().hydraulics;
  data.delivery = {{200, 330}, {10, 4e-6}};
  const double touch = 200 - 10 - data.kidney_width_deg / 2;
  for (const auto& [law, share] : {std::pair{NotchLaw::linear, 0.3}, {NotchLaw::quadratic, 0.09}}) {
    data.notch_law = law;
    const PortOpening port(data, data.delivery, 0.02);
    EXPECT_EQ(port.area(touch - 1e-6), 0);
    EXPECT_NEAR(port.area(touch + 3), share * 4e-6, 1e-18);
    EXPECT_NEAR(port.area(touch + 10), 4e-6, 1e-18);
    EXPECT_EQ(port.area(330 + data.kidney_width_deg / 2 + 1e-6), 0);
    // No jump anywhere: the steepest slope is that of the kidney.
    const double slope = radians(1) * 0.02 * data.kidney_height + 2 * 4e-6 / 10;
    for (double theta = 0; theta < 360; theta += 0.01)
      EXPECT_LE(std::abs(port.area(theta + 0.01) - port.area(theta)), 0.0101 * slope) << theta;
  }
}

// An integration restarts at each: a bend between two of them would go unseen. Between edges the
// area is a quadratic, whose third difference vanishes.
TEST(PortOpening, ItsEdgesAreWhereTheAreaBends) {
  constexpr double kStep = 0.01;  // deg
  HydraulicData data = *rated().hydraulics;
  data.kidney_rounding_deg = 5;
  for (const double notch : {0.0, 10.0}) {
    data.delivery = {{200, 330}, {notch, 4e-6}};
    const PortOpening port(data, data.delivery, 0.02);
    const double slope = radians(1) * 0.02 * data.kidney_height;
    const double least = 0.01 * slope / data.kidney_rounding_deg * kStep * kStep;
    int bends = 0;
    for (double theta = 0; theta < 360; theta += kStep) {
      const double bend = port.area(theta + 2 * kStep) - 3 * port.area(theta + kStep) +
                          3 * port.area(theta) - port.area(theta - kStep);
      if (std::abs(bend) < least) continue;
      ++bends;
      EXPECT_TRUE(std::any_of(port.edges_deg().begin(), port.edges_deg().end(), [&](double edge) {
        return std::abs(edge - theta) < 2.01 * kStep;
      })) << theta;
    }
    EXPECT_GE(bends, 6);
  }
}

// ---- Limits with known answers
// -------------------------------------------------------------------

TEST(Limit, IncompressibleFlowIsThatOfThePistons) {
  for (const int pistons : {5, 6, 7}) {
    const Case the_case = incompressible(pistons);
    const SteadyState state = steady_state(the_case);
    const double omega = rad_per_second(the_case.operation.speed_rpm);
    const Chamber chamber(the_case.pump.geometry, 1e-9);
    const auto flow = column(state.table, "Qd_l_per_min");
    // Kinematic ripple of 5 pistons: 1 - cos 18 deg over the mean; the window of a quarter of a
    // degree rounds off the cusps of it. What opens in an instant does not count.
    if (pistons == 5) {
      EXPECT_NEAR(state.summary.port_flow_ripple, 0.0498, scaled(6e-4));
    }
    for (std::size_t i = 0; i < flow.size(); ++i) {
      double pistons_push = 0;
      for (int k = 1; k <= pistons; ++k) {
        const double slope =
            chamber.volume(radians(piston_angle_deg(state.table.theta_deg[i], k, pistons))).slope;
        if (slope < 0) pistons_push -= slope * omega;
      }
      // What is left: the delivery volume breathes, orifices of 1 m height, a dead volume of 1 mm3.
      EXPECT_NEAR(flow[i], pistons_push * 6e4, scaled(1e-5) * state.summary.ideal_flow * 6e4)
          << pistons << " pistons at " << state.table.theta_deg[i];
    }
    EXPECT_NEAR(state.summary.volumetric_efficiency, 1, scaled(1e-5));

    // Closed form of the kinematic ripple: order 2N with 2/((2N)^2-1) for odd N and no odd multiple
    // of N; order N with 2/(N^2-1) for even N.
    const int lowest = pistons % 2 == 1 ? 2 * pistons : pistons;
    EXPECT_NEAR(amplitude(flow, lowest) / mean(flow), 2.0 / (lowest * lowest - 1), scaled(1e-4));
    if (pistons % 2 == 1) {
      EXPECT_LT(amplitude(flow, pistons) / mean(flow), scaled(1e-5));
    }
  }
}

TEST(Limit, CompressibilityIsWhatSpoilsTheKinematicFlow) {  // negative control of the above
  Case the_case = incompressible(5);
  the_case.hydraulics->bulk_modulus = 1.4e9;
  the_case.hydraulics->dead_volume = 3e-6;
  EXPECT_LT(steady_state(the_case).summary.volumetric_efficiency, 0.999);
}

TEST(Limit, ClosedChamberFollowsTheLawOfTheFluid) {
  // Closed from 180 - 24 + 26 = 182 to 230 - 26 = 204 degrees.
  Case the_case = rated();
  HydraulicData& h = *the_case.hydraulics;
  h.leakage = 0;
  h.delivery = {{230, 334}, {}};
  h.suction = {{26, 156}, {}};
  const SteadyState state = steady_state(the_case);
  const auto pressure = column(state.table, "p_1_bar"), volume = column(state.table, "V_1_cm3");
  int checked = 0;
  double first_oil = 0, first = 0;
  for (std::size_t i = 0; i < pressure.size(); ++i) {
    const double angle = state.table.theta_deg[i];
    if (angle < 182.01 || angle > 203.99) continue;
    // Written out here again: volume per unit of mass of oil with air.
    const double absolute = pascals(pressure[i]) + 101325;
    const double oil = 0.995 * std::exp(-(absolute - 101325) / 1.4e9) +
                       0.005 * std::pow(101325 / absolute, 1 / 1.4);
    if (checked++ == 0) first_oil = oil, first = volume[i];
    EXPECT_NEAR(volume[i] / first / (oil / first_oil), 1, scaled(1e-9)) << angle;
  }
  EXPECT_GT(checked, 40);
  EXPECT_GT(*std::max_element(pressure.begin(), pressure.end()), 400);  // and it is far from idle
}

TEST(Limit, MassThatEntersLeaves) {
  for (const double leakage : {0.0, 0.0025 / 6e4 / 1e5}) {
    Case the_case = rated();
    the_case.hydraulics->leakage = leakage;
    const Summary s = steady_state(the_case).summary;
    EXPECT_NEAR(s.mass_in / s.mass_out, 1, scaled(kMassBalance)) << leakage;
  }
}

TEST(Limit, MeanTorqueIsTheWorkOfPressureOverATurn) {
  Case the_case = rated();
  the_case.pressure.points = 7200;
  the_case.operation.samples_per_revolution = 3600;
  the_case.pump.friction = {};  // inertia and weight do no work over a turn
  const SteadyState state = steady_state(the_case);
  give_to(the_case, state);
  const Samples samples = test::one_turn(the_case);
  const double torque =
      mean(column(analytic::run(the_case, the_case.analytic, samples), "Td_z1_Nm"));
  // The spline's 0.05 deg against pressure rises of some degrees, to the power of its corners.
  EXPECT_NEAR(torque * 2 * kPi / state.summary.work, 1, scaled(1e-7));
  the_case.operation.samples_per_revolution = 360;
  // Both models integrate the same samples; 1 deg is too coarse for the rises, alike for both.
  const Samples coarse = test::one_turn(the_case);
  EXPECT_NEAR(
      mean(column(multibody::run_driven(the_case, the_case.multibody, coarse), "Td_z1_Nm")) /
          mean(column(analytic::run(the_case, the_case.analytic, coarse), "Td_z1_Nm")),
      1, scaled(1e-10));
}

// ---- Results
// -----------------------------------------------------------------------------------------

TEST(Orders, OfTheKinematicFlow) {
  Case the_case = incompressible(5);
  the_case.hydraulics->load = LoadData{};
  the_case.hydraulics->load->kind = LoadKind::constant_pressure;
  const SteadyState state = steady_state(the_case);
  ASSERT_EQ(state.orders.size(), kOrders);
  for (int m = 1; m <= kOrders; ++m) {
    const Order& order = state.orders[m - 1];
    ASSERT_EQ(order.order, 5 * m);
    // An odd number of pistons: even multiples of N only, 2/(k^2 - 1).
    const double expected = m % 2 == 1 ? 0 : 2.0 / (25 * m * m - 1);
    EXPECT_NEAR(order.flow / state.summary.mass_flow, expected, scaled(1e-5)) << m;
    EXPECT_EQ(order.delivery, 0);
  }
}

// ---- How pressures change with parameters

// A case with its tightest curve, and a parameter that is changed by a share of itself.
struct Changed {
  std::vector<std::string> circuit;
  std::string key;
  double value = 0;
  std::string before = {}, after = {};  // around the value: of a pair

  Case at(double share) const {
    std::vector<std::string> changes = {"hydraulics.tolerance=1e-12", "hydraulics.curve_error=1e-9",
                                        "operation.samples_per_revolution=360"};
    changes.insert(changes.end(), circuit.begin(), circuit.end());
    changes.push_back(key + "=" + before + number_text(value * (1 + share)) + after);
    return read_case(fs::path(BENTAXIS_SOURCE_DIR) / "cases/bap63_rated_hydraulic.toml", changes);
  }
};

std::ostream& operator<<(std::ostream& to, const Changed& changed) {
  for (const std::string& change : changed.circuit) to << change << ", ";
  return to << changed.key;
}

std::vector<Changed> parameters_of_the_plain_circuit() {
  return {{{}, "hydraulics.bulk_modulus_MPa", 1400},
          {{}, "hydraulics.dead_volume_cm3", 3},
          {{}, "hydraulics.air_percent", 0.5},
          {{}, "hydraulics.delivery_discharge_coefficient", 0.6},
          {{}, "hydraulics.suction_discharge_coefficient", 0.8},
          {{"hydraulics.oil_law=dowson_higginson"}, "hydraulics.compressibility_per_GPa", 0.6},
          {{"hydraulics.oil_law=dissolving_air"}, "hydraulics.air_dissolved_bar", 30},
          {{"hydraulics.oil_law=constant_density"}, "hydraulics.bulk_modulus_MPa", 1400},
          {{}, "hydraulics.delivery_notch_deg", 18},
          {{}, "port_plate.delivery_arc_deg", 204, "[", ", 336]"},
          {{}, "pump.piston_length_mm", 46},
          {{}, "pump.bore_diameter_mm", 22.5},
          {{}, "pressure.delivery_bar", 275},
          {{}, "operation.speed_rpm", 1500}};
}

// The same by differences of whole searches, of a step and of twice the step: what is left is their
// noise, at most the curves' errors times (8 + 8 + 1 + 1)/12 over the step, and the fourth power of
// the step, 0.02 deg at an edge of an arc.
class PressureRatesAre : public testing::TestWithParam<Changed> {};
TEST_P(PressureRatesAre, DifferencesOfPeriodicStates) {
  const Changed& changed = GetParam();
  constexpr double kDifferentiated = 1e-6;
  const SteadyState base = steady_state(changed.at(0));
  std::vector<double> angles;
  for (int i = 0; i < 360; ++i) angles.push_back(i + 0.3);
  const Neighbours neighbours{changed.at(kDifferentiated), changed.at(-kDifferentiated),
                              2 * kDifferentiated};
  ASSERT_TRUE(has_rates(base, neighbours));
  const PressureRates rates = pressure_rates(base, {&neighbours, 1}, angles).front();

  constexpr double kStep = 1e-4;
  const SteadyState states[] = {steady_state(changed.at(kStep)), steady_state(changed.at(-kStep)),
                                steady_state(changed.at(2 * kStep)),
                                steady_state(changed.at(-2 * kStep))};
  const auto difference = [&](const auto& of) {
    return (8 * (of(states[0]) - of(states[1])) - (of(states[2]) - of(states[3]))) / (12 * kStep);
  };
  double noise = 0, largest = 0;
  for (const SteadyState& state : states) noise = std::max(noise, state.computed->error / kStep);
  for (const double rate : rates.chamber) largest = std::max(largest, std::abs(rate));
  EXPECT_LT(noise, 2e-4 * base.computed->peak);
  double worst = 0, at = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const double off = std::abs(rates.chamber[i] - difference([&](const SteadyState& state) {
                                  return state.computed->gauge(angles[i]);
                                }));
    if (off > worst) worst = off, at = angles[i];
  }
  EXPECT_LE(worst, 1.5 * noise + 1e-6 * largest) << at;
  EXPECT_NEAR(rates.delivery_mean,
              difference([](const SteadyState& state) { return state.summary.delivery_mean; }),
              1.5 * noise);
}
INSTANTIATE_TEST_SUITE_P(PlainCircuit, PressureRatesAre,
                         testing::ValuesIn(parameters_of_the_plain_circuit()));
INSTANTIATE_TEST_SUITE_P(
    OtherCircuits, PressureRatesAre,
    testing::Values(Changed{{"load.kind=laminar", "load.conductance_l_per_min_per_bar=0.33"},
                            "hydraulics.bulk_modulus_MPa",
                            1400},
                    Changed{{"load.kind=laminar"}, "load.conductance_l_per_min_per_bar", 0.33},
                    Changed{{"load.kind=constant_pressure"}, "pressure.delivery_bar", 275},
                    Changed{{"load.kind=constant_pressure", "operation.speed_rpm=-900"},
                            "hydraulics.dead_volume_cm3",
                            3},
                    Changed{{"suction_line.length_m=1", "suction_line.diameter_mm=40"},
                            "suction_line.length_m",
                            1},
                    Changed{{"accumulator.gas_volume_l=0.3", "accumulator.precharge_bar=150"},
                            "accumulator.precharge_bar",
                            150},
                    Changed{{"hydraulics.cavitation=rate"}, "operation.speed_rpm", 1500},
                    Changed{{"delivery_line.length_m=1", "delivery_line.diameter_mm=20"},
                            "delivery_line.length_m",
                            1},
                    Changed{{"delivery_line.length_m=1", "delivery_line.diameter_mm=20"},
                            "hydraulics.delivery_volume_l",
                            0.5}));

// The size of the load is sought, so that its own coefficient moves no pressure: what the common
// one does is what both ports' do. Rates are to the tolerance of the variational equations, 1e-9
// per step, and the cases' 1e-6 apart.
TEST(PressureRates, OfTheCommonCoefficientAreThoseOfBothPorts) {
  const std::string both[] = {"hydraulics.delivery_discharge_coefficient",
                              "hydraulics.suction_discharge_coefficient"};
  const auto changed = [&](const std::string& key) {
    std::vector<std::string> circuit;
    if (key != "hydraulics.discharge_coefficient")
      circuit.push_back((key == both[0] ? both[1] : both[0]) + "=0.67");
    return Changed{circuit, key, 0.67};
  };
  std::vector<double> angles;
  for (int i = 0; i < 72; ++i) angles.push_back(5 * i + 0.3);
  const SteadyState base = steady_state(changed("hydraulics.discharge_coefficient").at(0));
  std::vector<Neighbours> neighbours;
  for (const std::string& key : {std::string("hydraulics.discharge_coefficient"), both[0], both[1]})
    neighbours.push_back({changed(key).at(1e-6), changed(key).at(-1e-6), 2e-6});
  const auto rates = pressure_rates(base, neighbours, angles);
  double largest = 0;
  for (const double rate : rates[0].chamber) largest = std::max(largest, std::abs(rate));
  EXPECT_GT(largest, 1e-3 * base.computed->peak);
  for (std::size_t i = 0; i < angles.size(); ++i)
    EXPECT_NEAR(rates[0].chamber[i], rates[1].chamber[i] + rates[2].chamber[i], 1e-5 * largest)
        << angles[i];
}

// Areas open from 0, so what moves an edge moves nothing at once: no jump there, but a change of
// slope. Both sides of an edge are 2e-7 deg apart, rates change by their size in a degree or so.
TEST(PressureRates, HaveNoJumpsAtEdgesOfPorts) {
  const Changed changed{{}, "port_plate.delivery_arc_deg", 204, "[", ", 336]"};
  const SteadyState base = steady_state(changed.at(0));
  const Neighbours neighbours{changed.at(1e-6), changed.at(-1e-6), 2e-6};
  std::vector<double> angles;
  for (const double edge : base.computed->edges_deg)
    for (const double side : {-1e-7, 1e-7}) angles.push_back(edge + side);
  ASSERT_GE(angles.size(), 8U);
  const auto rates = pressure_rates(base, {&neighbours, 1}, angles).front().chamber;
  const double largest = std::abs(*std::max_element(
      rates.begin(), rates.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  EXPECT_GT(largest, 0.1 * base.computed->peak);
  for (std::size_t i = 0; i < angles.size(); i += 2)
    EXPECT_NEAR(rates[i], rates[i + 1], 1e-5 * largest) << angles[i];
}

TEST(PressureRates, AreRefusedWhereTheCircuitChanges) {
  const SteadyState base = steady_state(rated());
  Neighbours two{rated(), rated(), 1};
  EXPECT_TRUE(has_rates(base, two));
  two.above.hydraulics->load = LoadData();
  two.above.hydraulics->load->kind = LoadKind::constant_pressure;
  EXPECT_FALSE(has_rates(base, two));
  EXPECT_THROW(pressure_rates(base, {&two, 1}, {}), InputError);
}

TEST(Orders, AreTheHarmonicsOfTheTable) {
  for (const char* line : {"", "delivery_line.length_m=1"}) {
    std::vector<std::string> changes = {"operation.samples_per_revolution=7200"};
    if (*line != 0) changes = {changes[0], line, "delivery_line.diameter_mm=20"};
    const SteadyState state = steady_state(
        read_case(fs::path(BENTAXIS_SOURCE_DIR) / "cases/bap63_rated_hydraulic.toml", changes));
    const auto flow = column(state.table, "mload_g_per_s");
    const auto pressure = column(state.table, "p_delivery_bar");
    for (const Order& order : state.orders) {
      // 1440 points of a period: what they mistake for a low harmonic is far up.
      EXPECT_NEAR(order.flow * 1e3, amplitude(flow, order.order), scaled(1e-6) * mean(flow));
      EXPECT_NEAR(order.delivery / 1e5, amplitude(pressure, order.order), scaled(1e-6) * 275);
      const double load =
          amplitude(*line != 0 ? column(state.table, "p_load_bar") : pressure, order.order);
      EXPECT_NEAR(order.load_pressure / 1e5, load, scaled(1e-6) * 275);
    }
    EXPECT_LT(amplitude(flow, 1) / mean(flow), 1e-6);
    EXPECT_GT(state.orders[0].flow * 1e3, 1e-3 * mean(flow));
  }
}

TEST(Orders, OfTheRateOfPressureAreThoseOfTheCurve) {
  const SteadyState state = steady_state(rated());
  std::vector<double> pressure;
  for (int i = 0; i < 36000; ++i) pressure.push_back(state.computed->gauge(i / 100.0));
  const auto rate = orders_of_rate(*state.computed, 100);
  ASSERT_EQ(rate.size(), 100);
  for (int order = 1; order <= 100; ++order)
    EXPECT_NEAR(rate[order - 1] / (order * amplitude(pressure, order)), 1, scaled(1e-3)) << order;
  // Nearly a rectangle: 2 p/pi of order 1.
  EXPECT_NEAR(rate[0] / (2 * 275e5 / kPi), 1, 0.05);
}

TEST(Table, ColumnsThatFollowFromOthers) {
  Case the_case =
      read_case(fs::path(BENTAXIS_SOURCE_DIR) / "cases/bap63_rated_hydraulic.toml",
                {"hydraulics.delivery_hole_deg=176", "hydraulics.delivery_hole_diameter_mm=1.5"});
  const SteadyState state = steady_state(the_case);
  const auto get = [&](const std::string& name) { return column(state.table, name); };
  const auto p = get("p_1_bar"), modulus = get("K_1_MPa"), rate = get("dp_1_bar_per_deg"),
             out = get("Qd_1_l_per_min"), back = get("Qdb_1_l_per_min"), in = get("Qs_1_l_per_min"),
             back_in = get("Qsb_1_l_per_min");
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double theta = state.table.theta_deg[i];
    EXPECT_NEAR(modulus[i] * 1e6 / effective_bulk_modulus(state, p[i] * 1e5), 1, scaled(1e-6));
    const double h = 1e-4;
    const double slope =
        (state.computed->gauge(theta + h) - state.computed->gauge(theta - h)) / (2 * h) / 1e5;
    // Half a degree behind an edge it changes by thousands of bar per degree.
    EXPECT_NEAR(rate[i], slope, scaled(1e-2) * (1 + std::abs(slope))) << theta;
    EXPECT_EQ(back[i], std::max(0.0, -out[i]));
    EXPECT_EQ(back_in[i], std::max(0.0, -in[i]));
  }
  EXPECT_NEAR(mean(get("Qdb_l_per_min")), 5 * mean(back), scaled(1e-3) * 5 * mean(back));
  EXPECT_NEAR(mean(get("Qsb_l_per_min")), 5 * mean(back_in), scaled(1e-3) * 5 * mean(back_in));
  EXPECT_GT(mean(back), 0.1);
  for (const std::string port : {"as", "ad"}) {
    std::vector<double> sum(p.size());
    int parts = 0;
    for (const Channel& channel : state.table.channels) {
      if (channel.name.rfind(port + "_1_", 0) != 0 || channel.name == port + "_1_mm2") continue;
      ++parts;
      const auto part = get(channel.name);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part[i];
      EXPECT_GT(mean(part), 0) << channel.name;
    }
    EXPECT_EQ(parts, port == "ad" ? 3 : 2);
    const auto whole = get(port + "_1_mm2");
    for (std::size_t i = 0; i < sum.size(); ++i)
      EXPECT_NEAR(sum[i], whole[i], scaled(1e-12) * 100) << port;
  }
}

// Counted on the curve itself, a hundredth of a degree at a time.
TEST(Report, DegreesBelowSaturationAndVapourPressure) {
  Case the_case = rated();
  the_case.operation.speed_rpm = 3000;  // oil tears
  the_case.hydraulics->vapour_pressure = pascals(0.02);
  const SteadyState state = steady_state(the_case);
  const Summary& s = state.summary;
  double below_saturation = 0, below_vapour = 0;
  for (double theta = 0.005; theta < 360; theta += 0.01) {
    below_saturation += state.computed->gauge(theta) < s.saturation ? 0.01 : 0;
    below_vapour += state.computed->gauge(theta) < s.vapour ? 0.01 : 0;
  }
  EXPECT_NEAR(s.below_saturation_deg, below_saturation, 0.1);
  EXPECT_NEAR(s.below_vapour_deg, below_vapour, 0.1);
  EXPECT_GT(below_vapour, 1);
  EXPECT_GT(below_saturation, below_vapour);
}

TEST(Report, LinesAreOneAnothersByTheirMeaning) {
  const SteadyState state = steady_state(rated());
  std::map<std::string, double> value;
  for (const Line& line : lines(state)) value[line.name] = line.value;
  EXPECT_DOUBLE_EQ(
      value.at("volumetric efficiency, mean flow to the load over ideal flow"),
      100 * value.at("mean flow to the load") / value.at("ideal flow, displacement x speed"));
  EXPECT_DOUBLE_EQ(value.at("mean torque of that work") * 2 * kPi,
                   value.at("work of the pistons per turn"));
  EXPECT_DOUBLE_EQ(value.at("load orifice"), state.summary.load_size * 1e6);
  EXPECT_NEAR(value.at("mean delivery pressure"), 275, 0.1);  // the rated one, bar
  EXPECT_LT(value.at("delivery pressure, minimum"), value.at("mean delivery pressure"));
  EXPECT_LT(value.at("mean delivery pressure"), value.at("delivery pressure, maximum"));
  for (const char* angle : {"angle of the maximum", "angle of the minimum"}) {
    EXPECT_GE(value.at(angle), 0);
    EXPECT_LT(value.at(angle), 360);
  }
  for (const Channel& channel : state.table.channels)
    EXPECT_EQ(channel.piston, channel.name.find("_1_") == std::string::npos ? 0 : 1)
        << channel.name;
}

// ---- The periodic state
// --------------------------------------------------------------------------

TEST(PeriodicState, MeanDeliveryPressureIsTheOneAskedFor) {
  for (const double bar : {1.0, 25.0, 275.0, 350.0}) {
    Case the_case = rated();
    the_case.pressure.ports.delivery = pascals(bar);
    const SteadyState state = steady_state(the_case);
    EXPECT_NEAR(state.summary.delivery_mean / pascals(bar), 1,
                scaled(kStepsAddUp) * the_case.hydraulics->tolerance);
    EXPECT_LT(state.convergence.residual, scaled(kStepsAddUp) * the_case.hydraulics->tolerance);
  }
}

TEST(PeriodicState, OpenLineStaysAtAtmosphere) {
  Case the_case = rated();
  the_case.pressure.ports.delivery = 0;
  const SteadyState state = steady_state(the_case);
  for (const double p : state.delivery.pressure) EXPECT_EQ(p, 0);
  EXPECT_EQ(state.summary.load_size, 0);
  EXPECT_GT(state.summary.volumetric_efficiency, 0.98);
}

TEST(PeriodicState, ErrorIsBelowTheOneStated) {
  for (const bool starved : {false, true}) {
    Case the_case = rated();
    if (starved) the_case.operation.speed_rpm = 3000;  // oil tears
    the_case.operation.samples_per_revolution = 7200;
    the_case.hydraulics->tolerance = 1e-12;
    the_case.hydraulics->curve_error = 1e-9;
    const SteadyState best = steady_state(the_case);
    double before = 1;
    for (const double allowed : {1e-3, 1e-5, 1e-7}) {
      the_case.hydraulics->tolerance = 1e-5;
      the_case.hydraulics->curve_error = allowed;
      const SteadyState state = steady_state(the_case);
      double error = 0;
      for (std::size_t i = 0; i < state.chamber.pressure.size(); ++i)
        error = std::max(error, std::abs(state.chamber.pressure[i] - best.chamber.pressure[i]));
      EXPECT_LE(error, state.computed->error + best.computed->error) << starved << " " << allowed;
      EXPECT_LE(state.computed->error, allowed * state.computed->peak);
      EXPECT_LT(error, before * state.computed->peak);
      before = error / state.computed->peak / 10;
    }
  }
}

// What the models get has no wiggle that the solution has not: where the pressure rises from port
// edge to port edge it does so between its points, and nothing is below absolute zero.
TEST(PeriodicState, CurveIsMonotoneWhereTheSolutionIs) {
  Case the_case = rated();
  the_case.operation.speed_rpm = 3000;
  SteadyState state = steady_state(the_case);
  give_to(the_case, state);
  const PressureTrace trace(the_case.pressure);
  int turning = 0;
  double least = 0, slope = 0;
  for (double theta = 0.005, before = trace(0); theta <= 360; theta += 0.005) {
    const double p = trace(theta);
    least = std::min(least, p);
    // Turning points that can be seen: those above the stated error.
    if (std::abs(p - before) < state.computed->error) continue;
    if ((p - before) * slope < 0) ++turning;
    slope = p - before;
    before = p;
  }
  EXPECT_GT(least, -the_case.hydraulics->atmosphere);
  EXPECT_LT(least, -0.9 * the_case.hydraulics->atmosphere);  // a hard case: the oil tears
  EXPECT_LT(turning, 40);
  // Negative control: the spline through 800 points dips below absolute zero.
  the_case.pressure.points = 800;
  give_to(the_case, steady_state(the_case));
  const PressureTrace spline(the_case.pressure);
  double dip = 0;
  for (double theta = 0; theta < 360; theta += 0.01) dip = std::min(dip, spline(theta));
  EXPECT_LT(dip, -the_case.hydraulics->atmosphere);
}

TEST(PeriodicState, SplineSaysHowFarItIsOff) {
  Case the_case = rated();
  the_case.pressure.points = 800;
  const SteadyState state = steady_state(the_case);
  give_to(the_case, state);
  const PressureTrace spline(the_case.pressure);
  the_case.pressure.points = 0;
  const PressureTrace curve(the_case.pressure);
  double off = 0;
  for (double theta = 0; theta < 360; theta += 0.001)
    off = std::max(off, std::abs(spline(theta) - curve(theta)));
  EXPECT_NEAR(state.spline_error / off, 1, 0.05);
  EXPECT_GT(off, pascals(0.1));
}

TEST(PeriodicState, DoesNotDependOnTheStart) {
  const Case the_case = rated();
  const SteadyState usual = steady_state(the_case);
  for (const Start& start : {Start{0, pascals(1), usual.summary.load_size * 20},
                             Start{pascals(600), pascals(600), usual.summary.load_size / 4},
                             Start{-pascals(0.9), pascals(50), usual.summary.load_size}}) {
    const SteadyState other = steady_state(the_case, start);
    EXPECT_LT(log_difference(the_case, other.chamber, usual.chamber),
              scaled(kStepsAddUp) * the_case.hydraulics->tolerance);
    EXPECT_NEAR(other.summary.load_size / usual.summary.load_size, 1,
                scaled(kStepsAddUp) * the_case.hydraulics->tolerance);
  }
}

TEST(PeriodicState, IsWhereALongTransientEnds) {
  Case the_case = rated();
  the_case.pressure.points = 360;
  const SteadyState state = steady_state(the_case);
  const int turns = 40, samples = 72;
  const ResultTable transient =
      transient_from_rest(the_case, state.summary.load_size, turns, samples);
  ASSERT_EQ(transient.rows(), 360 * turns);
  const Fluid fluid(*the_case.hydraulics);
  double worst = 0, first_turn = 0;
  for (std::size_t i = 0; i < 360; ++i) {
    const auto difference = [&](int turn) {
      const std::size_t row = 360 * turn + i;
      EXPECT_NEAR(transient.theta_deg[row], 360.0 * turn + static_cast<double>(i), 1e-9);
      return std::abs(fluid.log_pressure(pascals(transient.at(row, 0))) -
                      fluid.log_pressure(state.chamber.pressure[i]));
    };
    worst = std::max(worst, difference(turns - 1));
    first_turn = std::max(first_turn, difference(0));
  }
  // The line's memory of 12 ms is gone after 40 turns of 40 ms; what remains is the integrations'.
  EXPECT_LT(worst, scaled(kStepsAddUp) * the_case.hydraulics->tolerance);
  EXPECT_GT(first_turn, 0.1);
}

TEST(PeriodicState, TheMapsDerivativeIsThatOfTheIntegration) {
  const Case the_case = rated();
  const Network network(the_case);
  Integrator integrator(network);
  const SteadyState state = steady_state(the_case);
  const int size = network.size(), unknowns = network.pressures() + 1;
  std::vector<double> sensitivity;
  const double area = state.summary.load_size;
  integrator.over_period(state.states, area, 1e-10, &sensitivity);
  const double h = 1e-4;
  for (int j = 0; j < unknowns; ++j) {
    auto low = state.states, high = low;
    double low_area = area, high_area = area;
    if (j < network.pressures()) {
      low[j] -= h;
      high[j] += h;
    } else {
      low_area *= std::exp(-h);
      high_area *= std::exp(h);
    }
    const auto a = integrator.over_period(low, low_area, 1e-11);
    const auto b = integrator.over_period(high, high_area, 1e-11);
    for (int i = 0; i < size; ++i)  // differences: h^2, and errors of 1e-9 over h
      EXPECT_NEAR((b[i] - a[i]) / (2 * h), sensitivity[j * size + i], scaled(1e-4))
          << i << " " << j;
  }
}

TEST(PeriodicState, AnyNumberOfPistons) {
  for (const int pistons : {1, 2, 3, 9, 12}) {
    Case the_case = rated();
    the_case.pump.geometry.pistons = pistons;
    the_case.pressure.ports.delivery = pascals(pistons < 3 ? 60 : 275);
    const SteadyState state = steady_state(the_case);
    EXPECT_NEAR(state.summary.mass_in / state.summary.mass_out, 1, scaled(kMassBalance)) << pistons;
    EXPECT_EQ(state.chamber.pressure.size(), 720);
    // Neighbouring points belong together across the seams of the N pieces.
    const Fluid fluid(*the_case.hydraulics);
    for (std::size_t i = 0; i < 720; ++i)
      EXPECT_LT(std::abs(fluid.log_pressure(state.chamber.pressure[i]) -
                         fluid.log_pressure(state.chamber.pressure[(i + 1) % 720])),
                3)
          << pistons << " pistons, point " << i;
  }
}

// ---- Hard inputs
// ---------------------------------------------------------------------------------

TEST(HardInput, NoChamberIsEverBelowAbsoluteZero) {
  using Change = void (*)(Case&);
  const Change changes[] = {
      [](Case& c) { c.hydraulics->delivery.notch = c.hydraulics->suction.notch = {}; },
      // Opens to suction 25 deg after the dead centre: the oil is torn apart.
      [](Case& c) {
        c.hydraulics->suction = {{51, 130}, {}};
      },
      [](Case& c) {
        c.hydraulics->suction.arc = {80, 81};
      },
      [](Case& c) { c.operation.speed_rpm = 6000; },
      [](Case& c) { c.hydraulics->air_share = 1e-6; },
      [](Case& c) { c.pressure.ports.suction = -pascals(0.9); },
      [](Case& c) {
        c.hydraulics->bulk_modulus = 5e9;
        c.hydraulics->dead_volume = 1e-7;
        c.hydraulics->delivery.notch = c.hydraulics->suction.notch = {};
        c.hydraulics->suction = {{51, 130}, {}};
      }};
  int number = 0;
  double lowest = 1;
  for (const Change change : changes) {
    Case the_case = rated();
    change(the_case);
    if (number == 2) the_case.pressure.ports.delivery = pascals(20);
    const SteadyState state = steady_state(the_case);
    const double absolute = (state.summary.chamber_least + the_case.hydraulics->atmosphere) /
                            the_case.hydraulics->atmosphere;
    EXPECT_GT(absolute, 0) << number;
    for (const double p : state.chamber.pressure)
      EXPECT_GE(p, -the_case.hydraulics->atmosphere) << number;
    // Some of these fill hardly at all: the scale is a full chamber. Where air rules, K ~ P and the
    // mass is known no better than ln P.
    EXPECT_NEAR(state.summary.mass_in, state.summary.mass_out,
                scaled(kStepsAddUp) * the_case.hydraulics->tolerance *
                    the_case.hydraulics->density * state.summary.displacement)
        << number;
    lowest = std::min(lowest, absolute);
    ++number;
  }
  EXPECT_LT(lowest, 0.05);  // the cases do come near it
}

TEST(HardInput, StepLikePortEdges) {
  Case the_case = rated();
  HydraulicData& h = *the_case.hydraulics;
  h.delivery.notch = h.suction.notch = {};
  h.kidney_rounding_deg = 0;
  h.kidney_width_deg = 0.02;  // opens 150 mm2 within 0.02 deg
  h.kidney_height = 20;
  h.delivery.arc = {180, 360};
  h.suction.arc = {0, 180};
  const SteadyState state = steady_state(the_case);
  EXPECT_NEAR(state.summary.mass_in / state.summary.mass_out, 1, scaled(1e-7));
  EXPECT_GT(state.summary.port_flow_ripple, 1);  // back-flow through the whole kidney at once
}

TEST(HardInput, StiffAndSoft) {
  for (const double modulus : {1e8, 1e10, 1e12})
    for (const double volume : {1e-6, 1e-2}) {
      Case the_case = rated();
      the_case.hydraulics->bulk_modulus = modulus;
      the_case.hydraulics->delivery_volume = volume;
      EXPECT_NO_THROW(steady_state(the_case)) << modulus << " " << volume;
    }
}

std::string refusal(const Case& the_case) {
  try {
    steady_state(the_case);
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

TEST(HardInput, WhatHasNoPeriodicStateIsRefused) {
  Case the_case = rated();
  the_case.operation.speed_rpm = 0;
  EXPECT_THAT(refusal(the_case), testing::HasSubstr("at rest"));
  the_case.operation.speed_rpm = -1500;
  EXPECT_THAT(refusal(the_case), testing::HasSubstr("motoring"));
  the_case = rated();
  the_case.pump.geometry.tilt = 0;
  EXPECT_THAT(refusal(the_case), testing::HasSubstr("no stroke"));
  the_case = rated();
  the_case.hydraulics.reset();
  EXPECT_THAT(refusal(the_case), testing::HasSubstr("[hydraulics]"));
  // A model that was not given the computed curve says so instead of running without it.
  EXPECT_THROW(PressureTrace{rated().pressure}, InputError);
}

TEST(HardInput, PressureThatThePumpCannotReach) {
  Case the_case = rated();
  the_case.hydraulics->leakage *= 50;
  const auto refusal = [&](double bar) {
    the_case.pressure.ports.delivery = pascals(bar);
    try {
      steady_state(the_case);
    } catch (const ComputationError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  // The limit named is one: just below it there is a state, just above there is none.
  const std::string text = refusal(400);
  const auto at = text.find("delivery pressure is ");
  ASSERT_NE(at, std::string::npos) << text;
  const double largest = std::stod(text.substr(at + 21));
  EXPECT_GT(largest, 50);
  EXPECT_EQ(refusal(largest * 0.99), "");
  EXPECT_THAT(refusal(largest * 1.01), testing::HasSubstr("cannot be reached"));
}

// Stiff enough for steps of no length: it ends, and says why in words.
TEST(HardInput, EveryRunEnds) {
  Case the_case = rated();
  the_case.pump.geometry.pistons = 7;
  the_case.operation.speed_rpm = 0.02;
  the_case.pressure.ports.delivery = pascals(0.01);
  the_case.hydraulics->transition_pressure = 10;  // Pa
  the_case.hydraulics->bulk_modulus = 1e14;
  the_case.hydraulics->dead_volume = 1e-9;
  the_case.hydraulics->delivery_volume = 1e-9;
  try {
    const SteadyState state = steady_state(the_case);
    EXPECT_LT(state.convergence.residual, 1e-6);
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("hydraulics"));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("CV_")));
  }
}

TEST(HardInput, InterruptionIsSeenWithinAPeriod) {
  const Case the_case = rated();
  int calls = 0;
  EXPECT_THROW(steady_state(the_case, {},
                            [&](double) {
                              if (++calls == 3) throw Interrupted();
                            }),
               Interrupted);
  // Not once per Newton step only: a single integration asks as well.
  calls = 0;
  const Network network(the_case);
  Integrator integrator(network, [&] { ++calls; });
  const SteadyState state = steady_state(the_case);
  integrator.over_period(state.states, state.summary.load_size, 1e-10);
  EXPECT_GE(calls, 1);
  EXPECT_GE(calls, integrator.work().steps * network.size() / 11000);
}

TEST(Control, EveryNumberOfTheTableCounts) {
  const Case base = rated();
  const SteadyState usual = steady_state(base);
  using Change = void (*)(HydraulicData&);
  const Change changes[] = {[](HydraulicData& h) { h.density *= 1.001; },
                            [](HydraulicData& h) { h.bulk_modulus *= 1.001; },
                            [](HydraulicData& h) { h.air_share *= 1.001; },
                            [](HydraulicData& h) { h.air_exponent *= 1.001; },
                            [](HydraulicData& h) { h.atmosphere *= 1.001; },
                            [](HydraulicData& h) { h.delivery.arc.from_deg += 0.01; },
                            [](HydraulicData& h) { h.delivery.arc.to_deg += 0.01; },
                            [](HydraulicData& h) { h.suction.arc.from_deg += 0.01; },
                            [](HydraulicData& h) { h.suction.arc.to_deg += 0.01; },
                            [](HydraulicData& h) { h.delivery.notch.length_deg += 0.01; },
                            [](HydraulicData& h) { h.delivery.notch.area *= 1.001; },
                            [](HydraulicData& h) { h.suction.notch.length_deg += 0.01; },
                            [](HydraulicData& h) { h.suction.notch.area *= 1.001; },
                            [](HydraulicData& h) { h.kidney_width_deg += 0.01; },
                            [](HydraulicData& h) { h.kidney_height *= 1.001; },
                            [](HydraulicData& h) { h.kidney_rounding_deg += 0.01; },
                            [](HydraulicData& h) { h.notch_law = NotchLaw::linear; },
                            [](HydraulicData& h) { h.discharge_coefficient *= 1.001; },
                            [](HydraulicData& h) { h.transition_pressure *= 1.001; },
                            [](HydraulicData& h) { h.leakage *= 1.001; },
                            [](HydraulicData& h) { h.case_pressure += 100; },
                            [](HydraulicData& h) { h.dead_volume *= 1.001; },
                            [](HydraulicData& h) { h.delivery_volume *= 1.001; }};
  int number = 0;
  for (const Change change : changes) {
    Case changed = base;
    change(*changed.hydraulics);
    EXPECT_GT(log_difference(base, steady_state(changed).chamber, usual.chamber), 1e-7) << number++;
  }
}

// ---- The shipped cases
// ---------------------------------------------------------------------------

TEST(ShippedCases, PeakIsTheRatedPumpAtAnotherPressure) {
  const Case a = rated(), b = shipped("bap63_peak_hydraulic.toml");
  ASSERT_EQ(a.entries.size(), b.entries.size());
  for (std::size_t i = 0; i < a.entries.size(); ++i)
    if (a.entries[i].key != "delivery_bar" && a.entries[i].key != "name") {
      EXPECT_EQ(a.entries[i].value, b.entries[i].value) << a.entries[i].key;
    }
}

TEST(ShippedCases, SplineOf800PointsHoldsTheTorque) {
  Case the_case = rated();
  const auto torque = [&](int points) {
    the_case.pressure.points = points;
    give_to(the_case, steady_state(the_case));
    return mean(
        column(analytic::run(the_case, the_case.analytic, test::one_turn(the_case)), "Td_z1_Nm"));
  };
  // Points 0.45 deg apart against rises of some 5 deg: the paper's choice costs a millionth.
  EXPECT_NEAR(torque(800) / torque(6400), 1, scaled(1e-5));
}

}  // namespace
}  // namespace bentaxis::hydraulics
