// bentaxis manual: the manual page, from what the parser knows.
#include <fmt/format.h>

#include "command_tools.h"

namespace bentaxis::cli {
namespace {

const char* const kHelp = "--help";

// Text as roff takes it: nothing is a request, a dash is the one of the keyboard, a line may end
// after | and comma.
std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '-') out += '\\';
    out += c == '\\' ? "\\e" : std::string(1, c);
    if (c == '|' || c == ',') out += "\\:";
  }
  return out.find_first_of(".'") == 0 ? "\\&" + out : out;
}

std::string item(const OptionInfo& option) {
  std::string names;
  if (!option.is_argument)
    for (const auto& name : option.names)
      names += (names.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
  const std::string space = names.empty() || option.values.empty() ? "" : " ";
  return fmt::format(".TP\n{}{}{}\n{}\n", names, space,
                     option.values.empty() ? "" : "\\fI" + roff(option.values) + "\\fR",
                     roff(option.what));
}

// The line that calls a command: what it must have, then the rest.
std::string call(const std::string& name, const CommandInfo& command) {
  std::string text = "\\fB" + roff(name) + "\\fR";
  bool rest = false;
  for (const OptionInfo& option : command.options) {
    rest = rest || (!option.required && option.names.back() != kHelp);
    if (!option.required) continue;
    const std::string values = "\\fI" + roff(option.values) + "\\fR";
    text +=
        " " + (option.is_argument ? values : "\\fB" + roff(option.names.back()) + "\\fR " + values);
  }
  return text + (rest ? " [\\fIOPTIONS\\fR]" : "");
}

std::string section(const std::string& name, const CommandInfo& command) {
  std::string text;
  if (command.commands.empty()) {
    text = fmt::format(".SS {}\n{}.\n", call(name, command), roff(command.what));
    for (const OptionInfo& option : command.options)
      if (option.names.back() != kHelp) text += item(option);
    if (!command.example.empty()) text += ".PP\n.nf\n" + roff(command.example) + "\n.fi\n";
  }
  for (const CommandInfo& below : command.commands) text += section(name + " " + below.name, below);
  return text;
}

std::string manual(const CommandInfo& program, const std::string& footer) {
  std::string text = fmt::format(
      ".TH BENTAXIS 1 \"\" \"bentaxis {}\" \"User Commands\"\n.nh\n.ad l\n.SH NAME\nbentaxis \\- "
      "reaction "
      "forces "
      "and drive torque of bent\\-axis piston pumps by two independent models\n.SH SYNOPSIS\n"
      "\\fBbentaxis\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n{}\n.SH OPTIONS\n",
      BENTAXIS_VERSION, roff(program.what));
  for (const OptionInfo& option : program.options) text += item(option);
  text += ".SH COMMANDS\n";
  for (const CommandInfo& command : program.commands)
    text += section("bentaxis " + command.name, command);
  return text + ".SH EXIT STATUS\n.nf\n" + roff(footer) + "\n.fi\n" +
         ".SH SEE ALSO\nbentaxis docs opens the documentation. Its pages are also in "
         "share/doc/bentaxis, "
         "beginning with README.md.\n";
}

}  // namespace

Command add_manual_command(CommandParser program) {
  auto command = program.subcommand("manual", "Print the manual page: bentaxis manual | man -l -");
  return {command, [program] {
            std::fputs(manual(program.info(), program.footer()).c_str(), stdout);
            return kDone;
          }};
}

}  // namespace bentaxis::cli
