// What is asked first of a motion in time: how fast, how much, and where it is no motion of a pump.
#pragma once

#include <optional>
#include <vector>

#include "bentaxis/analytic/validity.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/trajectory.h"

namespace bentaxis::study {

/// Times in s from the start of the simulation, in the unit of time of its rows.
struct MotionAnswers {
  /// Share of the change of the speed that counts as its end.
  static constexpr double kReached = 0.95;
  /// A change of the shaft's speed that is asked about, of its largest.
  static constexpr double kLeastChange = 0.05;

  /// Share of the change that the speed may make in the last tenth of the time to have settled.
  static constexpr double kSettled = 0.02;

  double first_rpm = 0, last_rpm = 0;  ///< of the shaft, at the two ends
  /// Its mean over the last N-th of a turn: pistons, one after the other, let the speed ripple.
  double end_rpm = 0;
  /// From when on the shaft has made kReached of the change to end_rpm, for good; between two
  /// rows interpolated. Nothing where the change is below kLeastChange, or the ripple is above
  /// what is left of it.
  std::optional<double> reached_s;
  bool settled = true;  ///< less than kSettled of the change in the last tenth of the time

  /// The shaft's fastest turning against the direction of its start and end, where that is above
  /// kLeastChange of its largest speed.
  struct Backwards {
    double rpm = 0;  ///< with its sign
    double at_s = 0;
  };
  std::optional<Backwards> backwards;

  double largest_torque = 0;       ///< Nm, drive torque Td, by magnitude, with its sign
  double largest_torque_s = 0;     ///< when
  double drive_work = 0;           ///< J, of what drives the shaft
  bool drive_has_inertia = false;  ///< which the work turns too, beside the drive torque's own

  /// Of the delivery pressure, where the oil is simulated.
  struct Delivery {
    double highest_bar = 0, highest_s = 0;
    double end_bar = 0;        ///< mean over the last tenth of the time, or over the last turn
    bool end_is_turn = false;  ///< which is longer, and is what counts then
  };
  std::optional<Delivery> delivery;

  /// Limits of validity in the rows; none of a run without results.
  std::vector<analytic::ValidityLimit> limits;

  /// Of these: where the film force acts beyond the port plate, of which the plate is known.
  struct BeyondPlate {
    double share = 0;  ///< of the rows with a film force
    double largest_mm = 0, largest_s = 0;
    double plate_mm = 0;  ///< outer radius r4
  };
  std::optional<BeyondPlate> beyond_plate;

  /// Of pistons that turn the block by the walls of their bores.
  struct Walls {
    double largest_N = 0, largest_s = 0;
    int piston = 0;              ///< from 1
    double loose = 0;            ///< share of the rows in which no wall pushes
    double lag_deg[2] = {0, 0};  ///< of the block behind the shaft, least and largest
  };
  std::optional<Walls> walls;
};

MotionAnswers motion_answers(const Trajectory& run, const Case& the_case);

}  // namespace bentaxis::study
