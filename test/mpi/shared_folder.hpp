#pragma once

#include <mpi.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "test/mpi/scattered_fibers.hpp"

namespace fiber::test {

/// A folder of all ranks, gone at the end.
class SharedFolder {
 public:
  SharedFolder() {
    int number = static_cast<int>(getpid());
    MPI_Bcast(&number, 1, MPI_INT, 0, MPI_COMM_WORLD);
    path_ = std::filesystem::temp_directory_path() / ("files_" + std::to_string(number));
    std::filesystem::create_directories(path_);
    MPI_Barrier(MPI_COMM_WORLD);
  }
  ~SharedFolder() {
    MPI_Barrier(MPI_COMM_WORLD);
    if (own_rank() == 0) {
      std::filesystem::remove_all(path_);
    }
  }
  SharedFolder(const SharedFolder&) = delete;
  SharedFolder& operator=(const SharedFolder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace fiber::test
