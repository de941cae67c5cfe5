#include "log.h"

#include <array>
#include <string_view>

#include "bentaxis/pump/lists.h"

namespace bentaxis::fmu {
namespace {

constexpr const char* kEvents = "logEvents";
constexpr const char* kAll = "logAll";
// Of messages, in the order of Status, and that of all of them.
constexpr std::array<const char*, 6> kCategories = {
    kEvents, "logStatusWarning", "logStatusDiscard", "logStatusError", "logStatusFatal", kAll};

}  // namespace

bool Log::set_debug(bool on, const std::vector<std::string>& categories) {
  bool events = categories.empty();
  for (const std::string& category : categories) {
    if (!contains(kCategories, category)) return false;
    events = events || category == kEvents || category == kAll;
  }
  debug_ = on;
  events_ = events;
  return true;
}

std::string shown(std::string text, std::size_t longest) {
  const std::size_t size = text.size();
  if (size > longest) {
    while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xC0U) == 0x80U) --longest;
    text.resize(longest);
    text += ".. (" + std::to_string(size) + " bytes)";
  }
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

Status Log::say(Status status, const std::string& message) const noexcept {
  try {
    constexpr std::size_t kLongest = 2000;
    if (sink_)
      sink_(status, kCategories[static_cast<std::size_t>(status)], shown(message, kLongest));
  } catch (...) {  // an importer's function that throws is no reason to stop
  }
  return status;
}

void Log::event(const std::string& message) const noexcept {
  if (tells_events()) say(Status::ok, message);
}

}  // namespace bentaxis::fmu
