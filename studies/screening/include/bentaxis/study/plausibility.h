// Input plausibility checks of a case: a tilt in radians, millimetres given as metres,
// radii exchanged. Limits follow from the geometry and physics of the given pump.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/case.h"

namespace bentaxis::study {

/// A plausibility warning: a value or a combination of values.
struct PlausibilityWarning {
  std::string code;    ///< stable short name: "tilt-in-radians"
  std::string text;    ///< one line: the key with its value, the limit and its reason
  std::string reason;  ///< why it is meant all the same, where the case says so
};
using Doubt [[deprecated("use PlausibilityWarning")]] = PlausibilityWarning;

/// What an engineer checks first about a pump.
struct Plausibility {
  double displacement = 0;       ///< m3 per revolution
  double ideal_flow = 0;         ///< m3/s
  double ideal_torque = 0;       ///< Nm, displacement x (delivery - suction) / 2 pi
  double speed_rpm = 0;          ///< as given
  double delivery = 0;           ///< Pa gauge
  double mean_piston_speed = 0;  ///< m/s, two strokes per turn

  std::vector<PlausibilityWarning> warnings;  ///< in the order of the table of checks
  std::vector<PlausibilityWarning> meant;  ///< those that `[plausibility] meant` gives a reason for

  /// The pump in one line: the six numbers above.
  std::string summary() const;
};

/// Looks at a case before it is run: its numbers one by one and together, and one turn of the
/// analytic model, at its own angles, for what carries block and gear. Where the pressure is still
/// to be computed the turn is made with an ideal trace between the port pressures. Milliseconds.
/// @throws InputError where `[plausibility] meant` names no check or gives no reason
Plausibility plausibility(const Case& the_case);

/// Of a displacement, m3 per revolution: V (delivery - suction) / 2 pi, Nm; 0 without a sign.
double ideal_torque(double displacement, const PortPressures& ports);

/// Whether the chamber pressure of a case is of kind "hydraulic" and still to be computed.
bool lacks_pressure(const PressureSpec& pressure);

/// The reason that `[plausibility] meant` gives for a check or for a verdict on the timing of the
/// ports (study/timing.h), or "".
/// @throws InputError as above
std::string stated_reason(const Case& the_case, const std::string& code);

/// All checks as a Markdown table: name, and what it warns of.
std::string plausibility_markdown();
/// Names of all checks.
std::vector<std::string> plausibility_codes();

}  // namespace bentaxis::study
