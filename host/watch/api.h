// What viewers can ask for, without HTTP: pages, pictures, the state as JSON, moves of the camera, an explanation of a pixel.
#pragma once
#include <map>
#include <mutex>
#include <string>

#include "host/watch/board.h"

namespace solidcast::watch {

struct Question {
  bool post = false;
  std::string path;
  std::map<std::string, std::string> parameters;
  std::string body;
};

struct Answer {
  int status = 200;  // as in HTTP
  std::string type, body;
};

class Api {
 public:
  explicit Api(Board& board) : board_(board) {}

  /// Is there anything at this path for this method?
  static bool knows(const std::string& path, bool post);
  /// Never throws for what a question holds; called from several threads.
  Answer answer(const Question& question);

 private:
  Answer state(const Question& question);
  Answer picture(const Question& question);
  Answer pixel(const Question& question);
  Answer steer(const Question& question);
  Answer change(const Question& question);
  Answer asked(std::function<std::string(Session&)> wish);

  Board& board_;
  std::mutex mutex_;  // of what follows
  int encodedFrame_ = 0, waiting_ = 0;
  std::string encoded_;  // PNG of that frame
};

}  // namespace solidcast::watch
