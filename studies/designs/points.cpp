#include "bentaxis/designs/points.h"

#include <algorithm>
#include <bit>
#include <boost/random/sobol.hpp>
#include <limits>
#include <string>
#include <utility>

#include "bentaxis/pump/error.h"
#include "random_bits.h"

namespace bentaxis::designs {
namespace {

class Grid final : public Points {
 public:
  explicit Grid(std::vector<std::vector<double>> axes) : axes_(std::move(axes)) {
    for (const auto& axis : axes_) {
      if (axis.empty()) throw InputError("a grid with an axis of no values");
      if (size_ > std::numeric_limits<std::size_t>::max() / axis.size())
        throw InputError("a grid of more points than can be counted");
      size_ *= axis.size();
    }
  }
  std::size_t size() const override { return size_; }
  std::size_t dimension() const override { return axes_.size(); }
  void point(std::size_t index, std::span<double> coordinates) const override {
    for (std::size_t i = axes_.size(); i-- > 0;) {
      coordinates[i] = axes_[i][index % axes_[i].size()];
      index /= axes_[i].size();
    }
  }

 private:
  std::vector<std::vector<double>> axes_;
  std::size_t size_ = 1;
};

// Points of the cube.
class Cube : public Points {
 public:
  Cube(std::size_t dimension, std::size_t count, std::uint64_t seed)
      : seed_(seed), dimension_(dimension), count_(count) {
    if (dimension == 0 || count == 0)
      throw InputError(std::to_string(count) + " points of " + std::to_string(dimension) +
                       " coordinates: both must be at least 1");
  }
  std::size_t size() const override { return count_; }
  std::size_t dimension() const override { return dimension_; }

 protected:
  const std::uint64_t seed_;

 private:
  std::size_t dimension_, count_;
};

class Random final : public Cube {
 public:
  using Cube::Cube;
  void point(std::size_t index, std::span<double> coordinates) const override {
    for (std::size_t i = 0; i < dimension(); ++i)
      coordinates[i] = random_share(seed_, index * dimension() + i);
  }
};

class LatinHypercube final : public Cube {
 public:
  LatinHypercube(std::size_t dimension, std::size_t count, std::uint64_t seed)
      : Cube(dimension, count, seed),
        half_((static_cast<int>(std::bit_width(count - 1)) + 1) / 2) {}

  void point(std::size_t index, std::span<double> coordinates) const override {
    const auto parts = static_cast<double>(size());
    for (std::size_t i = 0; i < dimension(); ++i) {
      const std::uint64_t stream = random_bits(seed_, i);
      const double place = static_cast<double>(part(index, stream)) + random_share(stream, index);
      // In the last part rounding could reach 1.
      coordinates[i] = std::min(place / parts, 1 - 0x1p-53);
    }
  }

 private:
  // A permutation of 0 .. size() - 1 that needs no table: a Feistel network permutes the next power
  // of four and is repeated until it comes back into the range (J. Black, P. Rogaway, Ciphers with
  // arbitrary finite domains, CT-RSA 2002).
  std::uint64_t part(std::uint64_t index, std::uint64_t stream) const {
    constexpr std::uint64_t kRounds = 8;
    const std::uint64_t mask = (std::uint64_t{1} << half_) - 1;
    do {
      std::uint64_t left = index >> half_, right = index & mask;
      for (std::uint64_t round = 0; round < kRounds; ++round) {
        left ^= random_bits(stream + round, right) & mask;
        std::swap(left, right);
      }
      index = left << half_ | right;
    } while (index >= size());
    return index;
  }

  int half_;  // bits of each half of the network
};

class Sobol final : public Cube {
 public:
  Sobol(std::size_t dimension, std::size_t count, std::uint64_t seed)
      : Cube(dimension, count, seed),
        bits_(static_cast<std::size_t>(std::bit_width(count - 1))),
        directions_(bits_ * dimension),
        shift_(dimension) {
    constexpr std::size_t kMaxDimensions = boost::random::default_sobol_table::max_dimension;
    if (dimension > kMaxDimensions || bits_ > kBits)
      throw InputError("a Sobol sequence of " + std::to_string(dimension) + " coordinates and " +
                       std::to_string(count) + " points: at most " +
                       std::to_string(kMaxDimensions) + " and 2^" + std::to_string(kBits));
    // The engine walks in the order of Gray's code: vector 2^(j + 1) - 1, of which it has left out
    // number 0, is direction j alone.
    boost::random::sobol_engine<std::uint64_t, kBits> engine(dimension);
    for (std::size_t j = 0; j < bits_; ++j) {
      engine.seed((std::uint64_t{2} << j) - 2);
      for (std::size_t i = 0; i < dimension; ++i) directions_[j * dimension + i] = engine();
    }
    if (seed != 0)
      for (std::size_t i = 0; i < dimension; ++i) shift_[i] = random_bits(seed, i) >> (64 - kBits);
  }

  void point(std::size_t index, std::span<double> coordinates) const override {
    const std::uint64_t code = index ^ (index >> 1);
    for (std::size_t i = 0; i < dimension(); ++i) {
      std::uint64_t bits = shift_[i];
      for (std::size_t j = 0; j < bits_; ++j)
        if ((code >> j & 1) != 0) bits ^= directions_[j * dimension() + i];
      coordinates[i] = share_of(bits);
    }
  }

 private:
  static constexpr unsigned kBits = 52;    // as many as share_of() takes
  std::size_t bits_;                       // that `count` points need
  std::vector<std::uint64_t> directions_;  // bits_ x dimension
  std::vector<std::uint64_t> shift_;
};

}  // namespace

std::unique_ptr<Points> grid(std::vector<std::vector<double>> axes) {
  return std::make_unique<Grid>(std::move(axes));
}
std::unique_ptr<Points> sobol(std::size_t dimension, std::size_t count, std::uint64_t seed) {
  return std::make_unique<Sobol>(dimension, count, seed);
}
std::unique_ptr<Points> latin_hypercube(std::size_t dimension, std::size_t count,
                                        std::uint64_t seed) {
  return std::make_unique<LatinHypercube>(dimension, count, seed);
}
std::unique_ptr<Points> random(std::size_t dimension, std::size_t count, std::uint64_t seed) {
  return std::make_unique<Random>(dimension, count, seed);
}

}  // namespace bentaxis::designs
