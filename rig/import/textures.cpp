// Textures are not needed and never opened; a file that would have had others' opened is told of.
#include "rig/import/detail/parts.h"
#include "rig/import/detail/reach.h"
#include "rig/import/import.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <set>

namespace tutu::rig::import_detail {

void note_outside_textures(const Source& source, ImportReport& report) {
  const Reach reach(source.file);
  std::set<std::string> outside;
  for (unsigned m = 0; m < source.scene->mNumMaterials; ++m)
    for (int kind = 0; kind <= AI_TEXTURE_TYPE_MAX; ++kind) {
      const auto type = static_cast<aiTextureType>(kind);
      aiString name;
      for (unsigned i = 0; source.scene->mMaterials[m]->GetTexture(type, i, &name) == aiReturn_SUCCESS; ++i)
        if (!reach.holds_name(name.C_Str())) outside.insert(name.C_Str());
    }
  if (!outside.empty())
    report.notes.push_back(count_of(outside.size(), "texture") +
                           " outside of the file's folder not opened: " + list_of({outside.begin(), outside.end()}));
}

} // namespace tutu::rig::import_detail
