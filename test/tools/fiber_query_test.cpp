#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "fiber_proximity/io/csv.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/query/brute_force.hpp"
#include "test/support/shared_data.hpp"
#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

const std::string columns =
    "fiber_a,segment_a,s,fiber_b,segment_b,t,distance,point_a_x,point_a_y,point_a_z,"
    "point_b_x,point_b_y,point_b_z,normal_x,normal_y,normal_z,lower,upper\n";

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    result.push_back(line);
  }
  return result;
}

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

class FiberQuery : public ToolsTest {
 protected:
  /// Three fibres: two cross at a gap of 0.1 in their second and first segment, the third is 1
  /// away.
  std::string crossing() const {
    return write("crossing.csv",
                 "fiber,x,y,z,radius\n"
                 "a,-2,0,0,0.2\na,-1,0,0,0.2\na,1,0,0,0.2\n"
                 "b,0,-1,0.5,0.2\nb,0,1,0.5,0.2\n"
                 "c,-2,0,1.5,0.2\nc,2,0,1.5,0.2\n");
  }
  std::string soup(const std::string& arguments) const {
    const ProcessResult made = scene("soup " + arguments + " --out " + path("soup.csv"));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return path("soup.csv");
  }
};

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

// Of the hairpin a with itself, and of each pair of fibres.
TEST_F(FiberQuery, FiberPairsAreTheMinimumDistancesOfFibres) {
  const std::string file = write("hairpin.csv",
                                 "fiber,x,y,z\n"
                                 "a,0,0,0\na,4,0,0\na,4,1,0\na,0,1,0\n"
                                 "b,1,2,3\nb,3,2,3\nc,0,0,-2\nc,0,-1,-2\n");
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

TEST_F(FiberQuery, NearestAnswersEveryFrameWithEveryEngine) {
  const std::string path = soup("--scale 0.005 --frames 3 --seed 4");
  const std::string arguments = "nearest " + path + " --point 0.1,-0.05,0.2 --k 7 --engine ";
  const ProcessResult expected = query(arguments + "brute_force");
  EXPECT_EQ(lines(expected.out).size(), 1U + 3 * 7);
  EXPECT_EQ(lines(expected.out)[0] + "\n", "frame," + columns);
  for (const std::string& engine : engine_names()) {
    EXPECT_EQ(query(arguments + engine).out, expected.out) << engine;
  }
}

TEST_F(FiberQuery, NearestRefusesBadPointsAndCounts) {
  const std::string nearest = "nearest " + crossing();
  EXPECT_TRUE(refused(query(nearest), "--point is required"));
  for (const std::string point :
       {"1,2", "1,2,3,4", "1,2,3,", "1;2;3", "a,b,c", "1,,3", "1,2,", ",,", "0,nan,0", "inf,0,0",
        "0,0,-1e200", "1,2,3x", "\"1, 2, 3\""}) {
    EXPECT_TRUE(refused(query(nearest + " --point " + (point == "1;2;3" ? "'1;2;3'" : point)),
                        "must be three numbers X,Y,Z; coordinates must be finite and at most 1e150 "
                        "m in magnitude"))
        << point;
  }
  for (const std::string k : {"0", "-1", "two", "1.5"}) {
    EXPECT_TRUE(refused(query(nearest + " --point 0,0,0 --k " + k),
                        "--k: '" + k + "' must be a whole number from 1"));
  }
  EXPECT_TRUE(refused(query(nearest + " --point 0,0,0 --k 4294967296"), "--k"));
  EXPECT_TRUE(refused(query(nearest + " --point 0,0,0 --margin 1"), "--margin"));
  EXPECT_TRUE(refused(query("contacts " + crossing() + " --point 0,0,0"), "--point"));
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
  const ProcessResult robust = query("contacts " + crossing() + " --margin 0.2");
  const ProcessResult fast = query("contacts " + crossing() + " --margin 0.2 --kernel fast");
  EXPECT_EQ(fast.out, robust.out);
  EXPECT_EQ(fast.err, "warning: --kernel fast saved no time and is gone: robust is used\n");

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

TEST_F(FiberQuery, AgreesWithBruteForceInEveryFrame) {
  const std::string path = soup("--scale 0.002 --frames 3 --seed 4");
  for (const std::string command : {"contacts", "closest", "fiber_pairs"}) {
    const std::string arguments = " " + path + " --margin 0.005 --threads 2";
    const ProcessResult tree = query(command + arguments + " --engine AL");
    EXPECT_EQ(tree.exit_code, 0) << tree.err;
    EXPECT_GT(lines(tree.out).size(), 3U) << "frames with contacts make the comparison worth it";
    EXPECT_EQ(tree.out, query(command + arguments + " --engine brute_force").out);
  }
}

TEST_F(FiberQuery, EveryEnginePrintsTheSameBytes) {
  std::vector<std::string> engines = engine_names();
  engines.insert(engines.end(), {"DL-6", "DS-200", "DL-26-classic"});
  const std::string tress = "tress_a --scale 0.004 --seed 3";
  ASSERT_EQ(scene(tress + " --frames 2 --out " + path("moving.csv")).exit_code, 0);
  ASSERT_EQ(scene(tress + " --shuffle --out " + path("still.hair")).exit_code, 0);
  for (const std::string file : {"moving.csv", "still.hair"}) {
    for (const std::string command : {"contacts ", "closest ", "fiber_pairs "}) {
      const std::string arguments = command + path(file) + " --margin 0.0002 --engine ";
      const ProcessResult expected = query(arguments + "brute_force");
      EXPECT_GE(lines(expected.out).size(), command == "closest " ? 2U : 10U);
      for (const std::string& engine : engines) {
        const ProcessResult result = query(arguments + engine);
        EXPECT_EQ(result.exit_code, 0) << engine << ": " << result.err;
        EXPECT_EQ(result.out, expected.out) << command << file << " with " << engine;
      }
    }
  }
}

TEST_F(FiberQuery, AnEngineThatIsNoneIsRefusedWithAllThereAre) {
  const std::string file = crossing();
  std::string known;
  for (const std::string& name : engine_names()) {
    known += (known.empty() ? "known are: " : ", ") + name;
  }
  known += "; DL-k and DS-k for even k from 6 to 200";
  for (const std::string engine : {"DL-7", "DL-4", "DL-202", "XX", "DS-", "DL-20x", "\"\""}) {
    EXPECT_TRUE(refused(query("contacts " + file + " --engine " + engine), known));
  }
  EXPECT_TRUE(
      refused(query("contacts " + file + " --engine DL-7"),
              "'DL-7' (k-DOP with k = 7: k must be even, from 6 to 200), known are: run_tree, AL"));
}

TEST_F(FiberQuery, ThreadingRefusesFibresOfDifferentLength) {
  EXPECT_TRUE(refused(query("contacts " + crossing() + " --engine AL-threaded"),
                      "fibre 1 has 1 segment(s), fibre 0 has 2; threading needs the same number"));
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
    QueryResult expected;
    brute_force(frame.fibers, options, expected);
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

TEST_F(FiberQuery, RefusesBadCommandLines) {
  const std::string file = crossing();
  EXPECT_TRUE(
      refused(query(""),
              "a subcommand is needed: contacts, closest, first, fiber_pairs, nearest, segments"));
  EXPECT_TRUE(refused(query("touches " + file), "touches"));
  EXPECT_TRUE(refused(query("contacts"), "FILE"));
  EXPECT_TRUE(refused(query("contacts " + file + " --frobnicate"), "--frobnicate"));
  EXPECT_TRUE(refused(query("contacts " + file + " more.csv"), "more.csv"));
  EXPECT_TRUE(refused(query("contacts " + file + " --engine XL"), "'XL', known are: run_tree, AL"));
  EXPECT_TRUE(refused(query("contacts " + file + " --format xml"), "--format: xml"));
  EXPECT_TRUE(refused(query("contacts " + file + " --threads x"), "--threads: 'x'"));
  EXPECT_TRUE(
      refused(query("contacts " + file + " --margin wide"), "--margin: 'wide' must be a number"));
  EXPECT_TRUE(refused(query("contacts " + file + " --margin -1"), "margin is -1"));
  EXPECT_TRUE(refused(query("contacts " + file + " --margin nan"), "margin is nan"));
  EXPECT_TRUE(refused(query("contacts " + file + " --margin"), "--margin"));
  EXPECT_TRUE(refused(query("contacts " + file + " --neighbour-skip -1"), "--neighbour-skip = -1"));
  EXPECT_TRUE(refused(query("contacts " + file + " --neighbour-skip-length -1"),
                      "neighbour_skip_length is -1"));
  EXPECT_TRUE(refused(query("contacts " + file + " --radius -1"), "radius is -1"));
}

TEST_F(FiberQuery, RefusesBadFilesNamingFileLineAndReason) {
  EXPECT_TRUE(refused(query("contacts " + path("none.csv")),
                      path("none.csv") + ": cannot be opened: No such file or directory"));
  EXPECT_TRUE(refused(query("contacts /"), "/: cannot be read: Is a directory"));
  const std::string head = "fiber,x,y,z\n0,0,0,0\n";
  const auto refusal = [this](const std::string& content, const std::string& reason) {
    return refused(query("contacts " + write("bad.csv", content)), path("bad.csv") + reason);
  };
  EXPECT_TRUE(refusal("", ": is empty"));
  EXPECT_TRUE(refusal("x,y,z\n0,0,0\n", ":1: the header is 'x,y,z'"));
  EXPECT_TRUE(refusal(head + "0,abc,0,0\n", ":3: x is 'abc', expected a number"));
  EXPECT_TRUE(refusal(head + "0,0,nan,0\n", ":3: y is 'nan'"));
  EXPECT_TRUE(refusal(head + "0,0,0,inf\n", ":3: z is 'inf'"));
  EXPECT_TRUE(refusal(head + "0,0,0\n", ":3: has 3 values, expected 4"));
  EXPECT_TRUE(refusal(head, ":2: fibre '0' has only this point"));
  EXPECT_TRUE(
      refusal(head + "0,1,0,0\n1,0,0,0\n1,1,0,0\n0,2,0,0\n", ":6: fibre '0' appears again"));
  EXPECT_TRUE(refusal("fiber,x,y,z,radius\n0,0,0,0,-1\n", ":2: radius is '-1'"));
}

TEST_F(FiberQuery, OutputThatCannotBeWrittenIsAnError) {
  const ProcessResult result =
      run_process("(" FIBER_QUERY " contacts " + crossing() + " >/dev/full)");
  EXPECT_TRUE(refused(result, "cannot be written"));
}

TEST_F(FiberQuery, AnswersTheRecordedCables) {
  const std::filesystem::path data = shared_data();
  if (!std::filesystem::exists(data / "cable_track_a.csv")) {
    GTEST_SKIP() << "no recorded cables in " << data;
  }
  for (const std::string name : {"a", "b", "c"}) {
    const std::string arguments =
        "contacts " + (data / ("cable_track_" + name + ".csv")).string() + " --margin 0.08";
    const ProcessResult tree = query(arguments);
    EXPECT_EQ(tree.exit_code, 0) << tree.err;
    EXPECT_EQ(tree.out, query(arguments + " --engine brute_force").out);
  }
}

}  // namespace
}  // namespace fiber::test
