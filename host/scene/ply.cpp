// PLY (the Stanford polygon format): a header of text that says which elements follow with which properties, then those as text or
// as binary numbers of either byte order. x, y, z of "vertex" and the list vertex_indices (or vertex_index) of "face" are
// kept; everything else is read over.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "host/scene/fields.h"
#include "host/scene/mesh_text.h"

namespace solidcast {
namespace {

struct Type {
  std::string_view name, otherName;
  std::size_t bytes;
};
constexpr Type kTypes[] = {{"char", "int8", 1},     {"uchar", "uint8", 1},   {"short", "int16", 2},
                           {"ushort", "uint16", 2}, {"int", "int32", 4},     {"uint", "uint32", 4},
                           {"float", "float32", 4}, {"double", "float64", 8}};
enum TypeIndex { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
  bool isList = false;
  std::size_t count = 0, type = 0;  // into kTypes; count only for a list
  std::string name;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  std::size_t find(std::initializer_list<std::string_view> names) const {
    const auto found = std::find_if(properties.begin(), properties.end(), [&](const Property& p) {
      return std::find(names.begin(), names.end(), p.name) != names.end();
    });
    return static_cast<std::size_t>(found - properties.begin());
  }
};

struct Header {
  std::string_view format;
  std::vector<Element> elements;
};

std::size_t readType(MeshText& text) {
  const std::string_view word = text.word();
  for (std::size_t i = 0; i < std::size(kTypes); ++i)
    if (word == kTypes[i].name || word == kTypes[i].otherName) return i;
  Names names;
  for (const Type& type : kTypes) names.push_back(type.name);
  text.refuse("unknown type " + inQuotes(word) + ", expected " + oneOf(word, names));
}

Header readHeader(MeshText& text) {
  Header header;
  text.nextLine();  // "ply"
  const Names formats = {"ascii", "binary_little_endian", "binary_big_endian"};
  for (;; text.nextLine()) {
    if (text.done()) text.refuse("the file ends in the header, expected \"end_header\"");
    const std::string_view key = text.word();
    if (key == "format") {
      header.format = text.word();
      if (std::find(formats.begin(), formats.end(), header.format) == formats.end())
        text.refuse("unknown format " + inQuotes(header.format) + ", expected " + oneOf(header.format, formats));
    } else if (key == "element") {
      Element element{std::string(text.word()), 0, {}};
      const std::int64_t count = text.whole("the number of elements");
      if (count < 0) text.refuse("a negative number of elements, expected one that is not");
      element.count = static_cast<std::uint64_t>(count);
      header.elements.push_back(element);
    } else if (key == "property") {
      if (header.elements.empty()) text.refuse("a property of nothing, expected an element before it");
      Property property;
      MeshText ahead = text;
      if (ahead.word() == "list") {
        text.word();
        property.isList = true;
        property.count = readType(text);
        if (property.count >= float32) text.refuse("a list whose length is not whole, expected a type like uchar");
      }
      property.type = readType(text);
      property.name = text.word();
      header.elements.back().properties.push_back(property);
    } else if (key == "end_header") {
      if (header.format.empty())
        text.refuse("the header names no format, expected \"format ascii 1.0\" or a binary one");
      text.nextLine();
      return header;
    } else if (!key.empty() && key != "comment" && key != "obj_info") {
      const Names keys = {"format", "comment", "obj_info", "element", "property", "end_header"};
      text.refuse("unknown key " + inQuotes(key) + ", expected " + oneOf(key, keys));
    }
  }
}

/// The elements as text.
class TextBody {
 public:
  explicit TextBody(const MeshText& text) : text_(text) {}
  std::size_t left() const { return text_.rest().size(); }
  static std::size_t bytes(std::size_t) { return 1; }  // at least: a digit
  double real(std::size_t, const char* what) {
    text_.skipSpace();
    return text_.real(what);
  }
  std::int64_t whole(std::size_t, const char* what) {
    text_.skipSpace();
    return text_.whole(what);
  }
  [[noreturn]] void refuse(const std::string&, const std::string& what) const { text_.refuse(what); }
  void at(const Element&, std::uint64_t) {}

 private:
  MeshText text_;
};

/// The elements as bytes.
class BinaryBody {
 public:
  BinaryBody(const std::string& file, std::string_view bytes, bool swapped)
      : file_(file), bytes_(bytes), swapped_(swapped) {}
  std::size_t left() const { return bytes_.size() - at_; }
  static std::size_t bytes(std::size_t type) { return kTypes[type].bytes; }
  double real(std::size_t type, const char* what) {
    if (type < float32) return static_cast<double>(whole(type, what));
    const double value = type == float32 ? next<float>(what) : next<double>(what);
    try {
      checkNumber(value, "");
    } catch (const Fault& fault) { refuse(what, fault.text); }
    return value;
  }
  std::int64_t whole(std::size_t type, const char* what) {
    switch (type) {
      case int8:
        return next<std::int8_t>(what);
      case uint8:
        return next<std::uint8_t>(what);
      case int16:
        return next<std::int16_t>(what);
      case uint16:
        return next<std::uint16_t>(what);
      case int32:
        return next<std::int32_t>(what);
      case uint32:
        return next<std::uint32_t>(what);
      default:
        refuse(what, "is not a whole number, expected an integer type");
    }
  }
  [[noreturn]] void refuse(const std::string& part, const std::string& what) const {
    throw Fault{
        "", file_ + ": " + element_ + " " + std::to_string(index_) + (part.empty() ? "" : ", " + part) + ": " + what};
  }
  /// Says where the body is, for messages.
  void at(const Element& element, std::uint64_t index) {
    if (index == 0) element_ = element.name;
    index_ = index;
  }

 private:
  template <class Number>
  Number next(const char* what) {
    std::array<char, sizeof(Number)> bytes;
    if (left() < bytes.size()) refuse(what, "the file ends, expected " + std::to_string(bytes.size()) + " bytes more");
    std::memcpy(bytes.data(), bytes_.data() + at_, bytes.size());
    at_ += bytes.size();
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<Number>(bytes);
  }

  const std::string& file_;
  std::string_view bytes_;
  bool swapped_;
  std::size_t at_ = 0;
  std::string element_;
  std::uint64_t index_ = 0;
};

/// A header may promise anything: nothing is allocated that the file cannot hold.
template <class Body>
void checkRoom(const Body& body, const Element& element) {
  std::uint64_t bytes = 0;
  for (const Property& property : element.properties)
    bytes += Body::bytes(property.isList ? property.count : property.type);
  if (bytes == 0 || element.count <= body.left() / bytes) return;
  body.refuse("", "the header promises " + std::to_string(element.count) + " of \"" + element.name +
                      "\", expected at most " + std::to_string(body.left() / bytes) + " in the " +
                      std::to_string(body.left()) + " bytes that follow");
}

template <class Body>
Mesh readBody(const Header& header, Body body) {
  Mesh mesh;
  Faces faces;
  std::uint64_t vertexCount = 0;
  for (const Element& element : header.elements)
    if (element.name == "vertex") vertexCount = element.count;
  std::vector<std::uint32_t> corners;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    body.at(element, 0);
    checkRoom(body, element);
    const bool isVertex = element.name == "vertex", isFace = element.name == "face";
    const std::size_t axes[] = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
    const std::size_t indices = element.find({"vertex_indices", "vertex_index"}), end = element.properties.size();
    if (isVertex && std::count(std::begin(axes), std::end(axes), end) > 0)
      body.refuse("", "a vertex has no x, y or z, expected all three");
    if (isFace && (indices == end || !element.properties[indices].isList))
      body.refuse("", "a face has no list of vertices, expected \"property list uchar int vertex_indices\"");
    if (isVertex) mesh.vertices.reserve(element.count);
    if (isFace) mesh.triangles.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body.at(element, i);
      Triple point{};
      for (std::size_t k = 0; k < end; ++k) {
        const Property& property = element.properties[k];
        if (!property.isList) {
          const double value = body.real(property.type, isVertex ? "a number of a vertex" : "a number");
          for (int axis = 0; axis < 3; ++axis)
            if (axes[axis] == k) point[axis] = value;
          continue;
        }
        const std::int64_t length = body.whole(property.count, "the length of a list");
        if (length < 0 || static_cast<std::uint64_t>(length) > body.left())
          body.refuse("", "a list of " + std::to_string(length) + ", expected one that the file can hold");
        const bool kept = isFace && k == indices;
        corners.clear();
        for (std::int64_t n = 0; n < length; ++n) {
          if (!kept) {
            body.real(property.type, "a number of a list");
            continue;
          }
          const std::int64_t index = body.whole(property.type, "the number of a vertex");
          if (index < 0 || static_cast<std::uint64_t>(index) >= vertexCount)
            body.refuse("", "vertex " + std::to_string(index) + " does not exist, expected 0 to " +
                                std::to_string(static_cast<std::int64_t>(vertexCount) - 1));
          corners.push_back(static_cast<std::uint32_t>(index));
        }
        if (kept) faces.add(mesh, corners);
      }
      if (isVertex) mesh.vertices.push_back(point);
    }
  }
  faces.finish(mesh);
  return mesh;
}

}  // namespace

Mesh readPly(const std::string& file, std::string_view whole) {
  MeshText text(file, whole);
  const Header header = readHeader(text);
  if (header.format == "ascii") return readBody(header, TextBody(text));
  const bool isLittle = header.format == "binary_little_endian";
  return readBody(header, BinaryBody(file, text.rest(), isLittle != (std::endian::native == std::endian::little)));
}

}  // namespace solidcast
