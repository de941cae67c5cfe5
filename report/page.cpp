#include "bentaxis/report/page.h"

#include <stdexcept>
#include <utility>
#include <vector>

namespace bentaxis::report {
namespace {

void replace_once(std::string& text, const std::string& marker, const std::string& value) {
  const auto at = text.find(marker);
  if (at == std::string::npos) throw std::logic_error("page template lacks " + marker);
  text.replace(at, marker.size(), value);
}

std::string escape_html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

// JSON inside a script element must not contain "</" or "<!--".
std::string script_safe(const nlohmann::json& value) {
  std::string out;
  for (const char c : value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace))
    out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

}  // namespace

std::string render_page(const Document& document, const Curves& curves) {
  return render_page(document.title, to_json(document), to_json(curves));
}

std::string render_page(const std::string& title, const nlohmann::json& report,
                        const nlohmann::json& curves) {
  const auto& parts = page_parts();
  std::string page = parts.at("template.html");
  // The data come last: nothing is searched for in them.
  for (const auto& [marker, value] : std::vector<std::pair<std::string, std::string>>{
           {"@TITLE@", escape_html(title)},
           {"@CSS@", parts.at("report.css")},
           {"@DYGRAPHS_CSS@", parts.at("dygraph.min.css")},
           {"@DYGRAPHS_JS@", parts.at("dygraph.min.js")},
           {"@REPORT_JS@", parts.at("report.js")},
           {"@CURVES_JSON@", script_safe(curves)},
           {"@REPORT_JSON@", script_safe(report)}})
    replace_once(page, marker, value);
  return page;
}

}  // namespace bentaxis::report
