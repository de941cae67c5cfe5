// Points at which designs are evaluated.
#include "bentaxis/designs/points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "bentaxis/pump/error.h"

namespace bentaxis::designs {
namespace {

std::vector<double> at(const Points& points, std::size_t index) {
  std::vector<double> coordinates(points.dimension());
  points.point(index, coordinates);
  return coordinates;
}

// In how many of `parts` equal parts of an axis points lie.
std::size_t parts_met(const Points& points, std::size_t axis, std::size_t first, std::size_t count,
                      std::size_t parts) {
  std::set<std::size_t> met;
  for (std::size_t i = first; i < first + count; ++i)
    met.insert(static_cast<std::size_t>(at(points, i)[axis] * static_cast<double>(parts)));
  return met.size();
}

TEST(Points, GridHasEveryCombinationTheLastAxisFastest) {
  const auto points = grid({{1, 2}, {5}, {10, 20, 30}});
  ASSERT_EQ(points->size(), 6U);
  EXPECT_EQ(at(*points, 0), (std::vector<double>{1, 5, 10}));
  EXPECT_EQ(at(*points, 2), (std::vector<double>{1, 5, 30}));
  EXPECT_EQ(at(*points, 3), (std::vector<double>{2, 5, 10}));
  EXPECT_EQ(grid({})->size(), 1U);  // the case itself
  EXPECT_THROW(grid({{1}, {}}), InputError);
  const std::vector<double> axis(100000);
  EXPECT_THROW(grid({axis, axis, axis, axis}), InputError);
}

// The first points of S. Joe and F. Y. Kuo's program with new-joe-kuo-6.21201, as printed on their
// page for three dimensions (the first is the origin); here half a step of 2^-52 off.
TEST(Points, SobolIsThatOfJoeAndKuo) {
  const double printed[10][3] = {{0, 0, 0},
                                 {0.5, 0.5, 0.5},
                                 {0.75, 0.25, 0.25},
                                 {0.25, 0.75, 0.75},
                                 {0.375, 0.375, 0.625},
                                 {0.875, 0.875, 0.125},
                                 {0.625, 0.125, 0.875},
                                 {0.125, 0.625, 0.375},
                                 {0.1875, 0.3125, 0.9375},
                                 {0.6875, 0.8125, 0.4375}};
  const auto points = sobol(3, 10, 0);
  for (std::size_t i = 0; i < 10; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(at(*points, i)[axis], printed[i][axis] + 0x1p-53) << i << " " << axis;
}

// Of 2^m points any aligned run of 2^k meets each of 2^k parts of every axis once, also shifted.
TEST(Points, SobolFillsEveryAxis) {
  for (const std::uint64_t seed : {0, 1, 7})
    for (const std::size_t axis : {0, 1, 9}) {
      const auto points = sobol(10, 1024, seed);
      EXPECT_EQ(parts_met(*points, axis, 0, 1024, 1024), 1024U);
      EXPECT_EQ(parts_met(*points, axis, 512, 64, 64), 64U);
    }
  EXPECT_NE(at(*sobol(2, 8, 1), 0), at(*sobol(2, 8, 2), 0));
  EXPECT_EQ(at(*sobol(2, 8, 1), 5), at(*sobol(2, 1000, 1), 5));  // a longer one goes on
  EXPECT_THAT([] { sobol(4000, 8, 1); },
              testing::ThrowsMessage<InputError>(testing::HasSubstr("at most")));
}

TEST(Points, LatinHypercubeMeetsEveryPartOnce) {
  for (const std::size_t count : {1, 2, 3, 5, 16, 17, 1000})
    for (const std::size_t axis : {0, 1, 2}) {
      const auto points = latin_hypercube(3, count, 4);
      EXPECT_EQ(parts_met(*points, axis, 0, count, count), count) << count;
    }
  // Axes are permuted apart from each other: correlations as of independent permutations, whose
  // standard deviation is 1 / sqrt(count - 1).
  const auto points = latin_hypercube(3, 1000, 4);
  double product[3] = {};
  for (std::size_t i = 0; i < 1000; ++i) {
    const auto x = at(*points, i);
    const double index = (static_cast<double>(i) + 0.5) / 1000;
    product[0] += (x[0] - 0.5) * (x[1] - 0.5);
    product[1] += (x[1] - 0.5) * (x[2] - 0.5);
    product[2] += (x[0] - 0.5) * (index - 0.5);  // nor do they follow the number
  }
  for (const double p : product) EXPECT_LT(std::abs(p * 12 / 1000), 4 / std::sqrt(999));
}

// Every permutation of three is drawn about as often as any other: of 6000 a sixth each, with a
// standard deviation of 29.
TEST(Points, LatinHypercubeDrawsAllPermutations) {
  std::map<std::vector<int>, int> drawn;
  for (std::uint64_t seed = 0; seed < 6000; ++seed) {
    const auto points = latin_hypercube(1, 3, seed);
    std::vector<int> order;
    for (std::size_t i = 0; i < 3; ++i) order.push_back(static_cast<int>(at(*points, i)[0] * 3));
    ++drawn[order];
  }
  ASSERT_EQ(drawn.size(), 6U);
  for (const auto& [order, times] : drawn) EXPECT_NEAR(times, 1000, 4.5 * 29);
}

// Moments of the uniform distribution within four of their standard deviations, coordinates of a
// point and of its neighbours uncorrelated.
TEST(Points, RandomOnesAreUniformAndIndependent) {
  constexpr std::size_t kCount = 20000;
  const auto points = random(2, kCount, 11);
  double mean = 0, square = 0, pair = 0, neighbours = 0, before = 0.5;
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto x = at(*points, i);
    EXPECT_TRUE(x[0] > 0 && x[0] < 1 && x[1] > 0 && x[1] < 1);
    mean += x[0] / kCount;
    square += (x[0] - 0.5) * (x[0] - 0.5) / kCount;
    pair += (x[0] - 0.5) * (x[1] - 0.5) / kCount;
    neighbours += (x[0] - 0.5) * (before - 0.5) / kCount;
    before = x[0];
  }
  const double root = std::sqrt(double{kCount});
  EXPECT_NEAR(mean, 0.5, 4 * std::sqrt(1.0 / 12) / root);
  EXPECT_NEAR(square, 1.0 / 12, 4 * std::sqrt(1.0 / 180) / root);
  EXPECT_NEAR(pair, 0, 4 / 12.0 / root);
  EXPECT_NEAR(neighbours, 0, 4 / 12.0 / root);
  EXPECT_NE(at(*random(2, 5, 1), 3), at(*random(2, 5, 2), 3));
  EXPECT_THROW(random(2, 0, 1), InputError);
}

}  // namespace
}  // namespace bentaxis::designs
