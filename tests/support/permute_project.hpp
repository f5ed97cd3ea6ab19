/// A small project whose permutations take a fraction of a second.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "support/child.hpp"
#include "support/files.hpp"

namespace relievo::test {

/// A manifest's text; 16 permutations × 2 targets, 14 programs.
inline std::string small_manifest(const std::string& head = {}) {
  return head + R"(schema = 1
name = "small"
targets = ["spirv-1.0", "glsl-450"]

[axes]
technique = ["parallax", "bump", "relief"]
address = ["repeat", "clamp"]
filter = ["hardware", "exact"]

[axes."relief.binary_steps"]
values = [3, 7]
default = 7
binding = "specialization"
)";
}

/// A folder with a manifest, and runs of `relievo permute` on it.
class PermuteProject {
 public:
  explicit PermuteProject(const std::string& manifest = small_manifest()) { folder_.write("relievo.toml", manifest); }

  std::string operator/(std::string_view name) const { return folder_ / name; }
  const TemporaryFolder& folder() const { return folder_; }

  /// `relievo permute relievo.toml -o OUT …`
  std::vector<std::string> arguments(const std::string& out, const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"permute", *this / "relievo.toml", "-o", *this / out};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  ChildResult run(const std::string& out, const std::vector<std::string>& more) const {
    return run_relievo(arguments(out, more));
  }
  /// The archive that such a run makes; a failure of the test where it makes none.
  std::string archive_of(const std::string& out, const std::vector<std::string>& more) const {
    const ChildResult result = run(out, more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return archive(out);
  }
  std::string archive(const std::string& out) const { return TemporaryFolder::read(*this / (out + "/small.rla")); }

  /// Starts such a run silently, with at most `file_limit` bytes a file.
  pid_t start(const std::string& out, const std::vector<std::string>& more, rlim_t file_limit = RLIM_INFINITY) const {
    std::vector<std::string> words = arguments(out, more);
    words.insert(words.begin(), "relievo");
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const std::string messages = folder_ / "messages";
    const pid_t child = ::fork();
    if (child != 0) return child;
    const int file = ::open(messages.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    ::dup2(file, 1);
    ::dup2(file, 2);
    const rlimit limit{file_limit, file_limit};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::execv(RELIEVO_BINARY_DIR "/bin/relievo", pointers.data());
    ::_exit(98);
  }
  std::string messages() const { return TemporaryFolder::read(folder_ / "messages"); }

 private:
  TemporaryFolder folder_;
};

/// An exit code; −1 when a signal ended the process.
inline int end_of_run(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// Files in a folder that are neither an archive nor what lies beside one for good.
inline std::vector<std::string> strays(const std::string& folder) {
  std::vector<std::string> names;
  if (!std::filesystem::exists(folder)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (!name.ends_with(".rla") && !name.ends_with(".costs") && !name.ends_with(".stamp")) names.push_back(name);
  }
  return names;
}

}  // namespace relievo::test
