// A case: a pump, how it runs, and the pressure in its chambers.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/bearing_ratings.h"
#include "bentaxis/pump/drive_spec.h"
#include "bentaxis/pump/hydraulic_data.h"
#include "bentaxis/pump/parameters.h"
#include "bentaxis/pump/pressure.h"

namespace bentaxis {

struct Operation {
  double speed_rpm = 0;  ///< sign gives the direction
  int revolutions = 1;   ///< of an integrated run
  int samples_per_revolution = 720;
};

/// One key of an input file as read, for reports.
struct InputEntry {
  std::string table;  ///< "pump"; "" for the top level
  std::string key;
  std::string value;
  bool defaulted = false;
  bool changed = false;  ///< by --set
};

/// What is not known exactly, [uncertainty], as text: designs/distribution.h says what it means.
struct UncertaintyData {
  struct Parameter {
    std::string name;          ///< "pump.tilt_deg"
    std::string distribution;  ///< "normal(40, 0.1)"
  };
  struct Correlation {
    std::string first, second;  ///< names of parameters
    double coefficient = 0;     ///< in [-1, 1]
  };
  std::vector<Parameter> parameters;
  std::vector<Correlation> correlations;
};

/// A file that was read, and what was in it.
struct InputFile {
  std::filesystem::path file;  ///< as it was named
  std::string sha256;          ///< of its bytes: 64 hexadecimal digits
};

struct Case {
  // Compiled once: nearly every source copies cases.
  Case();
  ~Case();
  Case(const Case& other);
  Case(Case&& other) noexcept;
  Case& operator=(const Case& other);
  Case& operator=(Case&& other) noexcept;

  std::filesystem::path file;
  std::string name;
  PumpParameters pump;
  BearingRatings ratings;  ///< of the pump's bearings, where their life may be asked for
  Operation operation;
  PressureSpec pressure;
  std::optional<HydraulicData> hydraulics;  ///< present where pressure.kind is hydraulic
  std::optional<DriveSpec> drive;           ///< what turns the shaft in time, of a simulation
  Assumptions analytic;                     ///< what the analytic model assumes in this case
  Assumptions multibody;                    ///< what the multibody model assumes
  UncertaintyData uncertainty;              ///< empty where nothing is said
  std::string meant;  ///< reasons for implausible values: "CODE: reason; CODE: reason"
  std::vector<InputEntry> entries;  ///< as read from a file; empty for a case made in memory
  std::vector<InputFile> inputs;    ///< that the case was read from, each with what was read
};

}  // namespace bentaxis
