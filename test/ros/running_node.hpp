#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "test/support/process.hpp"

namespace node_test {

/// A node that a test starts; it ends with this.
class RunningNode {
 public:
  /// @param command the program and its arguments
  /// @param output a file for what it prints, its warnings and errors among that: on /rosout they
  ///        are lost for who is not connected yet; empty: what it prints is printed
  explicit RunningNode(std::vector<std::string> command, std::string output = "")
      : output_(std::move(output)) {
    std::vector<char*> arguments;
    for (std::string& argument : command) {
      arguments.push_back(argument.data());
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (!output_.empty()) {
      posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output_.c_str(),
                                       O_WRONLY | O_CREAT | O_TRUNC, 0600);
      posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    }
    const int error = posix_spawn(&id_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
      throw std::system_error(error, std::generic_category(), command[0]);
    }
  }
  ~RunningNode() {
    send(SIGKILL);
    wait();
  }
  RunningNode(const RunningNode&) = delete;
  RunningNode& operator=(const RunningNode&) = delete;

  void send(int signal) const {
    if (id_ > 0) {
      kill(id_, signal);
    }
  }

  /// Returns what it has printed so far.
  std::string output() const { return fiber::test::read_file(output_); }

  bool is_running() {
    look(WNOHANG);
    return id_ > 0;
  }

  /// @returns the exit code, -1 for one that a signal ended
  int wait() {
    look(0);
    return exit_code_;
  }

  /// Ends it as Ctrl+C does.
  /// @returns as wait()
  int stop() {
    send(SIGINT);
    return wait();
  }

 private:
  void look(int options) {
    int status = 0;
    if (id_ > 0 && waitpid(id_, &status, options) == id_) {
      id_ = 0;
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
  }

  std::string output_;
  pid_t id_ = 0;
  int exit_code_ = -1;
};

}  // namespace node_test
