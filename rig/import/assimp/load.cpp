// From bytes to assimp's scene.
#include "rig/import/assimp/load.h"

#include "rig/error.h"

#include <assimp/BaseImporter.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <cctype>
#include <filesystem>

namespace tutu::rig::import_detail {
namespace fs = std::filesystem;
namespace {

/// assimp quotes the file at length, in whatever bytes it has.
std::string readable(std::string reason) {
  constexpr std::size_t k_longest = 160;
  if (reason.find("bad_alloc") != std::string::npos) return "it would take more memory than its size can explain";
  for (char& c : reason)
    if (!std::isprint(static_cast<unsigned char>(c))) c = c == '\n' || c == '\r' || c == '\t' ? ' ' : '?';
  if (reason.size() > k_longest) reason = reason.substr(0, k_longest) + " ...";
  return reason;
}

/// A file may name others: none is needed, so nothing is opened (materials of an .obj, say).
class NoFiles : public Assimp::IOSystem {
public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

/// Every other reader is removed, so that no content is ever handed to it.
void keep_only_reader(Assimp::Importer& importer, const std::string& name) {
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    const aiImporterDesc* description = importer.GetImporterInfo(i);
    if (description && name == description->mName) continue;
    Assimp::BaseImporter* reader = importer.GetImporter(i);
    importer.UnregisterLoader(reader); // hands ownership over
    delete reader;
  }
}

/// Face indices must be in range before assimp's own triangulation walks them.
void check_indices(const aiScene& scene, const std::string& file, const char* expected) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    const std::string place = "mesh " + std::string(mesh.mName.C_Str());
    if (mesh.mNumVertices > 0 && !mesh.mVertices) throw InputError(file, place, "no positions", expected);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f)
      for (unsigned i = 0; i < mesh.mFaces[f].mNumIndices; ++i)
        if (mesh.mFaces[f].mIndices[i] >= mesh.mNumVertices)
          throw InputError(file, place, "vertex index " + std::to_string(mesh.mFaces[f].mIndices[i]),
                           "an index below " + std::to_string(mesh.mNumVertices));
  }
}

} // namespace

std::shared_ptr<const aiScene> load(const std::string& file, std::string_view bytes, const char* reader,
                                    const char* expected) {
  const auto importer = std::make_shared<Assimp::Importer>();
  importer->SetIOHandler(new NoFiles);                                          // owned by the importer
  importer->SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, false); // ids, which are unique
  importer->SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer->SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true); // else a file without mesh gets one of cones
  keep_only_reader(*importer, reader);
  std::string extension = fs::path(file).extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  const aiScene* scene = importer->ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str());
  if (!scene || !scene->mRootNode)
    throw InputError(file, "", "a file that cannot be read (" + readable(importer->GetErrorString()) + ")", expected);
  check_indices(*scene, file, expected);
  scene = importer->ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene) throw InputError(file, "", "polygons that cannot be triangulated", expected);
  return {importer, scene};
}

} // namespace tutu::rig::import_detail
