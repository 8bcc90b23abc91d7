#include "src/view/pose/pose_overlay.h"

#include "src/view/pose/pose_colours.h"

#include <imgui.h>
#include <numbers>

namespace tutu::app {
namespace {

constexpr int k_ring_segments = 64;

/// Draws points of the world.
class Pen {
public:
  explicit Pen(const Editor& editor)
      : picture_(editor.picture()), scale_(editor.pixel_scale()), draw_(*ImGui::GetBackgroundDrawList()) {
    // The display may count in other units than the picture's pixels.
    per_pixel_ = ImGui::GetIO().DisplaySize.x / static_cast<float>(picture_.width);
  }

  std::optional<ImVec2> place(const Vec3& point) const {
    const auto seen = project(picture_.camera, picture_.width, picture_.height, point.cast<float>());
    if (!seen) return std::nullopt;
    return ImVec2(seen->x() * per_pixel_, seen->y() * per_pixel_);
  }
  void line(const Vec3& a, const Vec3& b, ImU32 colour, float width) const {
    const auto from = place(a), to = place(b);
    if (from && to) draw_.AddLine(*from, *to, colour, width * px());
  }
  void dot(const Vec3& point, float radius, ImU32 fill) const {
    const auto at = place(point);
    if (!at) return;
    draw_.AddCircleFilled(*at, (radius + 1.2f) * px(), k_outline);
    draw_.AddCircleFilled(*at, radius * px(), fill);
  }
  void square(const Vec3& point, float half, ImU32 colour) const {
    const auto at = place(point);
    if (!at) return;
    const float h = half * px();
    draw_.AddRect({at->x - h, at->y - h}, {at->x + h, at->y + h}, colour, 0, 0, 2 * px());
  }
  void label(const Vec3& point, const std::string& text) const {
    const auto at = place(point);
    if (!at) return;
    const ImVec2 size = ImGui::CalcTextSize(text.c_str()), corner(at->x + 12 * px(), at->y - 0.5f * size.y);
    draw_.AddRectFilled({corner.x - 5 * px(), corner.y - 3 * px()},
                        {corner.x + size.x + 5 * px(), corner.y + size.y + 3 * px()}, k_label_back, 4 * px());
    draw_.AddText(corner, k_label_ink, text.c_str());
  }

private:
  float px() const { return scale_ * per_pixel_; }

  const Picture& picture_;
  float scale_, per_pixel_ = 1.0f;
  ImDrawList& draw_;
};

void draw_ghost(const Pen& pen, const rig::Skeleton& skeleton, const Pose& pose, ImU32 colour) {
  std::vector<Transform> model(pose.size());
  rig::model_from_local(skeleton, pose, model);
  for (int j = 0; j < skeleton.joint_count(); ++j)
    if (const int parent = skeleton.parents[j]; parent != rig::k_no_parent)
      pen.line(model[parent].translation, model[j].translation, colour, 2.0f);
}

/// The keys before and after the playhead.
void draw_onion_skin(const Pen& pen, const Editor& editor) {
  const EditState& state = editor.state();
  const EditKey *before = nullptr, *after = nullptr;
  for (const EditKey& key : state.keys) {
    if (key.time < state.time && key_at(state, state.time) != key_at(state, key.time)) before = &key;
    if (key.time > state.time && !after && key_at(state, state.time) != key_at(state, key.time)) after = &key;
  }
  if (before) draw_ghost(pen, editor.skeleton(), *before->pose, k_before);
  if (after) draw_ghost(pen, editor.skeleton(), *after->pose, k_after);
}

void draw_ring(const Pen& pen, const Editor& editor) {
  if (!editor.selected()) return;
  const auto ring = ring_of(editor.skeleton(), editor.state().pose, *editor.selected());
  if (!ring) return;
  const Vec3 eye = editor.picture().camera.eye.cast<double>();
  for (int i = 0; i < k_ring_segments; ++i) {
    const double step = 2.0 * std::numbers::pi / k_ring_segments;
    const Vec3 a = ring->at(i * step), b = ring->at((i + 1) * step);
    const bool far_side = (a - eye).norm() > (ring->centre - eye).norm();
    pen.line(a, b, far_side ? k_ring_far : k_ring, editor.ring_hovered() ? 4.0f : 2.0f);
  }
}

} // namespace

void draw_pose_overlay(const Editor& editor) {
  const Pen pen(editor);
  const rig::Skeleton& skeleton = editor.skeleton();
  if (editor.view().onion_skin) draw_onion_skin(pen, editor);
  if (!editor.view().joints) return;
  const std::vector<Transform> model = editor.model_from_joint();
  for (int j = 0; j < skeleton.joint_count(); ++j)
    if (const int parent = skeleton.parents[j]; parent != rig::k_no_parent)
      pen.line(model[parent].translation, model[j].translation, k_bone, 1.6f);
  draw_ring(pen, editor);
  const auto is_small = [&](int j) {
    return j > 0 && (model[j].translation - model[skeleton.parents[j]].translation).norm() < 0.05;
  };
  for (int j = 0; j < skeleton.joint_count(); ++j)
    pen.dot(model[j].translation, skeleton.parents[j] != rig::k_no_parent && is_small(j) ? 1.6f : 3.2f, k_joint);
  for (const rig::FootPin& pin : editor.state().pins) pen.square(model[pin.limb.end].translation, 8.0f, k_pin);
  if (const auto selected = editor.selected()) pen.dot(model[*selected].translation, 5.0f, k_selected);
  if (const auto hovered = editor.hovered()) {
    pen.dot(model[*hovered].translation, 6.0f, k_hovered);
    pen.label(model[*hovered].translation, std::string(rig::bare_joint_name(skeleton.names[*hovered])));
  }
}

} // namespace tutu::app
