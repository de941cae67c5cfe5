// A column over time beside the channels of a layout: of the motion's states, or of the oil.
#pragma once

#include <string>
#include <vector>

namespace bentaxis {

/// What a column holds. Nothing of this is in its name alone: the name is for people and files.
struct Column {
  std::string name;  ///< with its unit: "p_delivery_bar"
  std::string meaning;
  std::string unit = {};   ///< of bentaxis/pump/unit_of_measure.h: "bar"; "" where it has none
  std::string group = {};  ///< what is compared together: "p" of all chambers; "" = not compared
  int piston = 0;          ///< 1..N, or 0 where it belongs to no piston
};

/// The column of this name among those that say how a pump moves, in files and in simulations:
/// time, angles, speeds, accelerations, pressures of the ports. One of another name has a name
/// alone.
Column state_column(const std::string& name);

}  // namespace bentaxis
