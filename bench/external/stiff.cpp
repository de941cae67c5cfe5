// Problems of the Test Set for IVP Solvers by the integrator of the pressures.
#include <algorithm>
#include <string>
#include <vector>

#include "bentaxis/numerics/stiff_integrator.h"
#include "numbers.h"

namespace bentaxis::external {
namespace {

using Rates = void (*)(const double* y, double* dy);

// dy/dt of y over scales, with a Jacobian by differences.
class Problem : public numerics::Equations {
 public:
  Problem(Rates law, std::vector<double> scales) : rates_(law), scales_(std::move(scales)) {}
  int states() const override { return static_cast<int>(scales_.size()); }
  bool rates(double, const double* y, double* dy) override {
    std::vector<double> at(scales_.size());
    for (std::size_t i = 0; i < at.size(); ++i) at[i] = y[i] * scales_[i];
    rates_(at.data(), dy);
    for (std::size_t i = 0; i < at.size(); ++i) dy[i] /= scales_[i];
    return true;
  }
  void jacobian(double time, const double* y, const double* dy, bool, double* by_state) override {
    const std::size_t n = scales_.size();
    std::vector<double> at(y, y + n), changed(n);
    for (std::size_t j = 0; j < n; ++j) {
      const double step = 1e-7 * std::max(1e-3, std::abs(y[j]));
      at[j] = y[j] + step;
      rates(time, at.data(), changed.data());
      for (std::size_t i = 0; i < n; ++i) by_state[j * n + i] = (changed[i] - dy[i]) / step;
      at[j] = y[j];
    }
  }

 private:
  Rates rates_;
  std::vector<double> scales_;
};

void put(Numbers& numbers, const std::string& name, Rates rates, const std::vector<double>& scales,
         std::vector<double> y, double end) {
  Problem problem(rates, scales);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] /= scales[i];
  numerics::StiffIntegrator integrator(problem, 1e-9);
  integrator.start(0, y);
  while (integrator.time() < end) integrator.step(end);
  const double* last = integrator.state_at(end);
  for (std::size_t i = 0; i < y.size(); ++i) numbers.push_back({name, last[i] * scales[i]});
}

}  // namespace

Numbers stiff() {
  Numbers numbers;
  put(
      numbers, "stiff.hires",
      [](const double* y, double* dy) {
        dy[0] = -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007;
        dy[1] = 1.71 * y[0] - 8.75 * y[1];
        dy[2] = -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4];
        dy[3] = 8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3];
        dy[4] = -1.745 * y[4] + 0.43 * (y[5] + y[6]);
        dy[6] = 280 * y[5] * y[7] - 1.81 * y[6];
        dy[5] = -280 * y[5] * y[7] + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6];
        dy[7] = -dy[6];
      },
      std::vector<double>(8, 0.01), {1, 0, 0, 0, 0, 0, 0, 0.0057}, 321.8122);
  put(
      numbers, "stiff.van_der_pol",
      [](const double* y, double* dy) {
        dy[0] = y[1];
        dy[1] = ((1 - y[0] * y[0]) * y[1] - y[0]) / 1e-6;
      },
      {1, 1}, {2, 0}, 2);
  put(
      numbers, "stiff.orego",
      [](const double* y, double* dy) {
        dy[0] = 77.27 * (y[1] + y[0] * (1 - 8.375e-6 * y[0] - y[1]));
        dy[1] = (y[2] - (1 + y[0]) * y[1]) / 77.27;
        dy[2] = 0.161 * (y[0] - y[2]);
      },
      {1, 1000, 1000}, {1, 2, 3}, 360);
  return numbers;
}

}  // namespace bentaxis::external
