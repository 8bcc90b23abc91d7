#include "proxies/query/detail/broad_phase.h"

#include "proxies/motion/collider_motion.h"

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision_object.h>

namespace tutu::proxies {
namespace {

/// An FCL object that is nothing but a box written by us. FCL's own computeAABB bounds a turned capsule by the box of
/// its bounding sphere, about three times the candidates; the manager reads only the box, so geometry and transform
/// stay untouched.
class BoxedObject : public fcl::CollisionObjectd {
public:
  BoxedObject(const std::shared_ptr<fcl::CollisionGeometryd>& geometry, int index)
      : fcl::CollisionObjectd(geometry), index_(index) {
    setUserData(nullptr); // FCL leaves it uninitialised
  }

  int index() const { return index_; }
  void set_box(const Box& box) {
    aabb.min_ = box.min();
    aabb.max_ = box.max();
  }

private:
  int index_;
};

constexpr int k_query = -1; // index of the object that asks

bool collect(fcl::CollisionObjectd* found, fcl::CollisionObjectd*, void* out) {
  static_cast<std::vector<int>*>(out)->push_back(static_cast<const BoxedObject*>(found)->index());
  return false; // go on
}

} // namespace

struct BroadPhase::Tree {
  // Every object shares one geometry: the tree never looks at it, but FCL demands one.
  std::shared_ptr<fcl::CollisionGeometryd> geometry = std::make_shared<fcl::Boxd>(1.0, 1.0, 1.0);
  BoxedObject query{geometry, k_query};
  std::vector<std::unique_ptr<BoxedObject>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager; // holds pointers to `objects`
};

BroadPhase::BroadPhase() : tree_(std::make_unique<Tree>()) {}
BroadPhase::~BroadPhase() = default;

void BroadPhase::update(std::span<const Capsule> start, std::span<const Capsule> end) {
  std::vector<std::unique_ptr<BoxedObject>>& objects = tree_->objects;
  const bool same_count = objects.size() == start.size();
  if (!same_count) {
    tree_->manager.clear();
    objects.clear();
    for (std::size_t i = 0; i < start.size(); ++i)
      objects.push_back(std::make_unique<BoxedObject>(tree_->geometry, static_cast<int>(i)));
  }
  for (std::size_t i = 0; i < start.size(); ++i) objects[i]->set_box(swept_box(start[i], end[i]));
  if (same_count) {
    tree_->manager.update();
    return;
  }
  std::vector<fcl::CollisionObjectd*> pointers;
  for (const auto& object : objects) pointers.push_back(object.get());
  tree_->manager.registerObjects(pointers);
  tree_->manager.setup();
}

void BroadPhase::overlaps(const Box& box, std::vector<int>& out) {
  tree_->query.set_box(box);
  tree_->manager.collide(&tree_->query, &out, collect);
}

} // namespace tutu::proxies
