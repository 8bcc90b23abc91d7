#include "src/view/proxy_edit/proxy_editor.h"

#include "proxies/proxy_file.h"
#include "src/view/proxy_edit/fit_one.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

namespace tutu::app {
namespace {

using proxies::Capsule;
using proxies::Proxy;
using proxies::ProxyKind;

constexpr double k_reach = 12.0;         // px of a common display, around the pointer
constexpr double k_new_radius = 0.05;    // m
constexpr double k_new_length = 0.1;     // m, of a capsule on a joint without a child
constexpr double k_shortest_bone = 1e-3; // m: a child nearer than that gives no direction

constexpr std::array<ProxyCommandEntry, 10> k_table = {{
    {ProxyCommand::undo, "undo", "Ctrl+Z"},
    {ProxyCommand::redo, "redo", "Ctrl+Y"},
    {ProxyCommand::add_sphere, "add a sphere on the joint", "Ctrl+B"},
    {ProxyCommand::add_capsule, "add a capsule on the joint", "Ctrl+K"},
    {ProxyCommand::remove, "delete", "Delete"},
    {ProxyCommand::fit_one, "fit this one", "Ctrl+F"},
    {ProxyCommand::one_radius, "one radius for both ends", "Ctrl+E"},
    {ProxyCommand::save, "save", "Ctrl+S"},
    {ProxyCommand::save_as, "save as", "Ctrl+Shift+S"},
    {ProxyCommand::restart, "restart with these proxies", "Ctrl+R"},
}};

proxies::Anchor on_joint(int joint, const Vec3& point) {
  proxies::Anchor anchor;
  anchor.count = 1;
  anchor.joints[0] = joint;
  anchor.weights[0] = 1.0;
  anchor.points[0] = point;
  return anchor;
}

} // namespace

std::span<const ProxyCommandEntry> proxy_command_table() { return k_table; }

ProxyEditor::ProxyEditor(const rig::Character& character, std::vector<Proxy> proxies, std::filesystem::path file)
    : character_(&character), rest_(rig::rest_model(character.skeleton)), world_from_joint_(rest_),
      positions_(character.mesh.positions), file_(std::move(file)), document_(std::move(proxies)) {}

void ProxyEditor::set_pose(std::span<const Transform> world_from_joint, std::span<const Vec3f> positions) {
  hold_.reset();
  document_.drop();
  world_from_joint_.assign(world_from_joint.begin(), world_from_joint.end());
  positions_.assign(positions.begin(), positions.end());
  if (measure_) measure_->pose(positions_);
  figures_.reset();
}

void ProxyEditor::set_picture(const Picture& picture, float pixel_scale) {
  picture_ = picture;
  pixel_scale_ = pixel_scale;
}

Vec3 ProxyEditor::view_direction() const {
  return (picture_.camera.target.cast<double>() - picture_.camera.eye.cast<double>()).normalized();
}

bool ProxyEditor::press(double x, double y) {
  if (question_ != ProxyQuestion::none || !selected()) return false;
  const std::vector<Handle> all = handles();
  const auto handle = nearest_handle(picture_, all, x, y, k_reach * static_cast<double>(pixel_scale_));
  if (!handle) return false;
  hold_ = Hold{handle->kind, ProxyDrag(*selected(), *handle, pose(), ray_through(picture_, x, y), view_direction())};
  message_.clear();
  return true;
}

void ProxyEditor::point(double x, double y, bool shift) {
  if (!hold_) return;
  ProxyEditState next = state();
  next.proxies[*next.selected] = hold_->drag.at(ray_through(picture_, x, y), shift);
  document_.show(std::move(next));
  figures_.reset();
}

void ProxyEditor::release() {
  if (!hold_) return;
  hold_.reset();
  document_.keep();
  figures_.reset();
}

void ProxyEditor::click(double x, double y) {
  if (question_ != ProxyQuestion::none) return;
  document_.select(proxy_under(ray_through(picture_, x, y), shapes()));
  if (selected()) joint_ = selected()->a.joints[0];
  figures_.reset();
}

const Proxy* ProxyEditor::selected() const { return state().selected ? &state().proxies[*state().selected] : nullptr; }

std::vector<Capsule> ProxyEditor::shapes() const {
  std::vector<Capsule> shapes;
  for (const Proxy& proxy : state().proxies) shapes.push_back(posed(proxy, world_from_joint_));
  return shapes;
}

std::vector<Capsule> ProxyEditor::enabled_shapes() const {
  std::vector<Capsule> shapes;
  for (const Proxy& proxy : state().proxies)
    if (proxy.enabled) shapes.push_back(posed(proxy, world_from_joint_));
  return shapes;
}

std::optional<int> ProxyEditor::enabled_index() const {
  if (!selected() || !selected()->enabled) return std::nullopt;
  const auto first = state().proxies.begin();
  return static_cast<int>(
      std::count_if(first, first + *state().selected, [](const Proxy& proxy) { return proxy.enabled; }));
}

std::vector<Handle> ProxyEditor::handles() const {
  return selected() ? handles_of(*selected(), pose(), view_direction()) : std::vector<Handle>{};
}

std::optional<HandleKind> ProxyEditor::held() const { return hold_ ? std::optional(hold_->kind) : std::nullopt; }

const ProxyMeasure& ProxyEditor::measure() {
  if (!measure_) {
    measure_.emplace(character_->mesh);
    measure_->pose(positions_);
  }
  return *measure_;
}

const ProxyMeasure::Result& ProxyEditor::figures() {
  if (!figures_) figures_ = measure().measure(enabled_shapes(), enabled_index().value_or(-1));
  return *figures_;
}

void ProxyEditor::change(std::vector<Proxy> proxies, std::optional<int> selected) {
  document_.change({std::move(proxies), selected});
  figures_.reset();
}

bool ProxyEditor::can_run(ProxyCommand command) const {
  switch (command) {
  case ProxyCommand::undo: return document_.undo_depth() > 0;
  case ProxyCommand::redo: return document_.redo_depth() > 0;
  case ProxyCommand::remove: return selected() != nullptr;
  case ProxyCommand::fit_one: return enabled_index().has_value();
  case ProxyCommand::one_radius: return selected() && selected()->taper != 0.0;
  default: return true;
  }
}

void ProxyEditor::run(ProxyCommand command) {
  if (question_ != ProxyQuestion::none || hold_ || !can_run(command)) return;
  message_.clear();
  figures_.reset();
  std::vector<Proxy> next = state().proxies;
  switch (command) {
  case ProxyCommand::undo: document_.undo(); break;
  case ProxyCommand::redo: document_.redo(); break;
  case ProxyCommand::add_sphere: add(ProxyKind::sphere); break;
  case ProxyCommand::add_capsule: add(ProxyKind::capsule); break;
  case ProxyCommand::remove:
    next.erase(next.begin() + *state().selected);
    change(std::move(next), std::nullopt);
    break;
  case ProxyCommand::fit_one: fit(); break;
  case ProxyCommand::one_radius:
    next[*state().selected].radius += 0.5 * selected()->taper;
    next[*state().selected].taper = 0.0;
    change(std::move(next), state().selected);
    break;
  case ProxyCommand::save:
    if (file_.empty()) question_ = ProxyQuestion::save_as;
    else save_to(file_);
    break;
  case ProxyCommand::save_as: question_ = ProxyQuestion::save_as; break;
  case ProxyCommand::restart: restart_ = true; break;
  }
}

std::string ProxyEditor::free_name() const {
  const std::string joint(rig::bare_joint_name(skeleton().names[joint_]));
  for (int k = 1;; ++k) {
    const std::string name = fmt::format("{} {}", joint, k);
    if (std::none_of(state().proxies.begin(), state().proxies.end(), [&](const Proxy& p) { return p.name == name; }))
      return name;
  }
}

void ProxyEditor::add(ProxyKind kind) {
  Proxy proxy;
  proxy.name = free_name();
  proxy.kind = kind;
  proxy.radius = k_new_radius;
  proxy.a = proxy.b = on_joint(joint_, Vec3::Zero());
  if (kind == ProxyKind::capsule) { // along the bone
    Vec3 end = k_new_length * Vec3::UnitY();
    for (int j = skeleton().joint_count() - 1; j >= 0; --j)
      if (const Vec3& child = skeleton().rest_local[j].translation;
          skeleton().parents[j] == joint_ && child.norm() > k_shortest_bone)
        end = child;
    proxy.b = on_joint(joint_, end);
  }
  std::vector<Proxy> next = state().proxies;
  next.push_back(proxy);
  const int added = static_cast<int>(next.size()) - 1;
  change(std::move(next), added);
}

void ProxyEditor::fit() {
  const Proxy& proxy = *selected();
  const double before = figures().whole.rms;
  const std::vector<Capsule> shapes = enabled_shapes();
  const Capsule fitted = fit_one(measure().spots(), shapes, *enabled_index(), proxy.kind == ProxyKind::sphere);
  const auto placed = proxy_at(proxy, fitted, pose());
  if (!placed) {
    message_ = "not fitted: in this pose its joints are turned too far apart to move it";
    return;
  }
  std::vector<Proxy> next = state().proxies;
  next[*state().selected] = *placed;
  if (same_proxies(next, state().proxies)) {
    message_ = "fitted already: no small change brings it nearer to the skin";
    return;
  }
  change(std::move(next), state().selected);
  message_ =
      fmt::format("fitted: rms of all skin {:.3f} mm, before {:.3f} mm", 1e3 * figures().whole.rms, 1e3 * before);
}

bool ProxyEditor::save_to(const std::filesystem::path& file) {
  try {
    proxies::write_proxies(file, state().proxies, skeleton());
  } catch (const std::exception& error) {
    message_ = error.what();
    return false;
  }
  file_ = file;
  document_.mark_written();
  message_ = "saved " + file.string();
  return true;
}

bool ProxyEditor::ask_to_leave() {
  release();
  if (!document_.dirty()) return leaving_ = true;
  question_ = ProxyQuestion::leave_unsaved;
  return false;
}

void ProxyEditor::answer_leave(bool save) {
  question_ = ProxyQuestion::none;
  if (!save) leaving_ = true;
  else if (!file_.empty()) leaving_ = save_to(file_);
  else {
    question_ = ProxyQuestion::save_as;
    leave_after_ = true;
  }
}

void ProxyEditor::answer_save_as(const std::string& file) {
  if (file.empty() || !save_to(file)) return; // the question stays, with the message
  question_ = ProxyQuestion::none;
  leaving_ = leave_after_;
  leave_after_ = false;
}

void ProxyEditor::cancel_question() {
  question_ = ProxyQuestion::none;
  leave_after_ = false;
}

bool ProxyEditor::take_restart() { return std::exchange(restart_, false); }

nlohmann::ordered_json ProxyEditor::json() const {
  nlohmann::ordered_json json;
  json["file"] = file_.string();
  json["proxies"] = state().proxies.size();
  json["selected"] = selected() ? nlohmann::ordered_json(selected()->name) : nullptr;
  json["undo_depth"] = document_.undo_depth();
  json["redo_depth"] = document_.redo_depth();
  json["unsaved"] = document_.dirty();
  json["message"] = message_;
  return json;
}

} // namespace tutu::app
