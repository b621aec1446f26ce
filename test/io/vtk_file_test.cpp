// .vtk files, written byte by byte as VTK's documentation tells.
#include "src/io/fiber_formats.hpp"
#include "test/io/vtk_samples.hpp"

namespace fiber::test {
namespace {

const std::string vtk_begin = "# vtk DataFile Version 3.0\na title\n";

const std::string vtk_text = vtk_begin +
                             "ASCII\nDATASET POLYDATA\nPOINTS 5 float\n"
                             "0 0 0 1 -1 .5\n2 -2 1 3 -3 1.5 4 -4 2\n"
                             "LINES 2 7\n3 3 0 1\n2 1 4\n";

const std::string vtk_radius_text =
    "POINT_DATA 5\nSCALARS radius float 1\nLOOKUP_TABLE default\n.5 .25 8 1 2\n";

/// The file of vtk_text in bytes, of version 3 or 5, with the radius among other arrays.
std::string vtk_binary(bool has_offsets) {
  Bytes bytes(ByteOrder::BIG);
  bytes.letters(has_offsets ? "# vtk DataFile Version 5.1\nx\n" : vtk_begin)
      .letters("BINARY\nDATASET POLYDATA\nPOINTS 5 double\n")
      .doubles(vtk_coordinates())
      .letters(
          "\nMETADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n\n");
  if (has_offsets) {
    bytes.letters("LINES 3 5\nOFFSETS vtktypeint64\n").uint(0, 8).uint(3, 8).uint(5, 8);
    bytes.letters("\nCONNECTIVITY vtktypeint64\n");
    for (const std::uint64_t id : vtk_ids) {
      bytes.uint(id, 8);
    }
    bytes.letters("\nPOLYGONS 2 3\nOFFSETS vtktypeint64\n").uint(0, 8).uint(3, 8);
    bytes.letters("\nCONNECTIVITY vtktypeint64\n").uint(0, 8).uint(1, 8).uint(2, 8);
  } else {
    bytes.letters("LINES 2 7\n");
    for (const std::uint64_t number : {3, 3, 0, 1, 2, 1, 4}) {
      bytes.uint(number, 4);
    }
    bytes.letters("\nPOLYGONS 1 4\n").uint(3, 4).uint(0, 4).uint(1, 4).uint(2, 4);
  }
  bytes.letters("\nCELL_DATA 3\nSCALARS fa float\nLOOKUP_TABLE default\n").floats({1, 2, 3});
  bytes.letters("\nPOINT_DATA 5\nVECTORS u float\n").floats(std::vector<float>(15, 1.0F));
  bytes.letters("\nFIELD FieldData 2\nTubeRadius 1 5 double\n").doubles(vtk_radii);
  bytes.letters("\nmd 2 5 int\n");
  for (int i = 0; i < 10; ++i) {
    bytes.uint(7, 4);
  }
  bytes.letters("\nMETADATA\nINFORMATION 0\n\n");
  return bytes.text();
}

std::string vtk_refusal(const std::string& text) { return refusal(read_vtk, text); }

std::string with_text(std::string text, const std::string& old, const std::string& other) {
  return text.replace(text.find(old), old.size(), other);
}

TEST(ReadVtk, TextWithAndWithoutRadii) {
  const FiberFile file = read_text(read_vtk, vtk_text, 0.125);
  expect_same_fibers(file.frames.at(0).fibers, vtk_fibers(false, 0.125));
  EXPECT_EQ(file.notes, std::vector<std::string>{"1 points that are in no line are not read"});
  expect_same_fibers(read_text(read_vtk, vtk_text + vtk_radius_text, 0.125).frames.at(0).fibers,
                     vtk_fibers(true));
}

TEST(ReadVtk, BytesOfBothVersions) {
  for (const bool has_offsets : {false, true}) {
    const FiberFile file = read_text(read_vtk, vtk_binary(has_offsets));
    expect_same_fibers(file.frames.at(0).fibers, vtk_fibers(true));
    EXPECT_EQ(file.notes, (std::vector<std::string>{"1 cells that are no lines are not read",
                                                    "1 points that are in no line are not read",
                                                    "arrays not read: 'fa', 'u', 'md'"}));
  }
}

TEST(ReadVtk, EveryAttributeIsSteppedOver) {
  const std::string text =
      vtk_text +
      "POINT_DATA 5\nSCALARS a int 2\nLOOKUP_TABLE mine\n1 2 3 4 5 6 7 8 9 0\n"
      "LOOKUP_TABLE mine 2\n0 0 0 1 1 1 1 1\nCOLOR_SCALARS b 1\n0 0 0 0 1\n"
      "NORMALS c float\n1 0 0 1 0 0 1 0 0 1 0 0 1 0 0\nTEXTURE_COORDINATES d 1 float\n1 2 3 4 5\n"
      "TENSORS6 e float\n";
  std::string tensors;
  for (int i = 0; i < 30; ++i) {
    tensors += "0 ";
  }
  const std::string whole = text + tensors + "\nGLOBAL_IDS f vtkIdType\n1 2 3 4 5\n" +
                            "SCALARS Radius double\n.5 .25 8 1 2\n";
  const FiberFile file = read_text(read_vtk, whole);
  expect_same_fibers(file.frames.at(0).fibers, vtk_fibers(true));
  EXPECT_EQ(file.notes.back(), "arrays not read: 'a', 'b', 'c', 'd', 'e', 'f'");
}

TEST(ReadVtk, RefusesHeadersItCannotFollow) {
  EXPECT_EQ(vtk_refusal(""), ": is not a .vtk file, which begins with '# vtk DataFile Version '");
  EXPECT_EQ(vtk_refusal(vtk_begin + "HEX\n"),
            ": the encoding is 'HEX', expected ASCII or BINARY, before byte 38");
  EXPECT_EQ(vtk_refusal(vtk_begin + "ASCII\nDATASET UNSTRUCTURED_GRID\n"),
            ": has 'DATASET UNSTRUCTURED_GRID', expected DATASET POLYDATA, before byte 66");
  EXPECT_EQ(vtk_refusal(vtk_text + "CUBES 3\n"),
            ": has 'CUBES', which is no part of a file of poly data, before byte 141");
  EXPECT_EQ(vtk_refusal(vtk_text + "POINT_DATA 5\nSCALARS a string 1\n"),
            ": the type 'STRING' is not one of numbers, before byte 163");
}

TEST(ReadVtk, RefusesCountsAndIdsThatLie) {
  EXPECT_EQ(
      vtk_refusal(with_text(vtk_text, "POINTS 5", "POINTS 9999999999999")),
      ": the number of points is '9999999999999', expected a whole number up to 146, the size "
      "of the file, before byte 78");
  EXPECT_EQ(vtk_refusal(with_text(vtk_text, "POINTS 5", "POINTS 4")),
            ": has '4', which is no part of a file of poly data, before byte 107");
  EXPECT_EQ(vtk_refusal(with_text(vtk_text, "LINES 2 7", "LINES 3 7")),
            ": line 2 begins after the 7 numbers of LINES (byte 115), before byte 133");
  EXPECT_EQ(vtk_refusal(with_text(vtk_text, "LINES 2 7", "LINES 1 7")),
            ": 1 lines take 4 numbers of LINES (byte 115), there are 7, before byte 133");
  EXPECT_EQ(vtk_refusal(with_text(vtk_text, "2 1 4", "3 1 4")),
            ": line 1 has 3 points, more than the 7 numbers of LINES (byte 115), before byte 133");
  EXPECT_EQ(vtk_refusal(with_text(vtk_text, "2 1 4", "2 1 5")),
            ": line 1 has the point 5 (LINES (byte 115)), there are 5");
  EXPECT_EQ(vtk_refusal(with_text(vtk_text, "2 1 4", "2 1 -1")),
            ": line 1 has the point -1 (LINES (byte 115)), there are 5");
  EXPECT_EQ(vtk_refusal(with_text(vtk_text, "1 -1 .5", "1 nan .5")),
            ": y of point 1 of line 0 (POINTS (byte 66)) is nan, " +
                std::string(FiberAssembly::coordinate_rule));
  EXPECT_EQ(vtk_refusal(with_text(vtk_text, "1 -1 .5", "1 one .5")),
            ": has 'one', expected a number, before byte 84");
  EXPECT_EQ(vtk_refusal(vtk_text + with_text(vtk_radius_text, ".25", "-1")),
            ": the radius of point 1 of line 0 (radius (byte 190)) is -1, " +
                std::string(FiberAssembly::radius_rule));
  EXPECT_EQ(vtk_refusal(vtk_text + "POINT_DATA 4\nSCALARS radius float\n1 2 3 4\n"),
            ": the array 'radius' has 4 numbers for 5 points, before byte 175");
  EXPECT_EQ(vtk_refusal(vtk_text + "POINT_DATA 5\nFIELD f 1\nx 100 100 float\n"),
            ": the array 'x' has 100 times 100 numbers, the file 173 bytes, before byte 172");
  EXPECT_EQ(vtk_refusal(vtk_begin + "ASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\n"
                                    "VERTICES 1 2\n1 0\n"),
            ": has no lines, but 1 points and 1 cells of other kinds");
}

TEST(ReadVtk, RefusesOffsetsThatFall) {
  const std::string text = vtk_binary(true);
  const std::size_t offsets = text.find("vtktypeint64\n") + 13;
  const auto changed = [&](std::size_t index, std::uint64_t value) {
    return vtk_refusal(
        replaced(text, offsets + 8 * index, Bytes(ByteOrder::BIG).uint(value, 8).text()));
  };
  EXPECT_NE(changed(0, 1).find(": the first of the offsets is 1, expected 0"), std::string::npos);
  EXPECT_EQ(changed(1, 6).find(": line 0 ends at 6 of LINES (byte "), 0U);
  EXPECT_EQ(changed(2, 2).find(": line 1 ends at 2 of LINES (byte "), 0U);
  EXPECT_EQ(changed(2, 4).find(": the lines end at 4 of LINES (byte "), 0U);
  EXPECT_EQ(changed(1, 0xffff'ffff'ffff'ffffU).find(": line 0 ends at -1 of LINES (byte "), 0U);
}

TEST(ReadVtk, ABrokenFileIsReadOrRefusedAndNothingElse) {
  for (const bool has_offsets : {false, true}) {
    const std::string text = vtk_binary(has_offsets);
    for (std::size_t size = 0; size < text.size(); ++size) {
      refusal(read_vtk, text.substr(0, size));
    }
    expect_wrong_bits_read_or_refused(read_vtk, text);
    const std::size_t lines = text.find("\nLINES");
    for (std::size_t size = 0; size < lines; ++size) {
      EXPECT_NE(refusal(read_vtk, text.substr(0, size)), "accepted") << size;
    }
  }
}

}  // namespace
}  // namespace fiber::test
