// Runs either model on a case: the one place where a model's name becomes a model.
#pragma once

#include <functional>
#include <string>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/multibody/integrated.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"
#include "options.h"

namespace bentaxis::cli {

/// Samples of a run: one turn where driven, all revolutions (falling backwards) where integrated.
Samples samples_of(const Case& the_case, const PressureTrace& pressure, Way way);

/// Runs "analytic" or "multibody" under the given assumptions.
/// @param integration  used where way is integrated (multibody only)
/// @param scene        of the driven multibody model; an integrated run is of the full pump
/// @param record       filled by an integrated run, if not null
ResultTable run_model(const std::string& model, const Case& the_case,
                      const Assumptions& assumptions, const Samples& samples,
                      const PressureTrace& pressure, Way way,
                      const multibody::IntegrationOptions& integration,
                      multibody::IntegrationRecord* record = nullptr,
                      const multibody::SceneChoice& scene = {});

/// Runs the analytic model over one turn and writes its curves as CSV, row by row: memory does not
/// grow with the number of samples. Only channels that are wanted.
void stream_analytic(const Case& the_case, const Assumptions& assumptions,
                     const PressureTrace& pressure,
                     const std::function<bool(const Channel&)>& wanted, OutputFolder::Stream& out);

}  // namespace bentaxis::cli
