#include "loads/loads.h"

#include "bentaxis/pump/units.h"
#include "loads/film.h"
#include "loads/friction.h"
#include "scene/gear_mesh.h"

namespace bentaxis::multibody {

using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

AxialLoad axial_load(const PumpParameters& pump, const Assumptions& assumptions, double pressure,
                     double velocity, double rest_speed, double direction) {
  AxialLoad load;
  const double radius = pump.geometry.bore_diameter / 2;
  load.pressure = -pressure * kPi * radius * radius;
  if (assumptions.piston_friction)
    load.friction = piston_friction(pump.friction, velocity, rest_speed, direction);
  return load;
}

double pressure_power(const PumpParameters& pump, const PumpBodies& bodies,
                      const std::vector<double>& pressure, const State& state) {
  const Vec3 z2(bodies.block_frame.z());
  double power = 0;
  for (std::size_t k = 0; k < bodies.pistons.size(); ++k) {
    const SimTK::Transform& place = bodies.pistons[k].getBodyTransform(state);
    const SpatialVec& rate = bodies.pistons[k].getBodyVelocity(state);
    const SpatialVec& block_rate = bodies.block.getBodyVelocity(state);
    const Vec3 ring = pump.geometry.piston_length * Vec3(place.z());  // B from A
    const Vec3 on_block = place.p() + ring - bodies.block.getBodyOriginLocation(state);
    const double force = axial_load(pump, {false}, pressure[k], 0, 0).pressure;
    power += force * SimTK::dot(z2, rate[1] + rate[0] % ring) +
             pump.block.bottom_area * pressure[k] *
                 SimTK::dot(z2, block_rate[1] + block_rate[0] % on_block);
  }
  return power;
}

namespace {

class PumpLoadsImplementation : public SimTK::Force::Custom::Implementation {
 public:
  PumpLoadsImplementation(const PumpParameters& pump, const Assumptions& assumptions,
                          const PumpBodies& bodies, const LoadInputs& inputs, LoadedBodies loaded)
      : pump_(pump),
        assumptions_(assumptions),
        bodies_(bodies),
        inputs_(inputs),
        loaded_(loaded),
        pressure_(bodies.pistons.size()) {}

  void calcForce(const State& state, SimTK::Vector_<SpatialVec>& forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector&) const override {
    const Vec3 z1(0, 0, 1);
    const Vec3 z2(bodies_.block_frame.z());
    const auto& shaft = bodies_.shaft;
    const auto& block = bodies_.block;
    SpatialVec& on_block = forces[block.getMobilizedBodyIndex()];
    SpatialVec& on_shaft = forces[shaft.getMobilizedBodyIndex()];
    const Vec3& block_origin = block.getBodyOriginLocation(state);
    const Vec3& shaft_origin = shaft.getBodyOriginLocation(state);

    const double theta = turn_angle(shaft.getBodyRotation(state), SimTK::Rotation());
    inputs_.chamber_pressure(theta, block.getOneQ(state, 0), pressure_);
    for (std::size_t k = 0; k < bodies_.pistons.size(); ++k) {
      const auto& piston = bodies_.pistons[k];
      const SimTK::Transform& place = piston.getBodyTransform(state);
      const SpatialVec& rate = piston.getBodyVelocity(state);
      const Vec3 ring = pump_.geometry.piston_length * Vec3(place.z());  // B from A
      const double velocity = SimTK::dot(z2, rate[1] + rate[0] % ring);
      AxialLoad load = axial_load(pump_, assumptions_, pressure_[k], velocity, inputs_.rest_speed,
                                  inputs_.held_direction.empty() ? 0 : inputs_.held_direction[k]);
      double bottom = pump_.block.bottom_area * pressure_[k];
      if (!acts(LoadSource::pressure)) load.pressure = bottom = 0;
      if (!acts(LoadSource::piston_friction)) load.friction = 0;
      add_at(ring, (load.pressure + load.friction) * z2, forces[piston.getMobilizedBodyIndex()]);
      if (loaded_ == LoadedBodies::all)
        add_at(place.p() + ring - block_origin, (bottom - load.friction) * z2, on_block);
    }
    if (loaded_ == LoadedBodies::pistons) return;

    if (acts(LoadSource::spring)) {
      const Vec3 spring = pump_.block.spring_force * z2;
      add_at(bodies_.block_origin - block_origin, spring, on_block);
      add_at(bodies_.block_origin - shaft_origin, -spring, on_shaft);
    }
    if (pump_.port_plate && acts(LoadSource::film)) {
      const FilmLoad film = film_load_now();
      add_at(bodies_.block_origin - block_origin, film.force_z * z2, on_block);
      on_block[0] += bodies_.block_frame * Vec3(film.moment_x, film.moment_y, 0);
    }
    const double block_speed = SimTK::dot(z2, block.getBodyAngularVelocity(state));
    const double shaft_speed = SimTK::dot(z1, shaft.getBodyAngularVelocity(state));
    if (acts(LoadSource::block_friction))
      on_block[0] += block_friction(pump_.friction, block_speed) * z2;
    if (!acts(LoadSource::shaft_friction)) return;
    double shaft_torque = shaft_friction(pump_.friction, shaft_speed);
    if (inputs_.shaft_torque) shaft_torque += inputs_.shaft_torque(theta);
    on_shaft[0] += shaft_torque * z1;
  }

  SimTK::Real calcPotentialEnergy(const State&) const override { return 0; }

 private:
  bool acts(LoadSource source) const { return !inputs_.only || *inputs_.only == source; }

  // A force whose point is given from the body's origin, in Ground.
  static void add_at(const Vec3& lever, const Vec3& force, SpatialVec& on_body) {
    on_body += SpatialVec(lever % force, force);
  }

  // The film load changes only with the port pressures.
  const FilmLoad& film_load_now() const {
    if (inputs_.ports.delivery != film_ports_.delivery ||
        inputs_.ports.suction != film_ports_.suction || !film_known_) {
      film_ =
          inputs_.ports_change ? superposed_film() : film_load(*pump_.port_plate, inputs_.ports);
      film_ports_ = inputs_.ports;
      film_known_ = true;
    }
    return film_;
  }

  FilmLoad superposed_film() const {
    constexpr double kUnit = 1e5;  // Pa
    if (!of_suction_) {
      of_suction_ = film_load(*pump_.port_plate, {kUnit, 0});
      of_delivery_ = film_load(*pump_.port_plate, {0, kUnit});
    }
    const auto sum = [&](double FilmLoad::*part) {
      return ((*of_suction_).*part * inputs_.ports.suction +
              (*of_delivery_).*part * inputs_.ports.delivery) /
             kUnit;
    };
    return {sum(&FilmLoad::force_z), sum(&FilmLoad::moment_x), sum(&FilmLoad::moment_y)};
  }

  const PumpParameters& pump_;
  Assumptions assumptions_;
  PumpBodies bodies_;
  const LoadInputs& inputs_;
  LoadedBodies loaded_;
  mutable std::vector<double> pressure_;
  mutable FilmLoad film_;
  mutable std::optional<FilmLoad> of_suction_, of_delivery_;
  mutable PortPressures film_ports_;
  mutable bool film_known_ = false;
};

}  // namespace

PumpLoads::PumpLoads(SimTK::GeneralForceSubsystem& forces, const PumpParameters& pump,
                     const Assumptions& assumptions, const PumpBodies& bodies,
                     const LoadInputs& inputs, LoadedBodies loaded)
    : Custom(forces, new PumpLoadsImplementation(pump, assumptions, bodies, inputs, loaded)) {}

}  // namespace bentaxis::multibody
