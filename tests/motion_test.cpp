// The closed form for a block that moves on its own: high-precision instants, a second formulation,
// derivatives against differences, and what must hold for any motion.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>

#include "bentaxis/analytic/batch.h"
#include "bentaxis/analytic/budget.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/rounding.h"
#include "bentaxis/analytic/validity.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "closed_form/gear.h"
#include "closed_form/piston.h"
#include "free_bodies.h"
#include "printed_model.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using namespace analytic;

std::filesystem::path motion_folder() {
  return std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "motion";
}

std::vector<double> evaluate(const Model& model, const Instant& instant,
                             MotionChecks* checks = nullptr) {
  std::vector<double> values(model.layout().size());
  model.evaluate(instant, values, checks);
  return values;
}

double largest_of(const std::vector<double>& values, std::size_t count) {
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, std::abs(values[i]));
  return largest;
}

// ---- high-precision instants -------------------------------------------------------------------

class ReferenceInstants : public testing::TestWithParam<const char*> {
 protected:
  ReferenceInstants()
      : folder_(motion_folder() / GetParam()),
        case_(read_case(folder_ / "case.toml")),
        states_(read_states(folder_ / "states.csv", case_, PressureTrace(case_.pressure))),
        reference_(read_numeric_csv(folder_ / "reference.csv")) {}

  double peak(const ResultTable& table, std::size_t column) const {
    return table.peak(table.channels[column].group);
  }
  /// Column of the reference of a reaction.
  std::size_t place(const std::string& name) const {
    return static_cast<std::size_t>(
        std::find(reference_.header.begin(), reference_.header.end(), name) -
        reference_.header.begin());
  }

  std::filesystem::path folder_;
  Case case_;
  States states_;
  NumericTable reference_;
};

// Required is 1e-12; rounding of the inputs and some 300 operations.
constexpr double kReferenceTolerance = 1e-13;

TEST_P(ReferenceInstants, EveryReactionIsRightToRoundOff) {
  const MotionTable table = run_states(case_, case_.analytic, states_);
  ASSERT_EQ(table.results.rows(), reference_.rows.size());
  ASSERT_EQ(table.results.rows(), 12U);
  const ChannelLayout layout(case_.pump.geometry.pistons);
  for (std::size_t c = 0; c < layout.reactions(); ++c) {
    const std::string& name = layout.channels()[c].name;
    ASSERT_LT(place(name), reference_.header.size()) << name;
    for (std::size_t row = 0; row < table.results.rows(); ++row)
      ASSERT_NEAR(reference_.rows[row][place(name)], table.results.at(row, c),
                  scaled(kReferenceTolerance) * peak(table.results, c))
          << name << ", state " << row + 1;
  }
}

// Power of a row whose parts are of the order of Td omega.
TEST_P(ReferenceInstants, PowerBalancesAndTheRingDoesWork) {
  const MotionTable table = run_states(case_, case_.analytic, states_);
  const ResultTable& r = table.results;
  const std::size_t ring = r.find("ring_power_W");
  const std::size_t balance = r.find("power_balance_W");
  double largest_ring = 0;
  for (std::size_t row = 0; row < r.rows(); ++row) {
    EXPECT_LT(std::abs(r.at(row, balance)), scaled(1e-8)) << row;
    EXPECT_NEAR(r.at(row, r.find("power_residual_Nm")) * states_.motion[row].shaft_speed,
                r.at(row, balance), 1e-15);
    EXPECT_FALSE(is_computed(r.at(row, r.find("Rcs_law_N"))));  // rigid teeth
    largest_ring = std::max(largest_ring, std::abs(r.at(row, ring)));
  }
  EXPECT_GT(largest_ring, 1);
}

TEST_P(ReferenceInstants, BatchesAreRightOnEveryInstructionSet) {
  const std::size_t n = states_.rows();
  std::array<std::vector<double>, 6> motion;
  std::vector<std::vector<double>> pressure(case_.pump.geometry.pistons);
  Instant instant;
  for (std::size_t row = 0; row < n; ++row) {
    states_.instant(row, instant);
    const double values[] = {instant.shaft.angle, instant.shaft.speed, instant.shaft.acceleration,
                             instant.block.angle, instant.block.speed, instant.block.acceleration};
    for (std::size_t i = 0; i < motion.size(); ++i) motion[i].push_back(values[i]);
    for (std::size_t k = 0; k < pressure.size(); ++k)
      pressure[k].push_back(instant.chamber_pressure[k]);
  }
  std::vector<Varying> chamber;
  for (const auto& column : pressure) chamber.push_back({column.data(), 0});
  const BatchInstants instants = {
      n,
      {motion[0].data(), 0},
      {motion[1].data(), 0},
      {motion[2].data(), 0},
      chamber,
      {nullptr, instant.ports.suction},
      {nullptr, instant.ports.delivery},
      BlockMotion{{motion[3].data(), 0}, {motion[4].data(), 0}, {motion[5].data(), 0}}};
  const MotionTable table = run_states(case_, case_.analytic, states_);
  const BatchModel one(case_.pump, case_.analytic);
  const PumpBatch many(std::vector<PumpParameters>(n, case_.pump), case_.analytic);
  BatchColumns columns(one.layout().reactions(), n);
  const BatchOutputs outputs = outputs_of(one.layout(), ChannelGroup::all, columns);
  for (const InstructionSet set : available_instruction_sets())
    for (const bool pumps : {false, true}) {
      if (pumps)
        many.reactions(instants, outputs, {set, 1});
      else
        one.reactions(instants, outputs, {set, 1});
      for (std::size_t c = 0; c < one.layout().reactions(); ++c) {
        const std::size_t at = place(one.layout().channels()[c].name);
        for (std::size_t row = 0; row < n; ++row)
          ASSERT_NEAR(reference_.rows[row][at], columns.column(c)[row],
                      scaled(kReferenceTolerance) * peak(table.results, c))
              << reference_.header[at] << ", state " << row + 1 << ", " << to_string(set);
      }
    }
}

TEST_P(ReferenceInstants, ExtendedPrecisionAgreesToItsRounding) {
  const Model model(case_.pump, case_.analytic);
  std::vector<double> values(model.layout().size());
  std::vector<long double> wide(model.layout().reactions());
  Instant instant;
  double worst = 0;
  for (std::size_t row = 0; row < states_.rows(); ++row) {
    states_.instant(row, instant);
    model.reactions(instant, values);
    model.reactions(instant, wide);
    for (std::size_t c = 0; c < wide.size(); ++c)
      worst = std::max(worst, static_cast<double>(std::abs(wide[c] - values[c])) /
                                  largest_of(values, wide.size()));
  }
  EXPECT_LT(worst, scaled(1e-14));
  EXPECT_GT(worst, 0);
}

INSTANTIATE_TEST_SUITE_P(Cases, ReferenceInstants,
                         testing::Values("free_block", "free_block_seven"),
                         [](const auto& test) { return test.param; });

// ---- random pumps ------------------------------------------------------------------------------

constexpr int kPumps = 500;
// Far enough that nothing can be taken for small; every pump of RandomPump reaches it.
constexpr double kLead = 0.1;

// A pump, and an instant at which its block moves on its own.
struct Drawn {
  explicit Drawn(unsigned seed)
      : random(seed),
        pump(random.free(random.pump())),
        assumptions(random.assumptions(pump)),
        instant(random.free_instant(pump, kLead)),
        model(pump, assumptions) {}
  RandomPump random;
  PumpParameters pump;
  Assumptions assumptions;
  Instant instant;
  Model model;
};

void for_each_pump(const std::function<void(const Drawn&)>& look) {
  for (unsigned seed = 0; seed < kPumps; ++seed) {
    SCOPED_TRACE("pump " + std::to_string(seed));
    look(Drawn(seed));
    if (testing::Test::HasFatalFailure()) return;
  }
}

// As in analytic_test: bearings close together amplify.
constexpr double kTwinTolerance = 2e-11;

TEST(FreeMotion, AgreesWithThePrintedEquationsOnRandomPumps) {
  for_each_pump([](const Drawn& d) {
    const std::vector<double> values = evaluate(d.model, d.instant);
    const std::vector<double> twin = PrintedModel(d.pump, d.assumptions).reactions(d.instant);
    const double largest = largest_of(twin, twin.size());
    for (std::size_t c = 0; c < twin.size(); ++c)
      ASSERT_NEAR(values[c], twin[c], scaled(kTwinTolerance) * largest)
          << d.model.layout().channels()[c].name;
  });
}

TEST(FreeMotion, FreeBodiesBalance) {
  for_each_pump([](const Drawn& d) {
    const std::vector<double> values = evaluate(d.model, d.instant);
    ASSERT_LT(free_body_residual(d.pump, d.assumptions, d.instant, values), scaled(1e-12));
  });
}

// What the power balance is a small difference of.
double power_scale(const Drawn& d, const std::vector<double>& values) {
  const double speed = std::max(std::abs(d.instant.shaft.speed), std::abs(d.instant.block.speed));
  const double radius = d.pump.geometry.joint_circle_radius + d.pump.geometry.piston_length +
                        d.pump.gear.pitch_diameter;
  return d.pump.geometry.pistons * speed * radius *
         largest_of(values, d.model.layout().reactions());
}

TEST(FreeMotion, PowerBalancesAtEveryInstant) {
  for_each_pump([](const Drawn& d) {
    MotionChecks checks;
    const std::vector<double> values = evaluate(d.model, d.instant, &checks);
    ASSERT_LT(std::abs(checks.power_balance), scaled(1e-13) * power_scale(d, values));
    if (!d.pump.piston.contact) {
      ASSERT_EQ(checks.ring_power, 0);
    }
    const ChannelLayout& at = d.model.layout();
    for (int k = 0; k < at.pistons(); ++k)
      ASSERT_LT(std::abs(values[at.axis_moment(k)]),
                scaled(1e-13) * largest_of(values, at.reactions()));
  });
}

// The same with the block's speed imposed: what imposes it brings in power of its own.
TEST(FreeMotion, PowerBalancesWhereTheBlockIsImposed) {
  for_each_pump([](const Drawn& d) {
    const Model model(d.pump,
                      {d.assumptions.piston_friction, d.assumptions.inertia, BlockDrive::imposed});
    MotionChecks checks;
    std::vector<double> values = evaluate(model, d.instant, &checks);
    ASSERT_FALSE(is_computed(values[model.layout().Rcs()]));
    values[model.layout().Rcs()] = 0;
    ASSERT_LT(std::abs(checks.power_balance), scaled(1e-13) * power_scale(d, values));
  });
}

// Locked motion through the algebra of a free block: the smallest acceleration there is sets it
// free.
TEST(FreeMotion, LockedIsItsLimit) {
  for_each_pump([](const Drawn& d) {
    Instant locked = d.instant;
    locked.block = locked.shaft;
    Instant free = locked;
    free.block.acceleration = std::nextafter(free.block.acceleration, 1e9);
    ASSERT_FALSE(free.locked());
    MotionChecks checks_of_locked;
    MotionChecks checks_of_free;
    const std::vector<double> a = evaluate(d.model, locked, &checks_of_locked);
    const std::vector<double> b = evaluate(d.model, free, &checks_of_free);
    for (std::size_t c = 0; c < d.model.layout().reactions(); ++c)
      ASSERT_NEAR(a[c], b[c], scaled(1e-13) * largest_of(a, d.model.layout().reactions()))
          << d.model.layout().channels()[c].name;
    ASSERT_NEAR(checks_of_locked.ring_power, checks_of_free.ring_power,
                scaled(1e-13) * power_scale(d, a));
  });
}

// With one flank; with two all but what the separating part of the tooth force reaches.
TEST(FreeMotion, ReactionsAreAffineInTheAccelerations) {
  for_each_pump([](const Drawn& d) {
    PumpParameters pump = d.pump;
    pump.gear.flanks = Flanks::one;
    const Model model(pump, d.assumptions);
    const auto at = [&](double shaft, double block) {
      Instant instant = d.instant;
      instant.shaft.acceleration = shaft;
      instant.block.acceleration = block;
      return evaluate(model, instant);
    };
    const auto none = at(0, 0);
    const auto shaft = at(1000, 0);
    const auto block = at(0, 1000);
    const auto both = at(3000, -2000);
    const double largest = largest_of(both, model.layout().reactions());
    for (std::size_t c = 0; c < model.layout().reactions(); ++c)
      ASSERT_NEAR(both[c], none[c] + 3 * (shaft[c] - none[c]) - 2 * (block[c] - none[c]),
                  scaled(1e-12) * largest)
          << model.layout().channels()[c].name;
  });
}

// The mirror image runs backwards: x turns round, and with it the torques about z.
TEST(FreeMotion, BackwardsIsTheMirrorImage) {
  for_each_pump([](const Drawn& d) {
    PumpParameters pump = d.pump;
    pump.gear.flanks = Flanks::two;  // one flank keeps its line, and its sign(omega) turns it whole
    if (pump.piston.real) pump.piston.real->spin = 0;
    const Model model(pump, d.assumptions);
    Instant mirrored = d.instant;
    for (AxisMotion* m : {&mirrored.shaft, &mirrored.block})
      *m = {-m->angle, -m->speed, -m->acceleration};
    const int n = pump.geometry.pistons;
    for (int k = 0; k < n; ++k)
      mirrored.chamber_pressure[(n - k) % n] = d.instant.chamber_pressure[k];
    mirrored.ports = {0, 0};  // the arcs of a plate need not be symmetric
    Instant there = d.instant;
    there.ports = {0, 0};
    const auto a = evaluate(model, there);
    const auto b = evaluate(model, mirrored);
    const ChannelLayout& at = model.layout();
    const double largest = largest_of(a, at.reactions());
    const auto expect = [&](std::size_t i, std::size_t j, double sign) {
      ASSERT_NEAR(b[j], sign * a[i], scaled(1e-11) * largest) << at.channels()[i].name;
    };
    for (int k = 0; k < n; ++k) {
      expect(at.Rs(k, 0), at.Rs((n - k) % n, 0), -1);
      expect(at.Rs(k, 2), at.Rs((n - k) % n, 2), 1);
      expect(at.Rc(k, 1), at.Rc((n - k) % n, 1), 1);
    }
    expect(at.Fh(), at.Fh(), 1);
    expect(at.Rcn(0), at.Rcn(0), -1);
    expect(at.Rcn(1), at.Rcn(1), 1);
    if (d.instant.shaft.speed != 0) expect(at.Rcs(), at.Rcs(), 1);
    expect(at.Rb1(1), at.Rb1(1), 1);
    expect(at.Td(), at.Td(), -1);
  });
}

// ---- kinematics --------------------------------------------------------------------------------

// Positions along theta(t), psi(t) that are parabolas, differenced in extended precision.
TEST(FreeMotion, DerivativesAreThoseOfThePositions) {
  using Real = long double;
  constexpr Real kStep = 1e-4L;
  RandomPump random(7);
  for (int i = 0; i < 200; ++i) {
    const PumpParameters pump = random.pump();
    closed_form::FrameNumbers<double> frame_in_double;
    closed_form::PistonNumbers<double> piston_in_double{};
    const auto geometry = closed_form::raw(pump.geometry);
    closed_form::prepare(geometry, frame_in_double);
    closed_form::prepare(geometry, frame_in_double, piston_in_double);
    const closed_form::FrameNumbers<Real> frame = {
        frame_in_double.sin_tilt, frame_in_double.cos_tilt, frame_in_double.offset_y,
        frame_in_double.offset_z};
    closed_form::PistonNumbers<Real> piston{};
    piston.joint_radius = piston_in_double.joint_radius;
    piston.joint_y = piston_in_double.joint_y;
    piston.joint_z = piston_in_double.joint_z;
    piston.difference = piston_in_double.difference;
    piston.projected = piston_in_double.projected;
    piston.length_squared = piston_in_double.length_squared;
    piston.bore_radius = piston_in_double.bore_radius;
    const Real theta = random.in(-4, 7);
    const Real lead = random.in(-0.1, 0.1);
    const Real w[] = {random.in(-3, 3), random.in(-9, 9)};  // of theta: speed, acceleration
    const Real v[] = {random.in(-3, 3), random.in(-9, 9)};  // of psi
    const auto at = [&](Real time) {
      closed_form::FreeState<Real> t;
      const Real now = theta + w[0] * time + w[1] * time * time / 2;
      const Real psi = theta + lead + v[0] * time + v[1] * time * time / 2;
      t.sine = std::sin(now);
      t.cosine = std::cos(now);
      t.omega = w[0] + w[1] * time;
      t.omega_dot = w[1];
      t.lead(std::sin((psi - now) / 2), std::cos((psi - now) / 2));
      t.block_omega = v[0] + v[1] * time;
      t.block_omega_dot = v[1];
      return closed_form::piston_motion(frame, piston, t, t.sine, t.cosine);
    };
    // Where the bore is: on its circle at psi.
    const auto here = at(0);
    EXPECT_NEAR(static_cast<double>(here.joint.x + here.axis.x),
                static_cast<double>(-pump.geometry.bore_circle_radius * std::sin(theta + lead)),
                1e-17);
    EXPECT_NEAR(static_cast<double>(here.joint.y + here.axis.y),
                static_cast<double>(pump.geometry.bore_circle_radius * std::cos(theta + lead)),
                1e-17);
    // Differences of the fourth order; errors kStep^4 of the sixth derivative.
    const auto far_before = at(-2 * kStep);
    const auto before = at(-kStep);
    const auto after = at(kStep);
    const auto far_after = at(2 * kStep);
    const auto check = [&](const auto& value, Real first, Real second, const char* what) {
      const Real slope =
          (8 * (value(after) - value(before)) - value(far_after) + value(far_before)) /
          (12 * kStep);
      const Real bend = (16 * (value(after) + value(before)) - value(far_after) -
                         value(far_before) - 30 * value(here)) /
                        (12 * kStep * kStep);
      EXPECT_NEAR(static_cast<double>(first), static_cast<double>(slope), 1e-12) << what;
      EXPECT_NEAR(static_cast<double>(second), static_cast<double>(bend), 1e-10) << what;
    };
    check([](const auto& m) { return m.joint.x; }, here.joint_first.x, here.joint_second.x, "A x");
    check([](const auto& m) { return m.joint.y; }, here.joint_first.y, here.joint_second.y, "A y");
    check([](const auto& m) { return m.joint.z; }, here.joint_first.z, here.joint_second.z, "A z");
    check([](const auto& m) { return m.axis.x; }, here.axis_first.x, here.axis_second.x, "AB x");
    check([](const auto& m) { return m.axis.y; }, here.axis_first.y, here.axis_second.y, "AB y");
    check([](const auto& m) { return m.axis.z; }, here.axis_first.z, here.axis_second.z, "AB z");
    if (HasFailure()) return;
  }
}

// ---- hard states -------------------------------------------------------------------------------

TEST(HardStates, ARowNeedsAMotionAndAPressureForEachPiston) {
  States states;
  states.pistons = 5;
  states.motion.resize(2);
  states.chamber_pressure = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  Instant instant;
  states.instant(0, instant);
  EXPECT_EQ(instant.chamber_pressure, (std::vector<double>{1, 2, 3, 4, 5}));
  EXPECT_THROW(states.instant(1, instant), InputError);
  states.chamber_pressure.resize(20);
  EXPECT_NO_THROW(states.instant(1, instant));
  EXPECT_THROW(states.instant(2, instant), InputError);
}

// The state is named that has no finite value; what is not computed has none by right.
TEST(HardStates, WhatIsNotFiniteIsNamedWithItsState) {
  States states;
  states.pistons = 1;
  states.motion.resize(3);
  states.chamber_pressure.assign(3, 1e7);
  const ChannelLayout layout(1);
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    int calls = 0;
    const auto evaluate = [&](const Instant&, std::vector<double>& row, MotionChecks&) {
      row.assign(row.size(), ++calls == 2 ? bad : not_computed());
    };
    try {
      tabulate_states("analytic", layout, states, evaluate, {});
      ADD_FAILURE() << "accepted " << bad;
    } catch (const ComputationError& error) {
      EXPECT_STREQ(error.what(), "analytic model: Rs_1_x2_N is not finite in state 2");
    }
  }
}

TEST(HardStates, PressuresOfAFileAreThoseOfTheirPistons) {
  const Case the_case = read_case(motion_folder() / "free_block" / "case.toml");
  const auto file = std::filesystem::temp_directory_path() /
                    ("bentaxis_states_" + std::to_string(::getpid()) + ".csv");
  std::ofstream(file) << "theta_deg,psi_deg,theta_rpm,psi_rpm,theta_rad_per_s2,psi_rad_per_s2,"
                         "p_5_bar,p_1_bar,p_2_bar,p_3_bar,p_4_bar\n"
                         "10,10,1500,1500,0,0,50,10,20,30,40\n";
  const States states = read_states(file, the_case, PressureTrace(the_case.pressure));
  std::filesystem::remove(file);
  EXPECT_EQ(states.chamber_pressure, (std::vector<double>{10e5, 20e5, 30e5, 40e5, 50e5}));
}

TEST(HardStates, AnglesOfManyTurnsAreThoseOfOne) {
  const Case the_case = read_case(motion_folder() / "free_block" / "case.toml");
  States states;
  states.pistons = 5;
  for (const double turns : {0.0, 1e7, -1e7})
    states.motion.push_back(
        {10 + 360 * turns, 9.5 + 360 * turns, 150, 149, 20, -30, the_case.pressure.ports});
  states.chamber_pressure.assign(15, 1e7);
  const ResultTable table = run_states(the_case, the_case.analytic, states).results;
  for (std::size_t c = 0; c < ChannelLayout(5).reactions(); ++c)
    for (const std::size_t row : {1, 2})
      ASSERT_NEAR(table.at(row, c), table.at(0, c), 1e-12 * table.peak(table.channels[c].group))
          << table.channels[c].name;  // -350 deg is not 10 deg to the last bit
}

// One of both at rest, or both: dry friction has no speed of its own to compare with.
TEST(HardStates, ShaftOrBlockAtRest) {
  for_each_pump([](const Drawn& d) {
    for (const double regularization : {0.0, d.pump.friction.regularization})
      for (const int who : {0, 1, 2}) {
        PumpParameters pump = d.pump;
        pump.friction.regularization = regularization;
        Instant i = d.instant;
        if (who != 1) i.shaft.speed = 0;
        if (who != 0) i.block.speed = 0;
        const Model model(pump, d.assumptions);
        MotionChecks checks;
        const std::vector<double> values = evaluate(model, i, &checks);
        for (std::size_t c = 0; c < model.layout().reactions(); ++c)
          ASSERT_TRUE(std::isfinite(values[c])) << model.layout().channels()[c].name;
        ASSERT_EQ(is_computed(values[model.layout().power_residual()]), who == 1);
        ASSERT_LT(std::abs(checks.power_balance), scaled(1e-13) * power_scale(d, values));
        if (who == 2) {
          ASSERT_EQ(checks.power_balance, 0);
        }
        ASSERT_LT(free_body_residual(pump, d.assumptions, i, values), scaled(1e-12));
      }
  });
}

// Where the lead has all but taken a piston out of its reach digits go, as many as are foretold.
TEST(HardStates, LostDigitsNextToTheLimitOfAssemblyAreForetold) {
  const Case the_case = read_case(motion_folder() / "free_block" / "case.toml");
  const Geometry& g = the_case.pump.geometry;
  const auto farthest = [&](double lead) {
    double most = 0;
    for (int k = 0; k < g.pistons; ++k) {
      const double angle = 0.2 - 2 * kPi * k / g.pistons;
      most = std::max(most, joint_distance(g, angle, angle + lead));
    }
    return most;
  };
  double within = 0;
  double beyond = kPi;
  ASSERT_GT(farthest(beyond), g.piston_length);
  while (farthest(within) < g.piston_length * (1 - 1e-10)) {
    const double middle = (within + beyond) / 2;
    (farthest(middle) < g.piston_length * (1 - 1e-10 / 2) ? within : beyond) = middle;
  }
  Instant i;
  i.shaft = {0.2, 150, 20};
  i.block = {0.2 + within, 149, -30};
  i.chamber_pressure.assign(5, 1e7);
  const Model model(the_case.pump, the_case.analytic);
  std::vector<double> values(model.layout().size());
  std::vector<long double> wide(model.layout().reactions());
  model.reactions(i, values);
  model.reactions(i, wide);
  RoundingEstimate::Parts parts;
  RoundingEstimate(the_case.pump, the_case.analytic)
      .estimate(i, std::vector<double>(5, 1e-9), parts);
  bool of_the_angles = false;
  double worst = 0;
  for (std::size_t c = 0; c < wide.size(); ++c) {
    const double lost = static_cast<double>(std::abs(wide[c] - values[c]));
    worst = std::max(worst, lost / largest_of(values, wide.size()));
    // A prediction is one of the first order, of an error that is partly luck.
    ASSERT_LE(lost, 100 * (parts.inputs[c] + parts.arithmetic[c]));
    of_the_angles |= parts.worst_input[c] == "psi" || parts.worst_input[c] == "theta";
  }
  EXPECT_TRUE(of_the_angles);
  EXPECT_GT(worst, 1e-12);  // the case is as hard as it says
}

// ---- teeth -------------------------------------------------------------------------------------

TEST(ToothLaw, IsThePrintedOneOnEitherFlank) {
  Gear gear;
  gear.pitch_diameter = 0.1;
  gear.pressure_angle = radians(20);
  gear.contact = ToothContact::compliant;
  gear.flanks = Flanks::two;
  gear.compliance = ToothCompliance{100e6, 1.5, 0.2, 20e-6};  // 100 N at 1 um
  const closed_form::ToothLaw law = *closed_form::tooth_law(gear);
  const double arm = 0.05 * std::cos(radians(20));
  EXPECT_DOUBLE_EQ(law.arm, arm);
  const double touch = 10e-6 / arm;  // of the lag
  EXPECT_EQ(law.force(0, 5), 0);
  EXPECT_EQ(law.force(0.999 * touch, 100), 0);
  EXPECT_EQ(law.force(-0.999 * touch, -100), 0);
  // 4 um of approach: 100 * 4^1.5.
  const double lag = 14e-6 / arm;
  EXPECT_NEAR(law.force(lag, 0), 800, 1e-9);
  EXPECT_NEAR(law.force(-lag, 0), -800, 1e-9);
  EXPECT_NEAR(law.force(lag, 1 / arm), 800 * 1.2, 1e-9);     // approaching at 1 m/s
  EXPECT_NEAR(law.force(-lag, -1 / arm), -800 * 1.2, 1e-9);  // and on the other flank
  EXPECT_NEAR(law.force(lag, -1 / arm), 800 * 0.8, 1e-9);
  EXPECT_EQ(law.force(lag, -6 / arm), 0);  // never pulls
  gear.compliance->backlash = 0;
  EXPECT_EQ(closed_form::tooth_law(gear)->force(0, 1), 0);
  gear.compliance.reset();
  EXPECT_FALSE(closed_form::tooth_law(gear).has_value());
}

TEST(ToothLaw, IsAColumnBesideTheBalance) {
  Drawn d(3);
  d.pump.gear.contact = ToothContact::compliant;
  d.pump.gear.flanks = Flanks::two;
  d.pump.gear.compliance = ToothCompliance{200e6, 1, 0.05, 0};
  const Model model(d.pump, d.assumptions);
  MotionChecks checks;
  Instant i = d.instant;
  i.block = {i.shaft.angle - 1e-5, i.shaft.speed - 0.1, i.shaft.acceleration};
  evaluate(model, i, &checks);
  const double arm = d.pump.gear.pitch_diameter / 2 * std::cos(d.pump.gear.pressure_angle);
  const double expected = 200e6 * arm * 1e-5 * (1 + 0.05 * arm * 0.1);
  EXPECT_NEAR(checks.tooth_law, expected, 1e-9 * expected);
}

// The separating part pushes the gears apart whichever flank carries: the pin feels the difference,
// the block's torque and the drive do not.
TEST(TwoFlanks, DifferFromOneWhereTheForceIsNegativeOnly) {
  int negative = 0;
  int positive = 0;
  for_each_pump([&](const Drawn& d) {
    PumpParameters one = d.pump;
    one.gear.flanks = Flanks::one;
    PumpParameters two = d.pump;
    two.gear.flanks = Flanks::two;
    const Model first(one, d.assumptions);
    const auto a = evaluate(first, d.instant);
    const auto b = evaluate(Model(two, d.assumptions), d.instant);
    const ChannelLayout& at = first.layout();
    ASSERT_EQ(a[at.Rcs()], b[at.Rcs()]);
    ASSERT_EQ(a[at.Td()], b[at.Td()]);
    ASSERT_EQ(a[at.Rb1(0)], b[at.Rb1(0)]);
    const double towards_psi = (d.instant.shaft.speed < 0 ? -1 : 1) * a[at.Rcs()];
    (towards_psi < 0 ? negative : positive) += 1;
    const Model::FlankChange change = first.flank_change(a[at.Rcs()], d.instant.shaft.speed);
    if (towards_psi >= 0) {
      ASSERT_EQ(change.pin + change.film + change.tapered + change.cylindrical, 0);
      for (std::size_t c = 0; c < at.reactions(); ++c) ASSERT_EQ(a[c], b[c]);
      return;
    }
    const double half = d.pump.geometry.tilt / 2;
    const double turned = -2 * towards_psi * std::sin(d.pump.gear.pressure_angle);
    // y2 of the separating part, (0, -sin, cos) of alpha/2, moved from the pin to the gear.
    ASSERT_NEAR(b[at.Rcn(1)] - a[at.Rcn(1)], turned * std::sin(half),
                1e-12 * largest_of(a, at.reactions()));
    ASSERT_NEAR(b[at.Fh()] - a[at.Fh()], -turned * std::cos(half),
                1e-12 * largest_of(a, at.reactions()));
    // What validity says of it.
    const auto apart = [&](std::size_t first_column, int components) {
      double sum = 0;
      for (int i = 0; i < components; ++i)
        sum += std::pow(b[first_column + i] - a[first_column + i], 2);
      return std::sqrt(sum);
    };
    const double off = 1e-12 * largest_of(a, at.reactions());
    ASSERT_NEAR(change.pin, apart(at.Rcn(0), 2), off);
    ASSERT_NEAR(change.film, apart(at.Fh(), 1), off);
    ASSERT_NEAR(change.tapered, apart(at.Rb1(0), 3), off);
    ASSERT_NEAR(change.cylindrical, apart(at.Rb2(0), 2), off);
  });
  EXPECT_GT(negative, kPumps / 4);
  EXPECT_GT(positive, kPumps / 4);
}

// The figure that validity gives is the largest difference over the turn, whichever of the two was
// run and whichever way the pump turns.
TEST(TwoFlanks, ValiditySaysHowFarTheyDifferFromOne) {
  for (const double speed : {1500.0, -1500.0}) {
    Case the_case = reference_case("bap63_rated");
    the_case.operation.speed_rpm = speed;
    the_case.pump.friction.block_viscous = 0;
    Case other = the_case;
    other.pump.gear.flanks = Flanks::two;
    const Samples samples = one_turn(the_case);
    const ResultTable one = run(the_case, the_case.analytic, samples);
    const ResultTable two = run(other, other.analytic, samples);
    const ChannelLayout at(5);
    double pin = 0;
    for (std::size_t row = 0; row < one.rows(); ++row)
      pin = std::max(pin, std::hypot(two.at(row, at.Rcn(0)) - one.at(row, at.Rcn(0)),
                                     two.at(row, at.Rcn(1)) - one.at(row, at.Rcn(1))));
    ASSERT_GT(pin, 1);
    char expected[64];
    std::snprintf(expected, sizeof expected, "Rcn changes by up to %.4g N", pin);
    const auto said = [&](const Case& c, const ResultTable& table) {
      std::string text;
      for (const auto& limit : check_validity(c, c.analytic, samples, table))
        text += limit.consequence + "\n";
      return text;
    };
    EXPECT_NE(said(the_case, one).find(expected), std::string::npos) << said(the_case, one);
    EXPECT_NE(said(other, two).find(expected), std::string::npos) << said(other, two);
  }
}

TEST(RingContact, ValidityStatesTheWorkThatTheBudgetHasAsACause) {
  Case the_case = reference_case("bap63_rated");
  const auto ring_of = [&](const Samples& samples) -> std::optional<ValidityLimit> {
    const ResultTable table = run(the_case, the_case.analytic, samples);
    for (const auto& limit : check_validity(the_case, the_case.analytic, samples, table))
      if (limit.name == "Rc works on the play") return limit;
    return {};
  };
  const Samples samples = one_turn(the_case);
  EXPECT_FALSE(ring_of(samples));
  the_case.pump.piston.contact = the_case.pump.geometry.piston_length;
  EXPECT_FALSE(ring_of(samples));
  the_case.pump.piston.contact = 0.0415;
  const auto ring = ring_of(samples);
  ASSERT_TRUE(ring);
  const ResultTable budget = run_budget(the_case, the_case.analytic, samples);
  double largest = 0;
  for (std::size_t row = 0; row < budget.rows(); ++row)
    largest =
        std::max(largest, samples.omega * std::abs(budget.at(row, budget.find("Td_ring_Nm"))));
  EXPECT_NEAR(std::abs(ring->worst), largest, 1e-9 * largest);
  EXPECT_GT(ring->violated_share, 0.9);
}

}  // namespace
}  // namespace bentaxis::test
