// What compare does beyond both models, by studies that a first build leaves out.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/study/comparison.h"
#include "report_files.h"

namespace bentaxis::cli {

/// @throws InputError where this program was built without it. @param option  "--with"
void require_whole_program(const std::string& option);

/// Names that --engine knows.
std::vector<std::string> engine_names();

/// --with: what of the case would explain the differences.
void explain_differences(study::Outcome& outcome, const Case& given,
                         const study::PartProgress& progress_of);

/// --uncertainty: refuses what cannot be sampled, before anything is computed. @throws InputError
void check_sampling(const Case& given, std::size_t samples);

/// How well the result is known: its section is added to the document.
struct KnownHowWell {
  std::string text;
  TextFile bands;
};
KnownHowWell add_uncertainty(report::Document& document, const Case& given,
                             const study::ComparisonResult& result, std::size_t samples,
                             const study::PartProgress& progress_of);

}  // namespace bentaxis::cli
