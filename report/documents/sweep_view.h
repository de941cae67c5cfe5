// Designs of a sweep by their numbers, as its report shows them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/designs/sweep.h"
#include "bentaxis/report/document.h"

namespace bentaxis::designs {

class SweepView {
 public:
  explicit SweepView(const SweepResult& result);

  const SweepPlan& plan() const { return result_.plan; }
  std::size_t designs() const { return result_.designs; }
  std::size_t variables() const { return plan().varied.size(); }
  std::size_t outputs() const { return plan().outputs.size(); }
  const Variable& variable(std::size_t k) const { return plan().varied[k].variable; }
  const Output& output(std::size_t k) const { return plan().outputs[k]; }
  int direction(std::size_t k) const { return plan().direction.empty() ? 0 : plan().direction[k]; }

  double value(std::size_t design, std::size_t variable) const {
    return result_.values[design * variables() + variable];
  }
  double result(std::size_t design, std::size_t output) const {
    return result_.results[design * outputs() + output];
  }
  /// The designs of the lowest and of the highest value of an output; nothing where none has one.
  std::optional<std::pair<std::size_t, std::size_t>> ends(std::size_t output) const;
  /// "NAME is .. in every design: ..", or "" where the designs differ or fewer than two have it.
  std::string constant_text(std::size_t output) const;
  /// Why it is infeasible, or "".
  const std::string& reason(std::size_t design) const;
  /// Its number in the plan.
  std::size_t number(std::size_t design) const { return design * result_.every; }
  /// "pump.tilt_deg 40, piston.inertia real"
  std::string text(std::size_t design) const;

  /// No design beats these; rising.
  const std::vector<std::size_t>& front() const { return front_; }
  /// Directions of how many outputs were asked for.
  std::size_t sought() const;

  /// Axes of variable or output k, with the unit where the name does not say it.
  report::Axis axis(std::size_t k) const;
  report::Axis output_axis(std::size_t k) const;

  /// Whether all combinations of levels are there.
  bool whole_grid() const;
  const std::vector<double>& levels(std::size_t variable) const {
    return plan().varied[variable].levels;
  }
  /// Number of the design of these levels of a whole grid.
  std::size_t at(const std::vector<std::size_t>& level) const;
  /// Of every variable the level next to the case's own value.
  const std::vector<std::size_t>& home() const { return home_; }

 private:
  const SweepResult& result_;
  std::vector<std::string> reasons_;
  std::vector<std::size_t> front_, home_;
};

/// A value of a variable for people: to six digits, or its word.
std::string value_text(const Variable& variable, double value);

/// Evenly chosen numbers below `count`, at most `most`, with all of `also` (rising).
std::vector<std::size_t> thinned(std::size_t count, std::size_t most,
                                 const std::vector<std::size_t>& also = {});

/// Figures of a sweep's report.
std::vector<report::Figure> sweep_figures(const SweepView& view);

}  // namespace bentaxis::designs
