// How the pressures of a running pump change with the parameters of its case.
#pragma once

#include <span>
#include <vector>

#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/case.h"

namespace bentaxis::hydraulics {

/// A parameter, as two cases a little above and below the one that a state is of: so little that
/// what is not linear in it between them does not count, about 1e-6 of the parameter.
struct Neighbours {
  Case above, below;
  double apart = 0;  ///< by how much the parameter differs between them, in any unit
};

/// Derivatives by one parameter, per its unit.
struct PressureRates {
  std::vector<double> chamber;  ///< Pa gauge, at angles of a chamber
  double delivery_mean = 0;     ///< Pa gauge, Summary::delivery_mean
};

/// What means over a turn become in the neighbours of a state, to first order in what they are
/// apart: the difference of anything that is made of them, over that, is its derivative.
struct NeighbourMeans {
  /// Of the summary: displacement, density, flows, their efficiency, work, masses and the mean
  /// delivery pressure; and the equations.
  SteadyState above, below;
  PowerBudget power_above, power_below;  ///< as power_by_place()
};

/// Whether both cases are allowed, with the circuit that the state is of.
bool has_rates(const SteadyState& state, const Neighbours& parameter);

/// Derivatives of the periodic state by parameters, by CVODES' forward sensitivities: the
/// variational equations, with derivatives of the equations by the parameters from the two cases of
/// each, give how the end of a period changes with its start, with the load's size and with each
/// parameter; that the changed state is periodic, and has the mean delivery pressure asked for,
/// decides how its start and the load follow. At edges of the ports nothing jumps: areas open from
/// 0, so that the equations are continuous there.
/// @param theta_k_deg  angles of a chamber, any
/// @param tolerance    error allowed per step of d(ln P)/d(parameter), in the unit of `apart`
/// @param means        if not null: receives the means of the neighbours of each parameter
/// @throws InputError where !has_rates()
/// @throws ComputationError where the integration fails
std::vector<PressureRates> pressure_rates(const SteadyState& state,
                                          std::span<const Neighbours> parameters,
                                          std::span<const double> theta_k_deg,
                                          double tolerance = 1e-9, const Progress& progress = {},
                                          std::vector<NeighbourMeans>* means = nullptr);

}  // namespace bentaxis::hydraulics
