#include "src/ros/environment/obstacle_change.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::ObjectChange;
using fiber::test::error_of;
using fiber_proximity::Obstacle;
using shape_msgs::SolidPrimitive;

using fiber::test::nan;

geometry_msgs::Pose pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation) {
  geometry_msgs::Pose message;
  message.position.x = position.x();
  message.position.y = position.y();
  message.position.z = position.z();
  message.orientation.x = rotation.x();
  message.orientation.y = rotation.y();
  message.orientation.z = rotation.z();
  message.orientation.w = rotation.w();
  return message;
}

SolidPrimitive primitive(std::uint8_t type, const std::vector<double>& dimensions) {
  SolidPrimitive message;
  message.type = type;
  message.dimensions = dimensions;
  return message;
}

shape_msgs::Plane plane(double a, double b, double c, double d) {
  shape_msgs::Plane message;
  message.coef = {a, b, c, d};
  return message;
}

shape_msgs::Mesh triangle() {
  shape_msgs::Mesh mesh;
  mesh.vertices.resize(3);
  mesh.vertices[1].x = 1.0;
  mesh.vertices[2].y = 1.0;
  mesh.triangles.resize(1);
  mesh.triangles[0].vertex_indices = {0, 1, 2};
  return mesh;
}

/// One box.
Obstacle box() {
  Obstacle obstacle;
  obstacle.id = "table";
  obstacle.operation = Obstacle::ADD;
  obstacle.primitives = {primitive(SolidPrimitive::BOX, {1.0, 2.0, 3.0})};
  return obstacle;
}

std::string error_after(const std::function<void(Obstacle&)>& change) {
  Obstacle obstacle = box();
  change(obstacle);
  return error_of([&] { to_change(obstacle); });
}

TEST(ObstacleChange, EveryOperationIsItself) {
  Obstacle obstacle = box();
  EXPECT_EQ(to_change(obstacle).operation, ObjectChange::Operation::ADD);
  obstacle.operation = Obstacle::APPEND;
  EXPECT_EQ(to_change(obstacle).operation, ObjectChange::Operation::APPEND);
  obstacle.operation = Obstacle::MOVE;
  EXPECT_EQ(to_change(obstacle).operation, ObjectChange::Operation::MOVE);
  obstacle.operation = Obstacle::REMOVE;
  EXPECT_EQ(to_change(obstacle).operation, ObjectChange::Operation::REMOVE);
  EXPECT_EQ(to_change(obstacle).object.name, "table");
  obstacle.id = "";
  EXPECT_EQ(to_change(obstacle).object.name, "");
}

TEST(ObstacleChange, EveryShapeIsItself) {
  Obstacle obstacle = box();
  obstacle.primitives.push_back(primitive(SolidPrimitive::SPHERE, {4.0}));
  obstacle.primitives.push_back(primitive(SolidPrimitive::CYLINDER, {5.0, 6.0}));
  obstacle.primitives.push_back(primitive(SolidPrimitive::CONE, {7.0, 8.0}));
  obstacle.capsules.resize(1);
  obstacle.capsules[0].radius = 9.0;
  obstacle.capsules[0].length = 10.0;
  obstacle.meshes = {triangle()};
  obstacle.planes = {plane(0, 0, -2, 6)};
  obstacle.half_spaces = {plane(0, 4, 0, -4)};
  const ObjectChange change = to_change(obstacle);
  const auto& shapes = change.object.shapes;
  ASSERT_EQ(shapes.size(), 8U);
  EXPECT_EQ(std::get<fiber::BoxShape>(shapes[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<fiber::SphereShape>(shapes[1].shape).radius, 4.0);
  EXPECT_EQ(std::get<fiber::CylinderShape>(shapes[2].shape).height, 5.0);
  EXPECT_EQ(std::get<fiber::CylinderShape>(shapes[2].shape).radius, 6.0);
  EXPECT_EQ(std::get<fiber::ConeShape>(shapes[3].shape).height, 7.0);
  EXPECT_EQ(std::get<fiber::ConeShape>(shapes[3].shape).radius, 8.0);
  EXPECT_EQ(std::get<fiber::CapsuleShape>(shapes[4].shape).radius, 9.0);
  EXPECT_EQ(std::get<fiber::CapsuleShape>(shapes[4].shape).length, 10.0);
  const auto& mesh = *std::get<std::shared_ptr<const fiber::TriangleMesh>>(shapes[5].shape);
  EXPECT_EQ(mesh.vertices()[2], Eigen::Vector3d::UnitY());
  EXPECT_EQ(mesh.triangles(), (std::vector<fiber::TriangleMesh::Triangle>{{0, 1, 2}}));
  const auto& sheet = std::get<fiber::PlaneShape>(shapes[6].shape);  // z = 3
  EXPECT_EQ(sheet.offset * sheet.normal, Eigen::Vector3d(0, 0, 3));
  const auto& ground = std::get<fiber::HalfSpaceShape>(shapes[7].shape);  // y <= 1
  EXPECT_EQ(ground.normal, Eigen::Vector3d::UnitY());
  EXPECT_EQ(ground.offset, 1.0);
}

TEST(ObstacleChange, PosesAreThoseOfTheMessage) {
  SCOPED_TRACE(fiber::test::seed_message());
  fiber::test::Random random;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d position = random.in_cube();
    const Eigen::Quaterniond rotation(
        Eigen::AngleAxisd(random.uniform(0.0, 6.0), random.direction()));
    Obstacle obstacle = box();
    obstacle.pose = pose(position, rotation);
    // As far off as tf takes it.
    const double length = random.uniform(0.996, 1.0045);
    obstacle.primitive_poses = {pose(-position, Eigen::Quaterniond(length * rotation.coeffs()))};
    const ObjectChange change = to_change(obstacle);
    const Eigen::Isometry3d expected = Eigen::Translation3d(position) * rotation;
    EXPECT_TRUE(change.object.pose.isApprox(expected, 1e-14));
    const Eigen::Isometry3d shape = Eigen::Translation3d(-position) * rotation;
    EXPECT_TRUE(change.object.shapes[0].pose.isApprox(shape, 1e-14));
  }
}

TEST(ObstacleChange, APoseThatNobodyFilledInIsNoDisplacement) {
  Obstacle obstacle = box();
  obstacle.primitive_poses.resize(1);
  const ObjectChange change = to_change(obstacle);
  EXPECT_TRUE(change.object.pose.isApprox(Eigen::Isometry3d::Identity(), 0.0));
  EXPECT_TRUE(change.object.shapes[0].pose.isApprox(Eigen::Isometry3d::Identity(), 0.0));
}

TEST(ObstacleChange, BadNamesAndOperationsAreRefused) {
  EXPECT_EQ(error_after([](Obstacle& obstacle) { obstacle.operation = 4; }),
            "obstacle 'table': operation is 4, it must be 0 (ADD), 1 (REMOVE), 2 (APPEND) or 3 "
            "(MOVE)");
  EXPECT_EQ(error_after([](Obstacle& obstacle) { obstacle.id = ""; }),
            "obstacle '': id is empty, it must name the object");
  const std::string reserved =
      "': 'cloud' and names that begin with 'robot/' are those of the point cloud and the links of "
      "the robot";
  EXPECT_EQ(error_after([](Obstacle& obstacle) { obstacle.id = "cloud"; }),
            "obstacle 'cloud" + reserved);
  EXPECT_EQ(error_after([](Obstacle& obstacle) {
              obstacle.id = "robot/hand";
              obstacle.operation = Obstacle::REMOVE;
            }),
            "obstacle 'robot/hand" + reserved);
}

TEST(ObstacleChange, BadPrimitivesAreRefused) {
  const auto error_with = [](std::uint8_t type, const std::vector<double>& dimensions) {
    return error_after(
        [&](Obstacle& obstacle) { obstacle.primitives.push_back(primitive(type, dimensions)); });
  };
  EXPECT_EQ(error_with(5, {1.0}),
            "obstacle 'table': primitive 1: type is 5, it must be 1 (BOX), 2 (SPHERE), 3 "
            "(CYLINDER) or 4 (CONE)");
  EXPECT_EQ(error_with(SolidPrimitive::BOX, {1.0, 1.0}),
            "obstacle 'table': primitive 1: a box has 2 dimension(s), it must have 3: x, y and z");
  EXPECT_EQ(error_with(SolidPrimitive::SPHERE, {}),
            "obstacle 'table': primitive 1: a sphere has 0 dimension(s), it must have 1: the "
            "radius");
  EXPECT_EQ(error_with(SolidPrimitive::CYLINDER, {1.0, 2.0, 3.0}),
            "obstacle 'table': primitive 1: a cylinder has 3 dimension(s), it must have 2: height "
            "and radius");
  EXPECT_EQ(error_with(SolidPrimitive::CONE, {1.0}),
            "obstacle 'table': primitive 1: a cone has 1 dimension(s), it must have 2: height and "
            "radius");
  for (const double bad : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
    const std::string error = error_with(SolidPrimitive::SPHERE, {bad});
    EXPECT_NE(error.find("'table'"), std::string::npos) << error;
    EXPECT_NE(error.find('1'), std::string::npos) << error;
  }
}

TEST(ObstacleChange, BadPosesAreRefused) {
  const auto error_with = [](const geometry_msgs::Pose& bad) {
    return error_after([&](Obstacle& obstacle) { obstacle.pose = bad; });
  };
  const Eigen::Quaterniond zero(0, 0, 0, 0);
  EXPECT_EQ(error_with(pose({1, 0, 0}, zero)),
            "obstacle 'table': pose: orientation (0, 0, 0, 0) has length 0, it must be a "
            "quaternion of length 1");
  EXPECT_EQ(error_with(pose({0, 0, 0}, Eigen::Quaterniond(2, 0, 0, 0))),
            "obstacle 'table': pose: orientation (0, 0, 0, 2) has length 2, it must be a "
            "quaternion of length 1");
  EXPECT_NE(error_with(pose({0, 0, 0}, Eigen::Quaterniond(1.006, 0, 0, 0))), "no error");
  EXPECT_NE(error_with(pose({0, 0, 0}, Eigen::Quaterniond(nan, 0, 0, 0))), "no error");
  EXPECT_EQ(error_with(pose({0, nan, 0}, Eigen::Quaterniond::Identity())),
            "obstacle 'table': pose: position (0, nan, 0) is not finite");
  EXPECT_EQ(error_after([](Obstacle& obstacle) {
              obstacle.primitive_poses = {pose({0, 0, 1}, Eigen::Quaterniond(0, 0, 0, 0))};
            }),
            "obstacle 'table': primitive 0: orientation (0, 0, 0, 0) has length 0, it must be a "
            "quaternion of length 1");
  EXPECT_EQ(error_after([](Obstacle& obstacle) { obstacle.primitive_poses.resize(2); }),
            "obstacle 'table': 2 pose(s) of 1 primitive(s); give one for each or none");
  EXPECT_EQ(error_after([](Obstacle& obstacle) { obstacle.half_space_poses.resize(1); }),
            "obstacle 'table': 1 pose(s) of 0 half-space(s); give one for each or none");
}

TEST(ObstacleChange, BadMeshesAreRefused) {
  const auto error_with = [](const std::function<void(shape_msgs::Mesh&)>& change) {
    return error_after([&](Obstacle& obstacle) {
      obstacle.meshes = {triangle(), triangle()};
      change(obstacle.meshes[1]);
    });
  };
  const std::string place = "obstacle 'table': mesh 1: ";
  const std::string index = error_with([](auto& mesh) { mesh.triangles[0].vertex_indices[2] = 3; });
  EXPECT_EQ(index.rfind(place, 0), 0U) << index;
  EXPECT_NE(index.find('3'), std::string::npos) << index;
  const std::string coordinate = error_with([](auto& mesh) { mesh.vertices[1].y = nan; });
  EXPECT_EQ(coordinate.rfind(place, 0), 0U) << coordinate;
  EXPECT_NE(coordinate.find("vertex 1"), std::string::npos) << coordinate;
  const std::string none = error_with([](auto& mesh) { mesh.triangles.clear(); });
  EXPECT_EQ(none.rfind(place, 0), 0U) << none;
  const std::string giant = error_with([](auto& mesh) {
    mesh.triangles.assign(fiber::TriangleMesh::max_triangles + 1, mesh.triangles[0]);
  });
  EXPECT_EQ(giant.rfind(place, 0), 0U) << giant;
  EXPECT_NE(giant.find("1000001"), std::string::npos) << giant;
}

TEST(ObstacleChange, BadPlanesAreRefused) {
  EXPECT_EQ(error_after([](Obstacle& obstacle) { obstacle.planes = {plane(0, 0, 0, 1)}; }),
            "obstacle 'table': plane 0: coef is (0, 0, 0, 1), it must be finite and its first "
            "three not all 0: ax + by + cz + d = 0");
  EXPECT_EQ(error_after([](Obstacle& obstacle) {
              obstacle.half_spaces = {plane(0, 0, 1, 0), plane(0, nan, 1, 0)};
            }),
            "obstacle 'table': half-space 1: coef is (0, nan, 1, 0), it must be finite and its "
            "first three not all 0: ax + by + cz + d = 0");
}

/// Objects become messages, and these the same objects.
TEST(ObstacleChange, ObjectsBecomeMessagesThatMakeThemAgain) {
  SCOPED_TRACE(fiber::test::seed_message());
  fiber::test::Random random;
  const auto random_pose = [&random] {
    return Eigen::Isometry3d(Eigen::Translation3d(random.in_cube()) *
                             Eigen::AngleAxisd(random.uniform(0.0, 6.0), random.direction()));
  };
  fiber::EnvironmentObject object;
  object.name = "table";
  object.pose = random_pose();
  const auto mesh = std::make_shared<const fiber::TriangleMesh>(
      std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 1e-9}},
      std::vector<fiber::TriangleMesh::Triangle>{{0, 1, 2}, {2, 1, 0}});
  for (const fiber::Shape& shape : std::vector<fiber::Shape>{
           fiber::BoxShape{{1, 2, 3}}, fiber::SphereShape{4}, fiber::CylinderShape{5, 6},
           fiber::ConeShape{7, 8}, fiber::CapsuleShape{9, 10}, mesh,
           fiber::PlaneShape{random.direction(), 11},
           fiber::HalfSpaceShape{random.direction(), -12}}) {
    object.shapes.push_back({shape, random_pose()});
  }
  const Obstacle message = to_obstacle(object, "arm");
  EXPECT_EQ(message.header.frame_id, "arm");
  EXPECT_EQ(message.id, "table");
  const ObjectChange change = to_change(message);
  EXPECT_EQ(change.operation, ObjectChange::Operation::ADD);
  EXPECT_TRUE(change.object.pose.isApprox(object.pose, 1e-14));
  const auto& shapes = change.object.shapes;
  ASSERT_EQ(shapes.size(), object.shapes.size());
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    EXPECT_EQ(shapes[i].shape.index(), object.shapes[i].shape.index());
    EXPECT_TRUE(shapes[i].pose.isApprox(object.shapes[i].pose, 1e-14));
  }
  EXPECT_EQ(std::get<fiber::BoxShape>(shapes[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<fiber::SphereShape>(shapes[1].shape).radius, 4);
  EXPECT_EQ(std::get<fiber::CylinderShape>(shapes[2].shape).radius, 5);
  EXPECT_EQ(std::get<fiber::CylinderShape>(shapes[2].shape).height, 6);
  EXPECT_EQ(std::get<fiber::ConeShape>(shapes[3].shape).radius, 7);
  EXPECT_EQ(std::get<fiber::ConeShape>(shapes[3].shape).height, 8);
  EXPECT_EQ(std::get<fiber::CapsuleShape>(shapes[4].shape).radius, 9);
  EXPECT_EQ(std::get<fiber::CapsuleShape>(shapes[4].shape).length, 10);
  const auto& read = *std::get<std::shared_ptr<const fiber::TriangleMesh>>(shapes[5].shape);
  EXPECT_EQ(read.vertices(), mesh->vertices());
  EXPECT_EQ(read.triangles(), mesh->triangles());
  const auto expect_sheet = [&](const auto& sheet, std::size_t i) {
    const auto& expected = std::get<std::decay_t<decltype(sheet)>>(object.shapes[i].shape);
    EXPECT_TRUE(sheet.normal.isApprox(expected.normal, 1e-14));
    EXPECT_NEAR(sheet.offset, expected.offset, 1e-12);
  };
  expect_sheet(std::get<fiber::PlaneShape>(shapes[6].shape), 6);
  expect_sheet(std::get<fiber::HalfSpaceShape>(shapes[7].shape), 7);
}

}  // namespace
}  // namespace fiber_proximity_ros
