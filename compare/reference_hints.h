// What a curve that differs from a reference looks like.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bentaxis/compare/comparison.h"
#include "bentaxis/pump/periodic_spline.h"

namespace bentaxis::compare {

// Tried on some of the angles that are compared.
class Hints {
 public:
  Hints(const ResultTable& reference, const ResultTable& result);
  std::string of(const ChannelComparison& channel) const;

 private:
  std::vector<double> values_of(const ResultTable& table, std::size_t column) const;
  // The reference moved by `shift` degrees towards larger angles, against ours.
  double shifted_rms(std::size_t column, const std::vector<double>& ours, double shift) const;
  double best_shift(std::size_t column, const std::vector<double>& ours) const;
  const PeriodicSpline& spline(std::size_t column) const;

  const ResultTable& reference_;
  const ResultTable& result_;
  std::vector<std::size_t> rows_;
  mutable std::map<std::size_t, PeriodicSpline> splines_;
};

}  // namespace bentaxis::compare
