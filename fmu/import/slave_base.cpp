#include "slave_base.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/number.h"

namespace bentaxis::fmu {
namespace {

constexpr std::size_t kMostLines = 1000;
constexpr std::size_t kLongestLine = 400;

const char* word_of(int status) {
  static const char* words[] = {"info", "warning", "discard", "error", "fatal"};
  return status >= 0 && status <= 4 ? words[status] : "unknown status";
}

}  // namespace

void UnitLog::add(int status, const char* message) noexcept {
  try {
    const std::lock_guard<std::mutex> lock(busy_);
    if (lines_.size() >= kMostLines) return;
    std::string line = message != nullptr ? message : "";
    for (char& c : line)
      if (static_cast<unsigned char>(c) < ' ') c = ' ';
    while (!line.empty() && line.back() == ' ') line.pop_back();
    if (line.size() > kLongestLine) line = line.substr(0, kLongestLine) + "..";
    lines_.push_back(std::string(word_of(status)) + ": " + line);
  } catch (...) {  // without memory there is nothing to be said
  }
}

std::string UnitLog::news() {
  const std::lock_guard<std::mutex> lock(busy_);
  constexpr std::size_t kMost = 3;
  std::string text;
  // The last ones are nearest to the reason.
  for (std::size_t i = std::max(told_, lines_.size() - std::min(lines_.size(), kMost));
       i < lines_.size(); ++i)
    text += (text.empty() ? "" : "; ") + lines_[i];
  told_ = lines_.size();
  return text;
}

void SlaveBase::fail(const std::string& what, const std::string& why) {
  failed_ = true;
  throw ComputationError(unit_ + ": " + what + ": " + why);
}

void SlaveBase::check(const std::string& what, int status) {
  if (status == 0 || status == 1) return;
  failed_ = true;
  fatal_ = status == 4;
  const std::string said = log_.news();
  fail(what, std::string("the unit returns ") + word_of(status) +
                 (said.empty() ? " and says nothing" : ", it says: " + said));
}

std::optional<WholeRange> whole_range(const std::string& type) {
  static const std::map<std::string, WholeRange> ranges = {
      {"Boolean", {0, 1}},
      {"Int8", {-128, 127}},
      {"UInt8", {0, 255}},
      {"Int16", {-32768, 32767}},
      {"UInt16", {0, 65535}},
      {"Integer", {-2147483648.0, 2147483647.0}},
      {"Enumeration", {-2147483648.0, 2147483647.0}},
      {"Int32", {-2147483648.0, 2147483647.0}},
      {"UInt32", {0, 4294967295.0}},
      // What a double counts without gaps.
      {"Int64", {-9007199254740992.0, 9007199254740992.0}},
      {"UInt64", {0, 9007199254740992.0}},
  };
  const auto found = ranges.find(type);
  if (found == ranges.end()) return std::nullopt;
  return found->second;
}

void SlaveBase::set(const UnitVariable& variable, double value) {
  const std::string what = "setting \"" + variable.name + "\"";
  if (!std::isfinite(value)) fail(what, "its value is not finite");
  if (!variable.numeric())
    fail(what, "is of type " + variable.type + (variable.array ? " with dimensions" : "") +
                   ": must be a single number");
  if (const auto range = whole_range(variable.type)) {
    const bool whole = value == std::round(value) && value >= range->low && value <= range->high;
    if (!whole)
      fail(what, number_text(value) + " is not what its type " + variable.type +
                     " holds: must be whole, in [" + number_text(range->low) + ", " +
                     number_text(range->high) + "]");
  }
  check(what, set_value(variable, value));
}

double SlaveBase::get(const UnitVariable& variable) {
  const std::string what = "reading \"" + variable.name + "\"";
  if (!variable.numeric())
    fail(what, "is of type " + variable.type + (variable.array ? " with dimensions" : "") +
                   ": must be a single number");
  double value = 0;
  check(what, get_value(variable, value));
  if (!std::isfinite(value)) fail(what, "its value is not finite");
  return value;
}

}  // namespace bentaxis::fmu
