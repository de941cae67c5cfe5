// Chamber pressure as a function of the chamber's angle: the load both models are given.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/periodic_cubic.h"
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
  hydraulic,  ///< computed by a hydraulic model
};

/// A periodic pressure curve: angles in degrees (strictly increasing, spanning less than 360, end
/// point not repeated) and gauge pressures in Pa.
struct PressureCurve {
  std::vector<double> theta_deg;
  std::vector<double> pressure;
};

/// A chamber's pressure over its own angle, computed with an error that is known. It is kept as
/// ln(P/P0), so that nothing between its points is below absolute zero.
struct ComputedPressure {
  PeriodicCubic log_pressure;
  double atmosphere = 0;          ///< P0, Pa absolute
  std::vector<double> edges_deg;  ///< where its slope changes fast: the edges of the ports
  double peak = 0;                ///< Pa gauge, largest magnitude
  double error = 0;               ///< Pa, estimate of the largest

  double gauge(double theta_k_deg) const;  ///< Pa
};

/// What the case file says about pressure.
struct PressureSpec {
  PressureKind kind = PressureKind::ideal;
  PortPressures ports;
  double transition_deg = 0;        ///< w, width of each rise and fall
  double delivery_start_deg = 180;  ///< middle of the rise
  std::filesystem::path file;       ///< of a curve
  /// Of kind hydraulic: points per turn of a spline that stands for the computed curve, as the
  /// paper gave it to ADAMS; 0: the computed curve itself.
  int points = 0;
  PressureCurve curve;  ///< of a file; of kind hydraulic with `points`, once it has been computed
  std::shared_ptr<const ComputedPressure> computed;  ///< of kind hydraulic, once it has been
};

/// Pressure over a turn. Works in degrees, where edges are exact.
class PressureTrace {
 public:
  /// @throws InputError if a curve has fewer than 3 points (or was not computed yet), or its angles
  /// are not as required.
  explicit PressureTrace(const PressureSpec& spec);

  /// Gauge pressure, Pa, in a chamber at angle theta_k (any real number of degrees).
  double operator()(double theta_k_deg) const;
  /// Of an ideal trace: share of the way from suction to delivery pressure there.
  std::optional<double> ideal_share(double theta_k_deg) const;

  /// Chamber angles in [0, 360) where the pressure or its derivative jumps, in increasing order.
  const std::vector<double>& edges_deg() const { return edges_deg_; }

 private:
  double share_of_delivery(double theta_k_deg) const;

  PressureKind kind_;
  PortPressures ports_;
  double transition_deg_, delivery_start_deg_;
  std::unique_ptr<PeriodicSpline> spline_;
  std::shared_ptr<const ComputedPressure> computed_;
  std::vector<double> edges_deg_;
};

/// Block angles in [0, 360), rising, at which any of the chambers passes an edge of the trace.
std::vector<double> block_edges_deg(const PressureTrace& pressure, int pistons);

/// Angle of piston k (from 1) when the shaft stands at theta: theta - 360 (k-1)/N, degrees.
inline double piston_angle_deg(double theta_deg, int piston, int pistons) {
  return theta_deg - 360.0 * (piston - 1) / pistons;
}

}  // namespace bentaxis
