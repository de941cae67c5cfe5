#include "bentaxis/designs/distribution.h"

#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <boost/math/distributions/lognormal.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/triangular.hpp>
#include <boost/math/distributions/uniform.hpp>
#include <cmath>
#include <set>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/lists.h"
#include "bentaxis/pump/number.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/words.h"
#include "plain_double.h"

namespace bentaxis::designs {
namespace {

namespace law = boost::math;
using Normal = law::normal_distribution<double, PlainDouble>;
using Uniform = law::uniform_distribution<double, PlainDouble>;
using Triangular = law::triangular_distribution<double, PlainDouble>;
using Lognormal = law::lognormal_distribution<double, PlainDouble>;

constexpr std::array<const char*, 4> kShapes = {"normal", "uniform", "triangular", "lognormal"};
constexpr std::array<std::size_t, 4> kNumbers = {2, 2, 3, 2};

// What `job` says of the law of this shape and these numbers.
template <class Job>
double ask(const Distribution& d, const Job& job) {
  const std::vector<double>& n = d.numbers;
  switch (d.shape) {
    case Shape::normal:
      return job(Normal(n[0], n[1]));
    case Shape::uniform:
      return job(Uniform(n[0], n[1]));
    case Shape::triangular:
      return job(Triangular(n[0], n[1], n[2]));
    case Shape::lognormal:
      break;
  }
  return job(Lognormal(std::log(n[0]), n[1]));
}

// What is wrong with the numbers of a distribution; "" where nothing is.
std::string broken(const Distribution& d) {
  const std::vector<double>& n = d.numbers;
  if (std::any_of(n.begin(), n.end(), [](double x) { return !std::isfinite(x); }))
    return "numbers must be finite";
  switch (d.shape) {
    case Shape::normal:
      return n[1] > 0 ? "" : "the standard deviation must be > 0";
    case Shape::uniform:
      return n[0] < n[1] ? "" : "the lower limit must be below the upper limit";
    case Shape::triangular:
      return n[0] <= n[1] && n[1] <= n[2] && n[0] < n[2]
                 ? ""
                 : "the mode must lie between the lower and the upper limit";
    case Shape::lognormal:
      break;
  }
  if (n[0] <= 0) return "the median must be > 0";
  return n[1] > 0 ? "" : "the standard deviation of the logarithm must be > 0";
}

// Of values whose normal scores have the correlation r: the integral over both scores by the
// trapezoidal rule, which converges exponentially for what falls off as the normal law does.
double covariance(const Distribution& a, const Distribution& b, double r) {
  constexpr double kWidest = 8.5, kStep = 0.1;  // what lies beyond is below 1e-16
  const double rest = std::sqrt(std::max(0.0, 1 - r * r));
  double sum = 0;
  const int steps = static_cast<int>(kWidest / kStep);
  for (int i = -steps; i <= steps; ++i) {
    const double z = i * kStep;
    double inner = 0;
    for (int j = -steps; j <= steps; ++j) {
      const double y = j * kStep;
      inner += std::exp(-y * y / 2) * (b.at_score(r * z + rest * y) - b.mean());
    }
    sum += std::exp(-z * z / 2) * (a.at_score(z) - a.mean()) * inner;
  }
  return sum * kStep * kStep / (2 * law::constants::pi<double>());
}

}  // namespace

double Distribution::quantile(double share) const {
  return ask(*this, [&](const auto& d) { return law::quantile(d, share); });
}

double Distribution::at_score(double score) const {
  if (shape == Shape::normal) return numbers[0] + numbers[1] * score;
  if (shape == Shape::lognormal) return numbers[0] * std::exp(numbers[1] * score);
  const Normal standard;  // of both tails the short one, which has all its digits
  return ask(*this, [&](const auto& d) {
    return score < 0 ? law::quantile(d, law::cdf(standard, score))
                     : law::quantile(complement(d, law::cdf(complement(standard, score))));
  });
}

double Distribution::cumulative(double value) const {
  if (shape == Shape::lognormal && value <= 0) return 0;
  return ask(*this, [&](const auto& d) { return law::cdf(d, value); });
}

double Distribution::density(double value) const {
  if (shape == Shape::lognormal && value <= 0) return 0;
  return ask(*this, [&](const auto& d) { return law::pdf(d, value); });
}

double Distribution::mean() const {
  return ask(*this, [](const auto& d) { return law::mean(d); });
}

double Distribution::standard_deviation() const {
  return ask(*this, [](const auto& d) { return law::standard_deviation(d); });
}

std::string Distribution::text() const {
  return std::string(kShapes[static_cast<std::size_t>(shape)]) + "(" +
         joined(numbers, ", ", [](double n) { return number_text(n); }) + ")";
}

Distribution distribution(const std::string& text, const std::string& what,
                          std::optional<double> about) {
  const auto fail = [&](const std::string& why) {
    throw InputError(what + " = " + text + ": " + why);
  };
  const auto open = text.find('(');
  if (open == std::string::npos || !trimmed(text, " ").ends_with(')'))
    fail("must be a distribution such as normal(40, 0.1)");
  std::string word(trimmed(text.substr(0, open), " "));
  std::vector<double> numbers;
  std::string rest = text.substr(open + 1, text.rfind(')') - open - 1);
  for (bool more = true; more;) {
    const auto comma = rest.find(',');
    more = comma != std::string::npos;
    const std::string part(trimmed(rest.substr(0, comma), " "));
    const auto number = number_in(part);
    if (!number) fail("\"" + part + "\" must be a finite number");
    numbers.push_back(*number);
    if (more) rest.erase(0, comma + 1);
  }
  if (about && word == "relative" && numbers.size() == 1) {
    if (*about == 0) fail("is relative to a value that is 0: give normal(standard deviation)");
    word = "normal";
    numbers = {*about, numbers[0] * std::abs(*about)};
  } else if (about && word == "normal" && numbers.size() == 1) {
    numbers.insert(numbers.begin(), *about);
  }
  const auto* const shape = std::find(kShapes.begin(), kShapes.end(), word);
  if (shape == kShapes.end()) {
    std::set<std::string> known(kShapes.begin(), kShapes.end());
    if (about) known.insert("relative");
    fail("no such distribution" + suggestion(word, known));
  }
  const auto place = static_cast<std::size_t>(shape - kShapes.begin());
  Distribution found{static_cast<Shape>(place), numbers};
  if (numbers.size() != kNumbers[place])
    fail(word + " takes " + std::to_string(kNumbers[place]) + " numbers");
  if (const std::string why = broken(found); !why.empty()) fail(why);
  return found;
}

bool UncertainVariables::independent() const { return factor.empty(); }

void UncertainVariables::correlate(const std::vector<Pair>& pairs) {
  const std::size_t n = size();
  const auto name_of = [&](std::size_t i) {
    return variables.empty() ? "number " + std::to_string(i + 1) : variables[i].name();
  };
  correlation.clear();
  factor.clear();
  if (pairs.empty()) return;
  correlation.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) correlation[i * n + i] = 1;
  for (const Pair& p : pairs) {
    const auto name = [&] {
      return "correlation of " + name_of(p.first) + " and " + name_of(p.second);
    };
    if (p.first == p.second) throw InputError(name() + ": must be of two parameters");
    if (!(std::abs(p.coefficient) <= 1))
      throw InputError(name() + " = " + number_text(p.coefficient) + ": must be in [-1, 1]");
    double& entry = correlation[p.first * n + p.second];
    if (entry != 0) throw InputError(name() + ": is given twice");
    entry = correlation[p.second * n + p.first] = p.coefficient;
  }
  // Cholesky's factor; a pivot of 0 (within round-off) is a number that others determine.
  constexpr double kRoundOff = 1e-12;
  factor.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = correlation[i * n + j];
      for (std::size_t k = 0; k < j; ++k) rest -= factor[i * n + k] * factor[j * n + k];
      const double pivot = factor[j * n + j];
      const bool possible = i == j ? rest > -kRoundOff : pivot > 0 || std::abs(rest) < 1e-6;
      if (!possible)
        throw InputError("[uncertainty] correlation: these correlations are inconsistent (" +
                         name_of(i) + " contradicts those before it)");
      if (i == j)
        factor[i * n + j] = rest > kRoundOff ? std::sqrt(rest) : 0;
      else
        factor[i * n + j] = pivot > 0 ? rest / pivot : 0;
    }
}

void UncertainVariables::values(std::span<const double> shares, std::span<double> values) const {
  const std::size_t n = size();
  if (independent()) {
    for (std::size_t i = 0; i < n; ++i) values[i] = distributions[i].quantile(shares[i]);
    return;
  }
  const Normal standard;
  for (std::size_t i = 0; i < n; ++i) values[i] = law::quantile(standard, shares[i]);
  for (std::size_t i = n; i-- > 0;) {  // downwards: those above are still independent
    double score = 0;
    for (std::size_t j = 0; j <= i; ++j) score += factor[i * n + j] * values[j];
    values[i] = score;
  }
  for (std::size_t i = 0; i < n; ++i) values[i] = distributions[i].at_score(values[i]);
}

std::vector<double> UncertainVariables::covariances() const {
  const std::size_t n = size();
  std::vector<double> all(n * n, 0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const double r = i == j ? 1 : independent() ? 0 : correlation[i * n + j];
      const Distribution &a = distributions[i], &b = distributions[j];
      const bool normal = a.shape == Shape::normal && b.shape == Shape::normal;
      all[i * n + j] = all[j * n + i] = i == j || normal || r == 0
                                            ? r * a.standard_deviation() * b.standard_deviation()
                                            : covariance(a, b, r);
    }
  return all;
}

UncertainVariables uncertain_variables(const Case& the_case) {
  const UncertaintyData& data = the_case.uncertainty;
  if (data.parameters.empty())
    throw InputError(the_case.file.string() +
                     ": needs [uncertainty]: distributions of parameters, \"pump.tilt_deg\" = "
                     "\"normal(40, 0.1)\"; or give it by --vary");
  UncertainVariables all;
  const auto place_of = [&](const std::string& name) {
    const auto found = std::find_if(all.variables.begin(), all.variables.end(),
                                    [&](const Variable& v) { return v.name() == name; });
    return static_cast<std::size_t>(found - all.variables.begin());
  };
  for (const UncertaintyData::Parameter& p : data.parameters) {
    const std::string what = "[uncertainty] " + p.name;
    if (place_of(p.name) < all.variables.size()) throw InputError(what + ": is given twice");
    const Variable variable = [&] {
      try {
        return Variable(p.name, the_case);
      } catch (const InputError& error) {
        throw InputError("[uncertainty] " + std::string(error.what()));
      }
    }();
    if (variable.discrete())
      throw InputError(what + ": is a whole number or a word: it cannot have a distribution");
    const Distribution found = distribution(p.distribution, what, variable.value(the_case));
    const NumberRange range = variable.range(the_case);
    const bool bounded = found.shape == Shape::uniform || found.shape == Shape::triangular;
    for (const double value : bounded
                                  ? std::vector<double>{found.numbers.front(), found.numbers.back()}
                                  : std::vector<double>{found.quantile(0.5)})
      if (!range.contains(value))
        throw InputError(what + " = " + p.distribution + ": " + number_text(value) + " must be " +
                         range.text());
    all.variables.push_back(variable);
    all.distributions.push_back(found);
  }
  std::vector<UncertainVariables::Pair> pairs;
  for (const UncertaintyData::Correlation& c : data.correlations) {
    for (const std::string& name : {c.first, c.second})
      if (place_of(name) == all.variables.size())
        throw InputError("[uncertainty] correlation: " + name + " has no distribution there");
    pairs.push_back({place_of(c.first), place_of(c.second), c.coefficient});
  }
  all.correlate(pairs);
  return all;
}

}  // namespace bentaxis::designs
