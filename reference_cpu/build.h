// From the plain scene description to the class model in a number type. Every fp64 number is rounded to it once.
#pragma once
#include <memory>
#include <variant>
#include <vector>

#include "host/scene/world.h"
#include "reference_cpu/aabox.h"
#include "reference_cpu/camera.h"
#include "reference_cpu/disc.h"
#include "reference_cpu/infinite_plane.h"
#include "reference_cpu/integrator.h"
#include "reference_cpu/quad.h"
#include "reference_cpu/quadric.h"
#include "reference_cpu/sphere.h"
#include "reference_cpu/triangle.h"
#include "reference_cpu/world.h"

namespace solidcast::reference {

template <class T>
struct Build {
  using SolidPtr = std::shared_ptr<Solid<T>>;
  using CameraPtr = std::unique_ptr<Camera<T>>;
  using IntegratorPtr = std::unique_ptr<Integrator<T>>;

  static Vec<T> vec(const Triple& v) { return toVec<T>(v); }

  // --- solids ---
  static SolidPtr make(const solidcast::InfinitePlane& s) {
    return std::make_shared<InfinitePlane<T>>(vec(s.origin), vec(s.normal));
  }
  static SolidPtr make(const solidcast::AABox& s) { return std::make_shared<AABox<T>>(vec(s.corner1), vec(s.corner2)); }
  static SolidPtr make(const solidcast::Sphere& s) { return std::make_shared<Sphere<T>>(vec(s.center), T(s.radius)); }
  static SolidPtr make(const solidcast::Disc& s) {
    return std::make_shared<Disc<T>>(vec(s.center), vec(s.normal), T(s.radius));
  }
  static SolidPtr make(const solidcast::Triangle& s) {
    return std::make_shared<Triangle<T>>(vec(s.v1), vec(s.v2), vec(s.v3));
  }
  static SolidPtr make(const solidcast::Quad& s) {
    return std::make_shared<Quad<T>>(vec(s.vertex), vec(s.span1), vec(s.span2));
  }
  static SolidPtr make(const solidcast::Quadric& s) { return std::make_shared<Quadric<T>>(s.coefficients); }

  // --- cameras ---
  static CameraPtr make(const solidcast::PerspectiveCamera& c) {
    return std::make_unique<PerspectiveCamera<T>>(vec(c.center), vec(c.forward), vec(c.up), T(c.verticalAngle),
                                                  T(c.horizontalAngle));
  }
  static CameraPtr make(const solidcast::OrthographicCamera& c) {
    return std::make_unique<OrthographicCamera<T>>(vec(c.center), vec(c.forward), vec(c.up), T(c.scaleX), T(c.scaleY));
  }
  static CameraPtr make(const solidcast::EnvironmentCamera& c) {
    return std::make_unique<EnvironmentCamera<T>>(vec(c.center), vec(c.forward), vec(c.up), T(c.verticalAngle),
                                                  T(c.horizontalAngle));
  }

  // --- integrators ---
  static IntegratorPtr make(const solidcast::RayCastingIntegrator&, const World<T>* world, bool twoSided) {
    return std::make_unique<RayCastingIntegrator<T>>(world, twoSided);
  }
  static IntegratorPtr make(const solidcast::RayCastingDistIntegrator& i, const World<T>* world, bool twoSided) {
    return std::make_unique<RayCastingDistIntegrator<T>>(world, vec(i.nearColor), T(i.nearDist), vec(i.farColor),
                                                         T(i.farDist), twoSided);
  }

  static IntegratorPtr make(const solidcast::CustomIntegrator& i, const World<T>*, bool) {
    throw Error(Exit::usage,
                i.code.file + ": the CPU reference runs no GLSL, expected the integrator casting or castingdist");
  }

  static CameraPtr camera(const solidcast::Camera& plain) {
    return std::visit([](const auto& c) { return make(c); }, plain);
  }
  static IntegratorPtr integrator(const solidcast::Integrator& plain, const World<T>* world, bool twoSided) {
    return std::visit([&](const auto& i) { return make(i, world, twoSided); }, plain);
  }

  static World<T> world(const solidcast::World& plain) {
    if (!plain.customSolids.empty())
      throw Error(Exit::usage, plain.customSolids[0].code.file +
                                   ": the CPU reference runs no GLSL, expected a scene without custom solids");
    std::vector<std::shared_ptr<SimpleGroup<T>>> groups(plain.groups.size());
    for (auto& group : groups) group = std::make_shared<SimpleGroup<T>>();
    std::vector<std::uint32_t> outerFirst{0};  // every group of the tree after the one that holds it
    std::vector<bool> placed(plain.groups.size());
    placed[0] = true;
    for (std::size_t i = 0; i < outerFirst.size(); ++i) {
      const std::uint32_t place = outerFirst[i];
      for (const GroupMember& member : plain.groups[place].members) {
        if (member.index >= (member.isGroup ? plain.groups.size() : plain.solids.size()))
          throw Error(Exit::usage, "world: a group member does not exist, expected the index of a group or solid");
        if (member.isGroup) {
          if (placed[member.index])
            throw Error(Exit::usage, "world: a group is a member twice or of itself, expected a tree of groups");
          placed[member.index] = true;
          groups[place]->add(groups[member.index]);
          outerFirst.push_back(member.index);
        } else {
          auto solid = std::visit([](const auto& s) { return make(s); }, plain.solids[member.index].shape);
          solid->index = static_cast<std::int32_t>(member.index);
          groups[place]->add(std::move(solid));
        }
      }
    }
    for (auto place = outerFirst.rbegin(); place != outerFirst.rend(); ++place) groups[*place]->rebuildIndex();
    return {groups[0], {}};
  }
};

}  // namespace solidcast::reference
