// A case: a pump, how it runs, and the pressure in its chambers; plus how it is read from a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"

namespace bentaxis {

struct Operation {
  double speed_rpm = 0;  ///< sign gives the direction
  int revolutions = 1;   ///< of an integrated run
  int samples_per_revolution = 720;
};

/// One key of the case file as read, for reports.
struct CaseEntry {
  std::string table;  ///< "pump"; "" for the top level
  std::string key;
  std::string value;
  bool defaulted = false;
};

struct Case {
  std::filesystem::path file;
  std::string name;
  PumpParameters pump;
  Operation operation;
  PressureSpec pressure;
  std::optional<HydraulicData> hydraulics;  ///< present where pressure.kind is hydraulic
  Assumptions analytic;                     ///< what the analytic model assumes in this case
  Assumptions multibody;                    ///< what the multibody model assumes
  std::vector<CaseEntry> entries;
};

/// Reads and validates a case file (TOML, schema 1; docs/case_file.md).
/// @throws InputError with one line that names file, line, key, value and allowed range.
Case read_case(const std::filesystem::path& file);

/// The same for text already in memory; `file` is used in messages and to resolve a curve's path.
Case parse_case(const std::string& text, const std::filesystem::path& file);

}  // namespace bentaxis
