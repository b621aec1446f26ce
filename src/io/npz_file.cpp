// .npz files: archives of numpy's arrays points, offsets and radii, closed and joints.
#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "src/io/bytes.hpp"
#include "src/io/fiber_formats.hpp"
#include "src/io/npy_array.hpp"
#include "src/io/number.hpp"
#include "src/io/one_frame.hpp"
#include "src/io/strands.hpp"
#include "src/io/zip_archive.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

class NpzReader {
 public:
  NpzReader(std::string_view bytes, const std::string& name) : name_(name), archive_(bytes, name) {}

  Strands read() {
    const std::string known[] = {"points", "offsets", "radii", "closed", "joints"};
    std::string others;
    for (const ZipArchive::Member& member : archive_.members()) {
      std::string_view array = member.name;
      if (array.size() > 4 && array.substr(array.size() - 4) == ".npy") {
        array.remove_suffix(4);
      }
      if (std::find(std::begin(known), std::end(known), array) == std::end(known)) {
        others += (others.empty() ? "" : ", ") + quote(array);
      }
    }
    if (!others.empty()) {
      strands_.notes.push_back("arrays not read: " + shortened(others, 1000));
    }
    read_points();
    read_offsets();
    read_radii();
    read_topology();
    return std::move(strands_);
  }

 private:
  [[noreturn]] void refuse(const std::string& array, const std::string& reason) const {
    throw FileError(name_, "the array " + array + ' ' + reason);
  }

  /// @return an array that stays until the next one is looked for; nothing if there is none
  std::optional<NpyArray> find(const std::string& array) {
    for (const ZipArchive::Member& member : archive_.members()) {
      if (member.name == array + ".npy") {
        unpacked_ = archive_.unpack(member);
        try {
          return read_npy(unpacked_);
        } catch (const std::runtime_error& error) {
          refuse(array + at_byte(member.byte), std::string("cannot be read: ") + error.what());
        }
      }
    }
    return std::nullopt;
  }

  static std::string text_of_shape(const NpyArray& array) {
    std::string text;
    for (const std::uint64_t length : array.shape) {
      text += (text.empty() ? "" : ", ") + text_of(length);
    }
    return "the shape (" + text + ")";
  }

  std::optional<NpyArray> find_whole(const std::string& name) {
    std::optional<NpyArray> array = find(name);
    if (array && (array->shape.size() != 1 || !is_whole(array->numbers.type()))) {
      refuse(name, "has " + text_of_shape(*array) +
                       (is_whole(array->numbers.type()) ? "" : " and no whole numbers") +
                       ", expected whole numbers in one row");
    }
    return array;
  }

  void read_points() {
    const std::optional<NpyArray> array = find("points");
    if (!array) {
      throw FileError(name_, "has no array points");
    }
    if (array->shape.size() != 2 || array->shape[1] != 3) {
      refuse("points", "has " + text_of_shape(*array) + ", expected three columns");
    }
    const std::uint64_t rows = array->shape[0];
    strands_.points.reserve(rows);
    for (std::uint64_t row = 0; row < rows; ++row) {
      Eigen::Vector3d& point = strands_.points.emplace_back();
      for (std::uint64_t axis = 0; axis < 3; ++axis) {
        point[static_cast<Eigen::Index>(axis)] =
            array->numbers.real(array->is_fortran ? axis * rows + row : 3 * row + axis);
      }
      check_point(name_, point, [&](int) { return "row " + text_of(row) + " of points"; });
    }
  }

  void read_offsets() {
    const std::optional<NpyArray> array = find_whole("offsets");
    if (!array) {
      throw FileError(name_, "has no array offsets");
    }
    const NumberArray& numbers = array->numbers;
    const auto point_count = static_cast<std::int64_t>(strands_.points.size());
    if (point_count > std::numeric_limits<std::int32_t>::max()) {
      refuse("points", "has " + text_of(point_count) + " rows, more than are supported");
    }
    if (numbers.size() == 0 || numbers.whole(0) != 0) {
      refuse("offsets", numbers.size() == 0
                            ? std::string("is empty, expected 0 as its first")
                            : "begins with " + text_of(numbers.whole(0)) + ", expected 0");
    }
    for (std::size_t i = 1; i < numbers.size(); ++i) {
      const std::int64_t offset = numbers.whole(i);
      if (offset < strands_.offsets.back() || offset > point_count) {
        refuse("offsets", "has " + text_of(offset) + " as number " + text_of(i) + ", expected " +
                              text_of(strands_.offsets.back()) + " to " + text_of(point_count));
      }
      strands_.offsets.push_back(static_cast<std::uint32_t>(offset));
    }
    if (strands_.offsets.back() != strands_.points.size()) {
      refuse("offsets", "ends with " + text_of(strands_.offsets.back()) + ", expected " +
                            text_of(point_count) + ", the number of points");
    }
  }

  void read_radii() {
    const std::optional<NpyArray> array = find("radii");
    if (!array) {
      return;
    }
    const std::size_t count = array->numbers.size();
    if (array->shape.size() > 1 ||
        (count != 1 && count != strands_.count() && count != strands_.points.size())) {
      refuse("radii", "has " + text_of_shape(*array) + ", expected 1, one per fibre (" +
                          text_of(strands_.count()) + ") or one per point (" +
                          text_of(strands_.points.size()) + ")");
    }
    strands_.radius_per = count == 1                  ? RadiusPer::ASSEMBLY
                          : count == strands_.count() ? RadiusPer::FIBER
                                                      : RadiusPer::POINT;
    for (std::size_t i = 0; i < count; ++i) {
      strands_.radii.push_back(array->numbers.real(i));
      check_radius(name_, strands_.radii.back(),
                   [&] { return "number " + text_of(i) + " of radii"; });
    }
  }

  void read_topology() {
    if (const std::optional<NpyArray> closed = find_whole("closed")) {
      require_size("closed", *closed, strands_.count());
      for (std::size_t i = 0; i < closed->numbers.size(); ++i) {
        const std::int64_t value = closed->numbers.whole(i);
        if (value != 0 && value != 1) {
          refuse("closed",
                 "has " + text_of(value) + " as number " + text_of(i) + ", expected 0 or 1");
        }
        strands_.topology.closed.push_back(static_cast<std::uint8_t>(value));
      }
    }
    if (const std::optional<NpyArray> joints = find_whole("joints")) {
      require_size("joints", *joints, strands_.points.size());
      for (std::size_t i = 0; i < joints->numbers.size(); ++i) {
        const std::int64_t value = joints->numbers.whole(i);
        if (value < -1 || value > std::numeric_limits<std::int32_t>::max()) {
          refuse("joints", "has " + text_of(value) + " as number " + text_of(i) +
                               ", expected -1 to 2147483647");
        }
        strands_.topology.joints.push_back(static_cast<std::int32_t>(value));
      }
    }
  }

  void require_size(const std::string& name, const NpyArray& array, std::size_t size) const {
    if (array.numbers.size() != size) {
      refuse(name, "has " + text_of_shape(array) + ", expected " + text_of(size) + " numbers");
    }
  }

  const std::string& name_;
  const ZipArchive archive_;
  std::string unpacked_;
  Strands strands_;
};

/// @param numbers one after another in memory
template <class Number>
void add_array(ZipWriter& archive, const std::string& name, const std::string& description,
               const std::vector<std::uint64_t>& shape, const std::vector<Number>& numbers) {
  std::string bytes = npy_header(description, shape);
  bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number));
  archive.add(name + ".npy", bytes);
}

}  // namespace

FiberFile read_npz(std::istream& stream, const std::string& name, const ReadOptions& options) {
  const std::string bytes = read_bytes(stream, name, "an .npz file");
  return to_file(NpzReader(bytes, name).read(), options, name, "fibre");
}

void write_npz(std::ostream& stream, const FiberFile& file) {
  static_assert(native_order == ByteOrder::LITTLE && sizeof(Eigen::Vector3d) == 24);
  const FiberAssembly& fibers = only_frame(".npz", file).fibers;
  const FiberTopology topology = fibers.topology();
  const std::vector<Eigen::Vector3d> points = fibers.given_points();
  const std::vector<std::uint32_t>& given = fibers.given_offsets();
  const std::vector<std::int64_t> offsets(given.begin(), given.end());
  const std::vector<double> radii = fibers.given_radii();
  ZipWriter archive;
  add_array(archive, "points", "<f8", {points.size(), 3}, points);
  add_array(archive, "offsets", "<i8", {offsets.size()}, offsets);
  add_array(archive, "radii", "<f8", {radii.size()}, radii);
  if (!topology.closed.empty()) {
    add_array(archive, "closed", "|u1", {topology.closed.size()}, topology.closed);
  }
  if (!topology.joints.empty()) {
    add_array(archive, "joints", "<i4", {topology.joints.size()}, topology.joints);
  }
  stream << archive.finish();
}

}  // namespace fiber
