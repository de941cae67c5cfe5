// Computes what strangers have numbers for and prints it: "id,value", a line each; an id with
// several values has a line for each. What they say is in expected.json beside this file, which
// scripts/run_external_benchmarks reads afterwards.
#include <chrono>
#include <cstdio>
#include <exception>

#include "bentaxis/designs/least_squares.h"
#include "bentaxis/designs/propagation.h"
#include "numbers.h"

int main() {
  using namespace bentaxis::external;
  constexpr int kSkipped = 77;
  if (bentaxis::designs::least_squares_library().empty() ||
      bentaxis::designs::openturns_version() == "none") {
    std::fprintf(stderr, "external_numbers: needs Ceres and OpenTURNS (scripts/setup full)\n");
    return kSkipped;
  }
  struct Group {
    const char* name;
    Numbers (*numbers)();
  };
  const Group groups[] = {{"iso_6336", iso_6336},
                          {"pair_of_62", pair_of_62},
                          {"finite_element_tooth", finite_element_tooth},
                          {"oscillator", oscillator},
                          {"oil", oil},
                          {"regression", regression},
                          {"sobol", sobol},
                          {"propagation", propagation},
                          {"posterior", posterior},
                          {"stiff", stiff},
                          {"bearings", bearings},
                          {"judgements", judgements},
                          {"modelica", modelica}};
  int status = 0;
  for (const Group& group : groups) try {
      const auto start = std::chrono::steady_clock::now();
      for (const Number& n : group.numbers()) std::printf("%s,%.17g\n", n.id.c_str(), n.value);
      const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
      std::fprintf(stderr, "%s: %.1f s\n", group.name, spent.count());
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", group.name, error.what());
      status = 1;
    }
  return status;
}
