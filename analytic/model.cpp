#include "bentaxis/analytic/model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>
#include <type_traits>

#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/validate.h"
#include "bentaxis/results/stopwatch.h"
#include "closed_form/bevel.h"
#include "closed_form/reactions.h"
#include "kinematics.h"
#include "prepared.h"
#include "turning.h"

namespace bentaxis::analytic {
namespace {

using Eigen::Vector3d;

Vector3d to_eigen(const closed_form::Vec3<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace

namespace {

// A piston's motion and forces at an instant.
struct PistonState {
  closed_form::PistonMotion<double> motion;
  double ring_velocity, friction;
  closed_form::PistonForces<double> forces;
};

template <class State>
PistonState piston_state(const PreparedPump& pump, const State& state, double pressure, int k) {
  const closed_form::Pump<double>& p = pump.numbers;
  const double phase_sin = pump.phase_sin[k];
  const double phase_cos = pump.phase_cos[k];
  PistonState piston;
  piston.motion = closed_form::piston_motion(p.frame, p.piston, state,
                                             state.sine * phase_cos - state.cosine * phase_sin,
                                             state.cosine * phase_cos + state.sine * phase_sin);
  piston.ring_velocity = piston.motion.ring_velocity(state.rate());
  piston.friction =
      closed_form::friction_force(pump.friction, p.friction, piston.ring_velocity, state.omega);
  piston.forces = closed_form::piston_forces(p.piston, piston.motion, state.rate(),
                                             state.rate_dot(), piston.friction, pressure);
  return piston;
}

// What is read and written without a further look.
template <class Real>
void require_sizes(const Instant& instant, const std::vector<Real>& values, int pistons,
                   std::size_t least) {
  if (instant.chamber_pressure.size() != static_cast<std::size_t>(pistons))
    throw InputError("analytic model: " + std::to_string(instant.chamber_pressure.size()) +
                     " chamber pressures for " + std::to_string(pistons) + " pistons");
  if (values.size() < least)
    throw InputError("analytic model: space for " + std::to_string(values.size()) +
                     " values, needed are " + std::to_string(least));
}

}  // namespace

namespace {

const PumpParameters& checked(const PumpParameters& pump) {
  validate(pump);
  if (pump.gear.contact == ToothContact::teeth)
    closed_form::require_mesh(pump.gear, closed_form::bevel(pump));
  return pump;
}

}  // namespace

Model::Model(const PumpParameters& pump, const Assumptions& assumptions)
    : Model(checked(pump), assumptions, Unchecked{}) {
  if (assumptions.flanks != FlankShape::involute)
    throw InputError("flank_shape: must be involute in the analytic model");
}

Model::Model(const PumpParameters& pump, const Assumptions& assumptions, Unchecked)
    : pump_(pump),
      layout_(pump),
      prepared_(std::make_shared<const PreparedPump>(prepare(pump, assumptions))) {}

namespace {

// A pump's numbers in another type: Pump is an array of numbers with names.
closed_form::Pump<long double> extended(const closed_form::Pump<double>& pump) {
  constexpr std::size_t kCount = sizeof pump / sizeof(double);
  double numbers[kCount];
  std::memcpy(numbers, &pump, sizeof numbers);
  long double wide[kCount];
  std::copy(std::begin(numbers), std::end(numbers), std::begin(wide));
  closed_form::Pump<long double> result;
  static_assert(sizeof result == sizeof wide);
  std::memcpy(&result, wide, sizeof result);
  return result;
}

template <class Real>
void all_reactions(const closed_form::Common& common, const closed_form::Pump<Real>& pump,
                   const Instant& instant, Real* results) {
  with_state<Real>(common.transfer, pump, instant, [&](const auto& state) {
    closed_form::reactions<Real>(
        common, pump, state, true,
        [pressure = instant.chamber_pressure.data()](int k) { return Real(pressure[k]); },
        [results](int index, Real value) { results[index] = value; });
  });
}

}  // namespace

bool Model::has_teeth() const { return prepared_->teeth && !prepared_->imposed; }

std::optional<Model::Settled> Model::find(const Instant& instant,
                                          std::vector<double>& values) const {
  require_sizes(instant, values, layout_.pistons(), layout_.reactions());
  if (!prepared_->has_tooth_force()) values[layout_.Rcs()] = not_computed();
  all_reactions(values.size() < layout_.size() ? prepared_->common() : prepared_->common(layout_),
                prepared_->numbers, instant, values.data());
  if (!has_teeth()) return {};
  return resolve_tooth_contact(instant, values);
}

void Model::act(const Instant& instant, const ToothLag& lag, TeethAction& teeth) const {
  teeth =
      prepared_->teeth->act(instant.shaft.angle, instant.shaft.speed, lag, instant.lag.has_value());
}

void Model::reactions(const Instant& instant, std::vector<double>& values,
                      TeethAction* teeth) const {
  const auto settled = find(instant, values);
  if (settled && teeth != nullptr) act(instant, settled->lag, *teeth);
}

AxisMotion Model::block_motion(const AxisMotion& shaft) const {
  if (!pump_.transfer.is_uneven_joint()) return shaft;
  Instant instant;
  instant.shaft = shaft;
  AxisMotion block;
  with_state<double>(prepared_->transfer, prepared_->numbers, instant, [&](const auto& state) {
    if constexpr (std::is_base_of_v<closed_form::FreeState<double>, std::decay_t<decltype(state)>>)
      block = {shaft.angle + std::atan2(state.lead_sine, 1 - state.lead_versine), state.block_omega,
               state.block_omega_dot};
  });
  return block;
}

void Model::reactions(const Instant& instant, std::vector<long double>& values) const {
  require_sizes(instant, values, layout_.pistons(), layout_.reactions());
  if (!prepared_->has_tooth_force()) values[layout_.Rcs()] = not_computed();
  all_reactions(prepared_->common(), extended(prepared_->numbers), instant, values.data());
  if (has_teeth()) resolve_tooth_contact(instant, values);
}

namespace {

// Towards +psi, of the column Rcs.
double on_block(const Instant& instant, double rcs) {
  return closed_form::Math<double>::direction(instant.shaft.speed) * rcs;
}

}  // namespace

// By the law where the instant says how the teeth stand, else at rest under the block's tooth
// force. Reactions were found with all of that at O4: what the teeth's own force and moment differ
// by comes on top.
template <class Real>
Model::Settled Model::resolve_tooth_contact(const Instant& instant,
                                            std::vector<Real>& values) const {
  using closed_form::Vec3;
  const closed_form::Pump<double>& p = prepared_->numbers;
  const BevelTeeth& teeth = *prepared_->teeth;
  const double tooth = on_block(instant, static_cast<double>(values[layout_.Rcs()]));
  const ToothLag lag =
      instant.lag ? *instant.lag : teeth.rest(instant.shaft.angle, tooth / p.gear.inverse_arm);
  const BevelTeeth::Wrench w =
      teeth.wrench(instant.shaft.angle, instant.shaft.speed, lag, instant.lag.has_value());
  const Vec3<double> force = {w.force[0], w.force[1], w.force[2]};
  const Vec3<double> moment = {w.moment[0], w.moment[1], w.moment[2]};
  const auto to_s2 = [&](const Vec3<double>& v) {
    return Vec3<double>{v.x, p.frame.cos_tilt * v.y - p.frame.sin_tilt * v.z,
                        p.frame.sin_tilt * v.y + p.frame.cos_tilt * v.z};
  };
  const auto at_o4 = closed_form::tooth_on_block(p.gear, tooth);
  const Vec3<double> block_moment = to_s2(moment) - at_o4.moment;
  const auto block = closed_form::hold_block(
      p.block, closed_form::BlockBalance<double>{to_s2(force) - at_o4.force, block_moment.x,
                                                 block_moment.y});
  const auto add = [&](std::size_t channel, double change) { values[channel] += change; };
  add(layout_.Fh(), block.fh);
  add(layout_.Th(0), block.th_x);
  add(layout_.Th(1), block.th_y);
  add(layout_.Rcn(0), block.pin_x);
  add(layout_.Rcn(1), block.pin_y);

  const auto shaft_at_o4 = closed_form::tooth_on_shaft(p.gear, tooth);
  const double offset = pump_.geometry.axis_offset;  // of O2 from O1
  const Vec3<double> about_o1 = moment + offset * Vec3<double>{-force.y, force.x, 0};
  const Vec3<double> shaft_force = -1.0 * force - shaft_at_o4.force;
  const Vec3<double> shaft_moment = -1.0 * about_o1 - shaft_at_o4.moment;
  const auto held = closed_form::bearings(p.shaft, shaft_force, shaft_moment.x, shaft_moment.y);
  add(layout_.Rb1(0), held.tapered.x);
  add(layout_.Rb1(1), held.tapered.y);
  add(layout_.Rb1(2), held.tapered.z);
  add(layout_.Rb2(0), held.cylindrical_x);
  add(layout_.Rb2(1), held.cylindrical_y);
  add(layout_.Td(), -shaft_moment.z * p.shaft.inverse_torque_factor);
  return {lag, w};
}

namespace {

// How the block turns, where it does not turn as the shaft and the layout has columns for that.
template <class State>
void put_block_motion(const ChannelLayout& at, const Instant& instant, const State& state,
                      std::vector<double>& values) {
  if (!at.has(Quantity::psi)) return;
  const double lead = std::atan2(state.lead_sine, 1 - state.lead_versine);
  values[at.psi()] = instant.shaft.angle + lead;
  if (at.has(Quantity::lag)) {
    // Given angles may be turns apart; a lag of its own digits is given as such.
    values[at.lag()] = instant.lag ? instant.lag->angle : instant.shaft.angle - instant.block.angle;
    values[at.psi()] = instant.shaft.angle - values[at.lag()];
  }
  if (at.has(Quantity::psi_speed)) {
    values[at.psi_speed()] = state.block_omega;
    values[at.psi_acceleration()] = state.block_omega_dot;
  }
}

// What follows from reactions that are found, and the checks. Sums of power are per unit of the
// motion's parameter (closed_form/state.h): over omega where the block is locked to the shaft.
template <class State>
MotionChecks judge(const PreparedPump& pump, const PumpParameters& parameters,
                   const ChannelLayout& at, const Instant& instant, const State& state,
                   const BevelTeeth::Wrench* teeth, std::vector<double>& values) {
  constexpr bool kLocked = !std::is_base_of_v<closed_form::FreeState<double>, State>;
  constexpr bool kWalls = std::is_same_v<State, closed_form::WallState<double>>;
  const closed_form::Pump<double>& numbers = pump.numbers;
  const closed_form::PistonNumbers<double>& p = numbers.piston;
  const Kinematics kinematics(parameters.geometry);
  const Friction& friction = parameters.friction;
  const AxisMotion& shaft = instant.shaft;
  // The angle is that of a gear's block, which its teeth ask for.
  const AxisMotion block = {instant.block.angle, state.block_speed(), state.block_acceleration()};
  const double rate = state.rate();
  const Vector3d gravity(0, p.gravity_y, p.gravity_z);
  const double length = parameters.geometry.piston_length;
  const double share_of_centre = p.mass > 0 ? p.static_moment / p.mass : 0;     // sG / b1
  const double inertia_centre = p.inertia - p.static_moment * share_of_centre;  // It / b1^2
  const bool off_the_ring = numbers.block.contact != 1;
  double carry = numbers.block.viscous * block.speed + numbers.block.inertia * block.acceleration;
  double work = 0;
  if (kLocked) {
    work = friction.shaft_torque_factor * values[at.Td()] -
           (numbers.shaft.viscous + numbers.block.viscous) * shaft.speed -
           (numbers.shaft.inertia + numbers.block.inertia) * shaft.acceleration;
  } else {
    work = (friction.shaft_torque_factor * values[at.Td()] - numbers.shaft.viscous * shaft.speed -
            numbers.shaft.inertia * shaft.acceleration) *
               shaft.speed -
           carry * block.speed;
    if (pump.has_tooth_force()) {
      const double tooth = on_block(instant, values[at.Rcs()]);
      work +=
          closed_form::tooth_on_block(numbers.gear, tooth).moment.z * (block.speed - shaft.speed);
    }
  }
  // What teeth take from the shaft beyond what their force at O4 would.
  if (teeth != nullptr) {
    const double tooth = on_block(instant, values[at.Rcs()]);
    work += (closed_form::tooth_on_block(numbers.gear, tooth).moment.z -
             BevelTeeth::about_shaft_axis(teeth->moment)) *
            (kLocked ? 1 : shaft.speed);
  }
  double ring_work = 0;
  for (int k = 0; k < at.pistons(); ++k) {
    const PistonState piston = piston_state(pump, state, instant.chamber_pressure[k], k);
    const double axial = piston.forces.axial;
    const Vector3d joint_path = to_eigen(piston.motion.joint_first);
    const Vector3d axis = to_eigen(piston.motion.axis);
    const Vector3d axis_path = to_eigen(piston.motion.axis_first);
    const Vector3d ring = to_eigen(piston.motion.joint) + axis;
    const Vector3d contact = to_eigen(closed_form::contact_point(numbers.block, piston.motion));
    const Vector3d joint_acceleration = to_eigen(piston.forces.joint_acceleration);
    const Vector3d axis_acceleration = to_eigen(piston.forces.axis_acceleration);
    const Vector3d rs(values[at.Rs(k, 0)], values[at.Rs(k, 1)], values[at.Rs(k, 2)]);
    const Vector3d rc(values[at.Rc(k, 0)], values[at.Rc(k, 1)], 0);

    values[at.pressure(k)] = instant.chamber_pressure[k];
    values[at.zB(k)] = ring.z();
    const Vector3d rs3 = kinematics.s3_in_s1(axis).transpose() * kinematics.to_s1(rs);
    for (int i = 0; i < 3; ++i) values[at.Rs3(k, i)] = rs3[i];
    const double share = contact.y() * rc.x() - contact.x() * rc.y();
    values[at.Tc(k)] = share;
    carry -= share;

    const Vector3d centre_path = joint_path + share_of_centre * axis_path;
    const Vector3d centre_acceleration = joint_acceleration + share_of_centre * axis_acceleration;
    if constexpr (kWalls) {
      const auto wall = closed_form::wall_approach(numbers.wall, piston.motion,
                                                   pump.clearance(static_cast<std::size_t>(k)));
      work -= (values[at.Rw(k, 0)] * wall.x + values[at.Rw(k, 1)] * wall.y) * wall.rate;
    }
    work += axial * (joint_path.z() + axis_path.z()) +
            p.mass * (gravity - centre_acceleration).dot(centre_path) -
            inertia_centre * axis_acceleration.dot(axis_path);
    if (off_the_ring) {
      // The play of the piston in its bore: C on the piston against the block's point there.
      const double block_path = kLocked ? 1 : block.speed;
      const Vector3d play = joint_path + numbers.block.contact * axis_path -
                            block_path * Vector3d::UnitZ().cross(contact);
      ring_work += rc.dot(play);
    }

    // Moments of everything on the piston about A, from the forces found; (32) was solved for x2
    // and y2 only, so the part about the piston's own axis is a check.
    const Vector3d moment = axis.cross(numbers.block.contact * rc + Vector3d(0, 0, axial)) +
                            axis.cross(p.static_moment * (gravity - joint_acceleration) -
                                       p.inertia * axis_acceleration) -
                            p.spin_momentum * rate * axis_path;
    values[at.axis_moment(k)] = axis.dot(moment) / length;
  }
  if (at.has(Quantity::Tcs)) values[at.Tcs()] = carry;
  if constexpr (kWalls) work += values[at.Tb()] * block.speed;
  if constexpr (!kLocked) put_block_motion(at, instant, state, values);
  work += ring_work;
  // The gear passes power on; an imposed block speed brings in power of its own.
  if (pump.imposed) work = kLocked ? work + carry : work + carry * block.speed;
  if (kLocked)
    values[at.power_residual()] = work;
  else
    values[at.power_residual()] = shaft.speed == 0 ? not_computed() : work / shaft.speed;
  double law = not_computed();
  if (pump.tooth_law)
    law = pump.tooth_law->force(shaft.angle - block.angle, shaft.speed - block.speed);
  if (teeth != nullptr)
    law = pump.teeth->about_block_axis(teeth->moment) * numbers.gear.inverse_arm;
  return {law, ring_work * rate, work * rate};
}

}  // namespace

void Model::evaluate(const Instant& instant, std::vector<double>& values, MotionChecks* checks,
                     TeethAction* teeth) const {
  require_sizes(instant, values, layout_.pistons(), layout_.size());
  const auto settled = find(instant, values);
  if (settled && teeth != nullptr) act(instant, settled->lag, *teeth);
  const ChannelLayout& at = layout_;
  const double fh = values[at.Fh()];
  values[at.xh()] = fh == 0 ? not_computed() : -values[at.Th(1)] / fh;  // (53)
  values[at.yh()] = fh == 0 ? not_computed() : values[at.Th(0)] / fh;

  MotionChecks found;
  with_state<double>(prepared_->transfer, prepared_->numbers, instant, [&](const auto& state) {
    found =
        judge(*prepared_, pump_, at, instant, state, settled ? &settled->wrench : nullptr, values);
  });
  if (checks != nullptr) *checks = found;
}

Model::FlankChange Model::flank_change(double tooth_force, double speed) const {
  const closed_form::Pump<double>& p = prepared_->numbers;
  closed_form::GearNumbers<double> one = p.gear;
  closed_form::GearNumbers<double> two = p.gear;
  one.two_flanks = 0;
  two.two_flanks = 1;
  const double tooth = closed_form::Math<double>::direction(speed) * tooth_force;
  const auto on_block_one = closed_form::tooth_on_block(one, tooth);
  const auto on_block_two = closed_form::tooth_on_block(two, tooth);
  const auto block = closed_form::hold_block(
      p.block, closed_form::BlockBalance<double>{on_block_two.force - on_block_one.force,
                                                 on_block_two.moment.x - on_block_one.moment.x,
                                                 on_block_two.moment.y - on_block_one.moment.y});
  const auto on_shaft_one = closed_form::tooth_on_shaft(one, tooth);
  const auto on_shaft_two = closed_form::tooth_on_shaft(two, tooth);
  const auto held = closed_form::bearings(p.shaft, on_shaft_two.force - on_shaft_one.force,
                                          on_shaft_two.moment.x - on_shaft_one.moment.x,
                                          on_shaft_two.moment.y - on_shaft_one.moment.y);
  return {std::hypot(block.pin_x, block.pin_y), std::abs(block.fh), to_eigen(held.tapered).norm(),
          std::hypot(held.cylindrical_x, held.cylindrical_y)};
}

Model::FrictionPower Model::friction_power(const Instant& instant, double drive_torque) const {
  require_sizes(instant, std::vector<double>(), layout_.pistons(), 0);
  const Friction& friction = pump_.friction;
  const double omega = instant.shaft.speed;
  FrictionPower power;
  power.shaft_viscous = -friction.shaft_viscous * omega * omega;
  power.shaft_proportional = -(1 - friction.shaft_torque_factor) * drive_torque * omega;
  power.pistons = -std::numeric_limits<double>::infinity();
  with_state<double>(prepared_->transfer, prepared_->numbers, instant, [&](const auto& state) {
    power.block = -friction.block_viscous * state.block_speed() * state.block_speed();
    for (int k = 0; k < layout_.pistons(); ++k) {
      const PistonState piston = piston_state(*prepared_, state, instant.chamber_pressure[k], k);
      power.pistons = std::max(power.pistons, piston.friction * piston.ring_velocity);
    }
  });
  return power;
}

namespace {

// How a table was made.
void note(Provenance& provenance, const Stopwatch& stopwatch, int n,
          const std::string& kinematics) {
  provenance.seconds = stopwatch.seconds();
  provenance.facts = {
      {"method",
       "closed form: equilibrium of pistons (31)-(33), block (56), (57), shaft (42), (43)"},
      {"bodies", std::to_string(n + 2) + " (shaft, block, " + std::to_string(n) + " pistons)"},
      {"equations",
       std::to_string(5 * n + 12) + " (5 per piston, 6 block, 6 shaft), solved body by body"},
      {"kinematics", kinematics}};
}

// Takes what the teeth do at each row of a table; nothing where there are none.
class TeethRows {
 public:
  /// @param table  null: not asked for
  TeethRows(const Model& model, const Gear& gear, ResultTable* table)
      : gear_(gear), table_(model.has_teeth() ? table : nullptr) {
    if (table_ != nullptr) *table_ = teeth_table("analytic");
  }
  /// Where the next row's is put.
  TeethAction* next() { return table_ != nullptr ? &action_ : nullptr; }
  void add(double theta_deg) {
    if (table_ != nullptr) append_teeth(*table_, theta_deg, gear_, action_);
  }
  std::size_t rows() const { return table_ != nullptr ? table_->rows() : 0; }

 private:
  const Gear& gear_;
  ResultTable* table_;
  TeethAction action_;
};

}  // namespace

ResultTable run(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                const Progress& progress, ResultTable* teeth) {
  const Stopwatch stopwatch;
  const Model model(validate(the_case).pump, assumptions);
  require_constant_speed(the_case);
  require_free_play(the_case);
  TeethRows acting(model, the_case.pump.gear, teeth);
  PlacedSamples placed(model, the_case);
  ResultTable table = tabulate(
      "analytic", model.layout(), samples,
      [&](const Instant& instant, std::vector<double>& row) {
        evaluate_at_constant_speed(model, placed.at(instant), row, acting.next());
        acting.add(samples.theta_deg[acting.rows()]);
      },
      progress);
  note(table.provenance, stopwatch, model.layout().pistons(),
       "exact derivatives with respect to theta (9)-(23)");
  if (the_case.pump.transfer.kind == TransferKind::pistons)
    table.provenance.facts.emplace_back("frozen lag", placed.rules().text());
  return table;
}

MotionTable run_states(const Case& the_case, const Assumptions& assumptions, const States& states,
                       const Progress& progress, ResultTable* teeth) {
  const Stopwatch stopwatch;
  const Model model(validate(the_case).pump, assumptions);
  TeethRows acting(model, the_case.pump.gear, teeth);
  MotionTable table = tabulate_states(
      "analytic", model.layout(), states,
      [&](const Instant& instant, std::vector<double>& row, MotionChecks& checks) {
        model.evaluate(instant, row, &checks, acting.next());
        acting.add(states.motion[acting.rows()].theta_deg);
      },
      progress);
  note(table.results.provenance, stopwatch, model.layout().pistons(),
       "exact total time derivatives of (9)-(12), with separate angles of shaft and block");
  return table;
}

}  // namespace bentaxis::analytic
