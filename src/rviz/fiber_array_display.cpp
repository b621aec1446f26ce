#include "src/rviz/fiber_array_display.hpp"

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/view_manager.h>

#include <cmath>
#include <exception>
#include <limits>
#include <pluginlib/class_list_macros.hpp>
#include <stdexcept>
#include <string>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/support/stopwatch.hpp"
#include "src/rviz/fiber_renderable.hpp"

namespace fiber_proximity_rviz {
namespace {

using fiber_proximity::ContactArrayConstPtr;
using fiber_proximity::FiberArrayConstPtr;
using ColorBy = DisplayProperties::ColorBy;
using Level = rviz::StatusProperty::Level;
using Style = DisplayProperties::Style;

using fiber_proximity_ros::distance_text;
using fiber_proximity_ros::LegendLine;

const char* const fiber_status = "Fibers";
const char* const contact_status = "Contacts";

std::string drawn_text(const fiber::FiberAssembly& fibers, FiberMesh::Kind kind, double seconds) {
  return std::to_string(fibers.fiber_count()) + " fiber(s), " +
         std::to_string(fibers.segment_count()) + " segment(s) as " +
         (kind == FiberMesh::Kind::ribbons ? "ribbons" : "tubes") + " in " +
         std::to_string(std::lround(1e3 * seconds)) + " ms";
}

std::string waiting_text(const std::string& topic) {
  return "waiting for the first message of " + topic;
}

}  // namespace

FiberArrayDisplay::FiberArrayDisplay()
    : properties_(
          *this, [this] { is_changed_ = true; }, [this] { subscribe_to_contacts(); },
          [this] {
            view_fitter_.forget();
            is_changed_ = true;
          }) {}

FiberArrayDisplay::~FiberArrayDisplay() {
  if (mesh_node_ != nullptr) {
    mesh_node_->detachAllObjects();
    scene_manager_->destroySceneNode(mesh_node_);
  }
}

void FiberArrayDisplay::onInitialize() {
  MFDClass::onInitialize();
  renderable_ = std::make_unique<FiberRenderable>();
  mesh_node_ = scene_node_->createChildSceneNode();
  mesh_node_->attachObject(renderable_.get());
}

void FiberArrayDisplay::reset() {
  MFDClass::reset();
  pairing_.clear();
  shown_ = FibersAndContacts();
  if (renderable_ != nullptr) {
    renderable_->clear();
  }
  show_waiting_status();
}

void FiberArrayDisplay::subscribe() {
  MFDClass::subscribe();
  subscribe_to_contacts();
  show_waiting_status();
}

/// A black window beside "Status: Ok" would be a riddle: the first message of many fibres may take
/// its sender half a minute.
void FiberArrayDisplay::show_waiting_status() {
  is_waiting_ = isEnabled() && !topic_property_->getTopicStd().empty();
  if (is_waiting_) {
    setStatusStd(Level::Warn, fiber_status, waiting_text(topic_property_->getTopicStd()));
  }
}

std::vector<LegendLine> FiberArrayDisplay::legend() const {
  const std::string name = getNameStd() + ": ";
  if (is_waiting_) {
    return {{fiber_proximity_ros::palette::within_margin,
             name + waiting_text(topic_property_->getTopicStd())}};
  }
  if (!shown_range_) {
    return {};
  }
  const auto text = [&](double value) {
    return name + (properties_.color_by() == ColorBy::radius ? "radius " + distance_text(value)
                                                             : distance_text(value) + " apart");
  };
  return {{color_map(0.0), text(shown_range_->at_blue)},
          {color_map(1.0), text(shown_range_->at_red)}};
}

void FiberArrayDisplay::unsubscribe() {
  MFDClass::unsubscribe();
  is_waiting_ = false;
  contact_subscriber_.shutdown();
}

void FiberArrayDisplay::fixedFrameChanged() {
  MFDClass::fixedFrameChanged();
  view_fitter_.forget();
}

bool FiberArrayDisplay::wants_contacts() const {
  return properties_.color_by() == ColorBy::distance && !properties_.contact_topic().empty();
}

void FiberArrayDisplay::subscribe_to_contacts() {
  contact_subscriber_.shutdown();
  deleteStatus(contact_status);
  shown_.contacts.reset();
  is_changed_ = true;
  if (!isEnabled() || !wants_contacts()) {
    return;
  }
  try {
    contact_subscriber_ = update_nh_.subscribe(properties_.contact_topic(), 1,
                                               &FiberArrayDisplay::process_contacts, this);
  } catch (const ros::Exception& error) {
    setStatus(Level::Error, contact_status, QString("cannot subscribe: ") + error.what());
  }
}

void FiberArrayDisplay::processMessage(const FiberArrayConstPtr& message) {
  if (wants_contacts()) {
    pairing_.add(message);
  } else {
    shown_ = {message, nullptr};
    is_new_ = true;
  }
}

void FiberArrayDisplay::process_contacts(const ContactArrayConstPtr& message) {
  pairing_.add(message);
}

void FiberArrayDisplay::update(float wall_dt, float /*ros_dt*/) {
  if (wants_contacts()) {
    const FibersAndContacts ready = pairing_.take(wall_dt);
    if (ready.fibers) {
      shown_ = ready;
      is_new_ = true;
    }
  }
  if (shown_.fibers && (is_new_ || is_changed_)) {
    draw();
    context_->queueRender();
  }
  if (renderable_ != nullptr && !renderable_->failure().empty()) {
    setStatusStd(Level::Error, fiber_status, renderable_->failure());
  }
}

void FiberArrayDisplay::draw() {
  is_waiting_ = false;
  try {
    const fiber_proximity_ros::Stopwatch stopwatch;
    if (is_new_) {  // the transform of an old stamp may be forgotten
      apply_transform(shown_.fibers->header);
    }
    read_fibers();
    if (properties_.fits_view()) {
      fit_view();
    }
    choose_colors();
    const FiberMesh& mesh = make_mesh();
    renderable_->set_transparent(properties_.is_transparent());
    if (mesh.kind == FiberMesh::Kind::tubes) {
      renderable_->show_tubes(mesh);
    } else {
      renderable_->show_ribbons(mesh, fibers_.points(), make_chunks(fibers_, mesh.origin),
                                properties_.detail());
    }
    mesh_node_->setPosition(static_cast<float>(mesh.origin.x()),
                            static_cast<float>(mesh.origin.y()),
                            static_cast<float>(mesh.origin.z()));
    setStatusStd(Level::Ok, fiber_status, drawn_text(fibers_, mesh.kind, stopwatch.seconds()));
  } catch (const std::exception& error) {
    renderable_->clear();
    setStatusStd(Level::Error, fiber_status, error.what());
  }
  is_new_ = false;
  is_changed_ = false;
}

void FiberArrayDisplay::fit_view() {
  const Ogre::Vector3& position = scene_node_->getPosition();
  const Ogre::Quaternion& orientation = scene_node_->getOrientation();
  const Eigen::Isometry3d pose =
      Eigen::Translation3d(position.x, position.y, position.z) *
      Eigen::Quaterniond(orientation.w, orientation.x, orientation.y, orientation.z);
  view_fitter_.fit(*context_->getViewManager()->getCurrent(), fixed_frame_.toStdString(), fibers_,
                   pose, properties_.keeps_in_view());
}

void FiberArrayDisplay::read_fibers() {
  to_chains(*shown_.fibers, buffer_);
  if (buffer_.radii.empty()) {
    buffer_.radii = {properties_.default_radius()};
  }
  assign(buffer_, fibers_);
}

void FiberArrayDisplay::apply_transform(const std_msgs::Header& header) {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  if (!context_->getFrameManager()->getTransform(header, position, orientation)) {
    throw std::runtime_error("no transform from frame '" + header.frame_id + "' to '" +
                             fixed_frame_.toStdString() + "' at the message's stamp");
  }
  scene_node_->setPosition(position);
  scene_node_->setOrientation(orientation);
}

void FiberArrayDisplay::choose_colors() {
  shown_range_.reset();
  switch (properties_.color_by()) {
    case ColorBy::fiber:
      color_by_fiber(fibers_, properties_.opacity(), colors_);
      return;
    case ColorBy::radius: {
      const std::vector<std::optional<double>> radii = radii_of_points(fibers_);
      const std::optional<ValueRange> range = properties_.range();
      shown_range_ = range ? *range : range_of(radii);
      color_by_value(radii, *shown_range_, properties_.color(), colors_);
      return;
    }
    case ColorBy::distance:
      color_by_distance();
      return;
    case ColorBy::nothing:
      color_flat(fibers_, properties_.color(), colors_);
      return;
  }
}

void FiberArrayDisplay::color_by_distance() {
  colors_.assign(fibers_.point_count(), properties_.color());
  if (properties_.contact_topic().empty()) {
    setStatus(Level::Warn, contact_status, "no contact topic");
    return;
  }
  if (!shown_.contacts) {
    setStatus(Level::Warn, contact_status, "no contacts with the stamp of these fibers");
    return;
  }
  const ContactArrayConstPtr& contacts = shown_.contacts;
  try {
    const std::optional<ValueRange> range = properties_.range();
    // Without a margin contacts penetrate; then they are all red.
    const double margin = std::isfinite(contacts->margin) ? contacts->margin : 0.0;
    shown_range_ = range ? *range : ValueRange{std::max(margin, 1e-9), 0.0};
    color_by_value(distances_of_points(fibers_, *contacts), *shown_range_, properties_.color(),
                   colors_);
    setStatus(Level::Ok, contact_status,
              QString::number(contacts->contacts.size()) + " contact(s)");
  } catch (const std::invalid_argument& error) {
    setStatus(Level::Error, contact_status, error.what());
  }
}

const FiberMesh& FiberArrayDisplay::make_mesh() {
  const int sides = properties_.sides();
  const std::size_t min_vertices = fibers_.point_count() * static_cast<std::size_t>(sides);
  const bool as_tubes =
      properties_.style() == Style::tubes ||
      (properties_.style() == Style::automatic && min_vertices <= max_automatic_vertices);
  return as_tubes ? mesher_.make_tubes(fibers_, colors_, sides)
                  : mesher_.make_ribbons(fibers_, colors_);
}

}  // namespace fiber_proximity_rviz

PLUGINLIB_EXPORT_CLASS(fiber_proximity_rviz::FiberArrayDisplay, rviz::Display)
