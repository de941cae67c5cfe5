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

// A process is limited by its group and by every group above that one. In a container the path may
// be that of the host, while the container's own files lie at the top.
double left_in_groups(const fs::path& top, const fs::path& group, const char* limit,
                      const char* used, const std::string& files) {
  fs::path place = top;
  const auto left_here = [&] {
    return left_in(place / limit, place / used, place / "memory.stat", files);
  };
  double left = left_here();
  for (const fs::path& part : group.relative_path()) {
    place /= part;
    left = std::min(left, left_here());
  }
  return left;
}

double left_in_control_group(const fs::path& root) {
  const fs::path top = root / "sys/fs/cgroup";
  double left = kUnknown;
  std::ifstream in(root / "proc/self/cgroup");
  for (std::string line; std::getline(in, line);) {
    // "0::/path" of the second version, "N:cpu,memory:/path" of the first.
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string kinds = "," + line.substr(first + 1, second - first - 1) + ",";
    const fs::path group = line.substr(second + 1);
    if (kinds == ",,")
      left = std::min(left,
                      left_in_groups(top, group, "memory.max", "memory.current", "inactive_file "));
    else if (kinds.find(",memory,") != std::string::npos)
      left = std::min(left, left_in_groups(top / "memory", group, "memory.limit_in_bytes",
                                           "memory.usage_in_bytes", "total_inactive_file "));
  }
  return left;
}

double left_of_address_space(const fs::path& root) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnknown;
  const double taken = number_behind(root / "proc/self/statm", "").value_or(0) *
                       static_cast<double>(sysconf(_SC_PAGE_SIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - taken);
}

}  // namespace

double available_memory(const fs::path& root) {
  const auto kilobytes = number_behind(root / "proc/meminfo", "MemAvailable:");
  return std::min({kilobytes ? *kilobytes * 1024 : kUnknown, left_in_control_group(root),
                   left_of_address_space(root)});
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
