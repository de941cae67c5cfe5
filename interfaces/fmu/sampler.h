// Differences of the equations of a unit's pump, at many points. Internal to dependencies.cpp.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "runtime/plant.h"
#include "runtime/variables.h"

namespace bentaxis::fmu {

/// A change below this share of what is of the same kind there is round-off.
constexpr double kRoundOff = 1e-11;

/// What an unknown changes by when a known does, over all points.
struct Change {
  double largest = 0;  ///< over what is of the same kind
  std::optional<double> factor;
  bool one_factor = true;

  bool seen() const { return largest > kRoundOff; }
  /// @param scale   the magnitude of what is of the same kind
  /// @param change  of the unknown, where the known changes by `by`
  void note(double scale, double change, double by);
};
/// By unknown, then by known or parameter.
using Changes = std::vector<std::vector<Change>>;

/// Numbers that are the same on every computer.
class Random {
 public:
  double between(double low, double high) {
    constexpr double kRange = 9007199254740992.0;  // 2^53
    return low + (high - low) * static_cast<double>(bits_() >> 11) / kRange;
  }
  bool once_in(int count) { return between(0, count) < 1; }
  double sign() { return once_in(2) ? 1 : -1; }
  double power_of_ten(double low, double high) { return std::pow(10.0, between(low, high)); }

 private:
  std::mt19937_64 bits_{20};
};

/// The pump of a unit under other parameters, and its values at points that are drawn by chance.
class Sampler {
 public:
  /// Where the motion is: in its start shaft and block are at angle 0.
  enum class Where { anywhere, at_start };
  using Values = std::vector<double>;  ///< of unknowns()
  struct Point {
    double time = 0;
    std::vector<double> states;
    Inputs inputs;
  };
  struct Seen {
    Point point;
    Values values, scales;
  };

  Sampler(const Case& the_case, const UnitChoice& choice, const std::vector<Variable>& variables);

  const Case& the_case() const { return case_; }
  const std::vector<const Variable*>& unknowns() const { return unknowns_; }
  const std::vector<const Variable*>& knowns() const { return knowns_; }
  const std::vector<const Variable*>& parameters() const { return parameters_; }
  /// Of parameters, by reference.
  const std::vector<double>& start_values() const { return values_; }
  double load_size() const { return base_.load_size; }

  /// @return null where the case with these parameters has no start
  std::unique_ptr<Plant> plant_of(const std::vector<double>& parameters) const;
  /// The case's own, where the load has another size than the one that is sought.
  std::unique_ptr<Plant> plant_of_other_load() const;
  /// Other values of all parameters; those that are 0 are not, as far as the case allows it.
  std::vector<double> other_parameters();
  /// The same set with another value of one parameter, where one is allowed.
  std::optional<std::vector<double>> with_other(std::vector<double> values,
                                                const Variable& parameter) const;

  /// What moving each known alone changes, over sets of parameters.
  /// @return nothing where there were not enough points
  std::optional<Changes> changes_by_knowns(const std::vector<std::vector<double>>& sets,
                                           Where where);
  std::vector<Seen> look_around(Plant& plant, Where where);
  /// What another plant changes at the points that were seen.
  /// @param place  of an unknown's Change, by its number
  template <class Place>
  void compare(Plant& plant, const std::vector<Seen>& seen, Place place) {
    Values after;
    for (const Seen& one : seen) {
      if (!values_at(plant, one.point, true, after)) continue;
      for (std::size_t u = 0; u < unknowns_.size(); ++u)
        place(u).note(std::max(one.scales[u], std::abs(after[u])), after[u] - one.values[u], 1);
    }
  }

 private:
  std::unique_ptr<Plant> plant_from(const PlantState& start,
                                    const std::vector<double>& parameters) const;
  bool allowed(const std::vector<double>& parameters) const;
  Point any_point(const Plant& plant, Where where);
  double any_state(const Variable& state, double omega);
  double any_speed(double omega);
  bool values_at(Plant& plant, const Point& point, bool new_edges, Values& values);
  double move(Point& point, const Variable& known);
  double scale_of(std::size_t unknown, const Values& values) const;
  std::vector<double> scales_at(const Values& values) const;

  Case case_;
  UnitChoice choice_;
  const std::vector<Variable>& variables_;
  std::vector<const Variable*> unknowns_, knowns_, parameters_;
  std::vector<double> values_;
  PlantState base_;
  std::vector<double> breakpoints_;
  Random random_;
  std::vector<double> rates_, indicators_;
};

}  // namespace bentaxis::fmu
