// Time integration of stiff equations by CVODES (variable-order BDF).
#pragma once

#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace bentaxis::numerics {

/// What is integrated: dy/dt = f(t, y). Every state and every integral is in units of what it is
/// measured by: its error counts as it is. A function that returns false has no finite value there;
/// a shorter step is then tried.
class Equations {
 public:
  virtual ~Equations() = default;
  virtual int states() const = 0;
  virtual int integrals() const { return 0; }
  /// Direction in which each event function passes zero where it ends a step: +1 rising, -1
  /// falling, 0 both.
  virtual std::vector<int> event_functions() const { return {}; }

  virtual bool rates(double time, const double* y, double* dy) = 0;
  /// d(dy/dt)/dy, column-major.
  /// @param dy     rates there
  /// @param again  Newton's method has failed with what was given before
  virtual void jacobian(double time, const double* y, const double* dy, bool again,
                        double* by_state) = 0;
  virtual void integrands(double, const double*, double*) {}
  virtual void event_values(double, const double*, double*) {}
  /// Rates of the sensitivities s_j, each with as many components as there are states.
  virtual bool sensitivity_rates(double, const double*, const std::vector<const double*>&,
                                 const std::vector<double*>&) {
    return true;
  }
  /// Whether a shorter step may avoid what one of these functions has thrown.
  virtual bool is_recoverable(const std::exception&) const { return false; }
};

/// The integration cannot continue.
class IntegrationFailure : public std::runtime_error {
 public:
  enum class Reason {
    tolerance,  ///< below what double precision gives
    no_rates,   ///< the rates are not finite from there on
    step,       ///< the solution changes faster than steps above round-off can follow
  };
  explicit IntegrationFailure(Reason reason);
  Reason reason() const { return reason_; }

 private:
  Reason reason_;
};

/// Why an integration fails.
/// @param states  what is integrated, "the states"
std::string text_of(IntegrationFailure::Reason reason, const std::string& states);

/// Sensitivities that are integrated beside the states.
struct Sensitivities {
  int count = 0;
  double tolerance = 0;     ///< of each, relative and absolute
  bool sets_steps = false;  ///< their errors are controlled too
};

/// Steps through a solution. Newton's method with dense matrices.
class StiffIntegrator {
 public:
  /// @param tolerance  error per step of every state and integral
  StiffIntegrator(Equations& equations, double tolerance, const Sensitivities& sensitivities = {});
  ~StiffIntegrator();
  StiffIntegrator(const StiffIntegrator&) = delete;
  StiffIntegrator& operator=(const StiffIntegrator&) = delete;

  /// Starts, or starts again, at order 1.
  /// @param sensitivities  column-major, states() rows
  void start(double time, const std::vector<double>& y, const std::vector<double>& integrals = {},
             const std::vector<double>& sensitivities = {});
  /// Starts again from what has been reached: the slopes jump there.
  void restart();
  enum class Reached { step, stop, event };
  /// One step, which ends at `stop` or where an event function passes zero.
  /// @throws IntegrationFailure, or what the equations threw last
  Reached step(double stop);

  double time() const { return time_; }
  /// Of each event function: +1 it passed zero upwards, -1 downwards, 0 not.
  const std::vector<int>& passed() const { return passed_; }
  /// At a time of the last step, by the integrator's own polynomial; each until its next call.
  const double* state_at(double time) const;
  const double* integrals_at(double time) const;
  const std::vector<double>& sensitivities_at(double time) const;
  /// What the equations threw where shorter steps were tried, the last time since it was forgotten;
  /// or nothing.
  std::string complaint() const;
  void forget_complaint();
  long steps() const { return steps_; }  ///< of all that was started
  long evaluations() const;              ///< of the rates, since the last start

 private:
  struct Implementation;
  std::unique_ptr<Implementation> cv_;
  std::vector<int> passed_;
  double time_ = 0;
  long steps_ = 0;
};

/// Of SUNDIALS, as linked: "6.4.1".
std::string sundials_version();

}  // namespace bentaxis::numerics
