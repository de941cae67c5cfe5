// [hydraulics]: oil, ports, leakage and delivery line.
#include <algorithm>
#include <functional>

#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

// Overlap over which a kidney with rounded ends opens, where the case does not say, degrees.
constexpr double kKidneyRounding = 5;
// Largest growth of a bulk modulus with pressure: above that of any liquid.
constexpr double kSteepestModulus = 20;

const When kAirTakesTime{"hydraulics", "cavitation", {"rate"}};

const Part kHydraulicData = [] {
  Part part = part_at([](auto& c) { return &c.hydraulics; }, kHydraulic);
  part.remove = [](Case& c) { c.hydraulics.reset(); };
  return part;
}();

std::string kidney_refusal(const Case& c) {
  const HydraulicData& data = *c.hydraulics;
  const auto too_long = [&](const PlatePort& port) {
    return port.arc.to_deg - port.arc.from_deg + port.notch.length_deg +
               port.trailing_notch.length_deg + data.kidney_width_deg >
           360;
  };
  for (const bool delivery : {true, false})
    if (too_long(delivery ? data.delivery : data.suction))
      return std::string("with the ") + (delivery ? "delivery" : "suction") +
             " port's arc and notches must not exceed 360 deg";
  return "";
}

// Degrees on the bore circle.
double degrees_of(double length, const Case& c) {
  return length / c.pump.geometry.bore_circle_radius / kRadPerDegree;
}

std::string ends_refusal(const Case& c) {
  const HydraulicData& data = *c.hydraulics;
  if (data.kidney_ends != KidneyEnds::circular) return "";
  const double least = degrees_of(data.kidney_height, c);
  for (const PortArc& arc :
       {data.delivery.arc, data.suction.arc, PortArc{0, data.kidney_width_deg}})
    if (arc.to_deg - arc.from_deg < least)
      return "kidney_width_deg and the ports' arcs must then be at least " + short_text(least) +
             " deg, which is kidney_height_mm on the bore circle";
  return "";
}

std::string groove_refusal(const PlatePort& port, const HydraulicData& data) {
  const ReliefGroove& groove = port.groove;
  if (groove.area == 0) return "";
  if (!(groove.from_deg < groove.to_deg) ||
      groove.to_deg - groove.from_deg + data.kidney_width_deg > 360)
    return "must be [from, to] with from < to, with kidney_width_deg at most 360 deg";
  return "";
}

std::string groove_width_refusal(const PlatePort& port) {
  return port.groove.area > 0 && port.groove.width == 0 ? "must be > 0 where there is a groove"
                                                        : "";
}

std::string hole_refusal(const PlateHole& hole, const Case& c) {
  const HydraulicData& data = *c.hydraulics;
  const double wide = radians(data.kidney_width_deg) * c.pump.geometry.bore_circle_radius;
  const double most = std::min(data.kidney_height, wide);
  return hole.diameter <= most
             ? ""
             : "must be <= " + short_text(most * 1e3) + ", the smaller side of a kidney";
}

std::string table_refusal(const OpeningTable& table) {
  const auto& angles = table.theta_deg;
  const auto& areas = table.area;
  if (angles.empty() && areas.empty()) return "";
  const auto outside = [](double area) { return !(area >= 0 && area < kInfinity); };
  if (angles.size() < 3 || angles.size() != areas.size()) return "must have at least 3 points";
  if (std::adjacent_find(angles.begin(), angles.end(), std::greater_equal<>()) != angles.end() ||
      !(angles.back() - angles.front() < 360))
    return "theta_deg must increase strictly and span less than 360 deg";
  if (std::any_of(areas.begin(), areas.end(), outside) ||
      *std::max_element(areas.begin(), areas.end()) == 0)
    return "area_mm2 must be >= 0, and > 0 somewhere";
  return "";
}

std::string boiling_refusal(const Case& c) {
  const HydraulicData& data = *c.hydraulics;
  if (c.pressure.kind != PressureKind::hydraulic || data.cavitation == Cavitation::ignored)
    return "";
  const double least = data.atmosphere + std::min(c.pressure.ports.suction, data.case_pressure);
  return data.vapour_pressure < least
             ? ""
             : "must be < " + short_text(least / kPascalPerBar) +
                   ", the smaller absolute pressure of suction port and case";
}

std::string vacuum_refusal(const Case& c) {
  if (c.pressure.kind != PressureKind::hydraulic) return "";  // present and unused
  return c.pressure.ports.suction > -c.hydraulics->atmosphere
             ? ""
             : "must exceed -suction_bar of [pressure]: no absolute pressure is below zero";
}

// What opens one port of [hydraulics]. `kPlateArc`: that of [port_plate].
template <auto kPort, auto kPlateArc>
std::vector<Parameter> port_parameters(const std::string& name) {
  return {
      {.key = name + "_arc_deg",
       .field = ARC((*c.hydraulics.*kPort).arc),
       .unit = kDegrees,
       .range_words = "[from, to], from < to <= from + 360",
       .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                      if (!c.pump.port_plate) return std::nullopt;
                      const PortArc& plate = *c.pump.port_plate.*kPlateArc;
                      return std::array{plate.from_deg, plate.to_deg};
                    },
                    .words = "that of `[port_plate]`"},
       .meaning = "edges of the " + name + " port"},
      {.key = name + "_notch_deg",
       .field = FIELD((*c.hydraulics.*kPort).notch.length_deg),
       .unit = kDegrees,
       .range = {0, 90},
       .fallback = {0.0},
       .meaning = "length of the silencing notch that leads the " + name + " port",
       .practice = "5..20"},
      {.key = name + "_notch_area_mm2",
       .field = FIELD((*c.hydraulics.*kPort).notch.area),
       .unit = kSquareMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "area of the notch that leads the " + name +
                  " port at its root, where it meets the port",
       .practice = "some mm2"},
      {.key = name + "_trailing_notch_deg",
       .field = FIELD((*c.hydraulics.*kPort).trailing_notch.length_deg),
       .unit = kDegrees,
       .range = {0, 90},
       .fallback = {0.0},
       .meaning = "length of a notch behind the trailing edge of the " + name + " port"},
      {.key = name + "_trailing_notch_area_mm2",
       .field = FIELD((*c.hydraulics.*kPort).trailing_notch.area),
       .unit = kSquareMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning =
           "area of the notch behind the trailing edge of the " + name + " port at its root"},
      {.key = name + "_groove_deg",
       .field = ARC((*c.hydraulics.*kPort).groove),
       .unit = kDegrees,
       .range_words = "[from, to], from < to",
       .fallback = {std::array{0.0, 0.0}},
       .meaning = "where a relief groove that leads to the " + name + " port lies"},
      {.key = name + "_groove_width_mm",
       .field = FIELD((*c.hydraulics.*kPort).groove.width),
       .unit = kMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "radial width of the relief groove of the " + name + " port"},
      {.key = name + "_groove_area_mm2",
       .field = FIELD((*c.hydraulics.*kPort).groove.area),
       .unit = kSquareMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "cross-section of the relief groove of the " + name + " port; 0: no groove",
       .practice = "below 1 mm2"},
      {.key = name + "_hole_deg",
       .field = FIELD((*c.hydraulics.*kPort).holes[0].angle_deg),
       .unit = kDegrees,
       .fallback = {0.0},
       .meaning = "centre of a hole in the bridge that leads to the " + name + " port"},
      {.key = name + "_hole_diameter_mm",
       .field = FIELD((*c.hydraulics.*kPort).holes[0].diameter),
       .unit = kMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "diameter of the hole that leads to the " + name + " port; 0: no hole",
       .practice = "1..3"},
      {.key = name + "_hole_2_deg",
       .field = FIELD((*c.hydraulics.*kPort).holes[1].angle_deg),
       .unit = kDegrees,
       .fallback = {0.0},
       .meaning = "centre of a second hole in the bridge that leads to the " + name + " port"},
      {.key = name + "_hole_2_diameter_mm",
       .field = FIELD((*c.hydraulics.*kPort).holes[1].diameter),
       .unit = kMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "diameter of the second hole that leads to the " + name + " port; 0: no hole"},
      {.key = name + "_opening_file",
       .field = curve_at(PLACE((*c.hydraulics.*kPort).table.file),
                         {.opening = [](Case& c) { return &(*c.hydraulics.*kPort).table; }}),
       .fallback = {std::string()},
       .meaning = "CSV `theta_deg,area_mm2`, path relative to the case file: the opening over "
                  "the chamber's angle in place of all other parts of the " +
                  name + " port; empty: none"}};
}

// What the openings of a port must be to each other.
template <auto kPort>
std::vector<Rule> port_rules(const std::string& name) {
  return {
      {.key = name + "_groove_deg",
       .after = "",
       .broken = [](const Case& c) { return groove_refusal(*c.hydraulics.*kPort, *c.hydraulics); }},
      {.key = name + "_groove_width_mm",
       .after = "",
       .broken = [](const Case& c) { return groove_width_refusal(*c.hydraulics.*kPort); }},
      {.key = name + "_opening_file",
       .after = "",
       .broken = [](const Case& c) { return table_refusal((*c.hydraulics.*kPort).table); }},
      {.key = name + "_hole_diameter_mm",
       .after = "",
       .broken = [](const Case& c) { return hole_refusal((*c.hydraulics.*kPort).holes[0], c); }},
      {.key = name + "_hole_2_diameter_mm", .after = "", .broken = [](const Case& c) {
         return hole_refusal((*c.hydraulics.*kPort).holes[1], c);
       }}};
}

template <class Entry>
std::vector<Entry> joined(std::vector<std::vector<Entry>> lists) {
  std::vector<Entry> all;
  for (auto& list : lists)
    for (Entry& entry : list) all.push_back(std::move(entry));
  return all;
}

}  // namespace

Table hydraulics_table() {
  return {
      .name = "hydraulics",
      .meaning = "oil, ports, leakage and delivery line",
      .part = &kHydraulicData,
      .parameters = joined<Parameter>(
          {{{.key = "density_kg_per_m3",
             .field = FIELD(c.hydraulics->density),
             .symbol = "rho0",
             .unit = {"kg/m3"},
             .range = {100, 5000},
             .fallback = {850.0},
             .meaning = "oil without air at P0",
             .practice = "mineral oil at 60 deg C: 840..870",
             .plausible = {.low = 600,
                           .high = 1300,
                           .why = "oils have 800 to 900, water 1000, esters 1200",
                           .slips = {slips::kTenth, slips::kTenfold}}},
            {.key = "bulk_modulus_MPa",
             .field = FIELD(c.hydraulics->bulk_modulus),
             .symbol = "K",
             .unit = kMegapascals,
             .range = {10, 1e9},
             .fallback = {1400.0},
             .meaning = "oil without air, isentropic",
             .practice = "1200..1600",
             .plausible = {.low = 400,
                           .high = 3500,
                           .why = "oils have 1200 to 1800, water 2200",
                           .slips = {{0.1, "in bar?"},
                                     {1e-6, "in pascals?"},
                                     {1e-3, "in kPa?"},
                                     {6.89476e-3, "in psi?"},
                                     slips::kTenfold}}},
            {.key = "air_percent",
             .field = FIELD(c.hydraulics->air_share),
             .symbol = "x",
             .unit = kPercent,
             .range = {0, 50, true},
             .fallback = {0.5},
             .meaning = "entrained air by volume at P0",
             .practice = "0.2..2",
             .plausible = {.low = 0.02,
                           .high = 15,
                           .why = "oil in a tank holds 0.2 to 2",
                           .slips = {{100, "a share?"}, slips::kTenth}}},
            {.key = "air_exponent",
             .field = FIELD(c.hydraulics->air_exponent),
             .symbol = "n",
             .range = {1, 1.67},
             .fallback = {1.4},
             .meaning = "1 isothermal, 1.4 adiabatic",
             .practice = "milliseconds per rise: near 1.4"},
            {.key = "atmosphere_bar",
             .field = FIELD(c.hydraulics->atmosphere),
             .symbol = "P0",
             .unit = kBar,
             .range = {0.1, 10},
             .range_words = "[0.1, 10], above -`suction_bar`",
             .fallback = {1.01325},
             .meaning = "absolute, where gauge pressure is 0",
             .plausible = {.low = 0.5,
                           .high = 1.2,
                           .why = "it is 1.013 at the sea and 0.54 at 5000 m; a charged tank "
                                  "is suction_bar",
                           .slips = {{10, "in MPa?"}}}},
            {.key = "bulk_modulus_slope",
             .field = FIELD(c.hydraulics->bulk_modulus_slope),
             .symbol = "K'",
             .range_here = [](const Case& c) -> std::optional<NumberRange> {
               const HydraulicData& data = *c.hydraulics;
               return NumberRange{
                   0, std::min(kSteepestModulus, 0.9 * data.bulk_modulus / data.atmosphere)};
             },
             .range_words = "[0, 20], at most 0.9 K/P0",
             .fallback = {0.0},
             .meaning = "growth of the oil's bulk modulus with pressure, K + K' (P - P0)",
             .practice = "mineral oil: 9..12"},
            {.key = "cavitation",
             .field = FIELD(c.hydraulics->cavitation),
             .words = {"ignored", "equilibrium", "rate"},
             .fallback = {std::string("ignored")},
             .meaning = "ignored: entrained air only; equilibrium: dissolved air comes out by "
                        "Henry's law, and bubbles hold vapour; rate: likewise, but it takes "
                        "time"},
            {.key = "air_release_ms",
             .field = FIELD(c.hydraulics->release_time),
             .symbol = "tau_r",
             .unit = kMilliseconds,
             .range = {1e-3, 1e9},
             .fallback = {10.0},
             .meaning = "time constant with which dissolved air comes out",
             .practice = "some milliseconds where the oil is stirred, to seconds",
             .active = kAirTakesTime},
            {.key = "air_dissolution_ms",
             .field = FIELD(c.hydraulics->dissolution_time),
             .symbol = "tau_d",
             .unit = kMilliseconds,
             .range = {1e-3, 1e9},
             .fallback = {100.0},
             .meaning = "time constant with which it dissolves again",
             .practice = "some 10 times longer",
             .active = kAirTakesTime},
            {.key = "dissolved_air_percent",
             .field = FIELD(c.hydraulics->dissolved_air),
             .symbol = "y",
             .unit = kPercent,
             .range = {0, 100},
             .fallback = {9.0},
             .meaning = "volume at P0 of the air dissolved at saturation, of the oil's",
             .practice = "mineral oil at 1 bar: 7..9 (Bunsen)"},
            {.key = "vapour_bar",
             .field = FIELD(c.hydraulics->vapour_pressure),
             .symbol = "Pv",
             .unit = kBar,
             .range_here = [](const Case& c) -> std::optional<NumberRange> {
               return NumberRange{0, in_file_unit(c.hydraulics->atmosphere, kBar), false, true};
             },
             .range_words = "[0, `atmosphere_bar`), below suction and case",
             .fallback = {0.001},
             .meaning = "absolute vapour pressure of the oil",
             .practice = "mineral oil at 60 deg C: below 0.001"},
            {.key = "saturation_bar",
             .field = FIELD(c.hydraulics->saturation_pressure),
             .symbol = "Ps",
             .unit = kBar,
             .range_here = [](const Case& c) -> std::optional<NumberRange> {
               const HydraulicData& data = *c.hydraulics;
               return NumberRange{in_file_unit(data.vapour_pressure - data.atmosphere, kBar), 10000,
                                  true};
             },
             .range_words = "above vapour pressure",
             .fallback = {0.0},
             .meaning = "gauge pressure below which dissolved air comes out: that at which the oil "
                        "lay with air",
             .practice = "open tank: 0"}},
           port_parameters<&HydraulicData::delivery, &PortPlate::delivery>("delivery"),
           port_parameters<&HydraulicData::suction, &PortPlate::suction>("suction"),
           {{.key = "kidney_width_deg",
             .field = FIELD(c.hydraulics->kidney_width_deg),
             .symbol = "w",
             .unit = kDegrees,
             .range = {0, 180, true},
             .range_words = "(0, 180], with arc and notches of a port at most 360",
             .meaning = "of a block kidney, seen from the block axis"},
            {.key = "kidney_height_mm",
             .field = FIELD(c.hydraulics->kidney_height),
             .unit = kMillimetres,
             .range = kPositive,
             .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                            const auto& plate = c.pump.port_plate;
                            if (!plate) return std::nullopt;
                            return (plate->r3 - plate->r2) * 1e3;
                          },
                          .words = "r3 - r2 of `[port_plate]`"},
             .meaning = "of a block kidney, radial, on the bore circle",
             .practice = "area about bore area less `bottom_area_mm2`"},
            {.key = "kidney_ends",
             .field = FIELD(c.hydraulics->kidney_ends),
             .words = {"rounded", "circular"},
             .fallback = {std::string("rounded")},
             .meaning = "rounded: the opening grows as the square over `kidney_rounding_deg`; "
                        "circular: semicircles on kidney and port, `kidney_height_mm` wide, their "
                        "common area"},
            {.key = "kidney_rounding_deg",
             .field = FIELD(c.hydraulics->kidney_rounding_deg),
             .unit = kDegrees,
             .range = kNotNegative,
             .range_here = [](const Case& c) -> std::optional<NumberRange> {
               return NumberRange{0, c.hydraulics->kidney_width_deg};
             },
             .range_words = "[0, `kidney_width_deg`]",
             .fallback = {.computed = [](const Case& c) -> std::optional<Value> {
                            return std::min(kKidneyRounding, c.hydraulics->kidney_width_deg);
                          },
                          .words = "5, at most the width"},
             .meaning = "overlap over which the opening of rounded ends grows as its square; 0: "
                        "straight",
             .practice = "about half the height, as an angle"},
            {.key = "notch_law",
             .field = FIELD(c.hydraulics->notch_law),
             .words = {"quadratic", "linear"},
             .fallback = {std::string("quadratic")},
             .meaning = "how a notch opens with the length passed: V groove, or groove of constant "
                        "depth"},
            {.key = "discharge_coefficient",
             .field = FIELD(c.hydraulics->discharge_coefficient),
             .symbol = "Cd",
             .range = {0, 2, true},
             .fallback = {0.67},
             .meaning = "of every opening",
             .practice = "0.6..0.7",
             .plausible = {.low = 0.3,
                           .high = 1,
                           .why = "edges have 0.6 to 0.7, a nozzle 1",
                           .slips = {slips::kTenfold}}},
            {.key = "transition_pressure_bar",
             .field = FIELD(c.hydraulics->transition_pressure),
             .symbol = "p_cr",
             .unit = kBar,
             .range = kPositive,
             .fallback = {0.1},
             .meaning = "below it the orifices are about linear",
             .practice = "regularisation"},
            {.key = "leakage_l_per_min_per_bar",
             .field = FIELD(c.hydraulics->leakage),
             .symbol = "G",
             .unit = kLeakage,
             .range = kNotNegative,
             .fallback = {0.002},
             .meaning = "of each chamber to the case, laminar",
             .practice = "gives a volumetric efficiency of 94..97 % at 275 bar"},
            {.key = "case_bar",
             .field = FIELD(c.hydraulics->case_pressure),
             .unit = kBar,
             .range_here = [](const Case& c) -> std::optional<NumberRange> {
               return NumberRange{-in_file_unit(c.hydraulics->atmosphere, kBar), kInfinity, true};
             },
             .range_words = "above -`atmosphere_bar`",
             .fallback = {0.0},
             .meaning = "case pressure, gauge",
             .plausible = {.low = -1.014,
                           .high = 20,
                           .why = "shaft seals bear a few bar",
                           .slips = {slips::kPascals, slips::kKilopascals, slips::kTenth}}},
            {.key = "dead_volume_cm3",
             .field = FIELD(c.hydraulics->dead_volume),
             .symbol = "V0",
             .unit = kCubicCentimetres,
             .range = kPositive,
             .fallback = {3.0},
             .meaning = "smallest volume of a chamber",
             .practice = "about a quarter of the stroke's 12.7 cm3"},
            {.key = "delivery_volume_l",
             .field = FIELD(c.hydraulics->delivery_volume),
             .unit = kLitres,
             .range = kPositive,
             .fallback = {0.5},
             .meaning = "between pump and load, or delivery line"},
            {.key = "tolerance",
             .field = FIELD(c.hydraulics->tolerance),
             .range = {1e-12, 1e-4},
             .fallback = {1e-10},
             .meaning = "relative error of pressure per step of the time integration at first"},
            {.key = "curve_error",
             .field = FIELD(c.hydraulics->curve_error),
             .range = {1e-9, 1e-2},
             .fallback = {1e-7},
             .meaning =
                 "largest error of the curve that the models get, of its peak: `tolerance` is "
                 "tightened until the estimate of it is smaller",
             .in_fmu = InFmu::absent}}}),
      .rules = joined<Rule>(
          {port_rules<&HydraulicData::delivery>("delivery"),
           port_rules<&HydraulicData::suction>("suction"),
           {{.key = "delivery_arc_deg",
             .after = "delivery_arc_deg",
             .broken = [](const Case& c) { return arc_refusal(c.hydraulics->delivery.arc); }},
            {.key = "suction_arc_deg",
             .after = "suction_arc_deg",
             .broken = [](const Case& c) { return arc_refusal(c.hydraulics->suction.arc); }},
            {.key = "kidney_width_deg", .after = "kidney_width_deg", .broken = kidney_refusal},
            {.key = "kidney_ends", .after = "", .broken = ends_refusal},
            {.key = "atmosphere_bar", .after = "", .broken = vacuum_refusal},
            {.key = "vapour_bar", .after = "", .broken = boiling_refusal}}})};
}

}  // namespace bentaxis::tables
