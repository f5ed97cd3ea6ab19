/// The built program as a child process.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/files.hpp"

extern char** environ;

namespace relievo::test {

struct ChildResult {
  int exit_code = -1;  ///< −1: ended by a signal
  int signal = 0;
  std::string out, err;
};

/// Runs `program` to its end, with `variables` added to the environment and `input` to read.
inline ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                             const std::map<std::string, std::string>& variables = {}, const std::string& input = {}) {
  const TemporaryFolder streams;
  streams.write("in", input);
  std::vector<std::string> words = {program}, settings;
  words.insert(words.end(), arguments.begin(), arguments.end());
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string setting = *entry;
    if (!variables.contains(setting.substr(0, setting.find('=')))) settings.push_back(setting);
  }
  for (const auto& [name, value] : variables) settings.push_back(name + "=" + value);
  const auto pointers = [](std::vector<std::string>& strings) {
    std::vector<char*> list;
    for (std::string& s : strings) list.push_back(s.data());
    list.push_back(nullptr);
    return list;
  };
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, (streams / "in").c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, (streams / "out").c_str(), O_WRONLY | O_CREAT, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, (streams / "err").c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, program.c_str(), &actions, nullptr, pointers(words).data(), pointers(settings).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("'" + program + "' cannot be started");
  int status = 0;
  waitpid(child, &status, 0);
  ChildResult result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  result.out = TemporaryFolder::read(streams / "out");
  result.err = TemporaryFolder::read(streams / "err");
  return result;
}

/// Runs the relievo program of this build.
inline ChildResult run_relievo(const std::vector<std::string>& arguments,
                               const std::map<std::string, std::string>& variables = {},
                               const std::string& input = {}) {
  return run_child(RELIEVO_BINARY_DIR "/bin/relievo", arguments, variables, input);
}

}  // namespace relievo::test
