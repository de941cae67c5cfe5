#include "mapping_frames.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "bentaxis/pump/units.h"

namespace bentaxis::study::mapping {
namespace {

using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
Eigen::Map<const Matrix> matrix(const Axes& axes) {
  return Eigen::Map<const Matrix>(axes[0].data());
}
Axes axes_of(const Matrix& matrix) {
  Axes axes;
  Eigen::Map<Matrix>(axes[0].data()) = matrix;
  return axes;
}

}  // namespace

std::array<Series, 3> in_axes(const std::array<Series, 3>& parts, const Axes& from,
                              const Axes& to) {
  const Matrix cosines = matrix(to) * matrix(from).transpose();
  std::array<Series, 3> out;
  for (int j = 0; j < 3; ++j)
    for (std::size_t row = 0; row < parts[0].size(); ++row)
      out[j].push_back(
          cosines.row(j).dot(Eigen::RowVector3d(parts[0][row], parts[1][row], parts[2][row])));
  return out;
}

const std::vector<Axes>& right_angles() {
  static const std::vector<Axes> all = [] {
    std::vector<Axes> list;
    std::array<std::size_t, 3> order = {0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Axes axes{};
        for (std::size_t j = 0; j < 3; ++j) axes[j][order[j]] = (signs >> j & 1) != 0 ? -1 : 1;
        if (matrix(axes).determinant() > 0) list.push_back(axes);
      }
    } while (std::next_permutation(order.begin(), order.end()));
    return list;
  }();
  return all;
}

double trace_of(const Axes& a, const Axes& b) { return matrix(a).cwiseProduct(matrix(b)).sum(); }

double angle_from_right_angles(const Axes& axes) {
  double cosine = -1;
  for (const Axes& other : right_angles())
    cosine = std::max(cosine, (trace_of(axes, other) - 1) / 2);
  return std::acos(std::min(1.0, cosine)) / kRadPerDegree;
}

std::array<double, 3> euler_angles(const Axes& axes, const std::string& sequence) {
  const auto& z = axes[2];
  std::array<double, 3> angles{};
  if (sequence == "ZXZ")
    angles = {std::atan2(z[0], -z[1]), std::atan2(std::hypot(z[0], z[1]), z[2]), 0};
  else
    angles = {std::atan2(-z[1], z[2]), std::atan2(z[0], std::hypot(z[1], z[2])), 0};
  for (double& angle : angles) angle /= kRadPerDegree;
  // The third one from the axes that the first two leave.
  const Axes before = compare::turned_axes(sequence, angles);
  const auto along = [&](const std::array<double, 3>& axis) {
    return std::inner_product(axis.begin(), axis.end(), axes[0].begin(), 0.0);
  };
  angles[2] = std::atan2(along(before[1]), along(before[0])) / kRadPerDegree;
  return angles;
}

Axes nearest_rotation(const std::vector<Axes>& products, const std::vector<double>& weights) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < products.size(); ++i) sum += weights[i] * matrix(products[i]);
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // A rotation and no reflection: the sign is that of the direction which the vectors show least.
  const double sign = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  return axes_of(svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() *
                 svd.matrixV().transpose());
}

std::function<int(int)> best_numbering(const std::vector<std::pair<int, int>>& votes, int pistons) {
  // Numbered against the rotation: only where enough pistons show it, for of two or three it
  // could be that two were mixed up.
  constexpr std::size_t kShowReversal = 4;
  std::set<int> different;
  for (const auto& [said, looks] : votes) different.insert(said);
  int most = -1, first = 0, direction = 1;
  for (const int d : {1, -1})
    for (int m = 0; m < pistons; ++m) {
      int count = 0;
      for (const auto& [said, looks] : votes)
        count += (d * (said - 1) + m + pistons) % pistons + 1 == looks;
      if (count > most && (d > 0 || different.size() >= kShowReversal)) {
        most = count;
        first = m;
        direction = d;
      }
    }
  return [=](int said) { return (direction * (said - 1) + first + pistons) % pistons + 1; };
}

}  // namespace bentaxis::study::mapping
