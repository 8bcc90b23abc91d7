// The proxy editor without its window: what pointer, keys and menus do to the proxies. Nothing here draws.
#pragma once

#include "rig/character.h"
#include "src/view/proxy_edit/proxy_document.h"
#include "src/view/proxy_edit/proxy_figures.h"
#include "src/view/proxy_edit/proxy_handles.h"

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace tutu::app {

enum class ProxyCommand { undo, redo, add_sphere, add_capsule, remove, fit_one, one_radius, save, save_as, restart };

struct ProxyCommandEntry {
  ProxyCommand command;
  const char* label; ///< what it does
  const char* keys;  ///< as shown, and as InputEvent has them
};

/// Keys and buttons are made of it.
std::span<const ProxyCommandEntry> proxy_command_table();

/// A question that waits for its answer; until then pointer and keys are not the proxies'.
enum class ProxyQuestion { none, leave_unsaved, save_as };

class ProxyEditor {
public:
  /// `file`: what the proxies were read from; empty where there is none. The character must outlive it.
  ProxyEditor(const rig::Character& character, std::vector<proxies::Proxy> proxies, std::filesystem::path file);

  /// The pose that is edited in: joints, and the skin's vertices; world, m. Copied. A drag is dropped.
  void set_pose(std::span<const Transform> world_from_joint, std::span<const Vec3f> positions);
  /// How many px one of a common display is.
  void set_picture(const Picture& picture, float pixel_scale);

  // The pointer, in px of the picture.
  bool press(double x, double y); ///< true: it took hold of a handle
  void point(double x, double y, bool shift);
  void release();
  void click(double x, double y); ///< selects the proxy there, or none

  void run(ProxyCommand command);
  bool can_run(ProxyCommand command) const;
  void select(std::optional<int> proxy) { document_.select(proxy); }
  void choose_joint(int joint) { joint_ = joint; } ///< that new proxies are put on

  /// True when it wrote the file; else, and then too, message() tells.
  bool save_to(const std::filesystem::path& file);

  /// Closing. True when nothing is unsaved; else it asks.
  bool ask_to_leave();
  void answer_leave(bool save); ///< leaving() when nothing is in the way
  void answer_save_as(const std::string& file);
  void cancel_question();

  bool take_restart(); ///< whether a restart was asked for since the last call

  const ProxyDocument& document() const { return document_; }
  const ProxyEditState& state() const { return document_.state(); }
  const proxies::Proxy* selected() const;
  ProxyPose pose() const { return {world_from_joint_, rest_}; }
  std::vector<proxies::Capsule> shapes() const;         ///< of all, posed
  std::vector<proxies::Capsule> enabled_shapes() const; ///< of those that collide
  std::vector<Handle> handles() const;                  ///< of the selected one
  std::optional<HandleKind> held() const;
  const ProxyMeasure::Result& figures(); ///< at this pose; `one` of the selected proxy
  const rig::Skeleton& skeleton() const { return character_->skeleton; }
  const Picture& picture() const { return picture_; }
  const std::filesystem::path& file() const { return file_; }
  const std::string& message() const { return message_; } ///< "" or one sentence about what was done last
  int joint() const { return joint_; }
  ProxyQuestion question() const { return question_; }
  bool leaving() const { return leaving_; }

  /// What a machine may ask about (--json).
  nlohmann::ordered_json json() const;

private:
  Vec3 view_direction() const;
  const ProxyMeasure& measure();
  void change(std::vector<proxies::Proxy> proxies, std::optional<int> selected);
  void add(proxies::ProxyKind kind);
  void fit();
  std::string free_name() const;
  std::optional<int> enabled_index() const; ///< of the selected one, among enabled_shapes()

  const rig::Character* character_;
  std::vector<Transform> rest_, world_from_joint_;
  std::vector<Vec3f> positions_;
  std::filesystem::path file_;
  ProxyDocument document_;
  std::optional<ProxyMeasure> measure_;         ///< once it is asked for: who only plays does not wait for it
  std::optional<ProxyMeasure::Result> figures_; ///< none: stale
  Picture picture_;
  float pixel_scale_ = 1.0f;
  struct Hold {
    HandleKind kind;
    ProxyDrag drag;
  };
  std::optional<Hold> hold_;
  int joint_ = 0;
  std::string message_;
  ProxyQuestion question_ = ProxyQuestion::none;
  bool leaving_ = false, leave_after_ = false, restart_ = false;
};

} // namespace tutu::app
