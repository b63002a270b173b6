#include "host/scene/mesh_text.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>

#include "host/scene/fields.h"
#include "host/scene/triple.h"

namespace solidcast {
namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

Triple edgeCross(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
  const Triple &p = mesh.vertices[t[0]], &q = mesh.vertices[t[1]], &r = mesh.vertices[t[2]];
  const auto component = [&](int i, int j) { return (q[i] - p[i]) * (r[j] - p[j]) - (q[j] - p[j]) * (r[i] - p[i]); };
  return {component(1, 2), component(2, 0), component(0, 1)};
}

}  // namespace

void MeshText::refuse(const std::string& what) const {
  const auto line = 1 + std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
  throw Fault{"", std::string(file_) + ":" + std::to_string(line) + ": " + what};
}

bool MeshText::lineEnds() {
  while (at_ < text_.size()) {
    if (isBlank(text_[at_])) ++at_;
    else if (text_.substr(at_, 2) == "\\\n") at_ += 2;
    else if (text_.substr(at_, 3) == "\\\r\n") at_ += 3;
    else return text_[at_] == '\n';
  }
  return true;
}

void MeshText::nextLine() { at_ = std::min(text_.find('\n', at_), text_.size() - 1) + 1; }

void MeshText::skipSpace() {
  while (at_ < text_.size() && (isBlank(text_[at_]) || text_[at_] == '\n')) ++at_;
}

std::string_view MeshText::word() {
  if (lineEnds()) return {};
  const std::size_t begin = at_;
  while (at_ < text_.size() && !isBlank(text_[at_]) && text_[at_] != '\n') ++at_;
  return text_.substr(begin, at_ - begin);
}

bool MeshText::take(char c) {
  if (at_ == text_.size() || text_[at_] != c) return false;
  ++at_;
  return true;
}

void MeshText::refuseNumber(const char* what) {
  const std::string expected = std::string(", expected ") + what;
  if (done()) refuse("the file ends" + expected);
  if (lineEnds()) refuse("the line ends" + expected);
  const std::size_t begin = at_;
  const std::string found = inQuotes(word());
  at_ = begin;
  refuse("found " + found + expected);
}

void MeshText::refuseUnlessEnded(std::size_t begin, const char* what) {
  if (at_ == text_.size() || isBlank(text_[at_]) || text_[at_] == '\n' || text_[at_] == '/') return;
  at_ = begin;
  refuseNumber(what);
}

double MeshText::real(const char* what) {
  if (lineEnds()) refuseNumber(what);
  const std::size_t start = at_;
  if (take('+') && (done() || text_[at_] == '-')) at_ = start;
  double value = 0;
  const char *begin = text_.data() + at_, *end = text_.data() + text_.size();
  const auto [stopped, error] = std::from_chars(begin, end, value);
  if (error == std::errc::invalid_argument) refuseNumber(what);
  at_ += static_cast<std::size_t>(stopped - begin);
  // Out of range is too large or too small; strtod tells which.
  if (error == std::errc::result_out_of_range) value = std::strtod(std::string(begin, stopped).c_str(), nullptr);
  refuseUnlessEnded(start, what);
  try {
    checkNumber(value, "");
  } catch (const Fault& fault) { refuse(fault.text); }
  return value;
}

std::int64_t MeshText::whole(const char* what) {
  if (lineEnds()) refuseNumber(what);
  const std::size_t start = at_;
  std::int64_t value = 0;
  const char *begin = text_.data() + at_, *end = text_.data() + text_.size();
  const auto [stopped, error] = std::from_chars(begin, end, value);
  if (error != std::errc()) refuseNumber(what);
  at_ += static_cast<std::size_t>(stopped - begin);
  refuseUnlessEnded(start, what);
  return value;
}

void Faces::add(Mesh& mesh, std::span<const std::uint32_t> corners) {
  if (corners.size() < 3) {
    ++mesh.thin;
    return;
  }
  if (corners.size() > 3) fans_.push_back({mesh.triangles.size(), corners.size() - 2});
  for (std::size_t i = 2; i < corners.size(); ++i) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

void Faces::finish(Mesh& mesh) const {
  for (const Fan& fan : fans_) {
    Triple sum{};
    for (std::size_t i = 0; i < fan.count; ++i) {
      const Triple normal = edgeCross(mesh, mesh.triangles[fan.first + i]);
      for (int k = 0; k < 3; ++k) sum[k] += normal[k];
    }
    bool bent = false;
    // Well beyond rounding: corners that lie on an edge are no reason for a warning.
    for (std::size_t i = 0; i < fan.count; ++i)
      bent = bent || dot(edgeCross(mesh, mesh.triangles[fan.first + i]), sum) < -1e-6 * dot(sum, sum);
    mesh.bent += bent;
  }
}

}  // namespace solidcast
