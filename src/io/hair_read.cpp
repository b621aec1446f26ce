#include <algorithm>
#include <cerrno>
#include <optional>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/hair_format.hpp"
#include "src/io/input_file.hpp"
#include "src/io/number.hpp"
#include "src/io/radii.hpp"

namespace fiber {
namespace {

using namespace hair_format;

std::string at_byte(std::uint64_t byte) { return " (byte " + text_of(byte) + ")"; }

/// Takes what stands in a stream and knows where it is.
class ByteReader {
 public:
  ByteReader(std::istream& stream, const std::string& name) : stream_(stream), name_(name) {}

  std::uint64_t position() const { return position_; }

  template <class Value>
  std::vector<Value> array(std::size_t count) {
    std::vector<Value> values(count);
    errno = 0;
    stream_.read(reinterpret_cast<char*>(values.data()),
                 static_cast<std::streamsize>(count * sizeof(Value)));
    if (stream_.bad()) {
      throw FileError::from_system(name_, "cannot be read");
    }
    position_ += static_cast<std::uint64_t>(stream_.gcount());
    if (!stream_) {
      throw FileError(name_, "ends at byte " + text_of(position_));
    }
    return values;
  }

 private:
  std::istream& stream_;
  const std::string& name_;
  std::uint64_t position_ = 0;
};

class HairReader {
 public:
  HairReader(std::istream& stream, const std::string& name, double default_radius)
      : stream_(stream), name_(name), bytes_(stream, name), default_radius_(default_radius) {
    check_default_radius(default_radius);
  }

  FiberFile read() {
    const std::optional<std::uint64_t> size = stream_size();
    read_header();
    check_size(size);
    std::vector<std::uint32_t> offsets = read_offsets();
    std::vector<Eigen::Vector3d> points = read_points();
    std::vector<double> radii = read_radii();
    return {false, {{0, FiberAssembly(std::move(points), std::move(offsets), std::move(radii))}}};
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const { throw FileError(name_, reason); }

  /// Nothing if the stream does not tell.
  std::optional<std::uint64_t> stream_size() {
    const auto end = stream_.seekg(0, std::ios::end).tellg();
    stream_.clear();
    stream_.seekg(0);
    if (!stream_ || end < 0) {
      stream_.clear();
      return std::nullopt;
    }
    return static_cast<std::uint64_t>(end);
  }

  void read_header() {
    const std::vector<char> begin = bytes_.array<char>(sizeof(signature));
    if (!std::equal(begin.begin(), begin.end(), signature)) {
      refuse("is not a HAIR file, which begins with the letters HAIR");
    }
    header_ = bytes_.array<Header>(1).front();
    if ((header_.flags & ~ALL_FLAGS) != 0) {
      refuse("the flags" + at_byte(flags_byte) + " are " + text_of(header_.flags) +
             ", only those up to " + text_of<std::uint32_t>(ALL_FLAGS) + " have a meaning");
    }
    if ((header_.flags & POINTS) == 0) {
      refuse("the flags" + at_byte(flags_byte) + " are " + text_of(header_.flags) +
             ", without the points (" + text_of<std::uint32_t>(POINTS) + ") there are no fibres");
    }
    constexpr std::uint32_t max_points = 0x7fff'ffffU;
    if (header_.points > max_points) {
      refuse("the number of points" + at_byte(point_count_byte) + " is " + text_of(header_.points) +
             ", at most " + text_of(max_points) + " are supported");
    }
  }

  bool has(Flag flag) const { return (header_.flags & flag) != 0; }

  void check_size(std::optional<std::uint64_t> size) const {
    if (!size) {
      refuse("does not tell its size, a HAIR file must be an ordinary file");
    }
    const std::uint64_t point_size = (has(POINTS) ? 12U : 0U) + (has(THICKNESS) ? 4U : 0U) +
                                     (has(TRANSPARENCY) ? 4U : 0U) + (has(COLOR) ? 12U : 0U);
    const std::uint64_t strand_size = has(SEGMENTS) ? 2 : 0;
    const std::uint64_t expected =
        header_size + strand_size * header_.strands + point_size * header_.points;
    if (*size != expected) {
      refuse("has " + text_of(*size) + " bytes, the header asks for " + text_of(expected) + ": " +
             text_of(header_.strands) + " strands" + at_byte(strand_count_byte) + ", " +
             text_of(header_.points) + " points" + at_byte(point_count_byte) + ", flags " +
             text_of(header_.flags) + at_byte(flags_byte));
    }
  }

  std::vector<std::uint32_t> read_offsets() {
    const std::uint64_t begin = bytes_.position();
    const auto own_segments = bytes_.array<std::uint16_t>(has(SEGMENTS) ? header_.strands : 0);
    std::vector<std::uint32_t> offsets{0};
    std::uint64_t total = 0;
    for (std::uint32_t strand = 0; strand < header_.strands; ++strand) {
      const std::uint64_t byte =
          has(SEGMENTS) ? begin + 2 * std::uint64_t{strand} : default_segments_byte;
      const std::uint64_t segments =
          has(SEGMENTS) ? own_segments[strand] : header_.default_segments;
      if (segments == 0) {
        refuse("strand " + text_of(strand) + " has 0 segments" + at_byte(byte) +
               ", a fibre needs at least 1");
      }
      total += segments + 1;
      if (total > header_.points) {
        refuse("strand " + text_of(strand) + " has " + text_of(segments) + " segments" +
               at_byte(byte) + " and would end with point " + text_of(total) + " of " +
               text_of(header_.points) + at_byte(point_count_byte));
      }
      offsets.push_back(static_cast<std::uint32_t>(total));
    }
    if (total != header_.points) {
      refuse("the strands have " + text_of(total) + " points, the header says " +
             text_of(header_.points) + at_byte(point_count_byte));
    }
    return offsets;
  }

  std::vector<Eigen::Vector3d> read_points() {
    const std::uint64_t begin = bytes_.position();
    std::vector<Eigen::Vector3d> points;
    points.reserve(header_.points);
    for (const Eigen::Vector3f& place : bytes_.array<Eigen::Vector3f>(header_.points)) {
      points.emplace_back(place.cast<double>());
      for (int axis = 0; axis < 3; ++axis) {
        if (!FiberAssembly::is_valid_coordinate(points.back()[axis])) {
          const std::uint64_t point = points.size() - 1;
          refuse(std::string(1, "xyz"[axis]) + " of point " + text_of(point) +
                 at_byte(begin + 12 * point + 4 * static_cast<std::uint64_t>(axis)) + " is " +
                 text_of(points.back()[axis]) + ", " + FiberAssembly::coordinate_rule);
        }
      }
    }
    return points;
  }

  std::vector<double> read_radii() {
    if (!has(THICKNESS)) {
      const double radius = checked_radius("the default thickness", header_.default_thickness,
                                           default_thickness_byte);
      return {header_.default_thickness == 0.0 ? default_radius_ : radius};
    }
    const std::uint64_t begin = bytes_.position();
    std::vector<double> radii;
    radii.reserve(header_.points);
    for (const float thickness : bytes_.array<float>(header_.points)) {
      radii.push_back(checked_radius("the thickness of point " + text_of(radii.size()), thickness,
                                     begin + 4 * radii.size()));
    }
    if (radii.empty()) {
      radii.push_back(default_radius_);
    }
    return shared_if_equal(std::move(radii));
  }

  double checked_radius(const std::string& what, double thickness, std::uint64_t byte) const {
    if (!FiberAssembly::is_valid_radius(0.5 * thickness)) {
      refuse(what + at_byte(byte) + " is " + text_of(thickness) + ", " +
             FiberAssembly::radius_rule);
    }
    return 0.5 * thickness;
  }

  std::istream& stream_;
  const std::string& name_;
  ByteReader bytes_;
  const double default_radius_;  // [m]

  Header header_;
};

}  // namespace

FiberFile read_hair(const std::string& path, double default_radius) {
  std::ifstream stream = open_to_read(path);
  return read_hair(stream, path, default_radius);
}

FiberFile read_hair(std::istream& stream, const std::string& name, double default_radius) {
  return HairReader(stream, name, default_radius).read();
}

}  // namespace fiber
