// The parameters of this program. One entry each; what is made from them: registry.h.
#include <algorithm>
#include <functional>
#include <limits>

#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/units.h"

namespace bentaxis {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostSamples = std::numeric_limits<int>::max();
constexpr NumberRange kCount{1, kMostSamples};

// Overlap over which a kidney with rounded ends opens, where the case does not say, degrees.
constexpr double kKidneyRounding = 5;
// Largest growth of a bulk modulus with pressure: above that of any liquid.
constexpr double kSteepestModulus = 20;

// ---- Units: the conversions that results hold to the last bit -----------------------------------

constexpr Unit kMillimetres{"mm", metres};
constexpr Unit kSquareMillimetres{"mm2", square_metres};
constexpr Unit kAngle{"deg", radians};            // kept in rad
constexpr Unit kDegrees{"deg"};                   // kept in degrees, where edges are exact
constexpr Unit kRotation{"rpm", rad_per_second};  // kept in rad/s
constexpr Unit kSpeed{"rpm"};                     // kept in rpm
constexpr Unit kBar{"bar", pascals};
constexpr Unit kKilograms{"kg"};
constexpr Unit kInertia{"kg mm2", square_metres};
constexpr Unit kNewtons{"N"};
constexpr Unit kKilonewtons{"kN", [](double x) { return x * 1e3; }};
constexpr Unit kTorquePerSpeed{"Nm/rpm", [](double x) { return x / kRadPerSecondPerRpm; }};
constexpr Unit kMegapascals{"MPa", [](double x) { return x * 1e6; }};
constexpr Unit kMilliseconds{"ms", [](double x) { return x / 1000; }};
constexpr Unit kPercent{"percent", [](double x) { return x / 100; }};
constexpr Unit kCubicCentimetres{"cm3", [](double x) { return x / 1e6; }};
constexpr Unit kGigapascal{"GPa", [](double x) { return x * 1e9; }};
constexpr Unit kMicrometres{"um", [](double x) { return x / 1e6; }};
constexpr Unit kStiffness{"N/um", [](double x) { return x * 1e6; }};
constexpr Unit kMetres{"m"};
constexpr Unit kCentistokes{"cSt", [](double x) { return x / 1e6; }};
constexpr Unit kPerGigapascal{"per GPa", [](double x) { return x / 1e9; }};
constexpr Unit kLitresPerMinute{"l/min", [](double x) { return x / 6e4; }};
constexpr Unit kAreaPerPressure{"mm2/bar", [](double x) { return x / 1e6 / kPascalPerBar; }};
constexpr Unit kLitres{"l", [](double x) { return x / 1e3; }};
// 1 l/min = 1e-3/60 m3/s
constexpr Unit kLeakage{"l/min/bar", [](double x) { return x / 6e4 / kPascalPerBar; }};

// ---- Conditions and parts
// ------------------------------------------------------------------------

const When kIdeal{"pressure", "kind", {"ideal"}};
const When kCurve{"pressure", "kind", {"curve"}};
const When kHydraulic{"pressure", "kind", {"hydraulic"}};
const When kAirTakesTime{"hydraulics", "cavitation", {"rate"}};
const When kReliefValve{"load", "kind", {"relief_valve"}};
const When kGivenFlow{"load", "kind", {"flow"}};
const When kOrifice{"load", "kind", {"orifice"}};
const When kLaminar{"load", "kind", {"laminar"}};
const When kBesideRelief{"load", "kind", {"orifice", "laminar", "flow"}};
const When kAnyRelief{"load", "kind", {"relief_valve", "orifice", "laminar", "flow"}};
const When kSizedLoad = kAnyRelief;
const When kCompliant{"gear", "contact", {"compliant"}};
const When kTeeth{"gear", "contact", {"teeth"}};
const When kGivingWay{"gear", "contact", {"compliant", "teeth"}};
const When kMotor{"drive", "kind", {"motor"}};
const When kGivenTorque{"drive", "kind", {"torque", "motor"}};

const Part kRealPiston{{"piston", "inertia", {"real", "dynamically_equivalent"}},
                       [](const ConstView& v) { return v.real_piston() != nullptr; },
                       [](const View& v) { v.pump->piston.real = PistonMass::Real(); }};
const Part kTaperedRating{{},
                          [](const ConstView& v) { return v.tapered_rating() != nullptr; },
                          [](const View& v) {
                            if (v.ratings != nullptr) v.ratings->tapered.emplace();
                          }};
const Part kCylindricalRating{{},
                              [](const ConstView& v) { return v.cylindrical_rating() != nullptr; },
                              [](const View& v) {
                                if (v.ratings != nullptr) v.ratings->cylindrical.emplace();
                              }};
// A single key without which something else is meant.
const Part kRingContact{{},
                        [](const ConstView& v) { return v.ring_contact() != nullptr; },
                        [](const View& v) { v.pump->piston.contact.emplace(); }};
const Part kStartSpeed{{},
                       [](const ConstView& v) { return v.start_speed() != nullptr; },
                       [](const View& v) { v.drive_spec()->start_speed.emplace(); }};
const Part kCompliance{kCompliant, [](const ConstView& v) { return v.compliance() != nullptr; },
                       [](const View& v) { v.pump->gear.compliance.emplace(); }};
// Teeth that give way, of either kind; the keys that both have come after those that make one.
const Part kGiving{kGivingWay,
                   [](const ConstView& v) {
                     return v.pump->gear.contact == ToothContact::teeth ? v.teeth() != nullptr
                                                                        : v.compliance() != nullptr;
                   },
                   [](const View& v) {
                     if (v.pump->gear.contact == ToothContact::teeth) v.pump->gear.teeth.emplace();
                   }};
const Part kToothData{kTeeth, [](const ConstView& v) { return v.teeth() != nullptr; },
                      [](const View& v) { v.pump->gear.teeth.emplace(); }};
const Part kDrive{{},
                  [](const ConstView& v) { return v.drive_spec() != nullptr; },
                  [](const View& v) {
                    if (v.drive != nullptr) v.drive->emplace();
                  }};
const Part kMotorData{kMotor, [](const ConstView& v) { return v.motor() != nullptr; },
                      [](const View& v) { v.drive_spec()->motor.emplace(); }};
const Part kPortPlate{{},
                      [](const ConstView& v) { return v.port_plate() != nullptr; },
                      [](const View& v) { v.pump->port_plate.emplace(); }};
const Part kHydraulicData{kHydraulic,
                          [](const ConstView& v) { return v.hydraulic_data() != nullptr; },
                          [](const View& v) {
                            if (v.hydraulics != nullptr) v.hydraulics->emplace();
                          },
                          [](const View& v) {
                            if (v.hydraulics != nullptr) v.hydraulics->reset();
                          }};

// A part of the hydraulic data that has a table of its own; null where it is missing.
template <auto kMember, class V>
auto hydraulic_part(const V& v) -> decltype(&*(v.hydraulic_data()->*kMember)) {
  auto* const data = v.hydraulic_data();
  return data != nullptr && (data->*kMember).has_value() ? &*(data->*kMember) : nullptr;
}
template <auto kMember>
const Part kHydraulicPart{{},
                          [](const ConstView& v) { return hydraulic_part<kMember>(v) != nullptr; },
                          [](const View& v) {
                            if (v.hydraulic_data() != nullptr)
                              (v.hydraulic_data()->*kMember).emplace();
                          }};
template <auto kMember, auto kField>
NumberField number_of() {
  return number_at([](const auto& v) { return in(hydraulic_part<kMember>(v), kField); });
}
constexpr auto kOil = &HydraulicData::oil;
constexpr auto kGaps = &HydraulicData::gaps;
constexpr auto kLoad = &HydraulicData::load;
constexpr auto kSuctionLine = &HydraulicData::suction_line;
constexpr auto kDeliveryLine = &HydraulicData::delivery_line;
constexpr auto kAccumulator = &HydraulicData::accumulator;
constexpr auto kLoop = &HydraulicData::loop;

// ---- What a rule says
// ----------------------------------------------------------------------------

// A computed number for a message.
std::string short_text(double value) { return rounded_text(value, 6); }

std::string not_assembled(const ConstView& v) {
  const Geometry& g = v.pump->geometry;
  const AssemblyMargin margin = assembly_margin(g);
  if (g.piston_length > margin.longest_distance) return "";
  return "must be > " + short_text(margin.longest_distance * 1e3) +
         ": the pump cannot be assembled at theta = " + short_text(margin.theta_deg) +
         " deg, where " + short_text((margin.longest_distance - g.piston_length) * 1e3) +
         " mm are missing (set by joint_circle_radius_mm, bore_circle_radius_mm, axis_offset_mm, "
         "tilt_deg)";
}

std::string same_bearings(const ConstView& v) {
  const Bearings& b = v.pump->bearings;
  return b.tapered_z == b.cylindrical_z ? "must differ from tapered_z_mm" : "";
}

std::string arc_refusal(const PortArc* arc) {
  if (arc == nullptr || (arc->from_deg < arc->to_deg && arc->to_deg <= arc->from_deg + 360))
    return "";
  return "must be [from, to] with from < to <= from + 360";
}

std::string inner_land_refusal(const ConstView& v) {
  const PortPlate* p = v.port_plate();
  return p->r1 < p->r2 ? "" : "must be [r1, r2] with 0 <= r1 < r2";
}

std::string outer_land_refusal(const ConstView& v) {
  const PortPlate* p = v.port_plate();
  return p->r2 < p->r3 && p->r3 < p->r4 ? "" : "must be [r3, r4] with r2 < r3 < r4";
}

std::string kidney_refusal(const ConstView& v) {
  const HydraulicData* data = v.hydraulic_data();
  const auto too_long = [&](const PlatePort& port) {
    return port.arc.to_deg - port.arc.from_deg + port.notch.length_deg +
               port.trailing_notch.length_deg + data->kidney_width_deg >
           360;
  };
  for (const bool delivery : {true, false})
    if (too_long(delivery ? data->delivery : data->suction))
      return std::string("with the ") + (delivery ? "delivery" : "suction") +
             " port's arc and notches must not exceed 360 deg";
  return "";
}

// Degrees on the bore circle.
double degrees_of(double length, const ConstView& v) {
  return length / v.pump->geometry.bore_circle_radius / kRadPerDegree;
}

std::string ends_refusal(const ConstView& v) {
  const HydraulicData* data = v.hydraulic_data();
  if (data->kidney_ends != KidneyEnds::circular) return "";
  const double least = degrees_of(data->kidney_height, v);
  for (const PortArc& arc :
       {data->delivery.arc, data->suction.arc, PortArc{0, data->kidney_width_deg}})
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

std::string hole_refusal(const PlateHole& hole, const ConstView& v) {
  const HydraulicData* data = v.hydraulic_data();
  const double wide = radians(data->kidney_width_deg) * v.pump->geometry.bore_circle_radius;
  const double most = std::min(data->kidney_height, wide);
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

std::string boiling_refusal(const ConstView& v) {
  const HydraulicData* data = v.hydraulic_data();
  if (v.pressure->kind != PressureKind::hydraulic || data->cavitation == Cavitation::ignored)
    return "";
  const double least = data->atmosphere + std::min(v.pressure->ports.suction, data->case_pressure);
  return data->vapour_pressure < least
             ? ""
             : "must be < " + short_text(least / kPascalPerBar) +
                   ", the smaller absolute pressure of suction port and case";
}

std::string vacuum_refusal(const ConstView& v) {
  if (v.pressure->kind != PressureKind::hydraulic) return "";  // present and unused
  return v.pressure->ports.suction > -v.hydraulic_data()->atmosphere
             ? ""
             : "must exceed -suction_bar of [pressure]: no absolute pressure is below zero";
}

std::string viscosity_refusal(const ConstView& v) {
  const OilData* oil = hydraulic_part<kOil>(v);
  return oil == nullptr || oil->viscosity_100 < oil->viscosity_40
             ? ""
             : "must be below viscosity_40C_cSt: oil thins as it warms";
}

std::string oil_refusal(const ConstView& v) {
  return hydraulic_part<kGaps>(v) == nullptr || hydraulic_part<kOil>(v) != nullptr
             ? ""
             : "needs the table [oil]: gaps leak by viscosity";
}

std::string gap_length_refusal(const ConstView& v) {
  const GapData* gaps = hydraulic_part<kGaps>(v);
  return gaps == nullptr || gaps->piston_gap == 0 || gaps->piston_gap_length > 0
             ? ""
             : "must be > 0 where piston_gap_um is";
}

std::string plate_gap_refusal(const ConstView& v) {
  const GapData* gaps = hydraulic_part<kGaps>(v);
  return gaps == nullptr || gaps->plate_gap == 0 || v.port_plate() != nullptr
             ? ""
             : "needs the lands of [port_plate]";
}

std::string ring_slot_refusal(const ConstView& v) {
  const GapData* gaps = hydraulic_part<kGaps>(v);
  return gaps == nullptr || gaps->ring_slot_height == 0 || gaps->ring_slot_length > 0
             ? ""
             : "must be > 0 where ring_slot_um is";
}

// Whether what the pump delivers to is held at a pressure.
bool delivery_is_held(const ConstView& v) {
  const LoadData* load = hydraulic_part<kLoad>(v);
  return v.pressure->ports.delivery == 0 ||
         (load != nullptr && load->kind == LoadKind::constant_pressure);
}

std::string share_refusal(const ConstView& v) {
  const TimeCurve& share = hydraulic_part<kLoad>(v)->share;
  if (share.time.empty()) return "";
  return share.time.size() >= 4 && share.time.size() == share.value.size()
             ? ""
             : "must have at least 4 points";
}

std::string accumulator_refusal(const ConstView& v) {
  return !delivery_is_held(v) || hydraulic_part<kDeliveryLine>(v) != nullptr
             ? ""
             : "the delivery volume is held at a pressure (constant_pressure, or delivery_bar = 0):"
               " an accumulator does nothing there";
}

std::string loop_refusal(const ConstView& v) {
  if (hydraulic_part<kSuctionLine>(v) != nullptr)
    return "a closed loop has no tank to draw from: leave out [suction_line]";
  return delivery_is_held(v) ? "a closed loop needs a load between its sides: not "
                               "constant_pressure, and not delivery_bar = 0"
                             : "";
}

// ---- Tables of a kind
// ----------------------------------------------------------------------------

// Two numbers of an arc. `Arc` finds it.
template <class Arc>
PairField arc_at(Arc) {
  return pair_at([](const auto& v) { return in(Arc{}(v), &PortArc::from_deg); },
                 [](const auto& v) { return in(Arc{}(v), &PortArc::to_deg); });
}

template <std::size_t kHole, class Port>
NumberField hole_angle(Port) {
  return number_at([](const auto& v) {
    const auto port = Port{}(v);
    return port == nullptr ? nullptr : &port->holes[kHole].angle_deg;
  });
}
template <std::size_t kHole, class Port>
NumberField hole_diameter(Port) {
  return number_at([](const auto& v) {
    const auto port = Port{}(v);
    return port == nullptr ? nullptr : &port->holes[kHole].diameter;
  });
}

template <class Place>
CurveField curve_at(Place place) {
  return {access<std::filesystem::path>(place), nullptr};
}

// What opens one port of [hydraulics]. `Port` finds it, `Plate` the arc of [port_plate].
template <class Port, class Plate>
std::vector<Parameter> port_parameters(const std::string& name, Port, Plate) {
  const auto arc = [](const auto& v) { return in(Port{}(v), &PlatePort::arc); };
  const auto notch_length = [](const auto& v) {
    return in(in(Port{}(v), &PlatePort::notch), &Notch::length_deg);
  };
  const auto notch_area = [](const auto& v) {
    return in(in(Port{}(v), &PlatePort::notch), &Notch::area);
  };
  const auto trailing_length = [](const auto& v) {
    return in(in(Port{}(v), &PlatePort::trailing_notch), &Notch::length_deg);
  };
  const auto trailing_area = [](const auto& v) {
    return in(in(Port{}(v), &PlatePort::trailing_notch), &Notch::area);
  };
  const auto groove = [](const auto& v) { return in(Port{}(v), &PlatePort::groove); };
  using Groove = decltype(groove);
  CurveField table = curve_at(
      [](const auto& v) { return in(in(Port{}(v), &PlatePort::table), &OpeningTable::file); });
  table.opening = [](const View& v) { return &Port{}(v)->table; };
  return {
      {.key = name + "_arc_deg",
       .field = arc_at(arc),
       .unit = kDegrees,
       .range_words = "[from, to], from < to <= from + 360",
       .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                      const PortArc* plate = Plate{}(v);
                      if (plate == nullptr) return std::nullopt;
                      return std::array{plate->from_deg, plate->to_deg};
                    },
                    .words = "that of `[port_plate]`"},
       .meaning = "edges of the " + name + " port"},
      {.key = name + "_notch_deg",
       .field = number_at(notch_length),
       .unit = kDegrees,
       .range = {0, 90},
       .fallback = {0.0},
       .meaning = "length of the silencing notch that leads the " + name + " port",
       .practice = "5..20"},
      {.key = name + "_notch_area_mm2",
       .field = number_at(notch_area),
       .unit = kSquareMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "area of the notch that leads the " + name +
                  " port at its root, where it meets the port",
       .practice = "some mm2"},
      {.key = name + "_trailing_notch_deg",
       .field = number_at(trailing_length),
       .unit = kDegrees,
       .range = {0, 90},
       .fallback = {0.0},
       .meaning = "length of a notch behind the trailing edge of the " + name + " port"},
      {.key = name + "_trailing_notch_area_mm2",
       .field = number_at(trailing_area),
       .unit = kSquareMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning =
           "area of the notch behind the trailing edge of the " + name + " port at its root"},
      {.key = name + "_groove_deg",
       .field = pair_at([](const auto& v) { return in(Groove{}(v), &ReliefGroove::from_deg); },
                        [](const auto& v) { return in(Groove{}(v), &ReliefGroove::to_deg); }),
       .unit = kDegrees,
       .range_words = "[from, to], from < to",
       .fallback = {std::array{0.0, 0.0}},
       .meaning = "where a relief groove that leads to the " + name + " port lies"},
      {.key = name + "_groove_width_mm",
       .field = number_at([](const auto& v) { return in(Groove{}(v), &ReliefGroove::width); }),
       .unit = kMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "radial width of the relief groove of the " + name + " port"},
      {.key = name + "_groove_area_mm2",
       .field = number_at([](const auto& v) { return in(Groove{}(v), &ReliefGroove::area); }),
       .unit = kSquareMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "cross-section of the relief groove of the " + name + " port; 0: no groove",
       .practice = "below 1 mm2"},
      {.key = name + "_hole_deg",
       .field = hole_angle<0>(Port{}),
       .unit = kDegrees,
       .fallback = {0.0},
       .meaning = "centre of a hole in the bridge that leads to the " + name + " port"},
      {.key = name + "_hole_diameter_mm",
       .field = hole_diameter<0>(Port{}),
       .unit = kMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "diameter of the hole that leads to the " + name + " port; 0: no hole",
       .practice = "1..3"},
      {.key = name + "_hole_2_deg",
       .field = hole_angle<1>(Port{}),
       .unit = kDegrees,
       .fallback = {0.0},
       .meaning = "centre of a second hole in the bridge that leads to the " + name + " port"},
      {.key = name + "_hole_2_diameter_mm",
       .field = hole_diameter<1>(Port{}),
       .unit = kMillimetres,
       .range = kNotNegative,
       .fallback = {0.0},
       .meaning = "diameter of the second hole that leads to the " + name + " port; 0: no hole"},
      {.key = name + "_opening_file",
       .field = table,
       .fallback = {std::string()},
       .meaning = "CSV `theta_deg,area_mm2`, path relative to the case file: the opening over "
                  "the chamber's angle in place of all other parts of the " +
                  name + " port; empty: none"}};
}

// What the openings of a port must be to each other.
template <class Port>
std::vector<Rule> port_rules(const std::string& name, Port) {
  return {{.key = name + "_groove_deg",
           .after = "",
           .broken =
               [](const ConstView& v) { return groove_refusal(*Port{}(v), *v.hydraulic_data()); }},
          {.key = name + "_groove_width_mm",
           .after = "",
           .broken = [](const ConstView& v) { return groove_width_refusal(*Port{}(v)); }},
          {.key = name + "_opening_file",
           .after = "",
           .broken = [](const ConstView& v) { return table_refusal(Port{}(v)->table); }},
          {.key = name + "_hole_diameter_mm",
           .after = "",
           .broken = [](const ConstView& v) { return hole_refusal(Port{}(v)->holes[0], v); }},
          {.key = name + "_hole_2_diameter_mm", .after = "", .broken = [](const ConstView& v) {
             return hole_refusal(Port{}(v)->holes[1], v);
           }}};
}

template <class Model>
Table assumptions_table(const std::string& model, Model) {
  return {
      .name = "assumptions." + model,
      .meaning = "what the " + model + " model assumes in this case",
      .presence = Presence::silent,
      .parameters =
          {{.key = "piston_friction",
            .field = flag_at(
                [](const auto& v) { return in(Model{}(v), &Assumptions::piston_friction); }),
            .fallback = {true},
            .meaning = model + " model: whether friction acts on the pistons"},
           {.key = "inertia",
            .field = choice_at([](const auto& v) { return in(Model{}(v), &Assumptions::inertia); }),
            .words = piston_inertia_names(),
            .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                           return to_string(v.pump->piston.inertia);
                         },
                         .words = "that of `[piston]`"},
            .meaning = model + " model: inertia of the pistons, as in `[piston]`"},
           {.key = "gear",
            .field = choice_at([](const auto& v) { return in(Model{}(v), &Assumptions::gear); }),
            .words = {"mesh", "imposed"},
            .fallback = {std::string("mesh")},
            .meaning = model +
                       " model: how the block is carried round: by the tooth force, or by a speed "
                       "imposed on its own joint, as in the paper's ADAMS run"}},
      .rules = {{.key = "inertia", .after = "gear", .broken = [](const ConstView& v) {
                   const Assumptions* a = Model{}(v);
                   return a == nullptr ? "" : piston_inertia_refusal(a->inertia, *v.pump);
                 }}}};
}

Table multibody_assumptions_table() {
  Table table = assumptions_table("multibody", [](const auto& v) { return v.multibody; });
  table.parameters.push_back(
      {.key = "flank_shape",
       .field = choice_at([](const auto& v) { return in(v.multibody, &Assumptions::flanks); }),
       .words = {"involute", "octoid"},
       .fallback = {std::string("involute")},
       .meaning = "of [gear] contact = \"teeth\": spherical involutes, as the analytic model has "
                  "them, or octoids, which a plane flank of a crown gear envelops",
       .active = kTeeth});
  return table;
}

Table plausibility_table() {
  return {.name = "plausibility",
          .meaning = "reasons for values that a check holds to be doubtful (plausibility.md)",
          .presence = Presence::silent,
          .parameters = {{.key = "meant",
                          .field = text_at([](const auto& v) { return v.meant; }),
                          .fallback = {std::string()},
                          .meaning = "`CODE: reason; CODE: reason`: these are meant, and do not "
                                     "warn"}}};
}

template <class Entry>
std::vector<Entry> joined(std::vector<std::vector<Entry>> lists) {
  std::vector<Entry> all;
  for (auto& list : lists)
    for (Entry& entry : list) all.push_back(std::move(entry));
  return all;
}

// ---- The tables, in the order in which a case is read
// --------------------------------------------

Table top_level() {
  return {.name = "",
          .meaning = "the file itself",
          .parameters = {{.key = "schema",
                          .field = IntegerField{},
                          .range = {1, 1},
                          .meaning = "version of this format"},
                         {.key = "name",
                          .field = text_at([](const auto& v) { return v.name; }),
                          .meaning = "shown in reports"}}};
}

Table pump_table() {
  return {
      .name = "pump",
      .meaning = "main dimensions",
      .parameters =
          {{.key = "type",
            .field = ChoiceField{},
            .words = {"bent_axis_bevel"},
            .fallback = {std::string("bent_axis_bevel")},
            .meaning = "kind of mechanism"},
           {.key = "pistons",
            .field = integer_at([](const auto& v) { return &v.pump->geometry.pistons; }),
            .symbol = "N",
            .range = {1, kMostPistons},
            .meaning = "number of pistons"},
           {.key = "tilt_deg",
            .field = number_at([](const auto& v) { return &v.pump->geometry.tilt; }),
            .path = {"geometry.tilt"},
            .symbol = "alpha",
            .unit = kAngle,
            .range = {0, 90, false, true},
            .meaning = "angle between shaft axis z1 and block axis z2"},
           {.key = "joint_circle_radius_mm",
            .field = number_at([](const auto& v) { return &v.pump->geometry.joint_circle_radius; }),
            .path = {"geometry.joint_circle_radius"},
            .symbol = "Ra",
            .unit = kMillimetres,
            .range = kPositive,
            .meaning = "radius of the circle of joint centres A, about z1"},
           {.key = "bore_circle_radius_mm",
            .field = number_at([](const auto& v) { return &v.pump->geometry.bore_circle_radius; }),
            .path = {"geometry.bore_circle_radius"},
            .symbol = "Rd",
            .unit = kMillimetres,
            .range = kPositive,
            .meaning = "radius of the circle of bore axes, about z2"},
           {.key = "axis_offset_mm",
            .field = number_at([](const auto& v) { return &v.pump->geometry.axis_offset; }),
            .path = {"geometry.axis_offset"},
            .symbol = "b",
            .unit = kMillimetres,
            .meaning = "z1 of O2: from the joint plane to the point where the axes meet"},
           {.key = "piston_length_mm",
            .field = number_at([](const auto& v) { return &v.pump->geometry.piston_length; }),
            .path = {"geometry.piston_length"},
            .symbol = "b1",
            .unit = kMillimetres,
            .range = kPositive,
            .range_words = "> 0, and long enough to be assembled over the whole turn",
            .meaning = "A to B"},
           {.key = "bore_diameter_mm",
            .field = number_at([](const auto& v) { return &v.pump->geometry.bore_diameter; }),
            .path = {"geometry.bore_diameter"},
            .symbol = "Dpi",
            .unit = kMillimetres,
            .range = kPositive,
            .meaning = "cylinder diameter; piston area A = pi Dpi^2/4"}},
      .rules = {{.key = "piston_length_mm", .after = "piston_length_mm", .broken = not_assembled}}};
}

// What both kinds of teeth that give way have.
template <class V>
auto of_either(const V& v, double ToothCompliance::*of_law, double ToothData::*of_teeth)
    -> decltype(in(v.compliance(), of_law)) {
  return v.pump->gear.contact == ToothContact::teeth ? in(v.teeth(), of_teeth)
                                                     : in(v.compliance(), of_law);
}

std::optional<Value> modules_of(const ConstView& v, double modules) {
  if (v.teeth() == nullptr || v.teeth()->count <= 0) return std::nullopt;
  return modules * v.pump->gear.pitch_diameter / v.teeth()->count * 1e3;
}

Table gear_table() {
  CurveField pitch_errors =
      curve_at([](const auto& v) { return in(v.teeth(), &ToothData::error_file); });
  pitch_errors.teeth = [](const View& v) { return v.teeth(); };
  return {
      .name = "gear",
      .meaning = "bevel gear pair that carries the block round",
      .parameters =
          {{.key = "pitch_diameter_mm",
            .field = number_at([](const auto& v) { return &v.pump->gear.pitch_diameter; }),
            .path = {"gear.pitch_diameter"},
            .symbol = "d = m Z",
            .unit = kMillimetres,
            .range = kPositive,
            .meaning = "pitch cone diameter at the contact point O4"},
           {.key = "pressure_angle_deg",
            .field = number_at([](const auto& v) { return &v.pump->gear.pressure_angle; }),
            .path = {"gear.pressure_angle"},
            .symbol = "alpha_p (ap)",
            .unit = kAngle,
            .range = {0, 60},
            .meaning = "pressure angle; the pitch cone angle is 90 deg - alpha/2"},
           {.key = "contact",
            .field = choice_at([](const auto& v) { return &v.pump->gear.contact; }),
            .words = {"rigid", "compliant", "teeth"},
            .fallback = {std::string("rigid")},
            .meaning = "rigid: block and shaft turn alike in motion; compliant: the flanks give "
                       "way, with backlash between them (motion.md); teeth: straight bevel teeth "
                       "that touch where they are (teeth.md)"},
           {.key = "flanks",
            .field = choice_at([](const auto& v) { return &v.pump->gear.flanks; }),
            .words = {"one", "two"},
            .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                           return std::string(v.pump->gear.gives_way() ? "two" : "one");
                         },
                         .words = "one; two where `contact` is not rigid"},
            .meaning = "one: as the paper prints, one line of action for either sign of the "
                       "force; two: the flank that is pushed carries, and the separating part "
                       "of its force always pushes the gears apart"},
           {.key = "stiffness_N_per_um",
            .field = number_at(
                [](const auto& v) { return in(v.compliance(), &ToothCompliance::stiffness); }),
            .path = {"gear.compliance.stiffness"},
            .symbol = "k",
            .unit = kStiffness,
            .range = kPositive,
            .meaning = "force of a flank at an approach of 1 um",
            .part = &kCompliance},
           {.key = "stiffness_exponent",
            .field = number_at(
                [](const auto& v) { return in(v.compliance(), &ToothCompliance::exponent); }),
            .path = {"gear.compliance.exponent"},
            .symbol = "e",
            .range = {1, 3},
            .fallback = {1.0},
            .meaning = "power of the approach with which the force grows",
            .practice = "lines 1, points 1.5, ADAMS' default 2.2",
            .part = &kCompliance},
           {.key = "dissipation_s_per_m",
            .field = number_at([](const auto& v) {
              return of_either(v, &ToothCompliance::dissipation, &ToothData::dissipation);
            }),
            .path = {"gear.dissipation"},
            .symbol = "c",
            .unit = {"s/m"},
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "growth of the force with the speed of approach",
            .part = &kGiving},
           {.key = "backlash_um",
            .field = number_at([](const auto& v) {
              return of_either(v, &ToothCompliance::backlash, &ToothData::backlash);
            }),
            .path = {"gear.backlash"},
            .symbol = "j",
            .unit = kMicrometres,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "along the line of action; rigid teeth have none",
            .part = &kGiving},
           {.key = "tooth_number",
            .field = integer_at([](const auto& v) { return in(v.teeth(), &ToothData::count); }),
            .symbol = "Z",
            .range = {5, 400},
            .meaning = "teeth of the shaft and of the block",
            .part = &kToothData},
           {.key = "face_width_mm",
            .field = number_at([](const auto& v) { return in(v.teeth(), &ToothData::face_width); }),
            .path = {"gear.teeth.face_width"},
            .symbol = "w",
            .unit = kMillimetres,
            .range = kPositive,
            .meaning = "along the pitch cone, O4 in its middle",
            .part = &kToothData},
           {.key = "addendum_mm",
            .field = number_at([](const auto& v) { return in(v.teeth(), &ToothData::addendum); }),
            .path = {"gear.teeth.addendum"},
            .symbol = "h_a",
            .unit = kMillimetres,
            .range = kPositive,
            .fallback = {.computed = [](const ConstView& v) { return modules_of(v, 1); },
                         .words = "the module d / Z"},
            .meaning = "of the teeth over the pitch cone, at O4",
            .part = &kToothData},
           {.key = "dedendum_mm",
            .field = number_at([](const auto& v) { return in(v.teeth(), &ToothData::dedendum); }),
            .path = {"gear.teeth.dedendum"},
            .symbol = "h_f",
            .unit = kMillimetres,
            .range = kPositive,
            .fallback = {.computed = [](const ConstView& v) { return modules_of(v, 1.25); },
                         .words = "1.25 modules"},
            .meaning = "of the gaps under the pitch cone, at O4",
            .part = &kToothData},
           {.key = "tip_relief_um",
            .field = number_at([](const auto& v) { return in(v.teeth(), &ToothData::tip_relief); }),
            .path = {"gear.teeth.tip_relief"},
            .symbol = "C_a",
            .unit = kMicrometres,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "material that the tips lack, along the line of action",
            .part = &kToothData},
           {.key = "tip_relief_height_mm",
            .field =
                number_at([](const auto& v) { return in(v.teeth(), &ToothData::relief_height); }),
            .path = {"gear.teeth.relief_height"},
            .unit = kMillimetres,
            .range = kPositive,
            .fallback = {.computed = [](const ConstView& v) { return modules_of(v, 0.5); },
                         .words = "half a module"},
            .meaning = "from the tip down to where its relief begins; it grows with the square of "
                       "the way from there",
            .part = &kToothData},
           {.key = "lead_crowning_um",
            .field =
                number_at([](const auto& v) { return in(v.teeth(), &ToothData::lead_crowning); }),
            .path = {"gear.teeth.lead_crowning"},
            .symbol = "C_b",
            .unit = kMicrometres,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "by how much a pair of flanks is farther apart at both ends than in the "
                       "middle of the face width: a parabola",
            .part = &kToothData},
           {.key = "youngs_modulus_GPa",
            .field =
                number_at([](const auto& v) { return in(v.teeth(), &ToothData::youngs_modulus); }),
            .path = {"gear.teeth.youngs_modulus"},
            .symbol = "E",
            .unit = kGigapascal,
            .range = kPositive,
            .fallback = {206.0},
            .meaning = "of the teeth",
            .practice = "steel 206",
            .part = &kToothData},
           {.key = "poisson_ratio",
            .field =
                number_at([](const auto& v) { return in(v.teeth(), &ToothData::poisson_ratio); }),
            .path = {"gear.teeth.poisson_ratio"},
            .symbol = "nu",
            .range = {0, 0.5},
            .fallback = {0.3},
            .meaning = "of the teeth",
            .part = &kToothData},
           {.key = "rim_ratio",
            .field = number_at([](const auto& v) { return in(v.teeth(), &ToothData::rim_ratio); }),
            .path = {"gear.teeth.rim_ratio"},
            .range = {1.4, 7},
            .fallback = {3.0},
            .meaning =
                "root radius over the radius of the hub's bore, of the equivalent spur gear: "
                "what the foundation's deflection depends on",
            .part = &kToothData},
           {.key = "shaft_runout_um",
            .field = number_at([](const auto& v) {
              return in(in(v.teeth(), &ToothData::shaft), &ToothErrors::runout);
            }),
            .path = {"gear.teeth.shaft.runout"},
            .unit = kMicrometres,
            .fallback = {0.0},
            .meaning = "amplitude of the material that the flanks of the shaft's teeth lack, once "
                       "a turn",
            .part = &kToothData},
           {.key = "shaft_runout_deg",
            .field = number_at([](const auto& v) {
              return in(in(v.teeth(), &ToothData::shaft), &ToothErrors::runout_angle);
            }),
            .path = {"gear.teeth.shaft.runout_angle"},
            .unit = kAngle,
            .fallback = {0.0},
            .meaning = "where they lack most, from tooth 1 in the order of the teeth",
            .part = &kToothData},
           {.key = "block_runout_um",
            .field = number_at([](const auto& v) {
              return in(in(v.teeth(), &ToothData::block), &ToothErrors::runout);
            }),
            .path = {"gear.teeth.block.runout"},
            .unit = kMicrometres,
            .fallback = {0.0},
            .meaning = "the same of the block's teeth",
            .part = &kToothData},
           {.key = "block_runout_deg",
            .field = number_at([](const auto& v) {
              return in(in(v.teeth(), &ToothData::block), &ToothErrors::runout_angle);
            }),
            .path = {"gear.teeth.block.runout_angle"},
            .unit = kAngle,
            .fallback = {0.0},
            .meaning = "the same of the block's teeth",
            .part = &kToothData},
           {.key = "pitch_error_file",
            .field = pitch_errors,
            .fallback = {std::string()},
            .meaning = "CSV `tooth,shaft_um,block_um`, path relative to the case file, a line for "
                       "each tooth: how far it stands ahead of its place, towards +theta or +psi, "
                       "along the line of action; empty: 0",
            .part = &kToothData}},
      .rules =
          {
              {.key = "flanks",
               .after = "flanks",
               .broken =
                   [](const ConstView& v) {
                     const Gear& gear = v.pump->gear;
                     return gear.gives_way() && gear.flanks == Flanks::one
                                ? std::string(
                                      "teeth that give way have two flanks: must be \"two\" "
                                      "beside contact = \"compliant\" or \"teeth\"")
                                : std::string();
                   }},
              {.key = "contact", .after = "", .broken = [](const ConstView& v) {
                 const ToothContact contact = v.pump->gear.contact;
                 if (contact == ToothContact::compliant && v.compliance() == nullptr)
                   return std::string("needs stiffness_N_per_um");
                 if (contact == ToothContact::teeth && v.teeth() == nullptr)
                   return std::string("needs tooth_number and face_width_mm");
                 // The cone distance grows as 1/tilt, and with it the round-off of contact points.
                 constexpr double kLeastTilt = 1e-4 * kRadPerDegree;
                 if (contact == ToothContact::teeth && v.pump->geometry.tilt < kLeastTilt)
                   return std::string(
                       "bevel teeth need [pump] tilt_deg >= 0.0001: nearly parallel axes meet too "
                       "far away for the contact of teeth to be computed");
                 return std::string();
               }}}};
}

// Ratings of a bearing; `Place` finds them.
template <class Place>
std::vector<Parameter> rating_parameters(const std::string& bearing, const Part* part, Place) {
  const auto dynamic_rating = [](const auto& v) {
    return in(Place{}(v), &BearingRating::dynamic_rating);
  };
  const auto static_rating = [](const auto& v) {
    return in(Place{}(v), &BearingRating::static_rating);
  };
  const auto designation = [](const auto& v) {
    return in(Place{}(v), &BearingRating::designation);
  };
  return {{.key = bearing + "_designation",
           .field = text_at(designation),
           .fallback = {std::string()},
           .meaning = "which " + bearing + " bearing it is, for reports",
           .part = part},
          {.key = bearing + "_dynamic_rating_kN",
           .field = number_at(dynamic_rating),
           .symbol = "C_" + bearing,
           .unit = kKilonewtons,
           .range = kPositive,
           .meaning = "basic dynamic radial load rating of the " + bearing + " bearing (ISO 281)",
           .part = part},
          {.key = bearing + "_static_rating_kN",
           .field = number_at(static_rating),
           .symbol = "C0_" + bearing,
           .unit = kKilonewtons,
           .range = kPositive,
           .meaning = "basic static radial load rating of the " + bearing + " bearing (ISO 76)",
           .part = part}};
}

// How radial and axial load count together. Of a contact angle a, Y = 0.4 cot a, e = 1.5 tan a and
// Y0 = 0.22 cot a (ISO 281, ISO 76): Y alone says the rest.
std::vector<Parameter> tapered_factors() {
  return {{.key = "tapered_Y",
           .field = number_at(
               [](const auto& v) { return in(v.tapered_rating(), &TaperedRating::axial_factor); }),
           .symbol = "Y",
           .range = kPositive,
           .meaning = "axial load factor",
           .practice = "0.7..2.1",
           .part = &kTaperedRating},
          {.key = "tapered_e",
           .field = number_at(
               [](const auto& v) { return in(v.tapered_rating(), &TaperedRating::ratio_limit); }),
           .symbol = "e",
           .range = kPositive,
           .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                          return 0.6 / v.tapered_rating()->axial_factor;
                        },
                        .words = "0.6 / `tapered_Y`"},
           .meaning = "Fa / Fr up to which the axial load does not count",
           .part = &kTaperedRating},
          {.key = "tapered_X",
           .field = number_at(
               [](const auto& v) { return in(v.tapered_rating(), &TaperedRating::radial_factor); }),
           .symbol = "X",
           .range = {0, 1},
           .fallback = {0.4},
           .meaning = "radial load factor beyond that",
           .part = &kTaperedRating},
          {.key = "tapered_Y0",
           .field = number_at([](const auto& v) {
             return in(v.tapered_rating(), &TaperedRating::static_axial_factor);
           }),
           .symbol = "Y0",
           .range = kNotNegative,
           .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                          return 0.55 * v.tapered_rating()->axial_factor;
                        },
                        .words = "0.55 `tapered_Y`"},
           .meaning = "static axial load factor",
           .part = &kTaperedRating}};
}

Table bearings_table() {
  Table table{
      .name = "bearings",
      .meaning =
          "places of the bearings on the shaft axis, and where their life is asked for their "
          "ratings",
      .parameters = {{.key = "tapered_z_mm",
                      .field = number_at([](const auto& v) { return &v.pump->bearings.tapered_z; }),
                      .path = {"bearings.tapered_z"},
                      .symbol = "C1",
                      .unit = kMillimetres,
                      .meaning = "z1 of the tapered roller bearing, which takes x, y and z"},
                     {.key = "cylindrical_z_mm",
                      .field =
                          number_at([](const auto& v) { return &v.pump->bearings.cylindrical_z; }),
                      .path = {"bearings.cylindrical_z"},
                      .symbol = "C2",
                      .unit = kMillimetres,
                      .range_words = "other than `tapered_z_mm`",
                      .meaning = "z1 of the cylindrical roller bearing, which takes x and y"}},
      .rules = {{.key = "cylindrical_z_mm", .after = "cylindrical_z_mm", .broken = same_bearings}}};
  const auto add = [&](const std::vector<Parameter>& more) {
    table.parameters.insert(table.parameters.end(), more.begin(), more.end());
  };
  add(rating_parameters("tapered", &kTaperedRating,
                        [](const auto& v) { return v.tapered_rating(); }));
  add(tapered_factors());
  add(rating_parameters("cylindrical", &kCylindricalRating,
                        [](const auto& v) { return v.cylindrical_rating(); }));
  return table;
}

Table piston_table() {
  return {
      .name = "piston",
      .meaning = "mass properties of one piston",
      .parameters =
          {{.key = "inertia",
            .field = choice_at([](const auto& v) { return &v.pump->piston.inertia; }),
            .words = piston_inertia_names(),
            .meaning = "two point masses at A and B; a rigid body; or three point masses at A, "
                       "centre of mass and B with the real piston's mass, centre and transverse "
                       "inertia (no spin)"},
           {.key = "mass_kg",
            .field = number_at([](const auto& v) { return &v.pump->piston.mass; }),
            .path = {"piston.mass"},
            .symbol = "m_pi",
            .unit = kKilograms,
            .range = kNotNegative,
            .meaning = "mass of a piston, m in theory.md"},
           {.key = "joint_mass_fraction",
            .field = number_at([](const auto& v) { return &v.pump->piston.joint_mass_fraction; }),
            .path = {"piston.joint_mass_fraction"},
            .symbol = "chi",
            .range = {0, 1},
            .fallback = {0.5},
            .meaning = "lumped: share of the mass at A; mA = chi m, mB = (1 - chi) m"},
           {.key = "contact_mm",
            .field = number_at([](const auto& v) { return v.ring_contact(); }),
            .path = {"piston.contact"},
            .symbol = "s_C",
            .unit = kMillimetres,
            .range = kPositive,
            .fallback = {.words = "`piston_length_mm`"},
            .meaning = "from A along the piston's axis to C, where the bore force Rc acts (32); "
                       "pressure and friction stay at B",
            .part = &kRingContact},
           {.key = "centre_of_mass_mm",
            .field = number_at([](const auto& v) {
              return in(v.real_piston(), &PistonMass::Real::centre_of_mass);
            }),
            .path = {"piston.real.centre_of_mass"},
            .symbol = "s_G (Gpi)",
            .unit = kMillimetres,
            .range_words = "dynamically equivalent: strictly between A and B, unless It = 0",
            .meaning = "from A along the piston's axis",
            .part = &kRealPiston},
           {.key = "transverse_inertia_kg_mm2",
            .field = number_at([](const auto& v) {
              return in(v.real_piston(), &PistonMass::Real::transverse_inertia);
            }),
            .path = {"piston.real.transverse_inertia"},
            .symbol = "It",
            .unit = kInertia,
            .range = kNotNegative,
            .meaning = "about the centre of mass, across the axis",
            .part = &kRealPiston},
           {.key = "axial_inertia_kg_mm2",
            .field = number_at([](const auto& v) {
              return in(v.real_piston(), &PistonMass::Real::axial_inertia);
            }),
            .path = {"piston.real.axial_inertia"},
            .symbol = "Ia",
            .unit = kInertia,
            .range = kNotNegative,
            .range_here = [](const ConstView& v) -> std::optional<NumberRange> {
              const PistonMass::Real* real = v.real_piston();
              if (real == nullptr) return std::nullopt;
              return NumberRange{0, 2 * in_file_unit(real->transverse_inertia, kInertia)};
            },
            .range_words = "[0, 2 It]",
            .meaning = "about the axis",
            .part = &kRealPiston},
           {.key = "spin_rpm",
            .field = number_at(
                [](const auto& v) { return in(v.real_piston(), &PistonMass::Real::spin); }),
            .path = {"piston.real.spin"},
            .symbol = "w_s",
            .unit = kRotation,
            .fallback = {0.0},
            .meaning = "real: axial component of the absolute angular velocity, positive along A "
                       "to B",
            .part = &kRealPiston}},
      .rules = {{.key = "inertia", .after = "", .broken = [](const ConstView& v) {
                   return piston_inertia_refusal(v.pump->piston.inertia, *v.pump);
                 }}}};
}

Table shaft_table() {
  return {.name = "shaft",
          .meaning = "shaft",
          .parameters = {
              {.key = "mass_kg",
               .field = number_at([](const auto& v) { return &v.pump->shaft.mass; }),
               .path = {"shaft.mass"},
               .symbol = "ms",
               .unit = kKilograms,
               .range = kNotNegative,
               .meaning = "mass"},
              {.key = "centre_of_mass_z_mm",
               .field = number_at([](const auto& v) { return &v.pump->shaft.centre_of_mass_z; }),
               .path = {"shaft.centre_of_mass_z"},
               .symbol = "Gs",
               .unit = kMillimetres,
               .meaning = "z1 of the centre of mass"},
              {.key = "axial_inertia_kg_mm2",
               .field = number_at([](const auto& v) { return &v.pump->shaft.axial_inertia; }),
               .path = {"shaft.axial_inertia"},
               .symbol = "I_s",
               .unit = kInertia,
               .range = kNotNegative,
               .fallback = {in_file_unit(kUsualShaftInertia, kInertia)},
               .meaning = "about z1; acts only where the speed changes"}}};
}

Table block_table() {
  return {
      .name = "block",
      .meaning = "cylinder block",
      .parameters = {
          {.key = "mass_kg",
           .field = number_at([](const auto& v) { return &v.pump->block.mass; }),
           .path = {"block.mass"},
           .symbol = "mc",
           .unit = kKilograms,
           .range = kNotNegative,
           .meaning = "mass"},
          {.key = "centre_of_mass_z_mm",
           .field = number_at([](const auto& v) { return &v.pump->block.centre_of_mass_z; }),
           .path = {"block.centre_of_mass_z"},
           .symbol = "Gt",
           .unit = kMillimetres,
           .meaning = "z2 of the centre of mass"},
          {.key = "pin_z_mm",
           .field = number_at([](const auto& v) { return &v.pump->block.pin_z; }),
           .path = {"block.pin_z"},
           .symbol = "Hcn",
           .unit = kMillimetres,
           .meaning = "z2 of the mean contact point of the guide pin"},
          {.key = "bottom_area_mm2",
           .field = number_at([](const auto& v) { return &v.pump->block.bottom_area; }),
           .path = {"block.bottom_area"},
           .symbol = "Ac",
           .unit = kSquareMillimetres,
           .range = kNotNegative,
           .fallback = {0.0},
           .meaning = "area per bore on which the chamber pressure pushes the block to the plate"},
          {.key = "spring_force_N",
           .field = number_at([](const auto& v) { return &v.pump->block.spring_force; }),
           .path = {"block.spring_force"},
           .symbol = "Fm",
           .unit = kNewtons,
           .range = kNotNegative,
           .fallback = {0.0},
           .meaning = "spring between shaft and block, pushes them apart"},
          {.key = "axial_inertia_kg_mm2",
           .field = number_at([](const auto& v) { return &v.pump->block.axial_inertia; }),
           .path = {"block.axial_inertia"},
           .symbol = "I_c",
           .unit = kInertia,
           .range = kNotNegative,
           .fallback = {in_file_unit(kUsualBlockInertia, kInertia)},
           .meaning = "about z2; acts only where the speed changes"}}};
}

Table friction_table() {
  return {
      .name = "friction",
      .meaning = "friction of pistons, block and shaft",
      .presence = Presence::optional,
      .parameters = {
          {.key = "piston_coulomb_N",
           .field = number_at([](const auto& v) { return &v.pump->friction.piston_coulomb; }),
           .path = {"friction.piston_coulomb"},
           .symbol = "Fc",
           .unit = kNewtons,
           .range = kNotNegative,
           .fallback = {0.0},
           .meaning = "Coulomb part of the piston friction Fpf"},
          {.key = "piston_viscous_N_s_per_m",
           .field = number_at([](const auto& v) { return &v.pump->friction.piston_viscous; }),
           .path = {"friction.piston_viscous"},
           .symbol = "cv",
           .unit = {"N s/m"},
           .range = kNotNegative,
           .fallback = {0.0},
           .meaning = "viscous part of Fpf"},
          {.key = "regularization_m_per_s",
           .field = number_at([](const auto& v) { return &v.pump->friction.regularization; }),
           .path = {"friction.regularization"},
           .symbol = "v_reg",
           .unit = {"m/s"},
           .range = kNotNegative,
           .fallback = {0.01},
           .meaning = "the Coulomb part grows as tanh(v/v_reg); 0 means sign(v)"},
          {.key = "block_viscous_Nm_per_rpm",
           .field = number_at([](const auto& v) { return &v.pump->friction.block_viscous; }),
           .path = {"friction.block_viscous"},
           .symbol = "Cc (also C)",
           .unit = kTorquePerSpeed,
           .range = kNotNegative,
           .fallback = {0.0},
           .meaning = "viscous torque of the block"},
          {.key = "shaft_viscous_Nm_per_rpm",
           .field = number_at([](const auto& v) { return &v.pump->friction.shaft_viscous; }),
           .path = {"friction.shaft_viscous"},
           .symbol = "Cs",
           .unit = kTorquePerSpeed,
           .range = kNotNegative,
           .fallback = {0.0},
           .meaning = "viscous torque of the shaft"},
          {.key = "shaft_torque_factor",
           .field = number_at([](const auto& v) { return &v.pump->friction.shaft_torque_factor; }),
           .path = {"friction.shaft_torque_factor"},
           .symbol = "Ct",
           .range = {0, 1, true},
           .fallback = {1.0},
           .meaning = "1 - Ct of the drive torque is lost"}}};
}

Table operation_table() {
  return {
      .name = "operation",
      .meaning = "how the pump runs",
      .parameters = {
          {.key = "speed_rpm",
           .field = number_at([](const auto& v) { return in(v.operation, &Operation::speed_rpm); }),
           .symbol = "omega",
           .unit = kSpeed,
           .meaning = "speed of shaft and block, positive about +z1, +z2; the sign gives the "
                      "direction"},
          {.key = "gravity_m_per_s2",
           .field = number_at([](const auto& v) { return &v.pump->gravity; }),
           .path = {"gravity"},
           .symbol = "g",
           .unit = {"m/s2"},
           .fallback = {9.80665},
           .meaning = "along -y1"},
          {.key = "revolutions",
           .field =
               integer_at([](const auto& v) { return in(v.operation, &Operation::revolutions); }),
           .range = kCount,
           .fallback = {1},
           .meaning = "of an integrated run"},
          {.key = "samples_per_revolution",
           .field = integer_at(
               [](const auto& v) { return in(v.operation, &Operation::samples_per_revolution); }),
           .range = kCount,
           .fallback = {720},
           .meaning = "angles of a turn, equally far apart"}}};
}

std::string too_few_points(const ConstView& v) {
  const int* points = in(v.pressure, &PressureSpec::points);
  return points == nullptr || *points == 0 || *points >= 16 ? "" : "must be 0 or in [16, 100000]";
}

Table pressure_table() {
  return {
      .name = "pressure",
      .meaning = "gauge pressure in the chambers over their own angle theta_k",
      .parameters =
          {{.key = "kind",
            .field = choice_at([](const auto& v) { return in(v.pressure, &PressureSpec::kind); }),
            .words = {"ideal", "curve", "hydraulic"},
            .meaning = "smoothed steps between the port pressures; points of a file; or computed "
                       "from `[hydraulics]`"},
           {.key = "suction_bar",
            .field = number_at([](const auto& v) {
              return in(in(v.pressure, &PressureSpec::ports), &PortPressures::suction);
            }),
            .symbol = "p_s",
            .unit = kBar,
            .meaning = "suction pressure; ideal: in the chambers; always: in the port, where it "
                       "loads the lands"},
           {.key = "delivery_bar",
            .field = number_at([](const auto& v) {
              return in(in(v.pressure, &PressureSpec::ports), &PortPressures::delivery);
            }),
            .symbol = "p_d",
            .unit = kBar,
            .range_here = [](const ConstView& v) -> std::optional<NumberRange> {
              if (v.pressure->kind != PressureKind::hydraulic) return std::nullopt;
              return NumberRange{0, 10000};
            },
            .range_words = "hydraulic: [0, 10000]",
            .meaning = "delivery pressure, likewise; hydraulic: the mean asked for, 0 is an open "
                       "line"},
           {.key = "points",
            .field =
                integer_at([](const auto& v) { return in(v.pressure, &PressureSpec::points); }),
            .range = {0, 100000},
            .range_words = "0 or [16, 100000]",
            .fallback = {0},
            .meaning = "0: both models get the computed curve, within `curve_error`; otherwise a "
                       "periodic cubic spline through as many of its points per turn, as the paper "
                       "gave ADAMS 800; its error is in the report",
            .active = kHydraulic},
           {.key = "transition_deg",
            .field = number_at(
                [](const auto& v) { return in(v.pressure, &PressureSpec::transition_deg); }),
            .symbol = "w",
            .unit = kDegrees,
            .range = {0, 180},
            .meaning = "width of each rise and fall; 0 is a step",
            .active = kIdeal},
           {.key = "delivery_start_deg",
            .field = number_at(
                [](const auto& v) { return in(v.pressure, &PressureSpec::delivery_start_deg); }),
            .unit = kDegrees,
            .fallback = {180.0},
            .meaning = "middle of the rise",
            .active = kIdeal},
           {.key = "file",
            .field = curve_at([](const auto& v) { return in(v.pressure, &PressureSpec::file); }),
            .meaning = "CSV `theta_deg,pressure_bar`, path relative to the case file",
            .active = kCurve}},
      .rules = {{.key = "points", .after = "points", .broken = too_few_points}}};
}

// The arcs of [port_plate].
struct DeliveryArc {
  template <bool kConstant>
  auto operator()(const BasicView<kConstant>& v) const {
    return in(v.port_plate(), &PortPlate::delivery);
  }
};
struct SuctionArc {
  template <bool kConstant>
  auto operator()(const BasicView<kConstant>& v) const {
    return in(v.port_plate(), &PortPlate::suction);
  }
};

Table port_plate_table() {
  return {
      .name = "port_plate",
      .meaning =
          "lands of the fixed port plate: full port pressure between r2 and r3, falling "
          "linearly to 0 at r1 and r4",
      .part = &kPortPlate,
      .parameters = {{.key = "inner_land_mm",
                      .field =
                          pair_at([](const auto& v) { return in(v.port_plate(), &PortPlate::r1); },
                                  [](const auto& v) { return in(v.port_plate(), &PortPlate::r2); }),
                      .path = {"port_plate.r1", "port_plate.r2"},
                      .symbol = "r1, r2",
                      .unit = kMillimetres,
                      .range = kNotNegative,
                      .range_words = "[r1, r2], 0 <= r1 < r2",
                      .meaning = "radii of the inner sealing land"},
                     {.key = "outer_land_mm",
                      .field =
                          pair_at([](const auto& v) { return in(v.port_plate(), &PortPlate::r3); },
                                  [](const auto& v) { return in(v.port_plate(), &PortPlate::r4); }),
                      .path = {"port_plate.r3", "port_plate.r4"},
                      .symbol = "r3, r4",
                      .unit = kMillimetres,
                      .range = kNotNegative,
                      .range_words = "[r3, r4], r2 < r3 < r4",
                      .meaning = "radii of the outer sealing land"},
                     {.key = "delivery_arc_deg",
                      .field = arc_at(DeliveryArc{}),
                      .path = {"port_plate.delivery.from_deg", "port_plate.delivery.to_deg"},
                      .symbol = "psi_d1, psi_d2",
                      .unit = kDegrees,
                      .range_words = "[from, to], from < to <= from + 360",
                      .meaning = "delivery port; psi = 0 is +y2, psi grows as theta"},
                     {.key = "suction_arc_deg",
                      .field = arc_at(SuctionArc{}),
                      .path = {"port_plate.suction.from_deg", "port_plate.suction.to_deg"},
                      .symbol = "psi_s1, psi_s2",
                      .unit = kDegrees,
                      .range_words = "[from, to], from < to <= from + 360",
                      .meaning = "suction port, likewise"}},
      .rules = {
          {.key = "inner_land_mm", .after = "inner_land_mm", .broken = inner_land_refusal},
          {.key = "outer_land_mm", .after = "outer_land_mm", .broken = outer_land_refusal},
          {.key = "delivery_arc_deg",
           .after = "delivery_arc_deg",
           .broken = [](const ConstView& v) { return arc_refusal(&v.port_plate()->delivery); }},
          {.key = "suction_arc_deg", .after = "suction_arc_deg", .broken = [](const ConstView& v) {
             return arc_refusal(&v.port_plate()->suction);
           }}}};
}

Table hydraulics_table() {
  const auto delivery = [](const auto& v) {
    return in(v.hydraulic_data(), &HydraulicData::delivery);
  };
  const auto suction = [](const auto& v) {
    return in(v.hydraulic_data(), &HydraulicData::suction);
  };
  return {
      .name = "hydraulics",
      .meaning = "oil, ports, leakage and delivery line",
      .part = &kHydraulicData,
      .parameters = joined<Parameter>(
          {{{.key = "density_kg_per_m3",
             .field = number_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::density); }),
             .symbol = "rho0",
             .unit = {"kg/m3"},
             .range = {100, 5000},
             .fallback = {850.0},
             .meaning = "oil without air at P0",
             .practice = "mineral oil at 60 deg C: 840..870"},
            {.key = "bulk_modulus_MPa",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::bulk_modulus);
             }),
             .symbol = "K",
             .unit = kMegapascals,
             .range = {10, 1e9},
             .fallback = {1400.0},
             .meaning = "oil without air, isentropic",
             .practice = "1200..1600"},
            {.key = "air_percent",
             .field = number_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::air_share); }),
             .symbol = "x",
             .unit = kPercent,
             .range = {0, 50, true},
             .fallback = {0.5},
             .meaning = "entrained air by volume at P0",
             .practice = "0.2..2"},
            {.key = "air_exponent",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::air_exponent);
             }),
             .symbol = "n",
             .range = {1, 1.67},
             .fallback = {1.4},
             .meaning = "1 isothermal, 1.4 adiabatic",
             .practice = "milliseconds per rise: near 1.4"},
            {.key = "atmosphere_bar",
             .field = number_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::atmosphere); }),
             .symbol = "P0",
             .unit = kBar,
             .range = {0.1, 10},
             .range_words = "[0.1, 10], above -`suction_bar`",
             .fallback = {1.01325},
             .meaning = "absolute, where gauge pressure is 0"},
            {.key = "bulk_modulus_slope",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::bulk_modulus_slope);
             }),
             .symbol = "K'",
             .range_here = [](const ConstView& v) -> std::optional<NumberRange> {
               const HydraulicData* data = v.hydraulic_data();
               return NumberRange{
                   0, std::min(kSteepestModulus, 0.9 * data->bulk_modulus / data->atmosphere)};
             },
             .range_words = "[0, 20], at most 0.9 K/P0",
             .fallback = {0.0},
             .meaning = "growth of the oil's bulk modulus with pressure, K + K' (P - P0)",
             .practice = "mineral oil: 9..12"},
            {.key = "cavitation",
             .field = choice_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::cavitation); }),
             .words = {"ignored", "equilibrium", "rate"},
             .fallback = {std::string("ignored")},
             .meaning = "ignored: entrained air only; equilibrium: dissolved air comes out by "
                        "Henry's law, and bubbles hold vapour; rate: likewise, but it takes "
                        "time"},
            {.key = "air_release_ms",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::release_time);
             }),
             .symbol = "tau_r",
             .unit = kMilliseconds,
             .range = {1e-3, 1e9},
             .fallback = {10.0},
             .meaning = "time constant with which dissolved air comes out",
             .practice = "some milliseconds where the oil is stirred, to seconds",
             .active = kAirTakesTime},
            {.key = "air_dissolution_ms",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::dissolution_time);
             }),
             .symbol = "tau_d",
             .unit = kMilliseconds,
             .range = {1e-3, 1e9},
             .fallback = {100.0},
             .meaning = "time constant with which it dissolves again",
             .practice = "some 10 times longer",
             .active = kAirTakesTime},
            {.key = "dissolved_air_percent",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::dissolved_air);
             }),
             .symbol = "y",
             .unit = kPercent,
             .range = {0, 100},
             .fallback = {9.0},
             .meaning = "volume at P0 of the air dissolved at saturation, of the oil's",
             .practice = "mineral oil at 1 bar: 7..9 (Bunsen)"},
            {.key = "vapour_bar",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::vapour_pressure);
             }),
             .symbol = "Pv",
             .unit = kBar,
             .range_here = [](const ConstView& v) -> std::optional<NumberRange> {
               return NumberRange{0, in_file_unit(v.hydraulic_data()->atmosphere, kBar), false,
                                  true};
             },
             .range_words = "[0, `atmosphere_bar`), below suction and case",
             .fallback = {0.001},
             .meaning = "absolute vapour pressure of the oil",
             .practice = "mineral oil at 60 deg C: below 0.001"},
            {.key = "saturation_bar",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::saturation_pressure);
             }),
             .symbol = "Ps",
             .unit = kBar,
             .range_here = [](const ConstView& v) -> std::optional<NumberRange> {
               const HydraulicData* data = v.hydraulic_data();
               return NumberRange{in_file_unit(data->vapour_pressure - data->atmosphere, kBar),
                                  10000, true};
             },
             .range_words = "above vapour pressure",
             .fallback = {0.0},
             .meaning = "gauge pressure below which dissolved air comes out: that at which the oil "
                        "lay with air",
             .practice = "open tank: 0"}},
           port_parameters("delivery", delivery, DeliveryArc{}),
           port_parameters("suction", suction, SuctionArc{}),
           {{.key = "kidney_width_deg",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::kidney_width_deg);
             }),
             .symbol = "w",
             .unit = kDegrees,
             .range = {0, 180, true},
             .range_words = "(0, 180], with arc and notches of a port at most 360",
             .meaning = "of a block kidney, seen from the block axis"},
            {.key = "kidney_height_mm",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::kidney_height);
             }),
             .unit = kMillimetres,
             .range = kPositive,
             .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                            const PortPlate* plate = v.port_plate();
                            if (plate == nullptr) return std::nullopt;
                            return (plate->r3 - plate->r2) * 1e3;
                          },
                          .words = "r3 - r2 of `[port_plate]`"},
             .meaning = "of a block kidney, radial, on the bore circle",
             .practice = "area about bore area less `bottom_area_mm2`"},
            {.key = "kidney_ends",
             .field = choice_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::kidney_ends); }),
             .words = {"rounded", "circular"},
             .fallback = {std::string("rounded")},
             .meaning = "rounded: the opening grows as the square over `kidney_rounding_deg`; "
                        "circular: semicircles on kidney and port, `kidney_height_mm` wide, their "
                        "common area"},
            {.key = "kidney_rounding_deg",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::kidney_rounding_deg);
             }),
             .unit = kDegrees,
             .range = kNotNegative,
             .range_here = [](const ConstView& v) -> std::optional<NumberRange> {
               return NumberRange{0, v.hydraulic_data()->kidney_width_deg};
             },
             .range_words = "[0, `kidney_width_deg`]",
             .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                            return std::min(kKidneyRounding, v.hydraulic_data()->kidney_width_deg);
                          },
                          .words = "5, at most the width"},
             .meaning = "overlap over which the opening of rounded ends grows as its square; 0: "
                        "straight",
             .practice = "about half the height, as an angle"},
            {.key = "notch_law",
             .field = choice_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::notch_law); }),
             .words = {"quadratic", "linear"},
             .fallback = {std::string("quadratic")},
             .meaning = "how a notch opens with the length passed: V groove, or groove of constant "
                        "depth"},
            {.key = "discharge_coefficient",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::discharge_coefficient);
             }),
             .symbol = "Cd",
             .range = {0, 2, true},
             .fallback = {0.67},
             .meaning = "of every opening",
             .practice = "0.6..0.7"},
            {.key = "transition_pressure_bar",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::transition_pressure);
             }),
             .symbol = "p_cr",
             .unit = kBar,
             .range = kPositive,
             .fallback = {0.1},
             .meaning = "below it the orifices are about linear",
             .practice = "regularisation"},
            {.key = "leakage_l_per_min_per_bar",
             .field = number_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::leakage); }),
             .symbol = "G",
             .unit = kLeakage,
             .range = kNotNegative,
             .fallback = {0.002},
             .meaning = "of each chamber to the case, laminar",
             .practice = "gives a volumetric efficiency of 94..97 % at 275 bar"},
            {.key = "case_bar",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::case_pressure);
             }),
             .unit = kBar,
             .range_here = [](const ConstView& v) -> std::optional<NumberRange> {
               return NumberRange{-in_file_unit(v.hydraulic_data()->atmosphere, kBar), kInfinity,
                                  true};
             },
             .range_words = "above -`atmosphere_bar`",
             .fallback = {0.0},
             .meaning = "case pressure, gauge"},
            {.key = "dead_volume_cm3",
             .field = number_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::dead_volume); }),
             .symbol = "V0",
             .unit = kCubicCentimetres,
             .range = kPositive,
             .fallback = {3.0},
             .meaning = "smallest volume of a chamber",
             .practice = "about a quarter of the stroke's 12.7 cm3"},
            {.key = "delivery_volume_l",
             .field = number_at([](const auto& v) {
               return in(v.hydraulic_data(), &HydraulicData::delivery_volume);
             }),
             .unit = kLitres,
             .range = kPositive,
             .fallback = {0.5},
             .meaning = "between pump and load, or delivery line"},
            {.key = "tolerance",
             .field = number_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::tolerance); }),
             .range = {1e-12, 1e-4},
             .fallback = {1e-10},
             .meaning = "relative error of pressure per step of the time integration at first"},
            {.key = "curve_error",
             .field = number_at(
                 [](const auto& v) { return in(v.hydraulic_data(), &HydraulicData::curve_error); }),
             .range = {1e-9, 1e-2},
             .fallback = {1e-7},
             .meaning =
                 "largest error of the curve that the models get, of its peak: `tolerance` is "
                 "tightened until the estimate of it is smaller"}}}),
      .rules = joined<Rule>(
          {port_rules("delivery", delivery),
           port_rules("suction", suction),
           {{.key = "delivery_arc_deg",
             .after = "delivery_arc_deg",
             .broken =
                 [](const ConstView& v) { return arc_refusal(&v.hydraulic_data()->delivery.arc); }},
            {.key = "suction_arc_deg",
             .after = "suction_arc_deg",
             .broken =
                 [](const ConstView& v) { return arc_refusal(&v.hydraulic_data()->suction.arc); }},
            {.key = "kidney_width_deg", .after = "kidney_width_deg", .broken = kidney_refusal},
            {.key = "kidney_ends", .after = "", .broken = ends_refusal},
            {.key = "atmosphere_bar", .after = "", .broken = vacuum_refusal},
            {.key = "vapour_bar", .after = "", .broken = boiling_refusal}}})};
}

Table oil_table() {
  return {.name = "oil",
          .meaning = "viscosity, for gaps and for laminar friction in lines",
          .part = &kHydraulicPart<kOil>,
          .parameters = {{.key = "temperature_C",
                          .field = number_of<kOil, &OilData::temperature>(),
                          .symbol = "T",
                          .unit = {"C"},
                          .range = {-50, 200},
                          .fallback = {60.0},
                          .meaning = "of the oil, everywhere"},
                         {.key = "viscosity_40C_cSt",
                          .field = number_of<kOil, &OilData::viscosity_40>(),
                          .symbol = "nu_40",
                          .unit = kCentistokes,
                          .range = {1, 1e5},
                          .fallback = {46.0},
                          .meaning = "kinematic, at 40 deg C and atmospheric pressure",
                          .practice = "ISO VG 46: 46"},
                         {.key = "viscosity_100C_cSt",
                          .field = number_of<kOil, &OilData::viscosity_100>(),
                          .symbol = "nu_100",
                          .unit = kCentistokes,
                          .range = {1, 1e5},
                          .range_words = "[1, 1e+05], below that at 40 deg C",
                          .fallback = {6.8},
                          .meaning = "the same at 100 deg C",
                          .practice = "ISO VG 46, viscosity index 100: 6.8"},
                         {.key = "pressure_viscosity_per_GPa",
                          .field = number_of<kOil, &OilData::pressure_viscosity>(),
                          .symbol = "alpha",
                          .unit = kPerGigapascal,
                          .range = {0, 100},
                          .fallback = {20.0},
                          .meaning = "viscosity grows as exp(alpha p)",
                          .practice = "mineral oil: 15..25"}},
          .rules = {{.key = "viscosity_100C_cSt",
                     .after = "viscosity_100C_cSt",
                     .broken = viscosity_refusal}}};
}

Table leakage_table() {
  return {
      .name = "leakage",
      .meaning = "gaps from each chamber to the case, beside `leakage_l_per_min_per_bar`; 0: none",
      .part = &kHydraulicPart<kGaps>,
      .parameters =
          {{.key = "piston_gap_um",
            .field = number_of<kGaps, &GapData::piston_gap>(),
            .symbol = "h",
            .unit = kMicrometres,
            .range = {0, 1000},
            .fallback = {0.0},
            .meaning = "between piston and bore, radial, of the concentric piston",
            .practice = "5..20"},
           {.key = "piston_gap_length_mm",
            .field = number_of<kGaps, &GapData::piston_gap_length>(),
            .symbol = "l",
            .unit = kMillimetres,
            .range = kNotNegative,
            .range_words = "> 0 with a gap",
            .fallback = {0.0},
            .meaning = "of that gap, along the bore"},
           {.key = "piston_gap_kind",
            .field = choice_at(
                [](const auto& v) { return in(hydraulic_part<kGaps>(v), &GapData::engaged); }),
            .words = {"land", "engaged"},
            .fallback = {std::string("land")},
            .meaning = "a land that moves with the piston, of the same length always; or what of "
                       "the piston is in the bore: the length is then the least, at the outer "
                       "dead centre, and grows by the piston's way in"},
           {.key = "eccentricity",
            .field = number_of<kGaps, &GapData::eccentricity>(),
            .symbol = "e",
            .range = {0, 1},
            .fallback = {0.0},
            .meaning = "of the piston in its bore, over the radial gap; 1: it touches"},
           {.key = "plate_gap_um",
            .field = number_of<kGaps, &GapData::plate_gap>(),
            .symbol = "h_p",
            .unit = kMicrometres,
            .range = {0, 1000},
            .fallback = {0.0},
            .meaning = "between block and port plate, over the lands of `[port_plate]`",
            .practice = "5..15"},
           {.key = "ring_slot_um",
            .field = number_of<kGaps, &GapData::ring_slot_height>(),
            .symbol = "h_r",
            .unit = kMicrometres,
            .range = {0, 1000},
            .fallback = {0.0},
            .meaning = "slot that a piston ring leaves at its joint"},
           {.key = "ring_slot_width_mm",
            .field = number_of<kGaps, &GapData::ring_slot_width>(),
            .symbol = "b_r",
            .unit = kMillimetres,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "of that slot, across the flow"},
           {.key = "ring_slot_length_mm",
            .field = number_of<kGaps, &GapData::ring_slot_length>(),
            .symbol = "l_r",
            .unit = kMillimetres,
            .range = kNotNegative,
            .range_words = "> 0 with a slot",
            .fallback = {0.0},
            .meaning = "of that slot, along the flow: the width of the ring"}},
      .rules = {{.key = "piston_gap_um", .after = "piston_gap_um", .broken = oil_refusal},
                {.key = "piston_gap_length_mm",
                 .after = "piston_gap_length_mm",
                 .broken = gap_length_refusal},
                {.key = "plate_gap_um", .after = "plate_gap_um", .broken = plate_gap_refusal},
                {.key = "ring_slot_length_mm",
                 .after = "ring_slot_length_mm",
                 .broken = ring_slot_refusal}}};
}

Table suction_line_table() {
  return {.name = "suction_line",
          .meaning = "pipe from the tank, which is at `suction_bar`, to the suction port",
          .part = &kHydraulicPart<kSuctionLine>,
          .parameters = {
              {.key = "length_m",
               .field = number_of<kSuctionLine, &SuctionLineData::length>(),
               .symbol = "L_s",
               .unit = kMetres,
               .range = {1e-3, 1000},
               .meaning = "the oil in it is one mass"},
              {.key = "diameter_mm",
               .field = number_of<kSuctionLine, &SuctionLineData::diameter>(),
               .symbol = "D_s",
               .unit = kMillimetres,
               .range = {0.1, 1e4},
               .meaning = "inside"},
              {.key = "loss_coefficient",
               .field = number_of<kSuctionLine, &SuctionLineData::loss>(),
               .symbol = "zeta",
               .range = kNotNegative,
               .fallback = {1.0},
               .meaning = "pressure lost over the dynamic pressure in the pipe; laminar friction "
                          "is added where there is `[oil]`",
               .practice = "entry 0.5, bend 0.3, filter more"},
              {.key = "volume_l",
               .field = number_of<kSuctionLine, &SuctionLineData::volume>(),
               .symbol = "V_s",
               .unit = kLitres,
               .range = kPositive,
               .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                              const SuctionLineData* line = hydraulic_part<kSuctionLine>(v);
                              if (line == nullptr) return std::nullopt;
                              return kPi / 8 * line->diameter * line->diameter * line->length * 1e3;
                            },
                            .words = "half of the pipe's"},
               .meaning = "between the suction line and the suction port"}}};
}

Table delivery_line_table() {
  return {.name = "delivery_line",
          .meaning = "pipe between delivery volume and load, in which waves run",
          .part = &kHydraulicPart<kDeliveryLine>,
          .parameters = {{.key = "length_m",
                          .field = number_of<kDeliveryLine, &DeliveryLineData::length>(),
                          .symbol = "L",
                          .unit = kMetres,
                          .range = {1e-3, 1000},
                          .meaning = "from the delivery volume to the load"},
                         {.key = "diameter_mm",
                          .field = number_of<kDeliveryLine, &DeliveryLineData::diameter>(),
                          .symbol = "D",
                          .unit = kMillimetres,
                          .range = {0.1, 1e4},
                          .meaning = "inside"},
                         {.key = "bandwidth_Hz",
                          .field = number_of<kDeliveryLine, &DeliveryLineData::bandwidth>(),
                          .symbol = "f",
                          .unit = {"Hz"},
                          .range = {1, 1e6},
                          .range_words = "[1, 1e+06], at most 48 modes",
                          .fallback = {1000.0},
                          .meaning = "up to which waves in it are right to 1e-3",
                          .practice = "8 times the pistons' frequency"},
                         {.key = "wave_speed_m_per_s",
                          .field = number_of<kDeliveryLine, &DeliveryLineData::wave_speed>(),
                          .symbol = "c",
                          .unit = {"m/s"},
                          .range = {0, 1e5},
                          .fallback = {0.0},
                          .meaning = "0: that of the oil at `delivery_bar`, in a rigid pipe",
                          .practice = "hose: 600..900"}}};
}

Table load_table() {
  CurveField share = curve_at([](const auto& v) {
    return in(in(hydraulic_part<kLoad>(v), &LoadData::share), &TimeCurve::file);
  });
  share.share = [](const View& v) { return &hydraulic_part<kLoad>(v)->share; };
  return {
      .name = "load",
      .meaning = "what the pump delivers against; an orifice where there is no such table",
      .part = &kHydraulicPart<kLoad>,
      .parameters =
          {{.key = "kind",
            .field = choice_at(
                [](const auto& v) { return in(hydraulic_part<kLoad>(v), &LoadData::kind); }),
            .words = {"orifice", "laminar", "relief_valve", "constant_pressure", "flow"},
            .fallback = {std::string("orifice")},
            .meaning =
                "orifice and laminar: of the size that gives the mean `delivery_bar`, or of "
                "that given, then the pressure follows; "
                "relief_valve: likewise by its cracking pressure; "
                "constant_pressure: a line held at `delivery_bar`; flow: takes a given flow"},
           {.key = "cracking_bar",
            .field = number_of<kLoad, &LoadData::cracking_pressure>(),
            .symbol = "p_c",
            .unit = kBar,
            .range = {0, 10000},
            .fallback = {0.0},
            .meaning = "pressure at which the valve begins to open; 0: sought",
            .active = kReliefValve},
           {.key = "opening_mm2_per_bar",
            .field = number_of<kLoad, &LoadData::opening>(),
            .symbol = "k",
            .unit = kAreaPerPressure,
            .range = kPositive,
            .fallback = {1.0},
            .meaning = "area that a relief valve opens per pressure above its cracking pressure",
            .practice = "95 l/min at 275 bar take about 9 mm2",
            .active = kAnyRelief},
           {.key = "full_area_mm2",
            .field = number_of<kLoad, &LoadData::full_area>(),
            .unit = kSquareMillimetres,
            .range = kPositive,
            .fallback = {100.0},
            .meaning = "area of the valve fully open",
            .active = kAnyRelief},
           {.key = "area_mm2",
            .field = number_of<kLoad, &LoadData::area>(),
            .symbol = "a",
            .unit = kSquareMillimetres,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "of the orifice; 0: sought",
            .active = kOrifice},
           {.key = "conductance_l_per_min_per_bar",
            .field = number_of<kLoad, &LoadData::conductance>(),
            .symbol = "G_L",
            .unit = kLeakage,
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "of the laminar load; 0: sought",
            .active = kLaminar},
           {.key = "relief_bar",
            .field = number_of<kLoad, &LoadData::relief_pressure>(),
            .symbol = "p_r",
            .unit = kBar,
            .range = {0, 10000},
            .fallback = {0.0},
            .meaning = "cracking pressure of a relief valve beside the load; 0: none",
            .active = kBesideRelief},
           {.key = "file",
            .field = share,
            .fallback = {std::string()},
            .meaning =
                "CSV `time_s,share`, path relative to the case file, at least 4 points from a "
                "time <= 0 on: in `bentaxis simulate` the load's size (of a relief valve its "
                "cracking pressure) is times that; other commands leave it aside; empty: none",
            .active = kSizedLoad},
           {.key = "flow_l_per_min",
            .field = number_of<kLoad, &LoadData::flow>(),
            .symbol = "Q",
            .unit = kLitresPerMinute,
            .range = kNotNegative,
            .range_words = "> 0, below displacement x speed",
            .meaning = "taken whatever the pressure, at the density in the tank; the pressure "
                       "follows, and `delivery_bar` is where its search starts",
            .active = kGivenFlow}},
      .rules = {{.key = "file", .after = "file", .broken = share_refusal}}};
}

Table accumulator_table() {
  return {.name = "accumulator",
          .meaning = "gas spring at the delivery volume",
          .part = &kHydraulicPart<kAccumulator>,
          .parameters = {{.key = "gas_volume_l",
                          .field = number_of<kAccumulator, &AccumulatorData::gas_volume>(),
                          .symbol = "V_g",
                          .unit = kLitres,
                          .range = {1e-6, 1e4},
                          .meaning = "of the gas at the precharge"},
                         {.key = "precharge_bar",
                          .field = number_of<kAccumulator, &AccumulatorData::precharge>(),
                          .symbol = "p_g",
                          .unit = kBar,
                          .range = {0, 10000},
                          .meaning = "gauge pressure of the gas without oil; below it the gas "
                                     "expands no further",
                          .practice = "0.6..0.9 of the working pressure"},
                         {.key = "gas_exponent",
                          .field = number_of<kAccumulator, &AccumulatorData::exponent>(),
                          .symbol = "n_g",
                          .range = {1, 1.67},
                          .fallback = {1.4},
                          .meaning = "polytropic exponent of the gas",
                          .practice = "fast: 1.4, at high pressure more; slow: 1"},
                         {.key = "inlet_area_mm2",
                          .field = number_of<kAccumulator, &AccumulatorData::inlet_area>(),
                          .symbol = "a_g",
                          .unit = kSquareMillimetres,
                          .range = kPositive,
                          .fallback = {100.0},
                          .meaning = "orifice between it and the delivery volume"}},
          .rules = {{.key = "gas_volume_l", .after = "", .broken = accumulator_refusal}}};
}

Table loop_table() {
  return {.name = "loop",
          .meaning =
              "closed circuit: the load leads into a volume at the suction port, and a "
              "charge supply at `suction_bar` feeds either side through a check valve",
          .part = &kHydraulicPart<kLoop>,
          .parameters = {{.key = "volume_l",
                          .field = number_of<kLoop, &LoopData::volume>(),
                          .symbol = "V_s",
                          .unit = kLitres,
                          .range = kPositive,
                          .fallback = {0.5},
                          .meaning = "of the closed loop at the suction port"},
                         {.key = "charge_area_mm2",
                          .field = number_of<kLoop, &LoopData::charge_area>(),
                          .symbol = "a_c",
                          .unit = kSquareMillimetres,
                          .range = kPositive,
                          .fallback = {50.0},
                          .meaning = "of each check valve, fully open"},
                         {.key = "charge_opening_bar",
                          .field = number_of<kLoop, &LoopData::opening>(),
                          .unit = kBar,
                          .range = {1e-3, 1000},
                          .fallback = {1.0},
                          .meaning = "pressure difference over which its area grows from 0 to "
                                     "that, in proportion"}},
          .rules = {{.key = "volume_l", .after = "", .broken = loop_refusal}}};
}

std::string curve_refusal(const ConstView& v) {
  const DriveSpec& drive = *v.drive_spec();
  if (drive.curve.time.empty()) return "";
  return drive.curve.time.size() >= 4 && drive.curve.time.size() == drive.curve.value.size()
             ? ""
             : "must have at least 4 points";
}

Table drive_table() {
  CurveField curve = curve_at(
      [](const auto& v) { return in(in(v.drive_spec(), &DriveSpec::curve), &TimeCurve::file); });
  curve.drive = [](const View& v) { return v.drive_spec(); };
  return {
      .name = "drive",
      .meaning =
          "what turns the shaft in `bentaxis simulate`, and for how long; other commands "
          "leave it aside",
      .part = &kDrive,
      .parameters =
          {{.key = "kind",
            .field = choice_at([](const auto& v) { return in(v.drive_spec(), &DriveSpec::kind); }),
            .words = {"speed", "torque", "motor"},
            .fallback = {std::string("speed")},
            .meaning = "the shaft's speed is given; a torque turns it; or a rotor turns it through "
                       "a coupling, Td = K (phi - theta) + D (phi' - theta')"},
           {.key = "file",
            .field = curve,
            .fallback = {std::string()},
            .meaning =
                "CSV `time_s,speed_rpm` or `time_s,torque_Nm`, path relative to the case "
                "file, at least 4 points from a time <= 0 on: the speed or the torque over time "
                "instead; of a motor `speed_rpm,torque_Nm`, its torque over its speed; empty: "
                "none"},
           {.key = "torque_Nm",
            .field =
                number_at([](const auto& v) { return in(v.drive_spec(), &DriveSpec::torque); }),
            .symbol = "Td, T0",
            .unit = {"Nm"},
            .fallback = {.computed = [](const ConstView& v) -> std::optional<Value> {
                           if (v.drive_spec()->curve.time.empty()) return std::nullopt;
                           return 0.0;
                         },
                         .words = "required, but beside a `file`"},
            .meaning =
                "of the drive, or of a motor at the speed of `[operation]`; unused beside a `file`",
            .active = kGivenTorque},
           {.key = "torque_slope_Nm_s_per_rad",
            .field =
                number_at([](const auto& v) { return in(v.motor(), &MotorData::torque_slope); }),
            .symbol = "s",
            .unit = {"Nm s/rad"},
            .fallback = {0.0},
            .meaning = "the motor's torque is T0 - s (phi' - omega), beside a `file` it is unused",
            .part = &kMotorData},
           {.key = "rotor_inertia_kg_m2",
            .field =
                number_at([](const auto& v) { return in(v.motor(), &MotorData::rotor_inertia); }),
            .symbol = "J_m",
            .unit = {"kg m2"},
            .range = kPositive,
            .meaning = "of the rotor, at the angle phi",
            .part = &kMotorData},
           {.key = "coupling_stiffness_Nm_per_rad",
            .field = number_at(
                [](const auto& v) { return in(v.motor(), &MotorData::coupling_stiffness); }),
            .symbol = "K",
            .unit = {"Nm/rad"},
            .range = kPositive,
            .meaning = "of the coupling",
            .part = &kMotorData},
           {.key = "coupling_damping_Nm_s_per_rad",
            .field = number_at(
                [](const auto& v) { return in(v.motor(), &MotorData::coupling_damping); }),
            .symbol = "D",
            .unit = {"Nm s/rad"},
            .range = kNotNegative,
            .fallback = {0.0},
            .meaning = "of the coupling",
            .part = &kMotorData},
           {.key = "start_rpm",
            .field = number_at([](const auto& v) { return v.start_speed(); }),
            .unit = kRotation,
            .fallback = {.words = "`speed_rpm`"},
            .meaning = "speed of every body at the start, not beside a given speed; from 0 the "
                       "coupling is unwound",
            .part = &kStartSpeed},
           {.key = "duration_s",
            .field =
                number_at([](const auto& v) { return in(v.drive_spec(), &DriveSpec::duration); }),
            .unit = {"s"},
            .range = kPositive,
            .meaning = "simulated time"},
           {.key = "samples",
            .field =
                integer_at([](const auto& v) { return in(v.drive_spec(), &DriveSpec::samples); }),
            .range = kCount,
            .meaning = "rows at 0, duration/samples, .., duration"}},
      .rules = {{.key = "file", .after = "file", .broken = curve_refusal}}};
}

}  // namespace

const Registry& standard_registry() {
  static const Registry registry{
      {top_level(),
       pump_table(),
       gear_table(),
       bearings_table(),
       piston_table(),
       shaft_table(),
       block_table(),
       friction_table(),
       operation_table(),
       drive_table(),
       pressure_table(),
       port_plate_table(),
       hydraulics_table(),
       oil_table(),
       leakage_table(),
       suction_line_table(),
       delivery_line_table(),
       load_table(),
       accumulator_table(),
       loop_table(),
       assumptions_table("analytic", [](const auto& v) { return v.analytic; }),
       multibody_assumptions_table(),
       plausibility_table()}};
  return registry;
}

}  // namespace bentaxis
