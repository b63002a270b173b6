// QueryCaster: free rays, a block at a time.
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "host/cast/index.h"
#include "host/cast/plan.h"
#include "host/cast/second_pass.h"
#include "host/cast/stopwatch.h"
#include "host/error.h"

namespace solidcast {
namespace {

// rays.comp: Portion, QueryRay, QueryHit
struct RayPush {
  std::uint32_t rays, stage;
  SearchPortion search;
};
struct RayRow {
  float origin[3], tMax, direction[3], unused;
};
struct HitRow {
  std::int32_t index;
  float t, normal[3], local[3], position[3];
};
static_assert(sizeof(RayRow) == 32 && sizeof(HitRow) == 44);

constexpr std::size_t blockRays = 65536;
// fp32 sees solids blurred: what it takes for hits lies mostly within this part of a solid's size beside it.
constexpr double blur = 1.0 / 64;

V3 vectorOf(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace

struct QueryCaster::Impl {
  gpu::Device& device;
  CastOptions options;
  const World* world = nullptr;
  Program program;
  gpu::Specialisation constants;
  std::vector<SearchPortion> search;
  std::optional<Index> index;
  std::optional<gpu::Pipeline> pipeline;
  std::vector<gpu::Buffer> buffers;
  std::optional<SecondPass> second;
  std::uint32_t lastRays = 0;  // of the last block
  CastStats stats;

  Impl(gpu::Device& d, const World& w, const CastOptions& o) : device(d), options(o), buffers(9) {
    std::string why;
    program.job = Job::rays;
    program.method = options.method;
    program.real = chooseReal(device.info(), options, Job::rays, 0, why);
    program.hits = options.method != Method::exact;
    stats.plan.push_back(why);
    buffers[2] = device.makeBuffer(blockRays * sizeof(RayRow), gpu::BufferUse::storage);
    buffers[3] = device.makeBuffer(blockRays * sizeof(HitRow), gpu::BufferUse::readback);
    setWorld(w);
  }

  void setWorld(const World& w) {
    Stopwatch flattening;
    world = &w;
    if (!w.customSolids.empty())
      throw Error(Exit::usage, w.customSolids[0].code.file +
                                   ": free rays are not cast at custom solids, expected a scene without them");
    const PlanFacts facts = planFacts(device.info(), w, program, blockRays, options);
    const PlanChoice choice = choosePlan(facts, options.plan);
    Program next = program;
    next.index = choice.plan == Plan::index;
    next.storage = choice.plan != Plan::uniform;
    Records records = worldRecords(w, {}, next.real);
    index.reset();
    if (next.index) {
      index.emplace(buildIndex(w, options.method == Method::exact ? 0 : blur));
      records = inOrder(records, *index);
    }
    search = next.index ? indexedSearch(records) : next.storage ? portions(records) : std::vector<SearchPortion>(1);
    stats.flatten_ms += flattening.ms();

    Stopwatch making;
    const bool same = pipeline && next.storage == program.storage && next.index == program.index;
    program = next;
    gpu::Specialisation wanted = recordConstants(program, records, records);
    // s to 2^-25.5 in fp64; in fp32 decisions that 2^-24 can tell, since t comes from the second pass.
    wanted[doubt] = bits(std::ldexp(1.f, program.real == RealType::f64 ? -23 : -9));
    if (!same || wanted != constants) {
      std::vector<std::uint32_t> spirv = programModule(program, options).spirv;
      pipeline.emplace(device.makePipeline(spirv, wanted));
      stats.spirvBytes = spirv.size() * 4;
      stats.specialisedSpirvBytes = pipeline->spirvBytes();
      stats.plan.resize(1);
      for (const std::string& line : planLines(facts, choice, options.plan)) stats.plan.push_back(line);
    }
    constants = wanted;
    const auto storage = gpu::BufferUse::storage;
    buffers[1] = filledBuffer(device, records.bytes, program.storage ? storage : gpu::BufferUse::uniform);
    if (program.storage)
      buffers[6] = device.makeBuffer(search.size() > 1 || program.index ? blockRays * 48 : 64, storage);
    if (program.index) {
      buffers[0] = filledBuffer(device, std::as_bytes(std::span(index->nodes)), storage);
      buffers[8] = filledBuffer(device, std::as_bytes(std::span(index->skips)), storage);
      buffers[4] = device.makeBuffer(blockRays * sizeof(IndexRay), storage);
      buffers[5] = device.makeBuffer(16, gpu::BufferUse::readback);
    }
    if (program.hits) buffers[7] = filledBuffer(device, std::as_bytes(std::span(records.places)), storage);
    stats.shader_ms += making.ms();
    stats.modules = {program.moduleName()};
    stats.planName = planName(choice.plan);
    stats.leftOut = leftOutLines(program, w, {});
    stats.deviceBytes = device.peakBytes();
    if (options.method == Method::exact) second.emplace(w, index ? &*index : nullptr);
  }

  /// rays.comp: Portion, of an index.
  std::vector<SearchPortion> indexedSearch(const Records& records) const {
    SearchPortion all;
    for (std::size_t k = 0; k < kindCount; ++k) {
      all.count[k] = index->end[k];
      all.firstRow[k] = records.firstRow[k] - index->firstPlace[k] * records.rowsPer[k];  // modulo 2^32
    }
    return {all};
  }

  /// The shader over the rays in the buffer; GPU time in ms.
  double dispatch(std::uint32_t n) {
    std::vector<const gpu::Buffer*> bound;
    for (const gpu::Buffer& b : buffers) bound.push_back(b.bytes().empty() ? nullptr : &b);
    if (program.index) return dispatchUntilThrough(n, bound);
    std::vector<RayPush> pushes;
    for (std::size_t p = 0; p < search.size(); ++p)
      pushes.push_back({n, (p == 0 ? 1u : 0u) | (p + 1 == search.size() ? 2u : 0u), search[p]});
    std::vector<gpu::Dispatch> dispatches;
    for (const RayPush& push : pushes) dispatches.push_back(dispatchOf(n, bound, push));
    return device.run(dispatches);
  }

  gpu::Dispatch dispatchOf(std::uint32_t n, const std::vector<const gpu::Buffer*>& bound, const RayPush& push) const {
    return {&*pipeline, bound, std::as_bytes(std::span(&push, 1)), {(n + 63) / 64, 1, 1}};
  }

  /// Rays that have not seen the whole index go on where they were.
  double dispatchUntilThrough(std::uint32_t n, const std::vector<const gpu::Buffer*>& bound) {
    double ms = 0;
    auto unfinished = buffers[5].as<std::uint32_t>();
    for (std::uint32_t first = 1; first == 1 || unfinished[0] != 0; first = 0) {
      unfinished[0] = 0;
      const RayPush push{n, first, search[0]};
      const gpu::Dispatch dispatch = dispatchOf(n, bound, push);
      ms += device.run({&dispatch, 1});
      ++stats.dispatches;
    }
    return ms;
  }

  void upload(std::span<const QueryRay> rays) {
    auto rows = buffers[2].as<RayRow>();
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const QueryRay& r = rays[i];
      rows[i] = {{r.origin[0], r.origin[1], r.origin[2]}, r.tMax, {r.direction[0], r.direction[1], r.direction[2]}, 0};
    }
    if (program.index) {
      auto boxRays = buffers[4].as<IndexRay>();
      for (std::size_t i = 0; i < rays.size(); ++i) boxRays[i] = indexRay(rows[i].origin, rows[i].direction);
    }
    lastRays = static_cast<std::uint32_t>(rays.size());
  }

  void block(std::span<const QueryRay> rays, std::span<QueryHit> hits) {
    upload(rays);
    Stopwatch dispatching;
    double ms = dispatch(lastRays);
    if (stats.rays == 0) stats.first_dispatch_ms = dispatching.ms();
    stats.dispatch_ms += ms;
    stats.rays += lastRays;
    Stopwatch again;
    auto found = buffers[3].as<HitRow>();
    if (second) {
      for (std::size_t i = 0; i < rays.size(); ++i) stats.fallbackRays += found[i].index == -2;
      inParallel(rays.size(), [&](std::size_t i) { hits[i] = exactHit(rays[i], found[i].index); });
    } else {
      for (std::size_t i = 0; i < rays.size(); ++i) {
        const HitRow& h = found[i];
        hits[i] = {};
        if (h.index < 0 || !std::isfinite(h.t)) continue;
        hits[i].index = h.index;
        hits[i].t = h.t;
        std::memcpy(hits[i].normal.data(), h.normal, sizeof h.normal);
        std::memcpy(hits[i].local.data(), h.local, sizeof h.local);
        std::memcpy(hits[i].position.data(), h.position, sizeof h.position);
      }
    }
    stats.fallback_ms += again.ms();
  }

  QueryHit exactHit(const QueryRay& given, std::int32_t index) const {
    if (index == -1) return {};
    RayQ ray{vectorOf(given.origin), vectorOf(given.direction), true};
    ExactHit hit;
    if (index >= 0) hit = second->castAt(ray, index);
    if (!hit) hit = std::isinf(given.tMax) ? second->cast(ray) : second->cast(ray, f128(given.tMax));
    // Beyond fp32's largest number lies the far limit of a query.
    if (!hit || std::isinf(static_cast<float>(hit.t))) return {};
    Surface s = second->surface(ray, hit);
    V3 p = ray.origin + hit.t * ray.direction;
    QueryHit out;
    out.index = hit.index;
    out.t = static_cast<float>(hit.t);
    for (int k = 0; k < 3; ++k) {
      auto at = static_cast<std::size_t>(k);
      out.normal[at] = static_cast<float>(s.normal[k]);
      out.local[at] = static_cast<float>(s.local[k]);
      out.position[at] = static_cast<float>(p[k]);
    }
    return out;
  }
};

QueryCaster::QueryCaster(gpu::Device& device, const World& world, const CastOptions& options)
    : impl_(std::make_unique<Impl>(device, world, options)) {}
QueryCaster::~QueryCaster() = default;

void QueryCaster::cast(std::span<const QueryRay> rays, std::span<QueryHit> hits) {
  for (std::size_t first = 0; first < rays.size(); first += blockRays) {
    std::size_t n = std::min(blockRays, rays.size() - first);
    impl_->block(rays.subspan(first, n), hits.subspan(first, n));
  }
}

void QueryCaster::setWorld(const World& world) { impl_->setWorld(world); }

double QueryCaster::dispatchOnly(std::span<const QueryRay> rays) {
  if (!rays.empty()) impl_->upload(rays.first(std::min(blockRays, rays.size())));
  return impl_->lastRays > 0 ? impl_->dispatch(impl_->lastRays) : 0;
}

const CastStats& QueryCaster::stats() const { return impl_->stats; }

}  // namespace solidcast
