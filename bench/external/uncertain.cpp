// Functions whose variance is known part by part, and the examples of the GUM's supplement 1.
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

// First-order uncertainty, then mean, standard deviation and 95 % of a million trials. Where the
// law is not symmetric the supplement prints the shortest interval, which the program does not
// have.
void put_propagation(Numbers& numbers, const std::string& name, const Function& function,
                     const std::vector<std::string>& distributions, bool symmetric = true) {
  constexpr std::size_t kTrials = 1000000;
  const UncertainVariables inputs = variables(distributions);
  const Response of = response(function, inputs.size());
  const designs::FirstOrder first = designs::first_order(of, 1, inputs);
  const designs::Spread trials =
      designs::spread_of(designs::sample(of, 1, inputs, kTrials, 1).of(0), 0.95);
  numbers.push_back({name + ".first_order", first.deviations[0]});
  numbers.push_back({name + ".mean", trials.mean});
  numbers.push_back({name + ".deviation", trials.deviation});
  if (!symmetric) return;
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

// JCGM 101:2008, 9.2 to 9.4.
Numbers gum_supplement() {
  Numbers numbers;
  const Function sum = [](std::span<const double> x) { return x[0] + x[1] + x[2] + x[3]; };
  // Rectangular numbers of standard deviation 1 and 10.
  const std::string one = "uniform(-1.7320508075688772, 1.7320508075688772)";
  const std::string ten = "uniform(-17.320508075688772, 17.320508075688772)";
  put_propagation(numbers, "gum_s1.sum_of_normal", sum,
                  std::vector<std::string>(4, "normal(0, 1)"));
  put_propagation(numbers, "gum_s1.sum_of_rectangular", sum, {one, one, one, one});
  put_propagation(numbers, "gum_s1.sum_with_a_dominant_one", sum, {one, one, one, ten});
  // Milligrams over the nominal 100 g; masses in mg, densities in kg/m3.
  put_propagation(numbers, "gum_s1.mass",
                  [](std::span<const double> x) {
                    return (x[0] + x[1]) * (1 + (x[2] - 1.2) * (1 / x[3] - 1 / x[4])) - 100000;
                  },
                  {"normal(100000, 0.050)", "normal(1.234, 0.020)", "uniform(1.10, 1.30)",
                   "uniform(7000, 9000)", "uniform(7950, 8050)"});
  const Function loss = [](std::span<const double> x) { return x[0] * x[0] + x[1] * x[1]; };
  for (const char* x1 : {"0", "0.010", "0.050"})
    put_propagation(numbers, std::string("gum_s1.loss_at_") + x1, loss,
                    {std::string("normal(") + x1 + ", 0.005)", "normal(0, 0.005)"}, false);
  return numbers;
}

}  // namespace bentaxis::external
