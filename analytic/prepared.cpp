#include "bentaxis/analytic/prepared.h"

#include <cmath>

#include "bentaxis/analytic/port_plate.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::analytic {
namespace {

using Numbers = closed_form::Pump<double>;

// Two point masses are a rigid body with centre at (1 - chi) b1 and chi (1 - chi) m b1^2 about it;
// both kinds of piston are treated through their moments about A.
void prepare_piston(const PumpParameters& pump, PistonInertia inertia, Numbers& p) {
  p.mass = pump.piston.mass;
  p.spin_momentum = 0;
  const double length = pump.geometry.piston_length;
  if (inertia == PistonInertia::lumped) {
    p.static_moment = p.mass * (1 - pump.piston.joint_mass_fraction);
    p.inertia = p.static_moment;
    return;
  }
  if (const std::string why = piston_inertia_refusal(inertia, pump); !why.empty())
    throw InputError(to_string(inertia) + " pistons: " + why);
  const PistonMass::Real& real = *pump.piston.real;
  const double centre = real.centre_of_mass;
  const double share = centre / length;
  if (inertia == PistonInertia::dynamically_equivalent) {
    // Point masses at A and B that have the transverse inertia about the centre of mass between
    // them, and the rest there.
    const bool spread = real.transverse_inertia > 0;
    const double at_joint = spread ? real.transverse_inertia / (length * centre) : 0;
    const double at_ring = spread ? real.transverse_inertia / (length * (length - centre)) : 0;
    const double at_centre = p.mass - at_joint - at_ring;
    p.static_moment = at_ring + at_centre * share;
    p.inertia = at_ring + at_centre * share * share;
    return;
  }
  p.static_moment = p.mass * share;
  p.inertia = p.mass * share * share + real.transverse_inertia / (length * length);
  p.spin_momentum = real.axial_inertia * real.spin / length;
}

void prepare_block(const PumpParameters& pump, Numbers& p) {
  const Block& block = pump.block;
  p.bottom_area = block.bottom_area;
  p.block_force_y = block.mass * p.gravity_y;
  p.block_force_z = block.spring_force + block.mass * p.gravity_z;
  p.block_moment_x = -block.centre_of_mass_z * block.mass * p.gravity_y;
  p.block_inertia = block.axial_inertia;
  p.block_viscous = pump.friction.block_viscous;
  p.pin_z = block.pin_z;
  LandForce delivery, suction;
  if (pump.port_plate) {
    delivery = land_force(*pump.port_plate, pump.port_plate->delivery);
    suction = land_force(*pump.port_plate, pump.port_plate->suction);
  }
  p.delivery_force = delivery.force_z;
  p.delivery_moment_x = delivery.moment_x;
  p.delivery_moment_y = delivery.moment_y;
  p.suction_force = suction.force_z;
  p.suction_moment_x = suction.moment_x;
  p.suction_moment_y = suction.moment_y;
}

// (19)-(22): axes bent by alpha and equal tooth counts make delta = 90 deg - alpha/2.
void prepare_gear(const PumpParameters& pump, Numbers& p) {
  const double half = pump.geometry.tilt / 2;
  const double radius = pump.gear.pitch_diameter / 2;
  const double sin_p = std::sin(pump.gear.pressure_angle);
  const double cos_p = std::cos(pump.gear.pressure_angle);
  p.gear_y = radius;
  p.gear_z1 = pump.geometry.axis_offset - radius * std::tan(half);
  p.gear_z2 = radius * std::tan(half);
  p.line_x = -cos_p;
  p.line_y1 = sin_p * std::sin(half);
  p.line_z1 = sin_p * std::cos(half);
  p.line_y2 = -p.line_y1;
  p.line_z2 = p.line_z1;
  p.inverse_gear_arm = 1 / (radius * cos_p);
}

void prepare_shaft(const PumpParameters& pump, Numbers& p) {
  const double weight = -pump.shaft.mass * pump.gravity;
  const double spring_y = -pump.block.spring_force * p.sin_tilt;  // along -z2, at O2
  p.shaft_force_y = weight + spring_y;
  p.shaft_force_z = -pump.block.spring_force * p.cos_tilt;
  p.shaft_moment_x = -pump.geometry.axis_offset * spring_y - pump.shaft.centre_of_mass_z * weight;
  p.shaft_inertia = pump.shaft.axial_inertia;
  p.shaft_viscous = pump.friction.shaft_viscous;
  p.inverse_torque_factor = 1 / pump.friction.shaft_torque_factor;
  p.tapered_z = pump.bearings.tapered_z;
  p.inverse_bearing_distance = 1 / (pump.bearings.cylindrical_z - pump.bearings.tapered_z);
}

}  // namespace

void prepare_geometry(const Geometry& g, closed_form::Pump<double>& p) {
  p.sin_tilt = std::sin(g.tilt);
  p.cos_tilt = std::cos(g.tilt);
  p.joint_radius = g.joint_circle_radius;
  p.joint_y = g.joint_circle_radius * p.cos_tilt;
  p.joint_z = g.joint_circle_radius * p.sin_tilt;
  p.difference = g.bore_circle_radius - g.joint_circle_radius;
  // Rd - Ra cos(alpha), without the cancellation that cos(alpha) next to 1 brings.
  const double half = std::sin(g.tilt / 2);
  p.projected = p.difference + 2 * g.joint_circle_radius * half * half;
  p.length_squared = g.piston_length * g.piston_length;
  p.offset_y = g.axis_offset * p.sin_tilt;
  p.offset_z = -g.axis_offset * p.cos_tilt;
  p.piston_area = kPi / 4 * g.bore_diameter * g.bore_diameter;
}

PreparedPump prepare(const PumpParameters& pump, const Assumptions& assumptions) {
  PreparedPump result;
  Numbers& p = result.numbers;
  prepare_geometry(pump.geometry, p);
  p.gravity_y = -pump.gravity * p.cos_tilt;
  p.gravity_z = -pump.gravity * p.sin_tilt;
  const Friction& friction = pump.friction;
  const bool any = assumptions.piston_friction;
  const bool smooth = friction.regularization > 0;
  p.coulomb = any ? friction.piston_coulomb : 0;
  p.viscous = any ? friction.piston_viscous : 0;
  p.inverse_regularization = smooth ? 1 / friction.regularization : 0;
  p.dry = smooth ? 0 : 1;
  result.smooth_friction = p.coulomb > 0 && smooth;
  result.dry_friction = p.coulomb > 0 && !smooth;
  prepare_piston(pump, assumptions.inertia, p);
  prepare_block(pump, p);
  prepare_gear(pump, p);
  prepare_shaft(pump, p);
  result.imposed = assumptions.gear == BlockDrive::imposed;
  for (int k = 0; k < pump.geometry.pistons; ++k) {
    result.phase_sin.push_back(std::sin(2 * kPi * k / pump.geometry.pistons));
    result.phase_cos.push_back(std::cos(2 * kPi * k / pump.geometry.pistons));
  }
  return result;
}

}  // namespace bentaxis::analytic
