// The curves and drawings of Roccatello & Nervegna (2009) by both models, each in its printed axes
// where they are known. What a figure shows, at which condition, and what can be said of its axes
// is data (reference_data/published/bap63/figures.toml); here it is computed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/difference.h"
#include "bentaxis/compare/published.h"
#include "bentaxis/study/progress.h"
#include "bentaxis/study/run.h"

namespace bentaxis::study {

// ---- What is known of the paper's figures

struct PaperAxis {
  std::string quantity, unit;
  std::vector<double> labels;  ///< first, step, last that can be read; empty: none
  std::optional<std::pair<double, double>> range;  ///< nothing: unknown
  std::string why;  ///< how the range is known beyond its labels, or why it is not, or ""

  /// "0 to 360 (labels 0 to 350; one turn)", or "unknown: ..".
  std::string text() const;
  /// "0 to 360 deg", or "unknown".
  std::string short_text() const;
};

struct PaperCurve {
  std::string label;
  Model model = Model::analytic;      ///< that the paper shows; the other one is held against it
  std::string condition, variant;     ///< names in the file of printed numbers
  std::vector<std::string> channels;  ///< several: the magnitude of the vector
  double factor = 1;
  std::string times, over;       ///< facts that the curve is multiplied and divided by, or ""
  bool compliant_teeth = false;  ///< the tooth force of a compliant contact in motion instead
  bool leaves = false;           ///< the axis, whatever it is: no verdict
  bool dashed = false;           ///< as it is printed
};

struct PaperPanel {
  std::string name;  ///< where a figure has several: "top"
  std::string title;
  int turns = 1;  ///< that are drawn
  PaperAxis x, y;
  std::vector<PaperCurve> curves;
  std::string outside;  ///< why our curves leave the axis, or ""
  std::string differs;  ///< why a window of the printed numbers is not this axis, or ""
};

enum class PaperKind {
  curves,
  operating_points,      ///< means over delivery pressures
  block_from_the_front,  ///< the pistons' forces on it, at angles
  force_triangle,        ///< of piston 1 in the plane x2-z2, without inertia
  piston_in_two_planes,  ///< x2-z2 and y2-z2, with Rs
};

struct PaperFigure {
  int number = 0, page = 0;
  std::string part;  ///< "a", or ""
  std::string shows, note;
  PaperKind kind = PaperKind::curves;
  std::vector<PaperPanel> panels;  ///< of a drawing none
  std::string condition, variant;  ///< of a drawing
  std::vector<double> angles;      ///< of a drawing, deg
  std::vector<double> delivery_bar;

  std::string id(const PaperPanel& panel = {}) const;    ///< "fig14a", "fig15_Rb1"
  std::string name(const PaperPanel& panel = {}) const;  ///< "Fig. 14a", "Fig. 15, Rb1"
};

struct PaperFigures {
  struct CaseOfCondition {
    std::string condition, file;                 ///< in the folder of cases
    std::optional<double> inertia_alone_at_rpm;  ///< pressures, weight, spring and friction off
  };
  std::filesystem::path file;
  compare::Published numbers;  ///< with conditions and variants
  std::vector<CaseOfCondition> cases;
  std::vector<PaperFigure> figures;
  std::vector<std::pair<std::string, std::string>> left_out;  ///< figures, reason

  const CaseOfCondition& case_of(const std::string& condition) const;
};

/// @throws InputError naming file, line and key
PaperFigures read_paper_figures(const std::filesystem::path& file);

// ---- What the models make of them

struct DrawnCurve {
  std::string label;
  std::vector<double> x, y;
  bool judged = true, dashed = false;
  compare::Difference other_model;  ///< from the other model: the largest one, held to the peak
};

struct DrawnPanel {
  PaperFigure figure;
  PaperPanel panel;
  std::vector<DrawnCurve> curves;
  /// Of the curves with a verdict: which, where on the x axis, the value.
  struct End {
    std::string curve;
    double x = 0, y = 0;
  };
  End least, greatest;

  bool known() const { return panel.y.range.has_value(); }
  double below() const;  ///< how far the curves leave the axis at its lower end; 0: they do not
  double above() const;  ///< at its upper end
  bool inside() const { return known() && below() == 0 && above() == 0; }
};

struct PaperNumber {
  std::string figures;  ///< "14"
  compare::PublishedRow row;
};

/// What a figure that is a drawing is made of.
struct PaperTurn {
  PaperFigure figure;
  PumpParameters pump;
  ResultTable table;  ///< of a turn by the analytic model
};

struct PaperStudy {
  PaperFigures list;
  std::vector<Case> cases;  ///< as computed, by condition of the list
  std::vector<DrawnPanel> panels;
  std::vector<PaperTurn> turns;  ///< by figure that is a drawing
  std::vector<PaperNumber> numbers;
};

/// @param list   of which the study keeps a copy
/// @param cases  folder of the cases that it names
/// @throws InputError where a case does not meet its condition; ComputationError
PaperStudy run_paper_study(const PaperFigures& list, const std::filesystem::path& cases,
                           const PartProgress& progress_of = silent());

}  // namespace bentaxis::study
