#include "bentaxis/study/published_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/study/reference_set.h"

namespace bentaxis::study {

void apply_variant(const compare::PublishedVariant& variant, Case& the_case,
                   Assumptions& assumptions) {
  for (const auto& [name, value] : variant.set) {
    if (name == "block_viscous_Nm_per_rpm")
      the_case.pump.friction.block_viscous = value / kRadPerSecondPerRpm;
    else if (name == "piston_friction")
      assumptions.piston_friction = value != 0;
    else if (name == "gear_imposed")
      assumptions.gear = value != 0 ? BlockDrive::imposed : BlockDrive::mesh;
    else if (name == "real_pistons")
      assumptions.inertia = value != 0 ? PistonInertia::real : PistonInertia::lumped;
    else
      throw InputError("published variant \"" + variant.name + "\": " + name +
                       " cannot be set; allowed: block_viscous_Nm_per_rpm, piston_friction, "
                       "gear_imposed, real_pistons");
  }
}

compare::Facts facts_of(const Case& the_case, const Assumptions& assumptions) {
  const PumpParameters& pump = the_case.pump;
  const PortPressures& ports = the_case.pressure.ports;
  const double speed = the_case.operation.speed_rpm;
  const double displacement = analytic::derived_quantities(pump).displacement;
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

std::optional<PrintedNumbers> printed_numbers_of(const std::filesystem::path& folder,
                                                 const std::vector<compare::Facts>& all_facts) {
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  for (const auto& place : references_below(folder)) {
    const auto description = compare::read_description(place.folder, place.name);
    if (description.kind != compare::ReferenceKind::published) continue;
    PrintedNumbers printed{compare::read_published(description.numbers), description.source};
    if (std::all_of(all_facts.begin(), all_facts.end(),
                    [&](const compare::Facts& facts) { return printed.numbers.describes(facts); }))
      return printed;
  }
  return std::nullopt;
}

compare::PublishedRun VariantRuns::operator()(const compare::PublishedVariant& variant) {
  Case the_case = *input_.the_case;
  RunOptions options{.model = model_, .assumptions = input_.assumptions};
  apply_variant(variant, the_case, *options.assumptions);
  compare::PublishedRun run{input_.table, facts_of(the_case, *options.assumptions)};
  if (variant.set.empty()) return run;
  ResultTable& table = tables_[variant.name];
  if (table.rows() == 0) {
    int& samples = the_case.operation.samples_per_revolution;
    samples = std::min(samples, kMaxVariantSamples);
    PressureTrace pressure(the_case.pressure);
    const PreparedCase ready{std::move(the_case), {}, std::move(pressure)};
    table = study::run(ready, options, progress_of_).table;
  }
  run.table = &table;
  return run;
}

compare::PublishedSection judge_case(const compare::Published& published,
                                     const PublishedInput& analytic,
                                     const PublishedInput& multibody,
                                     const PartProgress& progress_of) {
  VariantRuns of_analytic(Model::analytic, analytic, progress_of);
  VariantRuns of_multibody(Model::multibody, multibody, progress_of);
  return compare::judge_published(
      published, {to_string(Model::analytic), to_string(Model::multibody)},
      [&](const std::string& name, const compare::PublishedVariant& variant) {
        return name == to_string(Model::analytic) ? of_analytic(variant) : of_multibody(variant);
      });
}

std::optional<compare::PublishedTable> published_section(const std::filesystem::path& folder,
                                                         const PublishedInput& analytic,
                                                         const PublishedInput& multibody,
                                                         const PartProgress& progress_of) {
  const auto printed =
      printed_numbers_of(folder, {facts_of(*analytic.the_case, analytic.assumptions),
                                  facts_of(*multibody.the_case, multibody.assumptions)});
  if (!printed) return std::nullopt;
  compare::PublishedSection section =
      judge_case(printed->numbers, analytic, multibody, progress_of);
  const std::string text =
      printed->numbers.name + ": " + printed->source + ". " + section.summary.text() +
      " A window is the axis range of a figure; the curve must stay within it.";
  return compare::PublishedTable{text, std::move(section)};
}

compare::PublishedSection judge_point(const compare::Published& published,
                                      const OperatingPoint& point,
                                      const PartProgress& progress_of) {
  const Case& the_case = point.the_case();
  const std::string mismatch = published.mismatch(facts_of(the_case, the_case.analytic));
  if (!mismatch.empty())
    throw InputError(the_case.file.string() + ": the printed numbers are of another pump (" +
                     published.name + "): " + mismatch);
  compare::PublishedSection section =
      judge_case(published, {&the_case, the_case.analytic, &point.analytic},
                 {&the_case, the_case.multibody, &point.multibody}, progress_of);
  for (auto& row : section.rows) {
    const compare::PublishedNumber& number = row.number;
    if (!number.find_pressure || row.verdict == compare::PublishedVerdict::not_comparable) continue;
    try {
      const double pressure = delivery_pressure_for(
          point, number.quantity, number.low,
          [&](const ResultTable& table) {
            return compare::value_of(number, {&table, {}})->low;
          },
          progress_of);
      row.where +=
          fmt::format("; needs a mean delivery pressure of {:.1f} bar", pressure / kPascalPerBar);
    } catch (const ComputationError& error) {
      row.where += fmt::format("; the delivery pressure it needs was not found: {}", error.what());
    }
  }
  return section;
}

}  // namespace bentaxis::study
