#pragma once

#include <OgreMaterial.h>

namespace fiber_proximity_rviz {

/// The look of one display's fibres, which Ogre keeps under unique names.
class FiberMaterials {
 public:
  FiberMaterials();
  ~FiberMaterials();
  FiberMaterials(const FiberMaterials&) = delete;
  FiberMaterials& operator=(const FiberMaterials&) = delete;

  const Ogre::MaterialPtr& tubes() const { return tubes_; }
  const Ogre::MaterialPtr& ribbons() const { return ribbons_; }
  /// Look like ribbons that are a pixel wide.
  const Ogre::MaterialPtr& lines() const { return lines_; }

  /// Blends with what is behind, or hides it.
  void set_transparent(bool transparent);

 private:
  Ogre::MaterialPtr tubes_;    // lit by rviz's light
  Ogre::MaterialPtr ribbons_;  // turned to the viewer and lit by shaders; without them plain lines
  Ogre::MaterialPtr lines_;
};

}  // namespace fiber_proximity_rviz
