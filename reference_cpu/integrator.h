// What is seen along a ray. Only an integrator starts an intersection; a query is an integrator's getIntersection()
// without the radiance.
#pragma once
#include "reference_cpu/world.h"

namespace solidcast::reference {

template <class T>
class Integrator {
 public:
  explicit Integrator(const World<T>* world) : world_(world) {}
  virtual ~Integrator() = default;

  /// The nearest hit with 0 < t < limit.
  Intersection<T> getIntersection(const Ray<T>& ray, const T& limit = infinity<T>()) const {
    return world_->scene->intersect(ray, limit);
  }
  Vec<T> getRadiance(const Ray<T>& ray) const { return getRadiance(getIntersection(ray)); }
  /// Red, green and blue of what was hit, not clamped.
  virtual Vec<T> getRadiance(const Intersection<T>& hit) const = 0;

 private:
  const World<T>* world_;
};

/// Grey by the cosine between ray and normal, black from behind; two-sided its absolute value. A miss is black.
template <class T>
class RayCastingIntegrator : public Integrator<T> {
 public:
  using Integrator<T>::getRadiance;
  explicit RayCastingIntegrator(const World<T>* world, bool twoSided = false)
      : Integrator<T>(world), twoSided_(twoSided) {}

  Vec<T> getRadiance(const Intersection<T>& hit) const override {
    const T c = cosine(hit);
    return {c, c, c};
  }

 protected:
  T cosine(const Intersection<T>& hit) const {
    if (!hit) return 0;
    const T c = -dot(hit.ray().direction, hit.normal());
    return twoSided_ ? absolute(c) : greater(T(0), c);
  }

 private:
  bool twoSided_;
};

/// The same cosine times a colour that runs from nearColor at nearDist to farColor at farDist, constant beyond.
/// nearDist may lie beyond farDist.
template <class T>
class RayCastingDistIntegrator final : public RayCastingIntegrator<T> {
 public:
  using Integrator<T>::getRadiance;
  RayCastingDistIntegrator(const World<T>* world, const Vec<T>& nearColor, const T& nearDist, const Vec<T>& farColor,
                           const T& farDist, bool twoSided = false)
      : RayCastingIntegrator<T>(world, twoSided),
        nearColor_(nearColor),
        farColor_(farColor),
        nearDist_(nearDist),
        farDist_(farDist) {}

  Vec<T> getRadiance(const Intersection<T>& hit) const override {
    if (!hit) return {};
    const T factor = (hit.distance() - nearDist_) / (farDist_ - nearDist_);
    const T clamped = lesser(T(1), greater(T(0), factor));
    return this->cosine(hit) * (nearColor_ + clamped * (farColor_ - nearColor_));
  }

 private:
  Vec<T> nearColor_, farColor_;
  T nearDist_, farDist_;
};

}  // namespace solidcast::reference
