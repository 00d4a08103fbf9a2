/// @file
/// Lines and commands by a Unix domain socket, and what becomes of them back on it.
///
///     $ printf '{"do": "say", "text": "Hello", "when": "now"}\n' | nc -U head.sock
///
/// The socket is a file that its owner alone may use (mode 0600). A program that reads what is told
/// too slowly is left: nobody waits for it.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fap/result.h"

struct pollfd;

namespace animeme::speech {

/// One thread may read while another one tells.
class ControlSocket {
 public:
  /// Listens at a path (at most 107 bytes). A socket that nobody listens at any more is replaced.
  /// Errors: invalid_argument (the path is too long), io (somebody listens there, it is another
  /// kind of file, the folder is not writable).
  static Result<std::unique_ptr<ControlSocket>> open(const std::string& path);
  /// Removes the file.
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Adds what is to be watched.
  void add_to(std::vector<pollfd>& wanted);
  /// Reads from those of `ready` that are its own and have something; each line, without blanks
  /// around it, goes to `take`. Who sent a line that was refused is told why.
  void read(const std::vector<pollfd>& ready, const std::function<Result<void>(std::string)>& take);
  /// Sends a line to all who are connected.
  void tell(const std::string& line);

 private:
  struct Client;
  ControlSocket(std::string path, int listener);
  void enter();
  bool read_from(Client& client, const std::function<Result<void>(std::string)>& take);
  bool send(Client& client, const std::string& line);

  std::string path_;
  int listener_;
  std::uint64_t file_ = 0;  // its inode
  std::mutex mutex_;        // guards the list
  std::list<Client> clients_;
};

}  // namespace animeme::speech
