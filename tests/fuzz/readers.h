// What is fuzzed: the readers of files that come from outside.
#pragma once

#include <cstddef>
#include <cstdint>

namespace bentaxis::fuzz {

/// Reads bytes as a case file. Where it is accepted, the case is written, read again and must be
/// the same; a small part of a turn must evaluate to finite numbers or end in a ComputationError.
/// Anything but InputError and ComputationError escapes.
void read_as_case(const std::uint8_t* data, std::size_t size);

/// Takes bytes as a change, --set TABLE.KEY=VALUE, of a shipped case, which must write and read
/// back to the same.
void read_as_change(const std::uint8_t* data, std::size_t size);

/// Reads bytes as a CSV file of numbers, with and without empty fields.
void read_as_csv(const std::uint8_t* data, std::size_t size);

/// Reads bytes as a pressure curve, makes its periodic spline and evaluates it.
void read_as_curve(const std::uint8_t* data, std::size_t size);

/// Reads bytes as a speed and as a torque over time, whose curve is then evaluated.
void read_as_drive(const std::uint8_t* data, std::size_t size);

/// Reads bytes as states of a shipped case's pump. Where they are accepted the reactions there must
/// be finite or end in a ComputationError, and their table must read back.
void read_as_states(const std::uint8_t* data, std::size_t size);

/// Reads bytes as a MATLAB file, of any version.
void read_as_matlab(const std::uint8_t* data, std::size_t size);

/// Reads bytes as an Excel workbook: as its archive where they begin as one, else as its parts in
/// plain text, each behind a line "--- NAME", from which the archive is made.
void read_as_workbook(const std::uint8_t* data, std::size_t size);

/// Reads bytes as an FMU's archive where they begin as one, else as its modelDescription.xml.
void read_as_fmu(const std::uint8_t* data, std::size_t size);

/// Reads bytes as a finished block of a sweep. The SHA-256 at its end is made right, so that the
/// reader does not end there.
void read_as_block(const std::uint8_t* data, std::size_t size);

/// Reads bytes as a study file of sweep. Where it is accepted, the plan is written, read again and
/// must be the same.
void read_as_study(const std::uint8_t* data, std::size_t size);

/// Reads bytes as a file of data of identify.
void read_as_data(const std::uint8_t* data, std::size_t size);

}  // namespace bentaxis::fuzz
