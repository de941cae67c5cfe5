#include "bentaxis/engines/run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

#include "bentaxis/files/module_folders.h"
#include "bentaxis/pump/characters.h"
#include "bentaxis/results/stopwatch.h"
#include "shared_task.h"

namespace bentaxis::engines {
namespace {

constexpr double kLongest = 600;         // s, of a process
constexpr useconds_t kLookEvery = 2000;  // us

std::filesystem::path find_file(const std::string& file) {
  std::vector<std::filesystem::path> folders = module_folders();
  if (const char* more = std::getenv("BENTAXIS_ENGINE_PATH")) {
    std::istringstream list(more);
    std::vector<std::filesystem::path> named;
    for (std::string folder; std::getline(list, folder, ':');)
      if (!folder.empty()) named.emplace_back(folder);
    folders.insert(folders.begin(), named.begin(), named.end());
  }
  std::error_code none;
  for (const auto& folder : folders)
    if (std::filesystem::exists(folder / file, none))
      return std::filesystem::absolute(folder / file);
  return {};
}

std::string module_of(const std::string& name) { return "bentaxis_engine_" + name + ".so"; }

// Memory that a child process gets as a descriptor.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t size)
      : size_(size), file_(memfd_create("bentaxis", MFD_CLOEXEC)) {
    if (file_ < 0 || ftruncate(file_, static_cast<off_t>(size)) != 0) return;
    void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (memory != MAP_FAILED) memory_ = memory;
  }
  ~SharedMemory() {
    if (memory_ != nullptr) munmap(memory_, size_);
    if (file_ >= 0) close(file_);
  }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  int file() const { return file_; }
  void* get() const { return memory_; }

 private:
  std::size_t size_;
  int file_;
  void* memory_ = nullptr;
};

void write(const Mechanism& m, const Arrays& to) {
  const auto put = [](double*& at, const auto& numbers) {
    at = std::copy(numbers.data(), numbers.data() + numbers.size(), at);
  };
  Arrays at = to;
  for (std::size_t i = 0; i < m.bodies.size(); ++i) {
    const Body& body = m.bodies[i];
    *at.parent++ = body.parent;
    *at.mass++ = body.mass;
    put(at.place, body.place);
    put(at.axes, body.axes);
    put(at.centre, body.centre);
    put(at.inertia, body.inertia);
    for (const Freedom& freedom : body.freedoms) {
      *at.freedom_body++ = static_cast<std::int32_t>(i);
      *at.freedom_turns++ = freedom.turns ? 1 : 0;
      put(at.freedom_axis, freedom.axis);
    }
  }
  for (const Support& support : m.supports) *at.support_body++ = support.body;
  for (const State& state : m.states) {
    put(at.position, state.position);
    put(at.velocity, state.velocity);
    put(at.acceleration, state.acceleration);
    for (const Wrench& load : state.loads) put(at.loads, load);
    for (const Wrench& support : state.supports) put(at.support, support);
    for (std::size_t i = 0; i < m.actions.size(); ++i)
      for (int body = 0; body < static_cast<int>(m.bodies.size()); ++body) {
        const Action& action = m.actions[i];
        const double sign = action.on == body ? 1 : action.by == body ? -1 : 0;
        put(at.action, Wrench(sign * state.actions[i]));
      }
  }
}

// The last line that a process has printed.
std::string last_words(int file) {
  std::string text(4096, 0);
  const off_t size = lseek(file, 0, SEEK_END);
  const off_t from = std::max<off_t>(0, size - static_cast<off_t>(text.size()));
  const ssize_t read = pread(file, text.data(), text.size(), from);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(0, read)));
  while (!text.empty() && (text.back() == '\n' || text.back() == 0)) text.pop_back();
  const std::size_t line = text.rfind('\n');
  return without_control_characters(line == std::string::npos ? text : text.substr(line + 1));
}

// Starts the runner, waits for it. @return how it ended, or nothing: it was ended here
std::optional<int> run_process(const std::string& runner, const std::string& module, int memory,
                               int output, const Progress& progress) {
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  posix_spawn_file_actions_adddup2(&files, memory, 3);
  posix_spawn_file_actions_addclosefrom_np(&files, 4);
  std::string program = runner, argument = module;
  char* arguments[] = {program.data(), argument.data(), nullptr};
  pid_t process = 0;
  const int failed = posix_spawn(&process, runner.c_str(), &files, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) return 127 << 8;
  const Stopwatch stopwatch;
  int status = 0;
  const auto end = [&] {
    kill(process, SIGKILL);
    waitpid(process, &status, 0);
  };
  try {
    while (waitpid(process, &status, WNOHANG) == 0) {
      if (stopwatch.seconds() > kLongest) {
        end();
        return std::nullopt;
      }
      progress(0);
      usleep(kLookEvery);
    }
    progress(1);  // an interruption ends the process as well
  } catch (...) {
    end();
    throw;
  }
  return status;
}

std::string how_it_ended(const std::optional<int>& status, const std::string& words) {
  if (!status) return fmt::format("did not end within {:g} s", kLongest);
  const std::string said = words.empty() ? "" : ": " + words;
  if (WIFSIGNALED(*status))
    return fmt::format("crashed (signal {}, {}){}", WTERMSIG(*status), strsignal(WTERMSIG(*status)),
                       said);
  return fmt::format("ended before it had answered (exit status {}){}", WEXITSTATUS(*status), said);
}

}  // namespace

const std::vector<std::string>& known_engines() {
  static const std::vector<std::string> names = {"mujoco", "dart"};
  return names;
}

std::vector<std::string> installed_engines() {
  std::vector<std::string> names = known_engines();
  std::erase_if(names, [](const std::string& name) { return find_file(module_of(name)).empty(); });
  return names;
}

bool is_engine(const std::string& name) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_letter)) return false;
  const auto& known = known_engines();
  return std::find(known.begin(), known.end(), name) != known.end() ||
         !find_file(module_of(name)).empty();
}

Answer run_engine(const std::string& name, const Mechanism& m, const Progress& progress) {
  Answer answer;
  const auto failed = [&](const std::string& why) {
    answer.failure = name + ": " + why;
    return answer;
  };
  const std::filesystem::path module = find_file(module_of(name));
  if (module.empty())
    return failed("is not installed: there is no " + module_of(name) +
                  " beside the program or in BENTAXIS_ENGINE_PATH");
  const std::filesystem::path runner = find_file("bentaxis_engine_runner");
  if (runner.empty())
    return failed("cannot be run: there is no bentaxis_engine_runner beside the program");
  Shared counts;
  const auto count = [](const auto& list) { return static_cast<std::int32_t>(list.size()); };
  counts.bodies = count(m.bodies);
  counts.samples = count(m.states);
  counts.freedoms = count(m.states.front().position);
  counts.actions = count(m.actions);
  counts.supports = count(m.supports);
  std::copy_n(m.gravity.data(), 3, counts.gravity);
  counts.length = m.length;
  Arrays arrays{};
  const SharedMemory memory(lay_out(nullptr, counts, arrays)), output(1);
  if (memory.get() == nullptr || output.get() == nullptr)
    return failed("there is no memory for it");
  auto* shared = new (memory.get()) Shared(counts);
  lay_out(shared, counts, arrays);
  write(m, arrays);
  const Stopwatch stopwatch;
  const std::optional<int> status =
      run_process(runner.string(), module.string(), memory.file(), output.file(), progress);
  answer.seconds = stopwatch.seconds();
  shared->text[sizeof shared->text - 1] = 0;
  const std::string text = without_control_characters(shared->text);
  switch (shared->outcome) {
    case Outcome::returned:
      break;
    case Outcome::unfinished:
      return failed(how_it_ended(status, last_words(output.file())));
    case Outcome::not_loaded:
    case Outcome::no_function:
      return failed(module.string() + " is no module of an engine: " + text);
    case Outcome::other_interface:
      return failed(fmt::format("{} has interface {}, this program {}", module.string(),
                                shared->interface, BENTAXIS_ENGINE_INTERFACE));
  }
  const std::size_t size = m.states.size() * (m.actions.size() + m.supports.size());
  answer.values.assign(arrays.values, arrays.values + size);
  if (std::isnan(answer.values.front())) return failed(text);
  if (!std::all_of(answer.values.begin(), answer.values.end(),
                   [](double value) { return std::isfinite(value); }))
    return failed("a result is not a number");
  answer.text = text;
  answer.residual = *std::max_element(arrays.residual, arrays.residual + m.states.size());
  return answer;
}

}  // namespace bentaxis::engines
