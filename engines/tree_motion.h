// Motion of a tree of bodies from the coordinates of its joints. Internal.
#pragma once

#include "bentaxis/engines/mechanism.h"

namespace bentaxis::engines {

/// How a frame moves: its origin and its axes (columns).
struct FrameMotion {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vector origin = Vector::Zero(), velocity = Vector::Zero(), acceleration = Vector::Zero();
  Vector turning = Vector::Zero(), turning_rate = Vector::Zero();

  Vector point(const Vector& local) const { return origin + axes * local; }
  Vector velocity_of(const Vector& local) const { return velocity + turning.cross(axes * local); }
  Vector acceleration_of(const Vector& local) const {
    const Vector arm = axes * local;
    return acceleration + turning_rate.cross(arm) + turning.cross(turning.cross(arm));
  }
};

/// Coordinates of one freedom.
struct Coordinate {
  double position = 0, velocity = 0, acceleration = 0;
};

/// The frame of a body whose parent moves so.
/// @param axes  receives the direction of each freedom in the world
FrameMotion moved(const FrameMotion& parent, const Body& body, const Coordinate* coordinates,
                  std::vector<Vector>* axes = nullptr);

}  // namespace bentaxis::engines
