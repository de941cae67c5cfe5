#include <Eigen/LU>
#include <Eigen/QR>

#include "bentaxis/numerics/dense.h"

namespace bentaxis::numerics {

using Eigen::MatrixXd, Eigen::VectorXd;

struct LeastSquaresSolver::Factors {
  Eigen::ColPivHouseholderQR<MatrixXd> qr;
};

LeastSquaresSolver::LeastSquaresSolver(const MatrixXd& matrix)
    : factors_(std::make_shared<Factors>(Factors{matrix.colPivHouseholderQr()})) {}

LeastSquaresSolver::LeastSquaresSolver(const MatrixXd& matrix, double threshold) {
  auto factors = std::make_shared<Factors>();
  factors->qr.setThreshold(threshold);
  factors->qr.compute(matrix);
  factors_ = std::move(factors);
}

Eigen::Index LeastSquaresSolver::rank() const { return factors_->qr.rank(); }

VectorXd LeastSquaresSolver::solve(const VectorXd& right) const {
  return factors_->qr.solve(right);
}

MatrixXd LeastSquaresSolver::span() const {
  const auto& qr = factors_->qr;
  return qr.householderQ() * MatrixXd::Identity(qr.rows(), qr.rank());
}

MatrixXd LeastSquaresSolver::inverse_root() const {
  const auto& qr = factors_->qr;
  const MatrixXd r =
      qr.matrixR().topLeftCorner(qr.cols(), qr.cols()).triangularView<Eigen::Upper>();
  return qr.colsPermutation() * r.inverse();
}

struct ShortestSolver::Factors {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> qr;
};

ShortestSolver::ShortestSolver(const MatrixXd& matrix, double threshold) {
  auto factors = std::make_shared<Factors>();
  factors->qr.setThreshold(threshold);
  factors->qr.compute(matrix);
  factors_ = std::move(factors);
}

VectorXd ShortestSolver::solve(const VectorXd& right) const { return factors_->qr.solve(right); }
MatrixXd ShortestSolver::pseudo_inverse() const { return factors_->qr.pseudoInverse(); }

}  // namespace bentaxis::numerics
