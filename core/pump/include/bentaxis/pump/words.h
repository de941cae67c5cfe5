// Words for messages: what was probably meant.
#pragma once

#include <optional>
#include <set>
#include <string>

namespace bentaxis {

/// The word of `known` that is most like `word`, where one is alike enough to have been meant:
/// letters left out, added, exchanged, of another case.
/// @param alike  share of their letters that must be common, in the same order
std::optional<std::string> meant(const std::string& word, const std::set<std::string>& known,
                                 double alike = 0.6);

/// "; did you mean ...?" for a word that is like one of those known, or else a list of them, of
/// very many the first. Where some have the word's own beginning up to its last point, as
/// efficiency.mechanical has that of efficiency.total, only they are considered.
/// @param more  where the others are listed
std::string suggestion(const std::string& word, const std::set<std::string>& known,
                       const std::string& more = "in docs/");

/// "; decimals follow a point: 40.0" for text such as 40,0; "" for any other.
std::string decimal_point_hint(const std::string& text);

}  // namespace bentaxis
