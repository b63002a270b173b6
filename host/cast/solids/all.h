// Every solid's packing and second pass; one file a solid.
#pragma once
#include "host/cast/solids/box.h"
#include "host/cast/solids/disc.h"
#include "host/cast/solids/plane.h"
#include "host/cast/solids/quad.h"
#include "host/cast/solids/quadric.h"
#include "host/cast/solids/sphere.h"
#include "host/cast/solids/triangle.h"
