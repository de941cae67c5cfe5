// What the multibody model builds, and how it finds reactions.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/results/channels.h"

namespace bentaxis::multibody {

/// What is built. A smaller scene computes fewer channels; the others are not_computed().
enum class Scene {
  full,     ///< shaft in its bearings, block, gear, pistons: every channel
  pistons,  ///< shaft and block prescribed: Rs, Rc, zB, Rs3, Tc of every piston
  piston,   ///< the same with one piston, which stands for all where they see the same pressure
};

/// How reactions are found at an instant.
enum class Method {
  multipliers,  ///< Simbody's forward dynamics: accelerations and constraint multipliers together
  residual,     ///< accelerations from the constraint equations, forces by inverse dynamics; needs
                ///< no inertia, so it serves massless pistons too
};

/// What to build and how to find reactions there.
struct SceneChoice {
  Scene scene = Scene::full;
  Method method = Method::multipliers;
};

/// Whether a scene computes a channel: those of the pistons need neither bearings nor gear.
bool computes(Scene scene, const Channel& channel);
/// The smallest scene that computes all of these channels.
Scene smallest_scene(const std::vector<Channel>& channels);

/// Names as on the command line, in the order of the enumerations.
const std::vector<std::string>& scene_names();
const std::vector<std::string>& method_names();

}  // namespace bentaxis::multibody
