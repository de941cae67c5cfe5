// Time integration of stiff equations by CVODES (variable-order BDF). Internal.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "bentaxis/pump/error.h"

namespace bentaxis::coupled {

/// What is integrated. Every state and every integral is in units of what it is measured by: its
/// error counts as it is.
class Equations {
 public:
  virtual ~Equations() = default;
  virtual int states() const = 0;
  virtual int integrals() const = 0;
  /// Which way each guard passes zero where it ends a step: +1 rising, -1 falling, 0 both.
  virtual std::vector<int> event_functions() const = 0;

  /// @return false where a value is not finite
  virtual bool rates(double time, const double* y, double* dy) = 0;
  /// d(dy/dt)/dy, column-major.
  /// @param dy     rates there
  /// @param again  Newton's method has failed with what was given before
  virtual void jacobian(double time, const double* y, const double* dy, bool again,
                        double* by_state) = 0;
  virtual void integrands(double time, const double* y, double* dq) = 0;
  virtual void guard_values(double time, const double* y, double* values) = 0;
};

/// The integration does not get on.
class IntegrationFailure : public ComputationError {
 public:
  using ComputationError::ComputationError;
};

/// Steps through a solution. Newton's method with dense matrices.
class Integrator {
 public:
  /// @param tolerance  error per step of every state and integral
  Integrator(Equations& equations, double tolerance);
  ~Integrator();
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  /// Starts, or starts again, at order 1.
  void start(double time, const std::vector<double>& y, const std::vector<double>& integrals);
  enum class Reached { step, stop, guard };
  /// One step, which ends at `stop` or where a guard passes zero.
  /// @throws IntegrationFailure, or what the equations threw
  Reached step(double stop);

  double time() const { return time_; }
  double last_step() const { return last_step_; }  ///< s
  /// Of each guard: +1 it passed zero upwards, -1 downwards, 0 not.
  const std::vector<int>& passed() const { return passed_; }
  /// At a time of the last step, by the integrator's own polynomial.
  void state_at(double time, double* y) const;
  void integrals_at(double time, double* q) const;
  /// Why the equations had no rates at last, since this was forgotten; or nothing.
  std::string complaint() const;
  void forget_complaint();
  long steps() const { return steps_; }  ///< of all that was started

 private:
  struct Implementation;
  std::unique_ptr<Implementation> cv_;
  std::vector<int> passed_;
  double time_ = 0, last_step_ = 0;
  long steps_ = 0;
};

}  // namespace bentaxis::coupled
