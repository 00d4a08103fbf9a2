/// @file
/// A Unix domain socket that receives lines and commands and sends their events.
///
///     $ printf '{"do": "say", "text": "Hello", "when": "now"}\n' | nc -U head.sock
///
/// Only its owner may use the socket file (mode 0600). A client that reads events too slowly is
/// disconnected.
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

/// One thread may read while another one sends.
class ControlSocket {
 public:
  /// Listens at a path (at most 107 bytes). A stale socket is replaced. Errors: invalid_argument
  /// (the path is too long), io (the socket is in use, is another kind of file, or the folder is
  /// not writable).
  static Result<std::unique_ptr<ControlSocket>> open(const std::string& path);
  /// Removes the file.
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

  /// Adds the descriptors to poll.
  void add_to(std::vector<pollfd>& wanted);
  /// Reads from its descriptors in `ready` that have input; passes each line, without surrounding
  /// blanks, to `take`. The sender of a rejected line receives the error.
  void read(const std::vector<pollfd>& ready, const std::function<Result<void>(std::string)>& take);
  /// Sends a line to all clients.
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
