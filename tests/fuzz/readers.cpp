#include "readers.h"

#include <zip.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <list>
#include <string>
#include <string_view>

#include "bentaxis/analytic/model.h"
#include "bentaxis/files/case_file.h"
#include "bentaxis/files/case_writer.h"
#include "bentaxis/files/csv.h"
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/fmu/slave.h"
#include "bentaxis/pump/case.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/time_signal.h"
#include "bentaxis/results/result_table.h"
#include "scratch.h"
#include "unpacked.h"

namespace bentaxis::fuzz {
namespace {

void check_table(const ForeignTable& table) {
  require(table.rows.size() == table.lines.size() && table.header.size() == table.units.size() &&
              table.header.size() == table.digits.size(),
          "table is not complete");
  for (const auto& row : table.rows)
    require(row.size() == table.header.size(), "row of a table is not complete");
  for (const auto* names : {&table.header, &table.units})
    for (const std::string& name : *names)
      require(is_utf8(name) && !has_control_characters(name, true), "name is no plain text");
}

// Reads a table; where it is refused, with a message of one line.
void read_as_table(const std::filesystem::path& file) {
  try {
    check_table(read_table(file));
  } catch (const InputError& error) {
    check_message(error);
  }
}

bool is_archive(const std::uint8_t* data, std::size_t size) {
  return size >= 2 && data[0] == 'P' && data[1] == 'K';
}

// An archive of parts, each behind a line "--- NAME".
std::string archive_of(const std::string& parts) {
  constexpr std::string_view kLine = "--- ";
  zip_source_t* const target = zip_source_buffer_create(nullptr, 0, 0, nullptr);
  require(target != nullptr, "no memory");
  zip_source_keep(target);
  zip_t* const archive = zip_open_from_source(target, ZIP_TRUNCATE, nullptr);
  require(archive != nullptr, "no archive");
  std::list<std::string> contents;  // until the archive is closed
  for (std::size_t at = parts.find(kLine); at != std::string::npos;) {
    const std::size_t end_of_name = std::min(parts.find('\n', at), parts.size());
    const std::string name = parts.substr(at + kLine.size(), end_of_name - at - kLine.size());
    const std::size_t next = parts.find("\n" + std::string(kLine), end_of_name);
    const std::size_t begin = std::min(end_of_name + 1, parts.size());
    contents.push_back(parts.substr(begin, std::max(next, begin) - begin));
    zip_source_t* const content =
        zip_source_buffer(archive, contents.back().data(), contents.back().size(), 0);
    const zip_int64_t index = zip_file_add(archive, name.c_str(), content, ZIP_FL_ENC_GUESS);
    if (index < 0)
      zip_source_free(content);  // no name, or one that is there already
    else
      zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
    at = next == std::string::npos ? next : next + 1;
  }
  std::string bytes;
  if (zip_close(archive) != 0) {
    zip_discard(archive);
  } else if (zip_source_open(target) == 0) {
    zip_stat_t facts;
    zip_source_stat(target, &facts);
    bytes.resize(facts.size);
    require(zip_source_read(target, bytes.data(), bytes.size()) ==
                static_cast<zip_int64_t>(bytes.size()),
            "archive cannot be read back");
    zip_source_close(target);
  }
  zip_source_free(target);
  return bytes;
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
  read_as_table(file);
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
    const StrokeTable stroke = read_stroke_table(file_with(data, size));
    require(stroke.value.size() >= 4 && stroke.value.size() == stroke.theta_deg.size(),
            "stroke has too few points");
    for (const double value : stroke.value) require(std::isfinite(value), "stroke is not finite");
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

void read_as_matlab(const std::uint8_t* data, std::size_t size) {
  read_as_table(named_file_with("record.mat", data, size));
}

void read_as_workbook(const std::uint8_t* data, std::size_t size) {
  if (is_archive(data, size)) {
    read_as_table(file_with(data, size));
    return;
  }
  const std::string archive = archive_of({reinterpret_cast<const char*>(data), size});
  read_as_table(file_with(reinterpret_cast<const std::uint8_t*>(archive.data()), archive.size()));
}

void read_as_fmu(const std::uint8_t* data, std::size_t size) {
  try {
    std::string xml(reinterpret_cast<const char*>(data), size);
    if (is_archive(data, size)) {
      constexpr std::uint64_t kMax = 1ULL << 20U;
      const fmu::Unpacked unpacked(file_with(data, size), kMax);
      for (const auto& entry : std::filesystem::recursive_directory_iterator(unpacked.folder()))
        require(entry.is_directory() || entry.is_regular_file(), "unpacked what is no file");
      xml = unpacked.description();
    }
    const fmu::UnitDescription description = fmu::read_description(xml, "fuzz.fmu");
    require(description.version == 2 || description.version == 3, "of no known version");
    require(description.identifier.find('/') == std::string::npos, "identifier is a path");
    for (const fmu::UnitVariable& variable : description.variables) {
      require(description.find(variable.name) != nullptr, "variable is not found by its name");
      require(!has_control_characters(variable.name, true), "name is no plain text");
      if (variable.measure) require(variable.measure->factor != 0, "unit has no size");
    }
  } catch (const InputError& error) {
    check_message(error);
  }
}

}  // namespace bentaxis::fuzz
