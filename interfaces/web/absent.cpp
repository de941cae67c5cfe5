// What the page does not have, in place of the program's sources: a log of the files that were read
// (it writes no report that names them), workbooks and MATLAB files (whose libraries are not here),
// and the oil.
#include <stdexcept>
#include <string>

#include "bentaxis/files/input_log.h"
#include "bentaxis/hydraulics/steady_state.h"
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

// Of a solution of the oil, which there is never here.
double hydraulics::density(const SteadyState&, double) { throw std::logic_error("no oil"); }

}  // namespace bentaxis
