// Points at which designs are evaluated: every point by its number alone, so that any block of them
// can be computed anywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace bentaxis::designs {

/// Points in the unit cube or of lists of values. Immutable.
class Points {
 public:
  virtual ~Points() = default;
  virtual std::size_t size() const = 0;
  virtual std::size_t dimension() const = 0;
  /// Point `index` < size(). Of cubes every coordinate is in (0, 1).
  virtual void point(std::size_t index, std::span<double> coordinates) const = 0;
};

/// Every combination of the values of each axis, the last axis fastest.
std::unique_ptr<Points> grid(std::vector<std::vector<double>> axes);
/// Sobol's sequence after Joe & Kuo with a digital shift drawn from `seed`; `seed` 0: none, and
/// points move off 0 by half a step.
std::unique_ptr<Points> sobol(std::size_t dimension, std::size_t count, std::uint64_t seed);
/// Each axis cut in `count` equal parts, one point in each.
std::unique_ptr<Points> latin_hypercube(std::size_t dimension, std::size_t count,
                                        std::uint64_t seed);
/// Independent uniform points.
std::unique_ptr<Points> random(std::size_t dimension, std::size_t count, std::uint64_t seed);

}  // namespace bentaxis::designs
