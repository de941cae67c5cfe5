// The files of a command that reports: page, JSON and curves, as one set.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/files/output_folder.h"
#include "bentaxis/report/document.h"

namespace bentaxis::cli {

/// Name and content.
using TextFile = std::pair<std::string, std::string>;

/// Puts NAME.html, NAME.json and further files in place together. What an earlier run of the
/// command left there and this one has not is removed: it belongs to a report that is no longer
/// there.
/// @return their paths
/// @throws InputError
std::vector<std::filesystem::path> write_report(OutputFolder& folder, const std::string& name,
                                                report::Document document,
                                                const report::Curves& curves,
                                                const std::vector<TextFile>& further);

}  // namespace bentaxis::cli
