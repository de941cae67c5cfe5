#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "bentaxis/designs/identify.h"
#include "bentaxis/numerics/dense.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/reporting.h"
#include "row_major.h"

namespace bentaxis::designs {
namespace {

using Vector = std::vector<double>;

constexpr double kRise95 = 3.841458820694124;  // of chi-squared with one degree of freedom
constexpr double kNearEnough = 0.02;           // of that
constexpr int kMaxRefits = 8;                  // on either side

// The other unknowns fitted anew with one of them held.
class Held {
 public:
  Held(const LeastSquaresProblem& whole, std::size_t held) : whole_(whole), held_(held) {
    problem_.parameters = whole.parameters - 1;
    problem_.residuals = whole.residuals;
    problem_.low = without(whole.low);
    problem_.high = without(whole.high);
    problem_.evaluate = [this](std::span<const double> x, std::span<double> residuals) {
      return whole_.evaluate(with(x, value_), residuals);
    };
  }
  /// @param x  of all unknowns: where the search starts, and its end
  double refit(double value, Vector& x) {
    value_ = value;
    x[held_] = value;
    const LeastSquaresOptions options{.most_iterations = 20, .enough = 0.01};
    if (problem_.parameters == 0) {
      Vector residuals(whole_.residuals);
      if (!whole_.evaluate(x, residuals)) throw ComputationError("profile: no pump there");
      return sum_of_squares(residuals);
    }
    const LeastSquaresFit fit = least_squares(problem_, without(x), options);
    x = with(fit.x, value);
    return fit.sum_of_squares;
  }

 private:
  Vector without(const Vector& x) const {
    Vector others = x;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(held_));
    return others;
  }
  Vector with(std::span<const double> x, double value) const {
    Vector all(x.begin(), x.end());
    all.insert(all.begin() + static_cast<std::ptrdiff_t>(held_), value);
    return all;
  }

  const LeastSquaresProblem& whole_;
  LeastSquaresProblem problem_;
  std::size_t held_;
  double value_ = 0;
};

// Goes from the fit to one side until the sum has risen as far as 95 % allow.
// @return the limit, or the bound where it comes first
double limit_of(Held& held, const LeastSquaresFit& fit, std::size_t unknown, double first_step,
                double bound, bool& open, Profile& profile) {
  const double centre = fit.x[unknown], side = bound > centre ? 1 : -1;
  const double room = std::abs(bound - centre);
  open = room == 0;
  if (open) return bound;
  // The root of the rise is nearly straight: regula falsi on it.
  const double wanted = std::sqrt(kRise95);
  double inside = 0, root_inside = 0, outside = -1, root_outside = 0;
  double step = std::min(first_step, room);
  Vector x = fit.x, x_inside = fit.x;
  for (int refit = 0; refit < kMaxRefits; ++refit) {
    x = x_inside;
    double rise = HUGE_VAL;
    try {
      rise = held.refit(centre + side * step, x) - fit.sum_of_squares;
    } catch (const ComputationError&) {
      rise = HUGE_VAL;  // no pump there
    }
    if (std::isfinite(rise)) {
      profile.values.push_back(centre + side * step);
      profile.rises.push_back(rise);
    }
    if (std::isfinite(rise) && std::abs(rise - kRise95) < kNearEnough * kRise95)
      return centre + side * step;
    if (rise < kRise95) {
      if (step >= room) {
        open = true;
        return bound;
      }
      inside = step;
      root_inside = std::sqrt(std::max(rise, 0.0));
      x_inside = x;
    } else {
      outside = step;
      root_outside = std::isfinite(rise) ? std::sqrt(rise) : HUGE_VAL;
    }
    if (outside < 0) {
      const double grown = root_inside > 0 ? inside * wanted / root_inside : 4 * inside;
      step = std::min({std::max(grown, 1.2 * inside), 4 * inside, room});
    } else if (!std::isfinite(root_outside)) {
      step = (inside + outside) / 2;
    } else {
      const double share = (wanted - root_inside) / (root_outside - root_inside);
      step = inside + std::clamp(share, 0.05, 0.95) * (outside - inside);
    }
  }
  return centre + side * (outside < 0 ? inside : step);
}

}  // namespace

std::vector<Profile> profiles_of(const DataModel& model, const LeastSquaresFit& fit, int threads,
                                 const Progress& progress) {
  const LeastSquaresProblem problem = model.problem();
  const Information information = information_of(model, fit.x, fit.jacobian);
  std::vector<Profile> profiles(model.size());
  study::for_each_of(model.size(), threads, progress, [&](std::size_t i) {
    Profile& profile = profiles[i];
    Held held(problem, i);
    const double step = 1.96 * information.deviation[i];
    profile.low = limit_of(held, fit, i, step, problem.low[i], profile.open_low, profile);
    profile.high = limit_of(held, fit, i, step, problem.high[i], profile.open_high, profile);
    profile.values.push_back(fit.x[i]);
    profile.rises.push_back(0);
    std::vector<std::pair<double, double>> points;
    for (std::size_t k = 0; k < profile.values.size(); ++k)
      points.emplace_back(profile.values[k], profile.rises[k]);
    std::sort(points.begin(), points.end());
    for (std::size_t k = 0; k < points.size(); ++k)
      std::tie(profile.values[k], profile.rises[k]) = points[k];
  });
  return profiles;
}

std::vector<LeftOut> leave_one_out(const DataModel& model, const LeastSquaresFit& fit, int threads,
                                   const Progress& progress) {
  std::vector<std::size_t> rows;
  const auto& data = model.data().data;
  for (std::size_t i = 0; i < data.size(); ++i)
    if (data[i].use == Use::fitted && !data[i].curve) rows.push_back(i);
  std::vector<LeftOut> results(rows.size());
  study::for_each_of(rows.size(), threads, progress, [&](std::size_t r) {
    const Datum& datum = data[rows[r]];
    LeftOut& out = results[r];
    out.datum = rows[r];
    const LeastSquaresOptions options{.most_iterations = 40, .enough = 1e-3};
    const LeastSquaresFit refit = least_squares(model.problem(rows[r], true), fit.x, options);
    std::vector<double> numbers(model.numbers());
    model.predict(refit.x, numbers);
    const std::size_t place = model.place_of(rows[r]);
    out.value = numbers[place];
    out.high = numbers[place + datum.size() - 1];
    // How far the prediction can be off, linear about it.
    LeastSquaresProblem number;
    number.parameters = model.size();
    number.residuals = datum.size();
    for (const Unknown& u : model.data().unknowns) {
      number.low.push_back(u.low);
      number.high.push_back(u.high);
    }
    number.evaluate = [&](std::span<const double> x, std::span<double> values) {
      std::vector<double> all(model.numbers());
      if (!model.predict(x, all)) return false;
      std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(place), datum.size(), values.begin());
      return true;
    };
    const auto n = static_cast<Eigen::Index>(model.size());
    std::vector<double> slopes(datum.size() * model.size());
    if (!derivatives_of(number, refit.x, slopes)) return;
    const Eigen::Map<const RowMajor> jacobian(refit.jacobian.data(),
                                              static_cast<Eigen::Index>(refit.residuals.size()), n);
    const numerics::SymmetricSolver information(jacobian.transpose() * jacobian);
    for (std::size_t k = 0; k < datum.size(); ++k) {
      const Eigen::Map<const Eigen::VectorXd> slope(slopes.data() + k * model.size(), n);
      const double deviation = std::hypot(
          std::sqrt(std::max(slope.dot(information.solve(slope)), 0.0)), datum.uncertainty);
      const double distance =
          model.residual(datum, k, numbers[place + k]) * datum.uncertainty / deviation;
      if (k == 0 || std::abs(distance) > std::abs(out.distance)) {
        out.distance = distance;
        out.deviation = deviation;
      }
    }
  });
  return results;
}

}  // namespace bentaxis::designs
