// .vtp files, VTK's poly data in XML: docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include <tinyxml2.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <limits>
#include <utility>

#include "src/io/bytes.hpp"
#include "src/io/fiber_formats.hpp"
#include "src/io/number.hpp"
#include "src/io/strands.hpp"
#include "src/io/vtk_blocks.hpp"
#include "src/io/vtk_lines.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using tinyxml2::XMLElement;

std::string_view attribute(const XMLElement& element, const char* name) {
  const char* const value = element.Attribute(name);
  return value == nullptr ? "" : value;
}

/// Calls visit(element) with the elements in another, of a name or of all where it is nullptr.
template <class Visit>
void for_each_child(const XMLElement* parent, const char* name, const Visit& visit) {
  const XMLElement* child = parent == nullptr ? nullptr : parent->FirstChildElement(name);
  for (; child != nullptr; child = child->NextSiblingElement(name)) {
    visit(*child);
  }
}

class VtpReader {
 public:
  VtpReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), lines_(name) {}

  Strands read() {
    parse();
    const XMLElement& root = *document_.RootElement();
    read_encoding(root);
    const XMLElement* const data = root.FirstChildElement("PolyData");
    if (data == nullptr) {
      refuse(root, "there is no element PolyData");
    }
    for_each_child(data, "Piece", [&](const XMLElement& piece) { read_piece(piece); });
    return lines_.finish();
  }

 private:
  [[noreturn]] void refuse(const XMLElement& element, const std::string& reason) const {
    throw FileError(name_, static_cast<std::size_t>(element.GetLineNum()), reason);
  }

  /// Takes the XML apart. What is appended, which need not be XML, stays where it is.
  void parse() {
    constexpr std::string_view tag = "<AppendedData";
    std::string_view text = bytes_;
    std::string cut;
    const std::size_t begin = bytes_.find(tag);
    if (begin != std::string_view::npos) {
      const std::size_t end = std::min(bytes_.find('>', begin), bytes_.size());
      appended_ = bytes_.substr(end);
      appended_.remove_prefix(std::min(appended_.find('_'), appended_.size()));
      appended_.remove_prefix(appended_.empty() ? 0 : 1);
      cut = std::string(bytes_.substr(0, end)) + "/></VTKFile>";
      text = cut;
    }
    if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      throw FileError(name_, static_cast<std::size_t>(std::max(1, document_.ErrorLineNum())),
                      std::string("is no XML: ") + document_.ErrorName());
    }
    const XMLElement* const root = document_.RootElement();
    if (root == nullptr || std::strcmp(root->Name(), "VTKFile") != 0) {
      throw FileError(name_, "is not a .vtp file, whose first element is VTKFile");
    }
  }

  void read_encoding(const XMLElement& root) {
    const auto value_of = [&](const char* name, const std::vector<std::string_view>& known) {
      const std::string_view value = attribute(root, name);
      if (std::find(known.begin(), known.end(), value) == known.end()) {
        std::string all;
        for (const std::string_view one : known) {
          all += one.empty() ? "" : (all.empty() ? "" : " or ") + std::string(one);
        }
        refuse(root, std::string(name) + " is " + quote(value) + ", expected " + all);
      }
      return value;
    };
    value_of("type", {"PolyData"});
    encoding_.order = value_of("byte_order", {"LittleEndian", "BigEndian", ""}) == "BigEndian"
                          ? ByteOrder::BIG
                          : ByteOrder::LITTLE;
    encoding_.has_long_counts = value_of("header_type", {"UInt32", "UInt64", ""}) == "UInt64";
    encoding_.is_compressed = !value_of("compressor", {"vtkZLibDataCompressor", ""}).empty();
    if (const XMLElement* const appended = root.FirstChildElement("AppendedData")) {
      const std::string_view encoding = attribute(*appended, "encoding");
      if (encoding != "raw" && encoding != "base64") {
        refuse(*appended, "encoding is " + quote(encoding) + ", expected raw or base64");
      }
      is_appended_base64_ = encoding == "base64";
    }
  }

  std::uint64_t count_in(const XMLElement& piece, const char* name) const {
    const std::string_view text = attribute(piece, name);
    const auto count = parse_number<std::uint64_t>(text);
    constexpr std::uint64_t max_count = std::numeric_limits<std::uint64_t>::max() / 64;
    if (!text.empty() && !(count && *count < max_count)) {
      refuse(piece, std::string(name) + " is " + quote(text) + ", expected a whole number");
    }
    return count.value_or(0);
  }

  void read_piece(const XMLElement& element) {
    for (const char* const cells : {"NumberOfVerts", "NumberOfStrips", "NumberOfPolys"}) {
      lines_.skip_cells(count_in(element, cells));
    }
    const std::uint64_t point_count = count_in(element, "NumberOfPoints");
    const std::uint64_t line_count = count_in(element, "NumberOfLines");
    VtkPiece piece;
    read_point_data(element, point_count, piece);
    for_each_child(element.FirstChildElement("CellData"), nullptr,
                   [&](const XMLElement& array) { lines_.skip_array(attribute(array, "Name")); });
    const XMLElement* const points = element.FirstChildElement("Points");
    piece.points =
        read_array(element, points == nullptr ? nullptr : points->FirstChildElement("DataArray"),
                   "Points", 3, point_count);
    piece.ends = read_array(element, line_array(element, "offsets"), "offsets", 1, line_count);
    piece.ids =
        read_array(element, line_array(element, "connectivity"), "connectivity", 1, std::nullopt);
    if (!is_whole(piece.ends.numbers.type()) || !is_whole(piece.ids.numbers.type()) ||
        (piece.joints && !is_whole(piece.joints->numbers.type()))) {
      refuse(element, "the arrays offsets, connectivity and joint must be of whole numbers");
    }
    lines_.add(piece);
    decoded_.clear();
  }

  void read_point_data(const XMLElement& element, std::uint64_t point_count, VtkPiece& piece) {
    for_each_child(element.FirstChildElement("PointData"), nullptr, [&](const XMLElement& array) {
      const std::string name(attribute(array, "Name"));
      if (!piece.radii && is_radius_name(name)) {
        piece.radii = read_array(element, &array, name.c_str(), 1, point_count);
      } else if (name == "joint") {
        piece.joints = read_array(element, &array, name.c_str(), 1, point_count);
      } else {
        lines_.skip_array(name);
      }
    });
  }

  static const XMLElement* line_array(const XMLElement& piece, std::string_view name) {
    const XMLElement* found = nullptr;
    for_each_child(piece.FirstChildElement("Lines"), "DataArray", [&](const XMLElement& array) {
      found = attribute(array, "Name") == name ? &array : found;
    });
    return found;
  }

  /// @param element nullptr if there is none, which is right for an array of nothing
  /// @param count   of tuples; nothing: any
  VtkArray read_array(const XMLElement& piece, const XMLElement* element, const char* name,
                      std::uint64_t components, std::optional<std::uint64_t> count) {
    if (element == nullptr) {
      if (count.value_or(0) > 0) {
        refuse(piece, std::string("there is no array ") + name);
      }
      return {NumberArray(NumberType::INT64, native_order, ""), name};
    }
    const std::string_view told = attribute(*element, "NumberOfComponents");
    if ((told.empty() ? "1" : told) != text_of(components)) {
      refuse(*element, std::string("NumberOfComponents of ") + name + " is " + quote(told) +
                           ", expected " + text_of(components));
    }
    const VtkArray array{numbers_of(*element),
                         std::string(name) + ", line " + text_of(element->GetLineNum())};
    if (count && array.numbers.size() != *count * components) {
      refuse(*element, std::string(name) + " has " + text_of(array.numbers.size()) +
                           " numbers, expected " + text_of(*count * components));
    }
    return array;
  }

  NumberArray numbers_of(const XMLElement& element) {
    const NumberType type = type_of(element);
    const std::string_view format = attribute(element, "format");
    std::string& bytes = decoded_.emplace_back();
    // Errors quote words of this text, so it outlives them.
    const std::string inline_text = format == "appended" ? "" : text_in(element);
    if (format == "ascii") {
      if (const auto wrong = append_numbers(bytes, type, inline_text)) {
        refuse(element, "has " + quote(*wrong) + ", expected a number");
      }
      return {type_in_memory(type), native_order, bytes};
    }
    VtkEncoding encoding = encoding_;
    encoding.is_base64 = format != "appended" || is_appended_base64_;
    const std::string_view text =
        format == "binary" ? std::string_view(inline_text) : appended_at(element);
    try {
      bytes = decode_array(text, encoding);
    } catch (const std::runtime_error& error) {
      refuse(element, std::string("the data ") + error.what());
    }
    if (bytes.size() % size_of(type) != 0) {
      refuse(element, "the data has " + text_of(bytes.size()) + " bytes, which are no " +
                          std::string(attribute(element, "type")));
    }
    return {type, encoding.order, bytes};
  }

  std::string_view appended_at(const XMLElement& element) const {
    const std::string_view format = attribute(element, "format");
    if (format != "appended") {
      refuse(element, "format is " + quote(format) + ", expected ascii, binary or appended");
    }
    const std::string_view text = attribute(element, "offset");
    const auto offset = parse_number<std::uint64_t>(text);
    if (!offset || *offset > appended_.size()) {
      refuse(element, "offset is " + quote(text) + ", expected 0 to " + text_of(appended_.size()) +
                          ", as many bytes are appended");
    }
    return appended_.substr(*offset);
  }

  /// Information for people may stand before and after the numbers.
  static std::string text_in(const XMLElement& element) {
    std::string text;
    for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr;
         node = node->NextSibling()) {
      text += node->ToText() == nullptr ? " " : node->Value();
    }
    return text;
  }

  NumberType type_of(const XMLElement& element) const {
    constexpr std::pair<std::string_view, NumberType> types[] = {
        {"Int8", NumberType::INT8},       {"UInt8", NumberType::UINT8},
        {"Int16", NumberType::INT16},     {"UInt16", NumberType::UINT16},
        {"Int32", NumberType::INT32},     {"UInt32", NumberType::UINT32},
        {"Int64", NumberType::INT64},     {"UInt64", NumberType::UINT64},
        {"Float32", NumberType::FLOAT32}, {"Float64", NumberType::FLOAT64}};
    const std::string_view name = attribute(element, "type");
    for (const auto& [known, type] : types) {
      if (known == name) {
        return type;
      }
    }
    refuse(element, "type is " + quote(name) + ", expected Int8 to UInt64, Float32 or Float64");
  }

  const std::string_view bytes_;
  const std::string& name_;
  tinyxml2::XMLDocument document_;
  std::string_view appended_;  // from its first byte on
  bool is_appended_base64_ = false;
  VtkEncoding encoding_;
  std::deque<std::string> decoded_;  // arrays of the piece, where they stay
  VtkLines lines_;
};

}  // namespace

FiberFile read_vtp(std::istream& stream, const std::string& name, const ReadOptions& options) {
  const std::string bytes = read_bytes(stream, name, "a .vtp file");
  return to_file(VtpReader(bytes, name).read(), options, name, "line");
}

}  // namespace fiber
