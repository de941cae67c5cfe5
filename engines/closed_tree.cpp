// The entry of every module: closes the loops of a tree by superposition. At given motion what
// joints carry is linear in the loads. So each unknown force acts with size 1 on the tree at rest,
// and sizes are those for which no joint carries more than its supports. Where the engine
// integrates, the forces of the loops are its own, and the others are found at its own motion.
#include "closed_tree.h"

#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace bentaxis::engines {

Settings::Settings(const std::string& known, const std::string& given) {
  std::istringstream all(known), changes(given);
  for (std::string word; all >> word;) {
    const std::size_t equals = word.find('=');
    values_[word.substr(0, equals)] =
        word.substr(equals + 1, word.find_first_of(",;", equals) - equals - 1);
  }
  for (std::string word; changes >> word;) {
    const std::string name = word.substr(0, word.find('='));
    if (values_.count(name) == 0 || name.size() == word.size())
      throw std::runtime_error("has no setting " + word + ": must be one of " + known);
    values_[name] = word.substr(name.size() + 1);
  }
}

double Settings::number(const std::string& name) const {
  const std::string& text = word(name);
  // Not strtod: where the locale has a decimal comma it reads 0.5 as 0.
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end || !(value >= 0) || !std::isfinite(value))
    throw std::runtime_error("setting " + name + "=" + text + ": must be a number of at least 0");
  return value;
}

std::string Settings::text() const {
  std::string text;
  for (const auto& [name, value] : values_) text += (text.empty() ? "" : ", ") + name + " " + value;
  return text;
}

namespace {

class Closing {
 public:
  Closing(const bentaxis_engine_task& task, Tree& tree)
      : task_(task),
        tree_(tree),
        sizes_(Eigen::VectorXd::Zero(task.actions + task.supports)),
        joints_(6, task.bodies) {}

  /// At given motion.
  double solve(int sample, double* values) {
    const Eigen::Index freedoms = task_.freedoms, first = sample * freedoms;
    for (int i = 0; i < task_.actions; ++i) unknown_.push_back(i);
    return solve(sample, task_.position + first, task_.velocity + first, task_.acceleration + first,
                 values);
  }

  /// As the engine has integrated it, with its forces of the loops.
  double solve(int sample, const Moment& moment, double* values) {
    std::vector<bool> is_found(task_.actions);
    for (int loop = 0; loop < task_.loops; ++loop) {
      const int action = task_.loop_action[loop];
      Eigen::Matrix3d directions;
      for (int i = 0; i < 3; ++i) {
        directions.col(i) = force(sample, action + i).head<3>();
        is_found[action + i] = true;
      }
      sizes_.segment<3>(action) = directions.partialPivLu().solve(moment.loop_force.col(loop));
    }
    for (int i = 0; i < task_.actions; ++i)
      if (!is_found[i]) unknown_.push_back(i);
    return solve(sample, moment.position.data(), moment.velocity.data(), moment.acceleration.data(),
                 values);
  }

 private:
  // Finds the sizes of the unknown forces and of the supports beside those that are in sizes_.
  // @return what joints carry beyond their supports, over all that they carry
  double solve(int sample, const double* position, const double* velocity,
               const double* acceleration, double* values) {
    const auto actions = static_cast<Eigen::Index>(unknown_.size());
    const Eigen::Index unknowns = actions + task_.supports;
    Eigen::MatrixXd matrix(6 * task_.bodies, unknowns);
    tree_.set(position, velocity, acceleration, false);
    for (Eigen::Index i = 0; i < actions; ++i) {
      Wrenches alone = Wrenches::Zero(6, task_.bodies);
      add_action(sample, unknown_[i], 1, alone);
      tree_.joint_wrenches(alone, joints_);
      matrix.col(i) = -rows(joints_);
    }
    for (int i = 0; i < task_.supports; ++i) {
      const double* wrench = task_.support + 6 * (Eigen::Index{sample} * task_.supports + i);
      Wrenches alone = Wrenches::Zero(6, task_.bodies);
      alone.col(task_.support_body[i]) = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(wrench);
      matrix.col(actions + i) = rows(alone);
    }
    const Eigen::VectorXd scale = matrix.colwise().norm().transpose();
    if (!scale.allFinite() || !(scale.minCoeff() > 0))
      throw std::runtime_error("an unknown force does nothing");
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(matrix *
                                                             scale.cwiseInverse().asDiagonal());
    if (solver.rank() < unknowns)
      throw std::runtime_error("the reactions are not determined: the mechanism is redundant");
    // With all forces in place the engine says what is left, so that errors of the first solution
    // are taken away.
    tree_.set(position, velocity, acceleration, true);
    const Wrenches known = Eigen::Map<const Wrenches>(
        task_.loads + 6 * Eigen::Index{sample} * task_.bodies, 6, task_.bodies);
    double residual = 0;
    for (int pass = 0; pass < 2; ++pass) {
      Wrenches loads = known;
      for (int i = 0; i < task_.actions; ++i) add_action(sample, i, sizes_[i], loads);
      tree_.joint_wrenches(loads, joints_);
      const Eigen::VectorXd carried = rows(joints_);
      // Supports anew, actions by what is missing.
      const Eigen::VectorXd found =
          scale.cwiseInverse().asDiagonal() * Eigen::VectorXd(solver.solve(carried));
      for (Eigen::Index i = 0; i < actions; ++i) sizes_[unknown_[i]] += found[i];
      sizes_.tail(task_.supports) = found.tail(task_.supports);
      const double all = carried.norm();
      residual = all > 0 ? (carried - matrix * found).norm() / all : 0;
    }
    if (!sizes_.allFinite()) throw std::runtime_error("a result is not a number");
    Eigen::Map<Eigen::VectorXd>(values, sizes_.size()) = sizes_;
    sizes_.setZero();
    unknown_.clear();
    return residual;
  }

  Eigen::Map<const Eigen::Matrix<double, 6, 1>> force(int sample, int action) const {
    return Eigen::Map<const Eigen::Matrix<double, 6, 1>>(
        task_.action + 6 * (Eigen::Index{sample} * task_.actions + action));
  }
  void add_action(int sample, int i, double size, Wrenches& loads) const {
    if (task_.action_on[i] >= 0) loads.col(task_.action_on[i]) += size * force(sample, i);
    if (task_.action_by[i] >= 0) loads.col(task_.action_by[i]) -= size * force(sample, i);
  }
  // Forces and moments of all joints in one column and one unit.
  Eigen::VectorXd rows(Wrenches wrenches) const {
    wrenches.bottomRows(3) /= task_.length;
    return wrenches.reshaped();
  }

  const bentaxis_engine_task& task_;
  Tree& tree_;
  std::vector<int> unknown_;  // actions
  Eigen::VectorXd sizes_;
  Wrenches joints_;
};

// All steps first, since they are timed.
std::string integrate(const bentaxis_engine_task& task, Closing& closing,
                      bentaxis_engine_answer& answer) {
  const auto integration = make_integration(task, Settings(known_settings(), task.settings));
  const auto is_wanted = [&](int sample) {
    return sample >= task.first && (sample - task.first) % task.every == 0;
  };
  std::vector<Moment> moments(task.samples);
  auto start = std::chrono::steady_clock::now();
  for (int sample = 0; sample + 2 < task.samples; sample += 2) {
    if (sample == task.first) start = std::chrono::steady_clock::now();
    integration->step(sample, is_wanted(sample) ? &moments[sample] : nullptr);
  }
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const Eigen::Index width = task.actions + task.supports;
  for (int sample = 0; sample + 2 < task.samples; sample += 2)
    if (is_wanted(sample))
      answer.residual[sample] =
          closing.solve(sample, moments[sample], answer.values + sample * width);
  return integration->text();
}

std::string answer_task(const bentaxis_engine_task& task, bentaxis_engine_answer& answer) {
  if (task.request == BENTAXIS_ENGINE_SETTINGS) return known_settings();
  const std::unique_ptr<Tree> tree = make_tree(task);
  Closing closing(task, *tree);
  if (task.request == BENTAXIS_ENGINE_INTEGRATED) return integrate(task, closing, answer);
  const Eigen::Index width = task.actions + task.supports;
  for (int sample = 0; sample < task.samples; ++sample)
    answer.residual[sample] = closing.solve(sample, answer.values + sample * width);
  return tree->text();
}

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
    say(*answer, answer_task(*task, *answer));
  } catch (const std::exception& error) {
    say(*answer, error.what());
    if (task->samples > 0) answer->values[0] = std::numeric_limits<double>::quiet_NaN();
  }
  return BENTAXIS_ENGINE_INTERFACE;
}
