// Identification: what data determine where the answer is known beforehand.
#include "bentaxis/designs/identify.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bentaxis/designs/identify_document.h"
#include "bentaxis/designs/points.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/run.h"

namespace bentaxis::designs {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal_of(const std::function<void()>& job) {
  try {
    job();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

Case base_case() {
  return read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml",
                   {"operation.samples_per_revolution=60", "friction.piston_coulomb_N=0"});
}

double value_of(const Case& base, const std::string& name) {
  return outputs_of({output(name, base)}, study::prepare(base), study::Model::analytic)[0];
}

// Of the mean torque, which is a straight line over the delivery pressure.
double torque_at(double bar) {
  Case base = base_case();
  base.pressure.ports.delivery = bar * 1e5;
  return value_of(base, "mean:Td");
}
double torque_per_bar() { return (torque_at(275) - torque_at(265)) / 10; }

Datum number(const Case& base, const std::string& name, double value, double uncertainty) {
  Datum datum;
  datum.output = output(name, base);
  datum.what = datum.output->name;
  datum.value = value;
  datum.uncertainty = uncertainty;
  return datum;
}

IdentificationData data_of(const Case& base, const std::vector<std::string>& unknowns,
                           std::vector<Datum> data) {
  IdentificationData all;
  for (const std::string& text : unknowns) all.unknowns.push_back(unknown_of("--vary", text, base));
  all.data = std::move(data);
  return all;
}

class Identify : public testing::Test {
 protected:
  void SetUp() override {
    if (least_squares_library().empty()) GTEST_SKIP() << "without Ceres";
  }
  static Identification fit(const DataModel& model, bool profiles = false) {
    IdentifyOptions options;
    options.starts = 3;
    options.posterior = options.leave_one_out = false;
    options.profiles = profiles;
    return identify(model, options);
  }
};

// The mean torque is linear in the delivery pressure: its profile is that of a straight line.
TEST_F(Identify, ALinearUnknownHasTheLimitsOfItsNormalDistribution) {
  const Case base = base_case();
  const double torque = value_of(base, "mean:Td");
  const DataModel model(base, data_of(base, {"pressure.delivery_bar=200:400"},
                                      {number(base, "mean:Td", torque, 0.01 * torque)}));
  const Identification result = fit(model, true);
  EXPECT_NEAR(result.fit.x[0], 275, 1e-6);
  const double deviation = 0.01 * torque / torque_per_bar();
  EXPECT_NEAR(result.profiles[0].low, 275 - 1.959964 * deviation, 0.02 * deviation);
  EXPECT_NEAR(result.profiles[0].high, 275 + 1.959964 * deviation, 0.02 * deviation);
  EXPECT_FALSE(result.profiles[0].open_low || result.profiles[0].open_high);
  const double spread = 200 / std::sqrt(12.0);
  EXPECT_NEAR(result.information.deviation[0], deviation / std::hypot(1, deviation / spread), 1e-4);
}

// Nothing is interpolated: a record of the model itself has no residual, beside a statistic of the
// whole turn, by the kernel and without it.
TEST(IdentificationRecords, AreComparedAtTheirOwnAngles) {
  const Case base = base_case();  // of 60 samples
  const std::vector<double> theta = {-0.7, 0.3, 47.9, 182.1, 182.05, 359.9, 407.9};
  const ResultTable there = study::run_at_angles(study::prepare(base), theta, {});
  const std::size_t column = there.find("Rs_1_z2_N");
  ASSERT_LT(column, there.columns());
  Datum record;
  record.what = "Rs_1_z2_N";
  record.uncertainty = 1;
  record.curve.emplace(Datum::Curve{column, theta, {}, std::vector<double>(theta.size(), 1.0)});
  for (std::size_t row = 0; row < theta.size(); ++row)
    record.curve->values.push_back(there.at(row, column));
  const double torque = value_of(base, "mean:Td");
  for (const bool kernel : {true, false}) {
    const DataModel model(base,
                          data_of(base, {"pressure.delivery_bar=200:400"},
                                  {record, number(base, "mean:Td", torque, 1)}),
                          kernel);
    std::vector<double> numbers(model.numbers());
    ASSERT_TRUE(model.predict(model.start(), numbers));
    for (std::size_t row = 0; row < theta.size(); ++row)
      EXPECT_NEAR(numbers[row], record.curve->values[row], 1e-9 * there.peak("Rs")) << theta[row];
    EXPECT_NEAR(numbers.back(), torque, 1e-9 * torque);
    // And with another design after it.
    ASSERT_TRUE(model.predict(std::vector<double>{300}, numbers));
    Case other = base;
    other.pressure.ports.delivery = 300e5;
    const ResultTable then = study::run_at_angles(study::prepare(other), theta, {});
    for (std::size_t row = 0; row < theta.size(); ++row)
      EXPECT_NEAR(numbers[row], then.at(row, column), 1e-9 * there.peak("Rs")) << theta[row];
  }
}

TEST_F(Identify, WordsNameWhatIsDeterminedOnlyTogether) {
  const Case base = base_case();
  const Datum torque = number(base, "mean:Td", value_of(base, "mean:Td"), 0.1);
  const DataModel difference(
      base,
      data_of(base, {"pressure.delivery_bar=250:300", "pressure.suction_bar=-0.9:20"}, {torque}));
  EXPECT_THAT(fit(difference).information.words,
              Contains("pressure.delivery_bar and pressure.suction_bar are determined only through "
                       "their difference"));
  const DataModel product(
      base,
      data_of(base,
              {"friction.block_viscous_Nm_per_rpm=0.004:0.007", "operation.speed_rpm=1000:2000"},
              {number(base, "mean:Tcs_z2", value_of(base, "mean:Tcs_z2"), 0.01)}));
  EXPECT_THAT(
      fit(product).information.words,
      Contains("friction.block_viscous_Nm_per_rpm and operation.speed_rpm are determined only "
               "through their product"));
  const DataModel nothing(
      base, data_of(base, {"pressure.delivery_bar=250:300", "block.mass_kg=1:2"}, {torque}));
  EXPECT_THAT(fit(nothing).information.words, Contains("the data do not determine block.mass_kg"));
}

// What is said where the data notice everything but moves along one direction (in the unknowns'
// units), however that came about.
std::vector<std::string> words_where_open(const DataModel& model, std::vector<double> direction) {
  const std::vector<double> x = model.start();
  const std::size_t n = x.size();
  const std::vector<double> spread =
      information_of(model, x, std::vector<double>(n * n)).spread;  // whatever the data
  double square = 0;
  for (std::size_t i = 0; i < n; ++i) {
    direction[i] /= spread[i];
    square += direction[i] * direction[i];
  }
  std::vector<double> jacobian(n * n);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t i = 0; i < n; ++i)
      jacobian[r * n + i] =
          1000 * ((r == i ? 1 : 0) - direction[r] * direction[i] / square) / spread[i];
  return information_of(model, x, jacobian).words;
}

TEST_F(Identify, WordsFollowTheDirectionThatIsOpen) {
  const Case base = base_case();
  const std::vector<Datum> data = {number(base, "mean:Td", value_of(base, "mean:Td"), 0.1)};
  const DataModel two(
      base,
      data_of(base, {"pressure.delivery_bar=250:300", "operation.speed_rpm=1000:2000"}, data));
  const std::string names = "pressure.delivery_bar and operation.speed_rpm are determined only ";
  EXPECT_THAT(words_where_open(two, {275, 1500}), ElementsAre(names + "through their ratio"));
  EXPECT_THAT(words_where_open(two, {275, -1500}), ElementsAre(names + "through their product"));
  // Along (10, 60) the sum of -60 times the one and 10 times the other stays; lengths are those of
  // a direction of length 1 in spreads, 50 and 1000 over the root of 12.
  EXPECT_THAT(words_where_open(two, {10, 60}),
              ElementsAre(names + "together: through 83 x pressure.delivery_bar - 13.8 x "
                                  "operation.speed_rpm"));
  EXPECT_THAT(words_where_open(two, {10, -60}),
              ElementsAre(names + "together: through 83 x pressure.delivery_bar + 13.8 x "
                                  "operation.speed_rpm"));
  const DataModel bars(
      base, data_of(base, {"pressure.delivery_bar=250:300", "pressure.suction_bar=-0.9:20"}, data));
  EXPECT_THAT(words_where_open(bars, {1, -1}),
              ElementsAre("pressure.delivery_bar and pressure.suction_bar are determined only "
                          "through their sum"));
  // The largest share first; less than a seventh of the direction is not named.
  const DataModel four(base, data_of(base,
                                     {"pressure.delivery_bar=250:300", "pressure.suction_bar=0:20",
                                      "block.mass_kg=1:2", "operation.speed_rpm=1000:2000"},
                                     data));
  const double root = std::sqrt(12.0);
  EXPECT_THAT(
      words_where_open(four, {0.45 * 50 / root, 0.8 * 20 / root, -0.384 / root, 0.1 * 1000 / root}),
      ElementsAre("nearly unnoticed together: pressure.suction_bar +4.62 bar, "
                  "pressure.delivery_bar +6.5 bar, block.mass_kg -0.111 kg"));
  EXPECT_THAT(words_where_open(
                  four, {0.45 * 50 / root, 0.8 * 20 / root, -0.352 / root, 0.18 * 1000 / root}),
              ElementsAre(testing::EndsWith(", operation.speed_rpm +52 rpm")));
}

// Where the fit ends is right to rounding; the words are those of the place.
TEST_F(Identify, WordsDoNotDependOnRounding) {
  for (const char* suction : {"0", "1e-15", "-1e-13", "1e-9"}) {
    const Case base = read_case(
        BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml",
        {"operation.samples_per_revolution=60", std::string("pressure.suction_bar=") + suction});
    for (const double share : {0.0, 1e-15, -1e-13}) {
      const double torque = (1 + share) * value_of(base, "mean:Td");
      const DataModel model(
          base, data_of(base, {"pressure.delivery_bar=250:300", "pressure.suction_bar=-0.9:20"},
                        {number(base, "mean:Td", torque, 0.1)}));
      EXPECT_THAT(fit(model).information.words,
                  ElementsAre("pressure.delivery_bar and pressure.suction_bar are determined only "
                              "through their difference"))
          << suction << " bar, " << share;
    }
  }
}

// Of all pumps that fit equally well the nearest to the case, in shares of the bounds: with data
// that know only the difference of two pressures this is a foot of a perpendicular.
TEST_F(Identify, WhatTheDataLeaveOpenStaysAsItWas) {
  const Case base = base_case();
  const DataModel model(base, data_of(base,
                                      {"pressure.delivery_bar=250:300", "pressure.suction_bar=0:20",
                                       "block.mass_kg=0.1:9"},
                                      {number(base, "mean:Td", torque_at(265), 0.1)}));
  const std::vector<double> start = model.start();
  const double delivery = 50 * 50, suction = 20 * 20;
  for (const std::uint64_t seed : {1, 2, 3}) {
    IdentifyOptions options;
    options.starts = 4;
    options.seed = seed;
    options.posterior = options.leave_one_out = options.profiles = false;
    const Identification result = identify(model, options);
    EXPECT_LT(result.fit.sum_of_squares, 0.01);
    EXPECT_NEAR(result.fit.x[0], 275 - 10 * delivery / (delivery + suction), 0.01);
    EXPECT_NEAR(result.fit.x[1], 10 * suction / (delivery + suction), 0.01);
    EXPECT_NEAR(result.fit.x[2], start[2], 1e-6);
  }
}

TEST_F(Identify, AWindowPushesOnlyFromOutside) {
  const Case base = base_case();
  Datum window = number(base, "mean:Td", 0, 1);
  window.value.reset();
  window.low = -HUGE_VAL;
  window.high = torque_at(200);
  const DataModel model(base, data_of(base, {"pressure.delivery_bar=100:400"}, {window}));
  EXPECT_EQ(model.residual(window, 0, window.high - 5), 0);
  EXPECT_DOUBLE_EQ(model.residual(window, 0, window.high + 5), 5);
  const Identification result = fit(model, true);
  EXPECT_NEAR(result.fit.sum_of_squares, 0, 1e-6);
  EXPECT_TRUE(result.profiles[0].open_low);
  EXPECT_FALSE(result.profiles[0].open_high);
  // The torque may be 1.96 beyond its edge.
  EXPECT_NEAR(result.profiles[0].high, 200 + 1.959964 / torque_per_bar(), 0.02);
}

TEST_F(Identify, ANumberLeftOutIsPredictedByTheOthers) {
  const Case base = base_case();
  const double torque = value_of(base, "mean:Td"), force = value_of(base, "max:Rs_z2");
  // The second of two that should say the same is 2 % too high.
  const DataModel model(base, data_of(base, {"pressure.delivery_bar=200:400"},
                                      {number(base, "mean:Td", torque, 1e-3 * torque),
                                       number(base, "max:Rs_z2", 1.02 * force, 1e-3 * force)}));
  const auto left = leave_one_out(model, fit(model).fit, 1, {});
  ASSERT_EQ(left.size(), 2U);
  EXPECT_NEAR(left[1].value, force, 1e-3 * force) << "by the torque alone";
  EXPECT_NEAR(left[1].distance, -20 / std::sqrt(2.0), 0.3) << "both uncertainties count";
}

TEST_F(Identify, ThePosteriorIsThatOfALineAndDoesNotDependOnThreads) {
  const Case base = base_case();
  const double torque = value_of(base, "mean:Td");
  const DataModel model(base, data_of(base, {"pressure.delivery_bar=200:350", "block.mass_kg=1:2"},
                                      {number(base, "mean:Td", torque, 0.01 * torque)}));
  IdentifyOptions options;
  options.steps = 400;
  options.draws = 1000;
  options.profiles = options.leave_one_out = false;
  options.threads = 1;
  const Identification one = identify(model, options);
  options.threads = 2;
  const Identification two = identify(model, options);
  EXPECT_EQ(one.posterior.unknowns, two.posterior.unknowns);
  double mean = 0, square = 0, mass = 0;
  for (std::size_t d = 0; d < one.posterior.count; ++d) {
    mean += one.posterior.unknowns[2 * d] / 1000;
    mass += one.posterior.unknowns[2 * d + 1] / 1000;
  }
  for (std::size_t d = 0; d < one.posterior.count; ++d)
    square += std::pow(one.posterior.unknowns[2 * d] - mean, 2) / 999;
  const double deviation = 0.01 * torque / torque_per_bar();
  EXPECT_GT(one.posterior.effective, 300);
  // Within four of their own standard errors of 300 independent draws.
  EXPECT_NEAR(mean, 275, 4 * deviation / std::sqrt(300));
  EXPECT_NEAR(std::sqrt(square), deviation, 4 * deviation / std::sqrt(600));
  EXPECT_NEAR(mass, 1.5, 4 / std::sqrt(12 * 300)) << "nothing is known of it but its bounds";
  // Forces of the pistons go with the pressure, so does their band. A quantile at 2.5 % of 300
  // independent draws errs by 0.15 of the deviation, standard.
  const auto axial = std::find_if(one.bands.begin(), one.bands.end(), [&](const ReactionBand& b) {
    return b.column == output("max:Rs_z2", base).columns[0];
  });
  ASSERT_NE(axial, one.bands.end());
  EXPECT_NEAR(axial->half_width, 1.96 * deviation / 275, 3 * 0.15 / std::sqrt(2) * deviation / 275);

  // Walkers that have not settled are said.
  EXPECT_FALSE(identify_document(model, one, {}, {}).warnings);
  EXPECT_THAT(identify_text(model, one), testing::Not(HasSubstr("not converged")));
  Identification unsettled = one;
  unsettled.posterior.rhat.back() = 1.2;
  EXPECT_EQ(identify_document(model, unsettled, {}, {}).warnings.value().at(0).name,
            "Posterior not settled");
  EXPECT_THAT(identify_text(model, unsettled), HasSubstr("R-hat 1.2"));
}

// Whatever coordinates the walkers move in: where data say nothing, each unknown is as likely
// anywhere between its bounds.
TEST_F(Identify, WithoutNewsThePosteriorIsEvenBetweenTheBounds) {
  const Case base = base_case();
  Datum no_news = number(base, "mean:Td", 0, 1);
  no_news.value.reset();
  no_news.low = -1e9;
  no_news.high = HUGE_VAL;
  const DataModel model(base,
                        data_of(base,
                                {"pump.tilt_deg=20:60", "gear.pressure_angle_deg=5:40",
                                 "pressure.delivery_bar=10:400", "pressure.suction_bar=-0.5:5"},
                                {no_news}));
  IdentifyOptions options;
  options.steps = 600;
  options.draws = 2000;
  options.profiles = options.leave_one_out = false;
  const Posterior posterior = identify(model, options).posterior;
  ASSERT_GT(posterior.effective, 300);
  for (std::size_t i = 0; i < model.size(); ++i) {
    const Unknown& u = model.data().unknowns[i];
    double mean = 0, square = 0;
    for (std::size_t d = 0; d < posterior.count; ++d) {
      const double share = (posterior.unknowns[d * model.size() + i] - u.low) / (u.high - u.low);
      mean += share / static_cast<double>(posterior.count);
      square += share * share / static_cast<double>(posterior.count);
    }
    // Four standard errors of 300 independent draws; even in ln sin the mean would be 0.38, in
    // ln cos 0.64, in the logarithm 0.25.
    EXPECT_NEAR(mean, 0.5, 4 / std::sqrt(12 * 300)) << u.name();
    EXPECT_NEAR(square, 1 / 3.0, 4 * std::sqrt(4 / 45.0 / 300)) << u.name();
  }
}

TEST_F(Identify, FewDrawsAreOfManyWalkers) {
  const Case base = base_case();
  const double torque = torque_at(275);
  const DataModel model(base, data_of(base, {"pressure.delivery_bar=200:350"},
                                      {number(base, "mean:Td", torque, 0.01 * torque)}));
  IdentifyOptions options;
  options.steps = 20;
  options.draws = 10;
  options.profiles = options.leave_one_out = false;
  std::vector<double> draws = identify(model, options).posterior.unknowns;
  std::sort(draws.begin(), draws.end());
  // Ten independent normal numbers lie within one deviation once in 100000 times.
  EXPECT_GT(draws.back() - draws.front(), 0.01 * torque / torque_per_bar());
}

TEST_F(Identify, TheNumbersOfThePaperAreReadAndTheShippedCaseIsNearThem) {
  const Case base = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml",
                              {"operation.samples_per_revolution=180"});
  IdentificationData data;
  read_identification(BENTAXIS_SOURCE_DIR "/reference_data/published/bap63/unknowns.toml", base,
                      data);
  const DataModel model(base, data);
  std::vector<double> numbers(model.numbers());
  ASSERT_TRUE(model.predict(model.start(), numbers));
  int fitted = 0, predicted = 0, left_out = 0;
  for (std::size_t i = 0; i < data.data.size(); ++i) {
    const Datum& datum = model.data().data[i];
    fitted += datum.use == Use::fitted;
    predicted += datum.use == Use::predicted;
    left_out += datum.use == Use::left_out;
    EXPECT_EQ(datum.use == Use::left_out, !datum.reason.empty()) << datum.what;
    if (datum.what == "displacement") {
      EXPECT_NEAR(numbers[model.place_of(i)], 63.71, 0.01);
    } else if (datum.what == "torque from shaft to block at 0 deg" && datum.variant == "Cc = 0") {
      EXPECT_NEAR(numbers[model.place_of(i)], 6.10, 0.02);
    }
  }
  EXPECT_EQ(fitted + predicted + left_out, static_cast<int>(data.data.size()));
  EXPECT_GE(fitted, 20);
  EXPECT_GE(predicted, 10);
}

// What the kernel gives for the data of the paper, a record and outputs: what the general way does.
TEST_F(Identify, TheKernelGivesTheSameNumbers) {
  const Case base = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml",
                              {"operation.samples_per_revolution=60"});
  IdentificationData data;
  read_identification(BENTAXIS_SOURCE_DIR "/reference_data/published/bap63/unknowns.toml", base,
                      data);
  const ResultTable turn = study::run_turn(study::prepare(base), study::Model::analytic);
  for (const char* name : {"Rb1_x1_N", "Tcs_z2_Nm"}) {
    Datum record;
    record.what = name;
    record.uncertainty = 1;
    record.curve.emplace();
    record.curve->column = turn.find(name);
    record.curve->theta_deg = {1, 100.5, 359};
    record.curve->values = record.curve->uncertainties = {1, 1, 1};
    data.data.push_back(record);
  }
  for (const char* name : {"peak:Rs_3", "rms:Rb2_y1", "stroke_mm"})
    data.data.push_back(number(base, name, 1, 1));
  const DataModel fast(base, data), general(base, data, false);
  const auto points = latin_hypercube(fast.size(), 20, 1);
  int pumps = 0;
  for (std::size_t p = 0; p < points->size(); ++p) {
    std::vector<double> x(fast.size()), found(fast.numbers()), expected(fast.numbers());
    points->point(p, x);
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] = data.unknowns[i].low + x[i] * (data.unknowns[i].high - data.unknowns[i].low);
    const bool pump = general.predict(x, expected);
    ASSERT_EQ(fast.predict(x, found), pump);
    if (!pump) continue;
    ++pumps;
    // Rb1 and Rb2 are differences of forces 1e5 N large.
    for (std::size_t i = 0; i < data.data.size(); ++i)
      for (std::size_t k = 0; k < data.data[i].size(); ++k) {
        const std::size_t at = fast.place_of(i) + k;
        EXPECT_EQ(is_computed(found[at]), is_computed(expected[at])) << data.data[i].what;
        if (!is_computed(expected[at])) continue;
        EXPECT_NEAR(found[at], expected[at], 1e-12 * std::max(1e5, std::abs(expected[at])))
            << data.data[i].what;
      }
  }
  EXPECT_GE(pumps, 10);
}

TEST_F(Identify, WhatCannotBeIsRefused) {
  const Case base = base_case();
  const Datum torque = number(base, "mean:Td", 1, 1);
  const auto refusal = [&](const IdentificationData& data) {
    return refusal_of([&] { DataModel(base, data); });
  };
  EXPECT_THAT(refusal(data_of(base, {}, {torque})), HasSubstr("nothing is unknown"));
  EXPECT_THAT(refusal(data_of(base, {"pump.tilt_deg=30:50"}, {})), HasSubstr("nothing to which"));
  EXPECT_THAT(refusal(data_of(base, {"pump.tilt_deg=30:50", "pump.tilt_deg=30:50"}, {torque})),
              HasSubstr("unknown twice"));
  EXPECT_THAT(refusal_of([&] { unknown_of("--vary", "pump.tilt_deg=50:30", base); }),
              HasSubstr("below"));
  EXPECT_THAT(refusal_of([&] { unknown_of("--vary", "pump.pistons=3:9", base); }),
              HasSubstr("is not continuous"));
}

}  // namespace
}  // namespace bentaxis::designs
