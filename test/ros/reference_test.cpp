// docs/reference.md beside what the node really has.
#include <gtest/gtest.h>
#include <ros/master.h>
#include <ros/names.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "fiber_proximity/ProximityConfig.h"
#include "src/ros/server/server_options.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/source_folder.hpp"

namespace {

using fiber_proximity::ProximityConfig;
using NameSet = std::set<std::string>;

/// The rows of the table that begins with these cells, each its cells.
std::vector<std::vector<std::string>> rows_of_table(const std::string& header) {
  std::ifstream file(fiber::test::source_folder() / "docs/reference.md");
  std::vector<std::vector<std::string>> rows;
  bool is_within = false;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("| " + header + " |", 0) == 0) {
      is_within = true;
    } else if (is_within && line.rfind("| ", 0) == 0) {
      std::istringstream cells(line.substr(2));
      rows.emplace_back();
      for (std::string cell; std::getline(cells, cell, '|');) {
        cell.erase(cell.find_last_not_of(' ') + 1);
        rows.back().push_back(cell.substr(std::min(cell.find_first_not_of(' '), cell.size())));
      }
    } else if (line.rfind("|-", 0) != 0) {
      is_within = false;
    }
  }
  return rows;
}

/// What a cell has in backquotes after a tilde.
std::vector<std::string> private_names(const std::string& cell) {
  static const std::regex name("`~([a-z_]+)`");
  std::vector<std::string> names;
  for (std::sregex_iterator i(cell.begin(), cell.end(), name); i != std::sregex_iterator(); ++i) {
    names.push_back((*i)[1]);
  }
  return names;
}

NameSet first_column(const std::string& header) {
  NameSet names;
  for (const std::vector<std::string>& row : rows_of_table(header)) {
    for (const std::string& name : private_names(row[0])) {
      EXPECT_TRUE(names.insert(name).second) << name << " is there twice";
    }
  }
  return names;
}

/// As a table has it: without what a number does not need.
std::string plain(std::string value) {
  if (value.size() > 2 && value.front() == '`') {
    value = value.substr(1, value.size() - 2);
  }
  const std::string minus = "−";
  if (value.rfind(minus, 0) == 0) {
    value = "-" + value.substr(minus.size());
  }
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return end != value.c_str() && *end == '\0' ? std::to_string(number) : value;
}

/// Of what changes while the node runs, by name.
std::map<std::string, std::string> dynamic_defaults() {
  dynamic_reconfigure::Config message;
  ProximityConfig::__getDefault__().__toMessage__(message);
  std::map<std::string, std::string> defaults;
  for (const auto& value : message.bools) {
    defaults[value.name] = value.value ? "true" : "false";
  }
  for (const auto& value : message.ints) {
    defaults[value.name] = std::to_string(static_cast<double>(value.value));
  }
  for (const auto& value : message.doubles) {
    defaults[value.name] = std::to_string(value.value);
  }
  for (const auto& value : message.strs) {
    defaults[value.name] = value.value;
  }
  return defaults;
}

TEST(Reference, NamesAllParameters) {
  const std::vector<std::string> known = fiber_proximity_ros::known_parameters();
  EXPECT_EQ(first_column("parameter"), NameSet(known.begin(), known.end()));
}

TEST(Reference, HasTheDefaultsOfWhatCanChange) {
  const std::map<std::string, std::string> defaults = dynamic_defaults();
  ASSERT_GT(defaults.size(), 20U);
  std::size_t seen = 0;
  for (const std::vector<std::string>& row : rows_of_table("parameter")) {
    const bool has_star = row[0].find('*') != std::string::npos;
    for (const std::string& name : private_names(row[0])) {
      const auto found = defaults.find(name);
      EXPECT_EQ(has_star, found != defaults.end()) << name;
      if (found != defaults.end()) {
        EXPECT_EQ(plain(row[1]), found->second) << name;
        ++seen;
      }
    }
  }
  EXPECT_EQ(seen, defaults.size());
}

/// What the master knows of the node under test: topics or services below its own name.
NameSet private_names_of_node(int which) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue state;
  request[0] = ros::this_node::getName();
  EXPECT_TRUE(ros::master::execute("getSystemState", request, response, state, true));
  NameSet names;
  for (int i = 0; i < state[which].size(); ++i) {
    const std::string name = state[which][i][0];
    // Its begin() is that of structs. NOLINTNEXTLINE(modernize-loop-convert)
    for (int k = 0; k < state[which][i][1].size(); ++k) {
      const std::string prefix = "/proximity/";
      if (static_cast<std::string>(state[which][i][1][k]) == "/proximity" &&
          name.rfind(prefix, 0) == 0) {
        names.insert(name.substr(prefix.size()));
      }
    }
  }
  return names;
}

class ReferenceTest : public node_test::NodeTest {};

TEST_F(ReferenceTest, NamesAllTopicsAndServices) {
  constexpr int published = 0;
  constexpr int subscribed = 1;
  constexpr int served = 2;
  // The node has them all when it serves its last one.
  ASSERT_TRUE(ros::service::waitForService("/proximity/check_fibers", 120000));
  ASSERT_TRUE(ros::service::waitForService("/proximity/set_parameters", 120000));
  const auto without = [](NameSet names, const NameSet& others) {
    for (const std::string& other : others) {
      names.erase(other);
    }
    return names;
  };
  const NameSet of_reconfigure{"parameter_descriptions", "parameter_updates"};
  EXPECT_EQ(first_column("publishes"), without(private_names_of_node(published), of_reconfigure));
  EXPECT_EQ(without(first_column("subscribes"), {"inputs", "cloud", "obstacle_markers"}),
            private_names_of_node(subscribed));
  EXPECT_EQ(first_column("serves"), without(private_names_of_node(served),
                                            {"set_parameters", "get_loggers", "set_logger_level"}));
}

}  // namespace
