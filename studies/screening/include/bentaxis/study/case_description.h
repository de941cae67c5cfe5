// What a report says of a case beside the results of a study: whether its inputs are plausible, and
// one turn of the analytic model, from which the pump in space is drawn.
#pragma once

#include <optional>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/plausibility.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

struct CaseDescription {
  /// One driven turn of the analytic model, of at most 120 samples.
  struct Turn {
    Case the_case;  ///< with its chamber pressure and these samples
    ResultTable table;
    BodyLoadTable loads;
  };

  Case the_case;  ///< as it was given
  Plausibility plausibility;
  std::optional<Turn> turn;
  /// A turn in small steps, for the path of the film force's point. None where turns do
  /// not repeat by N-ths (teeth with errors of their own), or costs too much.
  std::optional<ResultTable> film_path;
  std::vector<FailedPoint> failed;  ///< of these what was asked for and could not be computed
};

/// What a study computes itself and its report does not need from here.
enum class Described {
  all,
  without_turn,  ///< the study has a turn with all loads
  inputs,        ///< the plausibility of the inputs alone
};

/// Computes the chamber pressure too where it is of kind "hydraulic" and not there yet.
/// @throws InputError where `[plausibility] meant` names no check or gives no reason; what
///         `progress_of` throws
CaseDescription describe(const Case& the_case, const PartProgress& progress_of = silent(),
                         Described what = Described::all);

}  // namespace bentaxis::study
