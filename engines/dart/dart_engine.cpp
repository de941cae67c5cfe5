// DART (Lee et al. 2018) as an engine: docs/engines.md has its traps.
#include <dart/config.hpp>
#include <dart/constraint/BallJointConstraint.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/simulation/World.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "closed_tree.h"

namespace bentaxis::engines {
namespace {

using dart::dynamics::BodyNode;
using dart::dynamics::Joint;
using Vector = Eigen::Vector3d;

// The bodies of a task: a skeleton for each that stands in the world, with all that hangs on it.
class Bodies {
 public:
  explicit Bodies(const bentaxis_engine_task& task) : task_(task) {
    for (int body = 0; body < task.bodies; ++body) add_body(body);
  }

  void apply(const Eigen::Ref<const Wrenches>& loads) {
    for (int body = 0; body < task_.bodies; ++body) {
      BodyNode* node = last[body];
      const Vector force = loads.col(body).head<3>();
      const Vector origin = node->getTransform().translation();
      node->setExtForce(force, Vector::Zero());
      node->setExtTorque(Vector(loads.col(body).tail<3>()) - origin.cross(force));
    }
  }

  std::vector<dart::dynamics::SkeletonPtr> skeletons;
  std::vector<Joint*> joints;          // of each freedom
  std::vector<BodyNode*> first, last;  // links of each body

 private:
  // A link for every freedom: all but the last without mass.
  void add_body(int body) {
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.translation() = Eigen::Map<const Vector>(task_.place + 3 * body);
    frame.linear() = Eigen::Map<const Eigen::Matrix3d>(task_.axes + 9 * body);
    BodyNode* node = task_.parent[body] < 0 ? nullptr : last[task_.parent[body]];
    if (node == nullptr)
      skeletons.push_back(dart::dynamics::Skeleton::create("body " + std::to_string(body)));
    first.push_back(nullptr);
    for (int i = 0; i < task_.freedoms; ++i) {
      if (task_.freedom_body[i] != body) continue;
      const Vector axis = Eigen::Map<const Vector>(task_.freedom_axis + 3 * i);
      node = task_.freedom_turns[i] != 0
                 ? add_link<dart::dynamics::RevoluteJoint>(node, i, frame, axis)
                 : add_link<dart::dynamics::PrismaticJoint>(node, i, frame, axis);
      if (first.back() == nullptr) first.back() = node;
      frame = Eigen::Isometry3d::Identity();
    }
    last.push_back(node);
    const Vector inertia = Eigen::Map<const Vector>(task_.inertia + 3 * body);
    node->setInertia(dart::dynamics::Inertia(
        task_.mass[body], Eigen::Map<const Vector>(task_.centre + 3 * body), inertia.asDiagonal()));
  }

  template <class Kind>
  BodyNode* add_link(BodyNode* parent, int freedom, const Eigen::Isometry3d& frame,
                     const Vector& axis) {
    typename Kind::Properties joint;
    joint.mName = "joint " + std::to_string(freedom);  // it reports every name it makes up
    joint.mT_ParentBodyToJoint = frame;
    joint.mAxis = axis;
    const BodyNode::Properties link{BodyNode::AspectProperties("link " + std::to_string(freedom))};
    const auto skeleton = parent == nullptr ? skeletons.back() : parent->getSkeleton();
    BodyNode* node = skeleton->createJointAndBodyNodePair<Kind>(parent, joint, link).second;
    joints.push_back(node->getParentJoint());
    node->setInertia(dart::dynamics::Inertia(0, Vector::Zero(), Eigen::Matrix3d::Zero()));
    return node;
  }

  const bentaxis_engine_task& task_;
};

class DartTree : public Tree {
 public:
  explicit DartTree(const bentaxis_engine_task& task) : task_(task), bodies_(task) {}

  std::string text() const override { return "DART " DART_VERSION ", computeInverseDynamics"; }

  void set(const double* position, const double* velocity, const double* acceleration,
           bool moves) override {
    for (std::size_t i = 0; i < bodies_.joints.size(); ++i) {
      bodies_.joints[i]->setPosition(0, position[i]);
      bodies_.joints[i]->setVelocity(0, moves ? velocity[i] : 0);
      bodies_.joints[i]->setAcceleration(0, moves ? acceleration[i] : 0);
    }
    for (const auto& skeleton : bodies_.skeletons)
      skeleton->setGravity(moves ? Vector(Eigen::Map<const Vector>(task_.gravity))
                                 : Vector(Vector::Zero()));
  }

  void joint_wrenches(const Wrenches& loads, Wrenches& joints) override {
    bodies_.apply(loads);
    // External forces do not act unless this says so.
    for (const auto& skeleton : bodies_.skeletons) skeleton->computeInverseDynamics(true);
    for (int body = 0; body < task_.bodies; ++body) {
      // Moment first, in the axes and about the origin of the first link.
      const BodyNode* node = bodies_.first[body];
      const Eigen::Isometry3d& frame = node->getTransform();
      const Vector moment = frame.linear() * node->getBodyForce().head<3>();
      const Vector force = frame.linear() * node->getBodyForce().tail<3>();
      joints.col(body) << force, moment + Vector(frame.translation()).cross(force);
    }
  }

 private:
  const bentaxis_engine_task& task_;
  Bodies bodies_;
};

// A BallJointConstraint for each loop; joints that are driven are velocity actuators.
class DartIntegration : public Integration {
 public:
  DartIntegration(const bentaxis_engine_task& task, const Settings& settings)
      : task_(task), settings_(settings.text()), bodies_(task) {
    using dart::constraint::BallJointConstraint;
    world_->setGravity(Eigen::Map<const Vector>(task.gravity));
    world_->setTimeStep(2 * task.interval);
    BallJointConstraint::setErrorReductionParameter(settings.number("error_reduction"));
    BallJointConstraint::setMaxErrorReductionVelocity(settings.number("largest_correction"));
    BallJointConstraint::setConstraintForceMixing(settings.number("force_mixing"));
    for (int i = 0; i < task.freedoms; ++i) {
      Joint* joint = bodies_.joints[i];
      joint->setPosition(0, task.position[i]);
      joint->setVelocity(0, task.velocity[i]);
      if (task.freedom_driven[i] == 0) continue;
      joint->setActuatorType(Joint::VELOCITY);
      joint->setCommand(0, task.velocity[i]);
    }
    for (const auto& skeleton : bodies_.skeletons) world_->addSkeleton(skeleton);
    auto solver = make_solver(settings.word("solver"));
    world_->setConstraintSolver(std::move(solver));
    for (int loop = 0; loop < task.loops; ++loop) {
      BodyNode* on = bodies_.last[task.loop_on[loop]];
      // It takes the point in the world.
      world_->getConstraintSolver()->addConstraint(std::make_shared<BallJointConstraint>(
          on, bodies_.last[task.loop_by[loop]],
          on->getTransform() * Vector(Eigen::Map<const Vector>(task.loop_point_on + 3 * loop))));
    }
  }

  std::string text() const override {
    return "DART " DART_VERSION ", semi-implicit Euler, BallJointConstraint, " + settings_;
  }

  // Impulses of a step belong to the positions at its begin, and its acceleration is the change of
  // velocity. The velocities of the engine are those of half a step before and after.
  void step(int sample, Moment* begin) override {
    bodies_.apply(Eigen::Map<const Wrenches>(task_.loads + 6 * Eigen::Index{sample} * task_.bodies,
                                             6, task_.bodies));
    const Eigen::VectorXd velocity = velocities();
    std::vector<Eigen::Matrix3d> axes;
    if (begin != nullptr) {
      begin->position.resize(task_.freedoms);
      for (int i = 0; i < task_.freedoms; ++i)
        begin->position[i] = bodies_.joints[i]->getPosition(0);
      for (int loop = 0; loop < task_.loops; ++loop)
        axes.emplace_back(link(loop)->getTransform().linear());
    }
    world_->step(false);
    if (begin == nullptr) return;
    const double dt = world_->getTimeStep();
    const Eigen::VectorXd after = velocities();
    begin->velocity = (velocity + after) / 2;
    begin->acceleration = (after - velocity) / dt;
    begin->loop_force.resize(3, task_.loops);
    for (int loop = 0; loop < task_.loops; ++loop)
      begin->loop_force.col(loop) = axes[loop] * link(loop)->getConstraintImpulse().tail<3>() / dt;
  }

 private:
  static std::unique_ptr<dart::constraint::ConstraintSolver> make_solver(const std::string& name) {
    using namespace dart::constraint;
    if (name == "Dantzig")
      return std::make_unique<BoxedLcpConstraintSolver>(std::make_shared<DantzigBoxedLcpSolver>());
    if (name == "PGS")
      return std::make_unique<BoxedLcpConstraintSolver>(std::make_shared<PgsBoxedLcpSolver>());
    throw std::runtime_error("setting solver=" + name + ": must be Dantzig or PGS");
  }

  BodyNode* link(int loop) const { return bodies_.last[task_.loop_on[loop]]; }
  Eigen::VectorXd velocities() const {
    Eigen::VectorXd values(task_.freedoms);
    for (int i = 0; i < task_.freedoms; ++i) values[i] = bodies_.joints[i]->getVelocity(0);
    return values;
  }

  const bentaxis_engine_task& task_;
  std::string settings_;
  Bodies bodies_;
  dart::simulation::WorldPtr world_ = dart::simulation::World::create();
};

}  // namespace

std::unique_ptr<Tree> make_tree(const bentaxis_engine_task& task) {
  return std::make_unique<DartTree>(task);
}

std::string known_settings() {
  return "error_reduction=1,0.5,0.2,0.01;0..1 force_mixing=1e-9,1e-5,1e-3;1e-9..1 "
         "largest_correction=1000,0.1;0..1e9 solver=Dantzig,PGS";
}

std::unique_ptr<Integration> make_integration(const bentaxis_engine_task& task,
                                              const Settings& settings) {
  return std::make_unique<DartIntegration>(task, settings);
}

}  // namespace bentaxis::engines
