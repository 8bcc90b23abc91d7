// What fuzz targets share. A target reads one input as the program reads a file of that kind, and goes on to what the
// program makes of it. It throws InputError on what is refused, as it should be; another exception, a signal, a
// sanitizer's report or a broken promise (require) is a finding. tests/fuzz/run.sh runs them under libFuzzer,
// test_fuzz runs the seeds through them.
#pragma once

#include "rig/character.h"
#include "rig/import/detail/file_scene.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace tutu::fuzz {

void fuzz_answer(std::string_view input);
void fuzz_autosave(std::string_view input);
void fuzz_bvh(std::string_view input);
void fuzz_clip(std::string_view input);
void fuzz_collada(std::string_view input);
void fuzz_drape(std::string_view input);
void fuzz_fbx(std::string_view input);
void fuzz_garment(std::string_view input);
void fuzz_gltf(std::string_view input);
void fuzz_joint_limits(std::string_view input);
void fuzz_proxies(std::string_view input);
void fuzz_reference(std::string_view input);
void fuzz_results(std::string_view input);
void fuzz_scene(std::string_view input);
void fuzz_settings(std::string_view input);
void fuzz_three_texts(std::string_view input);

/// A folder of this process's own, empty at first and gone when it ends. In $TMPDIR, which run.sh puts in memory.
const std::filesystem::path& scratch();
/// Writes a file there (`name` may have folders before it) and returns its path.
std::filesystem::path write_input(std::string_view bytes, const std::string& name);
std::string text_of(const std::filesystem::path& file);

/// Aborts, with the promise in words, where it does not hold.
void require(bool holds, const char* promise);
void require_poses(std::span<const Transform> transforms, const char* promise); ///< finite, with unit rotations

/// Each of nodes 0 to `nodes` - 1 moves once, with curves that hold and have values that are numbers.
void require_motion(const rig::import_detail::FileAnimation& animation, int nodes);

/// Six joints with Mixamo names, in a capsule for a body, 1 m from its joints' origin.
const rig::Character& small_character();

} // namespace tutu::fuzz
