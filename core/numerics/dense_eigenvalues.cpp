#include <Eigen/Eigenvalues>

#include "bentaxis/numerics/dense.h"

namespace bentaxis::numerics {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) { return matrix.eigenvalues(); }

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace bentaxis::numerics
