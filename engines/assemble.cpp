#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

#include "bentaxis/engines/mechanism.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/units.h"
#include "tree_motion.h"

namespace bentaxis::engines {

Wrench force_at(const Vector& point, const Vector& force) {
  Wrench wrench;
  wrench << force, point.cross(force);
  return wrench;
}

Wrench couple(const Vector& moment) {
  Wrench wrench;
  wrench << Vector::Zero(), moment;
  return wrench;
}

std::string why_not_given(const Channel& channel) {
  if (channel.kind == ChannelKind::check) return "is a check within a model";
  if (channel.kind == ChannelKind::input) return "is an input";
  if (channel.quantity == "xh" || channel.quantity == "yh") return "follows from Fh and Th";
  if (channel.quantity == "zB") return "is part of the given motion";
  if (channel.quantity == "Rs") return "is Rs in another frame";
  if (channel.quantity == "Tc") return "follows from Rc";
  return "does not act here";
}

namespace {

constexpr int kShaft = 0, kBlock = 1, kFirstPiston = 2;
constexpr int kSlide = 0, kFirstTilt = 1, kSecondTilt = 2, kSpin = 3;  // freedoms of a piston

void refuse(const Case& the_case, const std::string& what) {
  throw InputError(the_case.file.string() +
                   ": --engine: the description of the pump for engines has no " + what);
}

void check(const Case& the_case) {
  const PumpParameters& pump = the_case.pump;
  if (pump.transfer.kind == TransferKind::pistons)
    refuse(the_case, "transfer of kind pistons: its walls are contacts");
  if (pump.transfer.kind == TransferKind::gear && pump.gear.is_compliant())
    refuse(the_case, "compliant contact of teeth");
}

// The pressure on the lands of a port plate: a wrench on the block in S2 about O2.
Wrench land_load(const PortPlate& plate, const PortPressures& ports) {
  using Rule = boost::math::quadrature::gauss<double, 10>;
  constexpr int kPanels = 12;  // of an arc
  Wrench load = Wrench::Zero();
  const auto add = [&](const PortArc& arc, double pressure, double inner, double outer,
                       double at_inner, double at_outer) {
    const double width = radians(arc.to_deg - arc.from_deg) / kPanels;
    for (int panel = 0; panel < kPanels; ++panel) {
      const double from = radians(arc.from_deg) + panel * width;
      // weight: of each point of area, along x, along y
      const auto integral = [&](const auto& weight) {
        return Rule::integrate(
            [&](double r) {
              const double here =
                  pressure * (at_inner + (at_outer - at_inner) * (r - inner) / (outer - inner));
              return here * r *
                     Rule::integrate([&](double psi) { return weight(r, psi); }, from,
                                     from + width);
            },
            inner, outer);
      };
      load[2] -= integral([](double, double) { return 1.0; });
      load[3] -= integral([](double r, double psi) { return r * std::cos(psi); });
      load[4] -= integral([](double r, double psi) { return r * std::sin(psi); });
    }
  };
  for (const auto& [arc, pressure] :
       {std::pair(plate.delivery, ports.delivery), std::pair(plate.suction, ports.suction)}) {
    add(arc, pressure, plate.r1, plate.r2, 0, 1);
    add(arc, pressure, plate.r2, plate.r3, 1, 1);
    add(arc, pressure, plate.r3, plate.r4, 1, 0);
  }
  return load;
}

class Assembler {
 public:
  Assembler(const Case& the_case, const Assumptions& assumptions, const Samples& samples)
      : case_(the_case),
        pump_(the_case.pump),
        assumptions_(assumptions),
        samples_(samples),
        n_(pump_.geometry.pistons),
        trace_(the_case.pressure) {
    axes2_ = Eigen::AngleAxisd(-pump_.geometry.tilt, Vector::UnitX()).toRotationMatrix();
    origin2_ = Vector(0, 0, pump_.geometry.axis_offset);
  }

  Mechanism make() {
    mechanism_.gravity = Vector(0, -pump_.gravity, 0);
    mechanism_.length = pump_.geometry.joint_circle_radius;
    add_bodies();
    name_forces();
    if (pump_.port_plate) {
      const Wrench in_s2 = land_load(*pump_.port_plate, samples_.ports);
      lands_ = force_at(origin2_, axes2_ * in_s2.head<3>()) + couple(axes2_ * in_s2.tail<3>());
    }
    mechanism_.states.reserve(samples_.theta_deg.size());
    for (std::size_t row = 0; row < samples_.theta_deg.size(); ++row) add_state(row);
    return std::move(mechanism_);
  }

 private:
  bool spins() const { return assumptions_.inertia == PistonInertia::real; }
  std::size_t piston_freedoms() const { return spins() ? 4 : 3; }
  Vector joint_on_shaft(int k) const { return in_circle(pump_.geometry.joint_circle_radius, k); }
  Vector in_circle(double radius, int k) const {
    const double angle = -2 * kPi * k / n_;
    return {-radius * std::sin(angle), radius * std::cos(angle), 0};
  }

  void add_bodies();
  void name_forces();
  int add_action(const std::string& name, int on, int by);
  int add_support(const std::string& name, int body);
  void read(const std::string& channel, int place, double factor = 1) {
    mechanism_.readings.push_back({channel, {{place, factor}}});
  }
  void add_state(std::size_t row);
  void close_loop(int k, const FrameMotion& shaft, const FrameMotion& block);
  void turn_block();
  void join_by_two_crosses();
  // Parts of a tooth force of size 1: what turns the block, what pushes the gears apart.
  Vector turning_part() const {
    return -direction() * std::cos(pump_.gear.pressure_angle) * Vector::UnitX();
  }
  Vector separating_part() const { return std::sin(pump_.gear.pressure_angle) * between_axes(); }
  double direction() const { return samples_.omega < 0 ? -1 : 1; }
  Vector line_of_action() const;
  Vector mesh_point() const;
  Vector between_axes() const { return (Vector::UnitZ() + axes2_.col(2)).normalized(); }
  bool meshes() const {
    return pump_.transfer.kind == TransferKind::gear && assumptions_.gear == BlockDrive::mesh;
  }
  bool has_joint() const { return pump_.transfer.is_joint(); }
  bool has_two_flanks() const { return pump_.gear.flanks == Flanks::two; }

  const Case& case_;
  const PumpParameters& pump_;
  const Assumptions& assumptions_;
  const Samples& samples_;
  int n_;
  PressureTrace trace_;
  Eigen::Matrix3d axes2_;  // of S2, columns
  Vector origin2_;
  Wrench lands_ = Wrench::Zero();
  Wrench joint_ = Wrench::Zero();  // direction of what a joint exerts on the block
  Mechanism mechanism_;
  std::vector<Coordinate> coordinates_;  // of all bodies
};

void Assembler::add_bodies() {
  const Geometry& g = pump_.geometry;
  const Freedom turning{true, Vector::UnitZ(), true};
  Body shaft{"shaft"};
  shaft.freedoms = {turning};
  shaft.mass = pump_.shaft.mass;
  shaft.centre = Vector(0, 0, pump_.shaft.centre_of_mass_z);
  shaft.inertia = Vector::Constant(pump_.shaft.axial_inertia);
  Body block{"block"};
  block.place = origin2_;
  block.axes = axes2_;
  block.freedoms = {turning};
  block.mass = pump_.block.mass;
  block.centre = Vector(0, 0, pump_.block.centre_of_mass_z);
  block.inertia = Vector::Constant(pump_.block.axial_inertia);
  mechanism_.bodies = {shaft, block};
  coordinates_.resize(2);
  const PistonMass& mass = pump_.piston;
  for (int k = 0; k < n_; ++k) {
    // Origin at B, z towards the port plate: A lies one length below.
    Body piston{"piston " + std::to_string(k + 1), kBlock, in_circle(g.bore_circle_radius, k)};
    piston.freedoms = {{false, Vector::UnitZ()}, {true, Vector::UnitX()}, {true, Vector::UnitY()}};
    if (spins()) piston.freedoms.push_back({true, Vector::UnitZ()});
    piston.mass = mass.mass;
    if (assumptions_.inertia == PistonInertia::lumped) {
      const double at_a = mass.joint_mass_fraction, at_b = 1 - at_a;
      piston.centre.z() = -at_a * g.piston_length;
      const double transverse = mass.mass * (at_a * std::pow(at_b * g.piston_length, 2) +
                                             at_b * std::pow(at_a * g.piston_length, 2));
      piston.inertia = Vector(transverse, transverse, 0);
    } else {
      piston.centre.z() = mass.real->centre_of_mass - g.piston_length;
      piston.inertia = Vector(mass.real->transverse_inertia, mass.real->transverse_inertia,
                              spins() ? mass.real->axial_inertia : 0);
    }
    mechanism_.bodies.push_back(std::move(piston));
    for (std::size_t i = 0; i < piston_freedoms(); ++i) coordinates_.emplace_back();
  }
}

int Assembler::add_action(const std::string& name, int on, int by) {
  mechanism_.actions.push_back({name, on, by});
  return static_cast<int>(mechanism_.actions.size()) - 1;
}

// After all actions.
int Assembler::add_support(const std::string& name, int body) {
  mechanism_.supports.push_back({name, body});
  return static_cast<int>(mechanism_.actions.size() + mechanism_.supports.size()) - 1;
}

// Names and places; add_state() writes their wrenches in the same order.
void Assembler::name_forces() {
  const ChannelLayout layout(pump_);
  const auto channel = [&](std::size_t column) { return layout.channels()[column].name; };
  for (int k = 0; k < n_; ++k)
    for (int i = 0; i < 3; ++i) {
      const std::string name = channel(layout.Rs(k, i));
      read(name, add_action(name, kFirstPiston + k, kShaft));
    }
  for (int k = 0; k < n_; ++k)
    mechanism_.loops.push_back({kFirstPiston + k, kShaft,
                                Vector(0, 0, -pump_.geometry.piston_length), joint_on_shaft(k),
                                3 * k});
  const std::string drive = channel(layout.Td());
  read(drive, add_action(drive, kShaft, -1));
  if (meshes()) {
    const std::string name = channel(layout.Rcs());
    const int place = add_action(name, kBlock, kShaft);
    mechanism_.actions[place].two_sided = has_two_flanks();
    read(name, place);
    const Wrench at_mesh = force_at(mesh_point() - origin2_, line_of_action());
    read(channel(layout.Tcs()), place, at_mesh.tail<3>().dot(axes2_.col(2)));
  } else if (has_joint()) {
    const bool has_force = layout.has(Quantity::Fcs);
    const int place = add_action("couple of the joint", kBlock, kShaft);
    for (int i = 0; i < 3; ++i) {
      const Vector axis = axes2_.col(i);
      read(channel(layout.TcsJoint(i)), place);
      mechanism_.readings.back().component = couple(axis);
      if (!has_force) continue;
      // About O2 instead of O1.
      mechanism_.readings.back().component->head<3>() = -axis.cross(origin2_);
      read(channel(layout.Fcs(i)), place);
      mechanism_.readings.back().component = force_at(Vector::Zero(), axis);
    }
  } else {
    const std::string name = channel(layout.Tcs());
    read(name, add_action(name, kBlock, -1));
  }
  const auto supported = [&](std::size_t column, int body) {
    read(channel(column), add_support(channel(column), body));
  };
  for (int k = 0; k < n_; ++k)
    for (int i = 0; i < 2; ++i) supported(layout.Rc(k, i), kFirstPiston + k);
  supported(layout.Fh(), kBlock);
  for (int i = 0; i < 2; ++i) supported(layout.Th(i), kBlock);
  for (int i = 0; i < 2; ++i) supported(layout.Rcn(i), kBlock);
  for (int i = 0; i < 3; ++i) supported(layout.Rb1(i), kShaft);
  for (int i = 0; i < 2; ++i) supported(layout.Rb2(i), kShaft);
}

// Where the pitch cones of both gears touch, in the plane of the axes: half the pitch diameter away
// from the shaft's axis.
Vector Assembler::mesh_point() const {
  const Vector along = between_axes().cross(Vector::UnitX());
  return origin2_ + pump_.gear.pitch_diameter / 2 / along.y() * along;
}

// The shaft's tooth moves along -x there; the pressure angle turns its push towards the normal of
// the plane in which the cones roll. With one flank, as printed, the whole of it changes its sign
// with the speed; with two the separating part always pushes.
Vector Assembler::line_of_action() const {
  return turning_part() + (has_two_flanks() ? 1 : direction()) * separating_part();
}

// The block as the shaft turns it. A universal joint: the arm of the shaft's fork, which lies along
// x1 at the joint's phase, stays across that of the block's, which lies along y2 then.
void Assembler::turn_block() {
  coordinates_[kBlock] = coordinates_[kShaft];
  joint_ = couple(between_axes());
  if (pump_.transfer.kind == TransferKind::double_cardan) return join_by_two_crosses();
  if (!pump_.transfer.is_uneven_joint()) return;
  const double phase = pump_.transfer.phase();
  const Vector on_shaft(std::cos(phase), -std::sin(phase), 0);
  const Vector on_block(std::sin(phase), std::cos(phase), 0);
  const FrameMotion shaft = moved({}, mechanism_.bodies[kShaft], &coordinates_[kShaft]);
  const auto arm_of = [](const FrameMotion& frame, const Vector& local) {
    FrameMotion arm;  // a point at distance 1 of a centre at rest
    const Vector at = frame.axes * local;
    arm.origin = at;
    arm.velocity = frame.turning.cross(at);
    arm.acceleration = frame.turning_rate.cross(at) + frame.turning.cross(frame.turning.cross(at));
    return arm;
  };
  const FrameMotion one = arm_of(shaft, on_shaft);
  Coordinate& psi = coordinates_[kBlock];
  const auto other = [&] { return arm_of(moved({}, mechanism_.bodies[kBlock], &psi), on_block); };
  const Vector z2 = axes2_.col(2);
  constexpr int kTries = 50;
  double slope = 1;
  for (int tried = 0; tried < kTries; ++tried) {
    const Vector at = other().origin;
    slope = one.origin.dot(z2.cross(at));
    const double step = one.origin.dot(at) / slope;
    psi.position -= step;
    if (std::abs(step) < 1e-15) break;
  }
  psi.velocity = psi.acceleration = 0;
  slope = one.origin.dot(z2.cross(other().origin));
  psi.velocity = -one.velocity.dot(other().origin) / slope;
  const FrameMotion second = other();
  psi.acceleration = -(one.acceleration.dot(second.origin) + one.origin.dot(second.acceleration) +
                       2 * one.velocity.dot(second.velocity)) /
                     slope;
  // The cross carries a couple across both arms.
  Vector direction = one.origin.cross(second.origin).normalized();
  if (direction.dot(z2) < 0) direction *= -1;
  joint_ = couple(direction);
}

// Two universal joints, by the balance of the shaft between them, which has no mass: either cross
// gives it a couple across both arms of that cross, and they keep the size of their parts along its
// axis; what is left across the axis a pair of forces at the crosses' centres takes, across the
// axis too, along which the shaft slides.
void Assembler::join_by_two_crosses() {
  const Vector along = between_axes();
  const double distance = pump_.transfer.double_cardan->cross_distance;
  const double phase = pump_.transfer.phase();
  const Vector arm(std::cos(phase), -std::sin(phase), 0);  // in either body
  const auto across_both = [&](int body) -> Vector {
    const FrameMotion frame = moved({}, mechanism_.bodies[body], &coordinates_[body]);
    const Vector here = frame.axes * arm;
    const Vector couple = here.cross(along.cross(here));
    return couple / couple.dot(along);
  };
  const Vector lever = distance * axes2_.col(2);  // of the block's cross, from O2
  const double length = (lever + distance * Vector::UnitZ()).norm();
  const Vector from_shaft = across_both(kShaft), to_block = across_both(kBlock);
  const Vector force = (from_shaft - to_block).cross(along) / length;
  joint_ = force_at(origin2_ + lever, force) + couple(to_block);
}

// Slide and tilts of a piston that put its A onto the shaft's, with their rates.
void Assembler::close_loop(int k, const FrameMotion& shaft, const FrameMotion& block) {
  const Body& body = mechanism_.bodies[kFirstPiston + k];
  Coordinate* at = &coordinates_[2 + k * piston_freedoms()];
  const Vector joint(0, 0, -pump_.geometry.piston_length);
  const Vector wanted = shaft.point(joint_on_shaft(k));
  // From a piston along its bore Newton's steps never overshoot, so that they lead to the solution
  // with B above A and not to the one beyond a right angle.
  for (std::size_t i = 0; i < body.freedoms.size(); ++i) at[i] = {};
  at[kSlide].position = pump_.geometry.piston_length + (wanted - origin2_).dot(axes2_.col(2));
  Eigen::Matrix3d jacobian;
  const auto frame_with_jacobian = [&] {
    std::vector<Vector> axes;
    FrameMotion frame = moved(block, body, at, &axes);
    const Vector arm = frame.axes * joint;
    jacobian << axes[kSlide], axes[kFirstTilt].cross(arm), axes[kSecondTilt].cross(arm);
    return frame;
  };
  constexpr int kTries = 100;
  double before = 1e300;
  for (int tried = 0;; ++tried) {
    const FrameMotion frame = frame_with_jacobian();
    const Vector missing = wanted - frame.point(joint);
    // Converged where a step no longer makes it smaller.
    const double size = missing.norm();
    if (size <= 1e-12 * pump_.geometry.piston_length && size >= before / 2) break;
    if (tried == kTries || !(size < 1e300) || !(frame.axes.col(2).dot(axes2_.col(2)) > 0))
      throw ComputationError("engines: piston " + std::to_string(k + 1) +
                             " does not reach from its joint to its bore");
    const Vector step = jacobian.partialPivLu().solve(missing);
    for (int i = 0; i < 3; ++i) at[i].position += step[i];
    before = size;
    if (size == 0) break;
  }
  const auto solver = jacobian.partialPivLu();
  const auto set = [&](double Coordinate::*member, const Vector& values) {
    for (int i = 0; i < 3; ++i) at[i].*member = values[i];
  };
  const Vector joint2 = joint_on_shaft(k);
  set(&Coordinate::velocity,
      solver.solve(shaft.velocity_of(joint2) - frame_with_jacobian().velocity_of(joint)));
  if (spins()) {  // the angular velocity along the piston's own axis is given
    const FrameMotion frame = moved(block, body, at);
    at[kSpin].velocity = pump_.piston.real->spin - frame.turning.dot(frame.axes.col(2));
  }
  set(&Coordinate::acceleration,
      solver.solve(shaft.acceleration_of(joint2) - moved(block, body, at).acceleration_of(joint)));
  if (spins()) {
    const FrameMotion frame = moved(block, body, at);
    at[kSpin].acceleration = -frame.turning_rate.dot(frame.axes.col(2));
  }
}

void Assembler::add_state(std::size_t row) {
  const double omega = samples_.omega;
  coordinates_[kShaft] = {radians(std::fmod(samples_.theta_deg[row], 360.0)), omega, 0};
  turn_block();
  const double block_omega = coordinates_[kBlock].velocity;
  const FrameMotion shaft = moved({}, mechanism_.bodies[kShaft], coordinates_.data());
  const FrameMotion block = moved({}, mechanism_.bodies[kBlock], &coordinates_[kBlock]);
  State state;
  state.loads.assign(mechanism_.bodies.size(), Wrench::Zero());
  const Vector z1 = Vector::UnitZ(), z2 = axes2_.col(2);
  const auto unit2 = [&](int i) -> Vector { return axes2_.col(i); };
  const double diameter = pump_.geometry.bore_diameter;
  const double area = kPi / 4 * diameter * diameter;
  const Friction& friction = pump_.friction;
  std::vector<Wrench> bores;
  for (int k = 0; k < n_; ++k) {
    close_loop(k, shaft, block);
    const FrameMotion piston =
        moved(block, mechanism_.bodies[kFirstPiston + k], &coordinates_[2 + k * piston_freedoms()]);
    // Chambers turn with the block.
    const double pressure =
        pump_.transfer.is_uneven_joint()
            ? trace_(piston_angle_deg(coordinates_[kBlock].position / kRadPerDegree, k + 1, n_))
            : samples_.chamber_pressure[row * n_ + k];
    const double speed = piston.velocity.dot(z2);
    double rubs = 0;
    if (assumptions_.piston_friction) {
      // A piston this slow is at rest where dry friction is a step.
      const double rest = 1e-12 * std::abs(omega) * pump_.geometry.joint_circle_radius;
      const double direction = friction.regularization > 0
                                   ? std::tanh(speed / friction.regularization)
                               : std::abs(speed) <= rest ? 0
                                                         : std::copysign(1.0, speed);
      rubs = -friction.piston_coulomb * direction - friction.piston_viscous * speed;
    }
    const Wrench along_bore = force_at(piston.origin, z2);
    state.loads[kFirstPiston + k] += (rubs - area * pressure) * along_bore;
    state.loads[kBlock] += (pump_.block.bottom_area * pressure - rubs) * along_bore;
    const Vector joint = shaft.point(joint_on_shaft(k));
    for (int i = 0; i < 3; ++i) state.actions.push_back(force_at(joint, unit2(i)));
    const Vector contact =
        pump_.piston.contact
            ? piston.point({0, 0, *pump_.piston.contact - pump_.geometry.piston_length})
            : piston.origin;
    for (int i = 0; i < 2; ++i) bores.push_back(force_at(contact, unit2(i)));
  }
  state.loads[kBlock] += lands_ + pump_.block.spring_force * force_at(origin2_, z2) -
                         friction.block_viscous * block_omega * couple(z2);
  state.loads[kShaft] -= pump_.block.spring_force * force_at(origin2_, z2) +
                         friction.shaft_viscous * omega * couple(z1);
  // Part of the drive torque is lost in proportion.
  state.actions.emplace_back(friction.shaft_torque_factor * couple(z1));
  state.actions.push_back(meshes()      ? force_at(mesh_point(), line_of_action())
                          : has_joint() ? joint_
                                        : couple(z2));
  if (meshes() && has_two_flanks())
    state.other_sides = {force_at(mesh_point(), turning_part() - separating_part())};
  state.supports = std::move(bores);
  state.supports.push_back(force_at(origin2_, z2));
  for (int i = 0; i < 2; ++i) state.supports.push_back(couple(unit2(i)));
  for (int i = 0; i < 2; ++i)
    state.supports.push_back(force_at(origin2_ + pump_.block.pin_z * z2, unit2(i)));
  for (int i = 0; i < 3; ++i)
    state.supports.push_back(force_at(Vector(0, 0, pump_.bearings.tapered_z), Vector::Unit(i)));
  for (int i = 0; i < 2; ++i)
    state.supports.push_back(force_at(Vector(0, 0, pump_.bearings.cylindrical_z), Vector::Unit(i)));
  for (const Coordinate& c : coordinates_) {
    state.position.push_back(c.position);
    state.velocity.push_back(c.velocity);
    state.acceleration.push_back(c.acceleration);
  }
  mechanism_.states.push_back(std::move(state));
}

}  // namespace

Mechanism assemble(const Case& the_case, const Assumptions& assumptions, const Samples& samples) {
  check(the_case);
  return Assembler(the_case, assumptions, samples).make();
}

}  // namespace bentaxis::engines
