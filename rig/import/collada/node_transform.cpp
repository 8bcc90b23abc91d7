#include "rig/import/collada/node_transform.h"

#include "rig/error.h"
#include "rig/import/collada/source.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tutu::rig::import_detail {
namespace {

constexpr double k_degree = std::numbers::pi / 180.0;

struct Kind {
  const char* name;
  ElementKind kind;
  std::size_t numbers;
};
constexpr Kind k_kinds[] = {{"matrix", ElementKind::matrix, 16}, {"translate", ElementKind::translate, 3},
                            {"rotate", ElementKind::rotate, 4},  {"scale", ElementKind::scale, 3},
                            {"lookat", ElementKind::lookat, 9},  {"skew", ElementKind::skew, 7}};

const Kind* kind_of(const pugi::xml_node& element) {
  const auto* found =
      std::ranges::find_if(k_kinds, [&](const Kind& kind) { return std::string_view(element.name()) == kind.name; });
  return found == std::end(k_kinds) ? nullptr : found;
}

Vec3 unit(const Vec3& v) {
  const double length = v.norm();
  return length > 0.0 ? Vec3(v / length) : Vec3::Zero();
}

Quat turn(const std::vector<double>& n) {
  const Vec3 axis = unit(Vec3(n[0], n[1], n[2]));
  return axis.isZero() ? Quat::Identity() : Quat(Eigen::AngleAxisd(n[3] * k_degree, axis));
}

Eigen::Affine3d by_rows(const std::vector<double>& n) {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) map(r, c) = n[static_cast<std::size_t>(4 * r + c)];
  return map;
}

/// From where the eye is, -Z towards the point of interest, Y as far up as that allows [COLLADA 1.4.1, lookat].
Eigen::Affine3d look_at(const std::vector<double>& n) {
  const Vec3 eye(n[0], n[1], n[2]), back = unit(eye - Vec3(n[3], n[4], n[5]));
  const Vec3 right = unit(Vec3(n[6], n[7], n[8]).cross(back));
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.translation() = eye;
  if (!back.isZero() && !right.isZero()) map.linear() << right, back.cross(right), back;
  return map;
}

/// Moves along the second axis by the tangent of the angle times the way along the first [RenderMan, Skew].
Eigen::Affine3d skewed(const std::vector<double>& n) {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  map.linear() += std::tan(n[0] * k_degree) * unit(Vec3(n[4], n[5], n[6])) * unit(Vec3(n[1], n[2], n[3])).transpose();
  return map;
}

bool is_uniform(const Vec3& scale) { return (scale.array() == scale[0]).all(); }

/// A product of transforms that keeps rotation and scale apart as long as it can: a decomposition would lose the
/// rotation where a scale is 0.
class Product {
public:
  void translate(const Vec3& by) { map_.translate(by); }
  void rotate(const Quat& by) {
    is_plain_ = is_plain_ && is_uniform(scale_);
    rotation_ = rotation_ * by;
    map_.rotate(by);
  }
  void scale(const Vec3& by) {
    scale_ = scale_.cwiseProduct(by);
    map_.scale(by);
  }
  void apply(const Pose& pose) {
    translate(pose.translation);
    rotate(pose.rotation);
    scale(pose.scale);
  }
  void apply(const Eigen::Affine3d& map) {
    bool has_shear = false;
    const Pose pose = pose_of(map, has_shear);
    if (!has_shear) return apply(pose);
    is_plain_ = false;
    map_ = map_ * map;
  }
  Pose pose(bool& has_shear) const {
    if (is_plain_) return {map_.translation(), rotation_.normalized(), scale_};
    return pose_of(map_, has_shear);
  }

private:
  Eigen::Affine3d map_ = Eigen::Affine3d::Identity();
  Quat rotation_ = Quat::Identity();
  Vec3 scale_ = Vec3::Ones();
  bool is_plain_ = true; ///< map = translation * rotation * scale
};

Eigen::Affine3d map_of(ElementKind kind, const std::vector<double>& n) {
  switch (kind) {
  case ElementKind::matrix: return by_rows(n);
  case ElementKind::translate: return Eigen::Affine3d(Eigen::Translation3d(n[0], n[1], n[2]));
  case ElementKind::rotate: return Eigen::Affine3d(turn(n));
  case ElementKind::scale: return Eigen::Affine3d(Eigen::Scaling(n[0], n[1], n[2]));
  case ElementKind::lookat: return look_at(n);
  case ElementKind::skew: return skewed(n);
  }
  return Eigen::Affine3d::Identity();
}

void apply(Product& product, ElementKind kind, const std::vector<double>& n) {
  if (kind == ElementKind::translate) product.translate(Vec3(n[0], n[1], n[2]));
  else if (kind == ElementKind::rotate) product.rotate(turn(n));
  else if (kind == ElementKind::scale) product.scale(Vec3(n[0], n[1], n[2]));
  else product.apply(map_of(kind, n));
}

bool only_turns_or_scales(ElementKind kind) {
  return kind == ElementKind::rotate || kind == ElementKind::scale || kind == ElementKind::skew;
}

} // namespace

std::vector<TransformElement> transform_elements(const ColladaDocument& document, const pugi::xml_node& node) {
  std::vector<TransformElement> elements;
  for (const pugi::xml_node child : node.children()) {
    const Kind* kind = kind_of(child);
    if (!kind) continue;
    TransformElement element{kind->kind, child.attribute("sid").value(), {}};
    const std::vector<std::string_view> text = words_of(child);
    for (const std::string_view word : text) {
      const std::optional<double> number = number_of(word);
      if (number && std::abs(*number) <= k_largest_number) element.numbers.push_back(*number);
    }
    if (element.numbers.size() != kind->numbers || text.size() != kind->numbers)
      throw InputError(document.file(), "node " + shown(reference_name(node)),
                       std::string(kind->name) + " \"" + shown(child.child_value()) + "\"",
                       std::to_string(kind->numbers) + " finite numbers within +-1e9");
    elements.push_back(std::move(element));
  }
  return elements;
}

Pose MatrixKeys::at(double time, Side side) const {
  const auto next =
      side == Side::behind ? std::ranges::upper_bound(times, time) : std::ranges::lower_bound(times, time);
  if (next == times.begin()) return poses.front();
  const auto k = static_cast<std::size_t>(next - times.begin()) - 1;
  if (next == times.end() || held[k]) return poses[k];
  const Pose &a = poses[k], &b = poses[k + 1];
  const double s = (time - times[k]) / (times[k + 1] - times[k]);
  return {a.translation + s * (b.translation - a.translation), a.rotation.slerp(s, b.rotation),
          a.scale + s * (b.scale - a.scale)};
}

void MovingTransform::move(std::size_t element, int number, ScalarCurve curve) {
  matrices_.erase(element);
  curves_.insert_or_assign({element, number}, std::move(curve));
}

void MovingTransform::move(std::size_t element, MatrixKeys keys) {
  std::erase_if(curves_, [&](const auto& curve) { return curve.first.first == element; });
  matrices_.insert_or_assign(element, std::move(keys));
}

Pose MovingTransform::pose(double time, Side side, bool& has_shear) const {
  Product product;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    if (const auto keys = matrices_.find(e); keys != matrices_.end()) {
      product.apply(keys->second.at(time, side));
      continue;
    }
    auto curve = curves_.lower_bound({e, 0});
    if (curve == curves_.end() || curve->first.first != e) {
      apply(product, elements_[e].kind, elements_[e].numbers);
      continue;
    }
    std::vector<double> numbers = elements_[e].numbers;
    for (; curve != curves_.end() && curve->first.first == e; ++curve)
      numbers[static_cast<std::size_t>(curve->first.second)] = value_at(curve->second, time, side);
    apply(product, elements_[e].kind, numbers);
  }
  return product.pose(has_shear);
}

std::vector<double> MovingTransform::times() const {
  std::vector<const ScalarCurve*> curves;
  for (const auto& [place, curve] : curves_) curves.push_back(&curve);
  std::vector<double> times = merged_times(curves);
  for (const auto& [element, keys] : matrices_) times.insert(times.end(), keys.times.begin(), keys.times.end());
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::vector<int> MovingTransform::first_cuts(const std::vector<double>& times) const {
  std::vector<int> cuts;
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    double angle = 0.0;
    for (const auto& [place, curve] : curves_) {
      const ElementKind kind = elements_[place.first].kind;
      if (kind == ElementKind::translate || kind == ElementKind::scale) continue;
      const double way = way_between(curve, times[i], times[i + 1]);
      // Anything but an angle turns by no more than half a turn on its straight way.
      angle += kind == ElementKind::rotate && place.second == 3 ? way * k_degree : way > 0.0 ? std::numbers::pi : 0.0;
    }
    cuts.push_back(cuts_for(angle));
  }
  return cuts;
}

/// The one <translate> whose numbers alone move the node's translation, and by an affine map: nothing before it moves,
/// and nothing behind it has a translation.
std::optional<std::size_t> MovingTransform::only_moved_translation() const {
  if (curves_.empty() || !matrices_.empty()) return std::nullopt;
  const std::size_t first = curves_.begin()->first.first;
  if (elements_[first].kind != ElementKind::translate) return std::nullopt;
  for (std::size_t e = first + 1; e < elements_.size(); ++e)
    if (!only_turns_or_scales(elements_[e].kind)) return std::nullopt;
  return first;
}

NodeMotion MovingTransform::motion(bool& has_shear) const {
  NodeMotion motion;
  if (elements_.size() == 1 && matrices_.size() == 1) { // kept as it is
    const MatrixKeys& keys = matrices_.begin()->second;
    motion.translation.times = motion.rotation.times = motion.scale.times = keys.times;
    for (std::size_t k = 0; k < keys.times.size(); ++k) {
      motion.translation.values.push_back(keys.poses[k].translation);
      motion.rotation.values.emplace_back(keys.poses[k].rotation.coeffs());
      motion.scale.values.push_back(keys.poses[k].scale);
      motion.translation.laws.push_back(keys.held[k] ? Law::step : Law::linear);
    }
    motion.rotation.laws = motion.scale.laws = motion.translation.laws;
    return motion;
  }
  const std::vector<double> times = this->times();
  Product rest;
  for (const TransformElement& element : elements_) apply(rest, element.kind, element.numbers);
  PoseCurves curves = sampled_pose(
      times, first_cuts(times), [&](double time, Side side) { return pose(time, side, has_shear); },
      rest.pose(has_shear));
  motion.translation = std::move(curves.translation);
  motion.rotation = std::move(curves.rotation);
  motion.scale = std::move(curves.scale);
  if (const std::optional<std::size_t> moved = only_moved_translation(); moved && !motion.translation.empty()) {
    Eigen::Affine3d before = Eigen::Affine3d::Identity();
    for (std::size_t e = 0; e < *moved; ++e) before = before * map_of(elements_[e].kind, elements_[e].numbers);
    std::array<const ScalarCurve*, 3> parts{};
    for (int i = 0; i < 3; ++i)
      if (const auto curve = curves_.find({*moved, i}); curve != curves_.end()) parts[i] = &curve->second;
    const std::vector<double>& constant = elements_[*moved].numbers;
    const auto translation = [&](double time, Side side) {
      bool ignored = false;
      return pose(time, side, ignored).translation;
    };
    motion.translation =
        joined(parts, Vec3(constant[0], constant[1], constant[2]), before,
               tolerance_for(times, translation, before * Vec3(constant[0], constant[1], constant[2])));
  }
  return motion;
}

} // namespace tutu::rig::import_detail
