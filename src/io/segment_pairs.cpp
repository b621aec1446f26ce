#include "src/io/segment_pairs.hpp"

#include "src/io/coordinate_rows.hpp"
#include "src/io/input_file.hpp"

namespace fiber {
namespace {

RowFormat pair_format() {
  RowFormat format;
  format.names = {"the name"};
  format.may_lack_names = true;
  format.coordinates = {"p0.x", "p0.y", "p0.z", "p1.x", "p1.y", "p1.z",
                        "q0.x", "q0.y", "q0.z", "q1.x", "q1.y", "q1.z"};
  format.ignores_more = true;
  format.all_coordinates = "the 12 coordinates of p0, p1, q0 and q1";
  return format;
}

}  // namespace

std::vector<SegmentPair> read_segment_pairs(const std::string& path) {
  std::ifstream stream = open_to_read(path);
  return read_segment_pairs(stream, path);
}

std::vector<SegmentPair> read_segment_pairs(std::istream& stream, const std::string& name) {
  CoordinateRows rows(stream, name, pair_format());
  std::vector<SegmentPair> pairs;
  while (rows.next()) {
    pairs.push_back({rows.point(0), rows.point(1), rows.point(2), rows.point(3)});
  }
  return pairs;
}

}  // namespace fiber
