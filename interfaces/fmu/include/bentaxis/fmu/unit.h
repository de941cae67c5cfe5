// A case as a Functional Mock-up Unit (FMI 2.0, 3.0): the analytic pump for a system simulator.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"

namespace bentaxis::fmu {

enum class Version { fmi2, fmi3 };
/// What turns the shaft of an FMU.
enum class Drive {
  speed,       ///< inputs drive_speed, drive_acceleration
  torque,      ///< input drive_torque
  as_in_case,  ///< no input: the [drive] of the case
};

/// Of a library in the archive.
enum class Platform { x86_64_linux, x86_64_windows, aarch64_linux };
/// By their names in FMI 3, in the order of Platform.
std::vector<std::string> platform_names();
/// Those that the version of FMI knows and that have an installed library
/// (scripts/build_fmu_platforms); x86_64_linux is always there.
std::vector<Platform> installed_platforms(Version version);

struct UnitOptions {
  Version version = Version::fmi2;
  std::vector<Platform> platforms = {Platform::x86_64_linux};
  Drive drive = Drive::speed;
  double tolerance = 1e-9;  ///< of a step of co-simulation, as in coupled::Options
  std::string model_name;   ///< empty: the name of the case
  std::string generated;    ///< date and time, ISO 8601 UTC; empty: left out of the description
  /// Outputs in units of the SI, with names that say so ("p_1_Pa"); else as the columns of
  /// `bentaxis simulate` ("p_1_bar").
  bool si_outputs = false;
  /// Also what the library is compiled from, with buildDescription.xml: of FMI 3, where
  /// scripts/build_fmu_platforms has collected it.
  bool sources = false;
};

/// The bytes of the .fmu: a zip archive with modelDescription.xml, the libraries, the case with its
/// curves and documentation. The same arguments give the same bytes.
/// @throws InputError where the case cannot be simulated so, or a platform is not installed, or the
/// sources are not
std::string unit_archive(const Case& the_case, const UnitOptions& options);

/// What such an FMU has.
struct UnitSummary {
  std::vector<std::string> inputs;  ///< by name
  std::size_t outputs = 0, states = 0, indicators = 0, parameters = 0;
  std::optional<double> start_torque;  ///< Nm, of the input drive_torque, where there is one
  std::string no_start_torque;  ///< why the mean torque of the operating point is not known; then 0
  std::string needs;            ///< what it runs on: "Linux on x86-64 with glibc 2.35 or newer"
};
/// @throws InputError as unit_archive
UnitSummary unit_summary(const Case& the_case, const UnitOptions& options);

}  // namespace bentaxis::fmu
