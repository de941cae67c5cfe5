// The hydraulic side of a pump that turns anyhow: starts, stops, reverses, motors.
#pragma once

#include <memory>
#include <vector>

#include "bentaxis/hydraulics/steady_state.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/oil.h"

namespace bentaxis::hydraulics {

/// Where oil begins.
struct OilStart {
  /// Of a load whose size is sought, as in Summary; 0: it lets nothing pass.
  double load_size = 0;
  /// SteadyState::states: in the periodic state at theta = 0. Empty: at rest. Then every chamber
  /// has the pressure of the port that it is open to (of the wider one, and closed to both that of
  /// suction), the delivery volume and lines atmospheric pressure, or that at which the delivery
  /// side is held, or in a closed loop that of the charge supply, and nothing flows.
  std::vector<double> states;
};

/// In the periodic state.
OilStart running(const SteadyState& state);
/// At rest before the load of that state.
OilStart at_rest(const SteadyState& state);

/// Whether motion with oil begins in the periodic state of the speed of [operation]: where every
/// body turns at that speed. @throws InputError as drive_of()
bool starts_periodic(const Case& the_case);
/// Whether that periodic state has to be known: for the start, or for the load's size.
bool needs_periodic_state(const Case& the_case);

/// The equations of steady_state(), per second: chambers see the ports at the block's angle, and
/// their volume follows both angles. Any speed of [operation] will do, 0 and backwards among them;
/// of the suction line's flow it sets the scale alone.
/// @throws InputError if the case has no [hydraulics], the pistons have no stroke, or `states` is
///         of another circuit
std::unique_ptr<Oil> oil_in_time(const Case& the_case, const OilStart& start);

}  // namespace bentaxis::hydraulics
