// A .fmu unpacked into a folder that goes with its owner. Internal.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace bentaxis::fmu {

/// Of what is unpacked, whatever the archive says of its sizes.
inline constexpr std::uint64_t kMaxUnpacked = 1ULL << 30;

class Unpacked {
 public:
  /// Description, resources and the libraries of this machine.
  /// @param made  called once the folder is there, and nothing in it
  /// @throws InputError where the file is no archive, or one that should not be unpacked
  explicit Unpacked(const std::filesystem::path& archive, std::uint64_t most = kMaxUnpacked,
                    const std::function<void(const std::filesystem::path& folder)>& made = {});
  ~Unpacked();
  Unpacked(const Unpacked&) = delete;
  Unpacked& operator=(const Unpacked&) = delete;

  const std::filesystem::path& folder() const { return folder_; }
  std::string description() const;
  /// Folders below binaries/, as the archive has them.
  const std::vector<std::string>& platforms() const { return platforms_; }

 private:
  void unpack(const std::filesystem::path& file, std::uint64_t most);
  void remove() noexcept;

  std::filesystem::path file_, folder_;
  std::vector<std::string> platforms_;
};

/// Folder of this machine's libraries in an archive. @param version  of FMI
std::string platform_folder(int version);

}  // namespace bentaxis::fmu
