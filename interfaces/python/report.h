// Reports as the program writes them.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/report/document.h"
#include "report_files.h"

namespace bentaxis::python {

/// Name and version of everything, Python's too.
std::vector<std::pair<std::string, std::string>> versions();

/// Writes report.html, report.json and further files as one set, one call at a time.
/// @param call   what stands for the command line: "bentaxis.compare"
/// @param cases  whose files the provenance names
/// @return the files' paths
std::vector<std::filesystem::path> write_report(const std::filesystem::path& folder,
                                                const std::string& call,
                                                const std::vector<const Case*>& cases,
                                                const report::Document& document,
                                                const report::Curves& curves,
                                                const std::vector<cli::TextFile>& further);

/// The folder "reference_data" or "cases" that comes with the package.
std::optional<std::filesystem::path> shipped(const std::string& name);

void add_report(pybind11::module_& module);

}  // namespace bentaxis::python
