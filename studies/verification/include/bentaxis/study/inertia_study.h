// The whole study of lumped and real pistons: what `bentaxis inertia` computes.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bentaxis/compare/published.h"
#include "bentaxis/study/failed_point.h"
#include "bentaxis/study/inertia.h"

namespace bentaxis::study {

struct InertiaOptions {
  std::vector<double> speeds = {1500, 2350};  ///< rpm
  MapAxis map_axis = MapAxis::mass;
  /// Range of speed of the map, rpm; absent: a third of the slowest to 3 times the fastest.
  std::optional<std::pair<double, double>> map_speeds;
  std::pair<double, double> map_factors = {0.25, 8};  ///< on mass or length
  int map_size = 30;                                  ///< values along each side of the map
};

struct InertiaStudy {
  Case the_case;                       ///< with its chamber pressure
  std::vector<InertiaRun> one_piston;  ///< by speed: without load, loaded
  std::vector<InertiaRun> full;        ///< likewise
  ErrorCauses causes, multibody_causes;
  std::vector<Lumping> lumpings, over_fraction;
  ThreeMasses masses;
  ErrorMap map;
  std::vector<Approach> approach;
  std::optional<SpinRun> spin;  ///< absent: a piston without axial inertia has no freedom to spin
  std::vector<SceneCost> costs;
  std::vector<FailedPoint> failed;  ///< speeds whose pressure could not be computed: left out
  double fastest = 0;               ///< rpm
  double models_apart = 0;          ///< largest difference of the two models, of peak
  double scenes_apart = 0;          ///< of the one-piston scene from the full pump, of peak

  /// The run of a list at the same speed, loaded.
  static const InertiaRun& loaded(const std::vector<InertiaRun>& runs, double speed_rpm);
  bool agrees() const;
};

/// Refuses a case whose block does not turn exactly as its shaft does.
/// @param study  "an inertia study"
/// @throws InputError naming the transfers that do
void require_even_transfer(const Case& the_case, const std::string& study);

/// Both models solve the same equations; what they may differ by, of peak.
inline constexpr double kInertiaModelsAgree = 1e-10;
/// N. A force between resolved teeth is their stiffness times a gap, which has the round-off of the
/// radii that it is a difference of. E times the width is more than any pair's stiffness. 0 of
/// other contacts.
double tooth_round_off(const PumpParameters& pump);
/// The one-piston scene against the full pump, of peak.
inline constexpr double kInertiaScenesAgree = 1e-11;

/// Two masses do for a reaction where they miss at most this share of its loaded peak: less than
/// what masses and radii of a drawing are known to.
inline constexpr double kTwoMassesDo = 0.01;

/// @param as_read  a chamber pressure of kind "hydraulic" is computed at each speed
/// @throws InputError where the case has no data of the real piston or a speed is 0;
///         ComputationError
InertiaStudy run_inertia_study(const Case& as_read, const InertiaOptions& options,
                               const PartProgress& progress_of);

/// Holds the unloaded runs of both kinds of piston to the printed numbers of their speeds.
compare::PublishedSection judge_inertia(const InertiaStudy& study,
                                        const compare::Published& published);

}  // namespace bentaxis::study
