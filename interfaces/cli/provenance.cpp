#include "provenance.h"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <optional>
#include <string>

#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"
#include "versions.h"

namespace bentaxis::cli {
namespace {

std::string& command() {
  static std::string text;
  return text;
}

// As a shell would need it to give this word.
std::string shell_word(const std::string& word) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=,:+@%";
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char letter : word) quoted += letter == '\'' ? "'\\''" : std::string(1, letter);
  return quoted + "'";
}

std::optional<std::time_t> date_from_outside() {
  const char* const text = std::getenv("SOURCE_DATE_EPOCH");
  if (text == nullptr) return std::nullopt;
  const std::string seconds = text;
  constexpr long long kYear10000 = 253402300800;
  long long value = -1;
  const auto [end, error] = std::from_chars(seconds.data(), seconds.data() + seconds.size(), value);
  if (error != std::errc() || end != seconds.data() + seconds.size() || value < 0 ||
      value >= kYear10000)
    throw InputError("SOURCE_DATE_EPOCH=" + seconds +
                     ": must be the seconds since 1970 of a date, a whole number in [0, " +
                     std::to_string(kYear10000) + ")");
  return static_cast<std::time_t>(value);
}

std::string utc(std::time_t time) {
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[sizeof "9999-12-31T23:59:59Z"];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

// "Debian GNU/Linux 12 (bookworm), Linux 6.1.0 x86_64"
std::string operating_system() {
  std::string name;
  std::ifstream release("/etc/os-release");
  const std::string key = "PRETTY_NAME=";
  for (std::string line; std::getline(release, line);)
    if (line.starts_with(key)) name = line.substr(key.size());
  std::erase(name, '"');
  utsname kernel{};
  if (uname(&kernel) != 0) return name;
  return fmt::format("{}{}{} {} {}", name, name.empty() ? "" : ", ", kernel.sysname, kernel.release,
                     kernel.machine);
}

// The file's name and its folder's, which tell the case.toml of a set apart, and no path of the
// machine.
std::string short_name(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path().filename();
  return (folder / file.filename()).generic_string();
}

}  // namespace

void remember_command(int argc, const char* const* argv) {
  command() = "bentaxis";
  for (int i = 1; i < argc; ++i) command() += " " + shell_word(argv[i]);
}

void remember_command(const std::string& text) { command() = text; }

report::Provenance provenance() {
  report::Provenance provenance;
  provenance.command = command();
  provenance.date = utc(date_from_outside().value_or(
      std::chrono::system_clock::to_time_t(std::chrono::system_clock::now())));
  for (const InputFile& input : InputLog::files())
    provenance.inputs.push_back({short_name(input.file), input.sha256});
  for (const auto& [name, value] : shared_versions()) {
    if (name == "bentaxis") provenance.version = value;
    if (name == "processor" || name == "compiler") provenance.machine.emplace_back(name, value);
  }
  provenance.machine.emplace_back("system", operating_system());
  return provenance;
}

void add_provenance(report::Document& document) {
  document.provenance = provenance();
  if (date_from_outside() && document.models)
    for (report::ModelSection& model : *document.models) model.seconds = not_computed();
}

}  // namespace bentaxis::cli
