// Moved.
#pragma once
#include "host/oracle/families.h"
