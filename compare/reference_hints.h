// What a curve that differs from a reference looks like.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/compare/comparison.h"

namespace bentaxis::compare {

// Tried on some of the angles that are compared.
class Hints {
 public:
  Hints(const ResultTable& reference, const ResultTable& result);
  std::string of(const ChannelComparison& channel) const;

 private:
  // Of the reference towards larger angles, and what it leaves.
  struct Shift {
    double deg = 0, rms = 0;
  };
  std::vector<double> values_of(const ResultTable& table, std::size_t column) const;
  // By how many degrees a curve of the result may be moved so that its points cannot tell: half the
  // pitch of the pistons, the pitch, or a whole turn.
  double period_of(const Channel& channel) const;
  Shift best_shift(std::size_t column, const std::vector<double>& ours, double period) const;

  const ResultTable& reference_;
  const ResultTable& result_;
  std::vector<std::size_t> rows_;
};

}  // namespace bentaxis::compare
