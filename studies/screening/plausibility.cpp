#include "bentaxis/study/plausibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numeric>
#include <optional>

#include "bentaxis/analytic/derived.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/analytic/validity.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/periodic_spline.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/samples.h"
#include "bentaxis/study/timing.h"
#include "bentaxis/study/turn_summary.h"

namespace bentaxis::study {
namespace {

// ---- Limits that are no geometry

constexpr double kSteel = 8000;     // kg/m3; bronze is a tenth more
constexpr double kYield = 1000e6;   // Pa, of hardened steel
constexpr double kLightest = 0.06;  // of solid steel: hollow aluminium is a third of it, halved
constexpr double kMaxPressure = 1000e5;  // Pa; hydraulic pumps end at 500 bar
constexpr double kFastest = 10;          // m/s, mean piston speed; bent-axis pumps reach 5..7
constexpr double kSlowest = 0.05;        // m/s
constexpr double kCreep = 1;             // m/s, below it losses are no longer shares of the power
constexpr double kLightLoad = 100e5;     // Pa, likewise
constexpr int kTurnAngles = 72;          // of what is a mean or a share of the turn
constexpr int kPlayAngles = 360;
constexpr double kCardanTilt = 25;       // deg; the block's speed ripples by 20 %
constexpr double kWidePlay = 5;          // deg, of a block that pistons carry
constexpr double kShareOfTurn = 0.05;    // a limit violated for less is an edge of the pressure
constexpr double kOutsideShare = 0.25;   // likewise of the film force's point, when ports open
constexpr double kIdealTransition = 20;  // deg, where the pressure is still to be computed

double bar(double pascals) { return pascals / kPascalPerBar; }
double mm(double metres) { return metres * 1e3; }
double mm2(double area) { return area * 1e6; }
double deg(double angle) { return angle / kRadPerDegree; }
double square(double x) { return x * x; }
// Smallest bore that fills its room.
double least_filling(int pistons) { return pistons > 2 ? 0.5 : 0.15; }

// ---- What the checks look at

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

  // A default that a file states, as those that commands write do, is nobody's number either.
  bool defaulted(const std::string& table, const std::string& key) const {
    const Parameter& parameter = parameter_of(standard_registry(), table, key);
    if (const auto value = default_of(parameter, the_case);
        value && value == value_of(parameter, the_case))
      return true;
    for (const InputEntry& entry : the_case.entries)
      if (entry.table == table && entry.key == key) return entry.defaulted;
    return the_case.entries.empty();
  }
  const analytic::ValidityLimit* limit(const std::string& name) const {
    if (!turn) return nullptr;
    for (const auto& limit : turn->limits)
      if (limit.name == name) return limit.applicable ? &limit : nullptr;
    return nullptr;
  }
};

double land_area(const PortPlate& plate, const PortArc& arc) {
  const double radial = (square(plate.r3) - square(plate.r2)) / 2 +
                        (plate.r4 - plate.r3) * (2 * plate.r3 + plate.r4) / 6 +
                        (plate.r2 - plate.r1) * (2 * plate.r2 + plate.r1) / 6;
  return radial * (arc.to_deg - arc.from_deg) * kRadPerDegree;
}

std::optional<Turn> turn_of(const Facts& f) {
  Case c = f.the_case;
  c.operation.revolutions = 1;
  Turn turn;
  turn.ideal_pressure = lacks_pressure(c.pressure);
  if (turn.ideal_pressure) {
    c.pressure.kind = PressureKind::ideal;
    c.pressure.transition_deg = kIdealTransition;
    c.pressure.delivery_start_deg = 180;
  }
  try {
    const PressureTrace trace(c.pressure);
    turn.limits = limits_of_turn(c, c.analytic, trace);
    c.operation.samples_per_revolution = kTurnAngles;
    const ResultTable table = analytic::run(c, c.analytic, sample_case(c, trace));
    const ChannelLayout at(c.pump);
    const std::size_t rows = table.rows();
    turn.lowest_pressure = turn.highest_pressure = trace(table.theta_deg[0]);
    if (c.pressure.kind == PressureKind::curve) {
      const auto all =
          PeriodicSpline(c.pressure.curve.theta_deg, c.pressure.curve.pressure).extremes();
      turn.lowest_pressure = all.least;
      turn.highest_pressure = all.greatest;
    }
    double work = 0;
    for (std::size_t row = 0; row < rows; ++row) {
      const double p = trace(table.theta_deg[row]);
      work += (p - f.ports.suction) *
              (table.at((row + 1) % rows, at.zB(0)) - table.at((row + rows - 1) % rows, at.zB(0))) /
              2e3;
      turn.mean_pressure += p / static_cast<double>(rows);
      turn.lowest_pressure = std::min(turn.lowest_pressure, p);
      turn.highest_pressure = std::max(turn.highest_pressure, p);
    }
    const double ideal = (f.ports.delivery - f.ports.suction) * f.derived.stroke;
    if (ideal > 0) turn.work_ratio = work / ideal;
    turn.press_force =
        c.pump.block.spring_force + f.g.pistons * c.pump.block.bottom_area * turn.mean_pressure;
    if (c.pump.port_plate)
      turn.land_force =
          land_area(*c.pump.port_plate, c.pump.port_plate->delivery) * f.ports.delivery +
          land_area(*c.pump.port_plate, c.pump.port_plate->suction) * f.ports.suction;
    return turn;
  } catch (const InputError&) {
    return std::nullopt;  // the run itself will say it
  } catch (const ComputationError&) {
    return std::nullopt;
  }
}

std::optional<Walls> walls_of(const Facts& f) {
  if (f.pump.transfer.kind != TransferKind::pistons || !f.pump.transfer.wall) return std::nullopt;
  try {
    const analytic::Model model(f.pump, f.the_case.analytic);
    const double omega = rad_per_second(f.the_case.operation.speed_rpm);
    Walls walls;
    walls.share = 1 - f.pump.transfer.wall->from_joint / f.g.piston_length;
    for (int i = 0; i < kPlayAngles; ++i) {
      const double theta_deg = 360.0 * i / kPlayAngles, theta = radians(theta_deg);
      const analytic::FreePlay play = model.free_play(theta);
      if (!play.exists) {
        walls.without_deg = theta_deg;
        continue;
      }
      if (play.high - play.low > walls.widest) {
        walls.widest = play.high - play.low;
        walls.widest_deg = theta_deg;
      }
      const double lag = omega < 0 ? play.low : play.high;
      const int piston = omega < 0 ? play.low_piston : play.high_piston;
      const auto off_bore = [&](double turned) {
        const double at = theta + turned - 2 * kPi * piston / f.g.pistons;
        return joint_distance(f.g, at, at - lag);
      };
      const auto approach = [&](double turned) { return walls.share * off_bore(turned); };
      const double withdrawn = f.g.joint_circle_radius * std::sin(f.g.tilt) *
                               (1 - std::cos(theta - 2 * kPi * piston / f.g.pistons));
      const double slant = std::sqrt(1 - std::pow(off_bore(0) / f.g.piston_length, 2));
      if (withdrawn / slant > walls.outside) {
        walls.outside = withdrawn / slant;
        walls.outside_deg = theta_deg;
      }
      const double step = 1e-5;
      const double rate = omega * (approach(step) - approach(-step)) / (2 * step);
      if (-rate > walls.leaving) {
        walls.leaving = -rate;
        walls.leaving_deg = theta_deg;
      }
    }
    return walls;
  } catch (const InputError&) {
    return std::nullopt;  // the run itself will say it
  }
}

Facts::Facts(const Case& of)
    : the_case(of),
      pump(of.pump),
      g(of.pump.geometry),
      ports(of.pressure.ports),
      oil(of.hydraulics && of.pressure.kind == PressureKind::hydraulic ? &*of.hydraulics : nullptr),
      derived(analytic::derived_quantities(pump)),
      speed(std::abs(of.operation.speed_rpm)),
      piston_speed(2 * derived.stroke * speed / 60),
      spacing(g.pistons > 1 ? 2 * g.bore_circle_radius * std::sin(kPi / g.pistons) : 0),
      bore_room(g.pistons > 2 ? spacing : 2 * g.bore_circle_radius),
      bore(g.bore_diameter < bore_room && g.bore_diameter >= least_filling(g.pistons) * bore_room
               ? g.bore_diameter
               : 0.8 * bore_room),
      area(kPi / 4 * square(bore)),
      bores_radius(g.bore_circle_radius + bore / 2),
      highest(std::min(std::max(std::abs(ports.delivery), std::abs(ports.suction)), kMaxPressure)),
      load(std::max(highest, kLightLoad)),
      piston_span(g.piston_length + bore),
      block_length(g.piston_length + derived.stroke),
      shaft_reach(std::min(
          10 * g.joint_circle_radius,
          std::max(std::abs(pump.bearings.tapered_z), std::abs(pump.bearings.cylindrical_z)))),
      full_torque(g.pistons * area * g.joint_circle_radius * load / kPi),
      real(pump.piston.real && (pump.piston.inertia != PistonInertia::lumped ||
                                of.analytic.inertia != PistonInertia::lumped ||
                                of.multibody.inertia != PistonInertia::lumped)) {
  turn = turn_of(*this);
  walls = walls_of(*this);
}

// ---- Words

constexpr double kFarSlip = 3;

using Slips = std::vector<Slip>;
constexpr Slip kPsi{0.0689476, "in psi?"};
using namespace slips;

// The first slip that explains a value outside of [low, high]; a slip that would move it by far
// more than it is outside explains nothing.
std::string guess(double value, double low, double high, const Slips& slips) {
  const double off = value > high ? value / high : low / value;
  for (const Slip& slip : slips) {
    const double meant = value * slip.factor;
    const double moved = std::max(std::abs(slip.factor), 1 / std::abs(slip.factor));
    if (meant >= low && meant <= high &&
        (moved <= kFarSlip || !(off > 0) || moved <= kFarSlip * off * off))
      return fmt::format("; {} {:.4g} would do", slip.words, meant);
  }
  return "";
}

// "" where value is in [low, high].
std::string outside(const std::string& key, double value, double low, double high,
                    const std::string& unit, const std::string& why, const Slips& slips = {}) {
  if (value >= low && value <= high) return "";
  const bool below = value < low;
  return fmt::format("{} = {:.6g} is {} {:.4g}{}: {}{}", key, value, below ? "below" : "above",
                     below ? low : high, unit_after(unit), why, guess(value, low, high, slips));
}

// The same of a number of the case, as its file has it. Also "" where it is not there or unused.
// @param shown  the key, behind the table where a reader would not know which is meant
std::string outside(const Facts& f, const char* table_name, const std::string& shown, double low,
                    double high, const std::string& why, const Slips& slips = {}) {
  const Table& table = table_of(standard_registry(), table_name);
  const Parameter& parameter =
      parameter_of(standard_registry(), table_name, shown.substr(shown.rfind(' ') + 1));
  const auto value = value_of(parameter, f.the_case);
  const bool unused = table.part != nullptr && !table.part->needed.words.empty() &&
                      !holds(table.part->needed, standard_registry(), f.the_case);
  if (unused || !value) return "";
  const auto* const whole = std::get_if<int>(&*value);
  return outside(shown, whole != nullptr ? *whole : std::get<double>(*value), low, high,
                 parameter.unit.name, why, slips);
}

// "" where a number of the case is in the range that its entry holds for plausible.
std::string implausible(const Facts& f, const char* table, const char* key) {
  const auto& [low, high, why, slips] = parameter_of(standard_registry(), table, key).plausible;
  return outside(f, table, key, low, high, why, slips);
}

std::string first_of(std::initializer_list<std::string> texts) {
  for (const std::string& text : texts)
    if (!text.empty()) return text;
  return "";
}

// What several checks ask alike.

bool always(const Facts& /*facts*/) { return true; }
bool has_oil(const Facts& f) { return f.oil != nullptr; }
bool has_stroke_and_oil(const Facts& f) { return f.oil != nullptr && f.derived.stroke != 0; }
bool has_real_pistons(const Facts& f) { return f.real && f.pump.piston.mass != 0; }
bool has_shaft_mass(const Facts& f) { return f.pump.shaft.mass != 0; }
bool has_block_mass(const Facts& f) { return f.pump.block.mass != 0; }
bool has_walls(const Facts& f) { return f.walls.has_value(); }
bool has_cardan(const Facts& f) { return f.pump.transfer.is_uneven_joint(); }
bool has_double_cardan(const Facts& f) {
  return f.pump.transfer.kind == TransferKind::double_cardan;
}
// Data of walls in a pump whose pistons are not meant to touch them.
bool has_unused_walls(const Facts& f) {
  const auto& wall = f.pump.transfer.wall;
  return f.pump.transfer.kind != TransferKind::pistons && wall && wall->clearance > 0 &&
         wall->from_joint > 0;
}
bool has_teeth(const Facts& f) {
  return f.pump.gear.teeth && f.pump.gear.contact == ToothContact::teeth;
}

const Slips kOfLength = {kSign, kTenfold, kTenth, kMetres, kMicrometres};
const Slips kOfMass = {kTenth, kTenfold, kGrams, kTons};
const Slips kOfInertia = {kTenth, kTenfold, kKgM2, kGMm2};

// The sums over N pistons repeat after the N-th of a turn: angles that fall on the same places of
// it again and again say less than they seem to.
std::string repeated_samples(const Facts& f) {
  constexpr int kLeastPositions = 6;
  const int samples = f.the_case.operation.samples_per_revolution, pistons = f.g.pistons;
  const int positions = samples / std::gcd(samples, pistons);
  if (samples < kLeastPositions || positions >= kLeastPositions) return "";
  int better = samples;
  while (std::gcd(better, pistons) != 1) ++better;
  return fmt::format(
      "samples_per_revolution = {} shows the {} pistons in {} position{} only: drive torque, "
      "bearing "
      "forces and other sums over the pistons repeat {} times in a turn; {} angles would show {}",
      samples, pistons, positions, positions == 1 ? "" : "s", pistons, better, better);
}

// The widest gap between points of a curve of pressure, if it is too wide.
std::string gap_of_curve(const PressureSpec& pressure) {
  constexpr double kWidest = 30;  // deg
  const std::vector<double>& theta = pressure.curve.theta_deg;
  if (theta.size() < 3) return "";
  double from = theta.back(), to = theta.front() + 360;
  for (std::size_t i = 1; i < theta.size(); ++i)
    if (theta[i] - theta[i - 1] > to - from) {
      from = theta[i - 1];
      to = theta[i];
    }
  if (to - from <= kWidest) return "";
  const PressureTrace trace(pressure);
  const auto [low, high] =
      std::minmax_element(pressure.curve.pressure.begin(), pressure.curve.pressure.end());
  double furthest = 0, at = from;  // beyond all points
  for (int i = 1; i < 100; ++i) {
    const double angle = from + (to - from) * i / 100, p = trace(angle);
    const double beyond = std::max(p - *high, *low - p);
    if (beyond > furthest) {
      furthest = beyond;
      at = angle;
    }
  }
  const double covered = theta.back() - theta.front();
  return fmt::format(
      "[pressure] file has no point from {:.5g} to {:.5g} deg: what acts there is what a spline "
      "makes "
      "of the points around{}{}",
      from, wrap_degrees(to),
      furthest > 0 ? fmt::format(", as {:.4g} bar at {:.4g} deg", bar(trace(at)), wrap_degrees(at))
                   : "",
      covered < 2 * kPi ? guess(covered, 180, 360, {kRadians}) : "");
}

// The ports of the plate, then those of [hydraulics], up to the first that something is said of.
template <class Text>
std::string of_ports(const Facts& f, const Text& text) {
  std::string found;
  if (f.pump.port_plate)
    found = text("port_plate", f.pump.port_plate->delivery, f.pump.port_plate->suction);
  if (found.empty() && f.oil != nullptr)
    found = text("hydraulics", f.oil->delivery.arc, f.oil->suction.arc);
  return found;
}

std::string no_body_has_it(const Facts& f) {
  return fmt::format("not possible for a body of {:.4g} kg in a bore of {:.4g} mm over {:.4g} mm",
                     f.pump.piston.mass, mm(f.bore), mm(f.piston_span));
}

// What an input in Nm/rpm takes of the torque, where that is more than a share of the ideal one.
std::string viscous_torque(const Facts& f, const char* key, double coefficient, double share,
                           const char* share_in_words) {
  const double torque = coefficient * f.speed * kRadPerSecondPerRpm;
  if (torque <= share * f.full_torque) return "";
  return fmt::format(
      "{} = {:.4g} takes {:.4g} Nm at {:.6g} rpm, above {} of {:.4g} Nm; in Nm s/rad it would be "
      "{:.4g} Nm",
      key, coefficient * kRadPerSecondPerRpm, torque, f.speed, share_in_words, f.full_torque,
      torque * kRadPerSecondPerRpm);
}

// What numbers of the turn rest on, where it is not what a run will find.
const char* by_ideal_pressure(const Facts& f) {
  return f.turn->ideal_pressure ? "with an ideal pressure trace " : "";
}

// A limit of validity that is violated for more than a share of the turn.
const analytic::ValidityLimit* violated(const Facts& f, const char* name, double share) {
  const analytic::ValidityLimit* const limit = f.limit(name);
  return limit == nullptr || limit->violated_share <= share ? nullptr : limit;
}

// Push of the lands over bottom areas and spring; not computed where these do not press.
double block_balance(const Turn& turn) {
  return turn.press_force > 0 ? turn.land_force / turn.press_force : not_computed();
}

std::string block_balance_text(const Turn& turn) {
  const double balance = block_balance(turn);
  return is_computed(balance)
             ? fmt::format("{:.3g}", balance)
             : fmt::format("not defined, as bottom areas and spring do not press ({:.4g} N)",
                           turn.press_force);
}

// ---- Checks, in the order of the case file

struct Check {
  using Applies = bool (*)(const Facts&);
  using Text = std::string (*)(const Facts&);

  Check(const char* a_code, const char* words, Text what) : Check(a_code, words, always, what) {}
  Check(const char* a_code, const char* words, Applies where, Text what)
      : code(a_code), doubtful(words), applies(where), text(what) {}
  // Of the parameter whose plausible range is asked for: {0} and {1} in the words are its bounds.
  Check(const char* a_code, const char* words, const char* of_table, const char* of_key,
        Applies where = always, Text what = nullptr)
      : code(a_code), doubtful(words), applies(where), text(what), table(of_table), key(of_key) {}

  const char* code;
  const char* doubtful;  // what is, in words: docs/plausibility.md
  Applies applies;
  Text text = nullptr;  // "" where nothing is; null: implausible()
  const char* table = nullptr;
  const char* key = nullptr;

  std::string found(const Facts& facts) const {
    if (!applies(facts)) return "";
    return text != nullptr ? text(facts) : implausible(facts, table, key);
  }
  std::string words() const {
    if (table == nullptr) return doubtful;
    const PlausibleRange& range = parameter_of(standard_registry(), table, key).plausible;
    return fmt::format(fmt::runtime(doubtful), range.low, range.high);
  }
};

const Check kChecks[] = {
    // Main dimensions
    {"pump-size", "Ra below {0:g} or above {1:g} mm: no bent-axis pump is of this size", "pump",
     "joint_circle_radius_mm"},
    {"tilt-in-radians", "0 < tilt < 1 deg. 0 is an idealisation and accepted",
     [](const Facts& f) { return f.g.tilt != 0 && deg(f.g.tilt) < 1; },
     [](const Facts& f) {
       const double tilt = deg(f.g.tilt);
       return fmt::format("tilt_deg = {:.6g} is below 1 deg: in radians it would be {:.4g} deg",
                          tilt, deg(tilt));
     }},
    {"tilt-beyond-45", "tilt above 46 deg: bent-axis pumps have at most 45",
     [](const Facts& f) {
       return outside("tilt_deg", deg(f.g.tilt), 0, 46, "deg",
                      fmt::format("bent-axis pumps have at most 45 deg; measured from the other "
                                  "axis it would be {:.4g}",
                                  90 - deg(f.g.tilt)));
     }},
    {"radii-exchanged",
     "Rd > Ra, and exchanged the pistons would tilt less: the projection of the joint circle is an "
     "ellipse with half axes Ra and Ra cos(tilt), and the bores should lie between the two",
     [](const Facts& f) { return f.g.bore_circle_radius > f.g.joint_circle_radius; },
     [](const Facts& f) -> std::string {
       const Geometry& g = f.g;
       Geometry exchanged = g;
       std::swap(exchanged.bore_circle_radius, exchanged.joint_circle_radius);
       const double then = assembly_margin(exchanged).longest_distance;
       const double now = assembly_margin(g).longest_distance;
       if (then >= now) return "";
       return fmt::format(
           "bore_circle_radius_mm = {:.6g} exceeds joint_circle_radius_mm = {:.6g}: the bores "
           "should lie between {:.4g} (Ra cos tilt) and Ra; exchanged, no joint would be farther "
           "than {:.3g} mm from its bore's axis instead of {:.3g}",
           mm(g.bore_circle_radius), mm(g.joint_circle_radius),
           mm(g.joint_circle_radius) * std::cos(g.tilt), mm(then), mm(now));
     }},
    {"bores-overlap", "bore >= distance of neighbouring bore axes 2 Rd sin(180 deg/N), or >= 2 Rd",
     [](const Facts& f) { return f.g.bore_diameter >= f.bore_room; },
     [](const Facts& f) {
       return fmt::format("bore_diameter_mm = {:.6g} is not below {:.4g}, {}: the bores overlap{}",
                          mm(f.g.bore_diameter), mm(f.bore_room),
                          f.g.pistons > 2
                              ? fmt::format("the distance of {} neighbours on Rd", f.g.pistons)
                              : "twice Rd",
                          guess(mm(f.g.bore_diameter), mm(f.bore_room) / 2, mm(f.bore_room) * 0.97,
                                {kDiameter, kTenth, kMicrometres}));
     }},
    {"bores-touch",
     "the stress in the wall between neighbouring bores would exceed 1000 MPa: highest pressure x "
     "bore / wall, or is thinner than 2 % of the bore",
     [](const Facts& f) { return f.g.pistons >= 3 && f.g.bore_diameter < f.spacing; },
     [](const Facts& f) -> std::string {
       const double wall = f.spacing - f.g.bore_diameter;
       const double stress = f.highest * f.g.bore_diameter / wall;
       if (stress <= kYield && wall >= 0.02 * f.g.bore_diameter) return "";
       return fmt::format(
           "bore_diameter_mm = {:.6g} leaves a wall of {:.3g} mm to the next bore: {:.4g} MPa at "
           "{:.4g} bar, steel yields at {:.4g}",
           mm(f.g.bore_diameter), mm(wall), stress / 1e6, bar(f.highest), kYield / 1e6);
     }},
    {"bore-small",
     "bore below half of the distance of neighbours (less than 3 pistons: 0.3 Rd): a radius, or "
     "metres",
     [](const Facts& f) {
       return mm(f.g.bore_diameter) < mm(least_filling(f.g.pistons) * f.bore_room);
     },
     [](const Facts& f) {
       return outside("bore_diameter_mm", mm(f.g.bore_diameter),
                      mm(least_filling(f.g.pistons) * f.bore_room), mm(f.bore_room), "mm",
                      fmt::format("the block would be solid between {} bores on Rd = {:.4g}",
                                  f.g.pistons, mm(f.g.bore_circle_radius)),
                      {kRadius, kCentimetres, kInches, kMetres});
     }},
    {"axis-offset", "b outside +-Ra/2",
     [](const Facts& f) {
       const double most = mm(f.g.joint_circle_radius) / 2;
       return outside(f, "pump", "axis_offset_mm", -most, most,
                      "the axes meet far from the plane of the joints", {kMicrometres, kTenth});
     }},
    {"piston-tilt",
     "largest tilt of a piston in its bore above atan(Dpi / 4 stroke), at most 15 deg: a shank of "
     "half the bore meets the bore's edge",
     [](const Facts& f) -> std::string {
       const double most = std::min(std::atan2(f.bore / 4, f.derived.stroke), 15 * kRadPerDegree);
       if (f.derived.largest_tilt <= most) return "";
       return fmt::format(
           "the pistons tilt up to {:.3g} deg in their bores: over a stroke of {:.4g} mm a shank "
           "of half the bore's diameter allows {:.3g} (joint_circle_radius_mm = {:.6g}, "
           "bore_circle_radius_mm = {:.6g} where Ra (1 + cos tilt)/2 = {:.4g} minimises the tilt, "
           "axis_offset_mm = {:.6g}, piston_length_mm = {:.6g})",
           deg(f.derived.largest_tilt), mm(f.derived.stroke), deg(most),
           mm(f.g.joint_circle_radius), mm(f.g.bore_circle_radius),
           mm(f.g.joint_circle_radius) * (1 + std::cos(f.g.tilt)) / 2, mm(f.g.axis_offset),
           mm(f.g.piston_length));
     }},
    {"piston-length",
     "b1 below the stroke (the shaft would meet the block) or half the bore, or above 4 Ra",
     [](const Facts& f) {
       return outside(
           f, "pump", "piston_length_mm", mm(std::max(f.derived.stroke, f.bore / 2)),
           mm(4 * f.g.joint_circle_radius),
           fmt::format("a piston is longer than its stroke of {:.4g} mm or half its bore, and "
                       "shorter than 4 Ra",
                       mm(f.derived.stroke)),
           {kTenth, kCentimetres, kInches, kMicrometres, kMetres});
     }},
    // Gear
    {"gear-inside-bores", "d/2 < Rd + Dpi/2: the teeth would intersect the bores",
     [](const Facts& f) {
       return outside(f, "gear", "pitch_diameter_mm", mm(2 * f.bores_radius), HUGE_VAL,
                      "the teeth would intersect the bores, which reach to this diameter",
                      {kRadius, kCentimetres, kInches, kMetres});
     }},
    {"gear-large", "d/2 > 3 (Rd + Dpi/2)",
     [](const Facts& f) {
       return outside(f, "gear", "pitch_diameter_mm", 0, mm(6 * f.bores_radius),
                      "three times the enclosing diameter of the bores",
                      {kDiameter, kTenth, kMicrometres});
     }},
    {"pressure-angle", "0 < pressure angle < {0:g} deg, or > {1:g} deg", "gear",
     "pressure_angle_deg", [](const Facts& f) { return f.pump.gear.pressure_angle != 0; }},
    {"tooth-module", "module of the teeth, d/Z, below 1 or above 12 mm", has_teeth,
     [](const Facts& f) {
       const int count = f.pump.gear.teeth->count;
       return outside(fmt::format("tooth_number = {}: module", count),
                      mm(f.pump.gear.pitch_diameter) / count, 1, 12, "mm",
                      "synchronising gears have 2 to 8 mm");
     }},
    {"tooth-shape",
     "backlash above a tenth of the module, tip relief or crowning above a fiftieth, run-out above "
     "a "
     "twentieth, a face wider than half the distance from O2",
     has_teeth,
     [](const Facts& f) {
       const ToothData& teeth = *f.pump.gear.teeth;
       const double module = f.pump.gear.pitch_diameter / teeth.count;
       const double um = 1e6;
       const auto one = [&](const char* key, double value, double share, const char* why) {
         return outside(key, um * std::abs(value), 0, um * share * module, "um", why,
                        {{1e-3, "in um?"}});
       };
       return first_of(
           {one("backlash_um", teeth.backlash, 0.1, "gears of this module have a few hundredths"),
            one("tip_relief_um", teeth.tip_relief, 0.02, "reliefs are deflections, some microns"),
            one("lead_crowning_um", teeth.lead_crowning, 0.02, "crownings are some microns"),
            one("shaft_runout_um", teeth.shaft.runout, 0.05, "run-outs are some hundredths"),
            one("block_runout_um", teeth.block.runout, 0.05, "run-outs are some hundredths"),
            outside(f, "gear", "face_width_mm", 0,
                    mm(f.pump.gear.pitch_diameter) / (4 * std::cos(f.g.tilt / 2)),
                    "half the distance of the teeth from where the axes meet")});
     }},
    // Transfer
    {"cardan-tilt", "a single universal joint at a tilt above 25 deg", has_cardan,
     [](const Facts& f) {
       const double c = std::cos(f.g.tilt);
       return outside("tilt_deg", deg(f.g.tilt), 0, kCardanTilt, "deg",
                      fmt::format("one universal joint makes the block's speed ripple by {:.3g} % "
                                  "of the shaft's, and its side couple reach {:.3g} of the torque",
                                  100 * (1 / c - c), std::tan(f.g.tilt)));
     }},
    {"cross-distance",
     "the crosses of a double universal joint stand outside {0:g} .. {1:g} mm from O2", "transfer",
     "cross_distance_mm", has_double_cardan},
    {"wall-clearance",
     "pistons carry the block, and the clearance leaves it no free play at some angle, or more "
     "than 5 deg of it",
     has_walls,
     [](const Facts& f) -> std::string {
       const double clearance = mm(f.pump.transfer.wall->clearance);
       const double swing =
           f.walls->share * mm(f.g.joint_circle_radius) * (1 - std::cos(f.g.tilt)) / 2;
       if (is_computed(f.walls->without_deg))
         return fmt::format(
             "clearance_mm = {:.6g} leaves the block no free play at {:.4g} deg: it must exceed "
             "about {:.4g} mm, (1 - l_c/b1) Ra (1 - cos tilt)/2, and leave a piston that can "
             "touch{}",
             clearance, f.walls->without_deg, swing,
             guess(clearance, swing, 2 * swing,
                   {kTenfold, kTenth, kRadius, kDiameter, kMetres, kMicrometres}));
       if (deg(f.walls->widest) <= kWidePlay) return "";
       return fmt::format(
           "clearance_mm = {:.6g} leaves the block {:.3g} deg of free play at {:.4g} deg, above "
           "{:.4g}: the ports' timing would shift by as much; the pistons swing by about {:.4g} "
           "mm{}",
           clearance, deg(f.walls->widest), f.walls->widest_deg, kWidePlay, swing,
           guess(clearance, swing, 1.2 * swing, {kTenth, kDiameter}));
     }},
    {"wall-stiffness", "pistons carry the block on walls outside {0:g} .. {1:g} N/um", "transfer",
     "stiffness_N_per_um", has_walls},
    {"wall-damping",
     "a wall whose damping leaves no force where the piston that carries leaves it, at the case's "
     "speed",
     has_walls,
     [](const Facts& f) -> std::string {
       const double dissipation = f.pump.transfer.wall->dissipation;
       if (dissipation * f.walls->leaving < 1) return "";
       return fmt::format(
           "dissipation_s_per_m = {:.6g} leaves a wall no force where a piston leaves it faster "
           "than {:.4g} mm/s: the piston that carries does so at {:.4g} mm/s ({:.4g} deg, {:.6g} "
           "rpm)",
           dissipation, 1e3 / dissipation, 1e3 * f.walls->leaving, f.walls->leaving_deg, f.speed);
     }},
    {"wall-contact",
     "the contact point of the piston that carries outside of its bore, which begins where the "
     "joints come nearest to the block, or behind the ring, in the chamber",
     has_walls,
     [](const Facts& f) {
       const double ring = f.pump.piston.contact.value_or(f.g.piston_length);
       return outside(f, "transfer", "contact_from_joint_mm", mm(f.walls->outside), mm(ring),
                      fmt::format("the piston that carries stands {:.4g} mm out of a bore that "
                                  "begins where the joints come nearest to the block (theta = "
                                  "{:.4g} deg), and the ring is {:.4g} mm from A",
                                  mm(f.walls->outside), f.walls->outside_deg, mm(ring)),
                      {kTenfold, kCentimetres, kMetres, kTenth});
     }},
    {"piston-touches-bore",
     "a gear or a joint drives the block, and by contact_from_joint_mm and clearance_mm a piston "
     "tilts so far that it touches its bore",
     has_unused_walls,
     [](const Facts& f) -> std::string {
       const WallContact& wall = *f.pump.transfer.wall;
       const AssemblyMargin margin = assembly_margin(f.pump);
       const double off = (1 - wall.from_joint / f.g.piston_length) * margin.longest_distance;
       const double clearance = wall.smallest_clearance();
       if (off <= clearance) return "";
       return fmt::format(
           "a piston's axis is {:.4g} mm from that of its bore at {:.4g} deg, "
           "contact_from_joint_mm = {:.6g} from A: above {} = {:.6g}, the piston touches "
           "its bore, and [transfer] kind = \"{}\" leaves that out",
           mm(off), margin.theta_deg, mm(wall.from_joint),
           wall.deviation.empty() ? "clearance_mm" : "the smallest clearance in mm", mm(clearance),
           to_string(f.pump.transfer.kind));
     }},
    // Bearings
    {"bearing-side", "a bearing at z1 > -Ra/4: on the pistons' side, or in the plane of the joints",
     [](const Facts& f) {
       const auto one = [&](const char* key) {
         return outside(f, "bearings", key, -HUGE_VAL, -mm(f.g.joint_circle_radius) / 4,
                        "the shaft extends from the joints towards -z1, the pistons towards +z1",
                        {kSign, kMetres, kCentimetres});
       };
       return first_of({one("tapered_z_mm"), one("cylindrical_z_mm")});
     }},
    {"bearings-exchanged",
     "the tapered bearing is farther from the joints than the cylindrical one",
     [](const Facts& f) {
       const Bearings& b = f.pump.bearings;
       return b.tapered_z < b.cylindrical_z && b.cylindrical_z <= 0;
     },
     [](const Facts& f) {
       return fmt::format(
           "tapered_z_mm = {:.6g} is farther from the joints than cylindrical_z_mm = {:.6g}: the "
           "tapered bearing, which takes the thrust, sits next to the pistons",
           mm(f.pump.bearings.tapered_z), mm(f.pump.bearings.cylindrical_z));
     }},
    {"bearings-close", "bearings less than Ra/4 apart: two do not fit",
     [](const Facts& f) -> std::string {
       const double apart = std::abs(f.pump.bearings.tapered_z - f.pump.bearings.cylindrical_z);
       if (apart >= f.g.joint_circle_radius / 4) return "";
       return fmt::format(
           "tapered_z_mm and cylindrical_z_mm are {:.3g} mm apart, less than a quarter of Ra = "
           "{:.4g}: two bearings do not fit",
           mm(apart), mm(f.g.joint_circle_radius));
     }},
    {"ball-bearing",
     "balls of a ball bearing that overlap, or fill less than a quarter of their circle",
     [](const Facts& f) {
       const BearingRatings& b = f.the_case.ratings;
       return (b.tapered && b.tapered->balls) || (b.cylindrical && b.cylindrical->balls);
     },
     [](const Facts& f) {
       const auto one = [](const char* bearing, const auto& rating) -> std::string {
         if (!rating || !rating->balls) return "";
         const BallGeometry& balls = *rating->balls;
         const double filled =
             balls.balls * std::asin(std::min(1.0, balls.ball_diameter / balls.pitch_diameter)) /
             kPi;
         if (filled >= 0.25 && filled <= 1) return "";
         return fmt::format(
             "{0}_balls = {1}, {0}_ball_diameter_mm = {2:.4g}, {0}_ball_pitch_diameter_mm = "
             "{3:.4g}: "
             "the balls fill {4:.3g} % of their circle; 40 to 80 are usual, and above 100 they "
             "overlap",
             bearing, balls.balls, mm(balls.ball_diameter), mm(balls.pitch_diameter), 100 * filled);
       };
       const BearingRatings& b = f.the_case.ratings;
       return first_of({one("tapered", b.tapered), one("cylindrical", b.cylindrical)});
     }},
    {"bearing-far", "the nearer bearing farther than 5 Ra or the other farther than 10 Ra",
     [](const Facts& f) {
       const Bearings& b = f.pump.bearings;
       const bool tapered_nearer = std::abs(b.tapered_z) < std::abs(b.cylindrical_z);
       const auto one = [&](const char* key, bool nearer) {
         return outside(f, "bearings", key, -(nearer ? 5 : 10) * mm(f.g.joint_circle_radius),
                        HUGE_VAL,
                        nearer ? "5 Ra from the pistons that it carries" : "10 Ra from the pistons",
                        {kTenth, kMicrometres});
       };
       return first_of(
           {one("tapered_z_mm", tapered_nearer), one("cylindrical_z_mm", !tapered_nearer)});
     }},
    // Piston
    {"piston-heavier-than-steel",
     "piston mass above a steel cylinder of the bore's diameter and the length b1 + Dpi",
     [](const Facts& f) {
       return outside(f, "piston", "[piston] mass_kg", 0, kSteel * f.area * f.piston_span,
                      fmt::format("a solid steel cylinder of bore {:.4g} mm and length {:.4g} mm",
                                  mm(f.bore), mm(f.piston_span)),
                      {kTenth, kHundredth, kGrams});
     }},
    {"piston-too-light",
     "piston mass below 6 % of that cylinder (a hollow one of aluminium); 0 is an idealisation, "
     "accepted where pressure forces exceed the inertia of a steel piston ten times",
     [](const Facts& f) -> std::string {
       const double steel = kSteel * f.area * f.piston_span;
       const double omega = f.speed * kRadPerSecondPerRpm;
       const double inertia = steel / 3 * f.g.joint_circle_radius * square(omega);
       const double push = f.highest * f.area;
       if (f.pump.piston.mass == 0)
         return push >= 10 * inertia ? ""
                                     : fmt::format(
                                           "[piston] mass_kg = 0 where inertia matters: the "
                                           "inertia force of a steel piston would be {:.3g} N at "
                                           "{:.4g} rpm, the pressure force is {:.3g} N",
                                           inertia, f.speed, push);
       return outside(f, "piston", "[piston] mass_kg", kLightest * steel, HUGE_VAL,
                      "a hollow piston of aluminium weighs this",
                      {kTenfold, {100, "a hundred times too small?"}, kTons});
     }},
    {"piston-centre-of-mass", "centre of mass outside 0.1 .. 0.9 b1 from A (lumped: (1 - chi) b1)",
     [](const Facts& f) { return f.pump.piston.mass != 0; },
     [](const Facts& f) {
       const double b1 = mm(f.g.piston_length);
       return f.real ? outside(f, "piston", "[piston] centre_of_mass_mm", 0.1 * b1, 0.9 * b1,
                               fmt::format("it lies between A and B, {:.4g} mm apart", b1),
                               {kCentimetres, kTenth, kMetres, kMicrometres, kSign})
                     : implausible(f, "piston", "joint_mass_fraction");
     }},
    {"piston-transverse-inertia",
     "It outside of what a steel body of that mass within bore and length b1 + Dpi can have: of a "
     "solid disc that fills the bore, and of two masses at the ends",
     has_real_pistons,
     [](const Facts& f) {
       const double m = f.pump.piston.mass;
       const double r = f.bore / 2;
       const double disc = m / (1.1 * kSteel * f.area);
       return outside(f, "piston", "transverse_inertia_kg_mm2",
                      m * (square(r) / 4 + square(disc) / 12) * 1e6,
                      m * (square(f.piston_span / 2) + square(r) / 2) * 1e6, no_body_has_it(f),
                      {kTenth, kTenfold, kKgM2, kGMm2, kHundredth});
     }},
    {"piston-axial-inertia",
     "Ia outside of what a steel body of that mass within bore and length b1 + Dpi can have: of a "
     "rod of that length, and of a tube on the bore",
     has_real_pistons,
     [](const Facts& f) {
       const double m = f.pump.piston.mass;
       return outside(f, "piston", "[piston] axial_inertia_kg_mm2",
                      m * m / (2 * kPi * 1.1 * kSteel * f.piston_span) * 1e6,
                      m * square(f.bore / 2) * 1e6, no_body_has_it(f), kOfInertia);
     }},
    {"piston-spin", "spin above +-2.5 x speed: shaft and block, which drag it round, turn slower",
     [](const Facts& f) { return f.real; },
     [](const Facts& f) {
       return outside(
           f, "piston", "spin_rpm", -2.5 * f.speed, 2.5 * f.speed,
           fmt::format("shaft and block, which drag the pistons round, turn at {:.4g}", f.speed),
           {kTenth});
     }},
    // Shaft and block
    {"shaft-mass",
     "shaft mass outside 0.12 .. 4 times a steel cylinder of radius Ra + Dpi/2 to the farther "
     "bearing; 0 is an idealisation and accepted",
     has_shaft_mass,
     [](const Facts& f) {
       const double size =
           kSteel * kPi * square(f.g.joint_circle_radius + f.bore / 2) * f.shaft_reach;
       return outside(
           f, "shaft", "[shaft] mass_kg", 0.12 * size, 4 * size,
           fmt::format("a steel cylinder around joints and bearings weighs {:.3g} kg", size),
           kOfMass);
     }},
    {"shaft-centre-of-mass",
     "shaft's centre of mass at z1 > -Ra/5, or farther than twice the farther bearing",
     has_shaft_mass,
     [](const Facts& f) {
       return outside(f, "shaft", "[shaft] centre_of_mass_z_mm", -2 * mm(f.shaft_reach),
                      -mm(f.g.joint_circle_radius) / 5,
                      "the shaft reaches from the joints past its bearings, along -z1",
                      {kSign, kTenth, kMetres, kMicrometres});
     }},
    {"shaft-inertia",
     "I_s of a shaft: below a steel rod of that mass to the farther bearing, or above m (2.5 Ra)2",
     [](const Facts& f) {
       return has_shaft_mass(f) && !f.defaulted("shaft", "axial_inertia_kg_mm2");
     },
     [](const Facts& f) {
       const double m = f.pump.shaft.mass, ra = f.g.joint_circle_radius;
       return outside(
           f, "shaft", "[shaft] axial_inertia_kg_mm2",
           m * m / (2 * kPi * kSteel * (2 * f.shaft_reach + ra)) * 1e6, m * square(2.5 * ra) * 1e6,
           fmt::format("not possible for a shaft of {:.4g} kg and this size", m), kOfInertia);
     }},
    {"block-mass",
     "block mass outside 0.1 .. 1.2 times a steel cylinder of radius Rd + Dpi and length b1 + "
     "stroke; 0 is an idealisation and accepted",
     has_block_mass,
     [](const Facts& f) {
       const double size = kSteel * kPi * square(f.g.bore_circle_radius + f.bore) * f.block_length;
       return outside(f, "block", "[block] mass_kg", 0.1 * size, 1.2 * size,
                      fmt::format("a steel cylinder around the bores weighs {:.3g} kg", size),
                      kOfMass);
     }},
    {"block-centre-of-mass", "block's centre of mass at z2 < b1/10 or > b1 + stroke + Dpi",
     has_block_mass,
     [](const Facts& f) {
       return outside(f, "block", "[block] centre_of_mass_z_mm", mm(f.g.piston_length) / 10,
                      mm(f.block_length + f.bore),
                      "the block is around the piston heads, along +z2", kOfLength);
     }},
    {"block-inertia",
     "I_c of a block: below a steel rod of that mass and the block's length, or above m (Rd + "
     "Dpi)2",
     [](const Facts& f) {
       return has_block_mass(f) && !f.defaulted("block", "axial_inertia_kg_mm2");
     },
     [](const Facts& f) {
       const double m = f.pump.block.mass;
       return outside(f, "block", "[block] axial_inertia_kg_mm2",
                      m * m / (2 * kPi * kSteel * f.block_length) * 1e6,
                      m * square(f.g.bore_circle_radius + f.bore) * 1e6,
                      fmt::format("not possible for a block of {:.4g} kg and this size", m),
                      kOfInertia);
     }},
    {"pin-position", "pin at z2 < 0.15 (b1 + stroke), or > b1 + stroke + 2 Dpi: outside the block",
     [](const Facts& f) {
       return outside(f, "block", "pin_z_mm", 0.15 * mm(f.block_length),
                      mm(f.block_length + 2 * f.bore),
                      "the pin meets the block inside of it, along +z2", kOfLength);
     }},
    {"bottom-area", "Ac above the area of a bore, or 0 < Ac below a twentieth of it",
     [](const Facts& f) { return f.pump.block.bottom_area != 0; },
     [](const Facts& f) {
       const double area = mm2(f.area);
       return outside(f, "block", "bottom_area_mm2", area / 20, area,
                      fmt::format("it is a part of each bore's {:.4g} mm2", area),
                      {kTenth,
                       kTenfold,
                       kSquareCm,
                       kHundredth,
                       kSquareM,
                       {1. / f.g.pistons, "of all bores?"}});
     }},
    {"spring-force",
     "spring above the force of a coil spring between the bores at 1000 MPa, or below a tenth of "
     "the block's weight; 0 is an idealisation and accepted",
     [](const Facts& f) { return f.pump.block.spring_force != 0; },
     [](const Facts& f) {
       // Of outer radius r and index 4: wire 2 r/5, mean diameter 8 r/5; F = pi d^3 tau / (8 D).
       const double r = std::max(f.g.bore_circle_radius - f.bore / 2, 0.1 * f.g.bore_circle_radius);
       const double most = kPi * 0.005 * square(r) * kYield;
       const double weight = f.pump.block.mass * 9.81;
       return outside(f, "block", "spring_force_N", std::min(0.1 * weight, most), most,
                      fmt::format("a coil spring of {:.3g} mm between the bores has at most {:.3g} "
                                  "N, the block weighs {:.3g} N",
                                  2 * mm(r), most, weight),
                      {kTenth, kTenfold, {1e3, "in kN?"}, kThousandth});
     }},
    // Friction
    {"piston-friction",
     "Fc + cv v above a tenth of the pressure force on a piston (at 100 bar at least)",
     [](const Facts& f) -> std::string {
       const double v = f.speed * kRadPerSecondPerRpm * f.derived.stroke / 2;
       const double friction = f.pump.friction.piston_coulomb + f.pump.friction.piston_viscous * v;
       const double force = f.load * f.area;
       if (friction <= 0.1 * force) return "";
       return fmt::format(
           "piston_coulomb_N = {:.6g} and piston_viscous_N_s_per_m = {:.6g} make {:.4g} N of "
           "friction on a piston that {:.4g} bar push with {:.4g} N: more than a tenth would be "
           "lost",
           f.pump.friction.piston_coulomb, f.pump.friction.piston_viscous, friction, bar(f.load),
           force);
     }},
    {"block-viscous-torque", "Cc n above a tenth of N A 2 Ra p/(2 pi), with p of 100 bar at least",
     [](const Facts& f) {
       return viscous_torque(f, "block_viscous_Nm_per_rpm", f.pump.friction.block_viscous, 0.1,
                             "a tenth");
     }},
    {"shaft-viscous-torque", "Cs n above 3 % of that torque",
     [](const Facts& f) {
       return viscous_torque(f, "shaft_viscous_Nm_per_rpm", f.pump.friction.shaft_viscous, 0.03,
                             "3 %");
     }},
    {"torque-factor", "Ct below 0.8: the loss instead of what is left, or per cent",
     [](const Facts& f) { return f.pump.friction.shaft_torque_factor < 0.8; },
     [](const Facts& f) {
       const double ct = f.pump.friction.shaft_torque_factor;
       return fmt::format(
           "shaft_torque_factor = {:.6g} is below 0.8: {:.3g} % of the drive torque would be lost "
           "(1 is no loss)",
           ct, 100 * (1 - ct));
     }},
    {"regularization",
     "v_reg above a tenth of the joints' speed omega Ra: Coulomb friction does not reach its full "
     "value",
     [](const Facts& f) { return f.pump.friction.piston_coulomb != 0 && f.speed != 0; },
     [](const Facts& f) {
       return outside(
           f, "friction", "regularization_m_per_s", 0,
           f.speed * kRadPerSecondPerRpm * f.g.joint_circle_radius / 10,
           "a tenth of the speed of the joints: Coulomb friction would not reach its full value",
           {{1e-3, "in mm/s?"}, kTenth});
     }},
    // Operation
    {"speed-in-rad-per-s",
     "a speed that is no multiple of 10 rpm, below 628, and read as rad/s within 0.1 % of a "
     "multiple of 50 rpm",
     [](const Facts& f) -> std::string {
       const double rpm = f.speed / kRadPerSecondPerRpm;
       const double nearest = 50 * std::round(rpm / 50);
       if (rpm < 300 || rpm > 6000 || std::fmod(f.speed, 10) == 0) return "";
       if (std::abs(rpm - nearest) > 1e-3 * nearest) return "";
       return fmt::format("speed_rpm = {:.6g}: in rad/s it would be {:.6g} rpm",
                          f.the_case.operation.speed_rpm, rpm);
     }},
    {"piston-speed", "mean piston speed, two strokes per turn, above 10 m/s",
     [](const Facts& f) { return f.piston_speed > kFastest; },
     [](const Facts& f) {
       return fmt::format(
           "the pistons move at {:.4g} m/s on average at speed_rpm = {:.6g} (stroke {:.4g} mm): "
           "pumps reach 5 to 7 m/s",
           f.piston_speed, f.the_case.operation.speed_rpm, mm(f.derived.stroke));
     }},
    {"speed-low", "a speed, not 0, at which the pistons of the full stroke move below 0.05 m/s",
     [](const Facts& f) { return f.speed != 0; },
     [](const Facts& f) -> std::string {
       const double v = f.speed / 60 * 2 * std::max(f.derived.stroke, f.g.joint_circle_radius);
       if (v >= kSlowest) return "";
       return fmt::format(
           "speed_rpm = {:.6g} moves the pistons at {:.3g} m/s on average; in revolutions per "
           "second it would be {:.6g} rpm",
           f.the_case.operation.speed_rpm, v, 60 * f.the_case.operation.speed_rpm);
     }},
    {"gravity", "gravity that is not 0 and outside {0:g} .. {1:g} m/s2 (it acts along -y1)",
     "operation", "gravity_m_per_s2", [](const Facts& f) { return f.pump.gravity != 0; }},
    {"samples",
     "fewer than 6 or more than 1e6 angles in a turn, or more than 1e4 revolutions, or angles at "
     "which the N pistons stand in fewer than 6 different positions",
     [](const Facts& f) {
       return first_of({implausible(f, "operation", "samples_per_revolution"),
                        implausible(f, "operation", "revolutions"), repeated_samples(f)});
     }},
    // Pressure
    {"pressure-beyond-1000-bar", "delivery, suction or the curve above 1000 bar",
     [](const Facts& f) {
       const auto one = [](const char* key, double p) {
         return outside(key, bar(p), -HUGE_VAL, bar(kMaxPressure), "bar",
                        "hydraulic pumps have at most 500 bar",
                        {kPascals, kKilopascals, kPsi, kTenth});
       };
       return first_of({one("delivery_bar", f.ports.delivery), one("suction_bar", f.ports.suction),
                        f.turn && f.the_case.pressure.kind == PressureKind::curve
                            ? one("[pressure] file: its highest", f.turn->highest_pressure)
                            : std::string()});
     }},
    {"pressure-low",
     "0 < delivery < 3 bar, or delivery below -1.014 bar (absolute vacuum). 0 is no load and "
     "accepted",
     [](const Facts& f) { return f.ports.delivery != 0; },
     [](const Facts& f) {
       if (f.ports.delivery < 0)
         return outside(f, "pressure", "delivery_bar", -1.014, HUGE_VAL,
                        "absolute vacuum is at -1.013", {kSign});
       return outside(f, "pressure", "delivery_bar", 3, HUGE_VAL, "almost no load",
                      {{100, "in units of 100 bar?"}, {1000, "in kbar?"}});
     }},
    {"delivery-below-suction", "delivery pressure below suction pressure",
     [](const Facts& f) { return f.ports.delivery < f.ports.suction; },
     [](const Facts& f) {
       return fmt::format("delivery_bar = {:.6g} is below suction_bar = {:.6g}: exchanged?",
                          bar(f.ports.delivery), bar(f.ports.suction));
     }},
    {"suction-pressure",
     "suction below {0:g} bar (absolute vacuum), above {1:g} bar, or 1 atmosphere (pressures are "
     "gauge)",
     "pressure", "suction_bar", always,
     [](const Facts& f) -> std::string {
       const double suction = bar(f.ports.suction);
       if (std::abs(suction - 1.01325) < 1e-3)
         return fmt::format("suction_bar = {:.6g}: pressures are gauge; absolute?", suction);
       return implausible(f, "pressure", "suction_bar");
     }},
    {"transition", "0 < transition < {0:g} deg (0 is a step and accepted), or > {1:g} deg",
     "pressure", "transition_deg",
     [](const Facts& f) {
       const PressureSpec& p = f.the_case.pressure;
       return p.kind == PressureKind::ideal && p.transition_deg != 0;
     }},
    {"pressure-phase",
     "the pressure on a piston does less than 0.6 of the ideal work (delivery - suction) x A x "
     "stroke over a turn: it does not act while the chamber volume decreases (180 .. 360 deg)",
     [](const Facts& f) {
       return f.turn && f.ports.delivery - f.ports.suction >= kPascalPerBar &&
              f.derived.stroke >= 0.01 * f.g.joint_circle_radius && !(f.turn->work_ratio >= 0.6);
     },
     [](const Facts& f) {
       const bool ideal = f.the_case.pressure.kind == PressureKind::ideal;
       const double start = f.the_case.pressure.delivery_start_deg;
       return fmt::format(
           "{}: the pressure does {:.3g} of the ideal work over a turn; chamber volumes decrease "
           "from 180 to 360 deg{}",
           ideal ? fmt::format("delivery_start_deg = {:.6g}", start) : "[pressure] file",
           f.turn->work_ratio,
           ideal ? guess(start, 150, 210, {kRadians})
                 : "; another zero or sense of the angle, or "
                   "another unit of pressure?");
     }},
    {"curve-gap", "neighbouring points of the curve are more than 30 deg apart",
     [](const Facts& f) { return f.the_case.pressure.kind == PressureKind::curve; },
     [](const Facts& f) { return gap_of_curve(f.the_case.pressure); }},
    {"curve-pressure",
     "the highest pressure of the curve is not within 0.5 .. 2 times delivery_bar, the lowest "
     "is below absolute vacuum by more than 10 % of it, or the curve does more than 1.5 of the "
     "ideal work (delivery - suction) x A x stroke over a turn",
     [](const Facts& f) {
       return f.the_case.pressure.kind == PressureKind::curve && f.turn &&
              bar(f.ports.delivery) > 1;
     },
     [](const Facts& f) {
       const double delivery = bar(f.ports.delivery);
       return first_of(
           {outside("[pressure] file: its highest", bar(f.turn->highest_pressure), delivery / 2,
                    2 * delivery, "bar", fmt::format("delivery_bar = {:.6g}", delivery),
                    {{10, "in MPa?"}, kPascals, kKilopascals, kPsi}),
            outside(
                "[pressure] file: its lowest", bar(f.turn->lowest_pressure), -1.014 - delivery / 10,
                HUGE_VAL, "bar",
                "absolute vacuum is at -1.013, and a spline may leave its points by a tenth of "
                "delivery_bar",
                f.turn->highest_pressure < -f.turn->lowest_pressure / 2 ? Slips{kSign} : Slips{}),
            outside("[pressure] file: its work in a turn over the ideal work", f.turn->work_ratio,
                    -HUGE_VAL, 1.5, "", fmt::format("with delivery_bar = {:.6g}", delivery))});
     }},
    // Port plate
    {"lands-off-bores",
     "the bore circle lies outside r1 .. r4, or the groove r2 .. r3 extends outside Rd -+ Dpi/2",
     [](const Facts& f) { return f.pump.port_plate.has_value(); },
     [](const Facts& f) -> std::string {
       const PortPlate& p = *f.pump.port_plate;
       const double rd = f.g.bore_circle_radius, half = f.bore / 2;
       if (p.r1 < rd && rd < p.r4 && p.r2 >= rd - half && p.r3 <= rd + half) return "";
       return fmt::format(
           "inner_land_mm = [{:.6g}, {:.6g}], outer_land_mm = [{:.6g}, {:.6g}]: the groove between "
           "them feeds bores that reach from {:.4g} to {:.4g} mm (Rd -+ Dpi/2){}",
           mm(p.r1), mm(p.r2), mm(p.r3), mm(p.r4), mm(rd - half), mm(rd + half),
           guess(mm(p.r2 + p.r3) / 2, 0.8 * mm(rd), 1.2 * mm(rd),
                 {kDiameter, kMetres, kCentimetres, kTenth, kInches}));
     }},
    {"port-arcs-exchanged",
     "delivery port over 0 .. 180 deg, where chambers fill, and suction port over 180 .. 360: by "
     "the y of their middles",
     // A pump that delivers elsewhere is the business of pressure-phase.
     [](const Facts& f) { return !f.turn || !(f.turn->work_ratio < 0.6); },
     [](const Facts& f) {
       return of_ports(f, [](const char* table, const PortArc& d, const PortArc& s) {
         const auto y = [](const PortArc& arc) {
           return std::sin((arc.from_deg + arc.to_deg) / 2 * kRadPerDegree);
         };
         return y(d) > y(s) ? fmt::format(
                                  "[{}] delivery_arc_deg = [{:.6g}, {:.6g}], "
                                  "suction_arc_deg = [{:.6g}, {:.6g}]: chambers fill from "
                                  "0 to 180 deg and deliver from 180 to 360: exchanged?",
                                  table, d.from_deg, d.to_deg, s.from_deg, s.to_deg)
                            : std::string();
       });
     }},
    {"port-arc", "a port of less than 30 or more than 180 deg",
     [](const Facts& f) {
       return of_ports(f, [](const char* table, const PortArc& delivery, const PortArc& suction) {
         const auto one = [&](const char* port, const PortArc& arc) {
           return outside(fmt::format("[{}] {}_arc_deg covers", table, port),
                          arc.to_deg - arc.from_deg, 30, 180, "deg",
                          fmt::format("from {:.6g} to {:.6g}; a port serves half a turn less the "
                                      "bridges",
                                      arc.from_deg, arc.to_deg),
                          {kRadians});
         };
         return first_of({one("delivery", delivery), one("suction", suction)});
       });
     }},
    {"port-arcs-overlap", "delivery and suction port share an angle",
     [](const Facts& f) {
       return of_ports(f, [](const char* table, const PortArc& a, const PortArc& b) -> std::string {
         const auto within = [](double angle, const PortArc& arc) {
           double past = std::fmod(angle - arc.from_deg, 360);
           if (past < 0) past += 360;
           return past < arc.to_deg - arc.from_deg;
         };
         if (!within(a.from_deg, b) && !within(b.from_deg, a)) return "";
         return fmt::format(
             "[{}] delivery_arc_deg = [{:.6g}, {:.6g}] and suction_arc_deg = [{:.6g}, {:.6g}] "
             "overlap: the ports would be one",
             table, a.from_deg, a.to_deg, b.from_deg, b.to_deg);
       });
     }},
    // One turn of the analytic model
    {"block-lifts-off",
     "the film would have to pull the block onto the plate (Fh > 0) in more than 5 % of the turn",
     [](const Facts& f) -> std::string {
       const auto* limit = violated(f, "Fh reversed", kShareOfTurn);
       if (limit == nullptr) return "";
       return fmt::format(
           "{}the block lifts off its plate in {:.3g} % of the turn, worst {:.4g} N at {:.4g} deg: "
           "block balance (push of the lands over bottom areas and spring) is {} (lands {:.4g} "
           "N, bottom_area_mm2 = {:.6g} and spring_force_N = {:.6g} make {:.4g} N)",
           by_ideal_pressure(f), 100 * limit->violated_share, limit->worst, limit->theta_deg,
           block_balance_text(*f.turn), f.turn->land_force, mm2(f.pump.block.bottom_area),
           f.pump.block.spring_force, f.turn->press_force);
     }},
    {"block-overpressed",
     "block balance below 0.3 at more than 100 bar: the film would have to carry the rest",
     [](const Facts& f) {
       return f.pump.port_plate && f.turn && f.ports.delivery >= kLightLoad &&
              block_balance(*f.turn) < 0.3;
     },
     [](const Facts& f) {
       return fmt::format(
           "block balance is {:.3g}, below 0.3: the lands push {:.4g} N, bottom_area_mm2 = {:.6g} "
           "and spring_force_N = {:.6g} {:.4g} N; the film would have to carry the rest",
           block_balance(*f.turn), f.turn->land_force, mm2(f.pump.block.bottom_area),
           f.pump.block.spring_force, f.turn->press_force);
     }},
    {"film-force-outside",
     "the film force would act outside r4 in more than 25 % of the turn: the block tips",
     [](const Facts& f) -> std::string {
       const auto* limit = violated(f, "(xh, yh) outside r4", kOutsideShare);
       if (limit == nullptr) return "";
       return fmt::format(
           "{}the film force acts outside of the plate (r4 = {:.4g} mm) in {:.3g} % of the turn, "
           "up "
           "to {:.4g} mm from its axis at {:.4g} deg: the block tips; block balance is {}",
           by_ideal_pressure(f), mm(f.pump.port_plate->r4), 100 * limit->violated_share,
           limit->worst, limit->theta_deg, block_balance_text(*f.turn));
     }},
    {"tooth-force-flank",
     "one flank, and Rcs < 0 in more than 5 % of the turn, but at standstill: the other flank "
     "would be loaded",
     [](const Facts& f) { return f.speed != 0 && f.pump.gear.flanks != Flanks::two; },
     [](const Facts& f) -> std::string {
       const auto* limit = violated(f, "Rcs < 0", kShareOfTurn);
       if (limit == nullptr) return "";
       return fmt::format(
           "{}the tooth force is on the other flank in {:.3g} % of the turn, worst {:.4g} N at "
           "{:.4g} deg: the block leads the shaft (block_viscous_Nm_per_rpm = {:.4g} holds it "
           "back)",
           by_ideal_pressure(f), 100 * limit->violated_share, limit->worst, limit->theta_deg,
           f.pump.friction.block_viscous * kRadPerSecondPerRpm);
     }},
    // Hydraulics
    {"oil-density", "density outside {0:g} .. {1:g} kg/m3", "hydraulics", "density_kg_per_m3"},
    {"bulk-modulus", "bulk modulus outside {0:g} .. {1:g} MPa", "hydraulics", "bulk_modulus_MPa"},
    {"air-content", "air below {0:g} or above {1:g} per cent", "hydraulics", "air_percent"},
    {"atmosphere", "atmosphere outside {0:g} .. {1:g} bar", "hydraulics", "atmosphere_bar"},
    {"kidney",
     "kidney wider than the pitch 360/N or narrower than a fifth of the bore; higher than the bore "
     "or of less than 8 % of its area",
     has_oil,
     [](const Facts& f) {
       const double pitch = 360.0 / f.g.pistons;
       const double bore = 2 * deg(std::asin(std::min(1.0, f.bore / 2 / f.g.bore_circle_radius)));
       const double area =
           f.oil->kidney_width_deg * kRadPerDegree * f.g.bore_circle_radius * f.oil->kidney_height;
       return first_of(
           {outside(f, "hydraulics", "kidney_width_deg", bore / 5, pitch,
                    fmt::format("a bore covers {:.3g} deg, the pitch of {} kidneys is {:.4g}", bore,
                                f.g.pistons, pitch),
                    {kRadians, kTenfold, kTenth}),
            outside(f, "hydraulics", "kidney_height_mm", 0, mm(f.bore),
                    "a kidney is not higher than its bore", {kTenth, kMicrometres}),
            outside("kidney_height_mm: kidney area", mm2(area), 0.08 * mm2(f.area), HUGE_VAL, "mm2",
                    fmt::format("8 % of the bore's {:.4g} mm2 (height {:.4g} mm)", mm2(f.area),
                                mm(f.oil->kidney_height)))});
     }},
    {"notch",
     "a notch of less than 1 deg, or of less than 2e-4 or more than 0.2 of the bore's area",
     has_oil,
     [](const Facts& f) {
       const double area = mm2(f.area);
       const auto one = [&](const std::string& port, const Notch& notch) -> std::string {
         if (notch.length_deg == 0 || notch.area == 0) return "";
         return first_of(
             {outside(f, "hydraulics", port + "_notch_deg", 1, 90,
                      "a silencing notch leads by 5 to 20 deg", {kRadians}),
              outside(f, "hydraulics", port + "_notch_area_mm2", 2e-4 * area, 0.2 * area,
                      fmt::format("a bore has {:.4g} mm2, a notch some", area),
                      {kSquareCm, kHundredth, kSquareM, kTenth})});
       };
       return first_of(
           {one("delivery", f.oil->delivery.notch), one("suction", f.oil->suction.notch)});
     }},
    {"discharge-coefficient", "Cd outside {0:g} .. {1:g}", "hydraulics", "discharge_coefficient",
     always,
     [](const Facts& f) {
       return first_of({implausible(f, "hydraulics", "discharge_coefficient"),
                        implausible(f, "hydraulics", "delivery_discharge_coefficient"),
                        implausible(f, "hydraulics", "suction_discharge_coefficient")});
     }},
    {"transition-pressure", "p_cr above 5 bar and a twentieth of the delivery pressure", has_oil,
     [](const Facts& f) {
       return outside(
           f, "hydraulics", "transition_pressure_bar", 0, std::max(5.0, bar(f.ports.delivery) / 20),
           "orifices are turbulent well below the delivery pressure", {kPascals, kTenth});
     }},
    {"leakage", "chambers on delivery lose more than 15 % of the ideal flow (at 1 m/s at least)",
     has_stroke_and_oil,
     [](const Facts& f) -> std::string {
       const double lost = 0.5 * f.g.pistons * f.oil->leakage * std::max(0.0, f.ports.delivery);
       const double flow = f.g.pistons * f.area * std::max(f.piston_speed, kCreep) / 2;
       if (lost <= 0.15 * flow) return "";
       return fmt::format(
           "leakage_l_per_min_per_bar = {:.4g} loses {:.4g} l/min at {:.4g} bar, above 15 % of "
           "{:.4g} l/min",
           f.oil->leakage * 6e4 * kPascalPerBar, lost * 6e4, bar(f.ports.delivery), flow * 6e4);
     }},
    {"case-pressure", "case pressure above {1:g} bar", "hydraulics", "case_bar"},
    {"dead-volume", "V0 below 0.03 or above 5 times the stroke's volume", has_stroke_and_oil,
     [](const Facts& f) {
       const double stroke = f.area * f.derived.stroke * 1e6;
       return outside(
           f, "hydraulics", "dead_volume_cm3", 0.03 * stroke, 5 * stroke,
           fmt::format("a stroke displaces {:.4g} cm3", stroke),
           {{1e-3, "in mm3?"}, {1e3, "in litres?"}, {1e6, "in m3?"}, kTenfold, kHundredth});
     }},
    {"stroke-file", "the oil follows `stroke_file`, the forces the pump's own geometry",
     [](const Facts& f) { return f.oil != nullptr && !f.oil->stroke.theta_deg.empty(); },
     [](const Facts& f) {
       const StrokeTable& stroke = f.oil->stroke;
       const auto [least, greatest] = PeriodicSpline(stroke.theta_deg, stroke.value).extremes();
       const double displaced = (greatest - least) * (stroke.is_volume ? 1 : f.area);
       return fmt::format(
           "stroke_file: the oil's chambers displace {:.4g} cm3 per stroke by this file; forces, "
           "torque and efficiency are of pistons that displace {:.4g} cm3 by the pump's geometry",
           displaced * 1e6, f.area * f.derived.stroke * 1e6);
     }},
    {"delivery-volume", "delivery volume below 0.05 or above 1000 times the displacement",
     has_stroke_and_oil,
     [](const Facts& f) {
       const double turn = f.derived.displacement * 1e3;
       return outside(f, "hydraulics", "delivery_volume_l", 0.05 * turn, 1000 * turn,
                      fmt::format("a turn displaces {:.4g} l", turn),
                      {{1e-3, "in cm3?"}, {1e3, "in m3?"}});
     }},
    {"curve-points", "a spline of fewer than {0:g} points of the computed pressure in a turn",
     "pressure", "points",
     [](const Facts& f) {
       const PressureSpec& p = f.the_case.pressure;
       return p.kind == PressureKind::hydraulic && p.points != 0;
     }},
};

bool is_code(const std::string& code) {
  return std::any_of(std::begin(kChecks), std::end(kChecks),
                     [&](const Check& check) { return check.code == code; });
}

bool is_timing_code(const std::string& code) { return contains(timing_codes(), code); }

// "CODE: reason; CODE: reason"
std::vector<PlausibilityWarning> stated(const Case& the_case) {
  std::vector<PlausibilityWarning> list;
  const std::string& text = the_case.meant;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(';', at), text.size());
    const std::string part(trimmed(std::string_view(text).substr(at, end - at)));
    at = end + 1;
    if (part.empty()) continue;
    const std::size_t colon = part.find(':');
    const std::string code(trimmed(std::string_view(part).substr(0, colon)));
    const std::string reason(
        colon == std::string::npos ? "" : trimmed(std::string_view(part).substr(colon + 1)));
    const std::string where = the_case.file.string() + ": [plausibility] meant: ";
    if (!is_code(code) && !is_timing_code(code))
      throw InputError(where + "\"" + code +
                       "\" is not the code of a check (docs/plausibility.md and docs/hydraulics.md "
                       "list them); must be \"CODE: reason; CODE: reason\"");
    if (reason.empty())
      throw InputError(where + "\"" + code + "\" needs a reason: \"" + code + ": why\"");
    list.push_back({code, "", reason});
  }
  return list;
}

}  // namespace

std::string Plausibility::summary() const {
  return fmt::format(
      "{:.4g} cm3/rev: {:.4g} l/min at {:.6g} rpm, {:.4g} Nm at {:.4g} bar (ideal); mean piston "
      "speed {:.3g} m/s",
      displacement * 1e6, ideal_flow * 6e4, speed_rpm, ideal_torque, bar(delivery),
      mean_piston_speed);
}

Plausibility plausibility(const Case& the_case) {
  const std::vector<PlausibilityWarning> reasons = stated(the_case);
  const Facts facts(the_case);
  Plausibility result;
  result.displacement = facts.derived.displacement;
  result.speed_rpm = the_case.operation.speed_rpm;
  result.ideal_flow = result.displacement * facts.speed / 60;
  result.delivery = facts.ports.delivery;
  result.ideal_torque = ideal_torque(result.displacement, facts.ports);
  result.mean_piston_speed = facts.piston_speed;
  for (const Check& check : kChecks) {
    const std::string text = check.found(facts);
    if (text.empty()) continue;
    const auto reason =
        std::find_if(reasons.begin(), reasons.end(),
                     [&](const PlausibilityWarning& d) { return d.code == check.code; });
    if (reason == reasons.end())
      result.warnings.push_back({check.code, text, ""});
    else
      result.meant.push_back({check.code, text, reason->reason});
  }
  return result;
}

double ideal_torque(double displacement, const PortPressures& ports) {
  const double torque = displacement * (ports.delivery - ports.suction) / (2 * kPi);
  return torque == 0 ? 0 : torque;
}

bool lacks_pressure(const PressureSpec& pressure) {
  return pressure.kind == PressureKind::hydraulic && !pressure.computed &&
         pressure.curve.theta_deg.empty();
}

std::string stated_reason(const Case& the_case, const std::string& code) {
  for (const PlausibilityWarning& doubt : stated(the_case))
    if (doubt.code == code) return doubt.reason;
  return "";
}

std::string plausibility_markdown() {
  std::string text = "| name | warns of |\n|---|---|\n";
  for (const Check& check : kChecks)
    text += fmt::format("| `{}` | {} |\n", check.code, check.words());
  return text;
}

std::vector<std::string> plausibility_codes() {
  std::vector<std::string> codes;
  for (const Check& check : kChecks) codes.emplace_back(check.code);
  return codes;
}

}  // namespace bentaxis::study
