// The solids and the rays that the families are put together from.
#pragma once
#include "host/oracle/families.h"
#include "host/oracle/random.h"
#include "host/oracle/vectors.h"

namespace solidcast::oracle {

/// A solid and what the rays must know to find its difficult places.
struct Subject {
  Shape shape;
  Triple center{};
  double size = 1;
  int axis = 2;        // of a paraboloid or cone
  double opening = 1;  // of a cone: radius at distance 1 from the apex
};

/// Origin and direction rounded to fp32; the direction leads from the rounded origin to the target.
QueryRay aimed(const Triple& origin, const Triple& target);
/// x moved by k units of its last place.
float nudged(float x, int k);

/// A target on the outline seen from `origin` (which is drawn too), between one that is hit and one that is not;
/// `across` leads outwards. False where none was found.
bool outline(const Subject& subject, Random& random, Triple& origin, Triple& target, Triple& across);

Subject genericSubject(Kind kind, Random& random);
Subject tinySubject(Kind kind, Random& random);
Subject offsetSubject(Kind kind, Random& random);
Subject scaledSubject(Kind kind, Random& random);
Subject denormalSubject(Kind kind, Random& random);
Subject latticeSubject(Kind kind, Random& random);
Subject closedSubject(Kind kind, Random& random);
Subject floatBoxSubject(Kind kind, Random& random);
Subject planetSubject(Kind kind, Random& random);
Subject sliverSubject(Kind kind, Random& random);
Subject parallelSubject(Kind kind, Random& random);
Subject spreadSubject(Kind kind, Random& random);
Subject paraboloidSubject(Kind kind, Random& random);
Subject coneSubject(Kind kind, Random& random);
Subject cylinderSubject(Kind kind, Random& random);

QueryRay genericRay(const Subject& subject, Random& random);
QueryRay farRay(const Subject& subject, Random& random);
QueryRay tinyRay(const Subject& subject, Random& random);
QueryRay longRay(const Subject& subject, Random& random);
QueryRay denormalRay(const Subject& subject, Random& random);
QueryRay axisRay(const Subject& subject, Random& random);
QueryRay boundaryRay(const Subject& subject, Random& random);
QueryRay latticeRay(const Subject& subject, Random& random);
QueryRay rimRay(const Subject& subject, Random& random);
QueryRay surfaceRay(const Subject& subject, Random& random);
QueryRay insideRay(const Subject& subject, Random& random);
QueryRay grazingRay(const Subject& subject, Random& random);
QueryRay faceRay(const Subject& subject, Random& random);
QueryRay planetRay(const Subject& subject, Random& random);
QueryRay spannedRay(const Subject& subject, Random& random);
QueryRay nearAxisRay(const Subject& subject, Random& random);
QueryRay generatorRay(const Subject& subject, Random& random);
QueryRay apexRay(const Subject& subject, Random& random);

}  // namespace solidcast::oracle
