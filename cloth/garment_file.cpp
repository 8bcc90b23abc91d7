#include "cloth/garment_file.h"

#include "rig/json_file.h"

#include <numbers>

namespace tutu::cloth {
namespace {

constexpr int k_most_particles_a_side = 4096;

GridShape read_grid(const JsonValue& json) {
  json.only_keys({"rows", "columns", "corner", "across", "down"});
  GridShape grid;
  grid.rows = json.at("rows").integer_in(2, k_most_particles_a_side);
  grid.columns = json.at("columns").integer_in(2, k_most_particles_a_side);
  grid.corner = json.at("corner").vec3();
  grid.across = json.at("across").vec3();
  grid.down = json.at("down").vec3();
  return grid;
}

TubeShape::Ring read_ring(const JsonValue& json) {
  json.only_keys({"height", "radius", "centre"});
  TubeShape::Ring ring;
  ring.height = json.at("height").number();
  const JsonValue radius = json.at("radius");
  if (radius.is_array()) {
    const std::vector<double> half_axes = radius.numbers(2);
    if (!(half_axes[0] > 0.0 && half_axes[1] > 0.0)) throw radius.error("two half axes [x, z] above 0");
    ring.radius_x = half_axes[0];
    ring.radius_z = half_axes[1];
  } else {
    ring.radius_x = ring.radius_z = radius.positive();
  }
  if (const auto centre = json.find("centre")) {
    const std::vector<double> xz = centre->numbers(2);
    ring.centre_x = xz[0];
    ring.centre_z = xz[1];
  }
  return ring;
}

TubeShape read_tube(const JsonValue& json) {
  json.only_keys({"rows", "columns", "rings", "start_degrees", "seam"});
  TubeShape tube;
  tube.rows = json.at("rows").integer_in(2, k_most_particles_a_side);
  tube.columns = json.at("columns").integer_in(4, k_most_particles_a_side);
  for (const JsonValue& ring : json.at("rings").items()) tube.rings.push_back(read_ring(ring));
  if (tube.rings.size() < 2) throw json.at("rings").error(std::to_string(tube.rings.size()) + " rings", "at least two");
  if (const auto start = json.find("start_degrees")) tube.start_angle = start->number() * std::numbers::pi / 180.0;
  if (const auto seam = json.find("seam")) tube.seam = seam->number_in(0.0, 1.0);
  return tube;
}

std::variant<GridShape, TubeShape> read_shape(const JsonValue& json) {
  json.only_keys({"grid", "tube"});
  const auto grid = json.find("grid"), tube = json.find("tube");
  if (grid.has_value() == tube.has_value()) throw json.error(grid ? "both" : "neither", "exactly one of: grid, tube");
  if (grid) return read_grid(*grid);
  return read_tube(*tube);
}

Fabric read_fabric(const JsonValue& json) {
  json.only_keys({"density", "stretch", "shear", "bend", "drag", "thickness", "clearance"});
  Fabric fabric;
  if (const auto v = json.find("density")) fabric.density = v->positive();
  if (const auto v = json.find("stretch")) fabric.stretch = v->positive();
  if (const auto v = json.find("shear")) fabric.shear = v->non_negative();
  if (const auto v = json.find("bend")) fabric.bend = v->non_negative();
  if (const auto v = json.find("drag")) fabric.drag = v->non_negative();
  if (const auto v = json.find("thickness")) fabric.thickness = v->non_negative();
  if (const auto v = json.find("clearance")) fabric.clearance = v->non_negative();
  return fabric;
}

/// "rows": 0 or [0, 2]; negative numbers count from the end.
void read_range(const JsonValue& json, int& first, int& last) {
  const auto index = [](const JsonValue& v) {
    return v.integer_in(-k_most_particles_a_side, k_most_particles_a_side - 1);
  };
  if (json.is_array()) {
    const auto ends = json.items();
    if (ends.size() != 2) throw json.error("a number, or [first, last]");
    first = index(ends[0]);
    last = index(ends[1]);
  } else {
    first = last = index(json);
  }
}

Attachment read_attachment(const JsonValue& json) {
  json.only_keys({"joint", "rows", "columns"});
  Attachment attachment;
  attachment.joint = json.at("joint").string();
  read_range(json.at("rows"), attachment.first_row, attachment.last_row);
  if (const auto columns = json.find("columns")) read_range(*columns, attachment.first_column, attachment.last_column);
  return attachment;
}

} // namespace

GarmentDescription read_garment(const std::filesystem::path& file) {
  const JsonValue json = JsonValue::read(file);
  json.only_keys({"name", "shape", "fabric", "attachments", "colour"});
  GarmentDescription description;
  description.file = file.string();
  description.name = json.has("name") ? json.at("name").string() : file.stem().string();
  description.shape = read_shape(json.at("shape"));
  if (const auto fabric = json.find("fabric")) description.fabric = read_fabric(*fabric);
  if (const auto attachments = json.find("attachments"))
    for (const JsonValue& item : attachments->items()) description.attachments.push_back(read_attachment(item));
  if (const auto colour = json.find("colour")) {
    const std::vector<double> rgb = colour->numbers(3);
    for (int c = 0; c < 3; ++c) {
      if (!(rgb[c] >= 0.0 && rgb[c] <= 1.0)) throw colour->error("red, green, blue from 0 to 1");
      description.colour[c] = static_cast<float>(rgb[c]);
    }
  }
  return description;
}

} // namespace tutu::cloth
