#include "assumptions.h"

#include "bentaxis/pump/error.h"

namespace bentaxis::cli {

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
    assumptions.inertia = pick("lumped", "real") ? PistonInertia::real : PistonInertia::lumped;
    if (assumptions.inertia == PistonInertia::real && !pump.piston.real)
      throw InputError("assumption \"" + text +
                       "\": the case has no centre_of_mass_mm, transverse_inertia_kg_mm2 and "
                       "axial_inertia_kg_mm2 in [piston]");
  } else if (key == "gear") {
    assumptions.gear = pick("mesh", "imposed") ? GearScene::imposed : GearScene::mesh;
  } else {
    throw InputError(
        "assumption \"" + text +
        "\": must be piston_friction=on|off, inertia=lumped|real or gear=mesh|imposed");
  }
}

}  // namespace bentaxis::cli
