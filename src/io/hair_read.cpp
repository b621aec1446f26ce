#include <cstring>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/bytes.hpp"
#include "src/io/hair_format.hpp"
#include "src/io/input_file.hpp"
#include "src/io/number.hpp"
#include "src/io/strands.hpp"

namespace fiber {
namespace {

using namespace hair_format;

class HairReader {
 public:
  HairReader(std::string_view bytes, const std::string& name, const ReadOptions& options)
      : name_(name), size_(bytes.size()), bytes_(bytes, name), options_(options) {}

  FiberFile read() {
    read_header();
    check_size();
    Strands strands;
    strands.offsets = read_offsets();
    strands.points = read_points();
    read_radii(strands);
    return to_file(std::move(strands), options_, name_, "strand");
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const { throw FileError(name_, reason); }

  void read_header() {
    if (bytes_.take(sizeof(signature)) != std::string_view(signature, sizeof(signature))) {
      refuse("is not a HAIR file, which begins with the letters HAIR");
    }
    std::memcpy(&header_, bytes_.take(sizeof(header_)).data(), sizeof(header_));
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

  void check_size() const {
    const std::uint64_t point_size = (has(POINTS) ? 12U : 0U) + (has(THICKNESS) ? 4U : 0U) +
                                     (has(TRANSPARENCY) ? 4U : 0U) + (has(COLOR) ? 12U : 0U);
    const std::uint64_t strand_size = has(SEGMENTS) ? 2 : 0;
    const std::uint64_t expected =
        header_size + strand_size * header_.strands + point_size * header_.points;
    if (size_ != expected) {
      refuse("has " + text_of(size_) + " bytes, the header asks for " + text_of(expected) + ": " +
             text_of(header_.strands) + " strands" + at_byte(strand_count_byte) + ", " +
             text_of(header_.points) + " points" + at_byte(point_count_byte) + ", flags " +
             text_of(header_.flags) + at_byte(flags_byte));
    }
  }

  std::vector<std::uint32_t> read_offsets() {
    const std::uint64_t begin = bytes_.position();
    const std::string_view own_segments =
        bytes_.take(has(SEGMENTS) ? 2 * std::uint64_t{header_.strands} : 0);
    std::vector<std::uint32_t> offsets{0};
    std::uint64_t total = 0;
    for (std::uint32_t strand = 0; strand < header_.strands; ++strand) {
      const std::uint64_t byte =
          has(SEGMENTS) ? begin + 2 * std::uint64_t{strand} : default_segments_byte;
      const std::uint64_t segments =
          has(SEGMENTS)
              ? value_at<std::uint16_t>(&own_segments[2 * std::size_t{strand}], ByteOrder::LITTLE)
              : header_.default_segments;
      if (segments == 0 && !options_.skip_single_points) {
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
    std::vector<Eigen::Vector3d> points;
    points.reserve(header_.points);
    for (std::uint64_t point = 0; point < header_.points; ++point) {
      const std::uint64_t begin = bytes_.position();
      const auto x = bytes_.value<float>();
      const auto y = bytes_.value<float>();
      const auto z = bytes_.value<float>();
      points.emplace_back(x, y, z);
      check_point(name_, points.back(), [&](int axis) {
        return "point " + text_of(point) + at_byte(begin + 4 * static_cast<std::uint64_t>(axis));
      });
    }
    return points;
  }

  void read_radii(Strands& strands) {
    if (!has(THICKNESS)) {
      const double radius = checked_radius([] { return std::string("the default thickness"); },
                                           header_.default_thickness, default_thickness_byte);
      strands.radius_per = RadiusPer::ASSEMBLY;
      if (radius != 0.0) {
        strands.radii.push_back(radius);
      }
      return;
    }
    strands.radii.reserve(header_.points);
    for (std::uint64_t point = 0; point < header_.points; ++point) {
      const std::uint64_t begin = bytes_.position();
      strands.radii.push_back(
          checked_radius([&] { return "the thickness of point " + text_of(point); },
                         bytes_.value<float>(), begin));
    }
  }

  /// @param what called for an error only
  template <class What>
  double checked_radius(const What& what, double thickness, std::uint64_t byte) const {
    if (!FiberAssembly::is_valid_radius(0.5 * thickness)) {
      refuse(what() + at_byte(byte) + " is " + text_of(thickness) + ", " +
             FiberAssembly::radius_rule);
    }
    return 0.5 * thickness;
  }

  const std::string& name_;
  const std::uint64_t size_;  // [byte]
  ByteReader bytes_;
  const ReadOptions& options_;

  Header header_;
};

}  // namespace

FiberFile read_hair(const std::string& path, const ReadOptions& options) {
  std::ifstream stream = open_to_read(path);
  return read_hair(stream, path, options);
}

FiberFile read_hair(std::istream& stream, const std::string& name, const ReadOptions& options) {
  const std::string bytes = read_bytes(stream, name, "a HAIR file");
  return HairReader(bytes, name, options).read();
}

}  // namespace fiber
