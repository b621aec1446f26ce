// Files that are no whole files of fibres: all ranks say so, and the same.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/hdf5_file.hpp"
#include "test/mpi/open_file.hpp"
#include "test/mpi/scattered_fibers.hpp"
#include "test/mpi/shared_folder.hpp"

namespace fiber::test {
namespace {

/// Three fibres of 4, 3 and 5 points, on rank 0.
DistributedFibers three_fibers() {
  DistributedFibers fibers;
  if (own_rank() == 0) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 12; ++i) {
      points.emplace_back(0.1 * i, 0.01 * i * i, 0.0);
    }
    fibers.parts = FiberAssembly(points, {0, 4, 7, 12}, {0.001});
    fibers.names = {{5, 0}, {6, 0}, {8, 0}};
  }
  fibers.fiber_names = FiberNames({"a", "b", "c", "d", "e", "f", "g", "h", "i"});
  return fibers;
}

void write_fibers_to(const std::string& path, const DistributedFileOptions& options = {},
                     const DistributedFibers& fibers = three_fibers()) {
  DistributedFiberWriter writer(MPI_COMM_WORLD, path, options);
  writer.write(0, fibers);
  if (options.has_frames) {
    writer.write(1, fibers);
  }
  writer.finish();
}

/// Rank 0 breaks something, the others wait.
void on_rank_0(const std::function<void()>& work) {
  if (own_rank() == 0) {
    work();
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

/// Reads all frames.
std::string error_of_reading(const std::string& path) {
  try {
    const DistributedFiberReader reader(MPI_COMM_WORLD, path);
    DistributedFibers fibers;
    for (std::size_t i = 0; i < reader.frame_count(); ++i) {
      reader.read(i, fibers);
    }
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

void expect_refused(const std::string& path, const std::string& text) {
  testing::internal::CaptureStderr();
  const std::string error = error_of_reading(path);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");  // HDF5 prints nothing
  EXPECT_NE(error.find(text), std::string::npos) << error << "\nexpected: " << text;
  EXPECT_EQ(error.rfind("rank ", 0), 0u) << error;
  MPI_Barrier(MPI_COMM_WORLD);
}

struct Damage {
  std::string what;
  std::function<void(const OpenFile& file)> change;
  std::string error;
};

/// Damages a file, and reads it.
void expect_result_of(const Damage& damage, const std::string& path) {
  SCOPED_TRACE(damage.what);
  on_rank_0([&] { damage.change(OpenFile(path)); });
  if (damage.error == "no error") {
    EXPECT_EQ(error_of_reading(path), damage.error);
    MPI_Barrier(MPI_COMM_WORLD);
  } else {
    expect_refused(path, damage.error);
  }
}

TEST(BrokenFiles, WhatIsWrongWithJointsIsSaid) {
  const SharedFolder folder;
  const std::string path = folder / "broken.h5";
  DistributedFibers fibers = three_fibers();
  if (own_rank() == 0) {
    fibers.topology.closed = {0, 1, 0};
    fibers.topology.joints = {3, -1, -1, 4, -1, 4, -1, 3, -1, -1, -1, -1};
    fibers.topology.joint_tolerance = 0.5;
  }
  const std::string joints = "VTKHDF/PointData/joint";
  const std::string closed = "VTKHDF/CellData/closed";
  const std::vector<Damage> damages{
      {"nothing", [](const OpenFile&) {}, "no error"},
      {"no joints", [&](const OpenFile& file) { file.remove(joints); },
       "dataset joint cannot be read"},
      {"none closed", [&](const OpenFile& file) { file.remove(closed); },
       "dataset closed cannot be read"},
      {"fewer joints",
       [&](const OpenFile& file) {
         file.replace<std::int64_t>(joints, {11, 1}, std::vector<std::int64_t>(11, -1));
       },
       "dataset joint has 11 rows of 1 values, it must have 12 rows of 1 value"},
      {"more that are closed",
       [&](const OpenFile& file) {
         file.replace<std::uint8_t>(closed, {4, 1}, {0, 0, 0, 0});
       },
       "dataset closed has 4 rows of 1 values, it must have 3 rows of 1 value"},
      {"a large joint",
       [&](const OpenFile& file) { file.set<std::int64_t>(joints, 5, {2147483648}); },
       "point 5 has the joint 2147483648, joints are numbers from 0 to 2147483647, -1 for none"},
      {"a negative joint", [&](const OpenFile& file) { file.set<std::int64_t>(joints, 7, {-2}); },
       "point 7 has the joint -2, joints are numbers"},
      {"half closed", [&](const OpenFile& file) { file.set<std::uint8_t>(closed, 2, {7}); },
       "line 2 has closed 7, it must be 0 or 1"},
      {"a negative tolerance",
       [](const OpenFile& file) {
         H5Adelete(file.get(), "joint_tolerance");
         write_real(file.get(), "joint_tolerance", -0.5);
       },
       "joint_tolerance is -0.5 m, it must be at least 0"},
  };
  for (const Damage& damage : damages) {
    write_fibers_to(path, {}, fibers);
    expect_result_of(damage, path);
  }
}

TEST(BrokenFiles, WhatIsWrongInOneIsSaid) {
  const SharedFolder folder;
  const std::string path = folder / "broken.h5";
  const double nan = std::nan("");
  const std::vector<Damage> damages{
      {"nothing", [](const OpenFile&) {}, "no error"},
      {"no attribute", [](const OpenFile& file) { H5Adelete(file.get(), "fiber_proximity"); },
       "is no file of fibres"},
      {"an attribute of another kind",
       [](const OpenFile& file) {
         H5Adelete(file.get(), "fiber_proximity");
         write_numbers(file.get(), "fiber_proximity", {7});
       },
       "is no file of fibres"},
      {"another version",
       [](const OpenFile& file) {
         H5Adelete(file.get(), "version");
         write_numbers(file.get(), "version", {3});
       },
       "has a layout of version 3, known are 1 and 2"},
      {"a dataset of joints in a file of the first version",
       [](const OpenFile& file) {
         create_dataset(file.get(), "VTKHDF/PointData/joint", hdf5_type(double()).file, {1, 1});
       },
       "no error"},
      {"no group", [](const OpenFile& file) { file.remove("VTKHDF"); },
       "group VTKHDF cannot be read"},
      {"no radii", [](const OpenFile& file) { file.remove("VTKHDF/PointData/radius"); },
       "dataset radius cannot be read"},
      {"a group for a dataset",
       [](const OpenFile& file) {
         file.remove("VTKHDF/Points");
         create_group(file.get(), "VTKHDF/Points");
       },
       "dataset Points cannot be read"},
      {"fewer radii",
       [](const OpenFile& file) {
         file.replace<double>("VTKHDF/PointData/radius", {11, 1}, std::vector<double>(11, 0.0));
       },
       "dataset radius has 11 rows of 1 values, it must have 12 rows of 1 value"},
      {"radii of two values",
       [](const OpenFile& file) {
         file.replace<double>("VTKHDF/PointData/radius", {12, 2}, std::vector<double>(24, 0.0));
       },
       "dataset radius has 12 rows of 2 values"},
      {"fewer points",
       [](const OpenFile& file) {
         file.replace<double>("VTKHDF/Points", {10, 3}, std::vector<double>(30, 0.0));
       },
       "dataset radius has 12 rows of 1 values, it must have 10"},
      {"points of two coordinates",
       [](const OpenFile& file) {
         file.replace<double>("VTKHDF/Points", {12, 2}, std::vector<double>(24, 0.0));
       },
       "dataset Points has 2 columns, it must have 3"},
      {"fewer names",
       [](const OpenFile& file) {
         file.replace<std::uint64_t>("VTKHDF/CellData/fiber", {2, 1}, {5, 6});
       },
       "dataset first_segment has 3 rows of 1 values, it must have 2"},
      {"fewer offsets",
       [](const OpenFile& file) {
         file.replace<std::int64_t>("VTKHDF/Offsets", {3, 1}, {0, 4, 12});
       },
       "dataset Offsets has 3 rows of 1 values, it must have 4"},
      {"offsets that begin late",
       [](const OpenFile& file) { file.set<std::int64_t>("VTKHDF/Offsets", 0, {1}); },
       "Offsets begin with 1 and end with 12, they must with 0 and 12"},
      {"offsets that end early",
       [](const OpenFile& file) { file.set<std::int64_t>("VTKHDF/Offsets", 3, {11}); },
       "Offsets begin with 0 and end with 11, they must with 0 and 12"},
      {"a coordinate that is no number",
       [nan](const OpenFile& file) {
         file.set<double>("VTKHDF/Points", 9, {0.0, nan, 0.0});
       },
       "point 9 has the coordinate nan, coordinates must be finite"},
      {"an infinite coordinate",
       [](const OpenFile& file) {
         file.set<double>("VTKHDF/Points", 2, {HUGE_VAL, 0.0, 0.0});
       },
       "point 2 has the coordinate inf, coordinates must be finite"},
      {"no names of fibres", [](const OpenFile& file) { file.remove("fiber_names"); }, "no error"},
      {"too few names of fibres",
       [](const OpenFile& file) {
         file.replace<std::uint8_t>("fiber_names", {4, 1}, {'a', '\n', 'b', '\n'});
       },
       " has no name, there are 2"},
      {"a name of a fibre without an end",
       [](const OpenFile& file) {
         file.replace<std::uint8_t>("fiber_names", {3, 1}, {'a', '\n', 'b'});
       },
       "the last name of a fibre has no end"},
      {"a name of two fibres",
       [](const OpenFile& file) {
         file.replace<std::uint8_t>("fiber_names", {4, 1}, {'a', '\n', 'a', '\n'});
       },
       "fibre 1: the name 'a' is that of another, too"},
      {"names in columns",
       [](const OpenFile& file) {
         file.replace<std::uint8_t>("fiber_names", {1, 2}, {'a', '\n'});
       },
       "dataset fiber_names has 2 columns, it must have 1"},
      {"a negative radius",
       [](const OpenFile& file) { file.set<double>("VTKHDF/PointData/radius", 5, {-1.0}); },
       "point 5 has the radius -1, radii must be finite, at least 0"},
  };
  for (const Damage& damage : damages) {
    write_fibers_to(path);
    expect_result_of(damage, path);
  }
}

TEST(BrokenFiles, OffsetsOfAnyOrderAreRefusedByAnyNumberOfRanks) {
  const SharedFolder folder;
  const std::string path = folder / "offsets.h5";
  write_fibers_to(path);
  for (const std::int64_t first : {-1, 0, 1, 2, 3, 6, 7, 9, 11, 12, 13}) {
    for (const std::int64_t second : {-5, 0, 3, 4, 5, 8, 11, 12, 99}) {
      SCOPED_TRACE(std::to_string(first) + ", " + std::to_string(second));
      on_rank_0([&] {
        OpenFile(path).replace<std::int64_t>("VTKHDF/Offsets", {4, 1}, {0, first, second, 12});
      });
      const bool is_right = first >= 2 && second >= first + 2 && second <= 10;
      const std::string error = error_of_reading(path);
      EXPECT_EQ(error == "no error", is_right) << error;
      MPI_Barrier(MPI_COMM_WORLD);
    }
  }
}

TEST(BrokenFiles, FilesThatAreNotWholeAreRefused) {
  const SharedFolder folder;
  expect_refused(folder / "none.h5", "none.h5: cannot be opened: No such file");
  on_rank_0([&] { std::ofstream(folder / "empty.h5"); });
  expect_refused(folder / "empty.h5", "is no whole HDF5 file");
  on_rank_0([&] { std::ofstream(folder / "text.h5") << "fiber,x,y,z\n"; });
  expect_refused(folder / "text.h5", "is no whole HDF5 file");
  const std::string path = folder / "short.h5";
  write_fibers_to(path);
  const std::uintmax_t size = std::filesystem::file_size(path);
  for (const std::uintmax_t left : {size - 1, size / 2, size / 10, std::uintmax_t{100}}) {
    SCOPED_TRACE(left);
    on_rank_0([&] { std::filesystem::resize_file(path, left); });
    expect_refused(path, "short.h5: is no whole HDF5 file");
  }
}

TEST(BrokenFiles, FramesThatAreNotThereAreRefused) {
  const SharedFolder folder;
  DistributedFileOptions options;
  options.has_frames = true;
  write_fibers_to(folder / "moving.h5", options);
  EXPECT_EQ(error_of_reading(folder / "moving.h5"), "no error");
  MPI_Barrier(MPI_COMM_WORLD);
  on_rank_0([&] { std::filesystem::resize_file(folder / "moving.frames/000001.h5", 1000); });
  expect_refused(folder / "moving.h5", "moving.h5: frames/000001: group frames/000001 cannot be");
  on_rank_0([&] { std::filesystem::remove(folder / "moving.frames/000001.h5"); });
  expect_refused(folder / "moving.h5", "moving.h5: frames/000001: group frames/000001 cannot be");
}

TEST(BrokenFiles, PartsThatOverlapAreRefusedByTheEngine) {
  const SharedFolder folder;
  const std::string path = folder / "overlap.h5";
  write_fibers_to(path);
  on_rank_0([&] { OpenFile(path).set<std::uint64_t>("VTKHDF/CellData/fiber", 1, {5}); });
  DistributedFibers fibers;
  DistributedFiberReader(MPI_COMM_WORLD, path).read(0, fibers);
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  try {
    engine.update(fibers.parts, fibers.names);
    FAIL() << "no error";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("fibre 5: rank "), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace fiber::test
