// Our loops in place of SUNDIALS' own give its numbers, to the last bit.
#include "serial_vectors.h"

#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <random>
#include <vector>

namespace bentaxis::numerics::serial {
namespace {

class Loops : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { ASSERT_EQ(SUNContext_Create(nullptr, &context_), 0); }
  void TearDown() override {
    for (N_Vector v : vectors_) N_VDestroy(v);
    SUNContext_Free(&context_);
  }

  // A vector of random numbers: equal ones in the same order for the library and for us.
  N_Vector vector(unsigned seed, bool ours) {
    N_Vector v = N_VNew_Serial(GetParam(), context_);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < GetParam(); ++i) NV_Ith_S(v, i) = number(random);
    if (ours) use_loops(v);
    vectors_.push_back(v);
    return v;
  }
  std::vector<double> values(N_Vector v) const { return {NV_DATA_S(v), NV_DATA_S(v) + GetParam()}; }

  SUNContext context_ = nullptr;
  std::vector<N_Vector> vectors_;
};

TEST_P(Loops, VectorsAreThoseOfTheLibrary) {
  const double factors[] = {1, -1, 2, 0.3, -0.3, 7.1};
  std::vector<double> result[2];
  for (const bool ours : {false, true}) {
    const auto keep = [&](N_Vector v) {
      for (const double value : values(v)) result[ours].push_back(value);
    };
    for (const double a : factors)
      for (const double b : factors)
        for (int place = 0; place < 3; ++place) {  // the result elsewhere, in x, in y
          N_Vector x = vector(1, ours), y = vector(2, ours), z = vector(3, ours);
          N_Vector to = place == 0 ? z : place == 1 ? x : y;
          N_VLinearSum(a, x, b, y, to);
          keep(to);
        }
    for (const double c : factors) {
      N_Vector x = vector(4, ours), z = vector(5, ours);
      N_VScale(c, x, z);
      keep(z);
      N_VAddConst(x, c, x);
      keep(x);
      N_VInv(x, z);
      keep(z);
      N_VAbs(x, z);
      keep(z);
      result[ours].push_back(N_VWrmsNorm(x, z));
    }
    double sizes[] = {0.2, 1, -3.5};
    N_Vector from[] = {vector(6, ours), vector(7, ours), vector(8, ours)};
    N_Vector to = vector(9, ours);
    N_VLinearCombination(3, sizes, from, to);
    keep(to);
    N_Vector more[] = {vector(10, ours), vector(11, ours), vector(12, ours)};
    N_VScaleAddMulti(3, sizes, to, from, more);
    for (N_Vector v : more) keep(v);
  }
  EXPECT_EQ(result[0], result[1]);
}

TEST_P(Loops, SolutionsAreThoseOfTheLibrary) {
  const int size = GetParam();
  std::vector<double> result[2];
  for (const bool ours : {false, true}) {
    SUNMatrix matrix = SUNDenseMatrix(size, size, context_);
    std::mt19937 random(13);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < size * size; ++i) SM_DATA_D(matrix)[i] = i % 5 == 3 ? 0 : number(random);
    N_Vector x = vector(14, ours), b = vector(15, ours);
    SUNLinearSolver solver = SUNLinSol_Dense(x, matrix, context_);
    if (ours) {
      use_loops(matrix);
      use_loops(solver);
    }
    ASSERT_EQ(SUNMatScaleAddI(-0.7, matrix), 0);
    SUNMatrix other = SUNMatClone(matrix);
    ASSERT_EQ(SUNMatCopy(matrix, other), 0);
    ASSERT_EQ(SUNLinSolSetup(solver, other), 0);
    ASSERT_EQ(SUNLinSolSolve(solver, other, x, b, 0), 0);
    result[ours] = values(x);
    result[ours].insert(result[ours].end(), SM_DATA_D(other), SM_DATA_D(other) + size * size);
    // A matrix without an inverse is told by both, at the same column.
    for (int i = 0; i < size; ++i) SM_ELEMENT_D(matrix, i, size - 1) = 0;
    EXPECT_GT(SUNLinSolSetup(solver, matrix), 0);
    result[ours].push_back(static_cast<double>(SUNLinSolLastFlag(solver)));
    SUNLinSolFree(solver);
    SUNMatDestroy(other);
    SUNMatDestroy(matrix);
  }
  EXPECT_EQ(result[0], result[1]);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Loops, testing::Values(1, 2, 7, 20, 33));

}  // namespace
}  // namespace bentaxis::numerics::serial
