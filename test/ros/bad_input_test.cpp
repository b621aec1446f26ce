// What the running node does with input nobody should send: one clear error, nothing else.
#include <tf2_msgs/TFMessage.h>

#include <cstdio>
#include <limits>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/ros/running_node.hpp"
#include "test/support/process.hpp"

namespace {

using fiber_proximity::FiberArray;
using test_messages::header;
using test_messages::Points;
using visualization_msgs::Marker;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

class BadInputTest : public node_test::NodeTest {
 protected:
  void SetUp() override {
    good_ = advertise<FiberArray>("good");
    connect(good_, good_message());
  }

  static FiberArray good_message() {
    FiberArray message = test_messages::fiber_array(
        header("world", new_stamp()), {{0, 0, 0}, {1, 0, 0}, {0, 0.001, 0}, {1, 0.001, 0}});
    message.offsets = {0, 2, 4};
    return message;
  }

  /// A message of one fibre of four points that is all right.
  static FiberArray array(const std::string& frame = "world") {
    return test_messages::fiber_array(header(frame, new_stamp()), chain());
  }

  static Points chain() { return {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}; }

  static sensor_msgs::PointCloud2 cloud(const Points& points = chain()) {
    return test_messages::point_cloud2(header("world", new_stamp()), points);
  }

  /// Sends the message and expects that it is refused for this reason, with one log entry, without
  /// an answer, and that the node goes on.
  template <class Message>
  void expect_refused(const std::string& topic, const Message& message, const std::string& reason) {
    SCOPED_TRACE(topic);
    const std::size_t answers = contacts.messages.size();
    const std::size_t drawn = fibers.messages.size();
    const ros::Publisher publisher = advertise<Message>("bad/" + topic);
    publisher.publish(message);
    const std::string label = "input 'bad/" + topic + "'";
    ASSERT_TRUE(node_test::wait_for([&] { return !logs_of(label).empty(); })) << "no error";
    EXPECT_NE(logs_of(label).front().find("message refused: " + reason), std::string::npos)
        << logs_of(label).front();

    const FiberArray next = good_message();
    good_.publish(next);
    const fiber_proximity::Statistics* now = statistics.wait_for(next.header.stamp);
    ASSERT_NE(now, nullptr) << "the node does not live on";
    const fiber_proximity::InputStatistics* input = input_of(*now, "bad/" + topic);
    ASSERT_NE(input, nullptr);
    EXPECT_EQ(input->received, 1U);
    EXPECT_EQ(input->refused, 1U);
    EXPECT_EQ(input->fibers, 0U);
    EXPECT_EQ(input->last_error.rfind(reason, 0), 0U) << input->last_error;
    EXPECT_EQ(now->fibers, 2U);
    ASSERT_NE(contacts.wait_for(next.header.stamp), nullptr);
    ASSERT_NE(fibers.wait_for(next.header.stamp), nullptr);
    EXPECT_EQ(contacts.messages.size(), answers + 1) << "the bad message was answered";
    EXPECT_EQ(fibers.messages.size(), drawn + 1) << "the bad message was answered";
    EXPECT_EQ(logs_of(label).size(), 1U);
  }

  ros::Publisher good_;
};

/// What a second node says and returns that does not start.
struct Refusal {
  std::string output;
  int exit_code = 0;
};

/// One that starts all the same is ended, and returns what `timeout` does.
Refusal run_node(const std::string& arguments) {
  Refusal refusal;
  const std::string command = "timeout " + std::to_string(node_test::patience) +
                              " " PROXIMITY_NODE " __name:=refused " + arguments + " 2>&1";
  FILE* const pipe = popen(command.c_str(), "r");  // NOLINT(bugprone-command-processor)
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) {
    refusal.output.push_back(static_cast<char>(c));
  }
  refusal.exit_code = WEXITSTATUS(pclose(pipe));
  return refusal;
}

TEST_F(BadInputTest, BadEntriesOfInputsAreLeftOutWithAnErrorEach) {
  EXPECT_EQ(statistics.messages.back()->inputs.size(), 29U + 2U);  // and ~obstacles and markers
  // The same list for a node whose log can be read from its beginning.
  XmlRpc::XmlRpcValue inputs;
  ASSERT_TRUE(ros::param::get("/proximity/inputs", inputs));
  ros::param::set("/refused/inputs", inputs);
  const std::string log = run_node("_crossings:=none _margn:=0.1").output;
  EXPECT_TRUE(ros::param::del("/refused/inputs"));
  const auto expect_left_out = [&log](int entry, const std::string& reason) {
    const std::string prefix =
        "parameter /refused/inputs, entry " + std::to_string(entry) + " is left out: ";
    const std::size_t found = log.find(prefix);
    ASSERT_NE(found, std::string::npos) << reason;
    EXPECT_EQ(log.substr(found, prefix.size() + reason.size()), prefix + reason);
    EXPECT_EQ(log.find(prefix, found + 1), std::string::npos);
  };
  expect_left_out(1,
                  "unknown input type 'std_msgs/String', known are: fiber_proximity/FiberArray,");
  expect_left_out(2, "has no key 'topic'");
  expect_left_out(3, "has the unknown key 'colour', known are: topic, type,");
  expect_left_out(4, "key 'radius' is thick, it must be a number of metres, at least 0");
  expect_left_out(5, "key 'topic' is yaml/not a name, it must be a ROS name");
  expect_left_out(6, "is yaml_no_map, it must be a map with the key 'topic' at least");
  expect_left_out(36,
                  "key 'name' is good (without it, the topic), as of parameter /refused/inputs, "
                  "entry 0, it must be another one");
  EXPECT_NE(log.find("parameter /refused/margn is unknown and not used; is margin meant?"),
            std::string::npos);
  ros::param::del("/refused");
}

TEST_F(BadInputTest, ATopicOfTwoTypesIsThatOfTheFirst) {
  XmlRpc::XmlRpcValue inputs;
  inputs[0]["topic"] = "good";
  inputs[1]["topic"] = "good";
  inputs[1]["type"] = "sensor_msgs/PointCloud2";
  inputs[1]["name"] = "another type";
  inputs[2]["topic"] = "two_types/obstacles";
  inputs[2]["type"] = "sensor_msgs/PointCloud2";
  inputs[3]["topic"] = "two_types/fibers";
  XmlRpc::XmlRpcValue markers;
  markers[0] = "good";
  markers[1] = "two_types/obstacles";
  markers[2] = "two_types/cloud";
  ros::param::set("/two_types/inputs", inputs);
  ros::param::set("/two_types/obstacle_markers", markers);
  const fiber::test::TemporaryDirectory directory;
  node_test::RunningNode running({PROXIMITY_NODE, "__name:=two_types", "_cloud:=true"},
                                 directory.path("log"));
  for (const std::string error :
       {"parameter /two_types/inputs, entry 1 is left out: its topic is subscribed to with another "
        "type already",
        "parameter /two_types/inputs, entry 2 is left out: key 'topic' is two_types/obstacles, it "
        "must be none of the node's own topics",
        "parameter /two_types/inputs, entry 3 is left out: key 'topic' is two_types/fibers",
        "parameter ~obstacle_markers, topic 'good' is left out: its topic is",
        "parameter ~obstacle_markers, topic 'two_types/obstacles' is left out: its topic is",
        "parameter ~obstacle_markers, topic 'two_types/cloud' is left out: its topic is"}) {
    ASSERT_TRUE(node_test::wait_for([&] {
      return running.output().find(error) != std::string::npos;
    })) << error
        << " is not in " << running.output();
  }
  // The others go on.
  node_test::Recorder<fiber_proximity::FiberArray> fibers_of(node, "/two_types/fibers");
  ASSERT_TRUE(node_test::wait_for([&] {
    good_.publish(good_message());
    return !fibers_of.messages.empty();
  })) << running.output();
  EXPECT_EQ(fibers_of.messages.back()->offsets.size(), 3U);
  EXPECT_EQ(running.stop(), 0);
  ros::param::del("/two_types");
}

TEST_F(BadInputTest, AnEmptyListOfInputsIsAllowedWithAWarning) {
  XmlRpc::XmlRpcValue none;
  none.setSize(0);
  ros::param::set("/no_inputs/inputs", none);
  const fiber::test::TemporaryDirectory directory;
  node_test::RunningNode running({PROXIMITY_NODE, "__name:=no_inputs"}, directory.path("log"));
  EXPECT_TRUE(ros::service::waitForService("/no_inputs/query", ros::Duration(30.0)));
  EXPECT_EQ(running.stop(), 0);
  EXPECT_NE(running.output().find("parameter /no_inputs/inputs is an empty list"),
            std::string::npos)
      << running.output();
  ros::param::del("/no_inputs");
}

TEST_F(BadInputTest, MalformedFiberArraysAreRefused) {
  FiberArray message = array();
  message.points[2].y = nan;
  expect_refused("nan_point", message, "fibre 0, point 2: y is nan");

  message = array();
  message.points[3].z = -infinity;
  expect_refused("infinite_point", message, "fibre 0, point 3: z is -inf");

  message = array();
  message.radii = {-0.5};
  expect_refused("negative_radius", message, "the radius is -0.5");

  message = array();
  message.offsets = {0, 2, 4};
  message.radii = {0.5, nan};
  expect_refused("nan_radius", message, "fibre 1: the radius is nan");

  message = array();
  message.radii = {0.5, 0.5};
  expect_refused("radius_count", message, "2 radii for 1 fibre(s) of 4 points");

  message = array();
  message.offsets = {0, 3, 2, 4};
  expect_refused("decreasing_offsets", message, "fibre 1: offsets decrease from 3 to 2");

  message = array();
  message.offsets = {0, 2, 7};
  expect_refused("overrunning_offsets", message, "fibre 1: offset 7 lies beyond the 4 points");

  message = array();
  message.offsets = {0, 2};
  expect_refused("points_left_over", message, "the last offset is 2, but there are 4 points");

  message = array();
  message.offsets.clear();
  expect_refused("no_offsets", message, "offsets must start with 0, but are empty");

  message = array();
  message.offsets = {0, 3, 4};
  expect_refused("one_point", message, "fibre 1: has 1 point(s), a fibre needs at least 2");

  message = array();
  message.offsets = {0, 4, 4};
  expect_refused("empty_fiber", message, "fibre 1: has 0 point(s), a fibre needs at least 2");

  message = array();
  message.names = {"one", "too many"};
  expect_refused("names", message, "2 names for 1 fibre(s)");
}

TEST_F(BadInputTest, MessagesWithoutATransformAreRefused) {
  expect_refused("no_frame", array(""), "header.frame_id is empty");
  expect_refused("unknown_frame", array("nowhere"),
                 "no transform from frame 'nowhere' to 'world' at time ");
  EXPECT_FALSE(logs_of("unknown frame: ").empty());
  expect_refused("island", array("crater"), "no transform from frame 'crater' to 'world' at time ");
  EXPECT_FALSE(logs_of("frames not connected: ").empty());

  // Known now, but not at the time of the message.
  tf2_msgs::TFMessage transforms;
  transforms.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = transforms.transforms.front();
  transform.header = header("world", ros::Time::now() - ros::Duration(100.0));
  transform.child_frame_id = "moving";
  transform.transform.rotation.w = 1.0;
  const ros::Publisher tf = advertise<tf2_msgs::TFMessage>("/tf");
  tf.publish(transforms);
  fiber_proximity::QueryProximity query;
  query.request.shapes.resize(1);
  query.request.shapes[0].header.frame_id = "moving";
  query.request.shapes[0].points.resize(1);
  ASSERT_TRUE(node_test::wait_for([&] {
    return node_test::call_service("/proximity/query", query) && query.response.success;
  })) << query.response.message;
  FiberArray message = array("moving");
  message.header.stamp = transform.header.stamp + ros::Duration(100.0);
  expect_refused("future", message, "no transform from frame 'moving' to 'world' at time ");
  EXPECT_FALSE(logs_of("not known at that time: ").empty());
}

TEST_F(BadInputTest, MalformedCloudsAreRefused) {
  sensor_msgs::PointCloud2 message = cloud();
  message.fields[0].name = "u";
  expect_refused("cloud_without_x", message, "the cloud has no field 'x', it needs x, y and z");

  message = cloud();
  message.fields[2].datatype = sensor_msgs::PointField::INT32;
  expect_refused("cloud_of_integers", message, "field 'z' has datatype 5");

  message = cloud();
  message.point_step += 4;
  expect_refused("cloud_with_wrong_step", message, "row_step is ");

  message = cloud();
  message.is_bigendian = 1;
  expect_refused("big_endian_cloud", message, "the cloud is big-endian");

  Points points = chain();
  points[1].x() = nan;
  expect_refused("nan_cloud", cloud(points), "fibre 0, point 1: x is nan");
  expect_refused("empty_cloud", cloud({}), "fibre 0: has 0 point(s), a fibre needs at least 2");
}

TEST_F(BadInputTest, MalformedPosesAndMarkersAreRefused) {
  const std_msgs::Header world = header("world", new_stamp());
  expect_refused("one_pose", test_messages::pose_array(world, {{0, 0, 0}}),
                 "fibre 0: has 1 point(s), a fibre needs at least 2");

  nav_msgs::Path path = test_messages::path(world, chain());
  path.poses[3].header.frame_id = "gripper";
  expect_refused("path_frames", path, "pose 3 is in frame 'gripper', the path in 'world'");

  expect_refused("odd_line_list",
                 test_messages::marker(world, Marker::LINE_LIST, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}),
                 "marker cable/0: a LINE_LIST of 3 points");

  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(test_messages::marker(world, Marker::TEXT_VIEW_FACING, {}));
  expect_refused("text_marker", markers, "marker cable/0 has type 9; fibres are read from ");
}

TEST_F(BadInputTest, AFloodOfBadMessagesIsLoggedAtALowRate) {
  const ros::Publisher publisher = advertise<FiberArray>("bad/flood");
  FiberArray message = array();
  const ros::SteadyTime begin = ros::SteadyTime::now();
  const fiber_proximity::InputStatistics* input = nullptr;
  ASSERT_TRUE(node_test::wait_for([&] {
    for (int i = 0; i < 5; ++i) {
      message.points[static_cast<std::size_t>(i % 4)].x = nan;  // another text each time
      publisher.publish(message);
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.001));
    }
    good_.publish(good_message());
    input = input_of(*statistics.messages.back(), "bad/flood");
    return input != nullptr && input->refused > 100;
  }));
  const double seconds = (ros::SteadyTime::now() - begin).toSec();
  EXPECT_GE(logs_of("bad/flood").size(), 1U);
  EXPECT_LE(static_cast<double>(logs_of("bad/flood").size()), 2.0 + seconds);
}

/// The number in "(and N more refused since)", 0 without.
std::uint64_t more_in(const std::string& log) {
  const std::string before = "(and ";
  const std::size_t found = log.find(before);
  return found == std::string::npos ? 0 : std::stoul(log.substr(found + before.size()));
}

TEST_F(BadInputTest, OneReasonDoesNotHideAnother) {
  const ros::Publisher publisher = advertise<FiberArray>("bad/reasons");
  FiberArray frequent = array();
  frequent.points[2].y = nan;
  FiberArray rare = array();
  rare.names = {"one", "too many"};
  // Both reasons; the frequent one again and again, until it is logged another time.
  publisher.publish(frequent);
  ASSERT_TRUE(node_test::wait_for([this] { return !logs_of("point 2: y is nan").empty(); }));
  publisher.publish(rare);
  ASSERT_TRUE(node_test::wait_for([this] { return !logs_of("2 names for 1 fibre(s)").empty(); }))
      << "hidden by the other reason";
  std::uint64_t sent = 1;
  ASSERT_TRUE(node_test::wait_for([&] {
    publisher.publish(frequent);
    ++sent;
    return logs_of("point 2: y is nan").size() > 1;
  }));
  // All that were refused are told of, each once.
  const std::vector<std::string> told = logs_of("point 2: y is nan");
  EXPECT_GT(more_in(told[1]), 0U);
  EXPECT_LE(more_in(told[1]) + 2, sent);
}

TEST_F(BadInputTest, ABadParameterIsAClearErrorAndExitCode2) {
  const auto expect_exit = [](const std::string& arguments, const std::string& error) {
    ros::param::del("/refused");
    const Refusal refusal = run_node(arguments);
    EXPECT_EQ(refusal.exit_code, 2) << arguments;
    EXPECT_NE(refusal.output.find(error), std::string::npos) << refusal.output;
    const std::size_t fatal = refusal.output.find("FATAL");
    EXPECT_NE(fatal, std::string::npos) << refusal.output;
    EXPECT_EQ(refusal.output.find("FATAL", fatal + 1), std::string::npos) << refusal.output;
  };
  struct Bad {
    std::string name;
    std::string value;
    std::string allowed;
  };
  for (const Bad& bad : std::vector<Bad>{
           {"margin", "-1", "a number of at least 0"},
           {"margin", "a", "a number of at least 0"},
           {"margin", "nan", "a number of at least 0"},
           {"neighbour_skip", "-2", "a whole number of at least -1"},
           {"neighbour_skip_length", "-1.5", "a number of at least -1"},
           {"max_stamp_ahead", "-1", "a number of at least 0"},
           {"synchronize", "yes", "true or false"},
           {"synchronize_slop", "some", "a number of at least 0"},
           {"show_names", "3", "true or false"},
           {"show_legend", "none", "true or false"},
           {"tolerance", "inf", "finite and at least 0 m"},
           {"deadline", "inf", "finite and at least 0 s"},
           {"deadline", "soon", "a number of at least 0"},
           {"max_contacts", "0", "a whole number of at least 1"},
           {"max_contacts", "2.5", "a whole number of at least 1"},
           {"contact_limit", "-1", "a whole number of at least 0"},
           {"pair_limit", "1.5", "a whole number of at least 0"},
           {"box_level", "-1", "a whole number of at least 0"},
           {"query_type", "nearest", "one of first, closest, limited, all, fiber_pairs"},
           {"query_type", "3", "one of first, closest, limited, all, fiber_pairs"},
           {"kernel", "double", "one of robust, exact"},
           {"accuracy", "sloppy", "one of custom, robust, exact, deadline"},
           {"pairing", "none", "one of all, same_fiber, different_fibers"},
           {"show_boxes", "yes", "true or false"},
           {"compare", "1", "true or false"},
           {"minimum_distance", "0.5", "true or false"},
           {"threads", "1.5", "a whole number of at least 0"},
           {"radius", "1e+200", "a number from 0 to 1e+150"},
           {"marker_rate", "0", "a number of at least 0.001"},
           {"diagnostic_period", "never", "a number of at least 0.001"},
           {"fixed_frame", "7", "a string"}}) {
    SCOPED_TRACE(bad.name + " " + bad.value);
    const Refusal refusal = run_node("_" + bad.name + ":=" + bad.value);
    EXPECT_EQ(refusal.exit_code, 2);
    EXPECT_NE(refusal.output.find("FATAL"), std::string::npos) << refusal.output;
    EXPECT_EQ(refusal.output.find("FATAL"), refusal.output.rfind("FATAL")) << refusal.output;
    const std::size_t named = refusal.output.find("parameter /refused/" + bad.name + " is ");
    ASSERT_NE(named, std::string::npos) << refusal.output;
    EXPECT_NE(refusal.output.find(bad.value.substr(0, 3), named), std::string::npos)
        << refusal.output;
    EXPECT_NE(refusal.output.find("it must be " + bad.allowed, named), std::string::npos)
        << refusal.output;
    ros::param::del("/refused");
  }
  expect_exit("_accuracy:=deadline",
              "parameter /refused/accuracy is 'deadline' and deadline is 0 s, it must be above 0");
  expect_exit("_engine:=nonsense", "unknown engine 'nonsense', known are: run_tree, AL, ");
  expect_exit("_engine:=DL-7",
              "unknown engine 'DL-7' (k-DOP with k = 7: k must be even, from 6 to ");
  expect_exit("_threads:=-1", "parameter /refused/threads is -1, it must be a whole number of ");
  expect_exit("_threads:=100000", "threads is 100000, it must be at most 1024 (0 for as many as ");
  for (const std::string value : {"-0.001", "nan", "inf", "thin"}) {
    expect_exit("_skin:=" + value,
                "parameter /refused/skin is " + value + ", it must be a number of at least 0");
  }
  expect_exit("_tf_timeout:=-1", "parameter /refused/tf_timeout is -1, it must be a number of ");
  expect_exit("_radius:=thick",
              "parameter /refused/radius is thick, it must be a number from 0 to ");
  expect_exit("_inputs:=fibers", "parameter /refused/inputs is fibers, it must be a list of maps");
  ros::param::del("/refused");
}

}  // namespace
