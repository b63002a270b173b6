# A text file -> C++ source that holds it. Run as cmake -DTEXT= -DSOURCE= -P carry_text.cmake
file(READ ${TEXT} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE ${SOURCE} "#include \"host/catalogue/catalogue.h\"

namespace solidcast::catalogue {
static const unsigned char text[] = {
${bytes}
};
std::string_view carriedText() { return {reinterpret_cast<const char*>(text), sizeof text}; }
}  // namespace solidcast::catalogue
")
