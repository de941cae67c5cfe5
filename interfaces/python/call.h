// A computation that Python asks for: without Python's lock, ended by Ctrl-C.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/report/document.h"
#include "bentaxis/study/progress.h"

namespace bentaxis::python {

/// Looks at the signals that Python has noted whenever a computation says how far it is, at most
/// every 50 ms. Only the thread that called does: Python lets none but its main thread run the
/// handlers of signals, and threads of a computation that waited for Python's lock could wait for
/// ever.
class Watch {
 public:
  study::PartProgress progress_of();
  /// Raises what a signal's handler has raised: KeyboardInterrupt.
  [[noreturn]] void raise();

 private:
  void look();

  std::thread::id caller_ = std::this_thread::get_id();
  std::chrono::steady_clock::time_point looked_ = {};
  PyObject *type_ = nullptr, *value_ = nullptr, *trace_ = nullptr;
};

/// job(progress_of) without Python's lock. It must not touch anything of Python's.
template <class Job>
auto unlocked(const Job& job) {
  Watch watch;
  try {
    const pybind11::gil_scoped_release release;
    return job(watch.progress_of());
  } catch (const Interrupted&) {
    watch.raise();
  }
}

/// Warns as Python does, once per place in the caller's program: bentaxis.DoubtWarning.
void warn(const std::string& text);

/// What is implausible about a case, "code: text" each, as the program prints it.
std::vector<std::string> plausibility_texts(const Case& the_case);
/// Warns of each: bentaxis.PlausibilityWarning.
void warn_of_plausibility(const std::vector<std::string>& texts);
/// Warns of what is implausible about a case. @return the texts
std::vector<std::string> warned_of(const Case& the_case);
/// Warns of what a result says, and adds it to the texts of all warnings.
void warn_of(const std::vector<report::Warning>& warnings, std::vector<std::string>& texts);

}  // namespace bentaxis::python
