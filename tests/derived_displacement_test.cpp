// Displacement as test rigs derive it: flows of a known displacement, and the pump itself.
#include "bentaxis/study/derived_displacement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/study/efficiency.h"

namespace bentaxis::study {
namespace {

using testing::HasSubstr;
using Method = DisplacementMethod;

constexpr double kVolume = 63e-6;  // m3
constexpr double kRelative = 1e-12;
const std::vector<double> kSpeeds = {5, 10, 20, 25};  // rev/s
const std::vector<double> kPressures = {10e5, 100e5, 200e5, 280e5};

// Points over all speeds and pressures with a given loss of flow.
std::vector<FlowPoint> points_of(const std::function<double(double n, double p)>& loss,
                                 const std::vector<double>& speeds = kSpeeds,
                                 const std::vector<double>& pressures = kPressures) {
  std::vector<FlowPoint> points;
  for (const double n : speeds)
    for (const double p : pressures) points.push_back({n, p, p, kVolume * n - loss(n, p)});
  return points;
}

double bias(Method method, const std::vector<FlowPoint>& points) {
  return derived_displacement(method, points) / kVolume - 1;
}

double sum(const std::vector<double>& values, int power) {
  return std::accumulate(values.begin(), values.end(), 0.0,
                         [&](double all, double v) { return all + std::pow(v, power); });
}

// Value at 0 of the least-squares line through f over the pressures.
double line_at_zero(const std::function<double(double)>& f) {
  const double count = static_cast<double>(kPressures.size()), mean = sum(kPressures, 1) / count;
  double mean_f = 0, across = 0, along = 0;
  for (const double p : kPressures) mean_f += f(p) / count;
  for (const double p : kPressures) {
    across += (p - mean) * (f(p) - mean_f);
    along += (p - mean) * (p - mean);
  }
  return mean_f - across / along * mean;
}

TEST(DerivedDisplacementTest, LaminarSlipIsNoBias) {
  const auto points = points_of([](double, double p) { return 2e-12 * p; });
  for (const Method method : kDisplacementMethods)
    EXPECT_NEAR(bias(method, points), 0, kRelative) << name_of(method);
}

TEST(DerivedDisplacementTest, OnlyToetSeesALossThatIsTheSameAtEverySpeed) {
  const double loss = 1e-5;
  const auto points = points_of([&](double, double p) { return 2e-12 * p + loss; });
  EXPECT_NEAR(bias(Method::toet, points), 0, kRelative);
  EXPECT_NEAR(bias(Method::iso_8426, points), -loss / (kVolume * 25), kRelative);
  EXPECT_NEAR(bias(Method::zero_pressure_line, points),
              -loss / kVolume * sum(kSpeeds, 1) / sum(kSpeeds, 2), kRelative);
  EXPECT_LT(bias(Method::wilson, points), -1e-3);
}

TEST(DerivedDisplacementTest, OnlyWilsonMistakesALossInProportionToSpeedAndPressure) {
  const double modulus = 1.4e9;
  const auto points = points_of([&](double n, double p) { return kVolume * n * p / modulus; });
  for (const Method method : {Method::iso_8426, Method::toet, Method::zero_pressure_line})
    EXPECT_NEAR(bias(method, points), 0, kRelative) << name_of(method);
  // The two normal equations of V n - k p, solved by Cramer's rule.
  const auto each = static_cast<double>(kSpeeds.size());
  const double nn = each * sum(kSpeeds, 2), pp = each * sum(kPressures, 2),
               np = sum(kSpeeds, 1) * sum(kPressures, 1);
  const double right_n = -sum(kSpeeds, 2) * sum(kPressures, 1) / modulus,
               right_p = -sum(kSpeeds, 1) * sum(kPressures, 2) / modulus;
  const double expected = (right_n * pp - right_p * np) / (nn * pp - np * np);
  EXPECT_LT(expected, -1e-3);
  EXPECT_NEAR(bias(Method::wilson, points), expected, kRelative);
}

TEST(DerivedDisplacementTest, TurbulentSlipBiasesByTheLineThroughTheRoot) {
  const auto root = [](double p) { return 1e-9 * std::sqrt(p); };
  const auto points = points_of([&](double, double p) { return root(p); });
  const double at_zero = line_at_zero(root);
  ASSERT_GT(at_zero, 0);
  EXPECT_NEAR(bias(Method::iso_8426, points), -at_zero / (kVolume * 25), kRelative);
  EXPECT_NEAR(bias(Method::toet, points), 0, kRelative);
}

TEST(DerivedDisplacementTest, AMotorTakesMoreThanItsDisplacement) {
  const auto points = points_of([](double, double p) { return -2e-12 * p; });
  for (const Method method : kDisplacementMethods)
    EXPECT_NEAR(bias(method, points), 0, kRelative) << name_of(method);
  EXPECT_NEAR(volumetric_efficiency(kVolume, {10, 0, 1e7, kVolume * 10 / 0.9}, true), 0.9,
              kRelative);
  EXPECT_FALSE(is_computed(volumetric_efficiency(kVolume, {10, 0, 1e7, 0}, true)));
  EXPECT_NEAR(volumetric_efficiency(kVolume, {10, 0, 1e7, kVolume * 9}, false), 0.9, kRelative);
}

std::string refusal(Method method, const std::vector<FlowPoint>& points) {
  return reason_of([&] { derived_displacement(method, points); });
}

TEST(DerivedDisplacementTest, TooFewPointsAreRefused) {
  const auto slip = [](double, double p) { return 2e-12 * p; };
  for (const Method method : kDisplacementMethods) {
    EXPECT_THAT(refusal(method, {}), HasSubstr("two pressures")) << name_of(method);
    EXPECT_THAT(refusal(method, points_of(slip, {10}, {1e7})), HasSubstr("two pressures"))
        << name_of(method);
  }
  for (const Method method : {Method::iso_8426, Method::toet, Method::zero_pressure_line})
    EXPECT_THAT(refusal(method, points_of(slip, {10, 20}, {1e7})), HasSubstr("two pressures"))
        << name_of(method);
  const auto one_speed = points_of(slip, {10});
  EXPECT_THAT(refusal(Method::toet, one_speed), HasSubstr("two speeds each"));
  for (const Method method : {Method::iso_8426, Method::wilson, Method::zero_pressure_line})
    EXPECT_NEAR(bias(method, one_speed), 0, kRelative) << name_of(method);
}

TEST(DerivedDisplacementTest, MissingPointsBiasNothing) {
  auto points = points_of([](double, double p) { return 2e-12 * p; });
  points.erase(points.begin() + 14);                 // of the highest speed
  points.erase(points.begin(), points.begin() + 3);  // the lowest speed has one point left
  for (const Method method : kDisplacementMethods)
    EXPECT_NEAR(bias(method, points), 0, kRelative) << name_of(method);
}

// ---- The pump of a case

DisplacementStudy study_of(const std::string& name, const std::vector<std::string>& changes = {}) {
  const Case the_case =
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/" + name + ".toml", changes);
  return displacement_study(the_case, usual_test_speeds(the_case), usual_test_pressures(the_case));
}

double bias_of(const DisplacementStudy& study, std::size_t meter, Method method) {
  return study.meters.at(meter).by(method).bias;
}

constexpr std::size_t kAtDelivery = 0, kAtSuction = 1;

// Written down before the first run. A pump delivers V less what compression of its air and of its
// dead volume takes: the air (0.5 %) is compressed at every pressure of the test, so that lines
// over the pressure do not see it: about -0.6 % at delivery pressure, -0.1 % at suction pressure.
// Filling at the highest speed takes some 0.1 to 0.3 % more.
//   1. At delivery pressure every method is 0.3 to 1.5 % low.
//   2. At suction pressure every method gives more than at delivery pressure.
//   3. With 2 % of air every method is at least 1 % lower still.
//   4. By the geometric displacement no efficiency is above 100 %, by no method one at the highest
//      pressure.
// Two expectations were wrong. Without air ISO 8426 at suction pressure was to be within 0.3 %: it
// is 0.38 % low, because this plate connects both ports for 6 deg of a turn. What the air does is
// the difference of both flow meters, so that is what is held now: it goes with the air. And ISO
// 8426 was to give efficiencies above 100 %: it gives none here, Wilson does.
TEST(DerivedDisplacementTest, AirMakesAPumpsDisplacementLow) {
  const DisplacementStudy usual = study_of("bap63_rated_timed_plate");
  ASSERT_TRUE(usual.failed.empty());
  ASSERT_EQ(usual.meters.at(kAtDelivery).points.size(), 30U);
  const DisplacementStudy more = study_of("bap63_rated_timed_plate", {"hydraulics.air_percent=2"});
  const DisplacementStudy none =
      study_of("bap63_rated_timed_plate", {"hydraulics.air_percent=0.001"});
  for (const Method method : kDisplacementMethods) {
    SCOPED_TRACE(name_of(method));
    EXPECT_LT(bias_of(usual, kAtDelivery, method), -0.003);
    EXPECT_GT(bias_of(usual, kAtDelivery, method), -0.015);
    EXPECT_GT(bias_of(usual, kAtSuction, method), bias_of(usual, kAtDelivery, method));
    EXPECT_LT(bias_of(more, kAtDelivery, method), bias_of(usual, kAtDelivery, method) - 0.01);
  }
  const auto between_meters = [](const DisplacementStudy& study) {
    return bias_of(study, kAtSuction, Method::iso_8426) -
           bias_of(study, kAtDelivery, Method::iso_8426);
  };
  EXPECT_NEAR(between_meters(usual), 0.005, 0.001);
  EXPECT_NEAR(between_meters(more), 0.02, 0.004);
  EXPECT_NEAR(between_meters(none), 0, 0.0005);

  const MeteredDisplacement& meter = usual.meters.at(kAtDelivery);
  EXPECT_GT(meter.by(Method::wilson).above_one, 0U);
  EXPECT_EQ(meter.by(Method::iso_8426).above_one, 0U);
  for (std::size_t i = 0; i < meter.points.size(); ++i) {
    EXPECT_LT(volumetric_efficiency(usual.geometric, meter.points[i], false), 1);
    if (i % 6 != 5) continue;
    for (const Method method : kDisplacementMethods)
      EXPECT_LT(meter.by(method).efficiency[i], 1) << name_of(method);
  }
}

// Written down before the first run: the rated plate connects both ports for 30 deg of a turn. What
// passes goes with the root of the pressure and takes more of a slow turn, so that ISO 8426 is
// lower at the lowest speed than at the highest, by 1 % at least.
TEST(DerivedDisplacementTest, ConnectedPortsMakeTheSpeedOfTheTestMatter) {
  const DisplacementStudy study = study_of("bap63_rated_hydraulic");
  const auto& by_speed = study.meters.at(kAtDelivery).iso_by_speed;
  ASSERT_EQ(by_speed.size(), 5U);
  EXPECT_LT(by_speed.front().second / study.geometric,
            by_speed.back().second / study.geometric - 0.01);
  EXPECT_EQ(by_speed.back().second, study.meters.at(kAtDelivery).by(Method::iso_8426).volume);
}

// Written down before the first run: a motor takes V and what compression of its dead volume takes,
// whose air adds some 0.1 %: ISO 8426 within 1 % at delivery pressure, more at suction pressure, by
// about the air (0.5 %).
TEST(DerivedDisplacementTest, AMotorIsTestedBackwards) {
  const DisplacementStudy study = study_of("bap63_motoring");
  ASSERT_TRUE(study.motor);
  for (const FlowPoint& point : study.meters.at(kAtDelivery).points) {
    EXPECT_GT(point.speed, 0);
    EXPECT_GT(point.flow, 0);
    EXPECT_LT(volumetric_efficiency(study.geometric, point, true), 1.01);
  }
  EXPECT_LT(std::abs(bias_of(study, kAtDelivery, Method::iso_8426)), 0.01);
  EXPECT_NEAR(
      bias_of(study, kAtSuction, Method::iso_8426) - bias_of(study, kAtDelivery, Method::iso_8426),
      0.005, 0.002);
}

// Leakage of half the chambers takes all that the pump displaces: at 150 rpm below 50 bar.
const std::vector<std::string> kLeak = {"hydraulics.leakage_l_per_min_per_bar=0.15",
                                        "pressure.delivery_bar=100"};

TEST(DerivedDisplacementTest, FailedPointsAreNamedAndLeftOut) {
  const Case the_case =
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated_hydraulic.toml", kLeak);
  const DisplacementStudy study = displacement_study(the_case, {150, 1200, 1500}, {20, 60, 100});
  ASSERT_EQ(study.failed.size(), 2U);
  EXPECT_EQ(study.failed[0].point, "speed_rpm = 150, delivery_bar = 60");
  EXPECT_EQ(study.meters.at(kAtDelivery).points.size(), 7U);
  for (const Method method : kDisplacementMethods)
    EXPECT_TRUE(is_computed(study.meters.at(kAtDelivery).by(method).volume)) << name_of(method);
  const std::string csv = to_csv(study);
  EXPECT_THAT(csv, HasSubstr("cannot be reached"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 10);
  EXPECT_THROW(displacement_study(the_case, {150}, {60, 100}), ComputationError);
  EXPECT_THROW(displacement_study(the_case, {150, 1200}, {20}), InputError);
}

TEST(DerivedDisplacementTest, OneSpeedLeavesToetOut) {
  const Case the_case =
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated_hydraulic.toml", {});
  const DisplacementStudy study = displacement_study(the_case, {1500}, {100, 275});
  const DerivedDisplacement& toet = study.meters.at(kAtDelivery).by(Method::toet);
  EXPECT_FALSE(is_computed(toet.volume));
  EXPECT_THAT(toet.reason, HasSubstr("two speeds each"));
}

// The flow of a point and the geometric displacement are those that `pressure` states.
TEST(DerivedDisplacementTest, StatesTheFlowsOfTheOperatingPoint) {
  const Case the_case =
      read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated_hydraulic.toml", {});
  const DisplacementStudy study = displacement_study(the_case, {1500}, {100, 275});
  const PreparedCase ready = prepare(the_case);
  EXPECT_NEAR(study.meters.at(kAtSuction).points.at(1).flow, ready.hydraulics->summary.flow,
              1e-9 * ready.hydraulics->summary.flow);
  EXPECT_NEAR(study.meters.at(kAtDelivery).points.at(1).flow, flow_at_delivery(*ready.hydraulics),
              1e-9 * ready.hydraulics->summary.flow);
  EXPECT_NEAR(study.geometric * 25, ideal_flow(the_case), 1e-12 * ideal_flow(the_case));
}

}  // namespace
}  // namespace bentaxis::study
