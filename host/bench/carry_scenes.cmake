# Scene files -> C++ source that holds them by name. Run as cmake -DSCENES=a.json;b.json -DSOURCE= -P carry_scenes.cmake
set(arrays "")
set(table "")
set(number 0)
foreach(scene IN LISTS SCENES)
  get_filename_component(name ${scene} NAME_WE)
  file(READ ${scene} bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "static const unsigned char text${number}[] = {${bytes}};\n")
  string(APPEND table "    {\"${name}\", {reinterpret_cast<const char*>(text${number}), sizeof text${number}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${SOURCE} "#include <cstddef>
#include <string_view>

namespace solidcast::bench {
${arrays}
struct CarriedScene {
  const char* name;
  std::string_view text;
};
extern const CarriedScene kCarriedScenes[];
const CarriedScene kCarriedScenes[] = {
${table}};
extern const std::size_t kCarriedSceneCount;
const std::size_t kCarriedSceneCount = ${number};
}  // namespace solidcast::bench
")
