#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "fiber_proximity/ProximityConfig.h"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/inputs/input_source.hpp"
#include "src/ros/outputs/markers.hpp"

namespace fiber_proximity_ros {
namespace {

using XmlRpc::XmlRpcValue;

XmlRpcValue entry(const std::function<void(XmlRpcValue&)>& change = [](XmlRpcValue&) {}) {
  XmlRpcValue value;
  value["topic"] = "cable";
  change(value);
  return value;
}

std::string error_of(const XmlRpcValue& value) {
  try {
    read_input_options(value, 0.25);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

TEST(InputOptions, ATopicIsEnough) {
  const InputOptions options = read_input_options(entry(), 0.25);
  EXPECT_EQ(options.topic, "cable");
  EXPECT_EQ(options.type, "fiber_proximity/FiberArray");
  EXPECT_EQ(options.name, "cable");
  EXPECT_EQ(options.radius, 0.25);
  EXPECT_EQ(options.uncertainty, 0.0);
  EXPECT_EQ(options.missing_points, MissingPoints::REFUSE);
}

TEST(InputOptions, EveryKeyIsRead) {
  const InputOptions options = read_input_options(entry([](XmlRpcValue& value) {
                                                    value["type"] = "visualization_msgs/Marker";
                                                    value["name"] = "left";
                                                    value["radius"] = 1;
                                                    value["uncertainty"] = 0.002;
                                                    value["missing_points"] = "split";
                                                    value["namespace"] = "state";
                                                    value["radius_from_marker"] = true;
                                                    value["weld_tolerance"] = 0.5;
                                                  }),
                                                  0.25);
  EXPECT_EQ(options.type, "visualization_msgs/Marker");
  EXPECT_EQ(options.name, "left");
  EXPECT_EQ(options.radius, 1.0);
  EXPECT_EQ(options.uncertainty, 0.002);
  EXPECT_EQ(options.missing_points, MissingPoints::SPLIT);
  EXPECT_EQ(options.marker.marker_namespace, "state");
  EXPECT_TRUE(options.marker.radius_from_marker);
  EXPECT_EQ(options.marker.weld_tolerance, 0.5);
}

TEST(InputOptions, EveryErrorNamesKeyValueAndWhatIsAllowed) {
  const auto error_with = [](const std::string& key, const XmlRpcValue& bad) {
    return error_of(entry([&](XmlRpcValue& value) { value[key] = bad; }));
  };
  EXPECT_EQ(error_of(XmlRpcValue("cable")),
            "is cable, it must be a map with the key 'topic' at least");
  EXPECT_EQ(error_of(entry([](XmlRpcValue& value) {
              XmlRpcValue other;
              other["type"] = "nav_msgs/Path";
              value = other;
            })),
            "has no key 'topic'");
  EXPECT_EQ(error_with("topic", 7), "key 'topic' is 7, it must be a string");
  EXPECT_EQ(
      error_with("colour", "red"),
      "has the unknown key 'colour', known are: topic, type, name, radius, uncertainty, "
      "close_rings, missing_points, required, max_pairs, max_time, namespace, radius_from_marker, "
      "weld_tolerance");
  EXPECT_EQ(error_with("type", "std_msgs/String"),
            "unknown input type 'std_msgs/String', known are: fiber_proximity/FiberArray, "
            "sensor_msgs/PointCloud2, sensor_msgs/PointCloud, geometry_msgs/PoseArray, "
            "nav_msgs/Path, visualization_msgs/Marker, visualization_msgs/MarkerArray");
  EXPECT_EQ(error_with("radius", "thick"),
            "key 'radius' is thick, it must be a number from 0 to 1e+150");
  EXPECT_EQ(error_with("radius", -1), "key 'radius' is -1, it must be a number from 0 to 1e+150");
  EXPECT_EQ(error_with("radius", std::numeric_limits<double>::quiet_NaN()),
            "key 'radius' is nan, it must be a number from 0 to 1e+150");
  for (const XmlRpcValue& bad : {XmlRpcValue("drop"), XmlRpcValue("")}) {
    EXPECT_EQ(error_with("missing_points", bad), "key 'missing_points' is " + std::string(bad) +
                                                     ", it must be one of refuse, bridge, split");
  }
  EXPECT_EQ(error_with("missing_points", true),
            "key 'missing_points' is true, it must be one of refuse, bridge, split");
  EXPECT_EQ(error_with("namespace", "state"),
            "key 'namespace' is for markers only, not for type 'fiber_proximity/FiberArray'");
  EXPECT_EQ(error_with("radius_from_marker", 1),
            "key 'radius_from_marker' is 1, it must be true or false");
  EXPECT_EQ(error_with("weld_tolerance", -0.5),
            "key 'weld_tolerance' is -0.5, it must be a number from 0 to 1e+150");
}

TEST(DynamicParameters, DefaultsAreThoseOfTheOptions) {
  const auto& config = fiber_proximity::ProximityConfig::__getDefault__();
  const fiber::QueryOptions query;
  EXPECT_EQ(fiber::query_type_from_name(config.query_type), query.type);
  EXPECT_EQ(config.margin, query.margin);
  EXPECT_EQ(config.max_contacts, static_cast<int>(query.max_contacts));
  EXPECT_EQ(query.contact_limit, 0U);  // the node alone has to answer whatever comes
  EXPECT_EQ(query.pair_limit, 0U);
  EXPECT_GT(config.contact_limit, 0);
  EXPECT_GT(config.pair_limit, config.contact_limit);
  EXPECT_EQ(config.neighbour_skip, -1);
  EXPECT_EQ(config.neighbour_skip_length, -1.0);
  EXPECT_FALSE(query.neighbour_skip);
  EXPECT_FALSE(query.neighbour_skip_length);
  const MarkerOptions markers;
  EXPECT_EQ(config.show_fibers, markers.show_fibers);
  EXPECT_EQ(config.show_contacts, markers.show_contacts);
  EXPECT_EQ(config.show_nearest, markers.show_nearest);
  EXPECT_EQ(config.show_boxes, markers.show_boxes);
  EXPECT_EQ(config.show_crossings, markers.show_crossings);
  EXPECT_EQ(config.show_names, markers.show_names);
  EXPECT_EQ(config.show_legend, markers.show_legend);
  EXPECT_EQ(config.box_level, static_cast<int>(markers.level));
}

}  // namespace
}  // namespace fiber_proximity_ros
