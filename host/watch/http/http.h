// HTTP as a module of its own, loaded when a watch serves a page: the library behind it brings OpenSSL with it, and loading
// that took every run of the program three milliseconds.
#pragma once
#include <functional>
#include <string>

#include "host/watch/api.h"

namespace solidcast::watch {

struct HttpHandlers {  // called from several threads
  std::function<bool(const std::string& path, bool post)> knows;
  std::function<Answer(const Question&)> answer;
};

/// Listens on 127.0.0.1 until it is destroyed, which waits for requests at work.
class HttpServer {
 public:
  virtual ~HttpServer() = default;
  virtual int port() const = 0;
};

/// What the module has under the name "solidcastHttp": a server on this port (0: any free one), or null where there is none.
using HttpMaker = HttpServer*(int port, HttpHandlers handlers);

}  // namespace solidcast::watch
