// What a command is asked, as text.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

namespace bentaxis::report {

/// With a full stop, and with a capital unless it begins with a key of a case file: "drive.kind".
inline std::string sentence(std::string text) {
  if (text.empty()) return text;
  const std::size_t end = std::min(text.find(' '), text.size() - 1);
  const bool key = text.find('.') < end;  // within the first word
  if (!key) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text.back() == '.' ? text : text + ".";
}

/// The head of what a command prints: the name of the case, the headline, the answers.
inline std::string answers_text(const std::string& name, const std::string& headline,
                                const std::vector<std::string>& answers) {
  std::string text = name.empty() ? "" : name + "\n";
  text += headline + "\n";
  for (const std::string& answer : answers) text += answer + "\n";
  return text + "\n";
}

}  // namespace bentaxis::report
