#include "src/io/input_file.hpp"

#include <cerrno>
#include <utility>

#include "src/text/quote.hpp"

namespace fiber {

std::ifstream open_to_read(const std::string& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw FileError::from_system(path, "cannot be opened");
  }
  return stream;
}

LineReader::LineReader(std::istream& stream, std::string name)
    : stream_(stream), name_(std::move(name)), buffer_(longest_line + 2) {
  errno = 0;
}

bool LineReader::next(std::string_view& line) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  // Takes at most one character less than that, with a line's end one more.
  stream_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  if (stream_.bad()) {
    throw FileError::from_system(name_, "cannot be read");
  }
  const auto taken = static_cast<std::size_t>(stream_.gcount());
  if (taken == 0) {
    return false;
  }
  ++line_;
  const bool has_end = !stream_.eof() && !stream_.fail();
  line = {buffer_.data(), has_end ? taken - 1 : taken};
  if (line.size() > longest_line) {
    throw FileError(name_, line_,
                    "is longer than " + std::to_string(longest_line) + " bytes and begins with " +
                        quote(line.substr(0, 40)));
  }
  if (line_ == 1 && line.substr(0, mark.size()) == mark) {
    line.remove_prefix(mark.size());
  }
  return true;
}

void check_fields(const std::vector<std::string_view>& fields, const std::string& name,
                  std::size_t line) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i].size() > longest_field) {
      throw FileError(name, line,
                      "value " + std::to_string(i + 1) + " has " +
                          std::to_string(fields[i].size()) + " bytes, at most " +
                          std::to_string(longest_field) + " are allowed: " + quote(fields[i]));
    }
  }
}

}  // namespace fiber
