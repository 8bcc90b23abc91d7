#include "src/view/show/scene_view.h"

#include "src/view/render/error_colours.h"
#include "src/view/show/overlay_body.h"
#include "src/view/show/overlay_cloth.h"
#include "src/view/show/overlay_colours.h"

#include <fmt/format.h>

namespace tutu::app {
namespace {

/// `colours`: one a vertex in the place of the parts' own, or none.
void add_body(const rig::Mesh& mesh, const SkinView& skin, FrameView& view, bool wireframe,
              std::span<const Colour> colours) {
  for (const rig::MeshPart& part : mesh.parts) {
    SurfaceView surface;
    surface.positions = skin.positions;
    surface.normals = skin.normals;
    surface.triangles = std::span(mesh.triangles).subspan(part.first_triangle, part.triangle_count);
    surface.colour = part.colour;
    surface.colours = colours;
    surface.wireframe = wireframe;
    view.surfaces.push_back(surface);
  }
}

/// Unit; +Y where there is no area.
void area_weighted_normals(const std::vector<Vec3f>& positions, std::span<const rig::Triangle> triangles,
                           std::vector<Vec3f>& normals) {
  normals.assign(positions.size(), Vec3f::Zero());
  for (const rig::Triangle& t : triangles) {
    const Vec3f normal = (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]);
    for (const std::uint32_t corner : t) normals[corner] += normal;
  }
  for (Vec3f& normal : normals) {
    const float length = normal.norm();
    normal = length > 0.0f ? Vec3f(normal / length) : Vec3f::UnitY();
  }
}

} // namespace

SceneView::SceneView(const Scene& scene) : scene_(&scene) {
  constexpr int k_refinement = 3; // cells a cell each way: a skirt of 30 x 30 looks woven, not folded from paper
  for (const cloth::Garment& garment : scene.garments) {
    Sheet& sheet = cloth_.emplace_back();
    if (garment.rows == 0) continue; // flipped: a garment's rows run down, its front is outside
    const GridShape shape{garment.rows, garment.columns, garment.woven_shut};
    sheet.grid.emplace(shape, k_refinement, true);
    sheet.colour_grid.emplace(shape, k_refinement, true);
  }
}

void SceneView::colour_by_depth(const FrameState& state, const SkinView& skin) {
  const rig::Mesh& mesh = scene_->character.mesh;
  if (!body_ && sideless_.empty()) {
    try {
      body_.emplace(mesh.positions, mesh.triangles);
    } catch (const std::invalid_argument& unusable) {
      sideless_ = unusable.what();
    }
  }
  for (Sheet& sheet : cloth_) sheet.values.clear();
  if (!body_) return;
  body_->pose(skin.positions);
  for (std::size_t g = 0; g < cloth_.size(); ++g) {
    for (const Vec3& p : state.garments[g].positions) {
      const Colour colour = error_colour(k_depth_scale, std::max(0.0, -body_->signed_distance(p).distance));
      cloth_[g].values.emplace_back(colour[0], colour[1], colour[2]);
    }
  }
}

void SceneView::colour_by_distance(const FrameState& state, const FrameState& other) {
  for (std::size_t g = 0; g < cloth_.size(); ++g) {
    cloth_[g].values.clear();
    const std::vector<Vec3>& positions = state.garments[g].positions;
    if (g >= other.garments.size() || other.garments[g].positions.size() != positions.size()) continue;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Colour c = error_colour(k_apart_scale, (positions[i] - other.garments[g].positions[i]).norm());
      cloth_[g].values.emplace_back(c[0], c[1], c[2]);
    }
  }
}

void SceneView::add_sheet(std::size_t g, const FrameState& state, const Layers& layers, FrameView& view) {
  const cloth::Garment& garment = scene_->garments[g];
  Sheet& sheet = cloth_[g];
  sheet.particles.clear();
  for (const Vec3& p : state.garments[g].positions) sheet.particles.push_back(p.cast<float>());
  SurfaceView surface;
  if (sheet.grid) {
    sheet.grid->update(sheet.particles);
    surface.positions = sheet.grid->positions();
    surface.normals = sheet.grid->normals();
    surface.triangles = sheet.grid->triangles();
  } else {
    area_weighted_normals(sheet.particles, garment.triangles, sheet.normals);
    surface.positions = sheet.particles;
    surface.normals = sheet.normals;
    surface.triangles = garment.triangles;
  }
  if (!sheet.values.empty()) {
    std::span<const Vec3f> values = sheet.values;
    if (sheet.colour_grid) { // colours go between particles as places do
      sheet.colour_grid->update(values);
      values = sheet.colour_grid->positions();
    }
    sheet.colours.clear();
    for (const Vec3f& v : values) {
      const Vec3f c = v.cwiseMax(0.0f).cwiseMin(1.0f);
      sheet.colours.push_back({c.x(), c.y(), c.z()});
    }
    surface.colours = sheet.colours;
  }
  surface.colour = garment.colour;
  surface.wireframe = layers.wireframe;
  surface.two_sided = true;
  surface.offset = static_cast<float>(0.5 * garment.fabric.thickness);
  surface.sheen = 0.3f;
  view.surfaces.push_back(surface);
}

FrameView SceneView::frame(const FrameState& state, const SkinView& skin, const Layers& layers,
                           const FrameState* other) {
  FrameView view;
  view.ground = layers.ground && scene_->ground_height.has_value();
  view.ground_height = static_cast<float>(scene_->ground_height.value_or(0.0));
  const proxies::SweptColliders colliders = state.swept();
  std::span<const Colour> errors;
  if (layers.proxy_error && colliders.size() > 0) {
    errors = error_colours_.update(skin.positions, colliders.end, error_scale_);
    view.error_scale = error_scale_;
  }
  if (layers.body) add_body(scene_->character.mesh, skin, view, layers.wireframe, errors);
  if (layers.penetration) colour_by_depth(state, skin);
  else if (other) colour_by_distance(state, *other);
  else
    for (Sheet& sheet : cloth_) sheet.values.clear();
  view.legend = legend_of(layers);
  if (other && !layers.penetration)
    for (const double mm : {1.0, 10.0, 50.0}) {
      LegendEntry& entry = view.legend.emplace_back();
      entry.text = fmt::format("{:g} mm apart", mm);
      entry.colour = error_colour(k_apart_scale, 0.001 * mm);
    }
  if (layers.penetration && !sideless_.empty()) view.legend.push_back({"no depths: " + sideless_, k_grey});
  for (std::size_t g = 0; g < cloth_.size(); ++g) {
    const cloth::Garment& garment = scene_->garments[g];
    const std::vector<Vec3>& particles = state.garments[g].positions;
    if (layers.cloth) add_sheet(g, state, layers, view);
    if (layers.particles)
      for (const Vec3& p : particles) view.points.push_back(p.cast<float>());
    if (layers.strain) add_strain(garment, particles, view.threads);
    if (layers.attachments) add_attachments(garment, particles, view.marks, view.lines);
    if (layers.tiles) add_broad_phase(state.broad[g], particles, colliders, view.lines);
    if (layers.contacts) {
      touches_.clear();
      find_touches(garment, particles, state.swept(g), touches_);
      add_touches(touches_, garment.fabric.contact_offset(), view.lines);
    }
  }
  if (layers.proxies) add_proxies(state, view.capsules);
  if (layers.boxes) add_swept_boxes(colliders, view.lines);
  if (layers.sweeps) add_sweeps(colliders, view.capsules, view.lines);
  if (layers.skeleton) add_skeleton(scene_->character.skeleton, state.joints, view.lines);
  if (layers.joints) add_joint_frames(state.joints, view.lines);
  return view;
}

FrameView SceneView::frame(const Session& session, const Layers& layers, const FrameState* other) {
  capture(session, captured_);
  return frame(captured_, {session.body_positions(), session.body_normals()}, layers, other);
}

std::vector<LegendEntry> legend_of(const Layers& layers) {
  std::vector<LegendEntry> legend;
  const auto add = [&](bool shown, std::string_view text, const Colour& colour) {
    if (!shown) return;
    LegendEntry& entry = legend.emplace_back();
    entry.text = text;
    entry.colour = colour;
  };
  add(layers.skeleton, "bones", k_vermilion);
  add(layers.joints, "joint's x", k_vermilion);
  add(layers.joints, "joint's y", k_green);
  add(layers.joints, "joint's z", k_blue);
  add(layers.proxies, "spheres", k_sky);
  add(layers.proxies, "capsules", k_orange);
  add(layers.boxes, "swept boxes of the proxies", k_blue);
  add(layers.sweeps, "proxies on their way in the frame", k_purple);
  for (const double percent : {10.0, 5.0, 0.0, -5.0, -10.0})
    add(layers.strain, percent == 0.0 ? "as at rest" : fmt::format("{:+g} % long", percent),
        strain_colour(0.01 * percent));
  add(layers.attachments, "pinned", k_orange);
  add(layers.attachments, "sewn", k_purple);
  add(layers.tiles, "tiles with a candidate", k_black);
  add(layers.tiles, "tiles without", k_grey);
  add(layers.tiles, "tile to its candidate", k_sky);
  add(layers.contacts, "touches: at the gap", k_green);
  add(layers.contacts, "nearer: longer by 10 x the depth", k_orange);
  add(layers.contacts, "inside the proxy", k_vermilion);
  for (const double mm : {0.0, 1.0, 4.0, 10.0})
    add(layers.penetration, fmt::format("{:g} mm in the body", mm), error_colour(k_depth_scale, 0.001 * mm));
  return legend;
}

std::vector<Vec3f> motion_points(const Scene& scene) {
  constexpr int k_samples = 64;    // poses; dense enough for a frame around them
  constexpr double k_flesh = 0.12; // m around joints: a head, a hand, a skirt's flare
  const rig::Skeleton& skeleton = scene.character.skeleton;
  std::vector<Transform> local(skeleton.rest_local.size()), model(local.size());
  std::vector<Vec3f> points;
  for (int s = 0; s < k_samples; ++s) {
    rig::pose_at(scene.motion, skeleton, scene.motion.duration() * s / k_samples, local, model);
    for (const Transform& joint : model)
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-k_flesh, k_flesh})
          points.push_back((joint.translation + side * Vec3::Unit(axis)).cast<float>());
  }
  return points;
}

} // namespace tutu::app
