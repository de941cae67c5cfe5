// The pump in DART (Lee et al. 2018): see README.md for model and settings.
#include <array>
#include <dart/constraint/BallJointConstraint.hpp>
#include <dart/constraint/ConstraintSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/UniversalJoint.hpp>
#include <dart/simulation/World.hpp>
#include <memory>

#include "pump_case.h"

namespace bentaxis::peers {
namespace {

using dart::dynamics::BodyNode;
using dart::dynamics::Joint;
using dart::dynamics::PrismaticJoint;
using dart::dynamics::RevoluteJoint;
using dart::dynamics::Skeleton;
using dart::dynamics::SkeletonPtr;
using dart::dynamics::UniversalJoint;

PumpCase* pump = nullptr;

double length() { return pump->the_case.pump.geometry.piston_length; }

// S2 in the world, which is S1; O2 lies at the offset of the axes.
Eigen::Isometry3d block_frame() {
  const Geometry& g = pump->the_case.pump.geometry;
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear() = Eigen::AngleAxisd(-g.tilt, Vector::UnitX()).toRotationMatrix();
  frame.translation().z() = g.axis_offset;
  return frame;
}

// From A to B, unit length, in a frame that turns with theta about its z axis.
analytic::Motion turned_back(const analytic::Motion& d, double theta) {
  const Eigen::Matrix3d back = Eigen::AngleAxisd(-theta, Vector::UnitZ()).toRotationMatrix();
  const Vector z = Vector::UnitZ();
  return {back * d.value, back * (d.first - z.cross(d.value)),
          back * (d.second - 2 * z.cross(d.first) + z.cross(z.cross(d.value)))};
}

// The two angles of a universal joint (x, then y) that turn (0, 0, 1) to d; with derivatives.
struct Angles {
  Eigen::Vector2d value, first, second;
};
Angles angles(const analytic::Motion& d) {
  const double y = d.value.y(), y1 = d.first.y(), y2 = d.second.y();
  const double z = d.value.z(), z1 = d.first.z(), z2 = d.second.z();
  const double square = y * y + z * z;
  const double cosine = std::sqrt(square);
  Angles found;
  found.value = {std::atan2(-y, z), std::asin(d.value.x())};
  found.first = {(y * z1 - y1 * z) / square, d.first.x() / cosine};
  found.second = {
      (y * z2 - y2 * z) / square - 2 * found.first[0] * (y * y1 + z * z1) / square,
      (d.second.x() + found.first[1] * found.first[1] * std::sin(found.value[1])) / cosine};
  return found;
}
Angles angles_on_shaft(const analytic::PistonKinematics& state, double theta) {
  const Eigen::Matrix3d r = block_frame().linear() / length();
  return angles(
      turned_back({r * state.axis.value, r * state.axis.first, r * state.axis.second}, theta));
}
Angles angles_in_block(const analytic::PistonKinematics& state, double theta) {
  const double l = length();
  return angles(
      turned_back({state.axis.value / l, state.axis.first / l, state.axis.second / l}, theta));
}

BodyNode* turning(const SkeletonPtr& skeleton, const Eigen::Isometry3d& frame) {
  const auto [joint, body] = skeleton->createJointAndBodyNodePair<RevoluteJoint>();
  joint->setAxis(Vector::UnitZ());
  joint->setTransformFromParentBodyNode(frame);
  joint->setActuatorType(Joint::VELOCITY);  // the motion is given, whatever the torque
  body->setInertia(dart::dynamics::Inertia(1));
  return body;
}

// A piston whose frame is at A or, `from_b`, at B; z from A to B.
BodyNode* add_piston(const SkeletonPtr& skeleton, BodyNode* parent, const Vector& at, bool from_b) {
  const auto [joint, body] = skeleton->createJointAndBodyNodePair<UniversalJoint>(parent);
  joint->setAxis1(Vector::UnitX());
  joint->setAxis2(Vector::UnitY());
  joint->setTransformFromParentBodyNode(Eigen::Isometry3d(Eigen::Translation3d(at)));
  const auto& p = pump->the_case.pump.piston;
  const double chi = p.joint_mass_fraction;
  const double transverse = chi * (1 - chi) * p.mass * length() * length();
  const Vector centre(0, 0, (from_b ? -chi : 1 - chi) * length());
  body->setInertia(dart::dynamics::Inertia(p.mass, centre.x(), centre.y(), centre.z(), transverse,
                                           transverse, 1e-12, 0, 0, 0));
  return body;
}

// Inverse dynamics of the shaft with the pistons hanging on it at A by universal joints. What these
// carry is Rs less what really acts at B: pressure and friction along the bore, Rc across it. Its
// moment about A gives what acts at B across the piston, and the rest follows.
double inverse() {
  const SkeletonPtr skeleton = Skeleton::create();
  skeleton->setGravity({0, -pump->the_case.pump.gravity, 0});
  BodyNode* shaft = turning(skeleton, Eigen::Isometry3d::Identity());
  const int n = pump->pistons();
  std::vector<BodyNode*> pistons;
  for (int k = 0; k < n; ++k)
    pistons.push_back(
        add_piston(skeleton, shaft, block_frame() * pump->piston(0, k).joint.value, false));
  const Vector z2 = block_frame().linear().col(2);
  const double w = pump->omega;
  Eigen::VectorXd q(1 + 2 * n), qd(1 + 2 * n), qdd(1 + 2 * n);
  std::vector<Vector> found(static_cast<std::size_t>(PumpCase::kSamples) * n);
  std::vector<double> loads(n);
  const Stopwatch stopwatch;
  for (int sample = 0; sample < PumpCase::kSamples; ++sample) {
    const double theta = 2 * kPi * sample / PumpCase::kSamples;
    q[0] = theta;
    qd[0] = w;
    qdd[0] = 0;
    for (int k = 0; k < n; ++k) {
      const auto state = pump->piston(theta, k);
      const Angles a = angles_on_shaft(state, theta);
      q.segment<2>(1 + 2 * k) = a.value;
      qd.segment<2>(1 + 2 * k) = a.first * w;
      qdd.segment<2>(1 + 2 * k) = a.second * w * w;
      loads[k] = pump->axial(theta, k, (state.joint.first.z() + state.axis.first.z()) * w);
    }
    skeleton->setPositions(q);
    skeleton->setVelocities(qd);
    skeleton->setAccelerations(qdd);
    skeleton->computeInverseDynamics();
    for (int k = 0; k < n; ++k) {
      const auto& wrench = pistons[k]->getBodyForce();  // moment about A, force; piston's frame
      const Eigen::Matrix3d rotation = pistons[k]->getTransform().linear();
      Vector at_b(wrench[1] / length(), -wrench[0] / length(), 0);
      const Vector bore = rotation.transpose() * z2;
      at_b.z() = (loads[k] - at_b.dot(bore)) / bore.z();
      found[static_cast<std::size_t>(sample) * n + k] =
          pump->kinematics.to_s2(rotation * (wrench.tail<3>() - at_b));
    }
  }
  const double seconds = stopwatch.seconds();
  pump->forget();
  for (std::size_t i = 0; i < found.size(); ++i)
    pump->judge(static_cast<int>(i) / n, static_cast<int>(i) % n, found[i]);
  return seconds;
}

// The whole pump for integration: pistons in the block on a slide and a universal joint at B.
struct Integrated {
  dart::simulation::WorldPtr world = dart::simulation::World::create();
  std::vector<SkeletonPtr> blocks;
  std::vector<Joint*> driven, slides;
  std::vector<BodyNode*> pistons;

  Integrated(double theta, double dt, bool apart);
};

Integrated::Integrated(double theta, double dt, bool apart) {
  const double w = pump->omega;
  world->setGravity({0, -pump->the_case.pump.gravity, 0});
  world->setTimeStep(dt);
  const SkeletonPtr shaft_skeleton = Skeleton::create("shaft");
  BodyNode* shaft = turning(shaft_skeleton, Eigen::Isometry3d::Identity());
  driven.push_back(shaft->getParentJoint());
  BodyNode* block = nullptr;
  for (int k = 0; k < pump->pistons(); ++k) {
    if (block == nullptr || apart) {
      blocks.push_back(Skeleton::create("block " + std::to_string(k)));
      block = turning(blocks.back(), block_frame());
      driven.push_back(block->getParentJoint());
    }
    const auto [slide, slider] =
        blocks.back()->createJointAndBodyNodePair<PrismaticJoint>(block);
    const Vector ring = pump->piston(0, k).ring();
    slide->setAxis(Vector::UnitZ());
    slide->setTransformFromParentBodyNode(
        Eigen::Isometry3d(Eigen::Translation3d(ring.x(), ring.y(), 0)));
    slider->setInertia(dart::dynamics::Inertia(1e-12, 0, 0, 0, 1e-18, 1e-18, 1e-18, 0, 0, 0));
    slides.push_back(slide);
    pistons.push_back(add_piston(blocks.back(), slider, Vector::Zero(), true));
    const auto state = pump->piston(theta, k);
    const Angles a = angles_in_block(state, theta);
    slide->setPosition(0, state.ring().z());
    slide->setVelocity(0, (state.joint.first.z() + state.axis.first.z()) * w);
    pistons.back()->getParentJoint()->setPositions(a.value);
    pistons.back()->getParentJoint()->setVelocities(a.first * w);
  }
  for (Joint* joint : driven) {
    joint->setPosition(0, theta);
    joint->setVelocity(0, w);
    joint->setCommand(0, w);
  }
  world->addSkeleton(shaft_skeleton);
  for (const SkeletonPtr& b : blocks) world->addSkeleton(b);
  for (BodyNode* piston : pistons)
    world->getConstraintSolver()->addConstraint(
        std::make_shared<dart::constraint::BallJointConstraint>(
            piston, shaft, piston->getTransform() * Vector(0, 0, -length())));
}

// A turn with fixed steps; results at the samples.
double integrate(int steps, double erp, bool apart) {
  dart::constraint::DynamicJointConstraint::setErrorReductionParameter(erp);
  const double dt = 2 * kPi / pump->omega / steps;
  const int settling = steps / 5;  // not timed
  Integrated all(-2 * kPi * settling / steps, dt, apart);
  const int n = pump->pistons();
  std::vector<double> before(n);
  for (int k = 0; k < n; ++k) before[k] = all.slides[k]->getVelocity(0);
  const double ex = getenv("EX") ? atof(getenv("EX")) : 0.5;
  const auto step = [&](int i) {
    const double theta = 2 * kPi * i / steps;
    for (int k = 0; k < n; ++k) {
      const double velocity = all.slides[k]->getVelocity(0);
      all.slides[k]->setCommand(0, pump->axial(theta, k, velocity + ex * (velocity - before[k])));
      before[k] = velocity;
    }
    all.world->step(false);
  };
  for (int i = -settling; i < 0; ++i) step(i);
  const int every = steps / PumpCase::kSamples;
  std::vector<Vector> found;
  const Stopwatch stopwatch;
  for (int i = 0; i < steps; ++i) {
    std::array<Eigen::Matrix3d, 16> rotation;
    const bool sampled = i % every == 0;
    if (sampled)
      for (int k = 0; k < n; ++k) rotation[k] = all.pistons[k]->getTransform().linear();
    step(i);
    if (!sampled) continue;
    for (int k = 0; k < n; ++k)
      found.push_back(pump->kinematics.to_s2(
          rotation[k] * all.pistons[k]->getConstraintImpulse().tail<3>() / dt));
  }
  const double seconds = stopwatch.seconds();
  pump->forget();
  for (std::size_t i = 0; i < found.size(); ++i)
    pump->judge(static_cast<int>(i) / n, static_cast<int>(i) % n, found[i]);
  return seconds;
}

}  // namespace
}  // namespace bentaxis::peers

int main() {
  using namespace bentaxis::peers;
  PumpCase the_pump;
  pump = &the_pump;
  Rows rows;
  double best = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) best = std::min(best, inverse());
  rows.add("DART", "inverse dynamics", "computeInverseDynamics on the shaft's tree", best,
           the_pump.error(), PumpCase::kSamples);
  for (const int steps : {180, 360, 720, 1440, 2880, 5760}) {
    for (const bool apart : {false, true})
    for (const double erp : {0.01,0.2,0.5,1.0}) {
      best = integrate(steps, erp, apart);
      rows.add("DART", "integrated", "steps " + std::to_string(steps) + " erp " + std::to_string(erp) + (apart ? " apart" : ""), best,
               the_pump.error(), PumpCase::kSamples);
    }
  }
  rows.print();
  return 0;
}
