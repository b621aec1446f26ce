#include "src/rviz/display_properties.hpp"

#include <ros/message_traits.h>

#include <initializer_list>

#include "fiber_proximity/ContactArray.h"

namespace fiber_proximity_rviz {
namespace {

template <class Value>
void add_option(rviz::EnumProperty& property, const char* name, Value value) {
  property.addOption(name, static_cast<int>(value));
}

}  // namespace

DisplayProperties::DisplayProperties(rviz::Property& display,
                                     const std::function<void()>& on_style_change,
                                     const std::function<void()>& on_source_change,
                                     const std::function<void()>& on_fit_change)
    : style_(new rviz::EnumProperty(
          "Style", "Automatic",
          "Tubes of the fibres' radii, ribbons that face the viewer, or tubes as long as "
          "there are not too many.",
          &display)),
      sides_(new rviz::IntProperty("Sides", 8, "Corners around a tube.", &display)),
      reduce_detail_(new rviz::BoolProperty("Level of Detail", true,
                                            "Leave out points of ribbons where the picture stays "
                                            "the same but for the pixel error, and "
                                            "draw what is thinner than a pixel as lines.",
                                            &display)),
      pixel_error_(new rviz::FloatProperty(
          "Pixel Error", DetailOptions().pixel_error,
          "[pixels] By at most this much a fiber with fewer points is drawn beside its place.",
          reduce_detail_)),
      color_by_(new rviz::EnumProperty("Color By", "Fiber", "What the colors tell.", &display)),
      color_(new rviz::ColorProperty("Color", QColor(150, 110, 70),
                                     "Of all fibers, or of those without a contact.", &display)),
      contact_topic_(new rviz::RosTopicProperty(
          "Contact Topic", "", ros::message_traits::datatype<fiber_proximity::ContactArray>(),
          "Contacts among these fibers, with the same stamps: ~contacts of the node whose ~fibers "
          "are shown. Their distances color the segments.",
          &display)),
      autocompute_range_(new rviz::BoolProperty(
          "Autocompute Range", true,
          "Radius: from the least to the greatest. Distance: from the contacts' margin to 0.",
          &display)),
      min_value_(new rviz::FloatProperty("Min Value", 0.0F, "[m]", &display)),
      max_value_(new rviz::FloatProperty("Max Value", 0.01F, "[m]", &display)),
      opacity_(new rviz::FloatProperty("Alpha", 1.0F, "0 is invisible, 1 is opaque.", &display)),
      default_radius_(new rviz::FloatProperty(
          "Default Radius", 0.005F, "[m] Of fibers in messages without radii.", &display)),
      fit_view_(new rviz::BoolProperty(
          "Fit View", false,
          "Moves the view to where the first fibers are, and again when there are more, as long as "
          "nobody has moved it.",
          &display)),
      keep_in_view_(new rviz::BoolProperty("Keep in View", false,
                                           "Moves it again when fibers are about to leave it, too.",
                                           fit_view_)) {
  add_option(*style_, "Automatic", Style::automatic);
  add_option(*style_, "Tubes", Style::tubes);
  add_option(*style_, "Ribbons", Style::ribbons);
  add_option(*color_by_, "Fiber", ColorBy::fiber);
  add_option(*color_by_, "Radius", ColorBy::radius);
  add_option(*color_by_, "Distance", ColorBy::distance);
  add_option(*color_by_, "Flat Color", ColorBy::nothing);
  sides_->setMin(3);
  sides_->setMax(32);
  reduce_detail_->setDisableChildrenIfFalse(true);
  fit_view_->setDisableChildrenIfFalse(true);
  pixel_error_->setMin(0.01F);
  opacity_->setMin(0.0F);
  opacity_->setMax(1.0F);
  default_radius_->setMin(0.0F);

  const auto connect = [](std::initializer_list<rviz::Property*> properties,
                          const std::function<void()>& on_change) {
    for (rviz::Property* property : properties) {
      QObject::connect(property, &rviz::Property::changed, property, on_change);
    }
  };
  connect({style_, sides_, reduce_detail_, pixel_error_, color_by_, color_, autocompute_range_,
           min_value_, max_value_, opacity_, default_radius_},
          on_style_change);
  connect({style_, color_by_, autocompute_range_}, [this] { update_visibility(); });
  connect({color_by_, contact_topic_}, on_source_change);
  connect({fit_view_}, on_fit_change);
  update_visibility();
}

void DisplayProperties::update_visibility() {
  const bool has_values = color_by() == ColorBy::radius || color_by() == ColorBy::distance;
  sides_->setHidden(style() == Style::ribbons);
  reduce_detail_->setHidden(style() == Style::tubes);
  color_->setHidden(color_by() != ColorBy::nothing && color_by() != ColorBy::distance);
  contact_topic_->setHidden(color_by() != ColorBy::distance);
  autocompute_range_->setHidden(!has_values);
  min_value_->setHidden(!has_values || autocompute_range_->getBool());
  max_value_->setHidden(!has_values || autocompute_range_->getBool());
}

Color DisplayProperties::color() const {
  const QColor color = color_->getColor();
  return to_color({static_cast<float>(color.redF()), static_cast<float>(color.greenF()),
                   static_cast<float>(color.blueF())},
                  opacity());
}

std::optional<ValueRange> DisplayProperties::range() const {
  if (autocompute_range_->getBool()) {
    return std::nullopt;
  }
  const double min_value = min_value_->getFloat();
  const double max_value = max_value_->getFloat();
  // Red is what to beware of: short distances, but thick fibres.
  return color_by() == ColorBy::distance ? ValueRange{max_value, min_value}
                                         : ValueRange{min_value, max_value};
}

}  // namespace fiber_proximity_rviz
