// Speed against error of a case under a pressure with transitions and under one with steps: what
// `bentaxis tradeoff` computes, as a report, as CSV and as text.
#pragma once

#include <string>
#include <vector>

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

}  // namespace bentaxis::study

// Until version 2: programs written for 1.0.0 look for its part of a report here.
#if __has_include("bentaxis/study/tradeoff_document.h")
#include "bentaxis/study/tradeoff_document.h"
#endif
