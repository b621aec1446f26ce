#include "benchmark/environment/fcl_shapes.hpp"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include <stdexcept>
#include <vector>

#include "fiber_proximity/environment/triangle_mesh.hpp"

namespace fiber {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

struct FclShape {
  Geometry operator()(const BoxShape& box) const { return std::make_shared<fcl::Boxd>(box.size); }
  Geometry operator()(const SphereShape& sphere) const {
    return std::make_shared<fcl::Sphered>(sphere.radius);
  }
  Geometry operator()(const CylinderShape& cylinder) const {
    return std::make_shared<fcl::Cylinderd>(cylinder.radius, cylinder.height);
  }
  Geometry operator()(const ConeShape& cone) const {
    return std::make_shared<fcl::Coned>(cone.radius, cone.height);
  }
  Geometry operator()(const CapsuleShape& capsule) const {
    return std::make_shared<fcl::Capsuled>(capsule.radius, capsule.length);
  }
  Geometry operator()(const std::shared_ptr<const TriangleMesh>& mesh) const {
    std::vector<fcl::Triangle> triangles;
    for (const TriangleMesh::Triangle& triangle : mesh->triangles()) {
      triangles.emplace_back(triangle[0], triangle[1], triangle[2]);
    }
    auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model->beginModel();
    model->addSubModel(mesh->vertices(), triangles);
    model->endModel();
    return model;
  }
  template <class Other>
  Geometry operator()(const Other& /*shape*/) const {
    throw std::invalid_argument("a shape of the cell is none of those FCL is compared on");
  }
};

}  // namespace

Geometry fcl_shape(const Shape& shape) { return std::visit(FclShape(), shape); }

}  // namespace fiber
