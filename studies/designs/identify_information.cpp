#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "bentaxis/designs/identify.h"
#include "bentaxis/numerics/dense.h"

namespace bentaxis::designs {
namespace {

using Matrix = Eigen::MatrixXd;
using Index = Eigen::Index;

// Shares of a direction that lie in what the data leave open: from them on it counts as open, or
// what is open counts as that of a pair.
constexpr double kOpen = 0.95, kPair = 0.98;
constexpr double kEqual = 0.05;  // weights this near to each other are one

double width_of(const Unknown& u) {
  if (!u.prior) return (u.high - u.low) / std::sqrt(12.0);
  return std::min(u.prior->standard_deviation(), (u.high - u.low) / std::sqrt(12.0));
}

// What of two unknowns is determined where moving them by `first` and `second` together changes
// nothing.
std::string pair_words(const Unknown& a, const Unknown& b, double first, double second, double at_a,
                       double at_b) {
  const std::string names = a.name() + " and " + b.name();
  const auto equal = [](double u, double v) {
    return std::abs(u - v) <= kEqual * std::max(std::abs(u), std::abs(v));
  };
  if (a.variable.unit() == b.variable.unit()) {
    if (equal(first, second)) return names + " are determined only through their difference";
    if (equal(first, -second)) return names + " are determined only through their sum";
  }
  if (at_a != 0 && at_b != 0) {
    const double u = first / at_a, v = second / at_b;
    if (equal(u, v)) return names + " are determined only through their ratio";
    if (equal(u, -v)) return names + " are determined only through their product";
  }
  return fmt::format("{} are determined only together: through {:.3g} x {} {} {:.3g} x {}", names,
                     std::abs(second), a.name(), first * second > 0 ? "-" : "+", std::abs(first),
                     b.name());
}

class Words {
 public:
  Words(const DataModel& model, std::span<const double> x, const std::vector<double>& spread,
        const Matrix& open, const std::vector<std::size_t>& at_bound)
      : unknowns_(model.data().unknowns), x_(x), spread_(spread), open_(open) {
    std::vector<Index> held;
    for (const std::size_t i : at_bound) held.push_back(static_cast<Index>(i));
    open_ = without(open_, held);
  }

  std::vector<std::string> say() {
    const auto n = static_cast<Index>(unknowns_.size());
    for (Index i = 0; i < n; ++i)
      if (open_(i, i) >= kOpen) alone_.push_back(i);
    if (!alone_.empty()) {
      std::string text = "the data do not determine ";
      for (std::size_t k = 0; k < alone_.size(); ++k)
        text += (k == 0 ? "" : ", ") + unknowns_[static_cast<std::size_t>(alone_[k])].name();
      lines_.push_back(text);
    }
    // What is open but for them.
    Matrix rest = without(open_, alone_);
    for (Index i = 0; i < n; ++i)
      for (Index j = i + 1; j < n; ++j) {
        Matrix block(2, 2);
        block << rest(i, i), rest(i, j), rest(j, i), rest(j, j);
        const numerics::SymmetricEigen pair = numerics::symmetric_eigen(block);
        if (pair.values[1] < kPair) continue;
        const Eigen::VectorXd way = pair.vectors.col(1);
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        lines_.push_back(pair_words(unknowns_[a], unknowns_[b], way[0] * spread_[a],
                                    way[1] * spread_[b], x_[a], x_[b]));
        Eigen::VectorXd whole = Eigen::VectorXd::Zero(n);
        whole[i] = way[0];
        whole[j] = way[1];
        rest = deflated(rest, whole);
      }
    say_groups(rest);
    return lines_;
  }

 private:
  // Directions that need three or more unknowns: the simplest one says, eliminating one at a time.
  void say_groups(Matrix rest) {
    const auto n = static_cast<Index>(unknowns_.size());
    for (Index round = 0; round < n; ++round) {
      Index pivot = 0;
      if (rest.diagonal().maxCoeff(&pivot) < 0.5) return;
      Eigen::VectorXd way = rest.col(pivot).normalized();
      std::vector<std::pair<double, Index>> parts;
      for (Index i = 0; i < n; ++i)
        if (std::abs(way[i]) >= 0.15) parts.emplace_back(-std::abs(way[i]), i);
      std::sort(parts.begin(), parts.end());
      std::string text = "nearly unnoticed together:";
      for (std::size_t k = 0; k < parts.size(); ++k) {
        const auto i = static_cast<std::size_t>(parts[k].second);
        text += fmt::format("{} {} {:+.3g} {}", k == 0 ? "" : ",", unknowns_[i].name(),
                            way[parts[k].second] * spread_[i], unknowns_[i].variable.unit());
      }
      lines_.push_back(text);
      rest = deflated(rest, way);
    }
  }
  static Matrix deflated(const Matrix& rest, const Eigen::VectorXd& way) {
    const Eigen::VectorXd inside = rest * way;
    const double share = way.dot(inside);
    return share > 0 ? Matrix(rest - inside * inside.transpose() / share) : rest;
  }
  static Matrix without(const Matrix& open, const std::vector<Index>& alone) {
    Matrix rest = open;
    for (const Index i : alone) {
      rest.row(i).setZero();
      rest.col(i).setZero();
    }
    return rest;
  }

  const std::vector<Unknown>& unknowns_;
  std::span<const double> x_;
  const std::vector<double>& spread_;
  Matrix open_;
  std::vector<Index> alone_;
  std::vector<std::string> lines_;
};

}  // namespace

Information information_of(const DataModel& model, std::span<const double> x,
                           std::span<const double> jacobian,
                           const std::vector<std::size_t>& at_bound) {
  const std::size_t n = model.size();
  Information information;
  for (const Unknown& u : model.data().unknowns) information.spread.push_back(width_of(u));
  std::size_t rows = jacobian.size() / n;
  for (const Unknown& u : model.data().unknowns) rows -= u.prior.has_value();  // no data
  Matrix a(static_cast<Index>(rows), static_cast<Index>(n));
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t i = 0; i < n; ++i)
      a(static_cast<Index>(r), static_cast<Index>(i)) = jacobian[r * n + i] * information.spread[i];
  const numerics::SymmetricEigen eigen = numerics::symmetric_eigen(a.transpose() * a);
  Matrix after = Matrix::Zero(static_cast<Index>(n), static_cast<Index>(n)), open = after;
  for (Index k = static_cast<Index>(n) - 1; k >= 0; --k) {
    const double information_along = std::max(eigen.values[k], 0.0);
    const Eigen::VectorXd way = eigen.vectors.col(k);
    after += way * way.transpose() / (1 + information_along);
    // Open is what the data make less than twice as narrow as it was.
    if (information_along < 3) open += way * way.transpose();
    Direction direction{std::sqrt(1 + information_along), {way.begin(), way.end()}};
    information.directions.push_back(std::move(direction));
  }
  for (std::size_t i = 0; i < n; ++i)
    information.deviation.push_back(information.spread[i] *
                                    std::sqrt(after(static_cast<Index>(i), static_cast<Index>(i))));
  information.words = Words(model, x, information.spread, open, at_bound).say();
  return information;
}

}  // namespace bentaxis::designs
