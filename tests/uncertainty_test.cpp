// Distributions, correlated values, and what they do to outputs.
#include "bentaxis/designs/uncertainty.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <sstream>

#include "bentaxis/designs/distribution.h"
#include "bentaxis/designs/propagation.h"
#include "bentaxis/designs/uncertainty_document.h"
#include "bentaxis/designs/validation.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "support.h"

namespace bentaxis::designs {
namespace {

using test::refusal;

const std::string kRated = std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml";

double standard_cumulative(double score) { return std::erfc(-score / std::sqrt(2.0)) / 2; }

// Against closed forms: tables of the normal law, moments of the lognormal one, areas of a
// triangle.
TEST(Distribution, HasItsLaw) {
  const Distribution normal = distribution("normal(40, 0.1)", "x");
  EXPECT_NEAR(normal.quantile(0.975), 40.195996398454005, 1e-13);
  EXPECT_NEAR(normal.cumulative(39.9), 0.15865525393145707, 1e-13);
  EXPECT_NEAR(normal.density(40), 1 / (0.1 * std::sqrt(2 * M_PI)), 1e-13);
  const Distribution lognormal = distribution("lognormal(2, 0.5)", "x");
  EXPECT_NEAR(lognormal.quantile(0.5), 2, 1e-14);
  EXPECT_NEAR(lognormal.quantile(0.975), 2 * std::exp(0.5 * 1.959963984540054), 1e-13);
  EXPECT_NEAR(lognormal.mean(), 2 * std::exp(0.125), 1e-14);
  EXPECT_NEAR(lognormal.standard_deviation(), lognormal.mean() * std::sqrt(std::expm1(0.25)),
              1e-14);
  EXPECT_EQ(lognormal.cumulative(-1), 0);
  EXPECT_EQ(lognormal.density(0), 0);
  const Distribution triangular = distribution(" triangular(0, 1,4 ) ", "x");
  EXPECT_NEAR(triangular.quantile(0.25), 1, 1e-14);
  EXPECT_NEAR(triangular.mean(), 5.0 / 3, 1e-14);
  EXPECT_NEAR(triangular.density(1), 0.5, 1e-14);
  const Distribution uniform = distribution("uniform(-1, 3)", "x");
  EXPECT_NEAR(uniform.quantile(0.25), 0, 1e-15);
  EXPECT_NEAR(uniform.standard_deviation(), 4 / std::sqrt(12.0), 1e-15);
  for (const Distribution& d : {normal, lognormal, triangular, uniform}) {
    EXPECT_EQ(distribution(d.text(), "x").text(), d.text());
    for (const double score : {-3.0, -0.5, 0.0, 2.0, 6.0}) {  // as likely exceeded
      const double size = std::abs(d.quantile(0.5)) + d.standard_deviation();
      EXPECT_NEAR(d.cumulative(d.at_score(score)), standard_cumulative(score), 1e-13) << d.text();
      EXPECT_NEAR(d.at_score(score), d.quantile(standard_cumulative(score)),
                  score > 5 ? 1e-5 * size : 1e-13 * size)  // a share near 1 has lost its digits
          << d.text() << score;
    }
  }
}

TEST(Distribution, IsAboutAValue) {
  EXPECT_EQ(distribution("relative(0.01)", "x", -50).text(), "normal(-50, 0.5)");
  EXPECT_EQ(distribution("normal(0.25)", "x", 40).text(), "normal(40, 0.25)");
}

TEST(Distribution, RefusesWhatIsNone) {
  const auto why = [](const std::string& text) {
    return refusal([&] { distribution(text, "pump.tilt_deg"); });
  };
  EXPECT_EQ(why("normal(40, 0)"),
            "pump.tilt_deg = normal(40, 0): the standard deviation must be > 0");
  EXPECT_THAT(why("norml(40, 1)"), testing::HasSubstr("did you mean \"normal\""));
  EXPECT_THAT(why("40"), testing::HasSubstr("such as normal"));
  EXPECT_THAT(why("normal(40)"), testing::HasSubstr("takes 2 numbers"));
  EXPECT_THAT(why("relative(0.1)"), testing::HasSubstr("no such distribution"));
  EXPECT_THAT(why("uniform(2, 1)"), testing::HasSubstr("below"));
  EXPECT_THAT(why("uniform(1, inf)"), testing::HasSubstr("finite"));
  EXPECT_THAT(why("uniform(1, )"), testing::HasSubstr("\"\" must be a finite number"));
  EXPECT_THAT(why("triangular(0, 5, 4)"), testing::HasSubstr("the mode"));
  EXPECT_THAT(why("lognormal(0, 1)"), testing::HasSubstr("median must be > 0"));
  EXPECT_THAT(why("lognormal(1, -1)"), testing::HasSubstr("logarithm must be > 0"));
}

// A case with what is not known of it.
Case uncertain(const std::vector<UncertaintyData::Parameter>& parameters,
               const std::vector<UncertaintyData::Correlation>& correlations = {}) {
  Case made = read_case(kRated);
  made.uncertainty = {parameters, correlations};
  return made;
}

TEST(UncertainVariables, AreWhatTheCaseSays) {
  const UncertainVariables all = uncertain_variables(
      uncertain({{"pump.tilt_deg", "normal(0.1)"}, {"piston.mass_kg", "relative(0.02)"}}));
  EXPECT_TRUE(all.independent());
  EXPECT_EQ(all.distributions[0].text(), "normal(40, 0.1)");
  const std::array shares = {standard_cumulative(1), standard_cumulative(-1)};
  std::array<double, 2> values{};
  all.values(shares, values);
  EXPECT_NEAR(values[0], 40.1, 1e-12);
  EXPECT_NEAR(values[1], 0.98 * all.variables[1].value(read_case(kRated)), 1e-12);
}

// Scores of 1 and 0, then 0 and 1: correlated ones are the columns of Cholesky's factor.
TEST(UncertainVariables, AreCorrelated) {
  const UncertainVariables all = uncertain_variables(uncertain(
      {{"pump.tilt_deg", "normal(40, 0.1)"}, {"pressure.delivery_bar", "uniform(0, 300)"}},
      {{"pressure.delivery_bar", "pump.tilt_deg", 0.6}}));
  EXPECT_FALSE(all.independent());
  std::array<double, 2> values{};
  all.values(std::array{standard_cumulative(1), 0.5}, values);
  EXPECT_NEAR(values[0], 40.1, 1e-12);
  EXPECT_NEAR(values[1], 300 * standard_cumulative(0.6), 1e-10);
  all.values(std::array{0.5, standard_cumulative(1)}, values);
  EXPECT_NEAR(values[0], 40, 1e-12);
  EXPECT_NEAR(values[1], 300 * standard_cumulative(0.8), 1e-10);
}

// A number that another one determines.
TEST(UncertainVariables, MayGoTogether) {
  const UncertainVariables all = uncertain_variables(
      uncertain({{"pump.tilt_deg", "normal(40, 0.1)"}, {"pump.axis_offset_mm", "normal(0.01)"}},
                {{"pump.tilt_deg", "pump.axis_offset_mm", -1}}));
  std::array<double, 2> values{};
  all.values(std::array{standard_cumulative(2), 0.9}, values);
  const double offset = all.variables[1].value(read_case(kRated));
  EXPECT_NEAR(values[1], offset - 0.02, 1e-12);
}

TEST(UncertainVariables, RefuseWhatCannotBe) {
  const auto why = [](const std::vector<UncertaintyData::Parameter>& parameters,
                      const std::vector<UncertaintyData::Correlation>& correlations = {}) {
    return refusal([&] { uncertain_variables(uncertain(parameters, correlations)); });
  };
  const std::string a = "pump.tilt_deg", b = "piston.mass_kg", c = "pressure.delivery_bar";
  const std::vector<UncertaintyData::Parameter> three = {
      {a, "normal(1)"}, {b, "relative(0.1)"}, {c, "uniform(100, 300)"}};
  EXPECT_THAT(why({}), testing::HasSubstr("needs [uncertainty]"));
  EXPECT_THAT(why({{a, "normal(1)"}, {a, "normal(2)"}}), testing::HasSubstr("given twice"));
  EXPECT_THAT(why({{"pump.tilt", "normal(1)"}}), testing::HasSubstr("[uncertainty] pump.tilt: no"));
  EXPECT_THAT(why({{"pump.pistons", "uniform(3, 9)"}}), testing::HasSubstr("whole number"));
  EXPECT_THAT(why({{a, "uniform(80, 95)"}}), testing::HasSubstr("95 must be in [0, 90)"));
  EXPECT_THAT(why({{"pressure.suction_bar", "relative(0.1)"}}), testing::HasSubstr("is 0"));
  EXPECT_THAT(why(three, {{a, "piston.contact_mm", 0.5}}),
              testing::HasSubstr("piston.contact_mm has no distribution"));
  EXPECT_THAT(why(three, {{a, a, 0.5}}), testing::HasSubstr("two parameters"));
  EXPECT_THAT(why(three, {{a, b, 1.5}}), testing::HasSubstr("in [-1, 1]"));
  EXPECT_THAT(why(three, {{a, b, 0.5}, {b, a, 0.4}}), testing::HasSubstr("twice"));
  EXPECT_THAT(why(three, {{a, b, 0.9}, {b, c, 0.9}, {a, c, -0.9}}),
              testing::HasSubstr("are inconsistent"));
  EXPECT_EQ(why(three, {{a, b, 0.9}, {b, c, 0.9}, {a, c, 0.9}}), "accepted");
}

// ---- The table of a case file

std::string case_with(const std::string& table) {
  std::ifstream in(kRated);
  std::ostringstream text;
  text << in.rdbuf() << table;
  return text.str();
}

TEST(UncertaintyTable, IsReadAndWritten) {
  const std::string table =
      "\n[uncertainty]\n\"pump.tilt_deg\" = \"normal(40, 0.1)\"\n"
      "\"port_plate.delivery_arc_deg.1\" = \"normal(0.2)\"\n"
      "correlation = [[\"pump.tilt_deg\", \"port_plate.delivery_arc_deg.1\", -0.5]]\n";
  const Case read = parse_case(case_with(table), kRated);
  ASSERT_EQ(read.uncertainty.parameters.size(), 2U);
  EXPECT_EQ(uncertain_variables(read).correlation[1], -0.5);
  const Case again = parse_case(case_text(read), kRated);
  EXPECT_EQ(case_text(again), case_text(read));
  EXPECT_EQ(again.uncertainty.parameters[1].distribution, "normal(40, 0.1)");
  EXPECT_EQ(again.uncertainty.correlations[0].coefficient, -0.5);
  EXPECT_TRUE(read_case(kRated).uncertainty.parameters.empty());
}

TEST(UncertaintyTable, RefusesByLineWhatItCannotBe) {
  const auto why = [](const std::string& lines) {
    return refusal([&] { parse_case(case_with("\n[uncertainty]\n" + lines), "my.toml"); });
  };
  EXPECT_THAT(why("\"pump.tilt\" = \"normal(1)\"\n"),
              testing::MatchesRegex(
                  "my.toml:[0-9]+: .uncertainty. pump.tilt = .*not a number of this case.*"
                  "pump.tilt_deg.*"));
  EXPECT_THAT(why("\"pump.tilt_deg\" = 1\n"), testing::HasSubstr("must be a text"));
  EXPECT_THAT(why("\"pump.pistons\" = \"uniform(3, 9)\"\n"),
              testing::HasSubstr("not a number of this case"));
  const std::string one = "\"pump.tilt_deg\" = \"normal(1)\"\n";
  EXPECT_THAT(why(one + "correlation = [[\"pump.tilt_deg\", \"piston.mass_kg\", 0.5]]\n"),
              testing::HasSubstr("piston.mass_kg has no distribution"));
  EXPECT_THAT(why(one + "correlation = [\"pump.tilt_deg\"]\n"),
              testing::HasSubstr("list of lists"));
  EXPECT_THAT(why(one + "correlation = [[\"pump.tilt_deg\", \"pump.tilt_deg\", 2]]\n"),
              testing::HasSubstr("in [-1, 1]"));
}

// ---- Propagation

UncertainVariables numbers(const std::vector<std::string>& distributions) {
  UncertainVariables all;
  for (const std::string& text : distributions)
    all.distributions.push_back(distribution(text, "x"));
  return all;
}

// A function of one point, as a response of one output.
Response response_of(const std::function<double(std::span<const double>)>& function,
                     std::size_t dimension) {
  return [=](std::size_t count, std::span<const double> values, std::span<double> results,
             std::span<std::string>) {
    for (std::size_t i = 0; i < count; ++i)
      results[i] = function(values.subspan(i * dimension, dimension));
  };
}

// Of 10 values the second and the ninth enclose the median with 97.9 %, the next inner ones with
// 89 %: tables of the sign test.
TEST(QuantileRule, IsThatOfTheBinomialLaw) {
  const std::vector<double> values = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const Estimate median = QuantileRule(0.5, 10)(values);
  EXPECT_EQ(median.value, 4.5);
  EXPECT_EQ(median.low, 1);
  EXPECT_EQ(median.high, 8);
  EXPECT_EQ(QuantileRule::fewest(0.5), 6U);      // 0.5^6 < 0.025 < 0.5^5
  EXPECT_EQ(QuantileRule::fewest(0.025), 146U);  // 0.975^146 < 0.025 < 0.975^145
  EXPECT_EQ(fewest_samples(0.95), 146U);
  // Of these the 2.5 % quantile cannot be had, the median and the 25 % quantile can.
  const Spread few = spread_of(values, 0.95);
  EXPECT_FALSE(is_computed(few.low.value) || is_computed(few.high.low));
  EXPECT_EQ(few.median.value, 4.5);
  EXPECT_EQ(few.mean, 4.5);
}

// Intervals of 95 % of a skewed law's quantiles, mean and deviation hold the truth in about as many
// of 500 repetitions: quantiles in no less (their rule is on the safe side), but not always. The
// fourth moment of a lognormal law takes more samples than these for the last, so a uniform one.
TEST(Spread, CoversTheTruth) {
  const UncertainVariables law = numbers({"lognormal(1, 0.6)", "uniform(0, 1)"});
  const Distribution &skewed = law.distributions[0], &flat = law.distributions[1];
  const Response copy = [](std::size_t, std::span<const double> values, std::span<double> results,
                           std::span<std::string>) {
    std::copy(values.begin(), values.end(), results.begin());
  };
  constexpr int kRepetitions = 500;
  int low = 0, median = 0, high = 0, mean = 0, deviation = 0;
  const auto inside = [](const Estimate& e, double truth) {
    return e.low <= truth && truth <= e.high;
  };
  for (int seed = 1; seed <= kRepetitions; ++seed) {
    const SampledOutputs drawn = sample(copy, 2, law, 300, seed, 1);
    const Spread s = spread_of(drawn.of(0), 0.95), t = spread_of(drawn.of(1), 0.95);
    low += inside(s.low, skewed.quantile(0.025)) ? 1 : 0;
    median += inside(s.median, 1) ? 1 : 0;
    high += inside(s.high, skewed.quantile(0.975)) ? 1 : 0;
    mean += std::abs(t.mean - 0.5) < 1.96 * t.mean_error ? 1 : 0;
    deviation +=
        std::abs(t.deviation - flat.standard_deviation()) < 1.96 * t.deviation_error ? 1 : 0;
  }
  // 95 % -+ three standard deviations of the count; quantiles are allowed more.
  for (const int hits : {low, median, high}) {
    EXPECT_GE(hits, 461);
    EXPECT_LT(hits, kRepetitions);
  }
  for (const int hits : {mean, deviation}) EXPECT_NEAR(hits, 475, 15);
}

// JCGM 100:2008, annex H.1: an end gauge calibrated against a standard; its table H.1 and H.1.7.
// Lengths in nm; temperatures K.
TEST(FirstOrder, IsThatOfTheGuide) {
  const UncertainVariables inputs = numbers({
      "normal(50000623, 25)",     // length of the standard
      "normal(215, 9.7)",         // difference of lengths
      "normal(11.5e-6, 1.2e-6)",  // expansion of the standard, 1/K
      "normal(-0.1, 0.41)",       // temperature above 20 deg C
      "normal(0, 0.58e-6)",       // difference of expansions
      "normal(0, 0.029)",         // difference of temperatures
  });
  const Response length = response_of(
      [](std::span<const double> x) { return x[0] + x[1] - x[0] * (x[4] * x[3] + x[2] * x[5]); },
      6);
  const FirstOrder found = first_order(length, 1, inputs);
  const double printed[] = {25, 9.7, 0, 0, 2.9, 16.6};
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(std::abs(found.derivatives[i]) * inputs.distributions[i].standard_deviation(),
                printed[i], 0.1)
        << i;
  EXPECT_NEAR(found.values[0], 50000838, 0.5);
  EXPECT_NEAR(found.deviations[0], 32, 0.5);
  EXPECT_NEAR(found.deviations[0], std::sqrt(25 * 25 + 9.7 * 9.7 + 2.9 * 2.9 + 16.675 * 16.675),
              1e-2);
  // H.1.7: with the terms of second order 34 nm, which samples contain.
  const Spread sampled = spread_of(sample(length, 1, inputs, 200000, 1, 2).of(0), 0.95);
  EXPECT_NEAR(sampled.deviation, 34, 0.5);
  EXPECT_GT(sampled.deviation - found.deviations[0], 10 * sampled.deviation_error);
}

// Sums of correlated normal numbers are normal: all exactly known.
TEST(FirstOrder, OfALinearModelIsExact) {
  UncertainVariables inputs = numbers({"normal(1, 0.3)", "normal(-2, 0.4)", "normal(0.5, 0.1)"});
  inputs.correlate({{0, 1, 0.7}, {1, 2, -0.4}});
  const Response sum =
      response_of([](std::span<const double> x) { return 2 * x[0] - 3 * x[1] + x[2]; }, 3);
  const double exact = std::sqrt(4 * 0.09 + 9 * 0.16 + 0.01 - 12 * 0.7 * 0.12 + 6 * 0.4 * 0.04);
  const FirstOrder found = first_order(sum, 1, inputs);
  EXPECT_NEAR(found.values[0], 8.5, 1e-13);
  EXPECT_NEAR(found.derivatives[1], -3, 1e-12);
  EXPECT_NEAR(found.deviations[0], exact, 1e-12);
  const Spread s = spread_of(sample(sum, 1, inputs, 50000, 3, 2).of(0), 0.95);
  EXPECT_NEAR(s.mean, 8.5, 4 * s.mean_error);
  EXPECT_NEAR(s.deviation, exact, 4 * s.deviation_error);
  const double limit = 8.5 + 1.959963984540054 * exact;  // a little wider than the interval's 95 %
  EXPECT_NEAR(s.high.value, limit, 2 * (s.high.high - s.high.low));
}

// Uniform numbers whose scores are correlated by r: correlation 6/pi asin(r/2) (K. Pearson, 1907).
TEST(UncertainVariables, HaveTheCovariancesOfTheirCopula) {
  UncertainVariables inputs = numbers(
      {"uniform(0, 1)", "uniform(0, 1)", "lognormal(1, 0.5)", "lognormal(2, 0.3)", "normal(0, 2)"});
  inputs.correlate({{0, 1, 0.6}, {2, 3, -0.5}, {2, 4, 0.4}});
  const std::vector<double> c = inputs.covariances();
  EXPECT_NEAR(c[0 * 5 + 0], 1.0 / 12, 1e-15);
  EXPECT_NEAR(c[0 * 5 + 1], std::asin(0.3) / (2 * M_PI), 1e-10);
  EXPECT_NEAR(c[3 * 5 + 2], 2 * std::exp(0.125 + 0.045) * std::expm1(-0.5 * 0.5 * 0.3), 1e-12);
  EXPECT_NEAR(c[2 * 5 + 4], 0.4 * 0.5 * 2 * std::exp(0.125), 1e-12);
  EXPECT_EQ(c[0 * 5 + 2], 0);
}

// What has no outputs is counted with its reason, and left out of the rest.
TEST(Sample, LeavesOutWhatHasNoOutputs) {
  const UncertainVariables inputs = numbers({"uniform(0, 1)"});
  const Response half = [](std::size_t count, std::span<const double> values,
                           std::span<double> results, std::span<std::string> reasons) {
    for (std::size_t i = 0; i < count; ++i) {
      results[i] = values[i];
      if (values[i] > 0.5) reasons[i] = "too large";
    }
  };
  const SampledOutputs found = sample(half, 1, inputs, 1000, 1, 2);
  EXPECT_EQ(found.of(0).size() + found.infeasible.size(), 1000U);
  EXPECT_NEAR(static_cast<double>(found.infeasible.size()), 500, 60);
  EXPECT_EQ(found.infeasible.front().second, "too large");
  for (const double value : found.of(0)) ASSERT_LE(value, 0.5);
  EXPECT_EQ(sample(half, 1, inputs, 1000, 1, 1).results, found.results);  // whatever the threads
}

// T. Ishigami, T. Homma, An importance quantification technique in uncertainty analysis, 1990:
// sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1, whose variance is known part by part.
TEST(SobolIndices, OfIshigamisFunctionLieInTheirBands) {
  if (openturns_version() == "none") GTEST_SKIP() << "built without OpenTURNS";
  const UncertainVariables inputs =
      numbers(std::vector<std::string>(3, "uniform(-3.141592653589793, 3.141592653589793)"));
  const Response ishigami = response_of(
      [](std::span<const double> x) {
        return std::sin(x[0]) + 7 * std::pow(std::sin(x[1]), 2) +
               0.1 * std::pow(x[2], 4) * std::sin(x[0]);
      },
      3);
  const double one = 0.5 * std::pow(1 + 0.1 * std::pow(M_PI, 4) / 5, 2), two = 49.0 / 8;
  const double both = 8 * 0.01 * std::pow(M_PI, 8) / 225, all = one + two + both;
  const double first[] = {one / all, two / all, 0},
               total[] = {(one + both) / all, two / all, both / all};
  const SobolIndices found = sobol_indices(ishigami, 1, inputs, 4096, 1, 2);
  EXPECT_EQ(found.evaluations, 5U * 4096);
  EXPECT_EQ(found.left_out, 0U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LE(found.first[i].low, first[i]) << i;
    EXPECT_GE(found.first[i].high, first[i]) << i;
    EXPECT_LE(found.total[i].low, total[i]) << i;
    EXPECT_GE(found.total[i].high, total[i]) << i;
    EXPECT_LT(found.first[i].high - found.first[i].low, 0.1) << i;  // and say something
    EXPECT_LT(found.total[i].high - found.total[i].low, 0.1) << i;
  }
  // One number alone makes the whole variance: nothing is estimated.
  const SobolIndices one_alone =
      sobol_indices(response_of([](std::span<const double> x) { return std::sin(x[0]); }, 1), 1,
                    numbers({"normal(1, 0.2)"}), 64, 1, 1);
  for (const Estimate& index : {one_alone.first[0], one_alone.total[0]}) {
    EXPECT_EQ(index.value, 1);
    EXPECT_EQ(index.low, 1);
    EXPECT_EQ(index.high, 1);
  }
  const Response constant = response_of([](std::span<const double>) { return 1.0; }, 3);
  EXPECT_FALSE(is_computed(sobol_indices(constant, 1, inputs, 64, 1, 1).first[0].value));
  UncertainVariables correlated = inputs;
  correlated.correlate({{0, 1, 0.5}});
  EXPECT_THAT(refusal([&] { sobol_indices(ishigami, 1, correlated, 64, 1, 1); }),
              testing::HasSubstr("independent"));
}

// An output of one number alone: its indices are 1, those of the others 0, and not a round-off from
// them, which no interval would hold.
TEST(SobolIndices, ThatAreZeroOrOneAreExact) {
  if (openturns_version() == "none") GTEST_SKIP() << "built without OpenTURNS";
  const UncertainVariables inputs = numbers(std::vector<std::string>(3, "uniform(0, 1)"));
  for (const double offset : {0.0, 300.0, 1e6})
    for (const std::size_t base : {16U, 64U, 1024U})
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Response one =
            response_of([&](std::span<const double> x) { return offset + x[0]; }, 3);
        const SobolIndices found = sobol_indices(one, 1, inputs, base, seed, 1);
        EXPECT_EQ(found.first[0].value, 1);
        EXPECT_EQ(found.total[1].value, 0);
        EXPECT_FALSE(std::signbit(found.total[2].value));
        for (const auto* indices : {&found.first, &found.total})
          for (const Estimate& e : *indices) {
            EXPECT_LE(e.low, e.value) << offset << ", " << base << ", " << seed;
            EXPECT_GE(e.high, e.value) << offset << ", " << base << ", " << seed;
          }
        EXPECT_EQ(found.total[1].low, 0);
        EXPECT_EQ(found.total[1].high, 0);
        EXPECT_EQ(found.first[0].low, 1);
      }
  // What varies by its round-off alone has none.
  const Response still = response_of(
      [](std::span<const double> x) { return 1e9 * (1 + (x[0] > 0.5 ? 1 : 0) * 2.3e-16); }, 3);
  EXPECT_FALSE(is_computed(sobol_indices(still, 1, inputs, 64, 1, 1).first[0].value));
}

// ---- Of a case

Case some_uncertain() {
  Case made = uncertain({{"pump.tilt_deg", "normal(0.2)"},
                         {"pressure.delivery_bar", "uniform(260, 290)"},
                         {"bearings.tapered_z_mm", "normal(0.5)"}},
                        {{"pump.tilt_deg", "bearings.tapered_z_mm", 0.3}});
  made.operation.samples_per_revolution = 60;
  return made;
}

const CurveBand& band_of(const UncertaintyResult& result, const std::string& channel) {
  for (const CurveBand& band : result.bands)
    if (band.channel.name == channel) return band;
  throw std::runtime_error("no band of " + channel);
}

// What other samples do is what the band says: 95 % of them at an angle, fewer throughout.
TEST(Uncertainty, HasBandsThatHoldOtherSamples) {
  const Case the_case = some_uncertain();
  UncertaintyOptions options;
  options.samples = 2000;
  options.threads = 2;
  options.first_order = false;
  options.outputs = {output("mean:Td", the_case)};
  const UncertaintyResult one = uncertainty(the_case, options);
  EXPECT_EQ(one.bands.size(), 17U);
  EXPECT_EQ(one.theta_deg.size(), 60U);
  // Others are drawn as numbers of a design, which the sampled bands are not made of.
  const ChannelLayout layout(5);
  const std::size_t column = layout.Rb2(1);
  const CurveBand& band = band_of(one, "Rb2_y1_N");
  options.seed = 2;
  options.curves = false;
  options.further = {
      2, [&](const study::PreparedCase&, const ResultTable& table, std::span<double> values) {
        double inside = 0;
        for (std::size_t row = 0; row < table.rows(); ++row)
          if (table.at(row, column) >= band.low[row] && table.at(row, column) <= band.high[row])
            inside += 1.0 / static_cast<double>(table.rows());
        values[0] = inside;
        values[1] = inside > 1 - 1e-9 ? 1 : 0;
      }};
  const UncertaintyResult other = uncertainty(the_case, options);
  EXPECT_NEAR(other.further[0].mean, 0.95, 0.015);  // three times what 2 x 2000 samples leave
  EXPECT_NEAR(other.further[1].mean, band.throughout, 0.03);
  EXPECT_LT(band.throughout, 0.96);
  EXPECT_GT(band.edge_error, 0);
  EXPECT_LT(band.edge_error, band.widest / 4);
}

// Curves of fewer angles where memory says so, at angles of the case.
TEST(Uncertainty, FitsIntoMemory) {
  const Case the_case = some_uncertain();
  UncertaintyOptions options;
  options.samples = 200;
  const UncertaintyResult all = uncertainty(the_case, options);
  options.most_bytes = 17 * 60 * 200 * sizeof(double) / 3;
  const UncertaintyResult some = uncertainty(the_case, options);
  ASSERT_EQ(some.theta_deg.size(), 20U);
  EXPECT_EQ(some.theta_deg[1], 18);
  const CurveBand &full = band_of(all, "Rs_1_z2_N"), &thin = band_of(some, "Rs_1_z2_N");
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(thin.low[i], full.low[3 * i]);
    EXPECT_EQ(thin.nominal[i], full.nominal[3 * i]);
  }
}

// What pressure takes of the torque is pressure x area: relative deviations add up as squares.
TEST(Uncertainty, ToFirstOrderIsThatOfAProduct) {
  Case the_case = uncertain(
      {{"pressure.delivery_bar", "relative(0.01)"}, {"pump.bore_diameter_mm", "relative(0.005)"}});
  UncertaintyOptions options;
  options.samples = 200;
  options.curves = false;
  options.outputs = {output("mean:budget.Td_pressure", the_case)};
  const UncertaintyResult found = uncertainty(the_case, options);
  EXPECT_NEAR(found.first_order.deviations[0] / found.outputs[0].nominal,
              std::hypot(0.01, 2 * 0.005), 1e-9);
}

// Leaving samples out narrows the distributions: of the delivery arc's end only what lies after the
// beginning of the arc, at 189 deg, is left.
TEST(Uncertainty, SaysWhatLeavingSamplesOutDoes) {
  Case the_case = uncertain({{"port_plate.delivery_arc_deg.2", "normal(189.3, 0.5)"}});
  the_case.operation.samples_per_revolution = 60;
  UncertaintyOptions options;
  options.outputs = {output("mean:Td", the_case)};
  options.samples = 2000;
  options.curves = options.first_order = false;
  const UncertaintyResult found = uncertainty(the_case, options);
  const auto without = static_cast<double>(found.sampled.infeasible.size());
  EXPECT_NEAR(without / 2000, 0.2743, 4 * 0.01)
      << "what lies more than 0.6 deviations below the mean";
  ASSERT_EQ(found.kept_parameters.size(), 1U);
  // A normal number cut at 0.6 deviations below its mean: with r = phi(0.6) / Phi(0.6) its mean is
  // r deviations higher, its variance 1 - 0.6 r - r^2.
  const double r = 0.33322 / 0.72575;
  const Spread& kept = found.kept_parameters[0];
  EXPECT_NEAR(kept.mean, 189.3 + 0.5 * r, 4 * kept.mean_error);
  EXPECT_NEAR(kept.deviation, 0.5 * std::sqrt(1 - 0.6 * r - r * r), 4 * kept.deviation_error);
  const report::Document document = uncertainty_document(found, {}, {});
  EXPECT_EQ(document.warnings.value().at(0).name, "Samples left out");
  EXPECT_THAT(document.verdict->headline, testing::HasSubstr("are left out ("));
  EXPECT_EQ(document.runs->back().title, "Parameters of the remaining samples");
  EXPECT_THAT(uncertainty_text(found), testing::HasSubstr("those of the other samples alone"));
}

TEST(Uncertainty, RefusesWhatMostlyIsNoPump) {
  const Case the_case = uncertain({{"pump.axis_offset_mm", "uniform(80, 200)"}});
  UncertaintyOptions options;
  options.samples = 200;
  try {
    uncertainty(the_case, options);
    FAIL() << "accepted";
  } catch (const ComputationError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("of 200 samples are infeasible pumps"));
  }
}

// E = S - D with its three uncertainties (ASME V&V 20): root of the sum of squares, doubled.
TEST(ComparisonError, IsJudgedByItsUncertainty) {
  const ComparisonError error{103, 100, 0.2, 0.9, 1.2};
  EXPECT_EQ(error.error(), 3);
  EXPECT_NEAR(error.validation(), std::sqrt(0.04 + 0.81 + 1.44), 1e-15);
  EXPECT_TRUE(error.within());
  EXPECT_FALSE((ComparisonError{103, 100, 0.2, 0.9, 1.1}).within());
}

}  // namespace
}  // namespace bentaxis::designs
