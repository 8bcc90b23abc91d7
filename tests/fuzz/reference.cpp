// References past their checksum: what a damaged or forged file of the cache could hold. Written with a checksum that
// fits, they read back.
#include "rig/io/json_file.h"
#include "src/study/chart/reference_file.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_reference(std::string_view input) {
  const app::Reference reference = app::reference_of(JsonValue::parse(input, "reference.json"));
  (void)app::convergence_text(reference);
  const std::filesystem::path first = scratch() / "first.json", second = scratch() / "second.json";
  app::write_reference(reference, first);
  app::write_reference(app::read_reference(first, reference.scene, reference.fingerprint), second);
  require(text_of(first) == text_of(second), "a reference reads back as written");
  for (const app::Trajectory::Moment& moment : reference.trajectory.moments) {
    require(moment.positions.size() == reference.trajectory.drape.size() &&
                moment.touching.size() == moment.positions.size(),
            "all moments are of the same garments");
    for (std::size_t g = 0; g < moment.positions.size(); ++g)
      require(moment.positions[g].size() == reference.trajectory.drape[g].size() &&
                  moment.touching[g].size() == moment.positions[g].size(),
              "all moments are of the same particles");
  }
}

} // namespace tutu::fuzz
