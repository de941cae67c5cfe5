// How far a block kidney is open to a port of the plate.
#pragma once

#include <vector>

#include "bentaxis/pump/hydraulic_data.h"

namespace bentaxis::hydraulics {

/// Opening between the kidney of a chamber and one port, over the chamber's own angle. The kidney
/// is centred on the bore axis, so its edges stand at theta -+ width/2. Two parts:
///
/// - the overlap of kidney and port arc, as a length on the bore circle, x kidney height. Over the
///   first `kidney_rounding_deg` it grows as the square, like that of rounded ends;
/// - the notch: root area x (passed length / notch length)^m, m = 1 or 2, from where the kidney's
///   leading edge meets it to where the trailing edge has passed it.
class PortOpening {
 public:
  PortOpening(const HydraulicData& data, const PlatePort& port, double bore_circle_radius);

  /// Area, m2, at the chamber's angle, degrees (any real number). Continuous.
  double area(double theta_deg) const;

  /// Chamber angles in [0, 360) where the slope of the area jumps, or nearly so, in rising order.
  const std::vector<double>& edges_deg() const { return edges_deg_; }

 private:
  double passed(double length_deg) const;

  double from_, to_, half_width_, rounding_;
  double area_per_degree_;
  double notch_length_, notch_area_;
  bool quadratic_;
  std::vector<double> edges_deg_;
};

}  // namespace bentaxis::hydraulics
