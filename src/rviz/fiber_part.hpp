#pragma once

#include <OgreMovableObject.h>
#include <OgreRenderable.h>
#include <OgreVertexIndexData.h>

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "src/rviz/fiber_chunks.hpp"
#include "src/rviz/fiber_detail.hpp"

namespace fiber_proximity_rviz {

class FiberMaterials;

/// What one call draws of the vertices that all parts share. A chunk of ribbons keeps what it has
/// been drawn as, for the next time it is seen from as far.
class FiberPart : public Ogre::Renderable {
 public:
  /// All must outlive it.
  FiberPart(const Ogre::MovableObject& owner, Ogre::VertexData& vertices,
            const FiberMaterials& materials);

  /// @throws Ogre::Exception if the card has no memory for it
  void show_tubes(const FiberMesh& mesh);

  /// Sets what show() is about; draws nothing yet.
  void set_chunk(const FiberMesh& mesh, FiberChunk chunk);
  const FiberChunk& chunk() const { return chunk_; }

  /// Has to be asked for before show() by this detail; any number of parts at once may be.
  void prepare(const std::vector<Eigen::Vector3d>& points, const Detail& detail);
  /// Draws the chunk by the detail of the last prepare().
  /// @throws Ogre::Exception if the card has no memory for it
  void show();

  const Ogre::MaterialPtr& getMaterial() const override;
  void getRenderOperation(Ogre::RenderOperation& operation) override;
  void getWorldTransforms(Ogre::Matrix4* transform) const override;
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override;
  const Ogre::LightList& getLights() const override;

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

}  // namespace fiber_proximity_rviz
