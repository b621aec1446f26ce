#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/mpi/communicator.hpp"

// Wrappers of HDF5's C interface. A failure throws std::runtime_error with HDF5's own reason.

namespace fiber {

/// While it lives, HDF5 prints nothing of errors; then again as before.
class QuietHdf5 {
 public:
  QuietHdf5();
  ~QuietHdf5();
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Something open in HDF5, closed at the end.
class Hdf5Id {
 public:
  using Close = herr_t (*)(hid_t);

  /// @param what was done to get the id, for the error
  /// @throws std::runtime_error for an id that says that it failed
  Hdf5Id(hid_t id, Close closing, const std::string& what);
  ~Hdf5Id();
  Hdf5Id(Hdf5Id&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Id& operator=(Hdf5Id&&) = delete;

  hid_t get() const { return id_; }

  /// Closes it as the destructor does, and reports errors.
  /// @throws std::runtime_error
  void close(const std::string& what);

 private:
  hid_t id_;
  Close close_;
};

/// @throws std::runtime_error for a result of HDF5 that says that it failed
void require_success(herr_t result, const std::string& what);

/// The file of all ranks, new and empty. Collective.
/// @throws std::runtime_error
Hdf5Id create_parallel_file(const Communicator& ranks, const std::string& path);

/// The file for all ranks, to read. Collective.
/// @throws std::runtime_error
Hdf5Id open_parallel_file(const Communicator& ranks, const std::string& path);

Hdf5Id create_group(hid_t place, const std::string& name);
Hdf5Id open_group(hid_t place, const std::string& name);
bool has_link(hid_t place, const std::string& name);

void write_numbers(hid_t place, const std::string& name, const std::vector<std::int64_t>& values);
void write_real(hid_t place, const std::string& name, double value);
void write_text(hid_t place, const std::string& name, const std::string& text);

/// Nothing if there is none of this name, or of another kind.
std::optional<std::int64_t> read_number(hid_t place, const std::string& name);
std::optional<double> read_real(hid_t place, const std::string& name);
std::optional<std::string> read_text(hid_t place, const std::string& name);

/// In memory, and in a file: little-endian, so that files are the same everywhere.
struct Hdf5Type {
  hid_t memory;
  hid_t file;
};
Hdf5Type hdf5_type(double);
Hdf5Type hdf5_type(std::int64_t);
Hdf5Type hdf5_type(std::uint64_t);
Hdf5Type hdf5_type(std::uint8_t);

/// The size of a dataset. When it is made, space is taken and nothing is filled in.
struct Hdf5Shape {
  std::uint64_t rows = 0;
  std::uint64_t columns = 1;  // 1: no dimension of its own
};

/// Collective, as all that changes what is in a file.
Hdf5Id create_dataset(hid_t place, const std::string& name, hid_t file_type, Hdf5Shape shape);
Hdf5Id open_dataset(hid_t place, const std::string& name);

/// A dataset that holds nothing itself: it shows the rows of others in its file, one after another.
Hdf5Id create_view(hid_t place, const std::string& name, hid_t file_type,
                   const std::vector<std::string>& paths, Hdf5Shape of_each);

/// Another name, `path`, for a dataset of a group.
void link_dataset(hid_t group, const std::string& name, hid_t place, const std::string& path);

Hdf5Shape shape_of(hid_t dataset);

/// Rows of a dataset from `first` on, by this rank alone.
void write_rows(hid_t dataset, hid_t memory_type, std::uint64_t first, Hdf5Shape part,
                const void* values);
void read_rows(hid_t dataset, hid_t memory_type, std::uint64_t first, Hdf5Shape part, void* values);

/// Writes consecutive rows of a dataset in slices, so that they are never in memory as a whole.
template <class T, std::size_t columns = 1>
class RowWriter {
 public:
  /// @param first of its rows
  RowWriter(hid_t place, const std::string& name, std::uint64_t all_rows, std::uint64_t first)
      : dataset_(create_dataset(place, name, hdf5_type(T()).file, {all_rows, columns})),
        next_(first) {}

  template <class... Values>
  void append(const Values&... values) {
    static_assert(sizeof...(values) == columns);
    (values_.push_back(values), ...);
    if (values_.size() >= slice * columns) {
      flush();
    }
  }

  void flush() {
    const std::uint64_t rows = values_.size() / columns;
    write_rows(dataset_.get(), hdf5_type(T()).memory, next_, {rows, columns}, values_.data());
    next_ += rows;
    values_.clear();
  }

 private:
  static constexpr std::size_t slice = std::size_t{1} << 15U;  // [row]

  Hdf5Id dataset_;
  std::uint64_t next_;
  std::vector<T> values_;
};

}  // namespace fiber
