// [hydraulics]: oil, ports, leakage and delivery line.
#include <algorithm>
#include <cmath>
#include <functional>

#include "tables/entries.h"

namespace bentaxis::tables {
namespace {

// Overlap over which a kidney with rounded ends opens, where the case does not say, degrees.
constexpr double kKidneyRounding = 5;
// Largest growth of a bulk modulus with pressure: above that of any liquid.
constexpr double kSteepestModulus = 20;

const When kAirTakesTime{"hydraulics", "cavitation", {"rate"}};
const When kDissolvingAir{"hydraulics", "oil_law", {"dissolving_air"}};
const When kDowsonHigginson{"hydraulics", "oil_law", {"dowson_higginson"}};
const When kConstantDensity{"hydraulics", "oil_law", {"constant_density"}};

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

std::string stroke_refusal(const StrokeTable& table) {
  const auto& angles = table.theta_deg;
  const auto& values = table.value;
  if (angles.empty() && values.empty()) return "";
  constexpr std::size_t kFewest = 4;
  if (angles.size() < kFewest || angles.size() != values.size())
    return "must have at least 4 points";
  if (std::adjacent_find(angles.begin(), angles.end(), std::greater_equal<>()) != angles.end() ||
      !(angles.back() - angles.front() < 360))
    return "theta_deg must increase strictly and span less than 360 deg";
  const auto outside = [&](double value) {
    return !(std::abs(value) < kInfinity && (value > 0 || !table.is_volume));
  };
  if (std::any_of(values.begin(), values.end(), outside))
    return table.is_volume ? "volume_cm3 must be > 0" : "stroke_mm must be finite";
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  return *least < *greatest ? "" : "must have a stroke";
}

std::string law_refusal(const Case& c) {
  const HydraulicData& data = *c.hydraulics;
  const bool air_stays =
      data.oil_law == OilLaw::entrained_air || data.oil_law == OilLaw::dowson_higginson;
  return air_stays || data.cavitation == Cavitation::ignored
             ? ""
             : "must be \"entrained_air\" or \"dowson_higginson\" where cavitation is not "
               "\"ignored\"";
}

// Of a pressure that must be below those of suction port and case.
std::string not_below_both(const Case& c, double absolute, bool used) {
  const double least =
      c.hydraulics->atmosphere + std::min(c.pressure.ports.suction, c.hydraulics->case_pressure);
  return c.pressure.kind != PressureKind::hydraulic || !used || absolute < least
             ? ""
             : "must be < " + short_text(least / kPascalPerBar) +
                   ", the smaller absolute pressure of suction port and case";
}

std::string lowest_pressure_refusal(const Case& c) {
  const HydraulicData& data = *c.hydraulics;
  return not_below_both(c, data.lowest_pressure, data.oil_law == OilLaw::constant_density);
}

std::string boiling_refusal(const Case& c) {
  const HydraulicData& data = *c.hydraulics;
  return not_below_both(c, data.vapour_pressure, data.cavitation != Cavitation::ignored);
}

std::string vacuum_refusal(const Case& c) {
  if (c.pressure.kind != PressureKind::hydraulic) return "";  // present and unused
  return c.pressure.ports.suction > -c.hydraulics->atmosphere
             ? ""
             : "must exceed -suction_bar of [pressure]: an absolute pressure cannot be negative";
}

// The discharge coefficient of a port, where it has one of its own.
template <auto kPort>
const Part kDischarge = part_at([](auto& c) {
  return c.hydraulics ? &((*c.hydraulics).*kPort).discharge_coefficient : nullptr;
});

template <auto kPort>
Parameter discharge_parameter(const std::string& name) {
  return number(name + "_discharge_coefficient", "",
                FIELD((*c.hydraulics.*kPort).discharge_coefficient), kNoUnit, {0, 2, true},
                {.words = "`discharge_coefficient`"}, "of the openings of the " + name + " port",
                {.practice = "0.6..0.8",
                 .part = &kDischarge<kPort>,
                 .plausible = {0.3, 1, "edges have 0.6 to 0.7, a nozzle 1", {slips::kTenfold}}});
}

// What opens one port of [hydraulics]. `kPlateArc`: that of [port_plate].
template <auto kPort, auto kPlateArc>
std::vector<Parameter> port_parameters(const std::string& name) {
  return {number(name + "_arc_deg", "", ARC((*c.hydraulics.*kPort).arc), kDegrees, kAny,
                 {.computed = [](const Case& c) -> std::optional<Value> {
                    if (!c.pump.port_plate) return std::nullopt;
                    const PortArc& plate = *c.pump.port_plate.*kPlateArc;
                    return std::array{plate.from_deg, plate.to_deg};
                  },
                  .words = "that of `[port_plate]`"},
                 "edges of the " + name + " port",
                 {.range_words = "[from, to], from < to <= from + 360"}),
          number(name + "_notch_deg", "", FIELD((*c.hydraulics.*kPort).notch.length_deg), kDegrees,
                 {0, 90}, {0.0}, "length of the silencing notch that leads the " + name + " port",
                 {.practice = "5..20"}),
          number(name + "_notch_area_mm2", "", FIELD((*c.hydraulics.*kPort).notch.area),
                 kSquareMillimetres, kNotNegative, {0.0},
                 "area of the notch that leads the " + name +
                     " port at its root, where it meets the port",
                 {.practice = "some mm2"}),
          number(name + "_trailing_notch_deg", "",
                 FIELD((*c.hydraulics.*kPort).trailing_notch.length_deg), kDegrees, {0, 90}, {0.0},
                 "length of a notch behind the trailing edge of the " + name + " port"),
          number(name + "_trailing_notch_area_mm2", "",
                 FIELD((*c.hydraulics.*kPort).trailing_notch.area), kSquareMillimetres,
                 kNotNegative, {0.0},
                 "area of the notch behind the trailing edge of the " + name + " port at its root"),
          number(name + "_groove_deg", "", ARC((*c.hydraulics.*kPort).groove), kDegrees, kAny,
                 {std::array{0.0, 0.0}},
                 "where a relief groove that leads to the " + name + " port lies",
                 {.range_words = "[from, to], from < to"}),
          number(name + "_groove_width_mm", "", FIELD((*c.hydraulics.*kPort).groove.width),
                 kMillimetres, kNotNegative, {0.0},
                 "radial width of the relief groove of the " + name + " port"),
          number(name + "_groove_area_mm2", "", FIELD((*c.hydraulics.*kPort).groove.area),
                 kSquareMillimetres, kNotNegative, {0.0},
                 "cross-section of the relief groove of the " + name + " port; 0: no groove",
                 {.practice = "below 1 mm2"}),
          number(name + "_hole_deg", "", FIELD((*c.hydraulics.*kPort).holes[0].angle_deg), kDegrees,
                 kAny, {0.0}, "centre of a hole in the bridge that leads to the " + name + " port"),
          number(name + "_hole_diameter_mm", "", FIELD((*c.hydraulics.*kPort).holes[0].diameter),
                 kMillimetres, kNotNegative, {0.0},
                 "diameter of the hole that leads to the " + name + " port; 0: no hole",
                 {.practice = "1..3"}),
          number(name + "_hole_2_deg", "", FIELD((*c.hydraulics.*kPort).holes[1].angle_deg),
                 kDegrees, kAny, {0.0},
                 "centre of a second hole in the bridge that leads to the " + name + " port"),
          number(name + "_hole_2_diameter_mm", "", FIELD((*c.hydraulics.*kPort).holes[1].diameter),
                 kMillimetres, kNotNegative, {0.0},
                 "diameter of the second hole that leads to the " + name + " port; 0: no hole"),
          text(name + "_opening_file",
               curve_at(PLACE((*c.hydraulics.*kPort).table.file),
                        {.opening = [](Case& c) { return &(*c.hydraulics.*kPort).table; }}),
               "CSV `theta_deg,area_mm2`, path relative to the case file: the opening over the "
               "chamber's angle which replaces all other parts of the " +
                   name + " port; empty: none")};
}

// What the openings of a port must be to each other.
template <auto kPort>
std::vector<Rule> port_rules(const std::string& name) {
  return {at_end(name + "_groove_deg",
                 [](const Case& c) { return groove_refusal(*c.hydraulics.*kPort, *c.hydraulics); }),
          at_end(name + "_groove_width_mm",
                 [](const Case& c) { return groove_width_refusal(*c.hydraulics.*kPort); }),
          at_end(name + "_opening_file",
                 [](const Case& c) { return table_refusal((*c.hydraulics.*kPort).table); }),
          at_end(name + "_hole_diameter_mm",
                 [](const Case& c) { return hole_refusal((*c.hydraulics.*kPort).holes[0], c); }),
          at_end(name + "_hole_2_diameter_mm",
                 [](const Case& c) { return hole_refusal((*c.hydraulics.*kPort).holes[1], c); })};
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
          {{choice("oil_law", FIELD(c.hydraulics->oil_law),
                   {"entrained_air", "dissolving_air", "dowson_higginson", "constant_density"},
                   "entrained_air",
                   "how volume and density follow from the pressure: entrained_air (K, K', air "
                   "that stays), "
                   "dissolving_air (likewise, air dissolves up to `air_dissolved_bar`), "
                   "dowson_higginson (mineral oil, air that stays), constant_density (rho0 "
                   "everywhere, "
                   "K)"),
            number("density_kg_per_m3", "rho0", FIELD(c.hydraulics->density), {"kg/m3"},
                   {100, 5000}, {850.0}, "oil without air at P0",
                   {.practice = "mineral oil at 60 deg C: 840..870",
                    .plausible = {600,
                                  1300,
                                  "oils have 800 to 900, water 1000, esters 1200",
                                  {slips::kTenth, slips::kTenfold}}}),
            number("bulk_modulus_MPa", "K", FIELD(c.hydraulics->bulk_modulus), kMegapascals,
                   {10, 1e9}, {1400.0}, "oil without air, isentropic",
                   {.practice = "1200..1600",
                    .plausible = {400,
                                  3500,
                                  "oils have 1200 to 1800, water 2200",
                                  {{0.1, "in bar?"},
                                   {1e-6, "in pascals?"},
                                   {1e-3, "in kPa?"},
                                   {6.89476e-3, "in psi?"},
                                   slips::kTenfold}}}),
            number("air_percent", "x", FIELD(c.hydraulics->air_share), kPercent, {0, 50, true},
                   {0.5}, "volume fraction of entrained air at P0",
                   {.practice = "0.2..2",
                    .plausible = {0.02,
                                  15,
                                  "oil in a tank holds 0.2 to 2",
                                  {{100, "a share?"}, slips::kTenth}}}),
            number("air_exponent", "n", FIELD(c.hydraulics->air_exponent), kNoUnit, {1, 1.67},
                   {1.4}, "1 isothermal, 1.4 adiabatic",
                   {.practice = "milliseconds per rise: near 1.4"}),
            number("atmosphere_bar", "P0", FIELD(c.hydraulics->atmosphere), kBar, {0.1, 10},
                   {1.01325}, "absolute, where gauge pressure is 0",
                   {.range_words = "[0.1, 10], above -`suction_bar`",
                    .plausible =
                        {0.5,
                         1.2,
                         "1.013 at sea level, 0.54 at 5000 m; a charged tank is set by suction_bar",
                         {{10, "in MPa?"}}}}),
            number("bulk_modulus_slope", "K'", FIELD(c.hydraulics->bulk_modulus_slope), kNoUnit,
                   kAny, {0.0}, "increase of the oil's bulk modulus with pressure, K + K' (P - P0)",
                   {.range_here = [](const Case& c) -> std::optional<NumberRange> {
                      const HydraulicData& data = *c.hydraulics;
                      return NumberRange{
                          0, std::min(kSteepestModulus, 0.9 * data.bulk_modulus / data.atmosphere)};
                    },
                    .range_words = "[0, 20], at most 0.9 K/P0",
                    .practice = "mineral oil: 9..12"}),
            number("air_dissolved_bar", "P_c", FIELD(c.hydraulics->dissolved_pressure), kBar,
                   {0, 10000, true}, {30.0},
                   "gauge pressure from which on all entrained air is dissolved",
                   {.practice = "10..100", .active = kDissolvingAir}),
            number(
                "compressibility_per_GPa", "", FIELD(c.hydraulics->compressibility), kPerGigapascal,
                {0, 100, true}, {0.6},
                "a of rho = rho0 (1 + a p/(1 + b p)), p above P0: compressibility there, in place "
                "of 1/K",
                {.practice = "mineral oil: 0.6", .active = kDowsonHigginson}),
            number("compressibility_decrease_per_GPa", "",
                   FIELD(c.hydraulics->compressibility_decrease), kPerGigapascal, {0, 1000}, {1.7},
                   "b of the same law: how the compressibility decreases with pressure",
                   {.practice = "mineral oil: 1.7", .active = kDowsonHigginson}),
            number("lowest_pressure_bar", "P_min", FIELD(c.hydraulics->lowest_pressure), kBar,
                   {1e-8, 1}, {1e-4},
                   "absolute pressure below which none falls, however little oil is there",
                   {.range_words = "[1e-8, 1], below suction and case",
                    .practice = "regularisation",
                    .active = kConstantDensity}),
            choice("cavitation", FIELD(c.hydraulics->cavitation),
                   {"ignored", "equilibrium", "rate"}, "ignored",
                   "ignored: entrained air only; equilibrium: dissolved air is released by Henry's "
                   "law, and bubbles hold vapour; rate: likewise, with time constants"),
            number("air_release_ms", "tau_r", FIELD(c.hydraulics->release_time), kMilliseconds,
                   {1e-3, 1e9}, {10.0}, "time constant of the release of dissolved air",
                   {.practice = "some milliseconds where the oil is stirred, to seconds",
                    .active = kAirTakesTime}),
            number("air_dissolution_ms", "tau_d", FIELD(c.hydraulics->dissolution_time),
                   kMilliseconds, {1e-3, 1e9}, {100.0}, "time constant of its dissolution",
                   {.practice = "some 10 times longer", .active = kAirTakesTime}),
            number("dissolved_air_percent", "y", FIELD(c.hydraulics->dissolved_air), kPercent,
                   {0, 100}, {9.0}, "volume at P0 of the air dissolved at saturation, of the oil's",
                   {.practice = "mineral oil at 1 bar: 7..9 (Bunsen)"}),
            number(
                "vapour_bar", "Pv", FIELD(c.hydraulics->vapour_pressure), kBar, kAny, {0.001},
                "absolute vapour pressure of the oil",
                {.range_here = [](const Case& c) -> std::optional<NumberRange> {
                   return NumberRange{0, in_file_unit(c.hydraulics->atmosphere, kBar), false, true};
                 },
                 .range_words = "[0, `atmosphere_bar`), below suction and case",
                 .practice = "mineral oil at 60 deg C: below 0.001"}),
            number("saturation_bar", "Ps", FIELD(c.hydraulics->saturation_pressure), kBar, kAny,
                   {0.0},
                   "gauge pressure below which dissolved air is released: that at which the oil "
                   "was saturated with air",
                   {.range_here = [](const Case& c) -> std::optional<NumberRange> {
                      const HydraulicData& data = *c.hydraulics;
                      return NumberRange{in_file_unit(data.vapour_pressure - data.atmosphere, kBar),
                                         10000, true};
                    },
                    .range_words = "above vapour pressure",
                    .practice = "open tank: 0"})},
           port_parameters<&HydraulicData::delivery, &PortPlate::delivery>("delivery"),
           port_parameters<&HydraulicData::suction, &PortPlate::suction>("suction"),
           {number("kidney_width_deg", "w_k", FIELD(c.hydraulics->kidney_width_deg), kDegrees,
                   {0, 180, true}, kRequired, "of a block kidney, seen from the block axis",
                   {.range_words = "(0, 180], with arc and notches of a port at most 360"}),
            number("kidney_height_mm", "", FIELD(c.hydraulics->kidney_height), kMillimetres,
                   kPositive,
                   {.computed = [](const Case& c) -> std::optional<Value> {
                      const auto& plate = c.pump.port_plate;
                      if (!plate) return std::nullopt;
                      return (plate->r3 - plate->r2) * 1e3;
                    },
                    .words = "r3 - r2 of `[port_plate]`"},
                   "of a block kidney, radial, on the bore circle",
                   {.practice = "area about bore area less `bottom_area_mm2`"}),
            choice("kidney_ends", FIELD(c.hydraulics->kidney_ends), {"rounded", "circular"},
                   "rounded",
                   "rounded: the opening grows as the square over `kidney_rounding_deg`; circular: "
                   "semicircles on kidney and port, `kidney_height_mm` wide, their common area"),
            number(
                "kidney_rounding_deg", "", FIELD(c.hydraulics->kidney_rounding_deg), kDegrees,
                kNotNegative,
                {.computed = [](const Case& c) -> std::optional<Value> {
                   return std::min(kKidneyRounding, c.hydraulics->kidney_width_deg);
                 },
                 .words = "5, at most the width"},
                "overlap over which the opening of rounded ends grows as its square; 0: straight",
                {.range_here = [](const Case& c) -> std::optional<NumberRange> {
                   return NumberRange{0, c.hydraulics->kidney_width_deg};
                 },
                 .range_words = "[0, `kidney_width_deg`]",
                 .practice = "about half the height, as an angle"}),
            choice(
                "notch_law", FIELD(c.hydraulics->notch_law), {"quadratic", "linear"}, "quadratic",
                "how a notch opens with the length passed: V groove, or groove of constant depth"),
            number("discharge_coefficient", "Cd", FIELD(c.hydraulics->discharge_coefficient),
                   kNoUnit, {0, 2, true}, {0.67}, "of every opening",
                   {.practice = "0.6..0.7",
                    .plausible = {0.3, 1, "edges have 0.6 to 0.7, a nozzle 1", {slips::kTenfold}}}),
            discharge_parameter<&HydraulicData::delivery>("delivery"),
            discharge_parameter<&HydraulicData::suction>("suction"),
            number("transition_pressure_bar", "p_cr", FIELD(c.hydraulics->transition_pressure),
                   kBar, kPositive, {0.1},
                   "below it the orifice flow is about linear in the pressure difference",
                   {.practice = "regularisation"}),
            number("leakage_l_per_min_per_bar", "G", FIELD(c.hydraulics->leakage), kLeakage,
                   kNotNegative, {0.002}, "of each chamber to the case, laminar",
                   {.practice = "gives a volumetric efficiency of 94..97 % at 275 bar"}),
            number("case_bar", "", FIELD(c.hydraulics->case_pressure), kBar, kAny, {0.0},
                   "case pressure, gauge",
                   {.range_here = [](const Case& c) -> std::optional<NumberRange> {
                      return NumberRange{-in_file_unit(c.hydraulics->atmosphere, kBar), kInfinity,
                                         true};
                    },
                    .range_words = "above -`atmosphere_bar`",
                    .plausible = {-1.014,
                                  20,
                                  "shaft seals bear a few bar",
                                  {slips::kPascals, slips::kKilopascals, slips::kTenth}}}),
            number("dead_volume_cm3", "V0", FIELD(c.hydraulics->dead_volume), kCubicCentimetres,
                   kPositive, {3.0},
                   "smallest volume of a chamber; unused where `stroke_file` has volumes",
                   {.practice = "about a quarter of the stroke's 12.7 cm3"}),
            text("stroke_file",
                 curve_at(PLACE(c.hydraulics->stroke.file),
                          {.stroke = [](Case& c) { return &c.hydraulics->stroke; }}),
                 "CSV `theta_deg,stroke_mm` or `theta_deg,volume_cm3`, path relative to the case "
                 "file: how far a piston is out of its bore, from any zero, or the volume of a "
                 "chamber, over the chamber's angle. The oil's chambers follow it in place of the "
                 "pump's geometry; the forces do not. Empty: none"),
            number("delivery_volume_l", "", FIELD(c.hydraulics->delivery_volume), kLitres,
                   kPositive, {0.5}, "between pump and load, or delivery line"),
            number("tolerance", "", FIELD(c.hydraulics->tolerance), kNoUnit, {1e-12, 1e-4}, {1e-10},
                   "initial relative tolerance of the pressure per step of the time integration"),
            number("curve_error", "", FIELD(c.hydraulics->curve_error), kNoUnit, {1e-9, 1e-2},
                   {1e-7},
                   "largest error of the pressure curve, relative to its peak: `tolerance` is "
                   "tightened until the estimate of it is smaller",
                   {.in_fmu = InFmu::absent})}}),
      .rules = joined<Rule>(
          {port_rules<&HydraulicData::delivery>("delivery"),
           port_rules<&HydraulicData::suction>("suction"),
           {after("delivery_arc_deg",
                  [](const Case& c) { return arc_refusal(c.hydraulics->delivery.arc); }),
            after("suction_arc_deg",
                  [](const Case& c) { return arc_refusal(c.hydraulics->suction.arc); }),
            after("kidney_width_deg", kidney_refusal), at_end("kidney_ends", ends_refusal),
            at_end("oil_law", law_refusal),
            at_end("stroke_file",
                   [](const Case& c) { return stroke_refusal(c.hydraulics->stroke); }),
            at_end("lowest_pressure_bar", lowest_pressure_refusal),
            at_end("atmosphere_bar", vacuum_refusal), at_end("vapour_bar", boiling_refusal)}})};
}

}  // namespace bentaxis::tables
