// Answers call fibres by the names that they have in the file.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test/tools/fiber_query.hpp"

namespace fiber::test {
namespace {

class Names : public FiberQuery {
 protected:
  /// The file of crossing() with these names in place of 0, 1 and 2.
  std::string crossing_of(const std::string& first, const std::string& second,
                          const std::string& third) const {
    const std::vector<std::string> names{first, second, third};
    std::string text = "fiber,x,y,z,radius\n";
    const std::vector<std::string> rows = lines(read_file(crossing()));
    for (std::size_t i = 1; i < rows.size(); ++i) {
      text += names.at(static_cast<std::size_t>(rows[i][0] - '0')) + rows[i].substr(1) + "\n";
    }
    return write("names.csv", text);
  }
  std::string answer(const std::string& arguments) const {
    const ProcessResult result = query(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return result.out;
  }
};

/// The text with the fibres of each row, fields `first` and `first + distance`, by other names.
std::string renamed(const std::string& csv, std::size_t first, std::size_t distance,
                    const std::vector<std::string>& names) {
  const std::vector<std::string> rows = lines(csv);
  EXPECT_GE(rows.size(), 2U) << "no answer";
  std::string text = rows.at(0) + '\n';
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::istringstream fields(rows[i]);
    std::string field;
    std::string row;
    for (std::size_t place = 0; std::getline(fields, field, ','); ++place) {
      const bool is_fiber = place == first || place == first + distance;
      row += (place == 0 ? "" : ",") + (is_fiber ? names.at(std::stoul(field)) : field);
    }
    text += row + '\n';
  }
  return text;
}

TEST_F(Names, LeadThroughAllAnswersAboutPairs) {
  const std::vector<std::string> names{"\"a \"\"rope\"\", long\"", "7", "#3"};
  const std::vector<std::string> written{names[0], "7", "\"#3\""};
  const std::string named = crossing_of(names[0], names[1], "\"#3\"");
  for (const std::string options :
       {" --margin 0.2", " --margin inf --neighbour-skip 0", " --margin 2"}) {
    for (const std::string command : {"contacts ", "closest ", "first ", "fiber_pairs "}) {
      EXPECT_EQ(answer(command + named + options),
                renamed(answer(command + crossing() + options), 0, 3, written))
          << command << options;
    }
  }
  EXPECT_EQ(answer("nearest " + named + " --point 0,0,1.75 --k 4"),
            renamed(answer("nearest " + crossing() + " --point 0,0,1.75 --k 4"), 0, 3, written));
  EXPECT_EQ(answer("crossings " + named),
            renamed(answer("crossings " + crossing()), 0, 3, written));
  EXPECT_EQ(answer("writhe " + named), renamed(answer("writhe " + crossing()), 0, 0, written));
  EXPECT_EQ(answer("linking " + crossing()), answer("linking " + named)) << "of none there is none";
}

TEST_F(Names, LeadThroughJson) {
  const std::string named = crossing_of("rope", "7", "-0");
  const auto contacts = [&](const std::string& command) {
    return nlohmann::json::parse(answer(command + named + " --format json"));
  };
  const nlohmann::json pairs = contacts("fiber_pairs ").at("contacts");
  ASSERT_EQ(pairs.size(), 3U);
  EXPECT_EQ(pairs[0].at("fiber_a"), "rope");
  EXPECT_EQ(pairs[1].at("fiber_b"), 7) << "a whole number is one";
  EXPECT_EQ(pairs[0].at("fiber_b"), "-0") << "and nothing else";
  EXPECT_EQ(contacts("crossings ").at("crossings").at(0).at("fiber_b"), 7);
  EXPECT_EQ(contacts("writhe ").at("writhes").at(0).at("fiber"), "rope");
  // JSON is UTF-8; CSV has the bytes.
  const std::string latin = crossing_of("c\xE2\x62le", "b", "c");
  EXPECT_NE(answer("closest " + latin).find("\nc\xE2\x62le,"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(answer("closest " + latin + " --format json"))
                .at("contacts")
                .at(0)
                .at("fiber_a"),
            "c\xEF\xBF\xBD\x62le");
}

TEST_F(Names, LeadThroughCompare) {
  const std::string tiny =
      write("tiny.csv", "fiber,x,y,z\nu,-5e-8,0,0\nu,5e-8,0,0\nv,0,-5e-8,2e-8\nv,0,5e-8,2e-8\n");
  const std::string text = answer("compare " + tiny + " --radius 1.1e-8");
  EXPECT_NE(text.find("    u/0 - v/0: ours -1.99"), std::string::npos) << text;
  const auto pair = nlohmann::json::parse(
      answer("compare " + tiny + " --radius 1.1e-8 --format json"))["fcl"][0]["disagreements"][0];
  EXPECT_EQ(pair.at("fiber_a"), "u");
  EXPECT_EQ(pair.at("fiber_b"), "v");
}

TEST_F(Names, AreThoseOfEachFrame) {
  const std::string file = write("frames.csv",
                                 "frame,fiber,x,y,z\n"
                                 "1,0,0,0,0\n1,0,1,0,0\n1,1,0,0,1\n1,1,1,0,1\n"
                                 "2,1,0,0,0\n2,1,1,0,0\n2,0,0,0,1\n2,0,1,0,1\n"
                                 "3,b,0,0,0\n3,b,1,0,0\n3,1,0,0,1\n3,1,1,0,1\n");
  const std::vector<std::string> rows = lines(answer("closest " + file));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[1].substr(0, 10), "1,0,0,0,1,");
  EXPECT_EQ(rows[2].substr(0, 10), "2,1,0,0,0,");
  EXPECT_EQ(rows[3].substr(0, 10), "3,b,0,0,1,");
}

// Two frames of two fibres, as pandas, R, MATLAB, numpy and a logger sorted by time write them.
TEST_F(Names, AreReadFromWhatOtherProgramsWrite) {
  const std::string plain =
      "frame,fiber,x,y,z,radius\n"
      "1,a,0,0,0,0.1\n1,a,1,0,0,0.1\n1,b,0,0,0.25,0.1\n1,b,1,0,0.25,0.1\n"
      "2,a,0,0,0,0.1\n2,a,1,0,0,0.1\n2,b,0,0,0.125,0.1\n2,b,1,0,0.125,0.1\n";
  const std::vector<std::string> shapes{
      ",frame,fiber,x,y,z,radius\n"
      "0,1,a,0,0,0,0.1\n1,1,a,1,0,0,0.1\n2,1,b,0,0,0.25,0.1\n3,1,b,1,0,0.25,0.1\n"
      "4,2,a,0,0,0,0.1\n5,2,a,1,0,0,0.1\n6,2,b,0,0,0.125,0.1\n7,2,b,1,0,0.125,0.1\n",
      "\"\";\"Frame\";\"X\";\"Y\";\"Z\";\"Fiber\";\"Radius\"\r\n"
      "\"1\";1;0;0;0;\"a\";0.1\r\n\"2\";1;1;0;0;\"a\";0.1\r\n"
      "\"3\";1;0;0;0.25;\"b\";0.1\r\n\"4\";1;1;0;0.25;\"b\";0.1\r\n"
      "\"5\";2;0;0;0;\"a\";0.1\r\n\"6\";2;1;0;0;\"a\";0.1\r\n"
      "\"7\";2;0;0;0.125;\"b\";0.1\r\n\"8\";2;1;0;0.125;\"b\";0.1\r\n",
      "# fiber frame x y z radius\n"
      "a 1.000e+00 0.000e+00 0 0 1e-1\na 1.000e+00 1 0 0 1e-1\nb 1 0 0 0.25 0.1\nb 1 1 0 0.25 0.1\n"
      "a 2 0 0 0 0.1\na 2 1 0 0 0.1\nb 2 0 0 0.125 0.1\nb 2 1 0 0.125 0.1\n",
      "frame\tx\ty\tz\tradius\tfiber\n"
      "1\t0\t0\t0\t0.1\ta\n1\t0\t0\t0.25\t0.1\tb\n2\t0\t0\t0\t0.1\ta\n"
      "2\t0\t0\t0.125\t0.1\tb\n1\t1\t0\t0\t0.1\ta\n1\t1\t0\t0.25\t0.1\tb\n"
      "2\t1\t0\t0\t0.1\ta\n2\t1\t0\t0.125\t0.1\tb\n"};
  const std::string file = write("plain.csv", plain);
  for (const std::string command : {"contacts ", "closest ", "sweep "}) {
    const std::string expected = answer(command + file);
    EXPECT_NE(expected.find(",a,"), std::string::npos);
    for (const std::string& shape : shapes) {
      EXPECT_EQ(answer(command + write("shape.csv", shape)), expected) << shape;
    }
  }
  EXPECT_TRUE(refused(query("contacts " + write("german.csv", "x;y;z\n0,5;0;0\n1,5;0;0\n")),
                      "german.csv:2: x is '0,5', expected a number with a decimal point"));
}

TEST_F(Names, WhatOfAFileIsNotReadIsTold) {
  const std::string file =
      write("more.csv", "time,x,y,z,id\n0,0,0,0,3\n0,1,0,0,3\n1,5,5,5,4\n1,6,6,6,4\n");
  for (const std::string command : {"contacts ", "crossings ", "compare ", "writhe "}) {
    const ProcessResult result = query(command + file);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "fiber_query: " + file +
                              ": columns 'time', 'id' are not read; there is no column fiber: all "
                              "rows are one fibre\n")
        << command;
  }
}

TEST_F(Names, HelpTellsOfThem) {
  const std::string help = answer("contacts --help");
  EXPECT_NE(help.find("x, y, z"), std::string::npos) << help;
  EXPECT_NE(help.find("a name"), std::string::npos) << help;
}

}  // namespace
}  // namespace fiber::test
