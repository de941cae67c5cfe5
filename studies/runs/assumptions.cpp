#include "bentaxis/study/assumptions.h"

#include <algorithm>

#include "bentaxis/pump/error.h"

namespace bentaxis::study {

void apply_assumption(const std::string& text, const PumpParameters& pump,
                      Assumptions& assumptions) {
  const auto equals = text.find('=');
  const std::string key = text.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
  const auto pick = [&](const char* no, const char* yes) {
    if (value != no && value != yes)
      throw InputError("assumption \"" + text + "\": " + key + " must be " + no + " or " + yes);
    return value == yes;
  };
  if (key == "piston_friction") {
    assumptions.piston_friction = pick("off", "on");
  } else if (key == "inertia") {
    const auto& names = piston_inertia_names();
    const auto found = std::find(names.begin(), names.end(), value);
    if (found == names.end())
      throw InputError("assumption \"" + text + "\": inertia must be lumped, real or " + names[2]);
    assumptions.inertia = static_cast<PistonInertia>(found - names.begin());
    if (const std::string why = piston_inertia_refusal(assumptions.inertia, pump); !why.empty())
      throw InputError("assumption \"" + text + "\": " + why);
  } else if (key == "gear") {
    assumptions.gear = pick("mesh", "imposed") ? BlockDrive::imposed : BlockDrive::mesh;
  } else if (key == "flank_shape") {
    if (pump.gear.contact != ToothContact::teeth)
      throw InputError("assumption \"" + text + "\": needs [gear] contact = \"teeth\"");
    assumptions.flanks = pick("involute", "octoid") ? FlankShape::octoid : FlankShape::involute;
  } else {
    throw InputError("assumption \"" + text +
                     "\": must be piston_friction=on|off, inertia=lumped|real|"
                     "dynamically_equivalent, gear=mesh|imposed or flank_shape=involute|octoid");
  }
}

}  // namespace bentaxis::study
