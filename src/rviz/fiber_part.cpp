#include "src/rviz/fiber_part.hpp"

#include <OgreCamera.h>
#include <OgreHardwareBufferManager.h>

#include <utility>

#include "src/rviz/fiber_materials.hpp"

namespace fiber_proximity_rviz {
namespace {

using Kind = Detail::Kind;
using Operation = Ogre::RenderOperation;

std::unique_ptr<Ogre::IndexData> upload(const std::vector<std::uint32_t>& indices) {
  auto data = std::make_unique<Ogre::IndexData>();
  data->indexBuffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
      Ogre::HardwareIndexBuffer::IT_32BIT, indices.size(),
      Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  data->indexBuffer->writeData(0, sizeof(std::uint32_t) * indices.size(), indices.data(), true);
  data->indexCount = indices.size();
  return data;
}

}  // namespace

FiberPart::FiberPart(const Ogre::MovableObject& owner, Ogre::VertexData& vertices,
                     const FiberMaterials& materials)
    : owner_(owner), materials_(materials), material_(&materials.tubes()) {
  operation_.vertexData = &vertices;
  operation_.useIndexes = true;
}

void FiberPart::show_tubes(const FiberMesh& mesh) {
  std::unique_ptr<Ogre::IndexData>& all = levels_[Detail()];
  all = upload(mesh.indices);
  operation_.indexData = all.get();
  operation_.operationType = Operation::OT_TRIANGLE_LIST;
  chunk_.box = mesh.box;
}

void FiberPart::set_chunk(const FiberMesh& mesh, FiberChunk chunk) {
  mesh_ = &mesh;
  chunk_ = std::move(chunk);
}

void FiberPart::prepare(const std::vector<Eigen::Vector3d>& points, const Detail& detail) {
  detail_ = detail;
  indices_.clear();
  const auto all_points = all_points_.find(detail.kind);
  if (all_points != all_points_.end() && detail.level <= all_points->second) {
    detail_.level = Detail::finest;
  }
  if (levels_.count(detail_) > 0) {
    return;
  }
  indices_ = make_indices(points, mesh_->vertices, chunk_, detail_);
  const std::size_t indices_of_segment = detail.kind == Kind::lines ? 2 : 6;
  if (detail_.level > Detail::finest &&
      4 * indices_.size() > 3 * indices_of_segment * chunk_.segment_count) {
    all_points_[detail.kind] = detail.level;
    prepare(points, detail);
  }
}

void FiberPart::show() {
  std::unique_ptr<Ogre::IndexData>& shown = levels_[detail_];
  if (!shown) {
    shown = upload(indices_);
    indices_ = {};
  }
  const bool as_lines = detail_.kind == Kind::lines;
  material_ = as_lines ? &materials_.lines() : &materials_.ribbons();
  operation_.indexData = shown.get();
  operation_.operationType = as_lines ? Operation::OT_LINE_LIST : Operation::OT_TRIANGLE_LIST;
}

const Ogre::MaterialPtr& FiberPart::getMaterial() const { return *material_; }

void FiberPart::getRenderOperation(Ogre::RenderOperation& operation) { operation = operation_; }

void FiberPart::getWorldTransforms(Ogre::Matrix4* transform) const {
  *transform = owner_._getParentNodeFullTransform();
}

Ogre::Real FiberPart::getSquaredViewDepth(const Ogre::Camera* camera) const {
  // Only orders what is transparent.
  const Eigen::Vector3f center = chunk_.box.center();
  return (owner_._getParentNodeFullTransform() * Ogre::Vector3(center.x(), center.y(), center.z()))
      .squaredDistance(camera->getDerivedPosition());
}

const Ogre::LightList& FiberPart::getLights() const { return owner_.queryLights(); }

}  // namespace fiber_proximity_rviz
