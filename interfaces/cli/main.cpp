#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "bentaxis/files/input_log.h"
#include "bentaxis/hydraulics/accuracy_log.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/pump/error.h"
#include "bentaxis/study/timing.h"
#include "command_list.h"
#include "commands.h"
#include "console.h"
#include "provenance.h"
#include "versions.h"

namespace {

using namespace bentaxis;
using namespace bentaxis::cli;

// In a line of its own, also where a terminal still shows how far a job was.
void say(const char* text) {
  std::fprintf(stderr, "%sbentaxis: %s\n", isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "", text);
}

int guarded(const std::function<int()>& job) {
  try {
    return job();
  } catch (const InputError& error) {
    say(without_control_characters(error.what(), false).c_str());
    return kBadInput;
  } catch (const Interrupted&) {
    say("interrupted; nothing was written");
    return kInterrupted;
  } catch (const std::bad_alloc&) {
    say("not enough memory; use fewer samples or revolutions");
    return kComputationFailed;
  } catch (const std::filesystem::filesystem_error& error) {  // no permission, a link to itself
    const std::string path = error.path1().string();
    say(without_control_characters(
            (path.empty() ? "the current folder" : path) + ": " + error.code().message(), false)
            .c_str());
    return kBadInput;
  } catch (const std::exception& error) {
    say(without_control_characters(error.what(), false).c_str());
    return kComputationFailed;
  }
}

// What was printed is a result: if it did not arrive, the job is not done.
int checked_output(int status) {
  errno = 0;
  std::cout.flush();
  const bool arrived = std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good();
  if (arrived || status == kBadInput || status == kComputationFailed) return status;
  std::fprintf(stderr, "bentaxis: standard output cannot be written%s%s\n", errno != 0 ? ": " : "",
               errno != 0 ? std::strerror(errno) : "");
  return kBadInput;
}

// File names and texts of the arguments come back in what is printed: a terminal would act on them.
void refuse_control_characters(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (has_control_characters(argv[i], false))
      throw InputError("argument " + std::to_string(i) + ", \"" + argv[i] +
                       "\": contains a control character");
}

ProgramParser::Texts texts() {
  return {"bentaxis",
          "bentaxis: reaction forces and drive torque of bent-axis piston pumps by two independent "
          "models\n(analytic: closed form after Roccatello & Nervegna 2009; multibody: Simbody), "
          "and their differences.",
          "bentaxis " BENTAXIS_VERSION "\noptional parts: " + optional_parts(),
          "Exit status: 0 agreed or done, 1 out of tolerance, 2 bad usage or input, 3 computation "
          "failed.\nExample: bentaxis compare bap63_rated --out out\nAll cases by name: bentaxis "
          "cases"};
}

// A pressure that is less accurate than its case allows is said, whatever the command makes of it.
int with_accuracy_said(int status) {
  if (const auto warning = study::accuracy_warning(hydraulics::AccuracyLog::record()))
    std::fprintf(stderr, "bentaxis: warning: %s: %s\n", warning->name.c_str(),
                 warning->text.c_str());
  return status;
}

int run_program(int argc, char** argv) {
  ProgramParser parser(texts());
  const std::vector<Command> commands = add_commands(parser);
  return guarded([&]() -> int {
    refuse_control_characters(argc, argv);
    if (!parser.parse(argc, argv)) return kDone;
    watch_for_interruption();
    for (const Command& command : commands)
      if (command.parser.parsed()) return command.run();
    throw InputError("a command is needed, such as compare (see bentaxis --help)");
  });
}

}  // namespace

int main(int argc, char** argv) {
  // A file that outgrows its limit (ulimit -f) is refused as one on a full disk is.
  std::signal(SIGXFSZ, SIG_IGN);
  const InputLog inputs;
  const hydraulics::AccuracyLog accuracy;
  remember_command(argc, argv);
  return with_accuracy_said(checked_output(run_program(argc, argv)));
}
