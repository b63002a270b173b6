// How the cases are written down: inputs and allowed outcomes only, the truth is the oracle's business.
#pragma once
#include "host/catalogue/catalogue.h"

namespace solidcast::catalogue {

using Float3 = std::array<float, 3>;

/// (x, y, z) / length, in fp64 and then rounded to fp32: what a program hands to a ray caster as a unit direction.
Float3 unit(double x, double y, double z);

/// How hard a case is for the methods that need not be right.
enum class Hard {
  none,   // naive within 4096 ulp, fast within 256
  naive,  // the textbook formula fails or may fail; fast within 256 ulp
  fast,   // so may any fp32 formula
};

void addRay(Catalogue& to, const char* id, const char* note, std::vector<Shape> solids, const Float3& origin,
            const Float3& direction, Hard hard = Hard::none);
void addLimitedRay(Catalogue& to, const char* id, const char* note, std::vector<Shape> solids, const QueryRay& ray,
                   Hard hard = Hard::none);
void addReject(Catalogue& to, const char* id, const char* note, const char* about, const Shape& solid);
void addCameraReject(Catalogue& to, const char* id, const char* note, const char* about, const Camera& camera,
                     int width = 8, int height = 8);
void addRayReject(Catalogue& to, const char* id, const char* note, const char* about, const QueryRay& ray);
void addImage(Catalogue& to, const char* id, const char* note, std::vector<Shape> solids, const Camera& camera,
              int width, int height, const std::vector<std::array<int, 2>>& pixels, Hard hard);
void addFamily(Catalogue& to, const char* id, const char* note, const char* kind, const char* family, std::size_t rays);

void addSpheres(Catalogue& to);
void addPlanes(Catalogue& to);
void addBoxes(Catalogue& to);
void addDiscsAndQuads(Catalogue& to);
void addTriangles(Catalogue& to);
void addQuadrics(Catalogue& to);
void addRaysAndCameras(Catalogue& to);
void addWorse(Catalogue& to);

/// All cases, without truth.
Catalogue allCases();
/// The oracle's answers, at full effort.
void fillTruth(Catalogue& catalogue);
/// The text of catalogue.json.
std::string writeCatalogue(const Catalogue& catalogue);

}  // namespace solidcast::catalogue
