// The numbers of a pump that the closed form is made from, SI: those of PumpParameters as plain
// numbers of any type, so that a type that carries derivatives goes the same way.
#pragma once

#include "bentaxis/pump/parameters.h"

namespace bentaxis::analytic::closed_form {

/// As Geometry.
template <class T>
struct RawGeometry {
  T tilt, joint_circle_radius, bore_circle_radius, axis_offset, piston_length, bore_diameter;
};

/// As PortPlate, angles in degrees.
template <class T>
struct RawArc {
  T from_deg, to_deg;
};
template <class T>
struct RawPlate {
  T r1, r2, r3, r4;
  RawArc<T> delivery, suction;
};

/// Numbers only, so that it is an array of them with names. What a pump lacks is 0.
template <class T>
struct RawPump {
  RawGeometry<T> geometry;
  struct {
    T pitch_diameter, pressure_angle;
  } gear;
  struct {
    T phase, cross_distance;
    struct {
      T from_joint, clearance, stiffness, exponent, dissipation;
    } wall;
  } transfer;
  struct {
    T tapered_z, cylindrical_z;
  } bearings;
  struct {
    T mass, joint_mass_fraction;
    T contact;  // s_C: from A to the point C of its axis where Rc acts; that of B unless the pump
                // says otherwise
    struct {
      T centre_of_mass, transverse_inertia, axial_inertia, spin;
    } real;
  } piston;
  struct {
    T mass, centre_of_mass_z, axial_inertia;
  } shaft;
  struct {
    T mass, centre_of_mass_z, pin_z, bottom_area, spring_force, axial_inertia;
  } block;
  struct {
    T piston_coulomb, piston_viscous, regularization, block_viscous, shaft_viscous,
        shaft_torque_factor;
  } friction;
  RawPlate<T> plate;
  T gravity;
};

// Field by field with its name: a swap does not compile.
inline RawGeometry<double> raw(const Geometry& g) {
  return {.tilt = g.tilt,
          .joint_circle_radius = g.joint_circle_radius,
          .bore_circle_radius = g.bore_circle_radius,
          .axis_offset = g.axis_offset,
          .piston_length = g.piston_length,
          .bore_diameter = g.bore_diameter};
}

inline RawArc<double> raw(const PortArc& arc) {
  return {.from_deg = arc.from_deg, .to_deg = arc.to_deg};
}

inline RawPlate<double> raw(const PortPlate& p) {
  return {.r1 = p.r1,
          .r2 = p.r2,
          .r3 = p.r3,
          .r4 = p.r4,
          .delivery = raw(p.delivery),
          .suction = raw(p.suction)};
}

inline RawPump<double> raw(const PumpParameters& p) {
  const PistonMass::Real real = p.piston.real.value_or(PistonMass::Real());
  const WallContact wall = p.transfer.wall.value_or(WallContact());
  return {
      .geometry = raw(p.geometry),
      .gear = {.pitch_diameter = p.gear.pitch_diameter, .pressure_angle = p.gear.pressure_angle},
      .transfer = {.phase = p.transfer.phase(),
                   .cross_distance =
                       p.transfer.double_cardan.value_or(DoubleCardanJoint()).cross_distance,
                   .wall = {.from_joint = wall.from_joint,
                            .clearance = wall.clearance,
                            .stiffness = wall.stiffness,
                            .exponent = wall.exponent,
                            .dissipation = wall.dissipation}},
      .bearings = {.tapered_z = p.bearings.tapered_z, .cylindrical_z = p.bearings.cylindrical_z},
      .piston = {.mass = p.piston.mass,
                 .joint_mass_fraction = p.piston.joint_mass_fraction,
                 .contact = p.piston.contact.value_or(p.geometry.piston_length),
                 .real = {.centre_of_mass = real.centre_of_mass,
                          .transverse_inertia = real.transverse_inertia,
                          .axial_inertia = real.axial_inertia,
                          .spin = real.spin}},
      .shaft = {.mass = p.shaft.mass,
                .centre_of_mass_z = p.shaft.centre_of_mass_z,
                .axial_inertia = p.shaft.axial_inertia},
      .block = {.mass = p.block.mass,
                .centre_of_mass_z = p.block.centre_of_mass_z,
                .pin_z = p.block.pin_z,
                .bottom_area = p.block.bottom_area,
                .spring_force = p.block.spring_force,
                .axial_inertia = p.block.axial_inertia},
      .friction = {.piston_coulomb = p.friction.piston_coulomb,
                   .piston_viscous = p.friction.piston_viscous,
                   .regularization = p.friction.regularization,
                   .block_viscous = p.friction.block_viscous,
                   .shaft_viscous = p.friction.shaft_viscous,
                   .shaft_torque_factor = p.friction.shaft_torque_factor},
      .plate = raw(p.port_plate.value_or(PortPlate())),
      .gravity = p.gravity};
}

}  // namespace bentaxis::analytic::closed_form
