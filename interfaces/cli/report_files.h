// The files of a command that reports: page, JSON and curves, as one set.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/files/csv.h"
#include "bentaxis/files/output_folder.h"
#include "bentaxis/report/document.h"

namespace bentaxis::cli {

class CommandParser;

/// A file of a report: its text, or what writes it piece by piece when its turn has come.
struct TextFile {
  using Write = std::function<void(const TextSink&)>;

  TextFile(std::string file, std::string text)
      : name(std::move(file)),
        write([text = std::move(text)](const TextSink& sink) { sink(text); }) {}
  TextFile(std::string file, Write writes) : name(std::move(file)), write(std::move(writes)) {}
  explicit TextFile(std::pair<std::string, std::string> file)
      : TextFile(std::move(file.first), std::move(file.second)) {}

  std::string name;
  Write write;
};
/// Of files as pairs of name and text.
std::vector<TextFile> text_files(std::vector<std::pair<std::string, std::string>> files);

/// Where a report goes.
struct ReportPlace {
  std::string out = "out";
  std::string figures;  ///< folder for a file of each figure; empty: none
};
/// --out and --figures.
void add_report(const CommandParser& command, ReportPlace& place, const std::string& what);
/// --figures alone.
void add_figures(CommandParser command, std::string& folder);

/// The folders of a report, made and tried before anything is computed.
class ReportFolders {
 public:
  /// @throws InputError
  explicit ReportFolders(const ReportPlace& place);

  /// For tables too long to be kept as text: added before write(), they belong to its set.
  OutputFolder& tables() { return report_; }

  /// Whether figures are written too, of which each has all rows.
  bool has_figures() const { return figures_.has_value(); }

  /// Puts NAME.html, NAME.json and further files in place together, then the figures. What an
  /// earlier run of the command left there and this one has not is removed: it belongs to a report
  /// that is no longer there.
  /// @return their paths; of the figures that of their list
  /// @throws InputError
  std::vector<std::filesystem::path> write(const std::string& name, report::Document document,
                                           const report::Curves& curves,
                                           const std::vector<TextFile>& further);
  /// The same, and what was found with the paths on standard output.
  void publish(const std::string& name, const std::string& text, const report::Document& document,
               const std::vector<TextFile>& further, const report::Curves& curves = {});

 private:
  OutputFolder report_;
  std::optional<OutputFolder> figures_;
};

/// On standard output: a line for each file.
void print_files(const std::vector<std::filesystem::path>& files);
/// What a command found, on standard output, and the files that hold it.
void print_result(const std::string& text, const std::vector<std::filesystem::path>& files);

/// Each figure as SVG, PNG and CSV, and figures.csv that lists them.
/// @throws InputError, std::runtime_error where there is no librsvg
void add_figure_files(OutputFolder& folder, const report::Document& document,
                      const report::Curves& curves = {});
/// Puts them in place as one set. @return the path of the list
std::filesystem::path commit_figures(OutputFolder& folder);

}  // namespace bentaxis::cli
