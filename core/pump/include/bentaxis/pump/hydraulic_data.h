// The raw description of the hydraulic side of a pump: oil, ports, leakage, delivery line.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "bentaxis/pump/drive_spec.h"
#include "bentaxis/pump/parameters.h"

namespace bentaxis {

/// How the opening of a silencing notch grows with the length of it that the kidney has passed.
enum class NotchLaw {
  quadratic,  ///< V groove whose width and depth grow alike: area in proportion to the square
  linear,     ///< groove of constant depth: area in proportion to the length
};

/// Silencing notch beside a port: it goes on from the port's leading or trailing edge by
/// `length_deg` into the bridge.
struct Notch {
  double length_deg = 0;  ///< 0 = no notch
  double area = 0;        ///< m2, at its root, where it meets the port
};

/// Relief groove: a channel of constant cross-section in the bridge that leads to the port. A
/// kidney over it uncovers a mouth of its width x the overlap; the smaller of mouth and
/// cross-section is what is open.
struct ReliefGroove {
  double from_deg = 0, to_deg = 0;  ///< where it lies
  double width = 0;                 ///< m, radial
  double area = 0;                  ///< m2, cross-section; 0 = no groove
};

/// Hole in the bridge, on the bore circle, that leads to the port.
struct PlateHole {
  double angle_deg = 0;  ///< of its centre
  double diameter = 0;   ///< m; 0 = no hole
};

/// Opening of a port as a table over the chamber's own angle, in place of its geometry. Angles in
/// degrees: strictly increasing, spanning less than 360, end point not repeated; areas in m2.
struct OpeningTable {
  std::filesystem::path file;
  std::vector<double> theta_deg;  ///< empty: no table; else at least 3
  std::vector<double> area;
};

/// Stroke of a piston, or volume of a chamber, as a table over the chamber's own angle: the oil's
/// chambers follow it in place of the pump's kinematics. Angles as in OpeningTable.
struct StrokeTable {
  std::filesystem::path file;
  std::vector<double> theta_deg;  ///< empty: no table; else at least 4
  /// m, how far the piston is out of its bore, from any zero; or m3, volume of a chamber.
  std::vector<double> value;
  bool is_volume = false;
};

/// One port of the fixed plate as the kidneys of the block see it.
struct PlatePort {
  PortArc arc;                ///< degrees; psi as in PortArc
  Notch notch = {};           ///< before its leading edge
  Notch trailing_notch = {};  ///< behind its trailing edge
  ReliefGroove groove = {};
  std::array<PlateHole, 2> holes = {};
  OpeningTable table = {};
  std::optional<double> discharge_coefficient = {};  ///< of its openings; none: the common one
};

/// Ends of the block's kidneys and, where they are circular, of the ports.
enum class KidneyEnds {
  rounded,   ///< the opening grows as the square of the overlap over `kidney_rounding_deg`
  circular,  ///< semicircles as wide as the kidney is high, on kidney and port
};

/// What low pressure does to the oil.
enum class Cavitation {
  ignored,      ///< entrained air alone: none dissolves or comes out, no vapour
  equilibrium,  ///< dissolved air comes out by Henry's law; bubbles hold saturated vapour
  rate,         ///< likewise, but what is out follows that equilibrium with time constants
};

/// How volume and density of the oil follow from its pressure.
enum class OilLaw {
  entrained_air,     ///< a constant or linearly growing bulk modulus, and entrained air that stays
  dissolving_air,    ///< the same, but the air dissolves as the pressure rises
  dowson_higginson,  ///< density of a mineral oil by Dowson and Higginson, and entrained air
  constant_density,  ///< one density in every flow and balance, with a constant bulk modulus
};

/// What the pump delivers against. Size: what is given, or sought so that the mean delivery
/// pressure is the one asked for.
enum class LoadKind {
  orifice,       ///< its area is the size
  laminar,       ///< flow in proportion to pressure; its conductance is the size
  relief_valve,  ///< opens in proportion to the pressure above cracking, which is given or sought
  constant_pressure,  ///< a line held at the delivery pressure
  flow,               ///< takes a given flow; the pressure follows
};

/// `[load]`.
struct LoadData {
  LoadKind kind = LoadKind::orifice;
  // Of the relief valve.
  double cracking_pressure = 0;  ///< Pa gauge; 0: sought
  double opening = 1e-11;        ///< m2/Pa, area per pressure above cracking
  double full_area = 1e-4;       ///< m2, fully open
  double flow = 0;               ///< m3/s, given, at the density in the suction port
  double area = 0;               ///< m2, of the orifice; 0: sought
  double conductance = 0;        ///< m3/(s Pa), of the laminar load; 0: sought
  /// Pa, cracking pressure of a relief valve beside an orifice, a laminar load or a given flow; 0:
  /// none.
  double relief_pressure = 0;
  TimeCurve share = {};  ///< of the size over time, in a simulation

  /// Whether the mean delivery pressure follows from the load instead of being asked for.
  bool sets_pressure() const {
    return kind == LoadKind::flow || (kind == LoadKind::orifice && area > 0) ||
           (kind == LoadKind::laminar && conductance > 0) ||
           (kind == LoadKind::relief_valve && cracking_pressure > 0);
  }
  /// Whether there is a relief valve beside the load.
  bool has_relief() const {
    return relief_pressure > 0 && kind != LoadKind::relief_valve &&
           kind != LoadKind::constant_pressure;
  }
};

/// `[delivery_line]`: a pipe between the delivery volume and the load.
struct DeliveryLineData {
  double length = 0, diameter = 0;  ///< m, inside
  double bandwidth = 0;             ///< Hz, up to which waves in it are right
  double wave_speed = 0;            ///< m/s; 0: that of the oil at the delivery pressure
};

/// `[suction_line]`: a pipe from the tank to a volume at the suction port.
struct SuctionLineData {
  double length = 0, diameter = 0;  ///< m, inside
  double loss = 0;                  ///< zeta: pressure loss over the dynamic pressure in the pipe
  double volume = 0;                ///< m3, at the port
};

/// `[accumulator]`: a gas spring at the delivery volume.
struct AccumulatorData {
  double gas_volume = 0;  ///< m3, at the precharge
  double precharge = 0;   ///< Pa gauge
  double exponent = 1.4;  ///< n of the gas, p V^n = const
  double inlet_area = 0;  ///< m2, orifice between it and the delivery volume
};

/// `[loop]`: the load leads into a volume at the suction port, and a charge supply at the suction
/// pressure fills either side through a check valve.
struct LoopData {
  double volume = 0;       ///< m3, at the suction port
  double charge_area = 0;  ///< m2, of each check valve, fully open
  double opening = 1e5;    ///< Pa, pressure difference over which it opens
};

/// `[oil]`: viscosity.
struct OilData {
  double temperature = 60;            ///< deg C
  double viscosity_40 = 46e-6;        ///< m2/s, kinematic, at 40 deg C and atmospheric pressure
  double viscosity_100 = 6.8e-6;      ///< m2/s, likewise at 100 deg C
  double pressure_viscosity = 20e-9;  ///< 1/Pa, alpha of Barus' law
};

/// `[leakage]`: gaps from each chamber to the case; a gap of 0 is none.
struct GapData {
  double piston_gap = 0;         ///< m, radial, of the concentric piston
  double piston_gap_length = 0;  ///< m; where it is the engaged one, the least over the turn
  bool engaged = false;          ///< the gap is longer where the piston is deeper in
  double eccentricity = 0;       ///< over the radial gap, 0..1
  double plate_gap = 0;          ///< m, between block and port plate
  double ring_slot_height = 0;   ///< m, gap that a piston ring leaves at its joint
  double ring_slot_width = 0;    ///< m
  double ring_slot_length = 0;   ///< m, along the flow: the ring's width
};

/// All that the chamber pressures depend on beyond geometry and speed. Pressures in Pa; those of
/// `[pressure]` and of the case are gauge.
struct HydraulicData {
  // Oil with entrained air.
  OilLaw oil_law = OilLaw::entrained_air;
  double density = 0;             ///< kg/m3, of the oil without air at atmospheric pressure
  double bulk_modulus = 0;        ///< Pa, of the oil without air, isentropic
  double air_share = 0;           ///< volume of air / volume of both at atmospheric pressure, > 0
  double air_exponent = 0;        ///< polytropic exponent n of the air, p V^n = const
  double atmosphere = 0;          ///< Pa absolute, where gauge pressure is 0
  double bulk_modulus_slope = 0;  ///< K', dK/dp of the oil without air
  Cavitation cavitation = Cavitation::ignored;
  double dissolved_air = 0;        ///< volume at P0 of the air dissolved at saturation / oil's
  double saturation_pressure = 0;  ///< Pa gauge: below it dissolved air comes out
  double vapour_pressure = 0;      ///< Pa absolute, of the oil
  // Of Cavitation::rate, s.
  double release_time = 0.01, dissolution_time = 0.1;
  double dissolved_pressure = 30e5;  ///< Pa gauge: from there on OilLaw::dissolving_air has no air
  /// 1/Pa, a and b of OilLaw::dowson_higginson.
  double compressibility = 0.6e-9, compressibility_decrease = 1.7e-9;
  double lowest_pressure = 10;  ///< Pa absolute, of OilLaw::constant_density
  // Flow between the kidney of a chamber (in the block) and the ports of the plate.
  PlatePort delivery, suction;
  double kidney_width_deg = 0;  ///< of a block kidney, seen from the block axis
  double kidney_height = 0;     ///< m, radial
  KidneyEnds kidney_ends = KidneyEnds::rounded;
  double kidney_rounding_deg = 0;  ///< overlap over which the opening grows as its square
  NotchLaw notch_law = NotchLaw::quadratic;
  double discharge_coefficient = 0;  ///< Cd
  double transition_pressure = 0;    ///< Pa, p_cr: below it the orifices are about linear
  // The rest.
  double leakage = 0;            ///< m3/(s Pa), each chamber to the case, laminar
  double case_pressure = 0;      ///< Pa gauge
  double dead_volume = 0;        ///< V0, m3: smallest volume of a chamber
  StrokeTable stroke = {};       ///< in place of the pump's kinematics
  double delivery_volume = 0;    ///< m3, between pump and load
  std::optional<LoadData> load;  ///< an orifice where there is none
  std::optional<DeliveryLineData> delivery_line;
  std::optional<SuctionLineData> suction_line;
  std::optional<AccumulatorData> accumulator;
  std::optional<LoopData> loop;  ///< an open circuit where there is none
  std::optional<OilData> oil;
  std::optional<GapData> gaps;
  double tolerance = 0;       ///< relative error of pressure per step of the time integration
  double curve_error = 1e-7;  ///< largest of the computed curve, of its peak
};

}  // namespace bentaxis
