// The page of a watch over HTTP, for browsers on this machine alone. Only the routes of Api are answered; there is no way
// from a request to a file.
#pragma once
#include <memory>
#include <string>

#include "host/watch/api.h"

namespace solidcast::watch {

class HttpServer;

class Server {
 public:
  /// Listens on 127.0.0.1 and this port; 0: any free one. Throws Error(Exit::usage) where it cannot, or where the module
  /// of http/ is not found.
  Server(Board& board, int port);
  /// Ends the board, and waits for requests at work.
  ~Server();
  Server(const Server&) = delete;

  std::string url() const;

 private:
  Board& board_;
  Api api_;
  std::unique_ptr<HttpServer> http_;
};

}  // namespace solidcast::watch
