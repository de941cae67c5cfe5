// Reference data as the commands use them: how a model is run on a reference's case.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::cli {

/// All references at or below a folder, as folder and name. The name is the path below `root`, or
/// the folder's own name where root is itself a reference.
struct ReferencePlace {
  std::filesystem::path folder;
  std::string name;
};
std::vector<ReferencePlace> references_below(const std::filesystem::path& root);

/// Files that the cases of a reference use beside the case files themselves.
std::vector<std::filesystem::path> files_of(const Case& the_case);

/// The cases that the models of a reference are given: read, with the description's number of
/// samples, and with their chamber pressure computed where they leave it to the hydraulic model.
/// @throws InputError, ComputationError
struct ReferenceCases {
  Case analytic, multibody;
};
ReferenceCases cases_of(const compare::ReferenceDescription& description);

/// Runs a model over one turn of a case, driven.
struct ReferenceRun {
  ResultTable table;
  compare::ZeroScales zero_scales;
};
ReferenceRun run_for_reference(const std::string& model, const Case& the_case);

}  // namespace bentaxis::cli
