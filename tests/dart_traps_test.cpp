// What DART does otherwise than one may expect, each pinned by a rod on a hinge (docs/engines.md).
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>

namespace {

using Vector = Eigen::Vector3d;
using dart::dynamics::BodyNode;

// A rod of 1 kg and 1 m on a hinge about y at x = 2, turned by 90 degrees from x: it points along
// -z. No weight.
struct Rod {
  Rod() {
    dart::dynamics::RevoluteJoint::Properties joint;
    joint.mName = "hinge";
    joint.mAxis = Vector::UnitY();
    joint.mT_ParentBodyToJoint.translation() = Vector(2, 0, 0);
    const BodyNode::Properties link{BodyNode::AspectProperties("rod")};
    body = skeleton->createJointAndBodyNodePair<dart::dynamics::RevoluteJoint>(nullptr, joint, link)
               .second;
    body->setInertia(dart::dynamics::Inertia(1, Vector(0.5, 0, 0), Eigen::Matrix3d::Identity()));
    skeleton->setGravity(Vector::Zero());
    skeleton->setPosition(0, std::acos(0.0));
  }
  dart::dynamics::SkeletonPtr skeleton = dart::dynamics::Skeleton::create("pendulum");
  BodyNode* body = nullptr;
};

// External forces have no effect on the inverse dynamics unless it is told so.
TEST(DartTraps, InverseDynamicsLeavesExternalForcesOut) {
  Rod rod;
  rod.body->setExtForce(Vector(0, 0, 3));
  rod.skeleton->computeInverseDynamics();
  EXPECT_EQ(rod.body->getBodyForce().norm(), 0);
  rod.skeleton->computeInverseDynamics(true);
  EXPECT_NEAR(rod.body->getBodyForce().norm(), 3, 1e-12);
}

// The force of a joint has the moment first, in the axes of the body and about its origin: here z
// of the world is -x of the body.
TEST(DartTraps, JointForcesAreInTheFrameOfTheBody) {
  Rod rod;
  rod.body->setExtForce(Vector(0, 0, 3));
  rod.skeleton->computeInverseDynamics(true);
  const Vector force = rod.body->getBodyForce().tail<3>();
  EXPECT_NEAR(force.x(), 3, 1e-12);
  EXPECT_NEAR((rod.body->getTransform().linear() * force).z(), -3, 1e-12);
  rod.body->setExtForce(Vector(3, 0, 0), Vector(1, 0, 0));  // at the end of the rod, across it
  rod.skeleton->computeInverseDynamics(true);
  EXPECT_NEAR(rod.body->getBodyForce()[1], 3, 1e-12);
}

// The point of an external force is given in the frame of the body, the force itself in that of the
// world, unless it is said otherwise.
TEST(DartTraps, PointsOfForcesAreLocalForcesAreNot) {
  Rod rod;
  rod.body->setExtForce(Vector(3, 0, 0), Vector(1, 0, 0));
  rod.skeleton->computeInverseDynamics(true);
  const double local = rod.body->getBodyForce()[1];
  rod.body->setExtForce(Vector(3, 0, 0), Vector(2, 0, -1), false, false);
  rod.skeleton->computeInverseDynamics(true);
  EXPECT_NEAR(rod.body->getBodyForce()[1], local, 1e-12);
}

// setExtForce() and setExtTorque() each forget the moment that the other has set.
TEST(DartTraps, ForceAndTorqueForgetEachOther) {
  Rod rod;
  rod.body->setExtForce(Vector(3, 0, 0), Vector(1, 0, 0));
  EXPECT_NEAR(rod.body->getExternalForceLocal()[1], -3, 1e-12);
  rod.body->setExtTorque(Vector(0, 5, 0));
  EXPECT_NEAR(rod.body->getExternalForceLocal()[1], 5, 1e-12);
  rod.body->setExtForce(Vector(3, 0, 0), Vector(1, 0, 0));
  EXPECT_NEAR(rod.body->getExternalForceLocal()[1], -3, 1e-12);
}

// A body is given 1 kg where nothing is said; none at all is accepted.
TEST(DartTraps, AnUnsaidMassIsOneKilogram) {
  Rod rod;
  dart::dynamics::RevoluteJoint::Properties joint;
  joint.mName = "second hinge";
  BodyNode* link = rod.skeleton
                       ->createJointAndBodyNodePair<dart::dynamics::RevoluteJoint>(
                           rod.body, joint, BodyNode::AspectProperties("link"))
                       .second;
  EXPECT_EQ(link->getMass(), 1);
  link->setInertia(dart::dynamics::Inertia(0, Vector::Zero(), Eigen::Matrix3d::Zero()));
  rod.skeleton->computeInverseDynamics(true);
  EXPECT_EQ(link->getBodyForce().norm(), 0);
}

}  // namespace
