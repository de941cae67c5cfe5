// What acts on each body of the pump at an instant, for its free-body diagram: reactions, applied
// loads and inertia (d'Alembert), so that forces and moments on a body sum to zero.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace bentaxis {

enum class ForceKind {
  reaction,  ///< an unknown of the equilibrium equations
  applied,   ///< oil, friction, spring, weight, film
  inertia,   ///< minus mass times acceleration, minus the rate of angular momentum
};

/// A force, with what it acts on; components in S1. Symbols are those of docs/notation.md.
struct BodyLoad {
  std::string on;      ///< "piston 1", "block", "shaft"
  std::string by;      ///< "shaft", "oil", "gravity"; of inertia: the body itself
  std::string symbol;  ///< "Rs", "Fp", "inertia"
  std::string point;   ///< where it acts: "A1", "centre of mass"
  ForceKind kind = ForceKind::applied;
  std::array<double, 3> at = {};      ///< m, from O1
  std::array<double, 3> force = {};   ///< N
  std::array<double, 3> moment = {};  ///< Nm, beside that of the force at its point
};

/// What is left of all loads on a body.
struct BodySum {
  std::string body;
  std::array<double, 3> force = {};   ///< N
  std::array<double, 3> moment = {};  ///< Nm, about the first load's point
  double force_over_sum = 0;          ///< magnitude over the sum of the magnitudes
  double moment_over_sum = 0;         ///< likewise, of moments and of levers times forces
};

/// Rows of a run of which loads are kept, at most: more cannot be shown.
inline constexpr std::size_t kMaxLoadRows = 1440;

/// Loads of rows of a run. Every row has the same ones in the same order: a load that is 0 at an
/// instant is there with 0.
struct BodyLoadTable {
  struct Row {
    std::array<double, 3> at, force, moment;  ///< as in BodyLoad
  };
  std::vector<BodyLoad> loads;      ///< of the first row
  std::vector<Row> values;          ///< row-major, rows() x loads.size()
  std::size_t step = 1;             ///< of the run's rows the first and every `step`-th are kept
  std::size_t appended = 0;         ///< rows of the run, so far
  std::vector<BodySum> worst = {};  ///< see worst_sums; of rows that were appended

  /// One that keeps few enough of the rows of a run.
  static BodyLoadTable of(std::size_t run_rows) {
    const std::size_t step = (run_rows + kMaxLoadRows - 1) / kMaxLoadRows;
    return {{}, {}, step > 1 ? step : 1};
  }

  /// Those of the run, of which rows() are kept.
  std::size_t run_rows() const { return appended > 0 ? appended : rows(); }
  std::size_t rows() const { return loads.empty() ? 0 : values.size() / loads.size(); }
  const Row& at(std::size_t row, std::size_t load) const {
    return values[row * loads.size() + load];
  }
  /// Adds a row of the run. @throws ComputationError where it has not the loads of the first one
  void append(const std::vector<BodyLoad>& row);
  /// The loads of a row that is kept with their names.
  std::vector<BodyLoad> row(std::size_t row) const;
};

/// One for each body, in the order in which bodies first appear.
/// Of a body whose loads are all 0 they are 0.
std::vector<BodySum> sums_of(const std::vector<BodyLoad>& loads);

/// Of every body the largest of force_over_sum and of moment_over_sum in any row of the run, also
/// in rows that are not kept; force and moment are those of the row whose force_over_sum,
/// moment_over_sum it is.
std::vector<BodySum> worst_sums(const BodyLoadTable& table);

/// Whether two loads are the same but for their numbers.
bool same_load(const BodyLoad& a, const BodyLoad& b);

}  // namespace bentaxis
