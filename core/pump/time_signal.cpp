#include "bentaxis/pump/time_signal.h"

#include <algorithm>
#include <functional>

#include "bentaxis/pump/error.h"

namespace bentaxis {

TimeSignal::TimeSignal(const TimeCurve& curve) : time_(curve.time), value_(curve.value) {
  constexpr std::size_t kFewest = 4;
  if (time_.size() < kFewest || time_.size() != value_.size() ||
      std::adjacent_find(time_.begin(), time_.end(), std::greater_equal<>()) != time_.end())
    throw InputError(curve.file.string() + ": needs at least 4 points at increasing times");
  const auto chord = [&](std::size_t i) {
    return (value_[i + 1] - value_[i]) / (time_[i + 1] - time_[i]);
  };
  slope_.push_back(chord(0));
  for (std::size_t i = 1; i + 1 < time_.size(); ++i) {
    // Weighted harmonic mean of the slopes to both sides; level where the points turn back.
    const double before = chord(i - 1), after = chord(i);
    const double span = time_[i + 1] - time_[i - 1];
    const double weight = (span + time_[i + 1] - time_[i]) / (3 * span);
    slope_.push_back(before * after > 0 ? 1 / (weight / before + (1 - weight) / after) : 0);
  }
  slope_.push_back(chord(time_.size() - 2));
  area_.push_back(0);
  for (std::size_t i = 1; i < time_.size(); ++i) {
    const double h = time_[i] - time_[i - 1];
    area_.push_back(area_.back() + h * (value_[i - 1] + value_[i]) / 2 +
                    h * h * (slope_[i - 1] - slope_[i]) / 12);
  }
  offset_ = from_first(0);
}

std::size_t TimeSignal::piece(double time) const {
  const auto after = std::upper_bound(time_.begin(), time_.end() - 1, time);
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - time_.begin() - 1, 0));
}

double TimeSignal::value(double time) const {
  if (time <= time_.front()) return value_.front();
  if (time >= time_.back()) return value_.back();
  const std::size_t i = piece(time);
  const double h = time_[i + 1] - time_[i];
  const double s = (time - time_[i]) / h;
  const double rise = value_[i + 1] - value_[i];
  return value_[i] + rise * s * s * (3 - 2 * s) +
         h * s * (1 - s) * (slope_[i] * (1 - s) - slope_[i + 1] * s);
}

double TimeSignal::slope(double time) const {
  if (time < time_.front() || time >= time_.back()) return 0;
  const std::size_t i = piece(time);
  const double h = time_[i + 1] - time_[i];
  const double s = (time - time_[i]) / h;
  const double rise = value_[i + 1] - value_[i];
  return rise / h * 6 * s * (1 - s) + slope_[i] * (1 - s) * (1 - 3 * s) -
         slope_[i + 1] * s * (2 - 3 * s);
}

// The cubic's own antiderivative, by s from the start of its piece.
double TimeSignal::from_first(double time) const {
  if (time <= time_.front()) return value_.front() * (time - time_.front());
  if (time >= time_.back()) return area_.back() + value_.back() * (time - time_.back());
  const std::size_t i = piece(time);
  const double h = time_[i + 1] - time_[i];
  const double s = (time - time_[i]) / h;
  const double rise = value_[i + 1] - value_[i];
  const double s2 = s * s;
  return area_[i] + h * (value_[i] * s + rise * s2 * s * (1 - s / 2) +
                         h * slope_[i] * s2 * (0.5 - s * (2.0 / 3) + s2 / 4) -
                         h * slope_[i + 1] * s2 * s * (1.0 / 3 - s / 4));
}

double TimeSignal::integral(double time) const { return from_first(time) - offset_; }

}  // namespace bentaxis
