// A curve over the turn made of cubic pieces of any lengths.
#pragma once

#include <vector>

namespace bentaxis {

/// Periodic, piecewise cubic curve of period 360 degrees, each piece by values and slopes at its
/// two ends (Hermite). Slopes may jump from piece to piece.
class PeriodicCubic {
 public:
  struct Piece {
    double from_deg = 0;
    double value = 0, slope = 0;          ///< at its start; slope per degree
    double end_value = 0, end_slope = 0;  ///< where the next piece starts
  };

  PeriodicCubic() = default;
  /// @param pieces  the first from 0 deg, rising; the last ends at 360
  /// @throws InputError where they are not so
  explicit PeriodicCubic(std::vector<Piece> pieces);

  /// Value at any angle, degrees.
  double operator()(double angle_deg) const;
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  std::vector<Piece> pieces_;
};

/// Value of a piece that ends at `to_deg`.
double value_at(const PeriodicCubic::Piece& piece, double to_deg, double angle_deg);

}  // namespace bentaxis
