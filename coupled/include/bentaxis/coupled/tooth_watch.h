// Contact of teeth, or of pistons that carry the block, while a pump runs, by intervals of time.
#pragma once

#include <memory>
#include <string>

#include "bentaxis/results/mechanics.h"
#include "bentaxis/results/oil.h"

namespace bentaxis::coupled {

/// Of an interval of time. Where pistons carry the block, contacts are those of pistons and walls,
/// a side is the sign of theta - psi at the touch, and the force is the sum of all wall forces.
struct ContactInterval {
  double duration = 0;     ///< s
  double apart = 0;        ///< s without touch of a contact
  double plus = 0;         ///< s on the side that pushes the block towards +psi
  double minus = 0;        ///< s on the other
  double largest = 0;      ///< N, of the tooth force
  double impulse = 0;      ///< Ns, integral of the magnitude of the tooth force
  int separations = 0;     ///< contacts that left
  int impacts = 0;         ///< touches as fast as an impact
  double largest_hit = 0;  ///< Ns, of impacts whose flanks left again in the interval; not of walls
};

using ToothStretch [[deprecated("use ContactInterval")]] = ContactInterval;

/// Both intervals as one.
ContactInterval operator+(const ContactInterval& a, const ContactInterval& b);

/// Follows motion and oil as simulate() does, without rows. The largest force is that at the ends
/// of steps and at the tops of the parabolas through three of them.
class ToothWatch {
 public:
  /// @param name          of the model, for messages
  /// @param tolerance     error per step of each state, of its scale
  /// @param impact_speed  m/s of approach from which on a touch is an impact
  ToothWatch(std::string name, Mechanics& mechanics, const Oil& oil, double tolerance,
             double impact_speed);
  ~ToothWatch();

  /// Begins at time 0 with shaft and block as `motion` says and the oil as it starts.
  void start(const MotionVector& motion);
  /// @throws ComputationError naming the time where the motion cannot be followed
  ContactInterval run_to(double time);
  const MotionVector& motion() const;
  long steps() const;

 private:
  class Watcher;
  std::unique_ptr<Watcher> watcher_;
};

}  // namespace bentaxis::coupled
