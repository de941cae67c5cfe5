// Computes what strangers have numbers for and prints it: "id,value", a line each. What they say is
// in reference_data/external/expected.json, which scripts/run_external_benchmarks reads afterwards.
#include <cstdio>
#include <exception>

#include "numbers.h"

int main() {
  using namespace bentaxis::external;
  try {
    for (const auto group : {iso_6336, pair_of_62, finite_element_tooth, oscillator, oil})
      for (const Number& n : group()) std::printf("%s,%.17g\n", n.id.c_str(), n.value);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "external_numbers: %s\n", error.what());
    return 1;
  }
}
