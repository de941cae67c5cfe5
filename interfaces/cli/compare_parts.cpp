#include "compare_parts.h"

#include "bentaxis/designs/explain.h"
#include "bentaxis/designs/validation_section.h"
#include "bentaxis/engines/run.h"

namespace bentaxis::cli {

void require_whole_program(const std::string&) {}

std::vector<std::string> engine_names() { return engines::known_engines(); }

void explain_differences(study::Outcome& outcome, const Case& given,
                         const study::PartProgress& progress_of) {
  designs::explain(outcome, given, progress_of);
}

void check_sampling(const Case& given, std::size_t samples) {
  designs::check_sampling(given, samples);
}

KnownHowWell add_uncertainty(report::Document& document, const Case& given,
                             const study::ComparisonResult& result, std::size_t samples,
                             const study::PartProgress& progress_of) {
  const designs::Validation validation = designs::validation(given, result, samples, progress_of);
  designs::add_validation(document, validation);
  return {designs::validation_text(validation),
          {"bands.csv", designs::bands_csv(validation.uncertainty)}};
}

}  // namespace bentaxis::cli
