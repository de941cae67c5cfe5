#include "port.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/pump/units.h"

namespace bentaxis::hydraulics {
namespace {

double wrap_degrees(double angle) {
  const double wrapped = angle - 360.0 * std::floor(angle / 360.0);
  return wrapped >= 360.0 ? 0.0 : wrapped;
}

}  // namespace

PortOpening::PortOpening(const HydraulicData& data, const PlatePort& port,
                         double bore_circle_radius)
    : from_(port.arc.from_deg),
      to_(port.arc.to_deg),
      half_width_(data.kidney_width_deg / 2),
      rounding_(data.kidney_rounding_deg),
      area_per_degree_(radians(1) * bore_circle_radius * data.kidney_height),
      notch_length_(port.notch.length_deg),
      notch_area_(port.notch.length_deg > 0 ? port.notch.area : 0),
      quadratic_(data.notch_law == NotchLaw::quadratic) {
  for (const double at : {from_ - half_width_, from_ - half_width_ + rounding_, from_ + half_width_,
                          to_ - half_width_, to_ + half_width_ - rounding_, to_ + half_width_})
    edges_deg_.push_back(wrap_degrees(at));
  if (notch_area_ > 0)
    for (const double at :
         {from_ - notch_length_ - half_width_, from_ - notch_length_ + half_width_})
      edges_deg_.push_back(wrap_degrees(at));
  std::sort(edges_deg_.begin(), edges_deg_.end());
}

double PortOpening::passed(double length_deg) const {
  const double share = std::clamp(length_deg / notch_length_, 0.0, 1.0);
  return quadratic_ ? share * share : share;
}

double PortOpening::area(double theta_deg) const {
  // Angle of the kidney's leading edge past the start of notch and port; the kidney with the port
  // is shorter than a turn, so that one branch is enough.
  const double first = from_ - notch_length_;
  const double past = wrap_degrees(theta_deg + half_width_ - first) + first;
  const double trailing = past - 2 * half_width_;
  const double overlap = std::min(past, to_) - std::max(trailing, from_);
  double area = 0;
  if (overlap > 0)
    area = area_per_degree_ *
           (overlap < rounding_ ? overlap * overlap / (2 * rounding_) : overlap - rounding_ / 2);
  if (notch_area_ > 0) area += notch_area_ * (passed(past - first) - passed(trailing - first));
  return area;
}

}  // namespace bentaxis::hydraulics
