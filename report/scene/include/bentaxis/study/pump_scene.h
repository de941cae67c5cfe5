// The pump in space, from its own dimensions and the loads that the models find.
#pragma once

#include <optional>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/report/scene.h"
#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/case_description.h"

namespace bentaxis::study {

/// One model's part in a scene: rows of `loads` are those of `table`.
struct SceneRun {
  const ResultTable& table;
  const BodyLoadTable& loads;
};

/// Rows of a simulation: when they are, and how shaft and block stand.
struct SceneMotion {
  std::vector<double> time_ms;
  std::vector<double> shaft, block;  ///< rad
};

/// Of more rows than this a scene shows every second, third, .. with curves of its own.
inline constexpr std::size_t kMaxSceneRows = kMaxLoadRows;
inline constexpr std::size_t kMostSceneRows [[deprecated("use kMaxSceneRows")]] = kMaxSceneRows;

/// @param runs    as many rows each as the curves that the scene is shown with, whose tables have
///                the channels of these
/// @param motion  of a simulation; otherwise shaft and block turn by the tables' angle, which is
///                the axis of the curves
/// @param path    a turn in small steps, whose first N-th is the path of the film force's point
/// @throws ComputationError where runs differ in their rows
report::Scene pump_scene(const Case& the_case, const std::vector<SceneRun>& runs,
                         const SceneMotion* motion = nullptr, const ResultTable* path = nullptr);

/// Of a description: the film force's path for pump_scene, nullptr where there is none.
const ResultTable* film_path_of(const CaseDescription& description);

/// By the analytic model alone, of the description's turn, with curves of its own. None where the
/// description has no turn.
std::optional<report::Scene> scene_of(const CaseDescription& description);

[[deprecated("use describe and scene_of")]] inline std::optional<report::Scene> analytic_scene(
    const Case& the_case) {
  return scene_of(describe(the_case));
}

}  // namespace bentaxis::study
