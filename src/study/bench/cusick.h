// The drape of fabrics by the test that mills use [Cusick 1968].
#pragma once

#include "cloth/garment/garment.h"
#include "src/study/bench/analytic_scenes.h"

#include <filesystem>

namespace tutu::app {

/// A disc of 30 cm lies on a support of 18 cm; of the ring that hangs over, the share that its shadow covers: 1 for a
/// board, little for a rag. No number when the run broke. At least k_cusick_substeps a frame.
double drape_coefficient(const cloth::Fabric& fabric, const RunSettings& setup);
inline constexpr int k_cusick_substeps = 60;
/// N/m: threads as stiff as a fabric's own would need more substeps; so much less, and still none gives by 2 %.
inline constexpr double k_cusick_stretch = 1000.0;

/// Every fabric of the folder, in alphabetical order, beside the published band of its kind; one without such a band is
/// measured only. Throws InputError on a broken file, and where there is no fabric.
std::vector<AnalyticFigure> cusick(const std::filesystem::path& fabrics, const RunSettings& setup);

} // namespace tutu::app
