// Private to the importer: what the reader of Collada's nodes, meshes and skins does not tell of a file
// [COLLADA 1.4.1].
//
// Everything stays in the file's unit and axes: <unit> and <up_axis> are not applied.
#pragma once

#include "rig/import/detail/file_scene.h"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace pugi {
class xml_document;
class xml_node;
} // namespace pugi

namespace tutu::rig::import_detail {

/// A file as a tree of elements. Elements that it gives out are valid as long as it lives.
class ColladaDocument {
public:
  /// Throw InputError on a file that cannot be read or is no XML, with the line where it ceases to be; on elements
  /// nested more than 1000 deep.
  explicit ColladaDocument(const std::string& file);
  ColladaDocument(const std::string& file, std::string_view text); ///< the text is the file's

  const std::string& file() const { return file_; }
  pugi::xml_node root() const;                         ///< <COLLADA>, or no element
  pugi::xml_node element(std::string_view id) const;   ///< the first of this id, or none
  pugi::xml_node referred(std::string_view uri) const; ///< "#id"; none for what is elsewhere
  bool is_twice(std::string_view id) const { return twice_.contains(id); }

private:
  void index();

  std::string file_;
  std::shared_ptr<pugi::xml_document> tree_;
  std::unordered_map<std::string_view, const void*> by_id_; ///< pugi's node handles; the keys are in the tree
  std::unordered_set<std::string_view> twice_;              ///< ids
};

/// Throw InputError: on joint and weight indices out of range, on weights that are negative or no number, on arrays of
/// a skin whose id another element has too (of which one is taken here, perhaps the other elsewhere); and on geometry,
/// skins or scenes in another document or outside of the file's folder.
void check_skins(const ColladaDocument& document);
void check_references(const ColladaDocument& document);

/// What the reader calls a node by: its id, else its sid; empty when it has neither.
std::string reference_name(const pugi::xml_node& node);
/// For people: the name of each node by its reference name; of several of one reference name the first one's.
std::map<std::string, std::string> display_names(const ColladaDocument& document);

/// What a skin calls a node: its sid, by its reference name; of nodes that have one. Several may have the same, one in
/// each skeleton.
std::map<std::string, std::string> skin_names(const ColladaDocument& document);

/// By the id of a geometry: its name for people, which may be empty, and bound space from its vertices.
struct BoundGeometry {
  std::string name;
  Affine bind_shape = Affine::Identity();
};
std::map<std::string, BoundGeometry> bound_geometries(const ColladaDocument& document);

/// The clips of the file: its <animation_clip>s, or without any all animations together. `node_of` gives the node of a
/// reference name. Channels on anything else than the transform of such a node are left out and noted.
/// Throws InputError on keys that are not as many as they should be, fall in time, or are no numbers.
std::vector<FileAnimation> animations(const ColladaDocument& document, const std::map<std::string, int>& node_of);

} // namespace tutu::rig::import_detail
