// What every peer is given: the default pump at rated pressure, lumped pistons, constant and equal
// speeds of shaft and block; and how its joint forces are judged.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <vector>

#include "bentaxis/analytic/model.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/stopwatch.h"
#include "kinematics.h"

namespace bentaxis::peers {

using Vector = Eigen::Vector3d;

class PumpCase {
 public:
  static constexpr int kSamples = 36;  // per turn, as in `bentaxis tradeoff`

  PumpCase()
      : the_case(read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml")),
        omega(rad_per_second(the_case.operation.speed_rpm)),
        trace(the_case.pressure),
        model(the_case.pump, the_case.analytic),
        kinematics(the_case.pump.geometry) {}

  int pistons() const { return the_case.pump.geometry.pistons; }
  double area() const {
    const double d = the_case.pump.geometry.bore_diameter;
    return kPi / 4 * d * d;
  }
  /// Angle of piston k (from 0), rad.
  double angle(double theta, int k) const { return theta - 2 * kPi * k / pistons(); }
  analytic::PistonKinematics piston(double theta, int k) const {
    return kinematics.piston(std::sin(angle(theta, k)), std::cos(angle(theta, k)));
  }
  /// Pressure and friction on piston k along z2 at B, N.
  double axial(double theta, int k, double velocity) const {
    const double pressure = trace(piston_angle_deg(theta / kRadPerDegree, k + 1, pistons()));
    const Friction& f = the_case.pump.friction;
    const double sign = f.regularization > 0 ? std::tanh(velocity / f.regularization)
                                             : static_cast<double>((velocity > 0) - (velocity < 0));
    return -(f.piston_coulomb * sign + f.piston_viscous * velocity) - area() * pressure;
  }
  /// Largest |Rs - right Rs| at a sample so far, and the peak of the right one.
  void judge(int sample, int k, const Vector& rs) {
    Instant instant;
    instant.turn(2 * kPi * sample / kSamples, omega);
    instant.ports = the_case.pressure.ports;
    for (int i = 1; i <= pistons(); ++i)
      instant.chamber_pressure.push_back(
          trace(piston_angle_deg(360.0 * sample / kSamples, i, pistons())));
    std::vector<double> values(model.layout().size());
    model.reactions(instant, values);
    const auto& at = model.layout();
    const Vector right(values[at.Rs(k, 0)], values[at.Rs(k, 1)], values[at.Rs(k, 2)]);
    worst_ = std::max(worst_, (rs - right).cwiseAbs().maxCoeff());
    peak_ = std::max(peak_, right.norm());
  }
  double error() const { return worst_ / peak_; }
  void forget() { worst_ = peak_ = 0; }

  Case the_case;
  double omega;
  PressureTrace trace;
  analytic::Model model;
  analytic::Kinematics kinematics;

 private:
  double worst_ = 0, peak_ = 0;
};

/// Steps per turn of integrated runs: multiples of 180, so that every pressure edge ends a step.
inline constexpr int kStepsPerTurn[] = {180, 360, 720, 1440, 2880, 5760};

/// What an engine's free setting achieves: the shortest of three runs at the value with the
/// smallest error.
struct Tuned {
  double setting = 0, seconds = 0, error = 1e300;
};
/// @param run  runs a turn with a setting and returns its time; the pump case has its error then
template <class Run>
Tuned tuned(const PumpCase& pump, std::initializer_list<double> settings, const Run& run) {
  Tuned best;
  for (const double setting : settings) {
    double seconds = 1e300;
    for (int repeat = 0; repeat < 3; ++repeat) seconds = std::min(seconds, run(setting));
    if (pump.error() < best.error) best = {setting, seconds, pump.error()};
  }
  return best;
}

/// Collects the rows that scripts/write_performance_page reads.
class Rows {
 public:
  void add(const std::string& engine, const std::string& way, const std::string& settings,
           double seconds_per_turn, double error, int angles) {
    if (!text_.empty()) text_ += ",\n";
    char line[512];
    std::snprintf(line, sizeof line,
                  R"({"engine": "%s", "way": "%s", "settings": "%s", "seconds_per_turn": %.6g, )"
                  R"("error_Rs": %.3g, "angles": %d})",
                  engine.c_str(), way.c_str(), settings.c_str(), seconds_per_turn, error, angles);
    text_ += line;
  }
  void print() const { std::printf("[%s]\n", text_.c_str()); }

 private:
  std::string text_;
};

}  // namespace bentaxis::peers
