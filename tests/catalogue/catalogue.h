// Moved.
#pragma once
#include "host/catalogue/catalogue.h"
