// What `tutu play` was asked for, and its two ways of doing it.
#pragma once

#include "src/options/scene_options.h"
#include "src/scene/load.h"
#include "src/view/render/frame_view.h"
#include "src/view/show/layers.h"

namespace tutu::app {

struct PlayOptions {
  SceneOptions scene;
  bool headless = false, window = false, paused = false, no_pictures = false;
  std::optional<int> frames;
  std::string out, json;
  std::vector<int> at;
  std::vector<std::string> show, hide;
  std::vector<std::string> overlay;
  double tolerance_mm = 1000.0 * ErrorScale().tolerance;
  bool worst = false;
  std::string against, split; ///< the other scene, or KEY=VALUE of this one; "" for none
  std::string why;            ///< GARMENT:PARTICLE@FRAME, or ""
  std::string size = "1280x720";
  int supersample = 1;
  double yaw_degrees = 25.0, pitch_degrees = 8.0;
};

Layers layers_of(const PlayOptions& options);

/// The scene file with all options applied; notes of the loading, and warnings, go to stderr.
LoadedScene load(const PlayOptions& options);

/// A scene with the start of its garments.
struct Draped {
  LoadedScene scene;
  GarmentPositions start;
};

/// The other scene that --against or --split name; none without them, or when it does not settle (which was said). Of
/// --split it starts where `first` does, where that fits.
bool is_split(const PlayOptions& options);
std::string split_caption(const PlayOptions& options); ///< of the other one
std::optional<Draped> other_scene(const PlayOptions& options, const Draped& first);

/// "1280x720" -> {1280, 720}. Throws InputError.
std::pair<int, int> size_of(const std::string& text);

/// Once through the motion, or options.frames.
int frames_to_play(const PlayOptions& options, const LoadedScene& scene);

/// Where a run without a window puts its pictures: one film, or a folder of PNGs; no path for none.
struct PictureTarget {
  std::filesystem::path path;
  bool film = false;
};
PictureTarget picture_target(const PlayOptions& options, const Scene& scene);

/// Both return the exit status. `other`: with is_split only.
int play_headless(const PlayOptions& options, const Draped& first, const Draped* other);
/// Goes on with whatever file the user opens next.
int play_in_window(const PlayOptions& options, Draped first, std::optional<Draped> other);

} // namespace tutu::app
