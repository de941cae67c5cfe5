// [bearings]: their places, and where their life is asked for their ratings.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kTaperedRating = part_at([](auto& c) { return &c.ratings.tapered; });
const Part kCylindricalRating = part_at([](auto& c) { return &c.ratings.cylindrical; });

std::string same_bearings(const Case& c) {
  const Bearings& b = c.pump.bearings;
  return b.tapered_z == b.cylindrical_z ? "must differ from tapered_z_mm" : "";
}

// Ratings of a bearing.
template <auto kBearing>
std::vector<Parameter> rating_parameters(const std::string& bearing, const Part* part) {
  return {text(bearing + "_designation", FIELD((c.ratings.*kBearing)->designation),
               "which " + bearing + " bearing it is, for reports", {.part = part}),
          number(bearing + "_dynamic_rating_kN", "C_" + bearing,
                 FIELD((c.ratings.*kBearing)->dynamic_rating), kKilonewtons, kPositive, kRequired,
                 "basic dynamic radial load rating of the " + bearing + " bearing (ISO 281)",
                 {.part = part, .in_fmu = InFmu::absent}),
          number(bearing + "_static_rating_kN", "C0_" + bearing,
                 FIELD((c.ratings.*kBearing)->static_rating), kKilonewtons, kPositive, kRequired,
                 "basic static radial load rating of the " + bearing + " bearing (ISO 76)",
                 {.part = part, .in_fmu = InFmu::absent})};
}

// How radial and axial load count together. Of a contact angle a, Y = 0.4 cot a, e = 1.5 tan a and
// Y0 = 0.22 cot a (ISO 281, ISO 76): Y alone says the rest.
std::vector<Parameter> tapered_factors() {
  return {number("tapered_Y", "Y", FIELD(c.ratings.tapered->axial_factor), kNoUnit, kPositive,
                 kRequired, "axial load factor",
                 {.practice = "0.7..2.1", .part = &kTaperedRating, .in_fmu = InFmu::absent}),
          number("tapered_e", "e", FIELD(c.ratings.tapered->ratio_limit), kNoUnit, kPositive,
                 {.computed = [](const Case& c) -> std::optional<Value> {
                    return 0.6 / c.ratings.tapered->axial_factor;
                  },
                  .words = "0.6 / `tapered_Y`"},
                 "limit of Fa / Fr up to which the axial load is ignored (factor e)",
                 {.part = &kTaperedRating, .in_fmu = InFmu::absent}),
          number("tapered_X", "X", FIELD(c.ratings.tapered->radial_factor), kNoUnit, {0, 1}, {0.4},
                 "radial load factor above that limit",
                 {.part = &kTaperedRating, .in_fmu = InFmu::absent}),
          number("tapered_Y0", "Y0", FIELD(c.ratings.tapered->static_axial_factor), kNoUnit,
                 kNotNegative,
                 {.computed = [](const Case& c) -> std::optional<Value> {
                    return 0.55 * c.ratings.tapered->axial_factor;
                  },
                  .words = "0.55 `tapered_Y`"},
                 "static axial load factor", {.part = &kTaperedRating, .in_fmu = InFmu::absent})};
}

}  // namespace

Table bearings_table() {
  Table table{
      .name = "bearings",
      .meaning =
          "positions of the bearings on the shaft axis, and their ratings for the rating life",
      .differentiable = always,
      .parameters = {number("tapered_z_mm", "z_C1", FIELD(c.pump.bearings.tapered_z), kMillimetres,
                            kAny, kRequired,
                            "z1 of the tapered roller bearing, which takes x, y and z"),
                     number("cylindrical_z_mm", "z_C2", FIELD(c.pump.bearings.cylindrical_z),
                            kMillimetres, kAny, kRequired,
                            "z1 of the cylindrical roller bearing, which takes x and y",
                            {.range_words = "other than `tapered_z_mm`"})},
      .rules = {after("cylindrical_z_mm", same_bearings)}};
  for (const auto& more :
       {rating_parameters<&BearingRatings::tapered>("tapered", &kTaperedRating), tapered_factors(),
        rating_parameters<&BearingRatings::cylindrical>("cylindrical", &kCylindricalRating)})
    table.parameters.insert(table.parameters.end(), more.begin(), more.end());
  return table;
}

}  // namespace bentaxis::tables
