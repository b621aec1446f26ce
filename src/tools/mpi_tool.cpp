#include "src/tools/mpi_tool.hpp"

#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <streambuf>
#include <string>
#include <system_error>

#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// Swallows what another rank says already.
class NoText : public std::streambuf {
 protected:
  int_type overflow(int_type c) override { return traits_type::not_eof(c); }
};

/// mpirun and srun take the ranks' stderr through pipes, and write it to theirs: rank 0 is on the
/// machine where they were started, as a rule, and they are the process above.
bool is_stderr_terminal() {
  if (isatty(STDERR_FILENO) == 1) {
    return true;
  }
  std::error_code none;
  const std::string above =
      std::filesystem::read_symlink("/proc/" + std::to_string(getppid()) + "/fd/2", none).string();
  return above.rfind("/dev/pts/", 0) == 0 || above.rfind("/dev/tty", 0) == 0;
}

/// A rank that has no memory ends all: the others would wait for it.
void end_without_memory() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::fprintf(stderr, "rank %d: not enough memory\n", rank);
  MPI_Abort(MPI_COMM_WORLD, REFUSED);
}

}  // namespace

int run_mpi_tool(const char* name, const char* description, const Setup& setup, int argc,
                 char** argv) {
  int support = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &support);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::set_new_handler(end_without_memory);
  // A file that is too large for the system is an error like that of a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
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

Progress rank_progress(const Communicator& ranks) {
  return Progress(ranks.rank() == 0 && is_stderr_terminal());
}

void show_done(Progress& progress, std::uint64_t done, std::uint64_t all, const std::string& what) {
  constexpr std::size_t width = 30;
  if (all > 1) {
    std::string bar(width * done / all, '#');
    bar.resize(width, ' ');
    progress.show('[' + bar + "] " + std::to_string(done) + " of " + std::to_string(all) + ' ' +
                  what);
  }
}

void require_other_file(const Communicator& ranks, const std::string& in, const std::string& out) {
  run_on_root(ranks, [&] {
    std::error_code none;
    if (std::filesystem::equivalent(in, out, none)) {
      throw std::invalid_argument("the file to write is the one to read itself, " + quote(in));
    }
  });
}

}  // namespace fiber
