// A pump carried through time by what turns its shaft, from row to row.
#pragma once

#include <SimTKsimbody.h>

#include <memory>
#include <vector>

#include "bentaxis/multibody/simulation.h"
#include "integration/case_drive.h"
#include "integration/event_stepper.h"
#include "placement/placement.h"
#include "reactions/body_loads.h"
#include "scene/pump_system.h"

namespace bentaxis::multibody {

/// One simulation. Between events every load is on one smooth branch: of the chambers' pressures,
/// of the contact of the teeth, of dry friction that jumps.
class MotionRun {
 public:
  /// @param the_case, pressure  outlive the run
  MotionRun(const Case& the_case, const Assumptions& assumptions, const PressureTrace& pressure,
            const IntegrationOptions& options, long most_steps, bool body_loads);

  /// Fills rows and record.
  void run(Trajectory& trajectory, const Progress& progress);

  PumpSystem& system() { return system_; }

 private:
  struct Event {
    Witness witness;
    std::function<void()> happen;  ///< puts the loads on the branch that follows
  };

  void place_at_start();
  double psi_deg(const SimTK::State& state) const;
  double block_speed(const SimTK::State& state) const;
  double shaft_speed(const SimTK::State& state) const;
  double shaft_angle(const SimTK::State& state) const;
  double lag(const SimTK::State& state) const;

  void set_pressure();
  std::vector<Event> events();
  void add_pressure_edges(std::vector<Event>& events);
  void add_tooth_events(std::vector<Event>& events);
  void add_wall_events(std::vector<Event>& events);
  void touch_wall(std::size_t piston);
  void leave_wall(std::size_t piston);
  void note_wall(std::size_t piston, bool touch);
  int carrying_walls();
  void add_friction_jumps(std::vector<Event>& events);
  void set_branch(int flank, bool released);
  void touch(int flank);
  void leave(int flank);
  void advance_to(double time);
  void guard_against_chatter(double time);

  void read(double time, Trajectory& trajectory);
  void account(TrajectoryRecord& record);

  const Case& case_;
  CaseDrive drive_;
  const DriveSpec& spec_;
  const PressureTrace& pressure_;
  PumpSystem system_;
  EventStepper stepper_;
  bool body_loads_;
  BodyLoadReader load_reader_;
  // Block angles in [0, 360) at which a chamber's pressure has an edge, and the present segment
  // between two of them, degrees that do not wrap.
  std::vector<double> edges_;
  double accuracy_;
  long segment_ = 0;
  double low_ = 0, high_ = 0;
  // Contact.
  std::vector<ToothEvent> tooth_events_;
  double impulse_at_touch_ = 0, apart_since_ = 0, time_apart_ = 0;
  double last_event_ = -1;
  int events_there_ = 0;
  double energy_at_start_ = 0, elastic_at_start_ = 0;
  TrajectoryRecord record_;
};

}  // namespace bentaxis::multibody
