#include "bentaxis/analytic/model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::analytic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double direction(double omega) { return omega < 0 ? -1 : 1; }

}  // namespace

struct Model::PistonLoad {
  Vector3d joint_acceleration, axis_acceleration;  // of A, and second time derivative of AB
  double axial = 0;                                // Fp + Fpf, N along z2 at B
  double friction = 0;                             // Fpf
};

struct Model::Sums {
  Vector2d bore_force = Vector2d::Zero();    // sum of Rc
  Vector3d block_moment = Vector3d::Zero();  // of -Rc, -Fpf and Ftp about O2 (57)
  double block_axial = 0;                    // of -Fpf and Ftp (56)
  Vector3d joint_force = Vector3d::Zero();   // sum of Rs, in S1
  Vector3d joint_moment = Vector3d::Zero();  // of Rs at A about O1, in S1
};

Model::Model(const PumpParameters& pump, const Assumptions& assumptions)
    : pump_(pump),
      layout_(pump.geometry.pistons),
      kinematics_(pump.geometry),
      imposed_(assumptions.gear == GearScene::imposed),
      friction_(pump.friction) {
  const Geometry& g = pump.geometry;
  for (int k = 0; k < g.pistons; ++k) {
    phase_sin_.push_back(std::sin(2 * kPi * k / g.pistons));
    phase_cos_.push_back(std::cos(2 * kPi * k / g.pistons));
  }
  piston_area_ = kPi / 4 * g.bore_diameter * g.bore_diameter;
  const Vector3d gravity = kinematics_.to_s2({0, -pump.gravity, 0});
  gravity_y_ = gravity.y();
  gravity_z_ = gravity.z();
  if (!assumptions.piston_friction) friction_.piston_coulomb = friction_.piston_viscous = 0;

  // Two point masses are a rigid body with centre at (1 - chi) b1 and chi (1 - chi) m b1^2 about
  // it; both kinds of piston are treated through their moments about A.
  mass_ = pump.piston.mass;
  const double length = g.piston_length;
  if (assumptions.inertia == PistonInertia::lumped) {
    centre_share_ = 1 - pump.piston.joint_mass_fraction;
    inertia_ = mass_ * centre_share_;
    spin_momentum_ = 0;
  } else if (const std::string why = piston_inertia_refusal(assumptions.inertia, pump);
             !why.empty()) {
    throw InputError(to_string(assumptions.inertia) + " pistons: " + why);
  } else if (assumptions.inertia == PistonInertia::dynamically_equivalent) {
    // Point masses at A and B that have the transverse inertia about the centre of mass between
    // them, and the rest there.
    const PistonMass::Real& real = *pump.piston.real;
    const double centre = real.centre_of_mass;
    const bool spread = real.transverse_inertia > 0;
    const double at_joint = spread ? real.transverse_inertia / (length * centre) : 0;
    const double at_ring = spread ? real.transverse_inertia / (length * (length - centre)) : 0;
    const double at_centre = mass_ - at_joint - at_ring;
    const double share = centre / length;
    static_moment_ = at_ring + at_centre * share;
    centre_share_ = mass_ > 0 ? static_moment_ / mass_ : share;
    inertia_ = at_ring + at_centre * share * share;
    spin_momentum_ = 0;
  } else {
    const PistonMass::Real& real = *pump.piston.real;
    centre_share_ = real.centre_of_mass / length;
    inertia_ = mass_ * centre_share_ * centre_share_ + real.transverse_inertia / (length * length);
    spin_momentum_ = real.axial_inertia * real.spin / length;
  }
  if (assumptions.inertia != PistonInertia::dynamically_equivalent)
    static_moment_ = mass_ * centre_share_;

  if (pump.port_plate) {
    land_delivery_ = land_force(*pump.port_plate, pump.port_plate->delivery);
    land_suction_ = land_force(*pump.port_plate, pump.port_plate->suction);
  }

  // Gear (19)-(22): axes bent by alpha and equal tooth counts make delta = 90 deg - alpha/2.
  const double half = g.tilt / 2;
  const double radius = pump.gear.pitch_diameter / 2;
  const double sin_p = std::sin(pump.gear.pressure_angle);
  const double cos_p = std::cos(pump.gear.pressure_angle);
  gear_point_s1_ = {0, radius, g.axis_offset - radius * std::tan(half)};
  gear_point_s2_ = {0, radius, radius * std::tan(half)};
  separation_s1_ = {0, sin_p * std::sin(half), sin_p * std::cos(half)};
  gear_line_s1_ = Vector3d(-cos_p, 0, 0) + separation_s1_;
  gear_line_s2_ = {-cos_p, -sin_p * std::sin(half), sin_p * std::cos(half)};
  gear_arm_ = radius * cos_p;
  block_axis_s1_ = kinematics_.to_s1(Vector3d::UnitZ());
}

Model::PistonLoad Model::piston_load(const PistonKinematics& state, const Instant& instant,
                                     int k) const {
  PistonLoad load;
  const double omega2 = instant.omega * instant.omega;
  load.joint_acceleration = state.joint.second * omega2 + state.joint.first * instant.omega_dot;
  load.axis_acceleration = state.axis.second * omega2 + state.axis.first * instant.omega_dot;
  const double velocity = (state.joint.first.z() + state.axis.first.z()) * instant.omega;
  load.friction = piston_friction_force(friction_, velocity,
                                        piston_rest_speed(pump_.geometry, instant.omega));  // (25)
  load.axial = load.friction - piston_area_ * instant.chamber_pressure[k];                  // (24)
  return load;
}

void Model::solve_piston(const PistonKinematics& state, const PistonLoad& load,
                         const Instant& instant, Vector3d& joint_force,
                         Vector2d& bore_force) const {
  const Vector3d& axis = state.axis.value;
  const Vector3d free_fall = Vector3d(0, gravity_y_, gravity_z_) - load.joint_acceleration;
  // Weight, inertia and gyroscopic moment about A (26)-(28), appendix.
  const Vector3d moment =
      axis.cross(static_moment_ * free_fall - inertia_ * load.axis_acceleration) -
      spin_momentum_ * instant.omega * state.axis.first;
  // Moment equilibrium about A gives Rc (32), force equilibrium gives Rs (31).
  bore_force = {(axis.x() * load.axial - moment.y()) / axis.z(),
                (axis.y() * load.axial + moment.x()) / axis.z()};
  joint_force = static_moment_ * load.axis_acceleration - mass_ * free_fall;
  joint_force.head<2>() -= bore_force;
  joint_force.z() -= load.axial;
}

double Model::solve_block(const Sums& sums, const Instant& instant,
                          std::vector<double>& values) const {
  const Block& block = pump_.block;
  const double sign = direction(instant.omega);
  // About z2 (57): the torque that carries the block round.
  const double carry = block.axial_inertia * instant.omega_dot +
                       friction_.block_viscous * instant.omega - sums.block_moment.z();
  Vector3d force(-sums.bore_force.x(), -sums.bore_force.y() + block.mass * gravity_y_,
                 sums.block_axial + block.spring_force + block.mass * gravity_z_);
  Vector3d moment = sums.block_moment;
  moment.x() -= block.centre_of_mass_z * block.mass * gravity_y_;
  const double delivery = instant.ports.delivery;
  const double suction = instant.ports.suction;
  force.z() += land_delivery_.force_z * delivery + land_suction_.force_z * suction;
  moment.x() += land_delivery_.moment_x * delivery + land_suction_.moment_x * suction;
  moment.y() += land_delivery_.moment_y * delivery + land_suction_.moment_y * suction;

  double tooth_force = 0;
  if (imposed_) {
    values[layout_.Rcs()] = not_computed();
  } else {
    tooth_force = sign * carry / gear_arm_;
    const Vector3d on_block = sign * tooth_force * gear_line_s2_;
    force += on_block;
    moment += gear_point_s2_.cross(on_block);
    values[layout_.Rcs()] = tooth_force;
  }
  const double pin_x = -force.x();
  const double pin_y = -force.y();
  values[layout_.Rcn(0)] = pin_x;
  values[layout_.Rcn(1)] = pin_y;
  values[layout_.Fh()] = -force.z();
  values[layout_.Th(0)] = -moment.x() + block.pin_z * pin_y;
  values[layout_.Th(1)] = -moment.y() - block.pin_z * pin_x;
  return tooth_force;
}

Model::BearingForces Model::bearings(const Vector3d& force, const Vector3d& moment) const {
  const double z1 = pump_.bearings.tapered_z;
  const double distance = pump_.bearings.cylindrical_z - z1;
  BearingForces result;
  result.cylindrical = {(z1 * force.x() - moment.y()) / distance,
                        (z1 * force.y() + moment.x()) / distance};
  result.tapered = -force;
  result.tapered.head<2>() -= result.cylindrical;
  return result;
}

void Model::solve_shaft(const Sums& sums, const Instant& instant, double tooth_force,
                        std::vector<double>& values) const {
  const Shaft& shaft = pump_.shaft;
  const Vector3d spring = -pump_.block.spring_force * block_axis_s1_;
  const Vector3d tooth = -direction(instant.omega) * tooth_force * gear_line_s1_;
  const double weight = -shaft.mass * pump_.gravity;
  Vector3d force = spring + tooth - sums.joint_force;
  force.y() += weight;
  Vector3d moment = gear_point_s1_.cross(tooth) - sums.joint_moment;
  moment.x() += -pump_.geometry.axis_offset * spring.y() - shaft.centre_of_mass_z * weight;

  const BearingForces held = bearings(force, moment);
  for (int axis = 0; axis < 3; ++axis) values[layout_.Rb1(axis)] = held.tapered[axis];
  for (int axis = 0; axis < 2; ++axis) values[layout_.Rb2(axis)] = held.cylindrical[axis];
  values[layout_.Td()] = (shaft.axial_inertia * instant.omega_dot +
                          friction_.shaft_viscous * instant.omega - moment.z()) /
                         friction_.shaft_torque_factor;  // (38), (43)
}

void Model::reactions(const Instant& instant, std::vector<double>& values) const {
  const int n = layout_.pistons();
  const double sin_theta = std::sin(instant.theta);
  const double cos_theta = std::cos(instant.theta);
  Sums sums;
  for (int k = 0; k < n; ++k) {
    double s = 0;
    double c = 0;
    piston_angle(sin_theta, cos_theta, k, s, c);
    const PistonKinematics state = kinematics_.piston(s, c);
    const PistonLoad load = piston_load(state, instant, k);
    Vector3d rs;
    Vector2d rc;
    solve_piston(state, load, instant, rs, rc);
    for (int axis = 0; axis < 3; ++axis) values[layout_.Rs(k, axis)] = rs[axis];
    for (int axis = 0; axis < 2; ++axis) values[layout_.Rc(k, axis)] = rc[axis];

    const Vector3d ring = state.ring();
    const double axial = pump_.block.bottom_area * instant.chamber_pressure[k] - load.friction;
    sums.bore_force += rc;
    sums.block_axial += axial;
    sums.block_moment +=
        Vector3d(ring.z() * rc.y() + ring.y() * axial, -ring.z() * rc.x() - ring.x() * axial,
                 ring.y() * rc.x() - ring.x() * rc.y());
    const Vector3d rs1 = kinematics_.to_s1(rs);
    const double ra = pump_.geometry.joint_circle_radius;
    sums.joint_force += rs1;
    sums.joint_moment += Vector3d(-ra * s, ra * c, 0).cross(rs1);
  }
  const double tooth_force = solve_block(sums, instant, values);
  solve_shaft(sums, instant, tooth_force, values);
}

void Model::evaluate(const Instant& instant, std::vector<double>& values) const {
  reactions(instant, values);
  const ChannelLayout& at = layout_;
  const double fh = values[at.Fh()];
  values[at.xh()] = fh == 0 ? not_computed() : -values[at.Th(1)] / fh;  // (53)
  values[at.yh()] = fh == 0 ? not_computed() : values[at.Th(0)] / fh;

  const double omega = instant.omega;
  const double sin_theta = std::sin(instant.theta);
  const double cos_theta = std::cos(instant.theta);
  const Vector3d gravity(0, gravity_y_, gravity_z_);
  const double length = pump_.geometry.piston_length;
  const double inertia_centre = inertia_ - mass_ * centre_share_ * centre_share_;  // It / b1^2
  double carry = friction_.block_viscous * omega + pump_.block.axial_inertia * instant.omega_dot;
  // Virtual work per radian: every term of the power balance divided by omega.
  double work = friction_.shaft_torque_factor * values[at.Td()] -
                (friction_.shaft_viscous + friction_.block_viscous) * omega -
                (pump_.shaft.axial_inertia + pump_.block.axial_inertia) * instant.omega_dot;
  for (int k = 0; k < at.pistons(); ++k) {
    double s = 0;
    double c = 0;
    piston_angle(sin_theta, cos_theta, k, s, c);
    const PistonKinematics state = kinematics_.piston(s, c);
    const PistonLoad load = piston_load(state, instant, k);
    const Vector3d rs(values[at.Rs(k, 0)], values[at.Rs(k, 1)], values[at.Rs(k, 2)]);
    const Vector3d rc(values[at.Rc(k, 0)], values[at.Rc(k, 1)], 0);
    const Vector3d ring = state.ring();

    values[at.pressure(k)] = instant.chamber_pressure[k];
    values[at.zB(k)] = ring.z();
    const Vector3d rs3 = kinematics_.s3_in_s1(state.axis.value).transpose() * kinematics_.to_s1(rs);
    for (int axis = 0; axis < 3; ++axis) values[at.Rs3(k, axis)] = rs3[axis];
    const double share = ring.y() * rc.x() - ring.x() * rc.y();
    values[at.Tc(k)] = share;
    carry -= share;

    const Vector3d centre_path = state.joint.first + centre_share_ * state.axis.first;
    const Vector3d centre_acceleration =
        load.joint_acceleration + centre_share_ * load.axis_acceleration;
    work += load.axial * (state.joint.first.z() + state.axis.first.z()) +
            mass_ * (gravity - centre_acceleration).dot(centre_path) -
            inertia_centre * load.axis_acceleration.dot(state.axis.first);

    // Moments of everything on the piston about A, from the forces found; (32) was solved for x2
    // and y2 only, so the part about the piston's own axis is a check.
    const Vector3d& axis = state.axis.value;
    const Vector3d moment = axis.cross(rc + Vector3d(0, 0, load.axial)) +
                            axis.cross(static_moment_ * (gravity - load.joint_acceleration) -
                                       inertia_ * load.axis_acceleration) -
                            spin_momentum_ * omega * state.axis.first;
    values[at.axis_moment(k)] = axis.dot(moment) / length;
  }
  values[at.Tcs()] = carry;
  // The gear passes power on; an imposed block speed brings in power of its own.
  values[at.power_residual()] = imposed_ ? work + carry : work;
}

Model::FlankChange Model::other_flank(double tooth_force) const {
  const Vector3d on_block = 2 * std::abs(tooth_force) * separation_s1_;
  const BearingForces held = bearings(-on_block, -gear_point_s1_.cross(on_block));
  return {kinematics_.to_s2(on_block).head<2>().norm(), held.tapered.norm(),
          held.cylindrical.norm()};
}

Model::FrictionPower Model::friction_power(const Instant& instant, double drive_torque) const {
  const double omega = instant.omega;
  FrictionPower power;
  power.block = -friction_.block_viscous * omega * omega;
  power.shaft_viscous = -friction_.shaft_viscous * omega * omega;
  power.shaft_proportional = -(1 - friction_.shaft_torque_factor) * drive_torque * omega;
  power.pistons = -std::numeric_limits<double>::infinity();
  for (int k = 0; k < layout_.pistons(); ++k) {
    double s = 0;
    double c = 0;
    piston_angle(std::sin(instant.theta), std::cos(instant.theta), k, s, c);
    const PistonKinematics state = kinematics_.piston(s, c);
    const double velocity = (state.joint.first.z() + state.axis.first.z()) * omega;
    power.pistons = std::max(power.pistons, piston_load(state, instant, k).friction * velocity);
  }
  return power;
}

ResultTable run(const Case& the_case, const Assumptions& assumptions, const Samples& samples,
                const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const Model model(the_case.pump, assumptions);
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
