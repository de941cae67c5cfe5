// [bearings]: their places, and where their life is asked for their ratings.
#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

const Part kTaperedRating = part_at([](auto& c) { return &c.ratings.tapered; });
const Part kCylindricalRating = part_at([](auto& c) { return &c.ratings.cylindrical; });

// Internal geometry of a ball bearing.
template <auto kBearing>
const Part kBalls = [] {
  Part part = part_at(
      [](auto& c) { return c.ratings.*kBearing ? &(c.ratings.*kBearing)->balls : nullptr; });
  part.belongs_to = "the ratings of the bearing";
  return part;
}();

std::string same_bearings(const Case& c) {
  const Bearings& b = c.pump.bearings;
  return b.tapered_z == b.cylindrical_z ? "must differ from tapered_z_mm" : "";
}

// What the balls of a bearing must be to each other.
template <auto kBearing>
std::string pitch_refusal(const Case& c) {
  const auto& rating = c.ratings.*kBearing;
  if (!rating || !rating->balls) return "";
  return rating->balls->pitch_diameter > rating->balls->ball_diameter
             ? ""
             : "must be larger than the ball's diameter";
}
template <auto kBearing>
std::string clearance_refusal(const Case& c) {
  const auto& rating = c.ratings.*kBearing;
  if (!rating || !rating->balls) return "";
  return rating->balls->radial_clearance < rating->balls->ball_diameter / 10
             ? ""
             : "must be less than a tenth of the ball's diameter";
}
template <auto kBearing>
std::string balls_refusal(const Case& c) {
  const auto& rating = c.ratings.*kBearing;
  return !rating || !rating->balls || rating->element == RollingElement::ball
             ? ""
             : "is of a ball bearing: needs the rolling element \"ball\"";
}

bool has_balls(const Case& c) { return c.ratings.tapered->element == RollingElement::ball; }

// Ratings of a bearing.
template <auto kBearing>
std::vector<Parameter> rating_parameters(const std::string& bearing, const Part* part) {
  return {choice(bearing + "_rolling_element", FIELD((c.ratings.*kBearing)->element),
                 {"roller", "ball"}, "roller",
                 "roller: life exponent 10/3; ball: a ball bearing in place of the " + bearing +
                     " roller bearing, life exponent 3",
                 {.part = part}),
          text(bearing + "_designation", FIELD((c.ratings.*kBearing)->designation),
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

template <auto kBearing>
std::vector<Parameter> ball_parameters(const std::string& bearing) {
  const Part* const part = &kBalls<kBearing>;
  return {number(bearing + "_balls", "", FIELD((c.ratings.*kBearing)->balls->balls), kNoUnit,
                 {3, 1000}, kRequired,
                 "number of balls in place of the " + bearing +
                     " rollers: with it, deflection and L10r (ISO/TS 16281)",
                 {.part = part, .in_fmu = InFmu::absent}),
          number(bearing + "_ball_diameter_mm", "",
                 FIELD((c.ratings.*kBearing)->balls->ball_diameter), kMillimetres, kPositive,
                 kRequired, "diameter of a ball in place of the " + bearing + " rollers",
                 {.part = part, .in_fmu = InFmu::absent}),
          number(bearing + "_ball_pitch_diameter_mm", "",
                 FIELD((c.ratings.*kBearing)->balls->pitch_diameter), kMillimetres, kPositive,
                 kRequired,
                 "diameter of the circle of the centres of the balls in place of the " + bearing +
                     " rollers",
                 {.range_words = "above the ball's", .part = part, .in_fmu = InFmu::absent}),
          number(bearing + "_inner_groove_ratio", "",
                 FIELD((c.ratings.*kBearing)->balls->inner_groove_ratio), kNoUnit, {0.5, 1, true},
                 {0.52},
                 "radius of the inner ring's groove over the ball's diameter, in place of the " +
                     bearing + " rollers",
                 {.practice = "0.515..0.53", .part = part, .in_fmu = InFmu::absent}),
          number(bearing + "_outer_groove_ratio", "",
                 FIELD((c.ratings.*kBearing)->balls->outer_groove_ratio), kNoUnit, {0.5, 1, true},
                 {0.53},
                 "radius of the outer ring's groove over the ball's diameter, in place of the " +
                     bearing + " rollers",
                 {.practice = "0.52..0.54", .part = part, .in_fmu = InFmu::absent}),
          number(bearing + "_radial_clearance_um", "",
                 FIELD((c.ratings.*kBearing)->balls->radial_clearance), kMicrometres, kNotNegative,
                 {0.0},
                 "radial clearance in operation of the ball bearing in place of the " + bearing +
                     " rollers",
                 {.range_words = "below a tenth of the ball's diameter",
                  .part = part,
                  .in_fmu = InFmu::absent})};
}

// How radial and axial load count together. Of a contact angle a, Y = 0.4 cot a, e = 1.5 tan a and
// Y0 = 0.22 cot a (ISO 281, ISO 76): Y alone says the rest.
std::vector<Parameter> tapered_factors() {
  return {number("tapered_Y", "Y", FIELD(c.ratings.tapered->axial_factor), kNoUnit, kPositive,
                 kRequired, "axial load factor",
                 {.practice = "0.7..2.1", .part = &kTaperedRating, .in_fmu = InFmu::absent}),
          number("tapered_e", "e", FIELD(c.ratings.tapered->ratio_limit), kNoUnit, kPositive,
                 {.computed = [](const Case& c) -> std::optional<Value> {
                    if (has_balls(c)) return std::nullopt;
                    return 0.6 / c.ratings.tapered->axial_factor;
                  },
                  .words = "0.6 / `tapered_Y`; of balls required"},
                 "limit of Fa / Fr up to which the axial load is ignored (factor e)",
                 {.part = &kTaperedRating, .in_fmu = InFmu::absent}),
          number("tapered_X", "X", FIELD(c.ratings.tapered->radial_factor), kNoUnit, {0, 1},
                 {.computed = [](const Case& c) -> std::optional<Value> {
                    if (has_balls(c)) return std::nullopt;
                    return 0.4;
                  },
                  .words = "0.4; of balls required"},
                 "radial load factor above that limit",
                 {.part = &kTaperedRating, .in_fmu = InFmu::absent}),
          number("tapered_Y0", "Y0", FIELD(c.ratings.tapered->static_axial_factor), kNoUnit,
                 kNotNegative,
                 {.computed = [](const Case& c) -> std::optional<Value> {
                    if (has_balls(c)) return std::nullopt;
                    return 0.55 * c.ratings.tapered->axial_factor;
                  },
                  .words = "0.55 `tapered_Y`; of balls required"},
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
      .rules = {
          after("cylindrical_z_mm", same_bearings),
          at_end("tapered_balls", balls_refusal<&BearingRatings::tapered>),
          at_end("tapered_ball_pitch_diameter_mm", pitch_refusal<&BearingRatings::tapered>),
          at_end("tapered_radial_clearance_um", clearance_refusal<&BearingRatings::tapered>),
          at_end("cylindrical_balls", balls_refusal<&BearingRatings::cylindrical>),
          at_end("cylindrical_ball_pitch_diameter_mm", pitch_refusal<&BearingRatings::cylindrical>),
          at_end("cylindrical_radial_clearance_um",
                 clearance_refusal<&BearingRatings::cylindrical>)}};
  for (const auto& more :
       {rating_parameters<&BearingRatings::tapered>("tapered", &kTaperedRating), tapered_factors(),
        rating_parameters<&BearingRatings::cylindrical>("cylindrical", &kCylindricalRating),
        ball_parameters<&BearingRatings::tapered>("tapered"),
        ball_parameters<&BearingRatings::cylindrical>("cylindrical")})
    table.parameters.insert(table.parameters.end(), more.begin(), more.end());
  return table;
}

}  // namespace bentaxis::tables
