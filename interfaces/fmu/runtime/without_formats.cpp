// What the reader of case files needs of the module `files` and a unit has no libraries for: curves
// of a unit are text, and nobody asks which files were read.
#include "bentaxis/files/foreign_table.h"
#include "bentaxis/files/input_log.h"
#include "bentaxis/pump/error.h"
#include "foreign_grid.h"

namespace bentaxis {

InputLog::InputLog(Threads threads) : threads_(threads) {}
InputLog::~InputLog() = default;
std::vector<InputFile> InputLog::noted() const { return files_; }
void InputLog::note(const std::filesystem::path& /*file*/, const std::string& /*content*/) {}

namespace foreign {

ForeignTable read_workbook(const std::filesystem::path& file, const std::string& /*content*/,
                           const std::string& /*sheet*/) {
  throw InputError(file.string() + ": an FMU reads no workbooks: its curves must be CSV");
}
ForeignTable read_matlab(const std::filesystem::path& file, const std::string& /*content*/,
                         const std::string& /*wanted*/) {
  throw InputError(file.string() + ": an FMU reads no .mat files: its curves must be CSV");
}

}  // namespace foreign
}  // namespace bentaxis
