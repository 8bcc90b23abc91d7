#include "src/scene/scene_view.h"

namespace tutu::app {
namespace {

// Colour-blind safe (Okabe and Ito 2008), in linear RGB.
constexpr Colour k_orange = {0.791f, 0.347f, 0.0f};
constexpr Colour k_sky = {0.093f, 0.457f, 0.815f};
constexpr Colour k_vermilion = {0.665f, 0.112f, 0.0f};

/// `colours`: one a vertex in the place of the parts' own, or none.
void add_body(const Session& session, FrameView& view, bool wireframe, std::span<const Colour> colours) {
  const rig::Mesh& mesh = session.scene().character.mesh;
  for (const rig::MeshPart& part : mesh.parts) {
    SurfaceView surface;
    surface.positions = session.body_positions();
    surface.normals = session.body_normals();
    surface.triangles = std::span(mesh.triangles).subspan(part.first_triangle, part.triangle_count);
    surface.colour = part.colour;
    surface.colours = colours;
    surface.wireframe = wireframe;
    view.surfaces.push_back(surface);
  }
}

void add_skeleton(const Session& session, FrameView& view) {
  const rig::Skeleton& skeleton = session.scene().character.skeleton;
  const auto joints = session.world_from_joint();
  for (int j = 0; j < skeleton.joint_count(); ++j)
    if (const int parent = skeleton.parents[j]; parent != rig::k_no_parent)
      view.lines.push_back(
          {joints[parent].translation.cast<float>(), joints[j].translation.cast<float>(), k_vermilion});
}

void add_proxies(const Session& session, FrameView& view) {
  const proxies::ColliderSet& colliders = session.colliders();
  const auto posed = colliders.swept().end;
  for (std::size_t c = 0; c < posed.size(); ++c) {
    const bool sphere = colliders.proxies()[c].kind == proxies::ProxyKind::sphere;
    view.capsules.push_back({posed[c].a.cast<float>(), posed[c].b.cast<float>(),
                             static_cast<float>(posed[c].radius_at(0.0)), static_cast<float>(posed[c].radius_at(1.0)),
                             sphere ? k_sky : k_orange});
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

SceneView::SceneView(const Scene& scene) {
  constexpr int k_refinement = 3; // cells a cell each way: a skirt of 30 x 30 looks woven, not folded from paper
  for (const cloth::Garment& garment : scene.garments) {
    Sheet& sheet = cloth_.emplace_back();
    if (garment.rows > 0) // flipped: a garment's rows run down, its front is outside
      sheet.grid.emplace(GridShape{garment.rows, garment.columns, garment.woven_shut}, k_refinement, true);
  }
}

FrameView SceneView::frame(const Session& session, const Layers& layers) {
  FrameView view;
  view.ground = layers.ground && session.scene().description.ground_height.has_value();
  view.ground_height = static_cast<float>(session.scene().description.ground_height.value_or(0.0));
  std::span<const Colour> errors;
  if (const auto colliders = session.colliders().swept().end; layers.proxy_error && !colliders.empty()) {
    errors = error_colours_.update(session.body_positions(), colliders, error_scale_);
    view.error_scale = error_scale_;
  }
  if (layers.body) add_body(session, view, layers.wireframe, errors);
  for (std::size_t g = 0; g < cloth_.size(); ++g) {
    const cloth::Garment& garment = session.scene().garments[g];
    const std::vector<Vec3>& particles = session.garment(static_cast<int>(g)).particles().positions;
    if (layers.cloth) {
      Sheet& sheet = cloth_[g];
      sheet.particles.clear();
      for (const Vec3& p : particles) sheet.particles.push_back(p.cast<float>());
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
      surface.colour = garment.colour;
      surface.wireframe = layers.wireframe;
      surface.two_sided = true;
      surface.offset = static_cast<float>(0.5 * garment.fabric.thickness);
      surface.sheen = 0.3f;
      view.surfaces.push_back(surface);
    }
    if (layers.particles)
      for (const Vec3& p : particles) view.points.push_back(p.cast<float>());
  }
  if (layers.proxies) add_proxies(session, view);
  if (layers.skeleton) add_skeleton(session, view);
  return view;
}

std::vector<Vec3f> motion_points(const Scene& scene) {
  constexpr int k_samples = 64;    // poses; dense enough for a frame around them
  constexpr double k_flesh = 0.12; // m around joints: a head, a hand, a skirt's flare
  const rig::Skeleton& skeleton = scene.character.skeleton;
  std::vector<Transform> local(skeleton.rest_local.size()), model(local.size());
  std::vector<Vec3f> points;
  for (int s = 0; s < k_samples; ++s) {
    rig::sample(scene.clip, scene.clip.times.front() + scene.clip.duration() * s / k_samples, local);
    rig::model_from_local(skeleton, local, model);
    for (const Transform& joint : model)
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-k_flesh, k_flesh})
          points.push_back((joint.translation + side * Vec3::Unit(axis)).cast<float>());
  }
  return points;
}

} // namespace tutu::app
