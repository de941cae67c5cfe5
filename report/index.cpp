#include "bentaxis/report/index.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "bentaxis/report/page.h"
#include "bentaxis/report/picture.h"

namespace bentaxis::report {
namespace {

using Json = nlohmann::json;

// The member of that name where it is text, or "".
std::string text_in(const Json& object, const char* key) {
  if (!object.is_object()) return {};
  const auto member = object.find(key);
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

const Json& member(const Json& object, const char* key) {
  static const Json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found != object.end() ? *found : none;
}

// As a picture of its own, whose styles are no other's.
std::string image(const std::string& svg) {
  if (svg.empty()) return {};
  std::string text;
  for (const char c : svg) {
    if (c == '%' || c == '#' || c == '"' || c == '<' || c == '>' || c == '&' || c == '\n')
      text += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    else
      text += c;
  }
  return "<img alt=\"the pump to scale\" loading=\"lazy\" src=\"data:image/svg+xml;charset=utf-8," +
         text + "\">";
}

// A path as an address: what is no letter, digit, or one of -._~/ by its bytes.
std::string address(const std::string& path) {
  std::string text;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    text += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return text;
}

const char* tone_of(const IndexEntry& entry) {
  if (entry.agrees && !*entry.agrees) return "bad";
  if (!entry.warnings.empty()) return "warn";
  return entry.agrees ? "good" : "neutral";
}

// Each name once.
std::string warnings_of(const IndexEntry& entry) {
  if (entry.warnings.empty()) return {};
  std::string names;
  for (const auto& name : std::set<std::string>(entry.warnings.begin(), entry.warnings.end()))
    names += (names.empty() ? "" : ", ") + name;
  return fmt::format("{} warning{}: {}", entry.warnings.size(),
                     entry.warnings.size() == 1 ? "" : "s", names);
}

std::string word_of(const IndexEntry& entry) {
  if (!entry.word.empty()) return entry.word;
  return !entry.agrees ? "No verdict" : *entry.agrees ? "Agrees" : "Differs";
}

std::string row_of(const IndexEntry& entry) {
  const std::string& target = entry.page.empty() ? entry.json : entry.page;
  std::string worst;
  if (!entry.worst_channel.empty())
    worst = "<code>" + markup_of(entry.worst_channel) + "</code>" +
            (entry.worst_over_peak ? fmt::format(" {:.1e} of peak", *entry.worst_over_peak) : "");
  return fmt::format(
      "<tr><th scope=\"row\"><a href=\"{}\">{}</a><small>{}</small><small>{}</small></th>"
      "<td data-head=\"Verdict\"><div><span class=\"chip {}\">{}</span><small "
      "class=\"headline\">{}</small><small class=\"headline\">{}</small></div></td>"
      "<td data-head=\"Worst channel\"><div>{}</div></td>"
      "<td data-head=\"Made\"><div>{}<small>{}</small></div></td>"
      "<td data-head=\"Pump\"><div>{}</div></td></tr>\n",
      markup_of(address(target)), markup_of(entry.title), markup_of(target),
      markup_of(entry.case_file), tone_of(entry), markup_of(word_of(entry)),
      markup_of(entry.headline), markup_of(warnings_of(entry)), worst, markup_of(entry.date),
      markup_of(entry.command), image(entry.picture));
}

std::string counts_of(const std::vector<IndexEntry>& entries) {
  const auto count = [&](const char* tone) {
    return std::count_if(entries.begin(), entries.end(),
                         [&](const IndexEntry& e) { return tone_of(e) == std::string_view(tone); });
  };
  std::string text = fmt::format("{} report{}", entries.size(), entries.size() == 1 ? "" : "s");
  for (const auto& [tone, words] : {std::pair{"bad", "differ"},
                                    {"warn", "with warnings"},
                                    {"good", "agree"},
                                    {"neutral", "without a verdict"}})
    if (const auto n = count(tone); n > 0) text += fmt::format(", {} {}", n, words);
  return text;
}

std::string skipped_text(const std::vector<std::string>& skipped) {
  if (skipped.empty()) return {};
  std::string list;
  for (const std::string& file : skipped) list += "<li>" + markup_of(file) + "</li>\n";
  return fmt::format(
      "<details class=\"others\"><summary>JSON files that are no report ({})</summary>\n<ul>\n{}"
      "</ul></details>\n",
      skipped.size(), list);
}

}  // namespace

std::optional<IndexEntry> index_entry(const std::string& json_text) {
  const Json json = Json::parse(json_text, nullptr, false);
  // What every report has (docs/report.schema.json).
  if (!json.is_object() || !member(json, "schema").is_number() ||
      !member(json, "program").is_array() || !member(json, "title").is_string())
    return std::nullopt;
  IndexEntry entry;
  entry.title = text_in(json, "title");
  entry.case_file = text_in(member(json, "case"), "file");
  const Json& provenance = member(json, "provenance");
  entry.command = text_in(provenance, "command");
  entry.date = text_in(provenance, "date");
  entry.version = text_in(provenance, "version");
  const Json& verdict = member(json, "verdict");
  // The worst decides, of a report that says it part by part too (before 1.0.1).
  for (const Json* part : {&verdict, &member(verdict, "reference")})
    if (const Json& agrees = member(*part, "agrees"); agrees.is_boolean())
      entry.agrees = entry.agrees.value_or(true) && agrees.get<bool>();
  for (const Json* list :
       {&member(json, "warnings"), &member(member(json, "plausibility"), "warnings")})
    for (const Json& warning : *list) {
      const std::string name = text_in(warning, "name");
      entry.warnings.push_back(name.empty() ? text_in(warning, "code") : name);
    }
  // Where there is a warning, it says so too.
  if (const std::string where = text_in(verdict, "not_valid");
      !where.empty() && entry.warnings.empty())
    entry.warnings.push_back("not valid " + where);
  entry.word = text_in(verdict, "word");
  const Json& reference = member(verdict, "reference");
  if (const Json& held = member(reference, "agrees");
      held.is_boolean() && !held.get<bool>() && entry.word.empty())
    entry.word = "Reference differs";
  entry.headline = text_in(verdict, "headline");
  const Json& worst = member(verdict, "worst");
  entry.worst_channel = text_in(worst, "channel");
  if (const Json& over = member(worst, "max_over_peak"); over.is_number())
    entry.worst_over_peak = over.get<double>();
  for (const Json& file : member(json, "files"))
    if (file.is_string() && entry.page.empty() && file.get<std::string>().ends_with(".html"))
      entry.page = file.get<std::string>();
  return entry;
}

std::string picture_of_page(const std::string& html) {
  const std::string before = "<div id=\"picture\" hidden>";
  const auto at = html.find(before);
  if (at == std::string::npos) return {};
  const auto from = html.find("<svg", at), end = html.find("</div>", at);
  const auto to = html.find("</svg>", at);
  if (from == std::string::npos || to == std::string::npos || end < from || end < to) return {};
  return html.substr(from, to + 6 - from);
}

void sort_by_worst(std::vector<IndexEntry>& entries) {
  const auto rank = [](const IndexEntry& e) {
    return e.agrees && !*e.agrees ? 0 : !e.warnings.empty() ? 1 : e.agrees ? 2 : 3;
  };
  std::stable_sort(entries.begin(), entries.end(), [&](const IndexEntry& a, const IndexEntry& b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    const double first = a.worst_over_peak.value_or(-1), second = b.worst_over_peak.value_or(-1);
    if (first != second) return first > second;
    return a.json < b.json;
  });
}

std::string index_headline(const std::vector<IndexEntry>& entries) {
  if (entries.empty()) return "No report.";
  const IndexEntry& worst = entries.front();
  const std::string name =
      worst.title + " (" + (worst.page.empty() ? worst.json : worst.page) + ")";
  if (worst.agrees && !*worst.agrees)
    return fmt::format("{}. Worst: {}: {}", counts_of(entries), name, worst.headline);
  if (!worst.warnings.empty())
    return fmt::format("{}. None differs; first with warnings: {}: {}.", counts_of(entries), name,
                       warnings_of(worst));
  return fmt::format("{}. None differs, none has warnings.", counts_of(entries));
}

std::string index_page(const std::string& title, const std::vector<IndexEntry>& entries,
                       const std::vector<std::string>& skipped) {
  std::string rows;
  for (const IndexEntry& entry : entries) rows += row_of(entry);
  return filled_template("index.html", {{"@CSS@", page_parts().at("report.css")},
                                        {"@COUNTS@", markup_of(index_headline(entries))},
                                        {"@SKIPPED@", skipped_text(skipped)},
                                        {"@ROWS@", rows},
                                        {"@TITLE@", markup_of(title)},
                                        {"@TITLE@", markup_of(title)}});
}

std::string index_json(const std::vector<IndexEntry>& entries) {
  Json list = Json::array();
  for (const IndexEntry& e : entries)
    list.push_back({{"json", e.json},
                    {"page", e.page},
                    {"title", e.title},
                    {"case", e.case_file},
                    {"command", e.command},
                    {"date", e.date},
                    {"version", e.version},
                    {"agrees", e.agrees ? Json(*e.agrees) : Json()},
                    {"warnings", e.warnings},
                    {"word", word_of(e)},
                    {"headline", e.headline},
                    {"worst_channel", e.worst_channel},
                    {"worst_over_peak", e.worst_over_peak ? Json(*e.worst_over_peak) : Json()}});
  const Json whole = {
      {"schema", 1}, {"headline", index_headline(entries)}, {"reports", std::move(list)}};
  return whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bentaxis::report
