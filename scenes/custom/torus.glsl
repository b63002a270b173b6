// A torus: all points at distance r from the circle of radius R around the centre, across the axis.
//
// With q = q0 + s d, counted from the ray's point nearest to the centre (so that a far eye costs no digits) and R = 1,
//   P(s) = (|q|^2 + 1 - r^2)^2 - 4 (|q|^2 - (q.a)^2) = 0,  a quartic in s.
// Between the roots of its derivative a polynomial is monotone and has at most one root. So: the roots of P'' by the
// formula, between them those of P', between those the ones of P, each caught in a bracket that halves where Newton's
// step would leave it. Nothing is divided by what may vanish, and no root can be lost but one that only touches.

struct Quartic {
  float c[5];  // from s^0 up
};

float value(Quartic f, float s) { return (((f.c[4] * s + f.c[3]) * s + f.c[2]) * s + f.c[1]) * s + f.c[0]; }

Quartic derivative(Quartic f) {
  return Quartic(float[5](f.c[1], 2.0 * f.c[2], 3.0 * f.c[3], 4.0 * f.c[4], 0.0));
}

// The root between a and b, where f is monotone and changes sign.
float rootBetween(Quartic f, float a, float b) {
  Quartic slope = derivative(f);
  bool rises = value(f, b) > value(f, a);
  float s = 0.5 * (a + b);
  for (int round = 0; round < 30 && b - a > 1.0e-7; ++round) {
    float v = value(f, s);
    if ((v > 0.0) == rises) b = s;
    else a = s;
    float next = s - v / value(slope, s);
    bool kept = next > a && next < b;
    if (kept && abs(next - s) < 1.0e-7) return next;
    s = kept ? next : 0.5 * (a + b);
  }
  return s;
}

// The roots of f between cuts[0] and cuts[4], given the roots of its derivative (or those ends) in between; in their
// places, those that are missing as the last cut.
float[5] rootsBetween(Quartic f, float cuts[5]) {
  float roots[5] = float[5](cuts[0], cuts[4], cuts[4], cuts[4], cuts[4]);
  int found = 1;
  for (int i = 0; i < 4; ++i) {
    float a = cuts[i], b = cuts[i + 1];
    if (a < b && (value(f, a) > 0.0) != (value(f, b) > 0.0)) {
      roots[found] = rootBetween(f, a, b);
      found = min(found + 1, 3);
    }
  }
  return roots;
}

bool intersect(Ray ray, float tMin, float tMax, Parameters p, out float t, out vec3 normal) {
  vec3 axis = normalize(p.axis);
  float thick = p.r / p.R;
  vec3 away = ray.origin - p.center;
  float nearest = -dot(away, ray.direction);
  vec3 q0 = (away + nearest * ray.direction) / p.R;
  float outer = 1.001 * (1.0 + thick), c = dot(q0, q0);
  if (c > outer * outer) return false;  // passes the sphere around it, whose equator must not touch: P is 0 there

  float reach = sqrt(outer * outer - c);
  float from = max(-reach, (tMin - nearest) / p.R), to = min(reach, (tMax - nearest) / p.R);
  if (!(from < to)) return false;
  float b = dot(q0, ray.direction), h = dot(q0, axis), rise = dot(ray.direction, axis);
  float k = c + 1.0 - thick * thick;
  Quartic f = Quartic(float[5](k * k - 4.0 * (c - h * h), 4.0 * b * k - 8.0 * (b - h * rise),
                               4.0 * b * b + 2.0 * k - 4.0 * (1.0 - rise * rise), 4.0 * b, 1.0));
  Quartic first = derivative(f);
  // P'' = 12 s^2 + 24 b s + 2 c2
  float middle = -b, square = b * b - f.c[2] / 6.0, half_ = sqrt(max(square, 0.0));
  float low = clamp(middle - half_, from, to), high = clamp(middle + half_, from, to);
  float turns[5] = rootsBetween(first, float[5](from, low, high, to, to));
  float roots[5] = rootsBetween(f, float[5](from, turns[1], turns[2], turns[3], to));
  float s = roots[1];
  if (!(s < to)) return false;

  // The same equation as a distance loses fewer digits: one more step with it.
  vec3 q = q0 + s * ray.direction;
  vec3 flat_ = q - dot(q, axis) * axis;
  vec3 gradient = q - flat_ / length(flat_);
  float step = (dot(gradient, gradient) - thick * thick) / (2.0 * dot(gradient, ray.direction));
  if (abs(step) < 1.0e-3) s -= step;
  q = q0 + s * ray.direction;
  flat_ = q - dot(q, axis) * axis;
  t = nearest + s * p.R;
  normal = normalize(q - flat_ / length(flat_));
  return true;
}
