// A .fmu unpacked into a folder. Internal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace bentaxis::fmu {

/// Of what is unpacked, whatever the archive says of its sizes.
inline constexpr std::uint64_t kMostUnpacked = 1ULL << 30;

/// @throws InputError where it does not exist or is no regular file
void check_archive(const std::filesystem::path& archive);

class Unpacked {
 public:
  /// Description, resources and the libraries of this machine.
  /// @param folder  that is there
  /// @throws InputError where the file is no archive, or one that should not be unpacked
  Unpacked(const std::filesystem::path& archive, std::filesystem::path folder,
           std::uint64_t most = kMostUnpacked);

  const std::filesystem::path& folder() const { return folder_; }
  std::string description() const;
  /// Folders below binaries/, as the archive has them.
  const std::vector<std::string>& platforms() const { return platforms_; }

 private:
  void unpack(const std::filesystem::path& file, std::uint64_t most);

  std::filesystem::path folder_;
  std::vector<std::string> platforms_;
};

/// Folder of this machine's libraries in an archive. @param version  of FMI
std::string platform_folder(int version);

}  // namespace bentaxis::fmu
