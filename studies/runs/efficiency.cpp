#include "bentaxis/study/efficiency.h"

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study {

double pressure_difference(const PreparedCase& ready) {
  const PortPressures& ports = ready.the_case.pressure.ports;
  const double delivery =
      ready.hydraulics ? ready.hydraulics->summary.delivery_mean : ports.delivery;
  return delivery - ports.suction;
}

double ideal_flow(const Case& the_case) {
  return analytic::derived_quantities(the_case.pump).displacement *
         rad_per_second(the_case.operation.speed_rpm) / (2 * kPi);
}

std::optional<hydraulics::PumpPower> pump_power(const PreparedCase& ready,
                                                const Progress& progress) {
  if (!ready.hydraulics) return std::nullopt;
  return hydraulics::pump_power(hydraulics::power_by_place(*ready.hydraulics, progress));
}

double flow_at_delivery(const hydraulics::SteadyState& state) {
  return state.summary.mass_flow / hydraulics::density(state, state.summary.delivery_mean);
}

std::span<const EfficiencyLine> efficiency_lines() {
  static constexpr EfficiencyLine kLines[] = {
      {"volumetric", "volumetric",
       "mass flow to the load over that of the ideal flow at the density of the inlet; of a motor "
       "the inverse",
       &Efficiencies::volumetric},
      {"mechanical", "hydraulic-mechanical",
       "ISO 4409: ideal torque V dp / 2 pi over mean Td; above 100 % is possible where oil is soft",
       &Efficiencies::mechanical},
      {"overall", "total", "power of the flow to the load over that of the drive",
       &Efficiencies::overall},
      {"mechanical_mass", "mass-based hydraulic-mechanical",
       "total over volumetric: ideal mass flow x useful energy per mass over the power of the "
       "drive",
       &Efficiencies::mechanical_mass},
      {"volumetric_iso", "ISO 4409 volumetric",
       "volume flow to the load at mean delivery pressure over displacement x speed",
       &Efficiencies::volumetric_iso},
      {"overall_iso", "ISO 4409 total",
       "ISO 4409 volumetric x hydraulic-mechanical: flow at delivery pressure x pressure "
       "difference over the power of the drive",
       &Efficiencies::overall_iso}};
  return kLines;
}

Efficiencies efficiencies(const PreparedCase& ready,
                          const std::optional<hydraulics::PumpPower>& power, double mean_torque) {
  const double none = not_computed();
  Efficiencies e = {none, none, none, none, none, none};
  if (ready.hydraulics) e.volumetric = 100 * ready.hydraulics->summary.volumetric_efficiency;
  const double drive = mean_torque * rad_per_second(ready.the_case.operation.speed_rpm);
  const double raised = pressure_difference(ready) * ideal_flow(ready.the_case);
  if (!(drive > 0 && raised > 0)) return e;
  e.mechanical = 100 * raised / drive;
  if (!ready.hydraulics || !power) return e;
  e.overall = 100 * power->useful / drive;
  if (e.volumetric > 0) e.mechanical_mass = 100 * e.overall / e.volumetric;
  e.volumetric_iso = 100 * flow_at_delivery(*ready.hydraulics) / ideal_flow(ready.the_case);
  e.overall_iso = e.volumetric_iso * e.mechanical / 100;
  return e;
}

}  // namespace bentaxis::study
