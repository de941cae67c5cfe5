#include "words.h"

#include <map>
#include <regex>

namespace bentaxis::python {
namespace {

// Options whose arguments are called otherwise here; others lose their dashes.
const std::map<std::string, std::string>& argument_names() {
  static const std::map<std::string, std::string> known = {
      {"output", "outputs"}, {"unknown", "unknowns"}, {"multibody-case", "multibody_case"}};
  return known;
}

}  // namespace

std::string in_python(const std::string& message) {
  static const std::regex set("--set ([\\w.-]+) ?= ?([^\\n]*?): ");
  static const std::regex option("(^|[ (\"])--([a-z][a-z-]*)");
  std::string text = std::regex_replace(message, set, "case[\"$1\"] = $2: ");
  std::string result;
  std::smatch found;
  while (std::regex_search(text, found, option)) {
    const std::string name = found[2];
    const auto other = argument_names().find(name);
    result += found.prefix().str() + found[1].str() +
              (other == argument_names().end() ? name : other->second);
    text = found.suffix();
  }
  return result + text;
}

}  // namespace bentaxis::python
