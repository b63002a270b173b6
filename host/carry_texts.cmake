# Text files -> C++ source that holds them by their names without endings, in a namespace of solidcast.
# Run as cmake -DTEXTS=a.json;b.json -DNAMESPACE= -DSOURCE= -P carry_texts.cmake
set(arrays "")
set(table "")
set(number 0)
foreach(text IN LISTS TEXTS)
  get_filename_component(name ${text} NAME_WE)
  file(READ ${text} bytes HEX)
  string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
  string(APPEND arrays "static const unsigned char text${number}[] = {${bytes}};\n")
  string(APPEND table "    {\"${name}\", {reinterpret_cast<const char*>(text${number}), sizeof text${number}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${SOURCE} "#include <cstddef>
#include <string_view>

namespace solidcast::${NAMESPACE} {
${arrays}
struct CarriedText {
  const char* name;
  std::string_view text;
};
extern const CarriedText kCarriedTexts[];
const CarriedText kCarriedTexts[] = {
${table}};
extern const std::size_t kCarriedTextCount;
const std::size_t kCarriedTextCount = ${number};
}  // namespace solidcast::${NAMESPACE}
")
