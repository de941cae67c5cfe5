// Diagrams that engineers draw of a pump's forces: polygons, polar loci, shares, pressure on the
// plate, volume and pressure of a chamber.
#pragma once

#include <string>
#include <vector>

#include "bentaxis/pump/case.h"
#include "bentaxis/report/document.h"
#include "bentaxis/results/body_loads.h"
#include "bentaxis/results/result_table.h"
#include "bentaxis/study/shown_pump.h"

namespace bentaxis::study {

/// A run as its diagrams show it: one model's rows, over the shaft angle or in time.
struct DiagramRun {
  const Case& the_case;
  const ResultTable& table;              ///< all channels
  const BodyLoadTable* loads = nullptr;  ///< row for row, for the polygons; nullptr: none
  std::vector<double> block_deg = {};    ///< per row; empty: the block turns as the shaft does
  std::vector<double> time_ms = {};      ///< per row, of a simulation; empty: over the shaft angle
  bool constant_ports = true;            ///< ports at the pressures of the case
};

/// Force polygons of piston 1 (Fig. 14b) and of the block, polar loci of both bearing forces, tooth
/// force by flank (where one point of contact stands for the teeth), pressure on the plate,
/// pistons' moments on the block as shares upon each other, volume and pressure of chamber 1. What
/// the table lacks is left out.
std::vector<report::Figure> force_figures(const DiagramRun& run);

[[deprecated("use show_pump and force_figures")]] inline std::vector<report::Figure>
analytic_force_figures(const Case& the_case) {
  const ShownPump pump = show_pump(the_case);
  return force_figures({pump.ready.the_case, pump.run.table, &pump.run.loads});
}

/// The force polygon of a body, tip to tail in two or three planes of S2, at angles over the run.
/// Applied loads come first and reactions last, so that the reactions close it; loads of one name
/// have one colour.
/// @param planes  which components are drawn across and up, 0..2 for x2, y2, z2
/// @param shown_deg  the shaft angle that a still picture shows, the nearest there is
report::Figure force_polygon(const DiagramRun& run, const std::string& body,
                             const std::vector<std::pair<int, int>>& planes, double shown_deg);

/// Pressures of ports, lands and chambers on the port plate with the point of the film force.
report::Figure plate_pressure(const DiagramRun& run);

}  // namespace bentaxis::study
