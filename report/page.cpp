#include "bentaxis/report/page.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "bentaxis/report/picture.h"
#include "thinned.h"

namespace bentaxis::report {
namespace {

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
  for (const char* module :
       {"elements.js", "axes.js", "packed.js", "sections.js", "comparison.js", "cursor.js",
        "data.js", "curves.js", "bars.js", "drawing.js", "scene_state.js", "scene_shapes.js",
        "scene_view.js", "scene_tables.js", "scene_panel.js", "hand_out.js", "page.js"})
    text += "\n" + page_parts().at(module);
  return text + "})();\n";
}

// The figures as the program draws them: for paper, for files, and where there is no script.
std::string pictures(const Document& document, const Curves& curves) {
  std::string text;
  if (!document.figures) return text;
  for (const Figure& figure : *document.figures)
    text +=
        "<div data-figure=\"" + markup_of(figure.id) + "\">" + svg_of(figure, curves) + "</div>\n";
  return text;
}

// What only a page with the pump in space needs.
std::string scene_block(const Document& document) {
  if (!document.scene) return {};
  return "<script type=\"application/json\" id=\"scene\">\n" +
         script_safe(compact_json(*document.scene)) + "\n</script>\n<script>\n" +
         page_parts().at("three.min.js") + "\n</script>\n<script>\n" +
         page_parts().at("OrbitControls.js") + "</script>\n";
}

// The licences of the libraries in the page.
std::string notices(const Document& document) {
  std::string text;
  const auto add = [&](const std::string& name) {
    text += "<h2>" + name + "</h2>\n<pre>" + markup_of(page_parts().at(name + ".txt")) + "</pre>\n";
  };
  add("dygraphs");
  if (document.scene) add("three.js");
  return text;
}

}  // namespace

std::string filled_template(const std::string& part, const Fillings& fillings) {
  std::string text = page_parts().at(part);
  for (const auto& [marker, value] : fillings) {
    const auto at = text.find(marker);
    if (at == std::string::npos) throw std::logic_error("page template lacks " + marker);
    text.replace(at, marker.size(), value);
  }
  return text;
}

namespace {

std::string page_of(const Document& document, const Curves& curves) {
  const auto& parts = page_parts();
  return filled_template("template.html", {{"@TITLE@", markup_of(document.title)},
                                           {"@CSS@", parts.at("report.css")},
                                           {"@DYGRAPHS_CSS@", parts.at("dygraph.min.css")},
                                           {"@DYGRAPHS_JS@", parts.at("dygraph.min.js")},
                                           {"@REPORT_JS@", script()},
                                           {"@PICTURES@", pictures(document, curves)},
                                           {"@PICTURE@", document.picture},
                                           {"@NOTICES@", notices(document)},
                                           {"@SCENE@", scene_block(document)},
                                           {"@CURVES_JSON@", script_safe(packed_json(curves))},
                                           {"@REPORT_JSON@", script_safe(compact_json(document))}});
}

}  // namespace

std::string render_page(const Document& document, const Curves& curves) {
  if (!curves.rows.empty()) return page_of(thinned(document, curves.samples, curves.rows), curves);
  const std::size_t all = curves.theta_deg.size();
  const auto rows = rows_shown(curves, kMostRows);
  if (rows.size() == all) return page_of(document, curves);
  return page_of(thinned(document, all, rows), thinned(curves, rows));
}

}  // namespace bentaxis::report
