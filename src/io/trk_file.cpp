// .trk files of TrackVis: trackvis.org/docs/?subsect=fileformat
#include <stdexcept>
#include <utility>

#include "src/io/bytes.hpp"
#include "src/io/fiber_formats.hpp"
#include "src/io/millimetres.hpp"
#include "src/io/number.hpp"
#include "src/io/one_frame.hpp"
#include "src/io/strands.hpp"
#include "src/io/trk_space.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::string_view trk_signature{"TRACK\0", 6};
constexpr std::size_t trk_header_size = 1000;
constexpr std::size_t name_size = 20;  // of a scalar or a property
constexpr int max_names = 10;

// Where the fields of the header begin [byte].
constexpr std::size_t dimensions_byte = 6;
constexpr std::size_t voxel_size_byte = 12;
constexpr std::size_t scalar_count_byte = 36;
constexpr std::size_t property_count_byte = 238;
constexpr std::size_t matrix_byte = 440;
constexpr std::size_t order_byte = 948;
constexpr std::size_t track_count_byte = 988;
constexpr std::size_t version_byte = 992;
constexpr std::size_t header_size_byte = 996;

/// The text in a field, up to its first zero.
std::string_view text_in(std::string_view field) { return field.substr(0, field.find('\0')); }

class TrkReader {
 public:
  TrkReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), reader_(bytes, name) {}

  Strands read() {
    read_header();
    read_space();
    const std::uint64_t scalars = count_at(scalar_count_byte, "scalars");
    const std::uint64_t properties = count_at(property_count_byte, "properties");
    take_names(scalars, properties);
    const auto count = field<std::int32_t>(track_count_byte);
    if (count < 0) {
      refuse("the number of tracks" + at_byte(track_count_byte) + " is " + text_of(count));
    }
    // 0 says that they are not counted.
    while (count == 0 ? reader_.left() > 0 : strands_.count() < static_cast<std::uint64_t>(count)) {
      read_track(scalars, properties);
    }
    if (reader_.left() > 0) {
      refuse("has " + text_of(reader_.left()) + " bytes after " + text_of(count) +
             " tracks, as many as the header tells of" + at_byte(track_count_byte));
    }
    return std::move(strands_);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const { throw FileError(name_, reason); }

  template <class Value>
  Value field(std::size_t byte) const {
    return value_at<Value>(&bytes_[byte], order_);
  }

  void read_header() {
    if (bytes_.substr(0, trk_signature.size()) != trk_signature) {
      refuse("is not a .trk file, which begins with the letters TRACK and a zero");
    }
    reader_.take(trk_header_size);
    constexpr std::int32_t size = trk_header_size;
    if (field<std::int32_t>(header_size_byte) == size) {
      return;
    }
    order_ = other_order(order_);
    if (field<std::int32_t>(header_size_byte) != size) {
      refuse("the size of the header" + at_byte(header_size_byte) +
             " is not 1000, in neither order of bytes");
    }
  }

  void read_space() {
    TrkSpace space;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<Eigen::Index>(axis);
      space.dimensions[i] = field<std::int16_t>(dimensions_byte + 2 * axis);
      space.voxel_size[i] = field<float>(voxel_size_byte + 4 * axis);
    }
    for (std::size_t i = 0; i < 16; ++i) {
      space.vox_to_ras(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
          field<float>(matrix_byte + 4 * i);
    }
    space.voxel_order = text_in(bytes_.substr(order_byte, 4));
    if (!space.has_matrix()) {
      strands_.notes.emplace_back(
          "there is no vox_to_ras: coordinates count from the corner of the first voxel");
      return;
    }
    if (!(space.voxel_size.array() > 0.0).all() || !space.voxel_size.allFinite()) {
      refuse("the voxel_size" + at_byte(voxel_size_byte) + " is " + text_of(space.voxel_size.x()) +
             ' ' + text_of(space.voxel_size.y()) + ' ' + text_of(space.voxel_size.z()) +
             ", expected three numbers above 0");
    }
    if (!space.vox_to_ras.allFinite() ||
        space.vox_to_ras.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
      refuse("the matrix vox_to_ras" + at_byte(matrix_byte) +
             " is no affine one: finite, with 0 0 0 1 as its last row");
    }
    try {
      to_ras_ = ras_of_points(space);
    } catch (const std::invalid_argument& error) {
      refuse(error.what());
    }
  }

  std::uint64_t count_at(std::size_t byte, const char* what) const {
    const auto count = field<std::int16_t>(byte);
    if (count < 0 || count > max_names) {
      refuse(std::string("the number of ") + what + at_byte(byte) + " is " + text_of(count) +
             ", expected 0 to " + text_of(max_names));
    }
    return static_cast<std::uint64_t>(count);
  }

  /// Finds the radius among the scalars, and notes what else there is.
  void take_names(std::uint64_t scalars, std::uint64_t properties) {
    radius_ = scalars;
    std::string names;
    const auto take = [&](std::size_t begin, std::uint64_t i) {
      const std::string_view name = text_in(bytes_.substr(begin + 2 + name_size * i, name_size));
      names += (names.empty() ? "" : ", ") + quote(name);
    };
    for (std::uint64_t i = 0; i < scalars; ++i) {
      if (radius_ == scalars && is_radius_name(text_in(bytes_.substr(
                                    scalar_count_byte + 2 + name_size * i, name_size)))) {
        radius_ = i;
      } else {
        take(scalar_count_byte, i);
      }
    }
    if (!names.empty()) {
      strands_.notes.push_back("scalars not read: " + std::exchange(names, ""));
    }
    for (std::uint64_t i = 0; i < properties; ++i) {
      take(property_count_byte, i);
    }
    if (!names.empty()) {
      strands_.notes.push_back("properties not read: " + names);
    }
  }

  void read_track(std::uint64_t scalars, std::uint64_t properties) {
    const std::uint64_t begin = reader_.position();
    const auto points = reader_.value<std::int32_t>(order_);
    const std::uint64_t size =
        points < 0 ? 0 : 4 * ((3 + scalars) * static_cast<std::uint64_t>(points) + properties);
    if (points < 0 || size > reader_.left()) {
      refuse("track " + text_of(strands_.count()) + at_byte(begin) + " has " + text_of(points) +
             " points, the file has " + text_of(reader_.left()) + " more bytes");
    }
    for (std::int32_t point = 0; point < points; ++point) {
      read_point(scalars);
    }
    reader_.take(4 * properties);
    strands_.end_strand(name_);
  }

  void read_point(std::uint64_t scalars) {
    const std::uint64_t byte = reader_.position();
    const auto what = [&, index = strands_.points.size() - strands_.offsets.back()] {
      return "point " + text_of(index) + " of track " + text_of(strands_.count());
    };
    Eigen::Vector3d point;
    for (double& coordinate : point) {
      coordinate = reader_.value<float>(order_);
    }
    const auto place = [&](int axis) {
      return what() + at_byte(byte + 4 * static_cast<std::uint64_t>(axis));
    };
    check_point(name_, point, place);
    strands_.points.push_back(metres_of(to_ras_ * point));
    check_point(name_, strands_.points.back(), place);
    for (std::uint64_t i = 0; i < scalars; ++i) {
      const std::uint64_t scalar_byte = reader_.position();
      const double value = reader_.value<float>(order_);
      if (i == radius_) {
        check_radius(name_, value / 1000.0,
                     [&] { return "the radius of " + what() + at_byte(scalar_byte); });
        strands_.radii.push_back(value / 1000.0);
      }
    }
  }

  const std::string_view bytes_;
  const std::string& name_;
  ByteReader reader_;
  ByteOrder order_ = ByteOrder::LITTLE;
  Eigen::Affine3d to_ras_ = Eigen::Affine3d::Identity();
  std::uint64_t radius_ = 0;  // which scalar it is; their number if there is none
  Strands strands_;
};

template <class Value>
void put(std::string& header, std::size_t byte, Value value) {
  std::string bytes;
  append_value(bytes, value);
  header.replace(byte, bytes.size(), bytes);
}

/// The header that write_trk() writes: its voxels are of 1 mm and begin at the origin, so that
/// points stay where they are.
std::string trk_header(std::size_t tracks, bool has_radius) {
  std::string header(trk_header_size, '\0');
  header.replace(0, trk_signature.size(), trk_signature);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(header, dimensions_byte + 2 * axis, std::int16_t{1});
    put(header, voxel_size_byte + 4 * axis, 1.0F);
    put(header, matrix_byte + 20 * axis, 1.0F);
    put(header, matrix_byte + 16 * axis + 12, 0.5F);
  }
  put(header, matrix_byte + 60, 1.0F);
  header.replace(order_byte, 3, "RAS");
  if (has_radius) {
    put(header, scalar_count_byte, std::int16_t{1});
    header.replace(scalar_count_byte + 2, 6, "radius");
  }
  put(header, track_count_byte, static_cast<std::int32_t>(tracks));
  put(header, version_byte, std::int32_t{2});
  put(header, header_size_byte, std::int32_t{trk_header_size});
  return header;
}

}  // namespace

FiberFile read_trk(std::istream& stream, const std::string& name, const ReadOptions& options) {
  const std::string bytes = read_bytes(stream, name, "a .trk file");
  return to_file(TrkReader(bytes, name).read(), options, name, "track");
}

void write_trk(std::ostream& stream, const FiberFile& file) {
  const FiberAssembly& fibers = only_frame(".trk", file).fibers;
  const bool has_radius = has_radii(fibers);
  std::string bytes = trk_header(fibers.fiber_count(), has_radius);
  for_each_point(fibers, [&](std::size_t fiber, std::size_t i) {
    const std::uint32_t begin = fibers.offsets()[fiber];
    if (i == begin) {
      append_value(bytes, static_cast<std::int32_t>(fibers.offsets()[fiber + 1] - begin));
    }
    append_millimetres(bytes, ".trk", fibers, fiber, i);
    if (has_radius) {
      append_value(bytes, single_precision(".trk", 1000.0 * fibers.radius_at(fiber, i),
                                           "the radius", fiber, i - begin));
    }
  });
  stream << bytes;
}

}  // namespace fiber
