// What Bullet does otherwise than one may expect, each pinned by a multibody of one or two links
// (docs/engines.md). SI units.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <gtest/gtest.h>

#include <cmath>

namespace {

constexpr double kNoLimit = 1e30;

// A rod of 1 kg along x on a hinge about y at the origin, its centre of mass 0.5 m away.
struct Rod {
  explicit Rod(bool as_it_comes = false) : body(1, 0, btVector3(0, 0, 0), true, false) {
    body.setBasePos(btVector3(0, 0, 0));
    body.setWorldToBaseRot(btQuaternion::getIdentity());
    body.setupRevolute(0, 1, btVector3(1, 1, 1), -1, btQuaternion::getIdentity(),
                       btVector3(0, 1, 0), btVector3(0, 0, 0), btVector3(0.5, 0, 0));
    if (!as_it_comes) {
      body.setLinearDamping(0);
      body.setAngularDamping(0);
      body.setMaxCoordinateVelocity(kNoLimit);
    }
    body.finalizeMultiDof();
    body.getLink(0).m_jointFeedback = &feedback;
    place();
  }
  void place() { body.forwardKinematics(turns, origins); }
  void advance(double seconds) {
    body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(seconds, numbers, vectors, matrices,
                                                              false, true, false);
  }
  btMultiBody body;
  btMultiBodyJointFeedback feedback;
  btAlignedObjectArray<btScalar> numbers;
  btAlignedObjectArray<btVector3> vectors, origins;
  btAlignedObjectArray<btMatrix3x3> matrices;
  btAlignedObjectArray<btQuaternion> turns;
};

// The libraries with doubles and their headers belong together.
TEST(BulletTraps, NumbersHave64Bits) { EXPECT_EQ(sizeof(btScalar), 8U); }

// A multibody brakes itself: 4 % of its velocity per second, unless both dampings are set to 0.
TEST(BulletTraps, ItIsDampedUnlessToldOtherwise) {
  for (const bool as_it_comes : {true, false}) {
    Rod rod(as_it_comes);
    rod.body.setJointVel(0, 10);
    rod.body.clearForcesAndTorques();
    rod.advance(1e-3);
    if (as_it_comes)
      EXPECT_LT(rod.body.getJointVel(0), 10 - 1e-4);
    else
      EXPECT_NEAR(rod.body.getJointVel(0), 10, 1e-12);
  }
}

// The reaction is about the centre of mass of the link, force in m_topVec, and of the joint's own
// direction nothing: 10 N at 0.5 m are 5 Nm about the centre where the hinge is held.
TEST(BulletTraps, ReactionsAreAboutTheCentreOfMass) {
  Rod rod;
  rod.body.clearForcesAndTorques();
  rod.body.addLinkForce(0, btVector3(0, 0, -10));
  rod.body.addJointTorque(0, -5);  // holds it: about y, against the weight
  rod.advance(1);
  EXPECT_NEAR(rod.body.getJointVel(0), 0, 1e-12);
  EXPECT_NEAR(rod.feedback.m_reactionForces.m_topVec.z(), 10, 1e-12);
  EXPECT_NEAR(rod.feedback.m_reactionForces.m_bottomVec.y(), 0, 1e-12);  // 5 - 0.5 x 10
}

// Forces last until they are cleared.
TEST(BulletTraps, ForcesOfTheStepBeforeStay) {
  Rod rod;
  rod.body.clearForcesAndTorques();
  rod.body.addJointTorque(0, 1.25);  // 1 + 0.5^2 kg m2
  rod.advance(1);
  EXPECT_NEAR(rod.body.getJointVel(0), 1, 1e-12);
  rod.advance(1);
  EXPECT_NEAR(rod.body.getJointVel(0), 2, 1e-12);
}

// A point-to-point constraint gives up at an impulse of 100 N s, or whatever it is told; its rows
// push the first body along -x, -y, -z. The velocities change only when they are told to.
TEST(BulletTraps, ConstraintsHaveALargestImpulse) {
  for (const bool unlimited : {false, true}) {
    Rod rod;
    btRigidBody::btRigidBodyConstructionInfo none(0, nullptr, nullptr);
    btRigidBody ground(none);
    btMultiBodyPoint2Point hold(&rod.body, 0, &ground, btVector3(0.5, 0, 0), btVector3(1, 0, 0));
    if (unlimited) hold.setMaxAppliedImpulse(kNoLimit);
    hold.finalizeMultiDof();
    rod.body.clearForcesAndTorques();
    rod.body.addJointTorque(0, 1000);  // -1000 N along z at 1 m
    rod.advance(1);
    const double before = rod.body.getJointVel(0);
    btContactSolverInfo info;
    info.m_timeStep = 1;
    btMultiBodyConstraint* constraints[] = {&hold};
    btMultiBodyConstraintSolver solver;
    solver.solveMultiBodyGroup(nullptr, 0, nullptr, 0, nullptr, 0, constraints, 1, info, nullptr,
                               nullptr);
    EXPECT_NEAR(rod.body.getJointVel(0), before, 1e-9);
    rod.body.processDeltaVeeMultiDof2();
    EXPECT_GT(std::abs(rod.body.getJointVel(0) - before), 1);
    const double impulse = hold.getAppliedImpulse(2);
    EXPECT_NEAR(impulse, unlimited ? -1000 : -100, unlimited ? 1e-6 : 1e-9);
  }
}

}  // namespace
