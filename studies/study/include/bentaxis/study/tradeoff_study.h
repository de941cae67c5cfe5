// Speed against error of a case under a pressure with transitions and under one with steps: what
// `bentaxis tradeoff` computes, as a report, as CSV and as text.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/progress.h"
#include "bentaxis/study/tradeoff.h"

namespace bentaxis::study {

struct TradeoffStudy {
  struct Pressure {
    std::string name;  ///< "smooth" or "step"
    std::vector<TradeoffRun> runs;
  };
  Case the_case;
  TradeoffOptions options;
  std::vector<Pressure> pressures;  ///< the case's own and its counterpart
};

/// @param the_case  with its chamber pressure
/// @throws InputError at standstill
TradeoffStudy run_tradeoff_study(const Case& the_case, TradeoffOptions options,
                                 const Progress& progress);

report::Document tradeoff_document(const TradeoffStudy& study, const report::Lines& program);

/// A row per run.
std::string tradeoff_csv(const TradeoffStudy& study);

/// What to use for which error, and every run, for a terminal.
std::string tradeoff_text(const TradeoffStudy& study);

}  // namespace bentaxis::study
