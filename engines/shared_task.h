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
  std::int32_t request = BENTAXIS_ENGINE_GIVEN_MOTION;
  std::int32_t bodies = 0, freedoms = 0, samples = 0, actions = 0, supports = 0, loops = 0;
  std::int32_t first = 0, every = 1;
  double gravity[3] = {}, length = 1, interval = 0, seconds = 0;
  char settings[256] = "";
  char text[sizeof(bentaxis_engine_answer::text)] = "";  ///< of the answer, or why there is none
};

/// Arrays of a task and of its answer.
struct Arrays {
  std::int32_t *parent, *freedom_body, *freedom_turns, *freedom_driven, *action_on, *action_by,
      *support_body, *loop_on, *loop_by, *loop_action;
  double *place, *axes, *mass, *centre, *inertia, *freedom_axis, *position, *velocity,
      *acceleration, *loads, *action, *support, *loop_point_on, *loop_point_by, *values, *residual;
};

/// Places of the arrays. @return bytes of all of it
inline std::size_t lay_out(Shared* shared, const Shared& counts, Arrays& arrays) {
  auto* memory = reinterpret_cast<char*>(shared);
  std::size_t end = (sizeof(Shared) + 7) / 8 * 8;
  const auto place = [&](auto*& array, std::size_t count) {
    array = reinterpret_cast<std::remove_reference_t<decltype(array)>>(memory + end);
    end += (count * sizeof(*array) + 7) / 8 * 8;
  };
  const auto count = [](std::int32_t number) { return static_cast<std::size_t>(number); };
  const std::size_t b = count(counts.bodies), f = count(counts.freedoms), n = count(counts.samples),
                    a = count(counts.actions), s = count(counts.supports), l = count(counts.loops);
  place(arrays.parent, b);
  place(arrays.freedom_body, f);
  place(arrays.freedom_turns, f);
  place(arrays.freedom_driven, f);
  place(arrays.action_on, a);
  place(arrays.action_by, a);
  place(arrays.support_body, s);
  place(arrays.loop_on, l);
  place(arrays.loop_by, l);
  place(arrays.loop_action, l);
  place(arrays.loop_point_on, 3 * l);
  place(arrays.loop_point_by, 3 * l);
  place(arrays.place, 3 * b);
  place(arrays.axes, 9 * b);
  place(arrays.mass, b);
  place(arrays.centre, 3 * b);
  place(arrays.inertia, 3 * b);
  place(arrays.freedom_axis, 3 * f);
  place(arrays.position, n * f);
  place(arrays.velocity, n * f);
  place(arrays.acceleration, n * f);
  place(arrays.loads, n * b * 6);
  place(arrays.action, n * a * 6);
  place(arrays.support, n * s * 6);
  place(arrays.values, n * (a + s));
  place(arrays.residual, n);
  return end;
}

}  // namespace bentaxis::engines
