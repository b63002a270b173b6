#include "host/scene/quadric_forms.h"

#include "host/scene/exact.h"

namespace solidcast {

const QuadricForm* findQuadricForm(std::string_view name) {
  for (const QuadricForm& form : kQuadricForms)
    if (form.name == name) return &form;
  return nullptr;
}

Quadric makeQuadric(const QuadricForm& form, const Triple& center, const Triple& radii, int axis, bool mirrored) {
  const int p = axis == 0 ? 1 : 0, q = axis == 2 ? 1 : 2;
  std::array<int, 3> square{}, linear{};
  square[p] = form.pp;
  square[q] = form.qq;
  square[axis] = form.ww;
  linear[q] = form.q;
  linear[axis] = mirrored ? -form.w : form.w;

  // Per axis: s ((x-c)/r)^2 + l (x-c)/r = (s/r^2) x^2 + (l/r - 2sc/r^2) x + (sc^2/r^2 - lc/r).
  std::array<Wide, 10> wide{};
  wide[9] = form.constant;
  for (int i = 0; i < 3; ++i) {
    const Wide c = center[i], r = square[i] == 0 && linear[i] == 0 ? 1 : Wide(radii[i]);
    const Wide s = square[i] / (r * r), l = linear[i] / r;
    wide[i] = s;
    wide[6 + i] = l - 2 * s * c;
    wide[9] += s * c * c - l * c;
  }
  return {roundScaled(wide)};
}

}  // namespace solidcast
