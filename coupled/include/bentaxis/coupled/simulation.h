// Oil, pump and drive in time, as one system.
#pragma once

#include <complex>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/drive_spec.h"
#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/results/surroundings.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::coupled {

/// What a pump tells at an instant: a row of its tables.
struct PumpOutputs {
  double time = 0;                        ///< s
  const std::vector<std::string>& names;  ///< of trajectory_columns(), channels and oil columns
  const std::vector<double>& values;  ///< in the units of their names; not_computed() among them
  /// By name.
  /// @throws InputError where there is no such column
  double operator[](const std::string& name) const;
};

/// A partner outside that acts on the pump and receives its values from one communication point to
/// the next.
struct Exchange {
  double step = 0;  ///< s, between communication points; the first is 0
  /// Called at each of them before the end with what the pump tells there, under what acted until
  /// then. @return what acts until the next: constant, but for the shaft's speed, which changes by
  /// its acceleration. Of the shaft's motion speed and acceleration count: its angle goes on.
  std::function<Surroundings(const PumpOutputs& pump)> partner;
};

struct Options {
  double tolerance = 1e-9;    ///< error per step of each state, of its scale
  std::vector<double> times;  ///< of the rows, s, rising; empty: those of [drive]
  /// Moves the start by this share of each state's scale.
  double disturbance = 0;
  bool body_loads = false;  ///< Trajectory::loads too
  /// Of simulate(): works, energies and masses too. Without them a run costs less.
  bool balances = true;
  /// Of simulate(): reactions on the pump as a whole alone, which a run that only tells an error or
  /// a growth is looked at for.
  bool of_pump_alone = false;
  /// Of simulate(): acts from outside as far as mechanics and oil take it. Rows at communication
  /// points are those under what acts from then on.
  std::optional<Exchange> exchange;
};

/// Integrates states of motion and of the oil together, by variable-order BDF (CVODE) with Newton's
/// method. Steps end at every edge of the port openings, at every touch and leaving of a flank, at
/// every breakpoint of a curve over time; rows are read from the integrator's own polynomial.
/// Energies and masses are integrated along.
/// @param name  of the model, for the table
/// @throws ComputationError naming the time where the motion cannot be followed, or not within a
///         bounded number of steps; what the partner of an exchange throws
Trajectory simulate(const std::string& name, Mechanics& mechanics, Oil& oil, const DriveSpec& drive,
                    const Options& options = {}, const Progress& progress = {});

/// A motion that repeats itself after every N-th of the block's turn.
struct SteadyMotion {
  Trajectory turn;      ///< one turn of the block, rows at equal times from its start
  double period_s = 0;  ///< of an N-th of a turn
  double speed = 0;     ///< rad/s, mean, of the block
  int iterations = 0;   ///< Newton steps
  double residual = 0;  ///< largest change of a state over a period, of its scale
  /// How far the state may be from the periodic one, of its scale: the Newton step that would be
  /// next, and errors of the integration, which slow decay amplifies. About 30 tolerances at most,
  /// or what double precision leaves where a disturbance decays very slowly.
  double error = 0;
  double tolerance = 0;  ///< as in Options
  /// Floquet multipliers of an N-th of a turn, largest magnitude first; that of a shift in time,
  /// which is 1, is left out. A disturbance has shrunk by their magnitude after it.
  std::vector<std::complex<double>> multipliers;
  bool stable() const { return multipliers.empty() || std::abs(multipliers.front()) < 1; }
  MotionVector motion{};    ///< at its start, psi = 0
  std::vector<double> oil;  ///< likewise
};

/// Finds the periodic motion directly: Newton's method on the map of an N-th of the block's turn,
/// after which pistons are numbered again. Derivatives by central differences.
/// @throws InputError where what drives the shaft or the circuit changes in time (a curve);
///         ComputationError where no periodic motion is found, or the shaft does not turn
SteadyMotion steady(const std::string& name, Mechanics& mechanics, Oil& oil, const DriveSpec& drive,
                    const Options& options = {}, const Progress& progress = {});

}  // namespace bentaxis::coupled
