#include "host/watch/server.h"

#include <dlfcn.h>

#include "host/error.h"
#include "host/watch/http/http.h"

namespace solidcast::watch {
namespace {

/// Of the module, which the dynamic linker finds where the program says (RUNPATH: beside it, or where it is installed).
HttpMaker* loadHttp() {
  void* module = dlopen(SOLIDCAST_HTTP_MODULE, RTLD_NOW | RTLD_LOCAL);  // stays until the program ends
  void* maker = module ? dlsym(module, "solidcastHttp") : nullptr;
  if (!maker)
    throw Error(Exit::usage, std::string("--serve: ") + dlerror() +
                                 ", expected " SOLIDCAST_HTTP_MODULE " beside the program or where it was installed");
  return reinterpret_cast<HttpMaker*>(maker);
}

}  // namespace

Server::Server(Board& board, int port) : board_(board), api_(board) {
  http_.reset(loadHttp()(port, {Api::knows, [this](const Question& question) { return api_.answer(question); }}));
  if (!http_)
    throw Error(Exit::usage,
                "--serve: port " + std::to_string(port) + " cannot be had, expected a free one (--serve 0 takes any)");
}

Server::~Server() {
  board_.end();
  http_.reset();
}

std::string Server::url() const { return "http://127.0.0.1:" + std::to_string(http_->port()) + "/"; }

}  // namespace solidcast::watch
