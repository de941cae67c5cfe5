#include "report_files.h"

#include "bentaxis/report/page.h"
#include "provenance.h"

namespace bentaxis::cli {

std::vector<std::filesystem::path> write_report(OutputFolder& folder, const std::string& name,
                                                report::Document document,
                                                const report::Curves& curves,
                                                const std::vector<TextFile>& further) {
  add_provenance(document);
  document.files = {name + ".html"};
  for (const auto& [file, content] : further) document.files.push_back(file);
  document.files.push_back(name + ".json");
  folder.add(name + ".html", report::render_page(document, curves));
  for (const auto& [file, content] : further) folder.add(file, content);
  folder.add(name + ".json", report::json_text(document));  // last: it is the record of the set
  return folder.commit(name + ".json", report::files_of);
}

}  // namespace bentaxis::cli
