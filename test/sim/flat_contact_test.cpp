// Edges that lie flat on obstacles shorter than themselves: which part of them does, and that they
// come to rest there, on each shape and on meshes.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "src/environment/triangle_distance.hpp"
#include "src/sim/contact/flat_parts.hpp"
#include "test/sim/contact_system.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

Isometry3d turned(double angle, const Vector3d& axis, const Vector3d& to = Vector3d::Zero()) {
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = AngleAxisd(angle, axis).toRotationMatrix();
  pose.translation() = to;
  return pose;
}

/// An edge that is parallel to a flat of a solid, and longer than that.
struct FlatEdge {
  Vector3d p0;
  Vector3d p1;
};

/// One at a height over a flat through a point, with a direction in it.
FlatEdge edge_over(const Vector3d& point, const Vector3d& normal, const Vector3d& direction,
                   Random& random) {
  const Vector3d middle = point + random.uniform(0.001, 0.02) * normal;
  return {middle - random.uniform(0.5, 1.0) * direction,
          middle + random.uniform(0.5, 1.0) * direction};
}

Vector3d direction_in_xy(Random& random) {
  const double angle = random.uniform(-M_PI, M_PI);
  return {std::cos(angle), std::sin(angle), 0.0};
}

/// That some part which is found is the one with the least distance, by its ends.
template <class Solid, class Distance>
void expect_flat(const Solid& solid, const FlatEdge& edge, const Distance& distance) {
  constexpr int samples = 4000;
  const auto at = [&](double s) { return distance(Vector3d(edge.p0 + s * (edge.p1 - edge.p0))); };
  double least = at(0.5);
  for (int i = 0; i <= samples; ++i) {
    least = std::min(least, at(static_cast<double>(i) / samples));
  }
  double first = 1.0;
  double last = 0.0;
  for (int i = 0; i <= samples; ++i) {
    const double s = static_cast<double>(i) / samples;
    if (at(s) <= least + 1e-12) {
      first = std::min(first, s);
      last = std::max(last, s);
    }
  }
  ASSERT_GT(last - first, 0.005) << "the edge is not over a flat";
  const FlatParts found = parts_over_flats(solid, edge.p0, edge.p1);
  double error = 1.0;
  for (std::size_t i = 0; i < found.count; ++i) {
    error = std::min(error,
                     std::abs(found.parts[i].first - first) + std::abs(found.parts[i].last - last));
  }
  EXPECT_LT(error, 2.5 / samples) << first << " to " << last;
}

template <class Solid>
void expect_flat(const Solid& solid, const FlatEdge& edge) {
  expect_flat(solid, edge, [&](const Vector3d& p) { return point_distance(solid, p).distance; });
}

TEST(FlatParts, AreWhereAnEdgeIsNearest) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int i = 0; i < 60; ++i) {
    const Vector3d size(random.uniform(0.02, 0.3), random.uniform(0.02, 0.3),
                        random.uniform(0.02, 0.3));
    const Vector3d inside(random.uniform(-0.4, 0.4) * size.x(),
                          random.uniform(-0.4, 0.4) * size.y(), 0.5 * size.z());
    SCOPED_TRACE(i);
    expect_flat(BoxShape{size},
                edge_over(inside, Vector3d::UnitZ(), direction_in_xy(random), random));
    // Beside two faces, along the edge between them.
    expect_flat(BoxShape{size}, edge_over({0.0, 0.5 * size.y(), 0.5 * size.z()},
                                          Vector3d(0.0, 1.0, random.uniform(0.2, 3.0)).normalized(),
                                          Vector3d::UnitX(), random));
    const double radius = 0.5 * size.x();
    const Vector3d off(0.3 * radius, random.uniform(-0.5, 0.5) * radius, 0.0);
    const CylinderShape cylinder{radius, size.z()};
    expect_flat(cylinder, edge_over(off + 0.5 * size.z() * Vector3d::UnitZ(), Vector3d::UnitZ(),
                                    direction_in_xy(random), random));
    const Vector3d outwards = direction_in_xy(random);
    expect_flat(cylinder, edge_over(radius * outwards, outwards, Vector3d::UnitZ(), random));
    expect_flat(CapsuleShape{radius, size.z()},
                edge_over(radius * outwards, outwards, Vector3d::UnitZ(), random));
    const ConeShape cone{radius, size.z()};
    expect_flat(cone, edge_over(off - 0.5 * size.z() * Vector3d::UnitZ(), -Vector3d::UnitZ(),
                                direction_in_xy(random), random));
    const Vector3d up_the_side = size.z() * Vector3d::UnitZ() - radius * outwards;
    const Vector3d off_the_side = size.z() * outwards + radius * Vector3d::UnitZ();
    expect_flat(cone, edge_over(0.5 * radius * outwards, off_the_side.normalized(),
                                up_the_side.normalized(), random));
    TriangleCorners triangle;
    for (Vector3d& corner : triangle) {
      corner = random.in_cube(0.2);
    }
    const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if (normal.norm() < 0.005) {
      continue;
    }
    const Vector3d center = (triangle[0] + triangle[1] + triangle[2]) / 3.0;
    const Vector3d in_plane = normal.cross(random.direction()).normalized();
    expect_flat(
        triangle, edge_over(center, normal.normalized(), in_plane, random),
        [&](const Vector3d& p) { return (p - nearest_on_triangle(p, triangle).nearest).norm(); });
  }
}

TEST(FlatParts, SpheresAndPlanesHaveNone) {
  const Vector3d p0(-1.0, 0.0, 0.1);
  const Vector3d p1(1.0, 0.0, 0.1);
  EXPECT_EQ(parts_over_flats(SphereShape{0.05}, p0, p1).count, 0U);
  EXPECT_EQ(parts_over_flats(PlaneShape{}, p0, p1).count, 0U);
}

/// A table of triangles of this size around the origin, with bumps up to a height.
std::shared_ptr<const TriangleMesh> mesh_table(double length, double width, int count,
                                               double bumps = 0.0) {
  Random random(7);
  std::vector<Vector3d> corners;
  std::vector<TriangleMesh::Triangle> triangles;
  for (int i = 0; i <= count; ++i) {
    for (int j = 0; j <= count; ++j) {
      corners.emplace_back(length * (static_cast<double>(i) / count - 0.5),
                           width * (static_cast<double>(j) / count - 0.5),
                           -random.uniform(0.0, bumps));
      if (i > 0 && j > 0) {
        const auto here = static_cast<std::uint32_t>(corners.size() - 1);
        const auto row = static_cast<std::uint32_t>(count + 1);
        triangles.push_back({here - row - 1, here - 1, here});
        triangles.push_back({here - row - 1, here, here - row});
      }
    }
  }
  return std::make_shared<const TriangleMesh>(corners, triangles);
}

/// An obstacle whose top is flat, at z = 0 around the origin, at most 7 cm across.
struct Top {
  std::string name;
  Shape shape;
  Isometry3d pose;
};

std::vector<Top> tops() {
  const auto below = [](double z) { return turned(0.0, Vector3d::UnitX(), {0.0, 0.0, -z}); };
  std::vector<OccupancyOctree::Cell> cells;
  for (int i = -2; i < 2; ++i) {
    for (int j = -2; j < 2; ++j) {
      cells.push_back(
          *OccupancyOctree::cell_at(0.0125, {0.0125 * (i + 0.5), 0.0125 * (j + 0.5), 1e-3}));
    }
  }
  return {
      {"box", BoxShape{{0.05, 0.05, 0.03}}, below(0.015)},
      {"bar", BoxShape{{0.03, 0.5, 0.02}}, below(0.01)},
      {"post", CylinderShape{0.025, 0.05}, below(0.025)},
      {"lying cylinder", CylinderShape{0.025, 0.05},
       turned(0.5 * M_PI, Vector3d::UnitY(), {0.0, 0.0, -0.025})},
      {"cone on its apex", ConeShape{0.025, 0.05},
       turned(M_PI, Vector3d::UnitX(), {0.0, 0.0, -0.025})},
      {"lying capsule", CapsuleShape{0.025, 0.05},
       turned(0.5 * M_PI, Vector3d::UnitY(), {0.0, 0.0, -0.025})},
      {"two triangles", mesh_table(0.05, 0.05, 1), below(0.0)},
      {"mesh", mesh_table(0.05, 0.05, 4), below(0.0)},
      {"octree", std::make_shared<const OccupancyOctree>(0.0125, cells), below(0.0125)},
  };
}

constexpr double plug_radius = 0.02;
constexpr double plug_step = 1.0 / 240.0;

/// Of one edge of 10 cm, as heavy as copper in rubber.
Rods plug(double yaw, double along, double height) {
  const Vector3d direction(std::cos(yaw), std::sin(yaw), 0.0);
  const Vector3d middle = along * direction + (plug_radius + height) * Vector3d::UnitZ();
  Rods rods;
  rods.add({middle - 0.05 * direction, middle + 0.05 * direction}, plug_radius,
           solid_round_section({2e8, 7e7, 3000.0}, plug_radius));
  return rods;
}

/// Contacts begin and end at 1.05 and 0.95 of the radius: an edge may lean by that.
void expect_rest_at(double height, const Rods& rods) {
  const double first = rods.positions[0].z() - height;
  const double last = rods.positions[1].z() - height;
  EXPECT_NEAR(0.5 * (first + last), plug_radius, 0.06 * plug_radius);
  EXPECT_LT(std::abs(first - last), 0.05 * (rods.positions[1] - rods.positions[0]).norm());
}

TEST(FlatContacts, TheGradientIsThatOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  int divided = 0;
  for (const Top& top : tops()) {
    const auto contacts = contacts_with(environment_of(top.shape, top.pose));
    for (int i = 0; i < 20; ++i) {
      SCOPED_TRACE(top.name + " " + std::to_string(i));
      Rods rods = plug(random.uniform(-0.5, 0.5), random.uniform(-0.01, 0.01), 0.0);
      for (Vector3d& position : rods.positions) {
        position.z() += random.uniform(-0.8e-3, 0.8e-3);
      }
      ContactSet found = contacts_of(*contacts, rods);
      found.begin(rods, nullptr, {}, plug_step);
      divided += static_cast<int>(std::count_if(found.obstacle_contacts.begin(),
                                                found.obstacle_contacts.end(),
                                                [](const ObstacleContact& contact) {
                                                  return contact.point && !contact.part.is_point();
                                                }));
      const Eigen::VectorXd gradient = full_system(found, rods).gradient;
      const Eigen::VectorXd expected = gradient_by_differences(
          rods, [&](const Rods& r) { return energy_in(found, r); }, 1e-8);
      ASSERT_GT(expected.norm(), 0.0);
      EXPECT_LE((gradient - expected).norm(), 1e-4 * expected.norm());
      const Eigen::VectorXd eigenvalues =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full_system(found, rods).hessian)
              .eigenvalues();
      EXPECT_GE(eigenvalues.minCoeff(), -1e-10 * eigenvalues.maxCoeff());
    }
  }
  EXPECT_GT(divided, 150);
}

TEST(FlatContacts, HoldAHeavyEdgeThatIsLongerThanThey) {
  for (const Top& top : tops()) {
    const bool is_round = top.name.find("lying") == 0;
    for (const double yaw :
         is_round ? std::vector<double>{0.0} : std::vector<double>{0.0, 0.12, 0.25 * M_PI}) {
      for (const double along : {0.0, 0.003, 0.01}) {
        for (const double height : {0.0003, 0.004}) {
          SCOPED_TRACE(top.name + ", yaw " + std::to_string(yaw) + ", off by " +
                       std::to_string(along) + ", from " + std::to_string(height));
          StepperOptions options;
          options.threads = 1;
          Stepper stepper(plug(yaw, along, height), elastic(standard_gravity), options,
                          contacts_with(environment_of(top.shape, top.pose), 0.3));
          const double weight =
              standard_gravity * (stepper.rods().masses[0] + stepper.rods().masses[1]);
          double pushed = 0.0;
          constexpr int steps = 120;
          for (int i = 0; i < steps; ++i) {
            stepper.step(plug_step);
            ASSERT_EQ(stepper.report().unbalanced, 0U) << "step " << i;
            for (const auto& contact : stepper.forces().contacts) {
              pushed += contact.normal_force.z() + contact.friction_force.z();
            }
          }
          expect_rest_at(0.0, stepper.rods());
          EXPECT_NEAR(pushed, steps * weight, 0.15 * steps * weight);
        }
      }
    }
  }
}

TEST(FlatContacts, LetFallWhatIsNotOverThem) {
  for (const Top& top : tops()) {
    SCOPED_TRACE(top.name);
    StepperOptions options;
    options.threads = 1;
    Stepper stepper(plug(0.0, 0.04, 0.0003), elastic(standard_gravity), options,
                    contacts_with(environment_of(top.shape, top.pose), 0.3));
    for (int i = 0; i < 72; ++i) {
      stepper.step(plug_step);
    }
    EXPECT_LT(stepper.rods().positions[1].z(), -0.02);
  }
}

TEST(FlatContacts, CarryAHeavyEdgeThatTheyLift) {
  constexpr double speed = 0.2;
  for (const Top& top : tops()) {
    SCOPED_TRACE(top.name);
    const MovingObstacle lift = moving("lift", top.shape, [&](double time) {
      Isometry3d pose = top.pose;
      pose.translation().z() += speed * time;
      return pose;
    });
    StepperOptions options;
    options.threads = 1;
    Stepper stepper(plug(0.0, 0.003, 0.001), elastic(standard_gravity), options,
                    contacts_with_moving({lift}, 0.3));
    for (int i = 0; i < 72; ++i) {
      stepper.step(plug_step);
      ASSERT_EQ(stepper.report().unbalanced, 0U) << "step " << i;
    }
    expect_rest_at(speed * stepper.time(), stepper.rods());
  }
}

/// Whose segments are longer and shorter than the triangles: with friction, which must find what it
/// goes on with among many contacts of one edge.
TEST(FlatContacts, RopesComeToRestOnMeshes) {
  constexpr double radius = 0.004;
  for (const double bumps : {0.0, 0.003}) {
    const auto mesh = mesh_table(1.0, 0.3, 40, bumps);
    for (const int edges : {20, 60}) {
      SCOPED_TRACE(std::to_string(edges) + " edges, bumps of " + std::to_string(bumps));
      Rods rods;
      rods.add(straight({-0.4, 0.0, 0.01}, {0.45, 0.04, 0.02}, edges), radius,
               solid_round_section(material_preset("rope"), radius));
      StepperOptions options;
      options.threads = 1;
      Stepper stepper(rods, elastic(standard_gravity), options,
                      contacts_with(environment_of(mesh), 0.3));
      for (int i = 0; i < 96; ++i) {
        stepper.step(plug_step);
        ASSERT_EQ(stepper.report().unbalanced, 0U) << "step " << i;
      }
      for (const Vector3d& position : stepper.rods().positions) {
        const AxisDistance least = axis_distance(mesh, position, position, 1.0);
        EXPECT_GT(least.distance, 0.94 * radius);
        EXPECT_LT(least.distance, radius + bumps + 0.001);
      }
    }
  }
}

}  // namespace
}  // namespace fiber::test
