// A folder that holds a pump's model to curves, in CI too.
#pragma once

#include <filesystem>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::study {

/// Which CI systems get a job file.
struct ProjectCi {
  bool github = true, gitlab = true;
};

/// Writes a new folder, whole or not at all: case.toml with its curves, reference/today with what
/// both models give today, job files, README.md, .gitignore. Returns the paths of its files.
/// @param changed  the case is not as its file has it: it is written anew instead of copied
/// @throws InputError where the folder is not new; ComputationError
std::vector<std::filesystem::path> make_project(const Case& the_case, bool changed,
                                                const ProjectCi& ci,
                                                const std::filesystem::path& folder,
                                                const PartProgress& progress_of = silent());

}  // namespace bentaxis::study
