/// A Redis server of the test's own, and stand-ins for servers that fail.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "support/files.hpp"

namespace relievo::test {

/// A socket on a port of the loopback that nobody else has.
class LoopbackSocket {
 public:
  LoopbackSocket() : fd_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    ::setsockopt(fd_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    if (::bind(fd_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        ::getsockname(fd_, reinterpret_cast<sockaddr*>(&address), &size) != 0)
      throw std::runtime_error("no port is free");
    port_ = ntohs(address.sin_port);
  }
  ~LoopbackSocket() { ::close(fd_); }
  LoopbackSocket(const LoopbackSocket&) = delete;
  LoopbackSocket& operator=(const LoopbackSocket&) = delete;

  int fd() const { return fd_; }
  int port() const { return port_; }
  static sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }

 private:
  int fd_ = -1, port_ = 0;
};

/// Sends one command and returns the answer as it came; empty when there is no server.
inline std::string redis_command(int port, const std::vector<std::string>& words) {
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = LoopbackSocket::loopback(port);
  std::string answer;
  if (::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    std::string bytes = "*" + std::to_string(words.size()) + "\r\n";
    for (const std::string& word : words) bytes += "$" + std::to_string(word.size()) + "\r\n" + word + "\r\n";
    (void)!::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    ::shutdown(fd, SHUT_WR);  // the server answers, then closes
    char buffer[4096];
    for (ssize_t got = 0; (got = ::recv(fd, buffer, sizeof buffer, 0)) > 0;)
      answer.append(buffer, static_cast<std::size_t>(got));
  }
  ::close(fd);
  return answer;
}

/// Debian's redis-server on a free port, in memory alone; it ends with the test, however the test ends.
class RedisServer {
 public:
  RedisServer() {
    for (int attempt = 0; attempt < 5; ++attempt) {
      port_ = LoopbackSocket().port();  // free a moment ago: another may take it
      start();
      if (answers()) return;
      stop();
    }
    throw std::runtime_error("redis-server does not start: " + TemporaryFolder::read(folder_ / "log"));
  }
  ~RedisServer() { stop(); }
  RedisServer(const RedisServer&) = delete;
  RedisServer& operator=(const RedisServer&) = delete;

  int port() const { return port_; }
  std::string address() const { return "redis://127.0.0.1:" + std::to_string(port_); }
  std::string command(const std::vector<std::string>& words) const { return redis_command(port_, words); }
  void signal(int number) const { ::kill(child_, number); }
  void stop() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
    child_ = -1;
  }

 private:
  void start() {
    const std::string port = std::to_string(port_), log = folder_ / "log", place = folder_.path();
    child_ = ::fork();
    if (child_ != 0) return;
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::execlp("redis-server", "redis-server", "--port", port.c_str(), "--bind", "127.0.0.1", "--save", "",
             "--appendonly", "no", "--dir", place.c_str(), "--logfile", log.c_str(), nullptr);
    ::_exit(127);
  }
  bool answers() const {
    for (int i = 0; i < 500; ++i) {
      if (command({"PING"}).starts_with("+PONG")) return true;
      if (::waitpid(child_, nullptr, WNOHANG) != 0) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  TemporaryFolder folder_;
  int port_ = 0;
  pid_t child_ = -1;
};

/// Accepts connections and treats each as `serve` says; without one it never even accepts.
class FakeServer {
 public:
  explicit FakeServer(std::function<void(int fd, const std::atomic<bool>& ended)> serve = {}) {
    ::listen(socket_.fd(), 16);
    if (serve) thread_ = std::thread([this, serve = std::move(serve)] { accept_all(serve); });
  }
  ~FakeServer() {
    ended_ = true;
    if (thread_.joinable()) thread_.join();
  }
  std::string address() const { return "redis://127.0.0.1:" + std::to_string(socket_.port()); }

 private:
  void accept_all(const std::function<void(int, const std::atomic<bool>&)>& serve) {
    while (!ended_) {
      pollfd waiting{socket_.fd(), POLLIN, 0};
      if (::poll(&waiting, 1, 20) <= 0) continue;
      const int fd = ::accept4(socket_.fd(), nullptr, nullptr, SOCK_CLOEXEC);
      if (fd < 0) continue;
      serve(fd, ended_);
      ::close(fd);
    }
  }
  LoopbackSocket socket_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

}  // namespace relievo::test
