// FBX, binary and text: its motion on nodes that bear the names of its models, and names made unique.
#include "rig/import/fbx/fbx.h"
#include "rig/error.h"
#include "tests/fuzz/target.h"

namespace tutu::fuzz {

void fuzz_fbx(std::string_view input) {
  namespace detail = rig::import_detail;
  const std::vector<detail::FileNode> nodes = {{.name = "RootNode"},
                                               {.name = "Hips", .parent = 0},
                                               {.name = "Arm", .parent = 1},
                                               {.name = "Arm001", .parent = 1}};
  const detail::FbxMotion motion = detail::fbx_motion(input, nodes);
  for (const detail::FileAnimation& animation : motion.animations)
    require_motion(animation, static_cast<int>(nodes.size()));
  if (const auto unique = detail::with_unique_names(input)) {
    require(unique->bytes.size() == input.size(), "names stay as long as they are");
    require(!detail::with_unique_names(unique->bytes), "unique names are unique");
    detail::check_fbx_names("motion.fbx", unique->bytes);
  }
  if (!motion.unread.empty())
    throw InputError("motion.fbx", "", "a file that cannot be read (" + motion.unread + ")", "an FBX file");
}

} // namespace tutu::fuzz
