// A foreign record for guess_mapping(): what its names say, which of its columns can be the angle,
// and its curves over the turn.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/reference.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/pump/periodic_spline.h"
#include "bentaxis/results/channels.h"
#include "mapping_curves.h"

namespace bentaxis::study::mapping {

using compare::AngleMap;

// ---- Names

std::vector<std::string> words_of(const std::string& name);
// Places in a name that may be the letter of an axis: a word's last letter but for one digit behind
// it ("FX", "x2", "Force_y"), or columns 1 to 3 of a matrix. The name with '?' there, and the axis.
std::vector<std::pair<std::string, int>> axis_readings(const std::string& name);
// The number of a piston that a name has; 0 = none. Never that of an axis.
int piston_in(const std::string& name, int pistons);
bool is_quantity(const std::vector<std::string>& words, const std::string& quantity);
// Whether the words of a column's name are those of a channel: quantity, piston, axis.
bool named(const std::vector<std::string>& words, const Channel& channel);
// Whether a column of this unit ("" = none said) may be of the channels' unit.
bool may_have(const std::string& unit, const std::string& channel_unit);

// ---- Columns

// Half a unit of the last of so many significant digits of a number.
double half_of_last_digit(double number, int digits);
// Whether a column makes a turn; completes where the turn begins and the rounding.
bool is_record(const ForeignTable& table, std::size_t column, double degrees_per_second,
               AngleMap& map);
// Columns that can be the angle, with their units; only those of the best rank.
std::vector<AngleMap> angle_choices(const ForeignTable& table, double degrees_per_second);
// Whether a column rises or falls all along the record, which no periodic curve does.
bool runs_along(const ForeignTable& table, std::size_t column);

struct Group {
  std::string key;
  std::array<std::optional<std::size_t>, 3> columns;
  std::string unit;
  std::size_t count() const;
};
// Whether a column is the length of a vector of the file.
bool is_length(const ForeignTable& table, std::size_t column, const Group& group);

struct Grouping {
  std::vector<Group> groups;
  std::vector<std::size_t> singles;
  std::vector<std::pair<std::string, std::string>> ignored;  // columns, and why
};
// Vectors and single columns of a file, of those columns that have a curve.
Grouping find_groups(const ForeignTable& table, const std::vector<bool>& has_curve,
                     const std::vector<bool>& constant);

// ---- The record over one choice of its angle

// How the record's angle becomes the shaft's: theta = sign x angle + phase.
struct Turning {
  double sign = 1, phase = 0;
};

class Record {
 public:
  Record(const ForeignTable& table, double degrees_per_second)
      : table_(table), degrees_per_second_(degrees_per_second) {}

  std::vector<AngleMap> angle_choices() const {
    return mapping::angle_choices(table_, degrees_per_second_);
  }
  // Splines through the columns over their own angle.
  void take_turn(const AngleMap& map);
  compare::Turn turn_of(const AngleMap& map) const;

  const ForeignTable& table() const { return table_; }
  bool is_over_time() const { return over_time_; }
  const std::vector<Group>& groups() const { return found_.groups; }
  const std::vector<std::size_t>& singles() const { return found_.singles; }
  const std::vector<std::pair<std::string, std::string>>& ignored() const { return found_.ignored; }
  // Of these, what must be decided.
  const std::vector<std::string>& undecided() const { return undecided_; }
  bool has_whole_vector() const;
  bool is_constant(std::size_t column) const { return constant_[column]; }

  std::size_t column_of(const std::string& name) const;
  std::string unit_of(std::size_t column) const { return known_unit(table_.units[column]); }
  // Of a column's heading, where it is another one than the values fit; "" = none.
  std::string contradicting_unit(std::size_t column, const std::string& unit) const;
  // A column at equal steps of the shaft's turn.
  Series sampled(std::size_t column, const Turning& turning, std::size_t count) const;

 private:
  // Why a column over a turn has no curve to compare; "" where it has.
  std::string defect_of(std::size_t column, const Series& values);

  const ForeignTable& table_;
  double degrees_per_second_;
  bool over_time_ = false;
  std::vector<std::optional<PeriodicSpline>> splines_;
  std::vector<bool> constant_;
  Grouping found_;
  std::vector<std::string> undecided_;
};

}  // namespace bentaxis::study::mapping
