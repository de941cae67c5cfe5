// What ends a piece of motion: edges of the pressure, and contacts that touch, leave or stop to
// push. Internal.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "bentaxis/results/trajectory.h"
#include "simulation/equations.h"

namespace bentaxis::analytic::simulation {

[[noreturn]] void stop_simulation(double time, const std::string& why);

// A value that ends the piece of motion where it rises above 0, with its rate.
struct EventFunction {
  double value, rate;
};

struct EventFunctions {
  // The two ends of an interval; of the teeth or of each wall two more.
  std::array<EventFunction, 2 + 2 * kMaxPistons> all;
  std::size_t count = 0;
  void add(double value, double rate) { all[count++] = {value, rate}; }
};

// First time in (0, h] at which the cubic through both ends is above 0; h or more: not within.
double first_above(const EventFunction& from, const EventFunction& to, double h);

// The interval between edges of the pressure in which the block stands.
class PressureInterval {
 public:
  PressureInterval(Equations& equations, const PressureTrace& pressure, int pistons)
      : equations_(equations), edges_deg_(block_edges_deg(pressure, pistons)) {}

  // The one in which the block stands, or which it enters.
  void start(double time, const State& y);
  // The next one, or the one before.
  void pass(bool upper_end);
  // Two: its ends.
  void add_functions(double time, const State& y, EventFunctions& g) const;
  // So near to an end the block is on it, rad.
  double nearness(double time, const State& y) const;

 private:
  double edge_deg(std::ptrdiff_t index) const;
  void set();

  Equations& equations_;
  std::vector<double> edges_deg_;
  double turn_ = 0;
  std::ptrdiff_t edge_ = 0;  // that ends the interval
};

// How flanks or walls stand to each other, and every touch.
class Contacts {
 public:
  explicit Contacts(Equations& equations) : equations_(equations) {}

  // Which of them press from here on.
  void start(double time, State& y);
  // To be asked for right after the rates there.
  void add_functions(double time, const State& y, const State& dy, EventFunctions& g) const;
  // By the place of a function among those that were added.
  double nearness(std::size_t function) const;
  // What changes where a function has reached 0. @return whether contact or free flight began
  bool change(std::size_t function, double time, State& y);
  bool is_apart() const;
  // The flank that pressed has left: its impulse is known.
  void close(const State& y);
  const std::vector<ToothEvent>& events() const { return events_; }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  void start_teeth(double time, const State& y);
  void start_walls(double time, const State& y);
  void change_flank(bool first_function, double time, State& y);
  void change_wall(std::size_t piston, bool passes, double time, const State& y);
  ToothEvent event(double time, const State& y, bool touch) const;
  void add(ToothEvent event, const char* bodies);
  void wall_changes(std::size_t piston, bool touch, double approach_speed, double time,
                    const State& y);
  void flank_changes(int from, int to, double time, State& y);

  Equations& equations_;
  std::vector<ToothEvent> events_;
  std::size_t touch_ = kNone;  // event of the flank that presses
  std::vector<bool> inside_;   // which pistons are within their walls
};

}  // namespace bentaxis::analytic::simulation
