// The analytic model: high-precision curves, an independent twin, hand-solved cases, properties.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/rounding.h"
#include "bentaxis/analytic/validity.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "closed_form/film.h"
#include "closed_form/friction.h"
#include "free_bodies.h"
#include "kinematics.h"
#include "printed_model.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using analytic::Model;

// ---- high-precision curves ---------------------------------------------------------------------

class Reference : public testing::TestWithParam<std::string> {};

// Rounding of the inputs to double and some 300 operations: 3e-15 measured; required is 1e-12.
constexpr double kReferenceTolerance = 1e-13;

TEST_P(Reference, EveryChannelIsRightToRoundOff) {
  const Case the_case = reference_case(GetParam());
  const ResultTable table = analytic::run(the_case, the_case.analytic, one_turn(the_case));
  const NumericTable reference =
      read_numeric_csv(reference_folder() / GetParam() / "reference.csv", true);
  ASSERT_EQ(reference.rows.size(), table.rows());
  const ChannelLayout layout(the_case.pump.geometry.pistons);
  ASSERT_EQ(reference.header.size(), layout.reactions() + 1);
  for (std::size_t c = 1; c < reference.header.size(); ++c) {
    const std::size_t column = table.find(reference.header[c]);
    ASSERT_LT(column, table.columns()) << reference.header[c];
    const double peak = table.peak(table.channels[column].group);
    for (std::size_t row = 0; row < table.rows(); ++row) {
      ASSERT_DOUBLE_EQ(reference.rows[row][0], table.theta_deg[row]);
      ASSERT_NEAR(reference.rows[row][c], table.at(row, column),
                  scaled(kReferenceTolerance) * (peak > 0 ? peak : 1))
          << reference.header[c] << " at " << table.theta_deg[row] << " deg";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Reference, testing::ValuesIn(reference_cases()),
                         [](const auto& test) { return test.param; });

TEST(ReferenceCases, AllTwelveAreThere) { EXPECT_EQ(reference_cases().size(), 12U); }

// ---- independent twin --------------------------------------------------------------------------

// Both are closed-form; the worst of 500 random pumps is 2e-13 of the row's largest force (bearings
// close together amplify).
constexpr double kTwinTolerance = 2e-11;

TEST(PrintedTwin, AgreesOnRandomPumpsAndChangingSpeed) {
  RandomPump random(1);
  for (int i = 0; i < 500; ++i) {
    const PumpParameters pump = random.pump();
    const Assumptions assumptions = random.assumptions(pump);
    const Instant instant = random.instant(pump, true);
    const Model model(pump, assumptions);
    std::vector<double> values(model.layout().size());
    model.evaluate(instant, values);
    const std::vector<double> twin = PrintedModel(pump, assumptions).reactions(instant);
    double largest = 0;
    for (const double v : twin) largest = std::max(largest, std::abs(v));
    for (std::size_t c = 0; c < twin.size(); ++c)
      ASSERT_NEAR(values[c], twin[c], scaled(kTwinTolerance) * largest)
          << model.layout().channels()[c].name << ", pump " << i;
  }
}

// ---- hand-solved cases -------------------------------------------------------------------------

PumpParameters plain_pump(int pistons) {
  PumpParameters p;
  p.geometry = {pistons, radians(30), 0.03, 0.027, 0.0, 0.05, 0.02};
  p.gear.pitch_diameter = 0.1;
  p.gear.pressure_angle = radians(20);
  p.bearings = {-0.03, -0.08};
  p.gravity = 0;
  return p;
}

Instant still(int pistons, double pressure = 0) {
  Instant i;
  i.turn(0.3, 0);
  i.chamber_pressure.assign(pistons, pressure);
  return i;
}

// A weight on a beam on two supports.
TEST(HandSolved, ShaftWeightFollowsTheLeverRule) {
  PumpParameters p = plain_pump(3);
  p.gravity = 10;
  p.shaft.mass = 2;
  p.shaft.centre_of_mass_z = -0.05;
  const Model model(p, {});
  std::vector<double> v(model.layout().size());
  model.evaluate(still(3), v);
  EXPECT_NEAR(v[model.layout().Rb1(1)], 20 * 0.03 / 0.05, 1e-12);
  EXPECT_NEAR(v[model.layout().Rb2(1)], 20 * 0.02 / 0.05, 1e-12);
  EXPECT_NEAR(v[model.layout().Td()], 0, 1e-12);
}

// At zero tilt and equal radii pistons are parallel to the axes: pressure goes straight through.
TEST(HandSolved, ParallelPistonsCarryPressureStraightThrough) {
  PumpParameters p = plain_pump(1);
  p.geometry.tilt = 0;
  p.geometry.bore_circle_radius = p.geometry.joint_circle_radius;
  p.block.spring_force = 100;
  p.block.bottom_area = 2e-4;
  const Model model(p, {});
  const ChannelLayout& at = model.layout();
  std::vector<double> v(at.size());
  Instant i = still(1, 1e7);
  i.turn(0, 0);  // joint on +y
  model.evaluate(i, v);
  const double force = 1e7 * kPi * 1e-4;
  EXPECT_NEAR(v[at.Rs(0, 2)], force, 1e-9);
  for (const auto c : {at.Rs(0, 0), at.Rs(0, 1), at.Rc(0, 0), at.Rc(0, 1), at.Rcs(), at.Td()})
    EXPECT_NEAR(v[c], 0, 1e-9);
  // The film holds the spring and the pressure on the bottom of the bore.
  EXPECT_NEAR(v[at.Fh()], -100 - 2000, 1e-9);
  EXPECT_NEAR(v[at.xh()], 0, 1e-15);
  EXPECT_NEAR(v[at.yh()], 0.03 * 2000 / 2100, 1e-12);
  // Bearings: thrust in the tapered one; in both the couple that balances -force z at y = 0.03,
  // whose moment about x is -0.03 force: 0.03 Rb1_y + 0.08 Rb2_y = 0.03 force, Rb1_y = -Rb2_y.
  EXPECT_NEAR(v[at.Rb1(2)], force + 100, 1e-9);
  EXPECT_NEAR(v[at.Rb2(1)], force * 0.03 / 0.05, 1e-9);
  EXPECT_NEAR(v[at.Rb1(1)], -force * 0.03 / 0.05, 1e-9);
}

// The block's weight tilts it, and nothing presses it to the plate: a moment without a force has no
// point where it acts.
TEST(HandSolved, WithoutForceOnTheFilmThereIsNoCentreOfIt) {
  PumpParameters p = plain_pump(3);
  p.geometry.tilt = 0;  // the weight has no part along the block's axis
  p.gravity = 10;
  p.block.mass = 2;
  p.block.centre_of_mass_z = 0.02;
  const Model model(p, {});
  const ChannelLayout& at = model.layout();
  std::vector<double> v(at.size());
  model.evaluate(still(3), v);
  EXPECT_EQ(v[at.Fh()], 0);
  EXPECT_GT(std::abs(v[at.Th(0)]), 0.1);
  EXPECT_FALSE(is_computed(v[at.xh()]));
  EXPECT_FALSE(is_computed(v[at.yh()]));
}

// Only the block's viscous torque acts: the gear carries it with its arm (d/2) cos(ap).
TEST(HandSolved, GearCarriesTheBlocksFriction) {
  for (const double omega : {150.0, -150.0}) {
    PumpParameters p = plain_pump(3);
    p.friction.block_viscous = 0.05;
    const Model model(p, {});
    const ChannelLayout& at = model.layout();
    std::vector<double> v(at.size());
    Instant i = still(3);
    i.turn(i.shaft.angle, omega);
    model.evaluate(i, v);
    const double tooth = 0.05 * 150 / (0.05 * std::cos(radians(20)));
    EXPECT_NEAR(v[at.Rcs()], tooth, 1e-10);
    EXPECT_NEAR(v[at.Tcs()], 0.05 * omega, 1e-12);
    EXPECT_NEAR(v[at.Td()], 0.05 * omega, 1e-12);
    EXPECT_NEAR(v[at.Rcn(0)], (omega > 0 ? 1 : -1) * tooth * std::cos(radians(20)), 1e-10);
  }
}

// b = 0, Rd = Ra (1 + cos a)/2: the piston's tilt is constant and everything is a sine.
TEST(HandSolved, SinusoidalPumpHasTheClosedForm) {
  PumpParameters p = plain_pump(5);
  Geometry& g = p.geometry;
  g.bore_circle_radius = g.joint_circle_radius * (1 + std::cos(g.tilt)) / 2;
  const double e = g.joint_circle_radius * (1 - std::cos(g.tilt)) / 2;
  const double h = std::sqrt(g.piston_length * g.piston_length - e * e);
  const Model model(p, {});
  const ChannelLayout& at = model.layout();
  std::vector<double> v(at.size());
  Instant i = still(5);
  i.turn(0.7, 100);
  i.chamber_pressure = {1e7, 2e6, 3e7, 0, 5e6};
  model.evaluate(i, v);
  double torque_on_block = 0;
  for (int k = 0; k < 5; ++k) {
    const double angle = i.shaft.angle - 2 * kPi * k / 5;
    const double force = i.chamber_pressure[k] * kPi * 1e-4;
    EXPECT_NEAR(v[at.Rs(k, 0)], force * e * std::sin(angle) / h, 1e-9);
    EXPECT_NEAR(v[at.Rs(k, 1)], force * e * std::cos(angle) / h, 1e-9);
    EXPECT_NEAR(v[at.Rs(k, 2)], force, 1e-9);
    EXPECT_NEAR(v[at.Rc(k, 0)], -v[at.Rs(k, 0)], 1e-9);
    EXPECT_NEAR(v[at.Rc(k, 1)], -v[at.Rs(k, 1)], 1e-9);
    torque_on_block -= force * e / h * g.bore_circle_radius * std::sin(2 * angle);
  }
  EXPECT_NEAR(v[at.Tcs()], -torque_on_block, 1e-11);
}

// ---- properties --------------------------------------------------------------------------------

TEST(Properties, PowerBalanceAndPistonAxisMomentVanish) {
  RandomPump random(2);
  for (int n = 0; n < 300; ++n) {
    const PumpParameters pump = random.pump();
    Assumptions assumptions = random.assumptions(pump);
    if (n % 3 == 0) assumptions.gear = BlockDrive::imposed;
    const Model model(pump, assumptions);
    const ChannelLayout& at = model.layout();
    std::vector<double> v(at.size());
    Instant i = random.instant(pump, true);
    if (n % 10 == 0) i.turn(i.shaft.angle, 0);
    model.evaluate(i, v);
    double scale = 0;
    for (int k = 0; k < at.pistons(); ++k)
      scale += std::abs(v[at.Rs(k, 2)]) * pump.geometry.joint_circle_radius;
    // Round-off of the sums over pistons.
    EXPECT_NEAR(v[at.power_residual()], 0, scaled(1e-13) * scale);
    for (int k = 0; k < at.pistons(); ++k)
      EXPECT_NEAR(v[at.axis_moment(k)], 0, scaled(1e-13) * scale);
  }
}

// Whole pump as one free body, moments about an arbitrary point, written out from the columns.
TEST(Properties, ForcesOnTheWholePumpAreInEquilibrium) {
  RandomPump random(3);
  for (int n = 0; n < 100; ++n) {
    PumpParameters p = random.pump();
    p.friction.piston_coulomb = p.friction.piston_viscous = 0;
    const Model model(p, random.assumptions(p));
    const ChannelLayout& at = model.layout();
    std::vector<double> v(at.size());
    Instant i = random.instant(p, false);
    i.turn(i.shaft.angle, 0);  // no inertia: what is left must balance by itself
    model.evaluate(i, v);
    using V = Eigen::Vector3d;
    const analytic::Kinematics kinematics(p.geometry);
    const V o2(0, 0, p.geometry.axis_offset);
    const V about(0.1, -0.2, 0.3);
    V force = V::Zero();
    V moment = V::Zero();
    double scale = 0;
    const auto add = [&](const V& at_s1, const V& f) {
      force += f;
      moment += (at_s1 - about).cross(f);
      scale += f.norm();
    };
    const auto s2 = [&](double x, double y, double z) { return kinematics.to_s1({x, y, z}); };
    const auto point2 = [&](double x, double y, double z) -> V { return o2 + s2(x, y, z); };
    add({0, 0, p.bearings.tapered_z}, {v[at.Rb1(0)], v[at.Rb1(1)], v[at.Rb1(2)]});
    add({0, 0, p.bearings.cylindrical_z}, {v[at.Rb2(0)], v[at.Rb2(1)], 0});
    moment.z() += p.friction.shaft_torque_factor * v[at.Td()];
    add({0, 0, p.shaft.centre_of_mass_z}, {0, -p.shaft.mass * p.gravity, 0});
    add(point2(0, 0, p.block.centre_of_mass_z), {0, -p.block.mass * p.gravity, 0});
    add(point2(0, 0, p.block.pin_z), s2(v[at.Rcn(0)], v[at.Rcn(1)], 0));
    add(o2, s2(0, 0, v[at.Fh()]));
    moment += s2(v[at.Th(0)], v[at.Th(1)], 0);
    if (p.port_plate) {
      const auto plate = analytic::closed_form::raw(*p.port_plate);
      for (const auto& [arc, pressure] : {std::pair{plate.delivery, i.ports.delivery},
                                          std::pair{plate.suction, i.ports.suction}}) {
        const auto land = analytic::closed_form::land_force(plate, arc);
        add(o2, s2(0, 0, land.force_z * pressure));
        moment += s2(land.moment_x * pressure, land.moment_y * pressure, 0);
      }
    }
    for (int k = 0; k < at.pistons(); ++k) {
      const double angle = i.shaft.angle - 2 * kPi * k / at.pistons();
      const auto state = kinematics.piston(std::sin(angle), std::cos(angle));
      const V ring = state.ring();
      const double area = kPi / 4 * std::pow(p.geometry.bore_diameter, 2);
      // Oil pushes the piston down and the bottom of the bore up.
      add(point2(ring.x(), ring.y(), ring.z()),
          s2(0, 0, (p.block.bottom_area - area) * i.chamber_pressure[k]));
      const double centre = p.piston.inertia == PistonInertia::lumped
                                ? 1 - p.piston.joint_mass_fraction
                                : p.piston.real->centre_of_mass / p.geometry.piston_length;
      const V g = state.joint.value + centre * state.axis.value;
      add(point2(g.x(), g.y(), g.z()), {0, -p.piston.mass * p.gravity, 0});
    }
    EXPECT_LT(force.norm(), scaled(1e-13) * scale);
    EXPECT_LT(moment.norm(), scaled(1e-13) * scale);
  }
}

TEST(Properties, ShiftByOnePistonPermutesThePistons) {
  RandomPump random(4);
  for (int n = 0; n < 50; ++n) {
    const PumpParameters pump = random.pump();
    const Model model(pump, random.assumptions(pump));
    const ChannelLayout& at = model.layout();
    const int pistons = at.pistons();
    Instant i = random.instant(pump, true);
    Instant shifted = i;
    shifted.turn(i.shaft.angle + 2 * kPi / pistons, i.shaft.speed, i.shaft.acceleration);
    for (int k = 0; k < pistons; ++k)
      shifted.chamber_pressure[(k + 1) % pistons] = i.chamber_pressure[k];
    std::vector<double> a(at.size());
    std::vector<double> b(at.size());
    model.evaluate(i, a);
    model.evaluate(shifted, b);
    double scale = 0;
    for (std::size_t c = 0; c < at.reactions(); ++c) scale = std::max(scale, std::abs(a[c]));
    for (int k = 0; k < pistons; ++k)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(a[at.Rs(k, axis)], b[at.Rs((k + 1) % pistons, axis)], scaled(1e-12) * scale);
    for (std::size_t c = at.Fh(); c <= at.Td(); ++c)
      EXPECT_NEAR(a[c], b[c], scaled(1e-12) * scale) << at.channels()[c].name;
  }
}

TEST(Properties, PressureForcesScaleWithPressureAndInertiaForcesWithSpeedSquared) {
  RandomPump random(5);
  for (int n = 0; n < 50; ++n) {
    PumpParameters pump = random.pump();
    pump.gravity = 0;
    pump.friction = {};
    pump.block.spring_force = 0;
    const Assumptions assumptions = random.assumptions(pump);
    Instant i = random.instant(pump, false);
    const Model model(pump, assumptions);
    const ChannelLayout& at = model.layout();
    std::vector<double> pressure_only(at.size());
    std::vector<double> doubled(at.size());
    Instant statics = i;
    statics.turn(i.shaft.angle, 0);
    model.evaluate(statics, pressure_only);
    for (double& p : statics.chamber_pressure) p *= 2;
    statics.ports.delivery *= 2;
    statics.ports.suction *= 2;
    model.evaluate(statics, doubled);
    for (std::size_t c = 0; c < at.reactions(); ++c)
      EXPECT_DOUBLE_EQ(2 * pressure_only[c], doubled[c]) << at.channels()[c].name;

    Instant inertia = i;
    for (double& p : inertia.chamber_pressure) p = 0;
    inertia.ports = {};
    std::vector<double> slow(at.size());
    std::vector<double> fast(at.size());
    model.evaluate(inertia, slow);
    PumpParameters spun = pump;
    if (spun.piston.real) spun.piston.real->spin *= 2;
    inertia.turn(i.shaft.angle, 2 * inertia.shaft.speed);
    Model(spun, assumptions).evaluate(inertia, fast);
    for (std::size_t c = 0; c < at.reactions(); ++c)
      EXPECT_DOUBLE_EQ(4 * slow[c], fast[c]) << at.channels()[c].name;
  }
}

TEST(Properties, AxialInertiasDoNotActAtConstantSpeed) {
  RandomPump random(6);
  PumpParameters pump = random.pump();
  const Instant i = random.instant(pump, false);
  const Model model(pump, random.assumptions(pump));
  std::vector<double> a(model.layout().size());
  std::vector<double> b(model.layout().size());
  model.evaluate(i, a);
  const Assumptions same = {true, pump.piston.inertia, BlockDrive::mesh};
  Model(pump, same).evaluate(i, a);
  pump.shaft.axial_inertia *= 10;
  pump.block.axial_inertia *= 10;
  Model(pump, same).evaluate(i, b);
  for (std::size_t c = 0; c < model.layout().reactions(); ++c) EXPECT_EQ(a[c], b[c]);
  // The control: with changing speed they do act.
  Instant changing = i;
  changing.turn(i.shaft.angle, i.shaft.speed, 100);
  std::vector<double> c(model.layout().size());
  Model(pump, same).evaluate(changing, c);
  EXPECT_NE(b[model.layout().Td()], c[model.layout().Td()]);
}

TEST(Properties, ImposedBlockSpeedTakesTheGearTorqueOffTheShaft) {
  RandomPump random(7);
  for (int n = 0; n < 50; ++n) {
    const PumpParameters pump = random.pump();
    Assumptions mesh = random.assumptions(pump);
    Assumptions imposed = mesh;
    imposed.gear = BlockDrive::imposed;
    const Instant i = random.instant(pump, true);
    const Model with_gear(pump, mesh);
    const ChannelLayout& at = with_gear.layout();
    std::vector<double> a(at.size());
    std::vector<double> b(at.size());
    with_gear.evaluate(i, a);
    Model(pump, imposed).evaluate(i, b);
    const double arm = pump.gear.pitch_diameter / 2 * std::cos(pump.gear.pressure_angle);
    const double scale = std::abs(a[at.Td()]) + std::abs(a[at.Tcs()]);
    EXPECT_FALSE(is_computed(b[at.Rcs()]));
    EXPECT_NEAR(b[at.Tcs()], (i.shaft.speed < 0 ? -1 : 1) * a[at.Rcs()] * arm,
                scaled(1e-13) * scale);
    EXPECT_NEAR(pump.friction.shaft_torque_factor * (a[at.Td()] - b[at.Td()]), b[at.Tcs()],
                scaled(1e-12) * scale);
  }
}

// Mean torque of a frictionless pump is displacement x pressure / 2 pi; a transition of w rad
// lowers it by about w^2/40. Midpoint sums of a smooth periodic function converge beyond any order;
// the step needs angles that share the edges.
TEST(Properties, MeanTorqueIsDisplacementTimesPressure) {
  Case the_case = reference_case("bap63_rated");
  the_case.pump.friction = {};
  the_case.pump.piston.mass = 0;
  the_case.pump.gravity = 0;
  the_case.operation.samples_per_revolution = 3600;
  const auto mean_torque = [&](double transition) {
    the_case.pressure.transition_deg = transition;
    const ResultTable t = analytic::run(the_case, the_case.analytic, one_turn(the_case));
    double sum = 0;
    for (std::size_t row = 0; row < t.rows(); ++row) sum += t.at(row, t.find("Td_z1_Nm"));
    return sum / static_cast<double>(t.rows());
  };
  const double displacement = analytic::derived_quantities(the_case.pump.geometry).displacement;
  const double ideal = displacement * 275e5 / (2 * kPi);
  EXPECT_NEAR(mean_torque(0) / ideal, 1, 1e-6);  // second-order error of the sum at the kinks
  const double w = radians(20);
  EXPECT_NEAR((1 - mean_torque(20) / ideal) / (w * w / 40), 1, 0.01);
}

// Kinematic ripple of the sinusoidal pump under a step pressure: odd N has order 2N first.
TEST(Properties, KinematicRippleHasTheTextbookOrders) {
  for (const int pistons : {3, 5, 7, 4, 6}) {
    PumpParameters p = plain_pump(pistons);
    p.geometry.bore_circle_radius =
        p.geometry.joint_circle_radius * (1 + std::cos(p.geometry.tilt)) / 2;
    const Model model(p, {});
    const ChannelLayout& at = model.layout();
    std::vector<double> v(at.size());
    const int steps = 27720 * 2;  // edges of every N fall between samples
    double mean = 0;
    std::vector<double> amplitude(3);  // of N, 2N, 3N
    std::vector<std::complex<double>> sum(3);
    Instant i = still(pistons);
    for (int s = 0; s < steps; ++s) {
      i.turn(2 * kPi * (s + 0.5) / steps, 0);
      for (int k = 0; k < pistons; ++k) {
        const double angle = std::fmod(i.shaft.angle - 2 * kPi * k / pistons + 4 * kPi, 2 * kPi);
        i.chamber_pressure[k] = angle > kPi ? 1e7 : 0;
      }
      model.reactions(i, v);
      mean += v[at.Td()] / steps;
      for (int m = 0; m < 3; ++m)
        sum[m] += v[at.Td()] * std::polar(2.0 / steps, -(m + 1.0) * pistons * i.shaft.angle);
    }
    const int first = pistons % 2 == 1 ? 2 * pistons : pistons;
    const double expected = 2.0 / (first * first - 1.0);
    EXPECT_NEAR(std::abs(sum[pistons % 2 == 1 ? 1 : 0]) / mean, expected, 1e-6) << pistons;
    if (pistons % 2 == 1) {
      EXPECT_LT(std::abs(sum[0]) / mean, 1e-6) << pistons;
      EXPECT_LT(std::abs(sum[2]) / mean, 1e-6) << pistons;
    }
  }
}

// ---- friction ----------------------------------------------------------------------------------

TEST(RingFriction, OpposesMotionAndRestsAtRest) {
  PumpParameters pump = reference_case("bap63_rated").pump;
  pump.friction.piston_coulomb = 25;
  pump.friction.piston_viscous = 10;
  const auto force = [&](double velocity, double omega) {
    analytic::closed_form::FrictionNumbers<double> numbers;
    const auto law =
        analytic::closed_form::prepare(analytic::closed_form::raw(pump), true, numbers);
    return analytic::closed_form::friction_force(law, numbers, velocity, omega);
  };
  pump.friction.regularization = 0.01;
  EXPECT_DOUBLE_EQ(force(0.01, 100), -(25 * std::tanh(1.0) + 0.1));
  EXPECT_DOUBLE_EQ(force(-0.01, -100), 25 * std::tanh(1.0) + 0.1);
  pump.friction.regularization = 0;
  const double rest = analytic::closed_form::kRestShare * 100 * pump.geometry.joint_circle_radius;
  for (const double omega : {100.0, -100.0}) {
    EXPECT_DOUBLE_EQ(force(1.01 * rest, omega), -(25 + 10.1 * rest));
    EXPECT_DOUBLE_EQ(force(-1.01 * rest, omega), 25 + 10.1 * rest);
    EXPECT_DOUBLE_EQ(force(0.99 * rest, omega), -9.9 * rest);
  }
  // The tests' own law agrees, on both sides of rest.
  for (const double regularization : {0.0, 0.01}) {
    pump.friction.regularization = regularization;
    for (const double v : {-2.0, -1e-3, -1.1 * rest, -0.9 * rest, 0.0, 0.9 * rest, 1.1 * rest, 0.5})
      EXPECT_DOUBLE_EQ(force(v, 100), ring_friction(pump.friction, v, rest)) << v;
  }
}

// ---- rounding ----------------------------------------------------------------------------------

// The estimate of rounding errors rests on evaluations that really are rounded otherwise: a
// compiler that moves them across the change of the mode, or evaluates them itself, gives zeros.
TEST(DirectedRounding, ReachesEveryReaction) {
  const Case the_case = reference_case("bap63_rated");
  const analytic::RoundingEstimate estimate(the_case.pump, the_case.analytic);
  const ResultTable table = analytic::run(the_case, the_case.analytic, one_turn(the_case));
  const Samples samples = one_turn(the_case);
  std::vector<double> largest(estimate.layout().reactions());
  analytic::RoundingEstimate::Parts parts;
  Instant instant;
  for (std::size_t row = 1; row < samples.theta_deg.size(); row += 7) {
    samples.instant(row, instant);
    estimate.estimate(instant, std::vector<double>(5), parts);
    for (std::size_t c = 0; c < largest.size(); ++c)
      largest[c] = std::max(largest[c], parts.arithmetic[c]);
  }
  for (std::size_t c = 0; c < largest.size(); ++c) {
    const Channel& channel = table.channels[c];
    const double peak = table.peak(channel.group) * channel.unit_in_si;
    EXPECT_GT(largest[c], 1e-18 * peak) << channel.name;
    EXPECT_LT(largest[c], 1e-12 * peak) << channel.name;
  }
}

// ---- kinematics --------------------------------------------------------------------------------

// Central differences of the positions must approach the derivatives with order 2.
TEST(Kinematics, DerivativesAreExact) {
  RandomPump random(8);
  for (int n = 0; n < 20; ++n) {
    const PumpParameters pump = random.pump();
    const analytic::Kinematics kinematics(pump.geometry);
    const double angle = random.in(0, 6);
    const auto ring = [&](double t) {
      return kinematics.piston(std::sin(t), std::cos(t)).ring().z();
    };
    const auto state = kinematics.piston(std::sin(angle), std::cos(angle));
    const double first = state.joint.first.z() + state.axis.first.z();
    const double second = state.joint.second.z() + state.axis.second.z();
    const auto errors = [&](double h) {
      return std::pair{
          std::abs((ring(angle + h) - ring(angle - h)) / (2 * h) - first),
          std::abs((ring(angle + h) - 2 * ring(angle) + ring(angle - h)) / (h * h) - second)};
    };
    const auto coarse = errors(2e-2);
    const auto fine = errors(1e-2);
    EXPECT_NEAR(std::log2(coarse.first / fine.first), 2, 0.1);
    EXPECT_NEAR(std::log2(coarse.second / fine.second), 2, 0.1);
    EXPECT_NEAR(state.axis.value.norm(), pump.geometry.piston_length, 1e-15);
  }
}

TEST(Kinematics, StrokeCountsInnerStationaryPoints) {
  RandomPump random(9);
  int inner = 0;
  for (int n = 0; n < 1000; ++n) {
    Geometry g = random.pump().geometry;
    g.axis_offset = random.in(-0.2, 0.2);
    if (assembly_margin(g).longest_distance > 0.999 * g.piston_length) continue;
    const analytic::Kinematics kinematics(g);
    double low = 1e9, least_tilt = 1e9;
    double high = -1e9, most_tilt = -1e9;
    for (int i = 0; i <= 5000; ++i) {
      const double t = kPi * i / 5000;
      const auto piston = kinematics.piston(std::sin(t), std::cos(t));
      const double z = piston.ring().z();
      low = std::min(low, z);
      high = std::max(high, z);
      const auto axis = piston.axis.value;
      const double tilt = std::atan2(std::hypot(axis.x(), axis.y()), std::abs(axis.z()));
      least_tilt = std::min(least_tilt, tilt);
      most_tilt = std::max(most_tilt, tilt);
    }
    const double ends =
        std::abs(kinematics.piston(0, 1).ring().z() - kinematics.piston(0, -1).ring().z());
    const auto derived = analytic::derived_quantities(g);
    const double stroke = derived.stroke;
    EXPECT_NEAR(stroke, high - low, 1e-6);
    EXPECT_NEAR(derived.smallest_tilt, least_tilt, 1e-3);  // may be 0, past which it rises
    EXPECT_NEAR(derived.largest_tilt, most_tilt, 1e-6);
    if (stroke > ends + 1e-6) ++inner;
  }
  EXPECT_GT(inner, 3);  // the sample contains what the test is about
}

TEST(Kinematics, S3IsOrthonormalWhereThePapersFormulaFails) {
  Geometry g;
  g = {5, 0, 0.03, 0.03, 0, 0.05, 0.02};  // zero tilt: k3_y = 0, (17) divides by it
  const analytic::Kinematics kinematics(g);
  const auto axes = kinematics.s3_in_s1(kinematics.piston(0, 1).axis.value);
  EXPECT_LT((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm(), 1e-15);
  EXPECT_NEAR(axes.determinant(), 1, 1e-15);
}

// Where q(u) is a straight line the tilt has its extremes at the ends of the turn: 2 Rd = Ra (1 +
// cos beta) to the last bit, which takes a cosine that ends in an even bit.
TEST(Derived, TiltsOfAPistonThatHasNoInnerExtreme) {
  Geometry g = reference_case("bap63_rated").pump.geometry;
  int seen = 0;
  for (int i = 0; i < 20; ++i) {
    g.tilt = 0.5 + 0.01 * i;
    g.joint_circle_radius = 1.0 / 32;
    g.bore_circle_radius = (1 + std::cos(g.tilt)) / 64;
    g.axis_offset = 0.002;
    const double difference = g.bore_circle_radius - g.joint_circle_radius;
    const double projected = g.bore_circle_radius - g.joint_circle_radius * std::cos(g.tilt);
    if (difference != -projected) continue;
    ++seen;
    const analytic::Kinematics kinematics(g);
    double smallest = 10, largest = 0;
    for (int k = 0; k <= 3600; ++k) {
      const double t = 2 * kPi * k / 3600;
      const auto axis = kinematics.piston(std::sin(t), std::cos(t)).axis.value;
      const double tilt = std::atan2(std::hypot(axis.x(), axis.y()), std::abs(axis.z()));
      smallest = std::min(smallest, tilt);
      largest = std::max(largest, tilt);
    }
    const auto derived = analytic::derived_quantities(g);
    EXPECT_NEAR(derived.smallest_tilt, smallest, 1e-12);
    EXPECT_NEAR(derived.largest_tilt, largest, 1e-12);
  }
  EXPECT_GT(seen, 3);
}

TEST(Facts, EquationsAreCounted) {
  Case the_case = reference_case("bap63_rated");
  the_case.operation.samples_per_revolution = 4;
  the_case.pump.geometry.pistons = 7;
  const ResultTable table = analytic::run(the_case, the_case.analytic, one_turn(the_case));
  EXPECT_THAT(table.provenance.facts,
              testing::Contains(testing::Pair(
                  "equations", "47 (5 per piston, 6 block, 6 shaft), solved body by body")));
}

TEST(Validity, ShareIsOfTheAnglesThatAreComputed) {
  Case the_case = reference_case("bap63_rated");
  the_case.operation.samples_per_revolution = 12;
  const Samples samples = one_turn(the_case);
  ResultTable table = analytic::run(the_case, the_case.analytic, samples);
  const std::size_t column = table.find("Rcs_z4_N");
  const auto set = [&](std::size_t row, double value) {
    table.values[row * table.columns() + column] = value;
  };
  for (std::size_t row = 0; row < 12; ++row) set(row, 10);
  set(4, -2);
  set(5, -3);
  set(6, 0);
  set(7, not_computed());
  set(8, not_computed());
  const auto flank = [&] {
    return analytic::check_validity(the_case, the_case.analytic, samples, table).at(0);
  };
  EXPECT_EQ(flank().name, "Rcs < 0");
  EXPECT_DOUBLE_EQ(flank().violated_share, 0.2);
  EXPECT_EQ(flank().worst, -3);
  EXPECT_DOUBLE_EQ(flank().theta_deg, 150);
  EXPECT_DOUBLE_EQ(analytic::share_beyond({flank()}), 0.2);
  // With both flanks modelled nothing is beyond the model.
  the_case.pump.gear.flanks = Flanks::two;
  EXPECT_TRUE(flank().applicable);
  EXPECT_EQ(flank().violated_share, 0);
  EXPECT_EQ(analytic::share_beyond({flank()}), 0);
  EXPECT_EQ(flank().worst, -3);
  EXPECT_NE(flank().consequence.find("negative over 20 % of the turn"), std::string::npos)
      << flank().consequence;
  the_case.pump.gear.flanks = Flanks::one;
  for (std::size_t row = 0; row < 12; ++row) set(row, not_computed());
  EXPECT_FALSE(flank().applicable);
}

// BAP 63: the figures the paper prints.
TEST(Derived, DefaultPumpIsABap63) {
  const Case the_case = reference_case("bap63_rated");
  const auto d = analytic::derived_quantities(the_case.pump.geometry);
  EXPECT_NEAR(d.displacement * 1e6, 63.7, 0.05);
  EXPECT_NEAR(d.displacement * 1500e3, 95.6, 0.05);
  EXPECT_NEAR(d.displacement * 275e5 / (2 * kPi), 278.8, 0.1);
}

// Each part of the block's motion counts on its own; its values are held in motion_test.
TEST(OneCallAtAnInstant, TakesABlockThatMovesOnItsOwn) {
  const Case the_case = reference_case("bap63_rated");
  const Model model(the_case.pump, the_case.analytic);
  const ChannelLayout& at = model.layout();
  std::vector<double> locked(at.size());
  model.evaluate(still(5, 1e7), locked);
  EXPECT_TRUE(is_computed(locked[at.power_residual()]));
  for (const auto part : {&AxisMotion::angle, &AxisMotion::speed, &AxisMotion::acceleration}) {
    Instant i = still(5, 1e7);
    EXPECT_TRUE(i.locked());
    i.block.*part += 1e-3;
    EXPECT_FALSE(i.locked());
    std::vector<double> values(at.size());
    model.evaluate(i, values);
    EXPECT_NE(values[at.Rcs()], locked[at.Rcs()]);
    // Work per radian of a shaft at rest.
    EXPECT_FALSE(is_computed(values[at.power_residual()]));
  }
  Instant i = still(5, 1e7);
  i.block.speed = 2;
  const Model::FrictionPower power = model.friction_power(i, 100);
  EXPECT_DOUBLE_EQ(power.block, -4 * the_case.pump.friction.block_viscous);
  EXPECT_EQ(power.shaft_viscous, 0);
}

TEST(OneCallAtAnInstant, DoesNotNeedARowPerCall) {
  // The same buffers serve every call: nothing is left over from the call before.
  const Case the_case = reference_case("bap63_rated");
  const Model model(the_case.pump, the_case.analytic);
  std::vector<double> first(model.layout().size());
  std::vector<double> again(model.layout().size(), 12345.0);
  Instant a;
  a.turn(1, 100);
  a.chamber_pressure.assign(5, 1e6);
  model.evaluate(a, first);
  Instant b = a;
  b.turn(4, 100);
  model.evaluate(b, again);
  model.evaluate(a, again);
  EXPECT_EQ(first, again);
}

}  // namespace
}  // namespace bentaxis::test
