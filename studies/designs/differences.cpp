#include <algorithm>
#include <cmath>
#include <limits>

#include "bentaxis/designs/evaluator.h"
#include "bentaxis/pump/number.h"
#include "derivatives.h"

namespace bentaxis::designs {
namespace {

// Of the parameter: short, so that another sample seldom becomes the largest and friction at a dead
// centre is followed through its change of sign; longer where the
// pressure is found by a search that ends at 1e-9 or so.
constexpr double kFirstStep = 1e-4, kFirstStepOfSearch = 0.02;
constexpr double kStepOfZero = 0.01;  // in the file's unit
constexpr int kMaxShorter = 8;        // times a first step that leads nowhere is halved
// Halvings: where an evaluation is quick, and where it is a search or takes Simbody.
constexpr int kLevels = 8, kSlowLevels = 5;

// The first step from which all of both sides is inside of the range; 0 where there is none.
double first_step(const Variable& variable, const Case& base, double at) {
  const NumberRange range = variable.range(base);
  const bool search = base.pressure.kind == PressureKind::hydraulic;
  double step = at == 0 ? kStepOfZero : (search ? kFirstStepOfSearch : kFirstStep) * std::abs(at);
  const double room = std::min(at - range.low, range.high - at);
  if (step >= room) step = room / 2;
  return step > 1e-9 * std::abs(at) && step > 0 ? step : 0;
}

// C. J. F. Ridders, Advances in Engineering Software 4 (1982) 75: central differences of falling
// steps in Neville's scheme; the entry that its neighbours confirm best. Of a function that is not
// smooth (the largest of some samples) an entry may be confirmed by chance: shorter steps must come
// to it too.
class Ridders {
 public:
  // The difference of one step more, half as long as the last. @return false: no use to go on
  bool add(double difference) {
    differences_.push_back(difference);
    std::vector<double> row = {difference};
    double factor = 1;
    for (std::size_t j = 0; j < last_.size(); ++j) {
      factor *= 4;
      row.push_back((row[j] * factor - last_[j]) / (factor - 1));
      const double error = std::max(std::abs(row[j + 1] - row[j]), std::abs(row[j + 1] - last_[j]));
      if (error <= error_) {
        error_ = error;
        value_ = row[j + 1];
        level_ = differences_.size() - 1;
      }
    }
    const bool worse = last_.size() > 1 && std::abs(row.back() - last_.back()) > 2 * error_;
    last_ = std::move(row);
    return !worse;
  }
  double value() const { return value_; }
  double error() const {
    const std::size_t count = differences_.size();
    double error = error_;
    // By two steps alone, of those shorter than what the value rests on the nearest.
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = std::min(level_ + 1, count - 1); k < count && k > 0; ++k) {
      const double by_two = differences_[k] + (differences_[k] - differences_[k - 1]) / 3;
      nearest = std::min(nearest, std::abs(by_two - value_));
    }
    error = std::max(error, nearest);
    // Halving a step takes away three quarters of what is left, where a function is smooth.
    if (count < 3) return error;
    const double* const last = &differences_[count - 3];
    const double ratio = (last[0] - last[1]) / (last[1] - last[2]);
    if (ratio > 3 && ratio < 5) return error;
    const auto [low, high] = std::minmax_element(last, last + 3);
    return std::max(error, *high - *low);
  }

 private:
  std::vector<double> differences_, last_;
  double value_ = 0, error_ = std::numeric_limits<double>::infinity();
  std::size_t level_ = 0;  // of the shortest step in value_
};

}  // namespace

void find_by_differences(Sensitivities& s, std::size_t v, const std::vector<std::size_t>& outputs,
                         const Progress& progress) {
  const Evaluator evaluator(Family(s.base, {s.variables[v]}), s.outputs, s.model);
  std::string reason;
  const int levels = evaluator.fast() ? kLevels : kSlowLevels;
  int evaluations = 0;
  const auto values = [&](double x) {
    // Some more than the levels need, as a first step may be halved.
    if (progress) progress(std::min(1.0, evaluations++ / (2.0 * levels + 2)));
    Evaluation found = evaluator.evaluate({&x, 1});
    if (!found.feasible()) reason = found.reason;
    return found.values;
  };
  double step = first_step(s.variables[v], s.base, s.at[v]);
  if (step == 0) reason = "is at a bound of its range";
  for (int i = 0; step > 0; ++i, step /= 2) {
    reason.clear();
    values(s.at[v] + step);
    if (reason.empty()) values(s.at[v] - step);
    if (reason.empty() || i == kMaxShorter) break;
  }
  if (!reason.empty()) {
    for (const std::size_t o : outputs)
      s.derivatives[o][v] = {not_computed(), 0, Way::differences, reason};
    return;
  }
  const double first = step;
  std::vector<Ridders> tables(outputs.size());
  std::vector<bool> going(outputs.size(), true);
  for (int level = 0; level < levels; ++level, step /= 2) {
    const double above = s.at[v] + step, below = s.at[v] - step;
    const auto high = values(above), low = values(below);
    if (!reason.empty()) break;
    for (std::size_t i = 0; i < outputs.size(); ++i)
      if (going[i])
        going[i] = tables[i].add((high[outputs[i]] - low[outputs[i]]) / (above - below));
  }
  // Round-off of the output, over the longest step.
  constexpr double kRoundOff = 4 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const double noise = kRoundOff * s.scales[outputs[i]] / first;
    Derivative found = {tables[i].value(), tables[i].error() + noise, Way::differences};
    if (!std::isfinite(found.error)) found = {not_computed(), 0, Way::differences, kNoDifferences};
    s.derivatives[outputs[i]][v] = found;
  }
}

}  // namespace bentaxis::designs
