#include "benchmark/kernels/child_process.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string>

namespace fiber {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error(what + ": " + std::strerror(errno));
}

/// The child: it leaves no traces, does not outlive its parent, and finishes nothing of it.
[[noreturn]] void run(const std::function<void()>& call) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDERR_FILENO);
  dup2(nowhere, STDOUT_FILENO);
  try {
    call();
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

}  // namespace

bool survives(const std::function<void()>& call) {
  const pid_t child = fork();
  if (child < 0) {
    fail("no child process");
  }
  if (child == 0) {
    run(call);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      fail("a child process is lost");
    }
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

SharedMemory::SharedMemory(std::size_t bytes)
    : bytes_(bytes),
      begin_(mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
  if (begin_ == MAP_FAILED) {
    fail("no shared memory");
  }
}

SharedMemory::~SharedMemory() { munmap(begin_, bytes_); }

}  // namespace fiber
