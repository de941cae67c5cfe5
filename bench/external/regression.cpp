// NIST's nonlinear regressions (Statistical Reference Datasets), all of them, from both starts.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bentaxis/designs/least_squares.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "numbers.h"

namespace bentaxis::external {
namespace {

using B = std::span<const double>;
using X = std::span<const double>;

double exponentials(X x, B b) {
  return b[0] * std::exp(-b[1] * x[0]) + b[2] * std::exp(-b[3] * x[0]) +
         b[4] * std::exp(-b[5] * x[0]);
}
double bell(double x, double height, double middle, double width) {
  return height * std::exp(-std::pow((x - middle) / width, 2));
}
double two_bells(X x, B b) {
  return b[0] * std::exp(-b[1] * x[0]) + bell(x[0], b[2], b[3], b[4]) +
         bell(x[0], b[5], b[6], b[7]);
}
double decay_over_line(X x, B b) { return std::exp(-b[0] * x[0]) / (b[1] + b[2] * x[0]); }
double cubic_over_cubic(X x, B b) {
  return (b[0] + x[0] * (b[1] + x[0] * (b[2] + x[0] * b[3]))) /
         (1 + x[0] * (b[4] + x[0] * (b[5] + x[0] * b[6])));
}
double saturation(X x, B b) { return -b[0] * std::expm1(-b[1] * x[0]); }
double oscillation(X x, B b) {
  const auto wave = [&](double period, double c, double s) {
    const double phase = 2 * kPi * x[0] / period;
    return c * std::cos(phase) + s * std::sin(phase);
  };
  return b[0] + wave(12, b[1], b[2]) + wave(b[3], b[4], b[5]) + wave(b[6], b[7], b[8]);
}

struct Dataset {
  std::string name;
  double (*model)(X x, B b);
  std::array<std::vector<double>, 2> starts;
};

const std::vector<Dataset>& datasets() {
  static const std::vector<Dataset> all = {
      {"Bennett5",
       [](X x, B b) { return b[0] * std::pow(b[1] + x[0], -1 / b[2]); },
       {{{-2000, 50, 0.8}, {-1500, 45, 0.85}}}},
      {"BoxBOD", saturation, {{{1, 1}, {100, 0.75}}}},
      {"Chwirut1", decay_over_line, {{{0.1, 0.01, 0.02}, {0.15, 0.008, 0.010}}}},
      {"Chwirut2", decay_over_line, {{{0.1, 0.01, 0.02}, {0.15, 0.008, 0.010}}}},
      {"DanWood", [](X x, B b) { return b[0] * std::pow(x[0], b[1]); }, {{{1, 5}, {0.7, 4}}}},
      {"ENSO",
       oscillation,
       {{{11, 3, 0.5, 40, -0.7, -1.3, 25, -0.3, 1.4}, {10, 3, 0.5, 44, -1.5, 0.5, 26, -0.1, 1.5}}}},
      {"Eckerle4",
       [](X x, B b) { return b[0] / b[1] * std::exp(-0.5 * std::pow((x[0] - b[2]) / b[1], 2)); },
       {{{1, 10, 500}, {1.5, 5, 450}}}},
      {"Gauss1",
       two_bells,
       {{{97, 0.009, 100, 65, 20, 70, 178, 16.5}, {94, 0.0105, 99, 63, 25, 71, 180, 20}}}},
      {"Gauss2",
       two_bells,
       {{{96, 0.009, 103, 106, 18, 72, 151, 18}, {98, 0.0105, 103, 105, 20, 73, 150, 20}}}},
      {"Gauss3",
       two_bells,
       {{{94.9, 0.009, 90.1, 113, 20, 73.8, 140, 20}, {96, 0.0096, 80, 110, 25, 74, 139, 25}}}},
      {"Hahn1",
       cubic_over_cubic,
       {{{10, -1, 0.05, -1e-5, -0.05, 0.001, -1e-6},
         {1, -0.1, 0.005, -1e-6, -0.005, 1e-4, -1e-7}}}},
      {"Kirby2",
       [](X x, B b) {
         return (b[0] + x[0] * (b[1] + x[0] * b[2])) / (1 + x[0] * (b[3] + x[0] * b[4]));
       },
       {{{2, -0.1, 0.003, -0.001, 1e-5}, {1.5, -0.15, 0.0025, -0.0015, 2e-5}}}},
      {"Lanczos1", exponentials, {{{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4, 6.3}}}},
      {"Lanczos2", exponentials, {{{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4, 6.3}}}},
      {"Lanczos3", exponentials, {{{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4, 6.3}}}},
      {"MGH09",
       [](X x, B b) {
         return b[0] * (x[0] * x[0] + x[0] * b[1]) / (x[0] * x[0] + x[0] * b[2] + b[3]);
       },
       {{{25, 39, 41.5, 39}, {0.25, 0.39, 0.415, 0.39}}}},
      {"MGH10",
       [](X x, B b) { return b[0] * std::exp(b[1] / (x[0] + b[2])); },
       {{{2, 400000, 25000}, {0.02, 4000, 250}}}},
      {"MGH17",
       [](X x, B b) {
         return b[0] + b[1] * std::exp(-x[0] * b[3]) + b[2] * std::exp(-x[0] * b[4]);
       },
       {{{50, 150, -100, 1, 2}, {0.5, 1.5, -1, 0.01, 0.02}}}},
      {"Misra1a", saturation, {{{500, 1e-4}, {250, 5e-4}}}},
      {"Misra1b",
       [](X x, B b) { return b[0] * (1 - std::pow(1 + b[1] * x[0] / 2, -2)); },
       {{{500, 1e-4}, {300, 2e-4}}}},
      {"Misra1c",
       [](X x, B b) { return b[0] * (1 - 1 / std::sqrt(1 + 2 * b[1] * x[0])); },
       {{{500, 1e-4}, {600, 2e-4}}}},
      {"Misra1d",
       [](X x, B b) { return b[0] * b[1] * x[0] / (1 + b[1] * x[0]); },
       {{{500, 1e-4}, {450, 3e-4}}}},
      {"Nelson",
       [](X x, B b) { return b[0] - b[1] * x[0] * std::exp(-b[2] * x[1]); },
       {{{2, 1e-4, -0.01}, {2.5, 5e-9, -0.05}}}},
      {"Rat42",
       [](X x, B b) { return b[0] / (1 + std::exp(b[1] - b[2] * x[0])); },
       {{{100, 1, 0.1}, {75, 2.5, 0.07}}}},
      {"Rat43",
       [](X x, B b) { return b[0] / std::pow(1 + std::exp(b[1] - b[2] * x[0]), 1 / b[3]); },
       {{{100, 10, 1, 1}, {700, 5, 0.75, 1.3}}}},
      {"Roszman1",
       [](X x, B b) { return b[0] - b[1] * x[0] - std::atan(b[2] / (x[0] - b[3])) / kPi; },
       {{{0.1, -1e-5, 1000, -100}, {0.2, -5e-6, 1200, -150}}}},
      {"Thurber",
       cubic_over_cubic,
       {{{1000, 1000, 400, 40, 0.7, 0.3, 0.03}, {1300, 1500, 500, 75, 1, 0.4, 0.05}}}}};
  return all;
}

designs::LeastSquaresProblem problem_of(const Dataset& dataset) {
  const NumericTable data = read_numeric_csv(
      std::filesystem::path(BENTAXIS_SOURCE_DIR "/tests/nist") / (dataset.name + ".csv"));
  designs::LeastSquaresProblem problem;
  problem.parameters = dataset.starts[0].size();
  problem.residuals = data.rows.size();
  problem.evaluate = [rows = data.rows, &dataset](B b, std::span<double> residuals) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double measured = rows[i].back();
      residuals[i] = (dataset.name == "Nelson" ? std::log(measured) : measured) -
                     dataset.model(X(rows[i]).first(rows[i].size() - 1), b);
      if (!std::isfinite(residuals[i])) return false;
    }
    return true;
  };
  return problem;
}

}  // namespace

// Parameters, their standard deviations, the residual standard deviation.
Numbers regression() {
  Numbers numbers;
  for (const Dataset& dataset : datasets())
    for (const std::size_t start : {0U, 1U}) {
      const designs::LeastSquaresFit fit =
          designs::least_squares(problem_of(dataset), dataset.starts[start]);
      const auto put = [&](double value) {
        numbers.push_back({"nist." + dataset.name + ".start" + std::to_string(start + 1), value});
      };
      for (const double b : fit.x) put(b);
      std::vector<double> covariance(fit.x.size() * fit.x.size(), not_computed());
      try {
        covariance = fit.covariance();
      } catch (const ComputationError&) {  // not a minimum: its deviations are missing
      }
      for (std::size_t i = 0; i < fit.x.size(); ++i)
        put(fit.residual_deviation() * std::sqrt(covariance[i * fit.x.size() + i]));
      put(fit.residual_deviation());
    }
  return numbers;
}

}  // namespace bentaxis::external
