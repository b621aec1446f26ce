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

/// The properties that the user sets in rviz below the display, and that rviz saves.
class DisplayProperties {
 public:
  enum class Style { automatic, tubes, ribbons };
  enum class ColorBy { fiber, radius, distance, nothing };

  /// @param on_style_change  called when the fibres' appearance has changed
  /// @param on_source_change called when contacts come from another topic from now on
  /// @param on_fit_change    called when fitting of the view has been switched on or off
  DisplayProperties(rviz::Property& display, const std::function<void()>& on_style_change,
                    const std::function<void()>& on_source_change,
                    const std::function<void()>& on_fit_change);

  Style style() const { return static_cast<Style>(style_->getOptionInt()); }
  int sides() const { return sides_->getInt(); }
  DetailOptions detail() const { return {reduce_detail_->getBool(), pixel_error_->getFloat()}; }
  ColorBy color_by() const { return static_cast<ColorBy>(color_by_->getOptionInt()); }
  /// The colour, with the opacity, of all fibres, or of those points that have no value to be
  /// coloured by.
  Color color() const;
  float opacity() const { return opacity_->getFloat(); }
  bool is_transparent() const { return opacity() < 1.0F; }
  /// The range that the user has set; nothing if it follows the values.
  std::optional<ValueRange> range() const;
  /// The radius [m] of fibres in messages without radii.
  double default_radius() const { return default_radius_->getFloat(); }
  /// Topic of the contacts whose distances colour fibres.
  std::string contact_topic() const { return contact_topic_->getTopicStd(); }
  /// Whether rviz's view is moved to where the fibres are.
  bool fits_view() const { return fit_view_->getBool(); }
  /// Whether the view is moved again when the fibres are about to leave it.
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
  rviz::BoolProperty* autocompute_range_;
  rviz::FloatProperty* min_value_;
  rviz::FloatProperty* max_value_;
  rviz::FloatProperty* opacity_;
  rviz::FloatProperty* default_radius_;
  rviz::BoolProperty* fit_view_;
  rviz::BoolProperty* keep_in_view_;
};

}  // namespace fiber_proximity_rviz
