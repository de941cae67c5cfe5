#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "bentaxis/numerics/dense.h"

namespace bentaxis::numerics {

struct LinearSolver::Factors {
  Eigen::PartialPivLU<Eigen::MatrixXd> lu;
};

LinearSolver::LinearSolver(const Eigen::MatrixXd& matrix)
    : factors_(std::make_shared<Factors>(Factors{matrix.partialPivLu()})) {}

Eigen::VectorXd LinearSolver::solve(const Eigen::VectorXd& right) const {
  return factors_->lu.solve(right);
}
Eigen::MatrixXd LinearSolver::solve(const Eigen::MatrixXd& right) const {
  return factors_->lu.solve(right);
}

struct SymmetricSolver::Factors {
  Eigen::LDLT<Eigen::MatrixXd> ldlt;
};

SymmetricSolver::SymmetricSolver(const Eigen::MatrixXd& matrix)
    : factors_(std::make_shared<Factors>(Factors{matrix.ldlt()})) {}

Eigen::VectorXd SymmetricSolver::solve(const Eigen::VectorXd& right) const {
  return factors_->ldlt.solve(right);
}

}  // namespace bentaxis::numerics
