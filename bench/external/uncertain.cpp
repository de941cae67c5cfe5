// Functions whose variance is known part by part, and examples of propagation that others state.
#include <cmath>
#include <string>

#include "bentaxis/designs/propagation.h"
#include "numbers.h"

namespace bentaxis::external {
namespace {

using designs::Response;
using designs::UncertainVariables;
using Function = std::function<double(std::span<const double>)>;

UncertainVariables variables(const std::vector<std::string>& distributions) {
  UncertainVariables all;
  for (const std::string& text : distributions)
    all.distributions.push_back(designs::distribution(text, "x"));
  return all;
}

Response response(const Function& function, std::size_t dimension) {
  return [=](std::size_t count, std::span<const double> values, std::span<double> results,
             std::span<std::string>) {
    for (std::size_t i = 0; i < count; ++i)
      results[i] = function(values.subspan(i * dimension, dimension));
  };
}

// First and total indices, one id each.
void put_indices(Numbers& numbers, const std::string& name, const Function& function,
                 const UncertainVariables& inputs) {
  constexpr std::size_t kBase = 8192;
  const designs::SobolIndices found =
      designs::sobol_indices(response(function, inputs.size()), 1, inputs, kBase, 1);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    numbers.push_back({name + ".first", found.first[i].value});
    numbers.push_back({name + ".total", found.total[i].value});
  }
}

// Mean and standard deviation of a million trials; the first-order uncertainty and the limits of
// 95 %, of which 2.5 % lie beyond each, where others state them.
struct Stated {
  bool first_order = false, interval = false;
};
void put_propagation(Numbers& numbers, const std::string& name, const Function& function,
                     const std::vector<std::string>& distributions, const Stated& stated) {
  constexpr std::size_t kTrials = 1000000;
  const UncertainVariables inputs = variables(distributions);
  const Response of = response(function, inputs.size());
  const designs::Spread trials =
      designs::spread_of(designs::sample(of, 1, inputs, kTrials, 1).of(0), 0.95);
  numbers.push_back({name + ".mean", trials.mean});
  numbers.push_back({name + ".deviation", trials.deviation});
  if (stated.first_order)
    numbers.push_back({name + ".first_order", designs::first_order(of, 1, inputs).deviations[0]});
  if (!stated.interval) return;
  numbers.push_back({name + ".interval", trials.low.value});
  numbers.push_back({name + ".interval", trials.high.value});
}

}  // namespace

Numbers sobol() {
  Numbers numbers;
  put_indices(
      numbers, "sobol.ishigami",
      [](std::span<const double> x) {
        return std::sin(x[0]) + 7 * std::pow(std::sin(x[1]), 2) +
               0.1 * std::pow(x[2], 4) * std::sin(x[0]);
      },
      variables(std::vector<std::string>(3, "uniform(-3.141592653589793, 3.141592653589793)")));
  put_indices(
      numbers, "sobol.g",
      [](std::span<const double> x) {
        constexpr double kA[] = {0, 1, 4.5, 9, 99, 99, 99, 99};
        double product = 1;
        for (std::size_t i = 0; i < x.size(); ++i)
          product *= (std::abs(4 * x[i] - 2) + kA[i]) / (1 + kA[i]);
        return product;
      },
      variables(std::vector<std::string>(8, "uniform(0, 1)")));
  return numbers;
}

// JCGM 101:2008, 9.2.2 and 9.2.3; a logarithm of NPL's report DEM-ES-011; magnitude and phase of
// JCGM 102:2011.
Numbers propagation() {
  Numbers numbers;
  const Function sum = [](std::span<const double> x) { return x[0] + x[1] + x[2] + x[3]; };
  // Of standard deviation 1.
  const std::string rectangular = "uniform(-1.7320508075688772, 1.7320508075688772)";
  put_propagation(numbers, "gum.sum_of_normal", sum, std::vector<std::string>(4, "normal(0, 1)"),
                  {.interval = true});
  put_propagation(numbers, "gum.sum_of_rectangular", sum, std::vector<std::string>(4, rectangular),
                  {.interval = true});
  put_propagation(numbers, "gum.logarithm",
                  [](std::span<const double> x) { return std::log(x[0]); }, {"uniform(0.1, 1.1)"},
                  {.first_order = true});
  const std::vector<std::string> parts = {"normal(0.001, 0.01)", "normal(0, 0.01)"};
  put_propagation(numbers, "gum.magnitude",
                  [](std::span<const double> x) { return std::hypot(x[0], x[1]); }, parts,
                  {.first_order = true});
  put_propagation(numbers, "gum.phase",
                  [](std::span<const double> x) { return std::atan2(x[1], x[0]); }, parts,
                  {.first_order = true});
  return numbers;
}

}  // namespace bentaxis::external
