// What fiber_query holds in memory where a frame has many contacts.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fiber_proximity/query/contact.hpp"
#include "tools/tools_test.hpp"

namespace fiber::test {
namespace {

/// Runs fiber_query without its output.
/// @return the most memory it held [bytes]
double peak_memory(const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>(FIBER_QUERY)};
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
    ::execv(FIBER_QUERY, argv.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  EXPECT_EQ(::wait4(child, &status, 0, &usage), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

class Memory : public ToolsTest {};

TEST_F(Memory, TheTextOfAFrameIsNeverThereAsAWhole) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer keeps memory that is free";
#endif
  const std::string file = path("soup.csv");
  ASSERT_EQ(scene("soup --scale 0.02 --seed 1 --out " + file).exit_code, 0);
  const std::string margin = "0.06";
  const ProcessResult all = query("contacts " + file + " --margin " + margin);
  const auto count = std::count(all.out.begin(), all.out.end(), '\n') - 1;
  ASSERT_GT(count, 200'000) << "or what the program itself needs counts";

  const double base = peak_memory({"first", file, "--margin", margin});
  const double csv = peak_memory({"contacts", file, "--margin", margin}) - base;
  const double json =
      peak_memory({"contacts", file, "--margin", margin, "--format", "json"}) - base;
  // The contacts and their candidates: a list that doubles was there up to three times.
  EXPECT_LE(csv, 1.6 * static_cast<double>(count) * sizeof(Contact));
  EXPECT_LE(json, 1.2 * csv);
}

}  // namespace
}  // namespace fiber::test
