#pragma once

#include <rviz/properties/bool_property.h>
#include <rviz/properties/color_property.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/float_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>

#include <functional>
#include <optional>
#include <string>

#include "src/rviz/fiber_colors.hpp"
#include "src/rviz/fiber_detail.hpp"

namespace fiber_proximity_rviz {

/// What the user chooses, as rviz shows and saves it below the display.
class DisplayProperties {
 public:
  enum class Style { automatic, tubes, ribbons };
  enum class ColorBy { fiber, radius, distance, nothing };

  /// @param look   called when fibres look different from now on
  /// @param source called when contacts come from elsewhere from now on
  /// @param view   called when the view is to be fitted, or no longer
  DisplayProperties(rviz::Property& display, const std::function<void()>& look,
                    const std::function<void()>& source, const std::function<void()>& view);

  Style style() const { return static_cast<Style>(style_->getOptionInt()); }
  int sides() const { return sides_->getInt(); }
  DetailOptions detail() const { return {reduce_detail_->getBool(), pixel_error_->getFloat()}; }
  ColorBy color_by() const { return static_cast<ColorBy>(color_by_->getOptionInt()); }
  /// Of all fibres, or of those points that have no value to be coloured by; with the opacity.
  Color color() const;
  float opacity() const { return opacity_->getFloat(); }
  bool is_transparent() const { return opacity() < 1.0F; }
  /// Ends that the user has set; nothing if they follow the values.
  std::optional<ValueRange> range() const;
  /// [m] Of messages without radii.
  double default_radius() const { return default_radius_->getFloat(); }
  /// Topic of the contacts whose distances colour fibres.
  std::string contact_topic() const { return contact_topic_->getTopicStd(); }
  /// rviz's view is moved to where the fibres are.
  bool fits_view() const { return fit_view_->getBool(); }
  /// It is moved again when they are about to leave it.
  bool keeps_in_view() const { return keep_in_view_->getBool(); }

 private:
  /// Hides what has no effect.
  void update_visibility();

  // rviz owns properties through their parents.
  rviz::EnumProperty* style_;
  rviz::IntProperty* sides_;
  rviz::BoolProperty* reduce_detail_;
  rviz::FloatProperty* pixel_error_;
  rviz::EnumProperty* color_by_;
  rviz::ColorProperty* color_;
  rviz::RosTopicProperty* contact_topic_;
  rviz::BoolProperty* follow_values_;
  rviz::FloatProperty* least_;
  rviz::FloatProperty* greatest_;
  rviz::FloatProperty* opacity_;
  rviz::FloatProperty* default_radius_;
  rviz::BoolProperty* fit_view_;
  rviz::BoolProperty* keep_in_view_;
};

}  // namespace fiber_proximity_rviz
