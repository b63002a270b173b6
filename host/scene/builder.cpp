#include "host/scene/builder.h"

#include <filesystem>

#include "host/scene/load.h"
#include "host/scene/mesh.h"

namespace solidcast {
namespace {

constexpr std::size_t kMaxListLength = 16;  // no field is longer than the ten coefficients
constexpr std::size_t kMaxValueDepth = 4;   // no field is deeper than a list of points

}  // namespace

void UniqueNames::add(const std::string& name, const std::string& what, const std::string& where) {
  if (name.empty()) return;
  const auto [found, isNew] = owners_.emplace(name, what);
  if (!isNew)
    throw Fault{where, "duplicate name " + inQuotes(name) + ", expected a name of its own (it is that of " +
                           found->second + ")"};
}

std::string SceneBuilder::where() const {
  std::string pointer;
  for (const Level& level : levels_)
    pointer += level.value.is_object() ? pointerPart(level.key) : numbered("/", level.index);
  return pointer;
}

bool SceneBuilder::add(Json value) {
  if (levels_.empty()) throw Fault{"", "wrong type: " + typeName(value) + ", expected an object"};
  Level& level = levels_.back();
  if (level.role == Role::solidList)
    throw Fault{where(), "wrong type: " + typeName(value) + ", expected an object that is a solid or a group"};
  if (level.value.is_array()) {
    if (++level.index > kMaxListLength)
      throw Fault{where(), "the list is longer than any field's, expected at most " + std::to_string(kMaxListLength) +
                               " entries"};
    level.value.push_back(std::move(value));
    return true;
  }
  if (level.role != Role::value && level.key == "solids")
    throw Fault{where(), "wrong type: " + typeName(value) + ", expected a list of solids"};
  level.value[level.key] = std::move(value);
  return true;
}

void SceneBuilder::open(Role role, Json value) {
  std::size_t depth = 0;
  for (auto level = levels_.rbegin(); level != levels_.rend() && level->role == Role::value; ++level) ++depth;
  if (depth >= kMaxValueDepth) throw Fault{where(), "nested deeper than any field, expected numbers"};
  Level level{role, std::move(value), {}};
  levels_.push_back(std::move(level));
}

bool SceneBuilder::start_object(std::size_t) {
  if (levels_.empty()) open(Role::root, Json::object());
  else if (levels_.back().role == Role::solidList) open(Role::solid, Json::object());
  else if (levels_.back().role != Role::value && levels_.back().key == "solids") return add(Json::object());
  else open(Role::value, Json::object());
  return true;
}

bool SceneBuilder::start_array(std::size_t) {
  if (levels_.empty()) return add(Json::array());
  Level& parent = levels_.back();
  if (parent.role == Role::solidList) return add(Json::array());
  if (parent.role == Role::value || parent.key != "solids") {
    open(Role::value, Json::array());
    return true;
  }
  parent.isGroup = true;
  std::uint32_t group = 0;
  if (parent.role == Role::solid) {
    if (++groupDepth_ > kMaxGroupDepth)
      throw Fault{where(), "groups are nested too deep, expected at most " + std::to_string(kMaxGroupDepth)};
    World& world = scene_.world;
    const std::uint32_t above = levels_[levels_.size() - 2].group;
    group = static_cast<std::uint32_t>(world.groups.size());
    world.groups.push_back({"", above, {}});
    world.groups[above].members.push_back({true, group});
    parent.group = group;
  }
  open(Role::solidList, Json::array());
  levels_.back().group = group;
  return true;
}

bool SceneBuilder::key(string_t& name) {
  Level& level = levels_.back();
  level.key = name;
  if (level.value.contains(name) || (level.isGroup && name == "solids"))
    throw Fault{where(), "duplicate key " + inQuotes(name) + ", expected each key once"};
  return true;
}

bool SceneBuilder::end_array() {
  Level level = std::move(levels_.back());
  levels_.pop_back();
  return level.role == Role::solidList || add(std::move(level.value));
}

bool SceneBuilder::end_object() {
  Level level = std::move(levels_.back());
  levels_.pop_back();
  if (level.role == Role::root) finishRoot(level);
  else if (level.role == Role::solid) finishSolid(level);
  else return add(std::move(level.value));
  return true;
}

void SceneBuilder::finishSolid(Level& solid) {
  World& world = scene_.world;
  const Fields fields(solid.value, where());
  if (fields.choice("type", "solid", solidTypes()) == "group") {
    if (!solid.isGroup) fields.need("solids", "a list of solids");
    fields.onlyKeys({"type", "name", "solids"});
    --groupDepth_;
    world.groups[solid.group].name = readName(fields);
    names_.add(world.groups[solid.group].name, numbered("group ", solid.group), fields.where("name"));
  } else {
    if (solid.isGroup)
      throw Fault{fields.where("solids"), "\"solids\" in a " + fields.text("type") + ", expected it only in a group"};
    if (fields.text("type") == "mesh") {
      finishMesh(fields);
      return;
    }
    if (fields.text("type") == "custom") {
      const CustomSolid custom = readCustomSolid(fields);
      names_.add(custom.name, numbered("custom ", world.customSolids.size()), fields.where("name"));
      world.customSolids.push_back(custom);
      ++levels_.back().index;
      return;
    }
    const Shape shape = readSolid(fields, warnings_);
    const std::string name = readName(fields);
    names_.add(name, kindName(shape) + numbered(" ", world.solids.size()), fields.where("name"));
    const std::uint32_t group = levels_.back().group, index = static_cast<std::uint32_t>(world.solids.size());
    world.groups[group].members.push_back({false, index});
    world.solids.push_back({name, shape, group});
  }
  ++levels_.back().index;
}

void SceneBuilder::finishMesh(const Fields& fields) {
  World& world = scene_.world;
  Level& list = levels_.back();
  if (groupDepth_ + 1 > kMaxGroupDepth)
    throw Fault{fields.where(), "groups are nested too deep, expected at most " + std::to_string(kMaxGroupDepth)};
  const MeshSolid mesh = readMeshSolid(fields);
  const std::string name = readName(fields);
  names_.add(name, numbered("group ", world.groups.size()), fields.where("name"));
  const std::size_t before = warnings_.size();
  const std::string file = std::filesystem::path(scene_.file).parent_path() / mesh.file;
  if (files_ != nullptr) files_->push_back(file);
  try {
    addMesh(world, list.group, name, file, mesh.placement, warnings_);
  } catch (const Fault& fault) { throw Fault{fields.where("file"), fault.text}; }
  for (std::size_t i = before; i < warnings_.size(); ++i) warnings_[i].where = fields.where("file");
  ++list.index;
}

void SceneBuilder::finishRoot(Level& root) {
  const Fields fields(root.value, "");
  readView(fields, scene_, warnings_);
  if (!root.isGroup) fields.need("solids", "a list of solids");
}

bool SceneBuilder::parse_error(std::size_t position, const std::string& token,
                               const nlohmann::detail::exception& error) {
  syntaxErrorAt = position;
  syntaxErrorToken = token;
  syntaxError = error.what();
  return false;
}

}  // namespace solidcast
