// The catalogue of hard cases as a report, as CSV, as the table of docs/trust.md and as text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bentaxis/report/document.h"
#include "bentaxis/study/hard_cases.h"

namespace bentaxis::study {

/// What one of hard_models() made of one case.
struct HardCaseRun {
  HardCase hard;
  HardOutcome outcome;
};

/// Runs of a catalogue: for each case one of each of hard_models(), in their order.
struct HardCaseStudy {
  std::vector<HardCaseRun> runs;
  std::optional<LongRun> long_run;

  /// Nothing is wrong, every loss was predicted, and nothing grows over the long run.
  bool good() const;
  std::string headline() const;
  /// What is wrong, and where each model has the fewest digits.
  std::vector<std::string> answers() const;
};

report::Document hard_cases_document(const HardCaseStudy& study, const report::Lines& program);
std::string hard_cases_csv(const HardCaseStudy& study);
std::string hard_cases_markdown(const HardCaseStudy& study);

/// Headings, and a line for each run as it ends.
std::string hard_cases_heading();
std::string text_of(const HardCaseRun& run);
/// The losses that were not predicted, the long run and the headline.
std::string hard_cases_text(const HardCaseStudy& study);

}  // namespace bentaxis::study
