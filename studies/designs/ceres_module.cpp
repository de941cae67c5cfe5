#include "ceres_module.h"

#include <ceres/ceres.h>

namespace {

using bentaxis::designs::CeresEnd;
using bentaxis::designs::CeresTask;

// All residuals as one block.
class AllResiduals final : public ceres::CostFunction {
 public:
  AllResiduals(const CeresTask& task, std::size_t parameters) : task_(task) {
    set_num_residuals(static_cast<int>(task.residuals));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(parameters));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    return task_.evaluate(parameters[0], residuals, jacobians == nullptr ? nullptr : jacobians[0]);
  }

 private:
  const CeresTask& task_;
};

// Ends the search once steps change the sum of squares by no more than is asked for.
class EnoughIsEnough final : public ceres::IterationCallback {
 public:
  explicit EnoughIsEnough(double enough) : enough_(enough) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (summary.iteration == 0 || !summary.step_is_successful) return ceres::SOLVER_CONTINUE;
    constexpr int kTimes = 2;
    times_ = 2 * summary.cost_change <= enough_ ? times_ + 1 : 0;  // the cost is half the sum
    return times_ >= kTimes ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  double enough_;
  int times_ = 0;
};

}  // namespace

CeresEnd bentaxis_ceres_solve(const CeresTask& task, std::vector<double>& u) {
  ceres::Problem problem;
  problem.AddResidualBlock(new AllResiduals(task, u.size()), nullptr, u.data());
  for (std::size_t i = 0; i < task.low.size(); ++i) {
    problem.SetParameterLowerBound(u.data(), static_cast<int>(i), task.low[i]);
    problem.SetParameterUpperBound(u.data(), static_cast<int>(i), task.high[i]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = task.options.most_iterations;
  options.function_tolerance = task.options.tolerance;
  options.parameter_tolerance = task.options.tolerance;
  options.gradient_tolerance = 0;  // of no scale that all problems share
  options.min_trust_region_radius = 1e-40;
  options.max_num_consecutive_invalid_steps = 30;
  options.logging_type = ceres::SILENT;
  EnoughIsEnough enough(task.options.enough);
  if (task.options.enough > 0) options.callbacks.push_back(&enough);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return {summary.termination_type == ceres::CONVERGENCE ||
              summary.termination_type == ceres::USER_SUCCESS,
          static_cast<int>(summary.iterations.size()), summary.message};
}

extern "C" {
decltype(&bentaxis_ceres_solve) const kBentaxisCeres = bentaxis_ceres_solve;
}
