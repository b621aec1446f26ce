#pragma once

#include <ros/subscriber.h>
#include <rviz/message_filter_display.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/ContactArray.h"
#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/marker_canvas.hpp"
#include "src/rviz/contact_pairing.hpp"
#include "src/rviz/display_properties.hpp"
#include "src/rviz/fiber_mesh.hpp"
#include "src/rviz/view_fit.hpp"

namespace fiber_proximity_rviz {

class FiberRenderable;

/// Shows a FiberArray in rviz: the newest one whenever rviz draws, as finely as is to be seen.
///
/// A message that is malformed, too large or without a transform draws nothing; why stands in the
/// status `Fibers`, contacts that do not fit in the status `Contacts`.
class FiberArrayDisplay : public rviz::MessageFilterDisplay<fiber_proximity::FiberArray> {
 public:
  /// The style `Automatic` draws tubes up to so many vertices, ribbons above.
  static constexpr std::size_t max_automatic_vertices = 1000000;

  FiberArrayDisplay();
  ~FiberArrayDisplay() override;

  void reset() override;
  void update(float wall_dt, float ros_dt) override;

  /// The legend of the fibres' colours, where distances or radii choose them; before the first
  /// message it says that the display waits.
  std::vector<fiber_proximity_ros::LegendLine> legend() const;

 protected:
  void onInitialize() override;
  void subscribe() override;
  void unsubscribe() override;
  void fixedFrameChanged() override;

 private:
  void processMessage(const fiber_proximity::FiberArrayConstPtr& message) override;
  void process_contacts(const fiber_proximity::ContactArrayConstPtr& message);

  /// Subscribes to the topic of contacts that the properties name.
  void subscribe_to_contacts();
  bool wants_contacts() const;

  /// Draws `shown_` anew.
  void draw();
  void fit_view();
  void read_fibers();
  void apply_transform(const std_msgs::Header& header);
  void choose_colors();
  void color_by_distance();
  void show_waiting_status();
  const FiberMesh& make_mesh();

  DisplayProperties properties_;
  ros::Subscriber contact_subscriber_;
  ContactPairing pairing_;
  FibersAndContacts shown_;
  bool is_waiting_ = false;  // the first message has not come
  bool is_new_ = false;      // the transform of `shown_` has not been applied
  bool is_changed_ = false;  // `shown_` has not been drawn as the properties say

  fiber_proximity_ros::FiberBuffer buffer_;
  fiber::FiberAssembly fibers_;
  std::vector<Color> colors_;
  std::optional<ValueRange> shown_range_;  // that colours stand for
  FiberMesher mesher_;
  ViewFitter view_fitter_;
  std::unique_ptr<FiberRenderable> renderable_;
  Ogre::SceneNode* mesh_node_ = nullptr;  // at the mesh's origin, in the fibres' frame
};

}  // namespace fiber_proximity_rviz
