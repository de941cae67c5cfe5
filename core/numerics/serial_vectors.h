// SUNDIALS' serial vectors and its dense solver with loops that the compiler can vectorize: those
// of the packaged library are compiled one number at a time and read a matrix again behind every
// store. Every number is what the library's own function gives, to the last bit: the same
// operations in the same order. Internal.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_linearsolver.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bentaxis::numerics::serial {

// z may be x or y: an element then depends on itself alone.
#ifdef __clang__
#define BENTAXIS_EVERY_ELEMENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define BENTAXIS_EVERY_ELEMENT _Pragma("GCC ivdep")
#endif

inline void linear_sum(realtype a, N_Vector x, realtype b, N_Vector y, N_Vector z) {
  const sunindextype size = NV_LENGTH_S(x);
  const realtype *xs = NV_DATA_S(x), *ys = NV_DATA_S(y);
  realtype* zs = NV_DATA_S(z);
  // The library's own cases but for those that differ in nothing: factors of 1 are exact.
  if (a == 1 && b == 1) {
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = 0; i < size; ++i) zs[i] = xs[i] + ys[i];
  } else if (b == 1) {
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = 0; i < size; ++i) zs[i] = a * xs[i] + ys[i];
  } else if (a == 1) {
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = 0; i < size; ++i) zs[i] = xs[i] + b * ys[i];
  } else if (a == b) {
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = 0; i < size; ++i) zs[i] = a * (xs[i] + ys[i]);
  } else if (a == -b) {
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = 0; i < size; ++i) zs[i] = a * (xs[i] - ys[i]);
  } else {
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = 0; i < size; ++i) zs[i] = a * xs[i] + b * ys[i];
  }
}

inline void scale(realtype c, N_Vector x, N_Vector z) {
  const sunindextype size = NV_LENGTH_S(x);
  const realtype* xs = NV_DATA_S(x);
  realtype* zs = NV_DATA_S(z);
  BENTAXIS_EVERY_ELEMENT
  for (sunindextype i = 0; i < size; ++i) zs[i] = c * xs[i];
}

inline realtype weighted_norm(N_Vector x, N_Vector w) {
  const sunindextype size = NV_LENGTH_S(x);
  const realtype *xs = NV_DATA_S(x), *ws = NV_DATA_S(w);
  realtype sum = 0;
  for (sunindextype i = 0; i < size; ++i) {
    const realtype product = xs[i] * ws[i];
    sum += product * product;
  }
  sum /= static_cast<realtype>(size);
  return sum <= 0 ? 0 : std::sqrt(sum);
}

inline int scale_add_multi(int count, realtype* a, N_Vector x, N_Vector* y, N_Vector* z) {
  for (int i = 0; i < count; ++i) linear_sum(a[i], x, 1, y[i], z[i]);
  return 0;
}

inline int linear_combination(int count, realtype* c, N_Vector* x, N_Vector z) {
  scale(c[0], x[0], z);
  for (int i = 1; i < count; ++i) linear_sum(c[i], x[i], 1, z, z);
  return 0;
}

inline void invert(N_Vector x, N_Vector z) {
  const sunindextype size = NV_LENGTH_S(x);
  const realtype* xs = NV_DATA_S(x);
  realtype* zs = NV_DATA_S(z);
  BENTAXIS_EVERY_ELEMENT
  for (sunindextype i = 0; i < size; ++i) zs[i] = 1 / xs[i];
}

inline void absolute(N_Vector x, N_Vector z) {
  const sunindextype size = NV_LENGTH_S(x);
  const realtype* xs = NV_DATA_S(x);
  realtype* zs = NV_DATA_S(z);
  BENTAXIS_EVERY_ELEMENT
  for (sunindextype i = 0; i < size; ++i) zs[i] = std::abs(xs[i]);
}

inline void add_constant(N_Vector x, realtype b, N_Vector z) {
  const sunindextype size = NV_LENGTH_S(x);
  const realtype* xs = NV_DATA_S(x);
  realtype* zs = NV_DATA_S(z);
  BENTAXIS_EVERY_ELEMENT
  for (sunindextype i = 0; i < size; ++i) zs[i] = xs[i] + b;
}

/// Of a vector, and of all that are cloned from it.
inline void use_loops(N_Vector v) {
  N_Vector_Ops ops = v->ops;
  ops->nvlinearsum = linear_sum;
  ops->nvscale = scale;
  ops->nvwrmsnorm = weighted_norm;
  ops->nvscaleaddmulti = scale_add_multi;
  ops->nvlinearcombination = linear_combination;
  ops->nvinv = invert;
  ops->nvabs = absolute;
  ops->nvaddconst = add_constant;
}

/// Solves with the factors that the library's dense solver has left in a matrix.
inline int solve(SUNLinearSolver solver, SUNMatrix matrix, N_Vector x, N_Vector b, realtype) {
  const sunindextype size = SM_ROWS_D(matrix);
  const sunindextype* pivots = static_cast<SUNLinearSolverContent_Dense>(solver->content)->pivots;
  const realtype* column = SM_DATA_D(matrix);
  realtype* xs = NV_DATA_S(x);
  if (x != b) scale(1, b, x);
  for (sunindextype k = 0; k < size; ++k)
    if (pivots[k] != k) std::swap(xs[k], xs[pivots[k]]);
  for (sunindextype k = 0; k < size - 1; ++k, column += size) {
    const realtype at = xs[k];
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = k + 1; i < size; ++i) xs[i] -= column[i] * at;
  }
  for (sunindextype k = size - 1; k > 0; --k, column -= size) {
    const realtype at = xs[k] /= column[k];
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = 0; i < k; ++i) xs[i] -= column[i] * at;
  }
  xs[0] /= column[0];
  return SUNLS_SUCCESS;
}

/// Factors a matrix as the library's dense solver does.
inline int factor(SUNLinearSolver solver, SUNMatrix matrix) {
  const auto content = static_cast<SUNLinearSolverContent_Dense>(solver->content);
  const sunindextype size = SM_ROWS_D(matrix);
  realtype* data = SM_DATA_D(matrix);
  content->last_flag = 0;
  for (sunindextype k = 0; k < size; ++k) {
    realtype* pivot = data + k * size;
    sunindextype largest = k;
    for (sunindextype i = k + 1; i < size; ++i)
      if (std::abs(pivot[i]) > std::abs(pivot[largest])) largest = i;
    content->pivots[k] = largest;
    if (pivot[largest] == 0) {
      content->last_flag = k + 1;
      return SUNLS_LUFACT_FAIL;
    }
    if (largest != k)
      for (sunindextype j = 0; j < size; ++j)
        std::swap(data[j * size + largest], data[j * size + k]);
    const realtype inverse = 1 / pivot[k];
    BENTAXIS_EVERY_ELEMENT
    for (sunindextype i = k + 1; i < size; ++i) pivot[i] *= inverse;
    for (sunindextype j = k + 1; j < size; ++j) {
      realtype* column = data + j * size;
      const realtype at = column[k];
      if (at == 0) continue;
      BENTAXIS_EVERY_ELEMENT
      for (sunindextype i = k + 1; i < size; ++i) column[i] -= at * pivot[i];
    }
  }
  return SUNLS_SUCCESS;
}

/// A c + 1.
inline int scale_add_one(realtype c, SUNMatrix matrix) {
  const sunindextype size = SM_ROWS_D(matrix);
  realtype* data = SM_DATA_D(matrix);
  BENTAXIS_EVERY_ELEMENT
  for (sunindextype i = 0; i < size * size; ++i) data[i] *= c;
  for (sunindextype i = 0; i < size; ++i) data[i * size + i] += 1;
  return SUNMAT_SUCCESS;
}

inline int copy(SUNMatrix from, SUNMatrix to) {
  std::copy_n(SM_DATA_D(from), SM_LDATA_D(from), SM_DATA_D(to));
  return SUNMAT_SUCCESS;
}

/// Of a square matrix, and of all that are cloned from it.
inline void use_loops(SUNMatrix matrix) {
  matrix->ops->scaleaddi = scale_add_one;
  matrix->ops->copy = copy;
}

inline void use_loops(SUNLinearSolver solver) {
  solver->ops->setup = factor;
  solver->ops->solve = solve;
}

#undef BENTAXIS_EVERY_ELEMENT

}  // namespace bentaxis::numerics::serial
