// Where tools write to: no link, pipe or device becomes a file, and no name says something else.
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "test/tools/simulate.hpp"

namespace fiber::test {
namespace {

class Outputs : public Simulate {
 protected:
  std::string rope() const {
    return write(
        "rope.yaml",
        "{fibers: [{name: a, shape: {line: {from: [0, 0, 0], to: [1, 0, 0]}}, segments: 4, "
        "radius: 0.01, material: rope}], effects: [gravity], time_step: 0.01}");
  }
  std::string simulation(const std::string& out) const {
    return FIBER_SIMULATE " " + rope() + " --seconds 0.02 --out " + out;
  }
  static std::string soup_to(const std::string& out) {
    return FIBER_SCENE " soup --scale 0.001 --out " + out;
  }
};

TEST_F(Outputs, LinksAreFollowed) {
  for (const std::string& command :
       {soup_to(path("link.csv")), simulation(path("link.csv")),
        simulation(path("other.csv")) + " --forces " + path("link.csv")}) {
    write("target.csv", "old\n");
    std::filesystem::remove(path("link.csv"));
    std::filesystem::create_symlink("target.csv", path("link.csv"));
    EXPECT_EQ(run_process(command).exit_code, 0) << command;
    EXPECT_TRUE(std::filesystem::is_symlink(path("link.csv"))) << command;
    EXPECT_GT(read_file(path("target.csv")).size(), 100U) << command;
  }
}

TEST_F(Outputs, PipesAreWrittenTo) {
  const std::string pipe = path("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& command : {soup_to(pipe), simulation(pipe)}) {
    const ProcessResult read = run_process("(" + command + " & cat " + pipe + "; wait $!)");
    EXPECT_EQ(read.exit_code, 0) << read.err;
    EXPECT_GT(read.out.size(), 100U) << command;
    EXPECT_TRUE(std::filesystem::is_fifo(pipe)) << command;
  }
}

TEST_F(Outputs, DevicesAreWrittenTo) {
  const std::string device = path("null");
  if (geteuid() != 0 || mknod(device.c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0) {
    GTEST_SKIP() << "only root makes devices";
  }
  for (const std::string& command : {soup_to(device), simulation(device)}) {
    EXPECT_EQ(run_process(command).exit_code, 0) << command;
    EXPECT_TRUE(std::filesystem::is_character_file(device)) << command;
  }
}

TEST_F(Outputs, NamesOfOtherFormatsAreRefused) {
  const std::string written =
      "; CSV, .hair, .npz, .pvd, .tck, .trk and .vtp are written, and .h5 by fiber_query_mpi "
      "convert";
  for (const std::string end : {"h5", "vtu", "trx", "npy", "json"}) {
    const std::string out = path("out." + end);
    EXPECT_TRUE(refused(run_process(soup_to(out)), "'" + out + "' is a name of "));
    EXPECT_TRUE(refused(run_process(simulation(out)), written));
    EXPECT_TRUE(refused(run_process(simulation(path("out.csv")) + " --forces " + out),
                        "--forces: '" + out + "' is a name of "));
    EXPECT_FALSE(std::filesystem::exists(out));
    EXPECT_TRUE(refused(query("contacts " + out), out + ": is "));
  }
  EXPECT_TRUE(refused(run_process(simulation(path("out.tck"))),
                      "a .tck file cannot hold this: it holds exactly 1 frame without a number, "
                      "not frames with numbers"));
  EXPECT_FALSE(std::filesystem::exists(path("out.csv"))) << "before anything is written";
  EXPECT_TRUE(refused(query("contacts " + path("a.h5")),
                      ": is HDF5 by its name; CSV, .hair, .npz, .swc, .tck, .trk, .vtk and .vtp "
                      "are read, and .h5 by fiber_query_mpi"));
}

}  // namespace
}  // namespace fiber::test
