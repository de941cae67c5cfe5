// What a command is asked, as text.
#pragma once

#include <cctype>
#include <string>
#include <vector>

namespace bentaxis::report {

/// With a capital and a full stop.
inline std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
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
