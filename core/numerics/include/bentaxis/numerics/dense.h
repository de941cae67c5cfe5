// Linear algebra of full matrices whose size is known at run time. Eigen's, compiled here once: its
// decompositions take the compiler seconds in every source that uses one.
#pragma once

#include <Eigen/Core>
#include <memory>

namespace bentaxis::numerics {

/// A square matrix, factored once for any number of right sides: Gaussian elimination with partial
/// pivoting. Solutions of a singular matrix are not finite, of one nearly so they are huge.
class LinearSolver {
 public:
  LinearSolver() = default;  ///< of no matrix: solve() must not be called
  explicit LinearSolver(const Eigen::MatrixXd& matrix);

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;

 private:
  struct Factors;
  std::shared_ptr<const Factors> factors_;
};

/// A symmetric matrix without negative eigenvalues, factored as L D L^T.
class SymmetricSolver {
 public:
  explicit SymmetricSolver(const Eigen::MatrixXd& matrix);

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;

 private:
  struct Factors;
  std::shared_ptr<const Factors> factors_;
};

/// Least squares of A x = b by orthogonal transformations with exchange of columns.
class LeastSquaresSolver {
 public:
  explicit LeastSquaresSolver(const Eigen::MatrixXd& matrix);
  /// @param threshold  what is smaller than this share of the largest pivot counts as 0
  LeastSquaresSolver(const Eigen::MatrixXd& matrix, double threshold);

  Eigen::Index rank() const;
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  /// rank() orthonormal columns with the span of the matrix's.
  Eigen::MatrixXd span() const;
  /// H with H H^T = (A^T A)^-1, for a matrix of full rank.
  Eigen::MatrixXd inverse_root() const;

 private:
  struct Factors;
  std::shared_ptr<const Factors> factors_;
};

/// Least squares of any rank: of all solutions the shortest.
class ShortestSolver {
 public:
  /// @param threshold  what is smaller than this share of the largest pivot counts as 0
  ShortestSolver(const Eigen::MatrixXd& matrix, double threshold);

  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  Eigen::MatrixXd pseudo_inverse() const;

 private:
  struct Factors;
  std::shared_ptr<const Factors> factors_;
};

/// Eigenvalues of a square matrix, in no order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// Eigenvalues of a symmetric matrix, of which the lower triangle is read, in ascending order.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

struct SymmetricEigen {
  Eigen::VectorXd values;   ///< in ascending order
  Eigen::MatrixXd vectors;  ///< of length 1, a column each
};
/// With eigenvectors.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

}  // namespace bentaxis::numerics
