#include "host/scene/load.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "host/error.h"
#include "host/scene/builder.h"
#include "host/scene/mesh.h"

namespace solidcast {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;
constexpr std::size_t kMaxWarnings = 20;  // lines; the rest is counted

[[noreturn]] void refuseFile(const std::string& line) { throw Error(Exit::usage, line); }

std::string readAll(std::istream& in, const std::string& file) {
  std::string text;
  std::string block(std::size_t{1} << 20, '\0');
  while (in.read(block.data(), block.size()), in.gcount() > 0) {
    text.append(block, 0, in.gcount());
    if (text.size() > kMaxFileBytes)
      refuseFile(file + ": the file is larger than " + std::to_string(kMaxFileBytes) + " bytes, expected at most that");
  }
  if (in.bad()) refuseFile(file + ": cannot be read, expected a readable scene file");
  return text;
}

/// What nlohmann says after "... while parsing KIND - ", without its prefix, position and the text it read last.
std::string syntaxReason(const std::string& what) {
  std::string reason = what;
  const std::size_t dash = reason.find(" - ");
  if (dash != std::string::npos) reason = reason.substr(dash + 3);
  const std::size_t last = reason.find("; last read: ");
  if (last != std::string::npos) {
    const std::size_t expected = reason.rfind("; expected ");
    reason = reason.substr(0, last) + (expected != std::string::npos && expected > last ? reason.substr(expected) : "");
  }
  const std::size_t semicolon = reason.rfind("; expected ");
  if (semicolon != std::string::npos) reason.replace(semicolon, 2, ", ");
  else if (reason.find("expected") == std::string::npos) reason += ", expected valid JSON";
  return reason;
}

/// The run of letters, digits and signs around a byte: the whole word that the parser stumbled in.
std::string wordAround(const std::string& text, std::size_t at, std::size_t& begin) {
  const auto inWord = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || std::strchr("+-._", text[i]));
  };
  begin = at;
  while (begin > 0 && inWord(begin - 1) && at - begin < 32) --begin;
  std::size_t end = begin;
  while (inWord(end) && end - begin < 32) ++end;
  return text.substr(begin, end - begin);
}

bool isNonFinite(std::string word) {
  std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
  if (!word.empty() && (word[0] == '-' || word[0] == '+')) word.erase(0, 1);
  return word == "nan" || word == "inf" || word == "infinity";
}

[[noreturn]] void refuseSyntax(const SceneBuilder& builder, const std::string& text, const std::string& file) {
  std::size_t at = std::min(builder.syntaxErrorAt > 0 ? builder.syntaxErrorAt - 1 : 0, text.size());
  std::string reason;
  std::size_t wordBegin;
  const std::string word = wordAround(text, at, wordBegin);
  if (builder.syntaxError.find("number overflow") != std::string::npos) {
    const std::string& number = builder.syntaxErrorToken;
    at = text.rfind(number, at);
    reason = "number " + inQuotes(number) + " is beyond fp32, expected at most 3.4028234663852886e+38 in size";
  } else if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    at = 0;
    reason = "the file is empty, expected a JSON object";
  } else if (isNonFinite(word)) {
    at = wordBegin;
    reason = word + " is not a JSON number, expected a finite number";
  } else {
    reason = syntaxReason(builder.syntaxError);
  }
  const auto begin = text.begin(), end = begin + static_cast<std::ptrdiff_t>(at);
  const auto line = 1 + std::count(begin, end, '\n');
  const auto column =
      1 + (end - std::find(std::make_reverse_iterator(end), std::make_reverse_iterator(begin), '\n').base());
  refuseFile(file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + reason);
}

/// The place of a fault; a way through a thousand groups keeps its beginning and end.
std::string place(const std::string& pointer) {
  if (pointer.empty()) return "/";
  return pointer.size() <= 160 ? pointer : pointer.substr(0, 60) + " ... " + pointer.substr(pointer.size() - 60);
}

Scene meshScene(const std::string& file, std::vector<std::string>& warnings) {
  try {
    std::vector<Fault> found;
    Scene scene = sceneOfMesh(file, found);
    for (const Fault& fault : found) warnings.push_back(fault.text);
    return scene;
  } catch (const Fault& fault) { refuseFile(fault.text); }
}

}  // namespace

Scene parseScene(const std::string& text, const std::string& file, std::vector<std::string>& warnings,
                 std::vector<std::string>* files) {
  Scene scene;
  scene.file = file;
  std::vector<Fault> found;
  SceneBuilder builder(scene, found, files);
  try {
    if (!Json::sax_parse(text, &builder, Json::input_format_t::json, true, true)) refuseSyntax(builder, text, file);
  } catch (const Fault& fault) { refuseFile(file + ": " + place(fault.where) + ": " + fault.text); }
  for (std::size_t i = 0; i < std::min(found.size(), kMaxWarnings); ++i)
    warnings.push_back(file + ": " + place(found[i].where) + ": " + found[i].text);
  if (found.size() > kMaxWarnings)
    warnings.push_back(file + ": " + std::to_string(found.size() - kMaxWarnings) + " more warnings of this kind");
  return scene;
}

Scene loadScene(const std::string& file, std::vector<std::string>& warnings, std::vector<std::string>* files) {
  if (file == "-") return parseScene(readAll(std::cin, "standard input"), "standard input", warnings);
  if (files != nullptr) files->push_back(file);
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) refuseFile(file + ": is a folder, expected a scene file");
  if (isMeshFile(file)) return meshScene(file, warnings);
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in)
    refuseFile(file + ": " + (errno == ENOENT ? "no such file" : std::strerror(errno)) + ", expected a scene file");
  return parseScene(readAll(in, file), file, warnings, files);
}

}  // namespace solidcast
