#include "continuous/known_motions.hpp"

#include <cstdlib>
#include <fstream>
#include <ios>
#include <sstream>
#include <stdexcept>

namespace fiber::bench {
namespace {

KnownMotion known_motion(const std::string& line) {
  std::istringstream fields(line);
  const auto next = [&] {
    std::string field;
    if (!std::getline(fields, field, ',')) {
      throw std::invalid_argument("too few fields, it must be set, truth and 24 coordinates");
    }
    return field;
  };
  KnownMotion known;
  known.set = next();
  const std::string truth = next();
  if (truth != "0" && truth != "1") {
    throw std::invalid_argument("the truth is '" + truth + "', it must be 0 or 1");
  }
  known.contact = truth == "1";
  HardMotion& motion = known.motion;
  for (Eigen::Vector3d* ends : {motion.a_before.data(), motion.b_before.data(),
                                motion.a_after.data(), motion.b_after.data()}) {
    for (int end = 0; end < 2; ++end) {
      for (double& coordinate : ends[end]) {
        const std::string field = next();
        char* stop = nullptr;
        coordinate = std::strtod(field.c_str(), &stop);
        if (field.empty() || *stop != '\0') {
          throw std::invalid_argument("'" + field + "' is no number");
        }
      }
    }
  }
  if (std::string rest; std::getline(fields, rest)) {
    throw std::invalid_argument("too many fields, it must be set, truth and 24 coordinates");
  }
  return known;
}

}  // namespace

std::vector<KnownMotion> read_known_motions(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    throw std::runtime_error("cannot read '" + path + "'");
  }
  std::vector<KnownMotion> motions;
  for (std::string line; std::getline(file, line);) {
    try {
      motions.push_back(known_motion(line));
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(path + ":" + std::to_string(motions.size() + 1) + ": " +
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
      for (const double coordinate : ends[end]) {
        text << separator << coordinate;
        separator = ",";
      }
    }
  }
  return text.str();
}

}  // namespace fiber::bench
