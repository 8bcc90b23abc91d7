#include "cloth/garment/drape_file.h"

#include "rig/io/file_io.h"
#include "rig/io/json_file.h"

#include <charconv>
#include <fmt/format.h>

namespace tutu::cloth {

Drape read_drape(const std::filesystem::path& file) {
  const JsonValue json = JsonValue::read(file);
  json.only_keys({"fingerprint", "garments"});
  Drape drape;
  const JsonValue fingerprint = json.at("fingerprint");
  const std::string digits = fingerprint.string();
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), drape.fingerprint, 16);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw fingerprint.error("up to 16 hexadecimal digits");
  for (const JsonValue& item : json.at("garments").items()) {
    item.only_keys({"name", "positions"});
    DrapedGarment garment{item.at("name").string(), {}};
    for (const JsonValue& position : item.at("positions").items()) garment.positions.push_back(position.vec3());
    drape.garments.push_back(std::move(garment));
  }
  return drape;
}

void write_drape(const Drape& drape, const std::filesystem::path& file) {
  std::string text = fmt::format("{{\n  \"fingerprint\": \"{:016x}\",\n  \"garments\": [", drape.fingerprint);
  for (std::size_t g = 0; g < drape.garments.size(); ++g) {
    const DrapedGarment& garment = drape.garments[g];
    text += fmt::format("{}\n    {{ \"name\": {}, \"positions\": [", g ? "," : "", nlohmann::json(garment.name).dump());
    for (std::size_t i = 0; i < garment.positions.size(); ++i) {
      const Vec3& p = garment.positions[i];
      text += fmt::format("{}\n      [{}, {}, {}]", i ? "," : "", p.x(), p.y(),
                          p.z()); // shortest form that reads back the same
    }
    text += "] }";
  }
  text += "\n  ]\n}\n";
  write_file(file, text);
}

} // namespace tutu::cloth
