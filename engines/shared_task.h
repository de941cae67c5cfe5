// A task and its answer in memory that the program shares with the process of an engine. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "bentaxis/engines/interface.h"

namespace bentaxis::engines {

enum class Outcome : std::int32_t {
  unfinished,
  returned,
  not_loaded,
  no_function,
  other_interface
};

/// At the begin of the memory; the arrays follow.
struct Shared {
  Outcome outcome = Outcome::unfinished;
  std::int32_t interface = 0;  ///< of the module, where it is another one
  double seconds = 0;
  bentaxis_engine_task task{};  ///< without its arrays: they are elsewhere in each process
  char settings[256] = "";
  char text[sizeof(bentaxis_engine_answer::text)] = "";  ///< of the answer, or why there is none

  Shared() { task.length = task.every = 1; }
};

/// Places of the arrays of a task and of its answer. @return bytes of all of it
inline std::size_t lay_out(Shared* shared, bentaxis_engine_task& task,
                           bentaxis_engine_answer& answer) {
  auto* memory = reinterpret_cast<char*>(shared);
  std::size_t end = (sizeof(Shared) + 7) / 8 * 8;
  const auto place = [&](auto*& array, std::size_t count) {
    array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(memory + end);
    end += (count * sizeof(*array) + 7) / 8 * 8;
  };
  const auto count = [](int number) { return static_cast<std::size_t>(number); };
  const std::size_t b = count(task.bodies), f = count(task.freedoms), n = count(task.samples),
                    a = count(task.actions), s = count(task.supports), l = count(task.loops);
  place(task.parent, b);
  place(task.freedom_body, f);
  place(task.freedom_turns, f);
  place(task.freedom_driven, f);
  place(task.action_on, a);
  place(task.action_by, a);
  place(task.support_body, s);
  place(task.loop_on, l);
  place(task.loop_by, l);
  place(task.loop_action, l);
  place(task.loop_point_on, 3 * l);
  place(task.loop_point_by, 3 * l);
  place(task.place, 3 * b);
  place(task.axes, 9 * b);
  place(task.mass, b);
  place(task.centre, 3 * b);
  place(task.inertia, 3 * b);
  place(task.freedom_axis, 3 * f);
  place(task.position, n * f);
  place(task.velocity, n * f);
  place(task.acceleration, n * f);
  place(task.loads, n * b * 6);
  place(task.action, n * a * 6);
  place(task.support, n * s * 6);
  place(answer.values, n * (a + s));
  place(answer.residual, n);
  return end;
}

}  // namespace bentaxis::engines
