// Small images and folders that clean up after themselves.
#pragma once
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "host/error.h"
#include "host/image/band.h"
#include "host/image/reader.h"
#include "host/image/writer.h"

namespace solidcast::testing {

/// A fresh folder, removed at the end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "solidcast-image-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::vector<std::string> names() const {
    std::vector<std::string> list;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      list.push_back(entry.path().filename().string());
    return list;
  }

 private:
  std::filesystem::path path_;
};

inline std::vector<std::uint8_t> bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void writeBytes(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

/// An image with all channels: gradients with noise, and misses.
inline Band randomBand(int width, int height, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1), sides(-5, 5);
  Band band;
  band.rows = height;
  band.width = width;
  for (int i = 0; i < width * height; ++i) {
    const bool miss = random() % 5 == 0;
    band.solid.push_back(miss ? -1 : static_cast<std::int32_t>(random() % 300));
    band.distance.push_back(miss ? std::numeric_limits<float>::infinity() : 10 * unit(random));
    for (int c = 0; c < 3; ++c) {
      band.rgb8.push_back(static_cast<std::uint8_t>(i / 7 + random() % 3));
      band.radiance.push_back(miss ? 0 : unit(random));
      band.normal.push_back(miss ? 0 : sides(random) / 5);
      band.local.push_back(miss ? 0 : sides(random));
      band.position.push_back(miss ? 0 : sides(random));
    }
  }
  return band;
}

template <class T>
std::vector<T> part(const std::vector<T>& values, int width, int firstRow, int rows, int perPixel) {
  const auto at = values.begin() + std::ptrdiff_t{1} * width * firstRow * perPixel;
  return {at, at + std::ptrdiff_t{1} * width * rows * perPixel};
}

inline Band cut(const Band& band, int firstRow, int rows) {
  const int w = band.width;
  return {firstRow,
          rows,
          w,
          part(band.rgb8, w, firstRow, rows, 3),
          part(band.radiance, w, firstRow, rows, 3),
          part(band.distance, w, firstRow, rows, 1),
          part(band.solid, w, firstRow, rows, 1),
          part(band.normal, w, firstRow, rows, 3),
          part(band.local, w, firstRow, rows, 3),
          part(band.position, w, firstRow, rows, 3)};
}

inline void writeWhole(const std::string& path, const Band& band, ImageKind kind = ImageKind::radiance) {
  ImageWriter writer(path, band.width, band.rows, kind);
  writer.rows(band);
  writer.finish();
}

/// The one line of an Error with this exit code; a failure when there is none.
template <class Work>
std::string errorOf(Exit code, Work work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return "";
}

inline bool contains(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

}  // namespace solidcast::testing
