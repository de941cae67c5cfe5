// The rattle map as a table, and the file in which its rows wait while it is computed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bentaxis/study/rattle.h"

namespace bentaxis::study {

/// A row per point and sweep, all digits (docs/rattle.md).
std::string rattle_csv(const RattleMap& map);

/// Rows that are finished, in a file that is whole at any time: each time written anew beside it
/// and renamed. Its head says what they were computed from; every row has a SHA-256 of its own,
/// over what it was computed from and its numbers.
class RattleFile {
 public:
  /// @param from  what the rows come from: a line without line ends
  RattleFile(std::filesystem::path file, std::string from);

  /// Its rows; none where there is no file.
  /// @throws InputError where it comes from something else or is none of these files, a row is
  ///         damaged, or two are of one pressure
  std::vector<RattleRow> read();
  /// @throws InputError where it cannot be written
  void keep(const RattleRow& row);
  std::size_t rows() const { return rows_; }
  const std::filesystem::path& file() const { return file_; }
  /// Removes the file, and what killed runs have left beside it.
  void remove() const;

 private:
  std::filesystem::path file_;
  std::string from_, text_;
  std::size_t rows_ = 0;
};

/// What a map's rows depend on, but for the case: speeds, turns, error.
std::string options_text(const RattleOptions& options);

}  // namespace bentaxis::study
