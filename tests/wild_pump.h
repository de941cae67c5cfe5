// Random cases from tame to wild: any size, speed and load, any number of pistons, and now and then
// a small tilt, bearings close together or pistons next to the assembly limit. Seeded.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bentaxis/files/case_writer.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/inputs.h"
#include "support.h"

namespace bentaxis::test {

/// A pump `factor` times the size at the same stresses and speeds of points: forces grow with
/// factor^2, moments with factor^3. Exact for powers of 2.
inline void scale_pump(PumpParameters& p, double factor) {
  const double f = factor;
  const double f2 = f * f;
  const double f3 = f2 * f;
  Geometry& g = p.geometry;
  for (double* length :
       {&g.joint_circle_radius, &g.bore_circle_radius, &g.axis_offset, &g.piston_length,
        &g.bore_diameter, &p.gear.pitch_diameter, &p.bearings.tapered_z, &p.bearings.cylindrical_z,
        &p.shaft.centre_of_mass_z, &p.block.centre_of_mass_z, &p.block.pin_z})
    *length *= f;
  if (p.piston.contact) *p.piston.contact *= f;
  for (double* mass : {&p.piston.mass, &p.shaft.mass, &p.block.mass}) *mass *= f3;
  for (double* inertia : {&p.shaft.axial_inertia, &p.block.axial_inertia}) *inertia *= f3 * f2;
  if (p.piston.real) {
    p.piston.real->centre_of_mass *= f;
    p.piston.real->transverse_inertia *= f3 * f2;
    p.piston.real->axial_inertia *= f3 * f2;
    p.piston.real->spin /= f;
  }
  p.block.bottom_area *= f2;
  p.block.spring_force *= f2;
  p.friction.piston_coulomb *= f2;
  p.friction.piston_viscous *= f2;
  p.friction.block_viscous *= f2 * f2;
  p.friction.shaft_viscous *= f2 * f2;
  if (p.port_plate)
    for (double* r : {&p.port_plate->r1, &p.port_plate->r2, &p.port_plate->r3, &p.port_plate->r4})
      *r *= f;
  p.gravity /= f;
}

/// How a block moves past the shaft, on top of its motion.
struct Lead {
  double angle = 0, speed = 0, acceleration = 0, shaft_acceleration = 0;  ///< rad, rad/s, rad/s2
};

class RandomCase {
 public:
  explicit RandomCase(unsigned seed) : random_(seed) {}

  /// A case and an angle to look at it.
  struct Drawn {
    Case the_case;
    double theta_deg = 0;
    Lead lead;
  };

  Drawn tame() { return finish(random_.pump()); }

  /// That with a block that moves on its own, any flank, and bore forces anywhere on the pistons.
  Drawn freed(Drawn drawn) {
    PumpParameters& p = drawn.the_case.pump;
    if (random_.in(0, 1) < 0.5) p.gear.flanks = Flanks::two;
    if (random_.in(0, 1) < 0.5) p.piston.contact = power(-0.5, 0.2) * p.geometry.piston_length;
    Lead& lead = drawn.lead;
    lead = {random_.in(-0.1, 0.1), random_.in(-300, 300), random_.in(-9000, 9000),
            random_.in(-9000, 9000)};
    if (random_.in(0, 1) < 0.2) lead.angle *= power(-12, 0);
    if (random_.in(0, 1) < 0.2) lead.speed = lead.acceleration = 0;
    while (!assembled(drawn)) lead.angle /= 2;
    return drawn;
  }

  Drawn wild() {
    PumpParameters p = random_.pump();
    Geometry& g = p.geometry;
    const auto now_and_then = [&] { return random_.in(0, 1) < 0.2; };
    if (now_and_then()) g.tilt *= power(-9, 0);
    if (now_and_then()) g.bore_circle_radius = g.joint_circle_radius;
    if (now_and_then()) g.axis_offset = 0;
    if (now_and_then()) p.gear.pressure_angle = 0;
    if (now_and_then()) p.bearings.cylindrical_z = p.bearings.tapered_z - power(-7, 0);
    if (now_and_then()) p.piston.mass *= power(-9, 3);
    if (now_and_then()) p.piston.mass = 0;
    if (now_and_then()) p.piston.joint_mass_fraction = random_.in(0, 1) < 0.5 ? 0 : 1;
    if (p.piston.real && (now_and_then() || p.piston.mass == 0))
      p.piston.real->transverse_inertia = p.piston.real->axial_inertia = 0;
    if (now_and_then()) p.friction = {0, 0, 0.01, 0, 0, 1};
    if (now_and_then()) p.friction.regularization = 0;
    if (now_and_then()) p.gravity = 0;
    if (now_and_then()) {
      const double limit = assembly_margin(g).longest_distance;
      if (limit > 0.02 * g.joint_circle_radius) {
        const double length = limit * (1 + power(-6, -1));
        if (p.piston.real) p.piston.real->centre_of_mass *= length / g.piston_length;
        g.piston_length = length;
      }
    }
    scale_pump(p, power(-1.5, 1.5));
    Drawn drawn = finish(p);
    if (now_and_then()) drawn.the_case.operation.speed_rpm *= power(-6, 1.5);
    if (now_and_then()) drawn.the_case.operation.speed_rpm = 0;
    if (now_and_then()) drawn.theta_deg = 45 * std::floor(drawn.theta_deg / 45);
    return drawn;
  }

 private:
  // Whether joints and bores are no further apart than without the lead, but for little.
  static bool assembled(const Drawn& drawn) {
    const Geometry& g = drawn.the_case.pump.geometry;
    const double slack = g.piston_length - assembly_margin(g).longest_distance;
    for (int k = 0; k < g.pistons; ++k) {
      const double angle = radians(drawn.theta_deg) - 2 * kPi * k / g.pistons;
      if (joint_distance(g, angle, angle + drawn.lead.angle) > g.piston_length - slack / 2)
        return false;
    }
    return true;
  }

  // 10^x, x uniform.
  double power(double low, double high) { return std::pow(10.0, random_.in(low, high)); }

  Drawn finish(const PumpParameters& p) {
    Drawn drawn;
    Case& c = drawn.the_case;
    c.name = "random pump";
    c.pump = p;
    c.operation.speed_rpm = random_.in(-3000, 3000);
    c.operation.samples_per_revolution = 8;
    c.pressure.ports = {random_.in(-1e5, 1e6), random_.in(0, 4e7)};
    c.pressure.transition_deg = random_.in(1, 40);
    c.pressure.delivery_start_deg = random_.in(160, 200);
    c.analytic = {random_.in(0, 1) < 0.7, p.piston.inertia, BlockDrive::mesh};
    c.multibody = c.analytic;
    drawn.theta_deg = random_.in(-400, 400);
    return drawn;
  }

  RandomPump random_;
};

/// A failing case made plainer as long as it still fails: what is left is what matters.
inline Case shrink(Case the_case, const std::function<bool(const Case&)>& fails) {
  using Step = std::function<void(Case&)>;
  std::vector<Step> steps = {
      [](Case& c) { c.pump.port_plate.reset(); },
      [](Case& c) { c.pump.piston.contact.reset(); },
      [](Case& c) { c.pump.gear.flanks = Flanks::one; },
      [](Case& c) { c.pump.friction = {0, 0, 0.01, 0, 0, 1}; },
      [](Case& c) { c.analytic.piston_friction = c.multibody.piston_friction = false; },
      [](Case& c) { c.pump.gravity = 0; },
      [](Case& c) { c.pump.block.spring_force = 0; },
      [](Case& c) { c.operation.speed_rpm = 0; },
      [](Case& c) { c.pressure.transition_deg = 0; },
      [](Case& c) { c.pressure.delivery_start_deg = 180; },
      [](Case& c) { c.pressure.ports.suction = 0; },
      [](Case& c) {
        c.pressure.ports = {0, 1e7};
      },
      [](Case& c) {
        c.pump.piston.inertia = c.analytic.inertia = c.multibody.inertia = PistonInertia::lumped;
        c.pump.piston.real.reset();
      },
      [](Case& c) { c.pump.piston.mass = 0; },
      [](Case& c) { c.pump.shaft.mass = c.pump.block.mass = 0; }};
  for (int n = 1; n < the_case.pump.geometry.pistons; ++n)
    steps.emplace_back(
        [n](Case& c) { c.pump.geometry.pistons = std::min(n, c.pump.geometry.pistons); });
  for (std::size_t i = 0; i < continuous_inputs(the_case.pump).size(); ++i)
    steps.emplace_back([i](Case& c) {  // fewer digits
      const auto inputs = continuous_inputs(c.pump);
      if (i >= inputs.size()) return;
      double& value = *inputs[i].value;
      if (value == 0) return;
      const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 1);
      value = std::round(value / unit) * unit;
    });
  bool again = true;
  for (int round = 0; again && round < 10; ++round) {
    again = false;
    for (const Step& step : steps) {
      Case plainer = the_case;
      step(plainer);
      const bool piston_fits = plainer.pump.geometry.piston_length >
                               assembly_margin(plainer.pump.geometry).longest_distance;
      if (!piston_fits || case_text(plainer) == case_text(the_case) || !fails(plainer)) continue;
      the_case = plainer;
      again = true;
    }
  }
  return the_case;
}

}  // namespace bentaxis::test
