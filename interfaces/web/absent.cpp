// What the page does not have, in place of the program's sources: a log of the files that were read
// (it writes no report that names them), workbooks and MATLAB files (whose libraries are not here),
// and threads.
#include <functional>
#include <string>

#include "bentaxis/files/input_log.h"
#include "bentaxis/numerics/parallel_for.h"
#include "bentaxis/pump/error.h"
#include "foreign_grid.h"

namespace bentaxis {

InputLog::InputLog(Threads threads) : threads_(threads) {}
InputLog::~InputLog() = default;
std::vector<InputFile> InputLog::noted() const { return {}; }
void InputLog::note(const std::filesystem::path&, const std::string&) {}

namespace foreign {

ForeignTable read_workbook(const std::filesystem::path& file, const std::string&,
                           const std::string&) {
  throw InputError(file.string() + ": this page reads no workbooks; save it as CSV");
}
ForeignTable read_matlab(const std::filesystem::path& file, const std::string&,
                         const std::string&) {
  throw InputError(file.string() + ": this page reads no MATLAB files; save it as CSV");
}

}  // namespace foreign

// Jobs side by side: one after the other here.
void numerics::parallel_for(int, std::size_t count, const std::function<void(std::size_t)>& job) {
  for (std::size_t i = 0; i < count; ++i) job(i);
}

}  // namespace bentaxis
