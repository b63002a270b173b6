#include "host/cli/rays.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "host/error.h"
#include "host/scene/load.h"

namespace solidcast::cli {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;  // and the longest line
constexpr char kExpected[] = "expected ox oy oz dx dy dz [tmax]";

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The word as a message can show it: short, printable, quoted.
std::string shown(std::string_view word) {
  std::string text = "\"";
  for (const char c : word.substr(0, 40)) text += c >= ' ' && c < 127 ? c : '?';
  return text + (word.size() > 40 ? "...\"" : "\"");
}

/// Parses a line that is not blank; the message of what is wrong, or nothing.
std::optional<std::string> parseRay(std::string_view line, float tMax, QueryRay& ray) {
  static constexpr const char* kNames[] = {"ox", "oy", "oz", "dx", "dy", "dz", "tmax"};
  float values[7];
  int count = 0;
  for (std::size_t at = 0; at < line.size();) {
    if (isBlank(line[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < line.size() && !isBlank(line[end])) ++end;
    const std::string_view word = line.substr(at, end - at);
    at = end;
    if (count == 7) return "more than 7 numbers, " + std::string(kExpected);
    if (auto wrong = parseNumber(word, values[count])) return std::string(kNames[count]) + " " + *wrong;
    if (std::isnan(values[count]) || (std::isinf(values[count]) && count < 6))
      return std::string(kNames[count]) + " is " + shown(word) + ", expected a finite number";
    ++count;
  }
  if (count < 6)
    return std::to_string(count) + (count == 1 ? " number" : " numbers") + " instead of 6 or 7, " + kExpected;
  if (values[3] == 0 && values[4] == 0 && values[5] == 0)
    return "the direction is zero in fp32, expected a direction of any other length";
  if (count == 7 && values[6] < 0) return "tmax is negative, expected 0 or more";
  ray.origin = {values[0], values[1], values[2]};
  ray.direction = {values[3], values[4], values[5]};
  ray.tMax = count == 7 ? values[6] : tMax;
  return std::nullopt;
}

}  // namespace

std::optional<std::string> parseNumber(std::string_view word, float& value) {
  std::string_view digits = word;
  const bool negative = digits.starts_with('-');
  if (negative || digits.starts_with('+')) digits.remove_prefix(1);
  const bool hex = digits.size() > 1 && digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X');
  if (hex) digits.remove_prefix(2);
  if (digits.starts_with('-')) return shown(word) + " is no number, expected a decimal or a hex float like 0x1.8p+3";
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value,
                                            hex ? std::chars_format::hex : std::chars_format::general);
  if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
    return shown(word) + " is no number, expected a decimal or a hex float like 0x1.8p+3";
  // from_chars reports too large and too small alike, and GCC 12's rounds some hex denormals wrongly; strtof does
  // neither, but is slow.
  if (error == std::errc::result_out_of_range || (hex && value < std::numeric_limits<float>::min()))
    value = std::strtof(((hex ? "0x" : "") + std::string(digits)).c_str(), nullptr);
  const bool letters = !hex && !digits.empty() && std::strchr("iInN", digits[0]) != nullptr;
  if (std::isinf(value) && !letters) return shown(word) + " is beyond fp32, expected at most 3.40282347e+38 in size";
  if (negative) value = -value;
  return std::nullopt;
}

RayReader::RayReader(const std::string& file, float tMax)
    : name_(file == "-" ? "standard input" : file), tMax_(tMax), buffer_(kBufferBytes) {
  file_ = file == "-" ? STDIN_FILENO : ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (file_ < 0)
    throw Error(Exit::usage, name_ + ": cannot be read: " + std::strerror(errno) + ", expected a file of rays");
  struct stat status {};
  if (::fstat(file_, &status) == 0 && S_ISREG(status.st_mode)) fileSize_ = status.st_size;
}

RayReader::~RayReader() {
  if (file_ > STDIN_FILENO) ::close(file_);
}

void RayReader::refill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  ssize_t got;
  do got = ::read(file_, buffer_.data() + end_, buffer_.size() - end_);
  while (got < 0 && errno == EINTR);
  if (got < 0)
    throw Error(Exit::usage, name_ + ": cannot be read: " + std::strerror(errno) + ", expected a file of rays");
  end_ += got;
  bytesRead_ += got;
  atEnd_ = got == 0;
}

bool RayReader::nextLine(std::string_view& line) {
  for (std::size_t searched = 0;;) {
    const char* text = buffer_.data() + begin_;
    const std::size_t length = end_ - begin_;
    const void* newline = length > searched ? std::memchr(text + searched, '\n', length - searched) : nullptr;
    if (newline != nullptr || (atEnd_ && length > 0)) {
      const std::size_t size = newline != nullptr ? static_cast<const char*>(newline) - text : length;
      line = {text, size};
      begin_ += size + (newline != nullptr ? 1 : 0);
      ++lineNumber_;
      return true;
    }
    if (atEnd_) return false;
    searched = length;
    if (length == buffer_.size())
      throw Error(Exit::usage, name_ + ":" + std::to_string(lineNumber_ + 1) + ": the line is longer than " +
                                   std::to_string(length) + " bytes, " + kExpected);
    refill();
  }
}

std::size_t RayReader::read(std::span<QueryRay> rays) {
  std::size_t count = 0;
  std::string_view line;
  while (count < rays.size() && nextLine(line)) {
    line = line.substr(0, line.find('#'));
    if (std::all_of(line.begin(), line.end(), isBlank)) continue;
    if (const auto wrong = parseRay(line, tMax_, rays[count]))
      throw Error(Exit::usage, name_ + ":" + std::to_string(lineNumber_) + ": " + *wrong);
    ++count;
  }
  return count;
}

double RayReader::fraction() const {
  return fileSize_ == 0 ? 0 : static_cast<double>(bytesRead_ - (end_ - begin_)) / static_cast<double>(fileSize_);
}

HitFormatter::HitFormatter(const World& world, bool hex) : hex_(hex) {
  names_.reserve(world.solids.size());
  for (std::uint32_t i = 0; i < world.solids.size(); ++i)
    names_.push_back(
        nlohmann::json(solidName(world, i)).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void HitFormatter::number(std::string& text, float value) const {
  if (!std::isfinite(value)) {
    text += "null";
    return;
  }
  char digits[64];
  if (!hex_) {
    const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 9).ptr;
    text.append(digits, end);
    return;
  }
  const auto end = std::to_chars(digits, digits + sizeof digits, std::fabs(value), std::chars_format::hex).ptr;
  text += std::signbit(value) ? "\"-0x" : "\"0x";
  text.append(digits, end);
  text += '"';
}

void HitFormatter::triple(std::string& text, const char* key, const std::array<float, 3>& value) const {
  text += key;
  for (int i = 0; i < 3; ++i) {
    if (i > 0) text += ',';
    number(text, value[i]);
  }
  text += ']';
}

void HitFormatter::append(std::string& text, std::uint64_t ray, const QueryHit& hit) const {
  char digits[24];
  text += "{\"ray\":";
  text.append(digits, std::to_chars(digits, digits + sizeof digits, ray).ptr);
  if (!hit) {
    text += ",\"hit\":false}\n";
    return;
  }
  text += ",\"hit\":true,\"t\":";
  number(text, hit.t);
  text += ",\"solid\":";
  text += names_[hit.index];
  text += ",\"index\":";
  text.append(digits, std::to_chars(digits, digits + sizeof digits, hit.index).ptr);
  triple(text, ",\"normal\":[", hit.normal);
  triple(text, ",\"local\":[", hit.local);
  triple(text, ",\"position\":[", hit.position);
  text += "}\n";
}

}  // namespace solidcast::cli
