// Holds that tear what is joined.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "src/sim/scene/rope_net.hpp"
#include "test/sim/scene/scene_fixture.hpp"
#include "test/support/random.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// The least energy of a net's ropes, joint by joint: an oracle that is slow and simple.
double least_energy(const RopeNet& net, std::vector<Vector3d> ends) {
  double energy = 0.0;
  double moved = 1.0;  // in the last sweep, at most
  for (int sweep = 0; sweep < 20000 && moved > 1e-15; ++sweep) {
    moved = 0.0;
    for (std::size_t joint = 0; joint < net.joint_count; ++joint) {
      Vector3d sum = Vector3d::Zero();
      int count = 0;
      for (const RopeNet::Rope& rope : net.ropes) {
        if (rope.from != joint && rope.to != joint) {
          continue;
        }
        // Where this rope alone would have the joint: the mean is where the majorant is least.
        const Vector3d other = ends[rope.from == joint ? rope.to : rope.from];
        const Vector3d way = ends[joint] - other;
        sum += other + std::min(1.0, rope.length / way.norm()) * way;
        ++count;
      }
      moved = std::max(moved, (sum / count - ends[joint]).norm());
      ends[joint] = sum / count;
    }
  }
  for (const RopeNet::Rope& rope : net.ropes) {
    const double by = std::max(0.0, (ends[rope.to] - ends[rope.from]).norm() - rope.length);
    energy += by * by;
  }
  return energy;
}

/// Nets of each shape: of those that an oracle tears, all are found, and no other.
TEST(RopeNet, IsTornWhereNoPlacesAreLeft) {
  int torn = 0;
  int whole = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    test::Random random(seed);
    const auto joints = static_cast<std::size_t>(random.integer(1, 6));
    const auto holds = static_cast<std::size_t>(random.integer(2, 6));
    const bool is_flat = random.chance(0.3);
    std::vector<Vector3d> ends;
    for (std::size_t i = 0; i < joints + holds; ++i) {
      ends.push_back(random.in_cube(1.0));
      ends.back().z() *= is_flat ? 0.0 : 1.0;
    }
    RopeNet net{joints, {}};
    const auto add = [&](std::size_t from, std::size_t to) {
      net.ropes.push_back({from, to, random.uniform(0.2, 1.4)});
    };
    for (std::size_t i = 1; i < joints; ++i) {
      add(i, static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1)));
    }
    for (std::size_t i = 0; i < holds; ++i) {
      add(static_cast<std::size_t>(random.integer(0, static_cast<int>(joints) - 1)), joints + i);
    }
    const double least = least_energy(net, ends);
    if (least > 1e-6) {
      ++torn;
      EXPECT_FALSE(tearing_tensions(net, ends).empty()) << least;
    } else if (least < 1e-16) {
      ++whole;
      EXPECT_TRUE(tearing_tensions(net, ends).empty()) << least;
    }
  }
  test::expect_enough(torn, 30);
  test::expect_enough(whole, 30);
}

struct Arm {
  std::string name;
  Vector3d from;
  Vector3d to;
  std::string path;  ///< of what holds its end; empty: nothing does
};

std::string text_of(const Vector3d& at) {
  return "[" + std::to_string(at.x()) + ", " + std::to_string(at.y()) + ", " +
         std::to_string(at.z()) + "]";
}

std::string scene_of(const std::vector<Arm>& arms, const std::string& joints) {
  std::string fibers = "fibers:\n";
  std::string holds;
  for (const Arm& arm : arms) {
    fibers += "  - {name: " + arm.name + ", shape: {line: {from: " + text_of(arm.from) +
              ", to: " + text_of(arm.to) + "}}, segments: 5, radius: 0.01, material: rope}\n";
    if (!arm.path.empty()) {
      holds += (holds.empty() ? "{fiber: " : ", {fiber: ") + arm.name + ", node: last, " +
               arm.path + "}";
    }
  }
  return fibers + "effects: [stretch, {joint: [" + joints + "]}, {attachment: [" + holds + "]}]\n";
}

std::string going(const Vector3d& to) {
  return "path: [{time: 0}, {time: 3, position: " + text_of(to) + "}]";
}

/// A star of arms of 1 m, whose ends are held on a circle about the middle: by three it may be a
/// tenth longer than the arms, where any two of them would let go further.
TEST_F(SimSceneTest, ThreeHoldsTearWhatTwoDoNot) {
  const auto star = [](int count, double radius) {
    std::vector<Arm> arms;
    std::string nodes;
    for (int i = 0; i < count; ++i) {
      const double angle = 2.0 * M_PI * i / count;
      const Vector3d out(std::cos(angle), std::sin(angle), 0.0);
      arms.push_back({"arm_" + std::to_string(i), Vector3d::Zero(), out, going(radius * out)});
      nodes += (i > 0 ? ", {fiber: " : "{fiber: ") + arms.back().name + "}";
    }
    return scene_of(arms, "{nodes: [" + nodes + "]}");
  };
  for (const int count : {3, 5, 12}) {
    SCOPED_TRACE(count);
    EXPECT_NO_THROW(read(star(count, 1.0999)));
    const std::string error = error_of([&] { read(star(count, 1.1001)); });
    EXPECT_NE(error.find("joint[0]: at 3 s, what holds node 5 of "), std::string::npos) << error;
    EXPECT_NE(error.find(" % at least, more than 10 % (max_strain)"), std::string::npos) << error;
    // Of more than needed, those are named that tear it.
    std::size_t named = 0;
    for (std::size_t at = 0; (at = error.find("node 5 of ", at)) != std::string::npos; ++at) {
      ++named;
    }
    EXPECT_LE(named, 4U) << error;
    EXPECT_GE(named, count % 2 == 0 ? 2U : 3U) << error;
  }
}

/// An H that four holds pull wider: each of its joints has a place that all holds reach, but both
/// together have none.
std::vector<Arm> wide(const std::vector<std::string>& paths) {
  const double along = std::sqrt(0.6 * 0.6 - 0.5 * 0.5);
  const Vector3d middle(0.65, 0.0, 0.0);
  std::vector<Arm> arms{{"bar", -middle, middle, ""}};
  for (int i = 0; i < 4; ++i) {
    const double side = i < 2 ? -1.0 : 1.0;
    const Vector3d out(side * along, i % 2 == 0 ? 0.5 : -0.5, 0.0);
    arms.push_back({"arm_" + std::to_string(i), side * middle, side * middle + out, paths[i]});
  }
  return arms;
}

constexpr const char* both_ends =
    "{nodes: [{fiber: bar}, {fiber: arm_0}, {fiber: arm_1}]}, "
    "{nodes: [{fiber: bar, node: last}, {fiber: arm_2}, {fiber: arm_3}]}";

Vector3d corner(int i, double width) {
  return {i < 2 ? -width : width, i % 2 == 0 ? 0.5 : -0.5, 0.0};
}

TEST_F(SimSceneTest, FourHoldsTearTwoJointsTogether) {
  const double most = std::sqrt(0.66 * 0.66 - 0.5 * 0.5) + 1.1 * 0.65;
  const auto pulled = [](double width) {
    std::vector<std::string> paths;
    for (int i = 0; i < 4; ++i) {
      paths.push_back(going(corner(i, width)));
    }
    return scene_of(wide(paths), both_ends);
  };
  EXPECT_NO_THROW(read(pulled(0.9999 * most)));
  const std::string error = error_of([&] { read(pulled(1.0001 * most)); });
  EXPECT_NE(error.find("]: at 3 s, what holds node 5 of fibre 'arm_0' at (-1.15"),
            std::string::npos)
      << error;
  EXPECT_NE(error.find("'arm_1'"), std::string::npos) << error;
  EXPECT_NE(error.find("'arm_2'"), std::string::npos) << error;
  EXPECT_NE(error.find("'arm_3'"), std::string::npos) << error;
  EXPECT_NE(error.find(" stretches the fibres between by 10.0"), std::string::npos) << error;
}

/// Two sides go out each in its own rhythm: at once for the first time at 13 s, in the
/// third round of the longer one.
TEST_F(SimSceneTest, PeriodsThatMeetLaterTear) {
  const auto rhythm = [](double narrow, double period) {
    std::vector<std::string> paths;
    for (int i = 0; i < 4; ++i) {
      const std::string out = "position: " + text_of(corner(i, 1.2));
      const std::string in = "position: " + text_of(corner(i, narrow));
      paths.push_back(i < 2 ? "path: [{time: 0}, {time: 1, " + out + "}, {time: 2, " + in +
                                  "}], period: 3"
                            : "path: [{time: 0}, {time: 2, " + in + "}, {time: 3, " + out +
                                  "}, {time: 4, " + in + "}], period: " + std::to_string(period));
    }
    return scene_of(wide(paths), both_ends);
  };
  EXPECT_NE(error_of([&] { read(rhythm(0.95, 5.0)); }).find("]: at 13 s, what holds "),
            std::string::npos);
  EXPECT_NO_THROW(read(rhythm(0.95, 6.0)));  // never at once
}

}  // namespace
}  // namespace fiber
