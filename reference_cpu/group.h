// Groups of primitives. A scene file may nest them ten thousand deep, so no walk over a tree of SimpleGroups recurses.
#pragma once
#include <cstddef>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "reference_cpu/primitive.h"

namespace solidcast::reference {

template <class T>
class Group : public Primitive<T> {
 public:
  virtual void add(std::shared_ptr<Primitive<T>> primitive) = 0;
  /// Called once after the adds, inner groups first; may build an index.
  virtual void rebuildIndex() = 0;
};

/// Without an index: intersect() goes over all members, in the order of their adds, so the first wins a tie.
template <class T>
class SimpleGroup final : public Group<T> {
 public:
  ~SimpleGroup() override {
    // Take the members of groups that would die with this one, so that destructors do not nest.
    std::vector<Member> doomed = std::move(members_);
    while (!doomed.empty()) {
      Member last = std::move(doomed.back());
      doomed.pop_back();
      if (!last.group || last.primitive.use_count() > 1) continue;
      for (Member& member : last.group->members_) doomed.push_back(std::move(member));
      last.group->members_.clear();
    }
  }

  void add(std::shared_ptr<Primitive<T>> primitive) override {
    SimpleGroup* group = dynamic_cast<SimpleGroup*>(primitive.get());
    members_.push_back({std::move(primitive), group});
  }

  /// Computes the bounds; needs those of the members.
  void rebuildIndex() override {
    bounds_ = BBox<T>::empty();
    for (const Member& member : members_) {
      const BBox<T> inner = member.primitive->getBounds();
      if (!inner.isEmpty()) bounds_.extend(inner);
    }
  }

  BBox<T> getBounds() const override { return bounds_; }

  Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const override {
    Intersection<T> nearest = Intersection<T>::failure();
    T best = previousBestDistance;
    std::vector<std::pair<const SimpleGroup*, std::size_t>> outer;  // groups half done: allocates only when they nest
    const SimpleGroup* group = this;
    for (std::size_t next = 0;;) {
      if (next == group->members_.size()) {
        if (outer.empty()) return nearest;
        std::tie(group, next) = outer.back();
        outer.pop_back();
        continue;
      }
      const Member& member = group->members_[next++];
      if (member.group) {
        outer.emplace_back(group, next);
        group = member.group;
        next = 0;
      } else if (const Intersection<T> hit = member.primitive->intersect(ray, best)) {
        best = hit.distance();
        nearest = hit;
      }
    }
  }

 private:
  struct Member {
    std::shared_ptr<Primitive<T>> primitive;
    SimpleGroup* group;  // the primitive, if it is a SimpleGroup
  };

  std::vector<Member> members_;
  BBox<T> bounds_;
};

}  // namespace solidcast::reference
