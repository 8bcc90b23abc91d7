#include "src/view/proxy_edit/proxy_edit_mode.h"

#include "src/scene/load.h"
#include "src/view/show/overlay_body.h"
#include "src/view/show/overlay_colours.h"

#include <cmath>

namespace tutu::app {
namespace {

constexpr Colour k_others = k_sky, k_chosen = k_orange, k_off = k_grey;

std::filesystem::path proxies_file(const LoadedScene& scene) {
  return scene.files.proxies.value_or(std::filesystem::path());
}

CapsuleView drawn(const proxies::Capsule& shape, const Colour& colour) {
  return {shape.a.cast<float>(), shape.b.cast<float>(), static_cast<float>(shape.radius_at(0.0)),
          static_cast<float>(shape.radius_at(1.0)), colour};
}

} // namespace

ProxyEditMode::ProxyEditMode(LoadedScene& scene, ScenePlayer& player, Start start, Drape drape)
    : scene_(&scene), player_(&player), start_(std::move(start)), drape_(std::move(drape)),
      editor_(scene.character, scene.proxies, proxies_file(scene)), played_(scene.proxies) {}

void ProxyEditMode::toggle() {
  if (on_) {
    editor_.release();
    holds_ = false;
    if (!same_proxies(played_, editor_.state().proxies)) restart();
  }
  on_ = !on_;
  frame_ = -1;
}

void ProxyEditMode::restart() {
  LoadedScene& scene = *scene_;
  player_->stop();
  scene.proxies = editor_.state().proxies;
  if (auto start = drape_(scene)) {
    played_ = scene.proxies;
    start_ = std::move(*start);
  } else {
    note_ = "the garments do not settle on these proxies; the simulation goes on with those before";
    scene.proxies = played_;
  }
  player_->restart(start_);
  frame_ = -1;
}

void ProxyEditMode::follow_pose() {
  if (frame_ == player_->shown().index) return;
  frame_ = player_->shown().index;
  editor_.set_pose(player_->shown().joints, player_->shown_skin().positions);
  holds_ = false;
}

Layers ProxyEditMode::layers(Layers chosen) const {
  chosen.cloth = chosen.cloth && cloth_;
  chosen.body = true;
  chosen.proxies = chosen.proxy_error = chosen.penetration = chosen.sweeps = false; // those are of the played proxies
  return chosen;
}

void ProxyEditMode::show(std::vector<FrameView>& views) {
  if (editor_.take_restart()) {
    note_ = "restarted with these proxies"; // unless it says otherwise
    if (same_proxies(played_, editor_.state().proxies)) player_->rewind();
    else restart();
  }
  follow_pose();
  FrameView& view = views.front();
  if (heat_) {
    const auto skin = player_->shown_skin().positions;
    const auto colours = colours_.update(skin, editor_.enabled_shapes(), scale_);
    view.error_scale = scale_;
    for (SurfaceView& surface : view.surfaces)
      if (surface.positions.data() == skin.data()) surface.colours = colours;
  }
  const std::vector<proxies::Capsule> shapes = editor_.shapes();
  const auto& state = editor_.state();
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const bool selected = state.selected == static_cast<int>(k);
    if (state.selected && !selected && !others_) continue;
    view.capsules.push_back(drawn(shapes[k], selected ? k_chosen : state.proxies[k].enabled ? k_others : k_off));
  }
}

void ProxyEditMode::set_picture(const Camera& camera, int width, int height, float pixel_scale) {
  pixel_scale_ = pixel_scale;
  editor_.set_picture({camera, width, height}, pixel_scale);
}

void ProxyEditMode::take(const InputEvent& event, bool panels_have, OrbitCamera& orbit) {
  using Kind = InputEvent::Kind;
  follow_pose();
  switch (event.kind) {
  case Kind::move:
    if (holds_) editor_.point(event.x, event.y, event.shift);
    else if (camera_button_) turn_camera(event, orbit);
    break;
  case Kind::press:
    if (panels_have || holds_ || camera_button_ || asks()) break;
    from_x_ = event.x;
    from_y_ = event.y;
    holds_ = event.button == PointerButton::left && editor_.press(event.x, event.y);
    if (!holds_) camera_button_ = event.button;
    break;
  case Kind::release: {
    constexpr double k_still = 4.0; // px: a hand that clicks
    if (holds_) {
      editor_.point(event.x, event.y, event.shift);
      editor_.release();
    } else if (camera_button_ == PointerButton::left &&
               std::hypot(event.x - from_x_, event.y - from_y_) < k_still * static_cast<double>(pixel_scale_)) {
      editor_.click(event.x, event.y);
    }
    holds_ = false;
    camera_button_.reset();
    break;
  }
  case Kind::wheel:
    if (!panels_have && !holds_) zoom(orbit, static_cast<float>(event.notches));
    break;
  case Kind::key:
    if (!panels_have || asks()) take_key(event.keys);
    break;
  case Kind::character: break; // layers and steps, as always
  }
  x_ = event.x;
  y_ = event.y;
}

void ProxyEditMode::turn_camera(const InputEvent& event, OrbitCamera& orbit) {
  const auto dx = static_cast<float>(event.x - x_), dy = static_cast<float>(event.y - y_);
  const bool turns = *camera_button_ == PointerButton::left && !event.shift;
  if (turns) rotate(orbit, dx, dy, editor_.picture().height);
  else pan(orbit, dx, dy, editor_.picture().height);
}

void ProxyEditMode::take_key(const std::string& keys) {
  if (editor_.question() == ProxyQuestion::leave_unsaved) {
    if (keys == "Enter") editor_.answer_leave(true);
    if (keys == "Escape") editor_.cancel_question();
    return;
  }
  if (asks()) {
    if (keys == "Escape") editor_.cancel_question();
    return;
  }
  note_.clear();
  if (keys == "Ctrl+Shift+Z") return editor_.run(ProxyCommand::redo);
  for (const ProxyCommandEntry& entry : proxy_command_table())
    if (keys == entry.keys) editor_.run(entry.command);
}

bool ProxyEditMode::may_close() {
  if (asks()) return false;
  if (editor_.document().dirty()) on_ = true; // the question is the mode's
  return editor_.ask_to_leave();
}

} // namespace tutu::app
