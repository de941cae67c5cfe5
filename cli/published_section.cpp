#include "published_section.h"

#include <cmath>
#include <map>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "data_folder.h"
#include "models.h"
#include "reference_set.h"

namespace bentaxis::cli {
namespace {

// Applies a variant's settings. @throws InputError for a fact that cannot be set.
void apply(const compare::PublishedVariant& variant, Case& the_case, Assumptions& assumptions) {
  for (const auto& [name, value] : variant.set) {
    if (name == "block_viscous_Nm_per_rpm")
      the_case.pump.friction.block_viscous = value / kRadPerSecondPerRpm;
    else if (name == "piston_friction")
      assumptions.piston_friction = value != 0;
    else if (name == "gear_imposed")
      assumptions.gear = value != 0 ? BlockDrive::imposed : BlockDrive::mesh;
    else
      throw InputError("published variant \"" + variant.name + "\": " + name +
                       " cannot be set; allowed: block_viscous_Nm_per_rpm, piston_friction, "
                       "gear_imposed");
  }
}

}  // namespace

compare::Facts facts_of(const Case& the_case, const Assumptions& assumptions) {
  const PumpParameters& pump = the_case.pump;
  const PortPressures& ports = the_case.pressure.ports;
  const double speed = the_case.operation.speed_rpm;
  const double displacement = analytic::derived_quantities(pump.geometry).displacement;
  const bool friction = assumptions.piston_friction &&
                        (pump.friction.piston_coulomb > 0 || pump.friction.piston_viscous > 0);
  const double block_viscous = pump.friction.block_viscous * kRadPerSecondPerRpm;
  return {{"pistons", pump.geometry.pistons},
          {"displacement_cm3", displacement * 1e6},
          {"ideal_torque_Nm", displacement * (ports.delivery - ports.suction) / (2 * kPi)},
          {"gear_arm_mm", pump.gear.pitch_diameter / 2 * std::cos(pump.gear.pressure_angle) * 1e3},
          {"cos_pressure_angle", std::cos(pump.gear.pressure_angle)},
          {"speed_rpm", speed},
          {"delivery_bar", ports.delivery / kPascalPerBar},
          {"suction_bar", ports.suction / kPascalPerBar},
          {"block_viscous_Nm_per_rpm", block_viscous},
          {"block_viscous_torque_Nm", block_viscous * speed},
          {"piston_friction", friction ? 1 : 0},
          {"gear_imposed", assumptions.gear == BlockDrive::imposed ? 1 : 0},
          {"real_pistons", assumptions.inertia == PistonInertia::real ? 1 : 0}};
}

std::optional<report::PublishedTable> published_section(const PublishedInput& analytic,
                                                        const PublishedInput& multibody) {
  std::map<std::pair<std::string, std::string>, ResultTable> tables;
  const auto shipped = shipped_reference_data();
  if (!shipped || !std::filesystem::is_directory(*shipped / "published")) return std::nullopt;
  for (const auto& place : references_below(*shipped / "published")) {
    const auto description = compare::read_description(place.folder, place.name);
    if (description.kind != compare::ReferenceKind::published) continue;
    const auto published = compare::read_published(description.numbers);
    bool described = true;
    for (const auto* input : {&analytic, &multibody})
      described = described && published.describes(facts_of(*input->the_case, input->assumptions));
    if (!described) continue;
    compare::PublishedSection section = compare::judge_published(
        published, {"analytic", "multibody"},
        [&](const std::string& model, const compare::PublishedVariant& variant) {
          const PublishedInput& input = model == "analytic" ? analytic : multibody;
          Case the_case = *input.the_case;
          Assumptions assumptions = input.assumptions;
          apply(variant, the_case, assumptions);
          compare::PublishedRun run{input.table, facts_of(the_case, assumptions)};
          if (variant.set.empty()) return run;
          const PressureTrace pressure(the_case.pressure);
          const Samples samples = samples_of(the_case, pressure, Way::driven);
          run.table = &(tables[{model, variant.name}] = run_model(
                            model, the_case, assumptions, samples, pressure, Way::driven, {}));
          return run;
        });
    const std::string text =
        published.name + ": " + description.source + ". " + section.summary.text() +
        " A window is the range of a figure's axis, which the curve must not leave; it is not the "
        "curve.";
    return report::PublishedTable{text, std::move(section)};
  }
  return std::nullopt;
}

}  // namespace bentaxis::cli
