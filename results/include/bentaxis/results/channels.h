// What a run computes, as data: one entry per column of a result. CSV headers, comparison groups,
// plots, report and regression are all derived from this table.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace bentaxis {

enum class ChannelKind {
  reaction,  ///< one of the unknowns of the equilibrium equations
  derived,   ///< follows from reactions and positions
  input,     ///< given to the model
  check,     ///< must vanish
};

/// One scalar result: which component of what, on which body, by which body, at which point, in
/// which frame and unit.
struct Channel {
  std::string name;      ///< column name: reaction, piston, axis and frame, unit ("Rs_1_x2_N")
  std::string quantity;  ///< "Rs"
  std::string meaning;   ///< in words
  std::string equation;  ///< of Roccatello & Nervegna (2009)
  int piston = 0;        ///< 1..N, or 0 where it belongs to no piston
  std::string axis;      ///< "x2"
  std::string frame;     ///< "S2"
  std::string on_body, by_body, point;
  std::string unit;       ///< "N", "Nm", "mm", "bar"
  double unit_in_si = 1;  ///< SI value of one unit
  std::string group;      ///< channels that share one peak: the components of one vector
  ChannelKind kind = ChannelKind::reaction;
};

/// Where each quantity of a pump with N pistons stands in a row of results, and its description.
/// Pistons count from 0 here; axes are 0, 1, 2 for x, y, z. Cheap to make and to copy.
class ChannelLayout {
 public:
  explicit ChannelLayout(int pistons);

  int pistons() const { return n_; }
  std::size_t size() const { return channels_->size(); }
  /// Number of leading channels that are unknowns of the equilibrium: 5 N + 12.
  std::size_t reactions() const { return at(5, 12); }
  const std::vector<Channel>& channels() const { return *channels_; }

  std::size_t Rs(int k, int axis) const { return static_cast<std::size_t>(5 * k + axis); }
  std::size_t Rc(int k, int axis) const { return static_cast<std::size_t>(5 * k + 3 + axis); }
  std::size_t Fh() const { return at(5, 0); }
  std::size_t Th(int axis) const { return at(5, 1 + axis); }
  std::size_t Rcn(int axis) const { return at(5, 3 + axis); }
  std::size_t Rcs() const { return at(5, 5); }
  std::size_t Rb1(int axis) const { return at(5, 6 + axis); }
  std::size_t Rb2(int axis) const { return at(5, 9 + axis); }
  std::size_t Td() const { return at(5, 11); }
  std::size_t xh() const { return at(5, 12); }
  std::size_t yh() const { return at(5, 13); }
  std::size_t Tcs() const { return at(5, 14); }
  std::size_t pressure(int k) const { return at(5, 15 + k); }
  std::size_t zB(int k) const { return at(6, 15 + k); }
  std::size_t Rs3(int k, int axis) const { return at(7, 15 + 3 * k + axis); }
  std::size_t Tc(int k) const { return at(10, 15 + k); }
  std::size_t power_residual() const { return at(11, 15); }
  std::size_t axis_moment(int k) const { return at(11, 16 + k); }

 private:
  std::size_t at(int per_piston, int offset) const {
    return static_cast<std::size_t>(per_piston * n_ + offset);
  }

  int n_;
  std::shared_ptr<const std::vector<Channel>> channels_;  // one list per number of pistons
};

}  // namespace bentaxis
