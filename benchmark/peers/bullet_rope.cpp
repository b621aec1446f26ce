#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "benchmark/peers/cable_peers.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

struct BulletSetting {
  int iterations = 1;    // of positions in a step; 1 is Bullet's default
  int bending = 0;       // links to all nodes up to so many edges away resist bending; 0: none
  bool clusters = true;  // cables touch each other by clusters; by default only faces touch
};

btVector3 to_bullet(const Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// Soft ropes and a floor, in single precision as Bullet is by default.
class BulletRopes final : public CableSimulation {
 public:
  BulletRopes(const CableScene& scene, int segments, const BulletSetting& setting) {
    const btVector3 gravity(0, 0, static_cast<btScalar>(-CableScene::gravity));
    world_.setGravity(gravity);
    btSoftBodyWorldInfo& info = world_.getWorldInfo();
    info.m_gravity = gravity;
    info.air_density = 0;
    info.m_broadphase = &broad_phase_;
    info.m_dispatcher = &dispatcher_;
    info.m_sparsesdf.Initialize();
    if (scene.touches) {
      floor_.setFriction(static_cast<btScalar>(scene.friction));
      world_.addRigidBody(&floor_);
    }
    for (const auto& [first, last] : scene.cables) {
      add_rope(scene, first, last, segments, setting);
    }
  }

  ~BulletRopes() override {
    for (const auto& rope : ropes_) {
      world_.removeSoftBody(rope.get());
    }
    if (floor_.isInWorld()) {
      world_.removeRigidBody(&floor_);
    }
  }

  void step() override { world_.stepSimulation(static_cast<btScalar>(CableScene::step), 0); }

  std::vector<Vector3d> positions() override {
    std::vector<Vector3d> nodes;
    for (const auto& rope : ropes_) {
      for (int i = first_node_; i < rope->m_nodes.size(); ++i) {
        const btVector3& x = rope->m_nodes[i].m_x;
        nodes.emplace_back(x.x(), x.y(), x.z());
      }
    }
    return nodes;
  }

 private:
  /// A clamp holds a node more, one edge before the first.
  void add_rope(const CableScene& scene, const Vector3d& first, const Vector3d& last, int segments,
                const BulletSetting& setting) {
    const Vector3d edge = (last - first) / segments;
    first_node_ = scene.first_end == CableEnd::CLAMPED ? 1 : 0;
    ropes_.emplace_back(
        btSoftBodyHelpers::CreateRope(world_.getWorldInfo(), to_bullet(first - first_node_ * edge),
                                      to_bullet(last), segments - 1 + first_node_, 0));
    btSoftBody& rope = *ropes_.back();
    const double mass = scene.section().mass_per_length * edge.norm();
    for (int i = 0; i < rope.m_nodes.size(); ++i) {
      const bool is_end = i == first_node_ || i + 1 == rope.m_nodes.size();
      const bool is_held = scene.first_end != CableEnd::FREE && i <= first_node_;
      rope.setMass(i, static_cast<btScalar>(is_held ? 0.0 : is_end ? 0.5 * mass : mass));
    }
    if (setting.bending > 0) {
      rope.generateBendingConstraints(setting.bending);
    }
    rope.m_cfg.piterations = setting.iterations;
    rope.m_cfg.kDP = static_cast<btScalar>(1.0 - scene.fade(CableScene::step));
    rope.m_cfg.kDF = static_cast<btScalar>(scene.friction);
    rope.getCollisionShape()->setMargin(static_cast<btScalar>(scene.radius));
    if (scene.touches && setting.clusters) {
      rope.m_cfg.collisions = btSoftBody::fCollision::SDF_RS + btSoftBody::fCollision::CL_SS;
      bend_a_little(rope, 0.1 * scene.radius);
      rope.generateClusters(std::max(1, segments / 4));
    }
    world_.addSoftBody(&rope);
  }

  /// Clusters are rigid bodies, which nodes in a row have no moment of inertia for.
  static void bend_a_little(btSoftBody& rope, double way) {
    for (int i = 0; i < rope.m_nodes.size(); ++i) {
      btVector3& position = rope.m_nodes[i].m_x;
      position[i % 3] += static_cast<btScalar>(i % 2 == 0 ? way : -way);
    }
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
  btStaticPlaneShape floor_shape_{{0, 0, 1}, 0};
  btRigidBody floor_{{0, nullptr, &floor_shape_}};
  std::vector<std::unique_ptr<btSoftBody>> ropes_;
  int first_node_ = 0;
};

std::string words(const CableScene& scene, const BulletSetting& setting) {
  std::string text = std::to_string(setting.iterations) + " iterations";
  if (setting.bending > 0) {
    text += ", bending links over " + std::to_string(setting.bending) + " edges";
  }
  if (scene.touches) {
    text += setting.clusters ? ", clusters" : ", faces";
  }
  return text;
}

}  // namespace

std::vector<CableMethod> bullet_ropes(const CableScene& scene, const std::vector<int>& segments) {
  std::vector<BulletSetting> settings;
  if (scene.touches) {
    settings = {{10, 0, false}, {100, 0, false}, {10, 0, true}, {100, 0, true}};
  } else if (scene.first_end == CableEnd::CLAMPED) {
    for (const int bending : {2, 4, 8}) {
      settings.insert(settings.end(), {{10, bending}, {100, bending}, {1000, bending}});
    }
  } else {
    settings = {{1}, {10}, {100}, {1000}};
  }
  std::vector<CableMethod> methods;
  for (const int count : segments) {
    for (const BulletSetting& setting : settings) {
      methods.push_back(
          {"bullet", words(scene, setting), count, [count, setting](const CableScene& of) {
             return std::make_unique<BulletRopes>(of, count, setting);
           }});
    }
  }
  return methods;
}

}  // namespace fiber
