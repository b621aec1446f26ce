#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
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

template <class Number>
std::string text_of(Number number) {
  std::string text;
  append_number(text, number);
  return text;
}

std::string at_byte(std::uint64_t byte) { return " (byte " + text_of(byte) + ")"; }

/// Takes little-endian numbers from a stream and knows where it is.
class ByteReader {
 public:
  ByteReader(std::istream& stream, const std::string& name) : stream_(stream), name_(name) {}

  std::uint64_t position() const { return position_; }

  std::uint8_t byte() {
    if (next_ == filled_) {
      fill();
    }
    ++position_;
    return static_cast<std::uint8_t>(block_[next_++]);
  }

  std::uint32_t uint16() {
    const std::uint32_t low = byte();
    const std::uint32_t high = byte();
    return low | (high << 8U);
  }

  std::uint32_t uint32() {
    const std::uint32_t low = uint16();
    const std::uint32_t high = uint16();
    return low | (high << 16U);
  }

  double float32() {
    const std::uint32_t bits = uint32();
    float value = 0.0F;
    static_assert(sizeof(value) == sizeof(bits));
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }

 private:
  void fill() {
    errno = 0;
    stream_.read(block_.data(), block_.size());
    if (stream_.bad()) {
      throw FileError::from_system(name_, "cannot be read");
    }
    filled_ = static_cast<std::size_t>(stream_.gcount());
    next_ = 0;
    if (filled_ == 0) {
      throw FileError(name_, "ends at byte " + text_of(position_));
    }
  }

  std::istream& stream_;
  const std::string& name_;
  std::array<char, 1U << 16U> block_;
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
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
    for (const char letter : signature) {
      if (bytes_.byte() != static_cast<std::uint8_t>(letter)) {
        refuse("is not a HAIR file, which begins with the letters HAIR");
      }
    }
    strands_ = bytes_.uint32();
    points_ = bytes_.uint32();
    flags_ = bytes_.uint32();
    default_segments_ = bytes_.uint32();
    default_thickness_ = bytes_.float32();
    while (bytes_.position() < header_size) {
      bytes_.byte();
    }
    if ((flags_ & ~ALL_FLAGS) != 0) {
      refuse("the flags" + at_byte(flags_byte) + " are " + text_of(flags_) + ", only those up to " +
             text_of<std::uint32_t>(ALL_FLAGS) + " have a meaning");
    }
    if ((flags_ & POINTS) == 0) {
      refuse("the flags" + at_byte(flags_byte) + " are " + text_of(flags_) +
             ", without the points (" + text_of<std::uint32_t>(POINTS) + ") there are no fibres");
    }
    constexpr std::uint32_t most_points = 0x7fff'ffffU;
    if (points_ > most_points) {
      refuse("the number of points" + at_byte(point_count_byte) + " is " + text_of(points_) +
             ", at most " + text_of(most_points) + " are supported");
    }
  }

  bool has(Flag flag) const { return (flags_ & flag) != 0; }

  void check_size(std::optional<std::uint64_t> size) const {
    if (!size) {
      refuse("does not tell its size, a HAIR file must be an ordinary file");
    }
    const std::uint64_t point_size = (has(POINTS) ? 12U : 0U) + (has(THICKNESS) ? 4U : 0U) +
                                     (has(TRANSPARENCY) ? 4U : 0U) + (has(COLOR) ? 12U : 0U);
    const std::uint64_t strand_size = has(SEGMENTS) ? 2 : 0;
    const std::uint64_t expected = header_size + strand_size * strands_ + point_size * points_;
    if (*size != expected) {
      refuse("has " + text_of(*size) + " bytes, the header asks for " + text_of(expected) + ": " +
             text_of(strands_) + " strands" + at_byte(strand_count_byte) + ", " + text_of(points_) +
             " points" + at_byte(point_count_byte) + ", flags " + text_of(flags_) +
             at_byte(flags_byte));
    }
  }

  std::vector<std::uint32_t> read_offsets() {
    std::vector<std::uint32_t> offsets{0};
    std::uint64_t total = 0;
    for (std::uint32_t strand = 0; strand < strands_; ++strand) {
      const std::uint64_t byte = has(SEGMENTS) ? bytes_.position() : default_segments_byte;
      const std::uint64_t segments = has(SEGMENTS) ? bytes_.uint16() : default_segments_;
      if (segments == 0) {
        refuse("strand " + text_of(strand) + " has 0 segments" + at_byte(byte) +
               ", a fibre needs at least 1");
      }
      total += segments + 1;
      if (total > points_) {
        refuse("strand " + text_of(strand) + " has " + text_of(segments) + " segments" +
               at_byte(byte) + " and would end with point " + text_of(total) + " of " +
               text_of(points_) + at_byte(point_count_byte));
      }
      offsets.push_back(static_cast<std::uint32_t>(total));
    }
    if (total != points_) {
      refuse("the strands have " + text_of(total) + " points, the header says " + text_of(points_) +
             at_byte(point_count_byte));
    }
    return offsets;
  }

  std::vector<Eigen::Vector3d> read_points() {
    std::vector<Eigen::Vector3d> points(points_);
    for (std::uint32_t point = 0; point < points_; ++point) {
      for (int axis = 0; axis < 3; ++axis) {
        const std::uint64_t byte = bytes_.position();
        points[point][axis] = bytes_.float32();
        if (!FiberAssembly::is_valid_coordinate(points[point][axis])) {
          refuse(std::string(1, "xyz"[axis]) + " of point " + text_of(point) + at_byte(byte) +
                 " is " + text_of(points[point][axis]) + ", " + FiberAssembly::coordinate_rule);
        }
      }
    }
    return points;
  }

  std::vector<double> read_radii() {
    if (!has(THICKNESS)) {
      const double radius =
          checked_radius("the default thickness", default_thickness_, default_thickness_byte);
      return {default_thickness_ == 0.0 ? default_radius_ : radius};
    }
    std::vector<double> radii;
    radii.reserve(points_);
    for (std::uint32_t point = 0; point < points_; ++point) {
      const std::uint64_t byte = bytes_.position();
      const double thickness = bytes_.float32();
      radii.push_back(checked_radius("the thickness of point " + text_of(point), thickness, byte));
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

  // The header.
  std::uint32_t strands_ = 0;
  std::uint32_t points_ = 0;
  std::uint32_t flags_ = 0;
  std::uint32_t default_segments_ = 0;
  double default_thickness_ = 0.0;
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
