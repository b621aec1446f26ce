#include "src/tools/mpi_tool.hpp"

#include <mpi.h>

#include <exception>
#include <iostream>
#include <streambuf>
#include <string>

namespace fiber {
namespace {

/// For what only one rank need say.
class NoText : public std::streambuf {
 protected:
  int_type overflow(int_type c) override { return traits_type::not_eof(c); }
};

}  // namespace

int run_mpi_tool(const char* name, const char* description, const Setup& setup, int argc,
                 char** argv) {
  int support = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &support);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  NoText none;
  std::streambuf* const output = std::cout.rdbuf();
  std::streambuf* const errors = std::cerr.rdbuf();
  if (rank != 0) {
    std::cout.rdbuf(&none);
    std::cerr.rdbuf(&none);
  }
  const int code = run_tool(name, description, setup, argc, argv);
  std::cout.rdbuf(output);
  std::cerr.rdbuf(errors);
  MPI_Finalize();
  return code;
}

void on_first_rank(const Communicator& ranks, const std::function<void()>& work) {
  std::string error;
  if (ranks.rank() == 0) {
    try {
      work();
    } catch (const std::exception& failure) {
      error = failure.what();
    }
  }
  ranks.agree(error);
}

}  // namespace fiber
