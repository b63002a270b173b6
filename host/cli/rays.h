// Text of `query`: rays in, one a line, and hits out, one JSON object a line. Made for streams of millions of
// rays: no allocation per ray, correctly rounded numbers both ways, and no locale.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/ray.h"
#include "host/scene/world.h"

namespace solidcast::cli {

/// Parses a decimal or hex float, rounded once to fp32; `inf` and `nan` are taken. Gives the message of what is wrong
/// with the word, or nothing.
std::optional<std::string> parseNumber(std::string_view word, float& value);

/// Reads `ox oy oz dx dy dz [tmax]` a line: decimal or hex floats (0x1.8p+3), rounded once to fp32; blanks or tabs
/// between them; `#` starts a comment. Only tmax may be `inf`.
class RayReader {
 public:
  /// Opens `file` ("-": standard input). `tMax` is for rays that give none. Throws Error(Exit::usage).
  RayReader(const std::string& file, float tMax);
  ~RayReader();
  RayReader(const RayReader&) = delete;
  RayReader& operator=(const RayReader&) = delete;

  /// Fills `rays` from the front and returns how many there were; less than asked for only at the end of the file.
  /// A line that is no ray throws Error(Exit::usage) `file:line: what, expected what`.
  std::size_t read(std::span<QueryRay> rays);

  /// Share of the file that has been read, 0 to 1; 0 where the length is unknown (a pipe).
  double fraction() const;

 private:
  bool nextLine(std::string_view& line);
  void refill();

  std::string name_;
  int file_ = -1;
  float tMax_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of the text in buffer_ that is not used up
  bool atEnd_ = false;
  std::uint64_t lineNumber_ = 0, bytesRead_ = 0, fileSize_ = 0;
};

/// Appends one JSON line a hit: {"ray":i,"hit":true,"t":..,"solid":"name","index":k,"normal":[..],"local":[..],
/// "position":[..]} or {"ray":i,"hit":false}.
class HitFormatter {
 public:
  /// `hex`: numbers as strings of hex floats, "0x1.8p+3", else decimals with 9 significant digits, which give the
  /// same fp32 back. A number that is not finite is null.
  HitFormatter(const World& world, bool hex);

  void append(std::string& text, std::uint64_t ray, const QueryHit& hit) const;

 private:
  void number(std::string& text, float value) const;
  void triple(std::string& text, const char* key, const std::array<float, 3>& value) const;

  std::vector<std::string> names_;  // quoted and escaped, by index of the solid
  bool hex_;
};

}  // namespace solidcast::cli
