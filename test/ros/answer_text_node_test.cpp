// What the running node's text says of its answers: it encloses the exact ones, whatever the node
// is asked for and whatever is unknown.
#include <visualization_msgs/MarkerArray.h>

#include <set>

#include "fiber_proximity/ApplyObstacles.h"
#include "test/ros/answer_claims.hpp"
#include "test/ros/live_settings.hpp"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/random.hpp"

namespace {

using answer_claims::Claims;
using answer_claims::claims_of;
using answer_claims::infinity;
using fiber::FiberAssembly;
using fiber_proximity::FiberArray;
using fiber_proximity::ProximityConfig;
using fiber_proximity::Statistics;
using node_test::set_parameters;
using test_messages::fiber_array;
using test_messages::header;
using visualization_msgs::MarkerArray;

class AnswerTextTest : public node_test::NodeTest {
 protected:
  void SetUp() override { connect(fibers_publisher_, cables()); }

  /// Three cables side by side.
  static FiberArray cables() {
    FiberArray message =
        fiber_array(header("world"),
                    {{0, 0, 0}, {1, 0, 0}, {0, 0.0377, 0}, {1, 0.0377, 0}, {0, 1, 0}, {1, 1, 0}});
    message.offsets = {0, 2, 4, 6};
    return message;
  }

  /// Sends the input without which answers about fibres are incomplete.
  void send_rope() {
    set_parameters(shown());
    const ros::Publisher rope = advertise<FiberArray>("rope");
    FiberArray message = fiber_array(header("world"), {{5, 0, 0}, {5, 1, 0}});
    ASSERT_TRUE(node_test::wait_for([&] {
      message.header.stamp = new_stamp();
      rope.publish(message);
      const Statistics* const told = statistics.wait_for(message.header.stamp);
      return told != nullptr && told->complete != 0;
    }));
  }

  static ProximityConfig shown() {
    ProximityConfig config = ProximityConfig::__getDefault__();
    config.show_cost = true;
    return config;
  }

  /// The lines of the answer about these fibres. The first two are the marker's, too.
  std::vector<std::string> lines_about(FiberArray message) {
    stamp_ = message.header.stamp = new_stamp();
    fibers_publisher_.publish(message);
    const Statistics* const told = statistics.wait_for(stamp_);
    const std::string* drawn = nullptr;
    node_test::wait_for([&] { return (drawn = drawn_text()) != nullptr; });
    if (told == nullptr || drawn == nullptr) {
      ADD_FAILURE() << "no answer, or none is drawn";
      return {3, ""};
    }
    std::vector<std::string> lines = split(told->summary);
    EXPECT_EQ(lines.size(), 3U) << told->summary;
    lines.resize(3);
    std::vector<std::string> of_marker = split(*drawn);
    of_marker.resize(3);
    EXPECT_EQ(of_marker[0], lines[0]);
    EXPECT_EQ(of_marker[1], lines[1]);
    EXPECT_NE(of_marker[2].find(" ms"), std::string::npos) << of_marker[2];
    EXPECT_EQ(told->parts.size(), told->part_complete.size());
    return lines;
  }

  void forget() {
    drawn_.clear();
    contacts.messages.clear();
    fibers.messages.clear();
    statistics.messages.clear();
  }

  ros::Time stamp_;

 private:
  static std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      lines.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    return lines;
  }

  const std::string* drawn_text() const {
    for (const MarkerArray::ConstPtr& message : drawn_) {
      for (const visualization_msgs::Marker& marker : message->markers) {
        if (marker.ns == "cost" && marker.header.stamp == stamp_ &&
            marker.action == visualization_msgs::Marker::ADD) {
          return &marker.text;
        }
      }
    }
    return nullptr;
  }

  ros::Publisher fibers_publisher_ = advertise<FiberArray>("fibers");
  std::vector<MarkerArray::ConstPtr> drawn_;
  ros::Subscriber markers_ = node.subscribe<MarkerArray>(
      "/proximity/markers", 1000,
      [this](const MarkerArray::ConstPtr& message) { drawn_.push_back(message); });
};

TEST_F(AnswerTextTest, OfAnInputThatHasNotComeYetNothingIsToldAsComplete) {
  ProximityConfig config = shown();
  config.margin = 0.1;
  set_parameters(config);
  std::vector<std::string> lines = lines_about(cables());
  EXPECT_EQ(lines[0].rfind("robust: at least 1 contacts (each to ", 0), 0U) << lines[0];
  EXPECT_NE(lines[0].find(", of what is known, closest known 27.7 mm, true may be closer"),
            std::string::npos)
      << lines[0];
  EXPECT_NE(lines[1].find(", of what is known"), std::string::npos) << lines[1];
  send_rope();
  set_parameters(config);
  lines = lines_about(cables());
  EXPECT_EQ(lines[0].rfind("robust: 1 of 1 contacts (each to ", 0), 0U) << lines[0];
  EXPECT_NE(lines[0].find("closest 27.7 mm (to "), std::string::npos) << lines[0];
  EXPECT_EQ(lines[1].rfind("objects: ", 0), 0U) << lines[1];
}

TEST_F(AnswerTextTest, ToleranceAndDeadlineAreInTheTextAtOnce) {
  send_rope();
  ProximityConfig config = shown();
  config.query_type = "closest";
  config.margin = 1.0;
  config.tolerance = 0.02;
  set_parameters(config);
  std::vector<std::string> lines = lines_about(cables());
  const Statistics* told = statistics.wait_for(stamp_);
  ASSERT_GT(told->minimum_upper - told->minimum_lower, 0.01) << "nothing is given up";
  EXPECT_EQ(lines[0].rfind("robust: closest 27.7 mm, true >= 7.", 0), 0U) << lines[0];
  EXPECT_LE(claims_of(lines[0]).minimum_lower, told->minimum_lower);
  EXPECT_NEAR(claims_of(lines[0]).minimum_lower, told->minimum_lower, 1e-4);

  config.query_type = "all";
  config.tolerance = 0.0;
  config.deadline = 1e-9;
  set_parameters(config);
  lines = lines_about(cables());
  EXPECT_EQ(lines[0].rfind("robust: at least ", 0), 0U) << lines[0];
  EXPECT_NE(lines[0].find(", cut off"), std::string::npos) << lines[0];
  EXPECT_NE(lines[2].find("contacts 0.0"), std::string::npos) << lines[2];
  EXPECT_NE(lines[2].find("(incomplete)"), std::string::npos) << lines[2];
}

/// What is true of a question about pairs.
struct Truth {
  std::vector<fiber::Contact> pairs;  // all there are
  std::size_t contacts = 0;  // pairs within the margin, of bodies where these are asked for
};

/// @param ask for the pairs that are within the margin
template <class Ask>
Truth truth_of(fiber::QueryOptions options, const Ask& ask) {
  options.kernel = fiber::Kernel::EXACT;
  Truth truth;
  const bool is_of_bodies = options.type == fiber::QueryType::FIBER_PAIRS;
  options.type = fiber::QueryType::ALL;
  std::set<std::pair<std::uint32_t, std::uint32_t>> bodies;
  const std::vector<fiber::Contact> within = ask(options).contacts;
  for (const fiber::Contact& contact : within) {
    bodies.emplace(contact.fiber_a, contact.fiber_b);
  }
  truth.contacts = is_of_bodies ? bodies.size() : within.size();
  options.margin = infinity;
  truth.pairs = ask(options).contacts;
  return truth;
}

void expect_true(const std::string& line, const Truth& truth) {
  const Claims claims = claims_of(line);
  EXPECT_LE(claims.min_contacts, truth.contacts) << line;
  EXPECT_GE(claims.max_contacts, truth.contacts) << line;
  const auto closest = std::min_element(truth.pairs.begin(), truth.pairs.end(), fiber::closer);
  if (closest == truth.pairs.end()) {
    EXPECT_EQ(claims.minimum_upper, infinity) << line;
    return;
  }
  EXPECT_LE(claims.minimum_lower, closest->upper) << line;
  EXPECT_GE(claims.minimum_upper, closest->lower) << line;
  const auto nearer = std::count_if(
      truth.pairs.begin(), truth.pairs.end(),
      [&claims](const fiber::Contact& pair) { return pair.upper < claims.others_lower; });
  EXPECT_LE(static_cast<std::size_t>(nearer), claims.min_contacts) << line;
}

/// The objects of answer_text.test.
FiberAssembly objects() {
  const Eigen::Vector3d ball(0.3, 0.1, -0.2);
  const Eigen::Vector3d bead(-0.5, 0.2, 0.4);
  return {{ball, ball, bead, bead}, {0, 2, 4}, {0.2, 0.05}};
}

/// Adds an object that is nowhere, which nothing is known of then, or takes it away.
void place_ghost(bool is_there) {
  fiber_proximity::ApplyObstacles call;
  call.request.obstacles = {test_messages::ball("ghost", 0.0, 0.1, "nowhere")};
  if (!is_there) {
    call.request.obstacles[0].operation = fiber_proximity::Obstacle::REMOVE;
  }
  ASSERT_TRUE(node_test::call_service("/proximity/apply_obstacles", call));
  EXPECT_FALSE(call.response.success) << "there is no such frame, and never was such an object";
}

ProximityConfig random_settings(fiber::test::Random& random, ProximityConfig config) {
  const std::vector<std::string> types{"first", "closest", "limited", "all", "fiber_pairs"};
  const auto some = [&random](double chance, double lowest, double highest) {
    return random.chance(chance) ? std::pow(10.0, random.uniform(lowest, highest)) : 0.0;
  };
  config.query_type = types[static_cast<std::size_t>(random.integer(0, 4))];
  config.margin = some(0.8, -3.0, 0.3);
  config.max_contacts = random.integer(1, 30);
  config.kernel = random.chance(0.3) ? "exact" : "robust";
  config.tolerance = some(0.4, -6.0, -0.5);
  config.relative_tolerance = some(0.3, -4.0, 0.0);
  config.deadline = some(0.4, -9.0, -3.0);
  config.minimum_distance = random.chance(0.8);
  config.contact_limit = random.chance(0.2) ? random.integer(1, 50) : 0;
  config.pair_limit = random.chance(0.2) ? random.integer(1, 300) : 0;
  return config;
}

fiber::QueryOptions question_of(const ProximityConfig& config) {
  fiber::QueryOptions options;
  options.type = fiber::query_type_from_name(config.query_type);
  options.margin = config.margin;
  return options;
}

FiberArray random_fibers(fiber::test::Random& random) {
  const FiberAssembly walks = fiber::test::walks(
      random, random.integer(1, 6), random.integer(1, 12), random.uniform(0.01, 0.3), 0.0);
  FiberArray message = fiber_array(header("world"), walks.points());
  message.offsets = walks.offsets();
  message.radii = {random.uniform(0.0, 0.03)};
  return message;
}

// The rope that is far away counts, too: what is told is held against all that ~fibers has.
TEST_F(AnswerTextTest, WhatIsToldEnclosesTheExactAnswer) {
  int frames = 0;
  ASSERT_TRUE(ros::param::get("~frames", frames));
  send_rope();
  fiber::test::Random random;
  bool has_ghost = false;
  int cut_off = 0;
  int doubtful = 0;
  for (int frame = 0; frame < frames && !HasFailure(); ++frame) {
    SCOPED_TRACE("frame " + std::to_string(frame) + ", " + fiber::test::seed_message());
    if (random.chance(0.05)) {
      has_ghost = !has_ghost;
      place_ghost(has_ghost);
    }
    const ProximityConfig config = random_settings(random, shown());
    set_parameters(config);
    const std::vector<std::string> lines = lines_about(random_fibers(random));
    const FiberArray* const sent = fibers.wait_for(stamp_);
    ASSERT_NE(sent, nullptr);
    const FiberAssembly about = node_test::to_assembly(*sent);
    expect_true(lines[0], truth_of(question_of(config), [&](const fiber::QueryOptions& options) {
                  return fiber::test::brute_force(about, options);
                }));
    expect_true(lines[1], truth_of(question_of(config), [&](const fiber::QueryOptions& options) {
                  return fiber::test::brute_force(objects(), about, options);
                }));
    if (has_ghost) {
      const Claims claims = claims_of(lines[1]);
      EXPECT_EQ(claims.minimum_lower, -infinity) << lines[1];
      EXPECT_EQ(claims.max_contacts, Claims().max_contacts) << lines[1];
    }
    cut_off += static_cast<int>(lines[0].find("cut off") != std::string::npos);
    doubtful += static_cast<int>(lines[0].find(", true >= ") != std::string::npos);
    forget();
  }
  place_ghost(false);
  fiber::test::expect_enough(cut_off, frames / 10);
  fiber::test::expect_enough(doubtful, frames / 10);
}

}  // namespace
