#include "bentaxis/report/page.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "bentaxis/report/picture.h"

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
std::string script_safe(const std::string& json) {
  std::string out;
  for (const char c : json) out += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return out;
}

// The script: what is used at once comes first, and page.js draws.
std::string script() {
  std::string text =
      "// Draws the report from the two JSON blocks of the page. Knows no physics and no channel "
      "names:\n"
      "// every name, unit and number comes from the data. Text goes in by textContent only, so "
      "that\n"
      "// nothing in a case file can become markup.\n"
      "(() => {\n\"use strict\";\n";
  for (const char* module : {"elements.js", "axes.js", "sections.js", "comparison.js", "curves.js",
                             "bars.js", "drawing.js", "hand_out.js", "page.js"})
    text += "\n" + page_parts().at(module);
  return text + "})();\n";
}

// The figures as the program draws them: for paper, for files, and where there is no script.
std::string pictures(const Document& document, const Curves& curves) {
  std::string text;
  if (!document.figures) return text;
  for (const Figure& figure : *document.figures)
    text += "<div data-figure=\"" + escape_html(figure.id) + "\">" + svg_of(figure, curves) +
            "</div>\n";
  return text;
}

// What only a page with the pump in space needs.
std::string scene_block(const Document& document) {
  if (!document.scene) return {};
  return "<script type=\"application/json\" id=\"scene\">\n" +
         script_safe(compact_json(*document.scene)) + "\n</script>\n";
}

}  // namespace

std::string render_page(const Document& document, const Curves& curves) {
  const auto& parts = page_parts();
  std::string page = parts.at("template.html");
  // The data come last: nothing is searched for in them.
  for (const auto& [marker, value] : std::vector<std::pair<std::string, std::string>>{
           {"@TITLE@", escape_html(document.title)},
           {"@CSS@", parts.at("report.css")},
           {"@DYGRAPHS_CSS@", parts.at("dygraph.min.css")},
           {"@DYGRAPHS_JS@", parts.at("dygraph.min.js")},
           {"@REPORT_JS@", script()},
           {"@PICTURES@", pictures(document, curves)},
           {"@PICTURE@", document.picture},
           {"@SCENE@", scene_block(document)},
           {"@CURVES_JSON@", script_safe(compact_json(curves))},
           {"@REPORT_JSON@", script_safe(compact_json(document))}})
    replace_once(page, marker, value);
  return page;
}

}  // namespace bentaxis::report
