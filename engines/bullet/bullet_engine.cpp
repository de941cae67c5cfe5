// Bullet (Coumans 2015), its multibodies with 64-bit numbers, as an engine: docs/engines.md has its
// traps. Debian has no header of its inverse dynamics, so forward dynamics are inverted: joints get
// the forces that make the accelerations those of the task.
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyMLCPConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "closed_tree.h"

namespace bentaxis::engines {
namespace {

using Vector = Eigen::Vector3d;

btVector3 bullet(const Vector& v) { return {v.x(), v.y(), v.z()}; }
btVector3 bullet(const double* v) { return {v[0], v[1], v[2]}; }
Vector eigen(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

// The bodies of a task as one multibody on a base that stands still, a link for every freedom: all
// but the last of a body without mass.
class Bodies {
 public:
  /// @param driven_inertia  of links whose freedom is driven, instead of their own; 0: their own
  explicit Bodies(const bentaxis_engine_task& task, double driven_inertia = 0)
      : tree(task.freedoms, 0, btVector3(0, 0, 0), true, false), task_(task) {
    tree.setBasePos(btVector3(0, 0, 0));
    tree.setWorldToBaseRot(btQuaternion::getIdentity());
    tree.setLinearDamping(0);
    tree.setAngularDamping(0);
    tree.setMaxCoordinateVelocity(kNoLimit);
    tree.setMaxAppliedImpulse(kNoLimit);
    for (int body = 0; body < task.bodies; ++body) add_body(body, driven_inertia);
    tree.finalizeMultiDof();
    feedback_.resize(task.freedoms);
    for (int i = 0; i < task.freedoms; ++i) tree.getLink(i).m_jointFeedback = &feedback_[i];
  }

  void set(const double* position, const double* velocity) {
    for (int i = 0; i < task_.freedoms; ++i) {
      tree.setJointPos(i, position[i]);
      tree.setJointVel(i, velocity[i]);
    }
    place();
  }
  Eigen::VectorXd positions() const { return values(&btMultiBody::getJointPos); }
  Eigen::VectorXd velocities() const { return values(&btMultiBody::getJointVel); }

  /// Links to the places that the coordinates say.
  void place() { tree.forwardKinematics(turns_, origins_); }

  /// Loads and weight, for the next call of advance().
  void apply(const Eigen::Ref<const Wrenches>& loads, const Vector& gravity) {
    tree.clearForcesAndTorques();
    for (int body = 0; body < task_.bodies; ++body) {
      const int link = last[body];
      const Vector force = loads.col(body).head<3>();
      const Vector moment = Vector(loads.col(body).tail<3>()) - centre(link).cross(force);
      tree.addLinkForce(link, bullet(Vector(force + task_.mass[body] * gravity)));
      tree.addLinkTorque(link, bullet(moment));
    }
  }

  /// Velocities after a time without constraints.
  void advance(double seconds) {
    tree.computeAccelerationsArticulatedBodyAlgorithmMultiDof(seconds, numbers_, vectors_,
                                                              matrices_, false, true, false);
  }
  /// What a unit of force in a freedom accelerates, at the state of the last advance().
  Eigen::VectorXd accelerated_by(int freedom) {
    const int size = 6 + task_.freedoms;
    std::vector<btScalar> force(size), found(size);
    force[6 + freedom] = 1;
    tree.calcAccelerationDeltasMultiDof(force.data(), found.data(), numbers_, vectors_);
    return Eigen::Map<const Eigen::VectorXd>(found.data() + 6, task_.freedoms);
  }
  /// What the joint of a body did in the last advance(). It is about the link's centre of mass.
  Eigen::Matrix<double, 6, 1> joint_wrench(int body) const {
    const btSpatialForceVector& found = feedback_[first[body]].m_reactionForces;
    const Vector force = eigen(found.m_topVec);
    Eigen::Matrix<double, 6, 1> wrench;
    wrench << force, eigen(found.m_bottomVec) + centre(first[body]).cross(force);
    return wrench;
  }

  btMultiBody tree;
  std::vector<int> first, last;  // links of each body
  static constexpr double kNoLimit = 1e30;

 private:
  Vector centre(int link) const {
    return eigen(tree.getLink(link).m_cachedWorldTransform.getOrigin());
  }
  Eigen::VectorXd values(btScalar (btMultiBody::*get)(int) const) const {
    Eigen::VectorXd found(task_.freedoms);
    for (int i = 0; i < task_.freedoms; ++i) found[i] = (tree.*get)(i);
    return found;
  }

  void add_body(int body, double driven_inertia) {
    const int parent = task_.parent[body];
    int link = parent < 0 ? -1 : last[parent];
    // Bullet measures from centre of mass to centre of mass, and from axes of the parent to own.
    Vector from_centre = Eigen::Map<const Vector>(task_.place + 3 * body);
    if (parent >= 0) from_centre -= Eigen::Map<const Vector>(task_.centre + 3 * parent);
    const Eigen::Matrix3d axes = Eigen::Map<const Eigen::Matrix3d>(task_.axes + 9 * body);
    Eigen::Quaterniond turn(Eigen::Matrix3d(axes.transpose()));
    first.push_back(-1);
    int end = 0;
    for (int i = 0; i < task_.freedoms; ++i)
      if (task_.freedom_body[i] == body) end = i;
    for (int i = 0; i <= end; ++i) {
      if (task_.freedom_body[i] != body) continue;
      if (first.back() < 0) first.back() = i;
      const bool has_mass = i == end;
      const btVector3 inertia = !has_mass ? btVector3(0, 0, 0)
                                : driven_inertia > 0 && task_.freedom_driven[i] != 0
                                    ? btVector3(driven_inertia, driven_inertia, driven_inertia)
                                    : bullet(task_.inertia + 3 * body);
      const double mass = has_mass ? task_.mass[body] : 0;
      const btVector3 centre = has_mass ? bullet(task_.centre + 3 * body) : btVector3(0, 0, 0);
      const btQuaternion rotation(turn.x(), turn.y(), turn.z(), turn.w());
      const btVector3 axis = bullet(task_.freedom_axis + 3 * i);
      if (task_.freedom_turns[i] != 0)
        tree.setupRevolute(i, mass, inertia, link, rotation, axis, bullet(from_centre), centre);
      else
        tree.setupPrismatic(i, mass, inertia, link, rotation, axis, bullet(from_centre), centre,
                            true);
      link = i;
      from_centre.setZero();
      turn.setIdentity();
    }
    last.push_back(link);
  }

  const bentaxis_engine_task& task_;
  std::vector<btMultiBodyJointFeedback> feedback_;
  btAlignedObjectArray<btScalar> numbers_;
  btAlignedObjectArray<btVector3> vectors_, origins_;
  btAlignedObjectArray<btMatrix3x3> matrices_;
  btAlignedObjectArray<btQuaternion> turns_;
};

std::string version() {
  return "Bullet " + std::to_string(btGetVersion() / 100) + "." +
         std::to_string(btGetVersion() % 100);
}

class BulletTree : public Tree {
 public:
  explicit BulletTree(const bentaxis_engine_task& task)
      : task_(task), bodies_(task), masses_(task.freedoms, task.freedoms) {}

  std::string text() const override {
    return version() + ", btMultiBody, forward dynamics inverted";
  }

  void set(const double* position, const double* velocity, const double* acceleration,
           bool moves) override {
    const Eigen::Index n = task_.freedoms;
    using Values = Eigen::Map<const Eigen::VectorXd>;
    velocity_ = moves ? Eigen::VectorXd(Values(velocity, n)) : Eigen::VectorXd::Zero(n);
    wanted_ = moves ? Eigen::VectorXd(Values(acceleration, n)) : Eigen::VectorXd::Zero(n);
    gravity_ = moves ? Vector(Eigen::Map<const Vector>(task_.gravity)) : Vector(Vector::Zero());
    bodies_.set(position, velocity_.data());
    bodies_.apply(Wrenches::Zero(6, task_.bodies), Vector::Zero());
    bodies_.advance(0);
    Eigen::MatrixXd inverse(n, n);
    for (int i = 0; i < n; ++i) inverse.col(i) = bodies_.accelerated_by(i);
    masses_ = inverse.inverse();
  }

  void joint_wrenches(const Wrenches& loads, Wrenches& joints) override {
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(task_.freedoms);
    for (int pass = 0; pass < 2; ++pass)
      forces += masses_ * (wanted_ - accelerations(loads, forces));
    accelerations(loads, forces);
    for (int body = 0; body < task_.bodies; ++body) joints.col(body) = bodies_.joint_wrench(body);
  }

 private:
  // In a second of this acceleration the velocities change by as much.
  Eigen::VectorXd accelerations(const Wrenches& loads, const Eigen::VectorXd& forces) {
    bodies_.apply(loads, gravity_);
    for (int i = 0; i < task_.freedoms; ++i) bodies_.tree.addJointTorque(i, forces[i]);
    bodies_.advance(1);
    Eigen::VectorXd found = bodies_.velocities() - velocity_;
    for (int i = 0; i < task_.freedoms; ++i) bodies_.tree.setJointVel(i, velocity_[i]);
    return found;
  }

  const bentaxis_engine_task& task_;
  Bodies bodies_;
  Eigen::MatrixXd masses_;
  Eigen::VectorXd velocity_, wanted_;
  Vector gravity_ = Vector::Zero();
};

// A btMultiBodyPoint2Point for each loop; an inertia that no load can slow down holds the speed of
// what is driven. Steps are those of btMultiBodyDynamicsWorld: velocities, constraints, positions.
class BulletIntegration : public Integration {
 public:
  BulletIntegration(const bentaxis_engine_task& task, const Settings& settings)
      : task_(task), settings_(settings.text()), bodies_(task, kInertia) {
    const std::string solver = settings.word("solver");
    if (solver == "Dantzig")
      solver_ = std::make_unique<btMultiBodyMLCPConstraintSolver>(&dantzig_);
    else if (solver == "impulses")
      solver_ = std::make_unique<btMultiBodyConstraintSolver>();
    else
      throw std::runtime_error("setting solver=" + solver + ": must be Dantzig or impulses");
    info_.m_timeStep = 2 * task.interval;
    info_.m_erp = info_.m_erp2 = settings.number("error_reduction");
    info_.m_globalCfm = settings.number("force_mixing");
    info_.m_numIterations = static_cast<int>(settings.number("iterations"));
    info_.m_leastSquaresResidualThreshold = 0;
    bodies_.set(task.position, task.velocity);
    for (int loop = 0; loop < task.loops; ++loop) {
      const int on = task.loop_on[loop], by = task.loop_by[loop];
      // It takes points from the centres of mass.
      const auto point = [&](const double* points, int body) {
        return bullet(points + 3 * loop) - bullet(task.centre + 3 * body);
      };
      loops_.push_back(std::make_unique<btMultiBodyPoint2Point>(
          &bodies_.tree, bodies_.last[on], &bodies_.tree, bodies_.last[by],
          point(task.loop_point_on, on), point(task.loop_point_by, by)));
      loops_.back()->setMaxAppliedImpulse(Bodies::kNoLimit);
      loops_.back()->finalizeMultiDof();
      constraints_.push_back(loops_.back().get());
    }
  }

  std::string text() const override {
    return version() + ", semi-implicit Euler, btMultiBodyPoint2Point, " + settings_;
  }

  // As in DART, velocities are those of half a step before and after.
  void step(int sample, Moment* begin) override {
    const Eigen::VectorXd position = bodies_.positions(), velocity = bodies_.velocities();
    bodies_.apply(Eigen::Map<const Wrenches>(task_.loads + 6 * Eigen::Index{sample} * task_.bodies,
                                             6, task_.bodies),
                  Eigen::Map<const Vector>(task_.gravity));
    bodies_.advance(info_.m_timeStep);
    solver_->solveMultiBodyGroup(nullptr, 0, nullptr, 0, nullptr, 0, constraints_.data(),
                                 static_cast<int>(constraints_.size()), info_, nullptr, nullptr);
    bodies_.tree.processDeltaVeeMultiDof2();  // the solver has left the changes aside
    const Eigen::VectorXd after = bodies_.velocities();
    bodies_.tree.stepPositionsMultiDof(info_.m_timeStep);
    bodies_.place();
    if (begin == nullptr) return;
    begin->position = position;
    begin->velocity = (velocity + after) / 2;
    begin->acceleration = (after - velocity) / info_.m_timeStep;
    begin->loop_force.resize(3, task_.loops);
    for (int loop = 0; loop < task_.loops; ++loop)
      for (int i = 0; i < 3; ++i)  // rows push the first body along -x, -y, -z
        begin->loop_force(i, loop) = -loops_[loop]->getAppliedImpulse(i) / info_.m_timeStep;
  }

 private:
  static constexpr double kInertia = 1e9;  // kg m2

  const bentaxis_engine_task& task_;
  std::string settings_;
  Bodies bodies_;
  btDantzigSolver dantzig_;
  std::unique_ptr<btMultiBodyConstraintSolver> solver_;
  btContactSolverInfo info_;
  std::vector<std::unique_ptr<btMultiBodyPoint2Point>> loops_;
  std::vector<btMultiBodyConstraint*> constraints_;
};

}  // namespace

std::unique_ptr<Tree> make_tree(const bentaxis_engine_task& task) {
  return std::make_unique<BulletTree>(task);
}

std::string known_settings() {
  return "solver=Dantzig,impulses error_reduction=1,0.5,0.2;0..1 force_mixing=0,1e-9,1e-6;0..1 "
         "iterations=50,10,200;1..100000;integer";
}

std::unique_ptr<Integration> make_integration(const bentaxis_engine_task& task,
                                              const Settings& settings) {
  return std::make_unique<BulletIntegration>(task, settings);
}

}  // namespace bentaxis::engines
