#include "validation/geometry/known_motions.hpp"

#include <algorithm>
#include <ios>
#include <sstream>
#include <stdexcept>

#include "src/io/segment_file.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// @throws std::invalid_argument for a truth that is none
KnownMotion known_motion(const MovingSegmentPair& pair) {
  if (pair.truth != "0" && pair.truth != "1") {
    throw std::invalid_argument("the truth is " + quote(pair.truth) + ", it must be 0 or 1");
  }
  KnownMotion known{pair.set, pair.truth == "1", {}};
  std::copy_n(pair.a_before, 2, known.motion.a_before.begin());
  std::copy_n(pair.a_after, 2, known.motion.a_after.begin());
  std::copy_n(pair.b_before, 2, known.motion.b_before.begin());
  std::copy_n(pair.b_after, 2, known.motion.b_after.begin());
  return known;
}

}  // namespace

std::vector<KnownMotion> read_known_motions(const std::string& path) {
  std::vector<KnownMotion> motions;
  for (const MovingSegmentPair& pair : read_segment_motions(path)) {
    try {
      motions.push_back(known_motion(pair));
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(path + ", motion " + std::to_string(motions.size() + 1) + ": " +
                               error.what());
    }
  }
  return motions;
}

std::string coordinates_of(const HardMotion& motion) {
  std::ostringstream text;
  text << std::hexfloat;
  const char* separator = "";
  for (const Eigen::Vector3d* ends : {motion.a_before.data(), motion.b_before.data(),
                                      motion.a_after.data(), motion.b_after.data()}) {
    for (int end = 0; end < 2; ++end) {
      for (const double coordinate : {ends[end].x(), ends[end].y(), ends[end].z()}) {
        text << separator << coordinate;
        separator = ",";
      }
    }
  }
  return text.str();
}

}  // namespace fiber
