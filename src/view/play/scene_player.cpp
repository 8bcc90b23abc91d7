#include "src/view/play/scene_player.h"

#include "proxies/distance/signed_distance.h"
#include "src/measure/worst_frame.h"
#include "src/view/show/overlay_cloth.h"
#include "src/view/show/overlay_colours.h"

#include <cmath>
#include <fmt/format.h>

namespace tutu::app {
namespace {

constexpr int k_ahead = 16;    // frames that are simulated before they are asked for: a slow picture owes so many
constexpr int k_history = 240; // frames of the plot

} // namespace

ScenePlayer::ScenePlayer(const Scene& scene, GarmentPositions start, int frames)
    : scene_(&scene), frames_(frames),
      simulation_(std::make_unique<Simulation>(scene, std::move(start), k_recording_bytes)), view_(scene),
      palette_(scene.character.skin.slot_count()), body_positions_(scene.character.mesh.positions.size()),
      body_normals_(scene.character.mesh.positions.size()) {
  simulation_->wait_for(0);
  shown_ = simulation_->frame(0);
  go(0);
}

void ScenePlayer::restart(GarmentPositions start) {
  simulation_ = std::make_unique<Simulation>(*scene_, std::move(start), k_recording_bytes);
  picked_.reset();
  picked_edge_.reset();
  picked_proxy_.reset();
  forget_first_wrong();
  worst_time_.reset();
  skinned_ = -1;
  target_ = 0;
  simulation_->wait_for(0);
  shown_ = simulation_->frame(0);
  go(0);
}

SkinView ScenePlayer::shown_skin() {
  skin();
  return {body_positions_, body_normals_};
}

void ScenePlayer::update() {
  if (shown_->index == target_) return;
  const Simulation::Extent extent = simulation_->extent();
  if (extent.last < extent.first) return;
  if (extent.failed) target_ = std::min(target_, extent.last);
  target_ = std::max(target_, extent.first);
  if (auto frame = simulation_->frame(std::min(target_, extent.last))) shown_ = std::move(frame);
}

void ScenePlayer::show(int index) {
  if (auto frame = simulation_->frame(index)) shown_ = std::move(frame);
}

void ScenePlayer::go(int frames) {
  target_ = std::clamp(target_ + frames, 0, frames_);
  simulation_->run_until(std::min(target_ + k_ahead, frames_));
  update();
}

void ScenePlayer::rewind() {
  target_ = 0;
  if (simulation_->extent().has(0)) go(0);
  else jump();
}

void ScenePlayer::seek(double time) {
  target_ = std::clamp(static_cast<int>(std::lround(time / frame_seconds())), 0, frames_);
  const Simulation::Extent extent = simulation_->extent();
  if (!extent.has(target_) && target_ != extent.last + 1) jump();
  go(0);
}

void ScenePlayer::jump() {
  simulation_->jump(target_);
  forget_first_wrong();
}

bool ScenePlayer::at_end() const {
  const Simulation::Extent extent = simulation_->extent();
  return shown_->index >= frames_ || (extent.failed && shown_->index >= extent.last);
}

std::string ScenePlayer::recorded() const {
  const Simulation::Extent extent = simulation_->extent();
  if (extent.last < extent.first) return "";
  return fmt::format("recorded {} to {}, {} of {} MB", extent.first, extent.last, extent.bytes >> 20,
                     k_recording_bytes >> 20);
}

std::vector<StageTime> ScenePlayer::stage_times() const {
  const FrameTimes& t = shown_->times;
  return {{"pose", t.pose}, {"proxies", t.proxies}, {"broad", t.broad}, {"cloth", t.cloth}, {"contact", t.contact}};
}

std::vector<float> ScenePlayer::history() const {
  std::vector<float> ms;
  for (int index = shown_->index - k_history + 1; index <= shown_->index; ++index)
    if (const auto frame = simulation_->frame(index)) ms.push_back(static_cast<float>(frame->times.total()));
  return ms;
}

std::vector<Figures> ScenePlayer::figures() {
  Figures figures;
  figures.ms = shown_->times.total();
  figures.frame = shown_->index;
  figures.recoveries = shown_->recoveries;
  for (std::size_t g = 0; g < shown_->garments.size(); ++g) {
    const cloth::Garment& garment = scene_->garments[g];
    touches_.clear();
    find_touches(garment, shown_->garments[g].positions, shown_->swept(g), touches_);
    figures.particles += garment.particle_count();
    figures.contacts += static_cast<int>(touches_.size());
    figures.substeps = std::max(figures.substeps, shown_->substeps[g]);
    for (const Touch& touch : touches_) figures.deepest = std::max(figures.deepest, -touch.contact.distance);
  }
  figures.state_hash = state_hash(*shown_);
  return {figures};
}

std::optional<double> ScenePlayer::worst_time() {
  if (!worst_time_)
    if (const auto frame = worst_frame(*scene_, [](int, int) { return true; })) worst_time_ = *frame * frame_seconds();
  return worst_time_;
}

void ScenePlayer::skin() {
  if (skinned_ == shown_->index) return;
  rig::skinning_palette(scene_->character.skin, shown_->joints, palette_);
  rig::skin_vertices(scene_->character.mesh, scene_->character.skin, palette_, body_positions_, body_normals_);
  skinned_ = shown_->index;
}

std::vector<FrameView> ScenePlayer::views(const Layers& layers) {
  update();
  std::vector<FrameView> views;
  views.push_back(draw(layers));
  return views;
}

FrameView ScenePlayer::draw(const Layers& layers) {
  drawn_ = layers;
  if (layers.body || layers.proxy_error || layers.penetration) skin();
  FrameView view = view_.frame(*shown_, {body_positions_, body_normals_}, layers, other_ ? &*other_ : nullptr);
  if (picked_) add_picked(view);
  return view;
}

void ScenePlayer::add_picked(FrameView& view) {
  const cloth::Garment& garment = scene_->garments[picked_->garment];
  const std::vector<Vec3>& positions = shown_->garments[picked_->garment].positions;
  for (std::size_t k = 0; k < garment.springs.size(); ++k) {
    const cloth::Spring& spring = garment.springs[k];
    const bool of_particle = spring.i == picked_->particle || spring.j == picked_->particle;
    if (picked_edge_ ? static_cast<int>(k) != *picked_edge_ : !of_particle) continue;
    const Vec3 &a = positions[spring.i], &b = positions[spring.j];
    view.lines.push_back(
        {a.cast<float>(), b.cast<float>(), strain_colour((b - a).norm() / spring.rest_length - 1.0), {2, 2}});
  }
  if (!picked_edge_) view.marks.push_back({positions[picked_->particle].cast<float>(), k_yellow});
}

void ScenePlayer::pick(std::size_t garment, int particle) {
  picked_ = Picked{garment, particle};
  picked_edge_.reset();
  forget_first_wrong();
}

void ScenePlayer::pick_as(const ScenePlayer& other) {
  picked_.reset();
  picked_edge_.reset();
  picked_proxy_.reset();
  const auto& same = other.picked_;
  if (same && same->garment < scene_->garments.size() &&
      same->particle < scene_->garments[same->garment].particle_count())
    pick(same->garment, same->particle);
}

void ScenePlayer::forget_first_wrong() {
  first_wrong_.reset();
  looked_at_ = -1;
}

void ScenePlayer::pick(const Ray& ray) {
  picked_.reset();
  picked_edge_.reset();
  picked_proxy_.reset();
  forget_first_wrong();
  if (drawn_.cloth || drawn_.particles || drawn_.strain) pick_particle(ray);
  if (picked_) pick_edge(ray);
  if (!picked_ && drawn_.proxies) pick_proxy(ray);
}

void ScenePlayer::pick_particle(const Ray& ray) {
  float best = std::numeric_limits<float>::max();
  for (std::size_t g = 0; g < shown_->garments.size(); ++g) {
    const std::vector<Vec3>& positions = shown_->garments[g].positions;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3f way = positions[i].cast<float>() - ray.from;
      const float along = way.dot(ray.direction), aside = (way - along * ray.direction).norm();
      const float score = along + 3.0f * aside; // the nearest sheet, and of that the particle under the pointer
      if (along <= 0.0f || aside > ray.spread * along || score >= best) continue;
      best = score;
      picked_ = Picked{g, static_cast<int>(i)};
    }
  }
}

void ScenePlayer::pick_edge(const Ray& ray) {
  constexpr double k_margin = 0.25; // of the edge: nearer to an end it is that particle that is meant
  const Vec3 from = ray.from.cast<double>(), direction = ray.direction.cast<double>();
  const std::vector<Vec3>& positions = shown_->garments[picked_->garment].positions;
  const Vec3 way = positions[picked_->particle] - from;
  const double along = way.dot(direction);
  double nearest = 0.5 * (way - along * direction).norm();
  const std::vector<cloth::Spring>& springs = scene_->garments[picked_->garment].springs;
  for (std::size_t k = 0; k < springs.size(); ++k) {
    const cloth::Spring& spring = springs[k];
    if (spring.kind != cloth::SpringKind::structural) continue;
    const Passing pass = passing(from, direction, positions[spring.i], positions[spring.j]);
    // Of the sheet that the particle is on, not one behind it.
    if (pass.aside >= nearest || pass.at < k_margin || pass.at > 1.0 - k_margin ||
        std::abs(pass.along - along) > spring.rest_length)
      continue;
    nearest = pass.aside;
    picked_edge_ = static_cast<int>(k);
  }
}

void ScenePlayer::pick_proxy(const Ray& ray) {
  constexpr double k_farthest = 60.0, k_there = 1e-4; // m
  constexpr int k_most_steps = 500;
  double along = 0.0; // no surface is nearer than the distance: that far the ray is free
  for (int step = 0; step < k_most_steps && along < k_farthest; ++step) {
    const Vec3 point = ray.from.cast<double>() + along * ray.direction.cast<double>();
    double nearest = k_farthest;
    for (std::size_t c = 0; c < shown_->colliders_end.size(); ++c) {
      const double distance = proxies::signed_distance(point, shown_->colliders_end[c]).distance;
      if (distance < k_there) {
        picked_proxy_ = static_cast<int>(c);
        return;
      }
      nearest = std::min(nearest, distance);
    }
    along += nearest;
  }
}

std::optional<WhyProxy> ScenePlayer::why_proxy() const {
  if (!picked_proxy_) return std::nullopt;
  return explain_proxy(*scene_, *picked_proxy_, *shown_);
}

std::optional<WhyEdge> ScenePlayer::why_edge() const {
  if (!picked_ || !picked_edge_) return std::nullopt;
  return explain_edge(*scene_, picked_->garment, *picked_edge_, *shown_);
}

std::optional<Why> ScenePlayer::why_shown() {
  if (!picked_ || picked_edge_) return std::nullopt;
  const auto before = simulation_->frame(shown_->index - 1);
  Why why = explain(*scene_, picked_->garment, picked_->particle, *shown_, before.get());
  for (; looked_at_ < shown_->index && !first_wrong_; ++looked_at_)
    if (const auto frame = simulation_->frame(looked_at_ + 1))
      first_wrong_ = wrong_in(*scene_, picked_->garment, picked_->particle, *frame);
  if (first_wrong_ && first_wrong_->frame <= shown_->index) why.first_wrong = first_wrong_;
  return why;
}

std::vector<std::vector<std::string>> ScenePlayer::why() {
  if (const auto proxy = why_proxy()) return {text_of(*proxy)};
  if (const auto edge = why_edge()) return {text_of(*edge)};
  const std::optional<Why> why = why_shown();
  return {why ? text_of(*why) : std::vector<std::string>{}};
}

} // namespace tutu::app
