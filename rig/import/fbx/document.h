// Private to the importer: the objects of an FBX file that motion is made of, and what is connected with what.
#pragma once

#include "rig/import/fbx/tree.h"
#include "rig/math.h"

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace tutu::rig::import_detail {

struct FbxObject {
  std::int64_t id = 0;
  std::string_view kind;    ///< "Model", "AnimationCurve", ...
  std::string_view name;    ///< without its class; points into the file
  std::string_view subkind; ///< "LimbNode", "Mesh", ...
  const FbxElement* element = nullptr;
};

/// From a part to what it is a part of.
struct FbxConnection {
  std::int64_t part = 0, whole = 0;
  std::string_view property; ///< of the whole that the part drives; empty where it drives none
};

class FbxDocument {
public:
  /// The bytes must outlive it. Throws as parse_fbx, and on a file without objects.
  explicit FbxDocument(std::string_view bytes);

  const FbxTree& tree() const { return tree_; }
  double ticks_per_second() const { return ticks_per_second_; }
  const std::vector<FbxObject>& objects() const { return objects_; } ///< in the order of the file
  const FbxObject* object(std::int64_t id) const;                    ///< null where there is none
  const std::vector<FbxConnection>& parts_of(std::int64_t id) const; ///< in the order of the file
  const FbxObject* parent_of(const FbxObject& model) const;          ///< a model, or null

  /// Numbers of a property ("Lcl Rotation") of an object, else of the file's template for models, else `otherwise`.
  Vec3 vector(const FbxObject& object, std::string_view property, const Vec3& otherwise) const;
  double number(const FbxObject& object, std::string_view property, double otherwise) const;
  std::optional<double> own_number(const FbxObject& object, std::string_view property) const; ///< not of a template
  std::optional<std::int64_t> own_integer(const FbxObject& object, std::string_view property) const;

private:
  const FbxElement* find(const FbxObject& object, std::string_view property) const;

  FbxTree tree_;
  double ticks_per_second_ = 0.0;
  std::vector<FbxObject> objects_;
  std::unordered_map<std::int64_t, std::size_t> by_id_;
  std::unordered_map<std::int64_t, std::vector<FbxConnection>> parts_;
  std::unordered_map<std::int64_t, std::size_t> parent_; ///< of models
  const FbxElement* model_template_ = nullptr;           ///< its Properties70
};

} // namespace tutu::rig::import_detail
