// Prints the hash of every kind of run of the cloth folder on a scene of its own. Built twice, with and without
// optimisation: both must print the same.
#include "cloth/adaptive_substeps.h"
#include "cloth/air/wind.h"
#include "cloth/metrics.h"
#include "cloth/recovery.h"
#include "tests/support/irregular_tube.h"
#include "tests/support/swinging_limbs.h"
#include "tests/support/woven_cases.h"

#include <cinttypes>
#include <cstdio>

using namespace tutu;
using namespace tutu::cloth;

namespace {

const Wind k_wind = {{2.0, 0.5, -3.0}, Gusts{1.0, 0.1, 7}};

/// 0 when the run could not be carried.
std::uint64_t hash_of(const Garment& garment, const SolverOptions& options, proxies::Backend backend, int frames) {
  GuardedSolver solver(make_solver(garment, options), garment);
  const auto query = proxies::make_query(backend);
  test::SwingingLimbs limbs(garment, 40);
  for (int frame = 0; frame < frames; ++frame) {
    FrameInput input = limbs.advance(options.solver == SolverKind::mass_spring ? 30 : 8);
    input.wind_start = wind_at(k_wind, frame * input.seconds);
    input.wind_end = wind_at(k_wind, (frame + 1) * input.seconds);
    input.substeps = plan_substeps(input, extent_of(solver.particles()), garment.fabric.contact_offset()).substeps;
    if (solver.step(input, *query)) return 0;
  }
  return state_hash(solver.particles());
}

} // namespace

int main() {
  std::vector<test::WovenCase> cases = test::woven_cases();
  for (const std::size_t k :
       {3, 5, 6, 8, 27}) { // rings of 15, 10 and 8 uneven lanes, a slit tube, a pinned grid: few, since -O0 is slow
    test::WovenCase& one = cases[k];
    if (one.garment.pins.empty()) test::pin_first_row(one.garment);
    for (const ContactFeatures features :
         {ContactFeatures::automatic, ContactFeatures::particles, ContactFeatures::triangles})
      for (const bool precise : {false, true}) {
        SolverOptions options;
        options.features = features;
        options.double_precision = precise;
        std::printf("%s, %s, %s: %016" PRIx64 "\n", one.name.c_str(),
                    std::string(k_contact_features_names[static_cast<std::size_t>(features)]).c_str(),
                    precise ? "double" : "float", hash_of(one.garment, options, proxies::Backend::hybrid, 6));
      }
    for (const proxies::Backend backend : {proxies::Backend::hybrid, proxies::Backend::fcl, proxies::Backend::brute})
      for (const SolverKind kind : {SolverKind::mass_spring, SolverKind::xpbd})
        std::printf("%s, %s, %s: %016" PRIx64 "\n", one.name.c_str(), std::string(name_of(kind)).c_str(),
                    std::string(proxies::k_backend_names[static_cast<std::size_t>(backend)]).c_str(),
                    hash_of(one.garment, {.solver = kind}, backend, 3));
    one.garment.fabric.air = Air{};
    for (const SolverKind kind : {SolverKind::mass_spring, SolverKind::xpbd})
      std::printf("%s, %s, in the air: %016" PRIx64 "\n", one.name.c_str(), std::string(name_of(kind)).c_str(),
                  hash_of(one.garment, {.solver = kind}, proxies::Backend::hybrid, 3));
  }
  const Garment irregular = test::irregular_tube(14);
  for (const proxies::Backend backend : {proxies::Backend::hybrid, proxies::Backend::fcl, proxies::Backend::brute})
    for (const SolverKind kind : {SolverKind::mass_spring, SolverKind::xpbd})
      std::printf("irregular tube, %s, %s: %016" PRIx64 "\n", std::string(name_of(kind)).c_str(),
                  std::string(proxies::k_backend_names[static_cast<std::size_t>(backend)]).c_str(),
                  hash_of(irregular, {.solver = kind, .features = ContactFeatures::triangles}, backend, 4));
}
