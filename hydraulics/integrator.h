// Time integration of the network over one period by CVODES (variable-order BDF).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "network.h"

namespace bentaxis::hydraulics {

/// Integrals over the angles of a period; masses in kg, work in J.
struct Integrals {
  double suction = 0, delivery = 0, leakage = 0, load = 0;
  double work = 0;  ///< of the pistons on the oil, gauge pressure
};

/// What an integration cost.
struct Work {
  long steps = 0, evaluations = 0, factorizations = 0;
};

/// Carries states through one period of 360/N degrees. Restarts at every port edge. Uses CVODES'
/// dense Newton iteration with the network's own Jacobian, and its forward sensitivities.
class Integrator {
 public:
  explicit Integrator(const Network& network);

  /// Receives the state at angles of the period, rising.
  using Observer = std::function<void(double x, const double* y)>;
  struct Watch {
    std::vector<double> at;  ///< angles in [0, period) where `sample` is called, rising
    Observer sample;
    Observer step;  ///< called after every step of the integrator
  };

  /// State at the end of the period from the state at its start (pressures; the mean starts at 0).
  /// @param tolerance    error of s (so relative error of P) allowed per step
  /// @param sensitivity  if not null: receives d(end state)/d(start pressures, ln load_area),
  ///                     column-major, size() rows; the last column only with a load
  /// @param integrals    if not null: receives the integrals, with the same control of error
  /// @throws ComputationError naming the angle where the integration fails
  std::vector<double> over_period(const std::vector<double>& pressures, double load_area,
                                  double tolerance, std::vector<double>* sensitivity = nullptr,
                                  Integrals* integrals = nullptr, const Watch* watch = nullptr);

  const Work& work() const { return work_; }  ///< of all calls so far

 private:
  struct Implementation;
  const Network& network_;
  Work work_;
};

}  // namespace bentaxis::hydraulics
