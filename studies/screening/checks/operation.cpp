// Speed, gravity, angles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "bentaxis/pump/counted.h"
#include "checks/check.h"

namespace bentaxis::study::checks {
namespace {

constexpr double kFastest = 10;    // m/s, mean piston speed; bent-axis pumps reach 5..7
constexpr double kSlowest = 0.05;  // m/s

// The sums over N pistons repeat after the N-th of a turn: angles that fall on the same places of
// it again and again say less than they seem to.
std::string repeated_samples(const Facts& f) {
  constexpr int kLeastPositions = 6;
  const int samples = f.the_case.operation.samples_per_revolution, pistons = f.g.pistons;
  const int positions = samples / std::gcd(samples, pistons);
  if (samples < kLeastPositions || positions >= kLeastPositions) return "";
  int better = samples;
  while (std::gcd(better, pistons) != 1) ++better;
  return fmt::format(
      "samples_per_revolution = {} shows the {} pistons in {} only: drive torque, bearing forces "
      "and other sums over the pistons repeat {} times in a turn; {} angles would show {}",
      samples, pistons, counted(positions, "position"), pistons, better, better);
}

}  // namespace

std::vector<Check> operation() {
  return {
      {"speed-in-rad-per-s",
       "a speed that is no multiple of 10 rpm, below 628, and read as rad/s within 0.1 % of a "
       "multiple of 50 rpm",
       [](const Facts& f) -> std::string {
         const double rpm = f.speed / kRadPerSecondPerRpm;
         const double nearest = 50 * std::round(rpm / 50);
         if (rpm < 300 || rpm > 6000 || std::fmod(f.speed, 10) == 0) return "";
         if (std::abs(rpm - nearest) > 1e-3 * nearest) return "";
         return fmt::format("speed_rpm = {:.6g}: in rad/s it would be {:.6g} rpm",
                            f.the_case.operation.speed_rpm, rpm);
       }},
      {"piston-speed", "mean piston speed, two strokes per turn, above 10 m/s",
       [](const Facts& f) { return f.piston_speed > kFastest; },
       [](const Facts& f) {
         return fmt::format(
             "the pistons move at {:.4g} m/s on average at speed_rpm = {:.6g} (stroke {:.4g} mm): "
             "pumps reach 5 to 7 m/s",
             f.piston_speed, f.the_case.operation.speed_rpm, mm(f.derived.stroke));
       }},
      {"speed-low", "a speed, not 0, at which the pistons of the full stroke move below 0.05 m/s",
       [](const Facts& f) { return f.speed != 0; },
       [](const Facts& f) -> std::string {
         const double v = f.speed / 60 * 2 * std::max(f.derived.stroke, f.g.joint_circle_radius);
         if (v >= kSlowest) return "";
         return fmt::format(
             "speed_rpm = {:.6g} moves the pistons at {:.3g} m/s on average; in revolutions per "
             "second it would be {:.6g} rpm",
             f.the_case.operation.speed_rpm, v, 60 * f.the_case.operation.speed_rpm);
       }},
      {"gravity", "gravity that is not 0 and outside {0:g} .. {1:g} m/s2 (it acts along -y1)",
       "operation", "gravity_m_per_s2", [](const Facts& f) { return f.pump.gravity != 0; }},
      {"samples",
       "fewer than 6 or more than 1e6 angles in a turn, or more than 1e4 revolutions, or angles at "
       "which the N pistons stand in fewer than 6 different positions",
       [](const Facts& f) {
         return first_of({implausible(f, "operation", "samples_per_revolution"),
                          implausible(f, "operation", "revolutions"), repeated_samples(f)});
       }},
  };
}

}  // namespace bentaxis::study::checks
