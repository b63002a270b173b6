// Records of the hand-written peer, calculated in fp64 and rounded once, and its run over all cores.

#include "host/bench/flush_denormals.h"
#include "host/bench/kernels.h"
#include "host/bench/peer.h"
#include "host/bench/vec.h"
#include "host/cast/workers.h"
#include "host/error.h"

namespace solidcast::bench {
namespace {

class Records {
 public:
  explicit Records(const Vec& eye) : eye_(eye) {}

  void add(const InfinitePlane& s) {
    const Vec n = glm::normalize(vec(s.normal));
    put(SimdScene::plane, n, glm::dot(n, vec(s.origin) - eye_));
  }
  void add(const Sphere& s) {
    const Vec f = vec(s.center) - eye_;
    const double C = glm::dot(f, f) - s.radius * s.radius, sign = C < 0 ? -1 : 1;
    put(SimdScene::sphere, f, C, sign, sign / s.radius);
  }
  void add(const Disc& s) {
    const Vec n = glm::normalize(vec(s.normal)), f = vec(s.center) - eye_;
    put(SimdScene::disc, n, glm::dot(n, f), f, s.radius * s.radius);
  }
  void add(const Triangle& s) { span(SimdScene::triangle, vec(s.v1), vec(s.v2) - vec(s.v1), vec(s.v3) - vec(s.v1)); }
  void add(const Quad& s) { span(SimdScene::quad, vec(s.vertex), vec(s.span1), vec(s.span2)); }
  void add(const AABox& s) {
    const Vec a = vec(s.corner1) - eye_, b = vec(s.corner2) - eye_;
    put(SimdScene::box, glm::min(a, b), glm::max(a, b));
  }
  void add(const Quadric& s) {
    const auto& k = s.coefficients;
    const Vec l = 0.5 * Vec(k[6], k[7], k[8]);
    const glm::dmat3 m(k[0], k[3] / 2, k[4] / 2, k[3] / 2, k[1], k[5] / 2, k[4] / 2, k[5] / 2, k[2]);
    const Vec w = m * eye_ + l;
    put(SimdScene::quadric, k[0], k[1], k[2], k[3], k[4], k[5], w, glm::dot(eye_, w + l) + k[9]);
  }

  SimdScene scene() const {
    SimdScene out{};
    for (int kind = 0; kind < SimdScene::kinds; ++kind) {
      out.records[kind] = floats_[kind].data();
      out.count[kind] = static_cast<int>(floats_[kind].size()) / kSimdFloats[kind];
    }
    return out;
  }

 private:
  void span(SimdScene::Kind kind, const Vec& v, const Vec& e1, const Vec& e2) {
    const Vec f = eye_ - v, n = glm::cross(e1, e2);
    const double k = 1 / glm::length(n);
    put(kind, k * n, -k * glm::dot(n, f), k * glm::cross(f, e2), k * glm::cross(e1, f));
  }
  template <class... Parts>
  void put(SimdScene::Kind kind, const Parts&... parts) {
    (append(floats_[kind], parts), ...);
  }
  static void append(std::vector<float>& to, double x) { to.push_back(static_cast<float>(x)); }
  static void append(std::vector<float>& to, const Vec& v) {
    for (int i = 0; i < 3; ++i) append(to, v[i]);
  }

  Vec eye_;
  std::vector<float> floats_[SimdScene::kinds];
};

class SimdPeer final : public Peer {
 public:
  SimdPeer(const Scene& scene, int width, int height, bool skipping, const Kernels& kernels)
      : scene_(scene), skipping_(skipping), kernels_(kernels), rays_(scene, width, height), image_(rays_) {}

  std::string name() const override { return std::string(kernels_.name) + (skipping_ ? "-skip" : ""); }
  std::string plan() const override {
    return std::string("hand-written ") + kernels_.name + ", " + std::to_string(kernels_.width) +
           " rays at a time, eye-relative, " + (skipping_ ? "missed solids left early, " : "") +
           std::to_string(workers_.threads()) + " threads";
  }
  Lap run() override {
    Stopwatch watch;
    Records records(std::visit([](const auto& camera) { return vec(camera.center); }, scene_.camera));
    const Solids& solids = scene_.world.solids;
    for (std::size_t i = 0; i < solids.size(); ++i)
      solids.shape(i).visit([&](const auto& shape) { records.add(shape); });
    const SimdScene scene = records.scene();
    const Span build = watch.lap();
    const RayView rays = rays_.view();
    const Light light = lightOf(scene_);
    const auto rows = skipping_ ? kernels_.simdRowsSkipping : kernels_.simdRows;
    workers_.run((rays.height + kPacketRows - 1) / kPacketRows, [&](int i) {
      const FlushDenormals flush;
      rows(scene, rays, light, image_.data(), i * kPacketRows);
    });
    return {build, watch.lap()};
  }
  Image image() const override { return image_.image(); }

 private:
  const Scene& scene_;
  bool skipping_;
  const Kernels& kernels_;
  Rays rays_;
  WordImage image_;
  Workers workers_;
};

}  // namespace

Image WordImage::image() const {
  Image image;
  image.width = view_.width, image.height = view_.height, image.channels = 3;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(view_.width) * view_.height * 3);
  for (int y = 0; y < view_.height; ++y)
    for (int x = 0; x < view_.width; ++x) {
      const std::uint32_t word = words_[static_cast<std::size_t>(y) * view_.stride + x];
      for (int c = 0; c < 3; ++c) bytes.push_back(static_cast<std::uint8_t>(word >> 8 * c));
    }
  image.values = std::move(bytes);
  return image;
}

std::unique_ptr<Peer> simdPeer(const Scene& scene, int width, int height, bool skipping, const Kernels* kernels) {
  if (kernels == nullptr)
    throw Error(Exit::usage, "--against simd: this CPU has neither AVX-512 nor AVX2 with FMA, expected one of them");
  if (std::holds_alternative<OrthographicCamera>(scene.camera))
    throw Error(Exit::usage, scene.file +
                                 ": --against simd: the camera is orthographic, expected one whose rays share "
                                 "their origin (perspective, environment)");
  return std::make_unique<SimdPeer>(scene, width, height, skipping, *kernels);
}

}  // namespace solidcast::bench
