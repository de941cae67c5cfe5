// Chamber pressure as a function of the chamber's angle: the load both models are given.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bentaxis/pump/periodic_spline.h"

namespace bentaxis {

/// Pressures of the two ports, Pa gauge.
struct PortPressures {
  double suction = 0;
  double delivery = 0;
};

enum class PressureKind {
  ideal,      ///< smoothed steps between the port pressures
  curve,      ///< periodic cubic spline through the points of a file
  hydraulic,  ///< the same through points that a hydraulic model has computed
};

/// A periodic pressure curve: angles in degrees (strictly increasing, spanning less than 360, end
/// point not repeated) and gauge pressures in Pa.
struct PressureCurve {
  std::vector<double> theta_deg;
  std::vector<double> pressure;
};

/// What the case file says about pressure.
struct PressureSpec {
  PressureKind kind = PressureKind::ideal;
  PortPressures ports;
  double transition_deg = 0;        ///< w, width of each rise and fall
  double delivery_start_deg = 180;  ///< middle of the rise
  std::filesystem::path file;       ///< of a curve
  int points = 800;                 ///< of a computed curve, per turn
  PressureCurve curve;              ///< of kind hydraulic: empty until it has been computed
};

/// Pressure over a turn. Works in degrees, where edges are exact.
class PressureTrace {
 public:
  /// @throws InputError if a curve has fewer than 3 points (or was not computed yet), or its angles
  /// are not as required.
  explicit PressureTrace(const PressureSpec& spec);

  /// Gauge pressure, Pa, in a chamber at angle theta_k (any real number of degrees).
  double operator()(double theta_k_deg) const;

  /// Chamber angles in [0, 360) where the pressure or its derivative jumps, in increasing order.
  const std::vector<double>& edges_deg() const { return edges_deg_; }

 private:
  double ideal(double theta_k_deg) const;

  PressureKind kind_;
  PortPressures ports_;
  double transition_deg_, delivery_start_deg_;
  std::unique_ptr<PeriodicSpline> spline_;
  std::vector<double> edges_deg_;
};

/// Angle of piston k (from 1) when the shaft stands at theta: theta - 360 (k-1)/N, degrees.
inline double piston_angle_deg(double theta_deg, int piston, int pistons) {
  return theta_deg - 360.0 * (piston - 1) / pistons;
}

}  // namespace bentaxis
