// What other programs write: the same fibres from all of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/support/process.hpp"
#include "test/support/random.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber {
namespace {

using Names = std::vector<std::string>;

FiberFile read(const std::string& text) {
  std::istringstream stream(text);
  return read_csv(stream, "shape.csv", 0.25);
}

std::string error_in_shape(const std::string& text) {
  try {
    read(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "accepted";
}

Names names_in(const FiberFrame& frame) { return frame.names.list(frame.fibers.fiber_count()); }

/// One frame with two fibres, whatever else is in the file.
void expect_rope_and_tube(const FiberFile& file) {
  EXPECT_FALSE(file.has_frames);
  ASSERT_EQ(file.frames.size(), 1U);
  EXPECT_EQ(names_in(file.frames[0]), (Names{"rope", "tube"}));
  const FiberAssembly& fibers = file.frames[0].fibers;
  EXPECT_EQ(fibers.offsets(), (std::vector<std::uint32_t>{0, 2, 5}));
  const std::vector<Eigen::Vector3d> expected{
      {0, 1, 2}, {3, 4.5, 5}, {6, 7, 8}, {-9, 1, 0.125}, {2, 3, 4}};
  EXPECT_EQ(fibers.points(), expected);
}

TEST(CsvShapes, OfOneSpellingAndOfAllOthers) {
  const std::string plain =
      "fiber,x,y,z\nrope,0,1,2\nrope,3,4.5,5\ntube,6,7,8\ntube,-9,1,0.125\ntube,2,3,4\n";
  expect_rope_and_tube(read(plain));
  const auto with = [&plain](char from, const std::string& to) {
    std::string text;
    for (const char letter : plain) {
      text += letter == from ? to : std::string(1, letter);
    }
    return text;
  };
  const std::vector<std::string> shapes{
      with(',', ";"),
      with(',', "\t"),
      with(',', " "),
      with(',', "  \t "),
      with(',', " ,\t"),
      with('\n', "\r\n"),
      with('\n', "\n# a comment\n\n  # another, with x,y,z\n"),
      "\xEF\xBB\xBF" + plain,
      "# " + plain,
      "#" + with(',', ";"),
      "# made by a program\n#   x y z are in metres\n## " + with(',', " "),
      "# x y z are in metres\n" + plain,
      // MATLAB, R and pandas with quotes.
      "FIBER,X,Y,Z\nrope,0,1,2\nrope,3,4.5,5\ntube,6,7,8\ntube,-9,1,0.125\ntube,2,3,4\n",
      "\"\",\"fibre\",\"x\",\"y\",\"z\"\n\"1\",\"rope\",0,1,2\n\"2\",\"rope\",3,4.5,5\n"
      "\"3\",\"tube\",6,7,8\n\"4\",\"tube\",-9,1,0.125\n\"5\",\"tube\",2,3,4\n",
      ",fiber,x,y,z\n0,rope,0,1,2\n1,rope,3,4.5,5\n2,tube,6,7,8\n3,tube,-9,1,0.125\n4,tube,2,3,4\n",
      "\" X "
      "\";\"Y\";\"Fiber\";\"Z\"\r\n\"0\";\"1\";\"rope\";\"2\"\r\n\"3\";\"4.5\";\"rope\";\"5\"\r\n"
      "\"6\";\"7\";\"tube\";\"8\"\r\n\"-9\";\"1\";\"tube\";\"0.125\"\r\n\"2\";\"3\";\"tube\";\"4\"",
      // Another order, and of rows, too.
      "z,fiber,y,x\n2,rope,1,0\n5,rope,4.5,3\n8,tube,7,6\n0.125,tube,1,-9\n4,tube,3,2\n",
      "x,y,z,fiber\n0,1,2,rope\n6,7,8,tube\n3,4.5,5,rope\n-9,1,0.125,tube\n2,3,4,tube\n",
  };
  for (const std::string& shape : shapes) {
    SCOPED_TRACE(shape);
    expect_rope_and_tube(read(shape));
  }
}

TEST(CsvShapes, AllColumnsMayBeInCapitals) {
  const FiberFile file = read("FRAME,FIBRE,X,Y,Z,RADIUS\n4,a,0,0,0,0.5\n4,a,1,0,0,0.5\n");
  ASSERT_TRUE(file.has_frames);
  EXPECT_EQ(file.frames[0].frame, 4);
  EXPECT_EQ(file.frames[0].fibers.radii(), std::vector<double>{0.5});
}

TEST(CsvShapes, RowsMayBeShuffledAsLongAsThoseOfAFibreKeepTheirOrder) {
  test::Random random;
  const Names labels{"b", "7", "a c", "#1"};
  for (int round = 0; round < 50; ++round) {
    // Of each frame and fibre some points, which say whose they are.
    std::vector<std::string> whose;
    for (int frame = 0; frame < 3; ++frame) {
      for (std::size_t fiber = 0; fiber < labels.size(); ++fiber) {
        const int points = random.integer(2, 5);
        for (int i = 0; i < points; ++i) {
          whose.push_back(std::to_string(frame * 10 - 5) + ",\"" + labels[fiber] + "\"");
        }
      }
    }
    for (std::size_t i = whose.size(); i > 1; --i) {
      std::swap(whose[i - 1],
                whose[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
    }
    std::string text = "frame,fiber,x,y,z,radius\n";
    std::vector<std::string> frames;
    std::string before;
    bool are_mixed = false;
    for (std::size_t row = 0; row < whose.size(); ++row) {
      text += whose[row] + ',' + std::to_string(row) + ",0,0," + std::to_string(row) + '\n';
      const std::string frame = whose[row].substr(0, whose[row].find(','));
      if (std::find(frames.begin(), frames.end(), frame) == frames.end()) {
        frames.push_back(frame);
      } else if (frame != before) {
        are_mixed = true;
      }
      before = frame;
    }
    if (are_mixed) {
      frames = {"-5", "5", "15"};
    }
    const FiberFile file = read(text);
    ASSERT_EQ(file.frames.size(), frames.size());
    std::size_t rows = 0;
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const FiberFrame& frame = file.frames[f];
      EXPECT_EQ(std::to_string(frame.frame), frames[f]);
      const Names names = names_in(frame);
      double first_before = -1.0;
      for (std::size_t fiber = 0; fiber < names.size(); ++fiber) {
        double last = -1.0;
        for (std::size_t i = frame.fibers.offsets()[fiber]; i < frame.fibers.offsets()[fiber + 1];
             ++i, ++rows) {
          const double row = frame.fibers.points()[i].x();
          EXPECT_EQ(whose[static_cast<std::size_t>(row)], frames[f] + ",\"" + names[fiber] + "\"");
          EXPECT_GT(row, last) << "points in the order of their rows";
          EXPECT_EQ(frame.fibers.radii().at(i), row);
          last = row;
        }
        const double first = frame.fibers.points()[frame.fibers.offsets()[fiber]].x();
        EXPECT_GT(first, first_before) << "fibres in the order in which they appear";
        first_before = first;
      }
    }
    EXPECT_EQ(rows, whose.size());
    EXPECT_TRUE(file.notes.empty()) << "with frames this is told of nobody";
  }
}

TEST(CsvShapes, FramesThatAreMixedAreInTheOrderOfTheirNumbers) {
  const auto frames = [](const std::string& order) {
    std::string text = "frame,fiber,x,y,z\n";
    for (const char frame : order) {
      text += std::string(1, frame) + ",a,0,0,0\n" + frame + ",a,1,0,0\n";
    }
    std::string found;
    for (const FiberFrame& frame : read(text).frames) {
      found += std::to_string(frame.frame);
    }
    return found;
  };
  EXPECT_EQ(frames("132"), "132") << "as they stand";
  EXPECT_EQ(frames("13123"), "123") << "a fibre that is not in every frame comes first";
}

TEST(CsvShapes, WithoutAColumnFiberAFrameIsOneFibre) {
  const FiberFile file = read("x,frame,y,z\n0,1,0,0\n5,2,0,0\n1,1,0,0\n6,2,0,0\n");
  ASSERT_EQ(file.frames.size(), 2U);
  for (const FiberFrame& frame : file.frames) {
    EXPECT_EQ(frame.fibers.fiber_count(), 1U);
    EXPECT_EQ(frame.fibers.point_count(), 2U);
    EXPECT_TRUE(frame.names.are_indices());
  }
  EXPECT_EQ(file.frames[1].fibers.points()[0].x(), 5.0);
  EXPECT_TRUE(file.notes.empty());
  EXPECT_EQ(read("x,y,z\n0,0,0\n1,0,0\n2,0,0\n").frames.at(0).fibers.offsets(),
            (std::vector<std::uint32_t>{0, 3}));
}

TEST(CsvShapes, FramesMayBeWrittenAsOtherNumbers) {
  const FiberFile file =
      read("frame,fiber,x,y,z\n-3.000e+00,1.0,0,0,0\n-3,1.0,1,0,0\n+4.0,1.0,0,0,0\n4,1.0,1,0,0\n");
  ASSERT_EQ(file.frames.size(), 2U);
  EXPECT_EQ(file.frames[0].frame, -3);
  EXPECT_EQ(file.frames[1].frame, 4);
  EXPECT_EQ(names_in(file.frames[0]), Names{"1.0"}) << "a name is a text";
  for (const std::string frame :
       {"1e300", "0.5", "nan", "inf", "9007199254740993.0", "first", ""}) {
    EXPECT_EQ(error_in_shape("frame,x,y,z\n" + frame + ",0,0,0\n"),
              "shape.csv:2: frame is '" + frame + "', expected a whole number");
  }
}

TEST(CsvShapes, WhatIsNotReadIsTold) {
  EXPECT_TRUE(read("fiber,x,y,z,radius\n").notes.empty());
  EXPECT_TRUE(read(",fiber,x,y,z,\n").notes.empty()) << "an index, and the end of a line";
  EXPECT_EQ(read("Time,fiber,x,y,z\n").notes, Names{"column 'Time' is not read"});
  EXPECT_EQ(read("a,fiber,b,x,c,y,d,z,e,f,g\n").notes,
            Names{"columns 'a', 'b', 'c', 'd', 'e' and 2 more are not read"});
  EXPECT_EQ(read("id,x,y,z\n").notes,
            Names{"column 'id' is not read; there is no column fiber: all rows are one fibre"});
  EXPECT_EQ(
      read("frame,id,x,y,z\n").notes,
      Names{
          "column 'id' is not read; there is no column fiber: the rows of a frame are one fibre"});
  EXPECT_EQ(read("fiber,x,y,z\na,0,0,0\nb,0,0,0\na,1,0,0\nb,1,0,0\n").notes,
            Names{"rows of one fibre do not stand one after another, as of 'a': without a column "
                  "frame they are put together"});
}

TEST(CsvShapes, ACommentThatCouldBeARowIsRefused) {
  const std::string refused =
      ": is a comment, or a row of fibre '#a': a name that begins with # stands in quotes, and a "
      "comment is no row";
  EXPECT_EQ(error_in_shape("fiber,x,y,z\n#a,0,0,0\n"), "shape.csv:2" + refused);
  EXPECT_EQ(error_in_shape("# fiber,x,y,z\n#a,0,0,0\n"), "shape.csv:2" + refused);
  EXPECT_EQ(error_in_shape("x,y,z,fiber\n#0,0,0,a\n0,0,0,a\n1,0,0,a\n"), "accepted");
  EXPECT_EQ(error_in_shape("fiber,x,y,z\n# a, b, c, d\n\"#a\",0,0,0\n\"#a\",1,0,0\n"), "accepted");
}

TEST(CsvShapes, OtherFormatsAreKnownByTheirFirstBytes) {
  const std::string rest =
      ", by its name CSV; CSV, .hair, .npz, .swc, .tck, .trk, .vtk and .vtp are read, and .h5 by "
      "fiber_query_mpi";
  EXPECT_EQ(error_in_shape("\x89HDF\r\n\x1A\n"), "shape.csv:1: is HDF5" + rest);
  EXPECT_EQ(error_in_shape("<?xml version=\"1.0\"?>\n"), "shape.csv:1: is VTK" + rest);
  EXPECT_EQ(error_in_shape("# vtk DataFile Version 3.0\na title\nASCII\n"),
            "shape.csv:2: is VTK" + rest);
  EXPECT_EQ(error_in_shape("\x93NUMPY\x01"), "shape.csv:1: is NumPy" + rest);
  EXPECT_EQ(error_in_shape("HAIR\x01\n"), "shape.csv:1: is HAIR" + rest);
}

TEST(CsvShapes, NamesAreWrittenSoThatTheyReadBackAsTheSame) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("names.csv");
  const Names names{"plain", "a,b",      "\"",    "say \"\"", " blanks ", "#1", "0",
                    "\t",    "semi;col", "é\xFF", "=1+1",     "x",        "\r", "'"};
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  for (std::size_t i = 0; i < names.size(); ++i) {
    points.emplace_back(static_cast<double>(i), 0.0, 0.0);
    points.emplace_back(static_cast<double>(i), 1.0, 0.0);
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  const FiberAssembly fibers(points, offsets, {0.5});
  for (const bool has_frames : {false, true}) {
    write_csv(path, {has_frames, {{0, fibers, FiberNames(names)}}});
    const FiberFile again = read_csv(path);
    EXPECT_EQ(names_in(again.frames.at(0)), names);
    EXPECT_EQ(again.frames[0].fibers.points(), points);
  }
  const std::string csv = test::read_file(path);
  EXPECT_NE(csv.find("\n0,\"a,b\",1,0,0,0.5\n"), std::string::npos);
  EXPECT_NE(csv.find("\n0,plain,0,0,0,0.5\n"), std::string::npos);
  EXPECT_THROW(write_csv(path, {false, {{0, fibers, FiberNames({"a", "b"})}}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace fiber
