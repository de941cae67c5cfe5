#include "resources.h"

#include <sstream>

#include "bentaxis/files/case_file.h"
#include "bentaxis/files/input_file.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::fmu {
namespace {

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decoded(const std::string& text, const std::string& uri) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i];
      continue;
    }
    const int high = i + 2 < text.size() ? digit_of(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? digit_of(text[i + 2]) : -1;
    if (high < 0 || low < 0 || (high == 0 && low == 0))
      throw InputError("resources \"" + uri + "\": % must be followed by two hexadecimal digits");
    plain += static_cast<char>(high * 16 + low);
    i += 2;
  }
  return plain;
}

Drive drive_in(const std::string& word, const std::string& where) {
  if (word == "speed") return Drive::speed;
  if (word == "torque") return Drive::torque;
  if (word == "case") return Drive::as_in_case;
  throw InputError(where + ": drive " + word + ": must be speed, torque or case");
}

void read_choice(const std::filesystem::path& file, Resources& all) {
  std::istringstream in(read_input_file(file, {"a choice of the FMU", kMebibyte}));
  for (std::string line; std::getline(in, line);) {
    const auto blank = line.find(' ');
    const std::string key = line.substr(0, blank);
    const std::string value = blank == std::string::npos ? "" : line.substr(blank + 1);
    if (key == "drive") all.choice.drive = drive_in(value, file.string());
    if (key == "token") all.token = value;
    if (key == "outputs") {
      if (value != "si")
        throw InputError(file.string() + ": outputs " + value + ": must be si, or not there");
      all.choice.si_outputs = true;
    }
    if (key == "start_torque") {
      all.choice.start_torque = number_in(value);
      if (!all.choice.start_torque)
        throw InputError(file.string() + ": start_torque " + value + ": must be a number");
    }
    if (key != "tolerance") continue;
    const auto tolerance = number_in(value);
    if (!tolerance || !(*tolerance > 0))
      throw InputError(file.string() + ": tolerance " + value + ": must be a number > 0");
    all.choice.tolerance = *tolerance;
  }
  if (all.token.empty()) throw InputError(file.string() + ": token is missing");
}

#ifdef _WIN32
constexpr bool kHasDrives = true;
#else
constexpr bool kHasDrives = false;
#endif

// "C:\folder" or "C:/folder".
bool begins_with_drive(const std::string& path) {
  return path.size() > 1 && path[1] == ':' &&
         ((path[0] >= 'A' && path[0] <= 'Z') || (path[0] >= 'a' && path[0] <= 'z'));
}

}  // namespace

std::filesystem::path path_of_text(const std::string& text) {
  return std::u8string(text.begin(), text.end());
}

std::filesystem::path path_of_uri(const std::string& uri) {
  if (kHasDrives && begins_with_drive(uri)) return path_of_text(uri);
  const auto colon = uri.find(':');
  const auto slash = uri.find('/');
  if (colon == std::string::npos || slash < colon) return path_of_text(uri);  // no scheme
  std::string scheme = uri.substr(0, colon);
  for (char& c : scheme) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (scheme != "file") throw InputError("resources \"" + uri + "\": must be a file URI");
  std::string rest = uri.substr(colon + 1);
  if (rest.starts_with("//")) {  // with a host, which is this one
    const auto path = rest.find('/', 2);
    const std::string host = path == std::string::npos ? rest : rest.substr(2, path - 2);
    if (path == std::string::npos || !(host.empty() || host == "localhost"))
      throw InputError("resources \"" + uri + "\": must be a file of this computer");
    rest = rest.substr(path);
  }
  if (kHasDrives && rest.starts_with('/') && begins_with_drive(rest.substr(1)))
    rest.erase(0, 1);  // file:///C:/folder
  return path_of_text(decoded(rest, uri));
}

Resources read_resources(const std::filesystem::path& folder) {
  Resources all;
  read_choice(folder / "unit.txt", all);
  all.the_case = with_drive(read_case(folder / "case.toml"), all.choice.drive);
  return all;
}

}  // namespace bentaxis::fmu
