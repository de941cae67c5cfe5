#include "report.h"

#include <dlfcn.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <mutex>

#include "bentaxis/designs/versions.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/error.h"
#include "data_folder.h"
#include "provenance.h"
#include "shipped_cases.h"
#include "versions.h"

namespace bentaxis::python {
namespace {

namespace fs = std::filesystem;
namespace py = pybind11;

// This module's file; what asks the loader for it lies in it.
fs::path module_file() {
  Dl_info info{};
  static const int here = 0;
  if (dladdr(&here, &info) == 0 || info.dli_fname == nullptr) return {};
  return fs::absolute(info.dli_fname);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> versions() {
  auto all = cli::shared_versions(designs::library_versions());
  all.insert(all.end() - 1, {"Python", PY_VERSION});
  return all;
}

std::vector<fs::path> write_report(const fs::path& folder, const std::string& call,
                                   const std::vector<const Case*>& cases,
                                   const report::Document& document, const report::Curves& curves,
                                   const std::vector<cli::TextFile>& further) {
  static std::mutex one_at_a_time;  // command and list of files are the process's
  const std::lock_guard lock(one_at_a_time);
  cli::ReportFolders folders({folder.string(), ""});
  cli::remember_command(call + ", Python");
  const InputLog inputs(InputLog::Threads::own);
  for (const Case* const the_case : cases)
    for (const InputFile& read : the_case->inputs) InputLog::note(read);
  return folders.write("report", document, curves, further);
}

std::optional<fs::path> shipped(const std::string& name) {
  return cli::shipped_folder(name, module_file(), BENTAXIS_DATA_FROM_MODULE);
}

void add_report(py::module_& module) {
  module.def(
      "data_folder",
      [](const std::string& name) {
        const auto folder = shipped(name);
        if (!folder)
          throw InputError("data_folder: nothing called " + name + " comes with bentaxis");
        return folder->string();
      },
      py::arg("name") = "cases",
      "Directory of files that come with bentaxis: \"cases\" or \"reference_data\".");
  module.def(
      "cases",
      [] {
        std::map<std::string, std::string> titles;
        if (const auto folder = shipped("cases"))
          for (const cli::ShippedCase& one : cli::cases_in(*folder)) titles[one.name] = one.title;
        return titles;
      },
      "Names of the cases that come with bentaxis, with their titles; read_case() takes a name.");
  module.def("versions", &versions, "Names and versions of all software that results depend on.");
}

}  // namespace bentaxis::python
