// Quadric p'Mp + 2 l.p + j = 0; normal along the gradient M p + l. A ray inside the surface (A = B = C = 0) misses.
//
// eye    w = M o + l, C = Q(o), B = w.d, A = d'Md: A + 2 B s + C s^2 = 0. The host negates all three so that C >= 0
//        (`sign` remembers) and scales them by powers of two (kappa undoes it); the wanted root is then the larger:
//        q = B^2 - C A, h = sqrt q, s = B > 0 ? -A/(h + B) : (h - B)/C: no cancellation in either, and no case for
//        A == 0. Eye on the surface (C == 0): the root t = 0 does not count, s = -A/(2B).
//        Rounding: |q^ - q| <= 32u |d|^2 (|w|^2 + C |M|); s keeps 2^-28 unless q, h(h+|B|) or A is small against
//        the terms it was made of; those are counted as in doubt (docs/numerics.md has the factors).
// free   the same with w and C formed for each ray.
// naive  A t^2 + 2 B t + C by the schoolbook formula with a case for A == 0.
// The cosine needs |gradient|: with G = M d + s w (s times the half gradient), G.d = -+ s h.
// eye record    (Mxx, Myy, Mzz, C) (Mxy, Mxz, Myz, kappa) (w, index)
//               (sign, weight of q, weight of h(h+|B|), weight of A) (weight of B, -, -, -)
// world record  (Mxx, Myy, Mzz, index) (Mxy, Mxz, Myz, j) (l, -)
#ifndef SOLIDCAST_QUADRIC
#define SOLIDCAST_QUADRIC
#include "../hit.glsl"

void quadric_eye(uint row, EyeRay ray, inout Best best) {
  real4 m = record(row);
  real4 n = record(row + 1u);
  real4 w = record(row + 2u);
  real4 more = record(row + 3u);
  real3 d = ray.direction;
  real gx = linear(real3(m.x, n.x, n.y), d);
  real gy = linear(real3(n.x, m.y, n.z), d);
  real gz = linear(real3(n.y, n.z, m.z), d);
  real A = linear(real3(gx, gy, gz), d);
  real B = linear(real3(w.x, w.y, w.z), d);
  real q = sub(mul(B, B), mul(m.w, A));
  real h = root(q);
  bool away = less(number(0.0), B);
  bool on = isZero(m.w);
  real sum = add(h, magnitude(B));
  real small = quotient(negate(A), select(add(B, B), sum, away));
  real s = select(select(quotient(sum, m.w), small, on), small, away);
  decided(best, mul(q, more.y));
  decided(best, mul(select(settled(), mul(h, sum), atLeast(q, number(0.0))), more.z));
  decided(best, mul(select(settled(), A, away || on), more.w));
  decided(best, mul(B, record(row + 4u).x));
  // -n.d = sign s h / |G|; on the surface and entering, the ray leaves again, so the sign turns.
  gx = add(gx, mul(s, w.x));
  gy = add(gy, mul(s, w.y));
  gz = add(gz, mul(s, w.z));
  real steep = root(add(mul(gx, gx), add(mul(gy, gy), mul(gz, gz))));
  real cosine = quotient(mul(mul(s, h), more.x), steep);
  cosine = select(cosine, negate(cosine), on && !away);
  offer(best, less(number(0.0), s), mul(s, n.w), cosine, w.w);
}

#if ARITHMETIC != 2
real3 quadricTimes(real4 m, real4 n, real3 v) {
  return real3(linear(real3(m.x, n.x, n.y), v), linear(real3(n.x, m.y, n.z), v), linear(real3(n.y, n.z, m.z), v));
}

void quadric_free(uint row, FreeRay ray, inout Best best) {
  real4 m = worldRecord(row);
  real4 n = worldRecord(row + 1u);
  real3 l = worldRecord(row + 2u).xyz;
  real3 Md = quadricTimes(m, n, ray.direction);
  real3 Mo = quadricTimes(m, n, ray.origin);
  precise real3 w = Mo + l;
  real A = dot3(ray.direction, Md);
  real B = dot3(w, ray.direction);
  precise real C = dot3(ray.origin, w) + dot3(ray.origin, l) + n.w;
  real size = length3(m.xyz) + real(2) * length3(n.xyz);
  real wScale = size * ray.reach + length3(l);
  real cScale = (size * ray.reach + real(2) * length3(l)) * ray.reach + abs(n.w);
  real sgn = C < real(0) ? real(-1) : real(1);
  A = mul(A, sgn), B = mul(B, sgn), C = mul(C, sgn);
  real q = sub(mul(B, B), mul(C, A));
  real h = root(q);
  bool away = B > real(0);
  real sum = h + abs(B);
  bool on = C == real(0);  // the surface: t = 0 does not count
  real s = away || on ? quotient(-A, away ? sum : B + B) : quotient(sum, C);
  decidedAgainst(best, C, cScale);
  decidedAgainst(best, q, ray.squared * (wScale * wScale + cScale * size));
  decidedAgainst(best, q < real(0) ? wScale * wScale + cScale * size : mul(h, sum), ray.squared * (wScale * wScale + cScale * size));
  decidedAgainst(best, away ? A : real(1), away ? ray.squared * size : real(1));
  precise real3 G = Md * sgn + w * (s * sgn);
  real cosine = quotient(sgn * s * h, length3(G));
  offer(best, s > real(0), s, on && !away ? -cosine : cosine, m.w);
}

void quadric_naive(uint row, vec3 origin, vec3 direction, inout Nearest best) {
  real4 m = worldRecord(row);
  real4 n = worldRecord(row + 1u);
  vec3 l = vec3(worldRecord(row + 2u).xyz);
  precise vec3 w = vec3(quadricTimes(m, n, origin)) + l;
  float A = float(dot3(direction, quadricTimes(m, n, direction)));
  float B = float(dot3(w, direction));
  precise float C = float(dot3(origin, w)) + float(dot3(origin, l)) + float(n.w);
  precise float q = B * B - A * C;
  precise float h = sqrt(q);
  precise float t1 = (-B - h) / A;
  precise float t2 = (-B + h) / A;
  float near = min(t1, t2), far = max(t1, t2);
  precise float line = -C / (2.0 * B);
  float t = A == 0.0 ? line : near > 0.0 ? near : far;
  precise vec3 p = origin + t * direction;
  precise vec3 gradient = vec3(quadricTimes(m, n, p)) + l;
  float cosine = -float(dot3(unit3(gradient), direction));
  offerNaive(best, A == 0.0 || q >= 0.0, t, cosine, float(m.w));
}

void quadric_finish(uint row, real3 hit, real3 direction, real cosine, inout real3 normal,
                    inout real3 local) {
  precise real3 gradient = quadricTimes(worldRecord(row), worldRecord(row + 1u), hit) + worldRecord(row + 2u).xyz;
  normal = unit3(gradient);
  if (gradient == real3(0)) normal = unit3(-direction);  // a cone's apex: no gradient; it faces the ray
}
#endif
#endif
