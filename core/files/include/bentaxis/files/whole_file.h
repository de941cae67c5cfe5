// Single files that are there whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace bentaxis {

/// Ending of the names under which write_whole() writes.
inline constexpr const char* kUnfinished = ".part";

/// Writes a file under a name that no other process or thread has, and renames it. A reader sees
/// the old content or the new one. On failure nothing of it is left.
/// @throws InputError naming the file and the reason, such as a full disk
void write_whole(const std::filesystem::path& file, const std::string& content);

}  // namespace bentaxis
