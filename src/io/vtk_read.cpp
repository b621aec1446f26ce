// .vtk files, VTK's legacy format: docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include <algorithm>
#include <deque>
#include <utility>

#include "src/io/bytes.hpp"
#include "src/io/fiber_formats.hpp"
#include "src/io/number.hpp"
#include "src/io/strands.hpp"
#include "src/io/vtk_lines.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

std::string in_capitals(std::string_view word) {
  std::string capitals;
  for (const char letter : word) {
    capitals += letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
  }
  return capitals;
}

class VtkReader {
 public:
  VtkReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes), rest_(bytes), name_(name), lines_(name) {}

  Strands read() {
    read_header();
    for (std::string key = next_key(); !key.empty(); key = next_key()) {
      read_part(key);
    }
    if (!has_points_) {
      refuse("has no POINTS");
    }
    lines_.add(piece_);
    return lines_.finish();
  }

 private:
  std::uint64_t position() const { return bytes_.size() - rest_.size(); }

  [[noreturn]] void refuse(const std::string& reason) const {
    throw FileError(name_, reason + ", before byte " + text_of(position()));
  }

  std::string_view take_line() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    return line;
  }

  std::string next_key() { return in_capitals(take_word(rest_)); }

  std::uint64_t next_count(const char* what) {
    const std::string_view word = take_word(rest_);
    const auto count = parse_number<std::uint64_t>(word);
    // Each has a byte at least.
    if (!count || *count > bytes_.size()) {
      refuse(std::string(what) + " is " + quote(word) + ", expected a whole number up to " +
             text_of(bytes_.size()) + ", the size of the file");
    }
    return *count;
  }

  NumberType next_type() {
    constexpr std::pair<std::string_view, NumberType> types[] = {
        {"UNSIGNED_CHAR", NumberType::UINT8}, {"CHAR", NumberType::INT8},
        {"SIGNED_CHAR", NumberType::INT8},    {"UNSIGNED_SHORT", NumberType::UINT16},
        {"SHORT", NumberType::INT16},         {"UNSIGNED_INT", NumberType::UINT32},
        {"INT", NumberType::INT32},           {"UNSIGNED_LONG", NumberType::UINT64},
        {"LONG", NumberType::INT64},          {"FLOAT", NumberType::FLOAT32},
        {"DOUBLE", NumberType::FLOAT64},      {"VTKIDTYPE", NumberType::INT32},
        {"VTKTYPEINT64", NumberType::INT64},  {"VTKTYPEUINT64", NumberType::UINT64}};
    const std::string word = next_key();
    for (const auto& [known, type] : types) {
      if (known == word) {
        return type;
      }
    }
    refuse("the type " + quote(word) + " is not one of numbers");
  }

  void read_header() {
    const std::string_view first = take_line();
    constexpr std::string_view begin = "# vtk DataFile Version ";
    if (first.substr(0, begin.size()) != begin) {
      throw FileError(name_, "is not a .vtk file, which begins with " + quote(begin));
    }
    std::string_view version = first.substr(begin.size());
    version = version.substr(0, version.find('.'));
    has_offsets_ = parse_number<int>(version).value_or(0) >= 5;
    take_line();  // a title
    const std::string encoding = next_key();
    if (encoding != "ASCII" && encoding != "BINARY") {
      refuse("the encoding is " + quote(encoding) + ", expected ASCII or BINARY");
    }
    is_binary_ = encoding == "BINARY";
    std::string key = next_key();
    if (key == "FIELD") {
      read_field();
      key = next_key();
    }
    const std::string type = next_key();
    if (key != "DATASET" || type != "POLYDATA") {
      refuse("has " + quote(key + ' ' + type) + ", expected DATASET POLYDATA");
    }
  }

  void read_part(const std::string& key) {
    if (key == "POINTS") {
      has_points_ = true;
      const std::uint64_t count = next_count("the number of points");
      const std::uint64_t begin = position();
      piece_.points = {take_numbers(next_type(), 3 * count), "POINTS" + at_byte(begin)};
    } else if (key == "LINES") {
      read_lines();
    } else if (key == "VERTICES" || key == "POLYGONS" || key == "TRIANGLE_STRIPS") {
      skip_cells();
    } else if (key == "POINT_DATA" || key == "CELL_DATA") {
      is_of_points_ = key == "POINT_DATA";
      tuples_ = next_count("the number of tuples");
    } else if (key == "METADATA") {
      take_line();
      while (take_line().find_first_not_of(" \r") != std::string_view::npos) {
      }
    } else if (key == "FIELD") {
      read_field();
    } else {
      read_attribute(key);
    }
  }

  /// Version 5 has where lines end, from 0 on, and ids; before, the number of its points leads each
  /// line.
  void read_lines() {
    const std::uint64_t begin = position();
    const std::string place = "LINES" + at_byte(begin);
    const std::uint64_t count = next_count("the number of lines");
    const std::uint64_t size = next_count("the size of the lines");
    std::string& ends = made_.emplace_back();
    std::string& ids = made_.emplace_back();
    if (has_offsets_) {
      const NumberArray offsets = take_named("OFFSETS", count);
      const NumberArray connectivity = take_named("CONNECTIVITY", size);
      if (count > 0 && offsets.whole(0) != 0) {
        refuse("the first of the offsets is " + text_of(offsets.whole(0)) + ", expected 0");
      }
      for (std::uint64_t i = 1; i < count; ++i) {
        append_value(ends, offsets.whole(i));
      }
      piece_.ids = {connectivity, place};
    } else {
      const NumberArray numbers = take_numbers(NumberType::INT32, size);
      std::uint64_t next = 0;
      for (std::uint64_t line = 0; line < count; ++line) {
        const std::int64_t points = next < size ? numbers.whole(next) : -1;
        ++next;
        if (points < 0 || static_cast<std::uint64_t>(points) > size - next) {
          refuse(
              "line " + text_of(line) +
              (next > size ? " begins after" : " has " + text_of(points) + " points, more than") +
              " the " + text_of(size) + " numbers of " + place);
        }
        for (std::int64_t i = 0; i < points; ++i, ++next) {
          append_value(ids, numbers.whole(next));
        }
        append_value(ends, static_cast<std::int64_t>(ids.size() / sizeof(std::int64_t)));
      }
      if (next != size) {
        refuse(text_of(count) + " lines take " + text_of(next) + " numbers of " + place +
               ", there are " + text_of(size));
      }
      piece_.ids = {NumberArray(NumberType::INT64, native_order, ids), place};
    }
    piece_.ends = {NumberArray(NumberType::INT64, native_order, ends), place};
  }

  NumberArray take_named(const char* name, std::uint64_t count) {
    const std::string key = next_key();
    if (key != name) {
      refuse("has " + quote(key) + ", expected " + name);
    }
    const NumberType type = next_type();
    if (!is_whole(type)) {
      refuse(std::string(name) + " must be whole numbers");
    }
    return take_numbers(type, count);
  }

  void skip_cells() {
    const std::uint64_t count = next_count("the number of cells");
    const std::uint64_t size = next_count("the size of the cells");
    if (has_offsets_) {
      take_named("OFFSETS", count);
      take_named("CONNECTIVITY", size);
    } else {
      take_numbers(NumberType::INT32, size);
    }
    lines_.skip_cells(has_offsets_ && count > 0 ? count - 1 : count);
  }

  void read_field() {
    take_word(rest_);  // its name
    const std::uint64_t count = next_count("the number of arrays");
    for (std::uint64_t i = 0; i < count; ++i) {
      std::string_view name = take_word(rest_);
      if (name == "METADATA") {
        read_part("METADATA");
        name = take_word(rest_);
      }
      const std::uint64_t components = next_count("the number of components");
      const std::uint64_t tuples = next_count("the number of tuples");
      take_attribute(name, next_type(), components, tuples);
    }
  }

  void read_attribute(const std::string& key) {
    const std::string_view name = take_word(rest_);
    if (key == "SCALARS") {
      const NumberType type = next_type();
      const std::string_view line = take_line_of_words();
      std::uint64_t components = 1;
      if (!line.empty()) {
        components = parse_number<std::uint64_t>(line).value_or(0);
        if (components < 1 || components > 4) {
          refuse("the number of components of " + quote(name) + " is " + quote(line) +
                 ", expected 1 to 4");
        }
      }
      std::string_view ahead = rest_;
      if (in_capitals(take_word(ahead)) == "LOOKUP_TABLE") {
        rest_ = ahead;
        take_word(rest_);
      }
      take_attribute(name, type, components, tuples_);
    } else if (key == "LOOKUP_TABLE") {
      const std::uint64_t size = next_count("the size of the table");
      take_numbers(is_binary_ ? NumberType::UINT8 : NumberType::FLOAT32, 4 * size);
    } else if (key == "COLOR_SCALARS") {
      const std::uint64_t components = next_count("the number of components");
      take_attribute(name, is_binary_ ? NumberType::UINT8 : NumberType::FLOAT32, components,
                     tuples_);
    } else if (key == "TEXTURE_COORDINATES") {
      const std::uint64_t components = next_count("the number of components");
      take_attribute(name, next_type(), components, tuples_);
    } else if (key == "VECTORS" || key == "NORMALS") {
      take_attribute(name, next_type(), 3, tuples_);
    } else if (key == "TENSORS" || key == "TENSORS6") {
      take_attribute(name, next_type(), key == "TENSORS" ? 9 : 6, tuples_);
    } else if (key == "GLOBAL_IDS" || key == "PEDIGREE_IDS" || key == "EDGE_FLAGS") {
      take_attribute(name, next_type(), 1, tuples_);
    } else {
      refuse("has " + quote(key) + ", which is no part of a file of poly data");
    }
  }

  void take_attribute(std::string_view name, NumberType type, std::uint64_t components,
                      std::uint64_t tuples) {
    const std::uint64_t begin = position();
    if (components > 0 && tuples > bytes_.size() / components) {
      refuse("the array " + quote(name) + " has " + text_of(tuples) + " times " +
             text_of(components) + " numbers, the file " + text_of(bytes_.size()) + " bytes");
    }
    const NumberArray numbers = take_numbers(type, components * tuples);
    const bool is_radius = !piece_.radii && is_radius_name(name);
    const bool is_joint = name == "joint" && is_whole(type);
    if (!is_of_points_ || components != 1 || !(is_radius || is_joint)) {
      lines_.skip_array(name);
      return;
    }
    if (numbers.size() != piece_.points.numbers.size() / 3) {
      refuse("the array " + quote(name) + " has " + text_of(numbers.size()) + " numbers for " +
             text_of(piece_.points.numbers.size() / 3) + " points");
    }
    auto& taken = is_radius ? piece_.radii : piece_.joints;
    taken = {numbers, std::string(name) + at_byte(begin)};
  }

  /// The words up to the line's end, without blanks around them.
  std::string_view take_line_of_words() {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return take_word(line);
  }

  /// Numbers that begin in the next line.
  NumberArray take_numbers(NumberType type, std::uint64_t count) {
    if (is_binary_) {
      take_line();
      if (count > rest_.size() / size_of(type)) {
        refuse("ends before " + text_of(count) + " numbers of " + text_of(size_of(type)) +
               " bytes");
      }
      const std::string_view numbers = rest_.substr(0, count * size_of(type));
      rest_.remove_prefix(numbers.size());
      return {type, ByteOrder::BIG, numbers};
    }
    std::string& bytes = made_.emplace_back();
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::string_view word = take_word(rest_);
      if (word.empty()) {
        refuse("ends before number " + text_of(i + 1) + " of " + text_of(count));
      }
      if (append_numbers(bytes, type, word)) {
        refuse("has " + quote(word) + ", expected a number");
      }
    }
    return {type_in_memory(type), native_order, bytes};
  }

  const std::string_view bytes_;
  std::string_view rest_;
  const std::string& name_;
  bool is_binary_ = false;
  bool has_offsets_ = false;
  bool has_points_ = false;
  bool is_of_points_ = false;     // the attributes
  std::uint64_t tuples_ = 0;      // of the attributes
  std::deque<std::string> made_;  // numbers that do not stand in the file as they are in memory
  VtkPiece piece_{{},
                  {},
                  {},
                  {NumberArray(NumberType::INT64, native_order, ""), "LINES"},
                  {NumberArray(NumberType::INT64, native_order, ""), "LINES"}};
  VtkLines lines_;
};

}  // namespace

FiberFile read_vtk(std::istream& stream, const std::string& name, const ReadOptions& options) {
  const std::string bytes = read_bytes(stream, name, "a .vtk file");
  return to_file(VtkReader(bytes, name).read(), options, name, "line");
}

}  // namespace fiber
