// Processes of one run on one or several machines, started by mpirun or srun.
#pragma once

#include <functional>
#include <span>
#include <string>

namespace bentaxis::cli {

/// This process among those of its run; alone where it was started on its own.
class Ranks {
 public:
  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Waits for all.
  void wait() const;
  /// Adds up, number by number, what all have.
  void add_up(std::span<double> numbers) const;
  /// @param what  of the inputs, for the message
  /// @throws InputError where this rank's text is another than that of rank 0
  void must_be_same(const std::string& text, const std::string& what) const;

 private:
  friend int in_ranks(const std::function<int(const Ranks&)>& job);
  int rank_ = 0, size_ = 1;
};

/// Runs a job in every rank. Where one fails, it says why and the whole run ends: the others would
/// wait for it.
/// @return the job's exit status
/// @throws InputError where there are several ranks and the program was built without MPI; whatever
///         the job throws where there is one
int in_ranks(const std::function<int(const Ranks&)>& job);

/// Name and version of the library; "none" where the program was built without it.
std::string mpi_library();

}  // namespace bentaxis::cli
