#include "src/study/chart/reference_file.h"

#include "rig/io/file_io.h"
#include "rig/io/json_file.h"
#include "src/base/content_hash.h"

#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tutu::app {
namespace {

using nlohmann::ordered_json;

constexpr double k_per_metre = 1e6; // micrometres: below every error that is told

double rounded(double metres) { return std::round(metres * k_per_metre); }

ordered_json json_of(const GarmentPositions& garments, bool exact) {
  ordered_json json = ordered_json::array();
  for (const std::vector<Vec3>& positions : garments) {
    ordered_json numbers = ordered_json::array();
    for (const Vec3& p : positions)
      for (int axis = 0; axis < 3; ++axis) {
        if (exact) numbers.push_back(p[axis]);
        else numbers.push_back(static_cast<std::int64_t>(rounded(p[axis])));
      }
    json.push_back(std::move(numbers));
  }
  return json;
}

GarmentPositions positions_of(const JsonValue& json, bool exact) {
  GarmentPositions garments;
  for (const JsonValue& item : json.items()) {
    const std::vector<double> numbers = item.numbers();
    if (numbers.size() % 3 != 0) throw item.error(std::to_string(numbers.size()) + " numbers", "three a particle");
    std::vector<Vec3>& positions = garments.emplace_back();
    for (std::size_t i = 0; i < numbers.size(); i += 3)
      positions.push_back(Vec3(numbers[i], numbers[i + 1], numbers[i + 2]) / (exact ? 1.0 : k_per_metre));
  }
  return garments;
}

void add(ContentHash& hash, const GarmentPositions& garments) {
  hash.add(std::uint64_t{garments.size()});
  for (const std::vector<Vec3>& positions : garments) {
    hash.add(std::uint64_t{positions.size()});
    for (const Vec3& p : positions)
      for (int axis = 0; axis < 3; ++axis) hash.add(static_cast<std::uint64_t>(std::llround(rounded(p[axis]))));
  }
}

std::string checksum_of(const Reference& r) {
  ContentHash hash;
  hash.add(r.fingerprint);
  hash.add(static_cast<std::uint64_t>(r.substeps));
  hash.add(r.resolution);
  for (const int frames : {r.protocol.frames, r.protocol.settle, r.protocol.held, r.protocol.every})
    hash.add(static_cast<std::uint64_t>(frames));
  for (const Refinement& f : r.refinements) {
    hash.add(static_cast<std::uint64_t>(f.from));
    hash.add(static_cast<std::uint64_t>(f.to));
    for (const double v : {f.trajectory_rms, f.trajectory_max, f.drape_rms, f.drape_hausdorff}) hash.add(v);
  }
  add(hash, r.start);
  add(hash, r.trajectory.drape);
  for (const Trajectory::Moment& moment : r.trajectory.moments) {
    hash.add(moment.time);
    add(hash, moment.positions);
    for (const std::vector<std::uint8_t>& flags : moment.touching)
      for (const std::uint8_t flag : flags) hash.add(std::uint64_t{flag});
  }
  return hash.text();
}

std::string text_of(const std::vector<std::uint8_t>& flags) {
  std::string text;
  for (const std::uint8_t flag : flags) text += flag ? '1' : '0';
  return text;
}

std::vector<std::uint8_t> flags_of(const JsonValue& json, std::size_t count) {
  const std::string text = json.string();
  if (text.size() != count || text.find_first_not_of("01") != text.npos)
    throw json.error(std::to_string(text.size()) + " characters", std::to_string(count) + " of 0 and 1");
  std::vector<std::uint8_t> flags;
  for (const char c : text) flags.push_back(c == '1');
  return flags;
}

Trajectory::Moment moment_of(const JsonValue& json) {
  json.only_keys({"time", "positions_um", "touching"});
  Trajectory::Moment moment{json.at("time").number(), positions_of(json.at("positions_um"), false), {}};
  const std::vector<JsonValue> touching = json.at("touching").items();
  if (touching.size() != moment.positions.size())
    throw json.at("touching")
        .error(std::to_string(touching.size()) + " garments", std::to_string(moment.positions.size()));
  for (std::size_t g = 0; g < touching.size(); ++g)
    moment.touching.push_back(flags_of(touching[g], moment.positions[g].size()));
  return moment;
}

/// Particles of each garment: what all positions of one reference have in common.
std::vector<std::size_t> sizes_of(const GarmentPositions& garments) {
  std::vector<std::size_t> sizes;
  for (const std::vector<Vec3>& positions : garments) sizes.push_back(positions.size());
  return sizes;
}

} // namespace

void write_reference(const Reference& r, const std::filesystem::path& file) {
  ordered_json json = {{"scene", r.scene},           {"fingerprint", r.fingerprint}, {"substeps", r.substeps},
                       {"resolution", r.resolution}, {"frames", r.protocol.frames},  {"settle", r.protocol.settle},
                       {"held", r.protocol.held},    {"every", r.protocol.every}};
  json["refinements"] = ordered_json::array();
  for (const Refinement& f : r.refinements)
    json["refinements"].push_back({{"from", f.from},
                                   {"to", f.to},
                                   {"trajectory_rms", f.trajectory_rms},
                                   {"trajectory_max", f.trajectory_max},
                                   {"drape_rms", f.drape_rms},
                                   {"drape_hausdorff", f.drape_hausdorff}});
  json["start"] = json_of(r.start, true);
  json["moments"] = ordered_json::array();
  for (const Trajectory::Moment& moment : r.trajectory.moments) {
    ordered_json touching = ordered_json::array();
    for (const std::vector<std::uint8_t>& flags : moment.touching) touching.push_back(text_of(flags));
    json["moments"].push_back(
        {{"time", moment.time}, {"positions_um", json_of(moment.positions, false)}, {"touching", std::move(touching)}});
  }
  json["drape_um"] = json_of(r.trajectory.drape, false);
  json["checksum"] = checksum_of(r);
  write_file(file, json.dump() + "\n");
}

Reference reference_of(const JsonValue& json) {
  json.only_keys({"scene", "fingerprint", "substeps", "resolution", "frames", "settle", "held", "every", "refinements",
                  "start", "moments", "drape_um", "checksum"});
  Reference r;
  r.scene = json.at("scene").string();
  r.fingerprint = json.at("fingerprint").string();
  constexpr int k_many = 1 << 30;
  r.substeps = json.at("substeps").integer_in(1, k_many);
  r.resolution = json.at("resolution").positive();
  r.protocol = {json.at("frames").integer_in(1, k_many), json.at("settle").integer_in(0, k_many),
                json.at("held").integer_in(0, k_many), json.at("every").integer_in(1, k_many)};
  for (const JsonValue& item : json.at("refinements").items()) {
    item.only_keys({"from", "to", "trajectory_rms", "trajectory_max", "drape_rms", "drape_hausdorff"});
    r.refinements.push_back({item.at("from").integer_in(1, k_many), item.at("to").integer_in(1, k_many),
                             item.at("trajectory_rms").number(), item.at("trajectory_max").number(),
                             item.at("drape_rms").number(), item.at("drape_hausdorff").number()});
  }
  r.start = positions_of(json.at("start"), true);
  for (const JsonValue& item : json.at("moments").items()) r.trajectory.moments.push_back(moment_of(item));
  r.trajectory.drape = positions_of(json.at("drape_um"), false);
  const std::vector<std::size_t> sizes = sizes_of(r.trajectory.drape);
  if (r.start.size() != sizes.size())
    throw json.at("start").error(std::to_string(r.start.size()) + " garments", std::to_string(sizes.size()));
  const std::vector<JsonValue> moments = json.at("moments").items();
  for (std::size_t m = 0; m < moments.size(); ++m)
    if (const auto found = sizes_of(r.trajectory.moments[m].positions); found != sizes)
      throw moments[m].at("positions_um").error(fmt::format("{} particles", found), fmt::format("{}", sizes));
  return r;
}

Reference read_reference(const std::filesystem::path& file, const std::string& scene, const std::string& fingerprint) {
  const JsonValue json = JsonValue::read(file);
  if (const JsonValue found = json.at("fingerprint"); found.string() != fingerprint)
    throw found.error("a reference of " + json.at("scene").string() + " (" + found.string() + ")",
                      "that of " + scene + " (" + fingerprint + ")");
  Reference r = reference_of(json);
  const std::string checksum = checksum_of(r);
  if (json.at("checksum").string() != checksum)
    throw json.at("checksum").error(checksum + " of what is in the file; delete the file to have it made anew");
  return r;
}

} // namespace tutu::app
