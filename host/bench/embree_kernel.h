// Embree's peer: packets of 4x4 rays (or single rays) to rtcIntersect, its hits to colours, and the tests of the kinds
// that Embree lacks as its callbacks. Included after simd_kernel.h, whose directions and colours it shares.

V cosineOf(const Triplet& d, const Triplet& n) {
  const V along = n.x * d.x + n.y * d.y + n.z * d.z;
  return -along / root(n.x * n.x + n.y * n.y + n.z * n.z);
}

template <CameraKind kCamera>
Triplet originOf(const RayView& rays, const RayRow& row, int column) {
  Triplet o{all(row.origin[0]), all(row.origin[1]), all(row.origin[2])};
  if constexpr (kCamera == CameraKind::orthographic) {
    const V p = load(rays.p + column);
    o.x += p * all(row.across[0]), o.y += p * all(row.across[1]), o.z += p * all(row.across[2]);
  }
  return o;
}

/// Rays of 16 x 4 pixels, plane after plane: origin and direction.
struct Strip {
  alignas(64) float number[6][kPacketRows][kPacketWidth];
};
template <CameraKind kCamera>
void fill(const RayView& rays, int first, int column, Strip& strip) {
  const M every = lanes(kWide);
  for (int y = 0; y < kPacketRows; ++y)
    for (int x = 0; x < kPacketWidth; x += kWide) {
      const RayRow& row = rays.rows[first + y];
      const Triplet o = originOf<kCamera>(rays, row, column + x), d = direction<kCamera>(rays, row, column + x);
      store(every, &strip.number[0][y][x], o.x), store(every, &strip.number[1][y][x], o.y);
      store(every, &strip.number[2][y][x], o.z), store(every, &strip.number[3][y][x], d.x);
      store(every, &strip.number[4][y][x], d.y), store(every, &strip.number[5][y][x], d.z);
    }
}
void fillStrip(const RayView& rays, int first, int column, Strip& strip) {
  if (rays.camera == CameraKind::perspective) fill<CameraKind::perspective>(rays, first, column, strip);
  else if (rays.camera == CameraKind::orthographic) fill<CameraKind::orthographic>(rays, first, column, strip);
  else fill<CameraKind::environment>(rays, first, column, strip);
}

constexpr float kFar = 3e38f;

void embree16(RTCSceneTy* scene, const RayView& rays, const Light& light, std::uint32_t* out, int first) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(64) int valid[16];
  for (int& v : valid) v = -1;
  Strip strip;
  RTCRayHit16 packet;
  const M every = lanes(kWide);
  for (int column = 0; column < rays.stride; column += kPacketWidth) {
    fillStrip(rays, first, column, strip);
    for (int x = 0; x < kPacketWidth; x += 4) {
      float* lines[6] = {packet.ray.org_x, packet.ray.org_y, packet.ray.org_z,
                         packet.ray.dir_x, packet.ray.dir_y, packet.ray.dir_z};
      for (int k = 0; k < 6; ++k)
        for (int y = 0; y < 4; ++y) _mm_store_ps(lines[k] + 4 * y, _mm_load_ps(&strip.number[k][y][x]));
      for (int i = 0; i < 16; i += kWide) {
        store(every, packet.ray.tnear + i, all(0)), store(every, packet.ray.tfar + i, all(kFar));
        store(every, packet.ray.time + i, all(0)), store(every, packet.ray.mask + i, ~0u);
        store(every, packet.ray.flags + i, 0u), store(every, packet.ray.id + i, 0u);
        store(every, packet.hit.geomID + i, RTC_INVALID_GEOMETRY_ID);
        store(every, packet.hit.instID[0] + i, RTC_INVALID_GEOMETRY_ID);
      }
      embreeApi.rtcIntersect16(valid, scene, &context, &packet);
      alignas(64) std::uint32_t colours[16];
      for (int i = 0; i < 16; i += kWide) {
        const V t = load(packet.ray.tfar + i);
        const Triplet d{load(packet.ray.dir_x + i), load(packet.ray.dir_y + i), load(packet.ray.dir_z + i)};
        const Triplet n{load(packet.hit.Ng_x + i), load(packet.hit.Ng_y + i), load(packet.hit.Ng_z + i)};
        store(colours + i, shade(light, t, select(less(t, all(kFar)), cosineOf(d, n), all(0))));
      }
      for (int y = 0; y < 4; ++y)
        _mm_storeu_si128(reinterpret_cast<__m128i*>(out + static_cast<long>(first + y) * rays.stride + column + x),
                         _mm_load_si128(reinterpret_cast<const __m128i*>(colours + 4 * y)));
    }
  }
}

void embree1(RTCSceneTy* scene, const RayView& rays, const Light& light, std::uint32_t* out, int first) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  Strip strip;
  alignas(64) float t[kPacketWidth], n[3][kPacketWidth];
  for (int column = 0; column < rays.stride; column += kPacketWidth) {
    fillStrip(rays, first, column, strip);
    for (int y = 0; y < kPacketRows; ++y) {
      for (int x = 0; x < kPacketWidth; ++x) {
        const auto at = [&](int k) { return strip.number[k][y][x]; };
        RTCRayHit one;
        one.ray = {at(0), at(1), at(2), 0, at(3), at(4), at(5), 0, kFar, ~0u, 0, 0};
        one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        embreeApi.rtcIntersect1(scene, &context, &one);
        t[x] = one.ray.tfar;
        n[0][x] = one.hit.Ng_x, n[1][x] = one.hit.Ng_y, n[2][x] = one.hit.Ng_z;
      }
      for (int x = 0; x < kPacketWidth; x += kWide) {
        const V far = load(t + x);
        const Triplet d{load(&strip.number[3][y][x]), load(&strip.number[4][y][x]), load(&strip.number[5][y][x])};
        const V cosine = cosineOf(d, {load(n[0] + x), load(n[1] + x), load(n[2] + x)});
        store(out + static_cast<long>(first + y) * rays.stride + column + x,
              shade(light, far, select(less(far, all(kFar)), cosine, all(0))));
      }
    }
  }
}

/// One solid and the rays of a callback, kWide at a time: test(o, d, t, n) gives where it is hit, t and a normal.
template <class Test>
void eachRay(const RTCIntersectFunctionNArguments* call, Test test) {
  const int count = static_cast<int>(call->N);
  float* ray = reinterpret_cast<float*>(call->rayhit);
  auto* hit = reinterpret_cast<unsigned*>(ray + 12 * count);  // origin, tnear, direction, time, tfar, mask, id, flags
  for (int at = 0; at < count; at += kWide) {
    const M m = lanes(count - at < kWide ? count - at : kWide);
    const auto field = [&](int k) { return load(m, ray + k * count + at); };
    const Triplet o{field(0), field(1), field(2)}, d{field(4), field(5), field(6)};
    V t;
    Triplet n;
    M hits = both(loadMask(m, call->valid + at), test(o, d, t, n));
    hits = both(hits, both(less(field(3), t), less(t, field(8))));
    if (!any(hits)) continue;
    store(hits, ray + 8 * count + at, t);
    store(hits, reinterpret_cast<float*>(hit) + at, n.x);
    store(hits, reinterpret_cast<float*>(hit) + count + at, n.y);
    store(hits, reinterpret_cast<float*>(hit) + 2 * count + at, n.z);
    store(hits, hit + 5 * count + at, call->primID);
    store(hits, hit + 6 * count + at, call->geomID);
    store(hits, hit + 7 * count + at, RTC_INVALID_GEOMETRY_ID);
  }
}

const float* recordOf(const RTCIntersectFunctionNArguments* call, int floats) {
  return static_cast<const UserSolids*>(call->geometryUserPtr)->records + static_cast<long>(call->primID) * floats;
}

void planes(const RTCIntersectFunctionNArguments* call) {
  const float* r = recordOf(call, kUserFloats[0]);
  eachRay(call, [&](const Triplet& o, const Triplet& d, V& t, Triplet& n) {
    t = (all(r[3]) - dot(o, r)) / dot(d, r);
    n = {all(r[0]), all(r[1]), all(r[2])};
    return less(all(0), t);
  });
}

void boxes(const RTCIntersectFunctionNArguments* call) {
  const float* r = recordOf(call, kUserFloats[1]);
  eachRay(call, [&](const Triplet& o, const Triplet& d, V& t, Triplet& n) {
    const V x1 = (all(r[0]) - o.x) / d.x, x2 = (all(r[3]) - o.x) / d.x;
    const V y1 = (all(r[1]) - o.y) / d.y, y2 = (all(r[4]) - o.y) / d.y;
    const V z1 = (all(r[2]) - o.z) / d.z, z2 = (all(r[5]) - o.z) / d.z;
    const V inX = smaller(x1, x2), inY = smaller(y1, y2), inZ = smaller(z1, z2);
    const V outX = larger(x1, x2), outY = larger(y1, y2), outZ = larger(z1, z2);
    const V enter = larger(larger(inX, inY), inZ), leave = smaller(smaller(outX, outY), outZ);
    const M outside = less(all(0), enter);
    t = select(outside, enter, leave);
    const M onX = atMost(magnitude(t - select(outside, inX, outX)), all(0));
    const M onY = atMost(magnitude(t - select(outside, inY, outY)), all(0));
    const V zero = all(0), against = select(outside, all(-1), all(1));
    n.x = select(onX, flip(against, signOf(d.x)), zero);
    n.y = select(onX, zero, select(onY, flip(against, signOf(d.y)), zero));
    n.z = select(onX, zero, select(onY, zero, flip(against, signOf(d.z))));
    return both(atMost(enter, leave), less(all(0), leave));
  });
}

void quadrics(const RTCIntersectFunctionNArguments* call) {
  const float* r = recordOf(call, kUserFloats[2]);
  const auto apply = [&](const Triplet& v) {
    const V half = all(0.5f);
    return Triplet{all(r[0]) * v.x + half * (all(r[3]) * v.y + all(r[4]) * v.z),
                   all(r[1]) * v.y + half * (all(r[3]) * v.x + all(r[5]) * v.z),
                   all(r[2]) * v.z + half * (all(r[4]) * v.x + all(r[5]) * v.y)};
  };
  const auto product = [](const Triplet& a, const Triplet& b) { return a.x * b.x + a.y * b.y + a.z * b.z; };
  eachRay(call, [&](const Triplet& given, const Triplet& d, V& t, Triplet& n) {
    // The equation is told from the solid's own place, so that its terms do not cancel (kernels.h).
    const Triplet o{given.x - all(r[10]), given.y - all(r[11]), given.z - all(r[12])};
    const Triplet Md = apply(d), Mo = apply(o);
    const Triplet w{Mo.x + all(r[6]), Mo.y + all(r[7]), Mo.z + all(r[8])};
    const V A = product(Md, d), B = product(w, d);
    const V C = product(Mo, o) + all(2) * dot(o, r + 6) + all(r[9]);
    const V D = B * B - A * C, h = root(D), z = -(B + flip(h, signOf(B)));
    const V t1 = z / A, t2 = C / z;
    t = smaller(select(less(all(0), t1), t1, all(kFar)), select(less(all(0), t2), t2, all(kFar)));
    n = {w.x + t * Md.x, w.y + t * Md.y, w.z + t * Md.z};
    return atMost(all(0), D);
  });
}
