// Operating points of a pump with a hydraulic model: pressures, flows and the torque they need, at
// one delivery pressure and over many.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// @throws InputError where the pressure of a case is not of kind "hydraulic"
void require_hydraulic(const Case& the_case);

/// @throws InputError where a load says which delivery pressure it is
void require_pressure_asked_for(const Case& the_case);

/// One operating point: its periodic hydraulic state, and a turn by both models as the case
/// assumes.
struct OperatingPoint {
  PreparedCase ready;
  ResultTable analytic, multibody;

  const Case& the_case() const { return ready.the_case; }
  const hydraulics::SteadyState& state() const { return *ready.hydraulics; }
};
/// @throws InputError, ComputationError
OperatingPoint run_point(Case the_case, const PartProgress& progress_of = silent());

/// The mean of a channel over all rows, channel's unit.
double mean(const ResultTable& table, const std::string& channel);

/// Mean torque (Nm), flow to the load (l/min) and volumetric efficiency (%, mass-based) at mean
/// delivery pressures (bar). `ideal` is displacement x pressure difference / 2 pi. `flow` is at the
/// density in the suction port, `flow_at_delivery` at that of the mean delivery pressure.
struct TorqueCurve {
  std::vector<double> bar, analytic, multibody, ideal, flow, efficiency, flow_at_delivery;
  /// Pressures that could not be computed: they are not in the vectors above.
  std::vector<FailedPoint> failed;
};
/// Points are independent and are computed by as many threads as there are processors, 8 at most.
/// A point whose computation fails is left out and named; the others are kept.
/// @throws InputError; ComputationError where every point fails
TorqueCurve torque_curve(const Case& the_case, const std::vector<double>& delivery_bar,
                         const Progress& progress = {});
/// The curve as a CSV file with a header line, in rising order of the pressure. The row of a point
/// that failed has empty fields and the reason in its last column.
std::string to_csv(const TorqueCurve& curve);
/// The curve as a table for people, six digits.
std::string torque_curve_text(const TorqueCurve& curve);

/// The mean delivery pressure (Pa) at which a statistic of the analytic model's turn reaches
/// `wanted`, which rises with the pressure about in proportion.
/// @param name  of the statistic, for messages
/// @throws ComputationError where no pressure is found
double delivery_pressure_for(const OperatingPoint& start, const std::string& name, double wanted,
                             const std::function<double(const ResultTable&)>& statistic,
                             const PartProgress& progress_of = silent());

}  // namespace bentaxis::study
