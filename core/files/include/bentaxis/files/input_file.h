// How input files are opened: every reader takes the bytes that this reads, and no other.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace bentaxis {

/// Kinds of input files; each has a maximum size, in bytes.
struct InputKind {
  const char* name;       ///< for messages, with its article: "a case file"
  std::uint64_t largest;  ///< bytes
};

inline constexpr std::uint64_t kMebibyte = 1ULL << 20U;
/// TOML files: cases, study files, files of data, mappings, descriptions.
inline constexpr std::uint64_t kLargestSettings = 64 * kMebibyte;
/// Tables: curves, records, states, in any of the formats that are read.
inline constexpr std::uint64_t kLargestTable = 256 * kMebibyte;
/// Reports that `index` reads, and files of finished work (blocks of a sweep, rows of a map).
inline constexpr std::uint64_t kLargestReport = 1024 * kMebibyte;

/// The content of a regular file. Directories, pipes, devices and sockets are refused before a byte
/// of them is read: what they would give has no end, or is gone for whoever reads it again.
/// @throws InputError naming the file, and its size and the limit where it is too large
std::string read_input_file(const std::filesystem::path& file, const InputKind& kind);

/// The same of a file that need not be there: nothing where it does not exist.
/// @throws InputError where it exists and cannot be read
std::optional<std::string> read_input_file_if_there(const std::filesystem::path& file,
                                                    const InputKind& kind);

}  // namespace bentaxis
