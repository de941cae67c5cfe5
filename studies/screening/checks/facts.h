// What the plausibility checks look at: a case, what follows from it, and one turn of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/analytic/validity.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::study::checks {

// Limits that several checks share.
inline constexpr double kSteel = 8000;          // kg/m3; bronze is a tenth more
inline constexpr double kYield = 1000e6;        // Pa, of hardened steel
inline constexpr double kMaxPressure = 1000e5;  // Pa; hydraulic pumps end at 500 bar
inline constexpr double kLightLoad = 100e5;     // Pa; below it losses are no shares of the power

inline double bar(double pascals) { return pascals / kPascalPerBar; }
inline double mm(double metres) { return metres * 1e3; }
inline double mm2(double area) { return area * 1e6; }
inline double deg(double angle) { return angle / kRadPerDegree; }
inline double square(double x) { return x * x; }
// Smallest bore that fills its room.
inline double least_filling(int pistons) { return pistons > 2 ? 0.5 : 0.15; }

struct Turn {
  double work_ratio = 1;     // of pressure on a piston over a turn, over the ideal one
  double mean_pressure = 0;  // Pa
  double lowest_pressure = 0, highest_pressure = 0;
  double land_force = 0, press_force = 0;  // N, mean
  std::vector<analytic::ValidityLimit> limits;
  bool ideal_pressure = false;  // instead of that of the oil, which is still to be computed
};

// Where pistons carry the block: its free play over a turn, and how fast the piston that carries on
// the driving side leaves its wall.
struct Walls {
  double share = 1;                     // w = 1 - l_c/b1
  double widest = 0, widest_deg = 0;    // rad, and where
  double without_deg = not_computed();  // an angle without free play
  double leaving = 0, leaving_deg = 0;  // m/s, and where
  // m from A along the piston that carries to the end of its bore, at most, and where. Joints stay
  // outside of the block: it ends where each of them comes nearest to it in its stroke.
  double outside = 0, outside_deg = 0;
};

struct Facts {
  explicit Facts(const Case& of);

  const Case& the_case;
  const PumpParameters& pump;
  const Geometry& g;
  const PortPressures& ports;
  const HydraulicData* oil;
  analytic::DerivedQuantities derived;
  double speed;         // rpm, magnitude
  double piston_speed;  // m/s, mean
  double spacing;       // m, between the axes of neighbouring bores; 0 with one piston
  double bore_room;     // m, the bore at which bores overlap
  // What other checks take for the bore, so that a wrong one is said once: where it is no bore for
  // this circle, a usual one.
  double bore, area;    // m, m2
  double bores_radius;  // m, that encloses all bores
  double highest;       // Pa, of the port pressures, at most kMaxPressure
  double load;          // Pa, likewise, at least kLightLoad
  double piston_span;   // m, length of a piston with its ball and head
  double block_length;  // m
  double shaft_reach;   // m, from the joints to the farther bearing, at most 10 Ra
  double full_torque;   // Nm, ideal torque at `load` if the axes stood at a right angle
  bool real;            // whether the data of real pistons are used
  std::optional<Turn> turn;
  std::optional<Walls> walls;

  /// Whether a value is the default of its key, stated or not.
  bool defaulted(const std::string& table, const std::string& key) const;
  /// The limit of validity of this name, where it applies to the turn.
  const analytic::ValidityLimit* limit(const std::string& name) const;
};

}  // namespace bentaxis::study::checks
