#include "bentaxis/study/case_description.h"

#include <algorithm>
#include <functional>
#include <string>

#include "bentaxis/analytic/body_loads.h"
#include "bentaxis/analytic/model.h"
#include "bentaxis/results/samples.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {
namespace {

constexpr int kMaxSamples = 120;  // of the turn
// A path of at least so many points per turn is a curve to the eye, however few rows a run has.
constexpr int kPathPerTurn = 1440, kPathPerPitch = 60;

CaseDescription::Turn turn_of(Case turn) {
  turn.operation.samples_per_revolution =
      std::min(turn.operation.samples_per_revolution, kMaxSamples);
  const Samples samples = sample_case(turn, PressureTrace(turn.pressure));
  ResultTable table = analytic::run(turn, turn.analytic, samples);
  BodyLoadTable loads = analytic::run_body_loads(turn, turn.analytic, samples);
  return {std::move(turn), std::move(table), std::move(loads)};
}

ResultTable film_path_of(Case turn) {
  const int pistons = turn.pump.geometry.pistons;
  turn.operation.samples_per_revolution = pistons * std::max(kPathPerPitch, kPathPerTurn / pistons);
  return analytic::run(turn, turn.analytic, sample_case(turn, PressureTrace(turn.pressure)));
}

}  // namespace

CaseDescription describe(const Case& the_case, const PartProgress& progress_of, Described what) {
  CaseDescription description{the_case, plausibility(the_case), {}, {}, {}};
  if (what == Described::inputs) return description;
  const auto attempt = [&](const char* part, const std::function<void()>& compute) {
    const std::string reason = reason_of(compute);
    if (!reason.empty()) description.failed.push_back({0, part, reason});
    return reason.empty();
  };
  Case ready = the_case;
  // Of a study of other cases the pressure of this one may not have been computed.
  if (lacks_pressure(ready.pressure) && !attempt("the chamber pressure of the pump in space", [&] {
        ready = prepare(the_case, progress_of).the_case;
      }))
    return description;
  if (what == Described::all &&
      !attempt("the pump in space", [&] { description.turn = turn_of(ready); }))
    return description;
  if (ready.pump.gear.contact != ToothContact::teeth)
    attempt("the path of the film force's point",
            [&] { description.film_path = film_path_of(ready); });
  return description;
}

}  // namespace bentaxis::study
