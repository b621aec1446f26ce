#include "src/rviz/fiber_renderable.hpp"

#include <OgreCamera.h>
#include <OgreHardwareBufferManager.h>
#include <OgreMath.h>
#include <OgreRenderQueue.h>
#include <OgreRenderable.h>
#include <OgreVertexIndexData.h>
#include <OgreViewport.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <map>
#include <utility>

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

/// Capacity for what is needed now and a little more.
std::size_t with_reserve(std::size_t count) { return count + count / 8; }

Ogre::AxisAlignedBox to_ogre(const Eigen::AlignedBox3f& box) {
  return {box.min().x(), box.min().y(), box.min().z(), box.max().x(), box.max().y(), box.max().z()};
}

/// How much of the world a pixel covers, as the shader of ribbons computes it.
class PixelSize {
 public:
  /// @param world where boxes are: as Ogre's own, of 1.9 or 1.12
  template <class Transform>
  PixelSize(const Ogre::Camera& camera, const Transform& world) {
    const Ogre::Matrix4& projection = camera.getProjectionMatrix();
    const Ogre::Matrix4 clip = projection * Ogre::Matrix4(camera.getViewMatrix() * world);
    for (int i = 0; i < 4; ++i) {
      depth_[i] = static_cast<double>(clip[3][i]);
    }
    const bool parallel_rays = projection[3][3] == 1.0F;
    min_depth_ = parallel_rays ? 1.0 : static_cast<double>(camera.getNearClipDistance());
    scale_ = 2.0 / std::abs(static_cast<double>(projection[1][1])) /
             camera.getViewport()->getActualHeight();
  }

  /// [m] at the nearest place of the box that can be seen, above 0
  double at(const Eigen::AlignedBox3f& box) const {
    double depth = depth_[3];
    for (int i = 0; i < 3; ++i) {
      depth += std::min(depth_[i] * static_cast<double>(box.min()[i]),
                        depth_[i] * static_cast<double>(box.max()[i]));
    }
    return std::max(scale_ * std::max(depth, min_depth_), std::numeric_limits<double>::min());
  }

 private:
  double depth_[4];  // [m] by place: a plane
  double min_depth_;
  double scale_;  // pixel's size by depth
};

}  // namespace

/// One draw call on the vertices that all parts share. A chunk of ribbons keeps the index buffers
/// it has been drawn with, for the next time it is seen from as far.
class FiberPart : public Ogre::Renderable {
 public:
  /// All must outlive it.
  FiberPart(const Ogre::MovableObject& owner, Ogre::VertexData& vertices,
            const FiberMaterials& materials)
      : owner_(owner), materials_(materials), material_(&materials.tubes()) {
    operation_.vertexData = &vertices;
    operation_.useIndexes = true;
  }

  /// @throws Ogre::Exception if the card has no memory for it
  void show_tubes(const FiberMesh& mesh) {
    std::unique_ptr<Ogre::IndexData>& all = levels_[Detail()];
    all = upload(mesh.indices);
    operation_.indexData = all.get();
    operation_.operationType = Operation::OT_TRIANGLE_LIST;
    chunk_.box = mesh.box;
  }

  /// Sets what show() is about; draws nothing yet.
  void set_chunk(const FiberMesh& mesh, FiberChunk chunk) {
    mesh_ = &mesh;
    chunk_ = std::move(chunk);
  }
  const FiberChunk& chunk() const { return chunk_; }

  /// Has to be asked for before show() by this detail; any number of parts at once may be.
  void prepare(const std::vector<Eigen::Vector3d>& points, const Detail& detail) {
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

  /// Draws the chunk by the detail of the last prepare().
  /// @throws Ogre::Exception if the card has no memory for it
  void show() {
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

  const Ogre::MaterialPtr& getMaterial() const override { return *material_; }
  void getRenderOperation(Ogre::RenderOperation& operation) override { operation = operation_; }
  void getWorldTransforms(Ogre::Matrix4* transform) const override {
    *transform = owner_._getParentNodeFullTransform();
  }
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override {
    // Only orders what is transparent.
    const Eigen::Vector3f center = chunk_.box.center();
    return (owner_._getParentNodeFullTransform() *
            Ogre::Vector3(center.x(), center.y(), center.z()))
        .squaredDistance(camera->getDerivedPosition());
  }
  const Ogre::LightList& getLights() const override { return owner_.queryLights(); }

 private:
  const Ogre::MovableObject& owner_;
  const FiberMaterials& materials_;
  Ogre::RenderOperation operation_;
  const Ogre::MaterialPtr* material_;

  const FiberMesh* mesh_ = nullptr;
  FiberChunk chunk_;
  std::map<Detail, std::unique_ptr<Ogre::IndexData>> levels_;
  std::map<Detail::Kind, int> all_points_;  // up to this level, where few could be left out
  Detail detail_;
  std::vector<std::uint32_t> indices_;  // of it, if they are not among levels_
};

FiberRenderable::FiberRenderable() : vertices_(std::make_unique<Ogre::VertexData>()) {
  Ogre::VertexDeclaration& layout = *vertices_->vertexDeclaration;
  layout.addElement(0, offsetof(MeshVertex, position), Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  layout.addElement(0, offsetof(MeshVertex, direction), Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  layout.addElement(0, offsetof(MeshVertex, color), Ogre::VET_COLOUR_ABGR, Ogre::VES_DIFFUSE);
  layout.addElement(0, offsetof(MeshVertex, offset), Ogre::VET_FLOAT1,
                    Ogre::VES_TEXTURE_COORDINATES);
}

FiberRenderable::~FiberRenderable() = default;

void FiberRenderable::clear() {
  parts_.clear();
  visible_parts_.clear();
  points_ = nullptr;
  failure_.clear();
  box_.setNull();
}

void FiberRenderable::set_vertices(const FiberMesh& mesh) {
  Ogre::VertexBufferBinding& binding = *vertices_->vertexBufferBinding;
  if (!binding.isBufferBound(0) || binding.getBuffer(0)->getNumVertices() < mesh.vertices.size()) {
    binding.unsetAllBindings();  // frees the old one first
    binding.setBinding(0, Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(
                              sizeof(MeshVertex), with_reserve(mesh.vertices.size()),
                              Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE));
  }
  binding.getBuffer(0)->writeData(0, sizeof(MeshVertex) * mesh.vertices.size(),
                                  mesh.vertices.data(), true);
  vertices_->vertexStart = 0;
  vertices_->vertexCount = mesh.vertices.size();
}

void FiberRenderable::show_tubes(const FiberMesh& mesh) {
  clear();  // if anything below throws
  if (mesh.vertices.empty()) {
    return;
  }
  set_vertices(mesh);
  auto part = std::make_unique<FiberPart>(*this, *vertices_, materials_);
  part->show_tubes(mesh);
  parts_.push_back(std::move(part));
  box_ = to_ogre(mesh.box);
}

void FiberRenderable::show_ribbons(const FiberMesh& mesh,
                                   const std::vector<Eigen::Vector3d>& points,
                                   const std::vector<FiberChunk>& chunks,
                                   const DetailOptions& options) {
  clear();
  if (mesh.vertices.empty()) {
    return;
  }
  set_vertices(mesh);
  for (const FiberChunk& chunk : chunks) {
    parts_.push_back(std::make_unique<FiberPart>(*this, *vertices_, materials_));
    parts_.back()->set_chunk(mesh, chunk);
  }
  points_ = &points;
  options_ = options;
  box_ = to_ogre(mesh.box);
}

void FiberRenderable::_notifyCurrentCamera(Ogre::Camera* camera) {
  Ogre::MovableObject::_notifyCurrentCamera(camera);
  visible_parts_.clear();
  failure_.clear();
  try {
    cull_parts(*camera);
  } catch (const std::exception& error) {  // no memory for it; rviz would end
    visible_parts_.clear();
    failure_ = error.what();
  }
}

void FiberRenderable::cull_parts(const Ogre::Camera& camera) {
  const auto& world = _getParentNodeFullTransform();
  for (const std::unique_ptr<FiberPart>& part : parts_) {
    Ogre::AxisAlignedBox box = to_ogre(part->chunk().box);
    box.transform(world);
    if (camera.isVisible(box)) {
      visible_parts_.push_back(part.get());
    }
  }
  if (points_ == nullptr) {  // tubes
    return;
  }
  const PixelSize pixel(camera, world);
  tbb::parallel_for(std::size_t{0}, visible_parts_.size(), [&](std::size_t i) {
    const FiberChunk& chunk = visible_parts_[i]->chunk();
    visible_parts_[i]->prepare(*points_, choose_detail(chunk, pixel.at(chunk.box), options_));
  });
  for (FiberPart* part : visible_parts_) {
    part->show();
  }
}

void FiberRenderable::_updateRenderQueue(Ogre::RenderQueue* queue) {
  for (FiberPart* part : visible_parts_) {
    queue->addRenderable(part, mRenderQueueID, OGRE_RENDERABLE_DEFAULT_PRIORITY);
  }
}

void FiberRenderable::visitRenderables(Ogre::Renderable::Visitor* visitor, bool /*debug*/) {
  for (const std::unique_ptr<FiberPart>& part : parts_) {
    visitor->visit(part.get(), 0, false);
  }
}

Ogre::Real FiberRenderable::getBoundingRadius() const {
  return box_.isFinite() ? Ogre::Math::boundingRadiusFromAABB(box_) : 0.0F;
}

const Ogre::String& FiberRenderable::getMovableType() const {
  static const Ogre::String type = "FiberRenderable";
  return type;
}

}  // namespace fiber_proximity_rviz
