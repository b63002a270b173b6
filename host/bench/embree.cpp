// Embree 3 as a peer, given what it is good at: its own spheres, discs, triangles and quads, AVX-512 with 16 wide
// packets, the coherent flag, all threads for the build, its default build quality. Planes, boxes and quadrics, which
// it lacks, are user geometry.
#include "host/bench/flush_denormals.h"
#include "host/bench/peer.h"
#include "host/cast/workers.h"
#include "host/error.h"

#ifdef SOLIDCAST_EMBREE
#include <dlfcn.h>

#include <array>
#include <cmath>

#include "host/bench/embree_api.h"
#include "host/bench/kernels.h"
#include "host/bench/vec.h"

namespace solidcast::bench {

EmbreeApi embreeApi;

void loadEmbree() {
  static void* const library = dlopen("libembree3.so.3", RTLD_NOW | RTLD_LOCAL);
  const auto find = [](const char* name) {
    void* function = library == nullptr ? nullptr : dlsym(library, name);
    if (function == nullptr)
      throw Error(Exit::usage, std::string("--against embree: libembree3.so.3 ") +
                                   (library == nullptr ? "is not installed" : std::string("has no ") + name) +
                                   ", expected Debian's package libembree3-3");
    return function;
  };
#define X(name) embreeApi.name = reinterpret_cast<decltype(&::name)>(find(#name));
  SOLIDCAST_EMBREE_FUNCTIONS(X)
#undef X
}

namespace {

/// Embree leaves out what reaches farther than 1.84e18. Unbounded solids must not: their box is this large.
constexpr double kEndless = 1e18;

RTCBounds boundsOf(const Vec& lo, const Vec& hi) {
  // Rounded outwards, so that a solid never leaves its box.
  const auto down = [](double x) { return std::nextafter(static_cast<float>(x), -3e38f); };
  const auto up = [](double x) { return std::nextafter(static_cast<float>(x), 3e38f); };
  return {down(lo.x), down(lo.y), down(lo.z), 0, up(hi.x), up(hi.y), up(hi.z), 0};
}

/// Flat along an axis that the plane is square to.
RTCBounds bounds(const InfinitePlane& s) {
  Vec lo(-kEndless), hi(kEndless);
  for (int i = 0; i < 3; ++i)
    if (s.normal[(i + 1) % 3] == 0 && s.normal[(i + 2) % 3] == 0) {
      const double margin = 1e-6 * std::abs(s.origin[i]);
      lo[i] = s.origin[i] - margin, hi[i] = s.origin[i] + margin;
    }
  return boundsOf(lo, hi);
}
RTCBounds bounds(const AABox& s) {
  const Vec a = vec(s.corner1), b = vec(s.corner2);
  return boundsOf(glm::min(a, b), glm::max(a, b));
}

struct QuadricForm {  // p'Mp + 2 l.p + j
  glm::dmat3 m;
  Vec l;
  double j;
};
QuadricForm form(const Quadric& s) {
  const auto& k = s.coefficients;
  return {{k[0], k[3] / 2, k[4] / 2, k[3] / 2, k[1], k[5] / 2, k[4] / 2, k[5] / 2, k[2]},
          0.5 * Vec(k[6], k[7], k[8]),
          k[9]};
}
/// Of an ellipsoid (M definite): c +- sqrt(k (M^-1)_ii) with c = -M^-1 l and k = l.M^-1 l - j. All others are endless.
RTCBounds bounds(const Quadric& s) {
  const QuadricForm q = form(s);
  const double minor = q.m[0][0] * q.m[1][1] - q.m[0][1] * q.m[0][1], determinant = glm::determinant(q.m);
  const double sign = q.m[0][0] < 0 ? -1 : 1;
  if (!(minor > 0) || !(sign * determinant > 0)) return boundsOf(Vec(-kEndless), Vec(kEndless));
  const glm::dmat3 inverse = glm::inverse(q.m);
  const Vec c = -(inverse * q.l);
  const double k = glm::dot(q.l, inverse * q.l) - q.j;
  Vec half;
  for (int i = 0; i < 3; ++i) half[i] = std::sqrt(std::max(0.0, k * inverse[i][i])) * (1 + 1e-6);
  return boundsOf(c - half, c + half);
}

float* put(float* to, double x) { return *to = static_cast<float>(x), to + 1; }
float* put(float* to, const Vec& v) { return put(put(put(to, v.x), v.y), v.z); }

/// Numbers of one solid, as Embree or kernels.h want them.
void write(const InfinitePlane& s, float* to) {
  const Vec n = glm::normalize(vec(s.normal));
  put(put(to, n), glm::dot(n, vec(s.origin)));
}
void write(const AABox& s, float* to) {
  const Vec a = vec(s.corner1), b = vec(s.corner2);
  put(put(to, glm::min(a, b)), glm::max(a, b));
}
void write(const Sphere& s, float* to) { put(put(to, vec(s.center)), s.radius); }
void write(const Disc& s, float* to) { put(put(to, vec(s.center)), s.radius); }
void write(const Triangle& s, float* to) { put(put(put(to, vec(s.v1)), vec(s.v2)), vec(s.v3)); }
void write(const Quad& s, float* to) {
  const Vec v = vec(s.vertex), a = vec(s.span1), b = vec(s.span2);
  put(put(put(put(to, v), v + a), v + a + b), v + b);
}
void write(const Quadric& s, float* to) {
  QuadricForm q = form(s);
  // From the centre of a bounded quadric, where fp32 loses nothing.
  const RTCBounds box = bounds(s);
  const Vec place =
      box.upper_x >= static_cast<float>(kEndless)
          ? Vec(0)
          : 0.5 * (Vec(box.lower_x, box.lower_y, box.lower_z) + Vec(box.upper_x, box.upper_y, box.upper_z));
  const Vec l = q.m * place + q.l;
  const double j = glm::dot(place, l + q.l) + q.j;
  const auto& k = s.coefficients;
  for (int i = 0; i < 6; ++i) to = put(to, k[static_cast<std::size_t>(i)]);
  put(put(put(to, l), j), place);
}

enum Kind { plane, box, sphere, disc, triangle, quad, quadric, kinds };  // as in Shape
constexpr std::array<int, kinds> kFloats{kUserFloats[0], kUserFloats[1], 4, 4, 9, 12, kUserFloats[2]};
constexpr std::array<int, kinds> kCorners{0, 0, 0, 0, 3, 4, 0};

class EmbreePeer final : public Peer {
 public:
  EmbreePeer(const Scene& scene, int width, int height, bool packets, const Kernels& kernels)
      : solids_(scene.world.solids),
        light_(lightOf(scene)),
        packets_(packets),
        kernels_(kernels),
        rays_(scene, width, height),
        image_(rays_) {
    const std::string settings = "threads=" + std::to_string(workers_.threads()) + ",frequency_level=simd512";
    device_ = embreeApi.rtcNewDevice(settings.c_str());
    if (device_ == nullptr)
      throw Error(Exit::usage, "--against embree: Embree makes no device (error " +
                                   std::to_string(embreeApi.rtcGetDeviceError(nullptr)) + "), expected one for \"" +
                                   settings + "\"");
  }
  ~EmbreePeer() override {
    drop();
    embreeApi.rtcReleaseDevice(device_);
  }

  std::string name() const override { return packets_ ? "embree16" : "embree1"; }
  std::string plan() const override {
    return "Embree " + std::to_string(embreeApi.rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION_MAJOR)) +
           "." + std::to_string(embreeApi.rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION_MINOR)) + "." +
           std::to_string(embreeApi.rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_VERSION_PATCH)) +
           (packets_ ? ", rtcIntersect16, packets of 4x4 rays, " : ", rtcIntersect1, ") +
           std::to_string(workers_.threads()) + " threads";
  }

  Lap run() override {
    drop();
    Stopwatch watch;
    build();
    const Span building = watch.lap();
    const RayView rays = rays_.view();
    const auto rows = packets_ ? kernels_.embree16 : kernels_.embree1;
    workers_.run((rays.height + kPacketRows - 1) / kPacketRows, [&](int i) {
      const FlushDenormals flush;
      rows(scene_, rays, light_, image_.data(), i * kPacketRows);
    });
    return {building, watch.lap()};
  }
  Image image() const override { return image_.image(); }

 private:
  void drop() {
    if (scene_ != nullptr) embreeApi.rtcReleaseScene(scene_);
    scene_ = nullptr;
  }

  /// What the threads write a kind's solids to.
  struct Target {
    float *numbers = nullptr, *normals = nullptr;
    unsigned* corners = nullptr;
  };

  void build() {
    // Each thread counts its share first, so that all can write at once.
    const int shares = static_cast<int>(workers_.threads());
    const auto start = [&](int share) {
      return solids_.size() * static_cast<std::size_t>(share) / static_cast<std::size_t>(shares);
    };
    std::vector<std::array<std::size_t, kinds>> firsts(static_cast<std::size_t>(shares) + 1);
    workers_.run(shares, [&](int i) {
      auto& counts = firsts[static_cast<std::size_t>(i) + 1];
      for (std::size_t k = start(i); k < start(i + 1); ++k) ++counts[solids_.shape(k).index()];
    });
    for (std::size_t i = 1; i < firsts.size(); ++i)
      for (std::size_t kind = 0; kind < kinds; ++kind) firsts[i][kind] += firsts[i - 1][kind];
    scene_ = embreeApi.rtcNewScene(device_);
    std::array<Target, kinds> targets;
    std::vector<RTCGeometry> geometries;
    for (std::size_t kind = 0; kind < kinds; ++kind)
      if (firsts.back()[kind] > 0) geometries.push_back(makeGeometry(kind, firsts.back()[kind], targets[kind]));
    workers_.run(shares, [&](int i) {
      std::array<std::size_t, kinds> at = firsts[static_cast<std::size_t>(i)];
      for (std::size_t k = start(i); k < start(i + 1); ++k) {
        const ShapeRef shape = solids_.shape(k);
        writeSolid(shape, targets[shape.index()], at[shape.index()]++);
      }
    });
    for (const RTCGeometry geometry : geometries) {
      embreeApi.rtcCommitGeometry(geometry);
      embreeApi.rtcAttachGeometry(scene_, geometry);
      embreeApi.rtcReleaseGeometry(geometry);
    }
    embreeApi.rtcCommitScene(scene_);
    if (const RTCError error = embreeApi.rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
      throw Error(Exit::usage, "--against embree: Embree cannot build the scene, error " + std::to_string(error));
  }

  RTCGeometry makeGeometry(std::size_t kind, std::size_t count, Target& target) {
    const auto newBuffer = [](RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t bytes,
                              std::size_t n) {
      return embreeApi.rtcSetNewGeometryBuffer(geometry, type, 0, format, bytes, n);
    };
    if (kind == sphere || kind == disc) {
      const RTCGeometry geometry = embreeApi.rtcNewGeometry(
          device_, kind == sphere ? RTC_GEOMETRY_TYPE_SPHERE_POINT : RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
      target.numbers =
          static_cast<float*>(newBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float), count));
      if (kind == disc)
        target.normals = static_cast<float*>(
            newBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, RTC_FORMAT_FLOAT3, 3 * sizeof(float), count));
      return geometry;
    }
    if (const auto corners = static_cast<std::size_t>(kCorners[kind]); corners > 0) {
      const RTCGeometry geometry =
          embreeApi.rtcNewGeometry(device_, kind == triangle ? RTC_GEOMETRY_TYPE_TRIANGLE : RTC_GEOMETRY_TYPE_QUAD);
      target.numbers = static_cast<float*>(
          newBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float), corners * count));
      target.corners = static_cast<unsigned*>(newBuffer(geometry, RTC_BUFFER_TYPE_INDEX,
                                                        kind == triangle ? RTC_FORMAT_UINT3 : RTC_FORMAT_UINT4,
                                                        corners * sizeof(unsigned), count));
      return geometry;
    }
    const RTCGeometry geometry = embreeApi.rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    embreeApi.rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
    UserKind& user = users_[kind];
    user.numbers.resize(count * static_cast<std::size_t>(kFloats[kind]));
    user.boxes.resize(count);
    user.solids.records = target.numbers = user.numbers.data();
    embreeApi.rtcSetGeometryUserData(geometry, &user);
    embreeApi.rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* call) {
          *call->bounds_o = static_cast<const UserKind*>(call->geometryUserPtr)->boxes[call->primID];
        },
        nullptr);
    embreeApi.rtcSetGeometryIntersectFunction(geometry, kind == plane ? kernels_.embreePlanes
                                                        : kind == box ? kernels_.embreeBoxes
                                                                      : kernels_.embreeQuadrics);
    return geometry;
  }

  void writeSolid(ShapeRef shape, const Target& target, std::size_t at) {
    const std::size_t kind = shape.index();
    shape.visit(
        [&](const auto& solid) { write(solid, target.numbers + at * static_cast<std::size_t>(kFloats[kind])); });
    if (const auto* s = shape.getIf<Disc>()) put(target.normals + 3 * at, glm::normalize(vec(s->normal)));
    if (const auto* s = shape.getIf<InfinitePlane>()) users_[plane].boxes[at] = bounds(*s);
    if (const auto* s = shape.getIf<AABox>()) users_[box].boxes[at] = bounds(*s);
    if (const auto* s = shape.getIf<Quadric>()) users_[quadric].boxes[at] = bounds(*s);
    const auto corners = static_cast<std::size_t>(kCorners[kind]);
    for (std::size_t i = 0; i < corners; ++i)
      target.corners[corners * at + i] = static_cast<unsigned>(corners * at + i);
  }

  struct UserKind {
    UserSolids solids;  // first: the callbacks read it
    std::vector<float> numbers;
    std::vector<RTCBounds> boxes;
  };

  const Solids& solids_;
  Light light_;
  bool packets_;
  const Kernels& kernels_;
  Rays rays_;
  WordImage image_;
  Workers workers_;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::array<UserKind, kinds> users_;
};

}  // namespace

std::unique_ptr<Peer> embreePeer(const Scene& scene, int width, int height, bool packets, const Kernels* kernels) {
  if (kernels == nullptr)
    throw Error(Exit::usage, "--against embree: this CPU has neither AVX-512 nor AVX2 with FMA, expected one of them");
  loadEmbree();
  return std::make_unique<EmbreePeer>(scene, width, height, packets, *kernels);
}

}  // namespace solidcast::bench

#else

namespace solidcast::bench {

std::unique_ptr<Peer> embreePeer(const Scene&, int, int, bool, const Kernels*) {
  throw Error(
      Exit::usage,
      "--against embree: this program was built without Embree 3, expected a build with it: install the package "
      "libembree-dev, run cmake again and build");
}

}  // namespace solidcast::bench
#endif
