#include "bentaxis/pump/words.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace bentaxis {
namespace {

// Share of two words' letters that stand in both in the same order: 1 for the same word, 0 where no
// letter is common. Parts of a long name that were left out cost little.
double likeness(const std::string& a, const std::string& b) {
  const auto same = [](unsigned char x, unsigned char y) {
    return std::tolower(x) == std::tolower(y);
  };
  std::vector<std::size_t> common(b.size() + 1);  // of a's letters so far and b's first j
  for (const char letter : a) {
    std::size_t diagonal = 0;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = common[j];
      common[j] = same(letter, b[j - 1]) ? diagonal + 1 : std::max(above, common[j - 1]);
      diagonal = above;
    }
  }
  return 2.0 * static_cast<double>(common.back()) / static_cast<double>(a.size() + b.size());
}

std::size_t digits_from(const std::string& text, std::size_t from) {
  const std::size_t end = text.find_first_not_of("0123456789", from);
  return std::min(end, text.size()) - from;
}

std::string allowed(const std::set<std::string>& known, const std::string& more) {
  constexpr std::size_t kMaxShown = 40;  // more are no line that anybody reads
  std::string names;
  std::size_t shown = 0;
  for (const auto& name : known) {
    if (known.size() > kMaxShown && shown == kMaxShown / 4) break;
    names += (names.empty() ? "" : ", ") + name;
    ++shown;
  }
  if (shown < known.size())
    names += " and " + std::to_string(known.size() - shown) + " more, " + more;
  return "; allowed: " + names;
}

}  // namespace

std::optional<std::string> meant(const std::string& word, const std::set<std::string>& known,
                                 double alike) {
  const auto nearest = std::max_element(
      known.begin(), known.end(),
      [&](const auto& a, const auto& b) { return likeness(word, a) < likeness(word, b); });
  if (nearest == known.end() || likeness(word, *nearest) < alike) return std::nullopt;
  return *nearest;
}

std::string suggestion(const std::string& word, const std::set<std::string>& known,
                       const std::string& more) {
  if (known.empty()) return "";
  const std::string beginning = word.substr(0, word.rfind('.') + 1);  // npos + 1 is 0
  std::set<std::string> alike, ends;
  for (const auto& name : known)
    if (!beginning.empty() && name.starts_with(beginning)) {
      alike.insert(name);
      ends.insert(name.substr(beginning.size()));
    }
  if (!alike.empty()) {
    const auto nearest = meant(word.substr(beginning.size()), ends);
    return nearest ? "; did you mean \"" + beginning + *nearest + "\"?" : allowed(alike, more);
  }
  if (const auto nearest = meant(word, known)) return "; did you mean \"" + *nearest + "\"?";
  return allowed(known, more);
}

std::string decimal_point_hint(const std::string& text) {
  const std::size_t start = text.find_first_of("+-") == 0 ? 1 : 0;
  const std::size_t comma = start + digits_from(text, start);
  if (comma == start || comma >= text.size() || text[comma] != ',') return "";
  const std::size_t end = comma + 1 + digits_from(text, comma + 1);
  if (end == comma + 1 || (end < text.size() && text[end] != 'e' && text[end] != 'E')) return "";
  std::string point = text;
  point[comma] = '.';
  return "; decimals follow a point: " + point;
}

}  // namespace bentaxis
