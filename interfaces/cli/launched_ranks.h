// What the program that started this one says of the ranks of the run. Internal.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

namespace bentaxis::cli {

/// Ranks of a run as Open MPI, MPICH and Slurm leave them in the environment of each.
struct LaunchedRanks {
  bool by_mpi = false;   ///< a program that starts ranks of MPI has started this one
  bool several = false;  ///< and says that there are others
};

/// @param variable  value of an environment variable, null where it is not set
template <class Variable>
LaunchedRanks launched_ranks(const Variable& variable) {
  const auto number = [&](const char* name) -> std::optional<int> {
    const char* const text = variable(name);
    if (text == nullptr) return std::nullopt;
    const std::string_view digits = text;
    int value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
  };
  LaunchedRanks found;
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const auto ranks = number(size)) {
      found.by_mpi = true;
      found.several = found.several || *ranks > 1;
    }
  // Slurm gives each rank its number by these, and their count by its own variable.
  for (const char* rank : {"PMI_RANK", "PMIX_RANK"})
    if (const auto which = number(rank)) {
      found.by_mpi = true;
      found.several = found.several || *which > 0 || number("SLURM_STEP_NUM_TASKS").value_or(1) > 1;
    }
  return found;
}

}  // namespace bentaxis::cli
