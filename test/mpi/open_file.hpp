#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <vector>

#include "src/mpi/hdf5_file.hpp"

namespace fiber::test {

/// A file of HDF5 that one rank changes.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path)
      : file_(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, "cannot be opened") {}

  hid_t get() const { return file_.get(); }

  void remove(const std::string& path) const {
    require_success(H5Ldelete(file_.get(), path.c_str(), H5P_DEFAULT), "cannot be removed");
  }

  /// Another dataset in place of one.
  template <class T>
  void replace(const std::string& path, Hdf5Shape shape, const std::vector<T>& values) const {
    remove(path);
    const Hdf5Id dataset = create_dataset(file_.get(), path, hdf5_type(T()).file, shape);
    write_rows(dataset.get(), hdf5_type(T()).memory, 0, shape, values.data());
  }

  template <class T>
  void set(const std::string& path, std::uint64_t row, const std::vector<T>& values) const {
    const Hdf5Id dataset = open_dataset(file_.get(), path);
    write_rows(dataset.get(), hdf5_type(T()).memory, row, {1, values.size()}, values.data());
  }

 private:
  const QuietHdf5 quiet_;
  Hdf5Id file_;
};

}  // namespace fiber::test
