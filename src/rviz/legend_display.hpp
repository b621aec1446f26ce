#pragma once

#include <ros/subscriber.h>
#include <rviz/display.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <visualization_msgs/MarkerArray.h>

#include <memory>
#include <vector>

#include "src/ros/outputs/marker_canvas.hpp"
#include "src/rviz/marker_texts.hpp"
#include "src/rviz/text_overlay.hpp"

namespace fiber_proximity_rviz {

/// Tells in a corner of rviz's window what the colours mean, what an answer lacks, and which
/// displays of fibres still wait for their first message. Beside the scene from wherever one looks,
/// as markers cannot be.
class LegendDisplay : public rviz::Display {
 public:
  LegendDisplay();

  void reset() override;
  void update(float wall_dt, float ros_dt) override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private:
  void process(const visualization_msgs::MarkerArrayConstPtr& message) { texts_.take(*message); }
  void subscribe();

  /// The lines to show now.
  std::vector<fiber_proximity_ros::LegendLine> lines() const;

  // rviz owns properties through their parents.
  rviz::RosTopicProperty* topic_;
  rviz::EnumProperty* corner_;
  rviz::IntProperty* text_size_;

  ros::Subscriber subscriber_;
  MarkerTexts texts_;
  std::vector<fiber_proximity_ros::LegendLine> shown_;
  bool is_changed_ = false;  // shown in another way
  std::unique_ptr<TextOverlay> overlay_;
};

}  // namespace fiber_proximity_rviz
