// The multibody model integrated in time over the revolutions of a case.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/pressure.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::multibody {

/// Time integrators of Simbody.
enum class Integrator {
  runge_kutta_merson,
  runge_kutta_feldberg,
  runge_kutta_3,
  verlet,
  semi_explicit_euler,
  cpodes,  ///< SUNDIALS' CVODE-like BDF with projection
};

/// Names as on the command line, in the order of the enumeration.
const std::vector<std::string>& integrator_names();
/// Lowest and highest order of the method, as Simbody states it: its error goes with that power of
/// the step.
std::pair<int, int> method_orders(Integrator kind);

struct IntegrationOptions {
  Integrator integrator = Integrator::runge_kutta_merson;
  double accuracy = 1e-6;  ///< Simbody's relative accuracy per step; not the achieved error
};

/// Worst errors at the samples of an interval of an integrated run, and the work lost until its
/// end.
struct WorstErrors {
  double position_error = 0;  ///< m, largest of all constraint equations
  double velocity_error = 0;  ///< m/s (rad/s for the speed of the shaft)
  double gear_phase = 0;      ///< rad, block minus shaft
  double shaft_angle = 0;     ///< rad, shaft minus omega t
  double speed_error = 0;     ///< of the shaft, relative to omega
  double spin_error = 0;      ///< rad/s, change of a real piston's spin about its axis
  double work_residual =
      0;  ///< J since the start, that constraints and integration created or lost

  /// Takes in the errors at a later sample: the larger ones, and a NaN for good; the work as it is
  /// there.
  void keep(const WorstErrors& later);
  bool is_finite() const;
};

/// What the integration cost and how well it kept the constraints.
struct IntegrationRecord {
  WorstErrors whole;                 ///< of the whole run
  std::vector<WorstErrors> turns;    ///< one per revolution
  double work_of_loads = 0;          ///< J, pressure, friction, weight, viscous
  double work_of_drives = 0;         ///< J, drive (and imposed block motion)
  double kinetic_energy_gained = 0;  ///< J
  long steps = 0;
  long evaluations = 0;  ///< realizations of the equations of motion
  double seconds = 0;
};

struct IntegratedRun {
  ResultTable table;
  IntegrationRecord record;
};

/// Integrates from an assembled start at theta = 0 and reads all channels at the samples, landing
/// on every sample and on every edge of the pressure instead of stepping over it.
/// @param samples  of all revolutions; falling angles where the speed is negative
/// @throws InputError at standstill; ComputationError where the integrator gives up
IntegratedRun run_integrated(const Case& the_case, const Assumptions& assumptions,
                             const Samples& samples, const PressureTrace& pressure,
                             const IntegrationOptions& options, const Progress& progress = {});

/// Integrates with the shaft free under a given drive torque: if the torque is right, the shaft
/// holds its speed. The error of the speed is WorstErrors::speed_error.
/// @param drive_torque  Td, Nm, as a function of the shaft angle in degrees
IntegrationRecord run_torque_driven(const Case& the_case, const Assumptions& assumptions,
                                    const Samples& samples, const PressureTrace& pressure,
                                    const std::function<double(double)>& drive_torque,
                                    const IntegrationOptions& options,
                                    const Progress& progress = {});

}  // namespace bentaxis::multibody
