// The solids of a scene: what they are, and the list of them that a scene keeps, an array for each kind. A picture of many solids
// reads them all, and in one array of variants a sphere took 104 bytes instead of 32 (36 beside other kinds).
// Every number is fp64 exactly as it was parsed. No mathematics in this file.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace solidcast {

using Triple = std::array<double, 3>;  // a point, vector or colour; x, y, z or r, g, b

// --- the kinds (names and arguments of the course sheet) ------------------------------------------

/// Normal of any length.
struct InfinitePlane {
  Triple origin, normal;
  bool operator==(const InfinitePlane&) const = default;
};
/// Opposite corners in any order.
struct AABox {
  Triple corner1, corner2;
  bool operator==(const AABox&) const = default;
};
struct Sphere {
  Triple center;
  double radius;
  bool operator==(const Sphere&) const = default;
};
/// Normal of any length.
struct Disc {
  Triple center, normal;
  double radius;
  bool operator==(const Disc&) const = default;
};
/// Normal (v2-v1) x (v3-v1).
struct Triangle {
  Triple v1, v2, v3;
  bool operator==(const Triangle&) const = default;
};
/// Parallelogram vertex + u span1 + v span2, u and v in [0,1]; normal span1 x span2.
struct Quad {
  Triple vertex, span1, span2;
  bool operator==(const Quad&) const = default;
};
/// a..j of ax^2+by^2+cz^2+dxy+exz+fyz+gx+hy+iz+j = 0; normal along the gradient.
struct Quadric {
  std::array<double, 10> coefficients;
  bool operator==(const Quadric&) const = default;
};

using Shape = std::variant<InfinitePlane, AABox, Sphere, Disc, Triangle, Quad, Quadric>;

// --- what goes for each of them -------------------------------------------------------------------

/// What is known of a variant's alternatives by their index.
template <class Variant>
struct Alternatives;
template <class... Solid>
struct Alternatives<std::variant<Solid...>> {
  using Arrays = std::tuple<std::vector<Solid>...>;
  template <class Of>
  static constexpr bool has = (std::is_same_v<Of, Solid> || ...);
  template <class Of>
  requires has<Of>
  static constexpr std::size_t indexOf() {
    std::size_t index = 0;
    (void)((std::is_same_v<Of, Solid> || (++index, false)) || ...);
    return index;
  }
  /// f(std::type_identity<the alternative>()).
  template <std::size_t INDEX = 0>
  static decltype(auto) with(std::size_t index, auto&& f) {
    if constexpr (INDEX + 1 < sizeof...(Solid))
      if (index != INDEX) return with<INDEX + 1>(index, f);
    return f(std::type_identity<std::tuple_element_t<INDEX, std::tuple<Solid...>>>());
  }
};
using Kinds = Alternatives<Shape>;

/// A solid where it lies, which must outlive this.
class ShapeRef {
 public:
  ShapeRef() = default;
  template <class Solid>
  requires Kinds::has<Solid> ShapeRef(const Solid& solid) : at_(&solid), index_(Kinds::indexOf<Solid>()) {}
  ShapeRef(const Shape& shape) : ShapeRef(std::visit([](const auto& solid) { return ShapeRef(solid); }, shape)) {}

  /// Of the kind, in Shape.
  std::size_t index() const { return index_; }
  template <class Solid>
  const Solid* getIf() const {
    return index_ == Kinds::indexOf<Solid>() ? static_cast<const Solid*>(at_) : nullptr;
  }
  /// f(the solid).
  decltype(auto) visit(auto&& f) const {
    return Kinds::with(index_, [&]<class Solid>(std::type_identity<Solid>) -> decltype(auto) {
      return f(*static_cast<const Solid*>(at_));
    });
  }
  Shape copy() const {
    return visit([](const auto& solid) { return Shape(solid); });
  }

 private:
  const void* at_ = nullptr;
  std::size_t index_ = 0;
};

/// One of a scene's solids.
struct SolidEntry {
  std::string name;  // unique in the scene; may be empty
  Shape shape;
  std::uint32_t group = 0;  // index into World::groups
  bool operator==(const SolidEntry&) const = default;
};

/// A scene's solids in their order, kept kind by kind. What it gives out one by one are copies; `shape` is for loops that
/// many solids go through.
class Solids {
 public:
  Solids() = default;
  explicit Solids(std::span<const SolidEntry> all) {
    for (const SolidEntry& solid : all) push_back(solid);
  }

  std::size_t size() const { return groups_.size(); }
  bool empty() const { return groups_.empty(); }
  /// How many there are of a kind, by Shape's index.
  std::size_t count(std::size_t index) const {
    return Kinds::with(index, [&]<class Solid>(std::type_identity<Solid>) { return of<Solid>().size(); });
  }
  /// All of a kind, in their order.
  template <class Solid>
  const std::vector<Solid>& of() const {
    return std::get<std::vector<Solid>>(arrays_);
  }
  struct Place {
    std::uint32_t index : 3, at : 29;  // the kind's index in Shape; where in its array
    bool operator==(const Place&) const = default;
  };
  Place place(std::size_t i) const { return places_.empty() ? placed(kind_, i) : places_[i]; }
  ShapeRef shape(std::size_t i) const {
    const Place place = this->place(i);
    return Kinds::with(place.index,
                       [&]<class Solid>(std::type_identity<Solid>) { return ShapeRef(of<Solid>()[place.at]); });
  }
  std::uint32_t group(std::size_t i) const { return groups_[i]; }
  std::string name(std::size_t i) const { return i < names_.size() ? names_[i] : std::string(); }
  SolidEntry operator[](std::size_t i) const { return {name(i), shape(i).copy(), group(i)}; }

  /// Throws std::length_error beyond 2^29 of a kind.
  void push_back(const SolidEntry& solid) {
    std::visit(
        [&]<class Solid>(const Solid& shape) {
          auto& array = std::get<std::vector<Solid>>(arrays_);
          if (array.size() >= std::size_t{1} << 29) throw std::length_error("more than 2^29 solids of a kind");
          constexpr std::size_t kind = Kinds::indexOf<Solid>();
          if (empty()) kind_ = kind;
          if (places_.empty() && kind != kind_)
            for (std::size_t i = 0; i < size(); ++i) places_.push_back(placed(kind_, i));
          if (!places_.empty()) places_.push_back(placed(kind, array.size()));
          array.push_back(shape);
        },
        solid.shape);
    groups_.push_back(solid.group);
    if (solid.name.empty()) return;
    names_.resize(size());
    names_.back() = solid.name;
  }
  /// Room for so many of a kind.
  template <class Solid>
  void reserve(std::size_t count) {
    groups_.reserve(size() + count);
    auto& array = std::get<std::vector<Solid>>(arrays_);
    array.reserve(array.size() + count);
  }

  class Iterator {
   public:
    using value_type = SolidEntry;
    using difference_type = std::ptrdiff_t;
    Iterator() = default;
    Iterator(const Solids& solids, std::size_t at) : solids_(&solids), at_(at) {}
    SolidEntry operator*() const { return (*solids_)[at_]; }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    Iterator operator++(int) { return {*solids_, at_++}; }
    bool operator==(const Iterator&) const = default;

   private:
    const Solids* solids_ = nullptr;
    std::size_t at_ = 0;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

  bool operator==(const Solids&) const = default;

 private:
  static_assert(std::variant_size_v<Shape> <= 8, "Place::index");
  static Place placed(std::size_t index, std::size_t at) {
    return {static_cast<std::uint32_t>(index) & 7, static_cast<std::uint32_t>(at) & 0x1fffffff};
  }

  std::size_t kind_ = 0;       // of the first
  std::vector<Place> places_;  // none while all are of that kind
  Kinds::Arrays arrays_;
  std::vector<std::uint32_t> groups_;
  std::vector<std::string> names_;  // up to the last that has one
};

/// Some of a scene's solids, one after the other.
struct Stretch {
  const Solids& solids;
  std::uint32_t first, count;
  std::size_t size() const { return count; }
  ShapeRef operator[](std::size_t i) const { return solids.shape(first + i); }
};

}  // namespace solidcast
