#include "test/tools/fiber_query.hpp"

#include <nlohmann/json.hpp>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/support/answers.hpp"

namespace fiber::test {
namespace {

/// The numbers of a contact in the order of the columns.
std::vector<double> numbers(const Contact& c) {
  return {double(c.fiber_a),
          double(c.segment_a),
          c.s,
          double(c.fiber_b),
          double(c.segment_b),
          c.t,
          c.distance,
          c.point_a.x(),
          c.point_a.y(),
          c.point_a.z(),
          c.point_b.x(),
          c.point_b.y(),
          c.point_b.z(),
          c.normal.x(),
          c.normal.y(),
          c.normal.z(),
          c.lower,
          c.upper};
}

std::vector<double> numbers(const nlohmann::json& c) {
  std::vector<double> result{c.at("fiber_a"),   c.at("segment_a"), c.at("s"),       c.at("fiber_b"),
                             c.at("segment_b"), c.at("t"),         c.at("distance")};
  for (const char* name : {"point_a", "point_b", "normal"}) {
    const auto vector = c.at(name).get<std::vector<double>>();
    result.insert(result.end(), vector.begin(), vector.end());
  }
  result.push_back(c.at("lower"));
  result.push_back(c.at("upper"));
  return result;
}

std::vector<double> without_bounds(std::vector<double> numbers) {
  EXPECT_EQ(numbers.size(), 18U);
  numbers.resize(16);
  return numbers;
}

TEST_F(FiberQuery, ContactsOfACrossing) {
  const ProcessResult result = query("contacts " + crossing() + " --margin 0.2");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const std::vector<std::string> found = lines(result.out);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0] + "\n", columns);
  EXPECT_EQ(without_bounds(numbers_in(found[1])),
            (std::vector<double>{0, 1, 0.5, 1, 0, 0.5, 0.5 - (0.2 + 0.2), 0, 0, 0.2, 0, 0, 0.3, 0,
                                 0, 1}));
  EXPECT_EQ(query("contacts " + crossing()).out, columns) << "the margin is 0 by default";
}

TEST_F(FiberQuery, ClosestHasNoMarginByDefault) {
  const std::vector<std::string> found = lines(query("closest " + crossing()).out);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[1].substr(0, 12), "0,1,0.5,1,0,");
  EXPECT_EQ(query("closest " + crossing() + " --margin 0.05").out, columns);
}

TEST_F(FiberQuery, FirstIsOneOfTheContacts) {
  const std::vector<std::string> all =
      lines(query("contacts " + crossing() + " --margin inf --neighbour-skip 0").out);
  const std::vector<std::string> first =
      lines(query("first " + crossing() + " --margin inf --neighbour-skip 0").out);
  EXPECT_EQ(all.size(), 1U + 4 * 3 / 2);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_NE(std::find(all.begin() + 1, all.end(), first[1]), all.end());
}

// The pair of the hairpin a with itself, and one of each pair of fibres.
TEST_F(FiberQuery, FiberPairsAreTheMinimumDistancesOfFibres) {
  const std::string file = write("hairpin.csv",
                                 "fiber,x,y,z\n"
                                 "0,0,0,0\n0,4,0,0\n0,4,1,0\n0,0,1,0\n"
                                 "1,1,2,3\n1,3,2,3\n2,0,0,-2\n2,0,-1,-2\n");
  const auto rows = [&](const std::string& options) {
    std::vector<std::vector<double>> values;
    const std::vector<std::string> found = lines(query("fiber_pairs " + file + options).out);
    for (std::size_t i = 1; i < found.size(); ++i) {
      const std::vector<double> row = numbers_in(found[i]);
      values.push_back({row[0], row[1], row[3], row[4], row[6]});
    }
    return values;
  };
  const std::vector<double> hairpin{0, 0, 0, 2, 1};
  const std::vector<double> a_c{0, 0, 2, 0, 2};
  EXPECT_EQ(rows(" --margin 0"), std::vector<std::vector<double>>());
  EXPECT_EQ(rows(" --margin 1"), std::vector<std::vector<double>>{hairpin});
  EXPECT_EQ(rows(" --margin 3"), (std::vector<std::vector<double>>{hairpin, a_c}));
  const std::vector<std::vector<double>> all = rows("");
  ASSERT_EQ(all.size(), 4U) << "no margin by default";
  EXPECT_EQ(all[0], hairpin);
  EXPECT_EQ(all[1], a_c);
  EXPECT_EQ(all[2], (std::vector<double>{0, 2, 1, 0, std::sqrt(10.0)}));
  EXPECT_EQ(all[3], (std::vector<double>{1, 0, 2, 0, std::sqrt(30.0)}));
}

TEST_F(FiberQuery, NearestAreTheSegmentsNearestToAPoint) {
  const std::string nearest = "nearest " + crossing() + " --point ";
  const std::vector<std::string> found = lines(query(nearest + "0,0,1.75 --k 3").out);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0] + "\n", columns);
  EXPECT_EQ(
      without_bounds(numbers_in(found[1])),
      (std::vector<double>{0, 0, 0, 2, 0, 0.5, 0.25 - 0.2, 0, 0, 1.75, 0, 0, 1.5 + 0.2, 0, 0, -1}));
  EXPECT_EQ(found[2].substr(0, 12), "0,0,0,1,0,0.");
  EXPECT_EQ(found[3].substr(0, 12), "0,0,0,0,1,0.");
  EXPECT_EQ(lines(query(nearest + "0,0,0").out).size(), 2U) << "one by default";
  EXPECT_EQ(lines(query(nearest + "-1e3,+2.5,0 --k 1000").out).size(), 1U + 4U);
  const ProcessResult json = query(nearest + "0,0,1.75 --k 2 --format json");
  const auto contacts = nlohmann::json::parse(json.out).at("contacts");
  ASSERT_EQ(contacts.size(), 2U);
  EXPECT_EQ(numbers(contacts[0]), numbers_in(found[1]));
  EXPECT_EQ(numbers(contacts[1]), numbers_in(found[2]));
}

TEST_F(FiberQuery, AccuracyIsChosenOnTheCommandLine) {
  const double gap = 0.5 - (0.2 + 0.2);
  for (const std::string kernel : {"robust", "exact"}) {
    const ProcessResult result =
        query("contacts " + crossing() + " --margin 0.2 --format json --kernel " + kernel);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const nlohmann::json answer = nlohmann::json::parse(result.out);
    EXPECT_EQ(answer.at("complete"), true);
    ASSERT_EQ(answer.at("contacts").size(), 1U);
    const nlohmann::json& contact = answer.at("contacts")[0];
    EXPECT_LE(contact.at("lower"), gap);
    EXPECT_GE(contact.at("upper"), gap);
    EXPECT_LE(answer.at("minimum_lower"), contact.at("lower"));
    const double width = contact.at("upper").get<double>() - contact.at("lower").get<double>();
    EXPECT_LT(width, 1e-9);
  }
  const ProcessResult loose = query("closest " + crossing() + " --tolerance 5");
  EXPECT_EQ(lines(loose.out).size(), 2U);
  EXPECT_GE(numbers_in(lines(loose.out)[1])[6], gap);

  const ProcessResult cut = query("contacts " + soup("--scale 0.001") + " --deadline 1e-9");
  EXPECT_EQ(cut.exit_code, 0);
  EXPECT_EQ(cut.out, columns);
  EXPECT_EQ(cut.err, "fiber_query: the deadline has passed: pairs may be missing\n");
  EXPECT_EQ(query("contacts " + crossing() + " --deadline 1000").err, "");

  for (const auto& [arguments, reason] :
       {std::pair{"--kernel double", "unknown kernel 'double', known are: robust, exact"},
        std::pair{"--tolerance -1", "tolerance is -1.000000, it must be finite and at least 0 m"},
        std::pair{"--relative-tolerance inf", "relative_tolerance is inf"},
        std::pair{"--deadline nan", "deadline is nan"}}) {
    const ProcessResult refused = query("contacts " + crossing() + " " + arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments;
    EXPECT_NE(refused.err.find(reason), std::string::npos) << refused.err;
  }
}

TEST_F(FiberQuery, NeighbourSkips) {
  const std::string path = write("line.csv", "fiber,x,y,z\n0,0,0,0\n0,1,0,0\n0,2,0,0\n0,3,0,0\n");
  const auto count = [&](const std::string& options) {
    return lines(query("contacts " + path + " --margin 1 " + options).out).size() - 1;
  };
  EXPECT_EQ(count(""), 0U);  // a straight line makes no loop
  EXPECT_EQ(count("--radius 0.25"), 0U);
  EXPECT_EQ(count("--neighbour-skip 1"), 1U);
  EXPECT_EQ(count("--neighbour-skip 0"), 3U);
  EXPECT_EQ(count("--neighbour-skip 2"), 0U);
  EXPECT_EQ(count("--neighbour-skip-length 1.5"), 0U);
  EXPECT_EQ(count("--neighbour-skip 1 --radius 0.25"), 1U);
}

TEST_F(FiberQuery, RadiusIsForFilesWithoutOne) {
  const std::string path = write("bare.csv", "fiber,x,y,z\n0,-1,0,0\n0,1,0,0\n1,0,-1,1\n1,0,1,1\n");
  EXPECT_EQ(query("contacts " + path).out, columns);
  EXPECT_EQ(lines(query("contacts " + path + " --radius 0.5").out).size(), 2U);
  EXPECT_EQ(query("contacts " + crossing() + " --radius 10").out, columns);
}

TEST_F(FiberQuery, PrintsTheLibrarysNumbersBitForBit) {
  const std::string path = soup("--scale 0.003 --frames 2");
  QueryOptions options;
  options.margin = 0.004;
  const ProcessResult csv = query("contacts " + path + " --margin 0.004");
  const ProcessResult json = query("contacts " + path + " --margin 0.004 --format json");
  const std::vector<std::string> rows = lines(csv.out);
  const std::vector<std::string> objects = lines(json.out);
  ASSERT_EQ(rows.front() + "\n", "frame," + columns);
  ASSERT_EQ(objects.size(), 2U);

  std::size_t row = 1;
  for (const FiberFrame& frame : read_csv(path).frames) {
    const QueryResult expected = brute_force(frame.fibers, options);
    ASSERT_GT(expected.contacts.size(), 1U);
    const auto object = nlohmann::json::parse(objects[static_cast<std::size_t>(frame.frame)]);
    EXPECT_EQ(object.at("frame"), frame.frame);
    ASSERT_EQ(object.at("contacts").size(), expected.contacts.size());
    for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
      std::vector<double> values = numbers(expected.contacts[i]);
      EXPECT_EQ(numbers(object.at("contacts")[i]), values);
      values.insert(values.begin(), static_cast<double>(frame.frame));
      ASSERT_LT(row, rows.size());
      EXPECT_EQ(numbers_in(rows[row++]), values);
    }
  }
  EXPECT_EQ(row, rows.size());
}

TEST_F(FiberQuery, ReadsHairFiles) {
  ASSERT_EQ(scene("tress_a --scale 0.01 --out " + path("a.hair")).exit_code, 0);
  const ProcessResult tree = query("contacts " + path("a.hair"));
  EXPECT_EQ(tree.exit_code, 0) << tree.err;
  EXPECT_GT(lines(tree.out).size(), 3U);
  EXPECT_EQ(tree.out, query("contacts " + path("a.hair") + " --engine brute_force").out);
  EXPECT_TRUE(refused(query("contacts " + write("b.hair", "HAIR")), "b.hair: ends at byte 4"));
}

TEST_F(FiberQuery, SkipsFibersOfOnePoint) {
  const std::string file =
      write("single.csv", "fiber,x,y,z\na,9,9,9\nb,0,0,0\nb,1,0,0\nc,0,1,0\nc,1,1,0\n");
  EXPECT_TRUE(refused(query("closest " + file), "single.csv:2: fibre 'a' has only this point"));
  const ProcessResult found = query("closest " + file + " --skip-single-points");
  EXPECT_EQ(found.exit_code, 0);
  EXPECT_EQ(found.err, "fiber_query: " + file +
                           ": 1 fibre of fewer than two points left out, as skip_single_points "
                           "says\n");
  EXPECT_EQ(lines(found.out).size(), 2U);
}

TEST_F(FiberQuery, FilesOfNothing) {
  const std::string bare = write("bare.csv", "fiber,x,y,z\n");
  const std::string framed = write("framed.csv", "frame,fiber,x,y,z\n");
  EXPECT_EQ(query("contacts " + bare).out, columns);
  EXPECT_EQ(query("closest " + bare + " --format json").out,
            "{\"complete\":true,\"minimum_lower\":null,\"contacts\":[]}\n");
  EXPECT_EQ(query("contacts " + framed).out, "frame," + columns);
  EXPECT_EQ(query("contacts " + framed + " --format json").out, "");
  EXPECT_EQ(query("nearest " + bare + " --point 0,0,0").out, columns);
  EXPECT_TRUE(refused(query("fiber_pairs " + framed + " --margin -1"), "margin is -1"));
}

TEST_F(FiberQuery, HelpIsNoError) {
  for (const std::string arguments : {"--help", "contacts --help"}) {
    const ProcessResult result = query(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("contacts"), std::string::npos);
    EXPECT_EQ(result.err, "");
  }
}

}  // namespace
}  // namespace fiber::test
