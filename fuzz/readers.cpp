#include "readers.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bentaxis/analytic/model.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/results/result_table.h"

namespace bentaxis::fuzz {
namespace {

// Fails in every build type, with a place for the fuzzer to report.
void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}

// A file that holds the bytes; it lives in memory, so that the disk does not set the pace.
std::filesystem::path file_with(const std::uint8_t* data, std::size_t size) {
  static const int handle = memfd_create("fuzz", 0);
  require(handle >= 0 && ftruncate(handle, 0) == 0, "no scratch file");
  require(pwrite(handle, data, size, 0) == static_cast<ssize_t>(size), "scratch file not written");
  return "/proc/self/fd/" + std::to_string(handle);
}

void check_message(const std::exception& error) {
  const std::string what = error.what();
  require(!what.empty(), "message is empty");
  require(what.find('\n') == std::string::npos, "message has more than one line");
}

}  // namespace

void read_as_case(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const Case the_case = parse_case(text, "/fuzz/case.toml");
    const std::string written = case_text(the_case);
    const Case again = parse_case(written, "/fuzz/case.toml");
    require(case_text(again) == written, "case is not the same after writing and reading");

    if (the_case.hydraulics) return;  // their pressure is another library's
    Case small = the_case;
    small.operation.samples_per_revolution = 3;
    const PressureTrace pressure(small.pressure);
    analytic::run(small, small.analytic, sample_case(small, pressure));
  } catch (const InputError& error) {
    check_message(error);
  } catch (const ComputationError& error) {
    check_message(error);
  }
}

void read_as_change(const std::uint8_t* data, std::size_t size) {
  const std::string change(reinterpret_cast<const char*>(data), size);
  try {
    const Case the_case = read_case(BENTAXIS_FUZZED_CASE, {change});
    const std::string written = case_text(the_case);
    require(case_text(parse_case(written, "/fuzz/case.toml")) == written,
            "changed case is not the same after writing and reading");
  } catch (const InputError& error) {
    check_message(error);
  }
}

void read_as_csv(const std::uint8_t* data, std::size_t size) {
  const auto file = file_with(data, size);
  for (const bool allow_empty : {false, true}) {
    try {
      const NumericTable table = read_numeric_csv(file, allow_empty);
      for (const auto& row : table.rows) {
        require(row.size() == table.header.size(), "row and header differ in length");
        for (const double value : row)
          require(std::isfinite(value) || (allow_empty && !is_computed(value)),
                  "number is not finite");
      }
    } catch (const InputError& error) {
      check_message(error);
    }
  }
  try {
    const ForeignTable table = read_table(file);
    require(table.rows.size() == table.lines.size() && table.header.size() == table.units.size() &&
                table.header.size() == table.digits.size(),
            "table is not complete");
    for (const auto& row : table.rows)
      require(row.size() == table.header.size(), "row of a table is not complete");
  } catch (const InputError& error) {
    check_message(error);
  }
}

void read_as_curve(const std::uint8_t* data, std::size_t size) {
  try {
    const OpeningTable opening = read_opening_table(file_with(data, size));
    require(opening.area.size() >= 3 && opening.area.size() == opening.theta_deg.size(),
            "opening has too few points");
    for (const double area : opening.area) require(area >= 0, "opening is negative");
  } catch (const InputError& error) {
    check_message(error);
  }
  try {
    PressureSpec spec;
    spec.kind = PressureKind::curve;
    spec.file = file_with(data, size);
    spec.curve = read_pressure_curve(spec.file);
    const PressureTrace trace(spec);
    for (const double angle : {-1e9, -0.5, 0.0, 33.0, 359.999, 720.0}) (void)trace(angle);
    // Through its points, where they do not lie closer than round-off.
    const auto& x = spec.curve.theta_deg;
    bool apart = true;
    for (std::size_t i = 1; i < x.size(); ++i) apart = apart && x[i] - x[i - 1] > 1e-3;
    if (!apart || std::abs(x.front()) > 1e6) return;
    double largest = 0;
    for (const double p : spec.curve.pressure) largest = std::max(largest, std::abs(p));
    if (!(largest > 1e-200 && largest < 1e200)) return;
    for (std::size_t i = 0; i < x.size(); ++i)
      require(std::abs(trace(x[i]) - spec.curve.pressure[i]) <= 1e-2 * largest,
              "spline misses a point");
  } catch (const InputError& error) {
    check_message(error);
  }
}

void read_as_drive(const std::uint8_t* data, std::size_t size) {
  const auto file = file_with(data, size);
  for (const DriveKind kind : {DriveKind::speed, DriveKind::torque}) {
    try {
      const TimeCurve curve = read_drive_curve(file, kind);
      const TimeSignal signal(curve);
      const auto [low, high] = std::minmax_element(curve.value.begin(), curve.value.end());
      const double span = curve.time.back() - curve.time.front();
      const double slack = 1e-9 * (std::abs(*low) + std::abs(*high));
      for (const double share : {-1.0, 0.0, 0.3, 0.999, 2.0}) {
        const double time = curve.time.front() + share * span;
        const double value = signal.value(time);
        if (std::isfinite(time) && std::isfinite(slack) && std::isfinite(*high - *low))
          require(value >= *low - slack && value <= *high + slack, "curve leaves its points");
        (void)signal.slope(time);
        (void)signal.integral(time);
      }
    } catch (const InputError& error) {
      check_message(error);
    }
  }
}

void read_as_states(const std::uint8_t* data, std::size_t size) {
  static const Case the_case = read_case(BENTAXIS_FUZZED_CASE);
  static const PressureTrace pressure(the_case.pressure);
  try {
    const States states = read_states(file_with(data, size), the_case, pressure);
    require(states.rows() > 0 && states.given.size() == states.rows() * states.header.size() &&
                states.chamber_pressure.size() == states.rows() * states.pistons,
            "states are not complete");
    const MotionTable table = analytic::run_states(the_case, the_case.analytic, states);
    const std::string text = to_csv(table);
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    const NumericTable again = read_numeric_csv(file_with(bytes, text.size()), true);
    require(again.rows.size() == states.rows(), "table has lost rows");
    for (std::size_t row = 0; row < again.rows.size(); ++row)
      for (std::size_t c = 0; c < states.header.size(); ++c)
        require(again.rows[row][c] == table.state(row, c), "state is not the same when read back");
  } catch (const InputError& error) {
    check_message(error);
  } catch (const ComputationError& error) {
    check_message(error);
  }
}

}  // namespace bentaxis::fuzz
