// Settled garments: read, written, and read again to the bit.
#include "cloth/garment/drape_file.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_drape(std::string_view input) {
  const cloth::Drape drape = cloth::read_drape(write_input(input, "drape.json"));
  cloth::write_drape(drape, scratch() / "again.json");
  const cloth::Drape again = cloth::read_drape(scratch() / "again.json");
  require(again.fingerprint == drape.fingerprint && again.garments.size() == drape.garments.size(),
          "a drape reads back as written");
  for (std::size_t g = 0; g < drape.garments.size(); ++g)
    require(again.garments[g].name == drape.garments[g].name &&
                again.garments[g].positions == drape.garments[g].positions,
            "a draped garment reads back to the bit");
}

} // namespace tutu::fuzz
