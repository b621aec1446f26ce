#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "test/support/curves.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// Fibres as they are given, some of them closed or joined.
struct JoinedFibers {
  std::string name;
  Curve points;
  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii;  // by point
  FiberTopology topology;

  FiberAssembly assembly() const { return {points, offsets, radii, topology}; }

  /// @param joints by point of the curve, or empty: none
  void add(const Curve& curve, double radius, bool is_closed = false,
           std::vector<std::int32_t> joints = {}) {
    joints.resize(curve.size(), -1);
    points.insert(points.end(), curve.begin(), curve.end());
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
    radii.resize(points.size(), radius);
    topology.closed.push_back(is_closed ? 1 : 0);
    topology.joints.insert(topology.joints.end(), joints.begin(), joints.end());
  }
};

inline Curve moved(Curve curve, const Eigen::Vector3d& way, double scale = 1.0) {
  for (Eigen::Vector3d& point : curve) {
    point = scale * point + way;
  }
  return curve;
}

/// A tree: each branch begins at a point of an earlier one, and wanders.
inline JoinedFibers random_tree(Random& random, int branches, int max_points) {
  JoinedFibers tree;
  tree.name = "tree";
  std::int32_t joint = 0;
  for (int i = 0; i < branches; ++i) {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    std::vector<std::int32_t> joints;
    if (i > 0) {
      const auto parent =
          static_cast<std::size_t>(random.integer(0, static_cast<int>(tree.points.size()) - 1));
      place = tree.points[parent];
      if (tree.topology.joints[parent] < 0) {
        tree.topology.joints[parent] = joint++;
      }
      joints.push_back(tree.topology.joints[parent]);
    }
    Curve curve;
    Eigen::Vector3d direction = random.direction();
    const int count = random.integer(2, max_points);
    for (int k = 0; k < count; ++k) {
      curve.push_back(place);
      direction = (2.0 * direction + random.direction()).normalized();
      place += random.uniform(0.1, 0.5) * direction;
    }
    tree.add(curve, random.uniform(0.02, 0.2), false, joints);
  }
  return tree;
}

/// A net of strands that go along two directions, joined where they meet, on a bent surface.
inline JoinedFibers random_net(Random& random, int strands, int per_mesh) {
  JoinedFibers net;
  net.name = "net";
  const double bend = random.uniform(0.0, 1.5);
  const auto place = [&](double x, double y) {
    return Eigen::Vector3d(x, y * std::cos(bend * y / strands), y * std::sin(bend * y / strands));
  };
  const bool is_closed = random.chance(0.5);  // a tube of rings and lines
  for (int direction = 0; direction < 2; ++direction) {
    for (int strand = 0; strand < strands; ++strand) {
      Curve curve;
      std::vector<std::int32_t> joints;
      for (int k = 0; k <= (strands - 1) * per_mesh; ++k) {
        const double along = static_cast<double>(k) / per_mesh;
        curve.push_back(direction == 0 ? place(along, strand) : place(strand, along));
        const int mesh = k / per_mesh;
        joints.push_back(k % per_mesh != 0 ? -1
                         : direction == 0  ? strand * strands + mesh
                                           : mesh * strands + strand);
      }
      if (is_closed && direction == 1 && strands * per_mesh > 3) {
        net.add(curve, random.uniform(0.02, 0.15), true, joints);
      } else {
        net.add(curve, random.uniform(0.02, 0.15), false, joints);
      }
    }
  }
  return net;
}

/// Closed curves: rings, some of them linked, knots, and eights that are joined where they cross.
inline JoinedFibers random_rings(Random& random) {
  JoinedFibers rings;
  rings.name = "rings";
  const double radius = random.uniform(0.02, 0.15);
  rings.add(circle(random.integer(3, 40)), radius, true);
  rings.add(moved(circle(random.integer(3, 40)), random.in_cube()), radius, true);
  rings.add(moved(trefoil(random.integer(12, 60)), random.in_cube(2.0), 0.5), radius, true);
  rings.add(moved(figure_eight(random.integer(20, 60)), random.in_cube(2.0), 0.5), radius, true);
  Curve eight;
  const int half = random.integer(4, 12);
  std::vector<std::int32_t> joints(static_cast<std::size_t>(2 * half), -1);
  for (int i = 0; i < 2 * half; ++i) {
    const double t = turn * i / (2 * half);
    eight.emplace_back(std::sin(t), std::sin(t) * std::cos(t), 0.0);
  }
  eight[static_cast<std::size_t>(half)] = eight[0];
  joints[0] = joints[static_cast<std::size_t>(half)] = 77;
  rings.add(moved(eight, random.in_cube(2.0)), radius, true, joints);
  return rings;
}

/// Three fibres that meet, two of them at this angle [rad].
inline JoinedFibers fork(Random& random, double angle) {
  JoinedFibers fibers;
  fibers.name = "fork of " + std::to_string(angle);
  const double step = random.uniform(0.05, 0.5);
  for (const double direction : {0.0, angle, turn / 2.0}) {
    Curve curve;
    const int count = random.integer(3, 25);
    for (int k = 0; k < count; ++k) {
      curve.emplace_back(k * step * std::cos(direction), k * step * std::sin(direction), 0.0);
    }
    std::vector<std::int32_t> joints(curve.size(), -1);
    joints[0] = 5;
    if (random.chance(0.5)) {
      std::reverse(curve.begin(), curve.end());
      std::reverse(joints.begin(), joints.end());
    }
    fibers.add(curve, random.uniform(0.02, 0.2), false, joints);
  }
  return fibers;
}

/// A chain that is joined with nothing and begins near a point of the others.
inline void add_stranger(JoinedFibers& fibers, Random& random) {
  const auto near =
      static_cast<std::size_t>(random.integer(0, static_cast<int>(fibers.points.size()) - 1));
  Curve chain{fibers.points[near] + random.in_cube(0.3)};
  for (int i = random.integer(1, 12); i > 0; --i) {
    chain.push_back(chain.back() + 0.2 * random.direction());
  }
  fibers.add(chain, random.uniform(0.02, 0.2));
}

inline JoinedFibers random_family(Random& random) {
  constexpr double degree = turn / 360.0;
  switch (random.integer(0, 3)) {
    case 0:
      return random_tree(random, random.integer(2, 8), 14);
    case 1:
      return random_net(random, random.integer(2, 4), random.integer(1, 4));
    case 2:
      return random_rings(random);
    default:
      return fork(random, degree * random.uniform(5.0, 175.0));
  }
}

/// A scene of one of these families, with strangers.
inline JoinedFibers random_joined_fibers(Random& random) {
  JoinedFibers fibers = random_family(random);
  for (int i = random.integer(0, 2); i > 0; --i) {
    add_stranger(fibers, random);
  }
  return fibers;
}

/// Other places of the same fibres: what is joined moves together.
inline JoinedFibers bent(JoinedFibers fibers, Random& random) {
  const Eigen::Vector3d way = random.in_cube();
  const double waves = random.uniform(0.2, 2.0);
  for (Eigen::Vector3d& point : fibers.points) {
    point += 0.3 * std::sin(waves * point.dot(way)) * way;
  }
  return fibers;
}

/// Places far from there: each point goes its own way, those of a joint the same.
inline JoinedFibers shaken(JoinedFibers fibers, Random& random) {
  std::map<std::int32_t, Eigen::Vector3d> ways;
  for (std::size_t i = 0; i < fibers.points.size(); ++i) {
    Eigen::Vector3d way = random.in_cube(0.5);
    if (const std::int32_t joint = fibers.topology.joints[i]; joint >= 0) {
      way = ways.emplace(joint, way).first->second;
    }
    fibers.points[i] += way;
  }
  return fibers;
}

}  // namespace fiber::test
