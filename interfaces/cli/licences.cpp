#include "licences.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "bentaxis/pump/error.h"
#include "bentaxis/pump/text.h"
#include "bentaxis/pump/words.h"

namespace bentaxis::cli {
namespace {

bool is_carried(const Part& part) {
  return part.how == "embedded" || part.how == "static" || part.how == "headers";
}

std::string list_of(const std::string& title, bool carried) {
  std::string text = title + "\n";
  for (const Part& part : parts())
    if (is_carried(part) == carried)
      text += fmt::format("  {:<22}{:<28}{}{}\n", part.name, part.version, part.spdx,
                          part.is_in_build ? "" : " (not in this build)");
  return text;
}

}  // namespace

std::vector<Part> parts() {
  std::vector<Part> all;
  const auto json = nlohmann::json::parse(licence_files().at("parts.json"));
  for (const auto& one : json.at("parts"))
    all.push_back({one.at("name"), one.at("version"), one.at("spdx"), one.at("for"), one.at("how"),
                   one.at("texts"), one.at("in_build")});
  return all;
}

std::string parts_text() {
  return "bentaxis: Apache-2.0\n\n" +
         list_of("In the program, its reports, FMUs and the page of the pump:", true) + "\n" +
         list_of("Used from the system:", false) +
         "\nbentaxis licenses PART prints the text of a licence.\n";
}

std::string licence_text(const std::string& part) {
  if (lower_case(part) == "bentaxis") return licence_files().at("LICENSE");
  std::set<std::string> names = {"bentaxis"};
  for (const Part& one : parts()) {
    names.insert(one.name);
    if (lower_case(one.name) != lower_case(part)) continue;
    std::string text =
        fmt::format("{} {}: {} ({})\n", one.name, one.version, one.spdx, one.purpose);
    for (const std::string& file : one.texts)
      text += "\n==== " + file + " ====\n" + licence_files().at(file);
    return text;
  }
  throw InputError(part + ": is not a part of bentaxis" +
                   suggestion(part, names, "by `bentaxis licenses`"));
}

}  // namespace bentaxis::cli
