#include "integration/motion_run.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bentaxis/multibody/model.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/units.h"
#include "bentaxis/results/max_abs.h"
#include "loads/friction.h"
#include "reactions/channels.h"
#include "reactions/solver_guard.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::Stage;
using SimTK::State;
using SimTK::Vec3;

namespace {

// Within a segment between edges the pressure is evaluated at least this far inside, degrees:
// beyond the tolerance within which an angle counts as on an edge.
constexpr double kInsideEdge = 2e-9;
// An angle this near to an edge, degrees, is on it.
constexpr double kOnEdge = 1e-10;
// Approach, of its unit, and share of a force that count as none where a branch ends.
constexpr double kNoApproach = 1e-10;
constexpr double kNoForce = 1e-9;
// m/s: of a piston that is about to turn.
constexpr double kNoSpeed = 1e-12;
// Events at one time after which nothing will come of it.
constexpr int kMaxEvents = 200;
double rpm(double speed) { return speed / kRadPerSecondPerRpm; }

// Of the duration: times nearer than that are one.
constexpr double kOneTime = 1e-12;

std::vector<double> pressure_edges(const PressureTrace& pressure, int pistons) {
  std::vector<double> edges;
  for (int k = 1; k <= pistons; ++k)
    for (const double edge : pressure.edges_deg()) {
      const double at = std::fmod(edge - piston_angle_deg(0, k, pistons), 360.0);
      edges.push_back(at < 0 ? at + 360 : at);
    }
  std::sort(edges.begin(), edges.end());
  const auto same = [](double a, double b) { return b - a < kInsideEdge; };
  edges.erase(std::unique(edges.begin(), edges.end(), same), edges.end());
  return edges;
}

ComputationError stopped(double time, const std::string& why) {
  const std::string model = "multibody model: ";
  const bool named = why.compare(0, model.size(), model) == 0;
  return ComputationError(model + "simulation stopped at " + short_text(time) +
                          " s: " + (named ? why.substr(model.size()) : why));
}

}  // namespace

MotionRun::MotionRun(const Case& the_case, const Assumptions& assumptions,
                     const PressureTrace& pressure, const IntegrationOptions& options,
                     long most_steps, bool body_loads)
    : case_(the_case),
      drive_(the_case),
      spec_(drive_.spec()),
      pressure_(pressure),
      system_(the_case.pump, assumptions, drive_.in_time()),
      stepper_(system_.system(), options, most_steps),
      body_loads_(body_loads),
      load_reader_(system_),
      edges_(pressure_edges(pressure, the_case.pump.geometry.pistons)),
      accuracy_(options.accuracy) {
  if (!has_equation_of_motion(the_case.pump, assumptions.inertia))
    throw ComputationError(
        "multibody model: a piston without inertia about its joint A (mass 0, or all of it at A) "
        "has no equation of motion in Simbody to simulate; use the analytic model");
  system_.inputs().ports = the_case.pressure.ports;
  place_at_start();
  set_pressure();
  const bool jumps = assumptions.piston_friction && the_case.pump.friction.regularization == 0 &&
                     the_case.pump.friction.piston_coulomb > 0;
  if (jumps) system_.inputs().held_direction.assign(system_.bodies().pistons.size(), 0);
  const State& state = system_.dynamics();
  energy_at_start_ = system_.system().calcKineticEnergy(state);
  if (system_.teeth() != nullptr) elastic_at_start_ += system_.teeth()->elastic_energy(state);
  if (system_.walls() != nullptr) elastic_at_start_ += system_.walls()->elastic_energy(state);
  if (system_.drive_torque() != nullptr)
    elastic_at_start_ += system_.drive_torque()->elastic_energy(state);
  stepper_.foresee(spec_.duration);
}

void MotionRun::place_at_start() {
  const double speed = drive_.start_speed();
  const AxisMotion shaft{0, speed, 0};
  AxisMotion block = shaft;
  if (system_.joint() != nullptr) block = JointMotion(case_.pump).block(shaft);
  block.acceleration = 0;
  // On an edge the block is past it in the direction it turns.
  const double psi = block.angle / kRadPerDegree;
  const double turn = psi < 0 ? -360 : 0;
  const double reached = psi - turn + (speed >= 0 ? kOnEdge : -kOnEdge);
  const auto passed =
      std::count_if(edges_.begin(), edges_.end(), [&](double edge) { return edge <= reached; });
  const auto count = static_cast<long>(edges_.size());
  segment_ = edges_.empty() ? 0 : passed - 1 + (turn < 0 ? -count : 0);
  system_.inputs().rest_speed = 0;
  Placement placement(system_);
  placement.place(shaft, block);
  if (const BoreWalls* walls = system_.walls()) {
    std::vector<WallBranch> held;
    for (std::size_t k = 0; k < walls->size(); ++k)
      held.push_back(walls->branch_at(system_.dynamics(), k));
    system_.wall_setting().held = held;
    system_.dynamics().invalidateAllCacheAtOrAbove(Stage::Dynamics);
  }
  if (system_.drive_torque() != nullptr)
    system_.drive_torque()->start(system_.dynamics(), speed, drive_.start_torque());
  system_.system().realize(system_.dynamics(), Stage::Velocity);
}

double MotionRun::psi_deg(const State& state) const {
  return system_.bodies().block.getOneQ(state, 0) / kRadPerDegree;
}
double MotionRun::block_speed(const State& state) const {
  return system_.bodies().block.getOneU(state, 0);
}
double MotionRun::shaft_speed(const State& state) const {
  return system_.bodies().shaft.getBodyAngularVelocity(state)[2];
}

// theta - psi.
double MotionRun::lag(const State& state) const {
  return system_.teeth() != nullptr ? system_.teeth()->advance(state) / system_.gear().arm()
                                    : -system_.gear_phase(state);
}

double MotionRun::shaft_angle(const State& state) const {
  const double near = system_.bodies().block.getOneQ(state, 0) + lag(state);
  const double angle = turn_angle(system_.bodies().shaft.getBodyRotation(state), SimTK::Rotation());
  return near + std::remainder(angle - near, 2 * kPi);
}

// The chambers' pressures on the branch of the present segment.
void MotionRun::set_pressure() {
  const auto edge = [this](long index) {
    const auto count = static_cast<long>(edges_.size());
    const long turn = index >= 0 ? index / count : -((-index + count - 1) / count);
    return edges_[static_cast<std::size_t>(index - turn * count)] +
           360.0 * static_cast<double>(turn);
  };
  const bool has_edges = !edges_.empty();
  low_ = has_edges ? edge(segment_) : -SimTK::Infinity;
  high_ = has_edges ? edge(segment_ + 1) : SimTK::Infinity;
  system_.inputs().chamber_pressure = [this, has_edges](double, double psi,
                                                        std::vector<double>& p) {
    double angle = psi / kRadPerDegree;
    if (has_edges) angle = std::clamp(angle, low_ + kInsideEdge, high_ - kInsideEdge);
    const int n = static_cast<int>(p.size());
    for (int k = 1; k <= n; ++k) p[k - 1] = pressure_(piston_angle_deg(angle, k, n));
  };
}

std::vector<MotionRun::Event> MotionRun::events() {
  std::vector<Event> events;
  add_pressure_edges(events);
  add_tooth_events(events);
  add_wall_events(events);
  add_friction_jumps(events);
  return events;
}

void MotionRun::add_pressure_edges(std::vector<Event>& events) {
  if (edges_.empty()) return;
  for (const int way : {1, -1}) {
    const double edge = way > 0 ? high_ : low_;
    events.push_back({{[=](const State& s) { return way * (psi_deg(s) - edge); },
                       [=](const State& s) { return way * block_speed(s) / kRadPerDegree; },
                       kOnEdge * std::max(1.0, std::abs(edge) / 3600)},
                      [=] {
                        segment_ += way;
                        set_pressure();
                      }});
  }
}

void MotionRun::add_tooth_events(std::vector<Event>& events) {
  const CompliantTeeth* teeth = system_.teeth();
  if (teeth == nullptr) return;
  const double tolerance = kNoApproach * teeth->unit();
  const ToothBranch branch = system_.tooth_branch();
  if (branch.flank == 0) {
    for (const int flank : {1, -1})
      events.push_back({{[=](const State& s) { return teeth->approach(s, flank); },
                         [=](const State& s) { return teeth->approach_rate(s, flank); }, tolerance},
                        [=] { touch(flank); }});
    return;
  }
  const int flank = branch.flank;
  events.push_back({{[=](const State& s) { return -teeth->approach(s, flank); },
                     [=](const State& s) { return -teeth->approach_rate(s, flank); }, tolerance},
                    [=] {
                      leave(flank);
                      if (case_.pump.gear.compliance->backlash == 0) touch(-flank);
                    }});
  const double dissipation = case_.pump.gear.compliance->dissipation;
  if (dissipation == 0) return;
  const int way = branch.released ? 1 : -1;
  events.push_back(
      {{[=](const State& s) { return way * (1 + dissipation * teeth->approach_rate(s, flank)); },
        {},
        kNoForce},
       [=] { set_branch(flank, !branch.released); }});
}

void MotionRun::add_wall_events(std::vector<Event>& events) {
  const BoreWalls* walls = system_.walls();
  if (walls == nullptr) return;
  const WallContact& law = walls->law();
  const double tolerance = kNoApproach * kWallApproach;
  for (std::size_t k = 0; k < walls->size(); ++k) {
    const WallBranch branch = system_.wall_setting().held[k];
    const double way = branch.touching ? -1 : 1;
    events.push_back({{[=](const State& s) { return way * walls->touch(s, k).approach; },
                       [=](const State& s) { return way * walls->touch(s, k).rate; }, tolerance},
                      [=] { branch.touching ? leave_wall(k) : touch_wall(k); }});
    if (!branch.touching || law.dissipation == 0) continue;
    const double turn = branch.released ? 1 : -1;
    events.push_back(
        {{[=](const State& s) { return turn * (1 + law.dissipation * walls->touch(s, k).rate); },
          {},
          kNoForce},
         [=] { system_.wall_setting().held[k].released = !branch.released; }});
  }
}

void MotionRun::add_friction_jumps(std::vector<Event>& events) {
  std::vector<double>& held = system_.inputs().held_direction;
  const Vec3 z2(system_.bodies().block_frame.z());
  for (std::size_t k = 0; k < held.size(); ++k) {
    const auto velocity = [this, z2, k](const State& s) {
      const SimTK::MobilizedBody& piston = system_.bodies().pistons[k];
      return dot(
          z2, piston.findStationVelocityInGround(s, Vec3(0, 0, case_.pump.geometry.piston_length)));
    };
    if (held[k] == 0) held[k] = velocity(stepper_.state()) < 0 ? -1 : 1;
    const double way = held[k];
    events.push_back({{[=](const State& s) { return -way * velocity(s); }, {}, kNoSpeed},
                      [this, way, k] { system_.inputs().held_direction[k] = -way; }});
  }
}

void MotionRun::set_branch(int flank, bool released) { system_.tooth_branch() = {flank, released}; }

void MotionRun::touch(int flank) {
  const State& state = stepper_.state();
  time_apart_ += stepper_.time() - apart_since_;
  impulse_at_touch_ = system_.teeth()->impulse(state);
  tooth_events_.push_back({stepper_.time(), true, flank, shaft_speed(state), block_speed(state),
                           system_.teeth()->approach_rate(state, flank), 0});
  set_branch(flank, false);
}

void MotionRun::leave(int flank) {
  const State& state = stepper_.state();
  apart_since_ = stepper_.time();
  if (!tooth_events_.empty())
    tooth_events_.back().impulse = system_.teeth()->impulse(state) - impulse_at_touch_;
  tooth_events_.push_back({stepper_.time(), false, flank, shaft_speed(state), block_speed(state),
                           system_.teeth()->approach_rate(state, flank), 0});
  set_branch(0, false);
}

int MotionRun::carrying_walls() {
  const auto& held = system_.wall_setting().held;
  return static_cast<int>(std::count_if(held.begin(), held.end(),
                                        [](const WallBranch& wall) { return wall.touching; }));
}

void MotionRun::touch_wall(std::size_t piston) {
  if (carrying_walls() == 0) time_apart_ += stepper_.time() - apart_since_;
  system_.wall_setting().held[piston] = {true, false};
  note_wall(piston, true);
}

void MotionRun::leave_wall(std::size_t piston) {
  system_.wall_setting().held[piston] = {};
  if (carrying_walls() == 0) apart_since_ = stepper_.time();
  note_wall(piston, false);
}

void MotionRun::note_wall(std::size_t piston, bool touch) {
  const State& state = stepper_.state();
  tooth_events_.push_back({stepper_.time(), touch, lag(state) < 0 ? -1 : 1, shaft_speed(state),
                           block_speed(state), system_.walls()->touch(state, piston).rate, 0,
                           static_cast<int>(piston) + 1});
}

void MotionRun::guard_against_chatter(double time) {
  const bool same = time - last_event_ <= kOneTime * spec_.duration;
  last_event_ = time;
  events_there_ = same ? events_there_ + 1 : 0;
  if (events_there_ > kMaxEvents)
    throw ComputationError("flanks, pressures or friction change " + std::to_string(kMaxEvents) +
                           " times at the same time without progress");
}

void MotionRun::advance_to(double time) {
  while (stepper_.time() < time) {
    const std::vector<Event> possible = events();
    std::vector<Witness> witnesses;
    for (const Event& event : possible) witnesses.push_back(event.witness);
    const int which = stepper_.advance(time, witnesses);
    if (which < 0) return;
    system_.system().realize(stepper_.state(), Stage::Velocity);
    possible[static_cast<std::size_t>(which)].happen();
    guard_against_chatter(stepper_.time());
    stepper_.restart();
  }
}

void MotionRun::run(Trajectory& trajectory, const Progress& progress) {
  const std::vector<double> rows = trajectory_times(spec_);
  std::vector<double> breakpoints;
  for (const double breakpoint : drive_.breakpoints())
    if (breakpoint > 0 && breakpoint < spec_.duration) breakpoints.push_back(breakpoint);
  stepper_.alive = [&] {
    if (progress) progress(std::min(1.0, stepper_.time() / spec_.duration));
  };
  try {
    stepper_.start(system_.dynamics());
    std::size_t breakpoint = 0;
    for (const double row : rows) {
      for (; breakpoint < breakpoints.size() && breakpoints[breakpoint] < row; ++breakpoint) {
        advance_to(breakpoints[breakpoint]);
        stepper_.restart();
      }
      advance_to(row);
      read(row, trajectory);
    }
  } catch (const SimTK::Exception::Base& error) {
    std::string why = error.getMessageText();
    std::replace(why.begin(), why.end(), '\n', ' ');
    throw stopped(stepper_.time(), why);
  } catch (const ComputationError& error) {
    throw stopped(stepper_.time(), error.what());
  }
  if (progress) progress(1);
  if (system_.teeth() != nullptr) {
    const bool apart = system_.tooth_branch().flank == 0;
    if (apart) time_apart_ += spec_.duration - apart_since_;
    if (!apart && !tooth_events_.empty())
      tooth_events_.back().impulse = system_.teeth()->impulse(stepper_.state()) - impulse_at_touch_;
    record_.share_out_of_contact = time_apart_ / spec_.duration;
  }
  if (system_.walls() != nullptr) {
    if (carrying_walls() == 0) time_apart_ += spec_.duration - apart_since_;
    record_.share_out_of_contact = time_apart_ / spec_.duration;
  }
  record_.events = tooth_events_;
  record_.steps = stepper_.steps();
  record_.evaluations = system_.system().getNumRealizationsOfThisStage(Stage::Acceleration);
  trajectory.record = record_;
}

void MotionRun::account(TrajectoryRecord& record) {
  const State& state = system_.dynamics();
  const auto& simbody = system_.system();
  double elastic = -elastic_at_start_;
  double drives = system_.work().of_drives(state);
  double total = system_.work().of_loads(state) + drives;
  if (system_.teeth() != nullptr) elastic += system_.teeth()->elastic_energy(state);
  if (system_.walls() != nullptr) elastic += system_.walls()->elastic_energy(state);
  if (system_.drive_torque() != nullptr) {
    elastic += system_.drive_torque()->elastic_energy(state);
    total -= drives;  // a torque that is applied is among the loads
  }
  record.kinetic_energy_gained = simbody.calcKineticEnergy(state) - energy_at_start_;
  record.potential_energy_gained = elastic;
  // What turns the shaft is Ct Td (38): the rest of Td's work is lost, to friction that is a load.
  if (spec_.kind != DriveKind::motor) drives /= case_.pump.friction.shaft_torque_factor;
  record.work_of_drives = drives;
  // What is left to dissipate: springs are accounted for by their energy.
  record.work_of_loads = total - drives + elastic;
  record.work_residual = total - record.kinetic_energy_gained;
  update_max_abs(record.worst_work_residual, record.work_residual);
  for (int i = 0; i < state.getNQErr(); ++i) update_max_abs(record.drift, state.getQErr()[i]);
}

void MotionRun::read(double time, Trajectory& trajectory) {
  State& state = system_.dynamics();
  state.setTime(stepper_.time());
  state.updY() = stepper_.state().getY();
  // A row is no step: what it reports follows the law, by which a piston that is slower than the
  // integration resolves is at rest.
  std::vector<double> held;
  held.swap(system_.inputs().held_direction);
  system_.inputs().rest_speed = std::max(kRestShare, accuracy_) *
                                std::abs(shaft_speed(stepper_.state())) *
                                case_.pump.geometry.joint_circle_radius;
  realize_with_flank(system_, state);
  held.swap(system_.inputs().held_direction);
  const double theta = shaft_angle(state) / kRadPerDegree;
  if (!std::isfinite(theta + shaft_speed(state) + block_speed(state)))
    throw ComputationError("the state is no longer finite");
  require_accurate_forces(estimated_force_error(system_, state), radians(theta));

  const int n = case_.pump.geometry.pistons;
  const ChannelLayout layout(system_.pump());
  std::vector<double> values(layout.size(), not_computed());
  std::vector<double> pressure(static_cast<std::size_t>(n));
  system_.inputs().chamber_pressure(0, system_.bodies().block.getOneQ(state, 0), pressure);
  const SimTK::Vector& udot = state.getUDot();
  // Of a given speed the sign is that of what was given: at rest the integration's own is
  // round-off.
  const AxisMotion shaft{radians(theta),
                         drive_.gives_speed() ? drive_.turning(time).speed : shaft_speed(state),
                         udot[system_.bodies().shaft.getFirstUIndex(state) + 2]};
  const AxisMotion block{radians(psi_deg(state)), block_speed(state),
                         udot[system_.bodies().block.getFirstUIndex(state)]};
  MotionChecks checks{};
  read_motion_row(system_, state, {shaft, block}, pressure, layout, values, checks);
  if (body_loads_) {
    Reactions reactions;
    reactions_from_multipliers(system_, state, reactions);
    trajectory.loads.append(load_reader_.read(state, udot, reactions, pressure, nullptr));
  }
  if (system_.has_rigid_gear()) system_.gear().setting().negative = false;

  std::vector<double> columns = {time, theta, psi_deg(state), rpm(shaft_speed(state)),
                                 rpm(block.speed)};
  const DriveTorque* torque = system_.drive_torque();
  if (torque != nullptr && torque->has_rotor()) columns.push_back(rpm(torque->rotor_speed(state)));
  append_trajectory_row(trajectory.table, columns, values, checks);
  trajectory.lag.push_back(lag(state));
  account(record_);
}

}  // namespace bentaxis::multibody
