#include "bentaxis/analytic/body_loads.h"

#include <array>
#include <string>

#include "bentaxis/analytic/constant_speed.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/pump/validate.h"
#include "closed_form/reactions.h"
#include "prepared.h"
#include "turning.h"

namespace bentaxis::analytic {
namespace {

using Vector = closed_form::Vec3<double>;

constexpr Vector kNone = {0, 0, 0};

std::array<double, 3> array(const Vector& v) { return {v.x, v.y, v.z}; }
Vector vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

// What holds a body back from its acceleration.
struct Inertia {
  Vector force, moment;  // about the centre of mass
};

}  // namespace

struct BodyLoads::Implementation {
  Implementation(const PumpParameters& the_pump, const Assumptions& the_assumptions)
      : pump(the_pump),
        inertia(the_assumptions.inertia),
        model(the_pump, the_assumptions),
        prepared(prepare(the_pump, the_assumptions)),
        values(model.layout().size()) {}

  std::vector<BodyLoad> all(const Instant& given, const std::vector<double>& row,
                            const TeethAction& acting) const;
  template <class State>
  void add_pistons(const Instant& instant, const State& state, const std::vector<double>& row,
                   std::vector<BodyLoad>& pistons, std::vector<BodyLoad>& block,
                   std::vector<BodyLoad>& shaft) const;
  void add_block(const Instant& instant, const std::vector<double>& row,
                 std::vector<BodyLoad>& on) const;
  void add_shaft(const Instant& instant, const std::vector<double>& row,
                 std::vector<BodyLoad>& on) const;
  void add_transfer(const Instant& instant, const std::vector<double>& row,
                    const TeethAction& acting, std::vector<BodyLoad>& block,
                    std::vector<BodyLoad>& shaft) const;
  double centre_of_mass() const;
  Inertia piston_inertia(const Vector& axis, const Vector& axis_rate, const Vector& joint,
                         const Vector& axis_acceleration) const;

  // From S2 to S1.
  Vector turned(const Vector& v) const { return closed_form::to_s1(prepared.numbers.frame, v); }
  Vector placed(const Vector& p) const { return turned(p) + o2(); }
  Vector o2() const { return {0, 0, pump.geometry.axis_offset}; }
  Vector weight(double mass) const { return {0, -mass * pump.gravity, 0}; }

  PumpParameters pump;
  PistonInertia inertia;
  Model model;
  PreparedPump prepared;
  std::vector<double> values;
  TeethAction teeth;
};

namespace {

void add(std::vector<BodyLoad>& loads, const char* on, const std::string& by, const char* symbol,
         const std::string& point, ForceKind kind, const Vector& at, const Vector& force,
         const Vector& moment = kNone) {
  loads.push_back({on, by, symbol, point, kind, array(at), array(force), array(moment)});
}

}  // namespace

// Of a piston, from A.
double BodyLoads::Implementation::centre_of_mass() const {
  return inertia == PistonInertia::lumped
             ? (1 - pump.piston.joint_mass_fraction) * pump.geometry.piston_length
             : pump.piston.real->centre_of_mass;
}

// In S2, of the piston whose axis AB has this rate and acceleration and whose joint this one.
Inertia BodyLoads::Implementation::piston_inertia(const Vector& axis, const Vector& axis_rate,
                                                  const Vector& joint,
                                                  const Vector& axis_acceleration) const {
  const double length = pump.geometry.piston_length;
  const double mass = pump.piston.mass;
  const double centre = centre_of_mass();
  Inertia held = {kNone, kNone};
  // A point mass on the axis, from A.
  const auto hold = [&](double part, double from_joint) {
    const Vector force = -part * (joint + from_joint / length * axis_acceleration);
    held.force = held.force + force;
    held.moment = held.moment + cross((from_joint - centre) / length * axis, force);
  };
  if (inertia == PistonInertia::lumped) {
    hold(pump.piston.joint_mass_fraction * mass, 0);
    hold((1 - pump.piston.joint_mass_fraction) * mass, length);
    return held;
  }
  const PistonMass::Real& real = *pump.piston.real;
  if (inertia == PistonInertia::dynamically_equivalent) {
    // Both outer masses have their common centre at the piston's own.
    const double outer =
        real.transverse_inertia > 0 ? real.transverse_inertia / (centre * (length - centre)) : 0;
    hold(outer * (length - centre) / length, 0);
    hold(mass - outer, centre);
    hold(outer * centre / length, length);
    return held;
  }
  hold(mass, centre);
  // H = It e x e' + Ia w_s e (appendix).
  held.moment = -real.transverse_inertia / (length * length) * cross(axis, axis_acceleration) -
                real.axial_inertia * real.spin / length * axis_rate;
  return held;
}

template <class State>
void BodyLoads::Implementation::add_pistons(const Instant& instant, const State& state,
                                            const std::vector<double>& row,
                                            std::vector<BodyLoad>& pistons,
                                            std::vector<BodyLoad>& block,
                                            std::vector<BodyLoad>& shaft) const {
  const closed_form::Pump<double>& p = prepared.numbers;
  const ChannelLayout& at = model.layout();
  const bool at_ring = p.block.contact == 1;
  for (int k = 0; k < at.pistons(); ++k) {
    const double pressure = instant.chamber_pressure[k];
    const auto m = closed_form::piston_motion(
        p.frame, p.piston, state,
        state.sine * prepared.phase_cos[k] - state.cosine * prepared.phase_sin[k],
        state.cosine * prepared.phase_cos[k] + state.sine * prepared.phase_sin[k]);
    const double friction = closed_form::friction_force(prepared.friction, p.friction,
                                                        m.ring_velocity(state.rate()), state.omega);
    const double rate = state.rate();
    const Inertia held =
        piston_inertia(m.axis, rate * m.axis_first,
                       rate * rate * m.joint_second + state.rate_dot() * m.joint_first,
                       rate * rate * m.axis_second + state.rate_dot() * m.axis_first);

    const std::string number = std::to_string(k + 1);
    const std::string name = "piston " + number;
    const std::string ring = "B" + number;
    const std::string bore = at_ring ? ring : "contact point " + number;
    const Vector a = placed(m.joint);
    const Vector b = placed(m.joint + m.axis);
    const Vector c = placed(closed_form::contact_point(p.block, m));
    const Vector g = placed(m.joint + centre_of_mass() / pump.geometry.piston_length * m.axis);
    const Vector rs = turned({row[at.Rs(k, 0)], row[at.Rs(k, 1)], row[at.Rs(k, 2)]});
    const Vector rc = turned({row[at.Rc(k, 0)], row[at.Rc(k, 1)], 0});
    const Vector rub = turned({0, 0, friction});
    const char* on = name.c_str();
    add(pistons, on, "shaft", "Rs", "A" + number, ForceKind::reaction, a, rs);
    add(pistons, on, "block", "Rc", bore, ForceKind::reaction, c, rc);
    add(pistons, on, "oil", "Fp", ring, ForceKind::applied, b,
        turned({0, 0, -p.piston.area * pressure}));
    add(pistons, on, "block", "Fpf", ring, ForceKind::applied, b, rub);
    add(pistons, on, "gravity", "Pp", "centre of mass", ForceKind::applied, g,
        weight(pump.piston.mass));
    add(pistons, on, name, "inertia", "centre of mass", ForceKind::inertia, g, turned(held.force),
        turned(held.moment));

    add(block, "block", name, "Rc", bore, ForceKind::reaction, c, -1.0 * rc);
    add(block, "block", name, "Fpf", ring, ForceKind::applied, b, -1.0 * rub);
    add(block, "block", "oil", "Ftp", ring, ForceKind::applied, b,
        turned({0, 0, pump.block.bottom_area * pressure}));
    if (at.has(Quantity::Rw)) {
      const Vector d = placed(m.joint + p.wall.along * m.axis);
      const Vector rw = turned({row[at.Rw(k, 0)], row[at.Rw(k, 1)], 0});
      add(pistons, on, "block", "Rw", "D" + number, ForceKind::reaction, d, rw);
      add(block, "block", name, "Rw", "D" + number, ForceKind::reaction, d, -1.0 * rw);
    }
    add(shaft, "shaft", name, "Rs", "A" + number, ForceKind::reaction, a, -1.0 * rs);
  }
}

void BodyLoads::Implementation::add_transfer(const Instant& instant, const std::vector<double>& row,
                                             const TeethAction& acting,
                                             std::vector<BodyLoad>& block,
                                             std::vector<BodyLoad>& shaft) const {
  const closed_form::GearNumbers<double>& gear = prepared.numbers.gear;
  const ChannelLayout& at = model.layout();
  if (at.has(Quantity::TcsJoint)) {
    const Vector couple = turned({row[at.TcsJoint(0)], row[at.TcsJoint(1)], row[at.TcsJoint(2)]});
    add(block, "block", "shaft", "Tcs", "about O2", ForceKind::reaction, o2(), kNone, couple);
    add(shaft, "shaft", "block", "Tcs", "about O2", ForceKind::reaction, o2(), kNone,
        -1.0 * couple);
    if (!at.has(Quantity::Fcs)) return;
    const Vector force = turned({row[at.Fcs(0)], row[at.Fcs(1)], row[at.Fcs(2)]});
    add(block, "block", "shaft", "Fcs", "O2", ForceKind::reaction, o2(), force);
    add(shaft, "shaft", "block", "Fcs", "O2", ForceKind::reaction, o2(), -1.0 * force);
    return;
  }
  if (at.has(Quantity::Tb)) {
    if (is_computed(row[at.Tb()]))
      add(block, "block", "outside", "Tb", "about z2", ForceKind::reaction, o2(), kNone,
          turned({0, 0, row[at.Tb()]}));
    return;
  }
  if (prepared.imposed) {
    add(block, "block", "imposed motion", "Tcs", "about z2", ForceKind::reaction, o2(), kNone,
        turned({0, 0, row[at.Tcs()]}));
    return;
  }
  const Vector o4 = {0, gear.y, gear.z1};
  const auto put = [&](const char* point, const Vector& there, const Vector& on_block,
                       const Vector& on_shaft) {
    add(block, "block", "shaft", "Rcs", point, ForceKind::reaction, there, on_block);
    add(shaft, "shaft", "block", "Rcs", point, ForceKind::reaction, there, on_shaft);
  };
  if (!model.has_teeth()) {
    const double tooth = closed_form::Math<double>::direction(instant.shaft.speed) * row[at.Rcs()];
    put("O4", o4, turned(closed_form::tooth_on_block(gear, tooth).force),
        closed_form::tooth_on_shaft(gear, tooth).force);
    return;
  }
  for (std::size_t i = 0; i < acting.pairs.size(); ++i) {
    const PairContact& pair = acting.pairs[i];
    const bool touches = pair.force > 0;
    const Vector force = touches ? pair.force * vector(pair.normal) : kNone;
    put(kPairNames[i], touches ? vector(pair.point) + o2() : o4, force, -1.0 * force);
  }
}

// All but what pistons and gear do.
void BodyLoads::Implementation::add_block(const Instant& instant, const std::vector<double>& row,
                                          std::vector<BodyLoad>& on) const {
  const ChannelLayout& at = model.layout();
  const auto reaction = [&](const char* by, const char* symbol, const char* point, const Vector& r,
                            const Vector& force, const Vector& moment) {
    add(on, "block", by, symbol, point, ForceKind::reaction, r, turned(force), turned(moment));
  };
  reaction("port-plate film", "Fh", "O2", o2(), {0, 0, row[at.Fh()]}, kNone);
  reaction("port-plate film", "Th", "about O2", o2(), kNone, {row[at.Th(0)], row[at.Th(1)], 0});
  reaction("pin", "Rcn", "(0, 0, z_pin)", placed({0, 0, pump.block.pin_z}),
           {row[at.Rcn(0)], row[at.Rcn(1)], 0}, kNone);
  const auto applied = [&](const char* by, const char* symbol, const char* point, const Vector& r,
                           const Vector& force, const Vector& moment = kNone) {
    add(on, "block", by, symbol, point, ForceKind::applied, r, force, moment);
  };
  applied("housing", "Tcf", "about z2", o2(), kNone,
          turned({0, 0, -pump.friction.block_viscous * instant.block.speed}));
  if (pump.port_plate) {
    const auto land = [&](const char* point, const closed_form::LandForce<double>& unit,
                          double pressure) {
      // A port of no width has no centre of pressure.
      const bool wide = unit.force_z != 0;
      const Vector centre = {wide ? -unit.moment_y / unit.force_z : 0,
                             wide ? unit.moment_x / unit.force_z : 0, 0};
      applied("oil", "Fth", point, placed(centre), turned({0, 0, unit.force_z * pressure}));
    };
    land("delivery lands", prepared.numbers.film.delivery, instant.ports.delivery);
    land("suction lands", prepared.numbers.film.suction, instant.ports.suction);
  }
  applied("shaft", "Fm", "O2", o2(), turned({0, 0, pump.block.spring_force}));
  const Vector centre = placed({0, 0, pump.block.centre_of_mass_z});
  applied("gravity", "Pc", "centre of mass", centre, weight(pump.block.mass));
  add(on, "block", "block", "inertia", "centre of mass", ForceKind::inertia, centre, kNone,
      turned({0, 0, -pump.block.axial_inertia * instant.block.acceleration}));
}

void BodyLoads::Implementation::add_shaft(const Instant& instant, const std::vector<double>& row,
                                          std::vector<BodyLoad>& on) const {
  const ChannelLayout& at = model.layout();
  const double drive = row[at.Td()];
  const auto put = [&](const char* by, const char* symbol, const char* point, ForceKind kind,
                       const Vector& r, const Vector& force, const Vector& moment = kNone) {
    add(on, "shaft", by, symbol, point, kind, r, force, moment);
  };
  put("tapered bearing", "Rb1", "C1", ForceKind::reaction, {0, 0, pump.bearings.tapered_z},
      {row[at.Rb1(0)], row[at.Rb1(1)], row[at.Rb1(2)]});
  put("cylindrical bearing", "Rb2", "C2", ForceKind::reaction, {0, 0, pump.bearings.cylindrical_z},
      {row[at.Rb2(0)], row[at.Rb2(1)], 0});
  put("prime mover", "Td", "about z1", ForceKind::reaction, kNone, kNone, {0, 0, drive});
  // (38)
  put("housing", "Tsf", "about z1", ForceKind::applied, kNone, kNone,
      {0, 0,
       -(1 - pump.friction.shaft_torque_factor) * drive -
           pump.friction.shaft_viscous * instant.shaft.speed});
  put("block", "Fm", "O2", ForceKind::applied, o2(), turned({0, 0, -pump.block.spring_force}));
  const Vector centre = {0, 0, pump.shaft.centre_of_mass_z};
  put("gravity", "Ps", "centre of mass", ForceKind::applied, centre, weight(pump.shaft.mass));
  put("shaft", "inertia", "centre of mass", ForceKind::inertia, centre, kNone,
      {0, 0, -pump.shaft.axial_inertia * instant.shaft.acceleration});
}

std::vector<BodyLoad> BodyLoads::Implementation::all(const Instant& given,
                                                     const std::vector<double>& row,
                                                     const TeethAction& acting) const {
  Instant instant = given;
  if (pump.transfer.is_joint()) instant.block = model.block_motion(given.shaft);
  std::vector<BodyLoad> loads;
  std::vector<BodyLoad> block;
  std::vector<BodyLoad> shaft;
  with_state<double>(prepared.transfer, prepared.numbers, instant, [&](const auto& state) {
    add_pistons(instant, state, row, loads, block, shaft);
  });
  // The transfer's stand behind those of the pistons on either body.
  add_transfer(instant, row, acting, block, shaft);
  add_block(instant, row, block);
  add_shaft(instant, row, shaft);
  loads.insert(loads.end(), block.begin(), block.end());
  loads.insert(loads.end(), shaft.begin(), shaft.end());
  return loads;
}

BodyLoads::BodyLoads(const PumpParameters& pump, const Assumptions& assumptions)
    : implementation_(std::make_unique<Implementation>(pump, assumptions)) {}
BodyLoads::~BodyLoads() = default;
BodyLoads::BodyLoads(BodyLoads&&) noexcept = default;
BodyLoads& BodyLoads::operator=(BodyLoads&&) noexcept = default;

std::vector<BodyLoad> BodyLoads::evaluate(const Instant& instant) {
  Implementation& i = *implementation_;
  i.model.evaluate(instant, i.values, nullptr, &i.teeth);
  return i.all(instant, i.values, i.teeth);
}

std::vector<BodyLoad> BodyLoads::of_row(const Instant& instant, const std::vector<double>& values,
                                        const TeethAction& teeth) const {
  return implementation_->all(instant, values, teeth);
}

namespace {

// @param loads_at  all loads at an instant
template <class Rows, class LoadsAt>
BodyLoadTable run_rows(const Case& the_case, const Assumptions& assumptions, const Rows& rows,
                       std::size_t count, const LoadsAt& loads_at, const Progress& progress) {
  BodyLoads loads(validate(the_case).pump, assumptions);
  BodyLoadTable table = BodyLoadTable::of(count);
  Instant instant;
  for (std::size_t row = 0; row < count; ++row) {
    rows.instant(row, instant);
    table.append(loads_at(loads, instant));
    if (progress) progress(static_cast<double>(row + 1) / static_cast<double>(count));
  }
  return table;
}

}  // namespace

BodyLoadTable run_body_loads(const Case& the_case, const Assumptions& assumptions,
                             const Samples& samples, const Progress& progress) {
  const Model model(the_case.pump, assumptions);
  PlacedSamples placed(model, the_case);
  std::vector<double> values(model.layout().size());
  TeethAction teeth;
  return run_rows(
      the_case, assumptions, samples, samples.theta_deg.size(),
      [&](const BodyLoads& loads, const Instant& instant) {
        const Instant& at = placed.at(instant);
        evaluate_at_constant_speed(model, at, values, &teeth);
        return loads.of_row(at, values, teeth);
      },
      progress);
}

BodyLoadTable run_body_loads(const Case& the_case, const Assumptions& assumptions,
                             const States& states, const Progress& progress) {
  return run_rows(
      the_case, assumptions, states, states.rows(),
      [](BodyLoads& loads, const Instant& instant) { return loads.evaluate(instant); }, progress);
}

}  // namespace bentaxis::analytic
