// Properties that hold for every pump, over seeded random ones. A failure is made plainer and
// written as a case file that reproduces it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>

#include "bentaxis/analytic/rounding.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "free_bodies.h"
#include "printed_model.h"
#include "support.h"
#include "wild_pump.h"

namespace bentaxis::test {
namespace {

using analytic::Model;
using analytic::RoundingEstimate;

/// What went wrong; nothing where the property holds.
using Failure = std::optional<std::string>;

Instant instant_at(const Case& c, double theta_deg, const Lead& lead = {}) {
  Instant i =
      test::instant_at(c, std::fmod(theta_deg, 360.0), rad_per_second(c.operation.speed_rpm));
  i.shaft.acceleration = lead.shaft_acceleration;
  i.block = {i.shaft.angle + lead.angle, i.shaft.speed + lead.speed,
             i.shaft.acceleration + lead.acceleration};
  return i;
}

std::vector<double> evaluate(const Case& c, const Instant& i) {
  const Model model(c.pump, c.analytic);
  std::vector<double> values(model.layout().size());
  model.evaluate(i, values);
  return values;
}

// Predicted rounding error of each group of reactions, and the largest magnitude in it.
struct Scales {
  std::map<std::string, double> rounding, peak;
  double largest = 0;             // of all reactions
  double largest_rounding = 0;    // of all groups
  double rounding_over_peak = 0;  // worst of all groups
};

Scales scales_of(const Case& c, const Instant& i, const std::vector<double>& values) {
  const RoundingEstimate estimate(c.pump, c.analytic);
  RoundingEstimate::Parts parts;
  std::vector<double> pressure;
  for (const double p : i.chamber_pressure) pressure.push_back(1e-15 * std::abs(p));
  estimate.estimate(i, pressure, parts);
  Scales scales;
  const auto& channels = estimate.layout().channels();
  for (std::size_t at = 0; at < estimate.layout().reactions(); ++at) {
    double& rounding = scales.rounding[channels[at].group];
    double& peak = scales.peak[channels[at].group];
    rounding = std::max(rounding, parts.inputs[at] + parts.arithmetic[at]);
    peak = std::max(peak, std::abs(values[at]));
    scales.largest = std::max(scales.largest, std::abs(values[at]));
  }
  for (const auto& [group, rounding] : scales.rounding)
    scales.largest_rounding = std::max(scales.largest_rounding, rounding);
  for (const auto& [group, rounding] : scales.rounding)
    if (scales.peak[group] > 0)
      scales.rounding_over_peak =
          std::max(scales.rounding_over_peak, rounding / scales.peak[group]);
  return scales;
}

std::string text(double value) { return number_text(value); }

// A case at one angle, evaluated once for all properties.
struct Look {
  Look(const Case& the_case, double angle_deg, const Lead& lead)
      : c(the_case),
        theta_deg(angle_deg),
        i(instant_at(c, theta_deg, lead)),
        at(c.pump.geometry.pistons),
        values(evaluate(c, i)),
        scales(scales_of(c, i, values)) {}
  const Case& c;
  double theta_deg;
  Instant i;
  ChannelLayout at;
  std::vector<double> values;
  Scales scales;
};
using Property = std::function<Failure(const Look&)>;

// ---- properties
// ----------------------------------------------------------------------------------

// A prediction is one of the first order, of an error that is partly luck.
constexpr double kPrediction = 100;
// Round-off of sums over the pistons, of the sum of the magnitudes.
constexpr double kSum = 1e-13;

Failure free_bodies_balance(const Look& look) {
  const auto& [c, theta_deg, i, at, values, scales] = look;
  const double residual = free_body_residual(c.pump, c.analytic, i, values);
  const double allowed = scaled(kSum + kPrediction * scales.rounding_over_peak);
  if (residual <= allowed) return {};
  return "free bodies: residual " + text(residual) + ", allowed " + text(allowed);
}

Failure power_balances(const Look& look) {
  const auto& [c, theta_deg, i, at, values, scales] = look;
  // Work per radian: forces times radius, and the torque with its rounding.
  double scale = std::abs(values[at.Td()]);
  for (int k = 0; k < at.pistons(); ++k)
    scale += std::hypot(values[at.Rs(k, 0)], values[at.Rs(k, 1)], values[at.Rs(k, 2)]) *
             c.pump.geometry.joint_circle_radius;
  const double allowed = scaled(kSum * scale + kPrediction * scales.rounding.at("Td"));
  if (i.locked() && std::abs(values[at.power_residual()]) > allowed)
    return "power balance: " + text(values[at.power_residual()]) + " Nm, allowed " + text(allowed);
  if (!i.locked()) {
    // Power itself: the shaft may stand. Everything that moves does so with one of these speeds,
    // and forces act on levers of the size of the pump.
    MotionChecks checks;
    std::vector<double> row(at.size());
    Model(c.pump, c.analytic).evaluate(i, row, &checks);
    const double speed = std::max(std::abs(i.shaft.speed), std::abs(i.block.speed));
    const double size = c.pump.geometry.piston_length + c.pump.geometry.joint_circle_radius +
                        c.pump.gear.pitch_diameter;
    const double most = speed * size * at.pistons() *
                        scaled(kSum * scales.largest + kPrediction * scales.largest_rounding);
    if (!(std::abs(checks.power_balance) <= most))
      return "power balance: " + text(checks.power_balance) + " W, allowed " + text(most);
  }
  for (int k = 0; k < at.pistons(); ++k)
    if (std::abs(values[at.axis_moment(k)]) >
        scaled(kSum * scale +
               kPrediction * scales.rounding.at("Rs") * c.pump.geometry.piston_length))
      return "moment about the axis of piston " + std::to_string(k + 1) + ": " +
             text(values[at.axis_moment(k)]) + " Nm";
  return {};
}

Failure shift_permutes(const Look& look) {
  const auto& [c, theta_deg, i, at, a, scales] = look;
  const int n = at.pistons();
  Instant shifted = i;
  shifted.shaft.angle += 2 * kPi / n;
  shifted.block.angle = shifted.shaft.angle + (i.block.angle - i.shaft.angle);
  for (int k = 0; k < n; ++k) shifted.chamber_pressure[(k + 1) % n] = i.chamber_pressure[k];
  const auto b = evaluate(c, shifted);
  for (std::size_t column = 0; column < at.reactions(); ++column) {
    std::size_t other = column;
    if (column < at.Fh()) other = (column + 5) % at.Fh();
    const std::string& group = at.channels()[column].group;
    // A reaction may be 0 by cancellation between the pistons.
    const bool moment = at.channels()[column].unit == "Nm";
    const double size = scales.largest * (moment ? c.pump.geometry.joint_circle_radius : 1);
    const double allowed = scaled(kSum * size + kPrediction * scales.rounding.at(group));
    if (std::abs(a[column] - b[other]) > allowed)
      return "shift by one piston: " + at.channels()[column].name + " " + text(a[column]) +
             " becomes " + text(b[other]) + ", allowed difference " + text(allowed);
  }
  return {};
}

Failure size_scales(const Look& look) {
  const auto& [c, theta_deg, instant, at, small, scales] = look;
  Case twice = c;
  scale_pump(twice.pump, 2);
  Instant i = instant;
  // At half the speeds points are as fast as before, and accelerations of angles are a quarter.
  for (AxisMotion* m : {&i.shaft, &i.block}) *m = {m->angle, m->speed / 2, m->acceleration / 4};
  const auto large = evaluate(twice, i);
  for (std::size_t column = 0; column < at.reactions(); ++column) {
    const double factor = at.channels()[column].unit == "Nm" ? 8 : 4;
    if (large[column] != factor * small[column])  // exact: a power of 2
      return "twice the size: " + at.channels()[column].name + " " + text(small[column]) +
             " becomes " + text(large[column]);
  }
  return {};
}

// Nothing jumps where an angle is special: dead centres, quarter turns, k3_y = 0.
Failure is_continuous(const Look& look) {
  const Case& c = look.c;
  const ChannelLayout& at = look.at;
  const Scales& scales = look.scales;
  const auto& values = look.values;
  if (c.pump.friction.regularization == 0) return {};  // jumps at dead centres, as it should
  Instant i = look.i;
  for (const double middle : {i.shaft.angle, radians(90 * std::floor(look.theta_deg / 90))}) {
    // Over a distance h the reactions change by about h/H of what they change over H. Sliding
    // friction smooths over v_reg: H is within that.
    const double speed = std::abs(i.shaft.speed) * c.pump.geometry.joint_circle_radius;
    const double far =
        std::min(1e-4, speed > 0 ? 0.1 * c.pump.friction.regularization / speed : 1e-4);
    const double near = 1e-4 * far;
    const auto around = [&](double distance) {
      i.turn(middle - distance, i.shaft.speed);
      auto before = evaluate(c, i);
      i.turn(middle + distance, i.shaft.speed);
      const auto after = evaluate(c, i);
      for (std::size_t column = 0; column < at.size(); ++column) before[column] -= after[column];
      return before;
    };
    const auto wide = around(far);
    const auto narrow = around(near);
    std::map<std::string, double> slope;
    for (std::size_t column = 0; column < at.reactions(); ++column) {
      double& s = slope[at.channels()[column].group];
      s = std::max(s, std::abs(wide[column]) + far * std::abs(values[column]));
    }
    for (std::size_t column = 0; column < at.reactions(); ++column) {
      const std::string& group = at.channels()[column].group;
      const double allowed = scaled(1e-2 * slope[group] + kSum * scales.peak.at(group) +
                                    kPrediction * scales.rounding.at(group));
      if (std::abs(narrow[column]) > allowed)
        return "continuity: " + at.channels()[column].name + " jumps by " + text(narrow[column]) +
               " at " + text(middle) + " rad, allowed " + text(allowed);
    }
  }
  return {};
}

Failure twin_agrees(const Look& look) {
  const auto& [c, theta_deg, i, at, values, scales] = look;
  const auto twin = PrintedModel(c.pump, c.analytic).reactions(i);
  for (std::size_t column = 0; column < twin.size(); ++column) {
    const std::string& group = at.channels()[column].group;
    // The twin solves whole bodies, so that its round-off is of the largest force on the body.
    const double allowed = scaled(kSum * scales.largest + kPrediction * scales.rounding.at(group));
    if (!(std::abs(values[column] - twin[column]) <= allowed))
      return "twin: " + at.channels()[column].name + " " + text(values[column]) + " against " +
             text(twin[column]) + ", allowed difference " + text(allowed);
  }
  return {};
}

const std::vector<std::pair<std::string, Property>>& properties() {
  static const std::vector<std::pair<std::string, Property>> list = {
      {"free_bodies", free_bodies_balance}, {"power", power_balances},
      {"permutation", shift_permutes},      {"scaling", size_scales},
      {"continuity", is_continuous},        {"twin", twin_agrees}};
  return list;
}

// Shrinks a failure and writes the case file that reproduces it; returns what to tell.
std::string report(const std::string& name, const RandomCase::Drawn& drawn,
                   const Property& property, unsigned number) {
  const Case plain = shrink(drawn.the_case, [&](const Case& c) {
    return property(Look(c, drawn.theta_deg, drawn.lead)).has_value();
  });
  const auto file = std::filesystem::temp_directory_path() /
                    ("bentaxis_" + name + "_" + std::to_string(number) + ".toml");
  std::ofstream(file) << "# fails \"" << name << "\" at theta = " << text(drawn.theta_deg)
                      << " deg; block ahead by " << text(drawn.lead.angle) << " rad, "
                      << text(drawn.lead.speed) << " rad/s, " << text(drawn.lead.acceleration)
                      << " rad/s2; shaft " << text(drawn.lead.shaft_acceleration) << " rad/s2\n"
                      << case_text(plain);
  return *property(Look(plain, drawn.theta_deg, drawn.lead)) + " (pump " + std::to_string(number) +
         ", theta = " + text(drawn.theta_deg) + " deg; reproduced by " + file.string() + ")";
}

class Analytic : public testing::TestWithParam<unsigned> {};

constexpr unsigned kBatches = 10;
constexpr unsigned kPumpsPerBatch = 2000;

TEST_P(Analytic, PropertiesHoldForEveryPump) {
  RandomCase random(1000 + GetParam());
  for (unsigned n = 0; n < kPumpsPerBatch; ++n) {
    const auto drawn = n % 4 == 0 ? random.tame() : random.wild();
    const Look look(drawn.the_case, drawn.theta_deg, drawn.lead);
    for (const auto& [name, property] : properties())
      if (property(look)) {
        ADD_FAILURE() << report(name, drawn, property, n);
        return;
      }
  }
}

// But for continuity along a turn, of which there is none.
TEST_P(Analytic, PropertiesHoldForAnyMotion) {
  RandomCase random(3000 + GetParam());
  for (unsigned n = 0; n < kPumpsPerBatch; ++n) {
    const auto drawn = random.freed(n % 4 == 0 ? random.tame() : random.wild());
    const Look look(drawn.the_case, drawn.theta_deg, drawn.lead);
    for (const auto& [name, property] : properties())
      if (name != "continuity" && property(look)) {
        ADD_FAILURE() << report(name, drawn, property, n);
        return;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Batches, Analytic, testing::Range(0U, kBatches));

// The control: each property notices a wrong result, and the shrunk case file still fails.
TEST(Control, AFailureIsShrunkToACaseFileThatReproducesIt) {
  RandomCase random(7);
  RandomCase::Drawn drawn = random.tame();
  while (drawn.the_case.pump.geometry.pistons < 5) drawn = random.tame();
  const auto wrong = [&](const Case& c) {
    Look look(c, drawn.theta_deg, drawn.lead);
    look.values[look.at.Rs(0, 2)] *= 1 + 1e-9;
    return c.pump.piston.mass > 0 && free_bodies_balance(look).has_value();
  };
  ASSERT_TRUE(wrong(drawn.the_case));
  EXPECT_FALSE(free_bodies_balance(Look(drawn.the_case, drawn.theta_deg, drawn.lead)));
  const Case plain = shrink(drawn.the_case, wrong);
  EXPECT_EQ(plain.pump.geometry.pistons, 1);
  EXPECT_FALSE(plain.pump.port_plate);
  EXPECT_GT(plain.pump.piston.mass, 0);  // what the failure needs stays
  const Case again = parse_case(case_text(plain), "shrunk.toml");
  EXPECT_TRUE(wrong(again));
}

// ---- Simbody
// -------------------------------------------------------------------------------------

// Agreement with the analytic model, of the largest reaction: what a tame pump reaches (4e-13
// measured) and any pump by inverse dynamics, and what the guard of the constraint solver lets pass
// of a wild one (its 1e-8 of the largest force, and the levers of the bearings).
constexpr double kTame = 1e-11;
constexpr double kWild = 1e-6;

// Properties of a multibody model of this pump at an instant and one piston pitch later.
void expect_properties(multibody::Model& model, const RandomCase::Drawn& drawn, double tolerance) {
  const Case& c = drawn.the_case;
  const Instant i = instant_at(c, drawn.theta_deg);
  const auto expected = evaluate(c, i);
  const Scales scales = scales_of(c, i, expected);
  const ChannelLayout at(c.pump.geometry.pistons);
  std::vector<double> values(at.size());
  std::vector<double> shifted(at.size());
  model.evaluate(i, values);
  Instant next = i;
  next.turn(i.shaft.angle + 2 * kPi / at.pistons(), i.shaft.speed);
  for (int k = 0; k < at.pistons(); ++k)
    next.chamber_pressure[(k + 1) % at.pistons()] = i.chamber_pressure[k];
  model.evaluate(next, shifted);
  const double allowed = scaled(tolerance * scales.largest);
  for (std::size_t column = 0; column < at.reactions(); ++column) {
    const double rounding = kPrediction * scales.rounding.at(at.channels()[column].group);
    ASSERT_NEAR(values[column], expected[column], allowed + rounding)
        << at.channels()[column].name << "\n"
        << case_text(c);
    const std::size_t other = column < at.Fh() ? (column + 5) % at.Fh() : column;
    ASSERT_NEAR(values[column], shifted[other], allowed + rounding)
        << at.channels()[column].name << "\n"
        << case_text(c);
  }
  if (tolerance > kTame) return;
  EXPECT_LE(free_body_residual(c.pump, c.multibody, i, values),
            scaled(kTame + kPrediction * scales.rounding_over_peak))
      << case_text(c);
  EXPECT_NEAR(values[at.power_residual()], 0, allowed + kPrediction * scales.rounding.at("Td"))
      << case_text(c);
}

TEST(Simbody, PropertiesHoldForEveryPump) {
  RandomCase random(2000);
  int refused = 0;
  constexpr int kPumps = 1000;
  for (int n = 0; n < kPumps; ++n) {
    const bool tame = n % 2 == 0;
    const auto drawn = tame ? random.tame() : random.wild();
    const Case& c = drawn.the_case;
    const double omega = rad_per_second(c.operation.speed_rpm);
    try {
      multibody::Model model(c.pump, c.multibody, omega);
      ASSERT_NO_FATAL_FAILURE(expect_properties(model, drawn, tame ? kTame : kWild)) << n;
    } catch (const ComputationError& error) {
      ASSERT_FALSE(tame) << error.what() << "\n" << case_text(c);
      ++refused;
    }
    multibody::Model model(c.pump, c.multibody, omega, multibody::Scene::full,
                           multibody::Method::residual);
    ASSERT_NO_FATAL_FAILURE(expect_properties(model, drawn, kTame)) << n;  // refuses none
  }
  // Of the wild pumps a good part must come through, or the guard refuses too much.
  EXPECT_LT(refused, kPumps / 4);
  RecordProperty("refused", refused);
  std::cout << refused << " of " << kPumps / 2 << " wild pumps refused\n";
}

}  // namespace
}  // namespace bentaxis::test
