// What is asked first of a transfer other than the gear over a turn at constant speed: how the
// block moves against the shaft, which piston carries when, and the largest wall force or side
// couple. docs/transfer.md.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/pump/number.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::study {

/// Takes a turn row by row, so that a run that is not kept can be summarised too. Of a gear it has
/// nothing to say.
class TransferSummary {
 public:
  /// Smallest and largest value of a number over the turn.
  struct Range {
    double low = not_computed(), high = not_computed();
    double low_deg = 0, high_deg = 0;  ///< angle of the shaft there
    void add(double value, double theta_deg);
  };
  /// Largest size of a vector.
  struct Peak {
    double value = not_computed();
    double theta_deg = 0;
    int piston = 0;  ///< from 1; 0: of no piston
  };
  /// Where a piston carries, angles of the shaft. It may pass 360 deg.
  struct Sector {
    double from_deg = 0, to_deg = 0;
  };

  /// @param channels  of the rows to come
  TransferSummary(const PumpParameters& pump, const std::vector<Channel>& channels);
  TransferSummary(const PumpParameters& pump, const ResultTable& table);
  void add(double theta_deg, const double* values);

  const Range& lag() const { return lag_; }      ///< theta - psi, deg; joints and pistons
  const Range& speed() const { return speed_; }  ///< of the block, rpm; universal joint
  /// Largest less smallest speed of the block over their mean value, %.
  double speed_ripple() const;
  const Peak& couple_on_block() const { return couple_on_block_; }  ///< across z2, Nm; joints
  const Peak& couple_on_shaft() const { return couple_on_shaft_; }  ///< across z1, Nm; joints
  const Peak& side_force() const { return side_force_; }  ///< at O2, N; double universal joint
  const Peak& wall() const { return wall_; }              ///< largest wall force, N; pistons
  /// Angle psi_k of its bore at which a piston is at the end of its stroke, deg, over all pistons:
  /// the chamber is smallest near 0 and largest near 180 deg.
  Range inner_dead_centre() const;
  Range outer_dead_centre() const;
  /// How often another piston comes to carry most, in the turn.
  std::size_t hand_overs() const;
  /// Rows at which no wall pushes.
  std::size_t rows_without_contact() const { return loose_rows_; }
  /// Most walls that push at a time.
  int most_walls() const { return most_walls_; }
  /// Where piston 1 carries most.
  std::vector<Sector> sectors_of_first() const;

  /// All of it in sentences; none of a gear.
  std::vector<std::string> answers() const;

 private:
  struct Row {
    double theta_deg = 0;
    std::vector<double> psi_deg, z;  // of each bore
    int carrier = -1;
  };
  struct DeadCentres {
    Range inner, outer;
    void add(const Row& before, const Row& here, const Row& after);
  };
  std::size_t place(const std::vector<Channel>& channels, std::size_t column) const;
  bool is_whole_turn() const;
  DeadCentres dead_centres() const;

  PumpParameters pump_;
  // Places of columns; past the end: there is none.
  std::size_t missing_;
  std::size_t lag_column_, psi_column_, speed_column_;
  std::array<std::size_t, 3> couple_columns_, force_columns_;
  std::vector<std::array<std::size_t, 2>> wall_columns_;
  std::vector<std::size_t> z_columns_;

  Range lag_, speed_;
  double speed_sum_ = 0;
  Peak couple_on_block_, couple_on_shaft_, side_force_, wall_;
  std::size_t rows_ = 0, loose_rows_ = 0, hand_overs_ = 0;
  int most_walls_ = 0, last_carrier_ = -1, first_carrier_ = -1;
  std::vector<Sector> sectors_;
  Row first_, second_, before_, here_;
  DeadCentres centres_;
};

/// The play of a block that pistons carry over a turn, in a sentence; "" of other transfers, and
/// where it has none.
std::string free_play_answer(const PumpParameters& pump);

}  // namespace bentaxis::study
