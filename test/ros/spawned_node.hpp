#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

extern char** environ;

/// A node that a test starts; it ends with this.
class SpawnedNode {
 public:
  /// @param command the program and its arguments
  /// @param errors file for what it writes to stderr, its warnings and errors among that: on
  /// /rosout
  ///        they are lost for who is not connected yet
  explicit SpawnedNode(std::vector<std::string> command, std::string errors = "")
      : errors_(std::move(errors)) {
    std::vector<char*> arguments;
    for (std::string& argument : command) {
      arguments.push_back(argument.data());
    }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (!errors_.empty()) {
      posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors_.c_str(),
                                       O_CREAT | O_WRONLY | O_TRUNC, 0600);
    }
    const int failure =
        posix_spawn(&id_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) {
      throw std::runtime_error("cannot start " + command[0]);
    }
  }
  ~SpawnedNode() {
    if (id_ > 0) {
      kill(id_, SIGKILL);
      wait();
    }
  }
  SpawnedNode(const SpawnedNode&) = delete;
  SpawnedNode& operator=(const SpawnedNode&) = delete;

  void send(int signal) const { kill(id_, signal); }

  /// What it has written to stderr so far.
  std::string errors() const {
    std::ifstream file(errors_);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  bool is_running() {
    int status = 0;
    if (id_ > 0 && waitpid(id_, &status, WNOHANG) == id_) {
      id_ = 0;
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    return id_ > 0;
  }

  /// @returns the exit code, -1 for one that a signal ended
  int wait() {
    int status = 0;
    if (id_ > 0 && waitpid(id_, &status, 0) == id_) {
      id_ = 0;
      exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    return exit_code_;
  }

 private:
  std::string errors_;
  pid_t id_ = 0;
  int exit_code_ = -1;
};
