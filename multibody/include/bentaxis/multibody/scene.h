// What the multibody model builds, and how it finds reactions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/parameters.h"
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
  std::optional<Method> method;  ///< none: method_for() the pump
};

/// Whether the bores' forces act elsewhere than at B: then they do work on the play between piston
/// and bore. Simbody's constraints are ideal and do none, so only Method::residual serves.
bool has_ring_off_b(const PumpParameters& pump);

/// The method asked for, or where none is the one that serves the pump: Method::multipliers, and
/// Method::residual where the bores' forces do not act at B.
/// @throws InputError where multipliers are asked for and cannot serve
Method method_for(const PumpParameters& pump, std::optional<Method> asked);

/// Whether a scene computes a channel: those of the pistons need neither bearings nor gear.
bool computes(Scene scene, const Channel& channel);
/// The smallest scene that computes all of these channels.
Scene smallest_scene(const std::vector<Channel>& channels);

/// Names as on the command line, in the order of the enumerations.
const std::vector<std::string>& scene_names();
const std::vector<std::string>& method_names();

}  // namespace bentaxis::multibody
