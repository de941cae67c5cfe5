#include "bentaxis/results/samples.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {

void Samples::instant(std::size_t row, Instant& instant) const {
  if (row >= theta_deg.size() || (row + 1) * pistons > chamber_pressure.size())
    throw InputError("samples: row " + std::to_string(row + 1) + " of " +
                     std::to_string(theta_deg.size()) + " angles and " +
                     std::to_string(chamber_pressure.size()) + " chamber pressures of " +
                     std::to_string(pistons) + " pistons");
  instant.turn(radians(std::fmod(theta_deg[row], 360.0)), omega);
  instant.ports = ports;
  const auto first = chamber_pressure.begin() + static_cast<std::ptrdiff_t>(row) * pistons;
  instant.chamber_pressure.assign(first, first + pistons);
}

Samples Samples::part(std::size_t first, std::size_t count) const {
  const std::size_t begin = std::min(first, theta_deg.size());
  const std::size_t end = begin + std::min(count, theta_deg.size() - begin);
  const auto rows = [](const std::vector<double>& all, std::size_t from, std::size_t to) {
    return std::vector<double>(all.begin() + static_cast<std::ptrdiff_t>(from),
                               all.begin() + static_cast<std::ptrdiff_t>(to));
  };
  const auto n = static_cast<std::size_t>(pistons);
  return {rows(theta_deg, begin, end), rows(chamber_pressure, begin * n, end * n), ports, omega,
          pistons};
}

void require_constant_speed(const Case& the_case) {
  const TransferKind kind = the_case.pump.transfer.kind;
  const auto refuse = [&](const std::string& value, const std::string& why,
                          const std::string& instead = "") {
    throw InputError((the_case.file.empty() ? "" : the_case.file.string() + ": ") + "[pressure] " +
                     value + ": must be " + why + " beside [transfer] kind = \"" + to_string(kind) +
                     "\" at constant speed" + instead);
  };
  const bool pistons = kind == TransferKind::pistons;
  if (!the_case.pump.transfer.is_even() && the_case.pressure.kind == PressureKind::hydraulic)
    refuse("kind = \"hydraulic\"", "\"ideal\" or \"curve\"",
           "; bentaxis simulate follows the oil in time");
  if (pistons && the_case.pressure.kind == PressureKind::ideal &&
      the_case.pressure.transition_deg == 0)
    refuse("transition_deg = 0", "> 0");
}

Samples sample_case(const Case& the_case, const PressureTrace& pressure, int revolutions,
                    bool falling, const SampleRange& range) {
  const int per_turn = the_case.operation.samples_per_revolution;
  const long long rows = static_cast<long long>(per_turn) * revolutions;
  const long long end = range.count < 0 ? rows : std::min(rows, range.first + range.count);
  std::vector<double> theta_deg;
  theta_deg.reserve(static_cast<std::size_t>(std::max(0LL, end - range.first)));
  for (long long row = range.first; row < end; ++row) {
    const double theta = (falling ? -360.0 : 360.0) * static_cast<double>(row) / per_turn;
    theta_deg.push_back(theta == 0 ? 0 : theta);  // no -0
  }
  return sample_angles(the_case, pressure, std::move(theta_deg));
}

Samples sample_angles(const Case& the_case, const PressureTrace& pressure,
                      std::vector<double> theta_deg) {
  require_constant_speed(the_case);
  Samples samples;
  samples.theta_deg = std::move(theta_deg);
  samples.pistons = the_case.pump.geometry.pistons;
  samples.omega = rad_per_second(the_case.operation.speed_rpm);
  samples.ports = the_case.pressure.ports;
  samples.chamber_pressure.reserve(samples.theta_deg.size() *
                                   static_cast<std::size_t>(samples.pistons));
  for (const double theta : samples.theta_deg)
    for (int k = 1; k <= samples.pistons; ++k)
      samples.chamber_pressure.push_back(pressure(piston_angle_deg(theta, k, samples.pistons)));
  return samples;
}

}  // namespace bentaxis
