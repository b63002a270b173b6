// Quadric Q(p) = ax^2 + by^2 + cz^2 + dxy + exz + fyz + gx + hy + iz + j = 0. Along a ray this is A t^2 + 2 B t + C = 0
// with A the quadratic part at d, B = d.grad Q(o) / 2, C = Q(o). With D = B^2 - A C and q = -(B + sign(B) sqrt(D))
// the roots are q / A and C / q: no sum that cancels, and a vanishing or tiny A only sends q / A to infinity. D itself
// cancels where the origin is far away; completing the square gives it a second form, -A Q(m) with m the point of the
// ray halfway between the roots, and the form with the smaller terms is taken.
// A ray inside the surface (A = B = C = 0) misses. The normal is the gradient; where it vanishes (a cone's apex, a
// double plane) the normal points back along the ray.
#pragma once
#include <algorithm>
#include <cmath>

#include "reference_cpu/ellipsoid.h"
#include "reference_cpu/primitive.h"

namespace solidcast::reference {

template <class T>
class Quadric final : public Solid<T> {
 public:
  explicit Quadric(const QuadricCoefficients& coefficients) : coefficients_(coefficients) {
    // A common power of two changes neither the surface nor any bit, and keeps squares within T's range.
    double largest = 0;
    for (double value : coefficients) largest = std::max(largest, std::abs(value));
    const int shift = largest > 0 ? -std::ilogb(largest) : 0;
    for (int i = 0; i < 10; ++i) q_[i] = T(ldexpq(coefficients[i], shift));
  }

  Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const override {
    const Vec<T>&o = ray.origin, &d = ray.direction;
    const T A = quadraticPart(d).value;
    const T B = dot(d, gradient(o)) / 2;
    const Sum C = equation(o);
    const T discriminant = this->discriminant(ray, A, B, C);
    if (!(discriminant >= 0)) return Intersection<T>::failure();

    const T root = sqrt(discriminant);
    const T q = B < 0 ? root - B : -(root + B);
    T t = infinity<T>();
    if (q != 0) {
      const T other = C.value / q;
      if (other > 0) t = other;
    }
    if (A != 0) {
      const T other = q / A;
      if (other > 0 && other < t) t = other;
    }
    if (!this->accepts(t, previousBestDistance)) return Intersection<T>::failure();
    const Vec<T> p = ray.getPoint(t);
    return {t, ray, this, normalAt(ray, t, p), p};
  }

  /// Unbounded, except for an ellipsoid, a point, and an empty surface.
  BBox<T> getBounds() const override {
    const auto bounded = boundedQuadric(coefficients_);
    if (!bounded) return BBox<T>::unbounded();
    if (bounded->empty) return BBox<T>::empty();
    BBox<T> bounds;
    bounds.extend(rounded(bounded->center - bounded->halfExtents));
    bounds.extend(rounded(bounded->center + bounded->halfExtents));
    return bounds;
  }

  /// Of an ellipsoid by an elliptic integral; 0 for a point or an empty surface; infinity for every unbounded quadric.
  T getArea() const override {
    if (const auto axes = ellipsoidAxes(coefficients_)) return T(ellipsoidArea(axes->semiAxes));
    return boundedQuadric(coefficients_) ? T(0) : infinity<T>();
  }

  /// On ellipsoids.
  Vec<T> sample(const T& u, const T& v) const override {
    const auto axes = ellipsoidAxes(coefficients_);
    if (!axes) this->refuseSample("a quadric that is no ellipsoid");
    const auto direction = sampleEllipsoidDirection(axes->semiAxes, double(u), double(v));
    const Vec<Quadruple> unit = normalized(Vec<Quadruple>{direction[0], direction[1], direction[2]});
    Vec<Quadruple> p = axes->center;
    for (int i = 0; i < 3; ++i) p = p + axes->semiAxes[i] * unit[i] * axes->directions[i];
    return rounded(p);
  }

 private:
  static Vec<T> rounded(const Vec<Quadruple>& p) { return {T(p.x), T(p.y), T(p.z)}; }

  /// A sum and the size of its terms, which bounds its rounding error.
  struct Sum {
    T value = 0, magnitude = 0;
    void add(const T& term) { value += term, magnitude += absolute(term); }
  };

  Sum quadraticPart(const Vec<T>& p) const {
    Sum sum;
    sum.add(q_[0] * p.x * p.x);
    sum.add(q_[1] * p.y * p.y);
    sum.add(q_[2] * p.z * p.z);
    sum.add(q_[3] * p.x * p.y);
    sum.add(q_[4] * p.x * p.z);
    sum.add(q_[5] * p.y * p.z);
    return sum;
  }

  /// Q(p).
  Sum equation(const Vec<T>& p) const {
    Sum sum = quadraticPart(p);
    sum.add(q_[6] * p.x);
    sum.add(q_[7] * p.y);
    sum.add(q_[8] * p.z);
    sum.add(q_[9]);
    return sum;
  }

  T discriminant(const Ray<T>& ray, const T& A, const T& B, const Sum& C) const {
    const T plain = B * B - A * C.value;
    if (A == 0) return plain;
    const T halfway = -B / A;
    const Vec<T> m = ray.getPoint(halfway);
    const Sum Qm = equation(m);
    T error = Qm.magnitude;  // and what m's rounding adds, along the gradient
    const Vec<T> g = gradient(m);
    for (int i = 0; i < 3; ++i)
      error += absolute(g[i]) * (absolute(ray.origin[i]) + absolute(halfway * ray.direction[i]));
    return absolute(A) * error < B * B + absolute(A) * C.magnitude ? -A * Qm.value : plain;
  }

  Vec<T> gradient(const Vec<T>& p) const {
    return {2 * q_[0] * p.x + q_[3] * p.y + q_[4] * p.z + q_[6], q_[3] * p.x + 2 * q_[1] * p.y + q_[5] * p.z + q_[7],
            q_[4] * p.x + q_[5] * p.y + 2 * q_[2] * p.z + q_[8]};
  }

  Vec<T> normalAt(const Ray<T>& ray, const T& t, const Vec<T>& p) const {
    const Vec<T> g = gradient(p);
    // What p's own rounding may put into each component: a gradient that is no larger is zero in truth.
    Vec<T> reach;
    for (int i = 0; i < 3; ++i) reach[i] = absolute(ray.origin[i]) + absolute(t * ray.direction[i]);
    const Vec<T> terms{
        absolute(2 * q_[0]) * reach.x + absolute(q_[3]) * reach.y + absolute(q_[4]) * reach.z + absolute(q_[6]),
        absolute(q_[3]) * reach.x + absolute(2 * q_[1]) * reach.y + absolute(q_[5]) * reach.z + absolute(q_[7]),
        absolute(q_[4]) * reach.x + absolute(q_[5]) * reach.y + absolute(2 * q_[2]) * reach.z + absolute(q_[8])};
    for (int i = 0; i < 3; ++i)
      if (absolute(g[i]) > 4 * Limits<T>::epsilon * terms[i]) return normalized(g);
    return normalized(-ray.direction);
  }

  QuadricCoefficients coefficients_;
  std::array<T, 10> q_;
};

}  // namespace solidcast::reference
