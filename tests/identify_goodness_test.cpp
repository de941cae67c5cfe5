// Whether a fit is refuted: chi-square where its law is known, a rig with friction that the fit
// leaves out, and the same rig fitted with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "bentaxis/designs/identify.h"
#include "bentaxis/designs/identify_document.h"
#include "bentaxis/designs/output.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::designs {
namespace {

using testing::HasSubstr;
using testing::Not;

// Upper critical values as tables print them (NIST/SEMATECH e-Handbook of Statistical Methods,
// 1.3.6.7.4).
TEST(ChiSquare, HasTheCriticalValuesOfTheTables) {
  const struct {
    std::size_t degrees;
    double value, p;
  } rows[] = {{1, 3.841, 0.05},    {1, 10.828, 0.001}, {2, 5.991, 0.05},     {10, 18.307, 0.05},
              {10, 29.588, 0.001}, {73, 0, 1},         {100, 124.342, 0.05}, {100, 149.449, 0.001}};
  for (const auto& row : rows)
    EXPECT_NEAR(chi_square_p_value(row.value, row.degrees), row.p, 5e-4 * row.p)
        << row.degrees << " degrees of freedom";
}

// With an even number of degrees of freedom the law is a finite sum.
TEST(ChiSquare, IsTheSumOfPoissonTerms) {
  for (const std::size_t degrees : {2U, 8U, 74U})
    for (const double value : {0.5, 10.0, 74.0, 200.0, 900.0}) {
      double term = std::exp(-value / 2), sum = 0;
      for (std::size_t k = 0; k < degrees / 2; ++k) {
        sum += term;
        term *= value / 2 / static_cast<double>(k + 1);
      }
      EXPECT_NEAR(chi_square_p_value(value, degrees), sum, 1e-12 * sum) << degrees << ", " << value;
    }
  EXPECT_EQ(chi_square_p_value(3419, 73), 0) << "below the smallest number";
  EXPECT_EQ(chi_square_p_value(HUGE_VAL, 1), 0);
}

constexpr double kTorqueNoise = 0.4;  // Nm, standard
constexpr double kForceNoise = 0.01;  // of the peak

Case pump(double coulomb) {
  return read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml",
                   {"operation.samples_per_revolution=72",
                    "friction.piston_coulomb_N=" + std::to_string(coulomb)});
}

// A record of a rig: a bearing force over the turn and mean torques at nine operating points, with
// normal noise.
struct Rig {
  double noise = 1;   // over what is stated
  double stated = 1;  // uncertainties, over those of the noise
  unsigned seed = 1;
  std::vector<std::string> unknowns = {"pump.tilt_deg=36:44", "pump.bore_diameter_mm=20:25"};
};

IdentificationData record_of(const Case& truth, const Rig& rig) {
  std::mt19937_64 engine(rig.seed);
  const auto uniform = [&] { return (static_cast<double>(engine() >> 11U) + 0.5) * 0x1p-53; };
  const auto normal = [&] {
    return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform());
  };
  IdentificationData data;
  for (const std::string& text : rig.unknowns)
    data.unknowns.push_back(unknown_of("--vary", text, truth));
  for (const double speed : {500.0, 1500.0, 2500.0})
    for (const double bar : {50.0, 150.0, 250.0}) {
      Condition condition;
      condition.name = std::to_string(static_cast<int>(speed)) + " rpm, " +
                       std::to_string(static_cast<int>(bar)) + " bar";
      condition.settings = {{Variable("operation.speed_rpm", truth), speed},
                            {Variable("pressure.delivery_bar", truth), bar}};
      Case there = truth;
      there.operation.speed_rpm = speed;
      there.pressure.ports.delivery = bar * 1e5;
      Datum datum;
      datum.output = output("mean:Td", truth);
      datum.what = datum.output->name;
      datum.unit = datum.output->unit;
      datum.condition = data.conditions.size();
      datum.value = outputs_of({*datum.output}, study::prepare(there), study::Model::analytic)[0] +
                    rig.noise * kTorqueNoise * normal();
      datum.uncertainty = rig.stated * kTorqueNoise;
      data.conditions.push_back(std::move(condition));
      data.data.push_back(std::move(datum));
    }
  const ResultTable turn = study::run_turn(study::prepare(truth), study::Model::analytic);
  Datum force;
  force.what = "Rb1_x1_N over the turn";
  force.unit = "N";
  force.curve.emplace();
  force.curve->column = turn.find("Rb1_x1_N");
  double peak = 0;
  for (std::size_t row = 0; row < turn.rows(); ++row)
    peak = std::max(peak, std::abs(turn.at(row, force.curve->column)));
  force.uncertainty = rig.stated * kForceNoise * peak;
  for (std::size_t row = 0; row < turn.rows(); ++row) {
    force.curve->theta_deg.push_back(turn.theta_deg[row]);
    force.curve->values.push_back(turn.at(row, force.curve->column) +
                                  rig.noise * kForceNoise * peak * normal());
    force.curve->uncertainties.push_back(force.uncertainty);
  }
  data.data.push_back(std::move(force));
  return data;
}

class Goodness : public testing::Test {
 protected:
  void SetUp() override {
    if (least_squares_library().empty()) GTEST_SKIP() << "without Ceres";
  }
  static Identification fit(const DataModel& model, bool whole = false) {
    IdentifyOptions options;
    options.starts = 2;
    options.steps = 40;
    options.draws = 20;
    options.posterior = options.profiles = options.leave_one_out = whole;
    return identify(model, options);
  }
};

TEST_F(Goodness, FrictionThatIsLeftOutRefutesTheFitAndIsNamed) {
  const DataModel model(pump(0), record_of(pump(120), {}));
  const Identification found = fit(model, true);
  EXPECT_EQ(found.goodness.residuals, 81U);
  EXPECT_EQ(found.goodness.degrees_of_freedom(), 79U);
  EXPECT_GT(found.goodness.chi_square, 500);
  EXPECT_TRUE(found.goodness.refuted());
  // The mean torques are what is furthest off; by friction's own torque, were nothing else moved.
  ASSERT_TRUE(found.worst.front().datum);
  EXPECT_LT(*found.worst.front().datum, 9U);
  EXPECT_LT(found.worst.front().residual, -8) << "the model has less torque";
  // What was left out ends it, at its value.
  ASSERT_FALSE(found.further.empty());
  const FurtherUnknown& best = found.further.front();
  EXPECT_EQ(best.variable.name(), "friction.piston_coulomb_N");
  EXPECT_NEAR(best.value, 120, 15);
  EXPECT_EQ(best.fit.degrees_of_freedom(), 78U);
  EXPECT_FALSE(best.fit.refuted());
  EXPECT_LT(best.fit.chi_square, 130);
  EXPECT_TRUE(best.implausible.empty());
  for (const FurtherUnknown& other : found.further)
    if (other.implausible.empty()) {
      EXPECT_GE(other.fit.chi_square, best.fit.chi_square) << other.variable.name();
    }
  // Nothing is claimed to be known.
  EXPECT_TRUE(found.profiles.empty());
  EXPECT_TRUE(found.bands.empty());
  EXPECT_TRUE(found.candidates.empty());
  EXPECT_EQ(found.posterior.count, 0U);
  const std::string text = identify_text(model, found);
  const report::Document document = identify_document(model, found, {}, {});
  for (const std::string& words : {text, document.verdict->headline}) {
    EXPECT_THAT(words, HasSubstr("the model does not fit the data: chi-square"));
    EXPECT_THAT(words, HasSubstr("with 79 degrees of freedom, p "));
    EXPECT_THAT(words, HasSubstr("mean:Td"));
    EXPECT_THAT(words, HasSubstr(" sigma"));
    EXPECT_THAT(words, Not(HasSubstr("are known to")));
    EXPECT_THAT(words, Not(HasSubstr("most useful further measurement")));
    EXPECT_THAT(words, Not(HasSubstr("as wide as the bounds")));
  }
  EXPECT_THAT(text, HasSubstr("The further unknown that would improve the fit most: "
                              "friction.piston_coulomb_N"));
  EXPECT_THAT(text, HasSubstr("Birge ratio"));
  EXPECT_EQ(document.verdict->agrees, false);
  EXPECT_EQ(document.verdict->word, "Refuted");
  EXPECT_TRUE(document.verdict->fit->refuted);
  EXPECT_EQ(document.verdict->fit->degrees_of_freedom, 79);
  const std::string written = identified_case_text(model, found);
  EXPECT_THAT(written, HasSubstr("# Identified values. the model does not fit the data"));
  EXPECT_THAT(written, HasSubstr("identified (fit refuted)"));
}

// Friction that an assumption turns off is searched from 0.
TEST_F(Goodness, FrictionThatIsTurnedOffIsNamedToo) {
  const IdentificationData record = record_of(pump(120), {});
  Case off = pump(25);
  off.analytic.piston_friction = false;
  const DataModel model(off, record);
  const Identification found = fit(model);
  EXPECT_TRUE(found.goodness.refuted());
  ASSERT_FALSE(found.further.empty());
  EXPECT_EQ(found.further[0].variable.name(), "friction.piston_coulomb_N");
  EXPECT_EQ(found.further[0].before, 0);
  EXPECT_NEAR(found.further[0].value, 120, 15);
  EXPECT_THAT(identify_text(model, found), HasSubstr("piston_friction = true of"));
}

TEST_F(Goodness, FrictionThatIsFittedIsNotRefuted) {
  Rig rig;
  rig.unknowns.emplace_back("friction.piston_coulomb_N=0:300");
  const DataModel model(pump(0), record_of(pump(120), rig));
  const Identification found = fit(model);
  EXPECT_EQ(found.goodness.degrees_of_freedom(), 78U);
  EXPECT_FALSE(found.goodness.refuted());
  EXPECT_TRUE(found.further.empty());
  EXPECT_THAT(identify_text(model, found), HasSubstr("not refuted"));
  EXPECT_EQ(identify_document(model, found, {}, {}).verdict->agrees, true);
  EXPECT_THAT(identified_case_text(model, found), Not(HasSubstr("refuted)")));
}

// The same model with the noise that is stated: p is as likely anywhere between 0 and 1.
TEST_F(Goodness, StatedNoiseIsNotRefuted) {
  constexpr int kRecords = 40;
  double mean = 0;
  int below = 0;
  for (unsigned seed = 1; seed <= kRecords; ++seed) {
    Rig rig;
    rig.seed = seed;
    const DataModel model(pump(120), record_of(pump(120), rig));
    const Identification found = fit(model);
    ASSERT_TRUE(found.goodness.p_value);
    EXPECT_FALSE(found.goodness.refuted()) << "seed " << seed;
    EXPECT_FALSE(found.goodness.uncertainties_too_large()) << "seed " << seed;
    mean += *found.goodness.p_value / kRecords;
    below += *found.goodness.p_value < 0.25;
  }
  // Four standard errors of even p.
  EXPECT_NEAR(mean, 0.5, 4 / std::sqrt(12.0 * kRecords));
  EXPECT_NEAR(below, 0.25 * kRecords, 4 * std::sqrt(0.25 * 0.75 * kRecords));
}

TEST_F(Goodness, NoiseStatedTooLargeIsSaid) {
  Rig rig;
  rig.stated = 3;
  const DataModel model(pump(120), record_of(pump(120), rig));
  const Identification found = fit(model);
  EXPECT_GT(*found.goodness.p_value, 0.999);
  EXPECT_TRUE(found.goodness.uncertainties_too_large());
  EXPECT_FALSE(found.goodness.refuted());
  EXPECT_EQ(identify_document(model, found, {}, {}).warnings.value().at(0).name,
            "Stated uncertainties too large");
  EXPECT_THAT(identify_text(model, found),
              HasSubstr("smaller than expected from the stated uncertainties"));
}

// Where the noise is three times what is stated and nothing else is wrong, widened deviations are
// those of the noise as it is.
TEST_F(Goodness, DeviationsAreWidenedToTheNoiseThatIsThere) {
  Rig small;
  small.stated = 1 / 3.0;
  const DataModel understated(pump(120), record_of(pump(120), small));
  const DataModel right(pump(120), record_of(pump(120), {}));
  const Identification refuted = fit(understated), accepted = fit(right);
  EXPECT_TRUE(refuted.goodness.refuted());
  EXPECT_FALSE(accepted.goodness.refuted());
  // A variance of 79 degrees of freedom is known to 16 %, standard; its root to 8 %.
  EXPECT_NEAR(refuted.goodness.birge_ratio(), 3, 3 * 3 * 0.08);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(refuted.information.deviation[i] / accepted.information.deviation[i],
                refuted.goodness.birge_ratio() / 3, 0.02);
}

Datum torque(const Case& base, double value, double uncertainty) {
  Datum datum;
  datum.output = output("mean:Td", base);
  datum.what = datum.output->name;
  datum.value = value;
  datum.uncertainty = uncertainty;
  return datum;
}

TEST_F(Goodness, AsManyUnknownsAsDataAreNoTest) {
  const Case base = pump(25);
  IdentificationData data;
  data.unknowns = {unknown_of("--vary", "pressure.delivery_bar=200:400", base)};
  data.data = {torque(base, 292, 1)};
  const DataModel model(base, data);
  const Identification found = fit(model);
  EXPECT_EQ(found.goodness.degrees_of_freedom(), 0U);
  EXPECT_FALSE(found.goodness.p_value);
  EXPECT_FALSE(found.goodness.refuted());
  const report::Verdict verdict = *identify_document(model, found, {}, {}).verdict;
  EXPECT_EQ(verdict.agrees, std::nullopt);
  EXPECT_EQ(verdict.word, "Not tested");
  EXPECT_THAT(verdict.headline, HasSubstr("no test of the fit"));
  EXPECT_THAT(verdict.headline, HasSubstr("0 degrees of freedom"));
}

// An unknown that its bound holds back is fitted to nothing: one datum is left to test it.
TEST_F(Goodness, AnUnknownAtItsBoundIsNotFitted) {
  const Case base = pump(25);
  IdentificationData data;
  data.unknowns = {unknown_of("--vary", "pressure.delivery_bar=200:280", base)};
  data.data = {torque(base, 400, 1)};
  const Identification found = fit(DataModel(base, data));
  EXPECT_NEAR(found.fit.x[0], 280, 1e-6);
  EXPECT_EQ(found.goodness.degrees_of_freedom(), 1U);
  EXPECT_TRUE(found.goodness.refuted());
  // And one of which the data say nothing neither.
  data.unknowns = {unknown_of("--vary", "block.mass_kg=1:2", base)};
  data.data = {torque(base, 292.5, 1), torque(base, 292.6, 1)};
  EXPECT_EQ(fit(DataModel(base, data)).goodness.degrees_of_freedom(), 2U);
}

// A window that is kept tests nothing; one that cannot be kept does, and so does a prior.
TEST_F(Goodness, WindowsCountWhereTheyAreLeft) {
  const Case base = pump(25);
  IdentificationData data;
  data.unknowns = {unknown_of("--vary", "pressure.delivery_bar=200:400", base)};
  Datum window = torque(base, 0, 1);
  window.value.reset();
  window.low = -HUGE_VAL;
  window.high = 1000;
  data.data = {torque(base, 292, 1), window};
  EXPECT_EQ(fit(DataModel(base, data)).goodness.degrees_of_freedom(), 0U);
  data.data[1].high = 200;
  const Identification left = fit(DataModel(base, data));
  EXPECT_EQ(left.goodness.residuals, 2U);
  EXPECT_EQ(left.goodness.degrees_of_freedom(), 1U);
  // Halfway between 200 and 292 Nm, 46 sigma from either.
  EXPECT_NEAR(left.goodness.chi_square, 2 * 46 * 46, 5);
  data.data.pop_back();
  data.unknowns[0].prior = distribution("normal(275, 1)", "pressure.delivery_bar");
  const DataModel with_prior(base, data);
  const Identification found = fit(with_prior);
  EXPECT_EQ(found.goodness.degrees_of_freedom(), 1U);
  EXPECT_FALSE(found.goodness.refuted());
  data.data[0].value = 270;
  const DataModel contradicted(base, data);
  const Identification refuted = fit(contradicted);
  EXPECT_TRUE(refuted.goodness.refuted());
  EXPECT_EQ(name_of(contradicted, refuted.worst[0]).find("prior of ") == 0,
            refuted.worst[0].unknown.has_value());
}

}  // namespace
}  // namespace bentaxis::designs
