// [gear]: the bevel gears, rigid or compliant.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const When kCompliant{"gear", "contact", {"compliant"}};
const When kGivingWay{"gear", "contact", {"compliant", "teeth"}};

// The gear's data: needed where it carries the block round, else there where the file has it.
const Part kGearData{kGear,
                     [](const Case& c) {
                       return c.pump.transfer.kind == TransferKind::gear ||
                              c.pump.gear.pitch_diameter != 0;
                     },
                     [](Case& c) {
                       // Until the key is read: the table is there.
                       if (c.pump.gear.pitch_diameter == 0) c.pump.gear.pitch_diameter = 1;
                     }};
const Part kCompliance = part_at([](auto& c) { return &c.pump.gear.compliance; }, kCompliant);
const Part kToothData = part_at([](auto& c) { return &c.pump.gear.teeth; }, kTeeth);
// Teeth that give way, of either kind; the keys that both have come after those that make one.
const Part kGiving{kGivingWay,
                   [](const Case& c) {
                     return c.pump.gear.contact == ToothContact::teeth
                                ? c.pump.gear.teeth.has_value()
                                : c.pump.gear.compliance.has_value();
                   },
                   [](Case& c) {
                     if (c.pump.gear.contact == ToothContact::teeth) c.pump.gear.teeth.emplace();
                   }};

// What both kinds of teeth that give way have.
template <auto kOfLaw, auto kOfTeeth>
constexpr auto kOfEither = [](auto& c) -> decltype(&(*c.pump.gear.teeth.*kOfTeeth)) {
  auto& gear = c.pump.gear;
  return gear.contact == ToothContact::teeth ? &(*gear.teeth.*kOfTeeth)
                                             : &(*gear.compliance.*kOfLaw);
};

std::optional<Value> modules_of(const Case& c, double modules) {
  if (!c.pump.gear.teeth || c.pump.gear.teeth->count <= 0) return std::nullopt;
  return modules * c.pump.gear.pitch_diameter / c.pump.gear.teeth->count * 1e3;
}

}  // namespace

Table gear_table() {
  return {
      .name = "gear",
      .meaning = "bevel gear pair that drives the block",
      .part = &kGearData,
      .differentiable = always,
      .parameters =
          {number("pitch_diameter_mm", "d = m Z", FIELD(c.pump.gear.pitch_diameter), kMillimetres,
                  kPositive, kRequired, "pitch cone diameter at the contact point O4"),
           number("pressure_angle_deg", "alpha_p", FIELD(c.pump.gear.pressure_angle), kAngle,
                  {0, 60}, kRequired, "pressure angle; the pitch cone angle is 90 deg - alpha/2",
                  {.scaling = Scaling::cosine,
                   .plausible = {10,
                                 35,
                                 "teeth are cut at 14.5 to 30 deg",
                                 {slips::kRadians, {2, "half of it?"}}}}),
           choice("contact", FIELD(c.pump.gear.contact), {"rigid", "compliant", "teeth"}, "rigid",
                  "rigid: block and shaft have the same angle at all times; compliant: compliant "
                  "contact with backlash (motion.md); teeth: resolved contact of straight bevel "
                  "teeth (teeth.md)",
                  {.changes_model = true}),
           choice("flanks", FIELD(c.pump.gear.flanks), {"one", "two"},
                  {.computed = [](const Case& c) -> std::optional<Value> {
                     return std::string(c.pump.gear.is_compliant() ? "two" : "one");
                   },
                   .words = "one; two where `contact` is not rigid"},
                  "one: one line of action for either sign of the force, as printed in the paper; "
                  "two: the flank that is pushed carries, and the separating part of its force "
                  "always pushes the gears apart"),
           number("stiffness_N_per_um", "k_F", FIELD(c.pump.gear.compliance->stiffness), kStiffness,
                  kPositive, kRequired, "force of a flank at an approach of 1 um",
                  {.part = &kCompliance}),
           number("stiffness_exponent", "n_F", FIELD(c.pump.gear.compliance->exponent), kNoUnit,
                  {1, 3}, {1.0}, "exponent of the contact force over the approach",
                  {.practice = "lines 1, points 1.5, ADAMS' default 2.2", .part = &kCompliance}),
           number("dissipation_s_per_m", "c_d",
                  kept_at(kOfEither<&ToothCompliance::dissipation, &ToothData::dissipation>,
                          "c.pump.gear.dissipation"),
                  {"s/m"}, kNotNegative, {0.0},
                  "increase of the force with the approach speed (dissipation)",
                  {.part = &kGiving}),
           number("backlash_um", "j",
                  kept_at(kOfEither<&ToothCompliance::backlash, &ToothData::backlash>,
                          "c.pump.gear.backlash"),
                  kMicrometres, kNotNegative, {0.0},
                  "along the line of action; rigid teeth have none", {.part = &kGiving}),
           number("tooth_number", "Z", FIELD(c.pump.gear.teeth->count), kNoUnit, {5, 400},
                  kRequired, "teeth of the shaft and of the block", {.part = &kToothData}),
           number("face_width_mm", "w_f", FIELD(c.pump.gear.teeth->face_width), kMillimetres,
                  kPositive, kRequired, "along the pitch cone, O4 in its middle",
                  {.part = &kToothData}),
           number("addendum_mm", "h_a", FIELD(c.pump.gear.teeth->addendum), kMillimetres, kPositive,
                  {.computed = [](const Case& c) { return modules_of(c, 1); },
                   .words = "the module d / Z"},
                  "of the teeth over the pitch cone, at O4", {.part = &kToothData}),
           number("dedendum_mm", "h_f", FIELD(c.pump.gear.teeth->dedendum), kMillimetres, kPositive,
                  {.computed = [](const Case& c) { return modules_of(c, 1.25); },
                   .words = "1.25 modules"},
                  "of the gaps under the pitch cone, at O4", {.part = &kToothData}),
           number("tip_relief_um", "C_a", FIELD(c.pump.gear.teeth->tip_relief), kMicrometres,
                  kNotNegative, {0.0},
                  "tip relief: material removed at the tips, along the line of action",
                  {.part = &kToothData}),
           number("tip_relief_height_mm", "", FIELD(c.pump.gear.teeth->relief_height), kMillimetres,
                  kPositive,
                  {.computed = [](const Case& c) { return modules_of(c, 0.5); },
                   .words = "half a module"},
                  "length of the tip relief, from the tip down; it increases with the square of "
                  "the distance from its start",
                  {.part = &kToothData}),
           number("lead_crowning_um", "C_b", FIELD(c.pump.gear.teeth->lead_crowning), kMicrometres,
                  kNotNegative, {0.0},
                  "crowning: gap between a pair of flanks at both ends of the face width, "
                  "parabolic, 0 in the middle",
                  {.part = &kToothData}),
           number("youngs_modulus_GPa", "E", FIELD(c.pump.gear.teeth->youngs_modulus), kGigapascal,
                  kPositive, {206.0}, "of the teeth",
                  {.practice = "steel 206", .part = &kToothData}),
           number("poisson_ratio", "nu", FIELD(c.pump.gear.teeth->poisson_ratio), kNoUnit, {0, 0.5},
                  {0.3}, "of the teeth", {.part = &kToothData}),
           number("rim_ratio", "", FIELD(c.pump.gear.teeth->rim_ratio), kNoUnit, {1.4, 7}, {3.0},
                  "root radius over the radius of the hub's bore, of the equivalent spur gear: "
                  "what the foundation's deflection depends on",
                  {.part = &kToothData}),
           number("shaft_runout_um", "", FIELD(c.pump.gear.teeth->shaft.runout), kMicrometres, kAny,
                  {0.0}, "amplitude of the eccentricity of the shaft's flanks, once per turn",
                  {.part = &kToothData}),
           number("shaft_runout_deg", "", FIELD(c.pump.gear.teeth->shaft.runout_angle), kAngle,
                  kAny, {0.0}, "position of its maximum, from tooth 1 in the order of the teeth",
                  {.part = &kToothData}),
           number("block_runout_um", "", FIELD(c.pump.gear.teeth->block.runout), kMicrometres, kAny,
                  {0.0}, "the same of the block's teeth", {.part = &kToothData}),
           number("block_runout_deg", "", FIELD(c.pump.gear.teeth->block.runout_angle), kAngle,
                  kAny, {0.0}, "the same of the block's teeth", {.part = &kToothData}),
           text("pitch_error_file",
                curve_at(PLACE(c.pump.gear.teeth->error_file),
                         {.teeth = [](Case& c) { return &*c.pump.gear.teeth; }}),
                "CSV `tooth,shaft_um,block_um`, path relative to the case file, a line for each "
                "tooth: how far it is ahead of its nominal position, towards +theta or +psi, along "
                "the line of action; empty: 0",
                {.part = &kToothData})},
      .rules = {after("flanks",
                      [](const Case& c) {
                        const Gear& gear = c.pump.gear;
                        return gear.is_compliant() && gear.flanks == Flanks::one
                                   ? std::string(
                                         "compliant teeth have two flanks: must be \"two\" with "
                                         "contact = \"compliant\" or \"teeth\"")
                                   : std::string();
                      }),
                after("contact",
                      [](const Case& c) {
                        const TransferKind kind = c.pump.transfer.kind;
                        return kind != TransferKind::gear && c.pump.gear.is_compliant()
                                   ? "must be \"rigid\" beside [transfer] kind = \"" +
                                         to_string(kind) + "\", which has no gear"
                                   : std::string();
                      }),
                at_end("contact", [](const Case& c) {
                  const ToothContact contact = c.pump.gear.contact;
                  if (contact == ToothContact::compliant && !c.pump.gear.compliance)
                    return std::string("needs stiffness_N_per_um");
                  if (contact == ToothContact::teeth && !c.pump.gear.teeth)
                    return std::string("needs tooth_number and face_width_mm");
                  // The cone distance grows as 1/tilt, and with it the round-off of contact
                  // points.
                  constexpr double kMinTilt = 1e-4 * kRadPerDegree;
                  if (contact == ToothContact::teeth && c.pump.geometry.tilt < kMinTilt)
                    return std::string(
                        "bevel teeth need [pump] tilt_deg >= 0.0001: nearly parallel axes meet too "
                        "far away to compute the contact of teeth");
                  return std::string();
                })}};
}

}  // namespace bentaxis::tables
