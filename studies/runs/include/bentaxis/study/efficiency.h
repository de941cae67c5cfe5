// The account of power of a pump at its operating point, and the efficiencies that follow from it.
#pragma once

#include <optional>
#include <span>

#include "bentaxis/hydraulics/power.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// Between the ports, Pa; with the hydraulic model the mean of the delivery volume.
double pressure_difference(const PreparedCase& ready);
/// Displacement x speed, m3/s.
double ideal_flow(const Case& the_case);

/// The energy balance of the oil in the pump, mean over a turn, W: of a case with the hydraulic
/// model, by one period more of its integration.
/// @throws ComputationError
std::optional<hydraulics::PumpPower> pump_power(const PreparedCase& ready,
                                                const Progress& progress = {});

/// Mean volume flow to the load at the density of the mean delivery pressure, m3/s.
double flow_at_delivery(const hydraulics::SteadyState& state);

/// In percent; not_computed() where there is none. docs/budgets.md has the definitions.
struct Efficiencies {
  // Of the energy balance and of mass: overall = volumetric x mechanical_mass.
  double volumetric = 0;       ///< mass flow to the load over that of the ideal flow at the density
                               ///< of the suction port, of a motor the inverse; with the hydraulic
                               ///< model
  double mechanical_mass = 0;  ///< the ideal mass flow times the useful energy of a unit of mass,
                               ///< over the power of the drive
  double overall = 0;          ///< PumpPower::useful over the power of the drive

  // Of ISO 4409, by volume flow at delivery conditions: overall_iso = volumetric_iso x mechanical.
  double volumetric_iso =
      0;  ///< volume flow to the load, at mean delivery pressure, over the ideal flow
  double mechanical = 0;   ///< hydraulic-mechanical: V dp / 2 pi over the mean drive torque,
                           ///< where power goes in and pressure is raised
  double overall_iso = 0;  ///< that volume flow x dp over the power of the drive
};

/// What an efficiency is called, wherever it is stated.
struct EfficiencyLine {
  const char* key;   ///< one word: "overall"
  const char* name;  ///< for readers: "total"
  const char* meaning;
  double Efficiencies::*value;
};
std::span<const EfficiencyLine> efficiency_lines();

/// @param power        pump_power(ready)
/// @param mean_torque  of Td, Nm
Efficiencies efficiencies(const PreparedCase& ready,
                          const std::optional<hydraulics::PumpPower>& power, double mean_torque);

}  // namespace bentaxis::study
