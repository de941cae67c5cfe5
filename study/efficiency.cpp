#include "bentaxis/study/efficiency.h"

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study {

double pressure_difference(const ReadyCase& ready) {
  const PortPressures& ports = ready.the_case.pressure.ports;
  const double delivery =
      ready.hydraulics ? ready.hydraulics->summary.delivery_mean : ports.delivery;
  return delivery - ports.suction;
}

double ideal_flow(const Case& the_case) {
  return analytic::derived_quantities(the_case.pump.geometry).displacement *
         rad_per_second(the_case.operation.speed_rpm) / (2 * kPi);
}

Efficiencies efficiencies(const ReadyCase& ready, double mean_torque) {
  Efficiencies e = {not_computed(), not_computed(), not_computed()};
  if (ready.hydraulics) e.volumetric = 100 * ready.hydraulics->summary.volumetric_efficiency;
  const double power = mean_torque * rad_per_second(ready.the_case.operation.speed_rpm);
  const double raised = pressure_difference(ready) * ideal_flow(ready.the_case);
  if (power > 0 && raised > 0) e.mechanical = 100 * raised / power;
  if (is_computed(e.volumetric) && is_computed(e.mechanical))
    e.overall = e.volumetric * e.mechanical / 100;
  return e;
}

}  // namespace bentaxis::study
