#include "reactions/body_loads.h"

#include <string>

#include "loads/friction.h"
#include "loads/loads.h"

namespace bentaxis::multibody {

using SimTK::dot;
using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

namespace {

using Loads = std::vector<BodyLoad>;

constexpr double kUnitPressure = 1e5;  // Pa

std::array<double, 3> array(const Vec3& v) { return {v[0], v[1], v[2]}; }

// Loads of one kind on one body.
class Putter {
 public:
  Putter(Loads& loads, std::string on, ForceKind kind)
      : loads_(loads), on_(std::move(on)), kind_(kind) {}
  void force(const std::string& by, const char* symbol, const std::string& point, const Vec3& at,
             const Vec3& force, const Vec3& moment = Vec3(0)) const {
    loads_.push_back({on_, by, symbol, point, kind_, array(at), array(force), array(moment)});
  }
  void moment(const char* by, const char* symbol, const char* point, const Vec3& at,
              const Vec3& moment) const {
    force(by, symbol, point, at, Vec3(0), moment);
  }

 private:
  Loads& loads_;
  std::string on_;
  ForceKind kind_;
};

}  // namespace

// What is read, and where it goes.
struct BodyLoadReader::Looked {
  const State& state;
  const Reactions& reactions;
  SimTK::Vector_<SpatialVec> accelerations, weights;  // of and on the bodies
  Loads pistons, block, shaft;

  Vec3 mass_centre(const MobilizedBody& body) const {
    return body.findStationLocationInGround(state, body.getBodyMassCenterStation(state));
  }
  void put_weight(Loads& loads, const std::string& on, const char* symbol,
                  const MobilizedBody& body) const {
    Putter(loads, on, ForceKind::applied)
        .force("gravity", symbol, "centre of mass", mass_centre(body),
               weights[body.getMobilizedBodyIndex()][1]);
  }
  // Minus mass times acceleration of the centre of mass, and minus the rate of the angular momentum
  // about it.
  void put_inertia(Loads& loads, const std::string& on, const MobilizedBody& body) const {
    const SimTK::MassProperties& mass = body.getBodyMassProperties(state);
    const Rotation& turned = body.getBodyRotation(state);
    const SpatialVec& rate = accelerations[body.getMobilizedBodyIndex()];
    const Vec3& w = body.getBodyAngularVelocity(state);
    const Vec3 lever = turned * mass.getMassCenter();
    const SimTK::Inertia central = mass.calcCentralInertia();
    const auto times = [&](const Vec3& v) { return Vec3(turned * (central * (~turned * v))); };
    Putter(loads, on, ForceKind::inertia)
        .force(on, "inertia", "centre of mass", mass_centre(body),
               -mass.getMass() * (rate[1] + rate[0] % lever + w % (w % lever)),
               -(times(rate[0]) + w % times(w)));
  }
};

void BodyLoadReader::read_pistons(Looked& at, const std::vector<double>& pressure) const {
  const PumpBodies& bodies = pump_.bodies();
  const PumpParameters& p = pump_.pump();
  const LoadInputs& inputs = pump_.inputs();
  const Vec3 z2(bodies.block_frame.z());
  const Putter block_reaction(at.block, "block", ForceKind::reaction);
  const Putter block_applied(at.block, "block", ForceKind::applied);
  const Putter shaft(at.shaft, "shaft", ForceKind::reaction);
  for (std::size_t k = 0; k < bodies.pistons.size(); ++k) {
    const MobilizedBody& body = bodies.pistons[k];
    const Reactions::OnPiston& on = at.reactions.pistons[k];
    const std::string number = std::to_string(k + 1);
    const std::string name = "piston " + number;
    const std::string joint = "A" + number;
    const std::string ring = "B" + number;
    const std::string bore = pump_.contact_at_b() ? ring : "contact point " + number;
    const Vec3 a = on.place.p();
    const Vec3 along(on.place.z());
    const Vec3 b = a + p.geometry.piston_length * along;
    const Vec3 c = a + pump_.contact_length() * along;
    const double velocity =
        dot(z2, body.findStationVelocityInGround(at.state, Vec3(0, 0, p.geometry.piston_length)));
    const AxialLoad axial =
        axial_load(p, pump_.assumptions(), pressure[k], velocity, inputs.rest_speed,
                   inputs.held_direction.empty() ? 0 : inputs.held_direction[k]);

    const Putter reaction(at.pistons, name, ForceKind::reaction);
    const Putter applied(at.pistons, name, ForceKind::applied);
    reaction.force("shaft", "Rs", joint, a, on.joint);
    reaction.force("block", "Rc", bore, c, on.bore);
    applied.force("oil", "Fp", ring, b, axial.pressure * z2);
    applied.force("block", "Fpf", ring, b, axial.friction * z2);
    at.put_weight(at.pistons, name, "Pp", body);
    at.put_inertia(at.pistons, name, body);

    block_reaction.force(name, "Rc", bore, c, -on.bore);
    block_applied.force(name, "Fpf", ring, b, -axial.friction * z2);
    block_applied.force("oil", "Ftp", ring, b, p.block.bottom_area * pressure[k] * z2);
    if (pump_.walls() != nullptr) {
      const std::string touch = "D" + number;
      const Vec3 d = a + pump_.walls()->law().from_joint * along;
      reaction.force("block", "Rw", touch, d, on.wall);
      block_reaction.force(name, "Rw", touch, d, -on.wall);
    }
    shaft.force(name, "Rs", joint, a, -on.joint);
  }
}

void BodyLoadReader::read_transfer(Looked& at, const TeethAction* teeth) const {
  const PumpBodies& bodies = pump_.bodies();
  const Putter block(at.block, "block", ForceKind::reaction);
  const Putter shaft(at.shaft, "shaft", ForceKind::reaction);
  const auto push = [&](const char* name, const Vec3& point, const Vec3& force) {
    block.force("shaft", "Rcs", name, point, force);
    shaft.force("block", "Rcs", name, point, -force);
  };
  if (pump_.joint() != nullptr) {
    block.moment("shaft", "Tcs", "about O2", bodies.block_origin, at.reactions.couple);
    shaft.moment("block", "Tcs", "about O2", bodies.block_origin, -at.reactions.couple);
    if (pump_.pump().transfer.kind == TransferKind::double_cardan) {
      block.force("shaft", "Fcs", "O2", bodies.block_origin, at.reactions.side_force);
      shaft.force("block", "Fcs", "O2", bodies.block_origin, -at.reactions.side_force);
    }
  } else if (pump_.walls() != nullptr) {
    // The walls are the pistons'. Given states need a torque from outside.
    if (pump_.block_is_imposed() && at.reactions.block_is_given)
      block.moment("outside", "Tb", "about z2", bodies.block_origin,
                   at.reactions.imposed * Vec3(bodies.block_frame.z()));
  } else if (teeth != nullptr) {
    for (std::size_t i = 0; i < teeth->pairs.size(); ++i) {
      const PairContact& pair = teeth->pairs[i];
      if (pair.force > 0)
        push(kPairNames[i], bodies.block_origin + vector_of(pair.point),
             pair.force * vector_of(pair.normal));
      else
        push(kPairNames[i], pump_.gear().point(), Vec3(0));
    }
  } else if (pump_.has_gear()) {
    push("O4", pump_.gear().point(), at.reactions.tooth * at.reactions.tooth_line);
  } else {
    block.moment("imposed motion", "Tcs", "about z2", bodies.block_origin,
                 at.reactions.imposed * Vec3(bodies.block_frame.z()));
  }
}

// All but what pistons and transfer do.
void BodyLoadReader::read_block(Looked& at) {
  const PumpBodies& bodies = pump_.bodies();
  const PumpParameters& p = pump_.pump();
  const Rotation& s2 = bodies.block_frame;
  const Vec3 z2(s2.z());
  const Vec3& o2 = bodies.block_origin;
  // The joint to ground stands for film and pin: the pin takes what is across z2, and what its
  // lever leaves of the moment is the film's.
  const Vec3 pin = o2 + p.block.pin_z * z2;
  const Vec3 along = dot(at.reactions.block_hold[1], z2) * z2;
  const Vec3 across = at.reactions.block_hold[1] - along;
  Vec3 moment = ~s2 * (at.reactions.block_hold[0] - (pin - o2) % across);
  moment[2] = 0;
  const Putter reaction(at.block, "block", ForceKind::reaction);
  reaction.force("port-plate film", "Fh", "O2", o2, along);
  reaction.moment("port-plate film", "Th", "about O2", o2, s2 * moment);
  reaction.force("pin", "Rcn", "(0, 0, z_pin)", pin, across);

  const Putter applied(at.block, "block", ForceKind::applied);
  const double speed = dot(z2, bodies.block.getBodyAngularVelocity(at.state));
  applied.moment("housing", "Tcf", "about z2", o2, block_friction(p.friction, speed) * z2);
  if (p.port_plate) {
    if (!lands_)
      lands_ = {film_load(*p.port_plate, {0, kUnitPressure}),
                film_load(*p.port_plate, {kUnitPressure, 0})};
    const auto land = [&](const char* name, const FilmLoad& unit, double pressure) {
      Vec3 centre = o2;
      if (unit.force_z != 0)
        centre += s2 * Vec3(-unit.moment_y / unit.force_z, unit.moment_x / unit.force_z, 0);
      applied.force("oil", "Fth", name, centre, unit.force_z * (pressure / kUnitPressure) * z2);
    };
    land("delivery lands", lands_->delivery, pump_.inputs().ports.delivery);
    land("suction lands", lands_->suction, pump_.inputs().ports.suction);
  }
  applied.force("shaft", "Fm", "O2", o2, p.block.spring_force * z2);
  at.put_weight(at.block, "block", "Pc", bodies.block);
  at.put_inertia(at.block, "block", bodies.block);
}

void BodyLoadReader::read_shaft(Looked& at) const {
  const PumpBodies& bodies = pump_.bodies();
  const PumpParameters& p = pump_.pump();
  const Vec3 z1(0, 0, 1);
  const Vec3 o1(0);
  // The drive gives the torque that is left after the proportional loss (38).
  const double drive = at.reactions.drive / p.friction.shaft_torque_factor;
  const Putter reaction(at.shaft, "shaft", ForceKind::reaction);
  reaction.force("tapered bearing", "Rb1", "C1", bodies.shaft_origin, at.reactions.tapered);
  reaction.force("cylindrical bearing", "Rb2", "C2", p.bearings.cylindrical_z * z1,
                 at.reactions.cylindrical);
  reaction.moment("prime mover", "Td", "about z1", o1, drive * z1);

  const Putter applied(at.shaft, "shaft", ForceKind::applied);
  const double speed = dot(z1, bodies.shaft.getBodyAngularVelocity(at.state));
  applied.moment(
      "housing", "Tsf", "about z1", o1,
      (shaft_friction(p.friction, speed) - (1 - p.friction.shaft_torque_factor) * drive) * z1);
  applied.force("block", "Fm", "O2", bodies.block_origin,
                -p.block.spring_force * Vec3(bodies.block_frame.z()));
  at.put_weight(at.shaft, "shaft", "Ps", bodies.shaft);
  at.put_inertia(at.shaft, "shaft", bodies.shaft);
}

std::vector<BodyLoad> BodyLoadReader::read(const State& state, const SimTK::Vector& accelerations,
                                           const Reactions& reactions,
                                           const std::vector<double>& pressure,
                                           const TeethAction* teeth) {
  Looked at{state, reactions, {}, {}, {}, {}, {}};
  pump_.matter().calcBodyAccelerationFromUDot(state, accelerations, at.accelerations);
  SimTK::Vector_<Vec3> particles;
  SimTK::Vector mobilities;
  pump_.weight().calcForceContribution(state, at.weights, particles, mobilities);
  read_pistons(at, pressure);
  read_transfer(at, teeth);
  read_block(at);
  read_shaft(at);
  Loads loads = std::move(at.pistons);
  loads.insert(loads.end(), at.block.begin(), at.block.end());
  loads.insert(loads.end(), at.shaft.begin(), at.shaft.end());
  return loads;
}

}  // namespace bentaxis::multibody
