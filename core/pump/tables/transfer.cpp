// [transfer]: what drives the block.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const When kCrosses{"transfer", "kind", {"cardan", "double_cardan"}};
const When kDoubleCardan{"transfer", "kind", {"double_cardan"}};
const When kPistons{"transfer", "kind", {"pistons"}};

// All keys of the joint have defaults: it is there where it is needed.
const Part kCardanJoint{kCrosses, [](const Case& c) { return c.pump.transfer.cardan.has_value(); },
                        [](Case& c) {
                          if (c.pump.transfer.has_crosses()) c.pump.transfer.cardan.emplace();
                        }};
const Part kDoubleJoint =
    part_at([](auto& c) { return &c.pump.transfer.double_cardan; }, kDoubleCardan);
const Part kWall = part_at([](auto& c) { return &c.pump.transfer.wall; }, kPistons);

std::string type_refusal(const Case& c) {
  if (c.pump.type != PumpType::bent_axis_bevel || c.pump.transfer.kind == TransferKind::gear)
    return "";
  return "must be \"gear\" beside [pump] type = \"bent_axis_bevel\"; write type = \"bent_axis\"";
}

std::string cardan_not_assembled(const Case& c) {
  if (!c.pump.transfer.is_uneven_joint()) return "";
  const AssemblyMargin margin = assembly_margin(c.pump);
  const double length = c.pump.geometry.piston_length;
  if (length > margin.longest_distance) return "";
  return "needs [pump] piston_length_mm > " + short_text(margin.longest_distance * 1e3) +
         ": a piston cannot be assembled at theta = " + short_text(margin.theta_deg) +
         " deg, where " + short_text((margin.longest_distance - length) * 1e3) + " mm are missing";
}

std::string deviations_refusal(const Case& c) {
  if (!c.pump.transfer.wall || c.pump.transfer.wall->deviation.empty()) return "";
  const WallContact& wall = *c.pump.transfer.wall;
  const int pistons = c.pump.geometry.pistons;
  if (wall.deviation.size() != static_cast<std::size_t>(pistons))
    return "has " + std::to_string(wall.deviation.size()) +
           " pistons, must be [pump] pistons = " + std::to_string(pistons);
  for (std::size_t k = 0; k < wall.deviation.size(); ++k)
    if (!(wall.clearance_of(k) > 0))
      return "deviation_um of piston " + std::to_string(k + 1) + ": must be > " +
             short_text(-wall.clearance * 1e6) + ", so that its clearance is > 0";
  return "";
}

}  // namespace

Table transfer_table() {
  return {
      .name = "transfer",
      .meaning = "what drives the block",
      .presence = Presence::optional,
      .differentiable = always,
      .parameters =
          {choice("kind", FIELD(c.pump.transfer.kind), transfer_names(), "gear",
                  "the bevel gear of `[gear]`; an ideal constant-velocity joint; one universal "
                  "joint in O2; tapered pistons that touch their bores; or two "
                  "universal joints about O2 with a sliding shaft between them (transfer.md)",
                  {.changes_model = true}),
           number("phase_deg", "phi", FIELD(c.pump.transfer.cardan->phase), kAngle, {-180, 180},
                  {0.0}, "shaft angle at which the arm of the shaft's fork lies along x1",
                  {.part = &kCardanJoint}),
           number("cross_distance_mm", "d", FIELD(c.pump.transfer.double_cardan->cross_distance),
                  kMillimetres, kPositive, kRequired,
                  "distance of the centre of either cross from O2, along the axis of its fork",
                  {.part = &kDoubleJoint,
                   .plausible = {2,
                                 200,
                                 "forks of some mm hold a cross, and the joint lies within the "
                                 "pump; its side force grows as 1/d",
                                 {slips::kMetres, slips::kMicrometres, slips::kTenfold}}}),
           number("contact_from_joint_mm", "l_c", FIELD(c.pump.transfer.wall->from_joint),
                  kMillimetres, kNotNegative, kRequired,
                  "from A along the piston's axis to D, where the piston touches its bore",
                  {.range_here = [](const Case& c) -> std::optional<NumberRange> {
                     return NumberRange{
                         0, in_file_unit(c.pump.geometry.piston_length, kMillimetres), false, true};
                   },
                   .range_words = "[0, `piston_length_mm`)",
                   .part = &kWall}),
           number("clearance_mm", "h", FIELD(c.pump.transfer.wall->clearance), kMillimetres,
                  kNotNegative, kRequired,
                  "radial distance that D may have from the axis of its bore",
                  {.part = &kWall,
                   .plausible = {0.01,
                                 10,
                                 "the piston swings by about (1 - l_c/b1) Ra (1 - cos alpha)/2",
                                 {slips::kMetres, slips::kMicrometres, slips::kTenfold}}}),
           number("stiffness_N_per_um", "k", FIELD(c.pump.transfer.wall->stiffness), kStiffness,
                  kPositive, kRequired, "force of a wall at an approach of 1 um",
                  {.practice = "steel, some mm of line contact: 50..500",
                   .part = &kWall,
                   .plausible = {1,
                                 5000,
                                 "lines of contact of steel have about 10 N/um per mm of length",
                                 {slips::kThousandth, slips::kThousandfold}}}),
           number("stiffness_exponent", "e", FIELD(c.pump.transfer.wall->exponent), kNoUnit, {1, 3},
                  {1.0}, "power of the approach with which the force grows",
                  {.practice = "lines 1, points 1.5", .part = &kWall}),
           number("dissipation_s_per_m", "c_d", FIELD(c.pump.transfer.wall->dissipation), {"s/m"},
                  kNotNegative, {0.0}, "growth of the force with the speed of approach",
                  {.part = &kWall}),
           text("clearance_deviation_file",
                curve_at(PLACE(c.pump.transfer.wall->deviation_file),
                         {.walls = [](Case& c) { return &*c.pump.transfer.wall; }}),
                "CSV `piston,deviation_um`, path relative to the case file, a line for each "
                "piston: by how much its clearance exceeds `clearance_mm`; empty: by nothing",
                {.part = &kWall})},
      .rules = {after("kind", type_refusal), at_end("kind", cardan_not_assembled),
                at_end("kind",
                       [](const Case& c) {
                         return c.pump.transfer.kind == TransferKind::pistons &&
                                        !c.pump.transfer.wall
                                    ? std::string(
                                          "needs contact_from_joint_mm, clearance_mm and "
                                          "stiffness_N_per_um")
                                    : std::string();
                       }),
                at_end("kind",
                       [](const Case& c) {
                         return c.pump.transfer.kind == TransferKind::double_cardan &&
                                        !c.pump.transfer.double_cardan
                                    ? std::string("needs cross_distance_mm")
                                    : std::string();
                       }),
                at_end("clearance_deviation_file", deviations_refusal)}};
}

}  // namespace bentaxis::tables
