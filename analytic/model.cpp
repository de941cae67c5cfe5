#include "bentaxis/analytic/model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/validate.h"
#include "closed_form/reactions.h"
#include "kinematics.h"
#include "prepared.h"

namespace bentaxis::analytic {
namespace {

using Eigen::Vector3d;

Vector3d to_eigen(const closed_form::Vec3<double>& v) { return {v.x, v.y, v.z}; }

}  // namespace

// A piston's motion and forces at an instant.
struct Model::PistonState {
  closed_form::PistonMotion<double> motion;
  double ring_velocity, friction;
  closed_form::PistonForces<double> forces;
};

namespace {

// What is read and written without a further look.
template <class Real>
void require_sizes(const Instant& instant, const std::vector<Real>& values, int pistons,
                   std::size_t least) {
  if (instant.chamber_pressure.size() != static_cast<std::size_t>(pistons))
    throw InputError("analytic model: " + std::to_string(instant.chamber_pressure.size()) +
                     " chamber pressures for " + std::to_string(pistons) + " pistons");
  if (values.size() < least)
    throw InputError("analytic model: room for " + std::to_string(values.size()) +
                     " values, needed are " + std::to_string(least));
}

}  // namespace

Model::Model(const PumpParameters& pump, const Assumptions& assumptions)
    : Model(validate(pump), assumptions, Unchecked{}) {}

Model::Model(const PumpParameters& pump, const Assumptions& assumptions, Unchecked)
    : pump_(pump),
      layout_(pump.geometry.pistons),
      prepared_(std::make_shared<const PreparedPump>(prepare(pump, assumptions))) {}

Model::PistonState Model::piston_state(const Instant& instant, double sin_theta, double cos_theta,
                                       int k) const {
  const double phase_sin = prepared_->phase_sin[k];
  const double phase_cos = prepared_->phase_cos[k];
  const closed_form::Pump<double>& p = prepared_->numbers;
  const double omega = instant.shaft.speed;
  PistonState state;
  state.motion =
      closed_form::piston_motion(p.frame, p.piston, sin_theta * phase_cos - cos_theta * phase_sin,
                                 cos_theta * phase_cos + sin_theta * phase_sin);
  state.ring_velocity = state.motion.ring_velocity(omega);
  state.friction =
      closed_form::friction_force(prepared_->friction, p.friction, state.ring_velocity, omega);
  state.forces =
      closed_form::piston_forces(p.piston, state.motion, omega, instant.shaft.acceleration,
                                 state.friction, instant.chamber_pressure[k]);
  return state;
}

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
  const Real theta = instant.shaft.angle;
  const closed_form::State<Real> state = {std::sin(theta),
                                          std::cos(theta),
                                          Real(instant.shaft.speed),
                                          Real(instant.shaft.acceleration),
                                          Real(instant.ports.suction),
                                          Real(instant.ports.delivery)};
  closed_form::reactions(
      common, pump, state, true,
      [pressure = instant.chamber_pressure.data()](int k) { return Real(pressure[k]); },
      [results](int index, Real value) { results[index] = value; });
}

}  // namespace

void Model::reactions(const Instant& instant, std::vector<double>& values) const {
  require_locked(instant, "analytic");
  require_sizes(instant, values, layout_.pistons(), layout_.reactions());
  if (prepared_->imposed) values[layout_.Rcs()] = not_computed();
  all_reactions(prepared_->common(), prepared_->numbers, instant, values.data());
}

void Model::reactions(const Instant& instant, std::vector<long double>& values) const {
  require_locked(instant, "analytic");
  require_sizes(instant, values, layout_.pistons(), layout_.reactions());
  if (prepared_->imposed) values[layout_.Rcs()] = not_computed();
  all_reactions(prepared_->common(), extended(prepared_->numbers), instant, values.data());
}

void Model::evaluate(const Instant& instant, std::vector<double>& values) const {
  require_sizes(instant, values, layout_.pistons(), layout_.size());
  reactions(instant, values);
  const ChannelLayout& at = layout_;
  const double fh = values[at.Fh()];
  values[at.xh()] = fh == 0 ? not_computed() : -values[at.Th(1)] / fh;  // (53)
  values[at.yh()] = fh == 0 ? not_computed() : values[at.Th(0)] / fh;

  const closed_form::Pump<double>& numbers = prepared_->numbers;
  const closed_form::PistonNumbers<double>& p = numbers.piston;
  const Kinematics kinematics(pump_.geometry);
  const double omega = instant.shaft.speed;
  const double sin_theta = std::sin(instant.shaft.angle);
  const double cos_theta = std::cos(instant.shaft.angle);
  const Vector3d gravity(0, p.gravity_y, p.gravity_z);
  const double length = pump_.geometry.piston_length;
  const double share_of_centre = p.mass > 0 ? p.static_moment / p.mass : 0;     // sG / b1
  const double inertia_centre = p.inertia - p.static_moment * share_of_centre;  // It / b1^2
  double carry = numbers.block.viscous * omega + numbers.block.inertia * instant.shaft.acceleration;
  // Virtual work per radian: every term of the power balance divided by omega.
  double work = pump_.friction.shaft_torque_factor * values[at.Td()] -
                (numbers.shaft.viscous + numbers.block.viscous) * omega -
                (numbers.shaft.inertia + numbers.block.inertia) * instant.shaft.acceleration;
  for (int k = 0; k < at.pistons(); ++k) {
    const PistonState state = piston_state(instant, sin_theta, cos_theta, k);
    const double axial = state.forces.axial;
    const Vector3d joint_path = to_eigen(state.motion.joint_first);
    const Vector3d axis = to_eigen(state.motion.axis);
    const Vector3d axis_path = to_eigen(state.motion.axis_first);
    const Vector3d ring = to_eigen(state.motion.joint) + axis;
    const Vector3d joint_acceleration = to_eigen(state.forces.joint_acceleration);
    const Vector3d axis_acceleration = to_eigen(state.forces.axis_acceleration);
    const Vector3d rs(values[at.Rs(k, 0)], values[at.Rs(k, 1)], values[at.Rs(k, 2)]);
    const Vector3d rc(values[at.Rc(k, 0)], values[at.Rc(k, 1)], 0);

    values[at.pressure(k)] = instant.chamber_pressure[k];
    values[at.zB(k)] = ring.z();
    const Vector3d rs3 = kinematics.s3_in_s1(axis).transpose() * kinematics.to_s1(rs);
    for (int i = 0; i < 3; ++i) values[at.Rs3(k, i)] = rs3[i];
    const double share = ring.y() * rc.x() - ring.x() * rc.y();
    values[at.Tc(k)] = share;
    carry -= share;

    const Vector3d centre_path = joint_path + share_of_centre * axis_path;
    const Vector3d centre_acceleration = joint_acceleration + share_of_centre * axis_acceleration;
    work += axial * (joint_path.z() + axis_path.z()) +
            p.mass * (gravity - centre_acceleration).dot(centre_path) -
            inertia_centre * axis_acceleration.dot(axis_path);

    // Moments of everything on the piston about A, from the forces found; (32) was solved for x2
    // and y2 only, so the part about the piston's own axis is a check.
    const Vector3d moment = axis.cross(rc + Vector3d(0, 0, axial)) +
                            axis.cross(p.static_moment * (gravity - joint_acceleration) -
                                       p.inertia * axis_acceleration) -
                            p.spin_momentum * omega * axis_path;
    values[at.axis_moment(k)] = axis.dot(moment) / length;
  }
  values[at.Tcs()] = carry;
  // The gear passes power on; an imposed block speed brings in power of its own.
  values[at.power_residual()] = prepared_->imposed ? work + carry : work;
}

Model::FlankChange Model::other_flank(double tooth_force) const {
  // The part of k4 that pushes the gears apart, turned round.
  const closed_form::GearNumbers<double>& gear = prepared_->numbers.gear;
  const Vector3d on_block = 2 * std::abs(tooth_force) * Vector3d(0, gear.line_y1, gear.line_z1);
  const Vector3d moment = Vector3d(0, gear.y, gear.z1).cross(-on_block);
  const auto held =
      closed_form::bearings(prepared_->numbers.shaft, {-on_block.x(), -on_block.y(), -on_block.z()},
                            moment.x(), moment.y());
  return {Kinematics(pump_.geometry).to_s2(on_block).head<2>().norm(),
          to_eigen(held.tapered).norm(), std::hypot(held.cylindrical_x, held.cylindrical_y)};
}

Model::FrictionPower Model::friction_power(const Instant& instant, double drive_torque) const {
  require_locked(instant, "analytic");
  require_sizes(instant, std::vector<double>(), layout_.pistons(), 0);
  const Friction& friction = pump_.friction;
  const double omega = instant.shaft.speed;
  FrictionPower power;
  power.block = -friction.block_viscous * omega * omega;
  power.shaft_viscous = -friction.shaft_viscous * omega * omega;
  power.shaft_proportional = -(1 - friction.shaft_torque_factor) * drive_torque * omega;
  power.pistons = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < layout_.pistons(); ++k) {
    const PistonState state =
        piston_state(instant, std::sin(instant.shaft.angle), std::cos(instant.shaft.angle), k);
    power.pistons = std::max(power.pistons, state.friction * state.ring_velocity);
  }
  return power;
}

ResultTable run(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const Model model(validate(the_case).pump, assumptions);
  ResultTable table = tabulate(
      "analytic", model.layout(), samples,
      [&](const Instant& instant, std::vector<double>& row) { model.evaluate(instant, row); },
      progress);
  const int n = the_case.pump.geometry.pistons;
  table.provenance.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  table.provenance.facts = {
      {"method",
       "closed form: equilibrium of pistons (31)-(33), block (56), (57), shaft (42), (43)"},
      {"bodies", std::to_string(n + 2) + " (shaft, block, " + std::to_string(n) + " pistons)"},
      {"equations",
       std::to_string(5 * n + 12) + " (5 per piston, 6 block, 6 shaft), solved body by body"},
      {"kinematics", "exact derivatives with respect to theta (9)-(23)"}};
  return table;
}

}  // namespace bentaxis::analytic
