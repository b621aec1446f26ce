// Recorded cables through the whole graph: players, transforms, node, contacts.
#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using Points = std::vector<Eigen::Vector3d>;

/// The points of one fibre that the player sends, brought into the fixed frame by the test itself.
std::vector<Points> read_track(const std::string& file, std::size_t fiber,
                               const Eigen::Isometry3d& transform) {
  std::vector<Points> track;
  for (const fiber::FiberFrame& frame : fiber::read_csv(file).frames) {
    const std::vector<std::uint32_t>& offsets = frame.fibers.offsets();
    track.emplace_back();
    for (std::uint32_t i = offsets[fiber]; i < offsets[fiber + 1]; ++i) {
      // A cloud of TrackDLO's kind holds single precision.
      track.back().push_back(transform * frame.fibers.points()[i].cast<float>().cast<double>());
    }
  }
  return track;
}

Eigen::Isometry3d read_transform(const std::string& text) {
  std::istringstream stream(text);
  std::array<double, 6> v{};
  for (double& value : v) {
    stream >> value;
  }
  return Eigen::Translation3d(v[0], v[1], v[2]) *
         Eigen::AngleAxisd(v[3], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(v[4], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(v[5], Eigen::Vector3d::UnitX());
}

double distance(const Points& a, const Points& b) {
  if (a.size() != b.size()) {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i] - b[i]).norm());
  }
  return largest;
}

class TracksTest : public node_test::NodeTest {
 protected:
  /// Answers and the fibres they are about: those of stamps that only one update had.
  std::vector<std::pair<const FiberArray*, const ContactArray*>> answers() const {
    std::map<ros::Time, std::pair<std::vector<const FiberArray*>, std::vector<const ContactArray*>>>
        by_stamp;
    for (const auto& message : fibers.messages) {
      by_stamp[message->header.stamp].first.push_back(message.get());
    }
    for (const auto& message : contacts.messages) {
      by_stamp[message->header.stamp].second.push_back(message.get());
    }
    std::vector<std::pair<const FiberArray*, const ContactArray*>> found;
    for (const auto& [stamp, update] : by_stamp) {
      if (update.first.size() == 1 && update.second.size() == 1 &&
          update.first[0]->names.size() == 3) {
        found.emplace_back(update.first[0], update.second[0]);
      }
    }
    return found;
  }
};

TEST_F(TracksTest, ThreeTrackersAgreeWithBruteForcePairForPair) {
  const ros::NodeHandle parameters("~");
  std::vector<std::string> files;
  std::vector<int> chosen;
  std::string transform;
  double radius = 0.0;
  ASSERT_TRUE(parameters.getParam("files", files) && parameters.getParam("fibers", chosen) &&
              parameters.getParam("transform", transform) && parameters.getParam("radius", radius));
  std::vector<std::vector<Points>> tracks;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::ifstream(files[i])) {
      GTEST_SKIP() << "there is no " << files[i];
    }
    tracks.push_back(
        read_track(files[i], static_cast<std::size_t>(chosen[i]),
                   i == 1 ? read_transform(transform) : Eigen::Isometry3d::Identity()));
  }
  ASSERT_TRUE(node_test::wait_for([this] { return answers().size() >= 200; }));

  std::vector<std::set<std::size_t>> frames_seen(3);
  std::size_t pairs_between_cables = 0;
  for (const auto& [merged, answer] : answers()) {
    EXPECT_EQ(merged->header.frame_id, "world");
    EXPECT_EQ(merged->names, (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(answer->fiber_names, merged->names);
    const fiber::FiberAssembly assembly = node_test::to_assembly(*merged);
    EXPECT_EQ(assembly.segment_radius(0), radius);
    for (std::size_t i = 0; i < 3; ++i) {
      const Points points(assembly.points().begin() + assembly.offsets()[i],
                          assembly.points().begin() + assembly.offsets()[i + 1]);
      const auto frame = std::min_element(tracks[i].begin(), tracks[i].end(),
                                          [&points](const Points& a, const Points& b) {
                                            return distance(a, points) < distance(b, points);
                                          });
      ASSERT_LE(distance(*frame, points), 1e-9) << "tracker "
                                                << "abc"[i];
      frames_seen[i].insert(static_cast<std::size_t>(frame - tracks[i].begin()));
    }
    node_test::expect_brute_force(*answer, *merged);
    ASSERT_FALSE(HasFailure());
    pairs_between_cables += static_cast<std::size_t>(
        std::count_if(answer->contacts.begin(), answer->contacts.end(),
                      [](const auto& contact) { return contact.fiber_a != contact.fiber_b; }));
  }
  for (const std::set<std::size_t>& frames : frames_seen) {
    EXPECT_GE(frames.size(), 10U);
  }
  std::cout << answers().size() << " answers, " << pairs_between_cables
            << " contacts between cables\n";
  EXPECT_GT(pairs_between_cables, 100U) << "the scene shows nothing";
}

}  // namespace
