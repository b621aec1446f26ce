#include "fiber_proximity/io/fiber_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "test/support/temporary_directory.hpp"

namespace fiber {
namespace {

const FiberAssembly one_segment({{1, 2, 3}, {4, 5, 6}}, {0, 2}, {0.5});

const std::vector<std::string> one_frame_formats{"hair", "npz", "tck", "trk", "vtp"};

class FiberFileTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return directory_.path(name); }

  std::string start_of(const std::string& name) const {
    std::string start(4, '\0');
    std::ifstream(path(name), std::ios::binary).read(start.data(), 4);
    return start;
  }

 private:
  test::TemporaryDirectory directory_;
};

TEST_F(FiberFileTest, TheNameDecidesTheFormat) {
  for (const std::string name : {"a.hair", "b.HAIR", "hair.csv", "c", ".hair"}) {
    SCOPED_TRACE(name);
    write_fibers(path(name), {false, {{0, one_segment}}});
    const bool is_hair = name == "a.hair" || name == "b.HAIR";
    EXPECT_EQ(start_of(name), is_hair ? "HAIR" : "fibe");
    const FiberFile file = read_fibers(path(name));
    EXPECT_EQ(file.frames.at(0).fibers.points(), one_segment.points());
    EXPECT_EQ(file.frames.at(0).fibers.radii(), one_segment.radii());
  }
}

TEST_F(FiberFileTest, TheDefaultRadiusReachesBoth) {
  std::ofstream(path("a.csv")) << "fiber,x,y,z\n0,0,0,0\n0,1,0,0\n";
  write_fibers(path("a.hair"), {false, {{0, {one_segment.points(), {0, 2}, {0.0}}}}});
  for (const std::string name : {"a.csv", "a.hair"}) {
    const std::vector<double> radii = read_fibers(path(name), 0.25).frames.at(0).fibers.radii();
    EXPECT_EQ(radii, std::vector<double>{0.25}) << name;
  }
}

TEST_F(FiberFileTest, FormatsOfOneFrameReadWhatTheyWrite) {
  for (const std::string& end : one_frame_formats) {
    SCOPED_TRACE(end);
    write_fibers(path("a." + end), {false, {{0, one_segment}}});
    const FiberAssembly again = read_fibers(path("a." + end)).frames.at(0).fibers;
    EXPECT_EQ(again.points(), one_segment.points());
    EXPECT_EQ(again.radii(), end == "tck" ? std::vector<double>{0.0} : one_segment.radii());
    EXPECT_THROW(write_fibers(path("b." + end), {true, {{3, one_segment}}}), std::invalid_argument);
    EXPECT_THROW(write_fibers(path("b." + end), {false, {}}), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(path("b." + end)));
  }
}

TEST_F(FiberFileTest, ManyFramesGoIntoCsvOnly) {
  write_fibers(path("a.csv"), {true, {{3, one_segment}, {5, one_segment}}});
  EXPECT_EQ(read_fibers(path("a.csv")).frames.at(1).frame, 5);
  EXPECT_THROW(write_fibers(path("a.hair"), {true, {{3, one_segment}}}), std::invalid_argument);
  EXPECT_THROW(write_fibers(path("b.hair"), {false, {}}), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path("a.hair")));
  EXPECT_THROW(write_fibers(path("c.hair"), {false, {{0, one_segment}, {1, one_segment}}}),
               std::invalid_argument);
}

TEST_F(FiberFileTest, NamesOfOtherFormatsAreRefused) {
  const auto error = [](const auto& work) -> std::string {
    try {
      work();
    } catch (const std::exception& failure) {
      return failure.what();
    }
    return "none";
  };
  const auto reading = [&](const std::string& name) {
    return error([&] { read_fibers(path(name)); });
  };
  const auto writing = [&](const std::string& name) {
    return error([&] { write_fibers(path(name), {false, {{0, one_segment}}}); });
  };
  const std::string read =
      "; CSV, .hair, .npz, .swc, .tck, .trk, .vtk and .vtp are read, and .h5 by fiber_query_mpi";
  const std::string written =
      "; CSV, .hair, .npz, .pvd, .tck, .trk and .vtp are written, and .h5 by fiber_query_mpi "
      "convert";
  EXPECT_EQ(reading("a.h5"), path("a.h5") + ": is HDF5 by its name" + read);
  EXPECT_EQ(writing("a.h5"), "'" + path("a.h5") + "' is a name of HDF5" + written);
  EXPECT_EQ(writing("A.VTU"), "'" + path("A.VTU") + "' is a name of VTK" + written);
  EXPECT_EQ(reading("a.pvd"), path("a.pvd") + ": is a collection of VTK by its name" + read);
  for (const std::string end : {"hdf5", "vtkhdf", "vtu", "npy", "trx", "ply", "obj", "json", "yaml",
                                "xlsx", "csv.gz", "mat", "abc", "usda", "bag"}) {
    EXPECT_NE(reading("a." + end).find(" by its name; "), std::string::npos) << end;
    EXPECT_NE(writing("a." + end).find(" is a name of "), std::string::npos) << end;
    EXPECT_FALSE(std::filesystem::exists(path("a." + end)));
  }
  for (const std::string name :
       {"a.csv", "a.CSV", "a.txt", "a.dat", "a.tsv", "a", "run_0.5", "h5", ".h5", "a.h5.old"}) {
    EXPECT_EQ(writing(name), "none") << name;
    EXPECT_EQ(reading(name), "none") << name;
    EXPECT_EQ(start_of(name), "fibe") << name;
  }
}

TEST_F(FiberFileTest, NamesWhatCannotBeReadOrWritten) {
  EXPECT_THROW(read_fibers(path("missing.hair")), FileError);
  EXPECT_THROW(read_fibers(path("missing.csv")), FileError);
  EXPECT_THROW(write_fibers("/no/such/a.hair", {false, {{0, one_segment}}}), FileError);
  EXPECT_THROW(write_fibers("/no/such/a.csv", {false, {{0, one_segment}}}), FileError);
}

}  // namespace
}  // namespace fiber
