// [gear]: the bevel gears, rigid or compliant.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const When kCompliant{"gear", "contact", {"compliant"}};
const When kGivingWay{"gear", "contact", {"compliant", "teeth"}};

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
constexpr auto of_either = [](auto& c) -> decltype(&(*c.pump.gear.teeth.*kOfTeeth)) {
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
  return {.name = "gear",
          .meaning = "bevel gear pair that carries the block round",
          .differentiable = always,
          .parameters =
              {{.key = "pitch_diameter_mm",
                .field = FIELD(c.pump.gear.pitch_diameter),
                .symbol = "d = m Z",
                .unit = kMillimetres,
                .range = kPositive,
                .meaning = "pitch cone diameter at the contact point O4"},
               {.key = "pressure_angle_deg",
                .field = FIELD(c.pump.gear.pressure_angle),
                .symbol = "alpha_p (ap)",
                .unit = kAngle,
                .range = {0, 60},
                .meaning = "pressure angle; the pitch cone angle is 90 deg - alpha/2",
                .scaling = Scaling::cosine,
                .plausible = {.low = 10,
                              .high = 35,
                              .why = "teeth are cut at 14.5 to 30 deg",
                              .slips = {slips::kRadians, {2, "half of it?"}}}},
               {.key = "contact",
                .field = FIELD(c.pump.gear.contact),
                .words = {"rigid", "compliant", "teeth"},
                .fallback = {std::string("rigid")},
                .meaning =
                    "rigid: block and shaft turn alike in motion; compliant: the flanks give "
                    "way, with backlash between them (motion.md); teeth: straight bevel teeth "
                    "that touch where they are (teeth.md)",
                .changes_model = true},
               {.key = "flanks",
                .field = FIELD(c.pump.gear.flanks),
                .words = {"one", "two"},
                .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                               return std::string(c.pump.gear.is_compliant() ? "two" : "one");
                             },
                             .words = "one; two where `contact` is not rigid"},
                .meaning = "one: as the paper prints, one line of action for either sign of the "
                           "force; two: the flank that is pushed carries, and the separating part "
                           "of its force always pushes the gears apart"},
               {.key = "stiffness_N_per_um",
                .field = FIELD(c.pump.gear.compliance->stiffness),
                .symbol = "k",
                .unit = kStiffness,
                .range = kPositive,
                .meaning = "force of a flank at an approach of 1 um",
                .part = &kCompliance},
               {.key = "stiffness_exponent",
                .field = FIELD(c.pump.gear.compliance->exponent),
                .symbol = "e",
                .range = {1, 3},
                .fallback = {1.0},
                .meaning = "power of the approach with which the force grows",
                .practice = "lines 1, points 1.5, ADAMS' default 2.2",
                .part = &kCompliance},
               {.key = "dissipation_s_per_m",
                .field = kept_at(of_either<&ToothCompliance::dissipation, &ToothData::dissipation>,
                                 "c.pump.gear.dissipation"),
                .symbol = "c",
                .unit = {"s/m"},
                .range = kNotNegative,
                .fallback = {0.0},
                .meaning = "growth of the force with the speed of approach",
                .part = &kGiving},
               {.key = "backlash_um",
                .field = kept_at(of_either<&ToothCompliance::backlash, &ToothData::backlash>,
                                 "c.pump.gear.backlash"),
                .symbol = "j",
                .unit = kMicrometres,
                .range = kNotNegative,
                .fallback = {0.0},
                .meaning = "along the line of action; rigid teeth have none",
                .part = &kGiving},
               {.key = "tooth_number",
                .field = FIELD(c.pump.gear.teeth->count),
                .symbol = "Z",
                .range = {5, 400},
                .meaning = "teeth of the shaft and of the block",
                .part = &kToothData},
               {.key = "face_width_mm",
                .field = FIELD(c.pump.gear.teeth->face_width),
                .symbol = "w",
                .unit = kMillimetres,
                .range = kPositive,
                .meaning = "along the pitch cone, O4 in its middle",
                .part = &kToothData},
               {.key = "addendum_mm",
                .field = FIELD(c.pump.gear.teeth->addendum),
                .symbol = "h_a",
                .unit = kMillimetres,
                .range = kPositive,
                .fallback = {.computed = [](const Case& c) { return modules_of(c, 1); },
                             .words = "the module d / Z"},
                .meaning = "of the teeth over the pitch cone, at O4",
                .part = &kToothData},
               {.key = "dedendum_mm",
                .field = FIELD(c.pump.gear.teeth->dedendum),
                .symbol = "h_f",
                .unit = kMillimetres,
                .range = kPositive,
                .fallback = {.computed = [](const Case& c) { return modules_of(c, 1.25); },
                             .words = "1.25 modules"},
                .meaning = "of the gaps under the pitch cone, at O4",
                .part = &kToothData},
               {.key = "tip_relief_um",
                .field = FIELD(c.pump.gear.teeth->tip_relief),
                .symbol = "C_a",
                .unit = kMicrometres,
                .range = kNotNegative,
                .fallback = {0.0},
                .meaning = "material that the tips lack, along the line of action",
                .part = &kToothData},
               {.key = "tip_relief_height_mm",
                .field = FIELD(c.pump.gear.teeth->relief_height),
                .unit = kMillimetres,
                .range = kPositive,
                .fallback = {.computed = [](const Case& c) { return modules_of(c, 0.5); },
                             .words = "half a module"},
                .meaning =
                    "from the tip down to where its relief begins; it grows with the square of "
                    "the way from there",
                .part = &kToothData},
               {.key = "lead_crowning_um",
                .field = FIELD(c.pump.gear.teeth->lead_crowning),
                .symbol = "C_b",
                .unit = kMicrometres,
                .range = kNotNegative,
                .fallback = {0.0},
                .meaning = "by how much a pair of flanks is farther apart at both ends than in the "
                           "middle of the face width: a parabola",
                .part = &kToothData},
               {.key = "youngs_modulus_GPa",
                .field = FIELD(c.pump.gear.teeth->youngs_modulus),
                .symbol = "E",
                .unit = kGigapascal,
                .range = kPositive,
                .fallback = {206.0},
                .meaning = "of the teeth",
                .practice = "steel 206",
                .part = &kToothData},
               {.key = "poisson_ratio",
                .field = FIELD(c.pump.gear.teeth->poisson_ratio),
                .symbol = "nu",
                .range = {0, 0.5},
                .fallback = {0.3},
                .meaning = "of the teeth",
                .part = &kToothData},
               {.key = "rim_ratio",
                .field = FIELD(c.pump.gear.teeth->rim_ratio),
                .range = {1.4, 7},
                .fallback = {3.0},
                .meaning =
                    "root radius over the radius of the hub's bore, of the equivalent spur gear: "
                    "what the foundation's deflection depends on",
                .part = &kToothData},
               {.key = "shaft_runout_um",
                .field = FIELD(c.pump.gear.teeth->shaft.runout),
                .unit = kMicrometres,
                .fallback = {0.0},
                .meaning =
                    "amplitude of the material that the flanks of the shaft's teeth lack, once "
                    "a turn",
                .part = &kToothData},
               {.key = "shaft_runout_deg",
                .field = FIELD(c.pump.gear.teeth->shaft.runout_angle),
                .unit = kAngle,
                .fallback = {0.0},
                .meaning = "where they lack most, from tooth 1 in the order of the teeth",
                .part = &kToothData},
               {.key = "block_runout_um",
                .field = FIELD(c.pump.gear.teeth->block.runout),
                .unit = kMicrometres,
                .fallback = {0.0},
                .meaning = "the same of the block's teeth",
                .part = &kToothData},
               {.key = "block_runout_deg",
                .field = FIELD(c.pump.gear.teeth->block.runout_angle),
                .unit = kAngle,
                .fallback = {0.0},
                .meaning = "the same of the block's teeth",
                .part = &kToothData},
               {.key = "pitch_error_file",
                .field = curve_at(PLACE(c.pump.gear.teeth->error_file),
                                  {.teeth = [](Case& c) { return &*c.pump.gear.teeth; }}),
                .fallback = {std::string()},
                .meaning =
                    "CSV `tooth,shaft_um,block_um`, path relative to the case file, a line for "
                    "each tooth: how far it stands ahead of its place, towards +theta or +psi, "
                    "along the line of action; empty: 0",
                .part = &kToothData}},
          .rules =
              {
                  {.key = "flanks",
                   .after = "flanks",
                   .broken =
                       [](const Case& c) {
                         const Gear& gear = c.pump.gear;
                         return gear.is_compliant() && gear.flanks == Flanks::one
                                    ? std::string(
                                          "teeth that give way have two flanks: must be \"two\" "
                                          "beside contact = \"compliant\" or \"teeth\"")
                                    : std::string();
                       }},
                  {.key = "contact", .after = "", .broken = [](const Case& c) {
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
                           "bevel teeth need [pump] tilt_deg >= 0.0001: nearly parallel axes meet "
                           "too "
                           "far away for the contact of teeth to be computed");
                     return std::string();
                   }}}};
}

}  // namespace bentaxis::tables
