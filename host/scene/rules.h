// What every scene must keep, whether it came from a file or was made through the API. Rules name the field they
// speak of; who calls them knows the place in the file.
#pragma once
#include <string>
#include <vector>

#include "host/scene/world.h"

namespace solidcast {

/// Groups may nest this deep: code that walks the tree by recursion must not run out of stack.
inline constexpr int kMaxGroupDepth = 1000;
/// Pixels along a side of the image.
inline constexpr int kMaxImageSide = 100000;
/// A triangle or quad whose area is below this part of its longest edge squared is a sliver: drawn, with a warning.
inline constexpr double kSliver = 1e-6;

/// A broken rule (thrown), or a doubtful thing (in a list of warnings).
struct Fault {
  std::string where;  // JSON pointer of the field, from the thing that was checked; may be empty
  std::string text;   // what is wrong, expected what
};

[[noreturn]] inline void refuse(const std::string& where, const std::string& text) { throw Fault{where, text}; }

/// NaN, infinities and numbers beyond fp32 are refused.
void checkNumber(double value, const std::string& where);
void checkPositive(double value, const std::string& where);
void checkNonZero(const Triple& vector, const std::string& where);

/// Degenerate shapes are refused; those that can be drawn but will hardly be seen are warned of.
void checkShape(const Shape& shape, std::vector<Fault>& warnings);
void checkImageSize(double width, double height);
void checkCamera(const Camera& camera, std::vector<Fault>& warnings);
void checkIntegrator(const RayCastingDistIntegrator& integrator);

/// Text with a number after it: numbered("sphere ", 3) is "sphere 3".
std::string numbered(const char* text, std::size_t number);

/// The shortest decimal that reads back as the same number.
std::string shortest(double value);

}  // namespace solidcast
