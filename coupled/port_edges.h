// Between which edges of the ports the block stands. Internal.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "bentaxis/results/instant.h"

namespace bentaxis::coupled {

/// Edges of a turn go on over any number of turns. Without edges the interval is everywhere.
class PortEdges {
 public:
  explicit PortEdges(std::vector<double> edges_deg) : edges_deg_(std::move(edges_deg)) {}

  bool none() const { return edges_deg_.empty(); }
  double from() const { return from_; }  ///< rad, the edge below
  double to() const { return to_; }      ///< and above
  /// The interval in which the block stands, or which it enters. Where it stands still on an edge,
  /// the one above.
  void find(const AxisMotion& block);
  /// The next one upwards (+1) or downwards (-1).
  void pass(int side);
  /// Whether an angle is beyond either end by more than what an event is placed by.
  bool left_by(double angle) const { return angle > to_ + kOutside || angle < from_ - kOutside; }

 private:
  static constexpr double kOutside = 1e-9;  // rad
  double edge(std::ptrdiff_t index) const;
  void set();

  std::vector<double> edges_deg_;
  std::ptrdiff_t edge_ = 0;  // that ends the interval, counted over turns
  double from_ = -1e300, to_ = 1e300;
};

}  // namespace bentaxis::coupled
