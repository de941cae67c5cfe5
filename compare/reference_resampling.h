// Curves of a reference at the angles at which they are compared.
#pragma once

#include <cstddef>
#include <vector>

#include "bentaxis/compare/reference.h"

namespace bentaxis::compare {

// Estimated error of the spline through all points, per interval between two of them: three times
// what the spline through every other point misses nearby. That is what a jump (the reversal of a
// friction force) may cost, where more points do not help: between two points the spline may miss
// by the whole jump, twice the miss half way; with a point on it by half the jump, 2.6 times the
// miss. A smooth curve is better than that, by up to 48 times. Which of them a curve is there
// cannot be told from its points alone: a steep flank beside the jump looks as smooth.
std::vector<double> resampling_errors(const std::vector<double>& theta,
                                      const std::vector<double>& values);
// The interval of rising angles that an angle of the turn lies in: its first point.
std::size_t interval_of(const std::vector<double>& theta, double angle);
// From each point to the next, the last of a turn to the first.
double step_after(const std::vector<double>& theta, std::size_t i);
void require_no_wide_gap(const ReferenceCurve& curve);
// Whether a curve has points at all of these angles.
bool covers(const ReferenceCurve& curve, const std::vector<double>& theta_deg);

// The reference at the angles of the result, with the band of the tube.
struct Resampled {
  ResultTable middle, low, high;
  ResultTable uncertainty;  // of the middle
  bool exact = true;
  double error = 0;
};
Resampled resample(const ReferenceDescription& description, const ReferenceCurve& curve,
                   const std::vector<double>& theta_deg);
// A curve as it stands.
Resampled at_own_angles(const ReferenceDescription& description, const ReferenceCurve& curve,
                        const ResultTable& result, const ResultAt& result_at);

}  // namespace bentaxis::compare
