// bentaxis completion: the Tab key.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
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
  CommandParser command = program.subcommand(
      "completion", "Print the script for completion of commands, options and values in a shell");
  std::vector<std::string> shells = completed_shells();
  shells.emplace_back(kWords);
  command
      .option(
          "shell", options->shell,
          "the shell whose script to print; words: what can follow after --, as the scripts ask")
      .required()
      .one_of(shells)
      .text("bash|zsh|fish|words");
  command.option("typed", options->typed, "words: the command line so far")
      .may_be_empty()
      .text("-- WORD..");
  return {command, [options, program] {
            const std::string text = options->shell == kWords
                                         ? completion_text(complete(program.info(), options->typed))
                                         : completion_script(options->shell);
            std::fputs(text.c_str(), stdout);
            return kDone;
          }};
}

}  // namespace bentaxis::cli
