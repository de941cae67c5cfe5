// The entry of every module: closes the loops of a tree by superposition. At given motion what
// joints carry is linear in the loads. So each unknown force acts with size 1 on the tree at rest,
// and sizes are those for which no joint carries more than its supports.
#include "closed_tree.h"

#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <stdexcept>

namespace bentaxis::engines {
namespace {

class Closing {
 public:
  Closing(const bentaxis_engine_task& task, Tree& tree)
      : task_(task),
        tree_(tree),
        unknowns_(task.actions + task.supports),
        matrix_(Eigen::MatrixXd::Zero(6 * task.bodies, unknowns_)),
        scale_(unknowns_),
        joints_(6, task.bodies) {}

  // @return what joints carry beyond their supports, over all that they carry
  double solve(int sample, double* values) {
    const Eigen::Index freedoms = task_.freedoms, first = sample * freedoms;
    const double* position = task_.position + first;
    const double* velocity = task_.velocity + first;
    const double* acceleration = task_.acceleration + first;
    tree_.set(position, velocity, acceleration, false);
    for (int i = 0; i < task_.actions; ++i) {
      tree_.joint_wrenches(action(sample, i), joints_);
      matrix_.col(i) = -rows(joints_);
    }
    matrix_.rightCols(task_.supports).setZero();
    for (int i = 0; i < task_.supports; ++i) {
      const double* wrench = task_.support + 6 * (Eigen::Index{sample} * task_.supports + i);
      Wrenches alone = Wrenches::Zero(6, task_.bodies);
      alone.col(task_.support_body[i]) = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(wrench);
      matrix_.col(task_.actions + i) = rows(alone);
    }
    scale_ = matrix_.colwise().norm().transpose();
    if (!scale_.allFinite() || !(scale_.minCoeff() > 0))
      throw std::runtime_error("an unknown force does nothing");
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(matrix_ *
                                                             scale_.cwiseInverse().asDiagonal());
    if (solver.rank() < unknowns_)
      throw std::runtime_error("the reactions are not determined: the mechanism is redundant");
    // With all forces in place the engine says what is left, so that errors of the first solution
    // are taken away.
    tree_.set(position, velocity, acceleration, true);
    const Wrenches known = Eigen::Map<const Wrenches>(
        task_.loads + 6 * Eigen::Index{sample} * task_.bodies, 6, task_.bodies);
    Eigen::VectorXd sizes = Eigen::VectorXd::Zero(unknowns_);
    double residual = 0;
    for (int pass = 0; pass < 2; ++pass) {
      Wrenches loads = known;
      for (int i = 0; i < task_.actions; ++i) loads += sizes[i] * action(sample, i);
      tree_.joint_wrenches(loads, joints_);
      const Eigen::VectorXd carried = rows(joints_);
      // Supports anew, actions by what is missing.
      const Eigen::VectorXd found =
          scale_.cwiseInverse().asDiagonal() * Eigen::VectorXd(solver.solve(carried));
      sizes.head(task_.actions) += found.head(task_.actions);
      sizes.tail(task_.supports) = found.tail(task_.supports);
      const double all = carried.norm();
      residual = all > 0 ? (carried - matrix_ * found).norm() / all : 0;
    }
    if (!sizes.allFinite()) throw std::runtime_error("a result is not a number");
    Eigen::Map<Eigen::VectorXd>(values, unknowns_) = sizes;
    return residual;
  }

 private:
  Wrenches action(int sample, int i) const {
    const Eigen::Index place = (Eigen::Index{sample} * task_.actions + i) * task_.bodies;
    return Eigen::Map<const Wrenches>(task_.action + 6 * place, 6, task_.bodies);
  }
  // Forces and moments of all joints in one column and one unit.
  Eigen::VectorXd rows(Wrenches wrenches) const {
    wrenches.bottomRows(3) /= task_.length;
    return wrenches.reshaped();
  }

  const bentaxis_engine_task& task_;
  Tree& tree_;
  Eigen::Index unknowns_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd scale_;
  Wrenches joints_;
};

void say(bentaxis_engine_answer& answer, const std::string& text) {
  std::snprintf(answer.text, sizeof answer.text, "%s", text.c_str());
}

}  // namespace
}  // namespace bentaxis::engines

extern "C" int bentaxis_engine(int interface, const bentaxis_engine_task* task,
                               bentaxis_engine_answer* answer) {
  using namespace bentaxis::engines;
  if (interface != BENTAXIS_ENGINE_INTERFACE) return BENTAXIS_ENGINE_INTERFACE;
  try {
    const std::unique_ptr<Tree> tree = make_tree(*task);
    Closing closing(*task, *tree);
    const Eigen::Index width = task->actions + task->supports;
    for (int sample = 0; sample < task->samples; ++sample)
      answer->residual[sample] = closing.solve(sample, answer->values + sample * width);
    say(*answer, tree->text());
  } catch (const std::exception& error) {
    say(*answer, error.what());
    answer->values[0] = std::numeric_limits<double>::quiet_NaN();
  }
  return BENTAXIS_ENGINE_INTERFACE;
}
