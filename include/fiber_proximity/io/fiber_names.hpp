#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace fiber {

/// What fibres are called, by index. Fibres without names of their own are called by their indices,
/// which takes no memory. Copies share the names.
class FiberNames {
 public:
  static constexpr std::size_t longest_name = 4'096;  ///< [byte]

  FiberNames() = default;

  /// @param names one per fibre, each another one, any text of one line; 0, 1, 2, … in this order
  ///              are the indices
  /// @throws std::invalid_argument for a name that is empty, longer than longest_name, of several
  ///         lines or given twice
  explicit FiberNames(std::vector<std::string> names);

  bool are_indices() const { return names_ == nullptr; }

  /// How many there are; 0 if they are indices, of which there are as many as fibres.
  std::size_t size() const { return names_ == nullptr ? 0 : names_->size(); }

  /// What a fibre is called.
  /// @param fiber below size(), unless names are indices
  std::string of(std::uint64_t fiber) const {
    return names_ == nullptr ? std::to_string(fiber) : (*names_)[fiber];
  }

  /// All of them.
  std::vector<std::string> list(std::size_t fiber_count) const;

  /// Those of some fibres, in this order.
  FiberNames select(const std::vector<std::uint32_t>& fibers) const;

  bool operator==(const FiberNames& other) const {
    return names_ == other.names_ ||
           (names_ != nullptr && other.names_ != nullptr && *names_ == *other.names_);
  }
  bool operator!=(const FiberNames& other) const { return !(*this == other); }

 private:
  std::shared_ptr<const std::vector<std::string>> names_;  // null: indices
};

}  // namespace fiber
