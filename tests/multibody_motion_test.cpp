// The multibody model where shaft and block move on their own: reactions at given states.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/analytic/model.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/results/max_abs.h"
#include "support.h"

namespace bentaxis::test {
namespace {

using multibody::Method;
using multibody::Scene;

std::filesystem::path motion_file(const std::string& name) {
  return std::filesystem::path(BENTAXIS_SOURCE_DIR) / "reference_data" / "motion" / name;
}

struct StoredInstants {
  explicit StoredInstants(const std::string& name)
      : the_case(read_case(motion_file(name + "/case.toml"))),
        states(read_states(motion_file(name + "/states.csv"), the_case,
                           PressureTrace(the_case.pressure))),
        reactions(read_numeric_csv(motion_file(name + "/reference.csv"))) {}

  MotionTable run() const { return multibody::run_states(the_case, the_case.multibody, states); }

  // Largest difference of each group from the stored curves over its peak there.
  std::map<std::string, double> differences(const MotionTable& table) const {
    std::map<std::string, double> off;
    std::map<std::string, double> peak;
    for (std::size_t c = 0; c < reactions.header.size(); ++c) {
      const auto& channels = table.results.channels;
      const auto channel = std::find_if(channels.begin(), channels.end(), [&](const Channel& x) {
        return x.name == reactions.header[c];
      });
      if (channel == channels.end()) continue;
      const auto at = static_cast<std::size_t>(channel - channels.begin());
      for (std::size_t row = 0; row < states.rows(); ++row) {
        update_max_abs(off[channel->group], table.results.at(row, at) - reactions.rows[row][c]);
        update_max_abs(peak[channel->group], reactions.rows[row][c]);
      }
    }
    for (auto& [group, difference] : off) difference /= peak[group];
    return off;
  }

  Case the_case;
  States states;
  NumericTable reactions;
};

double largest(const std::map<std::string, double>& differences) {
  double worst = 0;
  for (const auto& [group, difference] : differences) update_max_abs(worst, difference);
  return worst;
}

class Stored : public testing::TestWithParam<std::string> {};

// 1e-10 required; placement, two solves and round-off of pressures of 275 bar leave some 1e-14.
TEST_P(Stored, InstantsAreMet) {
  const StoredInstants stored(GetParam());
  const auto differences = stored.differences(stored.run());
  EXPECT_EQ(differences.size(), 9U);  // Rs, Rc, Fh, Th, Rcn, Rcs, Rb1, Rb2, Td
  for (const auto& [group, difference] : differences) EXPECT_LE(difference, scaled(1e-12)) << group;
}

TEST_P(Stored, PowerBalanceCloses) {
  const StoredInstants stored(GetParam());
  const MotionTable table = stored.run();
  const std::size_t balance = table.results.find("power_balance_W");
  const std::size_t ring = table.results.find("ring_power_W");
  double largest_ring = 0;
  for (std::size_t row = 0; row < stored.states.rows(); ++row) {
    // Of 11 kN at 5 m/s.
    EXPECT_NEAR(table.results.at(row, balance), 0, scaled(1e-12) * 5e4) << row;
    EXPECT_NEAR(table.results.at(row, table.results.find("power_residual_Nm")) *
                    stored.states.motion[row].shaft_speed,
                table.results.at(row, balance), 1e-9);
    update_max_abs(largest_ring, table.results.at(row, ring));
  }
  EXPECT_GT(largest_ring, 1);  // the balance would not close without it
}

// Whatever acts, off by 1e-6 of itself, must show in what is compared.
TEST_P(Stored, MissesShow) {
  StoredInstants stored(GetParam());
  const double right = largest(stored.differences(stored.run()));
  const auto changed = [&](double& value) {
    const double was = value;
    value *= 1 + 1e-6;
    const double wrong = largest(stored.differences(stored.run()));
    value = was;
    return wrong / right;
  };
  EXPECT_GT(changed(*stored.the_case.pump.piston.contact), 100);
  EXPECT_GT(changed(stored.the_case.pump.block.axial_inertia), 100);
  EXPECT_GT(changed(stored.the_case.pump.shaft.axial_inertia), 100);
  EXPECT_GT(changed(stored.states.motion[3].block_acceleration), 100);
  EXPECT_GT(changed(stored.states.motion[3].block_speed), 100);
  EXPECT_GT(changed(stored.states.motion[3].psi_deg), 100);
  stored.the_case.pump.gear.flanks = Flanks::one;
  EXPECT_GT(largest(stored.differences(stored.run())), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Cases, Stored, testing::Values("free_block", "free_block_seven"),
                         [](const auto& test) { return test.param; });

// A pump whose block moves on its own, with generic data and motion.
struct FreeInstant {
  explicit FreeInstant(RandomPump& random) : pump(random.pump()) {
    do {
      instant = random.instant(pump, true);
      instant.block = {instant.shaft.angle + random.in(-0.05, 0.05), random.in(-300, 300),
                       random.in(-2000, 2000)};
    } while (assembly_margin(pump.geometry).longest_distance > 0.8 * pump.geometry.piston_length);
    pump.gear.flanks = random.in(0, 1) < 0.5 ? Flanks::one : Flanks::two;
    assumptions = random.assumptions(pump);
  }
  PumpParameters pump;
  Instant instant;
  Assumptions assumptions;
};

// Multipliers of Simbody's equations of motion and inverse dynamics: two ways that share only the
// bodies. The model itself holds every reaction of one to the other.
TEST(FreeMotion, MultipliersAndInverseDynamicsAgreeOnRandomPumps) {
  RandomPump random(14);
  int negative = 0;
  for (int n = 0; n < 60; ++n) {
    const FreeInstant free(random);
    multibody::Model by_multipliers(free.pump, free.assumptions, 1, Scene::full,
                                    Method::multipliers);
    multibody::Model by_residual(free.pump, free.assumptions, 1, Scene::full, Method::residual);
    const ChannelLayout& at = by_multipliers.layout();
    std::vector<double> a(at.size());
    std::vector<double> b(at.size());
    MotionChecks checks{};
    try {
      by_multipliers.evaluate(free.instant, a, &checks);
    } catch (const ComputationError&) {
      continue;  // no assembly at this lag
    }
    by_residual.evaluate(free.instant, b);
    double peak = 0;
    for (std::size_t c = 0; c < at.reactions(); ++c) peak = std::max(peak, std::abs(a[c]));
    for (std::size_t c = 0; c < at.reactions(); ++c)
      ASSERT_NEAR(a[c], b[c], scaled(1e-10) * peak) << at.channels()[c].name << ", pump " << n;
    ASSERT_NEAR(checks.power_balance, 0, scaled(1e-10) * peak * 300 * 0.05) << n;
    EXPECT_EQ(checks.ring_power, 0);
    EXPECT_FALSE(is_computed(checks.tooth_law));
    negative += a[at.Rcs()] < 0 && free.pump.gear.flanks == Flanks::two ? 1 : 0;
  }
  EXPECT_GT(negative, 5);
}

// At constant speed with both bodies locked: the second flank changes the forces that press the
// gears apart where the tooth force is negative, and nothing that turns anything.
TEST(TwoFlanks, ChangeOnlyWhatPressesTheGearsApart) {
  Case the_case = reference_case("bap63_rated");
  the_case.pump.friction.block_viscous = 0;  // then the force changes sign
  const Samples samples = one_turn(the_case);
  const ResultTable one = multibody::run_driven(the_case, the_case.multibody, samples);
  the_case.pump.gear.flanks = Flanks::two;
  for (const Method method : {Method::multipliers, Method::residual}) {
    const ResultTable two =
        multibody::run_driven(the_case, the_case.multibody, samples, {}, Scene::full, method);
    const double ap = the_case.pump.gear.pressure_angle;
    const double cone = kPi / 2 - the_case.pump.geometry.tilt / 2;
    int other = 0;
    for (std::size_t row = 0; row < one.rows(); ++row) {
      const double rcs = one.at(row, one.find("Rcs_z4_N"));
      EXPECT_NEAR(two.at(row, two.find("Rcs_z4_N")), rcs, 1e-8);
      EXPECT_NEAR(two.at(row, two.find("Td_z1_Nm")), one.at(row, one.find("Td_z1_Nm")), 1e-8);
      // On the shaft: -2 |Rcs| sin(ap) (0, cos, sin) less than the one flank has it.
      const double more = rcs < 0 ? -2 * std::abs(rcs) * std::sin(ap) : 0;
      const auto change = [&](const std::string& name) {
        return two.at(row, two.find(name)) - one.at(row, one.find(name));
      };
      EXPECT_NEAR(change("Rb1_z1_N"), -more * std::sin(cone), 1e-7) << row;
      EXPECT_NEAR(change("Rb1_y1_N") + change("Rb2_y1_N"), -more * std::cos(cone), 1e-7) << row;
      EXPECT_NEAR(change("Rb1_x1_N") + change("Rb2_x1_N"), 0, 1e-7) << row;
      other += rcs < 0 ? 1 : 0;
    }
    EXPECT_GT(other, 10);
    EXPECT_LT(other, static_cast<int>(one.rows()) - 10);
  }
}

// The flank has no part in the motion: an integrated run meets the driven one with it too.
TEST(TwoFlanks, IntegratedMeetsDriven) {
  Case the_case = reference_case("bap63_rated");
  the_case.pump.friction.block_viscous = 0;
  the_case.pump.gear.flanks = Flanks::two;
  the_case.operation.samples_per_revolution = 24;
  const PressureTrace pressure(the_case.pressure);
  const Samples samples = sample_case(the_case, pressure);
  const ResultTable driven = multibody::run_driven(the_case, the_case.multibody, samples);
  const auto run = multibody::run_integrated(the_case, the_case.multibody, samples, pressure,
                                             {multibody::Integrator::runge_kutta_merson, 1e-7});
  EXPECT_LE(worst_difference(driven, run.table, true).over_peak, scaled(1e-5));
  const std::size_t rcs = driven.find("Rcs_z4_N");
  double least = 0;
  for (std::size_t row = 0; row < driven.rows(); ++row)
    least = std::min(least, driven.at(row, rcs));
  EXPECT_LT(least, -10);
}

// The column says who pushes in the direction of rotation; what the model was laid out for does not
// matter, and a shaft that stands counts as turning forward.
TEST(FreeMotion, TheToothForceIsSignedByTheDirectionOfTheInstant) {
  for (const Flanks flanks : {Flanks::one, Flanks::two}) {
    Case the_case = reference_case("bap63_rated");
    the_case.pump.gear.flanks = flanks;
    Instant i;
    i.chamber_pressure.assign(5, 0);
    double forward = 0;
    for (const double laid_out : {1.0, -1.0}) {
      multibody::Model model(the_case.pump, the_case.multibody, laid_out);
      std::vector<double> v(model.layout().size());
      for (const double speed : {1e-6, 0.0, -1e-6}) {
        // The block has to be accelerated towards +psi.
        i.shaft = {0.3, speed, 0};
        i.block = {0.3, speed, 40000};
        model.evaluate(i, v);
        const double rcs = v[model.layout().Rcs()];
        EXPECT_EQ(rcs > 0, speed >= 0);
        if (forward == 0) forward = rcs;
        EXPECT_NEAR(std::abs(rcs), forward, 1e-2);
      }
    }
  }
}

// Pistons slide where one of both turns; dry friction rests only where nothing does.
TEST(FreeMotion, DryFrictionActsWhereShaftOrBlockRests) {
  Case the_case = read_case(motion_file("free_block/case.toml"));
  the_case.pump.friction.regularization = 0;
  ASSERT_GT(the_case.pump.friction.piston_coulomb, 0);
  multibody::Model model(the_case.pump, the_case.multibody, 1);
  const analytic::Model closed(the_case.pump, the_case.analytic);
  Instant i;
  i.chamber_pressure.assign(5, 1e7);
  std::vector<double> v(model.layout().size()), expected(closed.layout().size());
  for (const auto& [shaft, block] : {std::pair{100.0, 0.0}, {0.0, 100.0}}) {
    i.shaft = {0.3, shaft, 0};
    i.block = {0.3, block, 0};
    model.evaluate(i, v);
    closed.evaluate(i, expected);
    const std::size_t torque = model.layout().Td();
    EXPECT_NEAR(v[torque], expected[torque], 1e-9 * std::abs(expected[torque])) << shaft;
  }
}

// A tooth in its gap, by hand: 100 N/um, 20 um of play, 0.5 s/m; arm 0.05 m.
TEST(FreeMotion, TheContactLawIsReportedBesideTheForce) {
  Case the_case = reference_case("bap63_rated");
  Gear& gear = the_case.pump.gear;
  gear.flanks = Flanks::two;
  gear.contact = ToothContact::compliant;
  gear.pressure_angle = radians(20);
  gear.pitch_diameter = 0.1 / std::cos(gear.pressure_angle);
  gear.compliance = ToothCompliance{1e8, 1, 0.5, 20e-6};
  multibody::Model model(the_case.pump, the_case.multibody, 1);
  std::vector<double> v(model.layout().size());
  Instant i;
  i.chamber_pressure.assign(5, 0);
  const auto law = [&](double lag_um, double rate) {
    i.shaft = {0.3, 100, 0};
    i.block = {0.3 - lag_um * 1e-6 / 0.05, 100 - rate / 0.05, 0};
    MotionChecks checks{};
    model.evaluate(i, v, &checks);
    return checks.tooth_law;
  };
  EXPECT_EQ(law(9.9, 0.1), 0);
  EXPECT_EQ(law(-9.9, 0.1), 0);
  EXPECT_NEAR(law(12, 0), 200, 1e-6);
  EXPECT_NEAR(law(12, 0.1), 200 * 1.05, 1e-6);
  EXPECT_NEAR(law(-13, 0), -300, 1e-6);
  EXPECT_NEAR(law(-13, 0.1), -300 * 0.95, 1e-6);  // that flank leaves
  EXPECT_EQ(law(12, -2.5), 0);                    // it never pulls
  gear.compliance->exponent = 2;
  model = multibody::Model(the_case.pump, the_case.multibody, 1);
  EXPECT_NEAR(law(13, 0), 900, 1e-6);
}

// Where a smaller scene prescribes both bodies the pistons' reactions are the same.
TEST(FreeMotion, SmallerScenesFindTheSamePistons) {
  const StoredInstants stored("free_block_seven");
  Instant instant;
  std::vector<double> full;
  std::vector<double> part;
  for (const bool off_b : {true, false}) {
    PumpParameters pump = stored.the_case.pump;
    if (!off_b) pump.piston.contact.reset();
    multibody::Model whole(pump, stored.the_case.multibody, 1);
    for (const Scene scene : {Scene::pistons, Scene::piston}) {
      multibody::Model model(pump, stored.the_case.multibody, 1, scene);
      for (std::size_t row = 0; row < stored.states.rows(); ++row) {
        stored.states.instant(row, instant);
        full.assign(whole.layout().size(), not_computed());
        part = full;
        whole.evaluate(instant, full);
        model.evaluate(instant, part);
        for (std::size_t c = 0; c < part.size(); ++c)
          if (whole.layout().channels()[c].piston > 0 && is_computed(part[c])) {
            EXPECT_NEAR(part[c], full[c], scaled(1e-8)) << whole.layout().channels()[c].name;
          }
      }
    }
  }
}

TEST(RingContact, IsRefusedByNameWhereConstraintsWouldHaveToDoWork) {
  const auto refused = [](const std::string& what) {
    return testing::ThrowsMessage<InputError>(testing::AllOf(
        testing::HasSubstr("[piston] contact_mm = 41.5 differs from piston_length_mm = 46"),
        testing::HasSubstr(what)));
  };
  Case the_case = reference_case("bap63_rated");
  the_case.pump.piston.contact = 41.5e-3;
  the_case.operation.samples_per_revolution = 4;
  const PressureTrace pressure(the_case.pressure);
  const Samples samples = sample_case(the_case, pressure);
  EXPECT_THAT(
      [&] {
        multibody::run_driven(the_case, the_case.multibody, samples, {}, Scene::full,
                              Method::multipliers);
      },
      refused("use --reactions residual"));
  EXPECT_THAT(
      [&] { multibody::run_integrated(the_case, the_case.multibody, samples, pressure, {}); },
      refused("not integrated in time"));
  const auto facts = multibody::run_driven(the_case, the_case.multibody, samples).provenance.facts;
  const auto bore = std::find_if(facts.begin(), facts.end(),
                                 [](const auto& fact) { return fact.first == "bore forces"; });
  ASSERT_NE(bore, facts.end());
  EXPECT_THAT(bore->second, testing::HasSubstr("inverse dynamics, chosen for that"));
  // At B there is nothing to refuse.
  the_case.pump.piston.contact = the_case.pump.geometry.piston_length;
  multibody::run_driven(the_case, the_case.multibody, samples, {}, Scene::full,
                        Method::multipliers);
}

}  // namespace
}  // namespace bentaxis::test
