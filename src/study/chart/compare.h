// How far a run is from the reference.
#pragma once

#include "src/measure/cell_run.h"

namespace tutu::app {

struct RunErrors {
  double trajectory_rms = 0.0,
         trajectory_max = 0.0;                   ///< m, of free particles, in the recorded frames of the first second
  double drape_rms = 0.0, drape_hausdorff = 0.0; ///< m, between the surfaces
  double missed = 0.0, false_contacts = 0.0;     ///< of the reference's contacts; of the particles it leaves free
  double reference_contacts = 0.0;               ///< share of free particles that touch in the reference
};

/// Garments in the same order; both recorded at the same moments. What a run that ended early has not is not compared.
RunErrors errors_against(const std::vector<cloth::Garment>& reference_garments, const Trajectory& reference,
                         const std::vector<cloth::Garment>& garments, const Trajectory& run);

inline constexpr double k_trajectory_seconds = 1.0; ///< what follows is chaos: folds that fall one way or the other

} // namespace tutu::app
