#include "fiber_proximity/ros/conversions.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "src/ros/inputs/point_messages.hpp"
#include "test/ros/messages.hpp"

namespace fiber_proximity_ros {
namespace {

using test_messages::header;
using test_messages::Points;

const Points& three_points() {
  static const Points points{{0.125, -1.0, 2.5}, {0.25, 0.5, 2.0}, {1.0, 0.75, -3.0}};
  return points;
}

std::string error_of(const std::function<void()>& function) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

void expect_one_fiber(const FiberBuffer& buffer) {
  EXPECT_EQ(buffer.header.frame_id, "camera");
  EXPECT_EQ(buffer.header.stamp, ros::Time(3, 4));
  EXPECT_EQ(buffer.points, three_points());
  EXPECT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 3}));
  EXPECT_TRUE(buffer.radii.empty());
  EXPECT_TRUE(buffer.names.empty());
}

TEST(Conversions, AnAssemblyComesBackFromItsMessage) {
  const fiber::FiberAssembly fibers({{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}}, {0, 2, 4},
                                    {0.5, 0.25});
  fiber_proximity::FiberArray message;
  to_message(fibers, {"left", "right"}, message);
  FiberBuffer buffer;
  to_chains(message, buffer);
  EXPECT_EQ(buffer.points, fibers.points());
  EXPECT_EQ(buffer.offsets, fibers.offsets());
  EXPECT_EQ(buffer.radii, fibers.radii());
  EXPECT_EQ(buffer.names, (std::vector<std::string>{"left", "right"}));
}

TEST(Conversions, NamesMustBeOnePerFibre) {
  fiber_proximity::FiberArray message = test_messages::fiber_array(header("map"), three_points());
  message.names = {"one", "two"};
  FiberBuffer buffer;
  EXPECT_EQ(error_of([&] { to_chains(message, buffer); }),
            "2 names for 1 fibre(s); give one per fibre or none");
}

TEST(Conversions, ContactKeepsEveryField) {
  fiber::Contact contact;
  contact.fiber_a = 1;
  contact.segment_a = 2;
  contact.s = 0.25;
  contact.fiber_b = 3;
  contact.segment_b = 4;
  contact.t = 0.75;
  contact.distance = -0.5;
  contact.lower = -0.625;
  contact.upper = -0.375;
  contact.point_a = {1, 2, 3};
  contact.point_b = {4, 5, 6};
  contact.normal = {0, 0, 1};
  fiber_proximity::Contact message;
  to_message(contact, fiber_proximity::Contact::FIBER, fiber_proximity::Contact::OBJECT, message);
  EXPECT_EQ(message.fiber_a, 1U);
  EXPECT_EQ(message.segment_a, 2U);
  EXPECT_EQ(message.s, 0.25);
  EXPECT_EQ(message.fiber_b, 3U);
  EXPECT_EQ(message.segment_b, 4U);
  EXPECT_EQ(message.t, 0.75);
  EXPECT_EQ(message.distance, -0.5);
  EXPECT_EQ(message.lower, -0.625);
  EXPECT_EQ(message.upper, -0.375);
  EXPECT_EQ(to_vector(message.point_a), contact.point_a);
  EXPECT_EQ(to_vector(message.point_b), contact.point_b);
  EXPECT_EQ(to_vector(message.normal), contact.normal);
}

TEST(Conversions, EveryTypeOfOneChainGivesTheSame) {
  const std_msgs::Header camera = header("camera", ros::Time(3, 4));
  FiberBuffer buffer;
  to_chains(test_messages::fiber_array(camera, three_points()), buffer);
  expect_one_fiber(buffer);
  to_chains(test_messages::point_cloud2(camera, three_points()), buffer);
  expect_one_fiber(buffer);
  to_chains(test_messages::point_cloud(camera, three_points()), buffer);
  expect_one_fiber(buffer);
  to_chains(test_messages::pose_array(camera, three_points()), buffer);
  expect_one_fiber(buffer);
  to_chains(test_messages::path(camera, three_points()), buffer);
  expect_one_fiber(buffer);
}

TEST(Conversions, APoseOfAPathMustBeInThePathsFrame) {
  nav_msgs::Path message = test_messages::path(header("map"), three_points());
  message.poses[1].header.frame_id = "map";
  FiberBuffer buffer;
  EXPECT_NO_THROW(to_chains(message, buffer));
  message.poses[2].header.frame_id = "gripper";
  EXPECT_EQ(error_of([&] { to_chains(message, buffer); }),
            "pose 2 is in frame 'gripper', the path in 'map'; they must be the same");
  message.poses[2].header.frame_id = "grip\xC0\n";
  EXPECT_EQ(error_of([&] { to_chains(message, buffer); }),
            "pose 2 is in frame 'grip\\xC0\\n', the path in 'map'; they must be the same");
}

/// A cloud laid out by hand: double z first, then float y and x, padding in points and rows, two
/// rows of two points.
sensor_msgs::PointCloud2 unusual_cloud() {
  sensor_msgs::PointCloud2 cloud;
  const auto add_field = [&cloud](const char* name, std::uint32_t offset, std::uint8_t datatype) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = offset;
    field.datatype = datatype;
    field.count = 1;
    cloud.fields.push_back(field);
  };
  add_field("z", 1, sensor_msgs::PointField::FLOAT64);
  add_field("y", 9, sensor_msgs::PointField::FLOAT32);
  add_field("x", 14, sensor_msgs::PointField::FLOAT32);
  cloud.width = 2;
  cloud.height = 2;
  cloud.point_step = 20;
  cloud.row_step = 43;
  cloud.data.resize(86, 0xAB);
  for (std::uint32_t i = 0; i < 4; ++i) {
    std::uint8_t* point = cloud.data.data() + (i / 2) * 43 + (i % 2) * 20;
    const double z = 0.1 * i;
    const float y = 10.0F + static_cast<float>(i);
    const float x = 20.0F + static_cast<float>(i);
    std::memcpy(point + 1, &z, sizeof z);
    std::memcpy(point + 9, &y, sizeof y);
    std::memcpy(point + 14, &x, sizeof x);
  }
  return cloud;
}

TEST(PointCloud2, AnyLayoutIsReadRowByRow) {
  FiberBuffer buffer;
  to_chains(unusual_cloud(), buffer);
  EXPECT_EQ(buffer.points,
            (Points{{20, 10, 0.0}, {21, 11, 0.1}, {22, 12, 0.2}, {23, 13, 0.1 * 3}}));
  EXPECT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 4}));
}

TEST(PointCloud2, AnEmptyCloudIsAFibreOfNoPoints) {
  sensor_msgs::PointCloud2 cloud = test_messages::point_cloud2(header("map"), {});
  cloud.height = 0xFFFF'FFFFU;
  FiberBuffer buffer;
  to_chains(cloud, buffer);
  EXPECT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 0}));
}

TEST(PointCloud2, MalformedCloudsAreRefused) {
  FiberBuffer buffer;
  const auto error_after = [&buffer](const std::function<void(sensor_msgs::PointCloud2&)>& change) {
    sensor_msgs::PointCloud2 cloud = unusual_cloud();
    change(cloud);
    return error_of([&] { to_chains(cloud, buffer); });
  };
  EXPECT_EQ(error_after([](auto& cloud) { cloud.fields.pop_back(); }),
            "the cloud has no field 'x', it needs x, y and z");
  EXPECT_EQ(error_after([](auto& cloud) { cloud.fields[1].datatype = 6; }),
            "field 'y' has datatype 6, it must be 7 (FLOAT32) or 8 (FLOAT64)");
  EXPECT_EQ(error_after([](auto& cloud) { cloud.fields[0].offset = 13; }),
            "field 'z' ends at byte 21, beyond point_step 20");
  EXPECT_EQ(error_after([](auto& cloud) { cloud.fields[0].offset = 0xFFFF'FFFCU; }),
            "field 'z' ends at byte 4294967300, beyond point_step 20");
  EXPECT_EQ(error_after([](auto& cloud) { cloud.is_bigendian = 1; }),
            "the cloud is big-endian, only little-endian is supported");
  EXPECT_EQ(error_after([](auto& cloud) { cloud.row_step = 39; }),
            "row_step is 39, but 2 points of point_step 20 need 40");
  EXPECT_EQ(error_after([](auto& cloud) { cloud.point_step = 0x8000'0000U; }),
            "row_step is 43, but 2 points of point_step 2147483648 need 4294967296");
  EXPECT_EQ(error_after([](auto& cloud) { cloud.data.pop_back(); }),
            "data has 85 bytes, but 2 row(s) of row_step 43 make 86");
}

FiberBuffer one_fiber(double radius) {
  FiberBuffer fibers;
  fibers.points = three_points();
  fibers.end_chain();
  fibers.radii = {radius};
  return fibers;
}

TEST(FiberBuffer, AssignTakesThePointsAndCopiesNone) {
  fiber::FiberAssembly fibers;
  for (const double radius : {0.5, 0.5, 0.25}) {  // other fibres, then moved points, then others
    FiberBuffer buffer = one_fiber(radius);
    const Eigen::Vector3d* const memory = buffer.points.data();
    assign(buffer, fibers);
    EXPECT_EQ(fibers.points().data(), memory);
    EXPECT_EQ(fibers.points(), three_points());
    EXPECT_EQ(fibers.radii(), std::vector<double>{radius});
  }
}

TEST(FiberBuffer, AssignRefusesWhatAnAssemblyRefuses) {
  FiberBuffer buffer = one_fiber(0.5);
  fiber::FiberAssembly fibers;
  assign(buffer, fibers);
  EXPECT_EQ(fibers.points(), three_points());
  buffer = one_fiber(-1.0);
  EXPECT_THROW(assign(buffer, fibers), std::invalid_argument);
  EXPECT_EQ(fibers.radii(), std::vector<double>{0.5});
}

}  // namespace
}  // namespace fiber_proximity_ros
