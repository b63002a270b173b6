// One exception type for everything that ends a run, with the exit code that main returns for it.
#pragma once
#include <stdexcept>
#include <string>

namespace solidcast {

/// Exit codes of the command line; a caller of the library reads them as kinds of failure.
enum class Exit : int {
  fine = 0,
  differs = 1,   // images differ, or a budget is exceeded
  usage = 2,     // wrong arguments, or a scene, ray or image file that cannot be used
  noDevice = 3,  // no usable Vulkan device
  shader = 4,    // a shader does not compile or is not valid
  output = 5,    // an output could not be written
};

/// `what()` is one line: place (file, line or JSON path), what is wrong, what was expected.
class Error : public std::runtime_error {
 public:
  Error(Exit code, const std::string& line) : std::runtime_error(line), code_(code) {}
  Exit code() const { return code_; }

 private:
  Exit code_;
};

}  // namespace solidcast
