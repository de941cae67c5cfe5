#include "platforms.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "bentaxis/files/input_file.h"
#include "bentaxis/files/module_folders.h"
#include "bentaxis/pump/error.h"
#include "description.h"
#include "embedded.h"

namespace bentaxis::fmu {
namespace {

namespace fs = std::filesystem;

struct Facts {
  const char* name;      // as FMI 3 names it, and its folder there
  const char* folder_2;  // FMI 2's; none where it knows no such platform
  const char* ending;
  const char* words;
};
// In the order of Platform.
constexpr std::array<Facts, 3> kFacts = {
    {{"x86_64-linux", "linux64", ".so", "Linux on x86-64"},
     {"x86_64-windows", "win64", ".dll", "Windows on x86-64"},
     {"aarch64-linux", nullptr, ".so", "Linux on 64-bit ARM"}}};

constexpr InputKind kLibrary = {"the library of an FMU", 64 * kMebibyte};
constexpr InputKind kSource = {"a source of an FMU", 64 * kMebibyte};

const Facts& facts_of(Platform platform) { return kFacts[static_cast<std::size_t>(platform)]; }

std::string library_name(Platform platform) {
  return std::string(kModelIdentifier) + facts_of(platform).ending;
}

// Where libraries and sources are installed: the folder that has a file; empty where none has it.
fs::path folder_with(const fs::path& file) {
  for (const fs::path& modules : module_folders()) {
    std::error_code none;
    if (fs::is_regular_file(modules / "fmu" / file, none)) return modules / "fmu";
  }
  return {};
}

// The folder with the library of a platform; empty where there is none.
fs::path folder_of(Platform platform) {
  const fs::path name = facts_of(platform).name;
  const fs::path folder = folder_with(name / library_name(platform));
  return folder.empty() ? folder : folder / name;
}

bool is_known(Version version, Platform platform) {
  return version == Version::fmi3 || facts_of(platform).folder_2 != nullptr;
}

bool is_there(Platform platform) {
  return platform == Platform::x86_64_linux || !folder_of(platform).empty();
}

// The least version of glibc that has all symbols the library needs: they stand in it as
// "GLIBC_2.35". Empty where it needs none.
std::string needed_glibc(std::string_view library) {
  constexpr std::string_view kPrefix = "GLIBC_2.";
  int newest = 0;
  for (auto at = library.find(kPrefix); at != std::string_view::npos;
       at = library.find(kPrefix, at + 1)) {
    int minor = 0;
    const char* const first = library.data() + at + kPrefix.size();
    std::from_chars(first, library.data() + library.size(), minor);
    newest = std::max(newest, minor);
  }
  return newest == 0 ? "" : "2." + std::to_string(newest);
}

PlatformLibrary library_of(Version version, Platform platform) {
  const Facts& facts = facts_of(platform);
  const char* const folder = version == Version::fmi2 ? facts.folder_2 : facts.name;
  PlatformLibrary it;
  it.place = "binaries/" + std::string(folder) + "/" + library_name(platform);
  if (platform == Platform::x86_64_linux) {
    it.bytes = embedded_library();
  } else {
    const fs::path installed = folder_of(platform);
    it.bytes = read_input_file(installed / library_name(platform), kLibrary);
    it.licences = read_input_file_if_there(installed / "licences.txt", kLibrary).value_or("");
  }
  const std::string glibc = needed_glibc(it.bytes);
  it.needs = facts.words + (glibc.empty() ? "" : " with glibc " + glibc + " or newer");
  return it;
}

}  // namespace

std::vector<std::string> platform_names() {
  std::vector<std::string> names;
  for (const Facts& facts : kFacts) names.emplace_back(facts.name);
  return names;
}

std::vector<Platform> installed_platforms(Version version) {
  std::vector<Platform> platforms;
  for (std::size_t i = 0; i < kFacts.size(); ++i) {
    const auto platform = static_cast<Platform>(i);
    if (is_known(version, platform) && is_there(platform)) platforms.push_back(platform);
  }
  return platforms;
}

std::vector<PlatformLibrary> platform_libraries(Version version,
                                                const std::vector<Platform>& platforms) {
  std::vector<PlatformLibrary> libraries;
  for (auto it = platforms.begin(); it != platforms.end(); ++it) {
    const std::string given = std::string("--platforms ") + facts_of(*it).name;
    if (std::find(platforms.begin(), it, *it) != it)
      throw InputError(given + ": is specified more than once");
    if (!is_known(version, *it))
      throw InputError(given + ": FMI 2.0 has no folder for it; --fmi 3 has");
    if (!is_there(*it))
      throw InputError(given +
                       ": its library is not installed; scripts/build_fmu_platforms builds it");
    libraries.push_back(library_of(version, *it));
  }
  return libraries;
}

std::vector<ArchiveFile> source_files(Version version) {
  const std::string given = "--sources";
  if (version == Version::fmi2)
    throw InputError(given + ": source code of FMI 2.0 must be C, and this is C++; --fmi 3 has it");
  const fs::path folder = folder_with(fs::path("sources") / "buildDescription.xml");
  if (folder.empty())
    throw InputError(given +
                     ": the sources are not installed; scripts/build_fmu_platforms collects them");
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "sources"))
    if (entry.is_regular_file()) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<ArchiveFile> files;
  for (const fs::path& path : paths)
    files.push_back(
        {path.lexically_relative(folder).generic_string(), read_input_file(path, kSource)});
  return files;
}

std::string needs_of(const std::vector<PlatformLibrary>& libraries) {
  std::string text;
  for (std::size_t i = 0; i < libraries.size(); ++i)
    text += (i == 0 ? "" : i + 1 == libraries.size() ? " and " : ", ") + libraries[i].needs;
  return text;
}

}  // namespace bentaxis::fmu
