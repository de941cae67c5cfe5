// What the timing of the ports does to a chamber over a turn.
#pragma once

#include <optional>
#include <vector>

namespace bentaxis::hydraulics {

/// Chamber angles, degrees: from in [0, 360), from < to; beyond 360 it goes on over 0.
struct AngleInterval {
  double from_deg = 0, to_deg = 0;
};

using Stretch [[deprecated("use AngleInterval")]] = AngleInterval;

/// A chamber's turn as its ports time it (docs/hydraulics.md, "Timing"). SI, pressures gauge;
/// volumes are of one chamber per turn, at the density in the suction port.
struct Timing {
  /// Where its pressure is below that at which dissolved air comes out, and at which oil boils.
  std::vector<AngleInterval> below_saturation, below_vapour;

  /// Open to both ports at once.
  struct Connection {
    AngleInterval where;
    double largest_area = 0;  ///< m2, of both openings in series: 1/sqrt(1/as^2 + 1/ad^2)
    double largest_area_deg = 0;
    double through = 0;  ///< m3 that comes from the delivery port while as much leaves to suction
  };
  std::vector<Connection> connected;

  // From the delivery port into the chamber.
  std::vector<AngleInterval> backflow_where;
  double backflow = 0;          ///< m3, all of it, what goes on to the suction port included
  double largest_backflow = 0;  ///< m3/s
  double largest_backflow_deg = 0;
  /// m3 that takes the largest chamber from suction to mean delivery pressure: the oil that must
  /// come from the delivery port where nothing is compressed before it opens.
  double filling = 0;

  /// Closed to both ports.
  struct Trapped {
    AngleInterval where;
    double swept = 0;  ///< m3, maximum less minimum volume of the interval
    double greatest = 0, greatest_deg = 0;
    double least = 0, least_deg = 0;
  };
  std::vector<Trapped> trapped;

  /// The end of suction: where the chamber's longest interval open to the suction port alone ends,
  /// because that port closes or the delivery port opens.
  struct Filled {
    double at_deg = 0;
    /// Mass in the chamber there, over that of the same volume of oil at suction pressure.
    double ratio = 1;
    /// Volume of oil at suction pressure that it lacks, over the volume swept by a stroke: what
    /// incomplete filling takes from the volumetric efficiency. Below 0 where it holds more.
    double loss = 0;
  };
  /// None backwards, and where no chamber is ever open to the suction port alone.
  std::optional<Filled> filled;

  double through() const {
    double sum = 0;
    for (const Connection& c : connected) sum += c.through;
    return sum;
  }
};

}  // namespace bentaxis::hydraulics
