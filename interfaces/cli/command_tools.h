// What the sources of the commands have at hand: the parser and the options that commands share,
// the console, the files of reports, the data that come with the program.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/pump/error.h"
#include "bentaxis/study/case_description.h"
#include "commands.h"
#include "console.h"
#include "data_folder.h"
#include "options.h"
#include "report_files.h"
#include "versions.h"

namespace bentaxis::cli {

/// What a report says of its case; the progress is shown.
inline study::CaseDescription described(const Case& the_case) {
  return study::describe(the_case, progress_of);
}

}  // namespace bentaxis::cli
