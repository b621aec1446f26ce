// .npz files, put together as the documentation of zip archives and of numpy tells.
#include <zlib.h>

#include <limits>

#include "src/io/fiber_formats.hpp"
#include "test/io/format.hpp"

namespace fiber::test {
namespace {

struct NpzMember {
  std::string name;
  std::string content;
  bool is_deflated = false;
};

std::string npy(const std::string& descr, const std::string& shape, const std::string& numbers,
                int version = 1, bool is_fortran = false) {
  const std::string header = "{'descr': '" + descr +
                             "', 'fortran_order': " + (is_fortran ? "True" : "False") +
                             ", 'shape': " + shape + ", }\n";
  return Bytes()
      .letters("\x93NUMPY")
      .uint(static_cast<std::uint64_t>(version), 2)
      .uint(header.size(), version == 1 ? 2 : 4)
      .letters(header)
      .letters(numbers)
      .text();
}

std::string raw_deflated(std::string bytes) {
  std::string out(bytes.size() + 100, '\0');
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// @param is_long with sizes and places in the fields of zip64, as numpy writes large ones
std::string zip(const std::vector<NpzMember>& members, bool is_long = false) {
  Bytes bytes;
  Bytes directory;
  for (const NpzMember& member : members) {
    const std::string packed = member.is_deflated ? raw_deflated(member.content) : member.content;
    const auto checksum = crc32(0, reinterpret_cast<const Bytef*>(member.content.data()),
                                static_cast<uInt>(member.content.size()));
    const std::uint64_t place = bytes.text().size();
    const auto add = [&](Bytes& to, bool is_entry) {
      const bool moves = is_long && is_entry;
      to.uint(45, 2).uint(0, 2).uint(member.is_deflated ? 8 : 0, 2).uint(0, 4).uint(checksum, 4);
      to.uint(moves ? 0xffff'ffffU : packed.size(), 4);
      to.uint(moves ? 0xffff'ffffU : member.content.size(), 4);
      to.uint(member.name.size(), 2).uint(moves ? 28 : 0, 2);
    };
    bytes.letters("PK\x03\x04");
    add(bytes, false);
    bytes.letters(member.name).letters(packed);
    directory.letters("PK\x01\x02").uint(45, 2);
    add(directory, true);
    directory.uint(0, 2).uint(0, 2).uint(0, 2).uint(0, 4);
    directory.uint(is_long ? 0xffff'ffffU : place, 4).letters(member.name);
    if (is_long) {
      directory.uint(1, 2).uint(24, 2).uint(member.content.size(), 8).uint(packed.size(), 8);
      directory.uint(place, 8);
    }
  }
  const std::uint64_t begin = bytes.text().size();
  bytes.letters(directory.text());
  if (is_long) {
    const std::uint64_t end = bytes.text().size();
    bytes.letters("PK\x06\x06").uint(44, 8).uint(45, 2).uint(45, 2).uint(0, 4).uint(0, 4);
    bytes.uint(members.size(), 8).uint(members.size(), 8).uint(directory.text().size(), 8);
    bytes.uint(begin, 8).letters("PK\x06\x07").uint(0, 4).uint(end, 8).uint(1, 4);
  }
  bytes.letters("PK\x05\x06").uint(0, 4);
  bytes.uint(is_long ? 0xffffU : members.size(), 2).uint(is_long ? 0xffffU : members.size(), 2);
  bytes.uint(directory.text().size(), 4).uint(is_long ? 0xffff'ffffU : begin, 4).uint(0, 2);
  return bytes.text();
}

const std::vector<double> npz_numbers{0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 1, 1};

NpzMember npz_points(const std::string& shape = "(5, 3)") {
  return {"points.npy", npy("<f8", shape, Bytes().doubles(npz_numbers).text())};
}

NpzMember npz_offsets(const std::vector<std::uint64_t>& offsets = {0, 2, 5}) {
  Bytes bytes;
  for (const std::uint64_t offset : offsets) {
    bytes.uint(offset, 8);
  }
  return {"offsets.npy", npy("<i8", "(" + std::to_string(offsets.size()) + ",)", bytes.text())};
}

NpzMember npz_radii(const std::vector<float>& radii) {
  return {"radii.npy",
          npy("<f4", radii.size() == 1 ? "()" : "(" + std::to_string(radii.size()) + ",)",
              Bytes().floats(radii).text(), 2)};
}

FiberAssembly npz_fibers(const std::vector<double>& radii) {
  return {{{0, 0, 0}, {1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {1, 1, 1}}, {0, 2, 5}, radii};
}

std::string npz_refusal(const std::vector<NpzMember>& members) {
  return refusal(read_npz, zip(members));
}

TEST(ReadNpz, StoredDeflatedAndLong) {
  for (const bool is_long : {false, true}) {
    for (const bool is_deflated : {false, true}) {
      std::vector<NpzMember> members{npz_points(), npz_radii({0.5F, 0.25F}), npz_offsets()};
      for (NpzMember& member : members) {
        member.is_deflated = is_deflated;
      }
      const FiberFile file = read_text(read_npz, zip(members, is_long));
      EXPECT_TRUE(file.notes.empty());
      expect_same_fibers(file.frames.at(0).fibers, npz_fibers({0.5, 0.25}));
    }
  }
}

TEST(ReadNpz, RadiiAreOneOrOnePerFibreOrOnePerPoint) {
  const auto radii = [](const std::vector<NpzMember>& more) {
    std::vector<NpzMember> members{npz_points(), npz_offsets()};
    members.insert(members.end(), more.begin(), more.end());
    return read_text(read_npz, zip(members), 0.125).frames.at(0).fibers.radii();
  };
  EXPECT_EQ(radii({}), std::vector<double>{0.125});
  EXPECT_EQ(radii({npz_radii({0.5F})}), std::vector<double>{0.5});
  EXPECT_EQ(radii({npz_radii({1, 2, 3, 4, 5})}), (std::vector<double>{1, 2, 3, 4, 5}));
}

TEST(ReadNpz, EveryTypeAndOrder) {
  std::string columns;
  Bytes big(ByteOrder::BIG);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t row = 0; row < 5; ++row) {
      columns += static_cast<char>(npz_numbers[3 * row + axis]);
      big.floats({static_cast<float>(npz_numbers[3 * row + axis])});
    }
  }
  const std::string offsets = Bytes(ByteOrder::BIG).uint(0, 2).uint(2, 2).uint(5, 2).text();
  for (const NpzMember& points :
       {NpzMember{"points.npy", npy("|u1", "(5, 3)", columns, 1, true)},
        NpzMember{"points.npy", npy(">f4", "(5, 3)", big.text(), 3, true)}}) {
    const FiberFile file =
        read_text(read_npz, zip({points, {"offsets.npy", npy(">u2", "(3,)", offsets)}}));
    expect_same_fibers(file.frames.at(0).fibers, npz_fibers({0.0}));
  }
}

TEST(ReadNpz, ReadsWhatIsWritten) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int trial = 0; trial < 200; ++trial) {
    const FiberAssembly fibers = random_graph(random);
    std::stringstream stream;
    write_npz(stream, {false, {{0, fibers}}});
    const FiberFile again = read_npz(stream, "a");
    EXPECT_TRUE(again.notes.empty());
    expect_same_fibers(again.frames.at(0).fibers, fibers);
  }
}

TEST(ReadNpz, TellsWhatElseThereIs) {
  const FiberFile file = read_text(
      read_npz, zip({npz_points(), npz_offsets(), {"names.npy", "any"}, {"read.me", "thing"}}));
  EXPECT_EQ(file.notes, std::vector<std::string>{"arrays not read: 'names', 'read.me'"});
}

TEST(ReadNpz, RefusesArraysThatAreNone) {
  EXPECT_EQ(npz_refusal({npz_offsets()}), ": has no array points");
  EXPECT_EQ(npz_refusal({npz_points()}), ": has no array offsets");
  EXPECT_EQ(npz_refusal({npz_points("(3, 5)"), npz_offsets()}),
            ": the array points has the shape (3, 5), expected three columns");
  EXPECT_EQ(npz_refusal({npz_points("(6, 3)"), npz_offsets()}),
            ": the array points (byte 40) cannot be read: it has 120 bytes of numbers, 144 are "
            "told");
  EXPECT_EQ(npz_refusal({npz_points("(4611686018427387904, 3)"), npz_offsets()}),
            ": the array points (byte 40) cannot be read: the shape is '(4611686018427387904, 3'), "
            "in 120 bytes");
  EXPECT_EQ(npz_refusal({{"points.npy", "text"}, npz_offsets()}),
            ": the array points (byte 40) cannot be read: it is no array of numpy");
  EXPECT_EQ(npz_refusal({{"points.npy", npy("<c16", "(5, 3)", "")}, npz_offsets()}),
            ": the array points (byte 40) cannot be read: the type (descr) is ''<c16'', expected "
            "whole numbers or those of 4 or 8 bytes");
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets({0, 3, 2, 5})}),
            ": the array offsets has 2 as number 2, expected 3 to 5");
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets({0, 6})}),
            ": the array offsets has 6 as number 1, expected 0 to 5");
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets({0, 2})}),
            ": the array offsets ends with 2, expected 5, the number of points");
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets({1, 5})}),
            ": the array offsets begins with 1, expected 0");
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets({})}),
            ": the array offsets is empty, expected 0 as its first");
  EXPECT_EQ(
      npz_refusal({npz_points(), {"offsets.npy", npz_points("(15,)").content}}),
      ": the array offsets has the shape (15) and no whole numbers, expected whole numbers in "
      "one row");
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets(), npz_radii({1, 2, 3})}),
            ": the array radii has the shape (3), expected 1, one per fibre (2) or one per point "
            "(5)");
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets(), npz_radii({1, -2})}),
            ": number 1 of radii is -2, " + std::string(FiberAssembly::radius_rule));
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets(), {"closed.npy", npy("|b1", "(2,)", "\1\2")}}),
            ": the array closed has 2 as number 1, expected 0 or 1");
  EXPECT_EQ(npz_refusal({npz_points(), npz_offsets(), {"joints.npy", npy("|i1", "(2,)", "\1\2")}}),
            ": the array joints has the shape (2), expected 5 numbers");
  EXPECT_EQ(
      npz_refusal({npz_points(), npz_offsets(), {"joints.npy", npy("|i1", "(5,)", "\1\1\2\3\4")}})
          .find(": joint 1"),
      0U);
}

TEST(ReadNpz, RefusesArchivesThatAreDamaged) {
  const std::vector<NpzMember> members{npz_points(), npz_offsets()};
  const std::string text = zip(members);
  EXPECT_EQ(refusal(read_npz, ""), ": is no zip archive, which begins with the letters PK");
  expect_truncations_refused(read_npz, text);
  EXPECT_EQ(refusal(read_npz, text.substr(0, text.size() - 1)),
            ": is a zip archive without its end, of " + std::to_string(text.size() - 1) + " bytes");
  std::string damaged = text;
  damaged[text.find(members[0].content) + 100] ^= 1;
  EXPECT_EQ(refusal(read_npz, damaged),
            ": the member 'points.npy': its checksum is another one than is told (byte 40)");
  EXPECT_EQ(refusal(read_npz, replaced(text, text.find("PK\x01\x02") + 24,
                                       Bytes().uint(0xf000'0000U, 4).text())),
            ": the member 'points.npy': it has " + std::to_string(members[0].content.size()) +
                " bytes, 4026531840 are told (byte 40)");
  EXPECT_EQ(refusal(read_npz, replaced(text, text.size() - 12, Bytes().uint(0xffff, 2).text()))
                .find(": the archive tells of 65535 members (byte "),
            0U);
  std::vector<NpzMember> deflated = members;
  deflated[0].is_deflated = true;
  const std::string packed = zip(deflated);
  EXPECT_EQ(refusal(read_npz, replaced(packed, packed.find("PK\x01\x02") + 24,
                                       Bytes().uint(0xf000'0000U, 4).text()))
                .find(": the member 'points.npy': "),
            0U);
  for (const bool is_long : {false, true}) {
    expect_wrong_bits_read_or_refused(read_npz, zip(members, is_long));
    expect_wrong_bits_read_or_refused(read_npz, zip(deflated, is_long));
  }
}

}  // namespace
}  // namespace fiber::test
