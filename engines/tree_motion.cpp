#include "tree_motion.h"

namespace bentaxis::engines {

FrameMotion moved(const FrameMotion& parent, const Body& body, const Coordinate* coordinates,
                  std::vector<Vector>* axes) {
  FrameMotion frame = parent;
  frame.origin = parent.point(body.place);
  frame.velocity = parent.velocity_of(body.place);
  frame.acceleration = parent.acceleration_of(body.place);
  frame.axes = parent.axes * body.axes;
  for (std::size_t i = 0; i < body.freedoms.size(); ++i) {
    const auto& [position, velocity, acceleration] = coordinates[i];
    const Vector axis = frame.axes * body.freedoms[i].axis;
    if (axes != nullptr) axes->push_back(axis);
    // The axis turns along with what has been moved so far.
    if (body.freedoms[i].turns) {
      frame.turning_rate += acceleration * axis + velocity * frame.turning.cross(axis);
      frame.turning += velocity * axis;
      frame.axes *= Eigen::AngleAxisd(position, body.freedoms[i].axis).toRotationMatrix();
    } else {
      const Vector arm = position * axis;
      frame.acceleration += frame.turning_rate.cross(arm) +
                            frame.turning.cross(frame.turning.cross(arm)) +
                            2 * velocity * frame.turning.cross(axis) + acceleration * axis;
      frame.velocity += frame.turning.cross(arm) + velocity * axis;
      frame.origin += arm;
    }
  }
  return frame;
}

}  // namespace bentaxis::engines
