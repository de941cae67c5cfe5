// Statistics of a curve over a turn with their derivatives. Internal.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bentaxis/designs/sensitivity.h"

namespace bentaxis::designs {

// Samples this near to the largest, of the output's scale, attain it as well.
inline constexpr double kTie = 1e-12;

// The largest of some values, with its derivative: on either side that of whichever of those that
// attain it then grows most.
class LargestRate {
 public:
  explicit LargestRate(std::size_t directions) : least_(directions), most_(directions) {}

  template <class Rate>
  void add(double value, double tie, const Rate& rate) {
    if (value < largest_ - tie) return;
    const bool alone = value > largest_ + tie;
    for (std::size_t d = 0; d < least_.size(); ++d) {
      least_[d] = alone ? rate(d) : std::min(least_[d], rate(d));
      most_[d] = alone ? rate(d) : std::max(most_[d], rate(d));
    }
    largest_ = std::max(largest_, value);
  }
  // The mean of both sides, and by how much each differs from it.
  Derivative rate(std::size_t d) const {
    return {(least_[d] + most_[d]) / 2, (most_[d] - least_[d]) / 2};
  }

 private:
  double largest_ = -std::numeric_limits<double>::infinity();
  std::vector<double> least_, most_;  // one per direction
};

// Statistics of one output with their derivatives, sample by sample.
class StatisticRates {
 public:
  StatisticRates(const Output& output, double scale, std::size_t directions)
      : output_(output),
        tie_(kTie * scale),
        sum_(directions),
        squares_(directions),
        kinks_(directions),
        slopes_(directions),
        low_(directions),
        high_(directions),
        peak_(directions) {}

  // `derivatives` as of DerivativeModel, of `reactions` each.
  void add(const std::vector<double>& values, const std::vector<double>& derivatives,
           std::size_t reactions) {
    double squares = 0;
    for (const std::size_t c : output_.columns) squares += values[c] * values[c];
    const bool vector = output_.columns.size() > 1;
    const double value = vector ? std::sqrt(squares) : values[output_.columns.front()];
    const auto rate = [&](std::size_t d) {
      const double* const row = &derivatives[d * reactions];
      if (!vector) return row[output_.columns.front()];
      double product = 0;
      for (const std::size_t c : output_.columns) product += values[c] * row[c];
      return value > 0 ? product / value : 0;
    };
    // A magnitude that is 0 grows by this on both sides.
    const bool zero = std::abs(value) <= tie_;
    const auto slope = [&](std::size_t d) {
      double square = 0;
      for (const std::size_t c : output_.columns)
        square += derivatives[d * reactions + c] * derivatives[d * reactions + c];
      return std::sqrt(square);
    };
    for (const double side : {-1.0, 1.0}) {
      const auto magnitude = [&](std::size_t d) {
        return zero ? side * slope(d) : (value < 0 ? -1 : 1) * rate(d);
      };
      peak_.add(std::abs(value), tie_, magnitude);
      const auto own = [&](std::size_t d) { return vector ? magnitude(d) : rate(d); };
      high_.add(value, tie_, own);
      low_.add(-value, tie_, [&](std::size_t d) { return -own(d); });
    }
    mean_square_ += value * value;
    ++count_;
    for (std::size_t d = 0; d < sum_.size(); ++d) {
      const double r = vector && zero ? 0 : rate(d);
      sum_[d] += r;
      squares_[d] += value * r;
      if (!zero) continue;
      if (vector) kinks_[d] += slope(d);
      slopes_[d] += slope(d) * slope(d);
    }
    all_zero_ &= zero;
  }

  Derivative derivative(std::size_t d) const {
    const Derivative low = low_.rate(d);
    Derivative high = high_.rate(d);
    switch (output_.statistic) {
      case Statistic::mean:
        return {sum_[d] / count_, kinks_[d] / count_};
      case Statistic::min:
        return {-low.value, low.error};
      case Statistic::max:
        return high;
      case Statistic::peak:
        return peak_.rate(d);
      case Statistic::rms:
        if (all_zero_) return {0, std::sqrt(slopes_[d] / count_)};
        return {squares_[d] / std::sqrt(mean_square_ * count_)};
      case Statistic::range:
        break;
    }
    return {high.value + low.value, high.error + low.error};
  }

 private:
  const Output& output_;
  double tie_, count_ = 0, mean_square_ = 0;
  bool all_zero_ = true;
  std::vector<double> sum_, squares_;   // one per direction
  std::vector<double> kinks_, slopes_;  // of samples where it is 0: sum of slopes, of their squares
  LargestRate low_, high_, peak_;       // of what is lowest the negative
};

}  // namespace bentaxis::designs
