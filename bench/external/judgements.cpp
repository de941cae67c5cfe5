// What compares, screens and describes results, held to examples that others print.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/motion_answers.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/tradeoff.h"
#include "numbers.h"

namespace bentaxis::external {
namespace {

// Axes turned by 90, 45 and 60 deg about z, y, x, as a quaternion: the record of another program
// may come in such a frame.
void put_axes(Numbers& numbers) {
  const compare::Axes r = compare::turned_axes("ZYX", {90, 45, 60});  // rows are the turned axes
  const double w = std::sqrt(1 + r[0][0] + r[1][1] + r[2][2]) / 2;
  for (const double part : {w, (r[1][2] - r[2][1]) / (4 * w), (r[2][0] - r[0][2]) / (4 * w),
                            (r[0][1] - r[1][0]) / (4 * w)})
    numbers.push_back({"compare.axes", part});
}

// The observed order of a result on three grids, each twice as fine as the one before: 0.961780,
// 0.968540, 0.970500, with the extrapolated value 0.971300.
void put_order(Numbers& numbers) {
  constexpr double kExtrapolated = 0.971300;
  std::vector<study::TradeoffRun> runs;
  long steps = 1;
  for (const double value : {0.961780, 0.968540, 0.970500}) {
    study::TradeoffRun run;
    run.method = "integrated";
    run.variant = "grid";
    run.error.worst = std::abs(value - kExtrapolated);
    run.record.emplace().steps = steps;
    runs.push_back(std::move(run));
    steps *= 2;
  }
  const study::Order order = study::order_of(runs, "grid");
  numbers.push_back({"verification.order", order.least_squares.value()});
}

// The step response of (8 s^2 + 18 s + 32)/(s^3 + 6 s^2 + 14 s + 24), by partial fractions (poles
// -4, -1 +- i sqrt 5), as a pressure over time.
void put_peak(Numbers& numbers) {
  constexpr int kRows = 100001;
  constexpr double kEnd = 10;
  Trajectory run;
  run.table.state_names = {"time_s", "theta_deg", "psi_deg", "shaft_rpm", "block_rpm"};
  run.oil.emplace().columns = {{"p_delivery_bar", ""}};
  const double root = std::sqrt(5.0);
  for (int row = 0; row < kRows; ++row) {
    const double t = kEnd * row / (kRows - 1);
    const double y =
        4.0 / 3 - 11.0 / 7 * std::exp(-4 * t) +
        std::exp(-t) * (5.0 / 21 * std::cos(root * t) + 41 / (21 * root) * std::sin(root * t));
    run.table.states.insert(run.table.states.end(), {t, 0, 0, 0, 0});
    run.oil->values.push_back(y);
    run.lag.push_back(0);
  }
  const study::MotionAnswers answers = study::motion_answers(run, {});
  numbers.push_back({"motion.peak", answers.delivery.value().highest_bar});
  numbers.push_back({"motion.peak_time", answers.delivery.value().highest_s});
}

// The flow of 20 cm3 per turn at 1500 rpm and a volumetric efficiency of 95 %, from what screening
// says of the default pump.
void put_flow(Numbers& numbers) {
  const study::Plausibility pump =
      study::plausibility(read_case(std::string(BENTAXIS_SOURCE_DIR) + "/cases/bap63_rated.toml"));
  constexpr double kDisplacement = 20e-6, kEfficiency = 0.95;
  numbers.push_back({"screening.flow", pump.ideal_flow / kLitrePerMinute * kDisplacement /
                                           pump.displacement * kEfficiency});
}

}  // namespace

Numbers judgements() {
  Numbers numbers;
  put_axes(numbers);
  put_order(numbers);
  put_peak(numbers);
  put_flow(numbers);
  return numbers;
}

}  // namespace bentaxis::external
