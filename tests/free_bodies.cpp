#include "free_bodies.h"

#include <cmath>

#include "bentaxis/pump/units.h"
#include "bentaxis/results/channels.h"
#include "printed_model.h"

namespace bentaxis::test {

double ring_friction(const Friction& f, double velocity, double rest_speed) {
  double share = 0;
  if (f.regularization > 0)
    share = std::tanh(velocity / f.regularization);
  else if (std::abs(velocity) > rest_speed)
    share = velocity < 0 ? -1 : 1;
  return -(f.piston_coulomb * share + f.piston_viscous * velocity);
}

double free_body_residual(const PumpParameters& p, const Assumptions& assumptions, const Instant& t,
                          const std::vector<double>& values, const TeethAction* teeth) {
  using V = Eigen::Vector3d;
  const Geometry& g = p.geometry;
  const ChannelLayout at(g.pistons);
  Eigen::Matrix3d r12;
  r12 << 1, 0, 0, 0, std::cos(g.tilt), std::sin(g.tilt), 0, -std::sin(g.tilt), std::cos(g.tilt);
  const V o2(0, 0, g.axis_offset);
  const V z2 = r12 * V::UnitZ();
  const double area = kPi * g.bore_diameter * g.bore_diameter / 4;
  const auto weight = [&](double mass) -> V { return {0, -mass * p.gravity, 0}; };
  FreeBody block;
  FreeBody shaft;
  double worst = 0;
  for (int k = 0; k < g.pistons; ++k) {
    const double phase = 2 * kPi * k / g.pistons;
    const Jet js = sine(t.shaft.angle - phase, t.shaft);
    const Jet jc = cosine(t.shaft.angle - phase, t.shaft);
    // A in S1; A and B in S2.
    const Jet a1[3] = {Jet(-g.joint_circle_radius) * js, Jet(g.joint_circle_radius) * jc, Jet(0)};
    const Jet az = Jet(-g.axis_offset);
    const Jet ct(std::cos(g.tilt));
    const Jet st(std::sin(g.tilt));
    const Jet a2[3] = {a1[0], ct * a1[1] - st * az, st * a1[1] + ct * az};
    const Jet bx = Jet(-g.bore_circle_radius) * sine(t.block.angle - phase, t.block);
    const Jet by = Jet(g.bore_circle_radius) * cosine(t.block.angle - phase, t.block);
    const Jet dx = bx - a2[0];
    const Jet dy = by - a2[1];
    const Jet h = sqrt(Jet(g.piston_length * g.piston_length) - dx * dx - dy * dy);
    const Jet axis[3] = {dx, dy, h};
    const auto part = [](const Jet* j, double Jet::*m) { return V(j[0].*m, j[1].*m, j[2].*m); };
    const V a = part(a1, &Jet::v);
    const V ab = r12 * part(axis, &Jet::v);
    const V b = a + ab;
    const V ac = p.piston.contact.value_or(g.piston_length) / g.piston_length * ab;
    const V acc_a = part(a1, &Jet::dd);
    const V acc_ab = r12 * part(axis, &Jet::dd);
    const V rs = r12 * V(values[at.Rs(k, 0)], values[at.Rs(k, 1)], values[at.Rs(k, 2)]);
    const V rc = r12 * V(values[at.Rc(k, 0)], values[at.Rc(k, 1)], 0);
    const double v = a2[2].d + h.d;
    const double friction =
        assumptions.piston_friction
            ? ring_friction(p.friction, v, 1e-12 * std::abs(t.shaft.speed) * g.joint_circle_radius)
            : 0;
    // Moments about A: the lever of what acts at A is exactly 0.
    FreeBody piston;
    piston.force(V::Zero(), rs);
    piston.force(ac, rc);
    piston.force(ab, (friction - area * t.chamber_pressure[k]) * z2);
    const auto mass_at = [&](double mass, double share) {
      piston.force(share * ab, weight(mass) - mass * (acc_a + share * acc_ab));
    };
    if (assumptions.inertia == PistonInertia::lumped) {
      mass_at(p.piston.joint_mass_fraction * p.piston.mass, 0);
      mass_at((1 - p.piston.joint_mass_fraction) * p.piston.mass, 1);
    } else {
      const auto& real = *p.piston.real;
      const double length = g.piston_length;
      mass_at(p.piston.mass, real.centre_of_mass / length);
      const V e_rate = r12 * part(axis, &Jet::d) / length;
      piston.moment(-real.transverse_inertia / (length * length) * ab.cross(acc_ab));
      // Point masses on the axis do not spin.
      if (assumptions.inertia == PistonInertia::real)
        piston.moment(-real.axial_inertia * real.spin * e_rate);
    }
    worst = std::max(worst, piston.residual());

    block.force(a + ac - o2, -rc);
    block.force(b - o2, -friction * z2);
    block.force(b - o2, p.block.bottom_area * t.chamber_pressure[k] * z2);
    shaft.force(a, -rs);
  }
  // Gear (19)-(22).
  const double delta = kPi / 2 - g.tilt / 2;
  const V o4(0, p.gear.pitch_diameter / 2,
             g.axis_offset - p.gear.pitch_diameter / 2 * std::tan(g.tilt / 2));
  const double ap = p.gear.pressure_angle;
  const double towards_psi = (t.shaft.speed < 0 ? -1 : 1) * values[at.Rcs()];
  const double apart = p.gear.flanks == Flanks::two ? std::abs(towards_psi) : towards_psi;
  const V tooth(-std::cos(ap) * towards_psi, std::sin(ap) * std::cos(delta) * apart,
                std::sin(ap) * std::sin(delta) * apart);
  if (teeth == nullptr) {
    block.force(o4 - o2, tooth);
    shaft.force(o4, -tooth);
  } else {
    for (const PairContact& pair : teeth->pairs) {
      if (!(pair.force > 0)) continue;
      const V point(pair.point[0], pair.point[1], pair.point[2]);
      const V force = pair.force * V(pair.normal[0], pair.normal[1], pair.normal[2]);
      block.force(point, force);
      shaft.force(o2 + point, -force);
    }
  }

  block.force(V::Zero(), (p.block.spring_force + values[at.Fh()]) * z2);
  block.moment(r12 * V(values[at.Th(0)], values[at.Th(1)], 0));
  block.force(p.block.pin_z * z2, r12 * V(values[at.Rcn(0)], values[at.Rcn(1)], 0));
  block.force(p.block.centre_of_mass_z * z2, weight(p.block.mass));
  block.moment(
      -(p.friction.block_viscous * t.block.speed + p.block.axial_inertia * t.block.acceleration) *
      z2);
  if (p.port_plate) {
    V force = V::Zero();
    V moment = V::Zero();
    PrintedModel(p, assumptions).add_film(t.ports, force, moment);
    block.force(V::Zero(), r12 * force);
    block.moment(r12 * moment);
  }
  shaft.force(o2, -p.block.spring_force * z2);
  shaft.force({0, 0, p.bearings.tapered_z},
              {values[at.Rb1(0)], values[at.Rb1(1)], values[at.Rb1(2)]});
  shaft.force({0, 0, p.bearings.cylindrical_z}, {values[at.Rb2(0)], values[at.Rb2(1)], 0});
  shaft.force({0, 0, p.shaft.centre_of_mass_z}, weight(p.shaft.mass));
  shaft.moment({0, 0,
                p.friction.shaft_torque_factor * values[at.Td()] -
                    p.friction.shaft_viscous * t.shaft.speed -
                    p.shaft.axial_inertia * t.shaft.acceleration});
  return std::max({worst, block.residual(), shaft.residual()});
}

}  // namespace bentaxis::test
