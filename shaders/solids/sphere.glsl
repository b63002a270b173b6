// Sphere: |p - c|^2 = r^2, outward normal; from inside the far side is hit.
//
// eye    f = o - c, C = |f|^2 - r^2 (exact on the host, where subtracting them costs digits), b = f.d:
//        C s^2 + 2 b s + |d|^2 = 0, q = b^2 - |d|^2 C, s = (sqrt q - b) / |C|; the host negates f when the eye is
//        inside (C < 0), and the wanted root is always the larger. q < 0 gives NaN, which loses every comparison.
//        Everything is scaled so that the bound of q's error is the shader's DOUBT; kappa undoes it. An eye very near the surface
//        (|C| << |f|^2, where the numerator cancels) is given to the quadric's careful form by the host.
//        fast, where some sphere of the scene is farther than 16 radii (FAR_SPHERES): b^2 and |d|^2 C are then nearly equal, and
//        fp32 keeps nothing of q; by the vector from the centre to the ray, q = |d|^2 (r^2 - |f - d b / |d|^2|^2), it keeps
//        all but 2^-21 |f| / r of it. (1 / |d|^2 is the ray's own, one division for all spheres: what it rounds shifts that
//        vector along d, at right angles to it, and is squared away.)
//        Rounding: |q^ - q| <= 32u |d|^2 (|f|^2 + |C|); s keeps 2^-28 where q >= 64u^2 2^56 |d|^2 |f|^2.
// free   the same from c and r, with the cancelling numerator avoided: from inside t > 0 needs care on one side only.
// naive  a t^2 + 2 b t + c = 0 by the schoolbook formula.
// The cosine falls out of the test: n.d = -+ sqrt(q)/r.
// eye record    (f, C) (kappa, k, index, r^2)   cosine = k sqrt q
// world record  (c, r) (index, -, -, -)
#ifndef SOLIDCAST_SPHERE
#define SOLIDCAST_SPHERE
#include "../hit.glsl"

#ifndef FAR_SPHERES
#define FAR_SPHERES false
#endif

void sphere_eye(uint row, EyeRay ray, inout Best best) {
  real4 f = record(row);
  real4 more = record(row + 1u);
  real b = linear(real3(f.x, f.y, f.z), ray.direction);
  real q = sub(mul(b, b), mul(ray.squared, f.w));
#if ARITHMETIC == 0
  if (FAR_SPHERES) {
    precise real inverse = 1.0 / ray.squared;
    precise real3 across = f.xyz - ray.direction * (b * inverse);
    q = mul(ray.squared, sub(more.w, linear(across, across)));
  }
#endif
  real h = root(q);
  real s = mul(more.x, sub(h, b));
  decided(best, q);
  offer(best, true, s, mul(h, more.y), more.z);
}

#if ARITHMETIC != 2
void sphere_free(uint row, FreeRay ray, inout Best best) {
  real4 c = worldRecord(row);
  real index = worldRecord(row + 1u).x;
  real3 f = minus3(ray.origin, c.xyz);
  real size = originScale(ray, c.xyz, f), scale = size * size + c.w * c.w;
  real r = c.w, unit = real(1);
#ifndef EXACT  // squares of 1e20 overflow fp32; a power of two, so that scaling rounds nothing
  unit = larger(larger(larger(abs(f.x), abs(f.y)), abs(f.z)), r);
  unit = uintBitsToFloat(max(floatBitsToUint(unit) & 0x7f800000u, 0x00800000u));
  f = f / unit;
  r = r / unit;
#endif
  real outside = sub(dot3(f, f), mul(r, r));
  real b = dot3(f, ray.direction);
#ifdef EXACT
  real q = sub(mul(b, b), mul(ray.squared, outside));
#else  // the same by the vector from the centre to the ray: b^2 and |d|^2 C of a far small sphere cancel
  precise real3 across = f - ray.direction * (b / ray.squared);
  real q = mul(ray.squared, sub(mul(r, r), dot3(across, across)));
#endif
  real h = root(q);
  bool inner = outside < real(0) || (outside == real(0) && b < real(0));  // on the surface and entering: the far side
  // outside: (h - b)/C for b < 0; inside: (h + b)/-C leaving, a/(h - b) entering the centre's side
  real numerator = inner && b < real(0) ? ray.squared : inner ? h + b : h - b;
  real denominator = inner && b < real(0) ? h - b : abs(outside);
  real s = quotient(numerator, denominator);
  decidedAgainst(best, outside, scale);
  decidedAgainst(best, q, ray.squared * scale);
  offer(best, inner || b < real(0), quotient(s, unit), (inner ? -h : h) / r, index);
}

void sphere_naive(uint row, vec3 origin, vec3 direction, inout Nearest best) {
  vec4 c = vec4(worldRecord(row));
  float index = float(worldRecord(row + 1u).x);
  vec3 f = vec3(minus3(origin, c.xyz));
  float a = float(dot3(direction, direction));
  float b = float(dot3(f, direction));
  precise float q = b * b - a * (float(dot3(f, f)) - c.w * c.w);
  precise float h = sqrt(q);
  precise float near = (-b - h) / a;
  precise float far = (-b + h) / a;
  bool outside = near > 0.0;
  precise float cosine = (outside ? h : -h) / c.w;
  offerNaive(best, q >= 0.0, outside ? near : far, cosine, index);
}

void sphere_finish(uint row, real3 hit, real3 direction, real cosine, inout real3 normal,
                   inout real3 local) {
  real4 c = worldRecord(row);
  normal = unit3(minus3(hit, c.xyz));
}
#endif
#endif
