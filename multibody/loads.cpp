#include "bentaxis/multibody/loads.h"

#include "bentaxis/multibody/gear_mesh.h"
#include "bentaxis/multibody/land_pressure.h"
#include "bentaxis/pump/units.h"

namespace bentaxis::multibody {

using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Vec3;

AxialLoad axial_load(const PumpParameters& pump, const Assumptions& assumptions, double pressure,
                     double velocity, double rest_speed) {
  AxialLoad load;
  const double radius = pump.geometry.bore_diameter / 2;
  load.pressure = -pressure * kPi * radius * radius;
  if (assumptions.piston_friction)
    load.friction = piston_friction_force(pump.friction, velocity, rest_speed);
  return load;
}

namespace {

class PumpLoadsImplementation : public SimTK::Force::Custom::Implementation {
 public:
  PumpLoadsImplementation(const PumpParameters& pump, const Assumptions& assumptions,
                          const PumpBodies& bodies, const LoadInputs& inputs)
      : pump_(pump), assumptions_(assumptions), bodies_(bodies), inputs_(inputs) {}

  void calcForce(const State& state, SimTK::Vector_<SpatialVec>& forces, SimTK::Vector_<Vec3>&,
                 SimTK::Vector&) const override {
    const Vec3 z1(0, 0, 1);
    const Vec3 z2(bodies_.block_frame.z());
    const auto& shaft = bodies_.shaft;
    const auto& block = bodies_.block;

    std::vector<double> pressure(bodies_.pistons.size());
    const double theta = turn_angle(shaft.getBodyRotation(state), SimTK::Rotation());
    inputs_.chamber_pressure(theta, pressure);
    const Vec3 ring(0, 0, pump_.geometry.piston_length);
    for (std::size_t k = 0; k < bodies_.pistons.size(); ++k) {
      const auto& piston = bodies_.pistons[k];
      const double velocity = SimTK::dot(z2, piston.findStationVelocityInGround(state, ring));
      const AxialLoad load =
          axial_load(pump_, assumptions_, pressure[k], velocity, inputs_.rest_speed);
      piston.applyForceToBodyPoint(state, ring, (load.pressure + load.friction) * z2, forces);
      const Vec3 on_block =
          block.findStationAtGroundPoint(state, piston.findStationLocationInGround(state, ring));
      block.applyForceToBodyPoint(
          state, on_block, (pump_.block.bottom_area * pressure[k] - load.friction) * z2, forces);
    }

    const Vec3 spring = pump_.block.spring_force * z2;
    apply_at(state, block, bodies_.block_origin, spring, forces);
    apply_at(state, shaft, bodies_.block_origin, -spring, forces);
    if (pump_.port_plate) {
      const FilmLoad film = film_load_now();
      apply_at(state, block, bodies_.block_origin, film.force_z * z2, forces);
      block.applyBodyTorque(state, bodies_.block_frame * Vec3(film.moment_x, film.moment_y, 0),
                            forces);
    }
    const double block_speed = SimTK::dot(z2, block.getBodyAngularVelocity(state));
    const double shaft_speed = SimTK::dot(z1, shaft.getBodyAngularVelocity(state));
    block.applyBodyTorque(state, -pump_.friction.block_viscous * block_speed * z2, forces);
    double shaft_torque = -pump_.friction.shaft_viscous * shaft_speed;
    if (inputs_.shaft_torque) shaft_torque += inputs_.shaft_torque(theta);
    shaft.applyBodyTorque(state, shaft_torque * z1, forces);
  }

  SimTK::Real calcPotentialEnergy(const State&) const override { return 0; }

 private:
  static void apply_at(const State& state, const SimTK::MobilizedBody& body, const Vec3& point,
                       const Vec3& force, SimTK::Vector_<SpatialVec>& forces) {
    body.applyForceToBodyPoint(state, body.findStationAtGroundPoint(state, point), force, forces);
  }

  // The film load changes only with the port pressures.
  const FilmLoad& film_load_now() const {
    if (inputs_.ports.delivery != film_ports_.delivery ||
        inputs_.ports.suction != film_ports_.suction || !film_known_) {
      film_ = film_load(*pump_.port_plate, inputs_.ports);
      film_ports_ = inputs_.ports;
      film_known_ = true;
    }
    return film_;
  }

  const PumpParameters& pump_;
  Assumptions assumptions_;
  PumpBodies bodies_;
  const LoadInputs& inputs_;
  mutable FilmLoad film_;
  mutable PortPressures film_ports_;
  mutable bool film_known_ = false;
};

}  // namespace

PumpLoads::PumpLoads(SimTK::GeneralForceSubsystem& forces, const PumpParameters& pump,
                     const Assumptions& assumptions, const PumpBodies& bodies,
                     const LoadInputs& inputs)
    : Custom(forces, new PumpLoadsImplementation(pump, assumptions, bodies, inputs)) {}

}  // namespace bentaxis::multibody
