// Where a report comes from: this run of the program.
#pragma once

#include <string>

#include "bentaxis/report/document.h"

namespace bentaxis::cli {

/// Remembers the command line, for reports.
void remember_command(int argc, const char* const* argv);
/// The same in words, where there is no command line.
void remember_command(const std::string& text);

/// Command line, date, version, files read so far, machine. The date is SOURCE_DATE_EPOCH where
/// that is set.
/// @throws InputError where SOURCE_DATE_EPOCH is no count of seconds
report::Provenance provenance();

/// Puts the provenance into a report. With SOURCE_DATE_EPOCH its times are left out: the same run
/// then gives the same bytes.
void add_provenance(report::Document& document);

}  // namespace bentaxis::cli
