// Motion of shaft and block in time, from the closed form.
#pragma once

#include <functional>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::analytic {

struct SimulationOptions : bentaxis::SimulationOptions {
  /// Moves the start by this share of what each state is measured by: so that a load changes by
  /// about this share of its peak. For seeing how much a trajectory makes of it.
  double disturbance = 0;
  std::vector<double> times;  ///< of the rows, s, rising; empty: those of [drive]
  double start_lag = 0;       ///< theta - psi at the start, rad, of compliant teeth
  double start_speed = 0;     ///< rad/s, added to the speeds of all bodies at the start; not of a
                              ///< shaft whose speed is given
};

/// Integrates the motion of a case's [drive] and evaluates all channels along it.
///
/// Every reaction is affine in (theta'', psi''), so that three evaluations of the closed form
/// give the equations of motion. They are integrated by the extrapolation method of Gragg, Bulirsch
/// and Stoer (Boost.Odeint), whose steps end at every touch and leaving of a flank, at every edge
/// of the pressure trace that a chamber passes, and at every row. The lag theta - psi is a state of
/// its own. docs/motion.md says what was measured against what.
///
/// @throws InputError as Model and drive_of(), where the block is carried by an imposed drive,
///         and where the contact is that of teeth;
///         ComputationError naming the time where the motion cannot be followed, or not within a
///         bounded number of evaluations
Trajectory simulate(const Case& the_case, const Assumptions& assumptions,
                    const PressureTrace& pressure, const SimulationOptions& options = {},
                    const Progress& progress = {});

/// Takes the force of a contact law at a row, N, > 0 where it pushes the block towards +psi: the
/// column Rcs_law_N of simulate().
using ToothForceSink = std::function<void(double time_s, double force)>;

/// The same motion, of which nothing but the tooth force is looked at. Neither reactions nor work
/// are computed, and a row does not end a step: its force is that of a polynomial within the step,
/// held to options.error.
/// @param the_case  of a gear with a contact law and a drive of given speed
/// @return without work and energy
/// @throws as simulate(); InputError where the case is of another kind
TrajectoryRecord watch_tooth_force(const Case& the_case, const Assumptions& assumptions,
                                   const PressureTrace& pressure, const SimulationOptions& options,
                                   const ToothForceSink& see);

}  // namespace bentaxis::analytic
