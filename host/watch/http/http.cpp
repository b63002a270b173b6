// The only file that includes the HTTP library (cpp-httplib).
//
// What is guarded against, though only programs of this machine can connect:
//  - Other sites in the user's browser: a request must name this machine as its host (a foreign name that was made to lead
//    here, "DNS rebinding", does not pass), and what the browser says of its origin must be this page.
//  - Sizes: the library bounds lines and headers, bodies may have 4 KiB.
//  - Floods: so many threads, so many connections waiting for one, the rest waits in the kernel. The watch itself runs on
//    another thread, which no request can hold up (board.h).
#include "host/watch/http/http.h"

#include <httplib.h>

#include <condition_variable>
#include <deque>
#include <thread>
#include <utility>
#include <vector>

namespace solidcast::watch {
namespace {

constexpr std::size_t kThreads = 24, kMostQueued = 64, kMostBody = 4096, kRequestsPerConnection = 1000;
constexpr int kTimeoutSeconds = 1, kMostInKernel = 128;

/// Like the library's own pool, but who brings more work than can wait has to wait.
class BoundedPool : public httplib::TaskQueue {
 public:
  BoundedPool() {
    for (std::size_t i = 0; i < kThreads; ++i) threads_.emplace_back([this] { work(); });
  }

  void enqueue(std::function<void()> task) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ended_ || tasks_.size() < kMostQueued; });
    tasks_.push_back(std::move(task));
    changed_.notify_all();
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
      changed_.notify_all();
    }
    threads_.clear();
  }

 private:
  void work() {
    for (;;) {
      std::function<void()> task;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return ended_ || !tasks_.empty(); });
        if (tasks_.empty()) return;
        task = std::move(tasks_.front());
        tasks_.pop_front();
        changed_.notify_all();
      }
      task();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  bool ended_ = false;
  std::vector<std::jthread> threads_;
};

/// With a longer queue in the kernel than the library's 5: a page's requests wait there while others are flooded away.
class Http : public httplib::Server {
 public:
  void lengthenQueue() { ::listen(svr_sock_, kMostInKernel); }
};

void refuse(httplib::Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_header("Connection", "close");
  response.set_content("{\"error\":\"" + why + "\"}\n", "application/json");
}

class Listener : public HttpServer {
 public:
  explicit Listener(HttpHandlers handlers) : handlers_(std::move(handlers)) { prepare(); }
  ~Listener() override {
    http_.stop();
    if (thread_.joinable()) thread_.join();
  }
  int port() const override { return port_; }

  /// False: the port cannot be had.
  bool listen(int port) {
    const std::string host = "127.0.0.1";
    if (port == 0) port_ = http_.bind_to_any_port(host);
    else port_ = http_.bind_to_port(host, port) ? port : -1;
    if (port_ <= 0) return false;
    http_.lengthenQueue();
    thread_ = std::thread([this] { http_.listen_after_bind(); });
    while (!http_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));  // else it cannot be stopped
    return true;
  }

 private:
  /// This machine by one of its names, with this port or none.
  bool isHere(const std::string& host) const {
    for (const char* name : {"127.0.0.1", "localhost"})
      if (host == name || host == name + (":" + std::to_string(port_))) return true;
    return false;
  }

  /// True: the request was refused.
  bool guard(const httplib::Request& request, httplib::Response& response) const {
    const bool post = request.method == "POST";
    const std::string origin = request.get_header_value("Origin");
    const std::string site = request.get_header_value("Sec-Fetch-Site");
    if (request.get_header_value_count("Host") != 1 || !isHere(request.get_header_value("Host")))
      refuse(response, 421, "expected the host 127.0.0.1 or localhost");
    else if (!origin.empty() && !(origin.starts_with("http://") && isHere(origin.substr(7))))
      refuse(response, 403, "expected a request of this page");
    else if (!site.empty() && site != "same-origin" && site != "none")
      refuse(response, 403, "expected a request of this page");
    else if (!post && request.method != "GET") refuse(response, 405, "expected GET or POST");
    else if (!handlers_.knows(request.path, post)) refuse(response, 404, "there is nothing here");
    else if (request.has_header("Range") || request.has_header("Content-Encoding") ||
             request.has_header("Transfer-Encoding") || (!post && request.has_header("Content-Length")))
      refuse(response, 400, "expected a plain request");
    else if (post && request.get_header_value("Content-Type") != "application/json")
      refuse(response, 415, "expected application/json");
    else return false;
    return true;
  }

  void answer(const httplib::Request& request, httplib::Response& response) {
    Question question{request.method == "POST", request.path, {}, request.body};
    for (const auto& [name, value] : request.params) question.parameters.emplace(name, value);
    Answer answer = handlers_.answer(question);
    response.status = answer.status;
    response.set_content(std::move(answer.body), answer.type.c_str());
  }

  void prepare() {
    http_.new_task_queue = [] { return new BoundedPool; };
    http_.set_keep_alive_timeout(kTimeoutSeconds);
    http_.set_keep_alive_max_count(kRequestsPerConnection);
    http_.set_read_timeout(kTimeoutSeconds, 0);
    http_.set_write_timeout(kTimeoutSeconds, 0);
    http_.set_payload_max_length(kMostBody);
    http_.set_tcp_nodelay(true);
    // The library's own choice would let a second watch share the port.
    http_.set_socket_options([](int socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    http_.set_default_headers(
        {{"Cache-Control", "no-store"},
         {"X-Content-Type-Options", "nosniff"},
         {"Referrer-Policy", "no-referrer"},
         {"Cross-Origin-Resource-Policy", "same-origin"},
         {"Content-Security-Policy",
          "default-src 'self'; img-src 'self' blob: data:; frame-ancestors 'none'; base-uri 'none'"}});
    http_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      return guard(request, response) ? httplib::Server::HandlerResponse::Handled
                                      : httplib::Server::HandlerResponse::Unhandled;
    });
    const auto handler = [this](const httplib::Request& request, httplib::Response& response) {
      answer(request, response);
    };
    http_.Get(".*", handler);
    http_.Post(".*", handler);
    http_.set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
      refuse(response, 500, "the question could not be answered");
    });
  }

  HttpHandlers handlers_;
  Http http_;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace

extern "C" HttpServer* solidcastHttp(int port, HttpHandlers handlers) {
  auto listener = std::make_unique<Listener>(std::move(handlers));
  return listener->listen(port) ? listener.release() : nullptr;
}
static_assert(std::is_same_v<decltype(solidcastHttp), HttpMaker>);

}  // namespace solidcast::watch
