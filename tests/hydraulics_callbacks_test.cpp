// No exception passes through the C code of CVODES. The linker puts this program's CVode between
// the integrator and the library's.
#include <cvodes/cvodes.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <new>
#include <vector>

#include "allocations.h"
#include "bentaxis/files/case_file.h"
#include "integrator.h"
#include "network.h"

namespace {

bool no_memory = false;  // for what CVODES calls
bool passed_through = false;

}  // namespace

// The names are the linker's.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" {
int __real_CVode(void* memory, realtype end, N_Vector y, realtype* reached, int task);
int __wrap_CVode(void* memory, realtype end, N_Vector y, realtype* reached, int task);
}

int __wrap_CVode(void* memory, realtype end, N_Vector y, realtype* reached, int task) {
  bentaxis::test::allocations_fail = no_memory;
  try {
    const int flag = __real_CVode(memory, end, y, reached, task);
    bentaxis::test::allocations_fail = false;
    return flag;
  } catch (...) {
    bentaxis::test::allocations_fail = false;
    passed_through = true;
    throw;
  }
}
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

namespace bentaxis::hydraulics {
namespace {

TEST(Integrator, CarriesExceptionsAroundTheLibrary) {
  const Network network(read_case(std::filesystem::path(BENTAXIS_SOURCE_DIR) / "cases" /
                                  "bap63_rated_hydraulic.toml"));
  constexpr double kAreaOfLoad = 1e-5;  // m2
  const std::vector<double> states(static_cast<std::size_t>(network.states()), 0.0);
  Integrator integrator(network);
  Integrals integrals;
  const auto integrate = [&] {
    return integrator.over_period(states, kAreaOfLoad, 1e-4, nullptr, &integrals);
  };
  no_memory = true;
  EXPECT_THROW(integrate(), std::bad_alloc);
  EXPECT_FALSE(passed_through);
  no_memory = false;
  EXPECT_FALSE(integrate().empty());  // it is whole
}

}  // namespace
}  // namespace bentaxis::hydraulics
