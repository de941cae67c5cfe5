// A matrix stored row by row, as the files of designs keep their Jacobians.
#pragma once

#include <Eigen/Core>

namespace bentaxis::designs {
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
}  // namespace bentaxis::designs
