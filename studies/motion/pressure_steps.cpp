#include "pressure_steps.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"
#include "bentaxis/results/channels.h"

namespace bentaxis::study {
namespace {

// Degrees from a step within which a model may take a block to be on either side of it: several
// times what the models and the trace take as on an edge, which grows with the number of turns.
constexpr double kOnStep = 4e-9;
constexpr double kManyTurns = 3600;  // deg

// Of the height of a step: pressures apart by less are one.
constexpr double kOnePressure = 1e-9;

}  // namespace

PressureSteps::PressureSteps(const PressureSpec& spec, const PumpParameters& pump) {
  if (spec.kind != PressureKind::ideal || spec.transition_deg != 0) return;
  const PressureTrace pressure(spec);
  constexpr double kBeside = 1e-6;  // deg
  for (const double angle : pressure.edges_deg())
    steps_.push_back({angle, pressure(angle - kBeside) / kPascalPerBar,
                      pressure(angle + kBeside) / kPascalPerBar});
  const ChannelLayout at(pump);
  for (int k = 0; k < at.pistons(); ++k) columns_.push_back(at.pressure(k));
}

bool PressureSteps::between(const Trajectory& first, const Trajectory& second, std::size_t row,
                            double angle_error) const {
  if (steps_.empty()) return false;
  const double blocks[] = {first.state(row, StateColumn::psi), second.state(row, StateColumn::psi)};
  const double on_step = kOnStep * std::max(1.0, std::abs(blocks[0]) / kManyTurns);
  const double near = angle_error / kRadPerDegree + on_step;
  const int pistons = static_cast<int>(columns_.size());
  bool found = false;
  for (int k = 0; k < pistons; ++k) {
    const std::size_t column = columns_[static_cast<std::size_t>(k)];
    const double pressures[] = {first.table.results.at(row, column),
                                second.table.results.at(row, column)};
    // Which side of a step a run stands on: -1 before it, 1 behind it, 0 neither.
    const auto side = [&](const Step& step, int run) {
      const double past =
          std::remainder(piston_angle_deg(blocks[run], k + 1, pistons) - step.angle_deg, 360.0);
      const auto has = [&](double pressure) {
        return std::abs(pressures[run] - pressure) <=
               kOnePressure * std::abs(step.after - step.before);
      };
      if (std::abs(past) > near) return 0;
      return has(step.before) && past <= on_step ? -1 : has(step.after) && past >= -on_step ? 1 : 0;
    };
    if (pressures[0] == pressures[1]) continue;
    if (std::none_of(steps_.begin(), steps_.end(),
                     [&](const Step& step) { return side(step, 0) * side(step, 1) < 0; }))
      return false;
    found = true;
  }
  return found;
}

}  // namespace bentaxis::study
