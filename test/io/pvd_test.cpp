#include <gtest/gtest.h>

#include <filesystem>
#include <iterator>
#include <sstream>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/support/process.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber {
namespace {

/// The numbers of an array of a file, from after what tells it to its end.
std::vector<double> numbers_after(const std::string& file, const std::string& attribute) {
  const std::size_t begin = file.find('\n', file.find(attribute));
  std::istringstream stream(file.substr(begin, file.find("</DataArray>", begin) - begin));
  return {std::istream_iterator<double>(stream), {}};
}

/// Two fibres, of 2 and of 3 points, whose numbers are not round.
FiberAssembly two_fibers(double shift) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 5; ++i) {
    points.emplace_back(shift + i / 3.0, -1e-300, i * 1e9);
  }
  return {points, {0, 2, 5}, {0.1, 1.0 / 3.0}};
}

std::string error_of(const std::string& path) {
  try {
    PvdWriter(path).write({0, two_fibers(0.0)}, 0.0);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Pvd, FramesHaveThePointsLinesAndRadii) {
  const test::TemporaryDirectory folder;
  const FiberAssembly fibers = two_fibers(0.1);
  PvdWriter(folder.path("run.pvd")).write({12, fibers}, 0.5);
  const std::string file = test::read_file(folder.path("run_000012.vtp"));
  std::vector<double> expected;
  for (const Eigen::Vector3d& point : fibers.points()) {
    expected.insert(expected.end(), point.data(), point.data() + 3);
  }
  EXPECT_EQ(numbers_after(file, "NumberOfComponents=\"3\""), expected);
  EXPECT_EQ(numbers_after(file, "\"radius\" format"),
            (std::vector<double>{0.1, 0.1, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}));
  EXPECT_EQ(numbers_after(file, "\"fiber\""), (std::vector<double>{0, 0, 1, 1, 1}));
  EXPECT_EQ(numbers_after(file, "\"connectivity\""), (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(numbers_after(file, "\"offsets\""), (std::vector<double>{2, 5}));
  EXPECT_NE(file.find("NumberOfPoints=\"5\" NumberOfVerts=\"0\" NumberOfLines=\"2\""),
            std::string::npos);
}

/// Python's parser says whether a file is XML.
std::string files_named_in(const std::string& pvd) {
  const test::ProcessResult result = test::run_process(
      "/usr/bin/python3 -c 'import sys, xml.etree.ElementTree as tree\n"
      "for each in tree.parse(sys.argv[1]).getroot().iter(\"DataSet\"):\n"
      "  print(each.get(\"timestep\"), each.get(\"file\"))' '" +
      pvd + "'");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out;
}

TEST(Pvd, CanBeOpenedAfterEachFrame) {
  const test::TemporaryDirectory folder;
  const std::string file = folder.path("a<b>&\"c.pvd");
  PvdWriter writer(file);
  EXPECT_EQ(files_named_in(file), "");
  writer.write({0, two_fibers(0.0)}, 0.0);
  const std::string first = "0 a<b>&\"c_000000.vtp\n";
  EXPECT_EQ(files_named_in(file), first);
  writer.write({1, two_fibers(1.0)}, 1.0 / 60.0);
  EXPECT_EQ(files_named_in(file), first + "0.016666666666666666 a<b>&\"c_000001.vtp\n");
  EXPECT_EQ(files_named_in(folder.path("a<b>&\"c_000001.vtp")), "");
}

TEST(Pvd, AFiberWriterWritesItByItsName) {
  const test::TemporaryDirectory folder;
  FiberWriter writer(folder.path("run.PVD"), true);
  writer.write({7, two_fibers(0.0)});
  writer.write({8, two_fibers(0.0)}, 0.25);
  writer.finish();
  EXPECT_EQ(files_named_in(folder.path("run.PVD")), "7 run_000007.vtp\n0.25 run_000008.vtp\n");
}

TEST(Pvd, WhatCannotBeWrittenIsNamed) {
  const test::TemporaryDirectory folder;
  EXPECT_EQ(
      error_of(folder.path("none/run.pvd")),
      folder.path("none/run.pvd") + ": cannot be opened for writing: No such file or directory");
  std::filesystem::create_symlink("/dev/full", folder.path("full.pvd"));
  EXPECT_EQ(error_of(folder.path("full.pvd")),
            folder.path("full.pvd") + ": cannot be written: No space left on device");
  std::filesystem::create_symlink("/dev/full", folder.path("run_000000.vtp"));
  EXPECT_EQ(error_of(folder.path("run.pvd")),
            folder.path("run_000000.vtp") + ": cannot be written: No space left on device");
}

}  // namespace
}  // namespace fiber
