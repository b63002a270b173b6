// The scene that integrators look at.
#pragma once
#include <memory>
#include <vector>

#include "reference_cpu/group.h"

namespace solidcast::reference {

class Light;  // the course's later sheets give it a body

template <class T>
struct World {
  std::shared_ptr<Primitive<T>> scene;
  std::vector<std::shared_ptr<Light>> lights;  // ray casting uses none
};

}  // namespace solidcast::reference
