#include "checks/facts.h"

#include <algorithm>
#include <cmath>

#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/periodic_spline.h"
#include "bentaxis/pump/registry.h"
#include "bentaxis/results/samples.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/turn_summary.h"

namespace bentaxis::study::checks {
namespace {

constexpr int kTurnAngles = 72;  // of what is a mean or a share of the turn
constexpr int kPlayAngles = 360;
constexpr double kIdealTransition = 20;  // deg, where the pressure is still to be computed

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

}  // namespace

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

// A default that a file states, as those that commands write do, is nobody's number either.
bool Facts::defaulted(const std::string& table, const std::string& key) const {
  const Parameter& parameter = parameter_of(standard_registry(), table, key);
  if (const auto value = default_of(parameter, the_case);
      value && value == value_of(parameter, the_case))
    return true;
  for (const InputEntry& entry : the_case.entries)
    if (entry.table == table && entry.key == key) return entry.defaulted;
  return the_case.entries.empty();
}

const analytic::ValidityLimit* Facts::limit(const std::string& name) const {
  if (!turn) return nullptr;
  for (const auto& limit : turn->limits)
    if (limit.name == name) return limit.applicable ? &limit : nullptr;
  return nullptr;
}

}  // namespace bentaxis::study::checks
