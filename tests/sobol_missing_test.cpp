// A program without OpenTURNS: designs/sobol_indices.cpp is compiled into this test without it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "bentaxis/designs/uncertainty.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/pump/error.h"

namespace bentaxis::designs {
namespace {

// What cannot be had is refused before anything is computed, however many samples there are.
TEST(Uncertainty, WithoutOpenTurnsRefusesSobolIndicesAtOnce) {
  ASSERT_EQ(openturns_version(), "none");
  EXPECT_THROW(require_sobol_indices(), InputError);
  Case the_case = read_case(BENTAXIS_SOURCE_DIR "/cases/bap63_rated.toml");
  the_case.uncertainty.parameters = {{"pump.tilt_deg", "normal(40, 0.1)"}};
  UncertaintyOptions options;
  options.outputs = {output("mean:Td", the_case)};
  options.sobol = 64;
  std::vector<std::string> begun;
  const study::PartProgress parts = [&](const std::string& part) {
    begun.push_back(part);
    return Progress([](double) {});
  };
  try {
    uncertainty(the_case, options, parts);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("built without OpenTURNS"));
  }
  EXPECT_THAT(begun, testing::IsEmpty());
  // The rest of it works.
  options.sobol = 0;
  options.samples = 150;
  options.curves = false;
  EXPECT_EQ(uncertainty(the_case, options, parts).outputs.size(), 1U);
  EXPECT_THAT(begun, testing::Contains("Monte Carlo"));
}

}  // namespace
}  // namespace bentaxis::designs
