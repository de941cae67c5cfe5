#include "bentaxis/study/case_sections.h"

#include <cmath>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study {

report::CaseSection case_section(const Case& the_case) {
  return {the_case.file.filename().string(), the_case.entries};
}

std::vector<report::DerivedQuantity> derived_section(const Case& the_case) {
  const Geometry& g = the_case.pump.geometry;
  const Gear& gear = the_case.pump.gear;
  const analytic::DerivedQuantities derived = analytic::derived_quantities(g);
  const double pressure = the_case.pressure.ports.delivery - the_case.pressure.ports.suction;
  return {
      {"displacement", "V", derived.displacement * 1e6, "cm3/rev", "N A stroke"},
      {"stroke", "", derived.stroke * 1e3, "mm", "max zB - min zB over the turn"},
      {"piston area", "A", derived.piston_area * 1e6, "mm2", "pi Dpi^2 / 4"},
      {"smallest piston tilt", "", derived.smallest_tilt / kRadPerDegree, "deg", "AB against z2"},
      {"largest piston tilt", "", derived.largest_tilt / kRadPerDegree, "deg", "AB against z2"},
      {"ideal flow", "", derived.displacement * std::abs(the_case.operation.speed_rpm) * 1e3,
       "l/min", "V n"},
      {"ideal torque", "", derived.displacement * pressure / (2 * kPi), "Nm",
       "V (delivery - suction) / 2 pi"},
      {"gear torque arm", "(d/2) cos ap",
       gear.pitch_diameter / 2 * std::cos(gear.pressure_angle) * 1e3, "mm", "(19), (22)"},
      {"pitch cone", "delta", 90 - g.tilt / kRadPerDegree / 2, "deg", "90 deg - alpha/2"}};
}

}  // namespace bentaxis::study
