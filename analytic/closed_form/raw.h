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

inline RawGeometry<double> raw(const Geometry& g) {
  return {g.tilt,        g.joint_circle_radius, g.bore_circle_radius,
          g.axis_offset, g.piston_length,       g.bore_diameter};
}

inline RawPlate<double> raw(const PortPlate& p) {
  return {p.r1,
          p.r2,
          p.r3,
          p.r4,
          {p.delivery.from_deg, p.delivery.to_deg},
          {p.suction.from_deg, p.suction.to_deg}};
}

inline RawPump<double> raw(const PumpParameters& p) {
  const PistonMass::Real real = p.piston.real.value_or(PistonMass::Real());
  const double contact = p.piston.contact.value_or(p.geometry.piston_length);
  const Block& b = p.block;
  const Friction& f = p.friction;
  return {raw(p.geometry),
          {p.gear.pitch_diameter, p.gear.pressure_angle},
          {p.bearings.tapered_z, p.bearings.cylindrical_z},
          {p.piston.mass,
           p.piston.joint_mass_fraction,
           contact,
           {real.centre_of_mass, real.transverse_inertia, real.axial_inertia, real.spin}},
          {p.shaft.mass, p.shaft.centre_of_mass_z, p.shaft.axial_inertia},
          {b.mass, b.centre_of_mass_z, b.pin_z, b.bottom_area, b.spring_force, b.axial_inertia},
          {f.piston_coulomb, f.piston_viscous, f.regularization, f.block_viscous, f.shaft_viscous,
           f.shaft_torque_factor},
          raw(p.port_plate.value_or(PortPlate())),
          p.gravity};
}

}  // namespace bentaxis::analytic::closed_form
