// Speed against error of every way to compute a case.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/multibody/integrated.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/study/achieved_error.h"

namespace bentaxis::study {

/// One way to compute a turn, what it cost and what it achieved.
struct TradeoffRun {
  std::string pressure;            ///< "smooth" or "step"
  std::string model;               ///< "analytic" or "multibody"
  std::string method;              ///< "scalar", "batch", "driven" or "integrated"
  std::string variant;             ///< instruction set, scene or integrator
  std::optional<double> accuracy;  ///< of an integrated run
  std::string failure;             ///< why there is no result; empty: there is one
  double seconds_per_turn = 0;
  AchievedError error;
  std::optional<multibody::IntegrationRecord> record;  ///< of an integrated run

  bool done() const { return failure.empty(); }
};

struct TradeoffOptions {
  std::vector<multibody::Integrator> integrators;
  std::vector<double> accuracies;  ///< loosest first
  int samples_per_revolution = 0;  ///< 0: eight per piston
  double max_seconds_per_run = 10;
};

/// All runs on one turn of a case. A run that fails is listed with its reason; one that takes
/// longer than allowed is stopped, and tighter accuracies of that integrator are not tried.
/// Errors are against the analytic model in extended precision.
/// @param progress  of all runs
std::vector<TradeoffRun> measure_tradeoff(const Case& the_case, const std::string& pressure_name,
                                          const TradeoffOptions& options, const Progress& progress);

/// Runs (by index) that no other run beats in both time and error, fastest first.
std::vector<std::size_t> pareto_front(const std::vector<TradeoffRun>& runs,
                                      const std::function<bool(const TradeoffRun&)>& among);

/// How fast the error falls with the step: exponent p of error ~ step^p.
struct Order {
  std::string integrator;
  int runs = 0;  ///< that count: an error below 1e-2 and above round-off, falling steps
  std::optional<double> last_pair, least_squares;
};
/// What is outside the orders [low, high] of the method by more than half an order, in words; ""
/// where nothing is.
std::string outside_theory(const Order& order, const std::pair<int, int>& theory);
Order order_of(const std::vector<TradeoffRun>& runs, const std::string& integrator,
               double degrees_per_turn = 360);

/// The fastest integrated run whose error is at most `error`; nullptr if there is none.
const TradeoffRun* fastest_within(const std::vector<TradeoffRun>& runs, double error);

}  // namespace bentaxis::study
