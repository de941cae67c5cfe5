// DART (Lee et al. 2018) as an engine: docs/engines.md has its traps.
#include <dart/config.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <string>
#include <vector>

#include "closed_tree.h"

namespace bentaxis::engines {
namespace {

using dart::dynamics::BodyNode;
using Vector = Eigen::Vector3d;

class DartTree : public Tree {
 public:
  explicit DartTree(const bentaxis_engine_task& task)
      : task_(task), skeleton_(dart::dynamics::Skeleton::create("pump")) {
    for (int body = 0; body < task.bodies; ++body) add_body(body);
  }

  std::string text() const override { return "DART " DART_VERSION ", computeInverseDynamics"; }

  void set(const double* position, const double* velocity, const double* acceleration,
           bool moves) override {
    const Eigen::Index n = task_.freedoms;
    using Values = Eigen::Map<const Eigen::VectorXd>;
    skeleton_->setPositions(Values(position, n));
    skeleton_->setVelocities(moves ? Eigen::VectorXd(Values(velocity, n))
                                   : Eigen::VectorXd(Eigen::VectorXd::Zero(n)));
    skeleton_->setAccelerations(moves ? Eigen::VectorXd(Values(acceleration, n))
                                      : Eigen::VectorXd(Eigen::VectorXd::Zero(n)));
    skeleton_->setGravity(moves ? Vector(Eigen::Map<const Vector>(task_.gravity))
                                : Vector(Vector::Zero()));
  }

  void joint_wrenches(const Wrenches& loads, Wrenches& joints) override {
    for (int body = 0; body < task_.bodies; ++body) {
      BodyNode* node = last_[body];
      const Vector force = loads.col(body).head<3>();
      const Vector origin = node->getTransform().translation();
      node->setExtForce(force, Vector::Zero());
      node->setExtTorque(Vector(loads.col(body).tail<3>()) - origin.cross(force));
    }
    // External forces do not act unless this says so.
    skeleton_->computeInverseDynamics(true);
    for (int body = 0; body < task_.bodies; ++body) {
      // Moment first, in the axes and about the origin of the first link.
      const BodyNode* node = first_[body];
      const Eigen::Isometry3d& frame = node->getTransform();
      const Vector moment = frame.linear() * node->getBodyForce().head<3>();
      const Vector force = frame.linear() * node->getBodyForce().tail<3>();
      joints.col(body) << force, moment + Vector(frame.translation()).cross(force);
    }
  }

 private:
  // A link for every freedom: all but the last without mass.
  void add_body(int body) {
    Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
    frame.translation() = Eigen::Map<const Vector>(task_.place + 3 * body);
    frame.linear() = Eigen::Map<const Eigen::Matrix3d>(task_.axes + 9 * body);
    BodyNode* node = task_.parent[body] < 0 ? nullptr : last_[task_.parent[body]];
    first_.push_back(nullptr);
    for (int i = 0; i < task_.freedoms; ++i) {
      if (task_.freedom_body[i] != body) continue;
      const Vector axis = Eigen::Map<const Vector>(task_.freedom_axis + 3 * i);
      node = task_.freedom_turns[i] != 0
                 ? add_link<dart::dynamics::RevoluteJoint>(node, i, frame, axis)
                 : add_link<dart::dynamics::PrismaticJoint>(node, i, frame, axis);
      if (first_.back() == nullptr) first_.back() = node;
      frame = Eigen::Isometry3d::Identity();
    }
    last_.push_back(node);
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
    BodyNode* node = skeleton_->createJointAndBodyNodePair<Kind>(parent, joint, link).second;
    node->setInertia(dart::dynamics::Inertia(0, Vector::Zero(), Eigen::Matrix3d::Zero()));
    return node;
  }

  const bentaxis_engine_task& task_;
  dart::dynamics::SkeletonPtr skeleton_;
  std::vector<BodyNode*> first_, last_;  // links of each body
};

}  // namespace

std::unique_ptr<Tree> make_tree(const bentaxis_engine_task& task) {
  return std::make_unique<DartTree>(task);
}

}  // namespace bentaxis::engines
