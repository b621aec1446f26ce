#include "src/rviz/legend_display.hpp"

#include <ros/message_traits.h>
#include <rviz/display_context.h>
#include <rviz/display_group.h>

#include <algorithm>
#include <pluginlib/class_list_macros.hpp>

#include "src/rviz/fiber_array_display.hpp"

namespace fiber_proximity_rviz {
namespace {

using Corner = TextOverlay::Corner;
using fiber_proximity_ros::LegendLine;
using Level = rviz::StatusProperty::Level;

const char* const topic_status = "Topic";

/// Appends the legends of the displays of fibres in a group.
void append_legends(const rviz::DisplayGroup& group, std::vector<LegendLine>& lines) {
  for (int i = 0; i < group.numDisplays(); ++i) {
    const rviz::Display* display = group.getDisplayAt(i);
    if (!display->isEnabled()) {
      continue;
    }
    if (const auto* inner = dynamic_cast<const rviz::DisplayGroup*>(display)) {
      append_legends(*inner, lines);
    } else if (const auto* fibers = dynamic_cast<const FiberArrayDisplay*>(display)) {
      const std::vector<LegendLine> more = fibers->legend();
      lines.insert(lines.end(), more.begin(), more.end());
    }
  }
}

}  // namespace

LegendDisplay::LegendDisplay()
    : topic_(new rviz::RosTopicProperty(
          "Marker Topic", "", ros::message_traits::datatype<visualization_msgs::MarkerArray>(),
          "Markers of which the namespaces legend and incomplete are shown, e.g. ~markers of "
          "proximity_node with show_legend, or ~force_markers of cable_sim.",
          this)),
      corner_(new rviz::EnumProperty("Corner", "Bottom Left", "Of the window.", this)),
      text_size_(new rviz::IntProperty("Text Size", 15, "[pixels]", this)) {
  corner_->addOption("Bottom Left", static_cast<int>(Corner::bottom_left));
  corner_->addOption("Bottom Right", static_cast<int>(Corner::bottom_right));
  corner_->addOption("Top Left", static_cast<int>(Corner::top_left));
  corner_->addOption("Top Right", static_cast<int>(Corner::top_right));
  text_size_->setMin(6);
  text_size_->setMax(100);
  QObject::connect(topic_, &rviz::Property::changed, topic_, [this] { subscribe(); });
  for (rviz::Property* property :
       {static_cast<rviz::Property*>(corner_), static_cast<rviz::Property*>(text_size_)}) {
    QObject::connect(property, &rviz::Property::changed, property, [this] { is_changed_ = true; });
  }
}

void LegendDisplay::onInitialize() { overlay_ = std::make_unique<TextOverlay>(); }

void LegendDisplay::onEnable() { subscribe(); }

void LegendDisplay::onDisable() {
  subscribe();
  shown_.clear();
  overlay_->show(shown_, Corner::bottom_left, text_size_->getInt());
}

void LegendDisplay::reset() {
  rviz::Display::reset();
  texts_.clear();
}

void LegendDisplay::subscribe() {
  subscriber_.shutdown();
  texts_.clear();
  deleteStatus(topic_status);
  if (!isEnabled() || topic_->getTopicStd().empty()) {
    return;
  }
  try {
    subscriber_ = update_nh_.subscribe(topic_->getTopicStd(), 5, &LegendDisplay::process, this);
    setStatus(Level::Ok, topic_status, "OK");
  } catch (const ros::Exception& error) {
    setStatus(Level::Error, topic_status, QString("cannot subscribe: ") + error.what());
  }
}

std::vector<LegendLine> LegendDisplay::lines() const {
  std::vector<LegendLine> lines = texts_.lines();
  append_legends(*context_->getRootDisplayGroup(), lines);
  return lines;
}

void LegendDisplay::update(float /*wall_dt*/, float /*ros_dt*/) {
  std::vector<LegendLine> now = lines();
  const auto are_alike = [](const LegendLine& a, const LegendLine& b) {
    return a.color == b.color && a.text == b.text;
  };
  if (!is_changed_ && std::equal(now.begin(), now.end(), shown_.begin(), shown_.end(), are_alike)) {
    return;
  }
  shown_ = std::move(now);
  is_changed_ = false;
  overlay_->show(shown_, static_cast<Corner>(corner_->getOptionInt()), text_size_->getInt());
  context_->queueRender();
}

}  // namespace fiber_proximity_rviz

PLUGINLIB_EXPORT_CLASS(fiber_proximity_rviz::LegendDisplay, rviz::Display)
