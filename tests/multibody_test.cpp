// The multibody model against the analytic one, driven and integrated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/inputs.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/results/max_abs.h"
#include "loads/friction.h"
#include "support.h"

namespace bentaxis::test {
namespace {

// The constraint solver's condition number (up to 1e3) times round-off: 2e-13 measured, 1e-10
// required.
constexpr double kDrivenTolerance = 5e-12;

class Driven : public testing::TestWithParam<std::string> {};

TEST_P(Driven, AgreesWithTheAnalyticModel) {
  const Case the_case = reference_case(GetParam());
  const Samples samples = one_turn(the_case);
  const ResultTable a = analytic::run(the_case, the_case.analytic, samples);
  const ResultTable m = multibody::run_driven(the_case, the_case.multibody, samples);
  const Worst worst = worst_difference(a, m, true);
  EXPECT_LE(worst.over_peak, scaled(kDrivenTolerance)) << worst.channel;
}

TEST_P(Driven, SatisfiesItsOwnChecks) {
  const Case the_case = reference_case(GetParam());
  const ResultTable m = multibody::run_driven(the_case, the_case.multibody, one_turn(the_case));
  const double scale = m.peak("Rs") * the_case.pump.geometry.joint_circle_radius;
  for (std::size_t c = 0; c < m.columns(); ++c) {
    if (m.channels[c].kind != ChannelKind::check) continue;
    for (std::size_t row = 0; row < m.rows(); ++row)
      ASSERT_NEAR(m.at(row, c), 0, scaled(1e-12) * scale) << m.channels[c].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Driven, testing::ValuesIn(reference_cases()),
                         [](const auto& test) { return test.param; });

TEST(DrivenModel, AgreesOnRandomPumpsAndChangingSpeed) {
  RandomPump random(21);
  for (int n = 0; n < 60; ++n) {
    const PumpParameters pump = random.pump();
    Assumptions assumptions = random.assumptions(pump);
    if (n % 4 == 3) assumptions.gear = BlockDrive::imposed;
    const Instant instant =
        random.instant(pump, n % 2 == 0 && assumptions.gear == BlockDrive::mesh);
    const analytic::Model a(pump, assumptions);
    multibody::Model m(pump, assumptions, instant.shaft.speed);
    std::vector<double> va(a.layout().size());
    std::vector<double> vm(a.layout().size());
    a.evaluate(instant, va);
    m.evaluate(instant, vm);
    double largest = 0;
    for (std::size_t c = 0; c < a.layout().reactions(); ++c)
      if (is_computed(va[c])) largest = std::max(largest, std::abs(va[c]));
    for (std::size_t c = 0; c < a.layout().reactions(); ++c) {
      ASSERT_EQ(is_computed(va[c]), is_computed(vm[c]));
      if (is_computed(va[c])) {
        ASSERT_NEAR(va[c], vm[c], scaled(1e-11) * largest)
            << a.layout().channels()[c].name << ", pump " << n;
      }
    }
    ASSERT_NEAR(va[a.layout().Tcs()], vm[a.layout().Tcs()], scaled(1e-11) * largest) << n;
  }
}

TEST(DrivenModel, DoesNotDependOnTheOrderOfCalls) {
  const Case the_case = reference_case("bap63_rated");
  multibody::Model fresh(the_case.pump, the_case.multibody, 1);
  multibody::Model used(the_case.pump, the_case.multibody, 1);
  Instant i;
  i.chamber_pressure.assign(5, 1e7);
  std::vector<double> a(fresh.layout().size());
  std::vector<double> b(fresh.layout().size());
  for (const double theta : {0.0, 0.05, 3.0, 6.2}) {
    i.turn(theta, 150);
    used.evaluate(i, b);
  }
  i.turn(2.0, 150);
  used.evaluate(i, b);
  fresh.evaluate(i, a);
  for (std::size_t c = 0; c < fresh.layout().reactions(); ++c)
    EXPECT_NEAR(a[c], b[c], scaled(1e-8)) << fresh.layout().channels()[c].name;  // N of 1e4
}

TEST(DrivenModel, AxialInertiasDoNotActAtConstantSpeed) {
  Case the_case = reference_case("bap63_rated");
  const Samples samples = one_turn(the_case);
  const ResultTable a = multibody::run_driven(the_case, the_case.multibody, samples);
  the_case.pump.shaft.axial_inertia *= 10;
  the_case.pump.block.axial_inertia *= 10;
  const ResultTable b = multibody::run_driven(the_case, the_case.multibody, samples);
  EXPECT_LE(worst_difference(a, b, true).over_peak, scaled(kDrivenTolerance));
  the_case.pump.shaft.axial_inertia = the_case.pump.block.axial_inertia = 0;
  const ResultTable c = multibody::run_driven(the_case, the_case.multibody, samples);
  EXPECT_LE(worst_difference(a, c, true).over_peak, scaled(kDrivenTolerance));
}

TEST(DrivenModel, RefusesAPistonWithoutInertiaAboutItsJoint) {
  Case the_case = reference_case("bap63_rated");
  the_case.pump.piston.mass = 0;
  EXPECT_THROW(multibody::run_driven(the_case, the_case.multibody, one_turn(the_case)),
               ComputationError);
  the_case.pump.piston.mass = 0.1;
  the_case.pump.piston.joint_mass_fraction = 1;
  EXPECT_THROW(multibody::run_driven(the_case, the_case.multibody, one_turn(the_case)),
               ComputationError);
}

// Every parameter that acts in the case, off by 1e-6 of itself in the multibody model alone, must
// show; and every reaction must be reached by at least one of them.
TEST(NegativeControl, EveryActiveParameterShowsInSomeReaction) {
  Case the_case = reference_case("asymmetric_ports");
  the_case.pump.friction.regularization =
      0.5;  // of the order of the pistons' speed, so that it acts
  const Samples samples = one_turn(the_case);
  const ResultTable reference = analytic::run(the_case, the_case.analytic, samples);
  // Lumped pistons have chi, real ones do not; axial inertias act where the speed changes.
  const std::set<std::string> without_effect = {"piston.joint_mass_fraction", "shaft.axial_inertia",
                                                "block.axial_inertia"};
  const std::size_t inputs = continuous_inputs(the_case.pump).size();
  std::map<std::string, int> noticed_in;
  for (std::size_t i = 0; i < inputs; ++i) {
    Case wrong = the_case;
    const PumpInput input = continuous_inputs(wrong.pump)[i];
    ASSERT_NE(*input.value, 0) << input.name;
    *input.value *= 1 + 1e-6;
    const ResultTable m = multibody::run_driven(wrong, wrong.multibody, samples);
    bool noticed = false;
    for (std::size_t c = 0; c < reference.columns(); ++c) {
      const Channel& channel = reference.channels[c];
      if (channel.kind != ChannelKind::reaction) continue;
      const double peak = reference.peak(channel.group);
      for (std::size_t row = 0; row < reference.rows(); ++row) {
        // Ten times what agreement is held to.
        if (std::abs(m.at(row, c) - reference.at(row, c)) > 10 * kDrivenTolerance * peak) {
          noticed = true;
          ++noticed_in[channel.name];
          break;
        }
      }
    }
    EXPECT_EQ(noticed, without_effect.count(input.name) == 0) << input.name;
  }
  for (const Channel& channel : reference.channels) {
    if (channel.kind == ChannelKind::reaction) {
      EXPECT_GT(noticed_in[channel.name], 0) << channel.name;
    }
  }
}

// ---- integrated --------------------------------------------------------------------------------

struct IntegratedError {
  double reactions = 0;
  multibody::IntegrationRecord record;
};

IntegratedError integrate(Case the_case, int revolutions, double accuracy) {
  the_case.operation.revolutions = revolutions;
  const PressureTrace pressure(the_case.pressure);
  const Samples samples =
      sample_case(the_case, pressure, revolutions, the_case.operation.speed_rpm < 0);
  const ResultTable a = analytic::run(the_case, the_case.analytic, samples);
  multibody::IntegrationOptions options;
  options.accuracy = accuracy;
  auto run = multibody::run_integrated(the_case, the_case.multibody, samples, pressure, options);
  return {worst_difference(a, run.table, true).over_peak, run.record};
}

TEST(Integrated, ErrorShrinksWithTheAccuracyAskedFor) {
  const Case the_case = reference_case("bap63_rated");
  double before = 1;
  for (const double accuracy : {1e-3, 1e-5, 1e-7}) {
    const IntegratedError error = integrate(the_case, 3, accuracy);
    // Measured: 3e-5, 3e-5 (held by the step between samples), 8e-7.
    EXPECT_LT(error.reactions, std::max(100 * accuracy, 1e-6)) << accuracy;
    EXPECT_LE(error.reactions, before);
    EXPECT_LT(std::abs(error.record.whole.gear_phase), 1e-6);
    EXPECT_LT(std::abs(error.record.whole.work_residual), 1e-4);  // J of 5434 J
    before = error.reactions;
  }
  EXPECT_LT(before, 5e-6);
}

TEST(Integrated, BackwardsStepsAndDryFrictionToo) {
  EXPECT_LT(integrate(reference_case("reversed"), 1, 1e-6).reactions, 1e-4);
  EXPECT_LT(integrate(reference_case("step_single"), 1, 1e-6).reactions, 1e-4);
  EXPECT_LT(integrate(reference_case("asymmetric_ports"), 1, 1e-6).reactions, 1e-4);
}

TEST(Integrated, RefusesStandstill) {
  EXPECT_THROW(integrate(reference_case("standstill"), 1, 1e-4), InputError);
}

// The shaft is free and fed the analytic torque: it must hold its speed. A torque that is 1 % off
// must not (the control).
TEST(Integrated, AnalyticTorqueHoldsTheSpeedOfAFreeShaft) {
  const Case the_case = reference_case("bap63_rated");
  const PressureTrace pressure(the_case.pressure);
  const Samples samples = sample_case(the_case, pressure, 1);
  const analytic::Model model(the_case.pump, the_case.analytic);
  std::vector<double> values(model.layout().size());
  Instant instant;
  instant.ports = samples.ports;
  instant.chamber_pressure.resize(5);
  double factor = 1;
  const auto torque = [&](double theta_deg) {
    instant.turn(radians(theta_deg), samples.omega);
    for (int k = 1; k <= 5; ++k)
      instant.chamber_pressure[k - 1] = pressure(piston_angle_deg(theta_deg, k, 5));
    model.reactions(instant, values);
    return factor * values[model.layout().Td()];
  };
  multibody::IntegrationOptions options;
  options.accuracy = 1e-7;
  const auto run = [&] {
    return multibody::run_torque_driven(the_case, the_case.multibody, samples, pressure, torque,
                                        options)
        .whole.speed_error;
  };
  EXPECT_LT(run(), 1e-7);
  factor = 1.01;
  EXPECT_GT(run(), 1e-3);
}

// The errors of a run are those of its worst sample; one that is no number must not be lost among
// the others.
TEST(Integrated, ErrorsOfARunKeepEveryNaN) {
  multibody::WorstErrors run;
  multibody::WorstErrors sample;
  sample.position_error = 3;
  sample.work_residual = -2;
  run.keep(sample);
  sample.position_error = -1;
  sample.work_residual = 1;
  run.keep(sample);
  EXPECT_EQ(run.position_error, 3);
  EXPECT_EQ(run.work_residual, 1);
  EXPECT_TRUE(run.is_finite());
  for (const auto error :
       {&multibody::WorstErrors::position_error, &multibody::WorstErrors::velocity_error,
        &multibody::WorstErrors::gear_phase, &multibody::WorstErrors::shaft_angle,
        &multibody::WorstErrors::speed_error, &multibody::WorstErrors::spin_error}) {
    multibody::WorstErrors broken;
    broken.*error = std::nan("");
    multibody::WorstErrors all = run;
    all.keep(broken);
    all.keep(sample);
    EXPECT_TRUE(std::isnan(all.*error));
    EXPECT_FALSE(all.is_finite());
  }
}

// Whoever notices, Simbody's step control or the account of errors: such a run ends with a message.
TEST(Integrated, ATorqueThatIsNoNumberEndsTheRun) {
  const Case the_case = reference_case("bap63_rated");
  const PressureTrace pressure(the_case.pressure);
  const Samples samples = sample_case(the_case, pressure, 1);
  for (const double from : {0.0, 90.0}) {
    const auto torque = [&](double theta_deg) { return theta_deg >= from ? std::nan("") : 290.0; };
    EXPECT_THROW(
        multibody::run_torque_driven(the_case, the_case.multibody, samples, pressure, torque, {}),
        ComputationError);
  }
}

TEST(Integrated, ATorqueNeedsBodiesThatResistIt) {
  const Case sound = reference_case("bap63_rated");
  const PressureTrace pressure(sound.pressure);
  const Samples samples = sample_case(sound, pressure, 1);
  const auto torque = [](double) { return 290.0; };
  for (const bool of_shaft : {true, false}) {
    Case the_case = sound;
    (of_shaft ? the_case.pump.shaft.axial_inertia : the_case.pump.block.axial_inertia) = 0;
    EXPECT_THROW(
        multibody::run_torque_driven(the_case, the_case.multibody, samples, pressure, torque, {}),
        InputError);
  }
}

TEST(Worst, KeepsTheLargestMagnitudeAndEveryNaN) {
  double worst = 0;
  update_max_abs(worst, -2);
  update_max_abs(worst, 1);
  EXPECT_EQ(worst, 2);
  update_max_abs(worst, std::nan(""));
  update_max_abs(worst, 3);
  EXPECT_TRUE(std::isnan(worst));
}

// ---- friction ----------------------------------------------------------------------------------

// (25), by hand: against the motion, smoothed or by the sign, and none of it at rest.
TEST(PistonFriction, OpposesMotionAndRestsAtRest) {
  Friction f;
  f.piston_coulomb = 25;
  f.piston_viscous = 10;
  f.regularization = 0.01;
  EXPECT_DOUBLE_EQ(multibody::piston_friction(f, 0.01, 0), -(25 * std::tanh(1.0) + 0.1));
  EXPECT_DOUBLE_EQ(multibody::piston_friction(f, -0.01, 0), 25 * std::tanh(1.0) + 0.1);
  f.regularization = 0;
  EXPECT_DOUBLE_EQ(multibody::piston_friction(f, 1e-3, 1e-12), -(25 + 0.01));
  EXPECT_DOUBLE_EQ(multibody::piston_friction(f, -1e-3, 1e-12), 25 + 0.01);
  EXPECT_DOUBLE_EQ(multibody::piston_friction(f, 1e-13, 1e-12), -1e-12);
  EXPECT_DOUBLE_EQ(multibody::piston_friction(f, 0, 0), 0);
  // At rest up to 1e-12 |omega| Ra.
  Geometry g;
  g.joint_circle_radius = 0.04;
  EXPECT_DOUBLE_EQ(multibody::rest_speed_at(g, -150), 6e-12);
}

// ---- rank of the constraints ------------------------------------------------------------------

std::string fact(const Provenance& provenance, const std::string& name) {
  for (const auto& [key, value] : provenance.facts)
    if (key == name) return value;
  return "";
}

Provenance provenance_of(const PumpParameters& pump, const Assumptions& assumptions,
                         multibody::Method method = multibody::Method::multipliers) {
  multibody::Model model(pump, assumptions, 1, multibody::Scene::full, method);
  Instant instant;
  instant.turn(0, 1);
  instant.chamber_pressure.assign(pump.geometry.pistons, 1e5);
  std::vector<double> values(model.layout().size());
  model.evaluate(instant, values);
  return model.provenance();
}

// Nothing missing, nothing twice: as many independent equations as mobilities, but for the spins
// that real pistons keep.
TEST(Rank, EveryMobilityIsHeldOnce) {
  for (const char* name : {"bap63_rated", "noload_2350_real"}) {
    const Case the_case = reference_case(name);
    const Provenance p = provenance_of(the_case.pump, the_case.multibody);
    const int n = the_case.pump.geometry.pistons;
    const bool spins = the_case.multibody.inertia == PistonInertia::real;
    EXPECT_EQ(fact(p, "rank of the constraint matrix"), fact(p, "constraint equations")) << name;
    EXPECT_EQ(std::stoi(fact(p, "mobilities")) - std::stoi(fact(p, "constraint equations")),
              spins ? n : 0)
        << name;
  }
}

// A bearing that repeats what the other does: its equations are none, its forces anybody's guess.
TEST(Rank, RedundantConstraintsAreRefusedByName) {
  Case the_case = reference_case("bap63_rated");
  // The same place would be refused as an input; this near they are one place all the same.
  the_case.pump.bearings = {0, 1e-320};
  for (const auto method : {multibody::Method::multipliers, multibody::Method::residual}) {
    try {
      provenance_of(the_case.pump, the_case.multibody, method);
      FAIL() << "not refused";
    } catch (const ComputationError& error) {
      EXPECT_NE(std::string(error.what()).find("14 constraint equations have rank 12"),
                std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace bentaxis::test
