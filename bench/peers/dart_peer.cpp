// The pump in DART (Lee et al. 2018): see README.md for model and settings.
#include <fmt/format.h>

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
using dart::dynamics::Inertia;
using dart::dynamics::Joint;
using dart::dynamics::PrismaticJoint;
using dart::dynamics::RevoluteJoint;
using dart::dynamics::Skeleton;
using dart::dynamics::SkeletonPtr;
using dart::dynamics::UniversalJoint;

PumpCase* pump = nullptr;

constexpr double kSmall = 1e-12;  // kg, kg m2: what has no inertia in the model

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

// A body on a joint of this kind; named, because the engine reports every name it has to make up.
template <typename Kind>
BodyNode* add(const SkeletonPtr& skeleton, BodyNode* parent, const std::string& name,
              const Eigen::Isometry3d& frame) {
  typename Kind::Properties joint;
  joint.mName = name;
  joint.mT_ParentBodyToJoint = frame;
  const BodyNode::Properties body{BodyNode::AspectProperties(name)};
  return skeleton->createJointAndBodyNodePair<Kind>(parent, joint, body).second;
}

// Shaft or block: the joint holds the speed, whatever the torque.
BodyNode* add_turning(const SkeletonPtr& skeleton, const Eigen::Isometry3d& frame) {
  BodyNode* body = add<RevoluteJoint>(skeleton, nullptr, "turning", frame);  // about z
  body->getParentJoint()->setActuatorType(Joint::VELOCITY);
  return body;
}

// A lumped piston with its frame at A or, `from_b`, at B; z from A to B.
BodyNode* add_piston(const SkeletonPtr& skeleton, BodyNode* parent, int k, const Vector& at,
                     bool from_b) {
  BodyNode* body = add<UniversalJoint>(skeleton, parent, "piston " + std::to_string(k),
                                       Eigen::Isometry3d(Eigen::Translation3d(at)));  // x, then y
  const auto& p = pump->the_case.pump.piston;
  const double chi = p.joint_mass_fraction;
  const double transverse = chi * (1 - chi) * p.mass * length() * length();
  const double centre = (from_b ? -chi : 1 - chi) * length();
  body->setInertia(Inertia(p.mass, 0, 0, centre, transverse, transverse, kSmall, 0, 0, 0));
  return body;
}

void judge(const std::vector<Vector>& found) {
  const int n = pump->pistons();
  pump->forget();
  for (int i = 0; i < static_cast<int>(found.size()); ++i) pump->judge(i / n, i % n, found[i]);
}

// Inverse dynamics of the shaft with the pistons hanging on it at A by universal joints. What these
// carry is Rs less what really acts at B: pressure and friction along the bore, Rc across it. Its
// moment about A gives what acts at B across the piston, and the rest follows.
double inverse() {
  const SkeletonPtr skeleton = Skeleton::create();
  skeleton->setGravity({0, -pump->the_case.pump.gravity, 0});
  BodyNode* shaft = add_turning(skeleton, Eigen::Isometry3d::Identity());
  const int n = pump->pistons();
  std::vector<BodyNode*> pistons;
  for (int k = 0; k < n; ++k)
    pistons.push_back(
        add_piston(skeleton, shaft, k, block_frame() * pump->piston(0, k).joint.value, false));
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
  judge(found);
  return seconds;
}

// For integration: pistons in the block on a slide and a universal joint at B, A held to the shaft.
struct Integrated {
  dart::simulation::WorldPtr world = dart::simulation::World::create();
  std::vector<Joint*> turning, slides;
  std::vector<BodyNode*> pistons;

  Integrated(double theta, double dt, bool block_per_piston);
};

Integrated::Integrated(double theta, double dt, bool block_per_piston) {
  const double w = pump->omega;
  world->setGravity({0, -pump->the_case.pump.gravity, 0});
  world->setTimeStep(dt);
  std::vector<SkeletonPtr> skeletons{Skeleton::create("shaft")};
  BodyNode* shaft = add_turning(skeletons[0], Eigen::Isometry3d::Identity());
  turning.push_back(shaft->getParentJoint());
  BodyNode* block = nullptr;
  for (int k = 0; k < pump->pistons(); ++k) {
    if (k == 0 || block_per_piston) {
      skeletons.push_back(Skeleton::create("block " + std::to_string(k)));
      block = add_turning(skeletons.back(), block_frame());
      turning.push_back(block->getParentJoint());
    }
    const Vector ring = pump->piston(0, k).ring();
    BodyNode* slider =
        add<PrismaticJoint>(skeletons.back(), block, "slider " + std::to_string(k),
                            Eigen::Isometry3d(Eigen::Translation3d(ring.x(), ring.y(), 0)));
    slider->setInertia(Inertia(kSmall, 0, 0, 0, kSmall, kSmall, kSmall, 0, 0, 0));
    slides.push_back(slider->getParentJoint());  // along z
    pistons.push_back(add_piston(skeletons.back(), slider, k, Vector::Zero(), true));
    const auto state = pump->piston(theta, k);
    const Angles a = angles_in_block(state, theta);
    slides[k]->setPosition(0, state.ring().z());
    slides[k]->setVelocity(0, (state.joint.first.z() + state.axis.first.z()) * w);
    pistons[k]->getParentJoint()->setPositions(a.value);
    pistons[k]->getParentJoint()->setVelocities(a.first * w);
  }
  for (Joint* joint : turning) {
    joint->setPosition(0, theta);
    joint->setVelocity(0, w);
    joint->setCommand(0, w);
  }
  for (const SkeletonPtr& skeleton : skeletons) world->addSkeleton(skeleton);
  for (BodyNode* piston : pistons)
    world->getConstraintSolver()->addConstraint(
        std::make_shared<dart::constraint::BallJointConstraint>(
            piston, shaft, piston->getTransform() * Vector(0, 0, -length())));
}

// A turn with fixed steps; results at the samples.
double integrate(int steps, double error_reduction, bool block_per_piston) {
  dart::constraint::DynamicJointConstraint::setErrorReductionParameter(error_reduction);
  const double dt = 2 * kPi / pump->omega / steps;
  // At first the joints at A are where they should be, later where the steps leave them.
  const int settling = steps / 5;
  Integrated parts(-2 * kPi * settling / steps, dt, block_per_piston);
  const int n = pump->pistons();
  std::vector<double> before(n);
  for (int k = 0; k < n; ++k) before[k] = parts.slides[k]->getVelocity(0);
  const auto advance = [&](int step) {
    for (int k = 0; k < n; ++k) {
      // The engine's velocities are half a step behind its positions.
      const double behind = parts.slides[k]->getVelocity(0);
      const double velocity = behind + (behind - before[k]) / 2;
      before[k] = behind;
      parts.slides[k]->setCommand(0, pump->axial(2 * kPi * step / steps, k, velocity));
    }
    parts.world->step(false);
  };
  for (int step = -settling; step < 0; ++step) advance(step);
  const int every = steps / PumpCase::kSamples;
  std::vector<Vector> found;
  std::vector<Eigen::Matrix3d> rotations(n);
  const Stopwatch stopwatch;
  for (int step = 0; step < steps; ++step) {
    const bool sample = step % every == 0;
    // Impulses of a step belong to the positions at its start.
    for (int k = 0; sample && k < n; ++k) rotations[k] = parts.pistons[k]->getTransform().linear();
    advance(step);
    for (int k = 0; sample && k < n; ++k)
      found.push_back(pump->kinematics.to_s2(
          rotations[k] * parts.pistons[k]->getConstraintImpulse().tail<3>() / dt));
  }
  const double seconds = stopwatch.seconds();
  judge(found);
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
  for (const bool block_per_piston : {false, true})
    for (const int steps : kStepsPerTurn) {
      const Tuned best_run = tuned(the_pump, {0.2, 0.5, 1.0}, [&](double error_reduction) {
        return integrate(steps, error_reduction, block_per_piston);
      });
      rows.add("DART", "integrated",
               fmt::format("{}, {} steps, error reduction {}",
                           block_per_piston ? "a block per piston" : "one block", steps,
                           best_run.setting),
               best_run.seconds, best_run.error, PumpCase::kSamples);
    }
  rows.print();
  return 0;
}
