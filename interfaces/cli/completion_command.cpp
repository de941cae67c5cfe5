// bentaxis completion: the Tab key.
#include "command_tools.h"
#include "completion.h"

namespace bentaxis::cli {
namespace {

const char* const kWords = "words";

struct CompletionOptions {
  std::string shell;
  std::vector<std::string> typed;
};

}  // namespace

Command add_completion_command(CommandParser program) {
  auto options = std::make_shared<CompletionOptions>();
  auto command = program.subcommand(
      "completion", "Print the script for completion of commands, options and values in a shell");
  std::vector<std::string> shells = completed_shells();
  shells.emplace_back(kWords);
  command.option(
      "shell", options->shell, Values::words(shells, "bash|zsh|fish|words").required(),
      "the shell whose script to print; words: what can follow after --, as the scripts ask");
  command.option("typed", options->typed, Values("-- WORD..").may_be_empty(),
                 "words: the command line so far");
  return {command, [options, program] {
            const std::string text = options->shell == kWords
                                         ? completion_text(complete(program.info(), options->typed))
                                         : completion_script(options->shell);
            std::fputs(text.c_str(), stdout);
            return kDone;
          }};
}

}  // namespace bentaxis::cli
