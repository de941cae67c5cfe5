#include "printed_model.h"

#include <Eigen/Dense>

namespace bentaxis::test {

std::vector<double> PrintedModel::reactions(const Instant& t) const {
  const Geometry& g = p_.geometry;
  const ChannelLayout at(g.pistons);
  std::vector<double> out(at.reactions());
  using V = Eigen::Vector3d;
  Eigen::Matrix3d r12;  // (7)
  r12 << 1, 0, 0, 0, std::cos(g.tilt), std::sin(g.tilt), 0, -std::sin(g.tilt), std::cos(g.tilt);
  const V o2(0, 0, g.axis_offset);
  const auto to_s2 = [&](const V& r1) -> V { return r12.transpose() * (r1 - o2); };
  const V gravity2 = r12.transpose() * V(0, -p_.gravity, 0);
  const double area = kPi * std::pow(g.bore_diameter / 2, 2);
  const double sign = t.shaft.speed < 0 ? -1 : 1;

  std::vector<V> joint1, ring2, contact2, rs, rc;
  std::vector<double> friction;
  for (int k = 0; k < g.pistons; ++k) {
    const double phase = 2 * kPi * k / g.pistons;
    const Jet js = sine(t.shaft.angle - phase, t.shaft);
    const Jet jc = cosine(t.shaft.angle - phase, t.shaft);
    const auto lift = [](double x) { return Jet(x); };
    // A in S1 (9), then in S2; B in S2 (11) with the positive root of (12).
    const Jet ax1 = lift(-g.joint_circle_radius) * js;
    const Jet ay1 = lift(g.joint_circle_radius) * jc;
    const Jet az1 = lift(-g.axis_offset);
    const double ct = std::cos(g.tilt);
    const double st = std::sin(g.tilt);
    const Jet a2[3] = {ax1, lift(ct) * ay1 - lift(st) * az1, lift(st) * ay1 + lift(ct) * az1};
    const Jet bx = lift(-g.bore_circle_radius) * sine(t.block.angle - phase, t.block);
    const Jet by = lift(g.bore_circle_radius) * cosine(t.block.angle - phase, t.block);
    const Jet dx = bx - a2[0];
    const Jet dy = by - a2[1];
    const Jet bz = a2[2] + sqrt(lift(g.piston_length * g.piston_length) - dx * dx - dy * dy);
    const Jet b2[3] = {bx, by, bz};
    const auto value = [](const Jet* j) { return V(j[0].v, j[1].v, j[2].v); };
    const auto rate = [](const Jet* j) { return V(j[0].d, j[1].d, j[2].d); };
    const auto acceleration = [&](const Jet* j) { return V(j[0].dd, j[1].dd, j[2].dd); };
    const V a = value(a2);
    const V b = value(b2);
    const V acc_a = acceleration(a2);
    const V acc_b = acceleration(b2);
    const double vb = bz.d;
    const V c = a + p_.piston.contact.value_or(g.piston_length) / g.piston_length * (b - a);
    double fpf = 0;
    if (a_.piston_friction)
      fpf = -(p_.friction.piston_coulomb *
                  (p_.friction.regularization > 0
                       ? std::tanh(vb / p_.friction.regularization)
                       : (std::abs(vb) <= 1e-12 * std::abs(t.shaft.speed) * g.joint_circle_radius
                              ? 0.0
                              : (vb > 0 ? 1.0 : -1.0))) +
              p_.friction.piston_viscous * vb);
    const V axial(0, 0, fpf - area * t.chamber_pressure[k]);

    // Known force and moment about O2, inertia included with its sign (31), (32).
    V force = axial;
    V moment = b.cross(axial);
    if (a_.inertia == PistonInertia::lumped) {
      const double ma = p_.piston.joint_mass_fraction * p_.piston.mass;
      const double mb = p_.piston.mass - ma;
      const V fa = ma * (gravity2 - acc_a);
      const V fb = mb * (gravity2 - acc_b);
      force += fa + fb;
      moment += a.cross(fa) + b.cross(fb);
    } else {
      const auto& real = *p_.piston.real;
      const double share = real.centre_of_mass / g.piston_length;
      const V centre = a + share * (b - a);
      const V fg = p_.piston.mass * (gravity2 - acc_a - share * (acc_b - acc_a));
      const V e = (b - a) / g.piston_length;
      const V e_rate = (rate(b2) - rate(a2)) / g.piston_length;
      const V e_acc = (acc_b - acc_a) / g.piston_length;
      force += fg;
      moment += centre.cross(fg) - real.transverse_inertia * e.cross(e_acc) -
                (a_.inertia == PistonInertia::real ? real.axial_inertia * real.spin : 0) * e_rate;
    }
    // Five unknowns, six equations of which one is an identity: least squares by QR.
    Eigen::Matrix<double, 6, 5> m = Eigen::Matrix<double, 6, 5>::Zero();
    for (int i = 0; i < 3; ++i) {
      m(i, i) = 1;
      m.block<3, 1>(3, i) = a.cross(V::Unit(i)) / g.piston_length;
    }
    for (int i = 0; i < 2; ++i) {
      m(i, 3 + i) = 1;
      m.block<3, 1>(3, 3 + i) = c.cross(V::Unit(i)) / g.piston_length;
    }
    Eigen::Matrix<double, 6, 1> right;
    right << -force, -moment / g.piston_length;
    const Eigen::Matrix<double, 5, 1> x = m.colPivHouseholderQr().solve(right);
    for (int i = 0; i < 3; ++i) out[at.Rs(k, i)] = x[i];
    for (int i = 0; i < 2; ++i) out[at.Rc(k, i)] = x[3 + i];
    rs.emplace_back(x[0], x[1], x[2]);
    rc.emplace_back(x[3], x[4], 0);
    joint1.emplace_back(ax1.v, ay1.v, 0);
    ring2.push_back(b);
    contact2.push_back(c);
    friction.push_back(fpf);
  }

  // Gear (19)-(22).
  const double cone = kPi / 2 - g.tilt / 2;
  const V o4(0, p_.gear.pitch_diameter / 2,
             -p_.gear.pitch_diameter / 2 / std::tan(cone) + g.axis_offset);
  const double ap = p_.gear.pressure_angle;
  V k4 = sign * V(-std::cos(ap), std::sin(ap) * std::cos(cone), std::sin(ap) * std::sin(cone));

  // Block (56), (57): unknown Fh, Thx, Thy, Rcnx, Rcny, Rcs.
  {
    V force(0, 0, p_.block.spring_force);
    V moment = V(
        0, 0,
        -p_.friction.block_viscous * t.block.speed - p_.block.axial_inertia * t.block.acceleration);
    for (int k = 0; k < g.pistons; ++k) {
      const V push(0, 0, p_.block.bottom_area * t.chamber_pressure[k] - friction[k]);
      force += push - rc[k];
      moment += ring2[k].cross(push) - contact2[k].cross(rc[k]);
    }
    const V weight = p_.block.mass * gravity2;
    force += weight;
    moment += V(0, 0, p_.block.centre_of_mass_z).cross(weight);
    if (p_.port_plate) add_film(t.ports, force, moment);
    Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Zero();
    m(2, 0) = 1;
    m(3, 1) = m(4, 2) = 1;
    for (int i = 0; i < 2; ++i) {
      m(i, 3 + i) = 1;
      m.block<3, 1>(3, 3 + i) = V(0, 0, p_.block.pin_z).cross(V::Unit(i));
    }
    Eigen::Matrix<double, 6, 1> right;
    right << -force, -moment;
    const auto solve = [&]() -> Eigen::Matrix<double, 6, 1> {
      const V line = r12.transpose() * k4;
      m.block<3, 1>(0, 5) = line;
      m.block<3, 1>(3, 5) = to_s2(o4).cross(line);
      return m.partialPivLu().solve(right);
    };
    Eigen::Matrix<double, 6, 1> x = solve();
    // Each flank has a line of its own, on which it only pushes. The column is positive where the
    // shaft pushes the block in the direction of rotation.
    if (p_.gear.flanks == Flanks::two) {
      const double pushes = x[5] < 0 ? -sign : sign;  // the block towards +psi
      k4 = sign * pushes *
           V(-pushes * std::cos(ap), std::sin(ap) * std::cos(cone), std::sin(ap) * std::sin(cone));
      x = solve();
    }
    out[at.Fh()] = x[0];
    out[at.Th(0)] = x[1];
    out[at.Th(1)] = x[2];
    out[at.Rcn(0)] = x[3];
    out[at.Rcn(1)] = x[4];
    out[at.Rcs()] = x[5];
  }

  // Shaft (42), (43): unknown Rb1, Rb2, Td.
  {
    V force = -p_.block.spring_force * (r12 * V::UnitZ());
    V moment = o2.cross(force);
    for (int k = 0; k < g.pistons; ++k) {
      const V on = -(r12 * rs[k]);
      force += on;
      moment += joint1[k].cross(on);
    }
    const V tooth = -out[at.Rcs()] * k4;
    force += tooth;
    moment += o4.cross(tooth);
    const V weight(0, -p_.shaft.mass * p_.gravity, 0);
    force += weight;
    moment += V(0, 0, p_.shaft.centre_of_mass_z).cross(weight);
    moment.z() -=
        p_.friction.shaft_viscous * t.shaft.speed + p_.shaft.axial_inertia * t.shaft.acceleration;
    Eigen::Matrix<double, 6, 6> m = Eigen::Matrix<double, 6, 6>::Zero();
    for (int i = 0; i < 3; ++i) {
      m(i, i) = 1;
      m.block<3, 1>(3, i) = V(0, 0, p_.bearings.tapered_z).cross(V::Unit(i));
    }
    for (int i = 0; i < 2; ++i) {
      m(i, 3 + i) = 1;
      m.block<3, 1>(3, 3 + i) = V(0, 0, p_.bearings.cylindrical_z).cross(V::Unit(i));
    }
    m(5, 5) = p_.friction.shaft_torque_factor;  // Td and its loss (38)
    Eigen::Matrix<double, 6, 1> right;
    right << -force, -moment;
    const Eigen::Matrix<double, 6, 1> x = m.partialPivLu().solve(right);
    for (int i = 0; i < 3; ++i) out[at.Rb1(i)] = x[i];
    for (int i = 0; i < 2; ++i) out[at.Rb2(i)] = x[3 + i];
    out[at.Td()] = x[5];
  }
  return out;
}

// Radial integrals of r and r^2 by Simpson's rule (exact for cubics).
void PrintedModel::add_film(const PortPressures& ports, Eigen::Vector3d& force,
                            Eigen::Vector3d& moment) const {
  const PortPlate& q = *p_.port_plate;
  const auto weight = [&](double r) {
    if (r <= q.r2) return (r - q.r1) / (q.r2 - q.r1);
    if (r >= q.r3) return (q.r4 - r) / (q.r4 - q.r3);
    return 1.0;
  };
  const auto simpson = [&](int power, double a, double b) {
    const auto f = [&](double r) { return weight(r) * std::pow(r, power); };
    return (b - a) / 6 * (f(a) + 4 * f((a + b) / 2) + f(b));
  };
  const auto radial = [&](int power) {
    return simpson(power, q.r1, q.r2) + simpson(power, q.r2, q.r3) + simpson(power, q.r3, q.r4);
  };
  for (const auto& [arc, pressure] :
       {std::pair{q.delivery, ports.delivery}, std::pair{q.suction, ports.suction}}) {
    const double from = radians(arc.from_deg);
    const double to = radians(arc.to_deg);
    force.z() -= pressure * radial(1) * (to - from);
    // integral of (-r sin, r cos) x (-z2) r dr
    moment.x() -= pressure * radial(2) * (std::sin(to) - std::sin(from));
    moment.y() += pressure * radial(2) * (std::cos(to) - std::cos(from));
  }
}

}  // namespace bentaxis::test
