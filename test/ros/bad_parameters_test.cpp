// What the running node does with parameters nobody should set: what cannot be used is left out
// with an error, or the node does not start.
#include <cstdio>

#include "test/ros/bad_input_fixture.hpp"
#include "test/ros/running_node.hpp"
#include "test/support/temporary_directory.hpp"

namespace {

using node_test::BadInputTest;

/// Runs a second node that does not start, and tells what it says and returns.
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
  expect_left_out(4, "key 'radius' is thick, it must be a number from 0 to 1e+150");
  expect_left_out(5, "key 'topic' is yaml/not a name, it must be a ROS name");
  expect_left_out(6, "is yaml_no_map, it must be a map with the key 'topic' at least");
  expect_left_out(36,
                  "key 'name' is good (without it, the topic), as of parameter /refused/inputs, "
                  "entry 0, it must be another one");
  const std::string rule = ", it must be a number from 0 to 1e+150";
  expect_left_out(39, "key 'uncertainty' is -0.001" + rule);
  expect_left_out(40, "key 'uncertainty' is nan" + rule);
  expect_left_out(41, "key 'uncertainty' is inf" + rule);
  expect_left_out(42, "key 'uncertainty' is some" + rule);
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
  EXPECT_TRUE(ros::service::waitForService("/no_inputs/query", ros::Duration(node_test::patience)));
  EXPECT_EQ(running.stop(), 0);
  EXPECT_NE(running.output().find("parameter /no_inputs/inputs is an empty list"),
            std::string::npos)
      << running.output();
  ros::param::del("/no_inputs");
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
           {"pair_limit", "true", "a whole number of at least 0"},
           {"heartbeat", "-1", "a number of at least 0"},
           {"obstacles_required", "maybe", "true or false"},
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
  expect_exit("_engine:=nonsense", "unknown engine 'nonsense', known are: run_tree, AL, ");
  expect_exit("_engine:=DL-7",
              "unknown engine 'DL-7' (k-DOP with k = 7: k must be even, from 6 to ");
  expect_exit("_threads:=-1", "parameter /refused/threads is -1, it must be a whole number of ");
  expect_exit("_threads:=100000", "threads is 100000, it must be at most 1024 (0 for as many as ");
  for (const std::string value : {"-0.001", "nan", "inf", "thin"}) {
    expect_exit("_skin:=" + value, "parameter /refused/skin is " + value +
                                       ", it must be automatic or a number of at least 0");
  }
  expect_exit("_scene:=/none",
              "parameter /refused/scene: file '/none': there is no such file to read");
  expect_exit("_tf_timeout:=-1", "parameter /refused/tf_timeout is -1, it must be a number of ");
  expect_exit("_radius:=thick",
              "parameter /refused/radius is thick, it must be a number from 0 to ");
  expect_exit("_inputs:=fibers", "parameter /refused/inputs is fibers, it must be a list of maps");
  ros::param::del("/refused");
}

}  // namespace
