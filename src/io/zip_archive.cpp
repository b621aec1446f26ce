// Zip archives: pkware.cachefly.net/webdocs/casestudies/APPNOTE.TXT
#include "src/io/zip_archive.hpp"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "fiber_proximity/io/file.hpp"
#include "src/io/bytes.hpp"
#include "src/io/inflate.hpp"
#include "src/io/number.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::uint64_t member_mark = 0x0403'4b50;
constexpr std::uint64_t entry_mark = 0x0201'4b50;
constexpr std::uint64_t end_mark = 0x0605'4b50;
constexpr std::uint64_t long_locator_mark = 0x0706'4b50;
constexpr std::uint64_t long_end_mark = 0x0606'4b50;
constexpr std::uint64_t member_size = 30;         // [byte] without name and extra fields
constexpr std::uint64_t entry_size = 46;          // [byte]
constexpr std::uint64_t end_size = 22;            // [byte]
constexpr std::uint64_t locator_size = 20;        // [byte]
constexpr std::uint64_t too_large = 0xffff'ffff;  // a field that stands in an extra one instead
constexpr std::uint16_t version = 20;

std::uint32_t checksum_of(std::string_view bytes) {
  uLong checksum = crc32(0, nullptr, 0);
  constexpr std::size_t piece = std::size_t{1} << 30U;  // zlib counts with 32 bits
  for (std::size_t i = 0; i < bytes.size(); i += piece) {
    checksum = crc32(checksum, reinterpret_cast<const Bytef*>(bytes.data() + i),
                     static_cast<uInt>(std::min(piece, bytes.size() - i)));
  }
  return static_cast<std::uint32_t>(checksum);
}

}  // namespace

ZipArchive::ZipArchive(std::string_view bytes, const std::string& name)
    : bytes_(bytes), name_(name) {
  const std::uint64_t end = find_end();
  std::uint64_t count = number(end + 10, 2);
  std::uint64_t begin = number(end + 16, 4);
  if (end >= locator_size && number(end - locator_size, 4) == long_locator_mark) {
    const std::uint64_t long_end = number(end - locator_size + 8, 8);
    if (number(long_end, 4) != long_end_mark) {
      refuse("the archive's long end is not where its locator says", long_end);
    }
    count = number(long_end + 32, 8);
    begin = number(long_end + 48, 8);
  }
  if (count > bytes.size() / entry_size) {
    refuse("the archive tells of " + text_of(count) + " members", end + 10);
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    begin = read_entry(begin);
  }
}

void ZipArchive::refuse(const std::string& reason, std::uint64_t byte) const {
  throw FileError(name_, reason + at_byte(byte));
}

/// The archive's end, before which its comment may stand.
std::uint64_t ZipArchive::find_end() const {
  if (bytes_.substr(0, 2) != "PK" || bytes_.size() < end_size) {
    throw FileError(name_, "is no zip archive, which begins with the letters PK");
  }
  constexpr std::uint64_t max_comment = 0xffff;
  const std::uint64_t last = bytes_.size() - end_size;
  for (std::uint64_t byte = last + 1; byte-- > 0 && last - byte <= max_comment;) {
    if (number(byte, 4) == end_mark && number(byte + 20, 2) == last - byte) {
      return byte;
    }
  }
  throw FileError(name_, "is a zip archive without its end, of " +
                             text_of(std::uint64_t{bytes_.size()}) + " bytes");
}

std::string_view ZipArchive::part(std::uint64_t byte, std::uint64_t size, const char* what) const {
  if (byte > bytes_.size() || size > bytes_.size() - byte) {
    refuse(std::string(what) + " lies beyond the file, which has " +
               text_of(std::uint64_t{bytes_.size()}) + " bytes",
           byte);
  }
  return bytes_.substr(byte, size);
}

std::uint64_t ZipArchive::number(std::uint64_t byte, std::size_t size) const {
  const char* const at = part(byte, size, "a field of the archive").data();
  return size == 2   ? value_at<std::uint16_t>(at, ByteOrder::LITTLE)
         : size == 4 ? value_at<std::uint32_t>(at, ByteOrder::LITTLE)
                     : value_at<std::uint64_t>(at, ByteOrder::LITTLE);
}

/// @return where the next entry of the directory begins
std::uint64_t ZipArchive::read_entry(std::uint64_t byte) {
  if (number(byte, 4) != entry_mark) {
    refuse("there is no entry of the archive's directory", byte);
  }
  const std::uint64_t method = number(byte + 10, 2);
  std::uint64_t packed_size = number(byte + 20, 4);
  Member member;
  member.size = number(byte + 24, 4);
  member.byte = number(byte + 42, 4);
  member.checksum = static_cast<std::uint32_t>(number(byte + 16, 4));
  member.is_deflated = method == 8;
  const std::uint64_t name_end = byte + entry_size + number(byte + 28, 2);
  member.name = part(byte + entry_size, number(byte + 28, 2), "a member's name");
  const std::uint64_t extra_end = name_end + number(byte + 30, 2);
  for (std::uint64_t extra = name_end; extra + 4 <= extra_end;) {
    const std::uint64_t next = extra + 4 + number(extra + 2, 2);
    std::uint64_t field = extra + 4;
    if (number(extra, 2) == 1) {
      for (std::uint64_t* const value : {&member.size, &packed_size, &member.byte}) {
        if (*value == too_large && field + 8 <= next) {
          *value = number(field, 8);
          field += 8;
        }
      }
    }
    extra = next;
  }
  if ((number(byte + 8, 2) & 1U) != 0 || (method != 0 && method != 8)) {
    refuse("the member " + quote(member.name) +
               " is encrypted or packed by another method than stored and deflated",
           byte);
  }
  if (number(member.byte, 4) != member_mark) {
    refuse("the member " + quote(member.name) + " is not where the directory says", member.byte);
  }
  const std::uint64_t begin =
      member.byte + member_size + number(member.byte + 26, 2) + number(member.byte + 28, 2);
  member.packed = part(begin, packed_size, "a member");
  member.byte = begin;
  members_.push_back(member);
  return extra_end + number(byte + 32, 2);
}

std::string ZipArchive::unpack(const Member& member) const {
  std::string content;
  std::string problem;
  if (member.is_deflated) {
    problem = inflate(content, member.packed, member.size, Deflated::RAW);
  } else {
    content = member.packed;
    problem = content.size() == member.size ? ""
                                            : "it has " + text_of(std::uint64_t{content.size()}) +
                                                  " bytes, " + text_of(member.size) + " are told";
  }
  if (problem.empty() && checksum_of(content) != member.checksum) {
    problem = "its checksum is another one than is told";
  }
  if (!problem.empty()) {
    refuse("the member " + quote(member.name) + ": " + problem, member.byte);
  }
  return content;
}

void ZipWriter::add(const std::string& name, const std::string& content) {
  if (bytes_.size() + content.size() >= too_large) {
    throw std::invalid_argument("a zip archive of 4 GiB and more is not written");
  }
  std::string common;  // to both headers
  append_value(common, version);
  append_value(common, std::uint16_t{0});     // flags
  append_value(common, std::uint16_t{0});     // stored
  append_value(common, std::uint16_t{0});     // no time: the same fibres make the same file
  append_value(common, std::uint16_t{0x21});  // 1980-01-01
  append_value(common, checksum_of(content));
  append_value(common, static_cast<std::uint32_t>(content.size()));
  append_value(common, static_cast<std::uint32_t>(content.size()));
  append_value(common, static_cast<std::uint16_t>(name.size()));
  append_value(common, std::uint16_t{0});  // extra fields
  append_value(directory_, static_cast<std::uint32_t>(entry_mark));
  append_value(directory_, version);
  directory_ += common + std::string(10, '\0');  // no comment, first disk, no attributes
  append_value(directory_, static_cast<std::uint32_t>(bytes_.size()));
  directory_ += name;
  append_value(bytes_, static_cast<std::uint32_t>(member_mark));
  bytes_ += common + name + content;
  ++count_;
}

std::string ZipWriter::finish() const {
  std::string bytes = bytes_ + directory_;
  append_value(bytes, static_cast<std::uint32_t>(end_mark));
  append_value(bytes, std::uint32_t{0});  // disks
  append_value(bytes, count_);
  append_value(bytes, count_);
  append_value(bytes, static_cast<std::uint32_t>(directory_.size()));
  append_value(bytes, static_cast<std::uint32_t>(bytes_.size()));
  append_value(bytes, std::uint16_t{0});  // comment
  return bytes;
}

}  // namespace fiber
