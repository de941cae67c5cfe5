// Straight bevel teeth of shaft and block in closed form: spherical involutes on base cones.
#pragma once

#include <array>
#include <memory>

#include "bentaxis/pump/parameters.h"
#include "bentaxis/results/instant.h"
#include "bentaxis/results/teeth.h"

namespace bentaxis::analytic {

struct PreparedPump;

/// Shape of a pair of equal bevel gears and where it touches. Cones are half angles at O2, where
/// both axes meet, rad.
struct BevelGeometry {
  double pitch_cone = 0, base_cone = 0, tip_cone = 0, root_cone = 0;
  double distance = 0;    ///< R, m, of O4 from O2: the middle of the face width
  double base_pitch = 0;  ///< rad, of neighbouring flanks along the path of contact, seen from O2
  /// The path of contact is an arc of a great circle through O4, the trace of the plane of action.
  /// Its ends, rad from O4, positive in the direction of the force on the block.
  double path_begin = 0, path_end = 0;
  double contact_ratio = 0;
  /// How far teeth may be pressed into each other, m, before a pair touches that is not among the
  /// kPairsPerFlank that are looked at.
  double reach = 0;
};

/// Teeth of a pump. Immutable; one object serves many threads, cheap to copy.
class BevelTeeth {
 public:
  /// @throws InputError naming table and key: as validate(); where the pump has no teeth, a contact
  ///         ratio below 1 or above kLargestContactRatio, tips that meet the other below its base
  ///         cone, undercut, pointed tips, no clearance, a face width that reaches O2
  explicit BevelTeeth(const PumpParameters& pump);

  const BevelGeometry& geometry() const;

  /// Contacts and forces of the teeth. Allocates nothing.
  /// @param theta        rad, of the shaft
  /// @param shaft_speed  rad/s
  /// @param lag          of the block's teeth: they stand at theta less its angle
  /// @param dissipation  false: without the part of the force that the speed of approach makes
  TeethAction act(double theta, double shaft_speed, const ToothLag& lag,
                  bool dissipation = true) const;

  /// Force on the block, S1, N, and its moment about O2, Nm, alone: the sums of act(), sooner.
  struct Wrench {
    std::array<double, 3> force = {}, moment = {};
  };
  Wrench wrench(double theta, double shaft_speed, const ToothLag& lag,
                bool dissipation = true) const;
  /// Parts of a vector in S1 along z2 and z1. Of the moment on the block: the torque on it, and the
  /// opposite of the torque on the shaft.
  double about_block_axis(const std::array<double, 3>& moment) const;
  static double about_shaft_axis(const std::array<double, 3>& moment) { return moment[2]; }

  /// The lag at which the teeth rest under this torque on the block about z2, Nm, to round-off;
  /// without torque that at which flank +1 just touches.
  /// @throws ComputationError where no lag carries the torque
  ToothLag rest(double theta, double torque_on_block) const;

  /// The largest approach of any pair and slice of a flank, m, < 0: the gap; continuous. And the
  /// speed of approach there, m/s.
  struct Approach {
    double distance = 0, rate = 0;
  };
  Approach approach(double theta, double shaft_speed, const ToothLag& lag, int flank) const;

  /// Of a pair that touches at O4 over the whole face width, along the line of action, N/m.
  double stiffness() const;

 private:
  struct Numbers;
  struct Contact;
  // The rounding estimate moves inputs by little, over their bounds too where they stand on them.
  friend void prepare(const PumpParameters& pump, const Assumptions& assumptions,
                      PreparedPump& result);
  struct Unchecked {};
  BevelTeeth(const PumpParameters& pump, Unchecked);

  std::shared_ptr<const Numbers> numbers_;
};

}  // namespace bentaxis::analytic
