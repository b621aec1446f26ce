#pragma once

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <system_error>
#include <vector>

namespace node_test {

/// A node that runs while this lives.
class RunningNode {
 public:
  /// @param output a file for what it prints; empty: what it prints is printed
  explicit RunningNode(const std::string& program, std::vector<std::string> arguments,
                       const std::string& output = "") {
    arguments.insert(arguments.begin(), program);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) {
      pointers.push_back(argument.data());
    }
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (!output.empty()) {
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0600);
      posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    }
    const int error =
        posix_spawn(&pid_, program.c_str(), &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
      throw std::system_error(error, std::generic_category(), program);
    }
  }
  ~RunningNode() { stop(); }
  RunningNode(const RunningNode&) = delete;
  RunningNode& operator=(const RunningNode&) = delete;

  /// Ends it as Ctrl+C does.
  /// @returns what waitpid says of its end; 0 is a clean one
  int stop() {
    int status = 0;
    if (pid_ > 0) {
      kill(pid_, SIGINT);
      waitpid(pid_, &status, 0);
      pid_ = 0;
    }
    return status;
  }

 private:
  pid_t pid_ = 0;
};

}  // namespace node_test
