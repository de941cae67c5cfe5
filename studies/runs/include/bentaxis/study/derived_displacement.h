// Displacement as test rigs derive it, from flows over speeds and pressures, beside the geometric
// displacement that the model knows.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// A steady operating point as a rig records it. A motor's flow and speed are positive as well.
struct FlowPoint {
  double speed = 0;       ///< rev/s, above 0
  double delivery = 0;    ///< Pa gauge, mean delivery pressure that was asked for
  double difference = 0;  ///< Pa, mean delivery pressure that was reached less suction pressure
  double flow = 0;        ///< m3/s
};

/// Speed (rpm) and delivery pressure (bar) of a point as they were asked for: without the round-off
/// of the conversion to SI.
double speed_rpm(const FlowPoint& point);
double delivery_bar(const FlowPoint& point);

/// A way to derive the displacement. Each is a least-squares fit of the flow q at speeds n and
/// pressure differences p:
///   iso_8426            q/n at p = 0, by a line over p, at one speed: the highest
///   toet                slope of q over n at each pressure, then its value at p = 0 by a line over
///                       p (two steps); a loss that does not depend on the speed drops out
///   wilson              V of q = V n - k p, all points at once: laminar slip
///   zero_pressure_line  q at p = 0 by a line over p at each speed, then V of q = V n
/// Sources: docs/hydraulics.md, "Derived displacement".
enum class DisplacementMethod { iso_8426, toet, wilson, zero_pressure_line };
inline constexpr DisplacementMethod kDisplacementMethods[] = {
    DisplacementMethod::iso_8426, DisplacementMethod::toet, DisplacementMethod::wilson,
    DisplacementMethod::zero_pressure_line};
const char* name_of(DisplacementMethod method);

/// @return m3 per revolution
/// @throws ComputationError where the points do not determine it: each method needs two pressures
///   at a speed, toet two such speeds besides
double derived_displacement(DisplacementMethod method, const std::vector<FlowPoint>& points);

/// q / (n volume); of a motor the inverse, not_computed() where no oil flows in.
double volumetric_efficiency(double volume, const FlowPoint& point, bool motor);

/// What a method makes of one pump.
struct DerivedDisplacement {
  DisplacementMethod method = DisplacementMethod::iso_8426;
  double volume = 0;   ///< m3 per revolution; not_computed() where the points do not determine it
  std::string reason;  ///< why they do not, or ""
  double bias = 0;     ///< (volume - geometric) / geometric
  /// Volumetric efficiency of each point by this displacement.
  std::vector<double> efficiency;
  std::size_t highest = 0;    ///< the point where it is highest
  std::size_t above_one = 0;  ///< points where it exceeds 1 by more than kFlowRounding
};

/// Relative error of a computed flow that counts as no excess.
inline constexpr double kFlowRounding = 1e-6;

/// What the flow meter reads: volume flow at the density of the delivery pressure (ISO 4409 refers
/// a pump's outlet and a motor's inlet flow to it) or at that of the suction port, as a meter in
/// the low-pressure line does.
struct MeteredDisplacement {
  std::string meter;              ///< "at delivery pressure"
  std::vector<FlowPoint> points;  ///< in order of the speeds, then of the pressures
  std::vector<DerivedDisplacement> derived;
  /// ISO 8426 at every speed at which it can be derived: rev/s, m3 per revolution.
  std::vector<std::pair<double, double>> iso_by_speed;

  const DerivedDisplacement& by(DisplacementMethod method) const {
    return derived.at(static_cast<std::size_t>(method));
  }
};

struct DisplacementStudy {
  double geometric = 0;  ///< m3 per revolution, N A stroke
  bool motor = false;
  std::size_t asked = 0;                    ///< number of points asked for
  std::vector<MeteredDisplacement> meters;  ///< at delivery pressure, at suction pressure
  std::vector<FailedPoint> failed;  ///< points that could not be computed, left out of the fits
};

/// Speeds (rpm) and delivery pressures (bar) of a usual test: a fifth to the whole of the case's
/// speed in five steps, 5 to 100 % of its pressure difference in six.
std::vector<double> usual_test_speeds(const Case& the_case);
std::vector<double> usual_test_pressures(const Case& the_case);

/// Runs the pump of a hydraulic case over all speeds and pressures, one steady state each, and
/// derives its displacement from the flows. Points run in parallel.
/// @param speeds_rpm    above 0; of a case that turns backwards, a motor, their sign is changed
/// @param delivery_bar  mean delivery pressures, gauge; two at least
/// @throws InputError; ComputationError where too few points could be computed for every method
DisplacementStudy displacement_study(const Case& the_case, const std::vector<double>& speeds_rpm,
                                     const std::vector<double>& delivery_bar,
                                     const Progress& progress = {});

/// One row per point: its flows, and its efficiency by every method at delivery pressure. The row
/// of a point that failed has empty fields and the reason in its last column.
std::string to_csv(const DisplacementStudy& study);

}  // namespace bentaxis::study
