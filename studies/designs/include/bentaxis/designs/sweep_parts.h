// Finished blocks of a sweep, in a folder until all are there.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/designs/sweep.h"
#include "bentaxis/files/run_lock.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::designs {

/// Which designs and numbers each block of a sweep must hold.
struct BlockLayout {
  std::size_t designs = 0;     ///< of all blocks
  std::size_t block_size = 1;  ///< designs of every block but the last
  std::size_t variables = 0, outputs = 0;
  bool singles = false;  ///< behind these blocks there may be any number of blocks of one design

  std::size_t blocks() const { return (designs + block_size - 1) / block_size; }
  /// Whether a block holds exactly the designs of this number, and as many values of each as the
  /// plan asks for.
  bool fits(std::size_t number, const SweepBlock& block) const;
};

/// What a sweep is, in a form that moves between machines: the case with its curves, the plan.
struct SweepRecord {
  std::string case_text;                                    ///< names curves as `curves` does
  std::vector<std::pair<std::string, std::string>> curves;  ///< file name and content
  std::string plan;                                         ///< a study file
  std::string identity;  ///< SHA-256 of all that blocks depend on, 64 hexadecimal digits
  BlockLayout layout;
};
/// @param program  name and version of what computes the blocks
/// @throws InputError where a curve's file cannot be read any more
SweepRecord record_of(const Sweep& sweep, const std::string& program);

/// A folder of blocks, each a file that is there whole or not at all: a block is written under
/// another name and renamed, and carries the sweep's identity and a SHA-256 of its own. Many
/// threads, processes and machines may write to one folder.
class SweepParts {
 public:
  /// @param folder  need not be there
  SweepParts(std::filesystem::path folder, SweepRecord record);

  const std::filesystem::path& folder() const { return folder_; }
  const SweepRecord& record() const { return record_; }
  /// Makes the folder and says in it what sweep it is of.
  /// @param kind  alone, or shared with runs that compute other parts of the same sweep
  /// @return held until the blocks are computed and, by a run that is alone, removed
  /// @throws InputError where it is that of another sweep, another run computes a sweep there, or
  /// it
  ///         cannot be written
  RunLock begin(RunLock::Kind kind = RunLock::Kind::alone) const;
  /// Held while the blocks are read, so that no run removes them meanwhile.
  /// @throws InputError where one computes them
  RunLock reading() const;
  /// A folder from elsewhere to look for blocks in.
  /// @throws InputError where it is of another sweep, or of none
  void add(const std::filesystem::path& folder);

  /// @throws InputError where it cannot be written
  void keep(std::size_t block, const SweepBlock& content) const;
  /// Nothing where the block is not there, is damaged, or is another block under this one's name.
  std::optional<SweepBlock> read(std::size_t block) const;
  /// Of these blocks those whose files are whole but hold another block of the sweep.
  std::vector<std::size_t> misplaced(const std::vector<std::size_t>& among) const;
  /// Number of blocks in the folder, whole or not, without those of one design behind the others.
  std::size_t count() const;
  /// Number of these.
  std::size_t count_singles() const;
  /// Removes blocks, record and what killed runs have left unfinished, and the folder if nothing
  /// else is in it.
  void remove(std::size_t blocks) const;

 private:
  void must_be_own() const;
  std::vector<std::size_t> numbers() const;  // of the blocks in the folder

  std::vector<std::filesystem::path> folders_;  // to look in
  std::filesystem::path folder_;                // to write to
  SweepRecord record_;
};

/// The sweep that the blocks in a folder are of, and its stored record.
/// @throws InputError where there is none
std::pair<Sweep, SweepRecord> sweep_in(const std::filesystem::path& folder);

/// Which blocks are computed here.
struct SweepShare {
  std::size_t part = 0, parts = 1;  ///< those whose number leaves `part` over `parts` ..
  std::size_t rank = 0, ranks = 1;  ///< .. and of these every `ranks`-th
  bool resume = false;              ///< those that are there are not computed again
  int threads = 0;                  ///< 0: one per processor
};
/// What a resumed run has found.
struct ResumedBlocks {
  std::size_t kept = 0;                ///< blocks that were there already
  std::vector<std::size_t> misplaced;  ///< computed again: their files held another block
};
/// Computes blocks into a folder. What is finished stays where the work is ended early.
ResumedBlocks compute_blocks(const Sweep& sweep, const SweepParts& parts, const SweepShare& share,
                             const Progress& progress);

/// Numbers as "3, 5-9, 12"; of many the first ones.
std::string list_of(const std::vector<std::size_t>& numbers);

}  // namespace bentaxis::designs
