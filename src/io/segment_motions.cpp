#include "src/io/segment_motions.hpp"

#include "src/io/coordinate_rows.hpp"
#include "src/io/input_file.hpp"

namespace fiber {
namespace {

RowFormat motion_format() {
  RowFormat format;
  format.names = {"set", "truth"};
  format.coordinates = {"a0.x at t = 0", "a0.y at t = 0", "a0.z at t = 0", "a1.x at t = 0",
                        "a1.y at t = 0", "a1.z at t = 0", "b0.x at t = 0", "b0.y at t = 0",
                        "b0.z at t = 0", "b1.x at t = 0", "b1.y at t = 0", "b1.z at t = 0",
                        "a0.x at t = 1", "a0.y at t = 1", "a0.z at t = 1", "a1.x at t = 1",
                        "a1.y at t = 1", "a1.z at t = 1", "b0.x at t = 1", "b0.y at t = 1",
                        "b0.z at t = 1", "b1.x at t = 1", "b1.y at t = 1", "b1.z at t = 1"};
  format.all_coordinates = "the 24 coordinates of a0, a1, b0 and b1 at t = 0, then at t = 1";
  return format;
}

}  // namespace

std::vector<MovingSegmentPair> read_segment_motions(const std::string& path) {
  std::ifstream stream = open_to_read(path);
  return read_segment_motions(stream, path);
}

std::vector<MovingSegmentPair> read_segment_motions(std::istream& stream, const std::string& name) {
  CoordinateRows rows(stream, name, motion_format());
  std::vector<MovingSegmentPair> motions;
  while (rows.next()) {
    motions.push_back({std::string(rows.name(0)),
                       std::string(rows.name(1)),
                       {rows.point(0), rows.point(1)},
                       {rows.point(2), rows.point(3)},
                       {rows.point(4), rows.point(5)},
                       {rows.point(6), rows.point(7)}});
  }
  return motions;
}

}  // namespace fiber
