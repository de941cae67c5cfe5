// Distributions, correlated values, and what they do to outputs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "bentaxis/designs/distribution.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"

namespace bentaxis::designs {
namespace {

const std::string kRated = std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml";

std::string refusal(const std::function<void()>& job) {
  try {
    job();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

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
  EXPECT_THAT(why("uniform(1, )"), testing::HasSubstr("\"\" must be a number"));
  EXPECT_THAT(why("triangular(0, 5, 4)"), testing::HasSubstr("most likely"));
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
              testing::HasSubstr("no numbers have all"));
  EXPECT_EQ(why(three, {{a, b, 0.9}, {b, c, 0.9}, {a, c, 0.9}}), "accepted");
}

}  // namespace
}  // namespace bentaxis::designs
