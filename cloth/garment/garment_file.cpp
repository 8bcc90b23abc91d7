#include "cloth/garment/garment_file.h"

#include "cloth/state/particles.h"
#include "cloth/state/tolerances.h"
#include "rig/import/surface.h"
#include "rig/io/json_file.h"
#include "rig/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
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
  if (const auto pressed = json.find("pressed"))
    throw pressed->error("pressed in a tube, whose threads are straight at rest", "it in a mesh, or not at all");
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

DiscShape read_disc(const JsonValue& json) {
  json.only_keys({"centre", "radius", "rings", "hole"});
  DiscShape disc;
  disc.centre = json.at("centre").vec3();
  disc.radius_x = disc.radius_z = json.at("radius").positive();
  disc.rings = json.at("rings").integer_in(1, 1024);
  if (const auto hole = json.find("hole")) {
    disc.hole = hole->non_negative() / disc.radius_x;
    if (!(disc.hole < 1.0)) throw hole->error("a radius below that of the disc");
  }
  return disc;
}

namespace fs = std::filesystem;

/// The file that a mesh names.
fs::path mesh_file(const JsonValue& name) {
  const fs::path file = (fs::path(name.file()).parent_path() / name.string()).lexically_normal();
  std::error_code error;
  if (!fs::is_regular_file(file, error))
    throw name.error("no file " + file.string(), "the path of a mesh, from the garment's folder");
  return file;
}

MeshShape read_mesh(const JsonValue& json) {
  json.only_keys({"file", "scale", "pressed"});
  const JsonValue name = json.at("file");
  const fs::path file = mesh_file(name);
  rig::TriangleSurface surface = rig::import_surface(file);
  MeshShape mesh{std::move(surface.positions), std::move(surface.triangles)};
  const auto scale = json.find("scale");
  const double metres = scale ? scale->positive() : 1.0;
  for (Vec3& p : mesh.positions) {
    p *= metres;
    if (!is_in_world(p))
      throw name.error(fmt::format("the point {:g} {:g} {:g} m in {}", p.x(), p.y(), p.z(), file.string()),
                       fmt::format("points within {:g} m of the origin", k_world_radius));
  }
  if (const auto pressed = json.find("pressed")) mesh.pressed = pressed->boolean();
  return mesh;
}

std::variant<GridShape, TubeShape, DiscShape, MeshShape> read_shape(const JsonValue& json) {
  json.only_keys({"grid", "tube", "disc", "mesh"});
  const auto grid = json.find("grid"), tube = json.find("tube"), disc = json.find("disc"), mesh = json.find("mesh");
  const int given = int{grid.has_value()} + int{tube.has_value()} + int{disc.has_value()} + int{mesh.has_value()};
  if (given != 1) throw json.error(given == 0 ? "none" : "several", "exactly one of: grid, tube, disc, mesh");
  if (grid) return read_grid(*grid);
  if (tube) return read_tube(*tube);
  if (disc) return read_disc(*disc);
  return read_mesh(*mesh);
}

/// The file of the fabric that `json` names.
fs::path fabric_file(const JsonValue& json) {
  const std::string name = json.string();
  const fs::path folder = fs::path(json.file()).parent_path();
  const bool is_path = fs::path(name).extension() == ".json";
  const fs::path shelf = (folder / "../fabrics").lexically_normal();
  if (!is_path && (name.empty() || name != fs::path(name).filename()))
    throw json.error("the name of a fabric, or a path that ends in .json");
  const fs::path file = is_path ? (folder / name).lexically_normal() : shelf / (name + ".json");
  std::error_code error;
  if (fs::is_regular_file(file, error)) return file;
  if (is_path) throw json.error("no file " + file.string(), "the path of a fabric, from the garment's folder");
  std::vector<std::string> known;
  for (const fs::directory_entry& entry : fs::directory_iterator(shelf, error))
    if (entry.path().extension() == ".json") known.push_back(entry.path().stem().string());
  std::sort(known.begin(), known.end());
  if (known.empty())
    throw json.error('"' + name + "\", and no fabrics in " + shelf.string(), "a fabric of that folder");
  throw json.error('"' + name + '"', fmt::format("one of: {}", fmt::join(known, ", ")));
}

/// true: the defaults; false: none.
std::optional<Air> read_air(const JsonValue& json) {
  if (json.is_boolean()) return json.boolean() ? std::optional(Air{}) : std::nullopt;
  if (!json.is_object()) throw json.error("true, false, or an object with pressure, lift and friction");
  json.only_keys({"pressure", "lift", "friction"});
  constexpr double k_most = 100.0; // fifty times any plate's
  Air air;
  if (const auto v = json.find("pressure")) air.pressure = v->number_in(0.0, k_most);
  if (const auto v = json.find("lift")) air.lift = v->number_in(0.0, k_most);
  if (const auto v = json.find("friction")) air.friction = v->number_in(0.0, k_most);
  return air;
}

/// A fabric as files make it up, one over the other.
struct ReadFabric {
  Fabric fabric;
  bool states_drag = false;

  /// Where there is air, drag is only what a file says.
  Fabric whole() const {
    Fabric result = fabric;
    if (fabric.air && !states_drag) result.drag = 0.0;
    return result;
  }
};

/// `read` with what `json` says otherwise.
ReadFabric with_keys_of(const JsonValue& json, ReadFabric read) {
  Fabric& fabric = read.fabric;
  if (const auto v = json.find("density")) fabric.density = v->positive();
  if (const auto v = json.find("stretch")) fabric.stretch = v->positive();
  if (const auto v = json.find("shear")) fabric.shear = v->non_negative();
  if (const auto v = json.find("bend")) fabric.bend = v->non_negative();
  if (const auto v = json.find("bend_springs")) fabric.bend_springs = v->non_negative();
  if (const auto v = json.find("damping")) fabric.damping = v->non_negative();
  if (const auto v = json.find("drag")) {
    fabric.drag = v->non_negative();
    read.states_drag = true;
  }
  if (const auto v = json.find("air")) fabric.air = read_air(*v);
  if (const auto v = json.find("thickness")) fabric.thickness = v->non_negative();
  if (const auto v = json.find("clearance")) fabric.clearance = v->non_negative();
  return read;
}

ReadFabric read_fabric_file(const fs::path& file) {
  const JsonValue json = JsonValue::read(file);
  json.only_keys({"source", "density", "stretch", "shear", "bend", "bend_springs", "damping", "drag", "air",
                  "thickness", "clearance"});
  return with_keys_of(json, {});
}

Fabric fabric_of(const JsonValue& json) {
  if (json.is_string()) return read_fabric(fabric_file(json));
  if (!json.is_object()) throw json.error("the name of a fabric, a path that ends in .json, or an object");
  json.only_keys({"base", "density", "stretch", "shear", "bend", "bend_springs", "damping", "drag", "air", "thickness",
                  "clearance"});
  const auto base = json.find("base");
  return with_keys_of(json, base ? read_fabric_file(fabric_file(*base)) : ReadFabric{}).whole();
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
  json.only_keys({"joint", "skin", "rows", "columns", "within", "above"});
  Attachment attachment;
  if (const auto skin = json.find("skin")) attachment.skin = skin->boolean();
  if (attachment.skin == json.has("joint"))
    throw json.error(attachment.skin ? "both joint and skin" : "neither joint nor skin",
                     "one of: joint, \"skin\": true");
  if (!attachment.skin) attachment.joint = json.at("joint").string();
  if (const auto within = json.find("within")) {
    within->only_keys({"centre", "radius"});
    attachment.within = Attachment::Ball{within->at("centre").vec3(), within->at("radius").positive()};
  }
  if (const auto above = json.find("above")) attachment.above = above->number();
  if (attachment.by_place()) {
    for (const char* key : {"rows", "columns"})
      if (json.has(key)) throw json.at(key).error("either rows, or within and above");
    return attachment;
  }
  read_range(json.at("rows"), attachment.first_row, attachment.last_row);
  if (const auto columns = json.find("columns")) read_range(*columns, attachment.first_column, attachment.last_column);
  return attachment;
}

MetColliders read_met_colliders(const JsonValue& json) {
  MetColliders met;
  for (const auto& [key, which] :
       {std::pair("ignore", MetColliders::Which::all_but), {"only", MetColliders::Which::only}}) {
    const auto names = json.find(key);
    if (!names) continue;
    if (met.which != MetColliders::Which::all) throw names->error("either ignore or only");
    met.which = which;
    for (const JsonValue& name : names->items()) met.names.push_back(name.string());
  }
  return met;
}

} // namespace

Fabric read_fabric(const fs::path& file) { return read_fabric_file(file).whole(); }

GarmentDescription read_garment(const std::filesystem::path& file) {
  const JsonValue json = JsonValue::read(file);
  json.only_keys({"name", "shape", "fabric", "attachments", "ignore", "only", "colour"});
  GarmentDescription description;
  description.file = file.string();
  description.name = json.has("name") ? json.at("name").string() : plain_text(file.stem().string());
  description.shape = read_shape(json.at("shape"));
  if (const auto fabric = json.find("fabric")) description.fabric = fabric_of(*fabric);
  if (const auto attachments = json.find("attachments"))
    for (const JsonValue& item : attachments->items()) description.attachments.push_back(read_attachment(item));
  description.met = read_met_colliders(json);
  if (const auto colour = json.find("colour")) {
    const std::vector<double> rgb = colour->numbers(3);
    for (int c = 0; c < 3; ++c) {
      if (!(rgb[c] >= 0.0 && rgb[c] <= 1.0)) throw colour->error("red, green, blue from 0 to 1");
      description.colour[c] = static_cast<float>(rgb[c]);
    }
  }
  return description;
}

std::vector<fs::path> files_named_by_garment(const fs::path& file) {
  const JsonValue json = JsonValue::read(file);
  std::vector<fs::path> files;
  if (const auto mesh = json.at("shape").find("mesh")) files.push_back(mesh_file(mesh->at("file")));
  auto fabric = json.find("fabric");
  if (fabric && fabric->is_object()) fabric = fabric->find("base");
  if (fabric) files.push_back(fabric_file(*fabric));
  return files;
}

} // namespace tutu::cloth
