// .tck files of MRtrix: mrtrix.readthedocs.io/en/latest/getting_started/image_data.html
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "src/io/bytes.hpp"
#include "src/io/csv_row.hpp"
#include "src/io/fiber_formats.hpp"
#include "src/io/millimetres.hpp"
#include "src/io/number.hpp"
#include "src/io/one_frame.hpp"
#include "src/io/strands.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::string_view tck_signature = "mrtrix tracks";

class TckReader {
 public:
  TckReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Strands read() {
    read_header();
    if (is_double_) {
      read_points<double>();
    } else {
      read_points<float>();
    }
    check_count();
    return std::move(strands_);
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const { throw FileError(name_, reason); }

  void read_header() {
    if (bytes_.substr(0, tck_signature.size()) != tck_signature) {
      refuse("is not a .tck file, which begins with " + quote(tck_signature));
    }
    std::size_t position = 0;
    for (std::size_t line = 1;; ++line) {
      const std::size_t end = bytes_.find('\n', position);
      if (end == std::string_view::npos) {
        refuse("the header has no line END");
      }
      const std::string_view text = trimmed(bytes_.substr(position, end - position));
      position = end + 1;
      if (text == "END") {
        break;
      }
      const std::size_t colon = text.find(':');
      if (line > 1 && colon != std::string_view::npos) {
        take_field(trimmed(text.substr(0, colon)), trimmed(text.substr(colon + 1)), line);
      }
    }
    if (!has_type_ || !begin_) {
      refuse(std::string("the header has no field ") + (has_type_ ? "file" : "datatype"));
    }
    if (*begin_ < position || *begin_ > bytes_.size()) {
      refuse("the field file says that the tracks begin at byte " + text_of(*begin_) +
             ", the header ends at " + text_of(position) + " and the file at " +
             text_of(bytes_.size()));
    }
  }

  void take_field(std::string_view key, std::string_view value, std::size_t line) {
    if (key == "datatype") {
      has_type_ = true;
      is_double_ = value.substr(0, 7) == "Float64";
      order_ = value.size() == 9 && value.substr(7) == "BE" ? ByteOrder::BIG : ByteOrder::LITTLE;
      if (value != "Float32LE" && value != "Float32BE" && value != "Float64LE" &&
          value != "Float64BE") {
        throw FileError(name_, line,
                        "datatype is " + quote(value) +
                            ", expected Float32LE, Float32BE, Float64LE or Float64BE");
      }
    } else if (key == "file") {
      begin_ = value.substr(0, 2) == ". " ? parse_number<std::size_t>(trimmed(value.substr(2)))
                                          : std::nullopt;
      if (!begin_) {
        throw FileError(
            name_, line,
            "file is " + quote(value) + ", expected a point and the byte where the tracks begin");
      }
    } else if (key == "count") {
      count_ = parse_number<std::uint64_t>(value);
      if (!count_) {
        throw FileError(name_, line, "count is " + quote(value) + ", expected a whole number");
      }
    }
  }

  template <class Real>
  void read_points() {
    ByteReader reader(bytes_, name_, *begin_);
    while (true) {
      const std::uint64_t byte = reader.position();
      if (reader.left() < 3 * sizeof(Real)) {
        refuse("ends at byte " + text_of(bytes_.size()) +
               ", without the three infinities that end the tracks");
      }
      Eigen::Vector3d point;
      for (double& coordinate : point) {
        coordinate = reader.value<Real>(order_);
      }
      if (point.array().isNaN().all()) {
        strands_.end_strand(name_);
      } else if (point.array().isInf().all()) {
        break;
      } else {
        check_point(name_, point, [&](int axis) {
          return "point " + text_of(strands_.points.size() - strands_.offsets.back()) +
                 " of track " + text_of(strands_.count()) +
                 at_byte(byte + sizeof(Real) * static_cast<std::uint64_t>(axis));
        });
        strands_.points.push_back(metres_of(point));
      }
    }
    if (strands_.points.size() > strands_.offsets.back()) {
      strands_.end_strand(name_);
    }
    if (reader.left() > 0) {
      strands_.notes.push_back(text_of(reader.left()) +
                               " bytes after the end of the tracks are not read");
    }
  }

  /// Programs that are stopped leave a count of 0.
  void check_count() const {
    if (count_ && *count_ != 0 && *count_ != strands_.count()) {
      refuse("the header's count is " + text_of(*count_) + ", there are " +
             text_of(strands_.count()) + " tracks");
    }
  }

  const std::string_view bytes_;
  const std::string& name_;
  bool has_type_ = false;
  bool is_double_ = false;
  ByteOrder order_ = ByteOrder::LITTLE;
  std::optional<std::size_t> begin_;  // of the tracks [byte]
  std::optional<std::uint64_t> count_;
  Strands strands_;
};

std::string tck_header(std::size_t count) {
  const std::string begin =
      std::string(tck_signature) + "\ndatatype: Float32LE\ncount: " + text_of(count) + "\nfile: . ";
  const std::string end = "\nEND\n";
  std::size_t size = begin.size() + end.size();
  while (begin.size() + text_of(size).size() + end.size() != size) {
    ++size;  // until it counts its own digits
  }
  return begin + text_of(size) + end;
}

void append_three(std::string& bytes, float value) {
  for (int axis = 0; axis < 3; ++axis) {
    append_value(bytes, value);
  }
}

}  // namespace

FiberFile read_tck(std::istream& stream, const std::string& name, const ReadOptions& options) {
  const std::string bytes = read_bytes(stream, name, "a .tck file");
  return to_file(TckReader(bytes, name).read(), options, name, "track");
}

void write_tck(std::ostream& stream, const FiberFile& file) {
  const FiberAssembly& fibers = only_frame(".tck", file).fibers;
  std::string bytes = tck_header(fibers.fiber_count());
  for_each_point(fibers, [&](std::size_t fiber, std::size_t i) {
    append_millimetres(bytes, ".tck", fibers, fiber, i);
    if (i + 1 == fibers.offsets()[fiber + 1]) {
      append_three(bytes, std::numeric_limits<float>::quiet_NaN());
    }
  });
  append_three(bytes, std::numeric_limits<float>::infinity());
  stream << bytes;
}

}  // namespace fiber
