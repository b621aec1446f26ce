#pragma once

#include <ros/serialization.h>

#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace fiber::test {

/// Bytes that are no message.
struct NoMessage : std::runtime_error {
  NoMessage() : std::runtime_error("the bytes end before the message") {}
};

/// Takes messages out of bytes, in ROS's own format. ROS's stream makes room for as many elements
/// as a length says before it looks whether they are there, which is no finding about us; this one
/// makes room as they come.
class MessageStream {
 public:
  MessageStream(const std::uint8_t* data, std::size_t size) : next_(data), end_(data + size) {}

  template <class Message>
  Message read() {
    Message message;
    next(message);
    return message;
  }

  // What the generated code of messages calls for each field.
  template <class Value>
  void next(Value& value) {
    if constexpr (std::is_arithmetic_v<Value>) {
      std::memcpy(&value, take(sizeof value), sizeof value);
    } else {
      ros::serialization::Serializer<Value>::read(*this, value);
    }
  }
  void next(std::string& text) {
    const std::size_t size = length();
    text.assign(reinterpret_cast<const char*>(take(size)), size);
  }
  template <class Element, class Allocator>
  void next(std::vector<Element, Allocator>& elements) {
    const std::size_t size = length();
    elements.clear();
    while (elements.size() < size) {
      Element element{};
      next(element);
      elements.push_back(std::move(element));
    }
  }
  template <class Element, std::size_t size>
  void next(boost::array<Element, size>& elements) {
    for (Element& element : elements) {
      next(element);
    }
  }

 private:
  const std::uint8_t* take(std::size_t size) {
    if (static_cast<std::size_t>(end_ - next_) < size) {
      throw NoMessage();
    }
    next_ += size;
    return next_ - size;
  }
  std::size_t length() {
    std::uint32_t length = 0;
    next(length);
    return length;
  }

  const std::uint8_t* next_;
  const std::uint8_t* end_;
};

}  // namespace fiber::test
