// Numbers that nobody here wrote, against teeth and integrators (docs/external_benchmarks.md).
//
//   judges      exit status 1 where a tolerance is exceeded that docs/external_benchmarks.md does
//   not know of
#include <cmath>
#include <cstdio>
#include <exception>

#include "rows.h"

namespace bentaxis::judges {

double Row::error() const {
  const double apart = std::abs(found - expected);
  const double error = relative ? apart / std::abs(expected) : apart;
  return std::isfinite(error) ? error : HUGE_VAL;
}

namespace {

int print(const char* title, const Rows& rows) {
  std::printf("\n%s\n", title);
  int unexpected = 0;
  for (const Row& row : rows) {
    const char* verdict = row.passed()
                              ? (row.known_to_fail ? "PASSED, was known to fail" : "passed")
                              : (row.known_to_fail ? "failed, known" : "FAILED");
    std::printf("  %-62s %16.9g %16.9g  %8.1e of %-7.1e %s\n", row.what.c_str(), row.found,
                row.expected, row.error(), row.tolerance, verdict);
    if (row.passed() == row.known_to_fail) ++unexpected;
  }
  return unexpected;
}

}  // namespace
}  // namespace bentaxis::judges

int main() {
  using namespace bentaxis::judges;
  try {
    std::printf("%-64s %16s %16s  %s\n", "", "found", "expected", "error");
    int unexpected =
        print("ISO/TR 6336-30, example 1; ISO 6336-1 and the law: N/(mm um)", iso_6336());
    unexpected += print("m 2 mm, 62/62 after Ma et al. 2014: N/m", pair_of_62());
    unexpected += print("One tooth by finite elements, stored: m/(N/m)", finite_element_tooth());
    unexpected += print("Kahraman and Singh's oscillator, exactly, and coupled/", oscillator());
    std::printf("\nrows other than docs/external_benchmarks.md says: %d\n", unexpected);
    return unexpected == 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "judges: %s\n", error.what());
    return 1;
  }
}
