#include "scene/inline_joints.h"

#include <array>

namespace bentaxis::multibody {

using SimTK::Array_;
using SimTK::ConstrainedBodyIndex;
using SimTK::ConstrainedQIndex;
using SimTK::dot;
using SimTK::Real;
using SimTK::SpatialVec;
using SimTK::State;
using SimTK::Transform;
using SimTK::UnitVec3;
using SimTK::Value;
using SimTK::Vec3;

namespace {

constexpr unsigned kAxes = 2;

// What a unit force along an axis, at a follower's point, is on both bodies at their origins: minus
// that of the base is what the base feels. The rates of the equations are the same products with
// velocities.
struct Way {
  SpatialVec follower, base;
};

// Of the positions of a state.
struct Geometry {
  std::array<Vec3, kAxes> axes;  // in the ancestor's frame
  std::vector<Vec3> lever;       // follower's point from the follower's origin,
  std::vector<Vec3> arm;         // and from the base's
  std::vector<Way> ways;         // of both axes of every follower
};

class InlineJointsImplementation : public SimTK::Constraint::Custom::Implementation {
 public:
  InlineJointsImplementation(SimTK::MobilizedBody& base, const UnitVec3& line,
                             const std::vector<Vec3>& points,
                             const std::vector<SimTK::MobilizedBody>& followers,
                             const Vec3& follower_point)
      : Implementation(base.updMatterSubsystem(), static_cast<int>(kAxes * followers.size()), 0, 0),
        x_(line.perp()),
        y_(line % Vec3(line.perp())),
        points_(points),
        follower_point_(follower_point) {
    base_ = add(base);
    for (const SimTK::MobilizedBody& follower : followers) followers_.push_back(add(follower));
  }

  std::size_t equations() const { return kAxes * followers_.size(); }
  SimTK::MobilizedBodyIndex body(ConstrainedBodyIndex of) const { return bodies_[of]; }

  Implementation* clone() const override { return new InlineJointsImplementation(*this); }

  void realizeTopology(State& state) const override {
    geometry_ = getMatterSubsystem().allocateCacheEntry(state, SimTK::Stage::Position,
                                                        new Value<Geometry>());
  }

  void realizePosition(const State& state) const override {
    auto& entry = getMatterSubsystem().updCacheEntry(state, geometry_);
    Geometry& geometry = Value<Geometry>::updDowncast(entry).upd();
    const Transform& base = getBodyTransformFromState(state, base_);
    geometry.axes[0] = base.R() * x_;
    geometry.axes[1] = base.R() * y_;
    geometry.lever.resize(followers_.size());
    geometry.arm.resize(followers_.size());
    geometry.ways.resize(kAxes * followers_.size());
    for (unsigned k = 0; k < followers_.size(); ++k) {
      const Transform& follower = getBodyTransformFromState(state, followers_[k]);
      geometry.lever[k] = follower.R() * follower_point_;
      geometry.arm[k] = follower.p() + geometry.lever[k] - base.p();
      for (unsigned i = 0; i < kAxes; ++i) {
        const Vec3& axis = geometry.axes[i];
        geometry.ways[kAxes * k + i] = {SpatialVec(geometry.lever[k] % axis, axis),
                                        SpatialVec(geometry.arm[k] % axis, axis)};
      }
    }
  }

  void calcPositionErrors(const State&, const Array_<Transform, ConstrainedBodyIndex>& bodies,
                          const Array_<Real, ConstrainedQIndex>&,
                          Array_<Real>& error) const override {
    const Transform& base = bodies[base_];
    for (unsigned k = 0; k < followers_.size(); ++k) {
      const Vec3 off = ~base * (bodies[followers_[k]] * follower_point_) - points_[k];
      error[kAxes * k] = dot(off, x_);
      error[kAxes * k + 1] = dot(off, y_);
    }
  }

  void calcPositionDotErrors(const State& state,
                             const Array_<SpatialVec, ConstrainedBodyIndex>& velocities,
                             const Array_<Real, ConstrainedQIndex>&,
                             Array_<Real>& error) const override {
    const Geometry& geometry = geometry_of(state);
    const SpatialVec& base = velocities[base_];
    for (unsigned row = 0; row < geometry.ways.size(); ++row) {
      const Way& way = geometry.ways[row];
      error[row] =
          product(way.follower, velocities[followers_[row / kAxes]]) - product(way.base, base);
    }
  }

  void calcPositionDotDotErrors(const State& state,
                                const Array_<SpatialVec, ConstrainedBodyIndex>& accelerations,
                                const Array_<Real, ConstrainedQIndex>&,
                                Array_<Real>& error) const override {
    find_acceleration_errors(
        state, [&](ConstrainedBodyIndex body) -> const SpatialVec& { return accelerations[body]; },
        error);
  }

  // Accelerations of constrained bodies as a function of them.
  template <class Accelerations, class Errors>
  void find_acceleration_errors(const State& state, const Accelerations& acceleration,
                                Errors& error) const {
    const Geometry& geometry = geometry_of(state);
    const SpatialVec& base = acceleration(base_);
    const SpatialVec& base_rate = getBodyVelocityFromState(state, base_);
    for (unsigned k = 0; k < followers_.size(); ++k) {
      const SpatialVec& follower = acceleration(followers_[k]);
      const SpatialVec& rate = getBodyVelocityFromState(state, followers_[k]);
      const Vec3 turning = rate[0] % geometry.lever[k];
      const Vec3 carried = base_rate[0] % geometry.arm[k];
      // Of the point past the base, and what turning adds to its acceleration seen from there.
      const Vec3 passing = rate[1] + turning - base_rate[1] - carried;
      const Vec3 by_turning =
          rate[0] % turning - base_rate[0] % carried - 2 * (base_rate[0] % passing);
      for (unsigned i = 0; i < kAxes; ++i) {
        const Way& way = geometry.ways[kAxes * k + i];
        error[kAxes * k + i] = product(way.follower, follower) - product(way.base, base) +
                               dot(geometry.axes[i], by_turning);
      }
    }
  }

  void addInPositionConstraintForces(const State& state, const Array_<Real>& multipliers,
                                     Array_<SpatialVec, ConstrainedBodyIndex>& forces,
                                     Array_<Real, ConstrainedQIndex>&) const override {
    const Geometry& geometry = geometry_of(state);
    for (unsigned row = 0; row < geometry.ways.size(); ++row) {
      const Real size = multipliers[row];
      if (size == 0) continue;  // Simbody asks for one column after the other
      const Way& way = geometry.ways[row];
      forces[followers_[row / kAxes]] += size * way.follower;
      forces[base_] -= size * way.base;
    }
  }

 private:
  ConstrainedBodyIndex add(const SimTK::MobilizedBody& body) {
    bodies_.push_back(body.getMobilizedBodyIndex());
    return addConstrainedBody(body);
  }
  static Real product(const SpatialVec& way, const SpatialVec& rate) {
    return dot(way[0], rate[0]) + dot(way[1], rate[1]);
  }
  const Geometry& geometry_of(const State& state) const {
    return Value<Geometry>::downcast(getMatterSubsystem().getCacheEntry(state, geometry_)).get();
  }

  Vec3 x_, y_;
  std::vector<Vec3> points_;
  Vec3 follower_point_;
  ConstrainedBodyIndex base_;
  std::vector<ConstrainedBodyIndex> followers_;
  Array_<SimTK::MobilizedBodyIndex, ConstrainedBodyIndex> bodies_;
  mutable SimTK::CacheEntryIndex geometry_;
};

}  // namespace

InlineJoints::InlineJoints(SimTK::MobilizedBody& base, const UnitVec3& line,
                           const std::vector<Vec3>& points,
                           const std::vector<SimTK::MobilizedBody>& followers,
                           const Vec3& follower_point)
    : Custom(new InlineJointsImplementation(base, line, points, followers, follower_point)) {}

void InlineJoints::acceleration_errors(const State& state,
                                       const SimTK::Vector_<SpatialVec>& accelerations,
                                       std::vector<double>& errors) const {
  const auto& self = static_cast<const InlineJointsImplementation&>(getImplementation());
  errors.resize(self.equations());
  self.find_acceleration_errors(
      state,
      [&](ConstrainedBodyIndex body) -> const SpatialVec& {
        return accelerations[self.body(body)];
      },
      errors);
}

}  // namespace bentaxis::multibody
