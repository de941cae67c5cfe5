// The readers of designs/: finished blocks of a sweep, study files, files of data.
#include <filesystem>
#include <fstream>
#include <string>

#include "bentaxis/designs/identify.h"
#include "bentaxis/designs/sweep.h"
#include "bentaxis/designs/sweep_parts.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/error.h"
#include "readers.h"
#include "scratch.h"

namespace bentaxis::fuzz {
namespace {

namespace fs = std::filesystem;

const Case& shipped_case() {
  static const Case the_case = read_case(BENTAXIS_FUZZED_CASE);
  return the_case;
}

// A sweep of two designs, and a folder for its blocks.
struct SmallSweep {
  designs::SweepRecord record;
  designs::SweepParts parts;

  SmallSweep()
      : record{"", {}, "", std::string(64, '0'), {2, 2, 1, 1}}, parts(scratch_folder(), record) {
    designs::SweepBlock block;
    block.designs = 2;
    block.values = {20, 30};
    block.results = {1, 2};
    block.reasons = {"", "a reason"};
    block.checks.push_back({1, {1}, {2}, "", "another", {3}});
    parts.keep(0, block);
    const auto again = parts.read(0);
    require(again && again->results == block.results && again->reasons == block.reasons,
            "a block that was kept is not read back");
  }
};

}  // namespace

void read_as_block(const std::uint8_t* data, std::size_t size) {
  static const SmallSweep sweep;
  constexpr std::size_t kHash = 64;
  std::string bytes(reinterpret_cast<const char*>(data), size);
  if (size > kHash) {
    bytes.resize(size - kHash);
    bytes += sha256_of(bytes);
  }
  const fs::path file = scratch_folder() / "block-000000.bin";
  std::error_code ignored;
  fs::remove(file, ignored);
  named_file_with(file.filename(), reinterpret_cast<const std::uint8_t*>(bytes.data()),
                  bytes.size());
  try {
    if (const auto block = sweep.parts.read(0))
      require(block->reasons.size() == block->designs, "a design of a block has no reason");
  } catch (const InputError& error) {
    check_message(error);
  }
}

void read_as_study(const std::uint8_t* data, std::size_t size) {
  try {
    const designs::SweepPlan plan =
        designs::sweep_plan(designs::read_sweep_request(file_with(data, size)), shipped_case());
    const std::string text = designs::plan_text(plan);
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    const designs::SweepPlan again = designs::sweep_plan(
        designs::read_sweep_request(file_with(bytes, text.size())), shipped_case());
    require(designs::plan_text(again) == text, "plan is not the same after writing and reading");
  } catch (const InputError& error) {
    check_message(error);
  }
}

void read_as_data(const std::uint8_t* data, std::size_t size) {
  static const bool curve_written = [] {
    std::ofstream(scratch_folder() / "curve.csv")
        << "theta_deg,Td_z1_Nm,Rb1_x1_N\n0,270,1\n90,280,2\n180,290,3\n270,280,4\n";
    return true;
  }();
  require(curve_written, "no curve");
  try {
    designs::IdentificationData all;
    designs::read_identification(named_file_with("data.toml", data, size), shipped_case(), all);
    for (const designs::Datum& datum : all.data) {
      require(datum.condition < all.conditions.size(), "datum has no condition");
      require(datum.use == designs::Use::left_out || datum.uncertainty > 0,
              "datum has no uncertainty");
    }
  } catch (const InputError& error) {
    check_message(error);
  }
}

}  // namespace bentaxis::fuzz
