// Efficiencies of a pump at its operating point.
#pragma once

#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// Between the ports, Pa; with the hydraulic model the mean of the delivery volume.
double pressure_difference(const ReadyCase& ready);
/// Displacement x speed, m3/s.
double ideal_flow(const Case& the_case);

/// In percent; not_computed() where there is none.
struct Efficiencies {
  double volumetric = 0;  ///< mass flow to the load over that of the ideal flow at the density of
                          ///< the inlet; of a pump with the hydraulic model
  double mechanical = 0;  ///< hydraulic-mechanical: V dp / 2 pi over the mean drive torque, where
                          ///< power goes in and pressure is raised
  double overall = 0;     ///< product of the two
};
/// @param mean_torque  of Td, Nm
Efficiencies efficiencies(const ReadyCase& ready, double mean_torque);

}  // namespace bentaxis::study
