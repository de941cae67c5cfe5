#include "bentaxis/study/memory.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>

#include "bentaxis/pump/error.h"

namespace bentaxis::study {
namespace {

namespace fs = std::filesystem;
constexpr double kUnknown = std::numeric_limits<double>::infinity();

// The number that a line of the system's begins with; "max" and what is not there are none.
std::optional<double> number_at(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop == text.data()) return std::nullopt;
  return value;
}

// Behind a name at the beginning of a line of a file.
std::optional<double> number_behind(const fs::path& file, const std::string& name) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(name)) return number_at(std::string_view(line).substr(name.size()));
  return std::nullopt;
}

// What a control group leaves: what it holds of files it can give up.
double left_in(const fs::path& limit, const fs::path& used, const fs::path& facts,
               const std::string& files) {
  const auto most = number_behind(limit, ""), now = number_behind(used, "");
  if (!most || !now) return kUnknown;
  return std::max(0.0, *most - *now + number_behind(facts, files).value_or(0));
}

double left_in_control_group() {
  double left = kUnknown;
  std::ifstream in("/proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    // "0::/path" of the second version, "N:memory:/path" of the first. In a container the path is
    // that of the host, and its own files lie at the top.
    const std::size_t second = line.find(':', line.find(':') + 1);
    if (second == std::string::npos) continue;
    const std::string kinds = line.substr(0, second), path = line.substr(second + 1);
    for (const std::string& place : {path, std::string()}) {
      if (kinds == "0:") {
        const fs::path group = "/sys/fs/cgroup" + place;
        left = std::min(left, left_in(group / "memory.max", group / "memory.current",
                                      group / "memory.stat", "inactive_file "));
      } else if (kinds.ends_with(":memory")) {
        const fs::path group = "/sys/fs/cgroup/memory" + place;
        left =
            std::min(left, left_in(group / "memory.limit_in_bytes", group / "memory.usage_in_bytes",
                                   group / "memory.stat", "total_inactive_file "));
      }
    }
  }
  return left;
}

double left_of_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  const double taken = number_behind("/proc/self/statm", "").value_or(0) *
                       static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - taken);
}

}  // namespace

double available_memory() {
  const auto kilobytes = number_behind("/proc/meminfo", "MemAvailable:");
  return std::min(
      {kilobytes ? *kilobytes * 1024 : kUnknown, left_in_control_group(), left_of_address_space()});
}

void require_memory(double needed, const std::string& what, const std::string& advice,
                    double available) {
  if (needed <= available) return;
  throw InputError(
      fmt::format("{}: about {:.3g} GB of memory are needed, and {:.3g} GB are "
                  "available; {}",
                  what, needed / 1e9, available / 1e9, advice));
}

}  // namespace bentaxis::study
