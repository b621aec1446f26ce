#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/number.hpp"
#include "src/text/csv_field.hpp"

namespace fiber {

/// A fibre, by its name where it has one.
struct FiberCalled {
  const FiberNames& names;
  std::uint64_t fiber;
};

/// The number of a frame, if its file has numbers.
struct FrameNumber {
  bool is_given;
  std::int64_t number;
};

/// Lines on their way to a stream or elsewhere, written piece by piece: a frame may have millions
/// of them.
class TextOutput {
 public:
  static constexpr std::size_t max_piece = 65'536;  // [byte]

  /// Takes the pieces of the text in their order, each of at most max_piece bytes. What it throws,
  /// the functions that write throw.
  using Sink = std::function<void(std::string_view piece)>;

  explicit TextOutput(Sink sink) : sink_(std::move(sink)) {}

  /// The functions that write throw std::runtime_error where the stream fails.
  explicit TextOutput(std::ostream& stream)
      : TextOutput([&stream](std::string_view piece) {
          if (!stream.write(piece.data(), static_cast<std::streamsize>(piece.size()))) {
            throw std::runtime_error("the output cannot be written");
          }
        }) {}

  void write(std::string_view text) {
    text_ += text;
    if (text_.size() >= max_piece) {
      flush();
    }
  }

  /// A line of CSV. A vector is three fields, a flag 1 or 0, no number of a frame no field; numbers
  /// are the shortest decimals that read back as the same.
  template <class... Fields>
  void write_row(const Fields&... fields) {
    (append(fields), ...);
    text_.back() = '\n';
    write("");
  }

  /// A line with one JSON value.
  void write_line(const nlohmann::ordered_json& value) { write(text_of_json(value) + '\n'); }

  /// A line with one JSON object that ends with a list, which is never in memory as text.
  /// @param object  what stands before the list
  /// @param to_json makes JSON of an item
  template <class Items, class ToJson>
  void write_object(nlohmann::ordered_json object, const char* list, const Items& items,
                    const ToJson& to_json) {
    begin_object(std::move(object), list);
    write_items(items, to_json, true);
    end_object();
  }

  // A JSON object with a list may also be written in pieces, by several one after another.

  void begin_object(nlohmann::ordered_json object, const char* list) {
    object[list] = nlohmann::ordered_json::array();
    const std::string empty = object.dump() + '\n';
    write(std::string_view(empty).substr(0, empty.size() - end_of_object.size()));
  }

  /// @param is_first whether the list has no item yet
  template <class Items, class ToJson>
  void write_items(const Items& items, const ToJson& to_json, bool is_first) {
    for (const auto& item : items) {
      write((std::exchange(is_first, false) ? "" : ",") + text_of_json(to_json(item)));
    }
  }

  void end_object() { write(end_of_object); }

  void flush() {
    for (std::size_t begin = 0; begin < text_.size(); begin += max_piece) {
      sink_(std::string_view(text_).substr(begin, max_piece));
    }
    text_.clear();
  }

 private:
  static constexpr std::string_view end_of_object = "]}\n";

  /// JSON is UTF-8: what is none in a name becomes U+FFFD.
  static std::string text_of_json(const nlohmann::ordered_json& value) {
    return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  }

  template <class Number>
  void append(const Number& number) {
    append_number(text_, number);
    text_ += ',';
  }
  void append(bool flag) { text_ += flag ? "1," : "0,"; }
  void append(const std::string& word) { text_ += word + ','; }
  void append(const FiberCalled& called) {
    if (called.names.are_indices()) {
      append_number(text_, called.fiber);
    } else {
      append_csv_field(text_, called.names.of(called.fiber));
    }
    text_ += ',';
  }
  void append(const Eigen::Vector3d& vector) {
    for (const double coordinate : {vector.x(), vector.y(), vector.z()}) {
      append(coordinate);
    }
  }
  void append(const FrameNumber& frame) {
    if (frame.is_given) {
      append(frame.number);
    }
  }

  const Sink sink_;
  std::string text_;
};

/// A JSON object that begins with the frame's number, if it has one.
inline nlohmann::ordered_json object_of(const FrameNumber& frame) {
  nlohmann::ordered_json object;
  if (frame.is_given) {
    object["frame"] = frame.number;
  }
  return object;
}

/// A name that is a whole number is a number in JSON, any other one text.
inline nlohmann::ordered_json json_of(const FiberCalled& called) {
  if (called.names.are_indices()) {
    return called.fiber;
  }
  constexpr std::int64_t max = 9'007'199'254'740'992;  // 2⁵³: others read it as a double
  std::string name = called.names.of(called.fiber);
  const auto number = parse_number<std::int64_t>(name);
  if (number && *number > -max && *number < max && text_of(*number) == name) {
    return *number;
  }
  return name;
}

inline nlohmann::ordered_json list_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace fiber
