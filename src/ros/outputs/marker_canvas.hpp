#pragma once

#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/ros/outputs/palette.hpp"

namespace fiber_proximity_ros {

std_msgs::ColorRGBA color(const Rgb& rgb, float a = 1.0F);

/// A distance [m] as texts have it, in mm.
std::string distance_text(double distance);

/// Lengths that annotations are measured in [m].
struct MarkerScale {
  /// @param frame of the fibres, which tells what is up
  MarkerScale(const fiber::FiberAssembly& fibers, const std::string& frame);

  /// Middle of the box's lower side.
  Eigen::Vector3d bottom() const { return top - std::abs(up.dot(box.sizes())) * up; }

  /// Unit vector that is level, and to the right for whoever looks from the front.
  static Eigen::Vector3d side() { return Eigen::Vector3d::UnitX(); }

  /// Unit vector towards whoever looks at them as the views of this package do: −y, or the camera.
  Eigen::Vector3d front() const;

  /// Below the fibres, and in front of them: what lies here lies across none of them for whoever
  /// looks from the front, from above, too.
  /// @param distance [m] both ways
  Eigen::Vector3d below_in_front(double distance) const;

  double thickest = 0.0;                                      ///< largest radius
  double thinnest = std::numeric_limits<double>::infinity();  ///< smallest radius
  double extent = 0.0;                                        ///< longest side of the box
  Eigen::Vector3d up;                             ///< unit vector: z, or −y in an optical frame
  Eigen::Vector3d top = Eigen::Vector3d::Zero();  ///< middle of the box's upper side
  Eigen::AlignedBox3d box;                        ///< around the points
};

/// Where a text is.
struct PlacedText {
  Eigen::Vector3d middle;  ///< [m]
  double height;           ///< [m] of its letters
  std::size_t letters;
};

/// A line of the legend: the meaning of a colour.
struct LegendLine {
  Rgb color;
  std::string text;
};

/// Hands out the markers of one update and keeps count of them: those of each namespace have the
/// ids 0, 1, …
class MarkerCanvas {
 public:
  using Counts = std::map<std::string, std::int32_t>;  ///< of markers, by namespace

  /// Holds references: they must outlive it.
  /// @param markers overwritten; their memory is reused
  MarkerCanvas(const std_msgs::Header& header, visualization_msgs::MarkerArray& markers)
      : header_(header), markers_(markers.markers) {}

  /// The next marker of this namespace, white, without points.
  visualization_msgs::Marker& add(const std::string& ns, int type);

  /// A text that faces the viewer.
  /// @param height [m] of its letters
  visualization_msgs::Marker& add_text(const std::string& ns, double height,
                                       const Eigen::Vector3d& position, const std::string& text);

  /// Texts that are drawn already.
  const std::vector<PlacedText>& texts() const { return texts_; }

  /// A thin line from what a text is about towards it.
  void add_leader(const std::string& ns, const MarkerScale& scale, const Eigen::Vector3d& point,
                  const Eigen::Vector3d& end);

  /// Lines of text below what is drawn and in front of it, of the namespace `legend`.
  void add_legend(const std::vector<LegendLine>& legend, const MarkerScale& scale);

  /// Deletes what was drawn and has not been drawn again; remembers what has.
  void finish(Counts& drawn);

 private:
  visualization_msgs::Marker& take(const std::string& ns, std::int32_t id, int action);

  const std_msgs::Header& header_;
  std::vector<visualization_msgs::Marker>& markers_;
  std::size_t used_ = 0;
  Counts counts_;
  std::vector<PlacedText> texts_;
};

/// Appends a line to a LINE_LIST that has a colour for each point.
void append_line(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                 const std_msgs::ColorRGBA& color, visualization_msgs::Marker& lines);

}  // namespace fiber_proximity_ros
