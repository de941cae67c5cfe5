#include "scene/gear_mesh.h"

#include <cmath>
#include <utility>

#include "bentaxis/pump/units.h"

namespace bentaxis::multibody {

using SimTK::Array_;
using SimTK::ConstrainedBodyIndex;
using SimTK::ConstrainedQIndex;
using SimTK::Real;
using SimTK::Rotation;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Transform;
using SimTK::Vec3;

namespace {

// Moment arm of the lines about the block's axis, signed.
double arm_of(const SimTK::MobilizedBody& block, const Vec3& point, const ToothLines& lines,
              const Rotation& block_frame) {
  const Vec3 from_axis = point - block.getDefaultInboardFrame().p();
  return SimTK::dot(block_frame.z() % from_axis, lines.positive);
}

class GearMeshImplementation : public SimTK::Constraint::Custom::Implementation {
 public:
  GearMeshImplementation(SimTK::SimbodyMatterSubsystem& matter, SimTK::MobilizedBody& shaft,
                         SimTK::MobilizedBody& block, const Vec3& point, const ToothLines& lines,
                         const Rotation& block_frame, std::shared_ptr<const GearSetting> setting)
      : Implementation(matter, 1, 0, 0),
        point_(point),
        lines_(lines),
        block_frame_(block_frame),
        setting_(std::move(setting)) {
    shaft_ = addConstrainedBody(shaft);
    block_ = addConstrainedBody(block);
    arm_ = arm_of(block, point, lines, block_frame);  // rate of the error per unit of speed
  }

  Implementation* clone() const override { return new GearMeshImplementation(*this); }

  void calcPositionErrors(const State&, const Array_<Transform, ConstrainedBodyIndex>& bodies,
                          const Array_<Real, ConstrainedQIndex>&,
                          Array_<Real>& error) const override {
    const double phase =
        turn_angle(bodies[block_].R(), block_frame_) - turn_angle(bodies[shaft_].R(), shaft_frame_);
    error[0] = arm_ * std::remainder(phase, 2 * SimTK::Pi);
  }

  void calcPositionDotErrors(const State& state,
                             const Array_<SpatialVec, ConstrainedBodyIndex>& velocities,
                             const Array_<Real, ConstrainedQIndex>&,
                             Array_<Real>& error) const override {
    error[0] = SimTK::dot(line(), velocity(state, velocities[block_], block_) -
                                      velocity(state, velocities[shaft_], shaft_));
  }

  void calcPositionDotDotErrors(const State& state,
                                const Array_<SpatialVec, ConstrainedBodyIndex>& accelerations,
                                const Array_<Real, ConstrainedQIndex>&,
                                Array_<Real>& error) const override {
    error[0] = SimTK::dot(line(), velocity_rate(state, accelerations[block_], block_) -
                                      velocity_rate(state, accelerations[shaft_], shaft_)) -
               arm_ * setting_->relative_acceleration;
  }

  void addInPositionConstraintForces(const State& state, const Array_<Real>& multipliers,
                                     Array_<SpatialVec, ConstrainedBodyIndex>& forces,
                                     Array_<Real, ConstrainedQIndex>&) const override {
    const Vec3 force = multipliers[0] * line();
    forces[block_] += SpatialVec(lever(state, block_) % force, force);
    forces[shaft_] -= SpatialVec(lever(state, shaft_) % force, force);
  }

 private:
  // Mesh point from the body's origin, in Ground.
  Vec3 lever(const State& state, ConstrainedBodyIndex body) const {
    return point_ - getBodyOriginLocationFromState(state, body);
  }
  // Velocity of the body's material that passes the mesh point.
  Vec3 velocity(const State& state, const SpatialVec& body, ConstrainedBodyIndex index) const {
    return body[1] + body[0] % lever(state, index);
  }
  // Its rate at the point fixed in space, not that of the material.
  Vec3 velocity_rate(const State& state, const SpatialVec& body, ConstrainedBodyIndex index) const {
    const SpatialVec& v = getBodyVelocityFromState(state, index);
    return body[1] + body[0] % lever(state, index) - v[0] % v[1];
  }

  const Vec3& line() const { return setting_->negative ? lines_.negative : lines_.positive; }

  Vec3 point_;
  ToothLines lines_;
  Rotation block_frame_, shaft_frame_;
  double arm_ = 0;
  ConstrainedBodyIndex shaft_, block_;
  std::shared_ptr<const GearSetting> setting_;
};

}  // namespace

double turn_angle(const Rotation& body_in_ground, const Rotation& frame) {
  const SimTK::Mat33& body = body_in_ground.asMat33();
  const SimTK::Mat33& axes = frame.asMat33();
  double x = 0;
  double y = 0;
  for (int i = 0; i < 3; ++i) {
    x += axes(i, 0) * body(i, 0);
    y += axes(i, 1) * body(i, 0);
  }
  return std::atan2(y, x);
}

GearMesh::GearMesh(SimTK::SimbodyMatterSubsystem& matter, SimTK::MobilizedBody& shaft,
                   SimTK::MobilizedBody& block, const Vec3& point, const ToothLines& lines,
                   const Rotation& block_frame)
    : GearMesh(matter, shaft, block, point, lines, block_frame, std::make_shared<GearSetting>()) {}

GearMesh::GearMesh(SimTK::SimbodyMatterSubsystem& matter, SimTK::MobilizedBody& shaft,
                   SimTK::MobilizedBody& block, const Vec3& point, const ToothLines& lines,
                   const Rotation& block_frame, const std::shared_ptr<GearSetting>& setting)
    : Custom(new GearMeshImplementation(matter, shaft, block, point, lines, block_frame, setting)),
      point_(point),
      lines_(lines),
      arm_(arm_of(block, point, lines, block_frame)),
      setting_(setting) {}

Vec3 mesh_point_of(const PumpParameters& pump) {
  const double radius = pump.gear.pitch_diameter / 2;
  const double cone = kPi / 2 - pump.geometry.tilt / 2;
  return {0, radius, -radius / std::tan(cone) + pump.geometry.axis_offset};
}

ToothLines tooth_lines_of(const PumpParameters& pump, double omega) {
  const double cone = kPi / 2 - pump.geometry.tilt / 2;
  const double sign = omega < 0 ? -1 : 1;
  const double ap = pump.gear.pressure_angle;
  const Vec3 across(-std::cos(ap), 0, 0);
  const Vec3 apart(0, std::sin(ap) * std::cos(cone), std::sin(ap) * std::sin(cone));
  // A flank pushes: the part of its force that lies across turns the block, the other part pushes
  // the gears apart, whichever flank it is.
  const Vec3 towards_psi(SimTK::UnitVec3(sign * (across + apart)));
  if (pump.gear.flanks == Flanks::one) return {towards_psi, towards_psi};
  const Vec3 against_psi(SimTK::UnitVec3(sign * (across - apart)));
  return omega < 0 ? ToothLines{against_psi, towards_psi} : ToothLines{towards_psi, against_psi};
}

std::unique_ptr<GearMesh> gear_of(const PumpParameters& pump, SimTK::SimbodyMatterSubsystem& matter,
                                  SimTK::MobilizedBody& shaft, SimTK::MobilizedBody& block,
                                  const Rotation& frame, double omega) {
  return std::make_unique<GearMesh>(matter, shaft, block, mesh_point_of(pump),
                                    tooth_lines_of(pump, omega), frame);
}

double GearMesh::tooth_force(const State& state) const {
  return -getMultipliersAsVector(state)[0];  // a multiplier is minus the applied force
}

}  // namespace bentaxis::multibody
