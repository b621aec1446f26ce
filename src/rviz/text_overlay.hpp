#pragma once

#include <string>
#include <vector>

#include "src/ros/outputs/marker_canvas.hpp"

namespace Ogre {
class Overlay;
class PanelOverlayElement;
}  // namespace Ogre

namespace fiber_proximity_rviz {

/// Lines of text in a corner of rviz's window, before all that is drawn there.
class TextOverlay {
 public:
  enum class Corner { bottom_left, bottom_right, top_left, top_right };

  TextOverlay();
  ~TextOverlay();
  TextOverlay(const TextOverlay&) = delete;
  TextOverlay& operator=(const TextOverlay&) = delete;

  /// Shows these lines, each in its colour, one below another; nothing if there are none.
  /// @param height [pixels] of a line's letters
  void show(const std::vector<fiber_proximity_ros::LegendLine>& lines, Corner corner, int height);

 private:
  std::string name_;  // of all that is Ogre's here
  Ogre::Overlay* overlay_;
  Ogre::PanelOverlayElement* panel_;
  std::string texture_;  // its name, empty if there is none; each has another, as of another size
  int texture_count_ = 0;
};

}  // namespace fiber_proximity_rviz
