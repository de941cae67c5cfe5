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
  return {{.key = bearing + "_designation",
           .field = FIELD((c.ratings.*kBearing)->designation),
           .fallback = {std::string()},
           .meaning = "which " + bearing + " bearing it is, for reports",
           .part = part},
          {.key = bearing + "_dynamic_rating_kN",
           .field = FIELD((c.ratings.*kBearing)->dynamic_rating),
           .symbol = "C_" + bearing,
           .unit = kKilonewtons,
           .range = kPositive,
           .meaning = "basic dynamic radial load rating of the " + bearing + " bearing (ISO 281)",
           .part = part,
           .in_fmu = InFmu::absent},
          {.key = bearing + "_static_rating_kN",
           .field = FIELD((c.ratings.*kBearing)->static_rating),
           .symbol = "C0_" + bearing,
           .unit = kKilonewtons,
           .range = kPositive,
           .meaning = "basic static radial load rating of the " + bearing + " bearing (ISO 76)",
           .part = part,
           .in_fmu = InFmu::absent}};
}

// How radial and axial load count together. Of a contact angle a, Y = 0.4 cot a, e = 1.5 tan a and
// Y0 = 0.22 cot a (ISO 281, ISO 76): Y alone says the rest.
std::vector<Parameter> tapered_factors() {
  return {{.key = "tapered_Y",
           .field = FIELD(c.ratings.tapered->axial_factor),
           .symbol = "Y",
           .range = kPositive,
           .meaning = "axial load factor",
           .practice = "0.7..2.1",
           .part = &kTaperedRating,
           .in_fmu = InFmu::absent},
          {.key = "tapered_e",
           .field = FIELD(c.ratings.tapered->ratio_limit),
           .symbol = "e",
           .range = kPositive,
           .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                          return 0.6 / c.ratings.tapered->axial_factor;
                        },
                        .words = "0.6 / `tapered_Y`"},
           .meaning = "Fa / Fr up to which the axial load does not count",
           .part = &kTaperedRating,
           .in_fmu = InFmu::absent},
          {.key = "tapered_X",
           .field = FIELD(c.ratings.tapered->radial_factor),
           .symbol = "X",
           .range = {0, 1},
           .fallback = {0.4},
           .meaning = "radial load factor beyond that",
           .part = &kTaperedRating,
           .in_fmu = InFmu::absent},
          {.key = "tapered_Y0",
           .field = FIELD(c.ratings.tapered->static_axial_factor),
           .symbol = "Y0",
           .range = kNotNegative,
           .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                          return 0.55 * c.ratings.tapered->axial_factor;
                        },
                        .words = "0.55 `tapered_Y`"},
           .meaning = "static axial load factor",
           .part = &kTaperedRating,
           .in_fmu = InFmu::absent}};
}

}  // namespace

Table bearings_table() {
  Table table{
      .name = "bearings",
      .meaning =
          "places of the bearings on the shaft axis, and where their life is asked for their "
          "ratings",
      .differentiable = always,
      .parameters = {{.key = "tapered_z_mm",
                      .field = FIELD(c.pump.bearings.tapered_z),
                      .symbol = "C1",
                      .unit = kMillimetres,
                      .meaning = "z1 of the tapered roller bearing, which takes x, y and z"},
                     {.key = "cylindrical_z_mm",
                      .field = FIELD(c.pump.bearings.cylindrical_z),
                      .symbol = "C2",
                      .unit = kMillimetres,
                      .range_words = "other than `tapered_z_mm`",
                      .meaning = "z1 of the cylindrical roller bearing, which takes x and y"}},
      .rules = {{.key = "cylindrical_z_mm", .after = "cylindrical_z_mm", .broken = same_bearings}}};
  for (const auto& more :
       {rating_parameters<&BearingRatings::tapered>("tapered", &kTaperedRating), tapered_factors(),
        rating_parameters<&BearingRatings::cylindrical>("cylindrical", &kCylindricalRating)})
    table.parameters.insert(table.parameters.end(), more.begin(), more.end());
  return table;
}

}  // namespace bentaxis::tables
