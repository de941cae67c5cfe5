// Derivatives of the closed form against differences of the same closed form in extended precision.
#include "bentaxis/analytic/derivatives.h"

#include <gtest/gtest.h>

#include <cstring>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/inputs.h"
#include "bentaxis/pump/number.h"
#include "closed_form/reactions.h"
#include "prepared.h"
#include "support.h"
#include "turning.h"

namespace bentaxis::test {
namespace {

using namespace analytic;
using Real = long double;

// A pump and an instant in extended precision, `step` along a direction of both.
struct Extended {
  PumpParameters pump, pump_rate;
  Assumptions assumptions;
  Instant instant, instant_rate;

  std::vector<Real> reactions(Real step) const {
    using Raw = closed_form::RawPump<double>;
    constexpr std::size_t kCount = sizeof(Raw) / sizeof(double);
    const Raw from = closed_form::raw(pump), rate = closed_form::raw(pump_rate);
    double values[kCount], rates[kCount];
    std::memcpy(values, &from, sizeof values);
    std::memcpy(rates, &rate, sizeof rates);
    Real numbers[kCount];
    for (std::size_t i = 0; i < kCount; ++i) numbers[i] = values[i] + step * rates[i];
    closed_form::RawPump<Real> raw;
    std::memcpy(&raw, numbers, sizeof raw);
    closed_form::Pump<Real> prepared;
    prepare_numbers(raw, pump, assumptions, prepared);

    const auto at = [&](auto get) { return get(instant) + step * Real(get(instant_rate)); };
    const Real theta = at([](const Instant& i) { return i.shaft.angle; });
    const closed_form::State<Real> shaft = {
        std::sin(theta),
        std::cos(theta),
        at([](const Instant& i) { return i.shaft.speed; }),
        at([](const Instant& i) { return i.shaft.acceleration; }),
        at([](const Instant& i) { return i.ports.suction; }),
        at([](const Instant& i) { return i.ports.delivery; })};
    const ChannelLayout layout(pump);
    std::vector<Real> out(layout.size());
    const PreparedPump place = prepare(pump, assumptions);
    with_shaft_state<Real>(pump.transfer.kind, [&](auto& turning) {
      static_cast<closed_form::State<Real>&>(turning) = shaft;
      closed_form::turn_block(prepared.joint, turning);
      closed_form::reactions<Real>(
          place.common(layout), prepared, turning, true,
          [&](int k) { return at([k](const Instant& i) { return i.chamber_pressure[k]; }); },
          [&](int index, Real value) { out[index] = value; });
    });
    return out;
  }

  // Central differences at h, h/2 and h/4, extrapolated: an error of about h^6 and 1e-19 / h.
  std::vector<Real> derivatives(Real h) const {
    std::vector<Real> rows[3];
    for (int level = 0; level < 3; ++level, h /= 2) {
      const std::vector<Real> above = reactions(h), below = reactions(-h);
      for (std::size_t c = 0; c < above.size(); ++c)
        rows[level].push_back((above[c] - below[c]) / (2 * h));
    }
    std::vector<Real> result;
    for (std::size_t c = 0; c < rows[0].size(); ++c) {
      const Real first = (4 * rows[1][c] - rows[0][c]) / 3;
      const Real second = (4 * rows[2][c] - rows[1][c]) / 3;
      result.push_back((16 * second - first) / 15);
    }
    return result;
  }
};

Instant at_rest(const Instant& instant) {
  Instant rate;
  rate.chamber_pressure.assign(instant.chamber_pressure.size(), 0.0);
  return rate;
}

// Relative change of an input, of the largest reaction.
constexpr double kTolerance = 1e-10;
constexpr Real kStep = 1e-3L;

TEST(Derivatives, AreDifferencesInExtendedPrecision) {
  RandomPump random(17);
  double worst = 0;
  int of_joints = 0;
  int of_two_crosses = 0;
  for (int i = 0; i < 105; ++i) {
    Extended x;
    x.pump = random.free(random.pump());
    if (i >= 60) {
      x.pump.gear = {};
      x.pump.transfer.kind = i % 3 == 0 ? TransferKind::constant_velocity : TransferKind::cardan;
      if (i >= 90) {
        x.pump.transfer.kind = TransferKind::double_cardan;
        x.pump.transfer.double_cardan = DoubleCardanJoint{2e-3 * (i - 80)};
      }
      if (x.pump.transfer.has_crosses())
        x.pump.transfer.cardan = CardanJoint{0.1 * i - (i < 90 ? 7 : 9.5)};
      x.pump.block.axial_inertia = 1e-3 * (i - 50);
      if (assembly_margin(x.pump).longest_distance >= 0.9 * x.pump.geometry.piston_length) continue;
      ++of_joints;
    }
    // The motion of a universal joint's block has larger derivatives of higher order.
    const Real step = i < 60 ? kStep : kStep / 2;
    x.assumptions = {i % 4 != 0, x.pump.piston.inertia,
                     i < 60 && i % 5 == 0 ? BlockDrive::imposed : BlockDrive::mesh};
    x.instant = random.instant(x.pump, true);

    // Every number of the pump and of the instant, each by its own size.
    std::vector<PumpParameters> pumps;
    std::vector<Instant> instants;
    std::vector<std::string> names;
    PumpParameters sizes = x.pump;
    for (const PumpInput& input : continuous_inputs(sizes)) {
      PumpParameters rate = rate_of(x.pump, input.name);
      for (const PumpInput& other : continuous_inputs(rate)) *other.value *= *input.value;
      pumps.push_back(rate);
      instants.push_back(at_rest(x.instant));
      names.push_back(input.name);
    }
    const auto of_instant = [&](const std::string& name, auto change) {
      pumps.push_back(no_rates(x.pump));
      instants.push_back(at_rest(x.instant));
      change(instants.back());
      names.push_back(name);
    };
    of_instant("theta", [](Instant& r) { r.shaft.angle = 1; });
    of_instant("speed", [&](Instant& r) { r.shaft.speed = x.instant.shaft.speed; });
    of_instant("acceleration", [](Instant& r) { r.shaft.acceleration = 1000; });
    of_instant("pressure", [](Instant& r) { r.chamber_pressure.back() = 1e6; });
    of_instant("ports", [](Instant& r) { r.ports = {1e5, 1e7}; });

    const DerivativeModel model(x.pump, x.assumptions, pumps);
    const std::size_t reactions = model.layout().reactions();
    std::vector<double> values(reactions), derivatives(reactions * pumps.size());
    model.reactions(x.instant, instants, values, derivatives);
    std::vector<double> expected(model.layout().size());
    Model(x.pump, x.assumptions).reactions(x.instant, expected);
    double scale = 0;
    for (std::size_t c = 0; c < reactions; ++c)
      if (is_computed(expected[c])) scale = std::max(scale, std::abs(expected[c]));
    for (std::size_t c = 0; c < reactions; ++c) {
      ASSERT_EQ(is_computed(values[c]), is_computed(expected[c]));
      if (is_computed(values[c])) {
        ASSERT_NEAR(values[c], expected[c], 1e-13 * scale);
      }
    }
    for (std::size_t d = 0; d < pumps.size(); ++d) {
      x.pump_rate = pumps[d];
      x.instant_rate = instants[d];
      const std::vector<Real> differences = x.derivatives(step);
      for (std::size_t c = 0; c < reactions; ++c) {
        const double found = derivatives[d * reactions + c];
        ASSERT_EQ(is_computed(found), is_computed(expected[c]));
        if (!is_computed(found)) continue;
        const double error = std::abs(found - static_cast<double>(differences[c])) / scale;
        worst = std::max(worst, error);
        ASSERT_LE(error, scaled(kTolerance))
            << names[d] << ", channel " << model.layout().channels()[c].name << ", pump " << i;
      }
    }
    if (!x.pump.transfer.is_joint()) continue;
    // The joint's couple likewise.
    std::vector<double> couple(3), rates(3 * pumps.size());
    model.joint_couple(x.instant, instants, couple, rates);
    Model(x.pump, x.assumptions).evaluate(x.instant, expected);
    for (std::size_t d = 0; d < pumps.size(); ++d) {
      x.pump_rate = pumps[d];
      x.instant_rate = instants[d];
      const std::vector<Real> differences = x.derivatives(step);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t c = model.layout().TcsJoint(axis);
        ASSERT_NEAR(couple[axis], expected[c], 1e-13 * scale);
        ASSERT_NEAR(rates[3 * d + axis], static_cast<double>(differences[c]),
                    scaled(kTolerance) * scale)
            << names[d] << ", couple " << axis << ", pump " << i;
      }
    }
    if (x.pump.transfer.kind != TransferKind::double_cardan) continue;
    ++of_two_crosses;
    std::vector<double> force(3);
    model.joint_force(x.instant, instants, force, rates);
    for (std::size_t d = 0; d < pumps.size(); ++d) {
      x.pump_rate = pumps[d];
      x.instant_rate = instants[d];
      const std::vector<Real> differences = x.derivatives(step);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t c = model.layout().Fcs(axis);
        ASSERT_NEAR(force[axis], expected[c], 1e-13 * scale);
        ASSERT_NEAR(rates[3 * d + axis], static_cast<double>(differences[c]),
                    scaled(kTolerance) * scale)
            << names[d] << ", force " << axis << ", pump " << i;
      }
    }
  }
  EXPECT_GT(of_two_crosses, 5);
  EXPECT_GT(of_joints, 20);
  RecordProperty("worst", std::to_string(worst));
}

// The couple is that of a joint; a lag that is a root has no derivatives here.
TEST(Derivatives, OfOtherTransfersAreRefused) {
  const Case gear = reference_case("bap63_rated");
  const PumpParameters tilt = rate_of(gear.pump, "geometry.tilt");
  const DerivativeModel model(gear.pump, gear.analytic, {&tilt, 1});
  Instant instant = instant_at(gear, 10, 157);
  const Instant rate;
  std::vector<double> three(3);
  EXPECT_EQ(refusal([&] {
              model.joint_couple(instant, {&rate, 1}, three, three);
            }),
            "derivatives: [transfer] kind = \"gear\": must be a joint, which has a couple");
  EXPECT_EQ(refusal([&] {
              model.joint_force(instant, {&rate, 1}, three, three);
            }),
            "derivatives: [transfer] kind = \"gear\": must be \"double_cardan\", whose joint has "
            "a force");
  const Case pistons = read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) /
                                 "reference_data/transfers/pistons_seven/case.toml");
  const PumpParameters none = no_rates(pistons.pump);
  EXPECT_EQ(refusal([&] {
              DerivativeModel(pistons.pump, pistons.analytic, {&none, 1});
            }),
            "derivatives: [transfer] kind = \"pistons\": must be of another kind: the lag of the "
            "block is a root");
}

TEST(Derivatives, RefuseWhatDoesNotFit) {
  const Case the_case = reference_case("bap63_rated");
  EXPECT_THROW(rate_of(the_case.pump, "geometry.tilted"), InputError);
  const PumpParameters tilt = rate_of(the_case.pump, "geometry.tilt");
  const DerivativeModel model(the_case.pump, the_case.analytic, {&tilt, 1});
  const Samples samples = one_turn(the_case);
  Instant instant;
  samples.instant(0, instant);
  const Instant rate;
  std::vector<double> values(37), derivatives(37);
  model.reactions(instant, {&rate, 1}, values, derivatives);
  EXPECT_THROW(model.reactions(instant, {}, values, derivatives), InputError);
  EXPECT_THROW(model.reactions(instant, {&rate, 1}, values, {derivatives.data(), 36}), InputError);
  instant.block.angle += 1e-3;
  EXPECT_THROW(model.reactions(instant, {&rate, 1}, values, derivatives), InputError);
}

}  // namespace
}  // namespace bentaxis::test
