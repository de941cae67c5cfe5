#include "scene_facts.h"

#include <algorithm>

#include "bentaxis/multibody/model.h"
#include "bentaxis/multibody/versions.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/validate.h"
#include "scene/pump_system.h"

namespace bentaxis::multibody {

Drive drive_of(Scene scene) {
  return scene == Scene::full ? Drive::given_acceleration : Drive::prescribed;
}

PumpParameters built_pump(const PumpParameters& pump, Scene scene) {
  PumpParameters built = pump;
  if (scene == Scene::piston) built.geometry.pistons = 1;
  return built;
}

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names = {"full", "pistons", "piston"};
  return names;
}

bool has_ring_off_b(const PumpParameters& pump) {
  return pump.piston.contact && *pump.piston.contact != pump.geometry.piston_length;
}

namespace {

std::string ring_contact_text(const PumpParameters& pump) {
  const auto mm = [](double metres) { return number_text(metres * 1e3); };
  return "multibody model: [piston] contact_mm = " + mm(*pump.piston.contact) +
         " differs from piston_length_mm = " + mm(pump.geometry.piston_length) +
         ": the bores' forces do work, which Simbody's ideal constraints cannot; ";
}

}  // namespace

void refuse_ring_off_b(const PumpParameters& pump) {
  if (has_ring_off_b(pump))
    throw InputError(ring_contact_text(pump) +
                     "it is not integrated in time, only evaluated at given motion (run --way "
                     "driven, run --states), or use the analytic model");
}

void refuse_teeth(const Case& the_case) {
  if (the_case.pump.gear.contact == ToothContact::teeth)
    throw InputError(
        (the_case.file.empty() ? "" : the_case.file.string() + ": ") +
        "[gear] contact = \"teeth\": not integrated by Simbody itself, only evaluated at "
        "given motion (run --way driven, run --states) or given as equations of motion "
        "(simulate)");
}

Method method_for(const PumpParameters& pump, std::optional<Method> asked) {
  if (!has_ring_off_b(pump)) return asked.value_or(Method::multipliers);
  if (asked == Method::multipliers)
    throw InputError(ring_contact_text(pump) +
                     "multipliers cannot represent such forces: use --reactions residual");
  return Method::residual;
}

const std::vector<std::string>& method_names() {
  static const std::vector<std::string> names = {"multipliers", "residual"};
  return names;
}

bool computes(Scene scene, const Channel& channel) {
  return scene == Scene::full || channel.piston > 0;
}

Scene smallest_scene(const std::vector<Channel>& channels) {
  const bool of_pistons = std::all_of(channels.begin(), channels.end(), [](const Channel& channel) {
    return computes(Scene::piston, channel);
  });
  return of_pistons ? Scene::piston : Scene::full;
}

std::vector<std::pair<std::string, std::string>> scene_facts(const PumpParameters& pump,
                                                             const Assumptions& assumptions,
                                                             Scene scene) {
  const TransferKind transfer = pump.transfer.kind;
  const bool mesh = transfer == TransferKind::gear && assumptions.gear == BlockDrive::mesh;
  const bool teeth = mesh && pump.gear.contact == ToothContact::teeth;
  const char* const gear =
      transfer == TransferKind::constant_velocity
          ? "constant-velocity joint (shaft and block mirror images, one equation of their "
            "rotations)"
      : transfer == TransferKind::cardan
          ? "universal joint (arms of two forks at right angles, one equation of their rotations)"
      : transfer == TransferKind::double_cardan
          ? "two universal joints with a sliding shaft between them (arms of both forks in one "
            "plane with the crosses' centres, one equation of places and rotations)"
      : transfer == TransferKind::pistons ? "pistons that touch their bores (spheres in cylinders, "
                                            "contact found in a force element)"
      : !mesh                             ? "gear replaced by a speed imposed on the block's joint"
      : !teeth                            ? "gear in mesh (tooth force along z4 at O4)"
      : assumptions.flanks == FlankShape::octoid
          ? "octoid bevel teeth, contact found by Newton's method in a force element"
          : "spherical involute bevel teeth, contact found by Newton's method in a force element";
  const int n = scene == Scene::piston ? 1 : pump.geometry.pistons;
  const std::string pistons = n == 1 ? "1 piston" : std::to_string(n) + " pistons";
  const std::string bodies = std::to_string(n + 2) + " (shaft, block, " + pistons + ")";
  if (scene != Scene::full)
    return {{"method", "multibody, Simbody " + simbody_version()},
            {"scene", scene == Scene::pistons ? "pistons; shaft and block move as prescribed"
                                              : "one piston; shaft and block move as prescribed"},
            {"bodies", bodies},
            {"joints", "pistons spherical at A to the shaft"},
            {"constraints", "B on its bore axis (2 per piston)"}};
  return {
      {"method", "multibody, Simbody " + simbody_version()},
      {"scene", std::string("full pump, ") + gear},
      {"bodies", bodies},
      {"joints", "shaft spherical at C1, block pin about z2, pistons spherical at A to the shaft"},
      {"constraints",
       std::string("cylindrical bearing inline at C2 (2), speed of the shaft (1), ") +
           (pump.transfer.is_joint() ? "joint (1), "
            : mesh && !teeth         ? "gear (1), "
                                     : "") +
           "B on its bore axis (2 per piston)"}};
}

SceneSize scene_size(const PumpParameters& pump, const Assumptions& assumptions, Scene scene) {
  const PumpSystem system(built_pump(validate(pump), scene), assumptions, 1, drive_of(scene));
  const SimTK::State& state = system.dynamics();
  SceneSize size;
  size.bodies = system.matter().getNumBodies() - 1;  // without Ground
  size.mobilities = state.getNU();
  size.equations = state.getNMultipliers();
  return size;
}

}  // namespace bentaxis::multibody
