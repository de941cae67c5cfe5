#include "bentaxis/study/state_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "bentaxis/pump/units.h"

namespace bentaxis::study {
namespace {

constexpr double kAtmosphere = 101325;  // Pa, where the case has none of its own
// No backlash is that wide: half a pitch of eighteen teeth.
constexpr double kTeethApartDeg = 10;
// A way that is off by this share and by this angle is no rounding of a rig's record.
constexpr double kWayShare = 0.2, kWayDeg = 1;

// Warns of the first state for which `text` is not empty.
void add(std::vector<Warning>& warnings, const States& states, const std::string& name,
         const std::function<std::string(std::size_t)>& text) {
  std::string first;
  std::size_t count = 0;
  for (std::size_t row = 0; row < states.rows(); ++row) {
    const std::string here = text(row);
    if (here.empty()) continue;
    if (count++ == 0) first = fmt::format("state {}: {}", row + 1, here);
  }
  if (count == 0) return;
  warnings.push_back(
      {name, count == 1 ? first : fmt::format("{}; {} states in all", first, count)});
}

// Rows without times whose angle goes one way from the first to the last while all speeds point the
// other way: the file is in reverse order, or the sign of a speed is wrong.
std::string against_its_speed(const States& states) {
  if (!states.time.empty() || states.rows() < 3) return "";
  const double way = states.motion.back().theta_deg - states.motion.front().theta_deg;
  for (std::size_t row = 0; row < states.rows(); ++row) {
    if (!(states.motion[row].shaft_speed * way < 0)) return "";
    if (row > 0 && !((states.motion[row].theta_deg - states.motion[row - 1].theta_deg) * way > 0))
      return "";
  }
  return fmt::format(
      "theta_deg {} from {:g} to {:g} over the rows, but theta_rpm is {} in all of them: the rows "
      "are in reverse order, or the speed has the wrong sign. Each state is computed as it stands",
      way > 0 ? "rises" : "falls", states.motion.front().theta_deg, states.motion.back().theta_deg,
      way > 0 ? "negative" : "positive");
}

}  // namespace

std::vector<Warning> state_doubts(const Case& the_case, const States& states) {
  std::vector<Warning> warnings;
  const double atmosphere = the_case.hydraulics ? the_case.hydraulics->atmosphere : kAtmosphere;
  add(warnings, states, "states-vacuum", [&](std::size_t row) -> std::string {
    const MotionState& state = states.motion[row];
    const auto first =
        states.chamber_pressure.begin() + static_cast<std::ptrdiff_t>(row) * states.pistons;
    const double least = std::min({state.ports.suction, state.ports.delivery,
                                   *std::min_element(first, first + states.pistons)});
    if (least >= -atmosphere) return "";
    return fmt::format("{:.4g} bar is below absolute zero, {:.5g} bar gauge", least / pascals(1),
                       -atmosphere / pascals(1));
  });
  add(warnings, states, "states-teeth-apart", [&](std::size_t row) -> std::string {
    const double lag = states.motion[row].theta_deg - states.motion[row].psi_deg;
    if (std::abs(lag) <= kTeethApartDeg) return "";
    return fmt::format("theta - psi = {:.4g} deg: gear teeth cannot be that far out of phase", lag);
  });
  if (const std::string against = against_its_speed(states); !against.empty())
    warnings.push_back({"states-against-speed", against});
  if (!states.time.empty())
    add(warnings, states, "states-against-time", [&](std::size_t row) -> std::string {
      if (row == 0) return "";
      const MotionState& before = states.motion[row - 1];
      const MotionState& now = states.motion[row];
      const double seconds = states.time[row] - states.time[row - 1];
      const auto off = [&](double from, double to, double speed_from, double speed_to) {
        const double said = (speed_from + speed_to) / 2 * seconds / kRadPerDegree;
        return std::abs(to - from - said) >
               kWayDeg + kWayShare * std::max(std::abs(to - from), std::abs(said));
      };
      const bool shaft = off(before.theta_deg, now.theta_deg, before.shaft_speed, now.shaft_speed);
      if (!shaft && !off(before.psi_deg, now.psi_deg, before.block_speed, now.block_speed))
        return "";
      return fmt::format(
          "the change of {1} since the previous state, {0:.4g} s ago, contradicts {2}", seconds,
          shaft ? "theta_deg" : "psi_deg", shaft ? "theta_rpm" : "psi_rpm");
    });
  return warnings;
}

}  // namespace bentaxis::study
