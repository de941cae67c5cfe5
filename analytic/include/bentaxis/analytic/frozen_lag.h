// Where a block stands that pistons carry round at constant speed. docs/transfer.md.
#pragma once

#include <cstddef>
#include <string>

namespace bentaxis::analytic {

/// Lags, in rad, at which no piston touches its bore, at one angle of the shaft (T11).
struct FreePlay {
  double low = 0, high = 0;
  int low_piston = 0, high_piston = 0;  ///< which touches at that end, from 0
  bool exists = false;                  ///< false: a piston touches always, or none can
};

/// Where a block that pistons carry round stands at constant speed: the rule of docs/transfer.md
/// that decided.
struct FrozenLag {
  enum class Rule {
    no_load,   ///< nothing turns the block: middle of its free play
    one_side,  ///< a root outside the free play on one side only
    driving,   ///< roots on both sides: that towards which the shaft drives
    free,      ///< a root within the free play, no wall pushes
  };
  double angle = 0;          ///< theta - psi, rad
  double low = 0, high = 0;  ///< ends of the free play, rad
  Rule rule = Rule::one_side;
};

/// Rows of a run by rule, and how often the block changed sides between two of them.
struct LagRules {
  std::size_t rows[4] = {};  ///< by FrozenLag::Rule
  std::size_t side_changes = 0;
  int side = 0;  ///< of the last row that had one
  void count(const FrozenLag& lag);
  std::string text() const;
};

}  // namespace bentaxis::analytic
