#pragma once

#include <OgreMovableObject.h>

#include <memory>
#include <string>
#include <vector>

#include "src/rviz/fiber_detail.hpp"
#include "src/rviz/fiber_materials.hpp"
#include "src/rviz/fiber_mesh.hpp"

namespace fiber_proximity_rviz {

class FiberPart;

/// Fibres in the graphics card's memory: vertices once, and for each chunk that has been in view
/// which of them are drawn, as finely as was to be seen.
class FiberRenderable : public Ogre::MovableObject {
 public:
  FiberRenderable();
  ~FiberRenderable() override;
  FiberRenderable(const FiberRenderable&) = delete;
  FiberRenderable& operator=(const FiberRenderable&) = delete;

  /// Fibres blend with what is behind, or hide it.
  void set_transparent(bool transparent) { materials_.set_transparent(transparent); }

  /// Replaces what is drawn.
  /// @throws Ogre::Exception if the card has no memory for it
  void show_tubes(const FiberMesh& mesh);
  /// Mesh and points must stay as they are until it shows something else.
  void show_ribbons(const FiberMesh& mesh, const std::vector<Eigen::Vector3d>& points,
                    const std::vector<FiberChunk>& chunks, const DetailOptions& options);
  void clear();

  /// Why the last picture lacks fibres; empty if it does not.
  const std::string& failure() const { return failure_; }

  const Ogre::AxisAlignedBox& getBoundingBox() const override { return box_; }
  Ogre::Real getBoundingRadius() const override;
  const Ogre::String& getMovableType() const override;
  /// Chooses what of the chunks this camera sees is drawn.
  void _notifyCurrentCamera(Ogre::Camera* camera) override;
  void _updateRenderQueue(Ogre::RenderQueue* queue) override;
  void visitRenderables(Ogre::Renderable::Visitor* visitor, bool debug) override;

 private:
  void set_vertices(const FiberMesh& mesh);
  void cull_parts(const Ogre::Camera& camera);

  FiberMaterials materials_;
  std::unique_ptr<Ogre::VertexData> vertices_;
  Ogre::AxisAlignedBox box_;
  std::vector<std::unique_ptr<FiberPart>> parts_;
  const std::vector<Eigen::Vector3d>* points_ = nullptr;  // of ribbons
  DetailOptions options_;
  std::vector<FiberPart*> visible_parts_;
  std::string failure_;
};

}  // namespace fiber_proximity_rviz
