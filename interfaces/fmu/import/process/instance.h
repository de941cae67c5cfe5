// The process of one instance of an FMU. Internal.
#pragma once

#include "messages.h"

namespace bentaxis::fmu::process {

/// Answers requests on kChannel until the program closes it. To be called in a process of its own.
[[noreturn]] void run_instance(Shared& shared);

}  // namespace bentaxis::fmu::process
