#include "sweep_view.h"

#include <iterator>

#include "bentaxis/designs/pareto.h"
#include "document_parts.h"

namespace bentaxis::designs {
namespace {

// Where the name says its unit, that is enough: tilt_deg, delivery_arc_deg.1, ripple_percent.
report::Axis axis_of(const std::string& name, const std::string& unit, bool log) {
  const bool said = name.ends_with("_" + unit) ||
                    name.find("_" + unit + ".") != std::string::npos ||
                    (unit.starts_with('%') && name.ends_with("_percent"));
  return {name, said ? "" : unit, log};
}

bool positive(double v) { return v > 0 && std::isfinite(v); }

// Steps are ratios rather than differences.
bool geometric(const std::vector<double>& levels) {
  if (levels.size() < 3 || !std::ranges::all_of(levels, positive)) return false;
  const double ratio = levels[1] / levels[0];
  for (std::size_t i = 1; i + 1 < levels.size(); ++i)
    if (std::abs(levels[i + 1] / levels[i] / ratio - 1) > 1e-6) return false;
  return std::abs(ratio - 1) > 1e-3;
}

}  // namespace

SweepView::SweepView(const SweepResult& result) : result_(result), reasons_(result.designs) {
  for (const auto& [design, reason] : result.infeasible) reasons_.at(design) = reason;
  if (!plan().direction.empty()) front_ = pareto_front(result.results, plan().direction);
  for (const Varied& varied : plan().varied) {
    const double own = varied.variable.value(result.base);
    const auto nearest = std::ranges::min_element(
        varied.levels, [&](double a, double b) { return std::abs(a - own) < std::abs(b - own); });
    home_.push_back(static_cast<std::size_t>(nearest - varied.levels.begin()));
  }
}

std::optional<std::pair<std::size_t, std::size_t>> SweepView::ends(std::size_t output) const {
  std::optional<std::pair<std::size_t, std::size_t>> ends;
  for (std::size_t d = 0; d < designs(); ++d) {
    const double value = result(d, output);
    if (!is_computed(value)) continue;
    if (!ends) ends = {d, d};
    if (value < result(ends->first, output)) ends->first = d;
    if (value > result(ends->second, output)) ends->second = d;
  }
  return ends;
}

std::string SweepView::constant_text(std::size_t output) const {
  const auto ends = this->ends(output);
  if (!ends || result(ends->first, output) != result(ends->second, output)) return "";
  std::size_t count = 0;
  for (std::size_t d = 0; d < designs(); ++d) count += is_computed(result(d, output)) ? 1 : 0;
  if (count < 2) return "";
  const Output& meant = plan().outputs[output];
  return fmt::format("{} is {:.5g}{} in every design: nothing that varies changes it.", meant.name,
                     result(ends->first, output), unit_after(meant.unit));
}

const std::string& SweepView::reason(std::size_t design) const { return reasons_[design]; }

std::string SweepView::text(std::size_t design) const {
  std::size_t k = 0;
  return joined(plan().varied, ", ", [&](const Varied& varied) {
    return varied.variable.name() + " " + value_text(varied.variable, value(design, k++));
  });
}

std::size_t SweepView::sought() const {
  return report::count_of(plan().direction, [](int direction) { return direction != 0; });
}

report::Axis SweepView::axis(std::size_t k) const {
  return axis_of(variable(k).name(), variable(k).unit(), geometric(levels(k)));
}

report::Axis SweepView::output_axis(std::size_t k) const {
  constexpr double kManyTimes = 300;  // what spans more is seen by its logarithm
  const auto ends = this->ends(k);
  const bool log = ends && positive(result(ends->first, k)) &&
                   std::isfinite(result(ends->second, k)) &&
                   result(ends->second, k) > kManyTimes * result(ends->first, k);
  return axis_of(output(k).name, output(k).unit, log);
}

bool SweepView::whole_grid() const {
  return plan().sampling == Sampling::grid && result_.every == 1 && designs() == plan().size();
}

std::size_t SweepView::at(const std::vector<std::size_t>& level) const {
  std::size_t design = 0;
  for (std::size_t k = 0; k < variables(); ++k) design = design * levels(k).size() + level[k];
  return design;
}

std::string value_text(const Variable& variable, double value) {
  return variable.words().empty() ? fmt::format("{:.6g}", value) : variable.text(value);
}

std::vector<std::size_t> thinned(std::size_t count, std::size_t most,
                                 const std::vector<std::size_t>& also) {
  std::vector<std::size_t> even, chosen;
  const std::size_t every = std::max<std::size_t>(1, (count + most - 1) / most);
  for (std::size_t i = 0; i < count; i += every) even.push_back(i);
  std::set_union(even.begin(), even.end(), also.begin(), also.end(), std::back_inserter(chosen));
  return chosen;
}

}  // namespace bentaxis::designs
