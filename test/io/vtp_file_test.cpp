// .vtp files, put together as VTK's documentation tells, in every encoding.
#include <zlib.h>

#include <algorithm>

#include "src/io/fiber_formats.hpp"
#include "test/io/vtk_samples.hpp"

namespace fiber::test {
namespace {

std::string base64(const std::string& bytes) {
  constexpr const char* letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t byte = 0; byte < 3; ++byte) {
      bits =
          bits << 8U | (i + byte < bytes.size() ? static_cast<unsigned char>(bytes[i + byte]) : 0U);
    }
    for (std::size_t letter = 0; letter < 4; ++letter) {
      text += i + letter > bytes.size() ? '=' : letters[bits >> (18 - 6 * letter) & 63U];
    }
  }
  return text;
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  return out.substr(0, size);
}

/// How a file is written.
struct VtpForm {
  ByteOrder order = ByteOrder::LITTLE;
  int count_size = 4;  // [byte]
  bool is_compressed = false;
  std::string format = "binary";  // ascii, binary, raw or base64, the last two of what is appended
  std::size_t block_size = 24;    // [byte]
};

/// Writes the arrays of a file.
class VtpFile {
 public:
  explicit VtpFile(const VtpForm& form) : form_(form) {}

  std::string real(const std::string& attributes, const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) {
      text += std::to_string(number) + "\n";
    }
    return array("type=\"Float64\" " + attributes, text,
                 Bytes(form_.order).doubles(numbers).text());
  }

  std::string whole(const std::string& attributes, const std::vector<std::uint64_t>& numbers) {
    std::string text;
    Bytes bytes(form_.order);
    for (const std::uint64_t number : numbers) {
      text += std::to_string(number) + " ";
      bytes.uint(number, 4);
    }
    return array("type=\"Int32\" " + attributes, text, bytes.text());
  }

  /// A file with these pieces.
  std::string file(const std::string& pieces) const {
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\"";
    text += form_.order == ByteOrder::BIG ? " byte_order=\"BigEndian\""
                                          : " byte_order=\"LittleEndian\"";
    text += form_.count_size == 8 ? " header_type=\"UInt64\"" : "";
    text += form_.is_compressed ? " compressor=\"vtkZLibDataCompressor\"" : "";
    text += ">\n<PolyData>\n" + pieces + "</PolyData>\n";
    if (form_.format == "raw" || form_.format == "base64") {
      text += "<AppendedData encoding=\"" + form_.format + "\">\n  _" + appended_ +
              "\n</AppendedData>\n";
    }
    return text + "</VTKFile>\n";
  }

  std::string piece(const std::string& cells = "") {
    const std::string radii = real("Name=\"Radius\"", vtk_radii);
    const std::string points = real("Name=\"p\" NumberOfComponents=\"3\"", vtk_coordinates());
    const std::string ids = whole("Name=\"connectivity\"", vtk_ids);
    return "<Piece NumberOfPoints=\"5\" NumberOfLines=\"2\"" + cells + ">\n<PointData>" + radii +
           "</PointData>\n<Points>" + points + "</Points>\n<Lines>" + ids +
           whole("Name=\"offsets\"", {3, 5}) + "</Lines>\n</Piece>\n";
  }

 private:
  std::string array(const std::string& attributes, const std::string& text,
                    const std::string& bytes) {
    const std::string begin = "<DataArray " + attributes + " format=\"";
    if (form_.format == "ascii") {
      return begin + "ascii\">\n" + text + "</DataArray>\n";
    }
    if (form_.format == "binary") {
      return begin + "binary\">\n  " + encoded(bytes, true) + "\n</DataArray>\n";
    }
    const std::size_t offset = appended_.size();
    appended_ += encoded(bytes, form_.format == "base64");
    return begin + "appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
  }

  std::string encoded(const std::string& bytes, bool is_base64) const {
    const auto text = [&](const std::string& run) { return is_base64 ? base64(run) : run; };
    Bytes header(form_.order);
    if (!form_.is_compressed) {
      return text(header.uint(bytes.size(), form_.count_size).text() + bytes);
    }
    const std::size_t block = form_.block_size;
    header.uint((bytes.size() + block - 1) / block, form_.count_size)
        .uint(block, form_.count_size)
        .uint(bytes.size() % block, form_.count_size);
    std::string blocks;
    for (std::size_t i = 0; i < bytes.size(); i += block) {
      const std::string one = deflated(bytes.substr(i, block));
      header.uint(one.size(), form_.count_size);
      blocks += one;
    }
    return text(header.text()) + text(blocks);
  }

  const VtpForm form_;
  std::string appended_;
};

std::string vtp_sample(const VtpForm& form, const std::string& cells = "") {
  VtpFile file(form);
  const std::string piece = file.piece(cells);
  return file.file(piece);
}

const VtpForm vtp_ascii{ByteOrder::LITTLE, 4, false, "ascii"};

std::string vtp_refusal(const std::string& text) { return refusal(read_vtp, text); }

std::string with(std::string text, const std::string& old, const std::string& other) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return at == std::string::npos ? text : text.replace(at, old.size(), other);
}

TEST(ReadVtp, EveryEncoding) {
  for (const ByteOrder order : {ByteOrder::LITTLE, ByteOrder::BIG}) {
    for (const int count_size : {4, 8}) {
      for (const bool is_compressed : {false, true}) {
        for (const std::string format : {"ascii", "binary", "raw", "base64"}) {
          for (const std::size_t block_size : {24U, 20U, 8U, 1000U}) {
            SCOPED_TRACE(testing::Message() << static_cast<int>(order) << count_size
                                            << is_compressed << format << block_size);
            const FiberFile file = read_text(
                read_vtp, vtp_sample({order, count_size, is_compressed, format, block_size}));
            expect_same_fibers(file.frames.at(0).fibers, vtk_fibers(true));
            EXPECT_EQ(file.notes,
                      std::vector<std::string>{"1 points that are in no line are not read"});
          }
        }
      }
    }
  }
}

TEST(ReadVtp, ReadsWhatIsWritten) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int trial = 0; trial < 200; ++trial) {
    const FiberAssembly fibers = random_graph(random);
    std::stringstream stream;
    write_vtp(stream, fibers);
    const FiberFile again = read_vtp(stream, "a");
    EXPECT_TRUE(again.notes.empty());
    if (fibers.fiber_count() > 0) {
      expect_same_fibers(again.frames.at(0).fibers, fibers);
    }
  }
}

TEST(ReadVtp, ReadsAllPiecesAndTellsWhatElseThereIs) {
  VtpFile file(vtp_ascii);
  const std::string piece = file.piece(" NumberOfVerts=\"2\" NumberOfPolys=\"1\"");
  const std::string others = "<CellData>" + file.whole("Name=\"id\"", {1, 2}) + "</CellData>\n";
  const std::string text = file.file(with(piece, "</Piece>", others + "</Piece>") + file.piece());
  const FiberFile read = read_text(read_vtp, text);
  EXPECT_EQ(read.frames.at(0).fibers.offsets(), (std::vector<std::uint32_t>{0, 3, 5, 8, 10}));
  EXPECT_EQ(read.notes, (std::vector<std::string>{"3 cells that are no lines are not read",
                                                  "2 points that are in no line are not read",
                                                  "arrays not read: 'id'"}));
  // Information that VTK writes into arrays, and counts that are coded apart from what they count.
  const std::string informed =
      with(vtp_sample(vtp_ascii), "</DataArray>",
           "<InformationKey name=\"L2_NORM_RANGE\" location=\"vtkDataArray\"/></DataArray>");
  expect_same_fibers(read_text(read_vtp, informed).frames.at(0).fibers, vtk_fibers(true));
  const std::string joined = base64(Bytes().uint(8, 4).uint(3, 4).uint(5, 4).text());
  const std::string apart =
      base64(Bytes().uint(8, 4).text()) + "\n" + base64(Bytes().uint(3, 4).uint(5, 4).text());
  expect_same_fibers(read_text(read_vtp, with(vtp_sample({}), joined, apart)).frames.at(0).fibers,
                     vtk_fibers(true));
}

TEST(ReadVtp, RingsAreClosedAndTheirPointsCount) {
  const auto lines = [](const std::string& ids, const std::string& offsets) {
    return "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"5\"><PointData><DataArray "
           "Name=\"joint\" type=\"Int8\" format=\"ascii\">-1 7 -1 -1 7</DataArray></PointData>"
           "<Points><DataArray type=\"Int8\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 "
           "1 1 0 2 2 2 1 0 0</DataArray></Points><Lines><DataArray type=\"Int8\" "
           "Name=\"connectivity\" format=\"ascii\">" +
           ids + "</DataArray><DataArray type=\"Int8\" Name=\"offsets\" format=\"ascii\">" +
           offsets + "</DataArray></Lines></Piece></PolyData></VTKFile>";
  };
  // A ring, and a line from it that begins at a copy of its point 1 and ends at its point 0.
  const std::string ring =
      with(lines("0 1 2 0 4 3 0", "4 7"), "<Piece ", "<Piece NumberOfLines=\"2\" ");
  FiberTopology topology;
  topology.closed = {1, 0};
  topology.joints = {8, 7, -1, 7, -1, 8};
  expect_same_fibers(read_text(read_vtp, ring).frames.at(0).fibers,
                     {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}, {2, 2, 2}, {0, 0, 0}},
                      {0, 3, 6},
                      {0},
                      topology});
  EXPECT_EQ(vtp_refusal(with(lines("0 1 0", "3"), "<Piece ", "<Piece NumberOfLines=\"1\" ")),
            ": line 0 is closed and has 2 points, a closed fibre needs at least 3");
  EXPECT_EQ(vtp_refusal(with(ring, "7 -1 -1 7", "7 7 -1 -1")).find(": joint 7"), 0U)
      << vtp_refusal(with(ring, "7 -1 -1 7", "7 7 -1 -1"));
}

TEST(ReadVtp, RefusesHeadersItCannotFollow) {
  const std::string text = vtp_sample(vtp_ascii);
  EXPECT_EQ(vtp_refusal(""), ":1: is no XML: XML_ERROR_EMPTY_DOCUMENT");
  EXPECT_EQ(vtp_refusal("<a/>"), ": is not a .vtp file, whose first element is VTKFile");
  EXPECT_EQ(vtp_refusal(with(text, "\"PolyData\"", "\"ImageData\"")),
            ":2: type is 'ImageData', expected PolyData");
  EXPECT_EQ(vtp_refusal(with(text, "LittleEndian", "Middle")),
            ":2: byte_order is 'Middle', expected LittleEndian or BigEndian");
  EXPECT_EQ(vtp_refusal(with(text, "version=\"1.0\" b", "compressor=\"vtkLZ4DataCompressor\" b")),
            ":2: compressor is 'vtkLZ4DataCompressor', expected vtkZLibDataCompressor");
  EXPECT_EQ(vtp_refusal(with(text, "NumberOfPoints=\"5\"", "NumberOfPoints=\"-5\"")),
            ":4: NumberOfPoints is '-5', expected a whole number");
  EXPECT_EQ(vtp_refusal(with(text, "NumberOfPoints=\"5\"", "NumberOfPoints=\"6\"")),
            ":5: Radius has 5 numbers, expected 6");
  EXPECT_EQ(vtp_refusal(with(text, "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"")),
            ":13: NumberOfComponents of Points is '2', expected 3");
  EXPECT_EQ(vtp_refusal(with(text, "NumberOfLines=\"2\"", "NumberOfLines=\"3\"")),
            ":33: offsets has 2 numbers, expected 3");
  EXPECT_EQ(vtp_refusal(with(text, "Float64", "Float16")),
            ":5: type is 'Float16', expected Int8 to UInt64, Float32 or Float64");
  EXPECT_EQ(vtp_refusal(with(text, "\"connectivity\"", "\"ids\"")),
            ": line 0 ends at 3 of offsets, line 33, expected 0 to 0");
  EXPECT_EQ(vtp_refusal(with(text, "format=\"ascii\"", "format=\"hex\"")),
            ":5: format is 'hex', expected ascii, binary or appended");
  EXPECT_EQ(vtp_refusal(with(text, "8.000000", "eight")), ":5: has 'eight', expected a number");
  EXPECT_EQ(vtp_refusal(with(text, "8.000000", "-8")), "accepted") << "of a point in no line";
  EXPECT_EQ(vtp_refusal(with(text, "0.250000", "-1")),
            ": the radius of point 1 of line 0 (Radius, line 5) is -1, " +
                std::string(FiberAssembly::radius_rule));
  EXPECT_EQ(vtp_refusal(with(text, "-4.000000", "nan")),
            ": y of point 4 of line 1 (Points, line 13) is nan, " +
                std::string(FiberAssembly::coordinate_rule));
  EXPECT_EQ(vtp_refusal(with(text, "3 5 ", "3 2 ")),
            ": line 1 ends at 2 of offsets, line 33, expected 3 to 5");
  const std::string twice = with(text, "</PolyData>", VtpFile(vtp_ascii).piece() + "</PolyData>");
  EXPECT_EQ(vtp_refusal(with(twice, "\"Radius\"", "\"r\"")),
            ": some pieces have radii, and others have none");
  EXPECT_EQ(vtp_refusal("<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\">"
                        "<Points><DataArray type=\"Int8\" NumberOfComponents=\"3\" "
                        "format=\"ascii\">1 2 3</DataArray></Points></Piece></PolyData></VTKFile>"),
            ": has no lines, but 1 points and 0 cells of other kinds");
}

TEST(ReadVtp, RefusesCountsAndBlocksThatLie) {
  VtpForm form{ByteOrder::LITTLE, 8, true, "raw", 24};
  const std::string text = vtp_sample(form);
  const std::size_t data = text.find("  _") + 3;
  const auto changed = [&](std::size_t index, std::uint64_t value) {
    return vtp_refusal(replaced(text, data + 8 * index, Bytes().uint(value, 8).text()));
  };
  const std::uint64_t huge = std::uint64_t{1} << 62U;
  EXPECT_EQ(changed(0, huge).find(":5: the data tells of 4611686018427387904 blocks in "), 0U);
  EXPECT_EQ(changed(0, 3).find(":5: the data "), 0U);
  EXPECT_EQ(changed(1, 23),
            ":5: the data block 0 of 2: more than 23 bytes come out, as many as are told");
  EXPECT_EQ(changed(1, huge),
            ":5: the data block 0 of 2: 24 bytes come out, 4611686018427387904 are told");
  EXPECT_EQ(changed(3, huge).find(":5: the data ends after "), 0U);
  std::string damaged = text;
  damaged[data + 8 * 5 + 3] = static_cast<char>(damaged[data + 8 * 5 + 3] ^ 0x55);
  EXPECT_EQ(
      vtp_refusal(damaged).find(":5: the data block 0 of 2: the compressed bytes are damaged"), 0U);
  form = {};
  EXPECT_EQ(
      vtp_refusal(with(vtp_sample(form), base64(Bytes().uint(8, 4).uint(3, 4).uint(5, 4).text()),
                       base64(Bytes().uint(0xffff'ffffU, 4).uint(3, 4).text())))
          .find(": the data ends after "),
      3U);
  form.format = "raw";
  EXPECT_EQ(vtp_refusal(with(vtp_sample(form), "offset=\"0\"", "offset=\"100000\""))
                .find(":5: offset is '100000', expected 0 to "),
            0U);
  for (const bool is_compressed : {false, true}) {
    for (const std::string format : {"binary", "raw", "base64"}) {
      const std::string sample = vtp_sample({ByteOrder::BIG, 4, is_compressed, format, 24});
      expect_truncations_refused(
          read_vtp,
          sample.substr(0, sample.find(format == "binary" ? "\n</VTKFile>" : "\n</AppendedData>")));
      expect_wrong_bits_read_or_refused(read_vtp, sample);
    }
  }
}

}  // namespace
}  // namespace fiber::test
