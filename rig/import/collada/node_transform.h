// Private to the importer: the transform of a Collada <node>, element by element, with channels on its numbers.
#pragma once

#include "rig/import/collada/collada.h"
#include "rig/import/curves/sampling.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace tutu::rig::import_detail {

enum class ElementKind : std::uint8_t { matrix, translate, rotate, scale, lookat, skew };

/// One element of a node's transform, its numbers as in the file: angles in degrees, a matrix by rows.
struct TransformElement {
  ElementKind kind = ElementKind::matrix;
  std::string sid;
  std::vector<double> numbers;
};

/// In the order in which they are multiplied: parent_from_node = first * second * ... Throws InputError on numbers that
/// are none or not as many as the element has.
std::vector<TransformElement> transform_elements(const ColladaDocument& document, const pugi::xml_node& node);

/// What a channel moves: one number of an element, or all of them.
struct Target {
  pugi::xml_node node;
  std::size_t element = 0;   ///< of transform_elements
  std::optional<int> number; ///< of the element's
};
/// "id/sid", "id/sid/sid", each also with ".X" or "(i)" or "(column)(row)" behind; nothing where that is no transform
/// of a node.
std::optional<Target> target_of(const ColladaDocument& document, const std::string& address);

/// Whole matrices at keys; between them translation and scale go straight and the rotation on an arc, or they are held.
struct MatrixKeys {
  std::vector<double> times; ///< s, never falling
  std::vector<Pose> poses;
  std::vector<bool> held; ///< up to the next key

  Pose at(double time, Side side) const;
};

/// The transform of a node over time.
class MovingTransform {
public:
  explicit MovingTransform(std::vector<TransformElement> elements) : elements_(std::move(elements)) {}

  const std::vector<TransformElement>& elements() const { return elements_; }
  /// In place of what moved it before.
  void move(std::size_t element, int number, ScalarCurve curve);
  void move(std::size_t element, MatrixKeys keys);

  bool moves() const { return !curves_.empty() || !matrices_.empty(); }

  /// Of a transform that moves; `node` is left to the caller. `has_shear` is set where a pose is not all of the
  /// transform. Throws std::length_error as sampled() does.
  NodeMotion motion(bool& has_shear) const;

private:
  Pose pose(double time, Side side, bool& has_shear) const;
  std::vector<double> times() const;
  std::vector<int> first_cuts(const std::vector<double>& times) const;
  std::optional<std::size_t> only_moved_translation() const;

  std::vector<TransformElement> elements_;
  std::map<std::pair<std::size_t, int>, ScalarCurve> curves_; ///< by element and number
  std::map<std::size_t, MatrixKeys> matrices_;                ///< by element
};

} // namespace tutu::rig::import_detail
