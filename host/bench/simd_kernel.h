// The hand-written peer: kWide rays of a row at a time, solid after solid, with everything that depends on the shared
// origin calculated beforehand (kernels.h has the records). Included once for each instruction set, inside its
// namespace, after the operations on V (numbers) and M (decisions).
// Textbook tests in t, unit directions. kSkip: a packet that misses a solid altogether leaves its test early; without,
// every test runs to its end, as a shader's does.

struct Triplet {
  V x, y, z;
};
V dot(const Triplet& d, const float* n) { return d.x * all(n[0]) + d.y * all(n[1]) + d.z * all(n[2]); }

/// Directions of kWide columns from `column` on.
template <CameraKind kCamera>
Triplet direction(const RayView& rays, const RayRow& row, int column) {
  const V p = load(rays.p + column);
  Triplet d{all(row.a[0]) + p * all(row.b[0]), all(row.a[1]) + p * all(row.b[1]), all(row.a[2]) + p * all(row.b[2])};
  if constexpr (kCamera == CameraKind::environment) {
    const V q = load(rays.q + column);
    d.x += q * all(row.c[0]), d.y += q * all(row.c[1]), d.z += q * all(row.c[2]);
  }
  if constexpr (kCamera == CameraKind::perspective) {
    const V scale = all(1) / root(d.x * d.x + d.y * d.y + d.z * d.z);
    d.x *= scale, d.y *= scale, d.z *= scale;
  }
  return d;
}

struct Found {
  V t, cosine;
  void offer(M hit, V tHit, V cosineHit) {
    t = select(hit, tHit, t);
    cosine = select(hit, cosineHit, cosine);
  }
};
M inReach(V t, const Found& best) { return both(less(all(0), t), less(t, best.t)); }

void testPlane(const float* r, const Triplet& d, Found& best) {
  const V q = dot(d, r), t = all(r[3]) / q;
  best.offer(inReach(t, best), t, -q);
}

template <bool kSkip>
void testSphere(const float* r, const Triplet& d, Found& best) {
  const V b = dot(d, r), D = b * b - all(r[3]);
  const M meets = atMost(all(0), D);
  if (kSkip && !any(meets)) return;
  const V h = root(D), t = b - all(r[4]) * h;
  best.offer(both(meets, inReach(t, best)), t, all(r[5]) * h);
}

template <bool kSkip>
void testDisc(const float* r, const Triplet& d, Found& best) {
  const V q = dot(d, r), t = all(r[3]) / q;
  const M reached = inReach(t, best);
  if (kSkip && !any(reached)) return;
  const V x = t * d.x - all(r[4]), y = t * d.y - all(r[5]), z = t * d.z - all(r[6]);
  best.offer(both(reached, atMost(x * x + y * y + z * z, all(r[7]))), t, -q);
}

/// u and v times |q|; the sign of q is taken out of them.
template <bool kSkip, bool kQuad>
void testSpan(const float* r, const Triplet& d, Found& best) {
  const V q = dot(d, r), sign = signOf(q), size = magnitude(q);
  const V u = flip(dot(d, r + 4), sign), v = flip(dot(d, r + 7), sign);
  const V last = kQuad ? size - larger(u, v) : size - u - v;
  const M inside = atMost(all(0), smaller(smaller(u, v), last));
  if (kSkip && !any(inside)) return;
  const V t = all(r[3]) / q;
  best.offer(both(inside, inReach(t, best)), t, -q);
}

template <bool kSkip>
void testBox(const float* r, const Triplet& d, const Triplet& inverse, Found& best) {
  const V x1 = all(r[0]) * inverse.x, x2 = all(r[3]) * inverse.x;
  const V y1 = all(r[1]) * inverse.y, y2 = all(r[4]) * inverse.y;
  const V z1 = all(r[2]) * inverse.z, z2 = all(r[5]) * inverse.z;
  const V inX = smaller(x1, x2), inY = smaller(y1, y2), inZ = smaller(z1, z2);
  const V outX = larger(x1, x2), outY = larger(y1, y2), outZ = larger(z1, z2);
  const V enter = larger(larger(inX, inY), inZ), leave = smaller(smaller(outX, outY), outZ);
  const M meets = both(atMost(enter, leave), less(all(0), leave));
  if (kSkip && !any(meets)) return;
  const M outside = less(all(0), enter);
  const V t = select(outside, enter, leave);
  const V boundX = select(outside, inX, outX), boundY = select(outside, inY, outY);
  const V along =
      select(atMost(magnitude(t - boundX), all(0)), d.x, select(atMost(magnitude(t - boundY), all(0)), d.y, d.z));
  const V towards = magnitude(along);
  best.offer(both(meets, inReach(t, best)), t, select(outside, towards, -towards));
}

template <bool kSkip>
void testQuadric(const float* r, const Triplet& d, Found& best) {
  const V half = all(0.5f);
  const V mx = all(r[0]) * d.x + half * (all(r[3]) * d.y + all(r[4]) * d.z);
  const V my = all(r[1]) * d.y + half * (all(r[3]) * d.x + all(r[5]) * d.z);
  const V mz = all(r[2]) * d.z + half * (all(r[4]) * d.x + all(r[5]) * d.y);
  const V A = mx * d.x + my * d.y + mz * d.z, B = dot(d, r + 6), C = all(r[9]);
  const V D = B * B - A * C;
  const M meets = atMost(all(0), D);
  if (kSkip && !any(meets)) return;
  const V h = root(D), z = -(B + flip(h, signOf(B)));  // roots z/A and C/z
  const V t1 = z / A, t2 = C / z, none = best.t;
  const V first = select(less(all(0), t1), t1, none), second = select(less(all(0), t2), t2, none);
  const V t = smaller(first, second);
  const M hit = both(meets, inReach(t, best));
  if (kSkip && !any(hit)) return;
  const V gx = all(r[6]) + t * mx, gy = all(r[7]) + t * my, gz = all(r[8]) + t * mz;
  const V along = gx * d.x + gy * d.y + gz * d.z;
  best.offer(hit, t, -along / root(gx * gx + gy * gy + gz * gz));
}

W level(V v) { return whole(smaller(larger(v, all(0)), all(1)) * all(255)); }

/// 8-bit colour of what was found; a miss has the cosine 0.
W shade(const Light& light, V t, V cosine) {
  if (light.twoSided) cosine = magnitude(cosine);
  if (!light.dist) return either(times(level(cosine), words(0x010101u)), words(0xff000000u));
  cosine = larger(cosine, all(0));
  const V part = smaller(larger((t - all(light.nearDist)) * all(light.scale), all(0)), all(1));
  const W red = level((all(light.nearColor[0]) + part * all(light.step[0])) * cosine);
  const W green = level((all(light.nearColor[1]) + part * all(light.step[1])) * cosine);
  const W blue = level((all(light.nearColor[2]) + part * all(light.step[2])) * cosine);
  return either(either(red, up<8>(green)), either(up<16>(blue), words(0xff000000u)));
}

template <CameraKind kCamera, bool kSkip>
void rowsOf(const SimdScene& scene, const RayView& rays, const Light& light, std::uint32_t* out, int first) {
  using S = SimdScene;
  const auto each = [&](S::Kind kind, auto test) {
    const float* record = scene.records[kind];
    for (int i = 0; i < scene.count[kind]; ++i, record += kSimdFloats[kind]) test(record);
  };
  for (int y = first; y < first + kPacketRows; ++y)
    for (int x = 0; x < rays.stride; x += kWide) {
      const Triplet d = direction<kCamera>(rays, rays.rows[y], x);
      Found best{all(3e38f), all(0)};
      each(S::plane, [&](const float* r) { testPlane(r, d, best); });
      each(S::sphere, [&](const float* r) { testSphere<kSkip>(r, d, best); });
      each(S::disc, [&](const float* r) { testDisc<kSkip>(r, d, best); });
      each(S::triangle, [&](const float* r) { testSpan<kSkip, false>(r, d, best); });
      each(S::quad, [&](const float* r) { testSpan<kSkip, true>(r, d, best); });
      if (scene.count[S::box] > 0) {
        const Triplet inverse{all(1) / d.x, all(1) / d.y, all(1) / d.z};
        each(S::box, [&](const float* r) { testBox<kSkip>(r, d, inverse, best); });
      }
      each(S::quadric, [&](const float* r) { testQuadric<kSkip>(r, d, best); });
      store(out + static_cast<long>(y) * rays.stride + x, shade(light, best.t, best.cosine));
    }
}

template <bool kSkip>
void simdRows(const SimdScene& scene, const RayView& rays, const Light& light, std::uint32_t* out, int first) {
  if (rays.camera == CameraKind::perspective) rowsOf<CameraKind::perspective, kSkip>(scene, rays, light, out, first);
  else rowsOf<CameraKind::environment, kSkip>(scene, rays, light, out, first);
}
