#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace fiber {

/// The members of a zip archive.
class ZipArchive {
 public:
  struct Member {
    std::string_view name;
    std::uint64_t byte = 0;      ///< where it begins in the archive
    std::string_view packed;     ///< as it stands there
    std::uint64_t size = 0;      ///< unpacked [byte]
    std::uint32_t checksum = 0;  ///< of what is unpacked
    bool is_deflated = false;
  };

  /// @param bytes of the archive; they stay where they are, and so does the name
  /// @param name  what errors call it
  /// @throws FileError
  ZipArchive(std::string_view bytes, const std::string& name);

  const std::vector<Member>& members() const { return members_; }

  /// Unpacks the content of a member.
  /// @throws FileError for one that is damaged
  std::string unpack(const Member& member) const;

 private:
  [[noreturn]] void refuse(const std::string& reason, std::uint64_t byte) const;
  std::uint64_t find_end() const;
  std::uint64_t number(std::uint64_t byte, std::size_t size) const;
  std::string_view part(std::uint64_t byte, std::uint64_t size, const char* what) const;
  std::uint64_t read_entry(std::uint64_t byte);

  const std::string_view bytes_;
  const std::string& name_;
  std::vector<Member> members_;
};

/// Puts together a zip archive of members that are stored as they are.
class ZipWriter {
 public:
  void add(const std::string& name, const std::string& content);

  /// The bytes of the archive.
  std::string finish() const;

 private:
  std::string bytes_;
  std::string directory_;
  std::uint16_t count_ = 0;
};

}  // namespace fiber
