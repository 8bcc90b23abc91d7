#include "tests/bench/bullet_skirt.h"

#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>
#include <ctime>

namespace tutu::bench {
namespace {

constexpr app::DancerMotion k_motion = app::DancerMotion::dance;

btScalar scalar(double v) { return static_cast<btScalar>(v); }
btVector3 vector(const Vec3& v) { return {scalar(v.x()), scalar(v.y()), scalar(v.z())}; }
Vec3 vector(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

/// Bullet's capsules lie along their own y.
btTransform transform_of(const proxies::Capsule& capsule) {
  const Quat turn = Quat::FromTwoVectors(Vec3::UnitY(), capsule.b - capsule.a);
  const bool sphere = capsule.a == capsule.b;
  btTransform transform;
  transform.setIdentity();
  transform.setOrigin(vector(Vec3(0.5 * (capsule.a + capsule.b))));
  if (!sphere) transform.setRotation({scalar(turn.x()), scalar(turn.y()), scalar(turn.z()), scalar(turn.w())});
  return transform;
}

double thread_cpu_ms() {
  std::timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

} // namespace

struct BulletSkirt::World {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btSoftRigidDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::vector<std::unique_ptr<btMotionState>> motions;
  std::vector<std::unique_ptr<btRigidBody>> bodies; ///< in the proxies' order
  std::unique_ptr<btSoftBody> cloth;

  ~World() {
    world.removeSoftBody(cloth.get());
    for (const auto& body : bodies) world.removeRigidBody(body.get());
  }
};

BulletSkirt::BulletSkirt(const BulletSetup& setup)
    : setup_(setup), skirt_(app::dancer_skirt(setup.n)), proxies_(app::k_dancer_proxies), pins_(skirt_.pins.size()),
      world_(std::make_unique<World>()) {
  particles_.positions = skirt_.rest_positions;
  app::pose_dancer(0.0, k_motion, proxies_);
  World& w = *world_;
  w.world.setGravity({0, scalar(-9.81), 0});
  btSoftBodyWorldInfo& info = w.world.getWorldInfo();
  info.m_dispatcher = &w.dispatcher;
  info.m_broadphase = &w.broadphase;
  info.m_gravity = w.world.getGravity();
  info.air_density = 0;
  info.m_sparsesdf.Initialize(); // sets a voxel of its own, which Reset() replaces
  info.m_sparsesdf.setDefaultVoxelsz(scalar(setup.voxel));
  info.m_sparsesdf.Reset();

  for (const proxies::Capsule& proxy : proxies_) {
    if (proxy.a == proxy.b) w.shapes.push_back(std::make_unique<btSphereShape>(scalar(proxy.radius)));
    else w.shapes.push_back(std::make_unique<btCapsuleShape>(scalar(proxy.radius), scalar((proxy.b - proxy.a).norm())));
    w.motions.push_back(std::make_unique<btDefaultMotionState>(transform_of(proxy)));
    w.bodies.push_back(std::make_unique<btRigidBody>(
        btRigidBody::btRigidBodyConstructionInfo(0, w.motions.back().get(), w.shapes.back().get())));
    btRigidBody& body = *w.bodies.back();
    body.setFriction(1); // it is multiplied with the cloth's
    body.setCollisionFlags(body.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    body.setActivationState(DISABLE_DEACTIVATION);
    w.world.addRigidBody(&body);
  }

  const int count = skirt_.particle_count();
  std::vector<btVector3> positions;
  std::vector<btScalar> masses;
  for (int i = 0; i < count; ++i) {
    positions.push_back(vector(skirt_.rest_positions[i]));
    masses.push_back(scalar(skirt_.masses[i]));
  }
  w.cloth = std::make_unique<btSoftBody>(&info, count, positions.data(), masses.data());
  for (int k = 0; k < skirt_.structural_count; ++k) w.cloth->appendLink(skirt_.springs[k].i, skirt_.springs[k].j);
  for (const auto& t : skirt_.triangles)
    w.cloth->appendFace(static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2]));
  for (const cloth::Pin& pin : skirt_.pins) w.cloth->setMass(pin.particle, 0);
  w.cloth->m_cfg.piterations = setup.iterations;
  w.cloth->m_cfg.kDF = scalar(app::k_dancer_friction);
  // Hardness of contacts with kinematic bodies: of 0.1 (its default), 0.5 and 1 the one with the least depth and
  // stretch on this scene.
  w.cloth->m_cfg.kKHR = scalar(0.5);
  w.cloth->m_cfg.collisions = btSoftBody::fCollision::SDF_RS;
  w.cloth->getCollisionShape()->setMargin(scalar(skirt_.fabric.contact_offset()));
  w.cloth->setActivationState(DISABLE_DEACTIVATION);
  w.world.addSoftBody(w.cloth.get());
}

BulletSkirt::~BulletSkirt() = default;

void BulletSkirt::move_bodies() {
  for (std::size_t k = 0; k < proxies_.size(); ++k)
    world_->motions[k]->setWorldTransform(transform_of(proxies_[k])); // asked for by the next step
}

void BulletSkirt::move_pins(double h) {
  for (std::size_t k = 0; k < skirt_.pins.size(); ++k) {
    btSoftBody::Node& node = world_->cloth->m_nodes[skirt_.pins[k].particle];
    node.m_v = (vector(pins_[k]) - node.m_x) / scalar(h); // the step takes it there: nodes without mass keep moving
  }
}

void BulletSkirt::advance() {
  const double before = thread_cpu_ms();
  const double frame = 1.0 / app::k_dancer_frames_per_second, h = frame / setup_.substeps;
  for (int k = 0; k < setup_.substeps; ++k) {
    const double t = frame_ * frame + (k + 1) * h;
    app::pose_dancer(t, k_motion, proxies_);
    app::dancer_pins(skirt_, t, k_motion, pins_);
    move_bodies();
    move_pins(h);
    world_->world.stepSimulation(scalar(h), 0);
  }
  ++frame_;
  for (int i = 0; i < skirt_.particle_count(); ++i) particles_.positions[i] = vector(world_->cloth->m_nodes[i].m_x);
  for (std::size_t k = 0; k < skirt_.pins.size(); ++k) particles_.positions[skirt_.pins[k].particle] = pins_[k];
  cpu_ms_ = thread_cpu_ms() - before;
}

} // namespace tutu::bench
