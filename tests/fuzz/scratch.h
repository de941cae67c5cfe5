// What the readers under test have in common: files in memory, and what must hold.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>

namespace bentaxis::fuzz {

/// Ends the program in every build type where a condition does not hold: a fuzzer reports it.
void require(bool condition, const char* what);

/// A file that holds the bytes; it lives in memory, so that the disk does not set the pace.
std::filesystem::path file_with(const std::uint8_t* data, std::size_t size);
/// The same under a name, in a folder of its own.
std::filesystem::path named_file_with(const std::string& name, const std::uint8_t* data,
                                      std::size_t size);
/// The folder of named files, which goes with the program.
const std::filesystem::path& scratch_folder();

/// That a refusal is one line of plain text.
void check_message(const std::exception& error);

}  // namespace bentaxis::fuzz
