// Typing errors and files that are none are refused in one short line on stderr, with exit 2.
#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

class BadCommandLine : public ToolsTest {
 protected:
  std::string crossing() const {
    return write("crossing.csv",
                 "fiber,x,y,z,radius\n"
                 "a,-2,0,0,0.2\na,-1,0,0,0.2\na,1,0,0,0.2\n"
                 "b,0,-1,0.5,0.2\nb,0,1,0.5,0.2\n");
  }
  std::string soup() const {
    const ProcessResult made = scene("soup --scale 0.003 --out " + path("soup.csv"));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return path("soup.csv");
  }
  static auto line_count(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  }
};

TEST_F(BadCommandLine, ThreadsBeyondTheMostAreRefusedAndThoseBeyondTheCoresAreQuiet) {
  const std::string file = soup();
  for (const std::string command :
       {"contacts ", "nearest --point 0,0,0 ", "crossings ", "compare "}) {
    for (const std::string threads : {"1025", "100000", "2147483648", "4294967295"}) {
      EXPECT_TRUE(refused(query(command + file + " --threads " + threads),
                          "threads is " + threads + ", it must be at most 1024"));
    }
    EXPECT_TRUE(refused(query(command + file + " --threads 4294967296"), "--threads"));
  }
  EXPECT_TRUE(refused(query("contacts " + file + " --engine AL --threads 1025"), "at most 1024"))
      << "an engine of one thread refuses what others refuse";
  for (const std::string command : {"contacts --margin 0.02 ", "crossings "}) {
    const ProcessResult one = query(command + file + " --threads 1");
    EXPECT_GT(line_count(one.out), 3);
    for (const std::string tool : {FIBER_QUERY " ", "taskset -c 0 " FIBER_QUERY " "}) {
      for (const std::string threads : {"0", "2", "7", "1024"}) {
        const ProcessResult result = run_process(tool + command + file + " --threads " + threads);
        EXPECT_EQ(result.err, "") << tool << threads;
        EXPECT_EQ(result.out, one.out) << tool << threads;
      }
    }
  }
}

TEST_F(BadCommandLine, RefusesWhatIsNoNumberWhereOneIsAskedFor) {
  const std::string file = crossing();
  for (const std::string option : {"--margin", "--neighbour-skip", "--neighbour-skip-length",
                                   "--radius", "--threads", "--tolerance", "--deadline"}) {
    for (const std::string value : {"", " ", "1e999", "-1e999", "1,5", "0x10", "1 2"}) {
      EXPECT_TRUE(refused(query("contacts " + file + " " + option + " '" + value + "'"),
                          option + ": '" + value + "' must be a"))
          << option;
    }
  }
  EXPECT_TRUE(refused(query("nearest " + file + " --point 0,0,0 --k ''"), "--k: ''"));
  EXPECT_TRUE(refused(query("crossings " + file + " --radius ''"), "--radius: ''"));
  EXPECT_TRUE(refused(query("compare " + file + " --margin ''"), "--margin: ''"));
  EXPECT_TRUE(refused(query("compare " + file + " --margin 1e999"), "--margin: '1e999'"));
  EXPECT_EQ(line_count(query("contacts " + file + " --margin inf").out), 1 + 2);
  EXPECT_EQ(query("closest " + file + " --margin +inf").exit_code, 0);
}

TEST_F(BadCommandLine, AnUnknownSubcommandIsRefusedWithAllThereAre) {
  const std::string known =
      ", known are: contacts, closest, first, fiber_pairs, nearest, segments, motions, sweep, ";
  EXPECT_TRUE(refused(query("touches " + crossing()), "unknown subcommand 'touches'" + known));
  EXPECT_TRUE(refused(query("''"), "unknown subcommand ''" + known));
}

// Whatever was put in comes back short and on one line.
TEST_F(BadCommandLine, ErrorsAreShortAndPrintable) {
  const std::string file = crossing();
  const std::string many(100'000, '7');
  std::vector<std::string> commands;
  const std::vector<std::string> places{"contacts @",
                                        "@ x.csv",
                                        "contacts -@",
                                        "contacts --@",
                                        "contacts " + file + " @",
                                        "contacts " + file + " --margin @",
                                        "contacts " + file + " --format @",
                                        "contacts " + file + " --engine @",
                                        "contacts " + file + " --engine DL-@",
                                        "contacts " + file + " --kernel @",
                                        "contacts " + file + " --neighbour-skip @",
                                        "nearest " + file + " --point @",
                                        "segments @",
                                        "motions @",
                                        "motions " + file + " --radius @"};
  const std::vector<std::string> values{"'" + many + "'", "x$(printf '\\n\\r\\033[2J\\177')y"};
  for (const std::string& where : places) {
    for (const std::string& value : values) {
      std::string command = where;
      commands.push_back(command.replace(where.find('@'), 1, value));
    }
  }
  for (const std::string& command : commands) {
    const ProcessResult result = query(command);
    EXPECT_TRUE(refused(result, "fiber_query: ")) << command.substr(0, 80);
    EXPECT_LE(result.err.size(), 6'100U) << command.substr(0, 80);
    for (const char letter : result.err.substr(0, result.err.size() - 1)) {
      ASSERT_TRUE(letter >= ' ' && letter <= '~') << result.err;
    }
  }
}

TEST_F(BadCommandLine, FilesWithLongLinesAreRefusedWithShortErrors) {
  const auto refusal = [this](const std::string& content, const std::string& reason) {
    const ProcessResult result = query("contacts " + write("long.csv", content));
    EXPECT_LE(result.err.size(), 1'000U);
    return refused(result, path("long.csv") + reason);
  };
  const std::string head = "fiber,x,y,z\n0,0,0,0\n";
  // So long on purpose. NOLINTNEXTLINE(bugprone-string-constructor)
  const std::string big(50'000'000, '1');
  EXPECT_TRUE(refusal(big, ":1: is longer than 65536 bytes and begins with '111"));
  EXPECT_TRUE(refusal(head + "0,1,0,0\n0," + big, ":4: is longer than 65536 bytes"));
  EXPECT_TRUE(refusal(std::string(70'000, '\0'), ":1: is longer than 65536 bytes"));
  EXPECT_TRUE(refusal(big.substr(0, 65'536), ":1: value 1 has 65536 bytes, at most 4096 are "));
  EXPECT_TRUE(refusal(head + "0,1,0," + std::string(4'097, '0'), ":3: value 4 has 4097 bytes"));
  EXPECT_TRUE(refusal("x" + std::string(4'000, '\x01') + "\n", ":1: the header is 'x\\x01"));
  EXPECT_TRUE(refused(query("contacts /dev/zero"), "/dev/zero:1: is longer than 65536 bytes"));
  EXPECT_TRUE(refused(query("segments /dev/zero"), "/dev/zero:1: is longer than 65536 bytes"));
  EXPECT_TRUE(refused(query("motions /dev/zero"), "/dev/zero:1: is longer than 65536 bytes"));

  const std::string zeros(4'000, '0');
  const std::string longest = "0,1." + zeros + ",0," + zeros + "1";
  const std::string padded = longest + std::string(65'536 - longest.size(), ' ');
  const ProcessResult fits =
      query("contacts " + write("fits.csv", head + padded + "\n" + longest + "\n"));
  EXPECT_EQ(fits.exit_code, 0) << fits.err;
}

}  // namespace
}  // namespace fiber::test
