// The pump in space, from its own dimensions and the loads that the models find.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/report/scene.h"
#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// One model's part in a scene: rows of `loads` are those of `table`.
struct SceneRun {
  const ResultTable& table;
  const BodyLoadTable& loads;
};

/// How shaft and block stand at each row, rad.
struct SceneAngles {
  std::vector<double> shaft, block;
};

/// @param runs    as many rows each as the curves that the scene is shown with, whose tables have
///                the channels of these
/// @param angles  if given; otherwise both turn by the angle that is the curves' axis
/// @throws ComputationError where runs differ in their rows
report::Scene pump_scene(const Case& the_case, const std::vector<SceneRun>& runs,
                         const SceneAngles* angles = nullptr);

/// By the analytic model alone, over one turn of at most 120 samples, with curves of its own.
/// @param the_case  whose chamber pressure is there (study::prepare)
/// @throws InputError, ComputationError as the model does
report::Scene analytic_scene(const Case& the_case);

}  // namespace bentaxis::study
