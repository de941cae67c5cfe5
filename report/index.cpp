#include "bentaxis/report/index.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "bentaxis/pump/number.h"
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
  if (!entry.warnings.empty() || !entry.not_valid.empty()) return "warn";
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

// The word of a report's page, with where it is not valid.
std::string whole_word_of(const IndexEntry& entry) {
  return index_word(entry) + (entry.not_valid.empty() ? "" : "; not valid " + entry.not_valid);
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
      markup_of(entry.case_file), tone_of(entry), markup_of(whole_word_of(entry)),
      markup_of(entry.headline), markup_of(warnings_of(entry)), worst, markup_of(entry.date),
      markup_of(entry.command), image(entry.picture));
}

// "over 7.5 % of the turn", also of two pumps: the largest share, %. 0 where none is stated.
double share_not_valid(const IndexEntry& entry) {
  const std::string before = "over ";
  double largest = 0;
  for (auto at = entry.not_valid.find(before); at != std::string::npos;
       at = entry.not_valid.find(before, at + 1))
    if (const auto end = entry.not_valid.find(" %", at); end != std::string::npos) {
      const auto from = at + before.size();
      largest = std::max(largest, number_in(entry.not_valid.substr(from, end - from)).value_or(0));
    }
  return largest;
}

constexpr const char* kDiffers = "differs";

// "2 differ, 1 no design": what is wrong by the word of its page.
std::string wrong_counts(const std::vector<IndexEntry>& entries) {
  std::map<std::string, std::size_t> others;
  std::size_t differ = 0;
  for (const IndexEntry& entry : entries) {
    if (tone_of(entry) != std::string_view("bad")) continue;
    if (const std::string fault = index_fault(entry); fault == kDiffers)
      ++differ;
    else
      ++others[fault];
  }
  std::string text = differ > 0 ? fmt::format(", {} differ", differ) : "";
  for (const auto& [word, n] : others) text += fmt::format(", {} {}", n, word);
  return text;
}

// How many rows of the table say what: each report has one verdict, and may have remarks.
std::string counts_of(const std::vector<IndexEntry>& entries) {
  const auto counted = [&](const char* before, const char* words, const auto& is) {
    const auto n = std::ranges::count_if(entries, is);
    return n > 0 ? fmt::format("{}{} {}", before, n, words) : std::string();
  };
  std::string text = fmt::format("{} report{}", entries.size(), entries.size() == 1 ? "" : "s");
  text += wrong_counts(entries);
  text += counted(", ", "agree", [](const IndexEntry& e) { return e.agrees.value_or(false); });
  text += counted(", ", "without a verdict", [](const IndexEntry& e) { return !e.agrees; });
  const std::string warned =
      counted("; ", "with warnings", [](const IndexEntry& e) { return !e.warnings.empty(); });
  return text + warned +
         counted(warned.empty() ? "; " : ", ", "not valid throughout",
                 [](const IndexEntry& e) { return !e.not_valid.empty(); });
}

constexpr std::size_t kMostNamed = 3;  // in a headline

// "2 could not be read, so nothing can be said of them: a.json (..), b (..)".
std::string unread_text(const std::vector<UnreadFile>& unread) {
  std::string text =
      fmt::format("{} could not be read, so nothing can be said of {}: ", unread.size(),
                  unread.size() == 1 ? "it" : "them");
  for (std::size_t i = 0; i < std::min(kMostNamed, unread.size()); ++i)
    text += fmt::format("{}{} ({})", i > 0 ? ", " : "", unread[i].path, unread[i].reason);
  if (unread.size() > kMostNamed) text += fmt::format(", {} more", unread.size() - kMostNamed);
  return text;
}

std::string unread_list(const std::vector<UnreadFile>& unread) {
  if (unread.empty()) return {};
  std::string list;
  for (const UnreadFile& file : unread)
    list += "<li><code>" + markup_of(file.path) + "</code>: " + markup_of(file.reason) + "</li>\n";
  return fmt::format(
      "<div class=\"banner bad unread\" role=\"status\"><p class=\"word\">Not read: "
      "{}</p>\n<ul>\n{}"
      "</ul></div>\n",
      unread.size(), list);
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

// What every report has (docs/report.schema.json).
bool is_report(const Json& json) {
  return json.is_object() && member(json, "schema").is_number() &&
         member(json, "program").is_array() && member(json, "title").is_string();
}

}  // namespace

std::string index_word(const IndexEntry& entry) {
  if (!entry.word.empty()) return entry.word;
  return !entry.agrees ? "No verdict" : *entry.agrees ? "Agrees" : "Differs";
}

std::string index_fault(const IndexEntry& entry) {
  std::string word = index_word(entry);
  if (word.ends_with("iffers")) return kDiffers;
  if (word[0] >= 'A' && word[0] <= 'Z') word[0] = static_cast<char>(word[0] - 'A' + 'a');
  return word;
}

std::optional<IndexEntry> index_entry(const std::string& json_text) {
  const Json json = Json::parse(json_text, nullptr, false);
  if (!is_report(json)) return std::nullopt;
  IndexEntry entry;
  entry.title = text_in(json, "title");
  entry.case_file = text_in(member(json, "case"), "file");
  const Json& provenance = member(json, "provenance");
  entry.command = text_in(provenance, "command");
  entry.date = text_in(provenance, "date");
  entry.version = text_in(provenance, "version");
  const Json& verdict = member(json, "verdict");
  // The worst decides, of a report that says it part by part too (before 1.1.0).
  for (const Json* part : {&verdict, &member(verdict, "reference")})
    if (const Json& agrees = member(*part, "agrees"); agrees.is_boolean())
      entry.agrees = entry.agrees.value_or(true) && agrees.get<bool>();
  for (const Json* list :
       {&member(json, "warnings"), &member(member(json, "plausibility"), "warnings")})
    for (const Json& warning : *list) {
      const std::string name = text_in(warning, "name");
      entry.warnings.push_back(name.empty() ? text_in(warning, "code") : name);
    }
  entry.not_valid = text_in(verdict, "not_valid");
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

std::string damage_of(const std::string& json_text) {
  if (json_text.empty()) return "empty";
  try {
    const Json json = Json::parse(json_text, nullptr, true, true);  // others write comments too
    if (is_report(json) || !member(json, "schema").is_number() ||
        (!json.contains("program") && !json.contains("verdict")))
      return {};
    return "a report without its title, or without what the program was";
  } catch (const Json::parse_error& error) {
    return error.byte > json_text.size()
               ? fmt::format("ends after {} bytes within its JSON", json_text.size())
               : fmt::format("no JSON at byte {}", error.byte);
  }
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
    if (e.agrees && !*e.agrees) return 0;
    if (!e.not_valid.empty()) return 1;
    return !e.warnings.empty() ? 2 : e.agrees ? 3 : 4;
  };
  std::ranges::stable_sort(entries, [&](const IndexEntry& a, const IndexEntry& b) {
    if (rank(a) != rank(b)) return rank(a) < rank(b);
    const auto size = [&](const IndexEntry& e) {
      return std::pair(rank(e) == 1 ? share_not_valid(e) : 0, e.worst_over_peak.value_or(-1));
    };
    if (size(a) != size(b)) return size(a) > size(b);
    return a.json < b.json;
  });
}

std::string index_headline(const std::vector<IndexEntry>& entries,
                           const std::vector<UnreadFile>& unread) {
  const std::string missing = unread.empty() ? "" : unread_text(unread);
  if (entries.empty()) return missing.empty() ? "No report." : "No report; " + missing + ".";
  const IndexEntry& worst = entries.front();
  const std::string name =
      worst.title + " (" + (worst.page.empty() ? worst.json : worst.page) + ")";
  std::string text = counts_of(entries) + (missing.empty() ? ". " : "; " + missing + ". ");
  if (worst.agrees && !*worst.agrees)
    return text + fmt::format("Worst: {}: {}", name, worst.headline);
  text += missing.empty() ? "None differs" : "Of those that were read, none differs";
  if (!worst.not_valid.empty())
    return text + fmt::format("; first that is not valid throughout: {}: not valid {}.", name,
                              worst.not_valid);
  if (!worst.warnings.empty())
    return text + fmt::format("; first with warnings: {}: {}.", name, warnings_of(worst));
  return text + ", none has warnings.";
}

std::string index_page(const std::string& title, const std::vector<IndexEntry>& entries,
                       const std::vector<std::string>& skipped,
                       const std::vector<UnreadFile>& unread) {
  std::string rows;
  for (const IndexEntry& entry : entries) rows += row_of(entry);
  return filled_template("index.html", {{"@CSS@", page_parts().at("report.css")},
                                        {"@COUNTS@", markup_of(index_headline(entries, unread))},
                                        {"@UNREAD@", unread_list(unread)},
                                        {"@SKIPPED@", skipped_text(skipped)},
                                        {"@ROWS@", rows},
                                        {"@TITLE@", markup_of(title)},
                                        {"@TITLE@", markup_of(title)}});
}

std::string index_json(const std::vector<IndexEntry>& entries,
                       const std::vector<UnreadFile>& unread) {
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
                    {"word", index_word(e)},
                    {"not_valid", e.not_valid},
                    {"headline", e.headline},
                    {"worst_channel", e.worst_channel},
                    {"worst_over_peak", e.worst_over_peak ? Json(*e.worst_over_peak) : Json()}});
  Json missing = Json::array();
  for (const UnreadFile& file : unread)
    missing.push_back({{"path", file.path}, {"reason", file.reason}});
  const Json whole = {{"schema", 1},
                      {"headline", index_headline(entries, unread)},
                      {"reports", std::move(list)},
                      {"unread", std::move(missing)}};
  return whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace bentaxis::report
