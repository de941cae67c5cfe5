// Reference data as studies use them: how a model is run on a reference's case.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// All references at or below a folder, as folder and name. The name is the path below `root`, or
/// the folder's own name where root is itself a reference.
struct ReferencePlace {
  std::filesystem::path folder;
  std::string name;
};
std::vector<ReferencePlace> references_below(const std::filesystem::path& root);

/// Files that the cases of a reference use beside the case files themselves.
std::vector<std::filesystem::path> files_of(const Case& the_case);

/// Keys in which the case of a reference differs from another, with both values, of those that both
/// have; "" where there are none. Names, files and how often a case is sampled do not count.
std::string differing_keys(const Case& theirs, const Case& ours);

/// The axes of the frames S1 and S2 of a case in S1, for curves given in other axes than ours.
compare::FrameAxes frames_of(const Case& the_case);

/// The cases that the models of a reference are given: read, with the description's number of
/// samples, and with their chamber pressure computed where they leave it to the hydraulic model.
/// @throws InputError, ComputationError
class ReferenceCases {
 public:
  explicit ReferenceCases(const compare::ReferenceDescription& description,
                          const PartProgress& progress_of = silent());
  const PreparedCase& of(Model model) const {
    return model == Model::multibody && multibody_ ? *multibody_ : analytic_;
  }

 private:
  PreparedCase analytic_;
  std::optional<PreparedCase> multibody_;  ///< where it is another one
};

/// Runs a model over one turn of a case, driven.
struct ReferenceRun {
  ResultTable table;
  compare::ZeroScales zero_scales;
};
ReferenceRun run_for_reference(const PreparedCase& ready, Model model,
                               const PartProgress& progress_of = silent());

}  // namespace bentaxis::study
