#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/hdf5_file.hpp"

namespace fiber {

/// The datasets of a frame that is written. All ranks make them alike, then each writes its rows.
class FrameDatasets {
 public:
  /// Makes a dataset. Collective.
  /// @param rows of this rank
  /// @param fill called by write() with a RowWriter, to which it appends the rows of this rank
  template <class T, std::size_t columns = 1, class Fill>
  void add(hid_t place, const std::string& name, const RankShare& rows, const Fill& fill) {
    const auto writer = std::make_shared<RowWriter<T, columns>>(place, name, rows.all, rows.before);
    writes_.push_back([writer, fill] {
      fill(*writer);
      writer->flush();
    });
  }

  /// Writes the rows of this rank, dataset by dataset.
  void write() const {
    for (const std::function<void()>& write_rows : writes_) {
      write_rows();
    }
  }

  void close() { writes_.clear(); }

 private:
  std::vector<std::function<void()>> writes_;
};

}  // namespace fiber
