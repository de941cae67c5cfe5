// Examples of the Modelica library built of the joints of multibody/, for Dymola's stored results.
#include <SimTKsimbody.h>

#include "../numbers.h"
#include "bentaxis/pump/parameters.h"
#include "conventions.h"
#include "transfers/joint.h"

namespace bentaxis::external {
namespace {

using namespace SimTK;

constexpr double kGravity = 9.80665;

struct World {
  World() : matter(system), forces(system), gravity(forces, matter, Vec3(0, -kGravity, 0)) {}
  MultibodySystem system;
  SimbodyMatterSubsystem matter;
  GeneralForceSubsystem forces;
  Force::UniformGravity gravity;
};

// Modelica.Mechanics.MultiBody.Examples.Constraints.UniversalConstraint: a body on a universal
// joint, with a spring. The first axis of the joint is z of the frame it is fixed in, the second x
// of the body. BlockJoint has its arms along x of the first body and y of the second: axes are
// renamed, z to x, x to y, y to z.
void put_universal(Numbers& numbers) {
  const auto renamed = [](double x, double y, double z) { return Vec3(z, x, y); };
  const Rotation fixed(BodyRotationSequence, convertDegreesToRadians(10), XAxis,
                       convertDegreesToRadians(55), YAxis, convertDegreesToRadians(68), ZAxis);
  Mat33 axes;  // of the renamed frame in the fixed one
  axes.col(0) = fixed.asMat33().col(2);
  axes.col(1) = fixed.asMat33().col(0);
  axes.col(2) = fixed.asMat33().col(1);
  const Transform frame(Rotation(axes, true), Vec3(0.2, -0.3, 0.2));

  World w;
  MobilizedBody::Weld fork(w.matter.updGround(), frame,
                           Body::Rigid(MassProperties(1, Vec3(0), Inertia(1))), Transform());
  const Vec3 centre = renamed(0.2, 0, 0);
  MobilizedBody::Ball body(
      w.matter.updGround(), frame,
      Body::Rigid(MassProperties(1, centre, Inertia(1).shiftFromMassCenter(centre, 1))),
      Transform());
  PumpParameters pump;
  pump.transfer.kind = TransferKind::cardan;
  pump.transfer.cardan = CardanJoint{};
  const multibody::BlockJoint joint(pump, fork, body);
  Force::TwoPointLinearSpring(w.forces, w.matter.updGround(), Vec3(0.8, 0, 0.3), body,
                              renamed(0.5, 0.15, 0.2), 20, 0);
  const State start = w.system.realizeTopology();
  RungeKuttaMersonIntegrator integrator(w.system);
  integrator.setAccuracy(1e-9);
  integrator.setConstraintTolerance(1e-10);
  TimeStepper stepper(w.system, integrator);
  stepper.initialize(start);
  for (const double time : {0.5, 1.0, 2.0, 3.0}) {
    stepper.stepTo(time);
    const State& state = stepper.getState();
    w.system.realize(state, Stage::Velocity);
    const Mat33 r = (~frame.R() * body.getBodyRotation(state)).asMat33();
    // Rows and columns by their old names: x is 1, y is 2, z is 0.
    numbers.push_back({"modelica.universal.phi_a", std::atan2(r(2, 1), r(1, 1))});
    numbers.push_back({"modelica.universal.phi_b", std::atan2(r(0, 2), r(0, 0))});
  }
}

// ModelicaTest.MultiBody.Joints.SphericalSpherical: a rod with its mass in the middle between a
// ball joint and a slider along x at (1, 0.2, 0).
void put_rod(Numbers& numbers) {
  constexpr double kLength = 1.04;
  const Vec3 slider(1, 0.2, 0);
  World w;
  const Vec3 middle(kLength / 2, 0, 0);
  MobilizedBody::Ball rod(
      w.matter.updGround(), Transform(Rotation(std::asin(0.2 / kLength), ZAxis)),
      Body::Rigid(MassProperties(1, middle, Inertia(1e-3).shiftFromMassCenter(middle, 1))),
      Transform());
  const multibody::InlineJoint line(w.matter.updGround(), UnitVec3(XAxis), slider, rod,
                                    Vec3(kLength, 0, 0));
  State state = w.system.realizeTopology();
  w.system.realize(state, Stage::Acceleration);
  const Vec3 end = rod.findStationLocationInGround(state, Vec3(kLength, 0, 0));
  // What the rod exerts on the support, at the slider's place.
  const Vec3 on_support = -multibody::constraint_force_on(state, line.constraint(), rod)[1];
  const Vec3 moment = (end - slider) % on_support;
  Vector_<SpatialVec> joints;
  multibody::joint_forces(state, w.matter, joints);
  numbers.push_back({"modelica.rod.place", end[0]});
  for (int axis = 0; axis < 3; ++axis) {
    numbers.push_back({"modelica.rod.force", on_support[axis]});
    numbers.push_back({"modelica.rod.moment", moment[axis]});
  }
  numbers.push_back({"modelica.rod.ball", joints[rod.getMobilizedBodyIndex()][1][1]});
}

}  // namespace

Numbers modelica() {
  Numbers numbers;
  put_universal(numbers);
  put_rod(numbers);
  return numbers;
}

}  // namespace bentaxis::external
