// Numbers of things in messages.
#pragma once

#include <string>
#include <string_view>

namespace bentaxis {

/// The word for so many things: "design" for 1, else "designs", or `more` where that is another.
template <class Count>
std::string word_for(Count count, std::string_view one, std::string_view more = {}) {
  if (count == 1) return std::string(one);
  return more.empty() ? std::string(one) + "s" : std::string(more);
}

/// So many things: "1 design", "12 designs", "1 row is", "2 rows are".
template <class Count>
std::string counted(Count count, std::string_view one, std::string_view more = {}) {
  return std::to_string(count) + " " + word_for(count, one, more);
}

}  // namespace bentaxis
