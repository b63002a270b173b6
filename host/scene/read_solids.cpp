#include <algorithm>

#include "host/scene/exact.h"
#include "host/scene/quadric_forms.h"
#include "host/scene/read.h"
#include "host/scene/theory.h"

namespace solidcast {
namespace {

/// The known keys, with those that every solid has.
void onlyKeys(const Fields& fields, Names own) {
  own.insert(own.begin(), {"type", "name"});
  fields.onlyKeys(own);
}

/// A solid with several forms of description: exactly one of their first keys must be there.
std::string_view chosenForm(const Fields& fields, const Names& keys) {
  std::string list;
  for (const std::string_view key : keys)
    list += (list.empty() ? "" : key == keys.back() ? " or " : ", ") + inQuotes(key);
  const auto given = std::count_if(keys.begin(), keys.end(), [&](auto key) { return fields.has(key); });
  if (given == 0) throw Fault{fields.where(), "missing field, expected " + list};
  if (given > 1) throw Fault{fields.where(), "more than one description, expected only one of " + list};
  return *std::find_if(keys.begin(), keys.end(), [&](auto key) { return fields.has(key); });
}

Shape readSphere(const Fields& fields) {
  onlyKeys(fields, {"center", "radius"});
  return Sphere{fields.triple("center"), fields.number("radius")};
}

Shape readPlane(const Fields& fields) {
  onlyKeys(fields, {"origin", "normal", "equation", "points"});
  const std::string_view form = chosenForm(fields, {"normal", "equation", "points"});
  if (form == "normal") return InfinitePlane{fields.triple("origin"), fields.triple("normal")};
  if (fields.has("origin"))
    throw Fault{fields.where("origin"), "\"origin\" beside " + inQuotes(form) + ", expected it only beside \"normal\""};
  if (form == "equation") {
    const std::vector<double> e = fields.numbers("equation", 4);
    if (isZero(Triple{e[0], e[1], e[2]}))
      throw Fault{fields.where("equation"), "A, B and C are zero, expected a normal [A, B, C] that is not"};
    return planeFromEquation(e[0], e[1], e[2], e[3]);
  }
  const auto [p1, p2, p3] = fields.threePoints("points");
  if (isZero(exactCross(p1, p2, p3)))
    throw Fault{fields.where("points"), "the three points are collinear, expected points that span a plane"};
  return planeFromPoints(p1, p2, p3);
}

Shape readBox(const Fields& fields) {
  onlyKeys(fields, {"corner1", "corner2"});
  return AABox{fields.triple("corner1"), fields.triple("corner2")};
}

Shape readDisc(const Fields& fields) {
  onlyKeys(fields, {"center", "normal", "radius"});
  return Disc{fields.triple("center"), fields.triple("normal"), fields.number("radius")};
}

Shape readTriangle(const Fields& fields) {
  onlyKeys(fields, {"vertices"});
  const auto [v1, v2, v3] = fields.threePoints("vertices");
  return Triangle{v1, v2, v3};
}

Shape readQuad(const Fields& fields) {
  onlyKeys(fields, {"vertex", "span1", "span2"});
  return Quad{fields.triple("vertex"), fields.triple("span1"), fields.triple("span2")};
}

Shape readNamedQuadric(const Fields& fields) {
  Names names;
  for (const QuadricForm& form : kQuadricForms) names.push_back(form.name);
  const QuadricForm& form = *findQuadricForm(fields.choice("form", "quadric form", names));
  if (form.usesAxis) onlyKeys(fields, {"form", "center", "radii", "axis"});
  else onlyKeys(fields, {"form", "center", "radii"});

  const Names axes = {"x", "y", "z", "-x", "-y", "-z"};
  const std::string axisName = fields.has("axis") ? fields.choice("axis", "axis", axes) : "z";
  const int axis = axisName.back() - 'x';

  const std::vector<double> given = fields.numbers("radii", form.usesAxisRadius ? 3 : 2);
  Triple radii = {1, 1, 1};
  for (std::size_t i = 0, next = 0; i < 3; ++i) {
    if (!form.usesAxisRadius && static_cast<int>(i) == axis) continue;
    checkPositive(given[next], fields.where("radii") + numbered("/", next));
    radii[i] = given[next++];
  }
  const Quadric quadric = makeQuadric(form, fields.triple("center"), radii, axis, axisName[0] == '-');
  for (const double coefficient : quadric.coefficients)
    if (!(std::abs(coefficient) <= 3.4e38))
      throw Fault{fields.where("radii"), "coefficient " + shortest(coefficient) +
                                             " is beyond fp32, expected a center and radii that are less far apart"};
  return quadric;
}

Shape readQuadric(const Fields& fields) {
  if (chosenForm(fields, {"coefficients", "form"}) == "form") return readNamedQuadric(fields);
  onlyKeys(fields, {"coefficients"});
  const std::vector<double> c = fields.numbers("coefficients", 10);
  Quadric quadric{};
  std::copy(c.begin(), c.end(), quadric.coefficients.begin());
  return quadric;
}

struct SolidReader {
  const char* type;
  Shape (*read)(const Fields&);
};
constexpr SolidReader kReaders[] = {{"sphere", readSphere},  {"infinite_plane", readPlane}, {"box", readBox},
                                    {"disc", readDisc},      {"triangle", readTriangle},    {"quad", readQuad},
                                    {"quadric", readQuadric}};

}  // namespace

Names solidTypes() {
  Names names = {"group", "mesh", "custom"};
  for (const SolidReader& reader : kReaders) names.push_back(reader.type);
  return names;
}

MeshSolid readMeshSolid(const Fields& fields) {
  onlyKeys(fields, {"file", "scale", "rotate", "translate"});
  MeshSolid mesh{fields.text("file"), {}};
  if (fields.has("scale")) {
    mesh.placement.scale = fields.number("scale");
    checkPositive(mesh.placement.scale, fields.where("scale"));
  }
  if (fields.has("rotate")) {
    const std::vector<double> turn = fields.numbers("rotate", 4);
    mesh.placement.axis = {turn[0], turn[1], turn[2]};
    mesh.placement.degrees = turn[3];
    checkNonZero(mesh.placement.axis, fields.where("rotate"));
  }
  if (fields.has("translate")) mesh.placement.translate = fields.triple("translate");
  return mesh;
}

Shape readSolid(const Fields& fields, std::vector<Fault>& warnings) {
  const std::string type = fields.choice("type", "solid", solidTypes());
  const auto reader = std::find_if(std::begin(kReaders), std::end(kReaders), [&](auto& r) { return r.type == type; });
  const Shape shape = reader->read(fields);
  std::vector<Fault> found;
  try {
    checkShape(shape, found);
  } catch (Fault& fault) { throw Fault{fields.where() + fault.where, fault.text}; }
  for (Fault& warning : found) warnings.push_back({fields.where() + warning.where, std::move(warning.text)});
  return shape;
}

std::string readName(const Fields& fields) {
  if (!fields.has("name")) return "";
  const std::string name = fields.text("name");
  if (name.empty()) throw Fault{fields.where("name"), "the name is empty, expected a text or no name at all"};
  return name;
}

}  // namespace solidcast
