// What a scene is made of: primitives, which are groups or solids.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "host/error.h"
#include "reference_cpu/bbox.h"
#include "reference_cpu/intersection.h"

namespace solidcast::reference {

// The course's later sheets give these a body; until then primitives keep what they are handed.
class Material;
class CoordMapper;

template <class T>
class Primitive {
 public:
  virtual ~Primitive() = default;

  virtual BBox<T> getBounds() const = 0;
  /// The nearest hit with 0 < t < previousBestDistance, both strict, or failure().
  virtual Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const = 0;

  void setMaterial(std::shared_ptr<Material> material) { material_ = std::move(material); }
  void setCoordMapper(std::shared_ptr<CoordMapper> mapper) { coordMapper_ = std::move(mapper); }
  const std::shared_ptr<Material>& material() const { return material_; }
  const std::shared_ptr<CoordMapper>& coordMapper() const { return coordMapper_; }

 private:
  std::shared_ptr<Material> material_;
  std::shared_ptr<CoordMapper> coordMapper_;
};

template <class T>
class Solid : public Primitive<T> {
 public:
  /// Area of the surface in square units of the world; infinity where it has no end.
  virtual T getArea() const = 0;
  /// A point of the surface, uniform by area for u and v uniform in [0,1).
  /// Throws Error(Exit::usage) for a solid without a finite, positive area.
  virtual Vec<T> sample(const T& u, const T& v) const = 0;

  std::int32_t index = -1;  // place among the scene's solids, depth first

 protected:
  static bool accepts(const T& t, const T& previousBestDistance) { return t > 0 && t < previousBestDistance; }
  [[noreturn]] static void refuseSample(const std::string& kind) {
    throw Error(Exit::usage, "sample: " + kind + " has no finite area, expected a solid with one");
  }
};

}  // namespace solidcast::reference
