#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/bytes.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// A file put together by hand, apart from the writer.
class Bytes {
 public:
  explicit Bytes(ByteOrder order = ByteOrder::LITTLE) : order_(order) {}

  Bytes& uint(std::uint64_t value, int size) {
    std::string bytes;
    for (int byte = 0; byte < size; ++byte) {
      bytes += static_cast<char>((value >> (8 * byte)) & 0xffU);
    }
    return put(bytes);
  }
  Bytes& floats(const std::vector<float>& values) {
    for (const float value : values) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof(bits));
      uint(bits, 4);
    }
    return *this;
  }
  Bytes& doubles(const std::vector<double>& values) {
    for (const double value : values) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof(bits));
      uint(bits, 8);
    }
    return *this;
  }
  Bytes& letters(const std::string& letters) {
    text_ += letters;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  Bytes& put(std::string bytes) {
    if (order_ == ByteOrder::BIG) {
      std::reverse(bytes.begin(), bytes.end());
    }
    text_ += bytes;
    return *this;
  }

  ByteOrder order_;
  std::string text_;
};

/// A reader of a format.
using Read = FiberFile(std::istream& stream, const std::string& name, const ReadOptions& options);

inline FiberFile read_text(Read& read, const std::string& text, const ReadOptions& options = {}) {
  std::istringstream stream(text);
  return read(stream, "a", options);
}

/// Returns the error that a file is refused with, without its name; "accepted" if it is not
/// refused. Any other exception than a FileError fails the test.
inline std::string refusal(Read& read, const std::string& text, const ReadOptions& options = {}) {
  try {
    read_text(read, text, options);
  } catch (const FileError& error) {
    return std::string(error.what()).substr(1);
  }
  return "accepted";
}

inline std::string replaced(std::string text, std::size_t at, const std::string& bytes) {
  return text.replace(at, bytes.size(), bytes);
}

/// A file that ends early is an error, wherever it ends.
inline void expect_truncations_refused(Read& read, const std::string& text, std::size_t begin = 0) {
  for (std::size_t size = begin; size < text.size(); ++size) {
    EXPECT_NE(refusal(read, text.substr(0, size)), "accepted") << "of " << size << " bytes";
  }
}

/// A file with a wrong bit anywhere is read or refused, and nothing else.
inline void expect_wrong_bits_read_or_refused(Read& read, const std::string& text) {
  for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
    std::string changed = text;
    changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ (1 << (bit % 8)));
    SCOPED_TRACE(testing::Message() << "bit " << bit);
    refusal(read, changed);
  }
}

/// Up to eight fibres of up to nine points, with a radius for all, for each, or for each point.
inline FiberAssembly random_fibers(Random& random) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  for (int fiber = random.integer(0, 8); fiber > 0; --fiber) {
    for (int point = random.integer(2, 9); point > 0; --point) {
      points.push_back(random.in_cube(random.chance(0.5) ? 1.0 : 1e-6));
    }
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  const std::size_t counts[] = {1, offsets.size() - 1, points.size()};
  std::vector<double> radii(std::max<std::size_t>(1, counts[random.integer(0, 2)]));
  for (double& radius : radii) {
    radius = random.uniform(0.0, 1e-3);
  }
  return {points, offsets, radii};
}

/// Random fibres of which some are closed, and some points are joined.
inline FiberAssembly random_graph(Random& random) {
  const FiberAssembly chains = random_fibers(random);
  std::vector<Eigen::Vector3d> points = chains.points();
  FiberTopology topology;
  for (std::size_t fiber = 0; fiber < chains.fiber_count(); ++fiber) {
    const bool can_close = chains.offsets()[fiber + 1] - chains.offsets()[fiber] > 2;
    topology.closed.push_back(can_close && random.chance(0.5) ? 1 : 0);
  }
  if (std::count(topology.closed.begin(), topology.closed.end(), 1) == 0) {
    topology.closed.clear();
  }
  topology.joints.resize(points.size(), -1);
  for (int joint = random.integer(0, 3); joint > 0 && !points.empty(); --joint) {
    const int last = static_cast<int>(points.size()) - 1;
    const auto first = static_cast<std::size_t>(random.integer(0, last));
    const auto other = static_cast<std::size_t>(random.integer(0, last));
    if (first != other && topology.joints[first] < 0 && topology.joints[other] < 0) {
      points[other] = points[first];
      topology.joints[first] = topology.joints[other] = joint;
    }
  }
  if (std::count_if(topology.joints.begin(), topology.joints.end(),
                    [](int joint) { return joint >= 0; }) == 0) {
    topology.joints.clear();
  }
  return {points, chains.offsets(), chains.radii(), topology};
}

/// Sees that fibres are the same, their radii at each point.
inline void expect_same_fibers(const FiberAssembly& fibers, const FiberAssembly& expected) {
  EXPECT_EQ(fibers.points(), expected.points());
  ASSERT_EQ(fibers.offsets(), expected.offsets());
  EXPECT_TRUE(fibers.has_topology_of(expected));
  for (std::size_t fiber = 0; fiber < expected.fiber_count(); ++fiber) {
    for (std::size_t i = expected.offsets()[fiber]; i < expected.offsets()[fiber + 1]; ++i) {
      ASSERT_EQ(fibers.radius_at(fiber, i), expected.radius_at(fiber, i)) << i;
    }
  }
}

/// Rounds fibres as a file of millimetres in single precision does.
inline FiberAssembly in_float_millimetres(const FiberAssembly& fibers, bool has_radii) {
  const auto rounded = [](double metres) {
    return static_cast<double>(static_cast<float>(1000.0 * metres)) / 1000.0;
  };
  std::vector<Eigen::Vector3d> points = fibers.points();
  for (Eigen::Vector3d& point : points) {
    point = point.unaryExpr(rounded);
  }
  std::vector<double> radii = has_radii ? fibers.radii() : std::vector<double>{0.0};
  for (double& radius : radii) {
    radius = rounded(radius);
  }
  return {points, fibers.offsets(), radii};
}

}  // namespace fiber::test
