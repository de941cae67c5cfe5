// A hundred records of a rig with noise, each identified: whether the bands that are given hold
// what they claim. Minutes long: among the slow tests (BENTAXIS_SLOW_TESTS=1).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "bentaxis/designs/identify.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::designs {
namespace {

constexpr int kRecords = 100;
constexpr double kNoise = 0.01;   // standard, of each channel's peak
constexpr std::size_t kRow = 17;  // of 72: where the bands of reactions are looked at
// Of bore and pressure forces show the product alone: only one of them can be unknown.
const std::vector<std::string> kUnknowns = {"pump.tilt_deg=36:44", "pump.bore_diameter_mm=21:24",
                                            "pump.axis_offset_mm=0:1"};
const std::vector<std::string> kMeasured = {"Rb1_x1_N", "Rb1_z1_N", "Rb2_y1_N", "Td_z1_Nm"};

Case truth() {
  return read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml",
                   {"operation.samples_per_revolution=72", "pump.axis_offset_mm=0.4"});
}

// What the rig writes down: every other sample, with normal noise.
IdentificationData record_of(const Case& the_case, const ResultTable& turn, unsigned seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&] { return (static_cast<double>(engine() >> 11U) + 0.5) * 0x1p-53; };
  IdentificationData data;
  for (const std::string& text : kUnknowns)
    data.unknowns.push_back(unknown_of("--vary", text, the_case));
  for (const std::string& name : kMeasured) {
    Datum datum;
    datum.what = name;
    datum.curve.emplace();
    datum.curve->column = turn.find(name);
    double peak = 0;
    for (std::size_t row = 0; row < turn.rows(); ++row)
      peak = std::max(peak, std::abs(turn.at(row, datum.curve->column)));
    datum.uncertainty = kNoise * peak;
    for (std::size_t row = 0; row < turn.rows(); row += 2) {
      const double normal = std::sqrt(-2 * std::log(uniform())) * std::cos(2 * M_PI * uniform());
      datum.curve->theta_deg.push_back(turn.theta_deg[row]);
      datum.curve->values.push_back(turn.at(row, datum.curve->column) + datum.uncertainty * normal);
      datum.curve->uncertainties.push_back(datum.uncertainty);
    }
    data.data.push_back(std::move(datum));
  }
  return data;
}

// Standard deviations that no unbiased estimate can be below, of numbers with these derivatives.
double bound_of(const std::vector<double>& covariance, std::span<const double> slope) {
  double variance = 0;
  for (std::size_t i = 0; i < slope.size(); ++i)
    for (std::size_t j = 0; j < slope.size(); ++j)
      variance += slope[i] * covariance[i * slope.size() + j] * slope[j];
  return std::sqrt(variance);
}

struct Count {
  int inside = 0;
  double width = 0;
};

TEST(IdentificationStudy, TheTruthIsInsideItsBandsAndTheyAreAsNarrowAsTheyCanBe) {
  if (least_squares_library().empty()) GTEST_SKIP() << "without Ceres";
  if (std::getenv("BENTAXIS_SLOW_TESTS") == nullptr) GTEST_SKIP() << "BENTAXIS_SLOW_TESTS not set";
  const Case the_case = truth();
  const ResultTable turn = study::run_turn(study::prepare(the_case), study::Model::analytic);
  const DataModel exact(the_case, record_of(the_case, turn, 0));
  const std::vector<double> x = exact.start();
  const std::size_t n = exact.size();
  LeastSquaresFit at_truth;
  at_truth.x = x;
  const LeastSquaresProblem problem = exact.problem();
  at_truth.residuals.resize(problem.residuals);
  at_truth.jacobian.resize(problem.residuals * n);
  ASSERT_TRUE(derivatives_of(problem, x, at_truth.jacobian));
  const std::vector<double> covariance = at_truth.covariance();
  LeastSquaresProblem reactions;
  reactions.parameters = n;
  reactions.residuals = ChannelLayout(5).reactions();
  reactions.evaluate = [&](std::span<const double> at, std::span<double> values) {
    const ResultTable table = exact.turn(at);
    for (std::size_t c = 0; c < values.size(); ++c) values[c] = table.at(kRow, c);
    return true;
  };
  std::vector<double> slopes(reactions.residuals * n);
  ASSERT_TRUE(derivatives_of(reactions, x, slopes));

  std::vector<Count> unknowns(n), bands(reactions.residuals);
  std::vector<bool> seen(reactions.residuals, false);
  for (int r = 0; r < kRecords; ++r) {
    const DataModel model(the_case, record_of(the_case, turn, 1000 + static_cast<unsigned>(r)));
    IdentifyOptions options;
    options.starts = 1;
    options.steps = 160;
    options.draws = 400;
    options.profiles = options.leave_one_out = false;
    const Identification found = identify(model, options);
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<double> draws;
      for (std::size_t d = 0; d < found.posterior.count; ++d)
        draws.push_back(found.posterior.unknowns[d * n + i]);
      std::sort(draws.begin(), draws.end());
      const double low = draws[draws.size() / 40],
                   high = draws[draws.size() - 1 - draws.size() / 40];
      unknowns[i].inside += low <= x[i] && x[i] <= high;
      unknowns[i].width += (high - low) / kRecords;
    }
    for (const ReactionBand& band : found.bands) {
      const double value = turn.at(kRow, band.column);
      seen[band.column] = true;
      bands[band.column].inside += band.low[kRow] <= value && value <= band.high[kRow];
      bands[band.column].width += (band.high[kRow] - band.low[kRow]) / kRecords;
    }
  }
  constexpr double k95 = 2 * 1.959964;
  const auto judge = [&](const std::string& name, const Count& count, double bound) {
    std::printf("%-28s %3d of %d inside, width %.3f of Cramer-Rao\n", name.c_str(), count.inside,
                kRecords, count.width / (k95 * bound));
    EXPECT_GE(count.inside, 89) << name;
    EXPECT_NEAR(count.width / (k95 * bound), 1, 0.2) << name;
  };
  for (std::size_t i = 0; i < n; ++i)
    judge(exact.data().unknowns[i].name(), unknowns[i], std::sqrt(covariance[i * n + i]));
  for (std::size_t c = 0; c < bands.size(); ++c)
    if (seen[c])
      judge(turn.channels[c].name, bands[c],
            bound_of(covariance, std::span(slopes).subspan(c * n, n)));
}

// Simulation-based calibration (Talts et al. 2018): rigs whose parameters are drawn from the
// bounds. The rank of a true value among draws of its posterior is then uniform.
TEST(IdentificationStudy, RanksOfTrueValuesAreUniform) {
  if (least_squares_library().empty()) GTEST_SKIP() << "without Ceres";
  if (std::getenv("BENTAXIS_SLOW_TESTS") == nullptr) GTEST_SKIP() << "BENTAXIS_SLOW_TESTS not set";
  constexpr int kRigs = 200, kDraws = 63, kBins = 8;
  constexpr double kLargest = 24.32;  // of chi-square with 7 degrees of freedom: one in a thousand
  const Case base = truth();
  std::mt19937_64 engine(7);
  std::vector<std::vector<int>> bins;
  int refuted = 0;
  for (int rig = 0; rig < kRigs; ++rig) {
    Case the_case = base;
    std::vector<double> drawn;
    for (const std::string& text : kUnknowns) {
      const Unknown u = unknown_of("--vary", text, base);
      const double share = (static_cast<double>(engine() >> 11U) + 0.5) * 0x1p-53;
      drawn.push_back(u.low + share * (u.high - u.low));
      u.variable.put(the_case, drawn.back());
    }
    bins.resize(drawn.size(), std::vector<int>(kBins, 0));
    const ResultTable turn = study::run_turn(study::prepare(the_case), study::Model::analytic);
    const DataModel model(base, record_of(the_case, turn, 5000 + static_cast<unsigned>(rig)));
    IdentifyOptions options;
    options.starts = 2;
    options.steps = 400;
    options.draws = kDraws;
    options.profiles = options.leave_one_out = false;
    const Posterior posterior = identify(model, options).posterior;
    if (posterior.count == 0) {  // refuted by chance: one in a thousand
      ++refuted;
      continue;
    }
    for (std::size_t i = 0; i < drawn.size(); ++i) {
      int rank = 0;
      for (std::size_t d = 0; d < posterior.count; ++d)
        rank += posterior.unknowns[d * drawn.size() + i] < drawn[i];
      ++bins[i][static_cast<std::size_t>(rank * kBins / (kDraws + 1))];
    }
  }
  EXPECT_LE(refuted, 2);
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const double each = static_cast<double>(kRigs - refuted) / kBins;
    double chi_square = 0;
    std::printf("%-32s ranks", kUnknowns[i].c_str());
    for (const int count : bins[i]) {
      chi_square += std::pow(count - each, 2) / each;
      std::printf(" %d", count);
    }
    std::printf(", chi-square %.1f of at most %.1f\n", chi_square, kLargest);
    EXPECT_LE(chi_square, kLargest) << kUnknowns[i];
  }
}

}  // namespace
}  // namespace bentaxis::designs
