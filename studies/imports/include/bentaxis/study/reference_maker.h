// Folders of reference data: made for a foreign curve, with a guess at what its columns are, made
// from today's results, and brought up to date.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/study/mapping_guess.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

/// A golden curve says that something changed, not what: few angles are enough.
inline constexpr int kGoldenSamples = 36;

/// Reads the record of another tool or a rig and guesses what its columns are, by holding them to
/// the analytic model's curves of the case.
/// @param sheet  of a workbook, variable of a MATLAB file; "" = the first with a table
/// @throws InputError where the record cannot be read or fits nothing; ComputationError
MappingGuess guess_reference(const Case& the_case, const std::filesystem::path& file,
                             const std::string& sheet = "");

/// The proposals as a table, worst first, and the angle and frame that were taken.
std::string proposal_text(const MappingGuess& guess);

/// The description.toml that says the same.
/// @param source     of the record, in words; "" = not stated
/// @param tolerance  of peak; where not given what the digits of the file allow
std::string description_of(const MappingGuess& guess, const std::string& source = "",
                           std::optional<double> tolerance = {});

/// Copies the case and the record into a new folder, beside a description. Returns the paths of its
/// files.
/// @param changed  the case is not as its file has it: it is written anew instead of copied
/// @param mapping  the file that the description is of, for messages; "" = it was guessed
/// @throws InputError where the folder is not new, and where regress would refuse it; nothing is
/// then written
std::vector<std::filesystem::path> make_reference(const Case& the_case, bool changed,
                                                  const std::filesystem::path& curve,
                                                  const std::string& description,
                                                  const std::filesystem::path& out,
                                                  const std::filesystem::path& mapping = {},
                                                  const PartProgress& progress_of = silent());

/// Makes a folder with the curves that both models give a case today. Returns the paths of its
/// files.
/// @param changed  as above; the folder of an unchanged case refers to its file
/// @throws InputError, ComputationError
std::vector<std::filesystem::path> make_golden(Case the_case, bool changed, int samples,
                                               const std::filesystem::path& out,
                                               const PartProgress& progress_of = silent());

/// What became of one golden folder, in words: what changed by how much, per curve.
struct GoldenUpdate {
  bool rewritten = false;
  std::string text;
};
/// Rewrites the curves of one golden reference that differ by more than its tolerance.
GoldenUpdate update_golden(const compare::ReferenceDescription& description,
                           const PartProgress& progress_of = silent());

/// The golden references below a folder, and the rest, which the program never writes.
struct GoldenSet {
  std::vector<compare::ReferenceDescription> golden;
  int others = 0;
  std::string kinds;  ///< of the others, in words
};
/// @throws InputError where there is no golden one
GoldenSet find_golden(const std::filesystem::path& root);

}  // namespace bentaxis::study
