#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "test/support/temporary_directory.hpp"

namespace fiber::test {

inline std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// How a program ended and what it printed.
struct ProcessResult {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs a command of the shell and waits for its end.
inline ProcessResult run_process(const std::string& command) {
  const TemporaryDirectory directory;
  const std::string out = directory.path("out");
  const std::string err = directory.path("err");
  const int status = std::system((command + " >" + out + " 2>" + err).c_str());
  if (!WIFEXITED(status)) {
    throw std::runtime_error("'" + command + "' did not exit: " + read_file(err));
  }
  return {WEXITSTATUS(status), read_file(out), read_file(err)};
}

}  // namespace fiber::test
